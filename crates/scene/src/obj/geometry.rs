//! The geometry of an OBJ text, read by tobj from the text that the linter has cleaned.

use std::iter::repeat_n;

use glam::{DVec3, Vec2, Vec3};
use tobj::{LoadError, LoadOptions};

use super::lint::Checked;
use super::scan::{Kind, unit};
use super::text::Findings;
use crate::surface::Geometry;

/// Models that are smaller than this are scaled to a size of 1: their areas would vanish in single precision.
const LEAST_EXTENT: f64 = 1e-6;

/// Models that are larger than this are scaled to a size of 1 too: the floor and the camera for one much larger would
/// exceed the limits of a scene.
const MOST_EXTENT: f64 = 1e7;

/// A model whose middle is farther from the origin than this many times its size is moved to the origin, since single
/// precision has too few digits so far out.
const FAR: f64 = 1000.0;

/// Reads the cleaned text of `checked`, in which the linter must have found no error. Each different triple of indices
/// that a corner has becomes a vertex. With `with_points`, a point cache moves the model, which then must keep the size
/// and the place that it has in the file.
///
/// # Errors
/// Those of tobj. The linter should have found any of them before.
pub(super) fn read(
    checked: &mut Checked<'_>,
    findings: &mut Findings<'_>,
    with_points: bool,
) -> Result<Geometry, LoadError> {
    // The cleaned text has no names and no materials, so all the faces are one model.
    let options = LoadOptions { single_index: true, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut checked.cleaned, &options, |_| Err(LoadError::OpenFileFailed))?;
    let mut mesh = models.into_iter().next().ok_or(LoadError::GenericFailure)?.mesh;

    // tobj's lists of texture coordinates and normals leave out vertices that have none, so both are matched to the
    // vertices here. A vertex is new at the first corner that uses it.
    let mut listed_uvs = mesh.texcoords.as_chunks::<2>().0.iter();
    let mut listed_normals = mesh.normals.as_chunks::<3>().0.iter();
    let count = mesh.positions.len() / 3;
    let (mut uvs, mut normals) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for (&vertex, gives) in mesh.indices.iter().zip(&checked.corners) {
        if vertex as usize == uvs.len() {
            let has = |kind: Kind| gives >> kind as u8 & 1 == 1;
            let uv = if has(Kind::Uv) { listed_uvs.next() } else { None };
            let normal = if has(Kind::Normal) { listed_normals.next() } else { None };
            uvs.push(uv.map(|uv| Vec2::from_array(uv.map(|value| value as f32))));
            normals.push(normal.and_then(|&normal| unit(normal)).map(Vec3::from_array));
        }
    }
    let triangles = repeat_n(&3, mesh.indices.len() / 3);
    let sum = |end: &mut u32, arity: &u32| {
        *end += arity;
        Some(*end)
    };
    let ends = if mesh.face_arities.is_empty() {
        triangles.scan(0, sum).collect()
    } else {
        mesh.face_arities.iter().scan(0, sum).collect()
    };
    let positions = mesh.positions.as_chunks_mut::<3>().0;
    if let Some(extent) = rescale_extreme(positions) {
        let what = if extent < 1.0 { "small for single precision" } else { "large for a scene" };
        let message = format!("the model is {extent:e} across, too {what}");
        let place = checked.faces.first().map_or(0, |face| face.offset as usize);
        if with_points {
            let mend = "it would be scaled, and its point cache not; export both in other units";
            findings.error(place, message, mend);
        } else {
            findings.warning(place, message, "it is scaled to a size of 1; export it in other units");
        }
    }
    if !with_points && let Some(middle) = bring_near(positions) {
        let [x, y, z] = middle.to_array();
        let message = format!("the model lies far from its origin, around [{x}, {y}, {z}]");
        let mend =
            "it is read around that place; to stand beside others of its kind, objects need a `translation`";
        findings.warning(checked.faces.first().map_or(0, |face| face.offset as usize), message, mend);
    }
    // Adding 0 makes -0 and 0 the same.
    let positions = positions.iter().map(|at| Vec3::from_array(at.map(|value| value as f32 + 0.0))).collect();
    Ok(Geometry { positions, uvs, normals, corners: mesh.indices, ends, ..Geometry::default() })
}

