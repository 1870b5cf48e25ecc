//! Tests of scenes whose regions, guides, painted amounts, reference frame or morphs are wrong: out of range, in
//! conflict, off the surface, or naming what is not there. Each is reported with its place, and those that only warn
//! still give a picture.

use std::fs;

use impasto_painting::{FrameOptions, prepare};
use impasto_scene::problem::Severity;

use crate::hostile_scenes::{load_in_folder, scene_text};

/// The case's name, the scene's fields from line 2 on, a part of the expected message, and whether there is a picture.
const CASES: [(&str, &str, &str, bool); 33] = [
    (
        "contradicting regions",
        r#"regions: [(name: "first", on: Group("a", "default"), direction: Up), (name: "second", on: Object("a"))]"#,
        "scene.ron:2:31: warning: the region \"second\" after it covers all of it; a later region wins",
        true,
    ),
    (
        "guide off the surface",
        r#"regions: [(name: "r", on: Object("a"), guides: [(points: [(at: (0, 0.5, 1), normal: (0, 0, 1)), (at: (0.5, 0.5, 4), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "scene.ron:2:102: warning: the guide is 3 away from \"a\", farther than it reaches (0.2)",
        true,
    ),
    (
        "guide on an object that is gone",
        r#"regions: [(name: "r", on: Everything, guides: [(object: "b", points: [(at: (0, 0, 1), normal: (0, 0, 1)), (at: (1, 0, 1), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "scene.ron:2:57: error: there is no object \"b\"",
        false,
    ),
    (
        "guide on another object than its region",
        r#"objects: [(name: "a", mesh: "cube.obj"), (name: "b", mesh: "cube.obj")], regions: [(name: "r", on: Object("a"), guides: [(object: "b", points: [(at: (0, 0, 1), normal: (0, 0, 1)), (at: (1, 0, 1), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "scene.ron:2:131: error: the region lies on \"a\"",
        false,
    ),
    (
        "region on an object that is gone",
        r#"regions: [(name: "r", on: Dabs("b", [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2)]))]"#,
        "scene.ron:2:27: error: there is no object \"b\"",
        false,
    ),
    (
        "zero radius of a guide",
        r#"regions: [(name: "r", on: Object("a"), guides: [(points: [(at: (0, 0, 1), normal: (0, 0, 1)), (at: (1, 0, 1), normal: (0, 0, 1))], radius: 0)])]"#,
        "scene.ron:2:140: error: a guide with a radius of 0 reaches nothing; give a radius above 0",
        false,
    ),
    (
        "zero radius of a dab",
        r#"regions: [(name: "r", on: Dabs("a", [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0)]))]"#,
        "scene.ron:2:27: error: a dab with a radius of 0 reaches nothing",
        false,
    ),
    (
        "guide of one point",
        r#"regions: [(name: "r", on: Object("a"), guides: [(points: [(at: (0, 0, 1), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "scene.ron:2:58: error: a guide of one point has no direction",
        false,
    ),
    (
        "group that is not there",
        r#"regions: [(name: "r", on: Group("a", "empty"))]"#,
        "scene.ron:2:27: error: there is no group \"empty\"",
        false,
    ),
    (
        "material that nothing wears",
        r#"objects: [(name: "a", mesh: "worn.obj")], regions: [(name: "r", on: Material("a", "spare"))]"#,
        "scene.ron:2:69: ",
        false,
    ),
    (
        "reference outside the timeline",
        "timeline: (first: 0, last: 10), reference: Frame(11)",
        "scene.ron:2:44: warning: frame 11 is outside the timeline (0 to 10)",
        true,
    ),
    (
        "degenerate triangle under a guide",
        r#"objects: [(name: "a", mesh: "needle.obj")], regions: [(name: "r", on: Object("a"), guides: [(points: [(at: (0.2, 0.2, 0), normal: (0, 0, 1)), (at: (5, 0.5, 0), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "needle.obj:8:1: warning: this face has no area; it is left out",
        true,
    ),
    (
        "turn that is no number",
        r#"regions: [(name: "r", on: Object("a"), turn_deg: NaN)]"#,
        "scene.ron:2:50: error: NaN is out of range",
        false,
    ),
    (
        "turn of a point that is endless",
        r#"regions: [(name: "r", on: Object("a"), guides: [(points: [(at: (0, 0.5, 1), normal: (0, 0, 1)), (at: (0.5, 0.5, 1), normal: (0, 0, 1), turn_deg: inf)], radius: 0.2)])]"#,
        "scene.ron:2:146: error: inf is out of range",
        false,
    ),
    (
        "guide of a mode that is not there",
        r#"regions: [(name: "r", on: Object("a"), guides: [(mode: Smoth, points: [], radius: 0.2)])]"#,
        "scene.ron:2:56: error: `regions[0].guides[0].mode` cannot be `Smoth`; did you mean `Smooth`?",
        false,
    ),
    (
        "smooth guide of one point",
        r#"regions: [(name: "r", on: Object("a"), guides: [(mode: Smooth, points: [(at: (0, 0, 1), normal: (0, 0, 1))], radius: 0.2)])]"#,
        "scene.ron:2:72: error: a guide of one point is no gesture",
        false,
    ),
    (
        "amount of nothing known",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Widht, dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, by: 2)])])]"#,
        "scene.ron:2:55: error: `regions[0].amounts[0].of` cannot be `Widht`; did you mean `Width`?",
        false,
    ),
    (
        "width by nothing",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Width, dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, by: 0)])])]"#,
        "scene.ron:2:121: error: 0 is out of range; give a number from 0.25 to 4",
        false,
    ),
    (
        "density below nothing",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Density, dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, by: -0.5)])])]"#,
        "scene.ron:2:123: error: -0.5 is out of range; give a number from 0 to 4",
        false,
    ),
    (
        "factor that is no number",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Length, dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, by: NaN)])])]"#,
        "scene.ron:2:122: error: NaN is out of range",
        false,
    ),
    (
        "dab of an amount without a radius",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Length, dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0, by: 2)])])]"#,
        "scene.ron:2:113: error: a dab with a radius of 0 reaches nothing",
        false,
    ),
    (
        "dab of an amount that faces nowhere",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Length, dabs: [(at: (0, 0, 1), normal: (0, 0, 0), radius: 0.1, by: 2)])])]"#,
        "scene.ron:2:94: error: a direction cannot be zero",
        false,
    ),
    (
        "amount on an object that is not there",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Width, object: "b", dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, by: 2)])])]"#,
        "scene.ron:2:70: error: there is no object",
        false,
    ),
    (
        "amount without dabs",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Width, dabs: [])])]"#,
        "scene.ron:2:68: warning: the amount has no dabs and changes nothing",
        true,
    ),
    (
        "dab of an amount that touches nothing",
        r#"regions: [(name: "r", on: Object("a"), amounts: [(of: Width, dabs: [(at: (0, 0, 9), normal: (0, 0, 1), radius: 0.2, by: 2)])])]"#,
        "scene.ron:2:68: warning: 1 of 1 dabs touch nothing of \"a\"",
        true,
    ),
    (
        "flood from nowhere",
        r#"regions: [(name: "r", on: Flood("a", (at: (0, 0, 1), normal: (0, 0, 0)), 30))]"#,
        "scene.ron:2:27: error: a direction cannot be zero",
        false,
    ),
    (
        "flood over an angle that is none",
        r#"regions: [(name: "r", on: Flood("a", (at: (0, 0, 1), normal: (0, 0, 1)), -3))]"#,
        "scene.ron:2:27: error: -3 is out of range; give a number from 0 to 180",
        false,
    ),
    (
        "several within several",
        r#"regions: [(name: "r", on: Several("a", [Several("a", [Whole])]))]"#,
        "cannot be `Several`; did you mean `Material`? Known here: Whole, Group, Material, Dabs, Flood",
        false,
    ),
    (
        "a group within several that is not there",
        r#"regions: [(name: "r", on: Several("a", [Group("defualt"), Whole]))]"#,
        "scene.ron:2:27: error: there is no group \"defualt\" in cube.obj; did you mean \"default\"?",
        false,
    ),
    (
        "several of nothing",
        r#"regions: [(name: "r", on: Several("a", []))]"#,
        "scene.ron:2:27: warning: the region has no patches and covers nothing",
        true,
    ),
    (
        "dabs that take away from nothing",
        r#"regions: [(name: "r", on: Dabs("a", [(at: (0, 0, 1), normal: (0, 0, 1), radius: 0.2, take_away: true)]))]"#,
        "scene.ron:2:27: warning: the region begins with dabs that take away from nothing",
        true,
    ),
    (
        "morph of another topology",
        r#"objects: [(name: "a", mesh: "cube.obj", morph: "needle.obj")]"#,
        "scene.ron:2:48: error: needle.obj does not go with cube.obj: 1 polygons instead of 6",
        false,
    ),
    (
        "morph without a target",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0, morph: 0.5)])]"#,
        "scene.ron:2:66: error: the object has nothing to turn into",
        false,
    ),
];

