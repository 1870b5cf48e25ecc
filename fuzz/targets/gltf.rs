//! Fuzzes glTF files, text or binary: they are read or refused, and what is read can be posed at any time.

#![no_main]

use impasto_gltf::{Animator, Playing};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut no_other_files = |name: &str, _: u64| Err(format!("no file {name}"));
    let Ok((gltf, _)) = impasto_gltf::read(bytes.to_vec(), &mut no_other_files) else { return };
    for mesh in &gltf.meshes {
        for primitive in &mesh.primitives {
            let count = primitive.positions.len();
            assert!(primitive.positions.iter().flatten().all(|number| number.is_finite()));
            assert!(primitive.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
        }
    }
    let (animator, _) = Animator::new(&gltf, Playing::All).expect("no animation was asked for by name");
    let span_s = animator.span_s().unwrap_or_default();
    for time_s in [f64::MIN, -1.0, 0.0, f64::from(span_s[0]), 0.37, f64::from(span_s[1]), f64::MAX] {
        let posed = animator.pose(time_s);
        assert!(posed.world_from_node.iter().all(|matrix| matrix.is_finite()), "at {time_s}");
    }
});
