//! A preset of the user's own: stroke settings as a file, for other scenes.

use serde::{Deserialize, Serialize};

use crate::document::{BrushMix, Edges, LayerSettings, STROKE_NUMBERS, Scene, StrokeSettings};
use crate::limits::MAX_STROKE_PX;
use crate::presets::{self, GROUND, LayerKind};

/// Stroke settings that hold for no scene in particular.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct StrokesFile {
    /// Version of the format: 1.
    pub version: u32,
    /// The height of the picture that sizes in pixels are meant for. In a scene of another height, they are scaled.
    pub height_px: u32,
    /// The settings. Brushes that are pictures lie in the folder of the file.
    #[serde(default)]
    pub strokes: StrokeSettings,
}

impl StrokesFile {
    /// The settings of the scene, or of its region with this index, together with what the region takes from the scene.
    /// What belongs to this scene alone is left out: changes over time, and which regions lie over which.
    pub fn of(scene: &Scene, region: Option<usize>) -> Self {
        let mut strokes = match region {
            None => scene.strokes.clone(),
            Some(region) => with_what_it_takes(scene, &scene.regions[region].strokes),
        };
        if strokes.preset.is_none() {
            let usual = scene.style.info().preset.unwrap_or(presets::DEFAULT_PRESET);
            strokes.preset = Some(usual.to_owned());
        }
        strokes.keys.clear();
        strokes.layer = None;
        Self { version: Scene::VERSION, height_px: scene.size.1, strokes }
    }

    /// The settings for a scene of this height, in place of `own`. What belongs to that scene stays: its changes over
    /// time, and which region lies over which. So do its ground and its order of layers where the preset states none. A
    /// region has no ground and no order of layers.
    pub fn applied_to(&self, own: &StrokeSettings, height_px: u32, is_region: bool) -> StrokeSettings {
        let mut strokes = self.strokes.clone();
        scale(&mut strokes, f64::from(height_px) / f64::from(self.height_px.max(1)));
        strokes.keys.clone_from(&own.keys);
        strokes.layer = own.layer;
        if is_region {
            strokes.order.clear();
            strokes.layers.retain(|layer| layer.name != GROUND);
            return strokes;
        }
        if strokes.order.is_empty() {
            strokes.order.clone_from(&own.order);
        }
        if strokes.layers.iter().all(|layer| layer.name != GROUND) {
            strokes.layers.extend(own.layers.iter().filter(|layer| layer.name == GROUND).cloned());
        }
        strokes
    }

    /// Each brush that is a picture, once.
    pub fn brush_pictures(&self) -> Vec<&str> {
        let mixes = self.strokes.layers.iter().map(|layer| &layer.brush).chain([&self.strokes.brush]);
        let names = mixes.flatten().flat_map(|mix| &mix.0).map(String::as_str);
        let mut pictures: Vec<&str> = names.filter(|name| presets::is_picture(name)).collect();
        pictures.sort_unstable();
        pictures.dedup();
        pictures
    }

    /// The same without the brushes that are pictures. A mix that holds only pictures is left out.
    pub fn without_pictures(&self) -> Self {
        let mut bare = self.clone();
        let strokes = &mut bare.strokes;
        for brush in strokes.layers.iter_mut().map(|layer| &mut layer.brush).chain([&mut strokes.brush]) {
            if let Some(BrushMix(names)) = brush {
                names.retain(|name| !presets::is_picture(name));
            }
            brush.take_if(|BrushMix(names)| names.is_empty());
        }
        bare
    }

    /// Gives brushes other names.
    pub fn rename_brushes(&mut self, renamed: impl Fn(&str) -> Option<String>) {
        let strokes = &mut self.strokes;
        let mixes = strokes.layers.iter_mut().map(|layer| &mut layer.brush).chain([&mut strokes.brush]);
        for name in mixes.flatten().flat_map(|mix| &mut mix.0) {
            if let Some(other) = renamed(name) {
                *name = other;
            }
        }
    }
}

/// Multiplies all sizes in pixels by a factor.
fn scale(strokes: &mut StrokeSettings, factor: f64) {
    if factor == 1.0 {
        return;
    }
    let scaled = |px: f64| size_px(px * factor);
    strokes.length_px = strokes.length_px.map(scaled);
    strokes.width_px = strokes.width_px.map(scaled);
    for layer in &mut strokes.layers {
        layer.length_px = layer.length_px.map(scaled);
        layer.width_px = layer.width_px.map(scaled);
    }
    if let Some(Edges::Overrun(px)) = &mut strokes.edges {
        *px = tidy((*px * factor).min(MAX_STROKE_PX));
    }
}

