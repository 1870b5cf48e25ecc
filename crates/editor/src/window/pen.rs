//! How hard a pen presses. egui has no field for that, so the pressure of each pointer event goes to the page beside
//! egui's input, in the same order.
//!
//! ```text
//! winit: Touch with a force        (where the system's touches have one) ─┐
//! winit: AxisMotion ─▶ which axis? ─▶ XInput2: "Abs Pressure" (X11)  ─────┴─▶ one number per pointer event ─▶ viewport
//! ```

use egui::{Context, Event, Id, RawInput};
use winit::event::{ElementState, TouchPhase, WindowEvent};

#[cfg(target_os = "linux")]
mod x11;

/// The number of the first axis that is not part of a pen's position: the axes before it are X and Y.
const FIRST_OTHER_AXIS: u32 = 2;

/// The axis of a pointing device that reports pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureAxis {
    /// Its number among the axes of the device.
    pub number: u32,
    /// Its least and its greatest value.
    pub range: [f64; 2],
    /// Its value now.
    pub value: f64,
}

/// Follows the pressure of pens from event to event.
pub struct Pens {
    /// Finds the pressure axis of the device that moves the pointer now; `None` if it has none.
    find: Box<dyn FnMut() -> Option<PressureAxis>>,
    /// Whether any device has reported an axis other than X and Y. Until then `find` is not called.
    has_axes: bool,
    /// Whether a device has reported an axis other than X and Y since the last press.
    has_told: bool,
    axis: Option<PressureAxis>,
    pressure: f64,
    /// The greatest pressure since the press; `None` while nothing is pressed.
    greatest: Option<f64>,
    /// One pressure for each pointer event since the last pass.
    samples: Vec<f64>,
    /// Whether axes that are reported now belong to the last movement: X11 reports a movement first, then its axes.
    moved: bool,
}

impl Pens {
    /// Follows pens; `find` finds the pressure axis of the device that moves the pointer now.
    pub fn new(find: impl FnMut() -> Option<PressureAxis> + 'static) -> Self {
        Self {
            find: Box::new(find),
            has_axes: false,
            has_told: false,
            greatest: None,
            axis: None,
            pressure: 1.0,
            samples: Vec::new(),
            moved: false,
        }
    }

    /// Follows the pens of an X server, if the window is on one.
    #[cfg(target_os = "linux")]
    pub(super) fn of_system(event_loop: &winit::event_loop::ActiveEventLoop) -> Self {
        use winit::platform::x11::ActiveEventLoopExtX11 as _;
        if !event_loop.is_x11() {
            return Self::new(|| None);
        }
        let mut server = None;
        // Connects on the first call, so that nothing is opened where there is no pen.
        Self::new(move || server.get_or_insert_with(x11::Server::open).as_ref()?.pressure_axis())
    }

    /// On systems other than Linux, pens come as touches, if the system reports their pressure at all.
    #[cfg(not(target_os = "linux"))]
    pub(super) fn of_system(_event_loop: &winit::event_loop::ActiveEventLoop) -> Self {
        Self::new(|| None)
    }

    /// Takes an event of the window, before egui does.
    pub fn before(&mut self, event: &WindowEvent) {
        match event {
            WindowEvent::Touch(touch) => self.pressure = touch.force.map_or(1.0, |force| force.normalized()),
            WindowEvent::AxisMotion { axis, value, .. } if *axis >= FIRST_OTHER_AXIS => {
                self.has_told = true;
                if !std::mem::replace(&mut self.has_axes, true) {
                    self.look();
                }
                if let Some(pressure) = self.axis.filter(|known| known.number == *axis) {
                    self.pressure = pressure.share(*value);
                    if let Some(last) = self.samples.last_mut().filter(|_| self.moved) {
                        *last = self.pressure;
                    }
                }
            }
            // A mouse may have taken the place of the pen, or the other way round.
            WindowEvent::MouseInput { state: ElementState::Pressed, .. } if self.has_axes => {
                match std::mem::take(&mut self.has_told) {
                    true => self.look(),
                    // It is a mouse: a pen would have reported axes, since its pressure changes all the time.
                    false => self.pressure = 1.0,
                }
            }
            _ => {}
        }
        match event {
            WindowEvent::MouseInput { state: ElementState::Pressed, .. } => {
                self.greatest = Some(self.pressure);
            }
            WindowEvent::Touch(touch) if touch.phase == TouchPhase::Started => {
                self.greatest = Some(self.pressure);
            }
            _ => self.greatest = self.greatest.map(|greatest| greatest.max(self.pressure)),
        }
        self.moved = match event {
            WindowEvent::CursorMoved { .. } => true,
            WindowEvent::AxisMotion { .. } => self.moved,
            _ => false,
        };
    }

