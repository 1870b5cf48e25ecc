//! Turns the document's lights and colours into linear light.

use glam::{DVec3, Vec3};
use impasto_core::color::linear_from_srgb;
use impasto_scene::document::{Color, Light, LightKind, Scene};
use impasto_scene::motion;

use crate::frame::{Cone, FrameLights, PointLight, SunLight};

/// A colour in linear Rec. 709.
pub(crate) fn linear(color: Color) -> [f32; 3] {
    color.0.map(linear_from_srgb)
}

fn radiance(color: Color, intensity: f64) -> Vec3 {
    Vec3::from(linear(color)) * intensity as f32
}

/// The lights of a scene at a frame, with the scene's exposure applied.
pub(crate) fn resolve(
    scene: &Scene,
    frame: f64,
    shadow_bounds: (Vec3, f32),
    origin_in_world: DVec3,
) -> FrameLights {
    let mut lights = unexposed(scene, frame, origin_in_world);
    lights.shadow_bounds = shadow_bounds;
    lights.shadow_lamp = brightest_lamp(scene).filter(|_| lights.suns.is_empty());
    let exposure = scene.exposure.exp2() as f32;
    lights.suns.iter_mut().for_each(|sun| sun.radiance *= exposure);
    lights.points.iter_mut().for_each(|point| point.radiance *= exposure);
    lights.ambient_above *= exposure;
    lights.ambient_below *= exposure;
    lights
}

/// The lights of a scene at a frame. If it names none, they are a warm sun from the upper left front, cool light from
/// above, and warm light from below.
fn unexposed(scene: &Scene, frame: f64, origin_in_world: DVec3) -> FrameLights {
    let mut lights = FrameLights::default();
    if scene.lights.is_empty() {
        lights.suns.push(SunLight {
            to_light: Vec3::new(-0.55, 0.75, 0.6).normalize(),
            radiance: Vec3::new(1.0, 0.9, 0.75) * 2.5,
        });
        lights.ambient_above = Vec3::new(0.40, 0.50, 0.68) * 0.55;
        lights.ambient_below = Vec3::new(0.50, 0.36, 0.24) * 0.45;
        return lights;
    }
    for light in motion::lights_at(scene, frame) {
        let radiance = radiance(light.color, light.intensity);
        match light.kind {
            LightKind::Sun => lights.suns.push(SunLight {
                to_light: -DVec3::from(light.direction.unwrap_or([0.0, -1.0, 0.0]))
                    .as_vec3()
                    .normalize_or(Vec3::NEG_Y),
                radiance,
            }),
            LightKind::Point | LightKind::Spot => lights.points.push(PointLight {
                position: (DVec3::from(light.position.unwrap_or_default()) - origin_in_world).as_vec3(),
                radiance,
                cone: (light.kind == LightKind::Spot).then(|| cone(&light)),
            }),
            LightKind::Ambient => {
                lights.ambient_above += radiance;
                lights.ambient_below += match light.ground {
                    Some(floor) => Vec3::from(linear(floor)) * light.intensity as f32,
                    None => radiance * Vec3::from(Light::OFF_THE_FLOOR),
                };
            }
        }
    }
    lights
}

/// The index of the brightest lamp among all points and spots, by the colour and intensity that the document states.
/// Keys do not count, so it is the same lamp in every frame.
fn brightest_lamp(scene: &Scene) -> Option<usize> {
    let is_lamp = |light: &&Light| matches!(light.kind, LightKind::Point | LightKind::Spot);
    let luma = |light: &Light| radiance(light.color, light.intensity).dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let lamps = scene.lights.iter().filter(is_lamp).map(luma).enumerate();
    // Of equally bright lamps, the first is taken.
    let brightest = lamps.reduce(|best, other| if other.1 > best.1 { other } else { best });
    brightest.map(|(index, _)| index)
}

fn cone(light: &Light) -> Cone {
    let [inner, outer] =
        light.cone_deg.unwrap_or(Light::USUAL_CONE_DEG).map(|deg| deg.to_radians().cos() as f32);
    let axis = DVec3::from(light.direction.unwrap_or([0.0, -1.0, 0.0])).as_vec3();
    Cone { axis: axis.normalize_or(Vec3::NEG_Y), inner_cosine: inner, outer_cosine: outer }
}
