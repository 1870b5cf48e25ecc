//! Tests of the viewport on a page of its own: pointer events, what chips ask for, and how overlays look.

use crate::headless;
use egui::{Event, Modifiers, PointerButton, Rect, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions};
use glam::{DVec2, DVec3};
use impasto_editor::panels::Ask;
use impasto_editor::theme::{self, Theme};
use impasto_editor::viewport::overlay::{CurvePart, DirectionInk, DirectionMark, GuideCurve};
use impasto_editor::viewport::{
    Badge, CameraChoice, Framing, Layout, Marks, Now, Pictures, ViewportEvents, ViewportInput, viewport,
};
use impasto_editor::window::keep_pressures;
use impasto_editor_model::Session;
use impasto_editor_model::camera_rig::ZOOM_PER_STEP;
use impasto_editor_model::editor::{PointerEvent, PointerKind};
use impasto_editor_model::keymap::{Action, Button, CommandId, Keymap};
use impasto_editor_model::session::{Mode, Overlays, Shading};
use impasto_editor_model::tools::{Needle, Ring};
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

const SCENE: (u32, u32) = (1280, 720);

/// A page with nothing but a viewport.
struct Page {
    session: Session,
    keymap: Keymap,
    badge: Badge,
    compare: bool,
    drawn: Drawn,
    /// Pointer events since the test last looked.
    pointer: Vec<PointerEvent>,
    last: ViewportEvents,
}

#[derive(Default)]
struct Drawn {
    direction_lines: Vec<DirectionMark>,
    guides: Vec<GuideCurve>,
    rings: Vec<Ring>,
    needle: Option<Needle>,
    tag: Option<&'static str>,
}

fn camera() -> CameraPose {
    CameraPose {
        eye: DVec3::new(1.0, 1.5, 4.0),
        target: DVec3::ZERO,
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 100.0 },
    }
}

impl Page {
    fn new(badge: Badge) -> Self {
        Self {
            session: Session::default(),
            keymap: Keymap::default(),
            badge,
            compare: false,
            drawn: Drawn::default(),
            pointer: Vec::new(),
            last: ViewportEvents::default(),
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui) {
        let area = ui.ctx().content_rect();
        let camera = camera();
        let layout =
            if self.compare { Layout::compare(area, SCENE, 1.0) } else { Layout::single(area, SCENE, 1.0) };
        let drawn = &self.drawn;
        let marks = Marks {
            direction_lines: &drawn.direction_lines,
            guides: &drawn.guides,
            rings: &drawn.rings,
            needle: drawn.needle,
            radius_px: 46.0,
            tag: drawn.tag,
            hides_pointer: !drawn.rings.is_empty(),
            ..Marks::default()
        };
        let now = Now { camera: &camera, frame: 37.0, note: "apple turned -86°", marks: &marks };
        let input = ViewportInput {
            pictures: &Pictures::default(),
            session: &self.session,
            keymap: &self.keymap,
            camera: &camera,
            through_shot: !matches!(self.badge, Badge::Free(_)),
            marks: &marks,
            now: self.compare.then_some(now),
            badge: self.badge,
            value: "Paint, comb, shot camera, frame 0, reference",
            under_cursor: "skin, 10 degrees, trust 0.97",
            empty: false,
            trouble: None,
        };
        let events = viewport(ui, &layout, &input);
        self.pointer.extend(&events.pointer);
        let did = !events.asks.is_empty() || events.look.is_some() || events.recapture;
        if did || events.orbit_px != DVec2::ZERO {
            self.last = events;
        }
    }
}

fn harness(page: Page) -> Harness<'static, Page> {
    // This runs more than one pass. Chips need that, because they know their size only from the second pass on.
    headless::harness(vec2(600.0, 420.0), Theme::Dark, page, |ui, page| page.ui(ui))
}

fn button(at: egui::Pos2, button: PointerButton, pressed: bool) -> Event {
    Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE }
}

