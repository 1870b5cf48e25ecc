//! How many particles an object needs where the scene does not state it.

use std::collections::{HashMap, HashSet};

use glam::{DAffine3, DVec2, DVec3, Vec3};
use impasto_core::sampling::Surface;
use impasto_core::screen_map::{area_px, facing};
use impasto_core::{ScreenMap, TriangleMesh};
use impasto_scene::document::{Object, Scene};
use rayon::prelude::*;

use crate::body_shape::BodyShape;
use crate::size_follow::Following;
use crate::view::PictureView;

/// The greatest count of a coat.
const MOST: f64 = 400_000.0;

/// The least count that is found: a reserve for cameras that come nearer than the scene's own. Where there are many
/// objects it shrinks down to `LEAST_OF_MANY`, so that all reserves together stay small.
const LEAST: u32 = 64;
const LEAST_OF_MANY: u32 = 8;

/// With more objects than this the least count is halved, and again whenever their number doubles.
const MANY: usize = 2048;

/// The least number of particles of a layer in a scene with this many objects. It has few steps, so that an edit hardly
/// ever changes it.
pub(crate) fn least(objects: usize) -> u32 {
    let halvings = (0..u32::BITS).take_while(|halvings| objects > MANY << halvings).count();
    (LEAST >> halvings.min(31)).max(LEAST_OF_MANY)
}

/// How far from the middle of the picture a face still counts, in half sizes of the picture.
const MARGIN: f64 = 1.1;

/// Once an object's faces cover the picture this many times, one behind the other, further faces give the object no
/// more particles: nearly all of them are hidden, as in a heap of thousands of large triangles. Groups of one mesh that
/// are objects of their own share this limit, but the limit of each is at least `LEAST_DEEP`.
const DEEPEST: f64 = 16.0;
const LEAST_DEEP: f64 = 4.0;

/// The deeper a heap, the more of its strokes hide each other. Therefore a heap beyond the limit above counts for less
/// the deeper it is: with a limit of 16, faces that cover the picture 20 times count as 16² / 20 = 12.8 times, and those
/// that cover it 32 times as 8. They count at least this many times or, if that is less, as often as the limit.
const DEEP_HEAP: f64 = 6.0;

/// The share of the count found for an object that it gets if its faces cover the picture `cover` times: all of it up
/// to the object's limit, which is `deepest` times.
fn share_of_deep(cover: f64, deepest: f64) -> f64 {
    let counting = (deepest * deepest / cover).max(DEEP_HEAP.min(deepest));
    if cover > deepest { counting / cover } else { 1.0 }
}

/// For each object, how many groups of its mesh are objects, itself included; 1 where it is the whole mesh.
pub(crate) fn groups_of_meshes(scene: &Scene) -> Vec<usize> {
    let mut groups: HashMap<&str, HashSet<&str>> = HashMap::new();
    for object in &scene.objects {
        if let Some(group) = &object.group {
            groups.entry(&object.mesh).or_default().insert(group);
        }
    }
    let of = |object: &Object| object.group.as_ref().map_or(1, |_| groups[object.mesh.as_str()].len());
    scene.objects.iter().map(of).collect()
}

/// The limit [`DEEPEST`] for an object that is one of this many groups of its mesh.
pub(crate) fn deepest(groups: usize) -> f64 {
    (DEEPEST / groups.max(1) as f64).max(LEAST_DEEP)
}

/// At most this many faces are examined.
const FACES: usize = 20_000;

/// One view of the object, in a picture of the size that the scene states.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sighting {
    pub(crate) map: ScreenMap,
    pub(crate) half_size_px: DVec2,
    pub(crate) near: f64,
    /// The shape of the body.
    pub(crate) shape: BodyShape,
}

/// How far beyond the picture there are particles, and how far from its particle a stroke's paint may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach {
    /// How far from the middle of the picture there are particles, in half sizes of the picture.
    pub(crate) margin: f64,
    /// How far strokes of the stated size reach beyond their particles, pixels at the scene's own size.
    pub(crate) reach_px: f64,
    /// How the strokes' size follows that of the surface; `None` if they keep their size in the picture.
    pub(crate) following: Option<Following>,
    /// How far strokes are lifted off the surface along its normal, at least and at most, model units.
    pub(crate) offsets: [f64; 2],
}

impl Reach {
    /// How far strokes may be from the surface, model units.
    pub(crate) fn most_offset(&self) -> f64 {
        self.offsets.into_iter().map(f64::abs).fold(0.0, f64::max)
    }
}

