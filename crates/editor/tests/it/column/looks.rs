//! Tests that the editor's right column, with the tree above and the inspector below, looks as it did: compares
//! pictures of it with stored ones.

use crate::headless::Headless;
use egui::{Vec2, vec2};
use egui_kittest::{SnapshotOptions, SnapshotResults};
use impasto_editor::panels::Control;
use impasto_editor::theme::Theme;
use impasto_editor_model::command::{Command, Edit, Regions, StrokeChange, StrokesOf};
use impasto_editor_model::session::Mode;
use impasto_editor_model::{Item, Selection};
use impasto_gl_render::context::Driver;
use impasto_scene::document::LayerSettings;

use super::{Column, SIZE, build, builder, object, region, with_guides};

/// A tolerance for drivers that round colours differently. A misplaced or recoloured control exceeds it by far.
fn options() -> SnapshotOptions {
    SnapshotOptions::new().threshold(0.6)
}

fn picture(name: &str, (column, theme): (Column, Theme), size: Vec2) -> SnapshotResults {
    let builder = builder(theme, size).renderer(Headless::open(Driver::Auto));
    let mut harness = build(builder, column);
    harness.snapshot_options(name, &options());
    harness.take_snapshot_results()
}

#[test]
fn the_column_looks_as_it_did() {
    let mut all = SnapshotResults::new();
    let of = |scene: &str, selected: Option<Item>| {
        let mut column = Column::open(scene);
        column.document.select(selected.into_iter().collect());
        column
    };
    let mut skin = of("apple.ron", region("apple"));
    with_guides(&mut skin);
    skin.apply(Command::Edit(Edit::SetLocked(vec![Item::Object("wall".to_owned())], true)));
    let of_strokes =
        |change| Command::Regions(Regions::SetStroke(StrokesOf::Region("apple".to_owned()), change));
    skin.apply(of_strokes(StrokeChange::Number("coverage", Some(3.0))));
    all.extend(picture("column_region_dark", (skin, Theme::Dark), SIZE));
    let mut skin = of("apple.ron", None);
    with_guides(&mut skin);
    skin.document.select(Selection::only(Item::Guide("apple".to_owned(), 1)));
    skin.tree_height = 240.0;
    all.extend(picture("column_guide_light", (skin, Theme::Light), vec2(336.0, 760.0)));
    let mut posed = of("still_life.ron", object("apple"));
    posed.session.mode = Mode::Animate;
    posed.session.frame = 40.0;
    all.extend(picture("column_pose_dark", (posed, Theme::Dark), vec2(280.0, 512.0)));
    all.extend(picture("column_object_light", (of("still_life.ron", object("jug")), Theme::Light), SIZE));
    all.extend(picture(
        "column_light_dark",
        (of("still_life.ron", Some(Item::Light("window".to_owned()))), Theme::Dark),
        SIZE,
    ));
    all.extend(picture("column_camera_dark", (of("still_life.ron", Some(Item::Camera)), Theme::Dark), SIZE));
    all.extend(picture("column_scene_dark", (of("still_life.ron", None), Theme::Dark), SIZE));
    let mut layers = of("still_life.ron", None);
    layers.tree_height = 40.0;
    let hidden = |name: &str| {
        StrokeChange::PaintLayer(Box::new(LayerSettings {
            name: name.to_owned(),
            hidden: Some(true),
            opacity: Some(0.5),
            ..LayerSettings::default()
        }))
    };
    let of_scene = |change| Command::Regions(Regions::SetStroke(StrokesOf::Scene, change));
    layers.apply(of_scene(hidden("scumble")));
    layers.reach = Some(Control { name: "Layer form".to_owned(), section: "Paint layers".to_owned() });
    all.extend(picture("column_layers_dark", (layers, Theme::Dark), vec2(280.0, 480.0)));
    let ink = of("sumi_e_carp.ron", None);
    all.extend(picture("column_ink_light", (ink, Theme::Light), vec2(280.0, 1240.0)));
}
