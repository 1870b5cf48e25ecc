//! Which region each point of an object belongs to, and what holds there.

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::direction::guide::{Falloff as GuideFalloff, Guide as SurfaceGuide};
use impasto_core::sampling::Particle;
use impasto_scene::document::{Dab, Direction, Falloff, Guide, Scene, Seam, Selector, Sense};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::presets::{self, ResolvedStrokes};

use crate::frame::ANY_COLOR;
use crate::lights::linear;

/// Surfaces turned away from a dab by more than this cosine are not touched by it.
const DAB_FACING: f32 = 0.0;

/// What holds in a region.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RegionRule {
    pub(crate) direction: Direction,
    pub(crate) seam: Seam,
    pub(crate) sense: Sense,
    pub(crate) strokes: ResolvedStrokes,
}

/// One rule per region of the scene, and last the implicit one for everything else.
pub(crate) fn rules(scene: &Scene) -> Vec<RegionRule> {
    let everything_else = RegionRule {
        direction: Direction::default(),
        seam: Seam::default(),
        sense: Sense::default(),
        strokes: presets::resolve(scene, None),
    };
    (0..scene.regions.len())
        .map(|index| RegionRule {
            direction: scene.regions[index].direction.clone(),
            seam: scene.regions[index].seam,
            sense: scene.regions[index].sense,
            strokes: presets::resolve(scene, Some(index)),
        })
        .chain([everything_else])
        .collect()
}

/// A guide on one object, with the region that it belongs to and the eye and target of its view in model space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyGuide {
    pub(crate) rule: u16,
    pub(crate) guide: SurfaceGuide,
    pub(crate) view: Option<[DVec3; 2]>,
}

/// The guides of an object, in the order of the file; those without a direction are left out (`check` refuses them).
pub(crate) fn guides(scene: &Scene, object: &str) -> Vec<BodyGuide> {
    let mut guides = Vec::new();
    for (rule, region) in scene.regions.iter().enumerate() {
        for guide in &region.guides {
            if guide.object.as_deref().or(region.on.object()) == Some(object) {
                guides.extend(surface_guide(guide).map(|surface| BodyGuide {
                    rule: rule as u16,
                    guide: surface,
                    view: guide.view.as_ref().map(|view| [view.eye, view.target].map(DVec3::from)),
                }));
            }
        }
    }
    guides
}

fn surface_guide(guide: &Guide) -> Option<SurfaceGuide> {
    let falloff = match guide.falloff {
        Falloff::Smooth => GuideFalloff::Smooth,
        Falloff::Linear => GuideFalloff::Linear,
        Falloff::Flat => GuideFalloff::Flat,
    };
    let points = guide.points.iter().map(|point| (DVec3::from(point.at), DVec3::from(point.normal)));
    SurfaceGuide::new(points, guide.radius, guide.strength, falloff)
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

/// The regions of one object.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyRegions {
    /// For each triangle, the last region that covers it whole; the implicit one where none does.
    of_triangle: Vec<u16>,
    /// Regions made of dabs, in the order of the file.
    dabbed: Vec<Dabbed>,
    implicit: u16,
}

/// A region made of dabs, sorted into cells as wide as the largest dab.
#[derive(Clone, Debug, PartialEq)]
struct Dabbed {
    rule: u16,
    cell: f32,
    dabs: Vec<(Vec3, Vec3, f32)>,
    in_cell: HashMap<IVec3, Vec<u32>>,
}

impl BodyRegions {
    /// The regions of an object with this mesh.
    pub(crate) fn new(scene: &Scene, object: &str, file: &MeshFile, mesh: &TriangleMesh) -> Self {
        let implicit = scene.regions.len() as u16;
        let mut regions =
            Self { of_triangle: vec![implicit; mesh.triangles.len()], dabbed: Vec::new(), implicit };
        for (index, region) in scene.regions.iter().enumerate() {
            let index = index as u16;
            let of_triangle = &mut regions.of_triangle;
            match &region.on {
                Selector::Everything => of_triangle.fill(index),
                Selector::Object(name) if name == object => of_triangle.fill(index),
                Selector::Group(name, group) if name == object => {
                    assign(of_triangle, &mesh.group_of_triangle, index, |g| {
                        file.groups[g as usize] == *group
                    });
                }
                Selector::Material(name, material) if name == object => {
                    assign(of_triangle, &mesh.material_of_triangle, index, |m| {
                        file.materials[m as usize].name == *material
                    });
                }
                Selector::Dabs(name, dabs) if name == object && !dabs.is_empty() => {
                    regions.dabbed.push(Dabbed::new(index, dabs));
                }
                Selector::Object(_) | Selector::Group(..) | Selector::Material(..) | Selector::Dabs(..) => {}
            }
        }
        regions
    }

