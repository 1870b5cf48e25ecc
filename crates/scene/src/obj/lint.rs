//! The first pass over an OBJ text: every number and index is checked, every problem reported with its place, and the
//! text is cleaned for tobj. Plain lines come in bulk from [`super::scan`], all others are taken one by one.

use std::collections::HashMap;
use std::ops::Range;

use super::cleaned::Cleaned;
use super::oddities::Oddities;
use super::scan::{self, Counts, Indices, Kind, MAX_COORDINATE, MAX_UV, Piece, gives, raise, unit};
use super::text::{Findings, Lines, Word, finite, name_of};

/// A face of at least three corners, no two equal ones side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub group: u32,
    pub material: u32,
    /// Where the face's line begins in the text.
    pub offset: u32,
}

/// An MTL file that the text names.
#[derive(Clone, Debug)]
pub(super) struct Library {
    /// The rest of the line as the name of one file.
    pub name: String,
    /// The words of the rest of the line, which may also be the names of several files.
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

/// What an OBJ text holds. Its geometry is in `cleaned`: if [`check`] found no error, every index there is in range,
/// unless it is that of a texture coordinate or normal and the file has none of that kind at all.
#[derive(Debug)]
pub(super) struct Checked<'a> {
    /// Vertices and faces, for tobj.
    pub cleaned: Cleaned<'a>,
    /// The faces of `cleaned`.
    pub faces: Vec<Face>,
    /// For each corner of these faces, which indices it has, see [`gives`].
    pub corners: Vec<u8>,
    pub groups: Names,
    pub materials: Names,
    /// Where each material is first named.
    pub material_offsets: Vec<usize>,
    pub libraries: Vec<Library>,
}

struct Linter<'f, 'a> {
    text: &'a [u8],
    checked: Checked<'a>,
    odd: Oddities,
    findings: &'f mut Findings<'a>,
    /// How many lines of each [`Kind`] there were so far.
    counts: [usize; 3],
    highest: Indices,
    object: Option<String>,
    group: Option<String>,
    group_number: Option<u32>,
    material_number: Option<u32>,
}

/// Checks a whole text. Errors and warnings go to `findings`.
pub(super) fn check<'a>(text: &'a [u8], findings: &mut Findings<'a>) -> Checked<'a> {
    let mut linter = Linter {
        text,
        checked: Checked {
            cleaned: Cleaned::new(text),
            faces: Vec::new(),
            corners: Vec::new(),
            groups: Names::default(),
            materials: Names::default(),
            material_offsets: Vec::new(),
            libraries: Vec::new(),
        },
        odd: Oddities::default(),
        findings,
        counts: [0; 3],
        highest: Indices::default(),
        object: None,
        group: None,
        group_number: None,
        material_number: None,
    };
    let pieces = scan::scan(text);
    linter.checked.faces.reserve(pieces.iter().map(|piece| piece.faces.len()).sum());
    linter.checked.corners.reserve(pieces.iter().map(|piece| piece.corners.len()).sum());
    for piece in pieces {
        linter.piece(&piece);
    }
    linter.finish()
}

