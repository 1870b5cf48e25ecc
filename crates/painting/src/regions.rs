//! Which region each triangle of an object belongs to, and what holds there.

use impasto_scene::document::{Direction, Scene, Selector};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::presets::{self, ResolvedStrokes};

use crate::frame::ANY_COLOR;
use crate::lights::linear;

/// What holds in a region.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RegionRule {
    pub(crate) direction: Direction,
    pub(crate) strokes: ResolvedStrokes,
}

/// One rule per region of the scene, and last the implicit one for everything else.
pub(crate) fn rules(scene: &Scene) -> Vec<RegionRule> {
    let everything_else =
        RegionRule { direction: Direction::default(), strokes: presets::resolve(scene, None) };
    (0..scene.regions.len())
        .map(|index| RegionRule {
            direction: scene.regions[index].direction.clone(),
            strokes: presets::resolve(scene, Some(index)),
        })
        .chain([everything_else])
        .collect()
}

/// The palettes of all rules, linear, and for each rule the number of its own ([`ANY_COLOR`] where it has none).
pub(crate) fn palettes(rules: &[RegionRule]) -> (Vec<Vec<[f32; 3]>>, Vec<u8>) {
    let mut palettes: Vec<Vec<[f32; 3]>> = Vec::new();
    let of_rule = rules
        .iter()
        .map(|rule| {
            let palette: Vec<[f32; 3]> = rule.strokes.palette.iter().map(|&color| linear(color)).collect();
            if palette.is_empty() {
                return ANY_COLOR;
            }
            let known = palettes.iter().position(|other| *other == palette);
            let index = known.unwrap_or_else(|| {
                palettes.push(palette);
                palettes.len() - 1
            });
            // More palettes than a byte counts: the last ones are shared.
            index.min(usize::from(ANY_COLOR) - 1) as u8
        })
        .collect();
    (palettes, of_rule)
}

/// For each triangle of an object, the last region that covers it; the implicit one where none does.
pub(crate) fn of_triangles(
    scene: &Scene,
    object: &str,
    file: &MeshFile,
    mesh: &impasto_core::TriangleMesh,
) -> Vec<u16> {
    let mut of_triangle = vec![scene.regions.len() as u16; mesh.triangles.len()];
    for (index, region) in scene.regions.iter().enumerate() {
        let index = index as u16;
        match &region.on {
            Selector::Everything => of_triangle.fill(index),
            Selector::Object(name) if name == object => of_triangle.fill(index),
            Selector::Group(name, group) if name == object => {
                assign(&mut of_triangle, &mesh.group_of_triangle, index, |g| {
                    file.groups[g as usize] == *group
                });
            }
            Selector::Material(name, material) if name == object => {
                assign(&mut of_triangle, &mesh.material_of_triangle, index, |m| {
                    file.materials[m as usize].name == *material
                });
            }
            Selector::Object(_) | Selector::Group(..) | Selector::Material(..) => {}
        }
    }
    of_triangle
}

fn assign(of_triangle: &mut [u16], names: &[u32], region: u16, chosen: impl Fn(u32) -> bool) {
    for (slot, &name) in of_triangle.iter_mut().zip(names) {
        if chosen(name) {
            *slot = region;
        }
    }
}