#[test]
fn every_bad_direction_is_reported_with_its_place() {
    let needle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 5 1 0\nv 5 0.5 0\nf 1 2 3\nf 4 5 6\n";
    for (name, fields, says, is_painted) in CASES {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("needle.obj"), needle).unwrap();
        fs::write(folder.path().join("worn.mtl"), "newmtl worn\nnewmtl spare\n").unwrap();
        fs::write(
            folder.path().join("worn.obj"),
            "mtllib worn.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl worn\nf 1 2 3\n",
        )
        .unwrap();
        let loaded = load_in_folder(folder.path(), scene_text(fields).as_bytes());
        let said: Vec<String> = match &loaded {
            Ok(scene) => scene.warnings.iter().map(ToString::to_string).collect(),
            Err(report) => report.0.iter().map(ToString::to_string).collect(),
        };
        let count = said.iter().filter(|line| line.contains("scene.ron")).count();
        assert!(
            count == 1 && said.iter().any(|line| line.contains(says)),
            "{name}: {said:?}\nexpected: {says}"
        );
        assert_eq!(loaded.is_ok(), is_painted, "{name}: {said:?}");
        if let Ok(scene) = loaded {
            assert!(scene.warnings.iter().all(|warning| warning.severity == Severity::Warning));
            let frame = prepare(scene.into()).unwrap().at(0.0, &FrameOptions::new([160, 90]));
            assert!(!frame.strokes.is_empty(), "{name}");
            assert!(frame.strokes.iter().all(|stroke| stroke.angle_rad.is_finite()), "{name}");
        }
    }
}
