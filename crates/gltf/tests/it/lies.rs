//! Tests with false files that are made here: a good file in which one value at a time is spoiled.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::build::{good, lines, read_alone, rich};
use impasto_gltf::{Animator, Finding, Gltf, Playing};

/// Reads a file and asserts what must hold whether it is read or refused. Returns the findings.
fn check(bytes: Vec<u8>, what: &str) -> Result<Vec<Finding>, Vec<Finding>> {
    let start = Instant::now();
    let len = bytes.len();
    let result = read_alone(bytes);
    let seconds = start.elapsed();
    assert!(seconds < Duration::from_secs(3), "{what}: {len} bytes took {seconds:?}");
    match result {
        Ok((gltf, warnings)) => {
            assert!(warnings.iter().all(|finding| !finding.is_fatal()), "{what}: read despite an error");
            use_all(&gltf);
            Ok(warnings)
        }
        Err(findings) => {
            assert!(findings.first().is_some_and(Finding::is_fatal), "{what}: refused without a reason");
            Err(findings)
        }
    }
}

/// Goes everywhere in a shot that was read: any index that leads nowhere would panic.
fn use_all(gltf: &Gltf) {
    for mesh in &gltf.meshes {
        for primitive in &mesh.primitives {
            let count = primitive.positions.len();
            assert!(primitive.positions.iter().flatten().all(|number| number.is_finite()));
            assert!(primitive.triangles.iter().flatten().all(|&vertex| (vertex as usize) < count));
            assert_eq!(primitive.targets.len(), mesh.target_count);
            assert!(primitive.material.is_none_or(|material| material < gltf.materials.len()));
            for list in primitive.uvs.iter().flatten() {
                assert_eq!(list.len(), count);
            }
        }
    }
    for texture in &gltf.textures {
        assert!(texture.image.is_none_or(|image| image < gltf.images.len()));
    }
    let (animator, _) = Animator::new(gltf, Playing::All).expect("all may play");
    for time_s in [-1.0, 0.0, 0.3, 1.0, 1.5, 2.0, 1e30, f64::INFINITY, f64::NAN] {
        let posed = animator.pose(time_s);
        assert!(posed.world_from_node.iter().all(|world| world.is_finite()), "at {time_s}");
        for skin in &gltf.skins {
            assert_eq!(posed.world_from_bound(skin).len(), skin.joints.len());
        }
    }
}

#[test]
fn the_file_that_is_spoiled_is_good() {
    let (buffer, document) = rich();
    let (gltf, warnings) = good(&document);
    assert!(warnings.is_empty(), "{}", lines(&warnings));
    use_all(&gltf);
    assert_eq!(gltf.meshes[0].primitives[0].triangles.len(), 2);
    assert_eq!(gltf.meshes[0].primitives[0].material, Some(1));
    assert_eq!(gltf.meshes[0].target_names, ["bulge"]);
    assert_eq!(gltf.nodes[4].instances.as_ref().map(|list| list.len()), Some(2));
    let (from_glb, warnings) = read_alone(buffer.glb(document)).expect("it is good");
    assert!(warnings.is_empty(), "{}", lines(&warnings));
    assert_eq!(gltf, from_glb);
}

fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Array(items) => {
            items
                .iter()
                .enumerate()
                .for_each(|(index, item)| pointers(item, &format!("{at}/{index}"), found));
        }
        Value::Object(members) => {
            members.iter().for_each(|(name, member)| pointers(member, &format!("{at}/{name}"), found));
        }
        _ => {}
    }
}

fn lies_about(value: &Value) -> Vec<Value> {
    let mut lies = vec![
        Value::Null,
        json!(true),
        json!(""),
        json!("NaN"),
        json!("../../etc/passwd"),
        json!([]),
        json!({}),
        json!([[]]),
        json!(0),
        json!(-1),
        json!(1),
        json!(0.5),
        json!(1e39),
        json!(-1e39),
        json!(1e308),
        json!(u64::MAX),
        json!(i64::MIN),
        json!(4_294_967_295_u64),
        json!(4_294_967_296_u64),
        json!(9_007_199_254_740_991_u64),
        json!(4_000_000_000_u64),
        json!(1e-30),
    ];
    if let Some(number) = value.as_f64() {
        lies.extend([
            json!(number + 1.0),
            json!(number - 1.0),
            json!(number * 2.0),
            json!(-number),
            json!(number * 1e6),
        ]);
        if let Some(whole) = value.as_u64() {
            lies.extend([
                json!(whole + 1),
                json!(whole.wrapping_sub(1)),
                json!(whole + 4),
                json!(whole * 65_536),
            ]);
        }
    }
    if let Some(text) = value.as_str().filter(|text| text.len() < 100) {
        lies.extend([json!(format!("{text}\0")), json!(text.to_lowercase()), json!(&text[..text.len() / 2])]);
        lies.extend([json!("CUBICSPLINE"), json!("MAT4"), json!("pointer"), json!("scale")]);
    }
    if let Some(items) = value.as_array() {
        let mut longer = items.clone();
        longer.extend(items.iter().cloned());
        lies.extend([json!(longer), json!(items.get(1..).unwrap_or_default()), json!(vec![json!(0); 1000])]);
    }
    lies
}

