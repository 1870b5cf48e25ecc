//! Tests of the checks on scenes.

use std::path::Path;

use impasto_core::TriangleMesh;

use super::*;
use crate::load::parse;
use crate::mesh_file::Material;
use crate::problem::Severity::{Error, Limit, Warning};

/// A scene of the given fields, with a valid camera and object unless the fields bring their own.
fn scene(fields: &str) -> Scene {
    let mut text = format!("(version: 1, {fields}");
    if !fields.contains("camera:") {
        text.push_str(", camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))])");
    }
    if !fields.contains("objects:") {
        text.push_str(", objects: [(name: \"a\", mesh: \"cube.obj\")]");
    }
    text.push(')');
    parse(Path::new("s.ron"), &text).unwrap_or_else(|report| panic!("{report}\n{text}"))
}

fn found(fields: &str) -> Vec<(Severity, String)> {
    check(&scene(fields)).into_iter().map(|finding| (finding.severity, finding.field_path)).collect()
}

#[track_caller]
fn assert_finds(fields: &str, expected: &[(Severity, &str)]) {
    let expected: Vec<_> = expected.iter().map(|(severity, path)| (*severity, path.to_string())).collect();
    assert_eq!(found(fields), expected, "{fields}");
}

#[test]
fn a_plain_scene_is_good() {
    assert_finds("seed: 3", &[]);
}

#[test]
fn sizes_frames_and_rates_have_limits() {
    assert_finds("size: (16384, 8192)", &[]);
    assert_finds("size: (16384, 8193)", &[(Limit, "size")]);
    assert_finds("size: (16385, 16)", &[(Limit, "size")]);
    assert_finds("size: (16, 0)", &[(Error, "size")]);
    for fps in ["0", "-24", "NaN", "inf"] {
        assert_finds(&format!("timeline: (fps: {fps})"), &[(Error, "timeline.fps")]);
    }
    assert_finds("timeline: (first: 5, last: 4)", &[(Error, "timeline.last")]);
    assert_finds("timeline: (first: 1, last: 1000000)", &[]);
    assert_finds("timeline: (first: 0, last: 1000000)", &[(Limit, "timeline.last")]);
    assert_finds("timeline: (last: 1000000000000)", &[(Limit, "timeline.last")]);
    let whole_range = format!("timeline: (first: {}, last: {})", i64::MIN, i64::MAX);
    assert_finds(&whole_range, &[(Limit, "timeline.first"), (Limit, "timeline.last")]);
    assert_finds("reference: Frame(-9223372036854775808)", &[(Limit, "reference")]);
}

#[test]
fn cameras_look_somewhere_that_has_an_up() {
    let keys = |keys: &str| format!("camera: (keys: [{keys}])");
    assert_finds(&keys(""), &[(Error, "camera.keys")]);
    let target = "camera.keys[0].target";
    assert_finds(&keys("(frame: 0, eye: (0, 5, 0), target: (0, 0, 0))"), &[(Error, target)]);
    assert_finds(&keys("(frame: 0, eye: (0, 5, 0.01), target: (0, 0, 0))"), &[]);
    assert_finds(&keys("(frame: 0, eye: (1, 2, 3), target: (1, 2, 3))"), &[(Error, target)]);
    assert_finds(&keys("(frame: 0, eye: (NaN, 2, 3), target: (1, 2, 3))"), &[(Error, "camera.keys[0].eye")]);
    assert_finds(
        &keys("(frame: 0, eye: (0, 1e300, 3), target: (1, 2, 3))"),
        &[(Error, "camera.keys[0].eye")],
    );
    let good = "eye: (0, 1, 4), target: (0, 0, 0)";
    let eased = |ease: &str| keys(&format!("(frame: 0, {good}, ease: {ease})"));
    assert_finds(&eased("Curve((0, -2), (1, 3))"), &[]);
    for bad in [
        "(-0.01, 0), (1, 1)",
        "(0, 0), (1.01, 1)",
        "(0, -2.01), (1, 1)",
        "(0, 0), (1, 3.01)",
        "(0, 0), (NaN, 0)",
    ] {
        assert_finds(&eased(&format!("Curve({bad})")), &[(Error, "camera.keys[0].ease")]);
    }
    let unsorted = keys(&format!("(frame: 0, {good}), (frame: 2, {good}), (frame: 1, {good})"));
    assert_finds(&unsorted, &[(Error, "camera.keys[2].frame")]);
    let twice = keys(&format!("(frame: 1, {good}), (frame: 1, {good}), (frame: NaN, {good})"));
    assert_finds(&twice, &[(Error, "camera.keys[1].frame"), (Error, "camera.keys[2].frame")]);
    assert_finds(
        &keys(&format!("(frame: 0, {good}, fov_y_deg: 171, roll_deg: inf)")),
        &[(Error, "camera.keys[0].roll_deg"), (Error, "camera.keys[0].fov_y_deg")],
    );
}

