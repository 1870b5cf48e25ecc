//! One frame of a painting: project, thin out, turn, and put in order. A pure function of the painting, the frame number
//! and the picture size.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use impasto_core::horn_exact::{self, ClipView};
use impasto_core::solve::{BakedParticles, ParticleView, SolvedParticle, SolvedParticles, solve};
use impasto_core::{ScreenMap, hash};
use impasto_scene::built_in_mesh;
use impasto_scene::document::{InkDrawing, InkRule, Solver, Style};
use impasto_scene::motion::{self, CameraPose};

use crate::coat::Coat;
use crate::frame::{BodySurface, Frame, FrameBody, FrameStyle, Quality, Strokes};
use crate::gate::Gate;
use crate::lights;
use crate::noise_displace::BodyShape;
use crate::prepare::Painting;
use crate::recall::Recall;
use crate::surface::Vertices;
use crate::view::PictureView;

/// How to see a painting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// Width and height of the picture, each at least 1.
    pub size_px: [u32; 2],
    /// How high the shot is in a picture that shows more than the shot, pixels, > 0: strokes are as large as in a shot of
    /// this height. `None` where the picture is the shot.
    pub shot_height_px: Option<f32>,
    /// Strokes keep their size in pixels, whatever the picture's height.
    pub keep_stroke_px: bool,
    /// No ground under the strokes.
    pub transparent: bool,
    /// Whether strokes turn.
    pub rotation: Rotation,
    /// What strokes are coloured by.
    pub colors: StrokeColors,
    /// How much care to take.
    pub quality: Quality,
}

/// What strokes are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrokeColors {
    /// The scene, lit and mixed.
    #[default]
    Scene,
    /// How far each turn can be trusted (κ): green where a turn describes what the picture of the surface has done, through
    /// yellow to red where it does not.
    Trust,
}

/// Whether strokes turn with what they lie on; the others are there to be compared with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    /// They do.
    #[default]
    On,
    /// They lie in every frame as in the reference pose: the picture moves under its own pattern, as behind a shower door.
    Off,
    /// They lie anyhow, anew in each frame.
    Random,
    /// They lie on the surface as a texture does: shorter as it turns away, smaller as it goes (the source paper's figure 2).
    Mapped,
}

impl FrameOptions {
    /// How high the shot is in the picture, pixels.
    pub(crate) fn shot_height_px(&self) -> f32 {
        self.shot_height_px.unwrap_or(self.size_px[1] as f32)
    }

    /// A picture of this size; all else as usual.
    pub const fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            shot_height_px: None,
            keep_stroke_px: false,
            transparent: false,
            rotation: Rotation::On,
            colors: StrokeColors::Scene,
            quality: Quality::Exact,
        }
    }
}

/// One coat in one view.
pub(crate) struct SeenCoat<'a> {
    pub(crate) coat: &'a Coat,
    /// The baked particles, on a surface that changes its shape as they are now.
    pub(crate) baked: Cow<'a, BakedParticles>,
    pub(crate) map: ScreenMap,
    pub(crate) view: ParticleView,
    pub(crate) world_from_model: DAffine3,
    /// With the paper's rule, how many particles of each polygon show.
    pub(crate) shown: Option<Vec<u32>>,
    /// With `horn-exact`, the reference and this view.
    clip_views: Option<(ClipView, ClipView)>,
    /// By rule; none for those that paint nothing.
    pub(crate) gates: Vec<Option<Gate>>,
}

/// What all strokes of a frame share.
pub(crate) struct Look<'a> {
    pub(crate) painting: &'a Painting,
    pub(crate) seen: Vec<SeenCoat<'a>>,
    pub(crate) half_px: [f32; 2],
    pub(crate) px_scale: f32,
    pub(crate) near_far: [f32; 2],
    pub(crate) rotation: Rotation,
    pub(crate) colors: StrokeColors,
    pub(crate) quality: Quality,
    pub(crate) recall: Option<&'a Recall>,
    /// Differs from frame to frame.
    moment: u32,
}

impl Painting {
    /// The painting at a frame of its timeline (which need not be whole), as its camera sees it.
    pub fn at(&self, frame: f64, options: &FrameOptions) -> Frame {
        self.seen_by(&motion::camera_at(self.scene(), frame), frame, options)
    }

    /// The painting at a frame of its timeline, as a camera of one's own sees it.
    pub fn seen_by(&self, camera: &CameraPose, frame: f64, options: &FrameOptions) -> Frame {
        let mut bare = self.bare(camera, frame, options);
        bare.lay(self.strokes(camera, frame, options, None));
        bare
    }

