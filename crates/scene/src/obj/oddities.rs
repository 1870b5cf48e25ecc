//! Oddities of an OBJ text, which are no errors. They are counted line by line, and each kind is reported once as a
//! warning.

use std::collections::BTreeSet;

use super::text::Findings;

/// Counts one kind of oddity, which is reported once, with its first place.
#[derive(Default)]
pub(super) struct Tally {
    count: usize,
    first: usize,
}

impl Tally {
    pub fn add(&mut self, offset: usize) {
        if self.count == 0 {
            self.first = offset;
        }
        self.count += 1;
    }

    /// Where the first one stands, if there is any. Resets the count, so that this kind is not reported again.
    pub fn take(&mut self) -> Option<usize> {
        (std::mem::take(&mut self.count) > 0).then_some(self.first)
    }

    fn tell(&self, findings: &mut Findings<'_>, what: &str, mend: &str) {
        if self.count > 0 {
            let more = if self.count == 1 { String::new() } else { format!(" ({} in all)", self.count) };
            findings.warning(self.first, format!("{what}{more}"), mend);
        }
    }
}

#[derive(Default)]
pub(super) struct Oddities {
    pub degenerate: Tally,
    pub too_few: Tally,
    pub plus: Tally,
    pub zero_w: Tally,
    pub bad_normal: Tally,
    pub bad_uv: Tally,
    /// One tally for each [`super::scan::Kind`]: corners that refer to texture coordinates, or to normals, though the
    /// file has none. A missing position is an error, so the first tally stays 0.
    pub absent: [Tally; 3],
    pub color: Tally,
    pub bad_color: Tally,
    pub extra: Tally,
    pub free_form: Tally,
    pub free_form_words: BTreeSet<String>,
    pub unknown: Tally,
    pub unknown_words: BTreeSet<String>,
    pub lines_and_points: usize,
}

impl Oddities {
    pub fn tell(&self, findings: &mut Findings<'_>) {
        self.degenerate.tell(findings, "this face repeats its corners and has no area", "it is left out");
        self.too_few.tell(findings, "this face has fewer than 3 corners", "it is left out");
        self.plus.tell(
            findings,
            "this index is written with a +, which not every reader takes",
            "leave the + out",
        );
        self.zero_w.tell(
            findings,
            "this vertex has the weight 0, a point at infinity",
            "the weight is ignored",
        );
        self.bad_normal.tell(
            findings,
            "this normal has no direction",
            "normals of its faces are worked out from the surface",
        );
        self.bad_uv.tell(
            findings,
            "this texture coordinate is not made of finite numbers",
            "0 is used in its place",
        );
        self.absent[1].tell(
            findings,
            "this corner refers to texture coordinates, and the file has none",
            "export them too; pictures are not shown on these faces",
        );
        self.absent[2].tell(
            findings,
            "this corner refers to normals, and the file has none",
            "export them too; they are worked out from the surface",
        );
        self.color.tell(
            findings,
            "this vertex has a colour, and colours of vertices are not used",
            "use a material",
        );
        self.bad_color.tell(
            findings,
            "this vertex has a colour or weight that is not made of finite numbers",
            "it is ignored; colours come from materials",
        );
        self.extra.tell(
            findings,
            "this vertex has an odd number of numbers",
            "those after the third are ignored",
        );
        if self.free_form.count > 0 {
            let words: Vec<&str> = self.free_form_words.iter().map(String::as_str).collect();
            let message = format!("curves and free-form surfaces are not read ({})", words.join(", "));
            findings.warning(self.free_form.first, message, "turn them into polygons before export");
        }
        if self.unknown.count > 0 {
            let words: Vec<&str> = self.unknown_words.iter().map(String::as_str).collect();
            let words = words.join(", ");
            let message = match self.unknown.count {
                1 => format!("this line begins with a word that OBJ does not know ({words})"),
                count => format!("{count} lines begin with words that OBJ does not know ({words})"),
            };
            let mend = if self.unknown.count == 1 { "it is ignored" } else { "they are ignored" };
            findings.warning(self.unknown.first, message, mend);
        }
    }
}