#[test]
fn lenses_have_a_near_before_their_far() {
    let lens =
        |lens: &str| format!("camera: (lens: {lens}, keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))])");
    assert_finds(&lens("Perspective(fov_y_deg: 180)"), &[(Error, "camera.lens.fov_y_deg")]);
    assert_finds(&lens("Perspective(fov_y_deg: 0.5)"), &[(Error, "camera.lens.fov_y_deg")]);
    assert_finds(&lens("Perspective(near: 10, far: 1)"), &[(Error, "camera.lens.far")]);
    assert_finds(&lens("Perspective(near: 1, far: 1)"), &[(Error, "camera.lens.far")]);
    assert_finds(&lens("Perspective(near: 0)"), &[(Error, "camera.lens.near")]);
    assert_finds(&lens("Orthographic(height: 2, near: -5, far: 5)"), &[]);
    assert_finds(&lens("Orthographic(height: 0)"), &[(Error, "camera.lens.height")]);
}

#[test]
fn lights_say_where_they_are_and_are_few() {
    let lights = |lights: &str| format!("lights: [{lights}]");
    assert_finds(&lights("(name: \"s\", kind: Sun)"), &[(Error, "lights[0]")]);
    assert_finds(&lights("(name: \"p\", kind: Point)"), &[(Error, "lights[0]")]);
    let zero = lights("(name: \"s\", kind: Sun, direction: (0, 0, 0))");
    assert_finds(&zero, &[(Error, "lights[0].direction")]);
    let dark =
        lights("(name: \"a\", kind: Ambient, intensity: -1), (name: \"a\", kind: Ambient, intensity: inf)");
    assert_finds(
        &dark,
        &[(Error, "lights[1].name"), (Error, "lights[0].intensity"), (Error, "lights[1].intensity")],
    );
    assert_finds(
        &lights("(name: \"a\", kind: Ambient, position: (0, 1, 0))"),
        &[(Warning, "lights[0].position")],
    );
    let suns = |count: usize| {
        lights(
            &(0..count)
                .map(|i| format!("(name: \"{i}\", kind: Sun, direction: (0, -1, 0)),"))
                .collect::<String>(),
        )
    };
    assert_finds(&suns(8), &[]);
    assert_finds(&suns(9), &[(Limit, "lights[8]")]);
}

#[test]
fn objects_have_names_particles_and_scales_in_range() {
    let object = |fields: &str| format!("objects: [(name: \"a\", mesh: \"cube.obj\", {fields})]");
    assert_finds(&object("particles: 0"), &[(Warning, "objects[0].particles")]);
    assert_finds(&object("particles: 16000000"), &[]);
    assert_finds(&object("particles: 16000001"), &[(Limit, "objects[0].particles")]);
    assert_finds(&object(&format!("particles: {}", u64::MAX)), &[(Limit, "objects[0].particles")]);
    assert_finds(&object("scale: 0"), &[(Warning, "objects[0].scale")]);
    assert_finds(&object("scale: (10, 1, 0.1)"), &[]);
    for scale in ["-1", "(1, -2, 1)", "NaN", "1e-300", "inf"] {
        assert_finds(&object(&format!("scale: {scale}")), &[(Error, "objects[0].scale")]);
    }
    let key = "keys: [(frame: 0, translation: (0, NaN, 0), rotation_deg: (inf, 0, 0))]";
    let expected = [(Error, "objects[0].keys[0].translation"), (Error, "objects[0].keys[0].rotation_deg")];
    assert_finds(&object(key), &expected);
    let named = |first: &str, second: &str| {
        format!("objects: [(name: \"{first}\", mesh: \"m.obj\"), (name: \"{second}\", mesh: \"m.obj\")]")
    };
    assert_finds(&named("a", "a"), &[(Error, "objects[1].name")]);
    assert_finds(&named("a", " "), &[(Error, "objects[1].name")]);
    assert_finds(&named("a", "b\\u{7}"), &[(Error, "objects[1].name")]);
    let many: String =
        (0..1000).map(|i| format!("(name: \"{i}\", mesh: \"m.obj\", particles: 100000),")).collect();
    assert_finds(&format!("objects: [{many}]"), &[(Limit, "objects[320].particles")]);
}

