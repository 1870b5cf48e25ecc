//! Reads MTL files line by line, with warnings for what cannot be used. Their pictures are only named here;
//! `material_library` reads those.

use super::text::{Findings, Lines, Walk, Word, name_of, to_utf8};
use crate::problem::{Problem, TextPosition};
use std::collections::HashSet;
use std::path::Path;

/// The colour (sRGB) of whatever has no material.
pub(super) const GREY: [f32; 3] = [0.8; 3];

/// A material as one `newmtl` describes it.
#[derive(Clone, Debug)]
pub(super) struct Described {
    pub name: String,
    /// `None` where there is no `Kd` that can be used.
    pub color: Option<[f32; 3]>,
    /// The picture's name as written.
    pub picture: Option<String>,
    /// Where the line that names the picture begins in the MTL file.
    pub picture_place: Option<TextPosition>,
    /// Mean of `Ks`, 0..=1.
    highlight: f32,
    /// `Ns`, 0..=1000.
    exponent: f32,
}

impl Described {
    /// Strength of highlights: 0 is matt, 1 is glazed. What common exporters write for a plain surface (Ks 0.5, Ns 250)
    /// gives 0.25.
    pub(super) fn gloss(&self) -> f32 {
        self.highlight * (self.exponent / 1000.0).sqrt()
    }
}

/// Reads an MTL text. Nothing in it is fatal: what cannot be used is left out with a warning.
pub(super) fn parse(path: &Path, bytes: Vec<u8>) -> (Vec<Described>, Vec<Problem>) {
    let (text, was_utf16) = to_utf8(bytes);
    let mut findings = Findings::new(path, &text);
    if was_utf16 {
        findings.warning(0, "the file is UTF-16", "save it as UTF-8");
    }
    let mut materials: Vec<Described> = Vec::new();
    let mut names: HashSet<String> = HashSet::new();
    let mut lines = Lines::new(&text);
    let mut words = Vec::new();
    let mut walk = Walk::default();
    while lines.next_into(&mut words) {
        let (keyword, rest) = (words[0], &words[1..]);
        if keyword.bytes == b"newmtl" {
            check_name(keyword, rest, &mut findings);
            if !names.insert(name_of(rest)) {
                let message = format!("the material {:?} is described already", name_of(rest));
                findings.warning(
                    keyword.offset,
                    message,
                    "the first description is used; give this one a name of its own",
                );
            }
            materials.push(Described {
                name: name_of(rest),
                color: None,
                picture: None,
                picture_place: None,
                highlight: 0.0,
                exponent: 0.0,
            });
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        match keyword.bytes {
            b"Kd" => {
                material.color = color(keyword, rest, &mut findings).or(material.color);
            }
            b"Ks" => material.highlight = mean(rest).clamp(0.0, 1.0),
            b"Ns" => material.exponent = mean(rest).clamp(0.0, 1000.0),
            b"d" | b"Tr" => opacity(keyword, rest, &mut findings),
            b"map_Kd" | b"map_kd" => {
                material.picture = picture_name(rest);
                material.picture_place = Some(walk.to(&text, keyword.offset));
                if material.picture.is_none() {
                    findings.warning(keyword.offset, "this texture map names no file", "it is left out");
                }
            }
            _ => {}
        }
    }
    if materials.is_empty() {
        findings.warning(0, "the file describes no material", "begin each one with newmtl and its name");
    }
    let warnings = findings.finish().unwrap_or_else(|report| report.0);
    (materials, warnings)
}

fn check_name(keyword: Word<'_>, rest: &[Word<'_>], findings: &mut Findings<'_>) {
    if rest.is_empty() {
        findings.warning(keyword.offset, "this material has no name", "write newmtl and a name");
    }
    if let Some(word) = rest.iter().find(|word| std::str::from_utf8(word.bytes).is_err()) {
        findings.warning(word.offset, "this name is not UTF-8 text", "save the file as UTF-8");
    }
}

/// The colour of a `Kd` line, each channel in 0..=1; one number means grey.
fn color(keyword: Word<'_>, rest: &[Word<'_>], findings: &mut Findings<'_>) -> Option<[f32; 3]> {
    let mend = "write Kd r g b with numbers from 0 to 1";
    let mut numbers = Vec::new();
    for word in rest.iter().take(3) {
        let Some(number) = word.text().parse::<f32>().ok().filter(|number| number.is_finite()) else {
            findings.warning(
                word.offset,
                format!("{} is not a number for a colour; grey is used", word.quoted()),
                mend,
            );
            return None;
        };
        numbers.push(number);
    }
    let [r, g, b] = match numbers[..] {
        [r, g, b] => [r, g, b],
        [grey] => [grey; 3],
        _ => {
            let message =
                format!("a colour needs 3 numbers and this one has {}; grey is used", numbers.len());
            findings.warning(keyword.offset, message, mend);
            return None;
        }
    };
    let channels = [r, g, b];
    if channels.iter().any(|channel| !(0.0..=1.0).contains(channel)) {
        findings.warning(keyword.offset, "this colour is outside of 0 to 1; it is brought inside", mend);
    }
    Some(channels.map(|channel| channel.clamp(0.0, 1.0)))
}

/// Mean of the numbers of a line; 0 where none can be used. Mistakes in highlights are not worth a warning.
fn mean(rest: &[Word<'_>]) -> f32 {
    let numbers: Vec<f32> = rest
        .iter()
        .take(3)
        .map_while(|word| word.text().parse::<f32>().ok())
        .filter(|n| n.is_finite())
        .collect();
    if numbers.is_empty() { 0.0 } else { numbers.iter().sum::<f32>() / numbers.len() as f32 }
}

fn opacity(keyword: Word<'_>, rest: &[Word<'_>], findings: &mut Findings<'_>) {
    let Some(value) = rest.last().and_then(|word| word.text().parse::<f32>().ok()) else { return };
    let opacity = if keyword.bytes == b"Tr" { 1.0 - value } else { value };
    if opacity <= 0.0 || !opacity.is_finite() {
        findings.warning(
            keyword.offset,
            "this material is fully transparent; it is painted as opaque",
            "write d 1",
        );
    }
}

/// The file's name on a map line, after its options.
fn picture_name(words: &[Word<'_>]) -> Option<String> {
    let mut rest = words;
    while let Some((option, after)) = rest.split_first() {
        let (least, most) = match option.bytes {
            b"-o" | b"-s" | b"-t" => (1, 3),
            b"-mm" => (2, 2),
            b"-blendu" | b"-blendv" | b"-boost" | b"-bm" | b"-cc" | b"-clamp" | b"-colorspace"
            | b"-imfchan" | b"-texres" | b"-type" => (1, 1),
            _ => break,
        };
        let is_number = |word: &&Word<'_>| word.text().parse::<f32>().is_ok();
        let numbers = after.iter().take(most).take_while(is_number).count().max(least);
        rest = after.get(numbers..).unwrap_or(&[]);
    }
    Some(name_of(rest).trim_matches('"').to_owned()).filter(|name| !name.is_empty())
}
