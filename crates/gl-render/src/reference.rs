//! The reference picture: a plain render with shadows, from which strokes take colour, depth and body.

use std::rc::Rc;

use glam::Vec4;
use half::f16;
use impasto_painting::frame::{FrameBody, FrameView};
use impasto_painting::{Frame, Quality};

use crate::body_program::{BodyProgram, COLOR, set_color};
use crate::gl::{
    DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, Texture, VertexArray,
    Vertices,
};
use crate::keeps::Keeps;
use crate::lens::{LENS_UNIFORMS, LensSetup, VIEW_LENS_UNIFORMS};
use crate::lighting::{LIGHT_UNIFORMS, LightSetup};
use crate::materials::noise_displace::{self, NoiseDisplace};
use crate::meshes::{DrawnBody, MeshCache};
use crate::noise_tiles::NoiseTiles;
use crate::reference_targets::{ReferenceTargets, SURFACE_TEXTURES};
use crate::samples::{SamplePass, Samples};
use crate::shader_files::{REFERENCE, SHARED};
use crate::shadow::ShadowMap;
use crate::styles;
use crate::watch::Watch;

/// The passes, in order: shadow, surface, samples, openness (ambient occlusion), light, then the bodies that are
/// coloured by noise.
pub(crate) struct ReferencePass {
    gpu: Gpu,
    shadow: ShadowMap,
    surface: BodyProgram,
    openness: Program,
    light: Program,
    /// Created when the first picture with several samples in a pixel is drawn.
    samples: Option<SamplePass>,
    /// The samples of the last picture, if its light used them. They can be taken once.
    drawn: Option<Samples>,
    /// Created when the first draft is drawn.
    draft_light: Option<Program>,
    /// Created when it is first wanted.
    light_parts: Option<Program>,
    screen: VertexArray,
    meshes: MeshCache,
    tiles: NoiseTiles,
    noise: NoiseDisplace,
}