#[test]
fn parents_exist_and_lead_to_a_root() {
    let objects = |parents: &[(&str, &str)]| {
        let list: String = parents
            .iter()
            .map(|(name, parent)| format!("(name: \"{name}\", mesh: \"m.obj\", parent: \"{parent}\"),"))
            .collect();
        format!("objects: [{list} (name: \"root\", mesh: \"m.obj\")]")
    };
    assert_finds(&objects(&[("b", "a"), ("a", "root")]), &[]);
    assert_finds(&objects(&[("a", "a")]), &[(Error, "objects[0].parent")]);
    // One finding per cycle, however many objects lead into it, and none for those objects.
    assert_finds(
        &objects(&[("d", "b"), ("a", "c"), ("b", "a"), ("c", "b"), ("e", "d")]),
        &[(Error, "objects[1].parent")],
    );
    let findings = check(&scene(&objects(&[("wheel", "rot")])));
    assert_eq!(findings[0].message, "there is no object \"rot\"");
    assert_eq!(findings[0].mend, "did you mean \"root\"?");
}

#[test]
fn stroke_settings_have_ranges_and_known_names() {
    for settings in [
        "length_px: 0",
        "length_px: -1",
        "width_px: 4097",
        "coverage: 20.1",
        "coverage: NaN",
        "flatness: 1.1",
        "angle_jitter_deg: -1",
        "size_jitter: inf",
        "layer: 1001",
        "brush: \"filbret\"",
        "brush: []",
        "scale: 0",
        "swing_deg: -1",
        "contour: 1.5",
        "taper: 1.01",
        "taper: NaN",
        "bend_deg: -181",
        "color_jitter: 11",
        "temperature: NaN",
        "grading: 2",
        "edges: Overrun(-1)",
        "palette: [\"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\", \"#000\"]",
        "preset: \"oil\"",
    ] {
        let field = settings.split(':').next().unwrap();
        assert_finds(&format!("strokes: ({settings})"), &[(Error, &format!("strokes.{field}"))]);
    }
    assert_finds(
        "strokes: (length_px: 4096, width_px: 0.5, coverage: 20, flatness: 0, taper: -1, bend_deg: 180, preset: \"impressionist\")",
        &[],
    );
}

#[test]
fn layers_of_paint_have_names_and_ranges() {
    let layer = |fields: &str| format!("strokes: (layers: [({fields})])");
    for (fields, field) in [
        ("name: \"body\", coverage: 1e9", "coverage"),
        ("name: \"body\", opacity: 1.01", "opacity"),
        ("name: \"form\", thickness: -0.1", "thickness"),
        ("name: \"scumble\", dryness: 2", "dryness"),
        ("name: \"lights\", pickup: -1", "pickup"),
        ("name: \"accents\", brush: \"broom\"", "brush"),
        ("name: \"boddy\"", "name"),
        ("name: \"body\", color: \"#fff\"", "color"),
    ] {
        assert_finds(&layer(fields), &[(Error, &format!("strokes.layers[0].{field}"))]);
    }
    assert_finds(&layer("name: \"ground\", color: \"#a08060\", opacity: 0.5"), &[]);
    assert_finds(&layer("name: \"ground\", hidden: true"), &[]);
    assert_finds(
        &layer("name: \"lights\", hidden: false, coverage: 0, thickness: 5, brush: [\"knife\", \"round\"]"),
        &[],
    );
    let many: String = (0..17).map(|index| format!("\"{index}.png\",")).collect();
    assert_finds(&format!("strokes: (brush: [{many}])"), &[(Error, "strokes.brush")]);
    for style in ["relief: -1", "weave: 11", "varnish: NaN"] {
        let field = style.split(':').next().unwrap();
        assert_finds(&format!("style: RotatingStrokes({style})"), &[(Error, &format!("style.{field}"))]);
    }
}