/// A face that a view does not see whole, or sees at very different depths, is cut into pieces that are at most this
/// share of the surface.
const PIECE: f64 = 1.0 / 2000.0;

/// A face is cut into at most the square of this many pieces.
const MOST_CUTS: f64 = 64.0;

/// The middle of a face stands for all of it while its corners' depths differ by at most this share of the nearest
/// depth.
const EVEN_DEPTH: f64 = 0.25;

/// A face or a piece of one, with how many strokes are wanted there.
struct CountedFace<const LAYERS: usize> {
    triangle: u32,
    flipped: bool,
    center: DVec3,
    normal: DVec3,
    /// The area at rest.
    area: f64,
    /// Strokes wanted per pixel, of each layer.
    wanted_per_px: [f64; LAYERS],
}

/// How many particles each layer needs.
pub(crate) struct Found<const LAYERS: usize> {
    pub(crate) needed: [f64; LAYERS],
    /// Whether views see large faces in part, or very unevenly. A small spot on such a face may then need more
    /// particles than its share of `needed`.
    pub(crate) is_cut: bool,
    /// How often, on average, faces that face the eye cover the part of the picture where the object is; the greatest
    /// of all views.
    pub(crate) deepness: f64,
}

/// How many particles each layer needs on the whole surface. They are enough that, in every view, nine tenths of the
/// object's area in the picture have all the strokes that are wanted there. `wanted_per_px` gives the strokes per pixel
/// wanted on a triangle, from its index, a point of it and its normal. `positions_at` gives the vertices' positions in
/// a shape, or `None` at rest. If the faces cover the picture more than `deepest` times, fewer particles are enough:
/// see [`share_of_deep`].
pub(crate) fn find<const LAYERS: usize>(
    surface: &Surface<'_>,
    sightings: &[Sighting],
    deepest: f64,
    positions_at: impl Fn(&BodyShape) -> Option<Vec<Vec3>> + Sync,
    wanted_per_px: impl Fn(usize, DVec3, DVec3) -> [f32; LAYERS],
) -> Found<LAYERS> {
    // Odd, since front and back faces of a sheet alternate: an even stride would take one side only.
    let stride = surface.faces().count().div_ceil(FACES) | 1;
    let faces: Vec<CountedFace<LAYERS>> = surface
        .faces()
        .step_by(stride)
        .flat_map(|(triangle, flipped, area)| {
            let corners = surface.mesh().corners(triangle as usize).map(Vec3::as_dvec3);
            let [a, b, c] = corners;
            let across = (b - a).cross(c - a).normalize_or_zero();
            let normal = if flipped { -across } else { across };
            let share = area / (surface.area() * PIECE);
            let is_uneven = share > 1.0 && sightings.iter().any(|sighting| sighting.is_uneven(corners));
            let cuts = if is_uneven { share.sqrt().ceil().min(MOST_CUTS) as usize } else { 1 };
            let wanted = &wanted_per_px;
            middles(corners, cuts).map(move |center| CountedFace {
                triangle,
                flipped,
                center,
                normal,
                area: area / (cuts * cuts) as f64,
                wanted_per_px: wanted(triangle as usize, center, normal).map(f64::from),
            })
        })
        .collect();
    let most = |a: ([f64; LAYERS], f64), b: ([f64; LAYERS], f64)| {
        (std::array::from_fn(|layer| a.0[layer].max(b.0[layer])), a.1.max(b.1))
    };
    let mesh = surface.mesh();
    let needed_in = |sighting: &Sighting| {
        let moved = positions_at(&sighting.shape);
        needed_per_area(&faces, (stride as f64, deepest), sighting, |face| match &moved {
            Some(positions) => face.moved(mesh, positions),
            None => (face.center, face.normal),
        })
    };
    let (needed_per_area, deepness) =
        sightings.par_iter().map(needed_in).reduce(|| ([0.0; LAYERS], 0.0), most);
    // A quarter more: with exactly the number wanted, strokes of the highest ranks are only half present.
    Found {
        needed: needed_per_area.map(|needed| needed * surface.area() * 1.25),
        is_cut: faces
            .windows(2)
            .any(|pair| (pair[0].triangle, pair[0].flipped) == (pair[1].triangle, pair[1].flipped)),
        deepness: deepness * stride as f64,
    }
}

