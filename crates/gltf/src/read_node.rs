//! Reads nodes, skins and scenes, and checks that nodes make trees.

use std::sync::Arc;

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};
use glam::{DAffine3, DMat4, DQuat, DVec3, Mat4};

use crate::accessor::{Component, Shape};
use crate::cursor::Cursor;
use crate::decode::{Accessors, Integers};
use crate::extensions::{INSTANCING, LIGHTS, VISIBILITY};
use crate::finding::{Checked, EXPORT_ANEW, Findings};
use crate::mesh::{Mesh, Primitive};
use crate::node::{LocalTransform, Node, Skin, Trs};
use crate::read_mesh;

/// What nodes refer to.
pub(crate) struct Referred<'a> {
    pub nodes: usize,
    pub meshes: &'a [Arc<Mesh>],
    pub cameras: usize,
    pub lights: usize,
    pub skins: &'a [Skin],
    pub joints_of_meshes: &'a [Joints],
}

/// What a mesh asks of a skin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joints {
    /// Some primitive has no joints.
    pub is_partial: bool,
    /// The largest joint with a weight; `None`: no primitive has joints.
    pub largest: Option<u16>,
}

impl Joints {
    pub fn of(mesh: &Mesh) -> Self {
        let largest =
            |primitive: &Primitive| primitive.influences.as_ref().map(|joints| joints.largest_joint);
        Self {
            is_partial: mesh.primitives.iter().any(|primitive| primitive.influences.is_none()),
            largest: mesh.primitives.iter().filter_map(largest).max(),
        }
    }
}

pub(crate) fn skins(
    root: &Cursor<'_, '_>,
    accessors: &mut Accessors<'_, '_, '_>,
    nodes: usize,
    findings: &mut Findings,
) -> Checked<Vec<Skin>> {
    let list = root.list("skins")?;
    let mut skins = Vec::new();
    for cursor in list.iter() {
        let skin = skin(&cursor, accessors, nodes, findings);
        skins.extend(findings.take(skin));
        if findings.is_full() {
            break;
        }
    }
    Ok(skins)
}

fn skin(
    cursor: &Cursor<'_, '_>,
    accessors: &mut Accessors<'_, '_, '_>,
    nodes: usize,
    findings: &mut Findings,
) -> Checked<Skin> {
    let joints_cursor = cursor.required("joints")?;
    let list = joints_cursor.clone().checked_list()?;
    let joints = list.iter().map(|joint| joint.index(nodes, "node")).collect::<Checked<Vec<_>>>()?;
    if joints.is_empty() {
        return Err(joints_cursor.error("the skin has no joints"));
    }
    accessors.take_memory(joints.len(), size_of::<Mat4>(), cursor)?;
    let inverse_bind_matrices = match cursor.member("inverseBindMatrices") {
        None => vec![Mat4::IDENTITY; joints.len()],
        Some(member) => {
            let index = accessors.expect(&member, &[Shape::Matrix(4)], &[Component::F32])?;
            let matrices = accessors.finite_floats::<16>(index, Integers::AsStated, findings)?;
            if matrices.len() < joints.len() {
                let message = format!("{} matrices stand for {} joints", matrices.len(), joints.len());
                return Err(member.error(message));
            }
            if matrices.len() > joints.len() {
                findings.add(member.warning("there are more matrices than joints", ""));
            }
            let is_affine = |matrix: &&[f32; 16]| {
                [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)]
                    .iter()
                    .all(|&(at, value)| (matrix[at] - value).abs() < 1e-4)
            };
            if !matrices.iter().take(joints.len()).all(|matrix| is_affine(&matrix)) {
                findings
                    .add(member.warning("the fourth row of a matrix is not 0, 0, 0, 1, and is left out", ""));
            }
            let matrices = matrices.iter().take(joints.len());
            matrices
                .map(|matrix| {
                    let mut matrix = *matrix;
                    for (at, value) in [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)] {
                        matrix[at] = value;
                    }
                    Mat4::from_cols_array(&matrix)
                })
                .collect()
        }
    };
    Ok(Skin {
        name: cursor.optional_text("name")?.unwrap_or_default().to_owned(),
        joints,
        inverse_bind_matrices,
        skeleton: cursor.optional_index("skeleton", nodes, "node")?,
    })
}

