//! The references (poses and views in which directions are stated): how they see a point of a body, and the lift of a
//! particle that follows from that.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::bending::CarriedPlace;
use impasto_core::lift::{Lift, turntable_axes};
use impasto_core::parts::Part;
use impasto_core::presence::smoothstep;
use impasto_core::sampling::PackedParticle;
use impasto_scene::document::{Reference, Scene};
use impasto_scene::motion;

use crate::bent::Bent;
use crate::body_shape::BodyShape;
use crate::kept::KeyHasher;
use crate::view::PictureView;

/// Cosines of the angle between the normal and the direction to the eye. A reference states nothing about surfaces
/// below `NONE`, states directions wholly from `WHOLE` on, and in part between them.
const NONE: f64 = 0.2;
const WHOLE: f64 = 0.5;

/// A reference: a camera, and the pose of every object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ReferencePose {
    pub(crate) view: PictureView,
    pub(crate) poses: Vec<DAffine3>,
    /// The frame that gives the poses and the shapes of the bodies.
    pub(crate) frame: f64,
}

/// All references of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SceneReferences {
    /// The scene's own, its `further_references`, then those that only regions state.
    pub(crate) poses: Vec<ReferencePose>,
    /// How many of them are `further_references`.
    pub(crate) further: usize,
    /// For each rule, the index of the reference that its directions refer to.
    pub(crate) of_rule: Vec<u16>,
}

impl SceneReferences {
    pub(crate) fn of(scene: &Scene) -> Self {
        let pose = |reference: &Reference| {
            let (camera, frame) = motion::referred_to(scene, reference);
            let size_px = [scene.size.0, scene.size.1];
            ReferencePose {
                view: PictureView { pose: camera, size_px },
                poses: motion::poses_at(scene, frame),
                frame,
            }
        };
        let own = std::iter::once(&scene.reference);
        let mut poses: Vec<ReferencePose> = own.chain(&scene.further_references).map(pose).collect();
        let mut of_rule = Vec::with_capacity(scene.regions.len() + 1);
        for region in &scene.regions {
            of_rule.push(match &region.reference {
                Some(reference) => {
                    let stated = pose(reference);
                    let known = poses.iter().position(|known| *known == stated);
                    known.unwrap_or_else(|| {
                        poses.push(stated);
                        poses.len() - 1
                    }) as u16
                }
                None => 0,
            });
        }
        of_rule.push(0);
        Self { poses, further: scene.further_references.len(), of_rule }
    }

    /// The scene's own reference.
    pub(crate) fn own(&self) -> &ReferencePose {
        &self.poses[0]
    }

    /// The references as one body sees them; `stands` has, for each reference, the body at the reference's frame.
    pub(crate) fn of_body(&self, object: usize, stands: Vec<Standing>) -> BodyReferences {
        let of_pose = |(reference, stands): (&ReferencePose, Standing)| {
            let pose = reference.poses[object];
            BodyReference {
                map: reference.view.screen_map(pose),
                near: reference.view.near(),
                roll_sin_cos: reference.view.pose.roll_rad.sin_cos().into(),
                up_in_model: pose.matrix3.transpose() * DVec3::Y,
                size_px: reference.view.size_px,
                stands,
            }
        };
        BodyReferences {
            all: self.poses.iter().zip(stands).map(of_pose).collect(),
            further: self.further,
            of_rule: self.of_rule.clone(),
        }
    }
}

/// A body as it is bent at the frame of a reference.
#[derive(Clone, Debug, Default)]
pub(crate) struct Standing {
    pub(crate) shape: BodyShape,
    /// `None` at rest.
    pub(crate) bent: Option<Arc<Bent>>,
    /// Where the middles of its parts are, model space; empty at rest.
    pub(crate) centers: Vec<DVec3>,
}

/// Only shapes are compared: all else follows from the shape.
impl PartialEq for Standing {
    fn eq(&self, other: &Self) -> bool {
        self.shape == other.shape
    }
}

impl Standing {
    /// Hashes where its vertices and its parts are.
    pub(crate) fn feed_key(&self, key: &mut KeyHasher) {
        // The shape is left out: it only says where the vertices are, and these are hashed.
        let Self { shape: _, bent, centers } = self;
        key.numbers(&[u8::from(bent.is_some())]);
        if let Some(bent) = bent {
            key.numbers(&bent.vertices.positions);
            key.numbers(&bent.vertices.normals);
        }
        key.numbers(centers);
    }
}

/// A reference as one body sees it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyReference {
    pub(crate) map: ScreenMap,
    pub(crate) near: f64,
    /// Sine and cosine of the angle by which its camera is rolled.
    roll_sin_cos: [f64; 2],
    /// The world's up in model space, at the reference pose.
    pub(crate) up_in_model: DVec3,
    /// Width and height of the scene's picture.
    pub(crate) size_px: [u32; 2],
    pub(crate) stands: Standing,
}

