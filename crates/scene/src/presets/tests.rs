use super::*;
use crate::document::{Camera, Direction, Region, Selector};

fn scene(strokes: StrokeSettings, of_region: StrokeSettings) -> Scene {
    Scene {
        version: Scene::VERSION,
        size: (640, 360),
        seed: 0,
        background: Default::default(),
        timeline: Default::default(),
        reference: Default::default(),
        camera: Camera { lens: Default::default(), keys: Vec::new() },
        lights: Vec::new(),
        objects: Vec::new(),
        strokes,
        regions: vec![Region {
            name: "skin".to_owned(),
            on: Selector::Everything,
            direction: Direction::Up,
            strokes: of_region,
        }],
        style: Default::default(),
    }
}

#[test]
fn a_scene_without_settings_is_an_oil_study() {
    let strokes = resolve(&scene(StrokeSettings::default(), StrokeSettings::default()), None);
    assert_eq!((strokes.length_px, strokes.width_px, strokes.coverage), (34.0, 11.0, 3.0));
    assert_eq!(strokes.brush, "filbert");
    assert!((strokes.angle_jitter_rad.to_degrees() - 7.0).abs() < 1e-5);
}

#[test]
fn the_nearest_statement_wins() {
    let of_scene = StrokeSettings { width_px: Some(9.0), coverage: Some(2.0), ..Default::default() };
    let of_region = StrokeSettings { width_px: Some(3.0), layer: Some(2), ..Default::default() };
    let scene = scene(of_scene, of_region);
    let (everywhere, region) = (resolve(&scene, None), resolve(&scene, Some(0)));
    assert_eq!((everywhere.width_px, everywhere.coverage, everywhere.layer), (9.0, 2.0, 0));
    assert_eq!((region.width_px, region.coverage, region.length_px, region.layer), (3.0, 2.0, 34.0, 2));
}

#[test]
fn a_regions_preset_replaces_the_scenes_values_and_not_its_own() {
    let of_scene = StrokeSettings { width_px: Some(9.0), ..Default::default() };
    let detail = Some("detail".to_owned());
    let of_region = StrokeSettings { preset: detail, coverage: Some(1.0), ..Default::default() };
    let region = resolve(&scene(of_scene, of_region), Some(0));
    assert_eq!((region.length_px, region.width_px, region.coverage), (16.0, 5.0, 1.0));
}

#[test]
fn the_papers_rule_has_no_jitter_and_belongs_to_the_scene() {
    let paper = StrokeSettings { preset: Some(PAPER_PRESET.to_owned()), ..Default::default() };
    let by_scene = scene(paper.clone(), StrokeSettings::default());
    let strokes = resolve(&by_scene, Some(0));
    assert_eq!((strokes.angle_jitter_rad, strokes.size_jitter, strokes.flatness), (0.0, 0.0, 1.0));
    assert!(is_paper(&by_scene));
    assert!(!is_paper(&scene(StrokeSettings::default(), paper)));
}

#[test]
fn every_preset_names_a_brush_that_exists() {
    assert!(PRESETS.iter().all(|preset| BRUSHES.contains(&preset.brush)));
    assert_eq!(names().next(), Some(DEFAULT_PRESET));
}
