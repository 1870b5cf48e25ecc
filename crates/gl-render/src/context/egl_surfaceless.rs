//! Opens OpenGL on EGL's surfaceless platform, for drivers that list no devices. glutin does not know this platform, so
//! EGL is called directly.

use std::ffi::{CStr, c_char, c_void};
use std::rc::Rc;

use libloading::Library;

use super::library::{first_library, symbol};
use super::opening::{OpenOptions, Opened, VERSIONS};
use crate::gl::Platform;

type Handle = *mut c_void;
type GetProcAddress = unsafe extern "system" fn(*const c_char) -> *const c_void;
type GetPlatformDisplay = unsafe extern "system" fn(u32, Handle, *const i32) -> Handle;
type Initialize = unsafe extern "system" fn(Handle, *mut i32, *mut i32) -> u32;
type BindApi = unsafe extern "system" fn(u32) -> u32;
type ChooseConfig = unsafe extern "system" fn(Handle, *const i32, *mut Handle, i32, *mut i32) -> u32;
type CreateContext = unsafe extern "system" fn(Handle, Handle, Handle, *const i32) -> Handle;
type MakeCurrent = unsafe extern "system" fn(Handle, Handle, Handle, Handle) -> u32;
type DestroyContext = unsafe extern "system" fn(Handle, Handle) -> u32;
type GetCurrentContext = unsafe extern "system" fn() -> Handle;

const PLATFORM_SURFACELESS_MESA: u32 = 0x31DD;
const OPENGL_API: u32 = 0x30A2;
const CONFIG: [i32; 5] = [0x3033, 0, 0x3040, 0x0008, 0x3038]; // any surface, renderable by OpenGL
const CONTEXT_MAJOR: i32 = 0x3098;
const CONTEXT_MINOR: i32 = 0x30FB;
const CONTEXT_PROFILE_MASK: i32 = 0x30FD;
const CORE_PROFILE: i32 = 1;
const CONTEXT_DEBUG: i32 = 0x31B0;
const NONE: i32 = 0x3038;

#[cfg(target_os = "windows")]
const LIBRARIES: [&str; 1] = ["libEGL.dll"];
#[cfg(target_vendor = "apple")]
const LIBRARIES: [&str; 1] = ["libEGL.dylib"];
#[cfg(not(any(target_os = "windows", target_vendor = "apple")))]
const LIBRARIES: [&str; 2] = ["libEGL.so.1", "libEGL.so"];

struct Functions {
    get_proc_address: GetProcAddress,
    get_platform_display: GetPlatformDisplay,
    initialize: Initialize,
    bind_api: BindApi,
    choose_config: ChooseConfig,
    create_context: CreateContext,
    make_current: MakeCurrent,
    destroy_context: DestroyContext,
    get_current_context: GetCurrentContext,
    /// Keeps the functions above callable: dropping it unloads them. The EGL display is never terminated.
    _library: Library,
}

impl Functions {
    fn load() -> Result<Self, String> {
        let library = first_library(&LIBRARIES)?;
        // SAFETY: names and signatures are those of EGL 1.5. The two functions that give a display differ only in the
        // type of their attribute list, which is always null here.
        unsafe {
            let get_proc_address: GetProcAddress = symbol(&library, c"eglGetProcAddress")?;
            let platform_display = [c"eglGetPlatformDisplay", c"eglGetPlatformDisplayEXT"]
                .map(|name| get_proc_address(name.as_ptr()))
                .into_iter()
                .find(|address| !address.is_null())
                .ok_or("this EGL has no platforms")?;
            Ok(Self {
                get_proc_address,
                get_platform_display: std::mem::transmute::<*const c_void, GetPlatformDisplay>(
                    platform_display,
                ),
                initialize: symbol(&library, c"eglInitialize")?,
                bind_api: symbol(&library, c"eglBindAPI")?,
                choose_config: symbol(&library, c"eglChooseConfig")?,
                create_context: symbol(&library, c"eglCreateContext")?,
                make_current: symbol(&library, c"eglMakeCurrent")?,
                destroy_context: symbol(&library, c"eglDestroyContext")?,
                get_current_context: symbol(&library, c"eglGetCurrentContext")?,
                _library: library,
            })
        }
    }
}