/// Reads `nodes`, and finds the parent of each.
pub(crate) fn nodes(
    root: &Cursor<'_, '_>,
    referred: &Referred<'_>,
    accessors: &mut Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<Vec<Node>> {
    let list = root.list("nodes")?;
    let mut nodes = Vec::new();
    for cursor in list.iter() {
        let node = node(&cursor, referred, accessors, findings);
        nodes.extend(findings.take(node));
        if findings.is_full() {
            break;
        }
    }
    if findings.any_fatal() {
        return Ok(nodes);
    }
    for parent in 0..nodes.len() {
        for place in 0..nodes[parent].children.len() {
            let child = nodes[parent].children[place];
            if let Some(other) = nodes[child].parent {
                let Some(cursor) = list.get(child) else { continue };
                return Err(cursor.error(format!("the node has two parents: nodes {other} and {parent}")));
            }
            nodes[child].parent = Some(parent);
        }
    }
    // Each node has at most one parent, so a node that no root leads to is in a circle of nodes or under one.
    let reached = parents_first(&nodes);
    if reached.len() < nodes.len() {
        let mut is_reached = vec![false; nodes.len()];
        reached.iter().for_each(|&node| is_reached[node] = true);
        if let Some(cursor) = is_reached.iter().position(|reached| !reached).and_then(|node| list.get(node)) {
            return Err(cursor.error("the node is its own ancestor, or under one that is"));
        }
    }
    name_uniquely(&mut nodes);
    Ok(nodes)
}

/// All nodes that a root leads to, parents before children.
pub(crate) fn parents_first(nodes: &[Node]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..nodes.len()).filter(|&node| nodes[node].parent.is_none()).collect();
    let mut next = 0;
    while next < order.len() {
        order.extend(&nodes[order[next]].children);
        next += 1;
    }
    order
}

