//! Reports on drivers: which were tried, which one is used, and which packages would help.

use std::fmt;

use impasto_system::{FOR_EGL, FOR_OSMESA, Part, mend};

use crate::gl::Gpu;

/// Which library to take OpenGL from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Driver {
    /// EGL where it works, else OSMesa.
    #[default]
    Auto,
    /// EGL, with a graphics card or in software.
    Egl,
    /// OSMesa, always in software.
    Osmesa,
}

impl fmt::Display for Driver {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Driver::Auto => "auto",
            Driver::Egl => "egl",
            Driver::Osmesa => "osmesa",
        })
    }
}

impl Driver {
    /// What the system must provide for this driver; nothing for [`Driver::Auto`], which stands for both others.
    pub fn parts(self) -> &'static [Part] {
        match self {
            Driver::Auto => &[],
            Driver::Egl => FOR_EGL,
            Driver::Osmesa => FOR_OSMESA,
        }
    }
}

/// An attempt to open a context that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailedAttempt {
    /// The driver.
    pub driver: Driver,
    /// How it was to be opened, in words.
    pub way: &'static str,
    /// Why it failed, as one line.
    pub reason: String,
}

/// No driver could open a context.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ContextError {
    /// Every attempt, in order.
    pub tried: Vec<FailedAttempt>,
}

impl fmt::Display for ContextError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "no usable OpenGL 3.3:")?;
        for attempt in &self.tried {
            write!(formatter, "\n  {}: {}", attempt.way, attempt.reason)?;
        }
        let tried = |driver: &Driver| self.tried.iter().any(|attempt| attempt.driver == *driver);
        let mends: Vec<String> = [Driver::Egl, Driver::Osmesa]
            .into_iter()
            .filter(tried)
            .map(|driver| format!("{} ({driver})", mend(driver.parts())))
            .collect();
        write!(formatter, "\n  mend: {}", mends.join(", or "))
    }
}

/// The driver in use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContextReport {
    /// The driver.
    pub driver: Driver,
    /// How it was opened, in words, such as "EGL device".
    pub way: &'static str,
    /// Name of the device, or a word that stands for it, such as "memory".
    pub device: String,
    /// `GL_VENDOR`.
    pub vendor: String,
    /// `GL_RENDERER`.
    pub renderer: String,
    /// `GL_VERSION`.
    pub version: String,
    /// `GL_SHADING_LANGUAGE_VERSION`.
    pub shading_language: String,
    /// The longest side of a picture, in pixels.
    pub max_side_px: u32,
    /// Whether the driver's debug output is collected.
    pub debug_output: bool,
    /// Attempts that failed before.
    pub tried: Vec<FailedAttempt>,
}

impl ContextReport {
    /// Whether one of Mesa's software drivers draws, on the CPU.
    pub fn is_software(&self) -> bool {
        ["llvmpipe", "softpipe"].iter().any(|name| self.renderer.contains(name))
    }
}

impl fmt::Display for ContextReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} ({}): {}, OpenGL {}", self.driver, self.way, self.renderer, self.version)?;
        for attempt in &self.tried {
            write!(formatter, "; not {}: {}", attempt.way, attempt.reason)?;
        }
        Ok(())
    }
}

pub(super) fn describe(
    gpu: &Gpu,
    driver: Driver,
    way: &'static str,
    device: String,
    tried: Vec<FailedAttempt>,
) -> ContextReport {
    let limits = gpu.limits();
    ContextReport {
        driver,
        way,
        device,
        vendor: limits.vendor.clone(),
        renderer: limits.renderer.clone(),
        version: limits.version.clone(),
        shading_language: limits.shading_language.clone(),
        max_side_px: limits.max_side_px,
        debug_output: gpu.listens(),
        tried,
    }
}
