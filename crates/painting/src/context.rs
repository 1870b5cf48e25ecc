//! What the steps of preparing one object are given: the scene's context, and the object's own inputs.

use std::sync::Arc;

use glam::DAffine3;
use impasto_core::hash;
use impasto_scene::document::{Scene, Solver};
use impasto_scene::presets::LayerKind;

use crate::amounts::BodyAmounts;
use crate::body_shape::BodyShape;
use crate::parts::Cap;
use crate::prepare::Seen;
use crate::references::BodyReferences;
use crate::regions::{BodyGuide, BodyRegions, RegionRule};
use crate::surface::SurfaceInputs;
use crate::view::PictureView;

/// What the steps of all objects share.
pub(crate) struct Context<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) rules: &'a Arc<Vec<RegionRule>>,
    /// Views over the whole timeline, each with the objects' poses. The number of particles needed follows from them.
    pub(crate) views: &'a [(PictureView, Vec<DAffine3>)],
    /// For each of these views, the objects' shapes.
    pub(crate) shapes: &'a [Vec<BodyShape>],
    /// All views, for what is made only where it is seen.
    pub(crate) seen: &'a Seen<'a>,
    pub(crate) solver: Solver,
    /// Whether strokes are painted by the source paper's own rule.
    pub(crate) paper: bool,
    pub(crate) underpainting: bool,
    pub(crate) orthographic: bool,
}

impl Context<'_> {
    /// The seed of all random numbers of a coat. The body layer uses the object's own seed.
    pub(crate) fn name_hash(&self, object: usize, kind: LayerKind) -> u32 {
        let of_object = hash::combine(self.scene.seed, hash::of_name(&self.scene.objects[object].name));
        if kind == LayerKind::Body { of_object } else { hash::combine(of_object, hash::of_name(kind.name())) }
    }
}

/// One object while it is prepared.
#[derive(Clone, Copy)]
pub(crate) struct ObjectInputs<'a> {
    pub(crate) index: usize,
    /// How many groups of its mesh are objects, itself included; 1 if it is the whole mesh.
    pub(crate) groups: usize,
    pub(crate) surface: &'a SurfaceInputs,
    pub(crate) regions: &'a Arc<BodyRegions>,
    /// The rules that may show on the object.
    pub(crate) used: &'a Arc<Vec<u16>>,
    pub(crate) guides: &'a Arc<Vec<BodyGuide>>,
    pub(crate) amounts: &'a Arc<BodyAmounts>,
    pub(crate) references: &'a Arc<BodyReferences>,
    /// For each part, the largest strokes that it carries.
    pub(crate) caps: &'a [Cap],
}
