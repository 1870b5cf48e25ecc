//! One frame of a painting: a pure function of the painting, the camera, the frame number and the options.

use std::sync::Arc;

use glam::DAffine3;
use impasto_scene::built_in_mesh;
use impasto_scene::motion::{self, CameraPose};

use crate::frame::{Frame, FrameBody, LayerKind, Lines, Strokes};
use crate::frame_options::FrameOptions;
use crate::lights;
use crate::painting::Painting;
use crate::recall::Recall;
use crate::view::PictureView;

impl Painting {
    /// The painting at a frame of its timeline, through its camera; the frame number may be a fraction.
    pub fn at(&self, frame: f64, options: &FrameOptions) -> Frame {
        self.seen_by(&motion::camera_at(self.scene(), frame), frame, options)
    }

    /// The painting at a frame of its timeline, through any camera.
    pub fn seen_by(&self, camera: &CameraPose, frame: f64, options: &FrameOptions) -> Frame {
        let mut bare = self.bare(camera, frame, options);
        bare.lay(self.strokes(camera, frame, options, None));
        bare
    }

    /// As [`Painting::seen_by`], without strokes: enough for a renderer to begin with.
    pub fn bare(&self, camera: &CameraPose, frame: f64, options: &FrameOptions) -> Frame {
        let scene = self.scene();
        let view = PictureView { pose: camera.clone(), size_px: options.size_px };
        let poses = motion::poses_at(scene, frame);
        let bent = self.bent_at(frame);
        let of_shot = scene.stage.shot.as_ref().map_or(0.0, |shot| shot.exposure_stops());
        let noises = self.noises_at(frame);
        let hidden = motion::hidden_at(scene, frame);
        let near = |pose: DAffine3| DAffine3 { translation: pose.translation - self.origin_in_world, ..pose };
        Frame {
            size_px: options.size_px,
            px_scale: self.px_scale(options),
            view: view.frame_view(self.origin_in_world),
            background: (!options.transparent).then(|| lights::linear(motion::background_at(scene, frame))),
            lights: lights::resolve(scene, frame, self.shadow_bounds, self.origin_in_world),
            bodies: self
                .bodies
                .iter()
                .zip(poses.iter().zip(noises).zip(&*bent))
                .zip(scene.objects.iter().zip(hidden))
                .map(|((body, ((&pose, noise), bent)), (object, hidden))| FrameBody {
                    is_backdrop: built_in_mesh::ALL.contains(&object.mesh.as_str()),
                    surface: Arc::clone(&body.surface),
                    world_from_model: glam::Mat4::from(near(pose).as_affine3()),
                    bent: bent.clone(),
                    noise,
                    hidden,
                })
                .collect(),
            strokes: Vec::new(),
            sources: Vec::new(),
            layers: Vec::new(),
            lines: Lines::default(),
            brushes: Arc::clone(&self.brushes),
            palettes: self.palettes_at(frame),
            finish: self.finish.at(&view, f64::from(options.shot_height_px()), options.keep_stroke_px),
            style: self.style.clone(),
            has_highlight_strokes: self.coats.iter().any(|coat| coat.kind == LayerKind::Lights),
            quality: options.quality,
            exposure: (options.exposure_stops + of_shot).exp2(),
        }
    }

    /// The strokes of [`Painting::seen_by`]. With a [`Recall`] of an earlier picture, only those that were present in
    /// it, and a changing share of the others.
    pub fn strokes(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        recall: Option<&Recall>,
    ) -> Strokes {
        if !self.style.settings().preparation().has_strokes {
            return Strokes::default();
        }
        let mut view = self.view(camera, frame, options, |_| true);
        view.recall = recall.filter(|recall| recall.is_of(self));
        let mut strokes = view.strokes();
        if self.has_touches() {
            view.lay_touches(&mut strokes);
        }
        strokes
    }
}
