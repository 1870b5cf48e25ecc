//! Triangles from lists, strips and fans, with or without indices.

use std::sync::Arc;

use crate::accessor::{Component, Shape};
use crate::cursor::Cursor;
use crate::finding::{Checked, EXPORT_ANEW};
use crate::read_mesh::MeshReader;

/// Vertex indices of triangles, shared.
pub(crate) type Triangles = Arc<Vec<[u32; 3]>>;

/// How vertices make triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Mode {
    /// Every three vertices are a triangle.
    Triangles,
    /// Each vertex makes a triangle with the two before it. Every other triangle is reversed, so that all wind alike.
    Strip,
    /// Each vertex makes a triangle with the one before it and the first.
    Fan,
}

/// The triangles of a primitive with `count` vertices. Primitives with the same indices, mode and count share one list.
///
/// # Errors
/// An index that is not less than `count`; triangles that need more memory than is left.
pub(crate) fn triangles(
    reader: &mut MeshReader<'_, '_, '_, '_>,
    primitive: &Cursor<'_, '_>,
    mode: Mode,
    count: usize,
) -> Checked<Triangles> {
    const INDEX: [Component; 3] = [Component::U8, Component::U16, Component::U32];
    let member = primitive.member("indices");
    let accessor = match &member {
        Some(member) => Some(reader.accessors.expect(member, &[Shape::Scalar], &INDEX)?),
        None => None,
    };
    let key = (accessor, mode, count);
    if let Some(known) = reader.triangles.get(&key) {
        return Ok(known.clone());
    }
    if u32::try_from(count).is_err() {
        return Err(primitive.error(format!("a primitive of {count} vertices is too large")));
    }
    let cursor = member.as_ref().unwrap_or(primitive);
    let index_count = accessor.map_or(count, |accessor| reader.accessors.get(accessor).count);
    match mode {
        Mode::Triangles if index_count % 3 != 0 => {
            let message =
                format!("{index_count} corners make no whole number of triangles: the last are left out");
            reader.findings.add(cursor.warning(message, EXPORT_ANEW));
        }
        _ if index_count < 3 => {
            reader
                .findings
                .add(cursor.warning(format!("{index_count} corners make no triangle"), EXPORT_ANEW));
        }
        _ => {}
    }
    let triangle_count =
        if mode == Mode::Triangles { index_count / 3 } else { index_count.saturating_sub(2) };
    reader.accessors.take_memory(triangle_count, size_of::<[u32; 3]>(), cursor)?;
    let triangles = match accessor {
        Some(accessor) => {
            let indices = reader.accessors.integers::<1>(accessor)?.into_flattened();
            if let Some(place) = indices.iter().position(|&index| index as usize >= count) {
                let message = format!(
                    "index {} at {place} is beyond the {count} vertices of a primitive",
                    indices[place]
                );
                return Err(reader.error_at(accessor, message));
            }
            let triangles = assembled(mode, indices.len(), |corner| indices[corner]);
            // The list of indices is dropped here.
            reader.accessors.give_back_memory(index_count, size_of::<u32>());
            triangles
        }
        None => assembled(mode, count, |corner| corner as u32),
    };
    let triangles = Arc::new(triangles);
    reader.triangles.insert(key, triangles.clone());
    Ok(triangles)
}

/// Triangles of `count` corners. Strips and fans are stitched with triangles that repeat a corner; these are dropped.
pub(crate) fn assembled(mode: Mode, count: usize, vertex: impl Fn(usize) -> u32) -> Vec<[u32; 3]> {
    let has_three = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::Triangles => {
            (0..count / 3).map(|triangle| [0, 1, 2].map(|corner| vertex(3 * triangle + corner))).collect()
        }
        Mode::Strip => (0..count.saturating_sub(2))
            .map(|first| [first, first + 1 + first % 2, first + 2 - first % 2].map(&vertex))
            .filter(has_three)
            .collect(),
        Mode::Fan => (0..count.saturating_sub(2))
            .map(|first| [first + 1, first + 2, 0].map(&vertex))
            .filter(has_three)
            .collect(),
    }
}

#[cfg(test)]
mod tests;
