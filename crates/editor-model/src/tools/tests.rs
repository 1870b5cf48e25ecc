//! The test scene for the tools of Paint (a ball and a plate), and pointer events for it.

use std::fmt::Write;
use std::sync::{Arc, OnceLock};

use impasto_core::bending::CarriedPlace;
use impasto_painting::BodyShape;
use impasto_painting::frame::BodySurface;
use impasto_painting::prepare;
use impasto_scene::document::Guide;

use super::*;
use crate::command::Edit;
use crate::document::Document;
use crate::session::FillKind;

mod amounts;
mod clicks;
mod curves;
mod pressure;
mod strokes;
mod touches;

const SIZE_PX: DVec2 = DVec2::new(640.0, 360.0);
const NONE: Modifiers = Modifiers { ctrl: false, shift: false, alt: false };
const CTRL: Modifiers = Modifiers { ctrl: true, ..NONE };
const SHIFT: Modifiers = Modifiers { shift: true, ..NONE };
const ALT: Modifiers = Modifiers { alt: true, ..NONE };

/// A unit ball of two groups, `lower` and, above y = 0.5, `upper`.
fn ball_obj() -> String {
    let (columns, rows) = (48, 24);
    let mut text = String::new();
    for row in 0..=rows {
        for column in 0..columns {
            let (sin, cos) = (std::f64::consts::PI * f64::from(row) / f64::from(rows)).sin_cos();
            let (x, z) = (std::f64::consts::TAU * f64::from(column) / f64::from(columns)).sin_cos();
            writeln!(text, "v {} {cos} {}", x * sin, z * sin).unwrap();
            writeln!(text, "vn {} {cos} {}", x * sin, z * sin).unwrap();
        }
    }
    for row in 0..rows {
        let name = if row < rows / 3 { "upper" } else { "lower" };
        writeln!(text, "g {name}\nusemtl {name}_paint").unwrap();
        for column in 0..columns {
            let at = |row: i32, column: i32| row * columns + column % columns + 1;
            let corners =
                [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            let corner = |index: i32| format!("{index}//{index}");
            let corners: Vec<String> = corners.into_iter().map(corner).collect();
            writeln!(text, "f {}", corners.join(" ")).unwrap();
        }
    }
    text
}

const PLATE_OBJ: &str = "v 1.2 -0.5 0\nv 2 -0.5 0\nv 2 0.5 0\nv 1.2 0.5 0\nf 1 2 3 4\n";

const SCENE: &str = r#"(
    version: 1,
    size: (640, 360),
    camera: (lens: Perspective(fov_y_deg: 35), keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]),
    objects: [
        (name: "ball", mesh: "ball.obj", particles: 60),
        (name: "plate", mesh: "plate.obj", particles: 20),
    ],
    regions: [
        (name: "skin", on: Object("ball"), direction: Angle(0)),
        (name: "lid", on: Group("ball", "upper"), direction: Angle(0)),
    ],
)"#;

struct World {
    document: Document,
    picker: Picker,
    poses: Vec<DAffine3>,
    view: View,
    options: ToolOptions,
    hand: Hand,
    secs: f64,
    pressure: f64,
    painted: Stub,
    _folder: tempfile::TempDir,
}

/// A stand-in for the painting: regions by height, one direction everywhere.
struct Stub {
    shown: Option<PaintedDirection>,
}

impl Painted for Stub {
    fn carried(&self, _: &Hit, _: f64) -> Option<CarriedPlace> {
        None
    }

    fn factor_at(&self, _: &Hit, _: Amount) -> Option<f64> {
        Some(1.25)
    }

    fn region_at(&self, hit: &Hit) -> Option<usize> {
        (hit.object == 0).then_some(usize::from(hit.position_in_model.y > 0.5))
    }

    fn shown_at(&self, _: &Hit) -> Option<PaintedDirection> {
        self.shown
    }
}

