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

/// The inputs that the steps of all objects share.
pub(crate) struct Context<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) rules: &'a Arc<Vec<RegionRule>>,
    /// A few of the views: that of the reference, and some spread evenly over the timeline. Each has the objects' poses
    /// beside it. The number of particles that an object needs is first found from these.
    pub(crate) views: &'a [(PictureView, Vec<DAffine3>)],
    /// For each of these views, the objects' shapes.
    pub(crate) shapes: &'a [Vec<BodyShape>],
    /// Every view that the painting will be seen from: large surfaces have particles only where one of these needs
    /// them.
    pub(crate) seen: &'a Seen<'a>,
    pub(crate) solver: Solver,
    /// Whether strokes are painted by the source paper's own rule.
    pub(crate) paper: bool,
    pub(crate) orthographic: bool,
}

impl Context<'_> {
    /// The seed of the random numbers of a coat (one layer of one object), made from the scene's seed and the names of
    /// object and layer. For the body layer, the name of the layer is left out.
    pub(crate) fn name_hash(&self, object: usize, kind: LayerKind) -> u32 {
        let of_object = hash::combine(self.scene.seed, hash::of_name(&self.scene.objects[object].name));
        if kind == LayerKind::Body { of_object } else { hash::combine(of_object, hash::of_name(kind.name())) }
    }
}

/// One object while it is prepared.
#[derive(Clone, Copy)]
pub(crate) struct ObjectInputs<'a> {
    pub(crate) index: usize,
    /// If the object is one group of a mesh: how many groups of this mesh are objects, this one included. 1 if it is
    /// the whole mesh.
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
