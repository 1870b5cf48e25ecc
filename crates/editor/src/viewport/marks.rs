//! Everything that the editor draws over one picture (grid, outlines, guides, rings, handles), and in which order.

use impasto_editor_model::gizmo::Gizmo;
use impasto_editor_model::tools::{Needle, Ring};
use impasto_editor_model::transform::Constraint;

use super::overlay::{
    self, AmountTint, Comb, CombPreviewStroke, DirectionMark, GuideCurve, MotionPath, Outline, RegionTint,
};
use super::overlay::{MissingMesh, Sheet, Sight, SingularPoint, StandIn};

/// What is drawn over one picture. Empty by default.
#[derive(Clone, Copy, Default)]
pub struct Marks<'a> {
    /// The grid on the floor.
    pub grid: bool,
    /// Regions in their colours.
    pub regions: &'a [RegionTint],
    /// A tint where the amount that the tool paints is above or below 1.
    pub amounts: Option<&'a AmountTint>,
    /// The outline of the selected object.
    pub selected: Option<&'a Outline>,
    /// Outlines of the selected object at the keys before and after this frame.
    pub ghosts: &'a [Outline],
    /// Lines along the strokes' directions on the surfaces.
    pub direction_lines: &'a [DirectionMark],
    /// Points where strokes have no direction, and the [`Sight`] that tells which of these points are visible.
    pub singular: Option<(&'a [SingularPoint], Sight<'a>)>,
    /// Curves: the guides of the selected region, the line of the selected touch, and the line that the tool draws.
    pub guides: &'a [GuideCurve],
    /// A preview of a comb: the strokes that it would turn, the comb itself, and the preview's opacity (0..=1).
    pub comb_preview: Option<(&'a [CombPreviewStroke], Comb, f32)>,
    /// The tool's own ring, then those of its mirror images.
    pub rings: &'a [Ring],
    /// A needle that shows the direction at the centre of the tool's own ring.
    pub needle: Option<Needle>,
    /// Radius of the tool's own ring, in points: it gives the needle its length and the label its place.
    pub radius_px: f64,
    /// The label beside the tool's own ring; it is not drawn where there is no ring.
    pub tag: Option<&'a str>,
    /// The motion path of the selected object.
    pub path: Option<&'a MotionPath>,
    /// Marks for suns and the shot camera, and whether each is selected.
    pub stand_ins: &'a [(StandIn, bool)],
    /// Boxes where meshes are missing.
    pub missing: &'a [MissingMesh],
    /// The handles, and the constraint of the highlighted one.
    pub gizmo: Option<(&'a Gizmo, Option<Constraint>)>,
    /// Whether the ring replaces the pointer.
    pub hides_pointer: bool,
}

impl Marks<'_> {
    /// Draws all marks; later ones cover earlier ones.
    pub fn draw(&self, sheet: &Sheet<'_>) {
        if self.grid {
            overlay::floor_grid(sheet);
        }
        overlay::region_tints(sheet, self.regions);
        if let Some(amounts) = self.amounts {
            overlay::amount_tint(sheet, amounts);
        }
        self.ghosts.iter().for_each(|ghost| overlay::outline(sheet, ghost, true));
        if let Some(selected) = self.selected {
            overlay::outline(sheet, selected, false);
        }
        overlay::direction_lines(sheet, self.direction_lines);
        if let Some((points, sight)) = &self.singular {
            overlay::singular_points(sheet, points, sight);
        }
        self.guides.iter().for_each(|guide| overlay::guide_curve(sheet, guide));
        if let Some((strokes, comb, shown)) = &self.comb_preview {
            overlay::comb_preview(sheet, strokes, comb, *shown);
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
