//! Reads meshes.

mod influences;
mod triangles;

use std::sync::Arc;

use foldhash::{HashMap, HashMapExt};

use crate::accessor::{Component, Shape};
use crate::cursor::Cursor;
use crate::decode::{Accessors, Integers, Scan};
use crate::extensions::{DRACO, VARIANTS};
use crate::finding::{Checked, EXPORT_ANEW, Finding, Findings, Severity};
use crate::mesh::{Influences, Mesh, MorphTarget, Primitive};
use triangles::{Mode, Triangles, triangles};

/// Lengths of the lists that meshes refer to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub materials: usize,
    pub variants: usize,
}

/// The joint and weight accessors of influences.
pub(crate) type InfluenceKey = Vec<(usize, usize)>;

/// Reads meshes, and keeps what several of them share.
pub(crate) struct MeshReader<'a, 'o, 'p, 't> {
    pub accessors: &'a mut Accessors<'o, 'p, 't>,
    pub findings: &'a mut Findings,
    pub counts: Counts,
    pub triangles: HashMap<(Option<usize>, Mode, usize), Triangles>,
    pub influences: HashMap<InfluenceKey, Arc<Influences>>,
}

const SMALL: [Component; 5] = [Component::F32, Component::I8, Component::U8, Component::I16, Component::U16];
const UNIT: [Component; 3] = [Component::F32, Component::U8, Component::U16];

pub(crate) fn read_all(
    root: &Cursor<'_, '_>,
    accessors: &mut Accessors<'_, '_, '_>,
    counts: Counts,
    findings: &mut Findings,
) -> Checked<Vec<Arc<Mesh>>> {
    let mut meshes = Vec::new();
    let mut reader =
        MeshReader { accessors, findings, counts, triangles: HashMap::new(), influences: HashMap::new() };
    for cursor in root.list("meshes")?.iter() {
        match reader.mesh(&cursor) {
            Ok(mesh) => meshes.push(Arc::new(mesh)),
            Err(finding) => reader.findings.add(*finding),
        }
        if reader.findings.is_full() {
            break;
        }
    }
    Ok(meshes)
}

impl MeshReader<'_, '_, '_, '_> {
    fn mesh(&mut self, cursor: &Cursor<'_, '_>) -> Checked<Mesh> {
        let name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
        let list_cursor = cursor.required("primitives")?;
        let list = list_cursor.clone().checked_list()?;
        if list.len() == 0 {
            self.findings.add(list_cursor.warning("the mesh has no primitives", ""));
        }
        let mut primitives = Vec::new();
        let mut target_count = None;
        for (index, item) in list.iter().enumerate() {
            let targets = item.list("targets")?.len();
            if *target_count.get_or_insert(targets) != targets {
                return Err(item.error(format!(
                    "the primitive has {targets} morph targets, and the one before it another number"
                )));
            }
            let primitive = self.primitive(&item, index)?;
            primitives.extend(primitive);
        }
        let target_count = target_count.unwrap_or(0);
        let weights = weights(cursor, target_count)?.unwrap_or_else(|| vec![0.0; target_count]);
        Ok(Mesh {
            name,
            primitives,
            target_count,
            weights,
            target_names: target_names(cursor, target_count),
            group_names: group_names(cursor),
        })
    }

    fn primitive(&mut self, cursor: &Cursor<'_, '_>, index: usize) -> Checked<Option<Primitive>> {
        let attributes = cursor.required("attributes")?.checked_object()?;
        for (_, member) in attributes.members() {
            self.accessors.index(&member)?;
        }
        let material = self.material(cursor)?;
        let mode = match cursor.member("mode") {
            None => Mode::Triangles,
            Some(member) => match member.whole()? {
                0..=3 => {
                    self.findings.add(member.warning("points and lines are not painted, and left out", ""));
                    return Ok(None);
                }
                4 => Mode::Triangles,
                5 => Mode::Strip,
                6 => Mode::Fan,
                mode => return Err(member.error(format!("{mode} is no mode of a primitive (0 to 6)"))),
            },
        };
        let Some(position) = attributes.member("POSITION") else {
            self.findings
                .add(attributes.warning("the primitive has no positions, and is left out", EXPORT_ANEW));
            return Ok(None);
        };
        self.check_compression(cursor, &position)?;
        let position_index = self.accessors.expect(&position, &[Shape::Vector(3)], &SMALL)?;
        self.accessors.warn_without_bounds(position_index, self.findings);
        let positions =
            self.accessors.finite_floats::<3>(position_index, Integers::AsStated, self.findings)?;
        let count = positions.len();
        if count == 0 {
            self.findings.add(position.warning("the primitive has no vertices, and is left out", ""));
            return Ok(None);
        }
        let triangles = triangles(self, cursor, mode, count)?;
        let normals = self.normals(&attributes, count)?;
        let uvs = [self.uvs(&attributes, "TEXCOORD_0", count)?, self.uvs(&attributes, "TEXCOORD_1", count)?];
        let colors = self.colors(&attributes, count)?;
        let influences = influences::read(self, &attributes, count)?;
        let points = self.numbers(&attributes, "_POINT", count)?;
        let groups = self.numbers(&attributes, "_GROUP", count)?;
        let targets = self.targets(cursor, count)?;
        Ok(Some(Primitive {
            index,
            positions,
            normals,
            uvs,
            colors,
            influences,
            targets,
            material,
            points,
            groups,
            triangles,
        }))
    }

