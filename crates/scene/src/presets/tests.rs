//! Tests of presets and of resolved stroke settings.

use std::collections::HashSet;

use super::*;
use crate::document::{Camera, Direction, Edges, Region, RotatingStrokes, STROKE_NUMBERS, Selector, Style};

fn scene(strokes: StrokeSettings, of_region: StrokeSettings) -> Scene {
    Scene {
        version: Scene::VERSION,
        size: (640, 360),
        seed: 0,
        background: Default::default(),
        background_keys: Vec::new(),
        exposure: 0.0,
        shot: None,
        stage: Default::default(),
        timeline: Default::default(),
        reference: Default::default(),
        further_references: Vec::new(),
        camera: Camera { of_shot: None, lens: Default::default(), keys: Vec::new() },
        lights: Vec::new(),
        objects: Vec::new(),
        strokes,
        regions: vec![Region {
            direction: Direction::Up,
            strokes: of_region,
            ..Region::new("skin", Selector::Everything)
        }],
        touches: Vec::new(),
        style: Default::default(),
        aovs: Vec::new(),
    }
}

fn body(strokes: &ResolvedStrokes) -> (f32, f32, f32) {
    let body = strokes.body();
    (body.length_px, body.width_px, body.coverage)
}

#[test]
fn a_scene_without_settings_is_an_oil_study_of_its_own_height() {
    let mut plain = scene(StrokeSettings::default(), StrokeSettings::default());
    let strokes = resolve(&plain, None);
    // Presets are stated for a height of 720 pixels; this scene is 360 high.
    assert_eq!(body(&strokes), (39.0, 12.5, 2.7));
    assert!((strokes.angle_jitter_rad.to_degrees() - 7.0).abs() < 1e-5);
    assert_eq!(strokes.edges, Edges::Overrun(1.5));
    plain.size = (1280, 720);
    assert_eq!(body(&resolve(&plain, None)), (78.0, 25.0, 2.7));
}

#[test]
fn the_nearest_statement_wins() {
    let of_scene = StrokeSettings { width_px: Some(9.0), coverage: Some(2.0), ..Default::default() };
    let of_region = StrokeSettings { width_px: Some(3.0), layer: Some(2), ..Default::default() };
    let scene = scene(of_scene, of_region);
    let (everywhere, region) = (resolve(&scene, None), resolve(&scene, Some(0)));
    assert_eq!((body(&everywhere), everywhere.layer), ((39.0, 9.0, 2.0), 0));
    assert_eq!((body(&region), region.layer), ((39.0, 3.0, 2.0), 2));
}

#[test]
fn other_layers_keep_their_proportion_to_the_body() {
    let usual = resolve(&scene(StrokeSettings::default(), StrokeSettings::default()), None);
    let sized = |settings: StrokeSettings| resolve(&scene(settings, StrokeSettings::default()), None);
    let halved = sized(StrokeSettings { scale: Some(0.5), ..Default::default() });
    let stated = sized(StrokeSettings {
        length_px: Some(39.0 * 0.5),
        width_px: Some(12.5 * 0.5),
        ..Default::default()
    });
    for strokes in [halved, stated] {
        for (half, whole) in strokes.layers.iter().zip(&usual.layers) {
            assert!((half.length_px * 2.0 - whole.length_px).abs() < 1e-4);
            assert!((half.width_px * 2.0 - whole.width_px).abs() < 1e-4);
        }
    }
}

#[test]
fn one_layer_can_differ_alone() {
    let scumble = LayerSettings {
        name: "scumble".to_owned(),
        coverage: Some(0.0),
        brush: Some(BrushMix(vec!["fan".to_owned()])),
        ..Default::default()
    };
    let usual = resolve(&scene(StrokeSettings::default(), StrokeSettings::default()), None);
    let settings = StrokeSettings { layers: vec![scumble], ..Default::default() };
    let strokes = resolve(&scene(settings, StrokeSettings::default()), None);
    assert_eq!(strokes.layer_of(LayerKind::Scumble).coverage, 0.0);
    assert_eq!(strokes.layer_of(LayerKind::Scumble).brushes, ["fan"]);
    for kind in LayerKind::ALL.into_iter().filter(|kind| *kind != LayerKind::Scumble) {
        assert_eq!(strokes.layer_of(kind), usual.layer_of(kind));
    }
}

#[test]
fn a_regions_preset_replaces_the_scenes_values_and_not_its_own() {
    let of_scene = StrokeSettings { width_px: Some(9.0), ..Default::default() };
    let impressionist = Some("impressionist".to_owned());
    let of_region = StrokeSettings { preset: impressionist, coverage: Some(1.0), ..Default::default() };
    let region = resolve(&scene(of_scene, of_region), Some(0));
    assert_eq!(body(&region), (18.0, 7.0, 1.0));
}

#[test]
fn the_papers_rule_has_no_jitter_and_belongs_to_the_scene() {
    let paper = StrokeSettings { preset: Some(PAPER_PRESET.to_owned()), ..Default::default() };
    let by_scene = scene(paper.clone(), StrokeSettings::default());
    let strokes = resolve(&by_scene, Some(0));
    assert_eq!((strokes.angle_jitter_rad, strokes.size_jitter, strokes.flatness), (0.0, 0.0, 1.0));
    assert_eq!((strokes.swing_rad, strokes.color_jitter, strokes.grading), (0.0, 0.0, 0.0));
    let others = LayerKind::ALL.into_iter().filter(|kind| *kind != LayerKind::Body);
    assert!(others.into_iter().all(|kind| strokes.layer_of(kind).coverage == 0.0));
    assert!(is_paper(&by_scene));
    assert!(!is_paper(&scene(StrokeSettings::default(), paper)));
}