    /// Notes the pressure of the pointer events that egui made of the window's event. `input` is all of egui's input
    /// since the last pass.
    pub fn after(&mut self, event: &WindowEvent, input: &RawInput) {
        let count = input.events.iter().filter(|event| is_of_pointer(event)).count();
        let lifts = matches!(event, WindowEvent::Touch(touch) if ends(touch.phase));
        let releases = matches!(event, WindowEvent::MouseInput { state: ElementState::Released, .. });
        // A pen presses less and less before it is lifted, so a release gets the greatest pressure since the press.
        let greatest = if lifts || releases { self.greatest.take() } else { None };
        self.samples.resize(count.max(self.samples.len()), greatest.unwrap_or(self.pressure));
        if lifts {
            self.pressure = 1.0;
        }
    }

    /// The pressures of all pointer events since the last call.
    pub fn take(&mut self) -> Vec<f64> {
        self.moved = false;
        std::mem::take(&mut self.samples)
    }

    fn look(&mut self) {
        self.axis = (self.find)();
        self.pressure = self.axis.map_or(1.0, |axis| axis.share(axis.value));
    }
}

impl std::fmt::Debug for Pens {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Pens").field("pressure", &self.pressure).finish_non_exhaustive()
    }
}

impl PressureAxis {
    /// A value as a share of the range.
    fn share(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let share = (value - low) / (high - low);
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 }
    }
}

fn ends(phase: TouchPhase) -> bool {
    matches!(phase, TouchPhase::Ended | TouchPhase::Cancelled)
}

fn is_of_pointer(event: &Event) -> bool {
    matches!(event, Event::PointerMoved(_) | Event::PointerButton { .. })
}

/// Takes the pressures of a pass's pointer events from the front of `pressures`, and keeps them for the page.
pub fn keep_pressures(ctx: &Context, pass: &RawInput, pressures: &mut Vec<f64>) {
    let count = pass.events.iter().filter(|event| is_of_pointer(event)).count().min(pressures.len());
    let own: Vec<f64> = pressures.drain(..count).collect();
    ctx.data_mut(|data| data.insert_temp(id(), own));
}

/// How hard a pen pressed at each pointer event (move or button) of this pass, 0..=1, in their order. Events beyond the
/// end of the list have pressure 1.
pub fn pressures(ctx: &Context) -> Vec<f64> {
    ctx.data(|data| data.get_temp(id())).unwrap_or_default()
}

