//! A view of a body. Gives upper bounds on how many pixels a unit of the body's surface fills in it.

use glam::{DAffine3, DVec2, DVec3, DVec4};
use impasto_core::ScreenMap;
use impasto_core::sampling::Cell;

use crate::own_depths::OwnDepths;
use crate::particle_count::{Reach, Sighting};
use crate::presence_bound::LEAST_COUNTED_FADE;
use crate::seen_part::SeenPart;
use crate::size_follow::{Following, px_per_unit};

/// A cell counts as uneven (its parts may be seen very differently) while its radius is more than this share of its
/// depth.
const EVEN: f64 = 0.1;

/// A cell counts as uneven while strokes on it may grow more than this many times as much in one place as in another.
const EVEN_GROWTH: f64 = 1.25;

/// A cell that is not wholly inside the view counts as uneven while its radius in pixels is more than this share of
/// half the picture's shorter side.
const LARGE: f64 = 0.25;

/// The planes that bound what a view sees, in model space; each with the length of its normal (its first three
/// numbers).
type Planes = [(DVec4, f64); 5];

/// Whether all of a sphere lies inside all planes, where they are negative.
fn is_inside(planes: &Planes, center: DVec3, radius: f64) -> bool {
    planes.iter().all(|(plane, length)| plane.dot(center.extend(1.0)) < -length * radius)
}

/// Whether all of a sphere lies beyond one of the planes.
fn is_beyond(planes: &Planes, center: DVec3, radius: f64) -> bool {
    planes.iter().any(|(plane, length)| plane.dot(center.extend(1.0)) > length * radius)
}

/// A sphere that holds the middles of all strokes of a cell, and how far these may lie from the sphere's centre along
/// the cell's normal or against it, model units.
struct Lifted {
    center: DVec3,
    radius: f64,
    thickness: f64,
}

/// A view of a body, ready to tell how many pixels a unit of a cell's surface fills in it.
pub(crate) struct Eye {
    map: ScreenMap,
    /// Nothing is seen where any of these is positive.
    planes: Planes,
    /// For strokes whose size follows that of the surface: how it does, and how far strokes of the stated size reach,
    /// pixels.
    following: Option<(Following, f64)>,
    /// Half the picture with the margin round it, pixels.
    half_margin_px: DVec2,
    /// The planes round the picture alone, without a margin.
    picture: Planes,
    half_px: DVec2,
    near: f64,
    row_w_length: f64,
    /// Takes a point to a vector from it towards the eye. The vector's length is w³ times the pixels that a unit of
    /// surface at the point fills if it faces the eye; w is the dot product of `map.row_w` and the point.
    w3_to_eye: DAffine3,
    /// How much `w3_to_eye` changes at most for each unit that the point moves.
    w3_to_eye_change: f64,
    /// How far strokes are lifted along the normal: halfway between the least and the most, half of the difference, and
    /// the greatest distance from the surface.
    mid_offset: f64,
    half_offsets: f64,
    most_offset: f64,
    /// The body's own depths, which tell what it hides of itself; `None` unless it is a heap of faces that hide each
    /// other.
    pub(crate) own: Option<OwnDepths>,
}

impl Eye {
    /// The eye of a view. `Reach` says how far round the picture there are particles, and how far from them there may
    /// be paint.
    pub(crate) fn new(sighting: &Sighting, reach: Reach) -> Self {
        let Reach { margin, reach_px, following, offsets: [least_offset, most_offset] } = reach;
        let map = &sighting.map;
        let half_margin_px = sighting.half_size_px * margin;
        let w3_to_eye = w3_to_eye(map);
        Self {
            w3_to_eye_change: w3_to_eye
                .matrix3
                .to_cols_array()
                .iter()
                .map(|entry| entry * entry)
                .sum::<f64>()
                .sqrt(),
            w3_to_eye,
            planes: planes(map, sighting.near, half_margin_px + 2.0 * reach_px),
            following: following.map(|following| (following, reach_px)),
            half_margin_px,
            picture: planes(map, sighting.near, sighting.half_size_px),
            half_px: sighting.half_size_px,
            near: sighting.near,
            row_w_length: map.row_w.truncate().length(),
            map: *map,
            mid_offset: 0.5 * (least_offset + most_offset),
            half_offsets: 0.5 * (most_offset - least_offset),
            most_offset: reach.most_offset(),
            own: None,
        }
    }

