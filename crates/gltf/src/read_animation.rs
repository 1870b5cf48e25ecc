//! Reads animations.

use std::sync::Arc;

use foldhash::{HashMap, HashSet, HashSetExt};

use crate::accessor::{Component, Shape};
use crate::animation::{
    Animation, CameraProperty, Interpolation, LightProperty, MaterialProperty, NodeProperty, Target, Track,
};
use crate::camera_light::{Camera, Lens};
use crate::cursor::Cursor;
use crate::decode::{Accessors, Integers};
use crate::extensions::POINTER;
use crate::finding::{Checked, EXPORT_ANEW, Findings};
use crate::mesh::Mesh;
use crate::node::{LocalTransform, Node};
use crate::pointer;

/// What animations drive.
pub(crate) struct Driven<'a> {
    pub nodes: &'a [Node],
    pub meshes: &'a [Arc<Mesh>],
    pub cameras: &'a [Camera],
    pub lights: usize,
    pub materials: usize,
}

/// Lists that tracks share.
#[derive(Default)]
struct Shared {
    times: HashMap<usize, Arc<Vec<f32>>>,
    values: HashMap<(usize, bool), Arc<Vec<f32>>>,
    /// Rotations that were checked: the accessor, and elements per key (3 with tangents, else 1).
    rotations: HashSet<(usize, usize)>,
}

/// A sampler, checked as far as it can be without its target.
struct Sampler<'p, 't> {
    times_s: Arc<Vec<f32>>,
    interpolation: Interpolation,
    output: Cursor<'p, 't>,
}