#[test]
fn a_style_paints_the_layers_that_it_draws() {
    let mut scene = scene(StrokeSettings::default(), StrokeSettings::default());
    let painted =
        |scene: &Scene| LayerKind::ALL.into_iter().filter(|kind| paints_layer(scene, *kind)).count();
    assert_eq!(painted(&scene), 7);
    scene.style = Style::RotatingStrokes(RotatingStrokes { underpainting: false, ..Default::default() });
    assert!(painted(&scene) == 6 && !paints_layer(&scene, LayerKind::Underpainting));
    scene.style = Style::SumiE(Default::default());
    assert!(painted(&scene) == 4 && !paints_layer(&scene, LayerKind::Lights));
    scene.strokes.preset = Some(PAPER_PRESET.to_owned());
    assert!(painted(&scene) == 1 && paints_layer(&scene, LayerKind::Body));
}

#[test]
fn every_preset_names_brushes_that_exist() {
    for preset in &PRESETS {
        for layer in ResolvedStrokes::of_preset(preset, 1.0).layers {
            assert!(!layer.brushes.is_empty());
            assert!(layer.brushes.iter().all(|brush| impasto_core::brush::NAMES.contains(&brush.as_str())));
        }
    }
    assert_eq!(names().next(), Some(DEFAULT_PRESET));
}

#[test]
fn a_hidden_layer_paints_nothing_and_keeps_its_numbers() {
    let layer = |name: &str, hidden| LayerSettings {
        name: name.to_owned(),
        hidden: Some(hidden),
        thickness: Some(0.25),
        ..Default::default()
    };
    let of_scene = StrokeSettings {
        layers: vec![layer("form", true), layer("lights", true), layer("body", false), layer(GROUND, true)],
        ..Default::default()
    };
    let of_region = StrokeSettings { layers: vec![layer("lights", false)], ..Default::default() };
    let scene = scene(of_scene, of_region.clone());
    let coverage = |strokes: &ResolvedStrokes, kind| strokes.layer_of(kind).coverage;
    let (everywhere, region) = (resolve(&scene, None), resolve(&scene, Some(0)));
    let kinds = [LayerKind::Body, LayerKind::Form, LayerKind::Lights];
    assert_eq!(kinds.map(|kind| coverage(&everywhere, kind)), [2.7, 0.0, 0.0]);
    assert_eq!(kinds.map(|kind| coverage(&region, kind)), [2.7, 0.0, 0.25], "the region hides lights");
    assert_eq!(everywhere.layer_of(LayerKind::Form).thickness, 0.25);
    assert!(everywhere.at(0.0).layer_of(LayerKind::Form).coverage == 0.0);
    let edited = resolve_with(&scene, &scene.strokes, None);
    assert_eq!((coverage(&edited, LayerKind::Form), edited.layer_of(LayerKind::Form).hidden), (1.25, true));
    assert_eq!(ground(&scene).opacity, 0.0);
}

#[test]
fn the_order_of_layers_is_the_scenes_or_the_usual_one() {
    let names = |kinds: [LayerKind; 7]| kinds.map(|kind| kind.name().to_owned()).to_vec();
    let mut kinds = LayerKind::ALL;
    let order =
        |order| laying_order(&scene(StrokeSettings { order, ..Default::default() }, Default::default()));
    assert_eq!(order(Vec::new()), LayerKind::ALL);
    kinds.reverse();
    kinds.swap(0, 3);
    assert_eq!(order(names(kinds)), kinds);
    // An order that `check` refuses counts as no order.
    assert_eq!(order(names(kinds)[1..].to_vec()), LayerKind::ALL);
    assert_eq!(order(vec!["body".to_owned(); 7]), LayerKind::ALL);
}

#[test]
fn the_ground_is_the_last_that_is_stated() {
    let ground = LayerSettings {
        name: GROUND.to_owned(),
        color: Some(Color([0.5, 0.25, 0.0])),
        opacity: Some(0.75),
        ..Default::default()
    };
    let settings = StrokeSettings { layers: vec![ground], ..Default::default() };
    let found = super::ground(&scene(settings, StrokeSettings::default()));
    assert_eq!(found, ResolvedGround { color: Color([0.5, 0.25, 0.0]), opacity: 0.75 });
    assert!(super::ground(&scene(StrokeSettings::default(), StrokeSettings::default())).opacity < 0.5);
}

#[test]
fn every_row_of_the_table_of_stroke_numbers_is_sound() {
    let (mut fields, mut places) = (HashSet::new(), HashSet::new());
    for row in STROKE_NUMBERS {
        let number = &row.number;
        assert!(fields.insert(number.field), "{} is there twice", number.field);
        assert!(places.insert(row.shown.place), "{}: another stands at {:?}", number.field, row.shown.place);
        assert!(number.effect.ends_with('.') && !row.shown.label.is_empty(), "{row:?}");
        for preset in &PRESETS {
            let value = (row.resolved)(&ResolvedStrokes::of_preset(preset, 1.0));
            assert!(number.limits.contains(&value), "{} {value} in {}", number.field, preset.name);
        }
    }
}

#[test]
fn a_stated_number_resolves_to_itself() {
    for row in STROKE_NUMBERS.iter().filter(|row| row.number.field != "scale") {
        let stated = (row.number.limits.end().min(90.0) * 0.5).max(0.5);
        let mut settings = StrokeSettings::default();
        *(row.number.of)(&mut settings) = Some(stated);
        let strokes = resolve(&scene(settings, StrokeSettings::default()), None);
        assert!(((row.resolved)(&strokes) - stated).abs() < 1e-5, "{}", row.number.field);
    }
}
