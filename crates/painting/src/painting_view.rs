//! A painting as one camera sees it at one frame: what all strokes of the frame share, and each coat in this view.

use std::borrow::Cow;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use impasto_core::horn_exact::{self, ClipView};
use impasto_core::lift::Lift;
use impasto_core::solve::{Bounds, ParticleView, PlacedParticles, SeenParticle};
use impasto_core::{ScreenMap, hash};
use impasto_scene::document::Solver;
use impasto_scene::motion::{self, CameraPose};
use impasto_scene::presets::ResolvedStrokes;

use crate::bent::Bent;
use crate::boil::Boil;
use crate::coat::Coat;
use crate::frame::Quality;
use crate::frame_options::{FrameOptions, Rotation, StrokeColors};
use crate::looks::Look;
use crate::painting::Painting;
use crate::presence_bound::PresenceBound;
use crate::recall::Recall;
use crate::size_follow::{growth, px_per_unit};
use crate::view::PictureView;

/// What all strokes of a frame share.
pub(crate) struct PaintingView<'a> {
    pub(crate) painting: &'a Painting,
    pub(crate) coats: Vec<CoatView<'a>>,
    /// One per object.
    pub(crate) bodies: Vec<PosedBody>,
    /// Turns world space to the axes of the view: right, up, towards the eye.
    pub(crate) view_from_world: DMat3,
    /// Half the picture's width and height.
    pub(crate) half_px: [f32; 2],
    /// The factor from pixels at the scene's own size to pixels of the picture.
    pub(crate) px_scale: f32,
    /// Nearest and farthest visible depth, world units.
    pub(crate) near_far: [f32; 2],
    pub(crate) rotation: Rotation,
    pub(crate) colors: StrokeColors,
    pub(crate) quality: Quality,
    pub(crate) recall: Option<&'a Recall>,
    frame: f64,
    /// For each rule, its stroke settings at this frame.
    pub(crate) strokes_of_rule: Vec<Cow<'a, ResolvedStrokes>>,
    /// Random bits of the frame.
    frame_bits: u32,
}

/// One coat in one view.
pub(crate) struct CoatView<'a> {
    pub(crate) coat: &'a Coat,
    /// Whether its body is hidden at this frame.
    pub(crate) hidden: bool,
    /// Its body as it is bent; `None` at rest.
    bent: Option<Arc<Bent>>,
    pub(crate) map: ScreenMap,
    particle_view: ParticleView,
    pub(crate) world_from_model: DAffine3,
    /// With the paper's rule, how many particles of each polygon side show.
    pub(crate) shown: Option<Vec<u32>>,
    /// With the solver `HornExact`, the view of the reference and this view.
    clip_views: Option<(ClipView, ClipView)>,
    /// The presence bound of each rule; `None` for a rule that paints nothing on this coat.
    pub(crate) presence_bounds: Vec<Option<PresenceBound>>,
}

/// A particle where it is at a frame.
pub(crate) struct PlacedParticle {
    /// Model space.
    pub(crate) position: DVec3,
    /// Unit, model space; zero where its surface has collapsed.
    pub(crate) normal: DVec3,
    /// The lift N', carried to where the surface is now.
    pub(crate) lift: Lift,
    /// Position, normal and the columns of N' in single precision. The length of the normal is the area of its surface
    /// now over that at rest.
    vectors: [[f32; 3]; 4],
}

/// One body at a frame, shared by its coats.
pub(crate) struct PosedBody {
    pub(crate) hidden: bool,
    pub(crate) world_from_model: DAffine3,
    pub(crate) map: ScreenMap,
    /// `None` at rest.
    pub(crate) bent: Option<Arc<Bent>>,
}

impl Painting {
    /// The painting at a frame through a camera, with the coats that are `wanted`.
    pub(crate) fn view(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        wanted: impl Fn(&Coat) -> bool,
    ) -> PaintingView<'_> {
        let view = PictureView { pose: camera.clone(), size_px: options.size_px };
        let poses = motion::poses_at(self.scene(), frame);
        let bodies: Vec<PosedBody> = poses
            .into_iter()
            .zip(&*self.bent_at(frame))
            .zip(motion::hidden_at(self.scene(), frame))
            .map(|((world_from_model, bent), hidden)| PosedBody {
                hidden,
                world_from_model,
                map: view.screen_map(world_from_model),
                bent: bent.clone(),
            })
            .collect();
        let px_scale = self.px_scale(options);
        let mut painting_view = PaintingView {
            painting: self,
            coats: Vec::new(),
            bodies,
            view_from_world: DMat3::from_mat4(view.pose.view_from_world()),
            half_px: options.size_px.map(|side| side as f32 * 0.5),
            px_scale,
            near_far: view.frame_view(self.origin_in_world).near_far,
            rotation: options.rotation,
            colors: options.colors,
            quality: options.quality,
            recall: None,
            frame,
            strokes_of_rule: self.rules.iter().map(|rule| rule.strokes.at(frame)).collect(),
            frame_bits: hash::scramble((frame * 1000.0).round() as i64 as u32),
        };
        let coats = self.coats.iter().filter(|coat| wanted(coat));
        painting_view.coats = coats
            .map(|coat| painting_view.coat_view(coat, &view, &painting_view.bodies[coat.object]))
            .collect();
        painting_view
    }

    pub(crate) fn px_scale(&self, options: &FrameOptions) -> f32 {
        if options.keep_stroke_px { 1.0 } else { options.shot_height_px() / self.scene().size.1 as f32 }
    }
}

