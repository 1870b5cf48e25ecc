//! Tests that numbers and triangles are read correctly in every form that they may have in a file.

use serde_json::{Value, json};

use crate::build::{Buffer, good, lines, read_alone};
use impasto_gltf::{LocalTransform, Severity};

fn one_primitive(buffer: &Buffer, primitive: Value) -> Value {
    buffer.finish(json!({
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }], "meshes": [{ "primitives": [primitive] }],
    }))
}

const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.];

#[test]
fn strips_and_fans_become_triangles() {
    for (mode, expected) in
        [(5, vec![[0, 1, 2], [1, 3, 2]]), (6, vec![[1, 2, 0], [2, 3, 0]]), (4, vec![[0, 1, 2]])]
    {
        let mut buffer = Buffer::default();
        let positions = buffer.floats("VEC3", &SQUARE);
        let document =
            one_primitive(&buffer, json!({ "attributes": { "POSITION": positions }, "mode": mode }));
        let (gltf, _) = good(&document);
        assert_eq!(*gltf.meshes[0].primitives[0].triangles, expected, "mode {mode}");
    }
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    for mode in 0..4 {
        let mut buffer = Buffer::default();
        let positions = buffer.floats("VEC3", &SQUARE);
        let document =
            one_primitive(&buffer, json!({ "attributes": { "POSITION": positions }, "mode": mode }));
        let (gltf, warnings) = good(&document);
        assert!(gltf.meshes[0].primitives.is_empty());
        assert_eq!(warnings[0].pointer, "/meshes/0/primitives/0/mode", "{}", lines(&warnings));
    }
}

#[test]
fn small_integers_are_dequantised() {
    let cases: [(u64, bool, &[u8], [f32; 3]); 6] = [
        (5120, true, &[127, 0x80, 0x81, 0], [1.0, -1.0, -1.0]),
        (5120, false, &[127, 0x80, 5, 0], [127.0, -128.0, 5.0]),
        (5121, true, &[255, 0, 51, 0], [1.0, 0.0, 0.2]),
        (5122, true, &[0xFF, 0x7F, 0x00, 0x80, 0, 0, 0, 0], [1.0, -1.0, 0.0]),
        (5123, true, &[0xFF, 0xFF, 0, 0, 0x33, 0x33, 0, 0], [1.0, 0.0, 0.2]),
        (5123, false, &[0xFF, 0xFF, 1, 0, 0, 1, 0, 0], [65535.0, 1.0, 256.0]),
    ];
    for (component, normalized, element, expected) in cases {
        let mut buffer = Buffer::default();
        let view = buffer.view(&element.repeat(3));
        buffer.views[view]["byteStride"] = json!(element.len());
        let positions = buffer.accessor(json!({
            "bufferView": view, "componentType": component, "normalized": normalized, "count": 3, "type": "VEC3",
        }));
        let mut document = one_primitive(&buffer, json!({ "attributes": { "POSITION": positions } }));
        document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        let (gltf, _) = good(&document);
        assert_eq!(*gltf.meshes[0].primitives[0].positions, [expected; 3], "{component} {normalized}");
    }
}

