//! Getting an OpenGL context on a machine that may have no display.
//!
//! There are three ways, which [`Driver::Auto`] tries in this order: an EGL device (graphics cards before software),
//! EGL's surfaceless platform, and OSMesa, Mesa's off-screen library. All are loaded at run time, so that the program
//! starts even where none is installed, and can say what is missing.

#![expect(unsafe_code, reason = "contexts are made by calls into C libraries that are loaded at run time")]

mod egl_device;
mod egl_surfaceless;
mod library;
mod opening;
mod osmesa;
mod report;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use crate::gl::{DriverMessages, Gpu, Limits};
use opening::Opened;

pub use opening::OpenOptions;
pub use report::{ContextError, ContextReport, Driver, FailedAttempt};

/// An OpenGL context of version 3.3 core or later, with no window.
///
/// It belongs to the thread that opened it. Several may be open on one thread.
pub struct Context {
    gpu: Gpu,
    report: ContextReport,
}

impl Context {
    /// Which driver the context uses, and why earlier attempts with other drivers failed.
    pub fn report(&self) -> &ContextReport {
        &self.report
    }

    /// OpenGL's functions, for other code that draws in this context. They act on whatever context is current
    /// ([`Context::make_current`]), and must not be called after this context is dropped.
    pub fn glow(&self) -> Arc<glow::Context> {
        self.gpu.functions()
    }

    /// Makes this the current context of the thread.
    ///
    /// # Errors
    ///
    /// The driver's message, if it refuses.
    pub fn make_current(&self) -> Result<(), String> {
        self.gpu.make_current().map_err(|error| error.to_string())
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

type Opener = fn(&OpenOptions) -> Result<Opened, String>;

/// Opens a context with the wanted driver.
///
/// # Errors
///
/// [`ContextError`] lists every way that was tried, why it failed, and which packages would help.
pub fn open(driver: Driver, options: &OpenOptions) -> Result<Context, ContextError> {
    let mut failed = Vec::new();
    for (candidate, way, opener) in ways(driver) {
        match guarded(|| opener(options).and_then(|opened| finish(opened, options))) {
            Ok((gpu, device)) => {
                let report = report::describe(&gpu, candidate, way, device, failed);
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

/// Turns a panic of the attempt (some drivers answer nonsense) into an error message.
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
