//! Chooses the direction lines that are drawn over the picture: spread evenly, and not hidden by a surface.

use egui::Color32;
use glam::DVec2;
use impasto_editor_model::session::{DirectionLines, Overlays};
use impasto_painting::{FrameOptions, Painting, StrokeDirection};
use impasto_scene::motion::CameraPose;

use super::overlay::{DirectionInk, DirectionMark};
use super::{Framing, surface_map::SurfaceMap};

/// The picture is cut into square cells of this side, points; each shows at most one line.
const APART: f64 = 20.0;
/// At most this many lines are shown; in a large picture the cells grow to keep to it.
const MOST: usize = 600;

/// How to draw direction lines.
#[derive(Clone, Copy, Debug)]
pub struct HairLook<'a> {
    /// Chooses the colours: plain, by region, or by trust.
    pub overlays: Overlays,
    /// The colour of each region of the scene.
    pub region_colours: &'a [Color32],
    /// The region that is being painted: lines of other regions are faint. `None` draws all alike.
    pub region: Option<usize>,
    /// The object that is being posed: lines of other objects are faint. `None` draws all alike.
    pub object: Option<usize>,
}

/// The direction lines of a painting at a frame. `camera` is the camera before `framing` widens it to the viewport.
/// `map` holds the surfaces that the widened camera sees.
pub fn direction_marks(
    painting: &Painting,
    camera: &CameraPose,
    frame: f64,
    framing: &Framing,
    map: &SurfaceMap,
    look: &HairLook<'_>,
) -> Vec<DirectionMark> {
    let size = framing.viewport().size();
    let options = FrameOptions {
        shot_height_px: Some(framing.shot().height()),
        ..FrameOptions::new([size.x, size.y].map(|side| side.ceil().max(1.0) as u32))
    };
    let cells = |apart: f64| {
        [size.x, size.y].map(|side| (f64::from(side) / apart).ceil() as usize).iter().product::<usize>()
    };
    let mut apart = APART;
    while cells(apart) > MOST {
        apart *= 1.02;
    }
    let place = |direction_line: &StrokeDirection| DVec2::from(direction_line.position_px.map(f64::from));
    let shows = |direction_line: &StrokeDirection| {
        map.shows(place(direction_line), f64::from(direction_line.depth), direction_line.object)
    };
    let direction_lines =
        painting.stroke_directions(&framing.widened(camera), frame, &options, apart as f32, &shows);
    let ink = |direction_line: &StrokeDirection| match look.overlays {
        Overlays { trust: true, .. } => DirectionInk::Trust(direction_line.kappa),
        Overlays { direction_lines: DirectionLines::ByRegion, .. } => look
            .region_colours
            .get(direction_line.region)
            .map_or(DirectionInk::Plain, |&colour| DirectionInk::Region(colour)),
        _ => DirectionInk::Plain,
    };
    let mark = |direction_line: &StrokeDirection| DirectionMark {
        at_px: place(direction_line),
        angle_rad: direction_line.angle_rad,
        ink: ink(direction_line),
        faint: look.region.is_some_and(|region| region != direction_line.region)
            || look.object.is_some_and(|object| object != direction_line.object),
    };
    direction_lines.iter().map(mark).collect()
}
