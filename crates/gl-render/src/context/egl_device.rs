//! Opens OpenGL on an EGL device, which is a graphics card or the software rasteriser. No display server is
//! needed.

#[cfg(target_vendor = "apple")]
use super::opening::{OpenOptions, Opened};

#[cfg(not(target_vendor = "apple"))]
pub(super) use with_devices::open;

#[cfg(target_vendor = "apple")]
pub(super) fn open(_options: &OpenOptions) -> Result<Opened, String> {
    Err("this system has no EGL".to_owned())
}

#[cfg(not(target_vendor = "apple"))]
mod with_devices {
    use std::ffi::{CStr, c_void};

    use glutin::api::egl::config::Config;
    use glutin::api::egl::context::PossiblyCurrentContext;
    use glutin::api::egl::device::Device;
    use glutin::api::egl::display::Display;
    use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
    use glutin::context::{
        ContextApi, ContextAttributesBuilder, GlProfile, PossiblyCurrentGlContext as _, Version,
    };
    use glutin::display::GlDisplay as _;

    use super::super::opening::{OpenOptions, Opened, VERSIONS};
    use crate::gl::Platform;

    /// Opens the first device that works; graphics cards are tried before software.
    pub(in super::super) fn open(options: &OpenOptions) -> Result<Opened, String> {
        let mut devices: Vec<Device> = Device::query_devices().map_err(|error| error.to_string())?.collect();
        devices.sort_by_key(|device| device.extensions().contains("EGL_MESA_device_software"));
        let mut reasons = Vec::new();
        for device in &devices {
            match open_device(device, options) {
                Ok(opened) => return Ok(opened),
                Err(reason) => reasons.push(format!("{}: {reason}", name_of(device))),
            }
        }
        Err(if reasons.is_empty() { "EGL knows no device".to_owned() } else { reasons.join("; ") })
    }

    fn name_of(device: &Device) -> String {
        let software = device.extensions().contains("EGL_MESA_device_software");
        device.name().map_or_else(
            || if software { "software device".to_owned() } else { "graphics device".to_owned() },
            str::to_owned,
        )
    }

    fn open_device(device: &Device, options: &OpenOptions) -> Result<Opened, String> {
        // SAFETY: no native display is passed, so none has to outlive the EGL display.
        let display = unsafe { Display::with_device(device, None) }.map_err(|error| error.to_string())?;
        // The default template asks for window surfaces, which a device does not have.
        let template = ConfigTemplateBuilder::new()
            .with_surface_type(ConfigSurfaceTypes::empty())
            .with_api(Api::OPENGL)
            .build();
        // SAFETY: the template names no native window.
        let config = unsafe { display.find_configs(template) }
            .map_err(|error| error.to_string())?
            .next()
            .ok_or("it has no configuration for OpenGL")?;
        let context = create(&display, &config, options)?;
        Ok(Opened { platform: Box::new(EglDevice { context, display }), device: name_of(device) })
    }

    fn create(
        display: &Display,
        config: &Config,
        options: &OpenOptions,
    ) -> Result<PossiblyCurrentContext, String> {
        let mut last = String::new();
        for (major, minor) in VERSIONS {
            let attributes = ContextAttributesBuilder::new()
                .with_profile(GlProfile::Core)
                .with_context_api(ContextApi::OpenGl(Some(Version::new(major, minor))))
                .with_debug(options.debug)
                .build(None);
            // SAFETY: the attributes name no native window.
            let created = unsafe { display.create_context(config, &attributes) };
            match created.and_then(|context| context.make_current_surfaceless()) {
                Ok(context) => return Ok(context),
                Err(error) => last = error.to_string(),
            }
        }
        Err(format!("no OpenGL 3.3 core context: {last}"))
    }

    struct EglDevice {
        context: PossiblyCurrentContext,
        display: Display,
    }

    impl Platform for EglDevice {
        fn make_current(&self) -> Result<(), String> {
            self.context.make_current_surfaceless().map_err(|error| error.to_string())
        }

        fn make_none_current(&self) -> Result<(), String> {
            self.context.make_not_current_in_place().map_err(|error| error.to_string())
        }

        fn function_address(&self, name: &CStr) -> *const c_void {
            self.display.get_proc_address(name)
        }
    }
}
