//! Chooses which direction lines to show: spread evenly over the picture, and not hidden by a surface.

use egui::Color32;
use glam::DVec2;
use impasto_editor_model::session::{Hairs, Overlays};
use impasto_painting::{FrameOptions, Painting, StrokeDirection};
use impasto_scene::motion::CameraPose;

use super::overlay::{HairInk, HairMark};
use super::{Framing, surface_map::SurfaceMap};

/// Lines are at least this far apart, points.
const APART: f64 = 20.0;
/// At most this many lines are shown.
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

/// The direction lines of a painting at a frame, seen through a camera (before widening) in a framing. `map` holds the
/// surfaces that this camera sees.
pub fn hair_marks(
    painting: &Painting,
    camera: &CameraPose,
    frame: f64,
    framing: &Framing,
    map: &SurfaceMap,
    look: &HairLook<'_>,
) -> Vec<HairMark> {
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
    let place = |hair: &StrokeDirection| DVec2::from(hair.position_px.map(f64::from));
    let shows = |hair: &StrokeDirection| map.shows(place(hair), f64::from(hair.depth), hair.object);
    let hairs = painting.stroke_directions(&framing.widened(camera), frame, &options, apart as f32, &shows);
    let ink = |hair: &StrokeDirection| match look.overlays {
        Overlays { trust: true, .. } => HairInk::Trust(hair.kappa),
        Overlays { hairs: Hairs::ByRegion, .. } => {
            look.region_colours.get(hair.region).map_or(HairInk::Plain, |&colour| HairInk::Region(colour))
        }
        _ => HairInk::Plain,
    };
    let mark = |hair: &StrokeDirection| HairMark {
        at_px: place(hair),
        angle_rad: hair.angle_rad,
        ink: ink(hair),
        faint: look.region.is_some_and(|region| region != hair.region)
            || look.object.is_some_and(|object| object != hair.object),
    };
    hairs.iter().map(mark).collect()
}
