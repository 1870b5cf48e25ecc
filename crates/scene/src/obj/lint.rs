//! The first pass over an OBJ text: every number and index is checked where it stands. Plain lines come in bulk from
//! [`super::plain`], all others are looked at here one by one.

use std::collections::HashMap;

use rayon::prelude::*;

use super::number::finite;
use super::oddities::Oddities;
use super::plain::{self, Corner, Counts, NONE, Piece};
use super::surface::SHARE;
use super::text::{Findings, Lines, Word, name_of};

/// Coordinates beyond this lose their squares and cross products in single precision.
pub(super) const MAX_COORDINATE: f64 = 1e9;

/// Texture coordinates from here on are of no use.
pub(super) const MAX_UV: f64 = 1e30;

/// One face of at least three different corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Where its corners end in [`Checked::corners`]; they begin where those of the face before it end.
    pub end: u32,
    pub group: u32,
    pub material: u32,
    /// Where its line begins in the text.
    pub offset: u32,
}

/// A file of materials that the text names.
#[derive(Clone, Debug)]
pub(super) struct Library {
    /// The whole rest of the line, and its single words: either may be meant.
    pub name: String,
    pub words: Vec<String>,
    pub offset: usize,
}

/// Names numbered in the order of their first use.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub list: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Names {
    fn number(&mut self, name: &str) -> u32 {
        if let Some(&number) = self.numbers.get(name) {
            return number;
        }
        let number = self.list.len() as u32;
        self.list.push(name.to_owned());
        self.numbers.insert(name.to_owned(), number);
        number
    }
}

/// What an OBJ text says, checked. Every index is in range once [`check`] found no error.
#[derive(Debug, Default)]
pub(super) struct Checked {
    pub positions: Vec<[f64; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// Of unit length; zero where the file's normal is of no use.
    pub normals: Vec<[f32; 3]>,
    pub corners: Vec<Corner>,
    pub faces: Vec<Face>,
    pub groups: Names,
    pub materials: Names,
    /// Where each material is first named.
    pub material_offsets: Vec<usize>,
    pub libraries: Vec<Library>,
}

struct Linter<'f, 'a> {
    checked: Checked,
    odd: Oddities,
    findings: &'f mut Findings<'a>,
    object: Option<String>,
    group: Option<String>,
    group_number: Option<u32>,
    material_number: Option<u32>,
    corners: Vec<Corner>,
}

/// Checks a whole text and keeps what a surface needs. Errors and warnings go to `findings`.
pub(super) fn check(text: &[u8], findings: &mut Findings<'_>) -> Checked {
    let mut linter = Linter {
        checked: Checked::default(),
        odd: Oddities::default(),
        findings,
        object: None,
        group: None,
        group_number: None,
        material_number: None,
        corners: Vec::new(),
    };
    let pieces = plain::read(text, plain::PIECE_BYTES);
    linter.reserve(&pieces);
    for piece in pieces {
        linter.piece(text, &piece);
    }
    linter.finish()
}

/// A direction of unit length, if there is one.
pub(super) fn unit(numbers: [f64; 3]) -> Option<[f32; 3]> {
    let length = numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
    (length > 1e-30 && length.is_finite()).then(|| numbers.map(|number| (number / length) as f32))
}

impl Linter<'_, '_> {
    /// Takes the memory for all plain lines at once.
    fn reserve(&mut self, pieces: &[Piece]) {
        let sum = |count: fn(&Piece) -> usize| pieces.iter().map(count).sum();
        self.checked.positions.reserve(sum(|piece| piece.positions.len()));
        self.checked.uvs.reserve(sum(|piece| piece.uvs.len()));
        self.checked.normals.reserve(sum(|piece| piece.normals.len()));
        self.checked.corners.reserve(sum(|piece| piece.corners.len()));
        self.checked.faces.reserve(sum(|piece| piece.faces.len()));
    }

    /// Takes the plain lines of a piece in bulk, and those between them one by one.
    fn piece(&mut self, text: &[u8], piece: &Piece) {
        let mut words = Vec::new();
        let mut taken = Counts::default();
        for rest in &piece.rest {
            self.plain_lines(piece, taken, rest.before);
            taken = rest.before;
            let mut lines = Lines::between(text, rest.text.start as usize, rest.text.end as usize);
            while lines.next_into(&mut words) {
                let is_last = words.last().is_some_and(|word| word.offset + word.bytes.len() == text.len());
                if is_last && self.drop_cut_line(&words) {
                    break;
                }
                self.line(&words);
            }
        }
        self.plain_lines(piece, taken, piece.counts());
    }