fn id() -> Id {
    Id::unique("pressure of pens")
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::rc::Rc;

    use egui::pos2;
    use winit::dpi::PhysicalPosition;
    use winit::event::{DeviceId, Force, MouseButton, Touch};

    use super::*;

    fn moved() -> WindowEvent {
        WindowEvent::CursorMoved { device_id: DeviceId::dummy(), position: PhysicalPosition::new(1.0, 1.0) }
    }

    fn axis(axis: u32, value: f64) -> WindowEvent {
        WindowEvent::AxisMotion { device_id: DeviceId::dummy(), axis, value }
    }

    fn button(state: ElementState) -> WindowEvent {
        WindowEvent::MouseInput { device_id: DeviceId::dummy(), state, button: MouseButton::Left }
    }

    fn pressed() -> WindowEvent {
        button(ElementState::Pressed)
    }

    fn released() -> WindowEvent {
        button(ElementState::Released)
    }

    fn touch(phase: TouchPhase, force: Option<Force>) -> WindowEvent {
        let location = PhysicalPosition::new(1.0, 1.0);
        WindowEvent::Touch(Touch { device_id: DeviceId::dummy(), phase, location, force, id: 1 })
    }

    /// Gives `pens` these events of the window. Returns the pressures of the pointer events that egui makes of them.
    fn told(pens: &mut Pens, events: &[WindowEvent]) -> Vec<f64> {
        let mut input = RawInput::default();
        for event in events {
            pens.before(event);
            match event {
                WindowEvent::CursorMoved { .. } | WindowEvent::Touch(_) => {
                    input.events.push(Event::PointerMoved(pos2(1.0, 1.0)));
                }
                WindowEvent::MouseInput { .. } => input.events.push(Event::PointerButton {
                    pos: pos2(1.0, 1.0),
                    button: egui::PointerButton::Primary,
                    pressed: true,
                    modifiers: egui::Modifiers::NONE,
                }),
                _ => {}
            }
            pens.after(event, &input);
        }
        pens.take()
    }

    fn tablet(value: f64) -> Option<PressureAxis> {
        Some(PressureAxis { number: 2, range: [0.0, 2000.0], value })
    }

    #[test]
    fn a_mouse_presses_fully_and_the_system_is_not_asked() {
        let asked = Rc::new(Cell::new(0));
        let count = Rc::clone(&asked);
        let mut pens = Pens::new(move || {
            count.set(count.get() + 1);
            None
        });
        let events = [moved(), axis(0, 17.0), axis(1, 3.0), pressed(), moved(), axis(0, 18.0)];
        assert_eq!(told(&mut pens, &events), [1.0; 3]);
        assert_eq!(asked.get(), 0);
    }

    #[test]
    fn the_axes_of_a_movement_come_after_it() {
        let mut pens = Pens::new(|| tablet(500.0));
        let events = [
            moved(),
            axis(0, 9.0),
            axis(2, 0.0),
            pressed(),
            moved(),
            axis(2, 1000.0),
            moved(),
            axis(0, 10.0),
            axis(2, 2000.0),
            axis(3, 77.0),
        ];
        // The press has the pressure that the tablet reports when it is asked: 500 of 2000.
        assert_eq!(told(&mut pens, &events), [0.0, 0.25, 0.5, 1.0]);
        // Pressure that changes without a movement belongs to the next one.
        assert_eq!(told(&mut pens, &[axis(2, 400.0), moved()]), [0.2]);
    }

    #[test]
    fn a_mouse_after_a_pen_presses_fully() {
        let is_pen = Rc::new(Cell::new(true));
        let pen = Rc::clone(&is_pen);
        let mut pens = Pens::new(move || tablet(600.0).filter(|_| pen.get()));
        assert_eq!(told(&mut pens, &[moved(), axis(2, 0.0), pressed()]), [0.0, 0.3]);
        is_pen.set(false);
        assert_eq!(told(&mut pens, &[pressed(), moved()]), [1.0, 1.0]);
    }

    #[test]
    fn the_system_is_asked_only_after_a_pen_told_something() {
        let asked = Rc::new(Cell::new(0));
        let count = Rc::clone(&asked);
        let mut pens = Pens::new(move || {
            count.set(count.get() + 1);
            tablet(600.0)
        });
        assert_eq!(told(&mut pens, &[moved(), axis(2, 0.0), pressed(), released()]), [0.0, 0.3, 0.3]);
        assert_eq!(asked.get(), 2);
        let clicks = [pressed(), released(), moved(), axis(0, 4.0), pressed(), released()];
        assert_eq!(told(&mut pens, &clicks), [1.0; 5], "a mouse must press fully");
        assert_eq!(asked.get(), 2);
        assert_eq!(told(&mut pens, &[axis(2, 100.0), pressed()]), [0.3]);
        assert_eq!(asked.get(), 3);
    }

    #[test]
    fn the_greatest_pressure_goes_with_the_release() {
        let mut pens = Pens::new(|| tablet(20.0));
        // The pen is set down, pressed and lifted in one place.
        let events = [moved(), axis(2, 0.0), pressed(), axis(2, 1200.0), axis(2, 40.0), released()];
        assert_eq!(told(&mut pens, &events), [0.0, 0.01, 0.6]);
        // To steady the path, the pointer pulls its tip by a string. While the pointer stays within the length of the
        // string, the path takes the greatest pressure.
        assert!((felt(0.2, &[0.01, 0.6]) - 0.6).abs() < 1e-9);
        let events = [axis(2, 30.0), pressed(), moved(), axis(2, 1600.0), axis(2, 10.0), released()];
        let told = told(&mut pens, &events);
        assert_eq!(told, [0.01, 0.005, 0.8]);
        assert!((felt(0.2, &told) - 0.8).abs() < 1e-9);
    }

    /// The mean pressure of a path that trembles in one place: a press, moves, and a release.
    fn felt(steady: f64, pressures: &[f64]) -> f64 {
        use glam::{DAffine3, DVec2, DVec3};
        use impasto_editor_model::path::{Faces, PathSettings, SurfacePath};
        use impasto_editor_model::picking::{Hit, View};
        use impasto_scene::document::Lens;
        use impasto_scene::motion::CameraPose;
        let hit = Hit {
            object: 0,
            triangle: 0,
            barycentric: [1.0, 0.0, 0.0],
            position_in_model: DVec3::ZERO,
            normal_in_model: DVec3::Z,
            face_normal_in_model: DVec3::Z,
            position_in_world: DVec3::ZERO,
            distance: 10.0,
            front: true,
            flipped: false,
        };
        let camera = CameraPose {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            roll_rad: 0.0,
            shift: DVec2::ZERO,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.05, far: 100.0 },
        };
        let view = View { camera, size_px: DVec2::new(640.0, 360.0) };
        let settings = PathSettings { radius_px: 10.0, steady, faces: Faces::Front };
        let at = DVec2::new(100.0, 100.0);
        let path = SurfacePath::press(at, &hit, &view, DAffine3::IDENTITY, &settings);
        let mut path = path.pressed(pressures[0]);
        let (last, moves) = pressures[1..].split_last().expect("a release");
        for (step, pressure) in moves.iter().enumerate() {
            path.press_by(*pressure);
            path.move_to(at + DVec2::new(step as f64 + 1.0, 0.0), &mut |_| Some(hit));
        }
        path.lifted(*last).finished(&mut |_| Some(hit)).mean_pressure()
    }

    #[test]
    fn touches_with_a_force_are_pens() {
        let mut pens = Pens::new(|| None);
        let half = Some(Force::Normalized(0.5));
        let events = [touch(TouchPhase::Started, half), touch(TouchPhase::Moved, half)];
        assert_eq!(told(&mut pens, &events), [0.5, 0.5]);
        let events = [touch(TouchPhase::Ended, half), touch(TouchPhase::Started, None), moved()];
        assert_eq!(told(&mut pens, &events), [0.5, 1.0, 1.0]);
    }

    #[test]
    fn an_axis_without_a_range_is_no_pressure() {
        let axis = PressureAxis { number: 2, range: [0.0, 0.0], value: 0.0 };
        assert_eq!(axis.share(0.0), 1.0);
        assert_eq!(axis.share(f64::NAN), 1.0);
        assert_eq!(PressureAxis { range: [-1.0, 1.0], ..axis }.share(9.0), 1.0);
    }

    #[test]
    fn each_pass_gets_the_pressures_of_its_own_events() {
        let ctx = Context::default();
        let moves = |count: usize| RawInput {
            events: vec![Event::PointerMoved(pos2(0.0, 0.0)); count],
            ..RawInput::default()
        };
        let mut left = vec![0.1, 0.2, 0.3];
        keep_pressures(&ctx, &moves(2), &mut left);
        assert_eq!(pressures(&ctx), [0.1, 0.2]);
        keep_pressures(&ctx, &moves(2), &mut left);
        assert_eq!(pressures(&ctx), [0.3]);
        keep_pressures(&ctx, &moves(0), &mut left);
        assert!(pressures(&ctx).is_empty());
    }
}