impl ReferencePass {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            shadow: ShadowMap::new(gpu)?,
            surface: BodyProgram::new(gpu, FILES, SURFACE)?,
            openness: Program::new(gpu, FILES, &OPENNESS)?,
            light: Program::new(gpu, FILES, &LIGHT)?,
            samples: None,
            drawn: None,
            draft_light: None,
            light_parts: None,
            screen: VertexArray::empty(gpu)?,
            meshes: MeshCache::new(gpu)?,
            tiles: NoiseTiles::new(gpu),
            noise: NoiseDisplace::new(gpu)?,
        })
    }

    /// Draws the reference picture into `targets`. Returns its lights, which also light the strokes.
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        targets: &ReferenceTargets,
        watch: &mut Watch<'_>,
    ) -> Result<LightSetup, Halt> {
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let bodies = self.bodies(frame)?;
        let lights = LightSetup::new(&self.gpu, &frame.lights, &self.shadow)?;
        self.tiles.prepare(frame)?;
        self.shadow.program().prepare(frame)?;
        self.surface.prepare(frame)?;
        if let Some(shadow_from_world) = lights.shadow_from_world() {
            self.shadow.draw(&bodies, shadow_from_world)?;
        }
        watch.passed("shadow")?;
        self.draw_surfaces(frame, &bodies, targets)?;
        watch.passed("surface")?;
        // The pixels of a huge picture are far smaller than a stroke, so its light needs no samples. The samples are
        // then drawn later, when memory is free.
        self.drawn = match styles::samples(frame, self.gpu.limits().max_side_px) {
            per_side if per_side > 1 && !Keeps::is_huge(frame.size_px) => {
                Some(self.ready_samples()?.draw(frame, &bodies, (per_side, true))?)
            }
            _ => None,
        };
        watch.passed("samples")?;

        self.gpu.begin_pass(&targets.unlit()?.openness_pass, DrawState::default());
        let bound = lens
            .set(self.openness.bind(), &VIEW_LENS_UNIFORMS)
            .texture("normal", &targets.normal)
            .texture("depth_and_id", &targets.depth_and_id)
            .set("view_from_world", frame.view.view_from_world);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("openness")?;

        self.gpu.begin_pass(&targets.light_pass, DrawState::default());
        if frame.quality == Quality::Draft {
            self.ready_drafts()?;
        }
        let light = match (frame.quality, &self.draft_light) {
            (Quality::Draft, Some(light)) => light,
            _ => &self.light,
        };
        let bound = targets
            .set(lights.set(lens.set(light.bind(), &LENS_UNIFORMS)))?
            .set("highlight_in_color", styles::highlight_in_color(frame));
        let bound = match &self.drawn {
            // A draft has no samples.
            _ if frame.quality == Quality::Draft => bound,
            Some(Samples { depth_and_id, root_albedo: Some(root_albedo), per_side }) => bound
                .texture("fine", depth_and_id)
                .texture("root_albedo", root_albedo)
                .set("samples", *per_side as i32),
            _ => bound
                .texture("fine", &targets.depth_and_id)
                .texture("root_albedo", &targets.depth_and_id)
                .set("samples", 1),
        };
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("light")?;
        self.noise.draw(frame, &bodies, &self.tiles, targets, watch)?;
        Ok(lights)
    }

    /// The samples of the last picture, which must show this frame; `None` if each pixel has only one sample. Draws the
    /// samples now, unless [`ReferencePass::draw`] has drawn them.
    pub(crate) fn take_samples(
        &mut self,
        frame: &Frame,
        bodies: &[DrawnBody<'_>],
    ) -> Result<Option<Samples>, GlError> {
        if let Some(samples) = self.drawn.take() {
            return Ok(Some(samples));
        }
        match styles::samples(frame, self.gpu.limits().max_side_px) {
            1 => Ok(None),
            per_side => self.ready_samples()?.draw(frame, bodies, (per_side, false)).map(Some),
        }
    }

    pub(crate) fn let_go(&mut self) {
        self.noise.let_go();
        if let Some(samples) = &mut self.samples {
            samples.let_go();
        }
    }

    /// Draws the light on the surfaces of the last picture, without their colours. Returns two lists, bottom row first.
    /// The first is the light that arrives; its last channel is the share of the shadow-casting light that arrives. The
    /// second is how open each place is.
    pub(crate) fn draw_light_parts(
        &mut self,
        frame: &Frame,
        lights: &LightSetup,
        targets: &ReferenceTargets,
    ) -> Result<[Vec<[f16; 4]>; 2], GlError> {
        self.ready_light_parts()?;
        let Some(program) = &self.light_parts else { return Ok(Default::default()) };
        let target =
            || Texture::target(&self.gpu, Format::Rgba16F, frame.size_px, Filter::Nearest).map(Rc::new);
        let pass = Framebuffer::new(&self.gpu, &[&target()?, &target()?], None)?;
        self.gpu.begin_pass(&pass, DrawState::default());
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let bound = targets.set(lights.set(lens.set(program.bind(), &LENS_UNIFORMS)))?;
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        Ok([pass.read_halves(0), pass.read_halves(1)])
    }

    /// Creates all programs at once, also those that are usually created when first needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.ready_samples()?.ready_all()?;
        self.ready_drafts()?;
        self.ready_light_parts()?;
        self.shadow.program().ready_all()?;
        self.surface.ready_all()?;
        self.noise.ready_all()
    }

    fn ready_samples(&mut self) -> Result<&mut SamplePass, GlError> {
        let pass = match self.samples.take() {
            Some(pass) => pass,
            None => SamplePass::new(&self.gpu)?,
        };
        Ok(self.samples.insert(pass))
    }

    fn ready_light_parts(&mut self) -> Result<(), GlError> {
        if self.light_parts.is_none() {
            self.light_parts = Some(Program::new(&self.gpu, FILES, &LIGHT_PARTS)?);
        }
        Ok(())
    }

    fn ready_drafts(&mut self) -> Result<(), GlError> {
        if self.draft_light.is_none() {
            self.draft_light = Some(Program::new(&self.gpu, FILES, &DRAFT_LIGHT)?);
        }
        Ok(())
    }

    /// The shadow map, as it was drawn last.
    pub(crate) fn shadow(&self) -> &ShadowMap {
        &self.shadow
    }

    pub(crate) fn bodies<'a>(&mut self, frame: &'a Frame) -> Result<Vec<DrawnBody<'a>>, GlError> {
        let gpu = self.gpu.clone();
        self.meshes.free_unused();
        frame.bodies.iter().map(|body| self.meshes.drawn(&gpu, body)).collect()
    }

    /// A vertex array of a body in two frames: the inputs of `now`, and the positions of `then` as one more input.
    pub(crate) fn with_then(&mut self, now: &FrameBody, then: &FrameBody) -> Result<VertexArray, GlError> {
        let gpu = self.gpu.clone();
        self.meshes.with_then(&gpu, now, then)
    }

    fn draw_surfaces(
        &self,
        frame: &Frame,
        bodies: &[DrawnBody<'_>],
        targets: &ReferenceTargets,
    ) -> Result<(), GlError> {
        let state = DrawState { depth_test: true, clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.unlit()?.surface_pass, state);
        let view = &frame.view;
        let eye = eye_in_world(view);
        let is_drawn_here = |body: &FrameBody| !body.hidden && !noise_displace::is_coloured(body);
        for (index, DrawnBody { body, mesh, array }) in bodies.iter().enumerate() {
            if !is_drawn_here(body) {
                continue;
            }
            // A draft draws only the triangles that face the eye. They are found on the mesh at rest, so a deformed
            // body is drawn whole. So is a body that the eye may be inside, because there the backs of triangles show.
            let front = match frame.quality {
                Quality::Draft if body.bent.is_none() => {
                    let eye = body.world_from_model.inverse() * eye;
                    let is_outside = mesh.is_outside(eye);
                    is_outside.then(|| mesh.front(&self.gpu, &body.surface, eye)).transpose()?
                }
                _ => None,
            };
            for (number, part) in mesh.parts.iter().enumerate() {
                let material = body.surface.materials.get(part.material);
                let bound = set_color(self.surface.bind(body, part), body, part)
                    .set("view_from_world", view.view_from_world)
                    .set("clip_from_view", view.clip_from_view)
                    .set("body_id", (index + 1) as f32)
                    .set("gloss", material.map_or(0.0, |material| material.gloss))
                    .set("eye", eye);
                let (array, vertices) = match &front {
                    Some((array, ranges)) => {
                        let [first, count] = ranges[number];
                        (&**array, Vertices::Indexed { first, count })
                    }
                    None => (&**array, part.vertices()),
                };
                self.gpu.draw(bound, array, vertices)?;
            }
        }
        Ok(())
    }
}

