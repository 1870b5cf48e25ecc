//! Adds a mesh to a scene: an object beside the others, and regions for its groups or materials.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{object_name, round_to};
use crate::built_in_mesh;
use crate::document::{Color, Object, ObjectKey, Region, Scene, Selector};
use crate::limits;
use crate::mesh_file::MeshFile;
use crate::motion;

/// Colours of regions in overlays, distinguishable with colour blindness too (Krzywinski's twelve); neighbours in this
/// list differ most.
pub const REGION_COLORS: [Color; 12] = [
    rgb(0x00, 0x8d, 0xf9),
    rgb(0xff, 0xc3, 0x3b),
    rgb(0x9f, 0x01, 0x62),
    rgb(0x00, 0xfc, 0xcf),
    rgb(0xe2, 0x01, 0x34),
    rgb(0xff, 0xb2, 0xfd),
    rgb(0x00, 0x9f, 0x81),
    rgb(0xff, 0x6e, 0x3a),
    rgb(0x84, 0x00, 0xcd),
    rgb(0x00, 0xc2, 0xf9),
    rgb(0xff, 0x5a, 0xaf),
    rgb(0xa4, 0x01, 0x22),
];

const fn rgb(red: u8, green: u8, blue: u8) -> Color {
    Color([red as f32 / 255.0, green as f32 / 255.0, blue as f32 / 255.0])
}

/// A mesh with more groups (or materials) than this gets no regions from them: so many are hardly separate things to
/// paint.
const MOST_REGIONS: usize = 64;

/// Gap between a new object and the others, as a share of its width or depth, whichever is larger.
const GAP: f64 = 0.15;

/// Adds an object with this mesh, named `mesh_name` in the scene, and its regions ([`regions_of`]). Returns the
/// object's name, which is the file's, made unique.
///
/// The first object stays where its file puts it. A later one stands to the right of all others, at the height of their
/// lowest point in the reference pose. `meshes` are those of the scene; objects whose mesh is not among them, and
/// built-in meshes, are ignored.
pub fn add_mesh(
    scene: &mut Scene,
    mesh_name: &str,
    mesh: &MeshFile,
    meshes: &BTreeMap<String, Arc<MeshFile>>,
) -> String {
    let taken: HashSet<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    let name = unique(&object_name(Path::new(mesh_name)), &taken);
    let mut object = Object::new(name.clone(), mesh_name);
    if let (Some([low, high]), Some([own_low, own_high])) =
        (bounds_of_all(scene, meshes), bounds(&object, mesh, DAffine3::IDENTITY))
    {
        let size = own_high - own_low;
        let off = GAP * size.x.max(size.z);
        let middle = (low + high) * 0.5 - (own_low + own_high) * 0.5;
        let to = DVec3::new(high.x + off - own_low.x, low.y - own_low.y, middle.z);
        let step = size.length().max(f64::MIN_POSITIVE) * 1e-4;
        object.keys = vec![ObjectKey { translation: round_to(to, step).to_array(), ..ObjectKey::at(0.0) }];
    }
    for region in regions_of(&object, mesh) {
        let taken: HashSet<&str> = scene.regions.iter().map(|region| region.name.as_str()).collect();
        let name = unique(&region.name, &taken);
        let color = Some(REGION_COLORS[scene.regions.len() % REGION_COLORS.len()]);
        scene.regions.push(Region { name, color, ..region });
    }
    scene.objects.push(object);
    name
}