/// All references as one body sees them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyReferences {
    all: Vec<BodyReference>,
    further: usize,
    of_rule: Vec<u16>,
}

/// A point of a body's surface at rest, with its rule and its part.
#[derive(Clone, Copy)]
pub(crate) struct SurfacePoint {
    /// The triangle, and where on it.
    pub(crate) place: PackedParticle,
    /// Model space.
    pub(crate) position: DVec3,
    /// How far it lies off the surface, model units.
    pub(crate) height: f64,
    /// Unit, model space.
    pub(crate) normal: DVec3,
    pub(crate) rule: usize,
    pub(crate) part: usize,
}

impl SurfacePoint {
    /// The point without its rule and its part.
    pub(crate) fn raised(&self) -> RaisedPlace {
        let &Self { place, position, normal, height, .. } = self;
        RaisedPlace { place, position, normal, height }
    }
}

/// A place over a surface at rest.
#[derive(Clone, Copy)]
pub(crate) struct RaisedPlace {
    /// The triangle, and where on it.
    pub(crate) place: PackedParticle,
    /// Model space, off the surface.
    pub(crate) position: DVec3,
    /// Unit, model space.
    pub(crate) normal: DVec3,
    /// How far it lies off the surface, model units.
    pub(crate) height: f64,
}

/// A [`RaisedPlace`] at the frame of a reference, as far off the surface as at rest.
pub(crate) struct PlaceThen {
    /// Model space.
    pub(crate) position: DVec3,
    /// Unit, model space.
    pub(crate) normal: DVec3,
    /// How the surface under it is carried there; `None` at rest.
    carried: Option<CarriedPlace>,
}

impl PlaceThen {
    /// A Jacobian there, pulled back to the surface at rest.
    pub(crate) fn pulled_back(&self, jacobian: [DVec3; 2]) -> [DVec3; 2] {
        self.carried.map_or(jacobian, |carried| carried.pulled_back(jacobian))
    }
}

/// How the references see one point of a surface.
pub(crate) struct Views {
    /// First, the reference of the point's rule; `None` if it does not face the point. Second, the further reference
    /// that faces the point best; `None` if none does, or if the first states the direction wholly.
    pub(crate) facing: [Option<FacingReference>; 2],
    pub(crate) normal: DVec3,
    /// Axes of the tangent plane, right and up as on a turntable.
    pub(crate) axes: [DVec3; 2],
    /// These axes, turned by the roll of the reference's camera.
    pub(crate) rolled_axes: [DVec3; 2],
    px_per_unit: f64,
    /// The Jacobian in the reference of the point's rule, even where that reference does not face the point.
    pub(crate) jacobian: [DVec3; 2],
}

/// A reference that faces a point.
#[derive(Clone, Copy)]
pub(crate) struct FacingReference {
    lift: Lift,
    /// How far it states the direction, 0..=1; 1 where it faces the point well.
    pub(crate) share: f64,
    /// The Jacobian in this reference, pulled back to the surface at rest.
    pub(crate) jacobian: [DVec3; 2],
}

/// How a reference sees a point, even one that it does not face.
struct Seen {
    /// Where the point is at the reference's frame, model space.
    position: DVec3,
    /// The Jacobian, pulled back to the surface at rest: pixels per step on that surface.
    jacobian: [DVec3; 2],
    /// Cosine between the normal and the direction to the eye.
    facing: f64,
}

impl BodyReferences {
    /// The scene's own reference.
    pub(crate) fn own(&self) -> &BodyReference {
        &self.all[0]
    }

    pub(crate) fn feed_key(&self, key: &mut KeyHasher) {
        let Self { all, further, of_rule } = self;
        for BodyReference { map, near, roll_sin_cos, up_in_model, size_px, stands } in all {
            key.value(&(map, near, roll_sin_cos, up_in_model, size_px));
            stands.feed_key(key);
        }
        key.numbers(&[*further as u64]);
        key.numbers(of_rule);
    }

    /// The reference that a rule's directions refer to.
    pub(crate) fn of_rule(&self, rule: usize) -> &BodyReference {
        &self.all[usize::from(self.of_rule[rule])]
    }