    /// Whether a cell may be in the picture.
    pub(crate) fn has_in_picture(&self, cell: &Cell) -> bool {
        let Lifted { center, radius, .. } = self.lifted(cell);
        !is_beyond(&self.picture, center, radius)
    }

    /// Where the strokes of a cell may lie: the smaller of two spheres. One is the cell's sphere, moved along the
    /// cell's normal, and enlarged because offsets differ, and because normals differ from the cell's by up to its
    /// `spread`. The other is the cell's sphere where it is, enlarged by the greatest distance of a stroke from the
    /// surface.
    fn lifted(&self, cell: &Cell) -> Lifted {
        let apart = self.half_offsets + self.most_offset * cell.spread;
        let (moved, apart) = if apart < self.most_offset {
            (cell.normal * self.mid_offset, apart)
        } else {
            (DVec3::ZERO, self.most_offset)
        };
        Lifted { center: cell.center + moved, radius: cell.radius + apart, thickness: cell.thickness + apart }
    }

    /// The least and the greatest factor by which strokes in a sphere may grow; `w` is that of its centre.
    fn growth(&self, center: DVec3, radius: f64, w: f64) -> [f64; 2] {
        let Some((following, _)) = &self.following else { return [1.0; 2] };
        let apart = self.row_w_length * radius;
        // With perspective, w is the depth.
        let near = if self.row_w_length > 0.0 { self.near } else { f64::MIN_POSITIVE };
        let now = [w + apart, w - apart].map(|w| px_per_unit(&self.map, w, near));
        following.growth_in(center, radius, now)
    }

    /// The part of a triangle on which the view may have particles.
    pub(crate) fn seen_part(&self, corners: [DVec3; 3]) -> SeenPart {
        let mut seen = SeenPart::of_triangle(corners);
        for (plane, length) in &self.planes {
            seen.cut(|corner| plane.dot(corner.extend(1.0)) - length * self.most_offset);
        }
        seen
    }

    /// An upper bound on the pixels that a unit of surface at rest fills anywhere on this part, divided by the fade of
    /// strokes near an outline; 0 if the part faces away. The part's corners must be finite. Anywhere on the part, the
    /// normal times the factor by which the area has grown since rest must be a weighted mean of `area_normals`.
    pub(crate) fn most_on(&self, seen: &SeenPart, area_normals: impl Iterator<Item = DVec3>) -> f64 {
        let (towards_eye, lifted) = self.towards_eye(seen);
        let mut facing = f64::NEG_INFINITY;
        let mut whole = 0.0f64;
        for normal in area_normals {
            let length = normal.length();
            if !length.is_finite() {
                return f64::INFINITY;
            }
            // The dot product below is linear along the surface, and in the normal. So it is greatest at a corner, with
            // one of the normals.
            for towards in towards_eye.corners() {
                facing = facing.max(normal.dot(*towards) + length * lifted);
                whole = whole.max(length * (towards.length() + lifted));
            }
        }
        if facing <= 0.0 {
            return 0.0;
        }
        self.most_of(seen, facing / whole, whole)
    }

    /// As [`Eye::most_on`], where normals may point anywhere, and the area has grown at most `growth` times since rest.
    pub(crate) fn most_facing(&self, seen: &SeenPart, growth: f64) -> f64 {
        let (towards_eye, lifted) = self.towards_eye(seen);
        let longest = towards_eye.corners().iter().map(|towards| towards.length()).fold(0.0, f64::max);
        self.most_of(seen, 1.0, growth * (longest + lifted))
    }

    /// The vector of `w3_to_eye` at each corner; and how much it may differ at a stroke that is lifted off the surface.
    fn towards_eye(&self, seen: &SeenPart) -> (SeenPart, f64) {
        let towards_eye = seen.moved(|corner| self.w3_to_eye.transform_point3(corner));
        (towards_eye, self.w3_to_eye_change * self.most_offset)
    }

