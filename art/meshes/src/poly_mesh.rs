//! Builds polygon meshes from rows of points, and writes them as OBJ and MTL files.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::Write as _;

use anyhow::{Context as _, ensure};
use glam::{DVec2, DVec3};

/// What a face belongs to: an OBJ group, and a material of the mesh's palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Name of the group.
    pub group: &'static str,
    /// Name of the material.
    pub material: &'static str,
}

/// One polygon: at least three corners, counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub struct Face {
    /// Indices into [`PolyMesh::positions`].
    pub corners: Vec<usize>,
    /// Group and material.
    pub look: Look,
}

/// A named base colour, sRGB as `#rrggbb`.
pub type Pigment = (&'static str, &'static str);

/// How the surface of a material shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shine {
    /// Name of the material in the palette.
    pub material: &'static str,
    /// Strength of the highlight, 0..=1: the MTL file's `Ks`, a grey.
    pub strength: f64,
    /// How small and sharp the highlight is, 0..=1000: the MTL file's `Ns`.
    pub sharpness: f64,
}

/// A mesh of polygons, Y up. One unit is about the size of an object.
#[derive(Clone, Debug)]
pub struct PolyMesh {
    /// File name without its ending.
    pub name: &'static str,
    /// What the file's first line says about it.
    pub about: &'static str,
    /// The materials, in the order of the MTL file.
    pub palette: &'static [Pigment],
    /// The materials that shine; every other one is matt.
    pub shines: Vec<Shine>,
    /// One point per vertex.
    pub positions: Vec<DVec3>,
    /// The polygons, in the order in which they were made.
    pub faces: Vec<Face>,
    /// Texture coordinates of each face's corners; empty for a mesh without them.
    pub uvs: Vec<Vec<DVec2>>,
    /// Whether the file gives one normal per point, so that no edge shows. If not, the program that reads the file
    /// decides where creases are.
    pub has_normals: bool,
}

impl PolyMesh {
    /// An empty mesh.
    pub fn new(name: &'static str, about: &'static str, palette: &'static [Pigment]) -> Self {
        Self {
            name,
            about,
            palette,
            shines: Vec::new(),
            positions: Vec::new(),
            faces: Vec::new(),
            uvs: Vec::new(),
            has_normals: false,
        }
    }

    /// Makes some materials of the palette shine, all alike.
    pub fn polish(&mut self, materials: &[&'static str], strength: f64, sharpness: f64) {
        self.shines.extend(materials.iter().map(|&material| Shine { material, strength, sharpness }));
    }

    /// Adds a closed surface round an axis: `rows` bands of `segments` faces each, from one pole to the other.
    ///
    /// `point(row, segment)` is called for rows 0 to `rows`; segments turn counter-clockwise seen from the first pole.
    /// The first and the last row are single points: for them `point` gets segment 0 only. `look(row, segment)`
    /// gives group and material of the face between `row` and `row + 1`.
    pub fn lathe(
        &mut self,
        [rows, segments]: [usize; 2],
        point: impl Fn(usize, usize) -> DVec3,
        look: impl Fn(usize, usize) -> Look,
    ) {
        let first = self.positions.len();
        self.positions.push(point(0, 0));
        for row in 1..rows {
            self.positions.extend((0..segments).map(|segment| point(row, segment)));
        }
        self.positions.push(point(rows, 0));
        let last = self.positions.len() - 1;
        let at = |row: usize, segment: usize| match row {
            0 => first,
            row if row == rows => last,
            row => first + 1 + (row - 1) * segments + segment % segments,
        };
        for row in 0..rows {
            for segment in 0..segments {
                let mut corners = vec![at(row, segment), at(row + 1, segment)];
                if row + 1 < rows {
                    corners.push(at(row + 1, segment + 1));
                }
                if row > 0 {
                    corners.push(at(row, segment + 1));
                }
                self.faces.push(Face { corners, look: look(row, segment) });
            }
        }
    }

    /// Adds an open sheet of `columns` by `rows` faces. Seen from outside, columns run to the right and rows run up.
    /// `point(column, row)` is called for columns 0 to `columns` and rows 0 to `rows`, both included.
    pub fn sheet(
        &mut self,
        [columns, rows]: [usize; 2],
        point: impl Fn(usize, usize) -> DVec3,
        look: impl Fn(usize, usize) -> Look,
    ) {
        let first = self.positions.len();
        for row in 0..=rows {
            self.positions.extend((0..=columns).map(|column| point(column, row)));
        }
        let at = |column: usize, row: usize| first + row * (columns + 1) + column;
        for row in 0..rows {
            for column in 0..columns {
                let corners =
                    vec![at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)];
                self.faces.push(Face { corners, look: look(column, row) });
            }
        }
    }