#[test]
fn strided_views_hold_several_lists() {
    let mut buffer = Buffer::default();
    let mut bytes = Vec::new();
    for vertex in 0..3_u8 {
        let position = [f32::from(vertex), f32::from(vertex == 1), 7.0];
        let uv = [f32::from(vertex) / 2.0, 0.25];
        bytes.extend(position.iter().chain(&uv).flat_map(|number| number.to_le_bytes()));
    }
    let view = buffer.view(&bytes);
    buffer.views[view]["byteStride"] = json!(20);
    let positions =
        buffer.accessor(json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3" }));
    let uvs = buffer.accessor(
        json!({ "bufferView": view, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC2" }),
    );
    let primitive = json!({ "attributes": { "POSITION": positions, "TEXCOORD_1": uvs } });
    let (gltf, _) = good(&one_primitive(&buffer, primitive));
    let primitive = &gltf.meshes[0].primitives[0];
    assert_eq!(*primitive.positions, [[0., 0., 7.], [1., 1., 7.], [2., 0., 7.]]);
    assert_eq!(primitive.uvs[0], None);
    assert_eq!(primitive.uvs[1].as_deref(), Some(&vec![[0., 0.25], [0.5, 0.25], [1., 0.25]]));
    // A fourth element would lie beyond the view.
    buffer.accessors[0]["count"] = json!(4);
    let refused = read_alone(
        one_primitive(&buffer, json!({ "attributes": { "POSITION": 0 } })).to_string().into_bytes(),
    );
    assert_eq!(refused.expect_err("beyond the view")[0].pointer, "/accessors/0");
}

#[test]
fn sparse_accessors_with_and_without_a_view() {
    for has_view in [true, false] {
        let mut buffer = Buffer::default();
        let mut accessor = json!({ "componentType": 5126, "count": 4, "type": "VEC3" });
        if has_view {
            let base: Vec<u8> = SQUARE.iter().flat_map(|number| number.to_le_bytes()).collect();
            accessor["bufferView"] = json!(buffer.view(&base));
        }
        let indices = buffer.view(&[1, 3]);
        let values: Vec<u8> =
            [1_f32, 2., 3., 4., 5., 6.].iter().flat_map(|number| number.to_le_bytes()).collect();
        let values = buffer.view(&values);
        accessor["sparse"] = json!({
            "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values },
        });
        let positions = buffer.accessor(accessor);
        let (gltf, _) =
            good(&one_primitive(&buffer, json!({ "attributes": { "POSITION": positions }, "mode": 5 })));
        let rest = if has_view { [0., 1., 0.] } else { [0.; 3] };
        assert_eq!(*gltf.meshes[0].primitives[0].positions, [[0.; 3], [1., 2., 3.], rest, [4., 5., 6.]]);
    }
}

#[test]
fn primitives_share_what_they_name_twice() {
    let mut buffer = Buffer::default();
    let positions = buffer.floats("VEC3", &SQUARE);
    let indices = buffer.shorts(&[0, 1, 2]);
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    let document = buffer.finish(json!({
        "scene": 0, "scenes": [{ "nodes": [0, 1] }], "nodes": [{ "mesh": 0, "name": "A" }, { "mesh": 1 }],
        "meshes": [{ "primitives": [primitive, primitive] }, { "primitives": [primitive] }],
    }));
    let (gltf, _) = good(&document);
    let all: Vec<_> = gltf.meshes.iter().flat_map(|mesh| &mesh.primitives).collect();
    assert!(all.iter().all(|primitive| std::sync::Arc::ptr_eq(&primitive.positions, &all[0].positions)));
    assert!(all.iter().all(|primitive| std::sync::Arc::ptr_eq(&primitive.triangles, &all[0].triangles)));
}

#[test]
fn names_are_unique_and_the_old_ones_kept() {
    let names = ["Cube", "Cube", "", "Cube.001", "Cube"];
    let nodes: Vec<Value> = names.iter().map(|name| json!({ "name": name })).chain([json!({})]).collect();
    let (gltf, _) = good(&json!({ "asset": { "version": "2.0" }, "nodes": nodes }));
    let unique: Vec<&str> = gltf.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(unique, ["Cube", "Cube.002", "Node.2", "Cube.001", "Cube.003", "Node.5"]);
    assert_eq!(gltf.nodes[4].original_name.as_deref(), Some("Cube"));
}

#[test]
fn weights_that_do_not_sum_to_one_are_scaled() {
    let mut buffer = Buffer::default();
    let positions = buffer.floats("VEC3", &SQUARE[..9]);
    let joints_view = buffer.view(&[0, 1, 0, 9].repeat(3));
    let joints = buffer
        .accessor(json!({ "bufferView": joints_view, "componentType": 5121, "count": 3, "type": "VEC4" }));
    let weights = buffer.floats("VEC4", &[1., 3., 0., 0., 0., 0., 0., 0., 0.25, 0.75, 0., 0.]);
    let primitive =
        json!({ "attributes": { "POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights } });
    let (gltf, warnings) = good(&one_primitive(&buffer, primitive));
    let influences = gltf.meshes[0].primitives[0].influences.as_ref().expect("it has joints");
    assert_eq!(influences.weights, [0.25, 0.75, 0., 0., 1., 0., 0., 0., 0.25, 0.75, 0., 0.]);
    // Joint 9 has no weight anywhere.
    assert_eq!(influences.largest_joint, 1);
    assert_eq!(warnings.iter().filter(|warning| warning.message.contains("weights")).count(), 2);
}

#[test]
fn what_is_not_read_is_refused_by_name() {
    for (name, mend) in [
        ("KHR_draco_mesh_compression", "export without compression"),
        ("EXT_meshopt_compression", "export without compression"),
        ("KHR_texture_basisu", "export with PNG, JPEG or WebP pictures"),
        ("ACME_thing", "export without it"),
    ] {
        let document =
            json!({ "asset": { "version": "2.0" }, "extensionsUsed": [name], "extensionsRequired": [name] });
        let findings = read_alone(document.to_string().into_bytes()).expect_err("it is required");
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].severity, Severity::Unsupported);
        assert_eq!(findings[0].pointer, "/extensionsRequired/0");
        assert!(findings[0].message.contains(name));
        assert_eq!(findings[0].mend, mend);
    }
}

/// A file may use Draco compression without naming it in `extensionsRequired`. Its accessors have no buffer view, so
/// they would be read as zeros.
#[test]
fn compressed_primitives_are_not_zeros() {
    let document = json!({
        "asset": { "version": "2.0" }, "extensionsUsed": ["KHR_draco_mesh_compression"],
        "accessors": [{ "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 },
            "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": { "POSITION": 0 } } } }] }],
    });
    let findings = read_alone(document.to_string().into_bytes()).expect_err("its numbers are not read");
    assert_eq!(findings[0].severity, Severity::Unsupported);
}

#[test]
fn whole_numbers_may_be_written_with_a_point() {
    let text = r#"{"asset":{"version":"2.0"},"scene":0.0,"scenes":[{"nodes":[1.0]}],"nodes":[{},{"children":[0.0]}]}"#;
    let (gltf, warnings) = read_alone(text.as_bytes().to_vec()).expect("the validator takes it too");
    assert!(warnings.is_empty());
    assert_eq!(gltf.roots, [1]);
    assert!(matches!(gltf.nodes[0].local, LocalTransform::Trs(_)));
}

#[test]
fn files_are_asked_for_by_checked_names() {
    let document = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 4, "uri": "a%20b.bin" }, { "byteLength": 3, "uri": "a%20b.bin" }],
    });
    let mut asked = Vec::new();
    let read = impasto_gltf::read(document.to_string().into_bytes(), &mut |name, max_bytes| {
        asked.push((name.to_owned(), max_bytes));
        Ok(vec![0; 4])
    });
    assert!(read.is_ok());
    assert_eq!(asked, [("a b.bin".to_owned(), impasto_gltf::MAX_FILE_BYTES)]);
}