/// Least and greatest corner of the box round all positions.
fn bounds(positions: &[[f64; 3]]) -> (DVec3, DVec3) {
    let points = positions.iter().map(|&at| DVec3::from_array(at));
    points.fold((DVec3::MAX, DVec3::MIN), |(low, high), at| (low.min(at), high.max(at)))
}

/// Moves a model that lies far from the origin to the origin, and returns from where; `None` if it stays. It moves by a
/// whole number of steps. A step is a power of 2 not smaller than the model, so a model that was changed a little moves
/// as far as before.
fn bring_near(positions: &mut [[f64; 3]]) -> Option<DVec3> {
    let (low, high) = bounds(positions);
    let (extent, middle) = ((high - low).max_element(), (low + high) * 0.5);
    let is_far = extent > 0.0 && extent.is_finite() && middle.abs().max_element() > FAR * extent;
    let step = is_far.then(|| extent.log2().ceil().exp2())?;
    let from = (middle / step).round() * step;
    positions.iter_mut().for_each(|at| *at = (DVec3::from_array(*at) - from).to_array());
    Some(from)
}

/// Scales a model that is smaller than [`LEAST_EXTENT`] or larger than [`MOST_EXTENT`] to a size of 1, and returns how
/// large it was. `None` for any other model.
fn rescale_extreme(positions: &mut [[f64; 3]]) -> Option<f64> {
    let (low, high) = bounds(positions);
    let extent = (high - low).max_element();
    let is_extreme = extent > 0.0 && !(LEAST_EXTENT..=MOST_EXTENT).contains(&extent) && extent.is_finite();
    is_extreme.then(|| positions.as_flattened_mut().iter_mut().for_each(|value| *value /= extent))?;
    Some(extent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_models_are_scaled_to_a_size_of_1_and_others_stay() {
        for (size, is_scaled) in [(1e-9, true), (1e-3, false), (1e6, false), (1e9, true)] {
            let mut positions = [[0.0, 0.0, 0.0], [size, 0.25 * size, 0.0]];
            let extent = rescale_extreme(&mut positions);
            assert_eq!(extent.is_some(), is_scaled, "{size:e}");
            let expected = if is_scaled { [1.0, 0.25, 0.0] } else { [size, 0.25 * size, 0.0] };
            assert_eq!(positions[1], expected);
        }
        assert_eq!(rescale_extreme(&mut []), None);
    }

    #[test]
    fn models_far_from_the_origin_are_read_around_their_place() {
        let quad = |at: f64| [[at - 0.5, 0.0, 3.0], [at + 0.25, 0.125, 3.0]];
        for (at, is_far) in [(0.0, false), (700.0, false), (3e5, true), (-1e7, true), (9e8, true)] {
            let mut positions = quad(at);
            let from = bring_near(&mut positions);
            assert_eq!(from.is_some(), is_far, "{at:e}");
            // The move is exact to the bit.
            let from = from.unwrap_or_default();
            assert_eq!(positions.map(|near| (DVec3::from_array(near) + from).to_array()), quad(at));
            assert!(
                !is_far || positions.as_flattened().iter().all(|value| value.abs() < 4.0),
                "{positions:?}"
            );
            // A model that grew a little moves as before.
            let mut grown = quad(at);
            grown[1][0] += 0.01;
            assert_eq!(bring_near(&mut grown).unwrap_or_default(), from);
        }
        assert_eq!(bring_near(&mut []), None);
        assert_eq!(bring_near(&mut [[1e6; 3]; 3]), None);
    }
}