    /// The bound of [`Eye::most_on`]. `facing` is the greatest cosine between a normal and the direction to the eye,
    /// `w3_px` the greatest length of a vector of `w3_to_eye`, times the growth of the area.
    fn most_of(&self, seen: &SeenPart, facing: f64, w3_px: f64) -> f64 {
        let w_of = |corner: &DVec3| self.map.row_w.dot(corner.extend(1.0));
        let mut least_w = seen.corners().iter().map(w_of).fold(f64::MAX, f64::min);
        if self.row_w_length > 0.0 {
            least_w = (least_w - self.row_w_length * self.most_offset).max(self.near);
        }
        self.most_at(least_w, facing, w3_px)
    }

    /// As [`Eye::most_of`], from the least w.
    fn most_at(&self, least_w: f64, facing: f64, w3_px: f64) -> f64 {
        let most = most_over_fade(facing, self.map.uneven.is_some()) * w3_px / least_w.powi(3);
        if most.is_nan() { f64::INFINITY } else { most }
    }

    /// First, an upper bound on the pixels that a unit of a cell's surface fills in this view, divided by the fade of
    /// strokes near an outline and by the square of their growth; 0 where the view does not see the cell. Second,
    /// whether the cell's parts may differ much: it is large beside its depth, strokes on it grow unevenly, or it is a
    /// large part of the picture and not all inside.
    pub(crate) fn most_per_area(&self, cell: &Cell) -> (f64, bool) {
        let Lifted { center, radius, thickness } = self.lifted(cell);
        let w = self.map.row_w.dot(center.extend(1.0));
        let [least_growth, most_growth] = self.growth(center, radius, w);
        let grown;
        let planes = match self.following {
            Some((_, reach_px)) if most_growth > 1.0 => {
                let half_px = self.half_margin_px + 2.0 * reach_px * most_growth;
                grown = planes(&self.map, self.near, half_px);
                &grown
            }
            _ => &self.planes,
        };
        if is_beyond(planes, center, radius) {
            return (0.0, false);
        }
        // The larger the strokes are, the fewer are needed.
        let fewer = least_growth.powi(-2);
        if self.row_w_length > 0.0 && w - self.row_w_length * radius <= self.near {
            // Nothing nearer than the near plane is seen.
            let towards_eye = self.w3_to_eye.transform_point3(center).length();
            let w3_px = towards_eye + self.w3_to_eye_change * radius;
            return (fewer * self.most_at(self.near, 1.0, w3_px), true);
        }
        let [along_x, along_y] = self.map.jacobian(center);
        let to_eye = along_x.cross(along_y);
        // The pixels that a unit of surface fills at the centre if it faces the eye.
        let px_per_area = to_eye.length();
        let radius_per_depth = self.row_w_length * radius / w;
        // A unit of surface that is nearer than the centre, and seen in another direction, may fill up to this many
        // times as many pixels.
        let nearer = (1.0 + radius_per_depth) / (1.0 - radius_per_depth).powi(3);
        let thickness = thickness / radius * radius_per_depth;
        // An upper bound on the cosine between the normal and the direction to the eye: the eye's height over the
        // cell's lowest point, along the cell's normal, divided by the eye's least distance from the cell or, if the
        // height is negative, by its greatest.
        let above = cell.normal.dot(to_eye) / px_per_area + thickness;
        let facing =
            above / if above > 0.0 { 1.0 - radius_per_depth } else { 1.0 + radius_per_depth } + cell.spread;
        if facing <= 0.0 {
            return (0.0, false);
        }
        let most = fewer * px_per_area * nearer * most_over_fade(facing.min(1.0), self.map.uneven.is_some());
        // A bound that is not a number becomes infinite below, which is the safe side.
        let is_large = radius * px_per_area.sqrt() > LARGE * self.half_px.min_element();
        let is_uneven = radius_per_depth > EVEN
            || most_growth > EVEN_GROWTH * least_growth
            || is_large && !is_inside(planes, center, radius);
        (if most.is_nan() { f64::INFINITY } else { most }, is_uneven)
    }
}

