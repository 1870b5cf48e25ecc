//! OSMesa: Mesa's library for drawing into plain memory.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_void};

use libloading::Library;

use super::library::{first_library, symbol};
use super::opening::{OpenOptions, Opened, VERSIONS};
use crate::gl::Platform;

type Handle = *mut c_void;
type CreateContextAttribs = unsafe extern "C" fn(*const i32, Handle) -> Handle;
type MakeCurrent = unsafe extern "C" fn(Handle, *mut c_void, u32, i32, i32) -> u8;
type GetProcAddress = unsafe extern "C" fn(*const c_char) -> *const c_void;
type DestroyContext = unsafe extern "C" fn(Handle);
type GetCurrentContext = unsafe extern "C" fn() -> Handle;

const FORMAT: i32 = 0x22;
const RGBA: i32 = 0x1908;
const DEPTH_BITS: i32 = 0x30;
const STENCIL_BITS: i32 = 0x31;
const PROFILE: i32 = 0x33;
const CORE_PROFILE: i32 = 0x34;
const CONTEXT_MAJOR: i32 = 0x36;
const CONTEXT_MINOR: i32 = 0x37;
const UNSIGNED_BYTE: u32 = 0x1401;

/// Side of the buffer that OSMesa wants; nothing is drawn into it.
const SIDE_PX: i32 = 16;
const BUFFER_BYTES: usize = (SIDE_PX * SIDE_PX * 4) as usize;

#[cfg(target_os = "windows")]
const LIBRARIES: [&str; 1] = ["osmesa.dll"];
#[cfg(target_vendor = "apple")]
const LIBRARIES: [&str; 2] = ["libOSMesa.8.dylib", "libOSMesa.dylib"];
#[cfg(not(any(target_os = "windows", target_vendor = "apple")))]
const LIBRARIES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];

pub(super) fn open(_options: &OpenOptions) -> Result<Opened, String> {
    let library = first_library(&LIBRARIES)?;
    // SAFETY: the names and signatures are those of Mesa's GL/osmesa.h.
    let (create, make_current, get_proc_address, destroy, get_current): (
        CreateContextAttribs,
        MakeCurrent,
        GetProcAddress,
        DestroyContext,
        GetCurrentContext,
    ) = unsafe {
        (
            symbol(&library, c"OSMesaCreateContextAttribs")?,
            symbol(&library, c"OSMesaMakeCurrent")?,
            symbol(&library, c"OSMesaGetProcAddress")?,
            symbol(&library, c"OSMesaDestroyContext")?,
            symbol(&library, c"OSMesaGetCurrentContext")?,
        )
    };
    let context = VERSIONS
        .iter()
        .map(|&version| {
            let attributes = attributes(version);
            // SAFETY: the list ends with two zeros.
            unsafe { create(attributes.as_ptr(), std::ptr::null_mut()) }
        })
        .find(|context| !context.is_null())
        .ok_or("no OpenGL 3.3 core context")?;
    let buffer = Box::new(UnsafeCell::new([0; BUFFER_BYTES]));
    let platform =
        Osmesa { context, buffer, make_current, get_proc_address, destroy, get_current, _library: library };
    Ok(Opened { platform: Box::new(platform), device: "memory".to_owned() })
}

fn attributes((major, minor): (u8, u8)) -> [i32; 14] {
    let mut list = [0; 14];
    list[..6].copy_from_slice(&[FORMAT, RGBA, DEPTH_BITS, 24, STENCIL_BITS, 8]);
    list[6..12].copy_from_slice(&[
        PROFILE,
        CORE_PROFILE,
        CONTEXT_MAJOR,
        major.into(),
        CONTEXT_MINOR,
        minor.into(),
    ]);
    list
}

struct Osmesa {
    context: Handle,
    /// OSMesa keeps the buffer's address while the context is current, so the buffer is boxed and never moved.
    buffer: Box<UnsafeCell<[u8; BUFFER_BYTES]>>,
    make_current: MakeCurrent,
    get_proc_address: GetProcAddress,
    destroy: DestroyContext,
    get_current: GetCurrentContext,
    /// Last, so that it is unloaded after everything above is gone.
    _library: Library,
}

impl Platform for Osmesa {
    fn make_current(&self) -> Result<(), String> {
        // SAFETY: the buffer has room for the stated size and lives, in place, as long as the context.
        let done = unsafe {
            (self.make_current)(self.context, self.buffer.get().cast(), UNSIGNED_BYTE, SIDE_PX, SIDE_PX)
        };
        if done == 0 { Err("the context cannot be made current".to_owned()) } else { Ok(()) }
    }

    fn function_address(&self, name: &CStr) -> *const c_void {
        // SAFETY: the name ends with a zero byte.
        unsafe { (self.get_proc_address)(name.as_ptr()) }
    }
}

impl Drop for Osmesa {
    fn drop(&mut self) {
        // SAFETY: the context is alive and is not used afterwards; it lets go of the buffer first.
        unsafe {
            if (self.get_current)() == self.context {
                (self.make_current)(std::ptr::null_mut(), std::ptr::null_mut(), UNSIGNED_BYTE, 0, 0);
            }
            (self.destroy)(self.context);
        }
    }
}
