//! Which region each point of an object belongs to, and the rule of each region.

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::direction::guide::{Falloff as GuideFalloff, Guide as SurfaceGuide, GuidePoint};
use impasto_core::flood::flooded;
use impasto_core::sampling::Particle;
use impasto_scene::document::{
    Dab, Direction, Falloff, Guide, GuideMode, PatchRef, Scene, Seam, Sense, StrokesKey,
};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::presets::{self, ResolvedStrokes};

use crate::frame::{ANY_COLOR, Palette};
use crate::kept::KeyHasher;
use crate::lights::linear;
use crate::references::Standing;

/// A dab touches a surface only where the cosine between their normals is above this.
const DAB_FACING: f32 = 0.0;

/// A rule: the resolved settings of a region.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RegionRule {
    pub(crate) direction: Direction,
    /// An angle that is added to all its directions, radians counter-clockwise as seen in the reference.
    pub(crate) turn_rad: f64,
    pub(crate) seam: Seam,
    pub(crate) sense: Sense,
    pub(crate) strokes: ResolvedStrokes,
}

/// One rule per region of the scene, and last the implicit one for everything else.
pub(crate) fn rules(scene: &Scene) -> Vec<RegionRule> {
    let everything_else = RegionRule {
        direction: Direction::default(),
        turn_rad: 0.0,
        seam: Seam::default(),
        sense: Sense::default(),
        strokes: presets::resolve(scene, None),
    };
    (0..scene.regions.len())
        .map(|index| RegionRule {
            direction: scene.regions[index].direction.clone(),
            turn_rad: scene.regions[index].turn_deg.to_radians(),
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
    pub(crate) mode: GuideMode,
    pub(crate) guide: SurfaceGuide,
    pub(crate) view: Option<BodyGuideView>,
}

/// The view in which a guide was drawn, model space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyGuideView {
    pub(crate) eye: DVec3,
    pub(crate) target: DVec3,
    pub(crate) frame: Option<f64>,
    /// The body at that frame; at rest without a frame.
    pub(crate) stands: Standing,
}

impl BodyGuide {
    pub(crate) fn feed_key(&self, key: &mut KeyHasher) {
        let Self { rule, mode, guide, view } = self;
        key.value(&(rule, mode, guide));
        key.numbers(&[u8::from(view.is_some())]);
        if let Some(BodyGuideView { eye, target, frame, stands }) = view {
            key.value(&(eye, target, frame));
            stands.feed_key(key);
        }
    }
}

/// The guides of an object, in the order of the file; those without a direction are left out (`check` refuses them).
pub(crate) fn guides(scene: &Scene, object: &str) -> Vec<BodyGuide> {
    let mut guides = Vec::new();
    for (rule, region) in scene.regions.iter().enumerate() {
        // Guides that smooth nothing are left out, so that the body's field is not solved needlessly.
        let is_idle = |guide: &&Guide| guide.mode == GuideMode::Smooth && guide.strength <= 0.0;
        for guide in region.guides.iter().filter(|guide| !is_idle(guide)) {
            if guide.object.as_deref().or(region.on.object()) == Some(object) {
                guides.extend(surface_guide(guide).map(|surface| BodyGuide {
                    rule: rule as u16,
                    mode: guide.mode,
                    guide: surface,
                    view: guide.view.as_ref().map(|view| BodyGuideView {
                        eye: view.eye.into(),
                        target: view.target.into(),
                        frame: view.frame,
                        stands: Standing::default(),
                    }),
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
    let points = guide.points.iter().map(|point| GuidePoint {
        position: DVec3::from(point.at),
        normal: DVec3::from(point.normal),
        turn_rad: point.turn_deg.to_radians(),
    });
    SurfaceGuide::new(points, guide.radius, guide.strength, falloff)
}

/// The palettes of all rules in linear light, and for each rule the index of its palette ([`ANY_COLOR`] if it has
/// none). Rules share a palette if their pigments and their keys of strokes are equal, since keys change its `mix`.
pub(crate) fn palettes(rules: &[RegionRule]) -> (Vec<Palette>, Vec<u8>) {
    let mut palettes: Vec<Palette> = Vec::new();
    let mut keys: Vec<&[StrokesKey]> = Vec::new();
    let of_rule = rules
        .iter()
        .map(|rule| {
            let pigments: Vec<[f32; 3]> = rule.strokes.palette.iter().map(|&color| linear(color)).collect();
            if pigments.is_empty() {
                return ANY_COLOR;
            }
            let palette = Palette { pigments, mix: 1.0 };
            let mut known = palettes.iter().zip(&keys);
            let known = known.position(|(other, keys)| *other == palette && *keys == rule.strokes.keys);
            let index = known.unwrap_or_else(|| {
                palettes.push(palette);
                keys.push(&rule.strokes.keys);
                palettes.len() - 1
            });
            // A byte can number no more palettes, so rules with a further palette get the last number.
            index.min(usize::from(ANY_COLOR) - 1) as u8
        })
        .collect();
    (palettes, of_rule)
}

/// The regions of one object.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyRegions {
    /// For each triangle, the last of the regions without dabs that covers it; the implicit region where none does.
    of_triangle: Vec<u16>,
    /// Regions that have dabs, in the order of the file.
    dabbed: Vec<Dabbed>,
    implicit: u16,
}

/// A region with dabs. The dabs are sorted into cells, whose side is the largest radius of a dab.
#[derive(Clone, Debug, PartialEq)]
struct Dabbed {
    rule: u16,
    cell: f32,
    dabs: Vec<PlacedDab>,
    in_cell: HashMap<IVec3, Vec<u32>>,
    /// For each triangle, 0 if no patch other than dabs (a group, a material, …) covers it; else 1 + the number of dabs
    /// that come before the last such patch. Empty if all patches are dabs.
    whole: Vec<u32>,
}

/// A dab. Where two dabs touch a point, the later one decides.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlacedDab {
    at: Vec3,
    facing: Vec3,
    radius: f32,
    take_away: bool,
}

impl BodyRegions {
    pub(crate) fn new(scene: &Scene, object: &str, file: &MeshFile, mesh: &TriangleMesh) -> Self {
        let implicit = scene.regions.len() as u16;
        let mut regions =
            Self { of_triangle: vec![implicit; mesh.triangles.len()], dabbed: Vec::new(), implicit };
        for (index, region) in scene.regions.iter().enumerate() {
            if !region.on.reaches(&scene.stage, object) {
                continue;
            }
            let index = index as u16;
            let patches = region.on.patches();
            let has_dabs =
                patches.iter().any(|patch| matches!(patch, PatchRef::Dabs(dabs) if !dabs.is_empty()));
            if has_dabs {
                regions.dabbed.push(Dabbed::new(index, &patches, file, mesh));
                continue;
            }
            for patch in patches {
                cover(&mut regions.of_triangle, file, mesh, patch, index);
            }
        }
        regions
    }

    /// The region of a particle: the last that covers it.
    pub(crate) fn of(&self, particle: &Particle) -> u16 {
        let whole = self.of_triangle[particle.triangle as usize];
        let later = |dabbed: &&Dabbed| whole == self.implicit || dabbed.rule > whole;
        let mut covering = self.dabbed.iter().rev().filter(later);
        covering.find(|dabbed| dabbed.covers(particle)).map_or(whole, |dabbed| dabbed.rule)
    }

    /// The region of a triangle, not counting dabs.
    #[inline]
    pub(crate) fn of_triangle(&self, triangle: usize) -> u16 {
        self.of_triangle[triangle]
    }

    pub(crate) fn feed_key(&self, key: &mut KeyHasher) {
        let Self { of_triangle, dabbed, implicit } = self;
        key.numbers(of_triangle);
        key.numbers(&[*implicit]);
        // Which dabs are in which cell follows from the dabs.
        for Dabbed { rule, cell, dabs, in_cell: _, whole } in dabbed {
            key.value(&(rule, cell));
            dabs.iter().for_each(|dab| key.value(dab));
            key.numbers(whole);
        }
    }

    /// Whether there are dabs, so that particles of one triangle may belong to different regions.
    pub(crate) fn has_dabs(&self) -> bool {
        !self.dabbed.is_empty()
    }

    /// The regions that may show on a triangle, in no order.
    pub(crate) fn on_triangle(&self, mesh: &TriangleMesh, triangle: usize) -> impl Iterator<Item = u16> + '_ {
        let [a, b, c] = mesh.corners(triangle);
        let center = (a + b + c) / 3.0;
        let reach = [a, b, c].iter().map(|corner| corner.distance(center)).fold(0.0, f32::max);
        let touching = self.dabbed.iter().filter(move |dabbed| {
            dabbed.whole.get(triangle).is_some_and(|&whole| whole > 0) || dabbed.may_touch(center, reach)
        });
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

/// Writes `value` for each triangle that a patch covers. Dabs are skipped, because they cover no whole triangles.
fn cover<T: Copy>(
    of_triangle: &mut [T],
    file: &MeshFile,
    mesh: &TriangleMesh,
    patch: PatchRef<'_>,
    value: T,
) {
    let mut assign = |names: &[u32], name: Option<usize>| {
        for (slot, _) in of_triangle.iter_mut().zip(names).filter(|(_, own)| Some(**own as usize) == name) {
            *slot = value;
        }
    };
    match patch {
        PatchRef::Whole => of_triangle.fill(value),
        PatchRef::Group(group) => {
            assign(&mesh.group_of_triangle, file.groups.iter().position(|known| known == group));
        }
        PatchRef::Material(material) => {
            let known = file.materials.iter().position(|known| known.name == material);
            assign(&mesh.material_of_triangle, known);
        }
        PatchRef::Flood(seed, sharp_deg) => {
            let [at, normal] = [seed.at, seed.normal].map(DVec3::from);
            let reached = flooded(mesh, at, normal, sharp_deg.to_radians());
            for (slot, _) in of_triangle.iter_mut().zip(reached).filter(|(_, reached)| *reached) {
                *slot = value;
            }
        }
        PatchRef::Dabs(_) => {}
    }
}

impl Dabbed {
    fn new(rule: u16, patches: &[PatchRef<'_>], file: &MeshFile, mesh: &TriangleMesh) -> Self {
        let mut dabs = Vec::new();
        let mut whole = Vec::new();
        for &patch in patches {
            match patch {
                PatchRef::Dabs(own) => dabs.extend(own.iter().map(PlacedDab::of)),
                _ => {
                    whole.resize(mesh.triangles.len(), 0);
                    cover(&mut whole, file, mesh, patch, dabs.len() as u32 + 1);
                }
            }
        }
        let cell = dabs.iter().map(|dab| dab.radius).fold(f32::MIN_POSITIVE, f32::max);
        let mut in_cell: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for (index, dab) in dabs.iter().enumerate() {
            in_cell.entry((dab.at / cell).floor().as_ivec3()).or_default().push(index as u32);
        }
        Self { rule, cell, dabs, in_cell, whole }
    }

    /// Whether the last patch or dab that reaches the particle adds it to the region.
    fn covers(&self, particle: &Particle) -> bool {
        let whole = self.whole.get(particle.triangle as usize).copied().unwrap_or(0);
        let touching = self.near(particle.position, 1).filter(|&dab| {
            // The last patch that covers the triangle overrides the dabs before it.
            dab + 1 >= whole && self.dabs[dab as usize].touches(particle.position, particle.normal)
        });
        touching.max().map_or(whole > 0, |last| !self.dabs[last as usize].take_away)
    }

    /// Whether any dab that adds to the region may reach a ball.
    fn may_touch(&self, center: Vec3, reach: f32) -> bool {
        let reaches = |dab: &PlacedDab| !dab.take_away && dab.at.distance(center) <= dab.radius + reach;
        if reach <= self.cell {
            self.near(center, 2).any(|dab| reaches(&self.dabs[dab as usize]))
        } else {
            self.dabs.iter().any(reaches)
        }
    }

    /// The dabs in the cell of a point and in those at most `cells` away.
    fn near(&self, at: Vec3, cells: i32) -> impl Iterator<Item = u32> + '_ {
        let home = (at / self.cell).floor().as_ivec3();
        let span = -cells..=cells;
        span.clone()
            .flat_map(move |x| span.clone().map(move |y| (x, y)))
            .flat_map(move |(x, y)| (-cells..=cells).map(move |z| IVec3::new(x, y, z)))
            .filter_map(move |offset| self.in_cell.get(&home.saturating_add(offset)))
            .flatten()
            .copied()
    }
}

impl PlacedDab {
    fn of(dab: &Dab) -> Self {
        let [at, normal] = [dab.at, dab.normal].map(|v| DVec3::from(v).as_vec3());
        let (facing, radius) = (normal.normalize_or(Vec3::Y), dab.radius as f32);
        Self { at, facing, radius, take_away: dab.take_away }
    }

    fn touches(&self, at: Vec3, normal: Vec3) -> bool {
        self.at.distance(at) <= self.radius && self.facing.dot(normal) > DAB_FACING
    }
}
