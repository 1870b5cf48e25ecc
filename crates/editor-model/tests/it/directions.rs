//! Tests of edits of regions: guides that are simplified, dabs, pasted strokes, and a new reference.

use std::path::Path;

use glam::DVec3;
use impasto_editor_model::Document;
use impasto_editor_model::command::{Command, Directions, Regions, StrokesOf};
use impasto_scene::document::{
    Dab, Direction, Falloff, Guide, GuidePoint, Reference, Region, Selector, StrokeSettings,
};
use impasto_scene::load::LoadOptions;

fn guide(from: f64, radius: f64, strength: f64) -> Guide {
    let point = |x: f64| GuidePoint { at: [from + x, 0.0, 0.0], normal: [0.0, 0.0, 1.0], turn_deg: 0.0 };
    Guide {
        mode: Default::default(),
        curve: false,
        object: None,
        view: None,
        points: vec![point(0.0), point(0.1)],
        radius,
        strength,
        falloff: Falloff::Flat,
    }
}

/// A cube that stands still and one that turns, with this region.
fn with_region(region: Region) -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
    let mut document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    document.apply(&Command::Regions(Regions::Add(Box::new(region)))).expect("it is added");
    document
}

fn region(document: &Document) -> &Region {
    document.scene().regions.iter().find(|region| region.name == "patch").expect("it is there")
}

#[test]
fn a_guide_is_dropped_only_where_a_later_one_covers_it_at_full_strength() {
    for (strength, left) in [(1.0, 1), (0.9, 2)] {
        let guides = vec![guide(0.0, 0.05, 1.0), guide(0.0, 0.2, strength)];
        let mut document =
            with_region(Region { guides, ..Region::new("patch", Selector::Object("still".to_owned())) });
        let simplify = Directions::Simplify { region: "patch".to_owned(), tolerance: 1e-6 };
        let _ = document.apply(&Command::Directions(simplify));
        assert_eq!(region(&document).guides.len(), left, "covered at strength {strength}");
    }
}

#[test]
fn dabs_are_added_to_those_of_a_region() {
    let dab = |x: f64| Dab { at: [x, 0.0, 0.4], normal: [0.0, 0.0, 1.0], radius: 0.1, take_away: false };
    let on = Selector::Dabs("still".to_owned(), vec![dab(0.0)]);
    let mut document = with_region(Region::new("patch", on));
    let paint = Regions::Paint { region: "patch".to_owned(), dabs: vec![dab(0.1), dab(0.2)] };
    document.apply(&Command::Regions(paint)).expect("it fits");
    let Selector::Dabs(_, dabs) = &region(&document).on else { panic!("{:?}", region(&document).on) };
    assert_eq!(*dabs, [dab(0.0), dab(0.1), dab(0.2)]);
}

#[test]
fn strokes_pasted_to_a_region_bring_no_order_of_layers() {
    let mut document = with_region(Region::new("patch", Selector::Object("still".to_owned())));
    let pasted = StrokeSettings {
        length_px: Some(33.0),
        order: vec!["body".to_owned(), "detail".to_owned()],
        ..StrokeSettings::default()
    };
    let of = StrokesOf::Region("patch".to_owned());
    document.apply(&Command::Regions(Regions::PasteStrokes(of, Box::new(pasted)))).expect("it fits");
    let strokes = &region(&document).strokes;
    assert_eq!(strokes.length_px, Some(33.0));
    assert!(strokes.order.is_empty(), "{:?}", strokes.order);
}

/// A region's directions look as before: its guides get the view of the old reference, and its angle keeps that
/// reference.
#[test]
fn a_new_reference_leaves_the_directions_of_regions() {
    let direction = Direction::Angle(30.0);
    let on = Selector::Object("turning".to_owned());
    let guides = vec![guide(0.0, 0.1, 1.0)];
    let mut document = with_region(Region { direction, guides, ..Region::new("patch", on) });
    let old = document.scene().reference.clone();
    document.apply(&Command::Directions(Directions::Recapture(7))).expect("it fits");
    assert_eq!(document.scene().reference, Reference::Frame(7));
    let region = region(&document);
    assert_eq!(region.reference, Some(old));
    let view = region.guides[0].view.as_ref().expect("the guide has a view");
    assert!(DVec3::from(view.eye).distance(DVec3::from(view.target)) > 0.1, "{view:?}");
}