    /// How the references see a point. `horn` may replace the lift of the tangent plane in the reference of the point's
    /// rule: by another (`Some(Some(lift))`), or by none (`Some(None)`), as if the reference did not face the point.
    /// `None` leaves the lift as it is.
    pub(crate) fn views(
        &self,
        point: SurfacePoint,
        horn: impl FnOnce(&BodyReference) -> Option<Option<Lift>>,
    ) -> Views {
        let SurfacePoint { normal, rule, .. } = point;
        let own = self.of_rule(rule);
        let seen = own.seen(point);
        let jacobian = seen.jacobian;
        let px_per_unit = jacobian[0].cross(jacobian[1]).length().sqrt();
        let axes = turntable_axes(normal, own.up_in_model);
        let [sin, cos] = own.roll_sin_cos;
        let mut facing = [own.facing_with(&seen, normal), None];
        if let Some(first) = &mut facing[0]
            && let Some(lift) = horn(own)
        {
            match lift {
                Some(lift) => first.lift = lift,
                None => facing[0] = None,
            }
        }
        if facing[0].is_none_or(|first| first.share < 1.0) {
            let others = self.all[1..=self.further].iter().filter(|other| !std::ptr::eq(*other, own));
            facing[1] = others
                .filter_map(|other| other.facing_with(&other.seen(point), normal))
                .max_by(|a, b| a.share.total_cmp(&b.share));
        }
        Views {
            facing,
            normal,
            axes,
            rolled_axes: [axes[0] * cos + axes[1] * sin, axes[1] * cos - axes[0] * sin],
            px_per_unit: if px_per_unit.is_finite() && px_per_unit > 0.0 { px_per_unit } else { 1.0 },
            jacobian,
        }
    }
}

impl BodyReference {
    /// Where a place of the surface is at the reference's frame, model space, and the deformation gradient there.
    /// `None` at rest.
    pub(crate) fn carried(&self, place: PackedParticle) -> Option<CarriedPlace> {
        self.stands.bent.as_ref().map(|bent| bent.place(place))
    }

    /// Where the middle of a part is at the reference's frame, model space.
    pub(crate) fn center(&self, index: usize, part: &Part) -> DVec3 {
        self.stands.centers.get(index).copied().unwrap_or(part.center)
    }

    /// Where a place is at the reference's frame.
    pub(crate) fn then(&self, place: RaisedPlace) -> PlaceThen {
        let RaisedPlace { position, normal, height, .. } = place;
        let Some(carried) = self.carried(place.place) else {
            return PlaceThen { position, normal, carried: None };
        };
        let normal = carried.normal(normal);
        PlaceThen { position: carried.position + normal * height, normal, carried: Some(carried) }
    }

    fn seen(&self, point: SurfacePoint) -> Seen {
        let then = self.then(point.raised());
        let jacobian = self.map.jacobian(then.position);
        let facing = self.map.facing(jacobian, then.normal);
        Seen { position: then.position, jacobian: then.pulled_back(jacobian), facing }
    }

    fn facing_with(&self, seen: &Seen, normal: DVec3) -> Option<FacingReference> {
        let &Seen { position, jacobian, facing } = seen;
        let share = f64::from(smoothstep(((facing - NONE) / (WHOLE - NONE)) as f32));
        if self.map.depth(position) <= self.near || share.is_nan() || share <= 0.0 {
            return None;
        }
        Lift::tangent(jacobian, normal).map(|lift| FacingReference { lift, share, jacobian })
    }
}

impl Views {
    /// How far the references together state the direction here, 0..=1.
    pub(crate) fn share(&self) -> f64 {
        1.0 - self.facing.iter().flatten().map(|reference| 1.0 - reference.share).product::<f64>()
    }

    /// The unit tangent for which the lift of [`Self::flat`] shows at this angle in the view with this Jacobian.
    pub(crate) fn tangent_at(&self, angle_rad: f64, jacobian: [DVec3; 2]) -> DVec3 {
        let turned = angle_rad - self.flat(self.axes[0]).map(jacobian).angle_rad();
        let (sin, cos) = turned.sin_cos();
        self.axes[0] * cos + self.axes[1] * sin
    }

    /// The lift of a camera that looks straight at the surface, for strokes along `tangent`.
    fn flat(&self, tangent: DVec3) -> Lift {
        let along = tangent / self.px_per_unit;
        Lift { along, across: self.normal.cross(along) }
    }

    /// N' for strokes along `tangent` (unit). Begins with the lift of a camera that looks straight at the surface. Over
    /// it, blends the lift of each reference that faces the point, turned so that in that reference's picture strokes
    /// show at the same angle as with the first lift.
    pub(crate) fn lift(&self, tangent: DVec3) -> Lift {
        let flat = self.flat(tangent);
        let mut lift = flat;
        for FacingReference { lift: own, share, jacobian } in self.facing.iter().rev().flatten() {
            let here = own.turned(flat.map(*jacobian).angle_rad());
            lift = if *share < 1.0 { here.blended(lift, 1.0 - share, *jacobian) } else { here };
        }
        lift
    }

    /// The lift that κ is measured with. It is made for strokes along the reference's right, but any tangent gives the
    /// same κ.
    pub(crate) fn bare_lift(&self) -> Lift {
        self.lift(self.rolled_axes[0])
    }

    /// The angle at which strokes along `tangent` show in the reference of the rule, radians.
    pub(crate) fn angle_in_reference(&self, tangent: DVec3) -> f64 {
        self.flat(tangent).map(self.jacobian).angle_rad()
    }
}

/// The angle at which a direction in space shows, radians.
pub(crate) fn shown_rad(direction: DVec3, [jx, jy]: [DVec3; 2]) -> f64 {
    DVec2::new(jx.dot(direction), jy.dot(direction)).to_angle()
}