    /// Adds a thin closed body, like a leaf or a fin: a front sheet and a back sheet of `columns` by `rows` faces each,
    /// which share their rim. `point` gives the front and the back point; on the rim the two are averaged.
    pub fn blade(
        &mut self,
        [columns, rows]: [usize; 2],
        point: impl Fn(usize, usize) -> [DVec3; 2],
        look: impl Fn(usize, usize) -> Look,
    ) {
        let mut index = vec![[0, 0]; (columns + 1) * (rows + 1)];
        for row in 0..=rows {
            for column in 0..=columns {
                let [front, back] = point(column, row);
                let rim = row == 0 || row == rows || column == 0 || column == columns;
                let next = self.positions.len();
                index[row * (columns + 1) + column] = if rim {
                    self.positions.push((front + back) / 2.0);
                    [next, next]
                } else {
                    self.positions.extend([front, back]);
                    [next, next + 1]
                };
            }
        }
        let at = |column: usize, row: usize, side: usize| index[row * (columns + 1) + column][side];
        for side in [0, 1] {
            for row in 0..rows {
                for column in 0..columns {
                    let mut corners = vec![
                        at(column, row, side),
                        at(column + 1, row, side),
                        at(column + 1, row + 1, side),
                        at(column, row + 1, side),
                    ];
                    if side == 1 {
                        corners.reverse();
                    }
                    self.faces.push(Face { corners, look: look(column, row) });
                }
            }
        }
    }

    /// Lowers or lifts everything so that the lowest point lies at y = 0.
    pub fn rest_on_ground(&mut self) {
        let lowest = self.positions.iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
        for point in &mut self.positions {
            point.y -= lowest;
        }
    }

    /// Rounds every coordinate to thousandths, which keeps the file short and is enough for what is far from the
    /// viewer.
    pub fn round_to_thousandths(&mut self) {
        self.round_to(1e3);
    }

    /// Rounds every coordinate to one part in `parts` of a unit.
    pub fn round_to(&mut self, parts: f64) {
        for point in &mut self.positions {
            *point = (*point * parts).round() / parts;
        }
    }

    /// The mesh file's text: faces sorted by group, then by material, in the order in which each first appears.
    /// Positions and texture coordinates are rounded to 5 decimals, normals to 3.
    pub fn to_obj(&self) -> anyhow::Result<String> {
        let mut text = format!("# {}\nmtllib {}.mtl\n", self.about, self.name);
        for point in &self.positions {
            ensure!(point.is_finite(), "{}: a point is not finite", self.name);
            writeln!(text, "v {} {} {}", decimal(point.x), decimal(point.y), decimal(point.z))?;
        }
        if self.has_normals {
            for normal in self.normals() {
                let [x, y, z] = normal.to_array().map(|value| decimal((value * 1e3).round() / 1e3));
                writeln!(text, "vn {x} {y} {z}")?;
            }
        }
        let uv_of = |uv: &DVec2| format!("{} {}", decimal(uv.x), decimal(uv.y));
        let mut uv_numbers = HashMap::new();
        for uv in self.uvs.iter().flatten() {
            let next = uv_numbers.len() + 1;
            if let Entry::Vacant(entry) = uv_numbers.entry(uv_of(uv)) {
                writeln!(text, "vt {}", entry.key())?;
                entry.insert(next);
            }
        }
        let mut groups = Vec::new();
        let mut looks = Vec::new();
        for face in &self.faces {
            if !groups.contains(&face.look.group) {
                groups.push(face.look.group);
            }
            if !looks.contains(&face.look) {
                looks.push(face.look);
            }
        }
        for group in groups {
            writeln!(text, "g {group}")?;
            for look in looks.iter().filter(|look| look.group == group) {
                writeln!(text, "usemtl {}", look.material)?;
                let faces = self.faces.iter().enumerate();
                for (index, face) in faces.filter(|(_, face)| face.look == *look) {
                    text.push('f');
                    for (place, corner) in face.corners.iter().enumerate() {
                        write!(text, " {}", corner + 1)?;
                        if let Some(uv) = self.uvs.get(index).and_then(|uvs| uvs.get(place)) {
                            write!(text, "/{}", uv_numbers[&uv_of(uv)])?;
                            if self.has_normals {
                                write!(text, "/{}", corner + 1)?;
                            }
                        } else if self.has_normals {
                            write!(text, "//{}", corner + 1)?;
                        }
                    }
                    text.push('\n');
                }
            }
        }
        Ok(text)
    }

    /// A unit normal per point: the mean of the normals of the faces round it, weighted by their areas.
    pub fn normals(&self) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for face in &self.faces {
            let at = |corner: usize| self.positions[face.corners[corner]];
            let area: DVec3 = (2..face.corners.len())
                .map(|corner| (at(corner - 1) - at(0)).cross(at(corner) - at(0)))
                .sum();
            for &corner in &face.corners {
                sums[corner] += area;
            }
        }
        sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y)).collect()
    }

    /// The material file's text: one base colour per material of the palette, and the highlight of those that shine.
    pub fn to_mtl(&self) -> anyhow::Result<String> {
        let mut text = String::new();
        for (name, hex) in self.palette {
            let value = u32::from_str_radix(hex.trim_start_matches('#'), 16)
                .with_context(|| format!("{}: {hex} is no colour", self.name))?;
            let channel = |shift: u32| decimal(f64::from(value >> shift & 0xff) / 255.0);
            writeln!(text, "newmtl {name}\nKd {} {} {}", channel(16), channel(8), channel(0))?;
            if let Some(shine) = self.shines.iter().find(|shine| shine.material == *name) {
                let strength = decimal(shine.strength);
                writeln!(text, "Ks {strength} {strength} {strength}\nNs {}", decimal(shine.sharpness))?;
            }
        }
        Ok(text)
    }
}

/// A number with at most 5 decimals, without trailing zeros and without a negative zero.
fn decimal(value: f64) -> String {
    let text = format!("{value:.5}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