#[test]
fn a_drag_comes_back_whole_and_in_order() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    let places: Vec<egui::Pos2> = (0..6).map(|step| pos2(200.0 + 7.0 * step as f32, 200.0)).collect();
    harness.event(Event::PointerMoved(places[0]));
    harness.event(button(places[0], PointerButton::Primary, true));
    for &at in &places[1..] {
        harness.event(Event::PointerMoved(at));
    }
    // The drag goes on outside the window while the button is held.
    harness.event(Event::PointerMoved(pos2(-30.0, 200.0)));
    harness.event(button(pos2(-30.0, 200.0), PointerButton::Primary, false));
    harness.run();
    let told: Vec<(PointerKind, f64)> =
        harness.state().pointer.iter().map(|event| (event.kind, event.at_px.x)).collect();
    let mut expected = vec![(PointerKind::Move, 200.0), (PointerKind::Press(Button::Left), 200.0)];
    expected.extend(places[1..].iter().map(|at| (PointerKind::Move, f64::from(at.x))));
    expected.extend([(PointerKind::Move, -30.0), (PointerKind::Release(Button::Left), -30.0)]);
    // The pointer is outside the picture now.
    expected.push((PointerKind::Leave, -30.0));
    assert_eq!(told, expected);
}

#[test]
fn the_pressure_of_a_pen_comes_with_each_event() {
    let ctx = egui::Context::default();
    theme::apply(&ctx, Theme::Dark, 1.0);
    let mut page = Page::new(Badge::Reference(0.0));
    let mut pass = |events: Vec<Event>, mut pressures: Vec<f64>| {
        let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 420.0)));
        let input = egui::RawInput { events, screen_rect, ..egui::RawInput::default() };
        keep_pressures(&ctx, &input, &mut pressures);
        ctx.run_ui(input, |ui| page.ui(ui)).drop_without_applying_deltas();
        std::mem::take(&mut page.pointer)
    };
    let at = |x: f32| pos2(x, 200.0);
    // Chips know their size from the second pass on.
    for _ in 0..2 {
        pass(Vec::new(), Vec::new());
    }
    let drag = || {
        vec![
            Event::PointerMoved(at(200.0)),
            button(at(200.0), PointerButton::Primary, true),
            // This is no event of the pointer, so it takes none of the pressures.
            Event::Text("x".to_owned()),
            Event::PointerMoved(at(210.0)),
            Event::PointerMoved(at(220.0)),
            button(at(220.0), PointerButton::Primary, false),
        ]
    };
    let told = pass(drag(), vec![0.0, 0.25, 0.5, 1.0, 0.75]);
    assert_eq!(told.iter().map(|event| event.pressure).collect::<Vec<_>>(), [0.0, 0.25, 0.5, 1.0, 0.75]);
    let told = pass(drag(), Vec::new());
    assert!(told.len() == 5 && told.iter().all(|event| event.pressure == 1.0), "a mouse presses fully");
}

#[test]
fn buttons_the_wheel_and_leaving_are_told() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    let at = pos2(300.0, 200.0);
    harness.event(Event::PointerMoved(at));
    for which in [PointerButton::Middle, PointerButton::Secondary] {
        harness.event(button(at, which, true));
        harness.event(button(at, which, false));
    }
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: vec2(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::SHIFT,
    });
    harness.event(Event::Zoom((1.0 / ZOOM_PER_STEP.powi(2)) as f32));
    harness.event(Event::PointerGone);
    harness.run();
    let told: Vec<PointerKind> = harness.state().pointer.iter().map(|event| event.kind).collect();
    let pair = |button| [PointerKind::Press(button), PointerKind::Release(button)];
    let mut expected = vec![PointerKind::Move];
    expected.extend(pair(Button::Middle));
    expected.extend(pair(Button::Right));
    expected.push(PointerKind::Wheel(2.0));
    assert_eq!(told[..6], expected);
    let [PointerKind::Wheel(pinched), PointerKind::Leave] = told[6..] else { panic!("{told:?}") };
    assert!((pinched - 2.0).abs() < 1e-6, "spreading two fingers is turning the wheel: {pinched}");
    assert!(harness.state().pointer[5].held.shift);
}

#[test]
fn losing_the_window_ends_a_drag() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    let at = pos2(300.0, 200.0);
    harness.event(Event::PointerMoved(at));
    harness.event(button(at, PointerButton::Primary, true));
    harness.event(Event::WindowFocused(false));
    harness.run();
    let last = harness.state().pointer.last().expect("something was told");
    assert_eq!(last.kind, PointerKind::Release(Button::Left));
}