/// The planes that bound a picture of this half size, pixels.
fn planes(map: &ScreenMap, near: f64, half_px: DVec2) -> Planes {
    let side = |row: DVec4, half_px: f64| row - map.row_w * half_px;
    let sides = [
        side(map.row_x, half_px.x),
        side(-map.row_x, half_px.x),
        side(map.row_y, half_px.y),
        side(-map.row_y, half_px.y),
        DVec4::W * near - map.row_depth,
    ];
    sides.map(|plane| (plane, plane.truncate().length()))
}

/// w³ times the cross product of the rows of the Jacobian, which is linear in the point: with x, y and w the products
/// of the point and the map's rows X, Y and W, it is w X × Y − y X × W − x W × Y.
fn w3_to_eye(map: &ScreenMap) -> DAffine3 {
    let [x, y, w] = [map.row_x, map.row_y, map.row_w];
    let cross = |a: DVec4, b: DVec4| a.truncate().cross(b.truncate());
    let (of_w, of_y, of_x) = (cross(x, y), cross(x, w), cross(w, y));
    let column = |w: f64, y: f64, x: f64| of_w * w - of_y * y - of_x * x;
    DAffine3::from_cols(
        column(w.x, y.x, x.x),
        column(w.y, y.y, x.y),
        column(w.z, y.z, x.z),
        column(w.w, y.w, x.w),
    )
}

/// The greatest `f / fade(f)` for `f` up to this facing. Where strokes face the eye less, there are more of them, to
/// make up for those that fade.
fn most_over_fade(facing: f64, uneven: bool) -> f64 {
    let least = f64::from(LEAST_COUNTED_FADE);
    // The pose scales some directions more than others. The fade follows the facing in world space, and this one is in
    // model space.
    if uneven {
        return facing / least;
    }
    // The ratio grows until the fade exceeds the least that counts, then falls. From a facing of 0.2 on, the fade is 1,
    // and the ratio is the facing.
    facing.max((facing / least).min(MOST_GRAZING))
}

