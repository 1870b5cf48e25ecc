//! Everything that is drawn over one picture, in its order.

use impasto_editor_model::gizmo::Gizmo;
use impasto_editor_model::tools::{Needle, Ring};
use impasto_editor_model::transform::Constraint;

use super::overlay::{self, Comb, ForeseenStroke, GuideCurve, HairMark, MotionPath, Outline, RegionTint};
use super::overlay::{MissingMesh, Sheet, Sight, SingularPoint, StandIn};

/// What is drawn over one picture. Empty by default.
#[derive(Clone, Copy, Default)]
pub struct Marks<'a> {
    /// The grid on the floor.
    pub grid: bool,
    /// Regions in their colours.
    pub regions: &'a [RegionTint],
    /// What is selected.
    pub selected: Option<&'a Outline>,
    /// What is selected, as it stands at the keys beside this frame.
    pub ghosts: &'a [Outline],
    /// Directions.
    pub hairs: &'a [HairMark],
    /// Points without a direction, and what tells whether they can be seen.
    pub singular: Option<(&'a [SingularPoint], Sight<'a>)>,
    /// Guides of the selected region.
    pub guides: &'a [GuideCurve],
    /// Strokes as the comb would lay them, with how much of them is shown (0..=1).
    pub foreseen: Option<(&'a [ForeseenStroke], Comb, f32)>,
    /// Rings of the brush, its mirror images among them.
    pub rings: &'a [Ring],
    /// The direction under the dot.
    pub needle: Option<Needle>,
    /// Radius of the ring, points.
    pub radius_px: f64,
    /// Words beside the ring.
    pub tag: Option<&'a str>,
    /// Where the selected object goes.
    pub path: Option<&'a MotionPath>,
    /// Lights and cameras, with whether they are selected.
    pub stand_ins: &'a [(StandIn, bool)],
    /// Boxes where meshes are missing.
    pub missing: &'a [MissingMesh],
    /// Handles, and the one that is lit.
    pub gizmo: Option<(&'a Gizmo, Option<Constraint>)>,
    /// Whether the ring stands for the pointer.
    pub hides_pointer: bool,
}

impl Marks<'_> {
    /// Draws all.
    pub fn draw(&self, sheet: &Sheet<'_>) {
        if self.grid {
            overlay::floor_grid(sheet);
        }
        self.regions.iter().for_each(|tint| overlay::region_tint(sheet, tint));
        self.ghosts.iter().for_each(|ghost| overlay::outline(sheet, ghost, true));
        if let Some(selected) = self.selected {
            overlay::outline(sheet, selected, false);
        }
        overlay::hairs(sheet, self.hairs);
        if let Some((points, sight)) = &self.singular {
            overlay::singular_points(sheet, points, sight);
        }
        self.guides.iter().for_each(|guide| overlay::guide_curve(sheet, guide));
        if let Some((strokes, comb, shown)) = &self.foreseen {
            overlay::foreseen(sheet, strokes, comb, *shown);
        }
        self.rings.iter().for_each(|ring| overlay::ring(sheet, ring));
        if let Some(needle) = &self.needle {
            overlay::needle(sheet, needle, self.radius_px);
        }
        if let (Some(tag), Some(ring)) = (self.tag, self.rings.first()) {
            overlay::needle_tag(sheet, ring.at_px, self.radius_px, tag);
        }
        if let Some(path) = self.path {
            overlay::motion_path(sheet, path);
        }
        self.missing.iter().for_each(|missing| overlay::missing_mesh(sheet, missing));
        overlay::stand_ins(sheet, self.stand_ins);
        if let Some((gizmo, lit)) = &self.gizmo {
            overlay::gizmo(sheet, gizmo, lit.as_ref());
        }
    }
}
