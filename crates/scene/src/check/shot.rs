//! Checks the picture size, the frames, the references, the camera, the exposure, the lights and the background's keys.

use glam::DVec3;

use super::{Findings, short, within};
use crate::document::{Lens, Light, LightKind, Reference, Scene};
use crate::limits;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_size(scene.size, findings);
    check_timeline(scene, findings);
    check_references(scene, findings);
    check_lens(&scene.camera.lens, findings);
    check_camera_keys(scene, findings);
    findings.number("exposure", scene.exposure, -16.0..=16.0);
    check_lights(&scene.lights, findings);
    findings.keys("background_keys", &scene.background_keys);
}

fn check_size((width, height): (u32, u32), findings: &mut Findings) {
    if width == 0 || height == 0 {
        findings.error("size", "a picture has at least one pixel a side", "give two whole numbers from 1 up");
    } else if width.max(height) > limits::MAX_SIDE_PX {
        let message = format!("{width} × {height} pixels: a side is longer than {}", limits::MAX_SIDE_PX);
        findings.limit("size", message, format!("give at most {} pixels a side", limits::MAX_SIDE_PX));
    } else if u64::from(width) * u64::from(height) > limits::MAX_PIXELS {
        let message = format!("{width} × {height} pixels are more than {}", limits::MAX_PIXELS);
        findings.limit("size", message, "give a smaller size");
    }
}

fn check_timeline(scene: &Scene, findings: &mut Findings) {
    let timeline = &scene.timeline;
    if !(timeline.fps > 0.0 && timeline.fps <= 1e6) {
        let message = format!("{} frames per second", short(timeline.fps));
        findings.error("timeline.fps", message, "give a number above 0, at most 1000000");
    }
    let mut in_range = true;
    for (field_path, frame) in [("timeline.first", timeline.first), ("timeline.last", timeline.last)] {
        in_range &= check_whole_frame(field_path, frame, findings);
    }
    if timeline.first > timeline.last {
        let message = format!("the shot ends at {}, before it starts at {}", timeline.last, timeline.first);
        findings.error("timeline.last", message, "give a last frame that is not before the first");
    } else if in_range {
        let frames = (timeline.last - timeline.first).unsigned_abs() + 1;
        if frames > limits::MAX_FRAMES {
            let message = format!("the shot has {frames} frames, more than {}", limits::MAX_FRAMES);
            findings.limit("timeline.last", message, "split the shot");
        }
    }
}

fn check_references(scene: &Scene, findings: &mut Findings) {
    check_reference("reference", scene, &scene.reference, findings);
    if scene.further_references.len() > limits::MAX_FURTHER_REFERENCES {
        let message = format!("{} further references", scene.further_references.len());
        let mend = format!("give at most {}", limits::MAX_FURTHER_REFERENCES);
        findings.limit("further_references", message, mend);
    }
    for (index, reference) in scene.further_references.iter().enumerate() {
        check_reference(&format!("further_references[{index}]"), scene, reference, findings);
    }
    for (index, region) in scene.regions.iter().enumerate() {
        if let Some(reference) = &region.reference {
            check_reference(&format!("regions[{index}].reference"), scene, reference, findings);
        }
    }
}

fn check_reference(field_path: &str, scene: &Scene, reference: &Reference, findings: &mut Findings) {
    let frame = match *reference {
        Reference::Frame(frame) => frame,
        Reference::View { eye, target, roll_deg, fov_y_deg, frame } => {
            let path = |field: &str| format!("{field_path}.{field}");
            findings.vector(&path("eye"), eye);
            findings.vector(&path("target"), target);
            findings.number(&path("roll_deg"), roll_deg, -limits::MAX_ANGLE_DEG..=limits::MAX_ANGLE_DEG);
            if let Some(fov_y_deg) = fov_y_deg {
                findings.number(&path("fov_y_deg"), fov_y_deg, limits::FOV_Y_DEG);
            }
            check_gaze(&path("target"), DVec3::from(eye), DVec3::from(target), findings);
            frame
        }
    };
    let timeline = &scene.timeline;
    let outside = !(timeline.first..=timeline.last).contains(&frame) && timeline.first <= timeline.last;
    // A reference that is left out is frame 0, which may lie outside the timeline.
    let is_default = field_path == "reference" && *reference == Reference::default();
    if check_whole_frame(field_path, frame, findings) && outside && !is_default {
        let message =
            format!("frame {frame} is outside the timeline ({} to {})", timeline.first, timeline.last);
        let mend = "name a frame of the timeline; the pose of the nearest key is used";
        findings.warning(field_path, message, mend);
    }
}