pub(crate) fn read_all(
    root: &Cursor<'_, '_>,
    driven: &Driven<'_>,
    accessors: &mut Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<Vec<Animation>> {
    let list = root.list("animations")?;
    let mut animations = Vec::new();
    let mut shared = Shared::default();
    for cursor in list.iter() {
        let animation = animation(&cursor, driven, (accessors, &mut shared), findings);
        animations.extend(findings.take(animation));
        if findings.is_full() {
            break;
        }
    }
    Ok(animations)
}

fn animation(
    cursor: &Cursor<'_, '_>,
    driven: &Driven<'_>,
    (accessors, shared): (&mut Accessors<'_, '_, '_>, &mut Shared),
    findings: &mut Findings,
) -> Checked<Animation> {
    let name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
    let samplers_cursor = cursor.required("samplers")?;
    let channels_cursor = cursor.required("channels")?;
    let sampler_list = samplers_cursor.checked_list()?;
    let samplers = sampler_list.iter().collect::<Vec<_>>();
    let samplers = samplers
        .iter()
        .map(|cursor| sampler(cursor, accessors, shared, findings))
        .collect::<Checked<Vec<_>>>()?;
    let channels = channels_cursor.checked_list()?;
    let mut tracks = Vec::new();
    let mut targets = HashSet::new();
    for (index, channel) in channels.iter().enumerate() {
        let sampler = &samplers[channel.required("sampler")?.index(samplers.len(), "sampler")?];
        let target_cursor = channel.required("target")?.checked_object()?;
        let Some(target) = target(&target_cursor, driven, findings)? else { continue };
        if !targets.insert(target) {
            findings.add(
                channel.warning("an earlier channel drives the same: this one is left out", EXPORT_ANEW),
            );
            continue;
        }
        let Some(sampler) = sampler else { continue };
        let Some(track) = track(sampler, (target, index), driven, (accessors, shared), findings)? else {
            continue;
        };
        tracks.push(track);
    }
    Ok(Animation { name, tracks })
}

/// Reads a sampler; `None` (after a warning) if its times are not in the file.
fn sampler<'p, 't>(
    cursor: &'p Cursor<'p, 't>,
    accessors: &mut Accessors<'_, '_, '_>,
    shared: &mut Shared,
    findings: &mut Findings,
) -> Checked<Option<Sampler<'p, 't>>> {
    let interpolation = match cursor.member("interpolation") {
        None => Interpolation::Linear,
        Some(member) => match member.text()? {
            "LINEAR" => Interpolation::Linear,
            "STEP" => Interpolation::Step,
            "CUBICSPLINE" => Interpolation::CubicSpline,
            _ => return Err(member.error("the interpolation is none of LINEAR, STEP, CUBICSPLINE")),
        },
    };
    let input = cursor.required("input")?;
    let index = accessors.expect(&input, &[Shape::Scalar], &[Component::F32])?;
    accessors.warn_without_bounds(index, findings);
    let times_s = match shared.times.get(&index) {
        Some(times) => times.clone(),
        None => {
            let times = accessors.finite_floats::<1>(index, Integers::AsStated, findings)?;
            if times.is_empty() {
                return Err(input.error("the animation has no keys"));
            }
            if times[0][0] < 0.0 {
                findings.add(input.warning("the times begin before 0", ""));
            }
            // By the specification, an accessor without a buffer view holds zeros. As times they do not increase, but
            // that is no reason to refuse the file.
            let is_placeholder = accessors.get(index).run.is_none() && accessors.get(index).sparse.is_none();
            if is_placeholder && times.len() > 1 {
                findings.add(
                    input.warning("the times are not in the file: what they move stands still", EXPORT_ANEW),
                );
                return Ok(None);
            }
            if let Some(place) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
                let message = format!("the times of keys {place} and {} do not increase", place + 1);
                return Err(accessors.error_at(index, message));
            }
            let times = Arc::new(times.as_flattened().to_vec());
            shared.times.insert(index, times.clone());
            times
        }
    };
    let output = cursor.required("output")?;
    accessors.index(&output)?;
    Ok(Some(Sampler { times_s, interpolation, output }))
}

/// What a channel drives; `None` if it drives nothing or, after a warning, something that is not read.
fn target(cursor: &Cursor<'_, '_>, driven: &Driven<'_>, findings: &mut Findings) -> Checked<Option<Target>> {
    let path = cursor.required("path")?;
    let extensions = cursor.object("extensions")?;
    let extension = extensions.as_ref().map_or(Ok(None), |extensions| extensions.object(POINTER))?;
    let node = cursor.optional_index("node", driven.nodes.len(), "node")?;
    let property = match path.text()? {
        "translation" => NodeProperty::Translation,
        "rotation" => NodeProperty::Rotation,
        "scale" => NodeProperty::Scale,
        "weights" => NodeProperty::Weights,
        "pointer" => {
            let Some(extension) = extension else {
                let message = "the path is \"pointer\", and there is no pointer: the channel is left out";
                findings.add(cursor.warning(message, EXPORT_ANEW));
                return Ok(None);
            };
            if node.is_some() {
                findings.add(cursor.warning("a pointer stands beside a node, which is left out", ""));
            }
            let member = extension.required("pointer")?;
            return pointed(&member, driven, findings);
        }
        _ => {
            findings.add(path.warning("such a path is not known: the channel is left out", ""));
            return Ok(None);
        }
    };
    match node {
        // The specification says that such a channel drives nothing.
        None => Ok(None),
        Some(node) => checked(Target::Node(node, property), &path, driven, findings),
    }
}

fn pointed(member: &Cursor<'_, '_>, driven: &Driven<'_>, findings: &mut Findings) -> Checked<Option<Target>> {
    let text = member.text()?;
    if !text.starts_with('/') {
        return Err(member.error("it is no JSON pointer: it begins with no /"));
    }
    let Some(target) = pointer::target(text) else {
        let shown: String = text.chars().take(100).collect();
        findings.add(member.warning(format!("motion of {shown:?} is not read: the channel is left out"), ""));
        return Ok(None);
    };
    let (index, count) = match target {
        Target::Node(index, _) => (index, driven.nodes.len()),
        Target::Camera(index, _) => (index, driven.cameras.len()),
        Target::Light(index, _) => (index, driven.lights),
        Target::Material(index, _) => (index, driven.materials),
    };
    if index >= count {
        return Err(member.error(format!("the pointer leads to number {index}, and there are {count}")));
    }
    checked(target, member, driven, findings)
}

/// The target; `None` (after a warning) if it has nothing that could be driven.
fn checked(
    target: Target,
    cursor: &Cursor<'_, '_>,
    driven: &Driven<'_>,
    findings: &mut Findings,
) -> Checked<Option<Target>> {
    let complaint = match target {
        Target::Node(node, NodeProperty::Weights) if target_count(node, driven) == 0 => {
            Some("the node has no morph targets: the channel is left out")
        }
        Target::Node(node, NodeProperty::Translation | NodeProperty::Rotation | NodeProperty::Scale)
            if matches!(driven.nodes[node].local, LocalTransform::Matrix(_)) =>
        {
            Some("the node has a matrix with shear, and stands still: the channel is left out")
        }
        Target::Camera(camera, property) => {
            let is_perspective = matches!(driven.cameras[camera].lens, Lens::Perspective { .. });
            let is_wrong = match property {
                CameraProperty::Yfov => !is_perspective,
                CameraProperty::Xmag | CameraProperty::Ymag => is_perspective,
                CameraProperty::Znear | CameraProperty::Zfar => false,
            };
            is_wrong.then_some("the camera is of the other kind: the channel is left out")
        }
        _ => None,
    };
    if let Some(complaint) = complaint {
        findings.add(cursor.warning(complaint, ""));
        return Ok(None);
    }
    Ok(Some(target))
}

fn target_count(node: usize, driven: &Driven<'_>) -> usize {
    driven.nodes[node].mesh.map_or(0, |mesh| driven.meshes[mesh].target_count)
}

fn track(
    sampler: &Sampler<'_, '_>,
    (target, channel): (Target, usize),
    driven: &Driven<'_>,
    (accessors, shared): (&mut Accessors<'_, '_, '_>, &mut Shared),
    findings: &mut Findings,
) -> Checked<Option<Track>> {
    const ANY: [Component; 5] =
        [Component::F32, Component::I8, Component::U8, Component::I16, Component::U16];
    let output = &sampler.output;
    // The shape of an element, and how many elements make a value.
    let (shape, elements) = match target {
        Target::Node(node, NodeProperty::Weights) => (Shape::Scalar, target_count(node, driven)),
        Target::Node(_, NodeProperty::Rotation) | Target::Material(_, MaterialProperty::BaseColor) => {
            (Shape::Vector(4), 1)
        }
        Target::Node(_, NodeProperty::Translation | NodeProperty::Scale)
        | Target::Light(_, LightProperty::Color)
        | Target::Material(_, MaterialProperty::EmissiveFactor) => (Shape::Vector(3), 1),
        _ => (Shape::Scalar, 1),
    };
    let components: &[Component] = match target {
        Target::Node(_, NodeProperty::Translation | NodeProperty::Scale) => &[Component::F32],
        _ => &ANY,
    };
    let index = accessors.expect(output, &[shape], components)?;
    // True and false are written as plain bytes, which are not normalised.
    let is_truth = matches!(target, Target::Node(_, NodeProperty::Visible));
    let integers = if is_truth { Integers::AsStated } else { Integers::Normalized };
    let per_key = if sampler.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let wanted = sampler.times_s.len().saturating_mul(per_key).saturating_mul(elements);
    let there = accessors.get(index).count;
    if there != wanted {
        let message = format!("accessor {index} has {there} elements, and {wanted} go with the keys' times");
        return Err(output.error(message));
    }
    let key = (index, is_truth);
    let values = match shared.values.get(&key) {
        Some(values) => values.clone(),
        None => {
            accessors.take_memory(there, 4 * shape.width(), output)?;
            let values = match shape.width() {
                4 => accessors.finite_floats::<4>(index, integers, findings)?.as_flattened().to_vec(),
                3 => accessors.finite_floats::<3>(index, integers, findings)?.as_flattened().to_vec(),
                _ => accessors.finite_floats::<1>(index, integers, findings)?.as_flattened().to_vec(),
            };
            let values = Arc::new(values);
            shared.values.insert(key, values.clone());
            values
        }
    };
    if matches!(target, Target::Node(_, NodeProperty::Rotation)) && shared.rotations.insert((index, per_key))
    {
        check_rotations(&values, per_key, index, accessors, findings)?;
    }
    let interpolation = if is_truth { Interpolation::Step } else { sampler.interpolation };
    if is_truth && sampler.interpolation != Interpolation::Step {
        findings.add(output.warning("what is true or false has no values between: it steps", ""));
        if per_key == 3 {
            return Ok(None);
        }
    }
    let width = shape.width() * elements;
    Ok(Some(Track { target, channel, times_s: sampler.times_s.clone(), values, width, interpolation }))
}

fn check_rotations(
    values: &[f32],
    per_key: usize,
    index: usize,
    accessors: &Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<()> {
    let mut is_off = false;
    // With splines, a key has three elements: in-tangent, value, out-tangent.
    for (key, quaternion) in values.chunks_exact(4).skip(per_key / 2).step_by(per_key).enumerate() {
        let length_squared: f32 = quaternion.iter().map(|number| number * number).sum();
        if !(length_squared > 1e-12 && length_squared.is_finite()) {
            return Err(accessors.error_at(index, format!("the rotation of key {key} is no quaternion")));
        }
        is_off |= (length_squared - 1.0).abs() > 0.02;
    }
    if is_off {
        let mut finding =
            *accessors.error_at(index, "some rotations are not of unit length, and are scaled".to_owned());
        finding.severity = crate::Severity::Warning;
        findings.add(finding);
    }
    Ok(())
}
