//! Commands on regions: what they cover, and their stroke settings.

use impasto_scene::document::{
    BrushMix, Color, Dab, Edges, LayerSettings, Patch, Region, Scene, Seam, Selector, StrokeNumber,
    StrokeSettings,
};
use impasto_scene::presets::{GROUND, LayerKind};
use impasto_scene::strokes_file::StrokesFile;

use super::{Done, region_mut, unlocked_region};
use crate::euler::tidy;
use crate::names;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// The owner of stroke settings.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum StrokesOf {
    /// The scene. Regions can replace its settings.
    Scene,
    /// The region of this name.
    Region(String),
}

/// One stroke setting; `None` leaves it to a preset or to the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum StrokeChange {
    /// A number of [`impasto_scene::document::STROKE_NUMBERS`], by its name in a scene file, in the file's units.
    Number(&'static str, Option<f64>),
    /// The brush, or a mix of brushes.
    Brush(Option<BrushMix>),
    /// How paint ends at the border of its body.
    Edges(Option<Edges>),
    /// Higher layers are painted over lower ones.
    Layer(Option<i32>),
    /// The named set of values to start from.
    Preset(Option<String>),
    /// The pigments.
    Palette(Option<Vec<Color>>),
    /// The settings of one layer of paint; a layer that states nothing is left to a preset or to the scene.
    PaintLayer(Box<LayerSettings>),
    /// The layers of paint in the order in which they are laid, for the scene alone; `None` for the usual order.
    LayerOrder(Option<[LayerKind; 7]>),
}

/// A change to a region, or to the stroke settings of a region or of the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Regions {
    /// Adds a region on top of the others; its name is made unique.
    Add(Box<Region>),
    /// Changes what a region covers.
    SetSelector(String, Selector),
    /// Adds dabs of the region brush; each adds what it touches to the region, or takes it away.
    Paint {
        /// The region.
        region: String,
        /// The dabs.
        dabs: Vec<Dab>,
    },
    /// Sets the colour in which overlays show a region.
    SetColor(String, Color),
    /// Sets how the directions of a region meet those around it.
    SetSeam(String, Seam),
    /// Changes one stroke setting.
    SetStroke(StrokesOf, StrokeChange),
    /// Replaces all stroke settings by those that were copied.
    PasteStrokes(StrokesOf, Box<StrokeSettings>),
    /// Replaces the stroke settings by those of a preset that the user made. Keys and `layer` stay. A scene also keeps
    /// its ground and its order of layers if the preset states none.
    ApplyPreset {
        /// Whose settings.
        of: StrokesOf,
        /// The preset. It names the pictures of its brushes by paths at which the scene finds them.
        preset: Box<StrokesFile>,
        /// Its name.
        name: String,
    },
}

impl Regions {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::Add(region) => {
                let mut region = Region::clone(region);
                let taken = scene.regions.iter().map(|region| region.name.as_str());
                region.name = names::unique(&names::typed(&region.name)?, taken);
                let name = region.name.clone();
                scene.regions.push(region);
                let selection = Selection::only(Item::Region(name.clone()));
                Ok(Done::new(format!("New region {name}")).selecting(selection))
            }
            Self::SetSelector(name, on) => {
                unlocked_region(scene, name)?.on = on.clone();
                Ok(Done::new(format!("Change what {name} covers")))
            }
            Self::Paint { region, dabs } => {
                let edited = unlocked_region(scene, region)?;
                paint(&mut edited.on, dabs)?;
                let selection = Selection::only(Item::Region(region.clone()));
                Ok(Done::new(format!("Paint region {region}")).selecting(selection))
            }
            Self::SetColor(name, color) => {
                region_mut(scene, name)?.color = Some(in_file(*color));
                Ok(Done::new(format!("Colour of {name}")))
            }
            Self::SetSeam(name, seam) => {
                unlocked_region(scene, name)?.seam = *seam;
                Ok(Done::new(format!("Seam of {name}")))
            }
            Self::SetStroke(of, change) => set_stroke(settings(scene, of)?, change),
            Self::PasteStrokes(of, pasted) => {
                let mut pasted = StrokeSettings::clone(pasted);
                if matches!(of, StrokesOf::Region(_)) {
                    // Only a scene has an order of layers, and a ground.
                    pasted.order.clear();
                    pasted.layers.retain(|layer| layer.name != GROUND);
                }
                *settings(scene, of)? = pasted;
                Ok(Done::new(match of {
                    StrokesOf::Scene => "Paste strokes to the scene".to_owned(),
                    StrokesOf::Region(name) => format!("Paste strokes to {name}"),
                }))
            }
            Self::ApplyPreset { of, preset, name } => {
                let height_px = scene.size.1;
                let own = settings(scene, of)?;
                *own = preset.applied_to(own, height_px, matches!(of, StrokesOf::Region(_)));
                Ok(Done::new(format!("Preset {name}")))
            }
        }
    }
}

