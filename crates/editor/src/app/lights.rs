//! The icons of lights over the picture.

use impasto_editor_model::Item;
use impasto_editor_model::editor::Editor;
use impasto_gl_render::{BillboardIcon, BillboardSize, LightBillboard};
use impasto_scene::document::{Color, Light, LightKind};

use crate::theme;
use crate::viewport::Framing;

/// Half the side of an icon, and the radius of the ring round a selected one, in points.
const ICON: f32 = 14.0;
const SELECTED: f32 = 17.0;

/// The colours of all icons are mixed with this much white, so that dark lights can be seen.
const LEAST_WHITE: f32 = 0.25;

/// Opacity of the ring in the world whose radius is [`range`].
const RANGE_ALPHA: f32 = 0.8;

/// The icons of all lights, each in its light's colour. The icon of a selected light has a ring around it. A selected
/// lamp or spot also has a ring in the world, with the radius [`range`].
pub(super) fn billboards(editor: &Editor, framing: &Framing) -> Vec<LightBillboard> {
    let px_per_point = framing.size_px()[1] as f32 / framing.viewport().height();
    let mut all = Vec::new();
    for place in editor.light_places() {
        let light = &place.light;
        let position = place.position;
        let icon = match light.kind {
            LightKind::Sun => BillboardIcon::Sun,
            LightKind::Point | LightKind::Spot => BillboardIcon::Point,
            LightKind::Ambient => BillboardIcon::Ambient,
        };
        let size = BillboardSize::Pixels(ICON * px_per_point);
        all.push(LightBillboard { position, icon, size, ink: ink(light.color) });
        if editor.document().selection().contains(&Item::Light(light.name.clone())) {
            let ring = |size: BillboardSize, ink: [f32; 4]| LightBillboard {
                position,
                icon: BillboardIcon::Ring,
                size,
                ink,
            };
            let accent = theme::DARK.accent_text.to_array().map(|channel| f32::from(channel) / 255.0);
            all.push(ring(BillboardSize::Pixels(SELECTED * px_per_point), accent));
            if let Some(range) = range(light) {
                let [r, g, b, _] = ink(light.color);
                all.push(ring(BillboardSize::World(range), [r, g, b, RANGE_ALPHA]));
            }
        }
    }
    all
}

fn ink(Color(color): Color) -> [f32; 4] {
    let [r, g, b] = color.map(|channel| channel + (1.0 - channel) * LEAST_WHITE);
    [r, g, b, 1.0]
}

/// The distance, in world units, at which a lamp or a spot lights a surface that faces it as brightly as a sun of
/// intensity 1. `None` for other kinds of light, and without intensity.
fn range(light: &Light) -> Option<f32> {
    let is_lamp = matches!(light.kind, LightKind::Point | LightKind::Spot);
    (is_lamp && light.intensity > 0.0).then(|| light.intensity.sqrt() as f32)
}
