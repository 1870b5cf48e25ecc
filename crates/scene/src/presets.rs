//! Named stroke settings, and what holds for a region once the preset, the scene and the region have spoken.

use crate::document::{Scene, StrokeSettings};

/// The preset of a scene that names none.
pub const DEFAULT_PRESET: &str = "oil study";

/// The source paper's own rule, whole: equal counts per polygon at random places, count by facing, one brush, the full
/// neighbour sum in every frame, no jitter and no underpainting. It holds for a scene, not for a region.
pub const PAPER_PRESET: &str = "paper";

/// The brushes that this build has.
pub const BRUSHES: [&str; 1] = ["filbert"];

/// A complete set of values under a name.
#[derive(Clone, Copy, Debug)]
struct Preset {
    name: &'static str,
    brush: &'static str,
    length_px: f64,
    width_px: f64,
    coverage: f64,
    flatness: f64,
    angle_jitter_deg: f64,
    size_jitter: f64,
    layer: i32,
}

/// The default first.
const PRESETS: [Preset; 4] = [
    // Strokes about three times as long as wide: they show their direction and still close over the form.
    Preset {
        name: DEFAULT_PRESET,
        brush: "filbert",
        length_px: 34.0,
        width_px: 11.0,
        coverage: 3.0,
        flatness: 1.0,
        angle_jitter_deg: 7.0,
        size_jitter: 0.16,
        layer: 0,
    },
    // Blocking in: large, wide, loosely held.
    Preset {
        name: "broad",
        brush: "filbert",
        length_px: 64.0,
        width_px: 22.0,
        coverage: 2.5,
        flatness: 1.0,
        angle_jitter_deg: 10.0,
        size_jitter: 0.2,
        layer: 0,
    },
    // Small, steady strokes, for what the eye should rest on.
    Preset {
        name: "detail",
        brush: "filbert",
        length_px: 16.0,
        width_px: 5.0,
        coverage: 3.0,
        flatness: 1.0,
        angle_jitter_deg: 4.0,
        size_jitter: 0.12,
        layer: 0,
    },
    Preset {
        name: PAPER_PRESET,
        brush: "filbert",
        length_px: 24.0,
        width_px: 8.0,
        coverage: 3.0,
        flatness: 1.0,
        angle_jitter_deg: 0.0,
        size_jitter: 0.0,
        layer: 0,
    },
];

/// Stroke settings with nothing left out.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedStrokes {
    /// Brush tip by name, one of [`BRUSHES`].
    pub brush: String,
    /// Length in pixels at the scene's size.
    pub length_px: f32,
    /// Width in pixels at the scene's size.
    pub width_px: f32,
    /// Strokes per pixel × length × width.
    pub coverage: f32,
    /// 1 keeps strokes flat on the picture, 0 lets their direction follow the surface.
    pub flatness: f32,
    /// Standard deviation of the angle, radians.
    pub angle_jitter_rad: f32,
    /// Standard deviation of the size, as a share of it.
    pub size_jitter: f32,
    /// Higher layers are painted over lower ones.
    pub layer: i32,
}

/// The names of all presets, the default first.
pub fn names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|preset| preset.name)
}

/// Whether the scene is painted by the source paper's own rule ([`PAPER_PRESET`]).
pub fn is_paper(scene: &Scene) -> bool {
    scene.strokes.preset.as_deref() == Some(PAPER_PRESET)
}

/// The settings of region `region` of the scene; of everything that no region covers where it is `None`.
///
/// A value comes from the first that states it: the region, the region's preset, the scene, the scene's preset, the
/// default preset. An unknown preset counts as none (`check` refuses it). The index must be one of the scene's regions.
pub fn resolve(scene: &Scene, region: Option<usize>) -> ResolvedStrokes {
    let mut strokes = ResolvedStrokes::from(&PRESETS[0]);
    strokes.apply(&scene.strokes);
    if let Some(region) = region {
        strokes.apply(&scene.regions[region].strokes);
    }
    strokes
}

impl ResolvedStrokes {
    /// Takes over what `settings` state: their preset first, then their own values.
    fn apply(&mut self, settings: &StrokeSettings) {
        let named = |preset: &&Preset| Some(preset.name) == settings.preset.as_deref();
        if let Some(preset) = PRESETS.iter().find(named) {
            *self = Self::from(preset);
        }
        if let Some(brush) = &settings.brush {
            self.brush.clone_from(brush);
        }
        replace(&mut self.length_px, settings.length_px);
        replace(&mut self.width_px, settings.width_px);
        replace(&mut self.coverage, settings.coverage);
        replace(&mut self.flatness, settings.flatness);
        replace(&mut self.angle_jitter_rad, settings.angle_jitter_deg.map(f64::to_radians));
        replace(&mut self.size_jitter, settings.size_jitter);
        self.layer = settings.layer.unwrap_or(self.layer);
    }
}

fn replace(value: &mut f32, stated: Option<f64>) {
    if let Some(stated) = stated {
        *value = stated as f32;
    }
}

impl From<&Preset> for ResolvedStrokes {
    fn from(preset: &Preset) -> Self {
        Self {
            brush: preset.brush.to_owned(),
            length_px: preset.length_px as f32,
            width_px: preset.width_px as f32,
            coverage: preset.coverage as f32,
            flatness: preset.flatness as f32,
            angle_jitter_rad: preset.angle_jitter_deg.to_radians() as f32,
            size_jitter: preset.size_jitter as f32,
            layer: preset.layer,
        }
    }
}

#[cfg(test)]
mod tests;
