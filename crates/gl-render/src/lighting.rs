//! The lights of a frame as shaders read them: the uniforms of `reference/lighting.glsl`.

use std::rc::Rc;

use glam::{Mat4, Vec2, Vec3, Vec4};
use impasto_painting::frame::{Cone, FrameLights};

use crate::gl::{Bound, Format, GlError, Gpu, Texture};
use crate::shadow::{ShadowMap, Sight};

/// The uniforms of `reference/lighting.glsl`.
pub(crate) const LIGHT_UNIFORMS: [&str; 9] = [
    "lights",
    "light_count",
    "shadowed_light",
    "shadow_depth",
    "shadow_from_world",
    "shadow_texel",
    "shadow_bias",
    "ambient_above",
    "ambient_below",
];

/// Rows of the texture of lights.
const ROWS: usize = 3;

/// The three texels that describe a light to shaders. The first is its direction (w 0) or place (w 1). The second is
/// its radiance and the slope of its cone. The third is the cone's axis and offset. A cone lets
/// (slope · cosine + offset)² through, with the bracket clamped to 0..=1 (KHR_lights_punctual). Without a cone, this
/// factor is 1.
fn column(place: Vec4, radiance: Vec3, cone: Option<&Cone>) -> [Vec4; ROWS] {
    let Some(cone) = cone else { return [place, radiance.extend(0.0), Vec4::W] };
    let slope = 1.0 / (cone.inner_cosine - cone.outer_cosine).max(1e-3);
    [place, radiance.extend(slope), cone.axis.extend(-cone.outer_cosine * slope)]
}

/// The values of [`LIGHT_UNIFORMS`] in one frame.
pub(crate) struct LightSetup {
    /// A column for each light: see [`column`].
    lights: Texture,
    light_count: i32,
    /// Index of the light that casts shadows; −1 without one.
    shadowed_light: i32,
    shadow_depth: Rc<Texture>,
    sight: Sight,
    ambient_above: Vec3,
    ambient_below: Vec3,
}

impl LightSetup {
    pub(crate) fn new(gpu: &Gpu, lights: &FrameLights, shadow: &ShadowMap) -> Result<Self, GlError> {
        let suns = lights.suns.iter().map(|sun| column(sun.to_light.extend(0.0), sun.radiance, None));
        let points = lights
            .points
            .iter()
            .map(|point| column(point.position.extend(1.0), point.radiance, point.cone.as_ref()));
        let all: Vec<[Vec4; ROWS]> = suns.chain(points).collect();
        let (count, columns) = (all.len(), all.len().max(1));
        let mut texels = vec![[0.0f32; 4]; ROWS * columns];
        for (index, of_light) in all.iter().enumerate() {
            for (row, value) in of_light.iter().enumerate() {
                texels[row * columns + index] = value.to_array();
            }
        }
        let size_px = [columns as u32, ROWS as u32];
        let (center, radius) = lights.shadow_bounds;
        let lamp = lights.shadow_lamp.filter(|_| lights.suns.is_empty());
        let sight = match lamp.and_then(|lamp| lights.points.get(lamp)) {
            Some(lamp) => Sight::of_lamp(center, radius, lamp),
            None => Sight::of_sun(center, radius, lights.suns.first().map_or(Vec3::Y, |sun| sun.to_light)),
        };
        Ok(Self {
            lights: Texture::from_texels(gpu, Format::Rgba32F, size_px, bytemuck::cast_slice(&texels))?,
            light_count: count as i32,
            shadowed_light: match lamp {
                // The texture lists suns before lamps. Without suns, a lamp's column is its index in `points`.
                Some(lamp) => lamp as i32,
                None => lights.suns.first().map_or(-1, |_| 0),
            },
            shadow_depth: Rc::clone(shadow.depth()),
            sight,
            ambient_above: lights.ambient_above,
            ambient_below: lights.ambient_below,
        })
    }

    /// From world space to the clip space of the shadow map; `None` where no light casts shadows.
    pub(crate) fn shadow_from_world(&self) -> Option<Mat4> {
        (self.shadowed_light >= 0).then_some(self.sight.shadow_from_world)
    }

    pub(crate) fn set<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound
            .texture("lights", &self.lights)
            .set("light_count", self.light_count)
            .set("shadowed_light", self.shadowed_light)
            .texture("shadow_depth", &self.shadow_depth)
            .set("shadow_from_world", self.sight.shadow_from_world)
            .set("shadow_texel", self.sight.texel)
            .set("shadow_bias", Vec2::from(self.sight.bias))
            .set("ambient_above", self.ambient_above)
            .set("ambient_below", self.ambient_below)
    }
}
