//! Named stroke settings, and the settings of a region once preset, scene and region are combined.

mod table;

use crate::document::{BrushMix, Color, LayerNumber, LayerSettings, Scene, StrokeSettings};
pub use crate::document::{ResolvedLayer, ResolvedStrokes};

use table::{PRESETS, Preset};

/// The preset of a scene that names none, unless its style has a usual preset of its own.
pub const DEFAULT_PRESET: &str = "oil study";

/// The preset of a scene in ink that names none.
pub const INK_PRESET: &str = "ink";

/// The source paper's own rule, complete. Every polygon has the same number of particles, at random places. In a frame,
/// as many of them show a stroke as the polygon's projected area asks for. There is one brush, the full neighbour sum
/// in every frame, no jitter, and no layer but the body. The rule holds for a whole scene, not for a region.
pub const PAPER_PRESET: &str = "paper";

/// The name that a scene's list of layers uses for the tone under all of them.
pub const GROUND: &str = "ground";

/// A layer of paint. The variants stand in the usual order of laying; a scene may state another ([`laying_order`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LayerKind {
    /// Large, thin, earthy strokes under everything.
    Underpainting,
    /// The bulk of the paint.
    Body,
    /// Smaller strokes where the form turns.
    Form,
    /// Broken, dry strokes in patches.
    Scumble,
    /// Small strokes where colours meet.
    Accents,
    /// Thin lines where a body ends, fading out in places.
    Contour,
    /// A few thick strokes on highlights.
    Lights,
    /// Strokes that were placed by hand, over all others.
    Touches,
}

impl LayerKind {
    /// The layers whose strokes Impasto places itself, in the usual order of laying.
    pub const ALL: [Self; 7] = [
        Self::Underpainting,
        Self::Body,
        Self::Form,
        Self::Scumble,
        Self::Accents,
        Self::Contour,
        Self::Lights,
    ];

    /// The name in a scene's list of layers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Underpainting => "underpainting",
            Self::Body => "body",
            Self::Form => "form",
            Self::Scumble => "scumble",
            Self::Accents => "accents",
            Self::Contour => "contour",
            Self::Lights => "lights",
            Self::Touches => "touches",
        }
    }
}

impl ResolvedLayer {
    /// Strokes wanted per pixel of the picture at the scene's size.
    pub fn wanted_per_px(&self) -> f32 {
        self.coverage / (self.length_px * self.width_px)
    }
}

/// The tone under all layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedGround {
    /// The tone.
    pub color: Color,
    /// How far the tone hides the wash of each body's own colour, 0..=1.
    pub opacity: f32,
}

/// The names of all presets, the default first.
pub fn names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|preset| preset.name)
}

/// Whether a brush is a picture of the user's own: its name has an ending.
pub fn is_picture(brush: &str) -> bool {
    std::path::Path::new(brush).extension().is_some()
}

/// Whether the scene is painted by the source paper's own rule ([`PAPER_PRESET`]).
pub fn is_paper(scene: &Scene) -> bool {
    scene.strokes.preset.as_deref() == Some(PAPER_PRESET)
}

/// Whether the style and the preset of the scene paint a layer where its coverage is not 0. A style that has no strokes
/// at the moment (`Preparation::has_strokes`) is taken as if it had.
pub fn paints_layer(scene: &Scene, kind: LayerKind) -> bool {
    let style = scene.style.settings().preparation();
    let of_style = match kind {
        LayerKind::Underpainting => style.underpainting,
        LayerKind::Contour | LayerKind::Lights => style.contour_and_lights,
        _ => true,
    };
    of_style && (kind == LayerKind::Body || !is_paper(scene))
}

/// The settings of region `region` of the scene; `None` means everything that no region covers.
///
/// A value comes from the first that states it: the region, the region's preset, the scene, the scene's preset, the
/// style's own preset. A preset states every value, so a region with one takes nothing from the scene. A region's
/// `scale` multiplies the size that the region would have without it. An unknown preset counts as none (`check` refuses
/// it). A hidden layer has a coverage of 0, except the body: its particles carry the directions that tools and touches
/// read. The scene must have a region of this index.
pub fn resolve(scene: &Scene, region: Option<usize>) -> ResolvedStrokes {
    let of_region = region.map(|region| &scene.regions[region].strokes);
    let mut strokes = resolve_with(scene, &scene.strokes, of_region);
    for kind in LayerKind::ALL.into_iter().filter(|kind| *kind != LayerKind::Body) {
        let layer = &mut strokes.layers[kind as usize];
        if layer.hidden {
            layer.coverage = 0.0;
        }
    }
    strokes
}

