//! The lights of a shot, with an exposure that brings them to the scale of a scene's lights.

use glam::DVec3;
use impasto_core::color::srgb_from_linear;
use impasto_gltf::{LightKind as ShotKind, LightProperty, LightValues, Posed, Target};

use super::Shot;
use crate::document::{Color, Light, LightKind};

/// What all the lights of a shot together bring to its middle, as a sun would: as bright as the sun of a new scene.
const BRIGHTNESS: f64 = 2.4;

/// Brightness of the soft light all around, which no exporter writes.
const AMBIENT: f64 = 0.5;

/// The light at the middle counts as at least this far from it, over the size of the scene.
const NEAREST: f64 = 0.1;

impl Shot {
    /// Our intensity over that of the file: all lights together are as bright at the middle of the shot as the light of a new scene.
    pub(super) fn found_exposure(&self) -> f64 {
        let rest = &self.file.rest;
        let places = self.objects.iter().map(|object| rest.world_from_node[object.node].translation);
        let (low, high) = places
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let (middle, size) = if low.cmple(high).all() {
            ((low + high) * 0.5, (high - low).length())
        } else {
            (DVec3::ZERO, 1.0)
        };
        let brings = |(node, light): (usize, usize)| {
            let values = rest.lights[light];
            let luma = values.color.map(f64::from).into_iter().zip([0.2126, 0.7152, 0.0722]);
            let bright = values.intensity * luma.map(|(channel, weight)| channel * weight).sum::<f64>();
            match self.file.gltf.lights[light].kind {
                ShotKind::Directional => bright,
                ShotKind::Point | ShotKind::Spot => {
                    let away = (rest.world_from_node[node].translation - middle).length();
                    bright / away.max(NEAREST * size).max(1e-6).powi(2)
                }
            }
        };
        let all: f64 = self.light_nodes().map(brings).sum();
        if all > 0.0 && all.is_finite() { BRIGHTNESS / all } else { 1.0 }
    }

    /// The lights as they are at rest, and a soft light all around where there are any.
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
            let ambient = Light {
                color: Color::from_bytes([0xcf, 0xdc, 0xf2]),
                intensity: AMBIENT,
                ..Light::new("ambient", LightKind::Ambient)
            };
            lights.push((ambient, None));
        }
        lights
    }

    /// A light of the scene at a time: what the document changed stays, the rest is as the shot has it.
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
        lit
    }

    /// Blender 5.0 writes keys of the strength of point and spot lights without the 1/4π of the light itself. Where that shows (one of
    /// the keys is 4π times the light at rest, and none is as it), the keys are brought down to the light.
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

    /// Each node with a light, and the light.
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
        // Colours beyond what a scene file can state go into the intensity.
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
