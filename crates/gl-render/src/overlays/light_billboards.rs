//! Draws the lights of a scene as icons that face the camera, over the picture in an editor's view.
//!
//! The corners of a quad (its centre ± the camera's right ± the camera's up) are uniforms, so no buffer is read. The
//! vertex shader picks a corner by `gl_VertexID`; the fragment shader finds texture coordinates by inverse bilinear
//! interpolation.

mod icons;

use glam::{DVec3, Mat4, Vec3, Vec4};
use impasto_painting::frame::FrameView;

use crate::gl::{
    Blend, DrawState, Format, Framebuffer, GlError, Gpu, Program, ProgramSource, Texture, VertexArray,
    Vertices,
};
use crate::shader_files::{LIGHT_BILLBOARDS, SHARED};

/// A picture that stands at a place and faces the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBillboard {
    /// Its centre, in the scene's own world space.
    pub position: DVec3,
    /// What it shows.
    pub icon: BillboardIcon,
    /// How large it is.
    pub size: BillboardSize,
    /// Encoded sRGB and straight alpha, 0..=1.
    pub ink: [f32; 4],
}

/// What a billboard shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BillboardIcon {
    /// A disc with rays: light from far away.
    Sun,
    /// A bulb: light from a point.
    Point,
    /// A dome over a line: light from all around.
    Ambient,
    /// A thin circle, as wide as the billboard.
    Ring,
}

/// How large a billboard is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BillboardSize {
    /// Half its side in world units: in perspective, the farther away it is, the smaller it looks.
    World(f32),
    /// Half its side in pixels, wherever it stands.
    Pixels(f32),
}

impl LightBillboard {
    /// Its corners in the frame's world space at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1), in a picture of this
    /// height. `None` if it is nearer than the near plane or has no size, so that nothing shows.
    pub fn corners(&self, view: &FrameView, height_px: u32) -> Option<[Vec3; 4]> {
        let depth = -view.view_from_world.transform_point3(self.seen_from(view)).z;
        let half = match self.size {
            BillboardSize::World(half) => half,
            BillboardSize::Pixels(half_px) => half_px * self.units_per_px(view, height_px),
        };
        if !(depth > view.near_far[0] && half.is_finite() && half > 0.0) {
            return None;
        }
        let [right, up] = camera_axes(view).map(|axis| axis * half);
        let center = self.seen_from(view);
        Some([center - right - up, center + right - up, center - right + up, center + right + up])
    }

    /// Its centre in the frame's world space, whose origin is [`FrameView::origin_in_world`].
    fn seen_from(&self, view: &FrameView) -> Vec3 {
        (self.position - view.origin_in_world).as_vec3()
    }

    /// Half its side in pixels.
    fn half_px(&self, view: &FrameView, height_px: u32) -> f32 {
        match self.size {
            BillboardSize::World(half) => half / self.units_per_px(view, height_px),
            BillboardSize::Pixels(half_px) => half_px,
        }
    }

    fn units_per_px(&self, view: &FrameView, height_px: u32) -> f32 {
        let depth = -view.view_from_world.transform_point3(self.seen_from(view)).z;
        let px_per_unit = view.clip_from_view.y_axis.y * 0.5 * height_px as f32;
        if view.orthographic { 1.0 / px_per_unit } else { depth / px_per_unit }
    }
}

/// The camera's right and up in world space, unit.
fn camera_axes(view: &FrameView) -> [Vec3; 2] {
    [view.view_from_world.row(0), view.view_from_world.row(1)].map(|row| row.truncate())
}

const BILLBOARD: ProgramSource = ProgramSource::new(
    "light_billboards/billboard.vert",
    Some("light_billboards/billboard.frag"),
    &[&[
        "corner_00",
        "corner_01",
        "corner_10",
        "corner_11",
        "camera_right",
        "camera_up",
        "clip_from_world",
        "icons",
        "depth_and_id",
        "icon",
        "px",
        "pieces",
        "ink",
        "depth",
        "softness",
    ]],
);

/// A ring is drawn as this many straight pieces.
const RING_PIECES: u32 = 64;

/// An icon behind a surface is dimmed. It is dimmed fully if it lies this share of its depth behind the surface.
const SOFTNESS: f32 = 0.03;

pub(crate) struct LightBillboards {
    gpu: Gpu,
    program: Program,
    icons: Texture,
    /// No inputs: corners are uniforms.
    no_vertices: VertexArray,
}

impl LightBillboards {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let side = icons::SIDE as u32;
        Ok(Self {
            gpu: gpu.clone(),
            program: Program::new(gpu, &[SHARED, LIGHT_BILLBOARDS], &BILLBOARD)?,
            icons: Texture::array_with_levels(
                gpu,
                Format::Rgba8,
                [side, side, icons::COUNT],
                &icons::levels(),
            )?,
            no_vertices: VertexArray::empty(gpu)?,
        })
    }

    /// Draws billboards over the picture in `output`, the farthest first. `depth_and_id` is the reference pass's
    /// texture: behind the surfaces in it, billboards are dimmed.
    pub(crate) fn draw(
        &self,
        billboards: &[LightBillboard],
        view: &FrameView,
        output: &Framebuffer,
        depth_and_id: &Texture,
    ) -> Result<(), GlError> {
        let mut seen: Vec<(f32, &LightBillboard, [Vec3; 4])> = billboards
            .iter()
            .filter_map(|billboard| {
                let depth = -view.view_from_world.transform_point3(billboard.seen_from(view)).z;
                Some((depth, billboard, billboard.corners(view, output.size_px()[1])?))
            })
            .collect();
        seen.sort_by(|a, b| b.0.total_cmp(&a.0));
        let clip_from_world: Mat4 = view.clip_from_view * view.view_from_world;
        let [right, up] = camera_axes(view);
        self.gpu.begin_pass(output, DrawState { blend: Blend::Over, ..DrawState::default() });
        for (depth, billboard, corners) in seen {
            let instances = if billboard.icon == BillboardIcon::Ring { RING_PIECES } else { 1 };
            let bound = self
                .program
                .bind()
                .set("corner_00", corners[0])
                .set("corner_10", corners[1])
                .set("corner_01", corners[2])
                .set("corner_11", corners[3])
                .set("camera_right", right)
                .set("camera_up", up)
                .set("clip_from_world", clip_from_world)
                .texture("icons", &self.icons)
                .texture("depth_and_id", depth_and_id)
                .set("icon", billboard.icon.layer())
                .set("px", 1.0 / billboard.half_px(view, output.size_px()[1]))
                .set("pieces", RING_PIECES as f32)
                .set("ink", Vec4::from(billboard.ink))
                .set("depth", depth)
                .set("softness", SOFTNESS * depth);
            self.gpu.draw(bound, &self.no_vertices, Vertices::Quads { instances })?;
        }
        Ok(())
    }
}

impl BillboardIcon {
    /// Layer of the icon texture; −1 for shapes that have none.
    fn layer(self) -> f32 {
        match self {
            Self::Sun => 0.0,
            Self::Point => 1.0,
            Self::Ambient => 2.0,
            Self::Ring => -1.0,
        }
    }
}
