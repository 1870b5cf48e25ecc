//! Finds the sphere that the shadow map covers. It holds all bodies or, if they reach far beyond what is seen, only
//! what is seen.

use std::cmp::Ordering;

use glam::{DAffine3, DMat4, DVec3, Vec3};
use impasto_scene::document::Lens;

use crate::view::PictureView;

/// A camera, and world from model of every object.
pub(crate) type View = (PictureView, Vec<DAffine3>);

/// Least and greatest corner of a body, model space.
pub(crate) type Corners = (Vec3, Vec3);

/// How many places of a picture, across and up, are tested for what they show.
const PLACES: [usize; 2] = [24, 14];

/// At most this many of the views are tested.
const VIEWS: usize = 5;

/// Places lie up to this many half sizes of the picture from its middle: what is just outside casts shadows into it.
const MARGIN: f64 = 1.2;

/// The sphere of what is seen holds this share of the seen places. The rest is mostly the strip below a horizon.
const COVERED: f64 = 0.92;

/// The sphere of what is seen is used where it is smaller than this share of the sphere round all.
const MUCH_SMALLER: f64 = 0.5;

/// A scene that lies farther from the world's origin than this many times its own radius is drawn about an origin in
/// its middle. At that distance the steps of single precision are up to 1/8,000 of the radius.
const FAR: f64 = 1024.0;

/// The origin of the frames' world space: 0, or the middle of a scene that lies far from there.
pub(crate) fn far_origin(all: &[Option<Corners>], views: &[View]) -> DVec3 {
    let (center, radius) = round_all(all, views.iter().map(|(_, poses)| poses.as_slice()));
    if center.length() > FAR * radius { center } else { DVec3::ZERO }
}

/// Centre and radius of the sphere; its centre is counted from `origin_in_world`. `all` are the boxes round the bodies,
/// `lit` those round bodies that are visible and lit.
pub(crate) fn find(
    all: &[Option<Corners>],
    lit: &[Option<Corners>],
    views: &[View],
    origin_in_world: DVec3,
) -> (Vec3, f32) {
    let whole = round_all(all, views.iter().map(|(_, poses)| poses.as_slice()));
    let seen = round_seen(lit, views);
    let (center, radius) = seen.filter(|(_, radius)| *radius < MUCH_SMALLER * whole.1).unwrap_or(whole);
    ((center - origin_in_world).as_vec3(), radius as f32)
}

/// A sphere round all bodies in all of these poses.
fn round_all<'a>(
    boxes: &[Option<(Vec3, Vec3)>],
    poses: impl Iterator<Item = &'a [DAffine3]>,
) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for poses in poses {
        for (bounds, pose) in boxes.iter().zip(poses) {
            let Some((least, greatest)) = bounds else { continue };
            for corner in 0..8 {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { least[axis] } else { greatest[axis] };
                let at = pose.transform_point3(Vec3::new(pick(0), pick(1), pick(2)).as_dvec3());
                low = low.min(at);
                high = high.max(at);
            }
        }
    }
    if low.cmpgt(high).any() {
        return (DVec3::ZERO, 1.0);
    }
    ((low + high) * 0.5, ((high - low).length() * 0.5).max(1e-6))
}

/// A sphere round nearly all that the views see of the boxes; `None` where they see nothing.
fn round_seen(boxes: &[Option<Corners>], views: &[View]) -> Option<(DVec3, f64)> {
    let mut seen: Vec<DVec3> = Vec::new();
    for (view, poses) in views.iter().step_by(views.len().div_ceil(VIEWS).max(1)) {
        let world_from_view = view.pose.view_from_world().inverse();
        let placed: Vec<(DAffine3, Corners)> = boxes
            .iter()
            .zip(poses)
            .filter_map(|(corners, pose)| Some((pose.inverse(), (*corners)?)))
            .filter(|(model_from_world, _)| model_from_world.is_finite())
            .collect();
        let rays = (0..PLACES[0]).flat_map(|column| (0..PLACES[1]).map(move |row| [column, row]));
        for ray in rays.map(|place| Ray::through(view, world_from_view, place)) {
            let hits = placed.iter().filter_map(|(model_from_world, corners)| {
                ray.hits(*model_from_world, *corners).filter(|hit| hit.depth > view.near())
            });
            // Boxes in which the ray begins come last, because only their far side is seen.
            let nearest = hits.min_by(|a, b| {
                (a.is_inside, a.depth).partial_cmp(&(b.is_inside, b.depth)).unwrap_or(Ordering::Equal)
            });
            seen.extend(nearest.map(|hit| ray.at(hit.depth)));
        }
    }
    let center = seen.iter().sum::<DVec3>() / seen.len().max(1) as f64;
    let mut away: Vec<f64> = seen.iter().map(|at| at.distance(center)).collect();
    away.sort_by(f64::total_cmp);
    let last = away.get((COVERED * away.len() as f64) as usize)?;
    Some((center, last.max(1e-6)))
}