/// The count of a coat that needs `needed` particles: at least `least` and at most [`MOST`].
pub(crate) fn bounded(needed: f64, least: u32) -> usize {
    needed.clamp(f64::from(least), MOST).ceil() as usize
}

/// A count that was found, times `by`, but at most [`MOST`] or, if that is more, the count itself.
pub(crate) fn times(found: usize, by: f32) -> usize {
    let most = found.max(MOST as usize);
    ((found as f64 * f64::from(by)).ceil() as usize).min(most)
}

impl<const LAYERS: usize> CountedFace<LAYERS> {
    /// Its middle when the vertices are at these positions, and its normal, whose length is its area now over that at
    /// rest.
    fn moved(&self, mesh: &TriangleMesh, positions: &[Vec3]) -> (DVec3, DVec3) {
        let at = |positions: &[Vec3]| {
            mesh.triangles[self.triangle as usize].map(|vertex| positions[vertex as usize].as_dvec3())
        };
        let ([a, b, c], [p, q, r]) = (at(&mesh.positions), at(positions));
        let across = (b - a).cross(c - a);
        let share = |from: DVec3, to: DVec3| {
            (to - from).cross(self.center - from).dot(across) / across.length_squared()
        };
        let (v, w) = (share(c, a), share(a, b));
        let grown = (q - p).cross(r - p) / across.length();
        (p + (q - p) * v + (r - p) * w, if self.flipped { -grown } else { grown })
    }
}

impl Sighting {
    /// A body at this pose, at rest, in a view.
    pub(crate) fn of(view: &PictureView, world_from_model: DAffine3) -> Self {
        let [width, height] = view.size_px.map(f64::from);
        Self {
            map: view.screen_map(world_from_model),
            half_size_px: DVec2::new(width, height) * 0.5,
            near: view.near(),
            shape: BodyShape::default(),
        }
    }

    /// Whether the middle of a triangle does not stand for all of it: a part of it is out of sight, or much nearer than
    /// another.
    fn is_uneven(&self, corners: [DVec3; 3]) -> bool {
        let depths = corners.map(|corner| self.map.depth(corner));
        let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
        let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let is_outside =
            |corner: &DVec3| !self.map.project(*corner).abs().cmplt(self.half_size_px * MARGIN).all();
        farthest > self.near
            && (nearest <= self.near
                || farthest - nearest > EVEN_DEPTH * nearest
                || corners.iter().any(is_outside))
    }
}

/// Cuts each side of a triangle into `cuts` parts, which makes equal small triangles. Returns their middles.
fn middles([a, b, c]: [DVec3; 3], cuts: usize) -> impl Iterator<Item = DVec3> {
    let at = move |row: usize, column: usize, third: f64| {
        let [v, w] = [row, column].map(|number| (number as f64 + third / 3.0) / cuts as f64);
        a + (b - a) * v + (c - a) * w
    };
    (0..cuts).flat_map(move |row| {
        let upright = (0..cuts - row).map(move |column| at(row, column, 1.0));
        upright.chain((0..cuts - row - 1).map(move |column| at(row, column, 2.0)))
    })
}

/// Particles needed per unit of surface in one view, by layer, and how often the given faces cover the box round them.
/// Only every `stride`-th face of the object is given. If all its faces cover the picture more than `deepest` times,
/// fewer particles are needed: see [`share_of_deep`].
fn needed_per_area<const LAYERS: usize>(
    faces: &[CountedFace<LAYERS>],
    (stride, deepest): (f64, f64),
    sighting: &Sighting,
    placed: impl Fn(&CountedFace<LAYERS>) -> (DVec3, DVec3),
) -> ([f64; LAYERS], f64) {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let seen: Vec<(&CountedFace<LAYERS>, f64)> = faces
        .iter()
        .filter_map(|face| {
            let (center, normal) = placed(face);
            let px = sighting.map.project(center);
            let inside = px.abs().cmplt(sighting.half_size_px * MARGIN).all();
            if sighting.map.depth(center) <= sighting.near || !inside {
                return None;
            }
            let jacobian = sighting.map.jacobian(center);
            let px_per_area = area_px(jacobian, normal);
            let faces_the_eye = px_per_area.is_finite() && facing(jacobian, normal) > 0.0;
            if faces_the_eye {
                (low, high) = (low.min(px), high.max(px));
            }
            faces_the_eye.then_some((face, px_per_area))
        })
        .collect();
    let shown = |(face, px_per_area): &(&CountedFace<LAYERS>, f64)| px_per_area * face.area;
    // Half of the largest face may reach beyond the box round the middles, on either side.
    let largest_px = seen.iter().map(shown).fold(0.0, f64::max).sqrt();
    let box_px = ((high - low).max(DVec2::ZERO) + largest_px).element_product();
    let deepness = seen.iter().map(shown).sum::<f64>() / box_px.max(f64::MIN_POSITIVE);
    let mut needed: Vec<(f64, f64)> = Vec::with_capacity(seen.len());
    let needed_by_layer =
        std::array::from_fn(|layer| {
            needed.clear();
            needed.extend(seen.iter().map(|(face, px_per_area)| {
                (px_per_area * face.wanted_per_px[layer], px_per_area * face.area)
            }));
            let total: f64 = needed.iter().map(|&(_, shown)| shown).sum();
            let picture = 4.0 * sighting.half_size_px.element_product();
            let share = share_of_deep(stride * total / picture, deepest);
            reached(&mut needed, 0.9 * total).unwrap_or(0.0) * share
        });
    (needed_by_layer, deepness)
}