#[test]
fn a_press_on_a_chip_is_none_on_the_picture() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    harness.get_by_role_and_label(Role::Button, "Trust").click();
    harness.run();
    let pressed = |event: &PointerEvent| matches!(event.kind, PointerKind::Press(_));
    assert!(!harness.state().pointer.iter().any(pressed), "{:?}", harness.state().pointer);
    let Some(Ask::Session(session)) = harness.state().last.asks.first() else {
        panic!("the overlays are asked for")
    };
    assert_eq!(session.overlays, Overlays { trust: true, ..Overlays::default() });
}

#[test]
fn a_press_beside_an_open_menu_only_closes_it() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    harness.get_by_role_and_label(Role::ComboBox, "Shading").click();
    harness.run();
    assert!(harness.query_by_label("Shaded").is_some());
    harness.state_mut().pointer.clear();
    let at = pos2(300.0, 380.0);
    let pressed = |page: &Page| {
        let pressed = page.pointer.iter().filter(|event| matches!(event.kind, PointerKind::Press(_)));
        pressed.count()
    };
    harness.event(Event::PointerMoved(at));
    for is_down in [true, false] {
        harness.event(button(at, PointerButton::Primary, is_down));
        harness.run();
    }
    assert!(harness.query_by_label("Shaded").is_none(), "the menu is still open");
    let told = &harness.state().pointer;
    assert!(told.iter().all(|event| event.kind == PointerKind::Move), "no drag begins: {told:?}");
    for is_down in [true, false] {
        harness.event(button(at, PointerButton::Primary, is_down));
        harness.run();
    }
    assert_eq!(pressed(harness.state()), 1, "the next press is one on the picture");
}

#[test]
fn chips_ask_for_what_they_say() {
    let mut harness = harness(Page::new(Badge::Reference(0.0)));
    harness.get_by_role_and_label(Role::Button, "Recapture reference").click();
    harness.run();
    assert!(harness.state().last.recapture);
    harness.get_by_role_and_label(Role::Button, "Compare").click();
    harness.run();
    assert!(matches!(harness.state().last.asks[..], [Ask::Act(Action::Compare)]));
    harness.get_by_role_and_label(Role::ComboBox, "Shading").click();
    harness.run();
    harness.get_by_label("Shaded").click();
    harness.run();
    let Some(Ask::Session(session)) = harness.state().last.asks.first() else {
        panic!("the shading is asked for")
    };
    assert_eq!(session.shading, Shading::Shaded);
    harness.get_by_role_and_label(Role::ComboBox, "View").click();
    harness.run();
    harness.get_by_label("Free view").click();
    harness.run();
    assert_eq!(harness.state().last.look, Some(CameraChoice::Free));
    harness.state_mut().badge = Badge::Free(0.0);
    harness.run();
    harness.get_by_role_and_label(Role::Button, "To the shot").click();
    harness.run();
    assert_eq!(harness.state().last.look, Some(CameraChoice::Shot));
}

#[test]
fn tooltips_of_chips_name_the_keys_that_are_in_use() {
    let mut page = Page::new(Badge::Reference(0.0));
    page.session.mode = Mode::Paint;
    for (command, keys) in
        [("Directions", "Ctrl 7"), ("Trust", "Ctrl 8"), ("Compare with the reference", "Ctrl 9")]
    {
        let id = CommandId::named(command).expect("there is such a command");
        page.keymap = page.keymap.with(id, vec![keys.parse().expect("a key")]);
    }
    for (name, keys) in [("Directions", "Ctrl 7"), ("Trust", "Ctrl 8"), ("Compare", "Ctrl 9")] {
        let keymap = page.keymap.clone();
        let session = page.session.clone();
        let mut harness = harness(Page { session, keymap, ..Page::new(Badge::Reference(0.0)) });
        let at = harness.get_by_role_and_label(Role::Button, name).rect().center();
        harness.hover_at(at);
        // A tooltip comes up once the pointer has rested for half a second.
        harness.run_steps(12);
        assert!(harness.query_by_label(keys).is_some(), "{name} does not name {keys}");
    }
}