/// A ray through a place of the picture, from the eye or, with an orthographic lens, from the eye's plane. Depths on it
/// are measured along the gaze.
struct Ray {
    from: DVec3,
    /// The step along the ray that goes one unit deeper.
    along: DVec3,
}

/// Where a ray meets a box.
struct Hit {
    depth: f64,
    /// Whether the ray begins inside.
    is_inside: bool,
}

impl Ray {
    fn through(view: &PictureView, world_from_view: DMat4, [column, row]: [usize; 2]) -> Self {
        let [width, height] = view.size_px.map(f64::from);
        // −1 to 1 across the picture, times the margin.
        let place = |index: usize, count: usize| ((index as f64 + 0.5) / count as f64 * 2.0 - 1.0) * MARGIN;
        let (x, y) = (place(column, PLACES[0]) * width / height, place(row, PLACES[1]));
        let (x, y) = (x - view.pose.shift.x, y - view.pose.shift.y);
        let (from, along) = match view.pose.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                let half = (0.5 * fov_y_deg.to_radians()).tan();
                (DVec3::ZERO, DVec3::new(x * half, y * half, -1.0))
            }
            Lens::Orthographic { height, .. } => {
                (DVec3::new(0.5 * x * height, 0.5 * y * height, 0.0), DVec3::NEG_Z)
            }
        };
        Self { from: world_from_view.transform_point3(from), along: world_from_view.transform_vector3(along) }
    }

    fn at(&self, depth: f64) -> DVec3 {
        self.from + self.along * depth
    }

    /// Where the ray meets a box, by Kay and Kajiya's slabs (1986); `None` where it misses.
    fn hits(&self, model_from_world: DAffine3, (low, high): Corners) -> Option<Hit> {
        let from = model_from_world.transform_point3(self.from);
        let along = model_from_world.transform_vector3(self.along);
        let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let [low, high] = [low[axis], high[axis]].map(|bound| f64::from(bound) - from[axis]);
            if along[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let [a, b] = [low / along[axis], high / along[axis]];
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
        if enters > leaves || leaves <= 0.0 || !leaves.is_finite() {
            return None;
        }
        let is_inside = enters <= 0.0;
        Some(Hit { depth: if is_inside { leaves } else { enters }, is_inside })
    }
}

#[cfg(test)]
mod tests {
    use impasto_scene::motion::CameraPose;

    use super::*;

    #[test]
    fn a_large_floor_does_not_spread_the_shadows() {
        let pose = CameraPose {
            eye: DVec3::new(0.0, 2.0, 8.0),
            target: DVec3::new(0.0, 0.5, 0.0),
            roll_rad: 0.0,
            shift: glam::DVec2::ZERO,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 5000.0 },
        };
        let views = [(PictureView { pose, size_px: [1280, 720] }, vec![DAffine3::IDENTITY])];
        let sphere = |half: f32| {
            let floor = [Some((Vec3::new(-half, 0.0, -half), Vec3::new(half, 0.0, half)))];
            find(&floor, &floor, &views, DVec3::ZERO)
        };
        // The sphere holds all of a small floor. It holds only a part of a large floor, which contains the origin in
        // front of the camera.
        assert_eq!(sphere(3.0), (Vec3::ZERO, 3.0 * 2f32.sqrt()));
        let (center, radius) = sphere(300.0);
        assert!(radius < 60.0 && center.distance(Vec3::ZERO) < radius, "centre {center}, radius {radius}");
    }
}
