//! The event loop: turns winit's events into passes of egui, and shows what they draw.

use std::panic::catch_unwind;
use std::time::{Duration, Instant};

use egui::{ViewportId, ViewportInfo};
use egui_winit::accesskit_winit;
use impasto_editor_model::keymap::{Key, Modifiers};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::focus::FocusRules;
use super::gl::WindowGl;
use super::icon::icon;
use super::input::one_thing_each;
use super::numpad::{keep_numpad, numpad_key};
use super::pen::{Pens, keep_pressures};
use super::{App, Asks, Frame, Opened, Options, Waker, WindowError};

/// The shortest time between two frames that only an animation asks for. Software drivers do not wait for the screen:
/// without this limit, an animation would draw without pause.
const LEAST_FRAME: Duration = Duration::from_millis(8);

/// An app can hold back new frames ([`Frame::hold`]) for at most this long.
const MOST_HELD: Duration = Duration::from_millis(100);

/// While an app holds back frames, passes for pointer moves are at least this far apart, and so are the passes that
/// egui itself asks for.
const HELD_PASS: Duration = Duration::from_millis(30);

/// Why a frame is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Due {
    /// Something happened, or the window system asks for the contents again.
    Now,
    /// The time of `Shell::next` has come: the frame is shown only if it looks different from the last.
    ByTimer,
}

/// What the window shows, to compare with the next frame.
#[derive(PartialEq)]
struct Page {
    shapes: Vec<egui::epaint::ClippedShape>,
    scale: f32,
    size: [u32; 2],
}