/// Weighted quantile: the least value such that the weights of all values up to it add up to at least `target`; `None`
/// if all weights together are less. Reorders `values`, which are pairs of value and weight.
fn reached(mut values: &mut [(f64, f64)], target: f64) -> Option<f64> {
    const FEW: usize = 32;
    let order = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
    let mut sum = 0.0;
    while values.len() > FEW {
        let middle = values.len() / 2;
        values.select_nth_unstable_by(middle, order);
        let (lower, upper) = values.split_at_mut(middle + 1);
        let weight: f64 = lower.iter().map(|&(_, weight)| weight).sum();
        values = if sum + weight >= target {
            lower
        } else {
            sum += weight;
            upper
        };
    }
    values.sort_unstable_by(order);
    values.iter().find_map(|&(value, weight)| {
        sum += weight;
        (sum >= target).then_some(value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_core::screen_map::PixelLens;
    use impasto_core::{TriangleMesh, hash};

    /// A square floor of this half side at y = 0, as a grid.
    fn floor(half: f32, cells: u32) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for row in 0..=cells {
            for column in 0..=cells {
                let [x, z] = [column, row].map(|number| (number as f32 / cells as f32 * 2.0 - 1.0) * half);
                mesh.positions.push(Vec3::new(x, 0.0, z));
                mesh.normals.push(Vec3::Y);
            }
        }
        for row in 0..cells {
            for column in 0..cells {
                let [a, c] = [0, 1].map(|down| (row + down) * (cells + 1) + column);
                mesh.triangles.extend([[a, c, a + 1], [a + 1, c, c + 1]]);
            }
        }
        mesh
    }

    #[test]
    fn a_floor_of_two_triangles_needs_as_many_as_a_grid() {
        // Someone who stands in the middle of 20 by 20 m and looks along the floor, a little down.
        let eye = DVec3::new(0.0, 1.7, 0.0);
        let view = glam::dcamera::rh::view::look_at_mat4(eye, eye + DVec3::new(0.3, -0.25, -1.0), DVec3::Y);
        let lens = PixelLens::Perspective { focal_px: 1000.0 };
        let map = ScreenMap::new(view, DAffine3::IDENTITY, lens);
        let shape = BodyShape::default();
        let sighting = Sighting { map, half_size_px: DVec2::new(640.0, 360.0), near: 0.1, shape };
        let counted = |cells: u32| {
            let mesh = floor(10.0, cells);
            let surface = Surface::new(&mesh, |_| true);
            find(&surface, std::slice::from_ref(&sighting), deepest(1), |_| None, |_, _, _| [0.001]).needed[0]
        };
        let (rough, fine) = (counted(1), counted(100));
        assert!((rough / fine - 1.0).abs() < 0.2, "{rough} particles, but {fine} on the grid");
    }

    #[test]
    fn a_fine_sheet_needs_as_many_from_either_side() {
        let mesh = floor(1.0, 90);
        let surface = Surface::new(&mesh, |_| true);
        assert!((FACES + 1..=2 * FACES).contains(&surface.faces().count()));
        let counted = |height: f64| {
            let eye = DVec3::new(0.0, height, 0.0);
            let view = glam::dcamera::rh::view::look_at_mat4(eye, DVec3::ZERO, DVec3::NEG_Z);
            let map = ScreenMap::new(view, DAffine3::IDENTITY, PixelLens::Perspective { focal_px: 300.0 });
            let (half_size_px, shape) = (DVec2::new(320.0, 180.0), BodyShape::default());
            let sighting = Sighting { map, half_size_px, near: 0.1, shape };
            find(&surface, &[sighting], deepest(1), |_| None, |_, _, _| [0.01]).needed[0]
        };
        let [above, below] = [4.0, -4.0].map(counted);
        assert!(above > 300.0 && (above / below - 1.0).abs() < 0.05, "{above} from above, {below} below");
    }

    #[test]
    fn what_lies_behind_many_others_gets_no_more_particles() {
        let view =
            glam::dcamera::rh::view::look_at_mat4(DVec3::new(0.0, 4.0, 0.0), DVec3::ZERO, DVec3::NEG_Z);
        let map = ScreenMap::new(view, DAffine3::IDENTITY, PixelLens::Perspective { focal_px: 1000.0 });
        let sighting =
            Sighting { map, half_size_px: DVec2::new(320.0, 180.0), near: 0.1, shape: BodyShape::default() };
        // Floors of the size of the picture, one below the other.
        let counted = |floors: u32| {
            let mut mesh = floor(1.0, 6);
            let (one, corners) = (mesh.clone(), mesh.positions.len() as u32);
            for level in 1..floors {
                let down = Vec3::NEG_Y * (0.01 * level as f32);
                mesh.positions.extend(one.positions.iter().map(|&at| at + down));
                mesh.normals.extend(&one.normals);
                mesh.triangles
                    .extend(one.triangles.iter().map(|of| of.map(|corner| corner + level * corners)));
            }
            let surface = Surface::new(&mesh, |_| true);
            let found =
                find(&surface, std::slice::from_ref(&sighting), deepest(1), |_| None, |_, _, _| [0.001]);
            assert!((found.deepness / f64::from(floors) - 1.0).abs() < 0.3, "{floors}: {}", found.deepness);
            found.needed[0]
        };
        let [one, some, many, more] = [1, 8, 64, 128].map(counted);
        assert!((some / one / 8.0 - 1.0).abs() < 0.1, "8 floors need {some}, one needs {one}");
        assert!(many < 9.0 * one && more < 1.2 * many, "1 floor needs {one}, 64 {many}, 128 {more}");
    }

    #[test]
    fn groups_of_one_mesh_share_the_depth() {
        let object = |mesh: &str, group: Option<&str>| Object {
            group: group.map(str::to_owned),
            ..Object::new("a", mesh)
        };
        let objects = vec![
            object("tree.obj", Some("leaves")),
            object("tree.obj", Some("bark")),
            // Another one of the same tree.
            object("tree.obj", Some("leaves")),
            object("tree.obj", None),
            object("ball.obj", Some("skin")),
        ];
        let scene = Scene { objects, ..impasto_scene::new_scene::empty() };
        assert_eq!(groups_of_meshes(&scene), [2, 2, 2, 1, 1]);
        assert_eq!([1, 2, 3, 100].map(deepest), [DEEPEST, DEEPEST / 2.0, DEEPEST / 3.0, LEAST_DEEP]);
    }

    #[test]
    fn objects_have_a_reserve_and_a_smaller_one_where_there_are_many() {
        assert_eq!([0, 1, MANY, MANY + 1, 2 * MANY + 1].map(least), [64, 64, 64, 32, 16]);
        assert_eq!([20_000, 1 << 20, usize::MAX].map(least), [LEAST_OF_MANY; 3]);
        // All reserves of a layer together stay small.
        for objects in [1000, 5000, 20_000] {
            assert!(objects * least(objects) as usize <= (MANY * LEAST as usize).max(objects * 8));
        }
    }

    #[test]
    fn a_value_is_reached_as_in_a_sorted_list() {
        for count in [0u32, 1, 31, 33, 500] {
            let random = |index: u32, which: u32| f64::from(hash::unit(hash::combine(index, which)));
            let mut values: Vec<(f64, f64)> = (0..count).map(|i| (random(i, 1), random(i, 2))).collect();
            let mut sorted = values.clone();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let total: f64 = sorted.iter().map(|&(_, weight)| weight).sum();
            for share in [0.05, 0.5, 0.9] {
                let mut sum = 0.0;
                let expected = sorted.iter().find_map(|&(value, weight)| {
                    sum += weight;
                    (sum >= share * total).then_some(value)
                });
                assert_eq!(reached(&mut values, share * total), expected, "{count} values, share {share}");
            }
        }
    }
}