    /// As [`Painting::seen_by`], without strokes: what a renderer can begin with.
    pub fn bare(&self, camera: &CameraPose, frame: f64, options: &FrameOptions) -> Frame {
        let scene = self.scene();
        let view = PictureView { pose: camera.clone(), size_px: options.size_px };
        let poses = motion::poses_at(scene, frame);
        let shapes = self.shapes_at(frame);
        Frame {
            size_px: options.size_px,
            px_scale: self.px_scale(options),
            view: view.frame_view(),
            background: (!options.transparent).then(|| lights::linear(scene.background)),
            lights: lights::resolve(scene, self.shadow_bounds),
            bodies: self
                .bodies
                .iter()
                .zip(poses.iter().zip(shapes))
                .zip(&scene.objects)
                .map(|((body, (&pose, shape)), object)| FrameBody {
                    is_backdrop: object.mesh == built_in_mesh::BACKDROP,
                    surface: Arc::clone(&body.surface),
                    world_from_model: glam::Mat4::from(pose.as_affine3()),
                    morph: shape.morph as f32,
                    noise: shape.noise,
                    hidden: body.hidden,
                })
                .collect(),
            strokes: Vec::new(),
            sources: Vec::new(),
            layers: Vec::new(),
            brushes: Arc::clone(&self.brushes),
            palettes: Arc::clone(&self.palettes),
            finish: self.finish.at(&view, f64::from(options.shot_height_px())),
            style: self.style,
            sumi_e: match &scene.style {
                Style::SumiE(ink) => Some(Arc::new(ink.clone())),
                Style::RotatingStrokes(_) | Style::Reference => None,
            },
            quality: options.quality,
        }
    }

    /// The strokes of [`Painting::seen_by`]; soon after another picture of about the same view, those that there were, and
    /// some of the others.
    pub fn strokes(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        recall: Option<&Recall>,
    ) -> Strokes {
        if !self.has_strokes() {
            return Strokes::default();
        }
        let look = self.look(camera, frame, options, |_| true);
        Look { recall: recall.filter(|recall| recall.is_of(self)), ..look }.strokes()
    }

    /// Whether anything is painted in strokes.
    fn has_strokes(&self) -> bool {
        match (self.style, &self.scene().style) {
            (FrameStyle::RotatingStrokes, _) => true,
            (FrameStyle::SumiE, Style::SumiE(ink)) => {
                ink.rule == InkRule::Painter && ink.drawing != InkDrawing::Wash
            }
            (FrameStyle::SumiE | FrameStyle::Reference, _) => false,
        }
    }

    fn px_scale(&self, options: &FrameOptions) -> f32 {
        if options.keep_stroke_px { 1.0 } else { options.shot_height_px() / self.scene().size.1 as f32 }
    }

    fn see_coat<'a>(
        &'a self,
        coat: &'a Coat,
        view: &PictureView,
        (world_from_model, stands): (DAffine3, &Stands),
        px_scale: f32,
    ) -> SeenCoat<'a> {
        let map = view.screen_map(world_from_model);
        let baked = match stands.vertices(&coat.surface, &self.reference_shapes[coat.object]) {
            Some([before, now]) => Cow::Owned(coat.deformed(before, now)),
            None => Cow::Borrowed(&coat.baked.baked),
        };
        let wanted_per_px =
            self.rules.last().map_or(0.0, |rule| f64::from(rule.strokes.body().wanted_per_px()));
        let shown = coat
            .sampled
            .polygons
            .as_ref()
            .map(|polygons| polygons.shown(&map, wanted_per_px / f64::from(px_scale * px_scale)));
        let clip_views = (self.solver == Solver::HornExact).then(|| {
            let reference = self.references.own();
            (reference.view.clip_view(reference.poses[coat.object]), view.clip_view(world_from_model))
        });
        let gates = self.gates(coat, px_scale, shown.is_some());
        let view = ParticleView::new(&map);
        SeenCoat { coat, baked, map, view, world_from_model, shown, clip_views, gates }
    }
}

/// How a body stands, with its vertices, which all its coats share.
struct Stands {
    shape: BodyShape,
    /// When it was baked, and now.
    vertices: OnceCell<[Vertices; 2]>,
}

impl Stands {
    /// Where the vertices were when the coats were baked, and where they are; none where they have not moved.
    fn vertices(&self, surface: &BodySurface, baked_at: &BodyShape) -> Option<&[Vertices; 2]> {
        let rests = |shape: &BodyShape| surface.is_at_rest(shape);
        if self.shape == *baked_at || (rests(&self.shape) && rests(baked_at)) {
            return None;
        }
        let vertices = || [baked_at, &self.shape].map(|shape| surface.vertices_at(shape));
        Some(self.vertices.get_or_init(vertices))
    }
}