/// Events that do not come from the window system.
#[derive(Debug)]
pub(super) enum Happening {
    /// A [`Waker`] asks for a pass.
    Wake,
    /// egui wants a pass at `at`. It asked for that in the pass with the number `pass`.
    Repaint { at: Instant, pass: u64 },
    /// A screen reader asks for something.
    Access(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for Happening {
    fn from(event: accesskit_winit::Event) -> Self {
        Self::Access(event)
    }
}

/// Opens a window, makes the app with `make`, and runs it until it closes. Must be called on the main thread, once.
///
/// # Errors
///
/// [`WindowError`] if there is no display or no OpenGL, or if one of them fails while the window is open.
pub fn run<A: App>(options: Options, make: impl FnOnce(&Opened) -> A) -> Result<(), WindowError> {
    let event_loop = build_event_loop()?;
    let proxy = event_loop.create_proxy();
    let mut shell = Shell { options, make: Some(make), proxy, open: None, next: None, failed: None };
    event_loop.run_app(&mut shell).map_err(|error| WindowError::Broken(error.to_string()))?;
    shell.failed.map_or(Ok(()), Err)
}

fn build_event_loop() -> Result<EventLoop<Happening>, WindowError> {
    let is_named = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux")
        && !["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(is_named)
    {
        return Err(WindowError::Unnamed);
    }
    // The libraries that winit uses panic if libxkbcommon-x11 or libwayland-egl is missing. The panic's message goes
    // into the error, so it is not printed here.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let built = catch_unwind(|| EventLoop::with_user_event().build());
    std::panic::set_hook(hook);
    match built {
        Ok(built) => built.map_err(|error| WindowError::NoDisplay { reason: error.to_string() }),
        Err(panic) => {
            let words = panic.downcast_ref::<String>().cloned();
            let words = words.or_else(|| panic.downcast_ref::<&str>().map(|words| (*words).to_owned()));
            Err(WindowError::NoDisplay { reason: words.unwrap_or_else(|| "a library is missing".to_owned()) })
        }
    }
}

struct Shell<A, M> {
    options: Options,
    make: Option<M>,
    proxy: EventLoopProxy<Happening>,
    open: Option<OpenWindow<A>>,
    /// When the next pass is due, if nothing happens earlier.
    next: Option<Instant>,
    failed: Option<WindowError>,
}

/// Fields drop from top to bottom. So the OpenGL context goes before its window.
struct OpenWindow<A> {
    app: A,
    painter: egui_glow::Painter,
    state: egui_winit::State,
    gl: WindowGl,
    window: Window,
    info: ViewportInfo,
    textures: egui::TexturesDelta,
    /// Keys of the number pad, for the next pass.
    numpad: Vec<(Key, Modifiers)>,
    held: Modifiers,
    pens: Pens,
    title: String,
    last_start: Instant,
    last_shown: Instant,
    last_took: Duration,
    shown: Option<Page>,
    /// Whether the last pass was held back.
    holds: bool,
}

impl<A: App, M: FnOnce(&Opened) -> A> Shell<A, M> {
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<(), WindowError> {
        let Some(make) = self.make.take() else { return Ok(()) };
        let no_gl = |reason| WindowError::NoOpenGl { reason };
        let (window, gl) = WindowGl::open(event_loop, attributes(&self.options, screen_points(event_loop)))
            .map_err(no_gl)?;
        let painter = egui_glow::Painter::new(gl.gl().clone(), "", None, false)
            .map_err(|error| WindowError::NoOpenGl { reason: error.to_string() })?;

        let ctx = egui::Context::default();
        ctx.add_plugin(FocusRules);
        let proxy = self.proxy.clone();
        ctx.set_request_repaint_callback(move |asked| {
            let at = Instant::now().checked_add(asked.delay);
            if let Some(at) = at {
                // The only error is that the loop has ended.
                let _ended =
                    proxy.send_event(Happening::Repaint { at, pass: asked.current_cumulative_pass_nr });
            }
        });
        let scale = window.scale_factor() as f32;
        let most = painter.max_texture_side();
        let mut state = egui_winit::State::new(
            ctx.clone(),
            ViewportId::ROOT,
            event_loop,
            Some(scale),
            window.theme(),
            Some(most),
        );
        // accesskit must be set up before the window is visible.
        state.init_accesskit(event_loop, &window, self.proxy.clone());

        let opened = Opened { ctx, waker: Waker(self.proxy.clone()), driver: gl.driver() };
        let app = make(&opened);
        if app.wants_controls() {
            opened.ctx.enable_accesskit();
        }
        let mut open = OpenWindow {
            app,
            painter,
            state,
            gl,
            window,
            info: ViewportInfo::default(),
            textures: egui::TexturesDelta::default(),
            numpad: Vec::new(),
            held: Modifiers::default(),
            pens: Pens::of_system(event_loop),
            title: String::new(),
            last_start: Instant::now(),
            last_shown: Instant::now(),
            last_took: Duration::ZERO,
            shown: None,
            holds: false,
        };
        open.frame(Due::Now)?;
        open.window.set_visible(true);
        open.window.request_redraw();
        self.open = Some(open);
        Ok(())
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: WindowError) {
        self.failed.get_or_insert(error);
        event_loop.exit();
    }

    fn frame(&mut self, event_loop: &ActiveEventLoop, due: Due) {
        let Some(open) = &mut self.open else { return };
        self.next = None;
        match open.frame(due) {
            Ok(close) if close => event_loop.exit(),
            Ok(_) => (),
            Err(error) => self.fail(event_loop, error),
        }
    }
}

/// Width and height of the screen that the window opens on, points; `None` if the system does not say.
fn screen_points(event_loop: &ActiveEventLoop) -> Option<egui::Vec2> {
    let screen = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next())?;
    let size = screen.size().to_logical::<f32>(screen.scale_factor());
    (size.width > 0.0 && size.height > 0.0).then(|| egui::vec2(size.width, size.height))
}

fn attributes(options: &Options, screen: Option<egui::Vec2>) -> winit::window::WindowAttributes {
    let size = |size: egui::Vec2| LogicalSize::new(size.x, size.y);
    let first = options.size.max(options.least_size);
    let [first, least] = [first, options.least_size].map(|size| on_screen(size, screen));
    let attributes = Window::default_attributes()
        .with_visible(false)
        .with_inner_size(size(first))
        .with_min_inner_size(size(least))
        .with_window_icon(icon());
    named(attributes, &options.app_id)
}

/// Reduces the size of a window to fit on the screen, with room for the system's title bar and panels.
fn on_screen(size: egui::Vec2, screen: Option<egui::Vec2>) -> egui::Vec2 {
    const FRAME: egui::Vec2 = egui::vec2(0.0, 40.0);
    match screen {
        Some(screen) => size.min(screen - FRAME),
        None => size,
    }
}

#[cfg(target_os = "linux")]
fn named(attributes: winit::window::WindowAttributes, app_id: &str) -> winit::window::WindowAttributes {
    use winit::platform::{wayland, x11};
    let attributes = wayland::WindowAttributesExtWayland::with_name(attributes, app_id, app_id);
    x11::WindowAttributesExtX11::with_name(attributes, app_id, app_id)
}

#[cfg(not(target_os = "linux"))]
fn named(attributes: winit::window::WindowAttributes, _app_id: &str) -> winit::window::WindowAttributes {
    attributes
}

impl<A: App, M: FnOnce(&Opened) -> A> ApplicationHandler<Happening> for Shell<A, M> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if let Err(error) = self.open(event_loop) {
            self.fail(event_loop, error);
        }
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            self.frame(event_loop, Due::ByTimer);
        }
    }

    fn user_event(&mut self, _event_loop: &ActiveEventLoop, happening: Happening) {
        let Some(open) = &mut self.open else { return };
        match happening {
            Happening::Wake => open.window.request_redraw(),
            Happening::Repaint { at, pass } => {
                let now = open.state.egui_ctx().cumulative_pass_nr();
                // A request from before the last pass is out of date: a later pass has run since.
                if now == pass || now == pass + 1 {
                    let least = if open.holds { HELD_PASS } else { LEAST_FRAME };
                    let at = at.max(open.last_start + least);
                    self.next = Some(self.next.map_or(at, |next| next.min(at)));
                }
            }
            Happening::Access(event) => match event.window_event {
                accesskit_winit::WindowEvent::InitialTreeRequested => {
                    open.state.egui_ctx().enable_accesskit();
                    open.window.request_redraw();
                }
                accesskit_winit::WindowEvent::ActionRequested(request) => {
                    open.state.on_accesskit_action_request(request);
                    open.window.request_redraw();
                }
                accesskit_winit::WindowEvent::AccessibilityDeactivated => {
                    open.state.egui_ctx().disable_accesskit()
                }
            },
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        if matches!(event, WindowEvent::RedrawRequested) {
            self.frame(event_loop, Due::Now);
            return;
        }
        let Some(open) = &mut self.open else { return };
        match &event {
            WindowEvent::Resized(size) => open.gl.resize([size.width, size.height]),
            WindowEvent::CloseRequested => {
                if open.app.on_close_request() {
                    event_loop.exit();
                }
                open.window.request_redraw();
                return;
            }
            WindowEvent::ModifiersChanged(held) => {
                let held = held.state();
                open.held =
                    Modifiers { ctrl: held.control_key(), shift: held.shift_key(), alt: held.alt_key() };
            }
            WindowEvent::KeyboardInput { event, .. } if !open.state.egui_ctx().text_edit_focused() => {
                if let Some(key) = numpad_key(event) {
                    open.numpad.push((key, open.held));
                    open.window.request_redraw();
                    return;
                }
            }
            _ => (),
        }
        open.pens.before(&event);
        let repaint = open.state.on_window_event(&open.window, &event).repaint;
        open.pens.after(&event, open.state.egui_input());
        if repaint {
            if open.holds && matches!(event, WindowEvent::CursorMoved { .. }) {
                let at = open.last_start + HELD_PASS;
                self.next = Some(self.next.map_or(at, |next| next.min(at)));
            } else {
                open.window.request_redraw();
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        event_loop.set_control_flow(self.next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        if let Some(mut open) = self.open.take() {
            open.textures.clear();
            if open.gl.make_current().is_ok() {
                open.painter.destroy();
            }
        }
    }
}

impl<A: App> OpenWindow<A> {
    /// Runs the passes that are due and shows the last. Returns whether the app wants to close.
    fn frame(&mut self, due: Due) -> Result<bool, WindowError> {
        self.last_start = Instant::now();
        let broken = |reason| WindowError::Broken(format!("OpenGL: {reason}"));
        self.gl.make_current().map_err(broken)?;
        let mut close = false;
        let mut hold = true;
        let mut shapes = Vec::new();
        let mut scale = 1.0;
        egui_winit::update_viewport_info(&mut self.info, self.state.egui_ctx(), &self.window, false);
        self.state.egui_input_mut().viewports.insert(ViewportId::ROOT, self.info.clone());
        let input = self.state.take_egui_input(&self.window);
        let ctx = self.state.egui_ctx().clone();
        keep_numpad(&ctx, std::mem::take(&mut self.numpad));
        let mut pressures = self.pens.take();
        for pass in one_thing_each(input) {
            keep_pressures(&ctx, &pass, &mut pressures);
            let (app, painter, last) = (&mut self.app, &mut self.painter, self.last_took);
            let mut asks = Asks::default();
            let output = ctx.run_ui(pass, |ui| app.ui(ui, &mut Frame { painter, last, asks: &mut asks }));
            close |= asks.close;
            hold &= asks.hold;
            self.textures.append(output.textures_delta);
            if let Some(controls) = &output.platform_output.accesskit_update {
                self.app.controls(controls);
            }
            self.state.handle_platform_output(&self.window, output.platform_output);
            for (_, viewport) in output.viewport_output {
                let mut asked = Vec::new();
                egui_winit::process_viewport_commands(
                    &ctx,
                    &mut self.info,
                    viewport.commands,
                    &self.window,
                    &mut asked,
                );
            }
            shapes = output.shapes;
            scale = output.pixels_per_point;
        }
        let title = self.app.title();
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
        let held = self.last_shown.elapsed();
        if hold && held < MOST_HELD {
            self.holds = true;
            ctx.request_repaint_after(MOST_HELD - held);
            return Ok(close);
        }
        self.holds = false;
        let size = self.window.inner_size();
        let page = Page { shapes: shapes.clone(), scale, size: size.into() };
        let is_shown = self.textures.is_empty() && self.shown.as_ref() == Some(&page);
        // When only a timer ran out and nothing looks different, nothing is shown.
        if due == Due::ByTimer && is_shown {
            return Ok(close);
        }
        self.shown = Some(page);
        self.paint(&ctx.tessellate(shapes, scale), scale);
        self.gl.show().map_err(broken)?;
        self.last_shown = Instant::now();
        self.last_took = self.last_start.elapsed();
        Ok(close)
    }

    fn paint(&mut self, primitives: &[egui::ClippedPrimitive], scale: f32) {
        let size: [u32; 2] = self.window.inner_size().into();
        self.gl.before_egui();
        let textures = std::mem::take(&mut self.textures);
        if size.contains(&0) {
            self.textures = textures;
            return;
        }
        let mut textures = textures;
        self.painter.clear(size, [0.0, 0.0, 0.0, 1.0]);
        self.painter.paint_and_update_textures(size, scale, primitives, &mut textures);
    }
}

#[cfg(test)]
mod tests {
    use egui::vec2;

    use super::*;

    #[test]
    fn a_window_is_never_larger_than_its_screen() {
        let usual = Options::default();
        assert_eq!(on_screen(usual.size, Some(vec2(3840.0, 2160.0))), usual.size);
        // 1920 x 1080 pixels at a scale of 2, and a small screen.
        assert_eq!(on_screen(usual.size, Some(vec2(960.0, 540.0))), vec2(960.0, 500.0));
        assert_eq!(on_screen(usual.least_size, Some(vec2(640.0, 480.0))), vec2(640.0, 440.0));
        assert_eq!(on_screen(usual.size, Some(usual.size)), vec2(1280.0, 760.0));
        assert_eq!(on_screen(usual.size, None), usual.size);
    }
}