/// The eye in world space; with parallel rays, the direction towards it, and w is 0.
fn eye_in_world(view: &FrameView) -> Vec4 {
    if view.orthographic {
        view.view_from_world.inverse().z_axis.truncate().extend(0.0)
    } else {
        view.eye_in_world.extend(1.0)
    }
}

const FILES: &[&[crate::gl::ShaderFile]] = &[SHARED, REFERENCE];

const SURFACE: ProgramSource<'static> = ProgramSource::new(
    "reference/surface.vert",
    Some("reference/surface.frag"),
    &[&["view_from_world", "clip_from_view", "body_id", "gloss", "eye"], &COLOR],
);

const OPENNESS: ProgramSource<'static> = ProgramSource::screen(
    "reference/openness.frag",
    &[&VIEW_LENS_UNIFORMS, &["normal", "depth_and_id", "view_from_world"]],
);

const LIGHT: ProgramSource<'static> = ProgramSource {
    uniforms: &[
        &LENS_UNIFORMS,
        &LIGHT_UNIFORMS,
        &SURFACE_TEXTURES,
        &["highlight_in_color", "fine", "root_albedo", "samples"],
    ],
    defined: &[],
    ..DRAFT_LIGHT
};

const DRAFT_LIGHT: ProgramSource<'static> = ProgramSource {
    defined: &["DRAFT"],
    ..ProgramSource::screen(
        "reference/light.frag",
        &[&LENS_UNIFORMS, &LIGHT_UNIFORMS, &SURFACE_TEXTURES, &["highlight_in_color"]],
    )
};

const LIGHT_PARTS: ProgramSource<'static> = ProgramSource::screen(
    "reference/light_parts.frag",
    &[&LENS_UNIFORMS, &LIGHT_UNIFORMS, &SURFACE_TEXTURES],
);