fn tidy(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// A length or width, clamped to what a file may state, and rounded.
fn size_px(px: f64) -> f64 {
    tidy(px.clamp(0.001, MAX_STROKE_PX))
}

/// A region's settings with those that it takes from the scene. A region with a preset takes nothing.
fn with_what_it_takes(scene: &Scene, own: &StrokeSettings) -> StrokeSettings {
    if own.preset.is_some() {
        return own.clone();
    }
    let resolved = presets::resolve_with(scene, &scene.strokes, Some(own));
    let mut all = scene.strokes.clone();
    for row in STROKE_NUMBERS {
        let stated = (row.number.get)(own).or((row.number.get)(&all));
        *(row.number.of)(&mut all) = stated;
    }
    // Scene and region may each state length, width and scale, which act on each other. The sizes that result are
    // written in their place.
    let states_sizes = all.length_px.or(all.width_px).or(all.scale).is_some();
    if states_sizes {
        all.length_px = Some(size_px(f64::from(resolved.body().length_px)));
        all.width_px = Some(size_px(f64::from(resolved.body().width_px)));
        all.scale = None;
    }
    all.order.clear();
    all.brush = own.brush.clone().or(all.brush);
    all.edges = own.edges.or(all.edges);
    all.palette = own.palette.clone().or(all.palette);
    let is_sized_body = |layer: &LayerSettings| {
        layer.name == LayerKind::Body.name() && layer.length_px.or(layer.width_px).is_some()
    };
    // The sizes of the other layers usually follow from the body's. If the list of layers states a size for `body`,
    // they do not, so the sizes of all layers are written into the list.
    let states_each = states_sizes && all.layers.iter().chain(&own.layers).any(is_sized_body);
    let of_region: Vec<String> = own.layers.iter().map(|layer| layer.name.clone()).collect();
    let each = LayerKind::ALL.map(LayerKind::name).into_iter().filter(|_| states_each);
    for name in of_region.iter().map(String::as_str).chain(each) {
        if all.layers.iter().all(|other| other.name != name) {
            all.layers.push(LayerSettings { name: name.to_owned(), ..LayerSettings::default() });
        }
    }
    all.layers.retain(|layer| layer.name != GROUND);
    for layer in &mut all.layers {
        let of_region = own.layers.iter().find(|other| other.name == layer.name);
        let Some(kind) = LayerKind::ALL.into_iter().find(|kind| kind.name() == layer.name) else { continue };
        let found = resolved.layer_of(kind);
        if layer.brush.is_some() || of_region.is_some_and(|other| other.brush.is_some()) {
            layer.brush = Some(BrushMix(found.brushes.clone()));
        }
        if layer.hidden.is_some() || of_region.is_some_and(|other| other.hidden.is_some()) {
            layer.hidden = found.hidden.then_some(true);
        }
        for row in LayerSettings::NUMBERS {
            let stated = |layer: &LayerSettings| (row.number.get)(layer).is_some();
            let is_size = matches!(row.number.field, "length_px" | "width_px");
            if stated(layer) || of_region.is_some_and(stated) || is_size && states_each {
                let value = f64::from(*(row.resolved)(&mut found.clone()));
                *(row.number.of)(layer) = Some(if is_size { size_px(value) } else { tidy(value) });
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Region, Selector, StrokesKey};
    use crate::new_scene;

    fn layer(name: &str) -> LayerSettings {
        LayerSettings { name: name.to_owned(), ..LayerSettings::default() }
    }

    fn scene() -> Scene {
        let mut scene = new_scene::empty();
        scene.size = (1280, 720);
        scene.strokes = StrokeSettings {
            scale: Some(0.5),
            coverage: Some(2.0),
            edges: Some(Edges::Overrun(4.0)),
            layers: vec![
                LayerSettings { opacity: Some(0.5), length_px: Some(40.0), ..layer("form") },
                LayerSettings { hidden: Some(true), ..layer("lights") },
                LayerSettings { opacity: Some(0.75), ..layer("ground") },
            ],
            keys: vec![StrokesKey::at(3.0)],
            ..StrokeSettings::default()
        };
        let of_region = StrokeSettings {
            width_px: Some(9.0),
            scale: Some(2.0),
            taper: Some(0.5),
            layer: Some(3),
            layers: vec![LayerSettings { coverage: Some(3.0), ..layer("form") }],
            ..StrokeSettings::default()
        };
        let region = Region { strokes: of_region, ..Region::new("skin", Selector::Everything) };
        scene.regions.push(region);
        scene
    }

    #[test]
    fn what_is_saved_of_a_region_looks_as_it_does_there_in_any_other_scene() {
        for body in [None, Some(LayerSettings { length_px: Some(100.0), ..layer("body") })] {
            let mut scene = scene();
            scene.strokes.layers.extend(body);
            looks_as_it_does_there(&scene);
        }
    }

    fn looks_as_it_does_there(scene: &Scene) {
        let preset = StrokesFile::of(scene, Some(0));
        assert!(preset.strokes.keys.is_empty() && preset.strokes.layer.is_none());
        let wanted = presets::resolve(scene, Some(0));
        let mut other = new_scene::empty();
        other.size = scene.size;
        other.strokes.preset = Some("impressionist".to_owned());
        other.regions.push(Region::new("else", Selector::Everything));
        other.regions[0].strokes.layer = Some(-1);
        other.regions[0].strokes = preset.applied_to(&other.regions[0].strokes, other.size.1, true);
        let found = presets::resolve(&other, Some(0));
        for (found, wanted) in found.layers.iter().zip(&wanted.layers) {
            assert!((found.length_px - wanted.length_px).abs() < 1e-3, "{found:?} {wanted:?}");
            assert!((found.width_px - wanted.width_px).abs() < 1e-3, "{found:?} {wanted:?}");
            let same = |layer: &presets::ResolvedLayer| {
                let mut layer = layer.clone();
                (layer.length_px, layer.width_px) = (0.0, 0.0);
                layer
            };
            assert_eq!(same(found), same(wanted));
        }
        assert_eq!((found.taper, found.edges, found.layer), (wanted.taper, wanted.edges, -1));
    }

    #[test]
    fn the_preset_of_a_region_leaves_a_scene_its_ground_and_its_order() {
        let mut from = scene();
        from.strokes.order = LayerKind::ALL.map(|kind| kind.name().to_owned()).into_iter().rev().collect();
        let preset = StrokesFile::of(&from, Some(0));
        let order: Vec<String> = LayerKind::ALL.map(|kind| kind.name().to_owned()).into();
        let ground = LayerSettings { opacity: Some(0.9), ..layer("ground") };
        let own = StrokeSettings { order: order.clone(), layers: vec![ground.clone()], ..Default::default() };
        let applied = preset.applied_to(&own, 720, false);
        assert_eq!(applied.order, order);
        assert!(applied.layers.contains(&ground) && applied.layers.len() > 1);
    }

    #[test]
    fn pixels_are_scaled_to_the_height_of_a_scene_and_what_is_not_stated_stays() {
        let preset = StrokesFile::of(&scene(), None);
        assert_eq!(preset.strokes.preset.as_deref(), Some(presets::DEFAULT_PRESET));
        let own =
            StrokeSettings { keys: vec![StrokesKey::at(7.0)], layer: Some(2), ..StrokeSettings::default() };
        let applied = preset.applied_to(&own, 360, false);
        assert_eq!((applied.keys.len(), applied.keys[0].frame, applied.layer), (1, 7.0, Some(2)));
        assert_eq!(applied.layers[0].length_px, Some(20.0));
        assert_eq!(applied.edges, Some(Edges::Overrun(2.0)));
        assert_eq!(applied.scale, Some(0.5), "the scale is no size in pixels, and was scaled");
        let same = preset.applied_to(&StrokeSettings::default(), 720, false);
        assert_eq!(same, preset.strokes);
    }

    #[test]
    fn pictures_of_brushes_are_found_and_renamed() {
        let mut preset = StrokesFile::of(&scene(), None);
        let mix = |names: &[&str]| Some(BrushMix(names.iter().map(|name| (*name).to_owned()).collect()));
        preset.strokes.brush = mix(&["round", "b.png", "a.png", "b.png"]);
        preset.strokes.layers[0].brush = mix(&["a.png", "c.png"]);
        assert_eq!(preset.brush_pictures(), ["a.png", "b.png", "c.png"]);
        preset.rename_brushes(|name| (name == "b.png").then(|| "brushes/b.png".to_owned()));
        assert_eq!(preset.strokes.brush, mix(&["round", "brushes/b.png", "a.png", "brushes/b.png"]));
        let bare = preset.without_pictures();
        assert_eq!((bare.strokes.brush, &bare.strokes.layers[0].brush), (mix(&["round"]), &None));
    }
}
