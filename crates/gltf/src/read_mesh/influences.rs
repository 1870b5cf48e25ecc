//! Joints and weights of skinned vertices.

use std::sync::Arc;

use crate::accessor::{Component, Shape};
use crate::cursor::Cursor;
use crate::decode::{Integers, Scan};
use crate::finding::{Checked, EXPORT_ANEW};
use crate::mesh::Influences;
use crate::read_mesh::{InfluenceKey, MeshReader};

/// Sets of four joints that are read.
const SETS: [(&str, &str); 2] = [("JOINTS_0", "WEIGHTS_0"), ("JOINTS_1", "WEIGHTS_1")];

/// The influences of a primitive with `count` vertices; `None` where it has no joints.
pub(crate) fn read(
    reader: &mut MeshReader<'_, '_, '_, '_>,
    attributes: &Cursor<'_, '_>,
    count: usize,
) -> Checked<Option<Arc<Influences>>> {
    const JOINT: [Component; 2] = [Component::U8, Component::U16];
    const WEIGHT: [Component; 3] = [Component::F32, Component::U8, Component::U16];
    let mut key = InfluenceKey::new();
    for (joints_name, weights_name) in SETS {
        let (Some(joints), Some(weights)) = (attributes.member(joints_name), attributes.member(weights_name))
        else {
            if let Some(lone) = attributes.member(joints_name).or_else(|| attributes.member(weights_name)) {
                return Err(
                    lone.error(format!("{joints_name} and {weights_name} go together, and one is missing"))
                );
            }
            break;
        };
        let joints_index = reader.accessors.expect(&joints, &[Shape::Vector(4)], &JOINT)?;
        let weights_index = reader.accessors.expect(&weights, &[Shape::Vector(4)], &WEIGHT)?;
        for (member, index) in [(&joints, joints_index), (&weights, weights_index)] {
            let own = reader.accessors.get(index).count;
            if own != count {
                return Err(
                    member.error(format!("accessor {index} has {own} elements for {count} positions"))
                );
            }
        }
        key.push((joints_index, weights_index));
    }
    if let Some(more) = attributes.member("JOINTS_2") {
        reader.findings.add(more.warning("more than 8 joints for a vertex: the rest is left out", ""));
    }
    if key.is_empty() {
        return Ok(None);
    }
    if let Some(known) = reader.influences.get(&key) {
        return Ok(Some(known.clone()));
    }
    let per_vertex = 4 * key.len();
    reader.accessors.take_memory(count * per_vertex, size_of::<u16>() + size_of::<f32>(), attributes)?;
    let mut influences = Influences {
        per_vertex,
        joints: vec![0; count * per_vertex],
        weights: vec![0.0; count * per_vertex],
        largest_joint: 0,
    };
    for (set, &(joints_index, weights_index)) in key.iter().enumerate() {
        let joints = reader.accessors.integers::<4>(joints_index)?;
        let weights =
            reader.accessors.finite_floats::<4>(weights_index, Integers::Normalized, reader.findings)?;
        if let Some(vertex) = reader.accessors.first(weights_index, Scan::Negative, &weights) {
            return Err(reader.error_at(weights_index, format!("a weight of vertex {vertex} is negative")));
        }
        let own = |vertex: usize| vertex * per_vertex + 4 * set..vertex * per_vertex + 4 * set + 4;
        for (vertex, (joints, weights)) in joints.iter().zip(&**weights).enumerate() {
            // Joints have 8 or 16 bits in the file.
            influences.joints[own(vertex)].copy_from_slice(&joints.map(|joint| joint as u16));
            influences.weights[own(vertex)].copy_from_slice(weights);
        }
        reader.accessors.give_back_memory(count, size_of::<[u32; 4]>());
    }
    finish(reader, attributes, &mut influences);
    let influences = Arc::new(influences);
    reader.influences.insert(key, influences.clone());
    Ok(Some(influences))
}

/// Makes the weights of each vertex sum to one, and finds the largest joint that has a weight.
fn finish(reader: &mut MeshReader<'_, '_, '_, '_>, attributes: &Cursor<'_, '_>, influences: &mut Influences) {
    let (mut off, mut empty) = (0, 0);
    let vertices = influences
        .weights
        .chunks_exact_mut(influences.per_vertex)
        .zip(influences.joints.chunks_exact(influences.per_vertex));
    for (weights, joints) in vertices {
        let sum: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
        if sum > 0.0 {
            // Sums of a few 8-bit weights are off by a step or two; that needs no warning.
            off += usize::from((sum - 1.0).abs() > 0.02);
            weights.iter_mut().for_each(|weight| *weight = (f64::from(*weight) / sum) as f32);
        } else {
            empty += 1;
            weights[0] = 1.0;
        }
        for (&joint, &weight) in joints.iter().zip(&*weights) {
            if weight > 0.0 {
                influences.largest_joint = influences.largest_joint.max(joint);
            }
        }
    }
    if off > 0 {
        let message = format!("the joint weights of {off} vertices do not sum to 1, and are scaled");
        reader.findings.add(attributes.warning(message, EXPORT_ANEW));
    }
    if empty > 0 {
        let message = format!("{empty} vertices have no joint weights, and follow their first joint");
        reader.findings.add(attributes.warning(message, EXPORT_ANEW));
    }
}