    /// Fails if a primitive is compressed, unless its positions are also in the file uncompressed.
    fn check_compression(&self, cursor: &Cursor<'_, '_>, position: &Cursor<'_, '_>) -> Checked<()> {
        let extensions = cursor.object("extensions")?;
        let Some(draco) = extensions.as_ref().and_then(|extensions| extensions.member(DRACO)) else {
            return Ok(());
        };
        if self.accessors.get(self.accessors.index(position)?).run.is_some() {
            return Ok(());
        }
        let message = format!("the primitive is compressed with {DRACO}, which is not read");
        Err(Box::new(draco.finding(Severity::Unsupported, message, "export without compression")))
    }

    fn material(&mut self, cursor: &Cursor<'_, '_>) -> Checked<Option<usize>> {
        let mut material = cursor.optional_index("material", self.counts.materials, "material")?;
        let extensions = cursor.object("extensions")?;
        let variants =
            extensions.as_ref().map(|extensions| extensions.object(VARIANTS)).transpose()?.flatten();
        if let Some(variants) = variants {
            let mappings = variants.list("mappings")?;
            let mut is_mapped = false;
            for mapping in mappings.iter() {
                let of_variant = mapping.required("material")?.index(self.counts.materials, "material")?;
                for variant in mapping.required("variants")?.checked_list()?.iter() {
                    let is_first = variant.index(self.counts.variants, "variant")? == 0;
                    if is_first && is_mapped {
                        self.findings
                            .add(variant.warning("the variant is mapped twice: the first counts", ""));
                    } else if is_first {
                        material = Some(of_variant);
                        is_mapped = true;
                    }
                }
            }
        }
        Ok(material)
    }

    /// Fails when a list is not as long as the positions.
    fn check_count(&self, member: &Cursor<'_, '_>, index: usize, count: usize) -> Checked<()> {
        let own = self.accessors.get(index).count;
        if own == count {
            return Ok(());
        }
        Err(member.error(format!("accessor {index} has {own} elements for {count} positions")))
    }

    fn normals(&mut self, attributes: &Cursor<'_, '_>, count: usize) -> Checked<Option<Arc<Vec<[f32; 3]>>>> {
        let Some(member) = attributes.member("NORMAL") else { return Ok(None) };
        const NORMAL: [Component; 3] = [Component::F32, Component::I8, Component::I16];
        let index = self.accessors.expect(&member, &[Shape::Vector(3)], &NORMAL)?;
        self.check_count(&member, index, count)?;
        let normals = self.accessors.floats::<3>(index, Integers::Normalized, self.findings)?;
        if let Some(bad) = self.accessors.first(index, Scan::NotFinite, &normals) {
            let message = format!("normal {bad} is not finite: the normals are left out");
            self.findings.add(member.warning(message, EXPORT_ANEW));
            return Ok(None);
        }
        if let Some(odd) = self.accessors.first(index, Scan::OddLength, &normals) {
            self.findings.add(member.warning(format!("normal {odd} is not of unit length"), ""));
        }
        Ok(Some(normals))
    }

    fn uvs(
        &mut self,
        attributes: &Cursor<'_, '_>,
        name: &'static str,
        count: usize,
    ) -> Checked<Option<Arc<Vec<[f32; 2]>>>> {
        let Some(member) = attributes.member(name) else { return Ok(None) };
        let index = self.accessors.expect(&member, &[Shape::Vector(2)], &SMALL)?;
        self.check_count(&member, index, count)?;
        let uvs = self.accessors.floats::<2>(index, Integers::AsStated, self.findings)?;
        Ok(self.finite_or_left_out(&member, index, uvs))
    }

    fn colors(&mut self, attributes: &Cursor<'_, '_>, count: usize) -> Checked<Option<Arc<Vec<[f32; 4]>>>> {
        let Some(member) = attributes.member("COLOR_0") else { return Ok(None) };
        let index = self.accessors.expect(&member, &[Shape::Vector(3), Shape::Vector(4)], &UNIT)?;
        self.check_count(&member, index, count)?;
        let colors = if self.accessors.get(index).shape == Shape::Vector(4) {
            self.accessors.floats::<4>(index, Integers::Normalized, self.findings)?
        } else {
            let opaque = self.accessors.floats::<3>(index, Integers::Normalized, self.findings)?;
            self.accessors.take_memory(count, 16, &member)?;
            Arc::new(opaque.iter().map(|&[red, green, blue]| [red, green, blue, 1.0]).collect())
        };
        if self.accessors.first(index, Scan::OutOfRange, &colors).is_some() {
            self.findings.add(member.warning("some colours are not from 0 to 1", ""));
        }
        Ok(self.finite_or_left_out(&member, index, colors))
    }