    fn plain_lines(&mut self, piece: &Piece, from: Counts, to: Counts) {
        let checked = &mut self.checked;
        append(&mut checked.positions, &piece.positions[from.positions as usize..to.positions as usize]);
        append(&mut checked.uvs, &piece.uvs[from.uvs as usize..to.uvs as usize]);
        append(&mut checked.normals, &piece.normals[from.normals as usize..to.normals as usize]);
        let faces = &piece.faces[from.faces as usize..to.faces as usize];
        let Some(last) = faces.last() else { return };
        let start = from.faces.checked_sub(1).map_or(0, |before| piece.faces[before as usize].end);
        let base = checked.corners.len() as u32;
        append(&mut checked.corners, &piece.corners[start as usize..last.end as usize]);
        let (group, material) = self.numbers_of_next_face(faces[0].offset as usize);
        self.checked.faces.extend(faces.iter().map(|face| Face {
            end: base + (face.end - start),
            group,
            material,
            offset: face.offset,
        }));
    }

    fn line(&mut self, words: &[Word<'_>]) {
        let (keyword, rest) = (words[0], &words[1..]);
        match keyword.bytes {
            b"v" => self.position(keyword, rest),
            b"vt" => self.uv(keyword, rest),
            b"vn" => self.normal(keyword, rest),
            b"f" | b"fo" => self.face(keyword, rest),
            b"o" => {
                self.object = Some(name_of(rest)).filter(|name| !name.is_empty());
                self.group = None;
                self.group_number = None;
            }
            b"g" => {
                self.group = Some(name_of(rest)).filter(|name| !name.is_empty());
                self.group_number = None;
            }
            b"usemtl" => {
                let number = self.checked.materials.number(&name_of(rest));
                if self.checked.material_offsets.len() <= number as usize {
                    self.checked.material_offsets.push(keyword.offset);
                }
                self.material_number = Some(number);
            }
            b"mtllib" => self.checked.libraries.push(Library {
                name: name_of(rest),
                words: rest.iter().map(|word| word.text().into_owned()).collect(),
                offset: keyword.offset,
            }),
            b"l" | b"p" => self.odd.lines_and_points += 1,
            b"s" | b"usemap" | b"maplib" | b"shadow_obj" | b"trace_obj" | b"lod" | b"bevel" | b"c_interp"
            | b"d_interp" | b"mg" => {}
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm"
            | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech" | b"stech" => {
                self.odd.free_form.add(keyword.offset);
                self.odd.free_form_words.insert(keyword.text().into_owned());
            }
            _ => {
                self.odd.unknown.add(keyword.offset);
                if self.odd.unknown_words.len() < 6 {
                    self.odd.unknown_words.insert(keyword.quoted());
                }
            }
        }
    }

