//! Tests that the inspector shows every value that can be set, for each kind of item.

use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor_model::Item;
use impasto_scene::document::STROKE_NUMBERS;

use super::{assert_named, click, harness, object, pick, region, type_in};

#[test]
fn a_region_shows_all_that_can_be_set() {
    let mut harness = harness("still_life.ron", region("apple"));
    click(&mut harness, "Advanced");
    click(&mut harness, "Guides");
    click(&mut harness, "Paint layers");
    click(&mut harness, "Layer form");
    assert_named(
        &harness,
        &[
            "Region colour",
            "Region name",
            "Region hidden",
            "Region locked",
            "Direction",
            "Base direction",
            "Turn",
            "Sense lines",
            "Sense arrows",
            "Seam hard",
            "Seam soft",
            "Strokes",
            "Brush flat",
            "Brush filbert",
            "Brush round",
            "Brush fan",
            "Brush dry",
            "Brush knife",
            "Brush rigger",
            "Reset Brush",
            "Reset Length",
            "Add a pigment to the palette",
            "Material of apple",
            "Guides",
            "No guides. Comb over the region, or draw a curve (V).",
            "Advanced",
            "Preset",
            "Edges",
            "Paint layers",
            "Layer lights",
            "Hide layer lights",
            "Opacity of lights",
            "Layer underpainting",
            "Brush knife of form",
            "Layer length",
            "Layer width",
            "Layer coverage",
            "Thickness",
            "Layer dryness",
            "Layer pickup",
            "Seed",
            "Copy strokes",
            "Paste strokes",
        ],
    );
    let of_table: Vec<&str> = STROKE_NUMBERS.iter().map(|field| field.shown.label).collect();
    assert_named(&harness, &of_table);
    let on = |name: &str| harness.get_by_label(name).accesskit_node().toggled();
    assert_eq!(on("Brush filbert"), Some(egui::accesskit::Toggled::True));
    assert_eq!(on("Brush fan"), Some(egui::accesskit::Toggled::False));
    let length = harness.get_by_label("Length");
    assert_eq!(length.accesskit_node().value().as_deref(), Some("72px"));
}

#[test]
fn an_object_shows_all_that_can_be_set() {
    let mut harness = harness("apple.ron", object("apple"));
    for part in ["Mesh", "Parent", "Regions"] {
        let section = harness.get_by_role_and_label(Role::DisclosureTriangle, part);
        section.click();
        harness.run();
    }
    assert_named(
        &harness,
        &[
            "Object name",
            "Object hidden",
            "Object locked",
            "Transform",
            "Move X",
            "Move Y",
            "Move Z",
            "Turn X",
            "Turn Y",
            "Turn Z",
            "Uniform scale",
            "Mesh file",
            "Replace mesh",
            "Turn upright",
            "Scale to 1 m",
            "Particles auto",
            "Particles own",
            "Particle count",
            "Material colour",
            "Texture file",
            "Browse for Texture file",
            "Gloss",
            "Without light or shadow",
            "Parent",
            "Go to apple stem",
        ],
    );
    assert_eq!(
        harness.get_by_label("Turn Y").accesskit_node().value().as_deref(),
        Some("\u{2212}25.0\u{b0}")
    );
    click(&mut harness, "Replace mesh");
    assert_eq!(harness.state().meshes, ["apple"]);
}

#[test]
fn lights_camera_and_scene_show_all_that_can_be_set() {
    let sun = harness("still_life.ron", Some(Item::Light("window".to_owned())));
    assert_named(
        &sun,
        &["Light name", "Kind of light", "Light colour", "Intensity", "Shines X", "Shines Y", "Shines Z"],
    );
    let sky = harness("still_life.ron", Some(Item::Light("room".to_owned())));
    assert_named(&sky, &["Ground colour", "Reset Ground colour"]);
    let mut lamp = harness("still_life.ron", Some(Item::Light("pool".to_owned())));
    assert_named(&lamp, &["Place X", "Place Y", "Place Z"]);
    pick(&mut lamp, "Kind of light", "Spot");
    assert_named(&lamp, &["Place X", "Shines X", "Cone", "Fades from"]);
    type_in(&mut lamp, "Fades from", "30");
    type_in(&mut lamp, "Cone", "20");
    let scene = lamp.state().document.scene();
    let spot = scene.lights.iter().find(|light| light.name == "pool").expect("it is there");
    assert_eq!(spot.cone_deg, Some([20.0, 20.0]), "what fades ends with the cone");
    let camera = harness("still_life.ron", Some(Item::Camera));
    assert_named(
        &camera,
        &[
            "Perspective",
            "Parallel",
            "Field of view",
            "Near",
            "Far",
            "Eye X",
            "Target Z",
            "Roll",
            "Camera to this view",
            "To the shot",
        ],
    );
    let mut scene = harness("still_life.ron", None);
    click(&mut scene, "All strokes");
    click(&mut scene, "Reference");
    assert_named(
        &scene,
        &[
            "Width px",
            "Height px",
            "Background colour",
            "Rate",
            "First",
            "Last",
            "Style strokes",
            "Style plain",
            "Solver",
            "Canvas linen",
            "Canvas board",
            "Canvas follows camera",
            "Weave",
            "Relief",
            "Varnish",
            "Underpainting",
            "Preset",
            "Length",
            "Brush flat",
            "Recapture",
        ],
    );
}
