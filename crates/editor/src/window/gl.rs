//! The window's OpenGL: opens it, and before egui draws, resets the state that the app has changed.

#![expect(
    unsafe_code,
    reason = "a window's OpenGL is reached through C libraries that are loaded at run time"
)]

use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use glow::HasContext as _;
use glutin::config::{Config, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, PossiblyCurrentContext};
use glutin::display::GetGlDisplay as _;
use glutin::prelude::{
    GlDisplay as _, GlSurface as _, NotCurrentGlContext as _, PossiblyCurrentGlContext as _,
};
use glutin::surface::{Surface, SurfaceAttributesBuilder, SwapInterval, WindowSurface};
use glutin_winit::DisplayBuilder;
use winit::event_loop::ActiveEventLoop;
use winit::raw_window_handle::HasWindowHandle as _;
use winit::window::{Window, WindowAttributes};

/// Makes Mesa draw the window in software, by environment variables; those that the user has set stay. Must be called
/// before anything else in this module, on the main thread, while no other thread runs.
pub fn force_software() {
    for (name, value) in [("LIBGL_ALWAYS_SOFTWARE", "1"), ("__GLX_VENDOR_LIBRARY_NAME", "mesa")] {
        if std::env::var_os(name).is_none() {
            // SAFETY: no other thread runs yet that could read the environment meanwhile.
            unsafe { std::env::set_var(name, value) };
        }
    }
}

/// A window's OpenGL context and what it draws on. It must be dropped before the window.
pub(super) struct WindowGl {
    surface: Surface<WindowSurface>,
    context: PossiblyCurrentContext,
    gl: Arc<glow::Context>,
}

impl WindowGl {
    /// Opens a window and an OpenGL context for it, and makes the context current.
    pub(super) fn open(
        event_loop: &ActiveEventLoop,
        window: WindowAttributes,
    ) -> Result<(Window, Self), String> {
        // `open` panics if the driver offers no config, and some drivers make glutin panic.
        catch_unwind(AssertUnwindSafe(|| open(event_loop, window)))
            .unwrap_or_else(|_| Err("the driver broke off while it was asked".to_owned()))
    }

    pub(super) fn gl(&self) -> &Arc<glow::Context> {
        &self.gl
    }

    /// The OpenGL version and the name that the driver gives itself.
    pub(super) fn driver(&self) -> String {
        // SAFETY: the context is current on this thread.
        let (version, renderer) = unsafe {
            (self.gl.get_parameter_string(glow::VERSION), self.gl.get_parameter_string(glow::RENDERER))
        };
        format!("OpenGL {version}, {renderer}")
    }

    pub(super) fn make_current(&self) -> Result<(), String> {
        self.context.make_current(&self.surface).map_err(|error| error.to_string())
    }

    pub(super) fn resize(&self, [width, height]: [u32; 2]) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(width), NonZeroU32::new(height)) {
            self.surface.resize(&self.context, width, height);
        }
    }

    pub(super) fn show(&self) -> Result<(), String> {
        self.surface.swap_buffers(&self.context).map_err(|error| error.to_string())
    }

    /// Restores the OpenGL state that egui's painter relies on.
    pub(super) fn before_egui(&self) {
        let gl = &self.gl;
        // SAFETY: the context is current on this thread, and none of these calls reads memory of ours.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 0);
            gl.pixel_store_i32(glow::UNPACK_SKIP_ROWS, 0);
            gl.pixel_store_i32(glow::UNPACK_SKIP_PIXELS, 0);
            if !gl.version().is_embedded {
                gl.disable(glow::COLOR_LOGIC_OP);
                if gl.version().major >= 3 {
                    gl.disable(glow::RASTERIZER_DISCARD);
                    gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
                }
            }
            if (gl.version().major, gl.version().minor) >= (3, 3) {
                gl.bind_sampler(0, None);
            }
        }
    }
}

fn open(event_loop: &ActiveEventLoop, attributes: WindowAttributes) -> Result<(Window, WindowGl), String> {
    let template = ConfigTemplateBuilder::new().with_depth_size(0).with_stencil_size(0);
    let (window, config) = DisplayBuilder::new()
        .with_window_attributes(Some(attributes))
        .build(event_loop, template, |mut configs| {
            configs.next().expect("a driver offers at least one config")
        })
        .map_err(|error| error.to_string())?;
    let window = window.ok_or("the window system made no window")?;
    let gl = open_on(&window, &config)?;
    Ok((window, gl))
}

fn open_on(window: &Window, config: &Config) -> Result<WindowGl, String> {
    let display = config.display();
    let handle = window.window_handle().map_err(|error| error.to_string())?.as_raw();
    let wanted = ContextAttributesBuilder::new().build(Some(handle));
    let embedded =
        ContextAttributesBuilder::new().with_context_api(ContextApi::Gles(None)).build(Some(handle));
    let size = window.inner_size();
    let least = |length| NonZeroU32::new(length).unwrap_or(NonZeroU32::MIN);
    let surface =
        SurfaceAttributesBuilder::<WindowSurface>::new().build(handle, least(size.width), least(size.height));
    // SAFETY: `handle` belongs to `window`, which its owner drops after the context and the surface that are made here.
    let (context, surface) = unsafe {
        let context = display.create_context(config, &wanted).or_else(|first| {
            display
                .create_context(config, &embedded)
                .map_err(|second| format!("{first}; OpenGL ES: {second}"))
        })?;
        (context, display.create_window_surface(config, &surface).map_err(|error| error.to_string())?)
    };
    let context = context.make_current(&surface).map_err(|error| error.to_string())?;
    // If the driver cannot wait for the screen, it draws without waiting.
    let _cannot_wait = surface.set_swap_interval(&context, SwapInterval::Wait(NonZeroU32::MIN));
    // SAFETY: the context is current on this thread, and the display outlives the functions: the surface holds it.
    let gl = unsafe { glow::Context::from_loader_function_cstr(|name| display.get_proc_address(name)) };
    Ok(WindowGl { surface, context, gl: Arc::new(gl) })
}
