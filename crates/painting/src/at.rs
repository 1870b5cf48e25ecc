//! One frame of a painting: project, thin out, turn, and put in order. A pure function of the painting, the frame number
//! and the picture size.

use glam::{DAffine3, DVec3};
use impasto_core::horn_exact::{self, ClipView};
use impasto_core::lift::PixelMap2;
use impasto_core::presence::{LEAST_WANTED_OVER_RANK, presence};
use impasto_core::screen_map::facing;
use impasto_core::solve::{SolvedParticles, solve};
use impasto_core::{ScreenMap, hash};
use impasto_scene::document::Solver;
use impasto_scene::motion;
use rayon::prelude::*;

use crate::bake::{LENGTH_JITTER, WIDTH_JITTER};
use crate::frame::{Frame, FrameBody, LayerRun, Stroke, StrokeSource};
use crate::lights;
use crate::prepare::{Body, OrderEntry, Painting};
use crate::view::PictureView;

/// The quad of a stroke is this much larger than the stroke, for ragged ends; it decides what is off the picture.
const QUAD_MARGIN: f32 = 1.0 / 0.84;

/// Underpainting strokes are this much longer and wider than the region's own.
const UNDER_LENGTH: f32 = 1.9;
const UNDER_WIDTH: f32 = 2.2;

/// Strokes per pixel × length × width of the underpainting.
const UNDER_COVERAGE: f32 = 4.5;

/// How to see a painting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameOptions {
    /// Width and height of the picture, each at least 1.
    pub size_px: [u32; 2],
    /// Strokes keep their size in pixels, whatever the picture's height.
    pub keep_stroke_px: bool,
    /// No ground under the strokes.
    pub transparent: bool,
}

/// One body in one view.
struct SeenBody<'a> {
    body: &'a Body,
    map: ScreenMap,
    world_from_model: DAffine3,
    solved: SolvedParticles,
    /// With the paper's rule, how many particles of each polygon show.
    shown: Option<Vec<u32>>,
    /// With `horn-exact`, the reference and this view.
    clip_views: Option<(ClipView, ClipView)>,
}

/// What all strokes of a frame share.
struct Look<'a> {
    painting: &'a Painting,
    seen: Vec<SeenBody<'a>>,
    half_px: [f32; 2],
    px_scale: f32,
    near_far: [f32; 2],
}

impl Painting {
    /// The painting at a frame of its timeline (which need not be whole), as its camera sees it.
    pub fn at(&self, frame: f64, options: &FrameOptions) -> Frame {
        let scene = self.scene();
        let view = PictureView { pose: motion::camera_at(scene, frame), size_px: options.size_px };
        let poses = motion::poses_at(scene, frame);
        let frame_view = view.frame_view();
        let px_scale =
            if options.keep_stroke_px { 1.0 } else { options.size_px[1] as f32 / scene.size.1 as f32 };
        let look = Look {
            painting: self,
            seen: self.see(&view, &poses, px_scale),
            half_px: options.size_px.map(|side| side as f32 * 0.5),
            px_scale,
            near_far: frame_view.near_far,
        };
        let (strokes, sources, layers) = look.strokes();
        Frame {
            size_px: options.size_px,
            px_scale,
            view: frame_view,
            background: (!options.transparent).then(|| lights::linear(scene.background)),
            lights: lights::resolve(scene, self.shadow_bounds),
            bodies: look
                .seen
                .iter()
                .map(|seen| FrameBody {
                    surface: std::sync::Arc::clone(&seen.body.surface),
                    world_from_model: glam::Mat4::from(seen.world_from_model.as_affine3()),
                })
                .collect(),
            strokes,
            sources,
            layers,
            style: self.style,
        }
    }

    fn see(&self, view: &PictureView, poses: &[DAffine3], px_scale: f32) -> Vec<SeenBody<'_>> {
        let wanted_per_px = self.rules.last().map_or(0.0, |rule| f64::from(rule.wanted_per_px()));
        self.bodies
            .iter()
            .enumerate()
            .map(|(index, body)| {
                let world_from_model = poses[index];
                let map = view.screen_map(world_from_model);
                let mut solved = SolvedParticles::default();
                solve(&body.baked.baked, &map, &mut solved);
                let shown = body
                    .sampled
                    .polygons
                    .as_ref()
                    .map(|polygons| polygons.shown(&map, wanted_per_px / f64::from(px_scale * px_scale)));
                let clip_views = (self.solver == Solver::HornExact).then(|| {
                    let reference = &self.reference;
                    (reference.view.clip_view(reference.poses[index]), view.clip_view(world_from_model))
                });
                SeenBody { body, map, world_from_model, solved, shown, clip_views }
            })
            .collect()
    }
}

type Strokes = (Vec<Stroke>, Vec<StrokeSource>, Vec<LayerRun>);

