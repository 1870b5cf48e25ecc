//! Previews how a comb would turn the strokes under its ring, while the pointer moves before a press.

use egui::Context;
use glam::DVec2;
use impasto_editor_model::editor::Editor;
use impasto_editor_model::tools::CombPreview;
use impasto_painting::{FrameOptions, SurfacePlace};
use impasto_scene::document::Sense;
use impasto_scene::presets;

use super::picture::PictureFlow;
use crate::viewport::overlay::{Comb, CombPreviewStroke};

/// At most this many strokes under the ring are considered for the preview.
const MAX_STROKES: usize = 600;
/// Shown strokes are at least this far apart, so that the picture stays visible.
const MIN_GAP_PX: f64 = 11.0;
/// A stroke is shown with the length that strokes of its region have, but at least 6 points and at most this.
const MAX_LENGTH_PX: f32 = 28.0;
/// Time to fade in and out, seconds.
const FADE_S: f32 = 0.15;

/// The strokes of the last preview, and how far they have faded in.
#[derive(Default)]
pub(super) struct CombPreviewStrokes {
    /// What the strokes were made from: the preview, and the version of the prepared scene.
    of: Option<(CombPreview, u64)>,
    strokes: Vec<CombPreviewStroke>,
    comb: Option<Comb>,
    opacity: f32,
}

impl CombPreviewStrokes {
    pub(super) fn follow(&mut self, ctx: &Context, editor: &Editor, picture_flow: &PictureFlow) {
        let held = editor.held();
        let wanted = editor.tool_output().comb_preview.filter(|_| !held.shift && !held.alt);
        let id = egui::Id::unique("comb_preview strokes");
        if editor.is_moving() {
            // During the gesture the picture itself shows the strokes turn.
            *self = Self::default();
            ctx.animate_bool_with_time(id, false, 0.0);
            return;
        }
        self.opacity = ctx.animate_bool_with_time(id, wanted.is_some(), FADE_S);
        let Some(comb_preview) = wanted else { return };
        let options = &editor.session.options;
        let along = if held.ctrl { -comb_preview.along } else { comb_preview.along };
        self.comb = Some(Comb {
            at_px: comb_preview.at_px,
            radius_px: options.radius_px,
            angle_rad: (along * DVec2::new(1.0, -1.0)).to_angle() as f32,
            strength: options.strength as f32,
            even: options.even,
        });
        let of = Some((comb_preview, picture_flow.prepared()));
        if self.of != of {
            self.strokes = strokes(&comb_preview, editor, picture_flow).unwrap_or_default();
            self.of = of;
        }
    }

    /// The strokes, the comb, and the opacity to draw them with; none if nothing is to be drawn.
    pub(super) fn shown(&self) -> Option<(&[CombPreviewStroke], Comb, f32)> {
        self.comb.filter(|_| self.opacity > 0.0).map(|comb| (&self.strokes[..], comb, self.opacity))
    }
}

/// The strokes in the ring that belong to the region under the pointer: a comb turns no others. `None` if the object is
/// not prepared.
fn strokes(
    comb_preview: &CombPreview,
    editor: &Editor,
    picture_flow: &PictureFlow,
) -> Option<Vec<CombPreviewStroke>> {
    let painting = editor.painting()?;
    let scene = painting.scene();
    scene.objects.get(comb_preview.object)?;
    let framing = picture_flow.layout().framings().first()?;
    let camera = framing.widened(&editor.camera());
    let size_px = framing.viewport().size();
    let shot_height_px = framing.shot().height();
    let options = FrameOptions {
        shot_height_px: Some(shot_height_px),
        ..FrameOptions::new([size_px.x, size_px.y].map(|side| side.ceil().max(1.0) as u32))
    };
    let place = SurfacePlace {
        object: comb_preview.object,
        position: comb_preview.position_in_model,
        normal: comb_preview.normal_in_model,
        radius: comb_preview.radius,
    };
    let region = comb_preview.region.unwrap_or(scene.regions.len());
    let of_scene = comb_preview.region.filter(|region| *region < scene.regions.len());
    let body_px = presets::resolve(scene, of_scene).body().length_px;
    let length_px = body_px * shot_height_px / scene.size.1.max(1) as f32;
    let directed = of_scene.is_some_and(|region| scene.regions[region].sense == Sense::Arrows);
    let direction_lines =
        painting.stroke_directions_near(&place, &camera, editor.session.frame, &options, MAX_STROKES);
    let stroke = |direction_line: &impasto_painting::StrokeDirection| CombPreviewStroke {
        at_px: DVec2::from(direction_line.position_px.map(f64::from)),
        angle_rad: direction_line.angle_rad,
        length_px: length_px.clamp(6.0, MAX_LENGTH_PX),
        directed,
    };
    let mut spaced: Vec<CombPreviewStroke> = Vec::new();
    for stroke in direction_lines.iter().filter(|direction_line| direction_line.region == region).map(stroke)
    {
        if spaced.iter().all(|other| other.at_px.distance_squared(stroke.at_px) >= MIN_GAP_PX * MIN_GAP_PX) {
            spaced.push(stroke);
        }
    }
    Some(spaced)
}
