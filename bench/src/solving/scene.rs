//! A body in two views: the input of all contenders that solve for angles, and the sums that their answers are checked
//! against.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use glam::{DAffine3, DMat4, DVec2, DVec3, Vec3};
use impasto_core::ScreenMap;
use impasto_core::hash;
use impasto_core::horn_exact::{self, ClipView};
use impasto_core::lift::Lift;
use impasto_core::screen_map::PixelLens;
use impasto_core::solve::BakedParticles;
use impasto_scene::document::Lens;
use impasto_scene::motion::camera_at;
use rayon::prelude::*;

use crate::inputs::{Cloud, Inputs};
use crate::morton;
use crate::neighbours;
use crate::peers::files;

/// Number of neighbours of each particle.
pub const K: usize = 48;

/// Baked particles, and the view of a frame.
pub type Facing = (BakedParticles, ScreenMap);

/// A body in Morton order.
pub struct SolveScene {
    /// Positions, model space.
    pub positions: Vec<Vec3>,
    /// Positions in the reference picture, pixels.
    pub reference_px: Vec<[f32; 2]>,
    /// [`K`] neighbours of each particle. If it has fewer, the rest of its list names the particle itself. The offset
    /// of 0 then adds nothing to a sum, except where the sum's origin is moved to the mean.
    pub lists: Vec<u32>,
    /// The input of our solve.
    pub baked: BakedParticles,
    reference: ScreenMap,
    /// The view of this frame.
    pub now: ScreenMap,
}

/// The first and the last view of the paper's largest scene.
pub fn views(inputs: &mut Inputs) -> anyhow::Result<(ScreenMap, ScreenMap)> {
    let scene = &inputs.scene("simple_objects")?.scene;
    let view = |frame: i64| {
        let pose = camera_at(scene, frame as f64);
        let Lens::Perspective { fov_y_deg, .. } = pose.lens else { return None };
        let focal_px = 0.5 * f64::from(scene.size.1) / (0.5 * fov_y_deg.to_radians()).tan();
        let lens = PixelLens::Perspective { focal_px };
        Some(ScreenMap::new(pose.view_from_world(), DAffine3::IDENTITY, lens))
    };
    view(scene.timeline.first).zip(view(scene.timeline.last)).context("the scene has a perspective lens")
}

/// Particles, each with the lift that a reference gives whose camera looks straight at the particle. That lift needs no
/// neighbours.
pub fn facing(cloud: &Cloud, reference: &ScreenMap) -> BakedParticles {
    let mut baked = BakedParticles::default();
    for (position, normal) in cloud.positions.iter().zip(&cloud.normals) {
        let (position, normal) = (position.as_dvec3(), normal.as_dvec3());
        let px_per_unit = reference.jacobian(position)[0].length();
        baked.push(position, normal, Lift::facing_view(normal, DVec3::Y, 0.0, px_per_unit));
    }
    baked
}

/// The file of a peer's answer.
pub fn answer(folder: &Path) -> PathBuf {
    folder.join("solve.angles")
}

impl SolveScene {
    /// A body in two views, with its lists and lifts.
    pub fn new(cloud: &Cloud, reference: ScreenMap, now: ScreenMap) -> anyhow::Result<Self> {
        let order = morton::order(&cloud.positions);
        let positions: Vec<Vec3> = order.iter().map(|&index| cloud.positions[index as usize]).collect();
        let normals: Vec<Vec3> = order.iter().map(|&index| cloud.normals[index as usize]).collect();
        let found = neighbours::find(&positions, cloud.radius_for(80.0));
        let lists: Vec<u32> = (0..positions.len())
            .flat_map(|particle| {
                let list = found.of(particle);
                (0..K).map(move |index| list.get(index).copied().unwrap_or(particle as u32))
            })
            .collect();
        drop(found);
        let reference_px: Vec<[f32; 2]> = positions
            .par_iter()
            .map(|position| reference.project(position.as_dvec3()).as_vec2().to_array())
            .collect();
        let lift = |particle: usize| {
            let offset = |&other: &u32| {
                let d = positions[other as usize].as_dvec3() - positions[particle].as_dvec3();
                let p = px(reference_px[other as usize]) - px(reference_px[particle]);
                (d, p)
            };
            Lift::horn(
                lists[K * particle..][..K].iter().filter(|&&other| other as usize != particle).map(offset),
            )
        };
        let lifts: Vec<Option<Lift>> = (0..positions.len()).into_par_iter().map(lift).collect();
        let mut baked = BakedParticles::default();
        for (particle, lift) in lifts.into_iter().enumerate() {
            let lift = lift.with_context(|| format!("particle {particle} has too few neighbours"))?;
            baked.push(positions[particle].as_dvec3(), normals[particle].as_dvec3(), lift);
        }
        Ok(Self { positions, reference_px, lists, baked, reference, now })
    }