#[test]
fn the_viewport_says_what_it_shows() {
    let harness = harness(Page::new(Badge::Turned { frame: 37.0, reference: 0.0 }));
    let canvas = harness.get_by_role_and_label(Role::Canvas, "Viewport");
    let value = canvas.accesskit_node().value();
    assert_eq!(value.as_deref(), Some("Paint, comb, shot camera, frame 0, reference"));
    let under = harness.get_by_label("Under the cursor").accesskit_node().value();
    assert_eq!(under.as_deref(), Some("skin, 10 degrees, trust 0.97"));
    for name in ["Directions", "Trust", "Regions overlay", "Grid", "Compare", "Compare with the reference"] {
        harness.get_by_role_and_label(Role::Button, name);
    }
    harness.get_by_role_and_label(Role::Canvas, "Axis ball");
    let badge = harness.get_by_label("Reference").accesskit_node().value();
    assert_eq!(badge.as_deref(), Some("Frame 37, turned from reference 0"));
}

/// Marks on a slope, with no picture under them.
fn marks() -> Drawn {
    let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 420.0));
    let view = Framing::new(area, SCENE, 1.0).view(&camera());
    let (right, up) = DVec3::new(0.3, 0.7, 0.6).normalize().any_orthonormal_pair();
    let circle = |centre: DVec3, radius: f64| -> Vec<DVec2> {
        let at = |piece: i32| {
            let way = DVec2::from_angle(f64::from(piece) * std::f64::consts::TAU / 48.0) * radius;
            view.project(centre + right * way.x + up * way.y)
        };
        (0..=48).filter_map(at).collect()
    };
    let ring = |centre: DVec3, mirrored| Ring {
        points_px: circle(centre, 0.5),
        half_px: circle(centre, 0.27),
        at_px: view.project(centre).expect("it is before the eye"),
        hollow: false,
        mirrored,
    };
    let own = ring(DVec3::new(0.2, 0.1, 0.0), false);
    let at_px = own.at_px;
    let inks = [DirectionInk::Plain, DirectionInk::Region(egui::Color32::from_rgb(214, 80, 70))];
    let inks = inks.into_iter().chain([0.97, 0.8, 0.4].map(DirectionInk::Trust));
    let direction_lines = inks.enumerate().flat_map(|(row, ink)| {
        (0..6).map(move |column| DirectionMark {
            at_px: DVec2::new(60.0 + 22.0 * f64::from(column), 120.0 + 22.0 * row as f64),
            angle_rad: 0.5 * column as f32,
            ink,
            faint: column > 3,
        })
    });
    let line: Vec<DVec2> = (0..24)
        .map(|step| DVec2::new(470.0 + f64::from(step).sin() * 3.0, 120.0 + 8.0 * f64::from(step)))
        .collect();
    let guide = GuideCurve {
        handles_px: vec![(0, line[0]), (1, line[8]), (2, line[16])],
        runs_px: vec![line],
        end_shows: true,
        selected: true,
        lit: Some(CurvePart::Handle(1)),
        adrift_px: vec![DVec2::new(520.0, 200.0)],
    };
    let hollow = Ring { hollow: true, half_px: Vec::new(), ..ring(DVec3::new(-0.6, -0.5, 0.4), true) };
    Drawn {
        direction_lines: direction_lines.collect(),
        guides: vec![guide],
        rings: vec![own, ring(DVec3::new(-0.9, 0.1, 0.0), true), hollow],
        needle: Some(Needle { at_px, along: DVec2::new(0.985, -0.174), headed: true }),
        tag: Some("10°  trust 0.97"),
    }
}

/// A tolerance for drivers that round colours differently. A misplaced mark exceeds it by far.
fn options() -> SnapshotOptions {
    SnapshotOptions::new().threshold(0.6)
}

#[test]
fn marks_and_chips_look_as_they_did() {
    let mut harness = harness(Page { drawn: marks(), ..Page::new(Badge::Reference(0.0)) });
    harness.run();
    harness.snapshot_options("viewport_dark", &options());
}

#[test]
fn a_comparison_looks_as_it_did() {
    let mut page = Page::new(Badge::Turned { frame: 37.0, reference: 0.0 });
    page.compare = true;
    page.session.overlays.trust = true;
    let mut harness = harness(page);
    harness.run();
    harness.snapshot_options("compare_dark", &options());
}