fn check_whole_frame(field_path: &str, frame: i64, findings: &mut Findings) -> bool {
    let in_range = within(frame as f64, limits::MAX_FRAME);
    if !in_range {
        let limit = short(limits::MAX_FRAME);
        let mend = format!("give a whole number from -{limit} to {limit}");
        findings.limit(field_path, format!("frame {frame} is too far away"), mend);
    }
    in_range
}

fn check_lens(lens: &Lens, findings: &mut Findings) {
    const NEAR: &str = "camera.lens.near";
    const FAR: &str = "camera.lens.far";
    let (near, far) = match *lens {
        Lens::Perspective { fov_y_deg, near, far } => {
            findings.number("camera.lens.fov_y_deg", fov_y_deg, limits::FOV_Y_DEG);
            findings.number(NEAR, near, limits::MIN_LENGTH..=limits::MAX_LENGTH);
            (near, far)
        }
        Lens::Orthographic { height, near, far } => {
            let range = limits::MIN_LENGTH..=limits::MAX_LENGTH;
            findings.number("camera.lens.height", height, range);
            findings.number(NEAR, near, -limits::MAX_LENGTH..=limits::MAX_LENGTH);
            (near, far)
        }
    };
    findings.number(FAR, far, -limits::MAX_LENGTH..=limits::MAX_LENGTH);
    if near >= far {
        let message = format!("near ({}) is not less than far ({})", short(near), short(far));
        findings.error(FAR, message, "give a far depth behind the near one");
    }
}

fn check_camera_keys(scene: &Scene, findings: &mut Findings) {
    let keys = &scene.camera.keys;
    // A shot that is not on the stage yet counts as having a camera.
    let has_camera = scene.stage.shot.as_ref().map_or(scene.shot.is_some(), |shot| shot.has_camera());
    if keys.is_empty() && !has_camera {
        let mend = "add one, as in (frame: 0, eye: (0, 1, 4), target: (0, 0, 0))";
        findings.error("camera.keys", "the camera has no key", mend);
    }
    findings.keys("camera.keys", keys);
    for (index, key) in keys.iter().enumerate() {
        let path = |field: &str| format!("camera.keys[{index}].{field}");
        findings.vector(&path("eye"), key.eye);
        findings.vector(&path("target"), key.target);
        let turn = limits::MAX_ANGLE_DEG;
        findings.number(&path("roll_deg"), key.roll_deg, -turn..=turn);
        if let Some(fov_y_deg) = key.fov_y_deg {
            let field_path = path("fov_y_deg");
            findings.number(&field_path, fov_y_deg, limits::FOV_Y_DEG);
            if matches!(scene.camera.lens, Lens::Orthographic { .. }) {
                let mend = "remove it, or use a Perspective lens";
                findings.warning(field_path, "an orthographic lens has no field of view", mend);
            }
        }
        check_gaze(&path("target"), DVec3::from(key.eye), DVec3::from(key.target), findings);
    }
}

/// A gaze must have a length and a horizontal part. If the camera looked straight up or down, it would be undefined
/// which way is up in the picture.
fn check_gaze(field_path: &str, eye: DVec3, target: DVec3, findings: &mut Findings) {
    const LEAST_SINE: f64 = 1e-6;
    let gaze = target - eye;
    let scale = eye.abs().max(target.abs()).max_element();
    if !scale.is_finite() || scale > limits::MAX_LENGTH {
        return; // The field that is out of range was reported already.
    }
    // Eye and target must differ by more than rounding, so that the gaze still has a direction.
    if gaze.length() <= limits::MIN_LENGTH.max(1e-12 * scale) {
        let mend = "move the eye or the target, so that the camera looks somewhere";
        findings.error(field_path, "eye and target are the same point", mend);
    } else if gaze.normalize().cross(DVec3::Y).length() < LEAST_SINE {
        let mend = "move the eye a little to the side, as in (0, 5, 0.01)";
        findings.error(field_path, "the camera looks straight up or down", mend);
    }
}

