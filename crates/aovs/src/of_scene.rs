//! The AOVs of the scene's surfaces: depth, normals, positions, motion, light, and which object a pixel shows.

use glam::{Mat4, Vec3, Vec4};
use half::f16;
use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::{MotionPixels, RenderError, Renderer};
use impasto_painting::Frame;
use impasto_scene::aovs::{Aov, AovSet};
use impasto_scene::motion;

use crate::drawn::{Drawn, Found};
use crate::planes::{in_steps, short};

/// The AOVs that need the surfaces: the renderer must keep them (`Renderer::keep`) while it draws the picture.
pub const OF_SURFACES: &[Aov] = &[Aov::Normal, Aov::Albedo, Aov::Light, Aov::Shadow, Aov::Occlusion];

/// The depth of pixels that show no body, as other renderers write it.
const NOTHING: f32 = 1e10;

/// Motion is rounded to a multiple of this.
const MOTION_STEP_PX: f32 = 1.0 / 256.0;

pub(crate) fn add(
    renderer: &mut Renderer,
    drawn: &Drawn<'_>,
    wanted: AovSet,
    found: &mut Found,
) -> Result<(), RenderError> {
    let frame = drawn.frame;
    let channels = &mut found.channels;
    if wanted.has_any(&[Aov::Depth, Aov::Position, Aov::ObjectId]) {
        let reference = renderer.read_reference();
        if wanted.has(Aov::Position) {
            let places = places(frame, &reference.depth);
            for (name, axis) in [("P.X", 0), ("P.Y", 1), ("P.Z", 2)] {
                let plane = places.iter().map(|place| short(place[axis])).collect();
                channels.push(Channel::new(name, Samples::Float(plane)));
            }
        }
        if wanted.has(Aov::ObjectId) {
            let ids = reference.body_id.iter().map(|&id| id as f32).collect();
            channels.push(Channel::new("objectid.X", Samples::Float(ids)));
        }
        if wanted.has(Aov::Depth) {
            let depth = reference.depth.into_iter();
            let depth = depth.map(|depth| if depth == 0.0 { NOTHING } else { short(depth) }).collect();
            channels.push(Channel::new("Z", Samples::Float(depth)));
        }
    }
    if wanted.has_any(OF_SURFACES) {
        let surfaces = renderer.read_surfaces(frame)?;
        let mut add = |name: &str, pixels: &[[f16; 4]], at: usize| {
            let plane = pixels.iter().map(|pixel| pixel[at]).collect();
            channels.push(Channel::new(name, Samples::Half(plane)));
        };
        let rows = [
            (Aov::Normal, &surfaces.normal, ["N.X", "N.Y", "N.Z"].as_slice(), 0),
            (Aov::Albedo, &surfaces.albedo, &["albedo.R", "albedo.G", "albedo.B"], 0),
            (Aov::Light, &surfaces.light, &["light.R", "light.G", "light.B"], 0),
            (Aov::Shadow, &surfaces.light, &["shadow.X"], 3),
        ];
        for (aov, pixels, names, first) in rows {
            for (at, name) in names.iter().enumerate().filter(|_| wanted.has(aov)) {
                add(name, pixels, first + at);
            }
        }
        if wanted.has(Aov::Occlusion) {
            channels.push(Channel::new("occlusion.X", Samples::Half(surfaces.openness)));
        }
    }
    let before = wanted.has_any(&[Aov::Motion, Aov::Backward]).then_some(-1.0);
    let after = wanted.has_any(&[Aov::Motion, Aov::Forward]).then_some(1.0);
    let mut moved = |by: Option<f64>| by.map(|by| motion_to(renderer, drawn, drawn.number + by)).transpose();
    let (before, after) = (moved(before)?, moved(after)?);
    let mut add = |name: &str, motion: &MotionPixels, axis: usize, sign: f32| {
        // + 0 turns −0 into 0.
        let plane = motion
            .offset_px
            .iter()
            .map(|offset| in_steps(sign * offset[axis], MOTION_STEP_PX) + 0.0)
            .collect();
        channels.push(Channel::new(name, Samples::Float(plane)));
    };
    // The renderer's offsets point from this frame to the other, and have y down. The AOVs have y up. They also point
    // from this frame to the other, except Z and W of `motion`, which point from the frame after to this one.
    if let (true, Some(before), Some(after)) = (wanted.has(Aov::Motion), &before, &after) {
        add("motion.X", before, 0, 1.0);
        add("motion.Y", before, 1, -1.0);
        add("motion.Z", after, 0, -1.0);
        add("motion.W", after, 1, 1.0);
    }
    for (aov, motion, names) in [
        (Aov::Forward, &after, ["forward.u", "forward.v"]),
        (Aov::Backward, &before, ["backward.u", "backward.v"]),
    ] {
        if let (true, Some(motion)) = (wanted.has(aov), motion) {
            add(names[0], motion, 0, 1.0);
            add(names[1], motion, 1, -1.0);
        }
    }
    Ok(())
}

/// How the surfaces of the picture move to another frame.
fn motion_to(renderer: &mut Renderer, drawn: &Drawn<'_>, number: f64) -> Result<MotionPixels, RenderError> {
    let camera = motion::camera_at(drawn.painting.scene(), number);
    let then = drawn.painting.bare(&camera, number, drawn.options);
    renderer.motion(drawn.frame, &then)
}

/// The place in world space that each pixel shows; 0 where nothing is. Top row first.
fn places(frame: &Frame, depth: &[f32]) -> Vec<[f32; 3]> {
    let [width, height] = frame.size_px.map(|side| side as usize);
    let view = &frame.view;
    let world_from_view: Mat4 = view.view_from_world.inverse();
    let view_from_clip = view.clip_from_view.inverse();
    let mut places = Vec::with_capacity(depth.len());
    for (pixel, &depth) in depth.iter().enumerate() {
        let [column, row] = [pixel % width, pixel / width];
        let x = (column as f32 + 0.5) / width as f32 * 2.0 - 1.0;
        let y = 1.0 - (row as f32 + 0.5) / height as f32 * 2.0;
        let place = if depth == 0.0 {
            Vec3::ZERO
        } else {
            let near = world_from_view.transform_point3(at_depth(&view_from_clip, [x, y], depth));
            (near.as_dvec3() + view.origin_in_world).as_vec3()
        };
        places.push(place.to_array());
    }
    places
}

/// The point in view space at this depth along the gaze, on the ray through the point `[x, y]` of the picture, −1..1.
fn at_depth(view_from_clip: &Mat4, [x, y]: [f32; 2], depth: f32) -> Vec3 {
    let on_plane = |z: f32| {
        let place: Vec4 = *view_from_clip * Vec4::new(x, y, z, 1.0);
        place.truncate() / place.w
    };
    let (near, far) = (on_plane(-1.0), on_plane(0.0));
    let share = (-depth - near.z) / (far.z - near.z);
    near + (far - near) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_found_again_from_its_pixel_and_its_depth() {
        let lenses = [
            glam::camera::rh::proj::opengl::perspective(0.7, 1.6, 0.1, 500.0),
            glam::camera::rh::proj::opengl::orthographic(-3.0, 3.0, -2.0, 2.0, 0.1, 50.0),
        ];
        for lens in lenses {
            for place in [Vec3::new(0.3, -0.2, -4.0), Vec3::new(-1.0, 0.7, -9.0)] {
                let clip = lens * place.extend(1.0);
                let found = at_depth(&lens.inverse(), [clip.x / clip.w, clip.y / clip.w], -place.z);
                assert!(found.distance(place) < 1e-3, "{found} for {place}");
            }
        }
    }
}