/// How much larger than stated a stroke may become that follows the size of its surface.
pub(crate) const MOST_GROWTH: f32 = 64.0;

impl<'a> Look<'a> {
    /// Those coats of a painting that are `wanted`, in a view at a frame in which objects stand like this.
    pub(crate) fn new(
        painting: &'a Painting,
        (view, frame): (&PictureView, f64),
        (poses, shapes): (&[DAffine3], Vec<BodyShape>),
        options: &FrameOptions,
        wanted: impl Fn(&Coat) -> bool,
    ) -> Self {
        let px_scale = painting.px_scale(options);
        let stands = |shape| Stands { shape, vertices: OnceCell::new() };
        let bodies: Vec<Stands> = shapes.into_iter().map(stands).collect();
        let seen = |coat: &'a Arc<Coat>| {
            painting.see_coat(coat, view, (poses[coat.object], &bodies[coat.object]), px_scale)
        };
        Look {
            painting,
            seen: painting.coats.iter().filter(|coat| wanted(coat)).map(seen).collect(),
            half_px: options.size_px.map(|side| side as f32 * 0.5),
            px_scale,
            near_far: view.frame_view().near_far,
            rotation: options.rotation,
            colors: options.colors,
            quality: options.quality,
            recall: None,
            moment: hash::scramble((frame * 1000.0).round() as i64 as u32),
        }
    }
}

impl Look<'_> {
    /// The angle of a particle's stroke before its contour has a say.
    pub(crate) fn angle_rad(&self, seen: &SeenCoat<'_>, index: usize, solved: &SolvedParticle) -> f32 {
        match self.rotation {
            Rotation::On | Rotation::Mapped => seen.angle_rad(index, solved),
            Rotation::Off => seen.base_angle_rad(index) as f32,
            Rotation::Random => {
                (hash::unit(seen.bits(index, self.moment)) * 2.0 - 1.0) * std::f32::consts::PI
            }
        }
    }

    /// Whether a depth is between the nearest and the farthest that show.
    pub(crate) fn is_between(&self, depth: f32) -> bool {
        depth > self.near_far[0] && depth < self.near_far[1]
    }
}

impl SeenCoat<'_> {
    /// A particle in this view.
    pub(crate) fn solved(&self, index: usize) -> SolvedParticle {
        self.view.solved(&self.baked, index)
    }

    /// All particles in this view.
    pub(crate) fn all_solved(&self) -> SolvedParticles {
        let mut solved = SolvedParticles::default();
        solve(&self.baked, &self.map, &mut solved);
        solved
    }

    fn angle_rad(&self, index: usize, solved: &SolvedParticle) -> f32 {
        let Some((reference, now)) = &self.clip_views else { return solved.angle_rad };
        let particles = &self.coat.sampled.particles;
        let position = |particle: usize| -> DVec3 { particles.at(particle).position.as_dvec3() };
        let neighbours = self.coat.ground.neighbours.as_ref().map_or(&[][..], |lists| lists.of(index));
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
        let region = usize::from(self.coat.seats.region(index));
        self.coat.baked.base_angle_rad(index, self.coat.ground.references.of_rule(region))
    }

    /// How much larger than stated the stroke of a particle is, since it follows the size of its surface: m^γ, m the pixels
    /// per unit of surface now over those in the reference picture, γ the region's `size_follow`.
    pub(crate) fn growth(&self, index: usize, painting: &Painting, px_scale: f32) -> f32 {
        let region = usize::from(self.coat.seats.region(index));
        let follow = painting.rules[region].strokes.size_follow;
        if follow <= 0.0 {
            return 1.0;
        }
        let scale = |map: &ScreenMap, at: DVec3, near: f64| {
            map.row_x.truncate().length() / map.row_w.dot(at.extend(1.0)).max(near)
        };
        let reference = self.coat.ground.references.of_rule(region);
        let before = scale(&reference.map, self.coat.baked.baked.position_of(index), reference.near);
        let now = scale(&self.map, self.baked.position_of(index), 1e-9);
        let grown = (now / before / f64::from(px_scale)).powf(f64::from(follow));
        if grown.is_finite() {
            grown.clamp(1.0 / f64::from(MOST_GROWTH), f64::from(MOST_GROWTH)) as f32
        } else {
            1.0
        }
    }

    /// Random bits of a particle.
    pub(crate) fn bits(&self, index: usize, which: u32) -> u32 {
        hash::combine(self.coat.seats.bits(index), which)
    }
}