#[test]
fn one_lie_at_a_time() {
    let (_, document) = rich();
    let mut places = Vec::new();
    pointers(&document, "", &mut places);
    let (mut read, mut refused, mut nowhere) = (0, 0, 0);
    for place in &places {
        let old = document.pointer(place).expect("it was found there").clone();
        for lie in lies_about(&old) {
            let mut spoiled = document.clone();
            *spoiled.pointer_mut(place).expect("it was found there") = lie.clone();
            let shown: String = lie.to_string().chars().take(60).collect();
            let what = format!("{place} = {shown}");
            match check(spoiled.to_string().into_bytes(), &what) {
                Ok(_) => read += 1,
                Err(findings) => {
                    refused += 1;
                    // Only an error about the whole document may have no pointer.
                    let has_place = findings.iter().any(|finding| !finding.pointer.is_empty());
                    nowhere += usize::from(!has_place && !place.is_empty());
                    assert!(has_place || place.is_empty(), "{what}: {}", lines(&findings));
                }
            }
        }
    }
    eprintln!("{} places: {read} lies read, {refused} refused, {nowhere} without a place", places.len());
    assert!(refused > read, "more lies are read than refused");
}

#[test]
fn members_that_are_missing() {
    let (_, document) = rich();
    let mut places = Vec::new();
    pointers(&document, "", &mut places);
    for place in &places {
        let Some((parent, name)) = place.rsplit_once('/') else { continue };
        let mut spoiled = document.clone();
        match spoiled.pointer_mut(parent).expect("it was found there") {
            Value::Object(members) => drop(members.remove(name)),
            Value::Array(items) => drop(items.remove(name.parse().expect("an index"))),
            _ => panic!("{parent} has members"),
        }
        let _ = check(spoiled.to_string().into_bytes(), &format!("without {place}"));
    }
}

#[test]
fn numbers_in_the_bytes_are_not_trusted() {
    let (buffer, document) = rich();
    let glb = buffer.glb(document);
    let start = glb.len() - buffer.bytes.len().next_multiple_of(4);
    for at in (start..glb.len() - 3).step_by(4) {
        for lie in
            [[0xFF; 4], f32::NAN.to_le_bytes(), f32::INFINITY.to_le_bytes(), [0; 4], 1e38_f32.to_le_bytes()]
        {
            let mut spoiled = glb.clone();
            spoiled[at..at + 4].copy_from_slice(&lie);
            let _ = check(spoiled, &format!("{lie:?} at {at}"));
        }
    }
}

#[test]
fn glb_cut_short_at_each_byte() {
    let (buffer, document) = rich();
    let glb = buffer.glb(document);
    for len in 0..glb.len() {
        let what = format!("{len} of {} bytes", glb.len());
        assert!(check(glb[..len].to_vec(), &what).is_err(), "{what} are read");
    }
}

#[test]
fn glb_headers_lie() {
    let (buffer, document) = rich();
    let glb = buffer.glb(document);
    let json_len = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    for at in (0..20).chain(20 + json_len..28 + json_len) {
        for lie in [0, 1, 2, 3, 4, 0x7F, 0x80, 0xFE, 0xFF] {
            let mut spoiled = glb.clone();
            spoiled[at] = lie;
            let _ = check(spoiled, &format!("byte {at} = {lie}"));
        }
    }
    let mut longer = glb.clone();
    longer.extend([7; 13]);
    assert_eq!(check(longer, "junk at the end").map(|warnings| warnings.len()), Ok(1));
}

#[test]
fn json_cut_short_or_deep() {
    let (_, document) = rich();
    let text = document.to_string();
    for len in (0..text.len()).step_by(7) {
        if text.is_char_boundary(len) {
            assert!(check(text.as_bytes()[..len].to_vec(), "cut short").is_err());
        }
    }
    for deep in [
        "[".repeat(1_000_000),
        "{\"a\":".repeat(1_000_000),
        format!("{}1e999{}", "[".repeat(9), "]".repeat(9)),
    ] {
        assert!(check(deep.into_bytes(), "deep").is_err());
    }
}