pub(super) fn settings<'a>(scene: &'a mut Scene, of: &StrokesOf) -> Result<&'a mut StrokeSettings, Refusal> {
    match of {
        StrokesOf::Scene => Ok(&mut scene.strokes),
        StrokesOf::Region(name) => Ok(&mut unlocked_region(scene, name)?.strokes),
    }
}

/// A colour as a scene file can hold it: 8 bits a channel.
pub(crate) fn in_file(color: Color) -> Color {
    Color::from_hex(&color.to_hex()).unwrap_or(color)
}

fn paint(on: &mut Selector, dabs: &[Dab]) -> Result<(), Refusal> {
    if let Selector::Dabs(_, list) = on {
        list.extend(dabs.iter().cloned());
        return Ok(());
    }
    let Some(object) = on.object().map(str::to_owned) else {
        return Err(Refusal::new("This region covers everything: make a new one to paint on it"));
    };
    if let Selector::Several(_, patches) = on {
        match patches.last_mut() {
            Some(Patch::Dabs(list)) => list.extend(dabs.iter().cloned()),
            _ => patches.push(Patch::Dabs(dabs.to_vec())),
        }
        return Ok(());
    }
    let first = match on.clone() {
        Selector::Group(_, group) => Patch::Group(group),
        Selector::Material(_, material) => Patch::Material(material),
        Selector::Flood(_, seed, sharp_deg) => Patch::Flood(seed, sharp_deg),
        _ => Patch::Whole,
    };
    *on = Selector::Several(object, vec![first, Patch::Dabs(dabs.to_vec())]);
    Ok(())
}

fn set_stroke(settings: &mut StrokeSettings, change: &StrokeChange) -> Result<Done, Refusal> {
    let text = match change {
        StrokeChange::Number(name, value) => {
            let field = StrokeNumber::named(name).ok_or_else(|| Refusal::unknown("stroke setting", name))?;
            *(field.number.of)(settings) = value.map(super::finite).transpose()?.map(tidy);
            let field = &field.shown;
            match value {
                Some(value) => {
                    let shown = value / field.file_per_shown;
                    format!("{} {shown:.*} {}", field.label, field.decimals, field.unit).trim_end().to_owned()
                }
                None => format!("Reset {}", field.label.to_lowercase()),
            }
        }
        StrokeChange::Brush(brush) => {
            settings.brush.clone_from(brush);
            match brush {
                Some(BrushMix(names)) => format!("Brush {}", names.join(", ")),
                None => "Reset brush".to_owned(),
            }
        }
        StrokeChange::Edges(edges) => {
            settings.edges = *edges;
            edges.map_or("Reset edges", |_| "Edges").to_owned()
        }
        StrokeChange::Layer(layer) => {
            settings.layer = *layer;
            layer.map_or("Reset layer".to_owned(), |layer| format!("Layer {layer}"))
        }
        StrokeChange::Preset(preset) => {
            settings.preset.clone_from(preset);
            preset.as_ref().map_or("Reset preset".to_owned(), |preset| format!("Preset {preset}"))
        }
        StrokeChange::Palette(palette) => {
            settings.palette =
                palette.as_ref().map(|colors| colors.iter().map(|&color| in_file(color)).collect());
            palette.as_ref().map_or("Any colour", |_| "Palette").to_owned()
        }
        StrokeChange::PaintLayer(layer) => paint_layer(settings, layer),
        StrokeChange::LayerOrder(order) => {
            let order = order.filter(|order| *order != LayerKind::ALL);
            settings.order =
                order.map_or_else(Vec::new, |order| order.map(|kind| kind.name().to_owned()).to_vec());
            order.map_or("Reset order of layers", |_| "Order of layers").to_owned()
        }
    };
    Ok(Done::new(text))
}

/// Replaces the settings of one layer of paint. Returns the text for the history.
fn paint_layer(settings: &mut StrokeSettings, layer: &LayerSettings) -> String {
    let layer = &LayerSettings { color: layer.color.map(in_file), ..layer.clone() };
    let name = &layer.name;
    let place = settings.layers.iter().position(|other| other.name == *name);
    let was_hidden = place.and_then(|place| settings.layers[place].hidden);
    let states_nothing = *layer == LayerSettings { name: name.clone(), ..LayerSettings::default() };
    match place {
        Some(place) if states_nothing => drop(settings.layers.remove(place)),
        Some(place) => settings.layers[place].clone_from(layer),
        None if states_nothing => {}
        None => settings.layers.push(layer.clone()),
    }
    match layer.hidden {
        hidden if hidden == was_hidden => format!("Paint: {name}"),
        Some(true) => format!("Hide layer {name}"),
        Some(false) => format!("Show layer {name}"),
        // `hidden` is no longer stated, so the inherited value counts. It is assumed to be the opposite of the old one.
        None if was_hidden == Some(false) => format!("Hide layer {name}"),
        None => format!("Show layer {name}"),
    }
}