impl World {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("ball.obj", ball_obj().as_str()), ("plate.obj", PLATE_OBJ), ("s.ron", SCENE)] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let document = Document::open(&folder.path().join("s.ron"), &Default::default()).unwrap();
        static SURFACES: OnceLock<[Arc<BodySurface>; 2]> = OnceLock::new();
        let surfaces = SURFACES.get_or_init(|| {
            let painting = prepare(Arc::clone(document.loaded())).unwrap();
            [0, 1].map(|object| Arc::clone(painting.surface(object)))
        });
        let mut picker = Picker::default();
        picker.update(&[0, 1].map(|object: usize| (Arc::clone(&surfaces[object]), BodyShape::default())));
        let (camera, poses) =
            (motion::camera_at(document.scene(), 0.0), motion::poses_at(document.scene(), 0.0));
        let options = ToolOptions { radius_px: 30.0, steady: 0.0, ..ToolOptions::default() };
        Self {
            document,
            picker,
            poses,
            view: View { camera, size_px: SIZE_PX },
            options,
            hand: Hand::default(),
            secs: 0.0,
            pressure: 1.0,
            painted: Stub { shown: Some(PaintedDirection { angle_rad: 10f64.to_radians(), trust: 0.97 }) },
            _folder: folder,
        }
    }

    /// Handles an event as the editor does: commits go into the document.
    fn take(&mut self, tool: Tool, event: ToolEvent) -> ToolOutput {
        let selection = self.document.selection().clone();
        let loaded = Arc::clone(self.document.loaded());
        let around = Surroundings {
            loaded: &loaded,
            view: &self.view,
            poses: &self.poses,
            frame: 0.0,
            picker: &self.picker,
            options: &self.options,
            selection: &selection,
            painted: &self.painted,
        };
        let output = self.hand.take(tool, &event, &around);
        match &output.preview {
            Some(command) => self.document.preview(command).unwrap(),
            None => self.document.end_preview(),
        }
        if let Some(command) = &output.commit {
            self.document.apply(command).unwrap();
        }
        if let Some(item) = &output.select {
            self.document.select(Selection::only(item.clone()));
        }
        if let Some(options) = &output.options {
            self.options = options.clone();
        }
        output
    }

    fn at(&mut self, at: [f64; 2]) -> (DVec2, f64) {
        self.secs += 0.02;
        (DVec2::from(at), self.secs)
    }

    fn hover(&mut self, tool: Tool, at: [f64; 2]) -> ToolOutput {
        let (at_px, at_secs) = self.at(at);
        self.take(tool, ToolEvent::Hover { at_px, at_secs })
    }

    fn press(&mut self, tool: Tool, at: [f64; 2], held: Modifiers) -> ToolOutput {
        let (at_px, at_secs) = self.at(at);
        self.take(tool, ToolEvent::Press { at_px, at_secs, held, pressure: self.pressure })
    }

    fn drag_to(&mut self, tool: Tool, at: [f64; 2], held: Modifiers) -> ToolOutput {
        let (at_px, at_secs) = self.at(at);
        self.take(tool, ToolEvent::Move { at_px, at_secs, held, pressure: self.pressure })
    }

    fn release(&mut self, tool: Tool) -> ToolOutput {
        self.take(tool, ToolEvent::Release { pressure: self.pressure })
    }

    /// A press and its release, late enough not to count as a double press.
    fn click(&mut self, tool: Tool, at: [f64; 2], held: Modifiers) -> [ToolOutput; 2] {
        self.secs += 1.0;
        [self.press(tool, at, held), self.release(tool)]
    }

    fn drag(&mut self, tool: Tool, through: &[[f64; 2]], held: Modifiers) -> ToolOutput {
        self.press(tool, through[0], held);
        for &at in &through[1..] {
            self.drag_to(tool, at, held);
        }
        self.release(tool)
    }

    fn select(&mut self, item: Item) {
        self.document.select(Selection::only(item));
    }

    fn guides(&self, region: usize) -> &[Guide] {
        &self.document.scene().regions[region].guides
    }

    fn run(&mut self, command: Command) {
        self.document.apply(&command).unwrap();
    }
}

fn refused(output: &ToolOutput) -> &str {
    assert!(output.commit.is_none() && output.preview.is_none());
    &output.refusal.as_ref().expect("it is refused").0
}