pub(super) fn open(options: &OpenOptions) -> Result<Opened, String> {
    let egl = Rc::new(Functions::load()?);
    let mut config = std::ptr::null_mut();
    let mut found = 0;
    // SAFETY: every pointer is null or points to a live value of the documented kind and length.
    let display = unsafe {
        let display =
            (egl.get_platform_display)(PLATFORM_SURFACELESS_MESA, std::ptr::null_mut(), std::ptr::null());
        if display.is_null() {
            return Err("this EGL has no surfaceless platform".to_owned());
        }
        if (egl.initialize)(display, std::ptr::null_mut(), std::ptr::null_mut()) == 0 {
            return Err("the surfaceless platform does not start".to_owned());
        }
        if (egl.bind_api)(OPENGL_API) == 0 {
            return Err("it does not speak OpenGL".to_owned());
        }
        if (egl.choose_config)(display, CONFIG.as_ptr(), &raw mut config, 1, &raw mut found) == 0
            || found == 0
        {
            return Err("it has no configuration for OpenGL".to_owned());
        }
        display
    };
    let context = create(&egl, display, config, options)?;
    let platform = Surfaceless { egl, display, context };
    platform.make_current()?;
    Ok(Opened { platform: Box::new(platform), device: "surfaceless".to_owned() })
}

fn create(egl: &Functions, display: Handle, config: Handle, options: &OpenOptions) -> Result<Handle, String> {
    for (major, minor) in VERSIONS {
        let mut attributes = vec![CONTEXT_MAJOR, major.into(), CONTEXT_MINOR, minor.into()];
        attributes.extend([CONTEXT_PROFILE_MASK, CORE_PROFILE]);
        if options.debug {
            attributes.extend([CONTEXT_DEBUG, 1]);
        }
        attributes.push(NONE);
        // SAFETY: display and config come from this EGL; the list ends with NONE.
        let context =
            unsafe { (egl.create_context)(display, config, std::ptr::null_mut(), attributes.as_ptr()) };
        if !context.is_null() {
            return Ok(context);
        }
    }
    Err("no OpenGL 3.3 core context".to_owned())
}

struct Surfaceless {
    egl: Rc<Functions>,
    display: Handle,
    context: Handle,
}

impl Platform for Surfaceless {
    fn make_current(&self) -> Result<(), String> {
        let none = std::ptr::null_mut();
        // SAFETY: display and context are alive; on this platform a context needs no surface.
        match unsafe { (self.egl.make_current)(self.display, none, none, self.context) } {
            0 => Err("the context cannot be made current".to_owned()),
            _ => Ok(()),
        }
    }

    fn make_none_current(&self) -> Result<(), String> {
        let none = std::ptr::null_mut();
        // SAFETY: the display is alive; no context is named.
        match unsafe { (self.egl.make_current)(self.display, none, none, none) } {
            0 => Err("the context cannot be let go".to_owned()),
            _ => Ok(()),
        }
    }

    fn function_address(&self, name: &CStr) -> *const c_void {
        // SAFETY: the name ends with a zero byte.
        unsafe { (self.egl.get_proc_address)(name.as_ptr()) }
    }
}

impl Drop for Surfaceless {
    fn drop(&mut self) {
        let none = std::ptr::null_mut();
        // SAFETY: the context is alive and is not used afterwards.
        unsafe {
            if (self.egl.get_current_context)() == self.context {
                (self.egl.make_current)(self.display, none, none, none);
            }
            (self.egl.destroy_context)(self.display, self.context);
        }
    }
}
