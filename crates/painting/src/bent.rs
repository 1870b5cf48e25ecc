//! Bodies that are not at rest: where their vertices are at a frame, and what carries strokes there.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

use glam::{Mat3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::bending::{CarriedPlace, Carrier, Gradients, Vertices};
use impasto_core::sampling::PackedParticle;
use impasto_core::shells::sides;
use rayon::prelude::*;

use crate::body::BodySurface;
use crate::body_bend::BodyBend;
use crate::body_shape::BodyShape;
use crate::displaced::displaced;
use crate::made_once::made_once;

/// A surface that is not at rest.
#[derive(Debug)]
pub struct Bent {
    surface: Arc<BodySurface>,
    /// Where the vertices are, with the normals with which they are drawn.
    pub vertices: Vertices,
    carrier: OnceLock<Carrier>,
}

impl Bent {
    /// The carrier, which takes places of the surface at rest to where they are now.
    pub(crate) fn carrier(&self) -> &Carrier {
        made_once(&self.carrier, || {
            let positions = &self.vertices.positions;
            Carrier::new(positions, &self.surface.gradients().at(positions))
        })
    }

    /// Where a place is now.
    pub(crate) fn place(&self, place: PackedParticle) -> CarriedPlace {
        self.carrier().place(&self.surface.mesh, place)
    }
}

impl BodySurface {
    /// A surface that nothing bends, without materials.
    pub fn still(mesh: TriangleMesh) -> Self {
        Self { sides: sides(&mesh), mesh, bending: BodyBend::default(), materials: Vec::new() }
    }

    /// Whether the surface in this shape is the same as its mesh.
    pub fn is_at_rest(&self, shape: &BodyShape) -> bool {
        let rest = &self.bending.rest;
        (&shape.pose, shape.cache_frame) == (&rest.pose, rest.cache_frame) && shape.displacing().is_none()
    }

    /// Whether joints, targets or a point cache may bend it.
    pub fn bends(&self) -> bool {
        self.bending.bend.is_some() || self.bending.cache.is_some()
    }

    /// Whether a point cache moves its vertices.
    pub(crate) fn has_cache(&self) -> bool {
        self.bending.cache.is_some()
    }

    /// The surface in a shape; `None` at rest.
    pub fn bent(self: &Arc<Self>, shape: &BodyShape) -> Option<Arc<Bent>> {
        let Strained { vertices, gradients } = (!self.is_at_rest(shape)).then(|| self.strained(shape))?;
        let carrier = gradients.map(|gradients| Carrier::new(&vertices.positions, &gradients));
        let carrier = carrier.map_or_else(OnceLock::new, OnceLock::from);
        Some(Arc::new(Bent { surface: Arc::clone(self), vertices, carrier }))
    }

    /// Positions of the vertices of the surface in this shape, and the deformation gradient F at each; no gradients at
    /// rest.
    pub(crate) fn moved_to(&self, shape: &BodyShape) -> (Vec<Vec3>, Option<Vec<Mat3>>) {
        if self.is_at_rest(shape) {
            return (self.mesh.positions.clone(), None);
        }
        let Strained { vertices, gradients } = self.strained(shape);
        let gradients = gradients.unwrap_or_else(|| self.gradients().at(&vertices.positions));
        (vertices.positions, Some(gradients))
    }

    /// Positions of the vertices of the surface in this shape.
    pub fn positions_at(&self, shape: &BodyShape) -> Vec<Vec3> {
        if self.is_at_rest(shape) { self.mesh.positions.clone() } else { self.vertices_at(shape).positions }
    }

    /// The vertices of the surface in this shape.
    pub(crate) fn vertices_at(&self, shape: &BodyShape) -> Vertices {
        self.strained(shape).vertices
    }

    fn strained(&self, shape: &BodyShape) -> Strained {
        let bent = self.unnoised(shape);
        match shape.displacing() {
            Some((noise, lookup)) => Strained::from(displaced(&bent.vertices, noise, lookup)),
            None => bent,
        }
    }

    /// What went wrong when its point cache was read, if anything did.
    pub(crate) fn fault(&self) -> Option<&String> {
        self.bending.fault.get()
    }

    pub(crate) fn gradients(&self) -> &Gradients {
        made_once(&self.bending.gradients, || Gradients::new(&self.mesh, self.bending.bonds()))
    }

    /// The vertices as targets, joints or a cache put them, before noise moves them.
    fn unnoised(&self, shape: &BodyShape) -> Strained {
        let BodyBend { bend, cache, rest, .. } = &self.bending;
        if let Some((cache, frame)) = cache.as_ref().zip(shape.cache_frame) {
            return match cache.positions(frame) {
                Ok(positions) => self.with_own_normals(positions),
                Err(error) => {
                    let path = cache.cache.path().display();
                    let _ = self.bending.fault.set(format!("{path}, at frame {frame}: {error}"));
                    self.at_rest()
                }
            };
        }
        match bend {
            Some(bend) if shape.pose != rest.pose => {
                let bent = bend.at(shape.pose.as_deref().unwrap_or(&bend.rest));
                if bend.turns_normals { self.with_own_normals(bent.positions) } else { bent.into() }
            }
            _ => self.at_rest(),
        }
    }

    fn at_rest(&self) -> Strained {
        Vertices { positions: self.mesh.positions.clone(), normals: self.mesh.normals.clone() }.into()
    }

    /// Vertices at these positions, with normals that turn as the surface round them does.
    fn with_own_normals(&self, positions: Vec<Vec3>) -> Strained {
        let gradients: Vec<Mat3> = self.gradients().at(&positions);
        let normals = self.gradients().normals(&self.mesh.normals, &gradients);
        Strained { vertices: Vertices { positions, normals }, gradients: Some(gradients) }
    }
}

/// Vertices, with the deformation gradient F at each of them if their normals were found from F.
struct Strained {
    vertices: Vertices,
    gradients: Option<Vec<Mat3>>,
}

impl From<Vertices> for Strained {
    fn from(vertices: Vertices) -> Self {
        Self { vertices, gradients: None }
    }
}

/// All bodies of a scene at one frame; `None` for those at rest.
pub(crate) type BentBodies = Arc<Vec<Option<Arc<Bent>>>>;

/// Remembers the bodies at the last few frames, because several steps of one picture ask for the same frame.
#[derive(Default)]
pub(crate) struct BentMemo(Mutex<VecDeque<Remembered>>);

struct Remembered {
    frame: f64,
    shapes: Vec<BodyShape>,
    /// Weak: this list does not keep bodies alive, so one is found again only while something else holds it. `None` for
    /// a body at rest.
    bodies: Vec<Option<Weak<Bent>>>,
    /// The same bodies, if the memo itself holds them.
    kept: Option<BentBodies>,
}

/// How many frames are remembered.
const REMEMBERED: usize = 8;

/// The memo itself holds the bodies of the newest frames: about this many bytes of them, and at least the last frame's.
const KEPT_BYTES: usize = 16 << 20;

/// Bytes of a vertex of a bent body: its position and normal, and its share of the [`Carrier`].
const VERTEX_BYTES: usize = size_of::<[Vec3; 2]>() + size_of::<[f32; 16]>();

impl Remembered {
    /// The body of an object, which is `None` at rest; outer `None` if nobody holds it any more.
    fn body(&self, object: usize) -> Option<Option<Arc<Bent>>> {
        match &self.bodies[object] {
            Some(body) => body.upgrade().map(Some),
            None => Some(None),
        }
    }

    /// All bodies; `None` if nobody holds one of them any more.
    fn all(&self) -> Option<BentBodies> {
        let found = || (0..self.bodies.len()).map(|object| self.body(object)).collect::<Option<_>>();
        self.kept.clone().or_else(|| found().map(Arc::new))
    }
}

impl BentMemo {
    /// The bodies with these surfaces at a frame. `shapes_at` is called unless all of them are still remembered.
    pub(crate) fn at<'a>(
        &self,
        frame: f64,
        surfaces: impl Iterator<Item = &'a Arc<BodySurface>>,
        shapes_at: impl FnOnce() -> Vec<BodyShape>,
    ) -> BentBodies {
        let known = |memo: &VecDeque<Remembered>| {
            memo.iter().find(|entry| entry.frame.to_bits() == frame.to_bits()).and_then(Remembered::all)
        };
        if let Some(bodies) = known(&self.lock()) {
            return bodies;
        }
        let shapes = shapes_at();
        // A body that has the same shape at a remembered frame is reused, so what a renderer uploaded for it is reused
        // too.
        let before: Vec<Option<Arc<Bent>>> = {
            let memo = self.lock();
            let of_shape = |(object, shape): (usize, &BodyShape)| {
                let mut same = memo.iter().filter(|entry| entry.shapes[object] == *shape);
                same.find_map(|entry| entry.body(object).flatten())
            };
            shapes.iter().enumerate().map(of_shape).collect()
        };
        let surfaces: Vec<&Arc<BodySurface>> = surfaces.collect();
        let bend = |((surface, shape), before): ((&&Arc<BodySurface>, &BodyShape), Option<Arc<Bent>>)| {
            before.or_else(|| surface.bent(shape))
        };
        let bodies: Vec<_> = surfaces.par_iter().zip(&shapes).zip(before).map(bend).collect();
        let bodies = Arc::new(bodies);
        let mut memo = self.lock();
        if let Some(known) = known(&memo) {
            return known;
        }
        let bytes: usize =
            bodies.iter().flatten().map(|bent| bent.vertices.positions.len() * VERTEX_BYTES).sum();
        memo.retain(|entry| entry.frame.to_bits() != frame.to_bits());
        memo.truncate(REMEMBERED - 1);
        let weak = bodies.iter().map(|body| body.as_ref().map(Arc::downgrade)).collect();
        memo.push_front(Remembered { frame, shapes, bodies: weak, kept: Some(Arc::clone(&bodies)) });
        let kept = (KEPT_BYTES / bytes.max(1)).max(1);
        memo.iter_mut().skip(kept).for_each(|entry| entry.kept = None);
        bodies
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<Remembered>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