impl Look<'_> {
    fn strokes(&self) -> Strokes {
        if self.painting.style != crate::frame::FrameStyle::RotatingStrokes {
            return Strokes::default();
        }
        // Those that face the eye inside the picture; few enough to go over again for each layer.
        let facing: Vec<OrderEntry> = self
            .painting
            .order
            .par_iter()
            .with_min_len(8192)
            .filter(|entry| self.is_in_picture(**entry))
            .copied()
            .collect();
        let (mut strokes, mut sources, mut layers) = Strokes::default();
        let mut append = |under: bool, entries: &[OrderEntry]| {
            let run: Vec<(Stroke, StrokeSource)> =
                entries.par_iter().with_min_len(512).filter_map(|&entry| self.stroke(entry, under)).collect();
            layers.push(LayerRun {
                underpainting: under,
                first: strokes.len() as u32,
                count: run.len() as u32,
            });
            strokes.extend(run.iter().map(|(stroke, _)| *stroke));
            sources.extend(run.iter().map(|(_, source)| *source));
        };
        if self.painting.underpainting {
            append(true, &facing);
        }
        for run in facing.chunk_by(|a, b| self.layer(*a) == self.layer(*b)) {
            append(false, run);
        }
        (strokes, sources, layers)
    }

    fn region(&self, entry: OrderEntry) -> u16 {
        self.seen[entry.body as usize].body.baked.region[entry.particle as usize]
    }

    fn layer(&self, entry: OrderEntry) -> i32 {
        self.painting.rules[self.region(entry) as usize].strokes.layer
    }

    fn is_in_picture(&self, entry: OrderEntry) -> bool {
        let (seen, index) = (&self.seen[entry.body as usize], entry.particle as usize);
        let solved = &seen.solved;
        let depth = solved.depth[index];
        let strokes = &self.painting.rules[self.region(entry) as usize].strokes;
        // Half a diagonal, for the largest of a lively crowd.
        let reach =
            (strokes.length_px * UNDER_LENGTH + strokes.width_px * UNDER_WIDTH) * QUAD_MARGIN * self.px_scale;
        solved.area_px[index] > 0.0
            && depth > self.near_far[0]
            && depth < self.near_far[1]
            && solved.x_px[index].abs() < self.half_px[0] + reach
            && solved.y_px[index].abs() < self.half_px[1] + reach
    }

    /// The stroke of a particle in a layer, unless it is absent.
    fn stroke(&self, entry: OrderEntry, under: bool) -> Option<(Stroke, StrokeSource)> {
        let (seen, index) = (&self.seen[entry.body as usize], entry.particle as usize);
        let (body, solved) = (seen.body, &seen.solved);
        let region = self.region(entry);
        let rule = &self.painting.rules[region as usize];
        let area_px = solved.area_px[index] / (self.px_scale * self.px_scale);
        let (length, width, wanted) = if under {
            let (length, width) =
                (rule.strokes.length_px * UNDER_LENGTH, rule.strokes.width_px * UNDER_WIDTH);
            (length, width, UNDER_COVERAGE / (length * width * rule.wanted_per_px()))
        } else {
            (rule.strokes.length_px, rule.strokes.width_px, 1.0)
        };
        let wanted_over_rank = body.wanted_over_rank[index] * area_px * wanted;
        if seen.shown.is_none() && wanted_over_rank <= LEAST_WANTED_OVER_RANK {
            return None;
        }
        let position = body.baked.baked.position_of(index);
        let normal = body.baked.baked.normal_of(index);
        let jacobian = seen.map.jacobian(position);
        let facing = facing(jacobian, normal) as f32;
        let presence = match (&seen.shown, &body.sampled.polygons) {
            (Some(shown), Some(polygons)) => f32::from(polygons.is_shown(shown, index)),
            _ => presence(wanted_over_rank, facing),
        };
        if presence <= 0.0 {
            return None;
        }
        let bits = hash::combine(body.baked.bits[index], u32::from(under));
        let jittered = |size_px: f32, which: u32| {
            let jitter = (rule.strokes.size_jitter * hash::normal(hash::combine(bits, which))).exp();
            size_px * jitter * self.px_scale
        };
        let lift = match self.painting.solver {
            Solver::Tangent => body.baked.baked.lift_of(index),
            Solver::Horn | Solver::HornExact => body.inputs.surface_lift(index),
        };
        let map: PixelMap2 = lift.map(jacobian);
        let stroke = Stroke {
            center_px: [solved.x_px[index] + self.half_px[0], solved.y_px[index] + self.half_px[1]],
            depth: solved.depth[index],
            angle_rad: seen.angle_rad(index),
            length_px: jittered(length, LENGTH_JITTER),
            width_px: jittered(width, WIDTH_JITTER),
            presence,
            bits,
            body_id: entry.body + 1,
            albedo_srgb8: body.sampled.albedo_srgb8[index],
            normal_in_world: (seen.world_from_model.matrix3 * normal).as_vec3().to_array(),
        };
        let count = body.sampled.particles.len() as f32;
        let source = StrokeSource {
            particle: entry.particle,
            region: u32::from(region),
            kappa: map.kappa() as f32,
            facing,
            rank: (entry.particle as f32 + 0.5) / count,
        };
        Some((stroke, source))
    }
}

impl SeenBody<'_> {
    fn angle_rad(&self, index: usize) -> f32 {
        let Some((reference, now)) = &self.clip_views else { return self.solved.angle_rad[index] };
        let particles = &self.body.sampled.particles;
        let position = |particle: usize| -> DVec3 { particles[particle].position.as_dvec3() };
        let neighbours = self.body.inputs.neighbours.as_ref().map_or(&[][..], |lists| lists.of(index));
        let turn_rad = horn_exact::turn_rad(
            position(index),
            neighbours.iter().map(|&neighbour| position(neighbour as usize)),
            reference,
            now,
        );
        impasto_core::angle::wrap_pi(turn_rad + f64::from(self.body.baked.base_angle_rad[index])) as f32
    }
}