    /// Whether the last line, which has no line end, was cut short: then it is left out, with a warning. A face that only
    /// has fewer corners than the one before it may be whole: it is kept, with a warning.
    fn drop_cut_line(&mut self, words: &[Word<'_>]) -> bool {
        let arity_before = match self.checked.faces[..] {
            [.., before, last] => last.end - before.end,
            [only] => only.end,
            [] => 0,
        };
        let rest = &words[1..];
        let ends_early = rest.last().is_some_and(|word| is_cut_number(*word));
        let is_cut = match words[0].bytes {
            b"v" => rest.len() < 3 || (rest.len() == 3 && ends_early),
            b"f" => rest.len() < 3 || ends_early,
            _ => false,
        };
        if is_cut {
            let message = "the last line has no end and too few numbers: the file seems cut short";
            self.findings.warning(words[0].offset, message, "the line is left out; get the whole file");
        } else if words[0].bytes == b"f" && rest.len() < arity_before as usize {
            let message =
                "the last line has no end and fewer corners than the one before: the file may be cut short";
            self.findings.warning(words[0].offset, message, "end the file with a line end if it is whole");
        }
        is_cut
    }

    fn position(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        let mut position = [0.0; 3];
        if rest.len() < 3 {
            let message = format!("a vertex needs 3 numbers and this one has {}", rest.len());
            self.findings.error(keyword.offset, message, "write v x y z");
        }
        for (value, word) in position.iter_mut().zip(rest) {
            *value = self.number(*word);
            if value.abs() > MAX_COORDINATE {
                let message = format!("the coordinate {} is beyond 1e9: areas would overflow", word.quoted());
                self.findings.error(word.offset, message, "scale the model down");
            }
        }
        let others: Vec<f64> = rest.iter().skip(3).take(5).map(|word| self.number(*word)).collect();
        match others.len() {
            0 => {}
            1 | 4 if others[0] == 0.0 => self.odd.zero_w.add(keyword.offset),
            1 => {}
            3 | 4 => self.odd.color.add(keyword.offset),
            _ => self.odd.extra.add(keyword.offset),
        }
        self.checked.positions.push(position);
    }

    fn uv(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        let mut uv = [0.0; 2];
        let mut is_bad = rest.is_empty();
        for (value, word) in uv.iter_mut().zip(rest) {
            match finite(word.bytes).filter(|number| number.abs() < MAX_UV) {
                Some(number) => *value = number as f32,
                None => is_bad = true,
            }
        }
        if is_bad {
            self.odd.bad_uv.add(keyword.offset);
        }
        self.checked.uvs.push(uv);
    }

    fn normal(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        let numbers: Vec<f64> = rest.iter().take(3).filter_map(|word| finite(word.bytes)).collect();
        let normal = <[f64; 3]>::try_from(numbers).ok().and_then(unit);
        if normal.is_none() {
            self.odd.bad_normal.add(keyword.offset);
        }
        self.checked.normals.push(normal.unwrap_or_default());
    }

    /// A finite number; anything else is an error where it stands.
    fn number(&mut self, word: Word<'_>) -> f64 {
        if let Some(number) = finite(word.bytes) {
            return number;
        }
        let text = word.text();
        let (message, mend) = if text.parse::<f64>().is_ok() {
            (format!("{} is not a finite number", word.quoted()), "give the vertex a real place")
        } else if text.contains(['d', 'D']) && text.replace(['d', 'D'], "e").parse::<f64>().is_ok() {
            (format!("{} has a Fortran exponent", word.quoted()), "write e in the place of D")
        } else if text.contains(',') {
            (format!("{} is not a number", word.quoted()), "write a point for the decimals, not a comma")
        } else {
            (format!("{} is not a number", word.quoted()), "write a number such as 0.5 or 1e-3")
        };
        self.findings.error(word.offset, message, mend);
        0.0
    }

    fn face(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        self.corners.clear();
        for word in rest {
            let Some(corner) = self.corner(*word) else { return };
            self.corners.push(corner);
        }
        if self.corners.len() < 3 {
            self.odd.too_few.add(keyword.offset);
            return;
        }
        self.corners.dedup_by_key(|corner| corner.position);
        while self.corners.len() > 1
            && self.corners.first().map(|c| c.position) == self.corners.last().map(|c| c.position)
        {
            self.corners.pop();
        }
        if self.corners.len() < 3 {
            self.odd.degenerate.add(keyword.offset);
            return;
        }
        let (group, material) = self.numbers_of_next_face(keyword.offset);
        self.checked.corners.append(&mut self.corners);
        let end = self.checked.corners.len() as u32;
        self.checked.faces.push(Face { end, group, material, offset: keyword.offset as u32 });
    }

    /// The group and the material of a face that stands here.
    fn numbers_of_next_face(&mut self, offset: usize) -> (u32, u32) {
        let group = match self.group_number {
            Some(group) => group,
            None => {
                let name = self.group.as_deref().or(self.object.as_deref()).unwrap_or("default");
                self.checked.groups.number(name)
            }
        };
        self.group_number = Some(group);
        let material = match self.material_number {
            Some(material) => material,
            None => {
                let number = self.checked.materials.number("");
                if self.checked.material_offsets.len() <= number as usize {
                    self.checked.material_offsets.push(offset);
                }
                number
            }
        };
        (group, material)
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`. Positive indices may point ahead, so their upper end is checked last.
    fn corner(&mut self, word: Word<'_>) -> Option<Corner> {
        let mut parts = word.bytes.split(|&byte| byte == b'/');
        let counts = [self.checked.positions.len(), self.checked.uvs.len(), self.checked.normals.len()];
        let mut indices = [NONE; 3];
        for (slot, (part, count)) in parts.by_ref().take(3).zip(counts).enumerate() {
            if part.is_empty() && slot > 0 {
                continue;
            }
            indices[slot] = self.index(word, part, count)?;
        }
        if parts.next().is_some() {
            let message = format!("the corner {} has more than three indices", word.quoted());
            self.findings.error(word.offset, message, "write v, v/vt, v//vn or v/vt/vn");
            return None;
        }
        Some(Corner { position: indices[0], uv: indices[1], normal: indices[2], offset: word.offset as u32 })
    }

    fn index(&mut self, word: Word<'_>, part: &[u8], count: usize) -> Option<u32> {
        let digits = part.strip_prefix(b"-").or_else(|| part.strip_prefix(b"+")).unwrap_or(part);
        if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
            let message = format!("the corner {} does not hold a whole number as index", word.quoted());
            self.findings.error(word.offset, message, "count the vertices from 1, in whole numbers");
            return None;
        }
        if part[0] == b'+' {
            self.odd.plus.add(word.offset);
        }
        let size = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse::<u32>().ok());
        let index = match size {
            Some(0) => {
                let message = format!("the corner {} has the index 0", word.quoted());
                self.findings.error(word.offset, message, "indices count from 1 (or from -1 backwards)");
                return None;
            }
            Some(size) if part[0] == b'-' => {
                count.checked_sub(size as usize).and_then(|at| u32::try_from(at).ok())
            }
            Some(size) if size != NONE => Some(size - 1),
            _ => None,
        };
        if index.is_none() {
            let message = format!("the corner {} is out of range: there are {count} so far", word.quoted());
            self.findings.error(word.offset, message, "use an index that the file has");
        }
        index
    }

    fn check_upper_ends(&mut self) {
        let limits = [
            ("vertex", self.checked.positions.len()),
            ("texture coordinate", self.checked.uvs.len()),
            ("normal", self.checked.normals.len()),
        ];
        let is_beyond = |corner: &Corner| {
            let indices = [corner.position, corner.uv, corner.normal];
            indices
                .into_iter()
                .zip(limits)
                .any(|(index, (_, count))| index != NONE && index as usize >= count)
        };
        if !self.checked.corners.par_iter().with_min_len(SHARE).any(is_beyond) {
            return;
        }
        for corner in &self.checked.corners {
            for (index, (what, count)) in [corner.position, corner.uv, corner.normal].into_iter().zip(limits)
            {
                if index != NONE && index as usize >= count {
                    let message =
                        format!("there is no {what} {}: the file has {count}", u64::from(index) + 1);
                    self.findings.error(corner.offset as usize, message, "use an index that the file has");
                }
            }
        }
    }

    fn finish(mut self) -> Checked {
        self.check_upper_ends();
        let findings = &mut *self.findings;
        self.odd.tell(findings);
        if self.checked.faces.is_empty() && !findings.has_errors() {
            let message = match (self.checked.positions.len(), self.odd.lines_and_points) {
                (0, 0) => "the file has no vertex and no face".to_owned(),
                (points, 0) => format!("the file has {points} vertices, but no face to paint on"),
                (points, lines) => format!(
                    "the file has {points} vertices and {lines} lines or points, but no face to paint on"
                ),
            };
            findings.error_of_file(message, "export the model as polygons");
        }
        self.checked
    }
}

/// Copies on all cores what is long enough for it.
fn append<T: Copy + Send + Sync>(to: &mut Vec<T>, from: &[T]) {
    if from.len() < SHARE {
        to.extend_from_slice(from);
    } else {
        to.par_extend(from.par_iter().with_min_len(SHARE).copied());
    }
}

/// Whether a number or a corner ends in the middle: nothing after a sign, a slash or an exponent's mark.
fn is_cut_number(word: Word<'_>) -> bool {
    matches!(word.bytes.last(), Some(b'/' | b'-' | b'+' | b'e' | b'E'))
}