fn check_lights(lights: &[Light], findings: &mut Findings) {
    findings.unique("lights", lights.iter().map(|light| light.name.as_str()));
    for (index, light) in lights.iter().enumerate() {
        let path = |field: &str| format!("lights[{index}].{field}");
        findings.number(&path("intensity"), light.intensity, 0.0..=limits::MAX_INTENSITY);
        let needs = |what: &str| format!("a {:?} light needs a {what}", light.kind);
        match light.direction {
            Some(direction) if shines(light.kind) => findings.direction(&path("direction"), direction),
            None if shines(light.kind) => {
                let mend = "add where its light goes, as in direction: (0.5, -1, -0.6)";
                findings.error(format!("lights[{index}]"), needs("direction"), mend);
            }
            Some(_) => unused(&path("direction"), "a Sun or a Spot", findings),
            None => {}
        }
        match light.position {
            Some(position) if stands(light.kind) => findings.vector(&path("position"), position),
            None if stands(light.kind) => {
                let mend = "add where it stands, as in position: (0, 3, 1)";
                findings.error(format!("lights[{index}]"), needs("position"), mend);
            }
            Some(_) => unused(&path("position"), "a Point light or a Spot", findings),
            None => {}
        }
        match light.cone_deg {
            Some([inner, outer]) if light.kind == LightKind::Spot => {
                findings.number(&path("cone_deg"), outer, 0.0..=90.0);
                findings.number(&path("cone_deg"), inner, 0.0..=outer.max(0.0));
            }
            Some(_) => unused(&path("cone_deg"), "a Spot", findings),
            None => {}
        }
        if light.ground.is_some() && light.kind != LightKind::Ambient {
            unused(&path("ground"), "an Ambient light", findings);
        }
        check_light_keys(index, light, findings);
    }
    type OfKind = fn(LightKind) -> bool;
    let limits: [(&str, usize, OfKind); 2] = [
        ("suns", limits::MAX_SUNS, |kind| kind == LightKind::Sun),
        ("point lights and spots", limits::MAX_POINT_LIGHTS, stands),
    ];
    for (kind, limit, is_kind) in limits {
        let mut of_kind = lights.iter().enumerate().filter(|(_, light)| is_kind(light.kind));
        if let Some((index, _)) = of_kind.nth(limit) {
            let message = format!("there are more than {limit} {kind}");
            findings.limit(format!("lights[{index}]"), message, format!("keep {limit} of them"));
        }
    }
}

/// Whether lights of this kind have a direction.
fn shines(kind: LightKind) -> bool {
    matches!(kind, LightKind::Sun | LightKind::Spot)
}

/// Whether lights of this kind have a place.
fn stands(kind: LightKind) -> bool {
    matches!(kind, LightKind::Point | LightKind::Spot)
}

fn check_light_keys(index: usize, light: &Light, findings: &mut Findings) {
    let keys_path = format!("lights[{index}].keys");
    findings.keys(&keys_path, &light.keys);
    for (number, key) in light.keys.iter().enumerate() {
        let path = |field: &str| format!("{keys_path}[{number}].{field}");
        if let Some(intensity) = key.intensity {
            findings.number(&path("intensity"), intensity, 0.0..=limits::MAX_INTENSITY);
        }
        match key.direction {
            Some(direction) if shines(light.kind) => findings.direction(&path("direction"), direction),
            Some(_) => unused(&path("direction"), "a Sun or a Spot", findings),
            None => {}
        }
        match key.position {
            Some(position) if stands(light.kind) => findings.vector(&path("position"), position),
            Some(_) => unused(&path("position"), "a Point light or a Spot", findings),
            None => {}
        }
        if key.ground.is_some() && light.kind != LightKind::Ambient {
            unused(&path("ground"), "an Ambient light", findings);
        }
    }
}

fn unused(field_path: &str, owner: &str, findings: &mut Findings) {
    findings.warning(field_path, format!("only {owner} uses this"), "remove it, or change the kind");
}
