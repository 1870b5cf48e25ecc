//! Light and colour of a new scene: a strong side light, a cool fill and a warm bounce, stronger for dark models; a
//! ground that goes with the model's colour; and a colour for models that have none.

use impasto_core::color::{linear_from_srgb, oklab_from_linear, srgb_from_linear};
use impasto_core::hash;

use super::axes::Axes;
use super::{light, round_to, significant};
use crate::document::{Color, Light, LightKind};
use crate::mesh_file::{Material, MeshFile, Texture};
use glam::DVec3;

/// The grey of faces without a material; exporters write it too where nobody has chosen a colour.
const NO_COLOR: [f32; 3] = [0.8; 3];

/// The light that a well lit middle tone should reflect, and the most that lighter tones should. Both are before the
/// soft shoulder of the reference render.
const BODY_LIGHT: f64 = 0.52;
const MOST_BODY_LIGHT: f64 = 0.66;
/// The light that the floor should reflect: under a light model, and under a dark one.
const FLOOR_LIGHT: f64 = 0.15;
const PALE_FLOOR_LIGHT: f64 = 0.28;

/// Exposure of the reference render; `lighting.glsl` has the same number.
const EXPOSURE: f64 = 0.62;

/// The albedo of a middle tone, and bounds of the strength of all light together.
const MIDDLE: f64 = 0.25;
const LEAST_LIGHT: f64 = 1.0;
const MOST_LIGHT: f64 = 9.0;

/// Factors on `Scheme::light`: for the light from one side, from the sky, and back from the floor.
const KEY: f64 = 0.92;
const SKY: f64 = 0.10;
const BOUNCE: f64 = 0.08;

/// Body and ground that go together: lightness, chroma and hue (degrees) in Oklab.
const HARMONIES: [[[f32; 3]; 2]; 8] = [
    // Terracotta on blue grey, ochre on plum grey, sage on brick, slate blue on straw.
    [[0.60, 0.085, 45.0], [0.58, 0.024, 225.0]],
    [[0.66, 0.075, 80.0], [0.54, 0.028, 320.0]],
    [[0.62, 0.050, 125.0], [0.55, 0.036, 40.0]],
    [[0.60, 0.045, 250.0], [0.58, 0.036, 75.0]],
    // Rose clay on moss grey, verdigris on umber, ivory on bottle green, mauve on sand.
    [[0.63, 0.060, 25.0], [0.56, 0.026, 140.0]],
    [[0.59, 0.045, 190.0], [0.54, 0.038, 50.0]],
    [[0.72, 0.040, 85.0], [0.50, 0.026, 165.0]],
    [[0.59, 0.042, 305.0], [0.60, 0.034, 88.0]],
];

/// Steps by which the colours of groups differ: in hue, degrees, and in Oklab lightness.
const GROUP_HUE_DEG: f32 = 16.0;
const GROUP_LIGHTNESS: f32 = 0.05;

/// The chroma of a ground under a model with colours of its own.
const GROUND_CHROMA: f32 = 0.035;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scheme {
    /// The colour of the model, from which [`Self::of_group`] makes those of its groups: lightness, chroma and hue
    /// (degrees) in Oklab. `None` if the model has colours of its own.
    pub body: Option<[f32; 3]>,
    /// The colour of floor and wall.
    pub ground: Color,
    /// The strength of all light together, in units of a sun of intensity 1.
    light: f64,
}

