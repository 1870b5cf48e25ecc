//! The window: an event loop around one egui page. It draws only when something changed, and knows nothing of painting.

mod event_loop;
mod focus;
mod gl;
mod heap;
mod icon;
mod input;
mod numpad;
mod pen;

use std::time::Duration;

use egui::vec2;
use impasto_system::{FOR_EGL, FOR_WAYLAND, FOR_X11, mend};
use winit::event_loop::EventLoopProxy;

pub use event_loop::run;
pub use focus::{FocusRules, tab_pressed};
pub use gl::force_software;
pub use heap::give_back_free_memory;
pub use numpad::numpad_pressed;
pub use pen::{Pens, PressureAxis, keep_pressures, pressures};

use event_loop::Happening;

/// What runs in the window.
pub trait App {
    /// Builds one pass of the page. Called when the window, the user, a timer or a [`Waker`] asks for it.
    ///
    /// Files that the user drags over the window or drops on it are in `ui.input(|input| &input.raw)`.
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut Frame<'_>);

    /// The words in the window's title bar.
    fn title(&self) -> String;

    /// The user asked the window system to close the window. Returning true closes it. An app with unsaved work returns
    /// false, asks in its page, and calls [`Frame::close`] later.
    fn on_close_request(&mut self) -> bool {
        true
    }

    /// Whether [`App::controls`] is to be called.
    fn wants_controls(&self) -> bool {
        false
    }

    /// The controls of the last pass, as a screen reader gets them.
    fn controls(&mut self, _controls: &egui::accesskit::TreeUpdate) {}
}

/// How to open the window.
#[derive(Clone, Debug)]
pub struct Options {
    /// Its first size in points.
    pub size: egui::Vec2,
    /// It cannot be made smaller than this, in points.
    pub least_size: egui::Vec2,
    /// The name that the desktop knows the program by.
    pub app_id: String,
}

impl Default for Options {
    fn default() -> Self {
        Self { size: vec2(1280.0, 800.0), least_size: vec2(640.0, 440.0), app_id: "impasto".to_owned() }
    }
}

/// What an app may know before its first pass.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The page's context; [`crate::theme::apply`] wants it.
    pub ctx: egui::Context,
    /// Wakes the window from other threads.
    pub waker: Waker,
    /// The OpenGL version and driver that draw the window.
    pub driver: String,
}

/// What one pass may use besides the page.
pub struct Frame<'a> {
    painter: &'a mut egui_glow::Painter,
    last: Duration,
    asks: &'a mut Asks,
}

#[derive(Clone, Copy, Debug, Default)]
struct Asks {
    close: bool,
    hold: bool,
}

impl Frame<'_> {
    /// The painter of the window, for textures that the app draws itself. Its context is current.
    pub fn painter(&mut self) -> &mut egui_glow::Painter {
        self.painter
    }

    /// How long the last frame that was shown took, from its input until it was on the screen.
    pub fn last_took(&self) -> Duration {
        self.last
    }

    /// Closes the window after this pass, without [`App::on_close_request`].
    pub fn close(&mut self) {
        self.asks.close = true;
    }

    /// Does not show this pass, because a better one will follow soon. While the view moves, that is the pass with the
    /// view's next picture. The window keeps its last contents for at most a tenth of a second after it showed them.
    pub fn hold(&mut self) {
        self.asks.hold = true;
    }
}

/// Makes the window run a pass soon. It works on any thread, and is cheap to clone.
#[derive(Clone, Debug)]
pub struct Waker(EventLoopProxy<Happening>);

impl Waker {
    /// Asks for a pass. Nothing happens once the window is gone.
    pub fn wake(&self) {
        // The only error is that the loop has ended.
        let _ended = self.0.send_event(Happening::Wake);
    }
}

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// The variables that name a display are not set.
    #[error(
        "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set. Open the editor from a desktop, or over `ssh -X`; \
         `impasto render` needs no display."
    )]
    Unnamed,
    /// Neither X11 nor Wayland could be reached.
    #[error(
        "no display: {reason}\n\
         The editor needs a display, and the libraries of X11 or Wayland.\n\
         For X11: {}\nFor Wayland: {}\n\
         `impasto render` needs no display.",
        mend(FOR_X11),
        mend(FOR_WAYLAND)
    )]
    NoDisplay {
        /// What the window system said.
        reason: String,
    },
    /// There is a window system but no OpenGL.
    #[error(
        "no OpenGL for a window: {reason}\n\
         The mend: {}\n`impasto doctor` tells what was found.",
        mend(FOR_EGL)
    )]
    NoOpenGl {
        /// What the driver said.
        reason: String,
    },
    /// The window system or OpenGL failed while the window was open.
    #[error("the window system broke off: {0}")]
    Broken(String),
}
