//! The lights of a shot, with an exposure that brings them to the scale of a scene's lights.

use glam::DVec3;
use impasto_core::color::{linear_from_srgb, srgb_from_linear};
use impasto_gltf::{LightKind as ShotKind, LightProperty, LightValues, Posed, Target};

use super::Shot;
use crate::document::{Color, Light, LightKind};

/// The intensity that a sun of one watt per square metre gets in a scene. It makes a white surface as bright as in the
/// program that made the shot, which is 1/π. The soft shoulder of the reference render multiplies middle values by
/// about 0.7, so the intensity is 1/π divided by 0.7.
const OF_WATT: f64 = 0.455;

/// Lux per watt per square metre, as exporters convert.
const LUX_PER_WATT: f64 = 683.0;

/// Light on the shot's objects between these intensities is neither dimmed nor lifted.
const LEAST: f64 = 0.7;
const MOST: f64 = 1.7;

/// Light below this intensity cannot have been stated in lux. Its numbers count as relative, and it is lifted to
/// `MOST`.
const NO_LUX: f64 = 0.01;

/// Light below `LEAST` is lifted: its share of `LEAST` is raised to this power. A night stays dark, but its strokes can
/// be seen.
const DARKNESS: f64 = 0.6;

/// The ambient light, which no exporter writes: as a share of the suns' light, and of the lamps' light.
const AROUND: [f64; 2] = [0.11, 0.25];

/// The tint of the ambient light, like that of a sky, sRGB.
const OF_SKY: [u8; 3] = [0xcf, 0xdc, 0xf2];

/// A lamp counts as at least this far from an object, as a share of the size of the scene.
const NEAREST: f64 = 0.05;

/// How bright a linear colour is.
fn luma(color: [f64; 3]) -> f64 {
    color.into_iter().zip([0.2126, 0.7152, 0.0722]).map(|(channel, weight)| channel * weight).sum()
}

impl Shot {
    /// The factor from a light's intensity in the file to that in the scene, and the intensity of the light that
    /// surfaces reflect onto each other. A shot is as bright as in the program that made it, within limits: it is
    /// dimmed where whites would burn out, and lifted where it is dark.
    pub(super) fn found_exposure(&self) -> (f64, f64) {
        let [suns, lamps] = self.light_at_middle().map(|lux| lux / LUX_PER_WATT * OF_WATT);
        // Ambient light reaches a surface from half of the sphere, which makes π times the radiance.
        let world = self.file.sidecar.world.unwrap_or_default();
        let found = suns + lamps + luma(world) * std::f64::consts::PI * OF_WATT;
        if !(suns + lamps > 0.0 && found.is_finite()) {
            return (OF_WATT / LUX_PER_WATT, 0.0);
        }
        let wanted = match found {
            ..NO_LUX => MOST,
            NO_LUX..LEAST => LEAST * (found / LEAST).powf(DARKNESS),
            _ => found.min(MOST),
        };
        let scale = wanted / found;
        let around = scale * (AROUND[0] * suns + AROUND[1] * lamps);
        (scale * OF_WATT / LUX_PER_WATT, around)
    }