    /// An attribute of our own with one whole number per vertex, stored as floats. `None` if it is missing. Other
    /// programs may use the name for something else, so another format also gives `None`, without a message. Fractions,
    /// negative numbers and too large numbers give `None` and a warning.
    fn numbers(
        &mut self,
        attributes: &Cursor<'_, '_>,
        name: &'static str,
        count: usize,
    ) -> Checked<Option<Arc<Vec<u32>>>> {
        /// Whole numbers below this are exact as floats.
        const MOST: f32 = 16_777_216.0;
        let Some(member) = attributes.member(name) else { return Ok(None) };
        let index = self.accessors.index(&member)?;
        let accessor = self.accessors.get(index);
        if accessor.shape != Shape::Scalar || accessor.component != Component::F32 || accessor.count != count
        {
            return Ok(None);
        }
        let values = self.accessors.floats::<1>(index, Integers::AsStated, self.findings)?;
        if values.iter().any(|[value]| !(0.0..MOST).contains(value) || value.fract() != 0.0) {
            let message = format!("{name} holds what is no whole number below {MOST}: it is left out");
            self.findings.add(member.warning(message, EXPORT_ANEW));
            return Ok(None);
        }
        self.accessors.take_memory(count, 4, &member)?;
        Ok(Some(Arc::new(values.iter().map(|[value]| *value as u32).collect())))
    }

    fn finite_or_left_out<const N: usize>(
        &mut self,
        member: &Cursor<'_, '_>,
        index: usize,
        values: Arc<Vec<[f32; N]>>,
    ) -> Option<Arc<Vec<[f32; N]>>> {
        let bad = self.accessors.first(index, Scan::NotFinite, &values);
        if let Some(bad) = bad {
            let message = format!("element {bad} is not finite: the attribute is left out");
            self.findings.add(member.warning(message, EXPORT_ANEW));
        }
        bad.is_none().then_some(values)
    }

    fn targets(&mut self, cursor: &Cursor<'_, '_>, count: usize) -> Checked<Vec<MorphTarget>> {
        let list = cursor.list("targets")?;
        let mut targets = Vec::new();
        for target in list.iter() {
            let target = target.checked_object()?;
            for (_, member) in target.members() {
                let index = self.accessors.index(&member)?;
                self.check_count(&member, index, count)?;
            }
            let positions = self.deltas(&target, "POSITION")?;
            let normals = self.deltas(&target, "NORMAL")?;
            targets.push(MorphTarget { positions, normals });
        }
        Ok(targets)
    }

    fn deltas(&mut self, target: &Cursor<'_, '_>, name: &'static str) -> Checked<Option<Arc<Vec<[f32; 3]>>>> {
        let Some(member) = target.member(name) else { return Ok(None) };
        let index = self.accessors.expect(&member, &[Shape::Vector(3)], &SMALL)?;
        if name == "POSITION" {
            self.accessors.warn_without_bounds(index, self.findings);
        }
        self.accessors.finite_floats::<3>(index, Integers::AsStated, self.findings).map(Some)
    }

    pub fn error_at(&self, index: usize, message: String) -> Box<Finding> {
        self.accessors.error_at(index, message)
    }
}

/// The weights of morph targets of a mesh or a node: as many as there are targets.
pub(crate) fn weights(cursor: &Cursor<'_, '_>, target_count: usize) -> Checked<Option<Vec<f32>>> {
    let Some(member) = cursor.member("weights") else { return Ok(None) };
    let list = member.clone().checked_list()?;
    if list.len() != target_count {
        return Err(member.error(format!("{} weights stand for {target_count} morph targets", list.len())));
    }
    let weights = list.iter().map(|item| Ok(item.number()? as f32)).collect::<Checked<Vec<f32>>>()?;
    Ok(Some(weights))
}

/// Names of groups of vertices. No rule says what `extras` holds, so nothing in it counts as an error.
fn group_names(cursor: &Cursor<'_, '_>) -> Vec<String> {
    let Some(extras) = cursor.member("extras") else { return Vec::new() };
    let Ok(names) = extras.list("groupNames") else { return Vec::new() };
    names.iter().map(|name| name.text().unwrap_or_default().to_owned()).collect()
}

/// Names of morph targets. No rule says what `extras` holds, so nothing in it counts as an error.
fn target_names(cursor: &Cursor<'_, '_>, target_count: usize) -> Vec<String> {
    let Some(extras) = cursor.member("extras") else { return Vec::new() };
    let Ok(names) = extras.list("targetNames") else { return Vec::new() };
    if names.len() != target_count {
        return Vec::new();
    }
    names.iter().map(|name| name.text().unwrap_or_default().to_owned()).collect()
}