#[test]
fn an_order_names_each_layer_once_and_is_the_scenes() {
    let all = "\"body\", \"underpainting\", \"form\", \"scumble\", \"accents\", \"contour\"";
    let order = |names: &str| format!("strokes: (order: [{names}])");
    assert_finds(&order(&format!("{all}, \"lights\"")), &[]);
    assert_finds(&order(all), &[(Error, "strokes.order")]);
    assert_finds(&order(&format!("{all}, \"light\"")), &[(Error, "strokes.order[6]")]);
    assert_finds(&order(&format!("{all}, \"body\"")), &[(Error, "strokes.order[6]")]);
    assert_finds(&order(&format!("{all}, \"ground\"")), &[(Error, "strokes.order[6]")]);
    let of_region = format!("regions: [(name: \"a\", on: Everything, {})]", order(all));
    assert_finds(&of_region, &[(Error, "regions[0].strokes.order")]);
}

#[test]
fn flatness_below_one_needs_the_tangent_plane() {
    let flat = "strokes: (flatness: 0.5)";
    assert_finds(&format!("{flat}, style: RotatingStrokes(solver: Tangent)"), &[]);
    for solver in ["Horn", "HornExact"] {
        let scene = format!("{flat}, style: RotatingStrokes(solver: {solver})");
        assert_finds(&scene, &[(Error, "strokes.flatness")]);
    }
    assert_finds("strokes: (flatness: 0.5, preset: \"paper\")", &[(Error, "strokes.flatness")]);
    assert_finds("strokes: (flatness: 1, preset: \"paper\")", &[]);
}

#[test]
fn regions_name_objects_and_differ() {
    let region = |on: &str, rest: &str| format!("regions: [(name: \"r\", on: {on}{rest})]");
    assert_finds(&region("Everything", ""), &[]);
    assert_finds(&region("Object(\"b\")", ""), &[(Error, "regions[0].on")]);
    assert_finds(&region("Group(\"b\", \"g\")", ""), &[(Error, "regions[0].on")]);
    assert_finds(&region("Everything", ", direction: Around((0, 0, 0))"), &[(Error, "regions[0].direction")]);
    assert_finds(&region("Everything", ", direction: Angle(NaN)"), &[(Error, "regions[0].direction")]);
    let paper = region("Everything", ", strokes: (preset: \"paper\")");
    assert_finds(&paper, &[(Error, "regions[0].strokes.preset")]);
}