    /// The illuminance in lux by all suns, and by all lamps, at the object where the sum of both is the median over all
    /// objects. Shadows are ignored.
    fn light_at_middle(&self) -> [f64; 2] {
        /// At most this many objects are sampled.
        const ASKED: usize = 256;
        let rest = &self.file.rest;
        let stride = self.objects.len().div_ceil(ASKED).max(1);
        let objects = self.objects.iter().step_by(stride);
        let mut places: Vec<DVec3> =
            objects.map(|object| rest.world_from_node[object.node].translation).collect();
        if places.is_empty() {
            places.push(DVec3::ZERO);
        }
        let (low, high) = places
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &at| (low.min(at), high.max(at)));
        let nearest = (NEAREST * (high - low).length()).max(1e-3);
        let mut lit: Vec<[f64; 2]> = places.iter().map(|&at| self.light_on(at, nearest)).collect();
        lit.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
        lit[lit.len() / 2]
    }

    /// The illuminance in lux at a place by all suns, and by all lamps. Lamps count as at least `nearest` away.
    fn light_on(&self, at: DVec3, nearest: f64) -> [f64; 2] {
        let rest = &self.file.rest;
        let mut brought = [0.0; 2];
        for (node, light) in self.light_nodes() {
            let values = rest.lights[light];
            let bright = values.intensity * luma(values.color.map(f64::from));
            let world = rest.world_from_view(node);
            let way = at - world.w_axis.truncate();
            let off_axis_rad = way.angle_between(-world.z_axis.truncate());
            match self.file.gltf.lights[light].kind {
                ShotKind::Directional => brought[0] += bright,
                ShotKind::Spot if off_axis_rad > values.outer_cone_rad => {}
                ShotKind::Point | ShotKind::Spot => brought[1] += bright / way.length().max(nearest).powi(2),
            }
        }
        brought
    }

    /// The background of the shot: the world that the sidecar states, or else a plain sky, as bright as the shot.
    /// `None` for a shot without lights.
    pub(super) fn sky(&self) -> Option<Color> {
        const OF_DAY: [f32; 3] = [0.66, 0.735, 0.80];
        const OF_LAMPS: f64 = 0.35;
        if let Some(world) = self.file.sidecar.world.filter(|_| self.has_lights()) {
            let scale = self.scale();
            let shown = world.map(|part| srgb_from_linear((part * scale).min(1.0) as f32));
            return Some(Color::from_hex(&Color(shown).to_hex()).unwrap_or_default());
        }
        let [suns, lamps] = self.light_at_middle();
        // Suns light the sky, lamps hardly do. The sky darkens sooner than the objects, hence the square.
        let share = ((suns + OF_LAMPS * lamps) * self.exposure / LEAST).min(1.0).powi(2) as f32;
        let sky = OF_DAY.map(|channel| srgb_from_linear(linear_from_srgb(channel) * share));
        // Rounded to 8 bits a channel, as a scene file states it.
        self.has_lights().then(|| Color::from_hex(&Color(sky).to_hex()).unwrap_or_default())
    }

    /// The lights as they are at rest and, if there are any, an ambient light.
    pub(super) fn lights_at_rest(&self) -> Vec<(Light, Option<usize>)> {
        let mut lights: Vec<(Light, Option<usize>)> = self
            .light_nodes()
            .map(|(node, light)| {
                let kind = match self.file.gltf.lights[light].kind {
                    ShotKind::Directional => LightKind::Sun,
                    ShotKind::Point => LightKind::Point,
                    ShotKind::Spot => LightKind::Spot,
                };
                let named = Light::new(self.file.gltf.nodes[node].name.clone(), kind);
                (self.lit(&named, node, &self.file.rest), Some(node))
            })
            .collect();
        if !lights.is_empty() {
            lights.push((self.light_around(), None));
        }
        lights
    }

    /// The ambient light: what surfaces reflect onto each other, and what comes from the world.
    fn light_around(&self) -> Light {
        let tint = Color::from_bytes(OF_SKY);
        let (color, intensity) = match self.file.sidecar.world {
            None => (tint, self.around),
            Some(world) => {
                let of_world = std::f64::consts::PI * OF_WATT * self.scale();
                let parts = [0, 1, 2].map(|channel| {
                    f64::from(linear_from_srgb(tint.0[channel])) * self.around + world[channel] * of_world
                });
                let most = parts.into_iter().fold(1e-9, f64::max);
                (Color(parts.map(|part| srgb_from_linear((part / most) as f32))), most)
            }
        };
        Light { color, intensity, ..Light::new("ambient", LightKind::Ambient) }
    }

    /// The factor from the brightness of light in the program that made the shot to that in the scene.
    fn scale(&self) -> f64 {
        self.exposure * LUX_PER_WATT / OF_WATT
    }

    /// A light of the scene in this pose of the shot: intensity, colour, direction, position and cone are the shot's,
    /// unless the document changed them.
    pub(crate) fn light_at(&self, light: &Light, posed: &Posed) -> Light {
        let brought = self.lights.iter().find(|(brought, _)| brought.name == light.name);
        let Some((rest, Some(node))) = brought.filter(|(brought, _)| brought.kind == light.kind) else {
            return light.clone();
        };
        let now = self.lit(rest, *node, posed);
        let mut lit = light.clone();
        if light.intensity == rest.intensity {
            lit.intensity = now.intensity;
        }
        if light.color == rest.color {
            lit.color = now.color;
        }
        if light.direction == rest.direction || light.direction.is_none() {
            lit.direction = now.direction;
        }
        if light.position == rest.position || light.position.is_none() {
            lit.position = now.position;
        }
        if light.cone_deg == rest.cone_deg {
            lit.cone_deg = now.cone_deg;
        }
        lit
    }

    /// Blender 5.0 writes keys of the strength of point and spot lights without the factor 1/4π that the light itself
    /// has. Such keys are divided by 4π. They are recognized if one of them is 4π times as strong as the light at rest,
    /// and none is as strong as the light.
    pub(super) fn mend_light_keys(&mut self, odd: &mut Vec<[String; 2]>) {
        const FOUR_PI: f64 = 4.0 * std::f64::consts::PI;
        let is_near = |value: f64, wanted: f64| (value / wanted - 1.0).abs() < 1e-3;
        let gltf = &self.file.gltf;
        for track in gltf.animations.iter().flat_map(|animation| &animation.tracks) {
            let Target::Light(index, LightProperty::Intensity) = track.target else { continue };
            let light = &gltf.lights[index];
            let has = |wanted: f64| track.values.iter().any(|&value| is_near(f64::from(value), wanted));
            let rest = light.values.intensity;
            if light.kind == ShotKind::Directional || has(rest) || !has(FOUR_PI * rest) {
                continue;
            }
            self.key_factors[index] = 1.0 / FOUR_PI;
            odd.push([
                format!("the keys of the light {:?} are 4π times as strong as the light itself", light.name),
                "they are brought down to it; Blender 5.0 writes them so".to_owned(),
            ]);
        }
    }

    /// Each node of the scene with a light, and the index of the light.
    fn light_nodes(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let nodes = self.file.gltf.nodes.iter().enumerate();
        nodes
            .filter_map(|(index, node)| Some((index, node.light?)))
            .filter(|(index, _)| self.file.is_in_scene(*index))
    }

    /// A light with the values of its node at a time.
    fn lit(&self, light: &Light, node: usize, posed: &Posed) -> Light {
        let Some(index) = self.file.gltf.nodes[node].light else { return light.clone() };
        let LightValues { color, intensity, inner_cone_rad, outer_cone_rad, .. } = posed.lights[index];
        let world = posed.world_from_view(node);
        // A colour that is too bright for a scene file is scaled down, and its intensity up.
        let most = color.into_iter().fold(0.0f32, f32::max).max(1e-6);
        let scale = if most > 1.0 { most } else { 1.0 };
        let shines = (light.kind != LightKind::Point).then(|| (-world.z_axis.truncate()).to_array());
        let stands = (light.kind != LightKind::Sun).then(|| world.w_axis.truncate().to_array());
        let shown = posed.is_visible[node];
        let is_keyed = intensity != self.file.rest.lights[index].intensity;
        let intensity = if is_keyed { intensity * self.key_factors[index] } else { intensity };
        Light {
            color: Color(color.map(|channel| srgb_from_linear(channel / scale))),
            intensity: if shown { (intensity * self.exposure * f64::from(scale)).min(1e6) } else { 0.0 },
            direction: shines,
            position: stands,
            cone_deg: (light.kind == LightKind::Spot)
                .then(|| [inner_cone_rad, outer_cone_rad].map(f64::to_degrees)),
            ..light.clone()
        }
    }
}