impl<'a> PaintingView<'a> {
    fn coat_view(&self, coat: &'a Coat, view: &PictureView, body: &PosedBody) -> CoatView<'a> {
        let world_from_model = body.world_from_model;
        let map = body.map;
        let wanted_per_px =
            self.strokes_of_rule.last().map_or(0.0, |strokes| f64::from(strokes.body().wanted_per_px()));
        let shown = coat.sampled.polygons.as_ref().map(|polygons| {
            let moved = body.bent.as_ref().map(|bent| (&coat.surface.mesh, &bent.vertices.positions[..]));
            polygons.shown(&map, wanted_per_px / f64::from(self.px_scale * self.px_scale), moved)
        });
        let clip_views = (self.painting.solver == Solver::HornExact).then(|| {
            let reference = self.painting.references.own();
            (reference.view.clip_view(reference.poses[coat.object]), view.clip_view(world_from_model))
        });
        let presence_bounds =
            self.painting.presence_bounds(coat, &self.strokes_of_rule, self.px_scale, shown.is_some());
        let particle_view = ParticleView::new(&map);
        let hidden = body.hidden;
        CoatView {
            coat,
            hidden,
            bent: body.bent.clone(),
            map,
            particle_view,
            world_from_model,
            shown,
            clip_views,
            presence_bounds,
        }
    }
}

impl PaintingView<'_> {
    /// The angle of a particle's stroke before it is pulled towards the contour.
    pub(crate) fn angle_rad(&self, coat: &CoatView<'_>, index: usize, placed: &PlacedParticle) -> f32 {
        match self.rotation {
            Rotation::On | Rotation::Mapped => coat.angle_rad(index, placed),
            Rotation::Off => coat.base_angle_rad(index) as f32,
            Rotation::Random => {
                (hash::unit(coat.bits(index, self.frame_bits)) * 2.0 - 1.0) * std::f32::consts::PI
            }
        }
    }

    pub(crate) fn strokes_of(&self, rule: u16) -> &ResolvedStrokes {
        &self.strokes_of_rule[usize::from(rule)]
    }

    /// How strokes of these settings boil at this frame; `None` if they do not.
    pub(crate) fn boil(&self, strokes: &ResolvedStrokes) -> Option<Boil> {
        (strokes.boil > 0.0).then(|| Boil::at(self.frame, strokes.boil, strokes.boil_on))
    }

    /// Whether a depth is between the nearest and the farthest that show.
    pub(crate) fn is_between(&self, depth: f32) -> bool {
        depth > self.near_far[0] && depth < self.near_far[1]
    }
}