/// The greatest `f / fade(f)` for `f` below 0.2.
const MOST_GRAZING: f64 = 0.243;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use impasto_core::sampling::{self, Cells, Surface};
    use impasto_core::screen_map::{PixelLens, area_px};
    use impasto_core::{TriangleMesh, presence};

    use crate::body_shape::BodyShape;
    use crate::size_follow::growth;

    #[test]
    fn grazing_strokes_need_no_more_than_is_kept_for_them() {
        for step in 1..=1000 {
            let facing = f64::from(step) / 1000.0;
            let fade = f64::from(presence::of_facing(facing as f32).max(LEAST_COUNTED_FADE));
            assert!(facing / fade <= most_over_fade(facing, false) * 1.000_001, "at {facing}");
            assert!(most_over_fade(facing, false) <= most_over_fade(facing, true));
        }
    }

    /// A bumpy surface, seen from near and from afar, from above and along it, through either lens, with strokes on it,
    /// strokes lifted off it, and strokes that follow its size and reach into the picture.
    #[test]
    fn no_place_needs_more_than_its_cell() {
        let mut mesh = TriangleMesh::default();
        for index in 0..60u32 * 60 {
            let [x, z] = [index % 60, index / 60].map(|number| number as f32 * 0.2 - 6.0);
            let height = |x: f32, z: f32| (1.3 * x).sin() * (1.1 * z + 0.4).cos();
            let slope =
                [height(x + 0.01, z) - height(x - 0.01, z), height(x, z + 0.01) - height(x, z - 0.01)];
            mesh.positions.push(Vec3::new(x, height(x, z), z));
            mesh.normals.push(Vec3::new(-slope[0], 0.02, -slope[1]).normalize());
        }
        for cell in 0..59u32 * 59 {
            let a = cell / 59 * 60 + cell % 59;
            mesh.triangles.extend([[a, a + 60, a + 1], [a + 1, a + 60, a + 61]]);
        }
        let surface = Surface::new(&mesh, |_| true);
        let cells: Vec<Cell> = Cells::new(&surface).into_iter().collect();
        let particles = sampling::scattered(&surface, 20_000, 4);
        let of_triangle: Vec<Vec<usize>> = {
            let mut of_triangle = vec![Vec::new(); mesh.triangles.len()];
            for (index, cell) in cells.iter().enumerate() {
                cell.triangles(&surface).for_each(|triangle| of_triangle[triangle].push(index));
            }
            of_triangle
        };
        let (mut seen, mut near, mut grown, mut shrunk) = (0, 0, 0, 0);
        for (eye, target, lens) in [
            ([0.0, 2.0, 9.0], [0.0, 0.0, 0.0], PixelLens::Perspective { focal_px: 500.0 }),
            ([0.3, 1.1, 0.2], [3.0, 1.0, -2.0], PixelLens::Perspective { focal_px: 300.0 }),
            ([1.0, -4.0, 2.0], [0.0, 0.0, 0.0], PixelLens::Perspective { focal_px: 400.0 }),
            ([4.0, 3.0, 4.0], [0.0, 0.0, 0.0], PixelLens::Orthographic { px_per_unit: 50.0 }),
            // The eye is between the bumps.
            ([0.3, 0.55, 0.2], [3.0, 0.5, -2.0], PixelLens::Perspective { focal_px: 300.0 }),
            ([2.1, -0.4, 1.4], [-3.0, 0.2, 2.0], PixelLens::Perspective { focal_px: 300.0 }),
        ] {
            let view = glam::dcamera::rh::view::look_at_mat4(eye.into(), target.into(), DVec3::Y);
            for pose in [DAffine3::IDENTITY, DAffine3::from_scale(DVec3::new(1.5, 0.7, 1.0))] {
                let map = ScreenMap::new(view, pose, lens);
                let reference = {
                    let view = glam::dcamera::rh::view::look_at_mat4(
                        DVec3::new(2.0, 1.5, 3.0),
                        DVec3::ZERO,
                        DVec3::Y,
                    );
                    ScreenMap::new(view, pose, PixelLens::Perspective { focal_px: 400.0 })
                };
                let sighting = Sighting {
                    map,
                    half_size_px: DVec2::new(320.0, 180.0),
                    near: 0.05,
                    shape: BodyShape::default(),
                };
                for (offsets, follow) in
                    [([0.0; 2], 0.0), ([0.4; 2], 0.0), ([-0.3, 0.1], 0.7), ([0.0; 2], 1.0)]
                {
                    let following = (follow > 0.0).then(|| Following::new(reference, 0.05, [0.0, follow]));
                    let of_sighting =
                        Eye::new(&sighting, Reach { margin: 1.0, reach_px: 60.0, following, offsets });
                    for (index, particle) in particles.iter().enumerate() {
                        let normal = particle.normal.as_dvec3();
                        let at = particle.position.as_dvec3() + normal * offsets[index % 2];
                        let px = map.project(at).abs();
                        let jacobian = map.jacobian(at);
                        let facing = map.facing(jacobian, normal) as f32;
                        // Some strokes follow, and some do not.
                        let w = |map: &ScreenMap| map.row_w.dot(at.extend(1.0));
                        let m =
                            px_per_unit(&map, w(&map), 0.0) / px_per_unit(&reference, w(&reference), 0.05);
                        let growth = if index % 3 == 0 { 1.0 } else { growth(m, follow) };
                        let half_px = sighting.half_size_px + 60.0 * growth;
                        if map.depth(at) <= 0.05 || !px.cmplt(half_px).all() || facing <= 0.0 {
                            continue;
                        }
                        grown += u32::from(growth > 2.0);
                        shrunk += u32::from(growth < 0.5);
                        seen += 1;
                        near += u32::from(map.depth(at) < 0.15);
                        let fade = f64::from(presence::of_facing(facing).max(LEAST_COUNTED_FADE));
                        let needed = area_px(jacobian, normal) / fade / growth.powi(2);
                        let most = of_triangle[particle.triangle as usize]
                            .iter()
                            .map(|&cell| of_sighting.most_per_area(&cells[cell]).0)
                            .fold(0.0, f64::max);
                        assert!(
                            needed <= most * 1.000_1,
                            "{needed} of {most}, {lens:?}, {pose:?}, {offsets:?}, {follow}"
                        );
                    }
                }
            }
        }
        assert!(seen > 10_000 && near > 20, "{seen}, {near} of them near the eye");
        assert!(grown > 300 && shrunk > 1000, "{grown} strokes grow, {shrunk} shrink");
    }

    /// A square far from the view's middle: strokes that are lifted sideways by three units stand before the eye, and
    /// those on the square do not. Seen from behind, neither shows.
    #[test]
    fn strokes_lifted_far_off_a_flat_cell_are_looked_for_where_they_are() {
        let mut mesh = TriangleMesh::default();
        mesh.positions
            .extend([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]].map(|[x, y]| Vec3::new(x, y, 0.0)));
        mesh.normals.extend([Vec3::Z; 4]);
        mesh.triangles.extend([[0, 1, 2], [0, 2, 3]]);
        let surface = Surface::new(&mesh, |_| true);
        let cells = Cells::new(&surface);
        let lens = PixelLens::Perspective { focal_px: 500.0 };
        let most = |eye: [f64; 3], target: [f64; 3], offset: f64| {
            let view = glam::dcamera::rh::view::look_at_mat4(eye.into(), target.into(), DVec3::Y);
            let map = ScreenMap::new(view, DAffine3::IDENTITY, lens);
            let half_size_px = DVec2::new(100.0, 60.0);
            let sighting = Sighting { map, half_size_px, near: 0.05, shape: BodyShape::default() };
            let eye = Eye::new(
                &sighting,
                Reach { margin: 1.0, reach_px: 0.0, following: None, offsets: [offset; 2] },
            );
            let front = cells.all().iter().filter(|cell| cell.normal.z > 0.99);
            front.map(|cell| eye.most_per_area(cell).0).reduce(f64::max).expect("cells of the front")
        };
        let slanted = [[6.0, 0.0, 8.0], [0.0, 0.0, 3.0]];
        assert!(most(slanted[0], slanted[1], 3.0) > 0.0);
        assert_eq!(most(slanted[0], slanted[1], 0.0), 0.0);
        assert_eq!(most([0.0, 0.0, -8.0], [0.0, 0.0, 3.0], 3.0), 0.0);
        assert_eq!(most([0.0, 0.0, 2.0], [0.0, 0.0, 0.0], 3.0), 0.0);
    }

    /// A small ball is one cell, and the eye is in its middle: the nearest places are as far away as the near plane.
    #[test]
    fn a_cell_round_the_eye_needs_what_the_near_plane_shows() {
        let (radius, near) = (0.08, 0.05);
        let mut mesh = TriangleMesh::default();
        // An octahedron, then a triangle far behind that has nearly all of the area.
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        mesh.positions.extend(axes.map(|axis| axis * radius));
        mesh.normals.extend(axes);
        for [x, y, z] in
            [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
        {
            mesh.triangles.push([x, y, z]);
        }
        mesh.positions.extend([
            Vec3::new(-20.0, -20.0, 9.0),
            Vec3::new(20.0, -20.0, 9.0),
            Vec3::new(0.0, 20.0, 9.0),
        ]);
        mesh.normals.extend([Vec3::Z; 3]);
        mesh.triangles.push([6, 7, 8]);
        let surface = Surface::new(&mesh, |_| true);
        let cells = Cells::new(&surface);
        let focal_px = 300.0;
        let view = glam::dcamera::rh::view::look_at_mat4(DVec3::ZERO, -DVec3::Z, DVec3::Y);
        let map = ScreenMap::new(view, DAffine3::IDENTITY, PixelLens::Perspective { focal_px });
        let half_size_px = DVec2::new(320.0, 180.0);
        let sighting = Sighting { map, half_size_px, near, shape: BodyShape::default() };
        let eye =
            Eye::new(&sighting, Reach { margin: 1.0, reach_px: 0.0, following: None, offsets: [0.0; 2] });
        let of_ball = cells.all().iter().find(|cell| cell.triangles(&surface).count() > 1).expect("a cell");
        let (most, is_uneven) = eye.most_per_area(of_ball);
        // The pixels that a unit of surface fills if it faces the eye: as far away as a corner of the ball, and at the
        // near plane.
        let at_least = (focal_px / f64::from(radius)).powi(2);
        let at_near = (focal_px / near).powi(2);
        assert!(is_uneven && most > at_least && most < 5.0 * at_near, "{most}, {at_least}, {at_near}");
    }
}