    /// The region of a particle: the last that covers it.
    pub(crate) fn of(&self, particle: &Particle) -> u16 {
        let whole = self.of_triangle[particle.triangle as usize];
        let later = |dabbed: &&Dabbed| whole == self.implicit || dabbed.rule > whole;
        let mut touching = self.dabbed.iter().rev().filter(later);
        touching
            .find(|dabbed| dabbed.touches(particle.position, particle.normal))
            .map_or(whole, |dabbed| dabbed.rule)
    }

    /// The regions that may show on a triangle, without order.
    pub(crate) fn on_triangle(&self, mesh: &TriangleMesh, triangle: usize) -> impl Iterator<Item = u16> + '_ {
        let [a, b, c] = mesh.corners(triangle);
        let center = (a + b + c) / 3.0;
        let reach = [a, b, c].iter().map(|corner| corner.distance(center)).fold(0.0, f32::max);
        let touching = self.dabbed.iter().filter(move |dabbed| dabbed.may_touch(center, reach));
        [self.of_triangle[triangle]].into_iter().chain(touching.map(|dabbed| dabbed.rule))
    }

    /// All regions that may show on the object.
    pub(crate) fn all(&self) -> Vec<u16> {
        let mut all: Vec<u16> =
            self.of_triangle.iter().copied().chain(self.dabbed.iter().map(|dabbed| dabbed.rule)).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

impl Dabbed {
    fn new(rule: u16, dabs: &[Dab]) -> Self {
        let dabs: Vec<(Vec3, Vec3, f32)> = dabs
            .iter()
            .map(|dab| {
                let [at, normal] = [dab.at, dab.normal].map(|v| DVec3::from(v).as_vec3());
                (at, normal.normalize_or(Vec3::Y), dab.radius as f32)
            })
            .collect();
        let cell = dabs.iter().map(|&(.., radius)| radius).fold(f32::MIN_POSITIVE, f32::max);
        let mut in_cell: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for (index, &(at, ..)) in dabs.iter().enumerate() {
            in_cell.entry((at / cell).floor().as_ivec3()).or_default().push(index as u32);
        }
        Self { rule, cell, dabs, in_cell }
    }

    fn touches(&self, at: Vec3, normal: Vec3) -> bool {
        self.near(at, 1)
            .any(|&(center, facing, radius)| center.distance(at) <= radius && facing.dot(normal) > DAB_FACING)
    }

    /// Whether any dab may reach a ball.
    fn may_touch(&self, center: Vec3, reach: f32) -> bool {
        let reaches = |&(at, _, radius): &(Vec3, Vec3, f32)| at.distance(center) <= radius + reach;
        if reach <= self.cell { self.near(center, 2).any(reaches) } else { self.dabs.iter().any(reaches) }
    }

    /// The dabs in the cells that are at most so many away.
    fn near(&self, at: Vec3, cells: i32) -> impl Iterator<Item = &(Vec3, Vec3, f32)> {
        let home = (at / self.cell).floor().as_ivec3();
        let span = -cells..=cells;
        span.clone()
            .flat_map(move |x| span.clone().map(move |y| (x, y)))
            .flat_map(move |(x, y)| (-cells..=cells).map(move |z| IVec3::new(x, y, z)))
            .filter_map(move |offset| self.in_cell.get(&home.saturating_add(offset)))
            .flatten()
            .map(|&dab| &self.dabs[dab as usize])
    }
}

fn assign(of_triangle: &mut [u16], names: &[u32], region: u16, chosen: impl Fn(u32) -> bool) {
    for (slot, &name) in of_triangle.iter_mut().zip(names) {
        if chosen(name) {
            *slot = region;
        }
    }
}