/// A region for each group of an object's mesh, or else for each material, or else one for the whole object. Groups (or
/// materials) get regions if triangles use 2 to 64 of them and the object shows the whole mesh; unused ones get none.
/// The regions' names differ; their colours are [`REGION_COLORS`] in order.
pub fn regions_of(object: &Object, mesh: &MeshFile) -> Vec<Region> {
    let own = |selector: fn(String, String) -> Selector| {
        move |name: &str| (name.to_owned(), selector(object.name.clone(), name.to_owned()))
    };
    let used = |of_triangle: &[u32], count: usize| -> Vec<usize> {
        let used: HashSet<u32> = of_triangle.iter().copied().collect();
        (0..count).filter(|&index| used.contains(&(index as u32))).collect()
    };
    let makes_regions = |count: usize| (2..=MOST_REGIONS).contains(&count);
    let groups = used(&mesh.mesh.group_of_triangle, mesh.groups.len());
    let materials = used(&mesh.mesh.material_of_triangle, mesh.materials.len());
    let found: Vec<(String, Selector)> = if object.group.is_none() && makes_regions(groups.len()) {
        groups.iter().map(|&group| mesh.groups[group].as_str()).map(own(Selector::Group)).collect()
    } else if object.group.is_none() && makes_regions(materials.len()) {
        let names = materials.iter().map(|&material| mesh.materials[material].name.as_str());
        names.map(own(Selector::Material)).collect()
    } else {
        vec![(object.name.clone(), Selector::Object(object.name.clone()))]
    };
    let mut regions: Vec<Region> = Vec::with_capacity(found.len());
    for (index, (name, on)) in found.into_iter().enumerate() {
        let taken: HashSet<&str> = regions.iter().map(|region| region.name.as_str()).collect();
        let name = unique(&plain(&name, &object.name), &taken);
        let color = Some(REGION_COLORS[index % REGION_COLORS.len()]);
        regions.push(Region { color, ..Region::new(name, on) });
    }
    regions
}

/// The groups of a mesh that triangles use.
pub(super) fn used_groups(mesh: &MeshFile) -> Vec<usize> {
    let used: HashSet<u32> = mesh.mesh.group_of_triangle.iter().copied().collect();
    (0..mesh.groups.len()).filter(|&index| used.contains(&(index as u32))).collect()
}

/// A valid name for the object that is one group of a model.
pub(super) fn object_name_of_group(group: &str, model: &str, taken: &HashSet<&str>) -> String {
    unique(&plain(group, model), taken)
}

/// A valid name: `name` on one line, `else_name` if that is empty, and short enough for [`unique`] to add a number.
fn plain(name: &str, else_name: &str) -> String {
    let name = name.replace(char::is_control, " ");
    let name = match name.trim() {
        "" => else_name,
        name => name,
    };
    let mut end = name.len().min(limits::MAX_NAME_BYTES - 16);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    name[..end].to_owned()
}

/// The name, with the first free number behind it if it is taken.
pub(super) fn unique(name: &str, taken: &HashSet<&str>) -> String {
    let mut numbered = (2..).map(|number: u32| format!("{name} {number}"));
    if !taken.contains(name) {
        return name.to_owned();
    }
    numbered.find(|numbered| !taken.contains(numbered.as_str())).unwrap_or_default()
}

/// Least and greatest corner of the box round all objects in the reference pose, world space, without built-in meshes.
fn bounds_of_all(scene: &Scene, meshes: &BTreeMap<String, Arc<MeshFile>>) -> Option<[DVec3; 2]> {
    let poses = motion::poses_at(scene, motion::referred_to(scene, &scene.reference).1);
    let of_objects = scene.objects.iter().zip(poses).filter_map(|(object, pose)| {
        let is_file = !built_in_mesh::is_built_in(&object.mesh);
        bounds(object, meshes.get(&object.mesh).filter(|_| is_file)?, pose)
    });
    of_objects.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)])
}

/// The box round an object's whole mesh, world space.
fn bounds(object: &Object, mesh: &MeshFile, pose: DAffine3) -> Option<[DVec3; 2]> {
    let (low, high) = mesh.mesh.bounds()?;
    let corners = (0..8).map(|corner| {
        let pick = |axis: usize| f64::from(if corner >> axis & 1 == 1 { high[axis] } else { low[axis] });
        pose.transform_point3(object.model_from_file() * DVec3::new(pick(0), pick(1), pick(2)))
    });
    let boxes = corners.map(|corner| [corner; 2]);
    boxes.reduce(|[low, high], [corner, _]| [low.min(corner), high.max(corner)])
}
