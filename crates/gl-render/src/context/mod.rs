//! Getting an OpenGL context on a machine that may have no display.
//!
//! Three ways, tried in this order by [`Driver::Auto`]: an EGL device (a GPU before the software one), EGL's
//! surfaceless platform, and OSMesa, Mesa's off-screen library. All of them are loaded at run time, so the program
//! starts, and can say what is missing, where none is installed.

#![expect(unsafe_code, reason = "contexts are made by calls into C libraries that are loaded at run time")]

mod driver_messages;
mod egl_device;
mod egl_surfaceless;
mod osmesa;
mod report;

use std::ffi::{CStr, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use crate::gl::{Gpu, Limits};

pub use driver_messages::DriverMessages;
pub use report::{ContextError, ContextReport, Driver, FailedAttempt, Mend};

/// How to open a context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Asks the driver for its debug output; [`crate::Renderer::render`] then fails where the driver complained.
    pub debug: bool,
}

/// An OpenGL context of version 3.3 core or later, with no window.
///
/// It belongs to the thread that opened it. Several may be open on one thread.
pub struct Context {
    gpu: Gpu,
    report: ContextReport,
}

impl Context {
    /// Which driver it is, and why the ones before it were not taken.
    pub fn report(&self) -> &ContextReport {
        &self.report
    }

    /// OpenGL's functions, for another painter in the same context. They call whatever context is current
    /// ([`Context::make_current`]), and must not be called once this one is dropped.
    pub fn glow(&self) -> Arc<glow::Context> {
        self.gpu.functions()
    }

    /// Makes this the current context of the thread.
    ///
    /// # Errors
    ///
    /// The driver's words, where it refuses.
    pub fn make_current(&self) -> Result<(), String> {
        self.gpu.make_current().map_err(|error| error.to_string())
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

/// What a driver hands over: a current context and the way to find its functions.
struct Opened {
    platform: Box<dyn Platform>,
    device: String,
}

/// The part of a context that the windowing library owns. Dropping it destroys the context.
pub(crate) trait Platform {
    /// Makes the context current on this thread.
    fn make_current(&self) -> Result<(), String>;
    /// The address of an OpenGL function, null where there is none.
    fn function_address(&self, name: &CStr) -> *const c_void;
}

/// OpenGL versions asked for, best first. Mesa refuses 4.6 where it has only 4.5, and nothing here needs it.
const VERSIONS: [(u8, u8); 4] = [(4, 5), (4, 3), (4, 1), (3, 3)];

type Opener = fn(&OpenOptions) -> Result<Opened, String>;

/// Opens a context with the wanted driver.
///
/// # Errors
///
/// [`ContextError`] lists every way that was tried, why it failed, and which package would mend it.
pub fn open(driver: Driver, options: &OpenOptions) -> Result<Context, ContextError> {
    let mut failed = Vec::new();
    for (candidate, way, opener) in ways(driver) {
        match guarded(|| opener(options).and_then(|opened| finish(opened, options))) {
            Ok((gpu, device)) => {
                let report = report::describe(&gpu, (candidate, way, device), failed);
                return Ok(Context { gpu, report });
            }
            Err(reason) => failed.push(FailedAttempt { driver: candidate, way, reason }),
        }
    }
    Err(ContextError { tried: failed })
}

fn ways(driver: Driver) -> Vec<(Driver, &'static str, Opener)> {
    let all: [(Driver, &'static str, Opener); 3] = [
        (Driver::Egl, "EGL device", egl_device::open),
        (Driver::Egl, "EGL surfaceless", egl_surfaceless::open),
        (Driver::Osmesa, "OSMesa", osmesa::open),
    ];
    all.into_iter().filter(|(candidate, ..)| driver == Driver::Auto || driver == *candidate).collect()
}

/// Turns a panic below (a driver that answers nonsense) into a reason.
fn guarded<T>(attempt: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(attempt)).unwrap_or_else(|payload| {
        let text = payload
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| payload.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Err(format!("the driver broke: {}", text.unwrap_or_else(|| "no reason given".to_owned())))
    })
}

fn finish(opened: Opened, options: &OpenOptions) -> Result<(Gpu, String), String> {
    let Opened { platform, device } = opened;
    platform.make_current()?;
    // SAFETY: the context is current on this thread, and the functions outlive the table: `Gpu` keeps `platform`.
    let mut gl = unsafe { glow::Context::from_loader_function_cstr(|name| platform.function_address(name)) };
    let version = gl_version(&gl);
    if version < (3, 3) {
        return Err(format!("it offers OpenGL {}.{}, and Impasto needs 3.3", version.0, version.1));
    }
    let messages = options.debug.then(|| DriverMessages::install(&mut gl)).flatten();
    let limits = Limits::read(&gl);
    let gl = Arc::new(gl);
    Ok((Gpu::new(gl, platform, messages, limits), device))
}

fn gl_version(gl: &glow::Context) -> (u32, u32) {
    use glow::HasContext as _;
    (gl.version().major, gl.version().minor)
}