impl Scheme {
    /// The scheme of a model; `name_hash` chooses among harmonies.
    pub fn of(meshes: &[&MeshFile], name_hash: u32) -> Self {
        let [own, ground] = HARMONIES[name_hash as usize % HARMONIES.len()];
        if meshes.iter().all(|mesh| has_no_color(mesh)) {
            let albedo = luminance(linear(own));
            return Self::lit(Some(own), ground, [albedo, albedo]);
        }
        let mut colors: Vec<([f32; 3], f64)> = meshes.iter().flat_map(|mesh| colors_of(mesh)).collect();
        if colors.is_empty() {
            colors.push((NO_COLOR.map(linear_from_srgb), 1.0));
        }
        let total: f64 = colors.iter().map(|(_, area)| area).sum();
        let mut mean = [0.0f32; 3];
        for (color, area) in &colors {
            mean = std::array::from_fn(|channel| mean[channel] + color[channel] * (area / total) as f32);
        }
        let [_, a, b] = oklab_from_linear(mean);
        let chroma = a.hypot(b);
        let hue = if chroma > 0.012 { b.atan2(a).to_degrees() + 180.0 } else { ground[2] };
        // `high` is a luminance that must not burn out: only the lightest twentieth of the surface is lighter.
        let mut values: Vec<(f64, f64)> =
            colors.iter().map(|&(color, area)| (luminance(color), area)).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut covered = 0.0;
        let high = values.iter().find(|(_, area)| {
            covered += area;
            covered >= 0.95 * total
        });
        let high = high.map_or(MIDDLE, |&(value, _)| value);
        Self::lit(None, [0.58, GROUND_CHROMA, hue], [luminance(mean), high])
    }

    /// The scheme for a body and a ground (lightness, chroma and hue), and for the mean and a high albedo of the model.
    /// The ground's lightness follows from the light; the lightness in `ground` is not used.
    fn lit(body: Option<[f32; 3]>, ground: [f32; 3], [mean, high]: [f64; 2]) -> Self {
        let high = high.max(1e-3);
        // A dark model stays darker than a light one, but by less than its albedo says.
        let wanted = (BODY_LIGHT * (high / MIDDLE).powf(0.4)).min(MOST_BODY_LIGHT);
        let light = (wanted / (EXPOSURE * high)).clamp(LEAST_LIGHT, MOST_LIGHT);
        let reflected = EXPOSURE * light * mean;
        let floor_light = if reflected < 0.3 { PALE_FLOOR_LIGHT } else { FLOOR_LIGHT };
        // The light from one side falls on the floor at a slant, which leaves 0.58 of it.
        let albedo = floor_light / (EXPOSURE * light * (0.58 * KEY + SKY));
        Self { body, ground: srgb(of_luminance(ground, albedo)), light }
    }

    pub fn of_group(body: [f32; 3], group: usize) -> Color {
        // The steps of the groups: 0, 1, −1, 2, −2, …
        let step = group.div_ceil(2) as f32 * if group % 2 == 1 { 1.0 } else { -1.0 };
        let [lightness, chroma, hue] = body;
        let lighter = if group % 3 == 1 {
            1.0
        } else if group % 3 == 2 {
            -1.0
        } else {
            0.0
        };
        srgb(linear([
            lightness + GROUP_LIGHTNESS * lighter,
            chroma,
            hue + GROUP_HUE_DEG * step.clamp(-4.0, 4.0),
        ]))
    }

    /// The colour that shows between strokes: that of the ground in shadow.
    pub fn background(&self) -> Color {
        let reflected = EXPOSURE * self.light * (0.25 * KEY + SKY);
        srgb(self.ground.0.map(|channel| linear_from_srgb(channel) * reflected as f32))
    }

    /// The colour of a plain background: that of the lit floor.
    pub fn plain_ground(&self) -> Color {
        let reflected = EXPOSURE * self.light * (0.58 * KEY + SKY);
        srgb(self.ground.0.map(|channel| (linear_from_srgb(channel) * reflected as f32).min(0.8)))
    }

    /// The lights, for a camera with these axes. The sun's light goes to the right of the picture if `light_goes` is 1,
    /// to the left if it is −1.
    pub fn lights(&self, axes: Axes, light_goes: f64) -> Vec<Light> {
        let from_sun = round_to(axes.to_world(from_sun(light_goes)), 1e-3);
        let sun = Light {
            direction: Some(from_sun.to_array()),
            ..light("sun", LightKind::Sun, "#fff0dc", significant(self.light * KEY))
        };
        let sky = self.light * SKY;
        let bounce = of_luminance([0.6, 0.06, 60.0], BOUNCE / SKY);
        let fill = Light {
            ground: Some(srgb(bounce)),
            ..light("sky", LightKind::Ambient, "#cfdcf2", significant(sky * 1.35))
        };
        vec![sun, fill]
    }
}