/// The error about a faulty number deep in the JSON names its place, although the text as a whole cannot be read.
#[test]
fn syntax_errors_have_a_place() {
    let findings = read_alone(br#"{"asset":{"version":"2.0"},"nodes":[{},{"scale":[1,2,1e999]}]}"#.to_vec());
    let findings = findings.expect_err("1e999 is beyond all numbers");
    assert_eq!(findings[0].pointer, "/nodes/1/scale/2");
}

#[test]
fn trees_only() {
    let spoiled = |nodes: Value| {
        let document = json!({ "asset": { "version": "2.0" }, "nodes": nodes });
        check(document.to_string().into_bytes(), "nodes").map_err(|findings| findings[0].pointer.clone())
    };
    assert_eq!(spoiled(json!([{ "children": [0] }])), Err("/nodes/0".to_owned()));
    assert_eq!(spoiled(json!([{ "children": [1] }, { "children": [0] }])), Err("/nodes/0".to_owned()));
    assert_eq!(spoiled(json!([{ "children": [2] }, { "children": [2] }, {}])), Err("/nodes/2".to_owned()));
    assert_eq!(spoiled(json!([{ "children": [1, 1] }, {}])), Err("/nodes/1".to_owned()));
    assert_eq!(spoiled(json!([{ "children": [7] }])), Err("/nodes/0/children/0".to_owned()));
    // A long chain is a tree, and takes no stack.
    let chain: Vec<Value> =
        (0..100_000).map(|node| json!({ "children": [node + 1] })).chain([json!({})]).collect();
    assert!(spoiled(json!(chain)).is_ok());
}

#[test]
fn a_claim_of_zeros_takes_no_memory() {
    for count in [4_000_000_000_u64, 100_000_000, u64::MAX, 1 << 53] {
        let document = json!({
            "asset": { "version": "2.0" },
            "accessors": [{ "componentType": 5126, "count": count, "type": "VEC3" }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        });
        let findings = check(document.to_string().into_bytes(), "zeros").expect_err("too many");
        assert!(findings[0].pointer.starts_with("/accessors/0"), "{}", findings[0]);
    }
}

/// Two thousand accessors on the same bytes become two thousand lists in memory: 24 GB, which is refused.
#[test]
fn overlapping_accessors_are_counted() {
    let accessor = json!({ "bufferView": 0, "componentType": 5121, "normalized": true, "count": 1_000_000, "type": "VEC3" });
    let accessors = vec![accessor; 2000];
    let primitive = |index| json!({ "attributes": { "POSITION": index } });
    let primitives: Vec<Value> = (0..2000).map(primitive).collect();
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 3_000_000, "uri": "a.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 3_000_000 }],
        "accessors": accessors,
        "meshes": [{ "primitives": primitives }],
    });
    let read = impasto_gltf::read(document.to_string().into_bytes(), &mut |_, _| Ok(vec![0; 3_000_000]));
    let findings = read.expect_err("24 GB are taken");
    assert_eq!(findings[0].severity, impasto_gltf::Severity::Limit);
}

/// Each scale is finite, but their product is not.
#[test]
fn scales_that_outgrow_all_numbers() {
    let node = |index: usize| json!({ "children": [index + 1], "scale": [1e38, 1e38, 0.0], "translation": [1e38, 0, 0] });
    let nodes: Vec<Value> = (0..20).map(node).chain([json!({})]).collect();
    let document = json!({ "asset": { "version": "2.0" }, "nodes": nodes });
    assert!(check(document.to_string().into_bytes(), "scales").is_ok());
}

/// A long list that many primitives share is scanned only once.
#[test]
fn sharing_takes_no_time() {
    let count = 250_000;
    let accessor =
        |kind: &str| json!({ "bufferView": 0, "componentType": 5126, "count": count, "type": kind });
    let primitive = json!({ "attributes": { "POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1, "COLOR_0": 2 } });
    let joints: Vec<usize> = vec![0];
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 16 * count, "uri": "a.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 16 * count }],
        "accessors": [accessor("VEC3"), accessor("VEC2"), accessor("VEC4"),
            { "bufferView": 0, "componentType": 5126, "count": count / 4, "type": "MAT4" }],
        "meshes": [{ "primitives": vec![primitive; 20_000] }],
        "skins": vec![json!({ "joints": joints, "inverseBindMatrices": 3 }); 20_000],
        "nodes": vec![json!({ "mesh": 0, "skin": 0 }); 20_000],
    });
    let start = Instant::now();
    let read = impasto_gltf::read(document.to_string().into_bytes(), &mut |_, _| Ok(vec![0; 16 * count]));
    assert!(read.is_ok());
    assert!(start.elapsed() < Duration::from_secs(3), "{:?}", start.elapsed());
}

/// A node may be three bytes in the file (`{},`), and takes much more in memory.
#[test]
fn short_texts_of_many_things_are_bounded() {
    for list in ["nodes", "materials", "scenes", "textures", "samplers"] {
        let text = format!(r#"{{"asset":{{"version":"2.0"}},"{list}":[{}{{}}]}}"#, "{},".repeat(3_000_000));
        let findings = read_alone(text.into_bytes()).expect_err("too many");
        assert_eq!(findings[0].severity, impasto_gltf::Severity::Limit, "{list}");
    }
    let text = format!(r#"{{"asset":{{"version":"2.0"}},"x":[{}0]}}"#, "0,".repeat(5_000_000));
    assert_eq!(read_alone(text.into_bytes()).expect_err("too many")[0].pointer, "/x/3999996");
}