fn node(
    cursor: &Cursor<'_, '_>,
    referred: &Referred<'_>,
    accessors: &mut Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<Node> {
    let cursor = &cursor.clone().checked_object()?;
    let children = cursor.list("children")?;
    let children =
        children.iter().map(|child| child.index(referred.nodes, "node")).collect::<Checked<Vec<_>>>()?;
    let mesh = cursor.optional_index("mesh", referred.meshes.len(), "mesh")?;
    let skin = cursor.optional_index("skin", referred.skins.len(), "skin")?;
    check_skin(
        cursor,
        mesh.map(|mesh| referred.joints_of_meshes[mesh]),
        skin.map(|skin| &referred.skins[skin]),
        findings,
    )?;
    let target_count = mesh.map_or(0, |mesh| referred.meshes[mesh].target_count);
    // Every pose holds the weights of the targets.
    accessors.take_memory(target_count, size_of::<f32>(), cursor)?;
    let extensions = cursor.object("extensions")?;
    let extension = |name| extensions.as_ref().map_or(Ok(None), |extensions| extensions.object(name));
    let light = match extension(LIGHTS)? {
        Some(light) => Some(light.required("light")?.index(referred.lights, "light")?),
        None => None,
    };
    let is_visible =
        extension(VISIBILITY)?.map_or(Ok(true), |visibility| visibility.truth_or("visible", true))?;
    let instances = match extension(INSTANCING)? {
        Some(instancing) => instances(&instancing, accessors, findings)?,
        None => None,
    };
    Ok(Node {
        name: String::new(),
        original_name: cursor.optional_text("name")?.map(str::to_owned),
        parent: None,
        children,
        mesh,
        camera: cursor.optional_index("camera", referred.cameras, "camera")?,
        light,
        skin,
        weights: read_mesh::weights(cursor, target_count)?,
        is_visible,
        local: local(cursor, findings)?,
        instances,
    })
}

fn check_skin(
    cursor: &Cursor<'_, '_>,
    mesh: Option<Joints>,
    skin: Option<&Skin>,
    findings: &mut Findings,
) -> Checked<()> {
    let Some(skin) = skin else { return Ok(()) };
    let Some(mesh) = mesh else {
        findings.add(cursor.warning("the node has a skin and no mesh", ""));
        return Ok(());
    };
    if mesh.is_partial {
        findings.add(cursor.warning("the node has a skin, and some of its mesh no joints", ""));
    }
    match mesh.largest {
        Some(largest) if usize::from(largest) >= skin.joints.len() => Err(cursor.error(format!(
            "the mesh names joint {largest}, and the skin has {} of them",
            skin.joints.len()
        ))),
        _ => Ok(()),
    }
}

fn local(cursor: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<LocalTransform> {
    let parts = ["translation", "rotation", "scale"];
    if let Some(member) = cursor.member("matrix") {
        if parts.iter().any(|part| cursor.member(part).is_some()) {
            findings.add(
                member.warning("the node has a matrix and parts of one: the matrix is used", EXPORT_ANEW),
            );
        }
        let matrix = DMat4::from_cols_array(&member.numbers::<16>()?);
        if matrix.row(3).to_array() != [0.0, 0.0, 0.0, 1.0] {
            return Err(member.error("the fourth row of the matrix is not 0, 0, 0, 1"));
        }
        let local = LocalTransform::of_matrix(DAffine3::from_mat4(matrix));
        if matches!(local, LocalTransform::Matrix(_)) {
            findings
                .add(member.warning("the matrix has shear or no volume: the node cannot be animated", ""));
        }
        return Ok(local);
    }
    let translation = DVec3::from(cursor.numbers_or("translation", [0.0; 3])?);
    let scale = DVec3::from(cursor.numbers_or("scale", [1.0; 3])?);
    let rotation = DQuat::from_array(cursor.numbers_or("rotation", [0.0, 0.0, 0.0, 1.0])?);
    if let Some(member) = cursor.member("rotation") {
        if rotation.length() < 1e-6 {
            return Err(member.error("the rotation is no quaternion: its length is 0"));
        }
        if (rotation.length() - 1.0).abs() > 5e-3 {
            findings.add(member.warning("the rotation is not of unit length, and is scaled", ""));
        }
    }
    Ok(LocalTransform::Trs(Trs { translation, rotation: rotation.normalize(), scale }))
}

fn instances(
    cursor: &Cursor<'_, '_>,
    accessors: &mut Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<Option<Arc<Vec<Trs>>>> {
    const TURN: [Component; 3] = [Component::F32, Component::I8, Component::I16];
    let attributes = cursor.required("attributes")?.checked_object()?;
    let mut count = None;
    for (_, member) in attributes.members() {
        let own = accessors.get(accessors.index(&member)?).count;
        if *count.get_or_insert(own) != own {
            return Err(member.error(format!("{own} values stand for {} instances", count.unwrap_or(0))));
        }
    }
    let Some(count) = count else {
        findings.add(attributes.warning("there are no attributes of instances", ""));
        return Ok(None);
    };
    accessors.take_memory(count, size_of::<Trs>(), cursor)?;
    let mut list = vec![Trs::IDENTITY; count];
    if let Some(member) = attributes.member("TRANSLATION") {
        let index = accessors.expect(&member, &[Shape::Vector(3)], &[Component::F32])?;
        let values = accessors.finite_floats::<3>(index, Integers::AsStated, findings)?;
        list.iter_mut()
            .zip(&**values)
            .for_each(|(trs, value)| trs.translation = DVec3::from(value.map(f64::from)));
    }
    if let Some(member) = attributes.member("SCALE") {
        let index = accessors.expect(&member, &[Shape::Vector(3)], &[Component::F32])?;
        let values = accessors.finite_floats::<3>(index, Integers::AsStated, findings)?;
        list.iter_mut().zip(&**values).for_each(|(trs, value)| trs.scale = DVec3::from(value.map(f64::from)));
    }
    if let Some(member) = attributes.member("ROTATION") {
        let index = accessors.expect(&member, &[Shape::Vector(4)], &TURN)?;
        let values = accessors.finite_floats::<4>(index, Integers::Normalized, findings)?;
        for (instance, (trs, value)) in list.iter_mut().zip(&**values).enumerate() {
            let rotation = DQuat::from_array(value.map(f64::from));
            if rotation.length() < 1e-6 {
                return Err(
                    accessors.error_at(index, format!("the rotation of instance {instance} has no length"))
                );
            }
            trs.rotation = rotation.normalize();
        }
    }
    Ok(Some(Arc::new(list)))
}

/// Names every node: its own name if it is the first to have it, else one that no node has.
fn name_uniquely(nodes: &mut [Node]) {
    let originals: HashSet<String> = nodes.iter().filter_map(|node| node.original_name.clone()).collect();
    let mut taken: HashSet<String> = HashSet::with_capacity(nodes.len());
    let mut doubles: HashMap<String, usize> = HashMap::new();
    for (index, node) in nodes.iter_mut().enumerate() {
        let own = node.original_name.clone().filter(|name| !name.is_empty());
        let wanted = own.clone().unwrap_or_else(|| format!("Node.{index}"));
        let is_free =
            |name: &str, taken: &HashSet<String>| !taken.contains(name) && !originals.contains(name);
        node.name = if own.is_some() && !taken.contains(&wanted) || is_free(&wanted, &taken) {
            wanted
        } else {
            let next = doubles.entry(wanted.clone()).or_insert(0);
            loop {
                *next += 1;
                let name = format!("{wanted}.{next:03}");
                if is_free(&name, &taken) {
                    break name;
                }
            }
        };
        taken.insert(node.name.clone());
    }
}

/// The roots of the scene that is shown: the stated one, else the first, else all nodes without parents.
pub(crate) fn roots(root: &Cursor<'_, '_>, nodes: &[Node], findings: &mut Findings) -> Checked<Vec<usize>> {
    let scenes = root.list("scenes")?;
    let chosen = root.optional_index("scene", scenes.len(), "scene")?;
    let mut roots_of_scenes = Vec::new();
    for scene in scenes.iter() {
        let list = scene.clone().checked_object()?;
        let list = list.list("nodes")?;
        let mut roots = Vec::new();
        let mut known = HashSet::new();
        for item in list.iter() {
            let node = item.index(nodes.len(), "node")?;
            if !known.insert(node) {
                findings.add(item.warning("the node is listed twice", ""));
                continue;
            }
            if nodes[node].parent.is_some() {
                findings.add(item.warning("the node is no root: it is shown with its parent's place", ""));
            }
            roots.push(node);
        }
        roots_of_scenes.push(roots);
    }
    if chosen.is_none() && !nodes.is_empty() {
        let message = if scenes.len() == 0 {
            "the file has no scene: all nodes are shown"
        } else {
            "the file does not say which scene is shown: the first is"
        };
        findings.add(root.warning(message, ""));
    }
    if scenes.len() == 0 {
        return Ok((0..nodes.len()).filter(|&node| nodes[node].parent.is_none()).collect());
    }
    let roots = roots_of_scenes.swap_remove(chosen.unwrap_or(0));
    if roots.is_empty() {
        findings.add(root.warning("the scene that is shown has no nodes", ""));
    }
    Ok(roots)
}