/// The direction of the sun's light in the camera's axes.
pub(super) fn from_sun(light_goes: f64) -> DVec3 {
    DVec3::new(0.75 * light_goes, -0.56, -0.34)
}

/// Whether no face has a colour that somebody chose.
pub(super) fn has_no_color(mesh: &MeshFile) -> bool {
    used(mesh).all(|(material, _)| material.texture.is_none() && material.color == NO_COLOR)
}

/// The materials that faces use, each with twice the area of its faces: only ratios of areas are used.
fn used(mesh: &MeshFile) -> impl Iterator<Item = (&Material, f64)> {
    let mut areas = vec![0.0f64; mesh.materials.len()];
    for (triangle, &material) in mesh.mesh.material_of_triangle.iter().enumerate() {
        let [a, b, c] = mesh.mesh.corners(triangle).map(|corner| corner.as_dvec3());
        if let Some(area) = areas.get_mut(material as usize) {
            *area += (b - a).cross(c - a).length();
        }
    }
    mesh.materials.iter().zip(areas).filter(|(_, area)| *area > 0.0)
}

/// Linear colours of the surface, each with the area that it covers. A texture gives the colours of its pixels.
fn colors_of(mesh: &MeshFile) -> Vec<([f32; 3], f64)> {
    let mut colors = Vec::new();
    for (material, area) in used(mesh) {
        let own = material.color.map(linear_from_srgb);
        let Some(texture) = &material.texture else {
            colors.push((own, area));
            continue;
        };
        let pixels = pixels_of(texture);
        for pixel in &pixels {
            colors.push((
                std::array::from_fn(|channel| own[channel] * pixel[channel]),
                area / pixels.len() as f64,
            ));
        }
    }
    colors
}

/// A few hundred pixels of a picture, linear.
fn pixels_of(texture: &Texture) -> Vec<[f32; 3]> {
    let step = (texture.rgba8.len() / 400).max(1);
    let linear = |[r, g, b, _]: &[u8; 4]| [r, g, b].map(|byte| linear_from_srgb(f32::from(*byte) / 255.0));
    texture.rgba8.iter().step_by(step).map(linear).collect()
}

fn luminance([r, g, b]: [f32; 3]) -> f64 {
    f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b)
}

/// Linear colour of a lightness, chroma and hue (degrees) in Oklab (Ottosson 2020).
fn linear([lightness, chroma, hue_deg]: [f32; 3]) -> [f32; 3] {
    let (sin, cos) = hue_deg.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let m = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let s = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
    .map(|channel| channel.clamp(0.0, 1.0))
}

/// The linear colour with this chroma and hue whose luminance is `wanted`.
fn of_luminance([_, chroma, hue]: [f32; 3], wanted: f64) -> [f32; 3] {
    let (mut low, mut high) = (0.0f32, 1.0f32);
    for _ in 0..24 {
        let middle = (low + high) / 2.0;
        // Dark colours get less chroma.
        let color = linear([middle, chroma * middle.min(0.6) / 0.6, hue]);
        if luminance(color) < wanted { low = middle } else { high = middle }
    }
    linear([high, chroma * high.min(0.6) / 0.6, hue])
}

/// A colour of a scene file, 8 bits a channel as it is saved.
fn srgb(linear: [f32; 3]) -> Color {
    Color::from_bytes(linear.map(|channel| (srgb_from_linear(channel) * 255.0).round() as u8))
}

/// The hash of a model's name, which chooses its harmony, the scene's seed and how the wall's strokes lean.
pub(super) fn name_hash(name: &str) -> u32 {
    hash::of_name(name)
}