/// As [`resolve`], with these settings of the scene and of a region in place of those that `scene` has. Hidden layers
/// keep their coverage, so that an editor can show it; what is painted comes from [`resolve`].
pub fn resolve_with(
    scene: &Scene,
    of_scene: &StrokeSettings,
    of_region: Option<&StrokeSettings>,
) -> ResolvedStrokes {
    // Presets are meant for a picture 720 pixels high.
    let size = scene.size.1 as f32 / 720.0;
    let usual = scene.style.info().preset.unwrap_or(DEFAULT_PRESET);
    let usual = PRESETS.iter().find(|preset| preset.name == usual).unwrap_or(&PRESETS[0]);
    let mut strokes = ResolvedStrokes::of_preset(usual, size);
    for stated in [Some(of_scene), of_region].into_iter().flatten() {
        strokes.apply(stated, size);
    }
    strokes
}

/// The tone under the scene's layers. If the scene states none, it is an earthy brown that lets most of each body's own
/// colour through. A hidden ground has an opacity of 0.
pub fn ground(scene: &Scene) -> ResolvedGround {
    let is_hidden = ground_of(&scene.strokes).is_some_and(|layer| layer.hidden == Some(true));
    let ground = stated_ground(&scene.strokes);
    ResolvedGround { opacity: if is_hidden { 0.0 } else { ground.opacity }, ..ground }
}

/// As [`ground`], for these settings of a scene. A hidden ground keeps its opacity.
pub fn stated_ground(of_scene: &StrokeSettings) -> ResolvedGround {
    let stated = ground_of(of_scene);
    ResolvedGround {
        color: stated.and_then(|layer| layer.color).unwrap_or(Color([0.447, 0.341, 0.227])),
        opacity: stated.and_then(|layer| layer.opacity).unwrap_or(0.2) as f32,
    }
}

fn ground_of(settings: &StrokeSettings) -> Option<&LayerSettings> {
    settings.layers.iter().rfind(|layer| layer.name == GROUND)
}

/// The layers of paint in the order in which the scene lays them, the lowest first. An order that does not name each
/// layer once counts as none (`check` refuses it).
pub fn laying_order(scene: &Scene) -> [LayerKind; 7] {
    let stated = &scene.strokes.order;
    let place_of = |kind: &LayerKind| stated.iter().position(|name| name == kind.name());
    let mut order = LayerKind::ALL;
    if stated.len() == order.len() && order.iter().all(|kind| place_of(kind).is_some()) {
        order.sort_by_key(place_of);
    }
    order
}

impl ResolvedStrokes {
    /// One layer.
    pub fn layer_of(&self, kind: LayerKind) -> &ResolvedLayer {
        &self.layers[kind as usize]
    }

    /// The body layer.
    pub fn body(&self) -> &ResolvedLayer {
        self.layer_of(LayerKind::Body)
    }

    /// Applies what `settings` state: their preset first, then the sizes, then single layers.
    fn apply(&mut self, settings: &StrokeSettings, preset_size: f32) {
        let named = |preset: &&Preset| Some(preset.name) == settings.preset.as_deref();
        if let Some(preset) = PRESETS.iter().find(named) {
            *self = Self::of_preset(preset, preset_size);
        }
        self.resize(settings);
        let body = &mut self.layers[LayerKind::Body as usize];
        if let Some(coverage) = settings.coverage {
            body.coverage = coverage as f32;
        }
        if let Some(BrushMix(names)) = &settings.brush {
            body.brushes.clone_from(names);
        }
        self.apply_numbers(settings);
        self.edges = settings.edges.unwrap_or(self.edges);
        if let Some(palette) = &settings.palette {
            self.palette.clone_from(palette);
        }
        self.layer = settings.layer.unwrap_or(self.layer);
        if !settings.keys.is_empty() {
            self.keys.clone_from(&settings.keys);
        }
        for stated in &settings.layers {
            if let Some(kind) = LayerKind::ALL.iter().find(|kind| kind.name() == stated.name) {
                self.layers[*kind as usize].apply(stated);
            }
        }
    }

    /// The body layer takes the stated size; the other layers keep their proportion to it.
    fn resize(&mut self, settings: &StrokeSettings) {
        let body = self.body();
        let before = body.length_px * body.width_px;
        let length_px = settings.length_px.map_or(body.length_px, |length| length as f32);
        let width_px = settings.width_px.map_or(body.width_px, |width| width as f32);
        let scale = settings.scale.map_or(1.0, |scale| scale as f32);
        let factor = (length_px * width_px / before).sqrt() * scale;
        for kind in LayerKind::ALL {
            let layer = &mut self.layers[kind as usize];
            (layer.length_px, layer.width_px) = match kind {
                LayerKind::Body => (length_px * scale, width_px * scale),
                _ => (layer.length_px * factor, layer.width_px * factor),
            };
        }
    }
}

impl ResolvedLayer {
    fn apply(&mut self, settings: &LayerSettings) {
        if let Some(BrushMix(names)) = &settings.brush {
            self.brushes.clone_from(names);
        }
        self.hidden = settings.hidden.unwrap_or(self.hidden);
        for LayerNumber { number, resolved } in LayerSettings::NUMBERS {
            if let Some(stated) = (number.get)(settings) {
                *resolved(self) = stated as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests;