impl<'a> Linter<'_, 'a> {
    /// Takes the plain lines of a piece in bulk, and those between them one by one.
    fn piece(&mut self, piece: &Piece) {
        raise(&mut self.highest, piece.highest);
        let mut words = Vec::new();
        let (mut at, mut taken) = (piece.text.start, Counts::default());
        for rest in &piece.rest {
            self.plain_lines(piece, at..rest.text.start, taken, rest.before);
            (at, taken) = (rest.text.end, rest.before);
            let mut lines = Lines::between(self.text, rest.text.start, rest.text.end);
            while lines.next_into(&mut words) {
                let is_last =
                    words.last().is_some_and(|word| word.offset + word.bytes.len() == self.text.len());
                if is_last && self.drop_cut_line(&words) {
                    break;
                }
                self.line(&words);
            }
        }
        self.plain_lines(piece, at..piece.text.end, taken, piece.counts);
    }

    /// Takes lines of a piece that are all plain; `from` and `to` are the piece's counts before and after them.
    fn plain_lines(&mut self, piece: &Piece, lines: Range<usize>, from: Counts, to: Counts) {
        self.checked.cleaned.keep(lines);
        for kind in 0..3 {
            self.counts[kind] += (to.values[kind] - from.values[kind]) as usize;
        }
        let offsets = &piece.faces[from.faces as usize..to.faces as usize];
        let Some(&first) = offsets.first() else { return };
        let (group, material) = self.numbers_of_next_face(first as usize);
        self.checked.corners.extend(&piece.corners[from.corners as usize..to.corners as usize]);
        self.checked.faces.extend(offsets.iter().map(|&offset| Face { group, material, offset }));
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

    /// Judges the last line of the text, which has no line end. Returns whether it was surely cut short: then it is
    /// left out, with a warning. A face that only has fewer corners than the face before it may be whole, so it is
    /// kept, also with a warning.
    fn drop_cut_line(&mut self, words: &[Word<'_>]) -> bool {
        let corners_before = self.checked.faces.last().map_or(0, |face| {
            let mut words = Vec::new();
            Lines::between(self.text, face.offset as usize, self.text.len()).next_into(&mut words);
            words.len() - 1
        });
        let rest = &words[1..];
        // A file may end each corner with a slash.
        let is_usual =
            |word: &Word<'_>| word.bytes.last() == Some(&b'/') && rest[0].bytes.last() == Some(&b'/');
        let ends_early = rest.last().is_some_and(|word| is_cut_number(*word) && !is_usual(word));
        let is_cut = match words[0].bytes {
            b"v" => rest.len() < 3 || (rest.len() == 3 && ends_early),
            b"f" => rest.len() < 3 || ends_early,
            _ => false,
        };
        if is_cut {
            let message = "the last line has no end and too few numbers: the file seems cut short";
            self.findings.warning(words[0].offset, message, "the line is left out; get the whole file");
        } else if words[0].bytes == b"f" && rest.len() < corners_before {
            let message =
                "the last line has no end and fewer corners than the one before: the file may be cut short";
            self.findings.warning(words[0].offset, message, "end the file with a line end if it is whole");
        }
        is_cut
    }

    fn position(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        if rest.len() < 3 {
            let message = format!("a vertex needs 3 numbers and this one has {}", rest.len());
            self.findings.error(keyword.offset, message, "write v x y z");
        }
        for word in rest.iter().take(3) {
            if self.number(*word).abs() > MAX_COORDINATE {
                let message = format!("the coordinate {} is beyond 1e9: areas would overflow", word.quoted());
                self.findings.error(word.offset, message, "scale the model down");
            }
        }
        let others: Vec<Option<f64>> = rest.iter().skip(3).take(5).map(|word| finite(word.bytes)).collect();
        match others.len() {
            0 => {}
            _ if others.contains(&None) => self.odd.bad_color.add(keyword.offset),
            1 | 4 if others[0] == Some(0.0) => self.odd.zero_w.add(keyword.offset),
            1 => {}
            3 | 4 => self.odd.color.add(keyword.offset),
            _ => self.odd.extra.add(keyword.offset),
        }
        self.value(Kind::Position, rest.iter().take(3).map(|word| word.bytes));
    }

    /// Writes a line that tobj reads as a position, texture coordinate or normal.
    fn value<'w>(&mut self, kind: Kind, numbers: impl Iterator<Item = &'w [u8]>) {
        let keyword: &[u8] = [b"v".as_slice(), b"vt", b"vn"][kind as usize];
        self.counts[kind as usize] += 1;
        self.checked.cleaned.write([keyword].into_iter().chain(numbers));
    }

    fn uv(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        let is_good = |word: &Word<'_>| finite(word.bytes).is_some_and(|number| number.abs() < MAX_UV);
        if rest.is_empty() || !rest.iter().take(2).all(is_good) {
            self.odd.bad_uv.add(keyword.offset);
        }
        let number =
            |at: usize| rest.get(at).filter(|word| is_good(word)).map_or(b"0".as_slice(), |word| word.bytes);
        self.value(Kind::Uv, [number(0), number(1)].into_iter());
    }

    /// Writes a normal. An unusable one is replaced by one of length 0, so that the indices of the others stay right.
    fn normal(&mut self, keyword: Word<'_>, rest: &[Word<'_>]) {
        let numbers: Vec<f64> = rest.iter().take(3).filter_map(|word| finite(word.bytes)).collect();
        if <[f64; 3]>::try_from(numbers).ok().and_then(unit).is_some() {
            self.value(Kind::Normal, rest.iter().take(3).map(|word| word.bytes));
        } else {
            self.odd.bad_normal.add(keyword.offset);
            self.value(Kind::Normal, [b"0".as_slice(); 3].into_iter());
        }
    }

    /// The word as a finite number. Anything else is reported as an error and counts as 0.
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
        let mut corners: Vec<Indices> = Vec::new();
        for word in rest {
            let Some(corner) = self.corner(*word) else { return };
            corners.push(corner);
        }
        if corners.len() < 3 {
            self.odd.too_few.add(keyword.offset);
            return;
        }
        corners.dedup_by_key(|corner| corner[0]);
        while corners.len() > 1 && corners.first().map(|c| c[0]) == corners.last().map(|c| c[0]) {
            corners.pop();
        }
        if corners.len() < 3 {
            self.odd.degenerate.add(keyword.offset);
            return;
        }
        let (group, material) = self.numbers_of_next_face(keyword.offset);
        self.checked.faces.push(Face { group, material, offset: keyword.offset as u32 });
        let mut words = vec!["f".to_owned()];
        for corner in corners {
            raise(&mut self.highest, corner);
            self.checked.corners.push(gives(corner));
            let part = |kind: usize| if corner[kind] == 0 { String::new() } else { corner[kind].to_string() };
            words.push(format!("{}/{}/{}", part(0), part(1), part(2)));
        }
        self.checked.cleaned.write(words.iter().map(String::as_bytes));
    }

    /// The numbers of the group and the material that the lines so far give to the next face. The face's line begins at
    /// `offset`.
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

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`. Positive indices may point ahead, so their upper limit is checked at
    /// the end.
    fn corner(&mut self, word: Word<'_>) -> Option<Indices> {
        let mut parts = word.bytes.split(|&byte| byte == b'/');
        let mut corner = Indices::default();
        for (kind, part) in parts.by_ref().take(3).enumerate() {
            if !part.is_empty() || kind == 0 {
                corner[kind] = self.index(word, part, kind)?;
            }
        }
        if parts.next().is_some() {
            let message = format!("the corner {} has more than three indices", word.quoted());
            self.findings.error(word.offset, message, "write v, v/vt, v//vn or v/vt/vn");
            return None;
        }
        Some(corner)
    }

    fn index(&mut self, word: Word<'_>, part: &[u8], kind: usize) -> Option<u32> {
        let count = self.counts[kind];
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
            // The index counts backwards, but no line of its kind came yet. The whole file may have none, which is no
            // error.
            Some(_) if part[0] == b'-' && kind > 0 && count == 0 => {
                self.odd.absent[kind].add(word.offset);
                return Some(0);
            }
            Some(size) if part[0] == b'-' => {
                (count + 1).checked_sub(size as usize).filter(|&index| index > 0)
            }
            size => size.map(|size| size as usize),
        };
        let index = index.and_then(|index| u32::try_from(index).ok());
        if index.is_none() {
            let message = format!("the corner {} is out of range: there are {count} so far", word.quoted());
            self.findings.error(word.offset, message, "use an index that the file has");
        }
        index
    }

    /// Reports indices beyond what the whole file has. If the file has no texture coordinate (or no normal) at all, the
    /// indices of that kind are no errors: faces do without.
    fn check_upper_ends(&mut self) {
        let counts = self.counts;
        let mut beyond = |offset: usize, kind: usize, index: &str| {
            if kind > 0 && counts[kind] == 0 {
                self.odd.absent[kind].add(offset);
            } else {
                let (what, count) = (["vertex", "texture coordinate", "normal"][kind], counts[kind]);
                let message = format!("there is no {what} {index}: the file has {count}");
                self.findings.error(offset, message, "use an index that the file has");
            }
        };
        let is_beyond = |kind: usize, index: u32| index as usize > counts[kind];
        if (0..3).any(|kind| is_beyond(kind, self.highest[kind])) {
            let mut lines = Lines::new(self.text);
            let mut words = Vec::new();
            while lines.next_into(&mut words) {
                let rest = if matches!(words[0].bytes, b"f" | b"fo") { &words[1..] } else { &[] };
                for word in rest {
                    for (kind, part) in word.text().split('/').take(3).enumerate() {
                        if part.parse().is_ok_and(|index| is_beyond(kind, index)) {
                            beyond(word.offset, kind, part);
                        }
                    }
                }
            }
        }
    }

    fn finish(mut self) -> Checked<'a> {
        self.check_upper_ends();
        for kind in 1..3 {
            if self.counts[kind] > 0
                && let Some(offset) = self.odd.absent[kind].take()
            {
                let message = "this corner counts backwards beyond the first line of its kind";
                self.findings.error(offset, message, "use an index that the file has");
            }
        }
        let findings = &mut *self.findings;
        self.odd.tell(findings);
        if self.checked.faces.is_empty() && !findings.has_errors() {
            let message = match (self.counts[0], self.odd.lines_and_points) {
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

/// Whether a number or a corner was cut in the middle: it ends in a sign, a slash or the `e` of an exponent.
fn is_cut_number(word: Word<'_>) -> bool {
    matches!(word.bytes.last(), Some(b'/' | b'-' | b'+' | b'e' | b'E'))
}