impl CoatView<'_> {
    fn at_rest_all(&self) -> &PlacedParticles {
        &self.coat.baked.placed
    }

    pub(crate) fn len(&self) -> usize {
        self.at_rest_all().len()
    }

    /// A bit for each particle of the coat: whether it faces the eye within these bounds.
    pub(crate) fn within(&self, bounds: &Bounds) -> Vec<u64> {
        match &self.bent {
            Some(bent) => self.coat.carried_within(bent, &self.particle_view, bounds),
            None => {
                let ordinals = self.coat.sampled.particles.ordinals();
                self.particle_view.within(self.at_rest_all(), ordinals, bounds)
            }
        }
    }

    /// Position and normal of a particle where it is now, and the columns of its lift, carried there.
    fn vectors(&self, index: usize, lift: [[f32; 3]; 2]) -> [[f32; 3]; 4] {
        match &self.bent {
            Some(bent) => {
                self.coat.carried(bent, index, lift.map(Vec3::from_array)).map(|vector| vector.to_array())
            }
            None => {
                let [position, normal] = self.at_rest_all().vectors_of(index);
                [position, normal, lift[0], lift[1]]
            }
        }
    }

    /// Where a particle is in this view. Needs no look.
    pub(crate) fn seen(&self, index: usize) -> SeenParticle {
        let [position, normal, ..] = self.vectors(index, [[0.0; 3]; 2]);
        self.particle_view.seen([position, normal])
    }

    /// Where a particle is now, and its unit normal, in model space. Needs no look.
    pub(crate) fn position_and_normal(&self, index: usize) -> [DVec3; 2] {
        let [position, normal, ..] =
            self.vectors(index, [[0.0; 3]; 2]).map(|vector| DVec3::from_array(vector.map(f64::from)));
        [position, self.unit(normal)]
    }

    /// The unit vector of a normal. The length of a carried normal is the area of its surface now over that at rest. A
    /// normal at rest is a unit vector already.
    fn unit(&self, normal: DVec3) -> DVec3 {
        if self.bent.is_some() { normal.normalize_or_zero() } else { normal }
    }

    pub(crate) fn placed(&self, index: usize, look: &Look) -> PlacedParticle {
        let vectors = self.vectors(index, look.lift);
        let [position, normal, along, across] =
            vectors.map(|vector| DVec3::from_array(vector.map(f64::from)));
        PlacedParticle { position, normal: self.unit(normal), lift: Lift { along, across }, vectors }
    }

    pub(crate) fn look(&self, index: usize) -> Look {
        self.coat.baked.looks.at(index)
    }

    fn angle_rad(&self, index: usize, placed: &PlacedParticle) -> f32 {
        let Some((reference, now)) = &self.clip_views else {
            let flatness = self.coat.baked.flatness.get(index).copied();
            return self.particle_view.solved_at(placed.vectors, flatness).angle_rad;
        };
        let particles = &self.coat.sampled.particles;
        let own = self.coat.lift_sources.references.own();
        // Where a particle is, in the reference and now.
        let position = |particle: usize| -> [DVec3; 2] {
            let (place, at_rest) = (particles.places()[particle], particles.at(particle).position.as_dvec3());
            [&own.stands.bent, &self.bent]
                .map(|bent| bent.as_ref().map_or(at_rest, |bent| bent.place(place).position))
        };
        let neighbours = self.coat.lift_sources.neighbours.as_ref().map_or(&[][..], |lists| lists.of(index));
        let turn_rad = horn_exact::turn_rad(
            position(index),
            neighbours.iter().map(|&neighbour| position(neighbour as usize)),
            reference,
            now,
        );
        impasto_core::angle::wrap_pi(turn_rad + self.base_angle_rad(index)) as f32
    }

    /// The angle of a particle's stroke in the reference picture, radians.
    pub(crate) fn base_angle_rad(&self, index: usize) -> f64 {
        let region = usize::from(self.coat.traits.region(index));
        let reference = self.coat.lift_sources.references.of_rule(region);
        self.coat.baked.base_angle_rad(index, self.coat.raised(index), reference)
    }

    /// Where a particle is at rest, model space.
    pub(crate) fn at_rest(&self, index: usize) -> DVec3 {
        self.at_rest_all().position_of(index)
    }

    /// The lift N of the tangent plane, without a stroke's direction, carried to where the surface is now. With the
    /// solvers `Horn` and `HornExact`, κ is measured with it.
    pub(crate) fn surface_lift(&self, index: usize) -> Lift {
        let Lift { along, across } =
            self.coat.lift_sources.surface_lift(index, self.coat.traits.region(index));
        let gradient = match &self.bent {
            Some(bent) => bent.place(self.coat.sampled.particles.places()[index]).gradient,
            None => return Lift { along, across },
        };
        Lift { along: gradient * along, across: gradient * across }
    }

    /// The factor by which lengths on the surface at a particle have grown since rest: the square root of the factor by
    /// which its area has grown.
    fn stretch(&self, bent: Option<&Arc<Bent>>, index: usize) -> f64 {
        let Some(bent) = bent else { return 1.0 };
        let place = bent.place(self.coat.sampled.particles.places()[index]);
        place.area_normal(self.at_rest_all().normal_of(index)).length().sqrt()
    }

    /// The factor on a stroke's stated size where it follows the size of its surface: m^γ. m is the pixels that a unit
    /// of length on the surface fills now over those that it fills in the reference picture, γ the region's
    /// `size_follow`.
    pub(crate) fn growth(&self, index: usize, view: &PaintingView<'_>) -> f32 {
        let region = self.coat.traits.region(index);
        let follow = view.strokes_of(region).size_follow;
        if follow <= 0.0 {
            return 1.0;
        }
        let scale =
            |map: &ScreenMap, at: DVec3, near: f64| px_per_unit(map, map.row_w.dot(at.extend(1.0)), near);
        let reference = self.coat.lift_sources.references.of_rule(usize::from(region));
        let was_at = reference.then(self.coat.raised(index)).position;
        let before = scale(&reference.map, was_at, reference.near)
            * self.stretch(reference.stands.bent.as_ref(), index);
        let [position, _] = self.position_and_normal(index);
        let now = scale(&self.map, position, 1e-9) * self.stretch(self.bent.as_ref(), index);
        growth(now / before / f64::from(view.px_scale), f64::from(follow)) as f32
    }

    /// Random bits of a particle, independent for each `which`.
    pub(crate) fn bits(&self, index: usize, which: u32) -> u32 {
        hash::combine(self.coat.traits.bits(index), which)
    }
}
