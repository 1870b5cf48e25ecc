//! Tests of layers of paint that are hidden, or laid in another order.

use std::collections::BTreeMap;

use impasto_painting::frame::{Frame, Quality};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{LayerSettings, Scene};
use impasto_scene::presets::LayerKind;
use impasto_tests::shapes;

const OPTIONS: FrameOptions = FrameOptions::new([320, 180]);

/// A sheet that faces the camera, with all layers of paint.
fn sheet(change: impl FnOnce(&mut Scene)) -> Painting {
    let mut scene = shapes::scene(vec![shapes::object("Sheet", 800)]);
    change(&mut scene);
    prepare(shapes::loaded(scene, [shapes::sheet(1)])).unwrap()
}

fn in_order(order: [LayerKind; 7]) -> impl FnOnce(&mut Scene) {
    move |scene| scene.strokes.order = order.map(|kind| kind.name().to_owned()).to_vec()
}

/// Each layer of a frame with its strokes, in the order in which they are laid.
fn layers(frame: &Frame) -> Vec<(LayerKind, String)> {
    let strokes = |first: u32, count: u32| {
        let range = first as usize..(first + count) as usize;
        format!("{:?}", &frame.strokes[range])
    };
    frame.layers.iter().map(|run| (run.kind, strokes(run.first, run.count))).collect()
}

#[test]
fn an_order_changes_who_lies_over_whom_and_no_stroke() {
    let mut reversed = LayerKind::ALL;
    reversed.reverse();
    let usual = layers(&sheet(|_| ()).at(0.0, &OPTIONS));
    let stated = layers(&sheet(in_order(LayerKind::ALL)).at(0.0, &OPTIONS));
    assert_eq!(usual, stated);
    let painting = sheet(in_order(reversed));
    let turned = layers(&painting.at(0.0, &OPTIONS));
    assert!(usual.len() >= 4, "{} layers", usual.len());
    let kinds =
        |layers: &[(LayerKind, String)]| -> Vec<LayerKind> { layers.iter().map(|(kind, _)| *kind).collect() };
    let mut expected = kinds(&usual);
    expected.reverse();
    assert_eq!(kinds(&turned), expected);
    let named = |layers| -> BTreeMap<LayerKind, String> { Vec::into_iter(layers).collect() };
    assert!(named(usual) == named(turned), "a stroke has changed");
    let possible: Vec<LayerKind> = painting.paint_layers().into_iter().map(|(_, kind)| kind).collect();
    assert_eq!(possible.first(), Some(&LayerKind::Lights));
}

#[test]
fn a_draft_has_the_underpainting_where_something_lies_under_it() {
    let draft = FrameOptions { quality: Quality::Draft, ..OPTIONS };
    let has_it = |painting: &Painting| {
        let frame = painting.at(0.0, &draft);
        frame.layers.iter().any(|run| run.kind == LayerKind::Underpainting && run.count > 0)
    };
    assert!(!has_it(&sheet(|_| ())));
    let mut order = LayerKind::ALL;
    order.swap(0, 1);
    assert!(has_it(&sheet(in_order(order))));
}

#[test]
fn a_hidden_layer_is_left_out_as_if_it_had_no_coverage() {
    let layer = |hidden, coverage| {
        let name = LayerKind::Form.name().to_owned();
        let layer = LayerSettings { name, hidden, coverage, ..LayerSettings::default() };
        layers(&sheet(|scene| scene.strokes.layers = vec![layer]).at(0.0, &OPTIONS))
    };
    let hidden = layer(Some(true), Some(2.0));
    assert!(hidden.iter().all(|(kind, _)| *kind != LayerKind::Form));
    assert_eq!(hidden, layer(None, Some(0.0)));
    assert!(layer(Some(false), Some(2.0)).iter().any(|(kind, _)| *kind == LayerKind::Form));
}