    /// Writes the peers' inputs; returns their arguments.
    pub fn write(&self, folder: &Path) -> anyhow::Result<Vec<String>> {
        let [positions, reference, lists, rows] =
            ["positions", "reference", "lists", "rows"].map(|name| folder.join(format!("solve.{name}")));
        files::write_floats(&positions, self.positions.iter().flat_map(|position| position.to_array()))?;
        files::write_floats(&reference, self.reference_px.iter().flatten().copied())?;
        files::write_words(&lists, self.lists.iter().copied())?;
        files::write_floats(&rows, self.rows().into_iter().flatten())?;
        let files = [positions, reference, lists, rows, answer(folder)];
        Ok(files.map(|file| file.to_string_lossy().into_owned()).to_vec())
    }

    /// The rows of this frame's screen map: numerators of x and y, and the denominator of both.
    pub fn rows(&self) -> [[f32; 4]; 3] {
        [self.now.row_x, self.now.row_y, self.now.row_w].map(|row| row.as_vec4().to_array())
    }

    /// The angle of each particle, computed by `angle`. This function gets the particle's index and, for each of its
    /// neighbours, the offset p in the reference, the offset c in this picture, and the weight w.
    fn angles(&self, angle: impl Fn(usize, &[(DVec2, DVec2, f64)]) -> f64 + Sync) -> Vec<f32> {
        let one = |particle: usize| {
            let position = |index: usize| self.positions[index].as_dvec3();
            let (then, now) = (px(self.reference_px[particle]), self.now.project(position(particle)));
            let depth = self.now.depth(position(particle));
            let pair = |&other: &u32| {
                let other = other as usize;
                let p = px(self.reference_px[other]) - then;
                (p, self.now.project(position(other)) - now, self.now.depth(position(other)) / depth)
            };
            let pairs: Vec<(DVec2, DVec2, f64)> = self.lists[K * particle..][..K].iter().map(pair).collect();
            angle(particle, &pairs) as f32
        };
        (0..self.positions.len()).into_par_iter().map(one).collect()
    }

    /// The angles of the sum with the weights w = z_neighbour / z_stroke. Our solve gives the same angles in closed
    /// form.
    pub fn weighted(&self) -> Vec<f32> {
        self.angles(|_, pairs| turn_of(pairs.iter().map(|&(p, c, weight)| (p, c * weight))))
    }

    /// The angles of the sum with p and c measured from their means over the neighbours.
    pub fn centred(&self) -> Vec<f32> {
        self.angles(|_, pairs| {
            let count = pairs.len() as f64;
            let p_mean = pairs.iter().map(|(p, ..)| *p).sum::<DVec2>() / count;
            let c_mean = pairs.iter().map(|(_, c, _)| *c).sum::<DVec2>() / count;
            turn_of(pairs.iter().map(|&(p, c, _)| (p - p_mean, c - c_mean)))
        })
    }

    /// Checks for a sample of particles that the given angles, computed by `gather.rs`, equal those of the paper's
    /// formula with matrices, in double precision.
    pub fn check_by_matrices(&self, angles_rad: &[f32]) -> anyhow::Result<()> {
        let clip = |map: &ScreenMap| ClipView {
            // The rows give pixels from the centre, which in a picture of 2 × 2 pixels are clip coordinates.
            clip_from_model: DMat4::from_cols(map.row_x, map.row_y, map.row_depth, map.row_w).transpose(),
            size_px: DVec2::splat(2.0),
        };
        let (reference, now) = (clip(&self.reference), clip(&self.now));
        let mut far = 0;
        for sample in 0..1000 {
            let particle = hash::scramble(sample) as usize % self.positions.len();
            let position = |index: usize| self.positions[index].as_dvec3();
            let others = self.lists[K * particle..][..K].iter().map(|&other| [position(other as usize); 2]);
            let expected = horn_exact::turn_rad([position(particle); 2], others, &reference, &now);
            let apart = impasto_core::angle::wrap_pi(expected - f64::from(angles_rad[particle]));
            far += usize::from(apart.abs() > 0.02f64.to_radians());
        }
        ensure!(far <= 10, "{far} of 1000 angles differ by more than 0.02°");
        Ok(())
    }
}

fn px(pixels: [f32; 2]) -> DVec2 {
    DVec2::from_array(pixels.map(f64::from))
}

fn turn_of(pairs: impl Iterator<Item = (DVec2, DVec2)>) -> f64 {
    let sum = pairs.fold(DVec2::ZERO, |sum, (p, c)| sum + DVec2::new(p.dot(c), p.perp_dot(c)));
    sum.y.atan2(sum.x)
}