#[test]
fn groups_and_materials_are_looked_for_in_the_mesh() {
    let groups = vec!["skin".to_owned(), "leaf".to_owned()];
    let wax = Material::plain("wax".to_owned(), [0.5; 3]);
    let mesh = MeshFile::still(TriangleMesh::default(), groups, vec![wax]);
    let meshes = BTreeMap::from([("cube.obj".to_owned(), Arc::new(mesh))]);
    let scene = scene(
        "objects: [(name: \"a\", mesh: \"cube.obj\", group: \"laef\"), (name: \"b\", mesh: \"unread.obj\", group: \"x\")],
         regions: [(name: \"1\", on: Group(\"a\", \"skin\")), (name: \"2\", on: Group(\"a\", \"wax\")),
                   (name: \"3\", on: Material(\"a\", \"wax\")), (name: \"4\", on: Material(\"a\", \"skin\"))]",
    );
    let findings = check_with_meshes(&scene, &meshes, &BTreeMap::new());
    let paths: Vec<&str> = findings.iter().map(|finding| finding.field_path.as_str()).collect();
    assert_eq!(paths, ["objects[0].group", "regions[1].on", "regions[3].on"]);
    assert_eq!(findings[0].mend, "did you mean \"leaf\"?");
}

#[test]
fn guides_and_dabs_that_cannot_work_are_errors() {
    let guide = |rest: &str| {
        format!("regions: [(name: \"r\", on: Object(\"a\"), guides: [({rest})])]").replace(
            "POINTS",
            "points: [(at: (0, 0, 0), normal: (0, 1, 0)), (at: (1, 0, 0), normal: (0, 1, 0))]",
        )
    };
    let at = |field: &str| format!("regions[0].guides[0]{field}");
    assert_finds(&guide("POINTS, radius: 0.1"), &[]);
    assert_finds(&guide("POINTS, radius: 0"), &[(Error, &at(".radius"))]);
    assert_finds(&guide("POINTS, radius: NaN"), &[(Error, &at(".radius"))]);
    assert_finds(&guide("POINTS, radius: 1, strength: 2"), &[(Error, &at(".strength"))]);
    assert_finds(&guide("POINTS, radius: 1, object: \"gone\""), &[(Error, &at(".object"))]);
    let same = "points: [(at: (0, 0, 0), normal: (0, 1, 0)), (at: (0, 0, 0), normal: (0, 1, 0))]";
    assert_finds(&guide(&format!("{same}, radius: 1")), &[(Error, &at(".points"))]);
    assert_finds(&guide("points: [], radius: 1"), &[(Error, &at(".points"))]);
    let flat = "points: [(at: (0, 0, 0), normal: (0, 0, 0)), (at: (1, 0, 0), normal: (0, 1, 0))]";
    assert_finds(&guide(&format!("{flat}, radius: 1")), &[(Error, &at(".points[0].normal"))]);
    let view = "POINTS, radius: 1, view: (eye: (0, 1, 0), target: (0, 1, 0))";
    assert_finds(&guide(view), &[(Error, &at(".view.target"))]);
    let framed = |frame: &str| {
        guide(&format!("POINTS, radius: 1, view: (eye: (0, 1, 0), target: (0, 0, 0), frame: Some({frame}))"))
    };
    assert_finds(&framed("7.5"), &[]);
    for frame in ["NaN", "inf", "-2e9"] {
        assert_finds(&framed(frame), &[(Error, &at(".view.frame"))]);
    }
    let everywhere = guide("POINTS, radius: 1").replace("Object(\"a\")", "Everything");
    assert_finds(&everywhere, &[(Error, "regions[0].guides[0]")]);
    let dabs = |dab: &str| format!("regions: [(name: \"r\", on: Dabs(\"a\", [{dab}]))]");
    assert_finds(&dabs("(at: (0, 0, 0), normal: (0, 1, 0), radius: 0.2)"), &[]);
    assert_finds(&dabs("(at: (0, 0, 0), normal: (0, 1, 0), radius: -1)"), &[(Error, "regions[0].on")]);
    assert_finds(&dabs(""), &[(Warning, "regions[0].on")]);
}

#[test]
fn amounts_that_cannot_work_are_errors() {
    let amount = |rest: &str| {
        let dab = "at: (0, 0, 0), normal: (0, 1, 0), radius: 0.1";
        format!("regions: [(name: \"r\", on: Object(\"a\"), amounts: [({rest})])]").replace("DAB", dab)
    };
    let at = |field: &str| format!("regions[0].amounts[0]{field}");
    for (of, least) in [("Width", "0.25"), ("Length", "0.25"), ("Density", "0"), ("Flatness", "0")] {
        for by in [least, "1", "4"] {
            assert_finds(&amount(&format!("of: {of}, dabs: [(DAB, by: {by})]")), &[]);
        }
        for by in ["-0.1", "4.01", "NaN", "inf"] {
            let bad = amount(&format!("of: {of}, dabs: [(DAB, by: 1), (DAB, by: {by})]"));
            assert_finds(&bad, &[(Error, &at(".dabs[1].by"))]);
        }
    }
    assert_finds(&amount("of: Width, dabs: []"), &[(Warning, &at(".dabs"))]);
    assert_finds(&amount("of: Width, object: \"gone\", dabs: [(DAB, by: 2)]"), &[(Error, &at(".object"))]);
    let everywhere = amount("of: Width, dabs: [(DAB, by: 2)]").replace("Object(\"a\")", "Everything");
    assert_finds(&everywhere, &[(Error, &at(""))]);
    let named = everywhere.replace("of: Width", "of: Width, object: \"a\"");
    assert_finds(&named, &[]);
    let by_horn = "style: RotatingStrokes(solver: Horn)";
    let flat = |by: &str| format!("{}, {by_horn}", amount(&format!("of: Flatness, dabs: [(DAB, by: {by})]")));
    assert_finds(&flat("0.5"), &[(Error, &at(".of"))]);
    assert_finds(&flat("2"), &[]);
    let many = "(DAB, by: 2), ".repeat(limits::MAX_AMOUNT_DABS / 2 + 1);
    let list = format!("of: Width, dabs: [{many}]), (of: Width, dabs: [{many}]");
    assert_finds(&amount(&list), &[(Limit, "regions")]);
}

#[test]
fn touches_that_cannot_work_are_errors() {
    let point = "(at: (0, 0, 0), normal: (0, 1, 0))";
    let touch = |rest: &str| {
        format!("touches: [(name: \"t\", on: \"a\", points: [{point}])]").replace("points: [", rest)
    };
    let with = |field: &str| touch(&format!("{field}, points: ["));
    let found = |field: &str, at: &str| {
        assert_finds(&with(field), &[(Error, &format!("touches[0].{at}"))]);
    };
    assert_finds(&with("width_px: 20, length_px: 80, opacity: 0.5, taper: -1, brush: Some(\"flat\")"), &[]);
    for (field, at) in [
        ("width_px: 0.5", "width_px"),
        ("width_px: 401", "width_px"),
        ("length_px: NaN", "length_px"),
        ("opacity: 1.01", "opacity"),
        ("taper: -1.1", "taper"),
        ("brush: Some(\"flatt\")", "brush"),
    ] {
        found(field, at);
    }
    assert_finds("touches: [(name: \"t\", on: \"a\", points: [])]", &[(Error, "touches[0].points")]);
    let elsewhere = with("width_px: 14").replace("on: \"a\"", "on: \"b\"");
    assert_finds(&elsewhere, &[(Error, "touches[0].on")]);
    let flat = with("width_px: 14").replace("normal: (0, 1, 0)", "normal: (0, 0, 0)");
    assert_finds(&flat, &[(Error, "touches[0].points[0].normal")]);
    let far = with("width_px: 14").replace("at: (0, 0, 0)", "at: (inf, 0, 0)");
    assert_finds(&far, &[(Error, "touches[0].points[0].at")]);
    let one = format!("(name: \"t\", on: \"a\", points: [{point}])");
    assert_finds(&format!("touches: [{one}, {one}]"), &[(Error, "touches[1].name")]);
    let points = format!("{point}, ").repeat(limits::MAX_TOUCH_POINTS + 1);
    let long = format!("touches: [(name: \"t\", on: \"a\", points: [{points}])]");
    assert_finds(&long, &[(Error, "touches[0].points")]);
    let many: String = (0..=limits::MAX_TOUCHES)
        .map(|index| format!("(name: \"t{index}\", on: \"a\", points: [{point}]), "))
        .collect();
    assert_finds(&format!("touches: [{many}]"), &[(Limit, "touches")]);
    let ink = format!("{}, style: SumiE()", with("width_px: 14"));
    assert_finds(&ink, &[(Warning, "touches")]);
}

#[test]
fn regions_that_a_later_one_covers_are_told() {
    let regions = |on: [&str; 3]| {
        let list: String =
            on.iter().enumerate().map(|(i, on)| format!("(name: \"{i}\", on: {on}),")).collect();
        format!("regions: [{list}]")
    };
    let group = "Group(\"a\", \"g\")";
    assert_finds(&regions(["Everything", "Object(\"a\")", group]), &[]);
    assert_finds(&regions([group, "Everything", "Object(\"a\")"]), &[(Warning, "regions[0].on")]);
    assert_finds(&regions(["Everything", group, group]), &[(Warning, "regions[1].on")]);
    assert_finds(&regions(["Object(\"a\")", "Object(\"a\")", group]), &[(Warning, "regions[0].on")]);
}

#[test]
fn references_stay_in_the_timeline() {
    let timeline = "timeline: (first: 10, last: 20)";
    assert_finds(timeline, &[]);
    assert_finds(&format!("{timeline}, reference: Frame(12)"), &[]);
    assert_finds(&format!("{timeline}, reference: Frame(9)"), &[(Warning, "reference")]);
    let further = format!("{timeline}, further_references: [Frame(10), Frame(21)]");
    assert_finds(&further, &[(Warning, "further_references[1]")]);
    let view = "reference: View(eye: (0, 0, 1), target: (0, 0, 1))";
    assert_finds(view, &[(Error, "reference.target")]);
}

#[test]
fn guides_lie_on_their_surface_and_morphs_have_its_topology() {
    use glam::Vec3;
    let triangles = |corners: &[[f32; 3]], faces: &[[u32; 3]]| {
        Arc::new(MeshFile {
            mesh: TriangleMesh {
                positions: corners.iter().map(|&corner| Vec3::from(corner)).collect(),
                normals: vec![Vec3::Z; corners.len()],
                triangles: faces.to_vec(),
                polygon_of_triangle: (0..faces.len() as u32).collect(),
                group_of_triangle: vec![0; faces.len()],
                material_of_triangle: vec![0; faces.len()],
                ..TriangleMesh::default()
            },
            groups: vec!["skin".to_owned(), "bare".to_owned()],
            bend: None,
            points: None,
            materials: vec![Material::plain(String::new(), [0.5; 3])],
        })
    };
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 0.0]];
    let needle = [[9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 0.5, 0.0]];
    let both: Vec<[f32; 3]> = corners[..3].iter().chain(&needle).copied().collect();
    let meshes = BTreeMap::from([
        ("cube.obj".to_owned(), triangles(&both, &[[0, 1, 2], [3, 4, 5]])),
        ("other.obj".to_owned(), triangles(&corners, &[[0, 1, 2], [2, 1, 3]])),
        ("fewer.obj".to_owned(), triangles(&corners, &[[0, 1, 2]])),
    ]);
    let guide = |from: &str, to: &str| {
        format!("(points: [(at: {from}, normal: (0, 0, 1)), (at: {to}, normal: (0, 0, 1))], radius: 0.5),")
    };
    let scene = scene(&format!(
        "objects: [(name: \"a\", mesh: \"cube.obj\", scale: 2, morph: \"other.obj\"),
                   (name: \"c\", mesh: \"other.obj\", morph: \"cube.obj\"),
                   (name: \"b\", mesh: \"cube.obj\", morph: \"fewer.obj\")],
         regions: [(name: \"r\", on: Object(\"a\"), guides: [{}{}{}]), (name: \"s\", on: Group(\"a\", \"bare\"))]",
        guide("(0, 0, 0)", "(1, 0.9, 0.1)"),
        guide("(0, 0, 0)", "(1, 1, 3)"),
        guide("(0, 0, 0)", "(18, 1.2, 0)"),
    ));
    let findings = check_with_meshes(&scene, &meshes, &BTreeMap::new());
    let found: Vec<(Severity, &str)> =
        findings.iter().map(|finding| (finding.severity, finding.field_path.as_str())).collect();
    assert_eq!(
        found,
        [
            (Error, "objects[1].morph"),
            (Error, "objects[2].morph"),
            (Warning, "regions[0].guides[1].points[1].at"),
            (Warning, "regions[1].on"),
        ]
    );
    assert!(findings[2].message.contains("is 3 away from \"a\""), "{}", findings[2].message);
}

#[test]
fn ten_thousand_problems_make_a_short_report_quickly() {
    let list: String = (0..10_000)
        .map(|i| format!("(name: \"object {i}\", mesh: \"m.obj\", parent: \"nobody {i}\"),"))
        .collect();
    let findings = check(&scene(&format!("objects: [{list}]")));
    assert_eq!(findings.len(), limits::MAX_PROBLEMS + 1);
    assert_eq!(findings.last().unwrap().message, "9900 more problems are not listed");
    assert!(findings.last().unwrap().severity.is_fatal());
}
