//! Reads a preset file that a user has made: stroke settings for other scenes.

use std::path::Path;

use super::parse::{options, parse_with};
use super::source::error_in;
use super::{read_brush, text_of};
use crate::assets::AssetFolders;
use crate::check;
use crate::document::Scene;
use crate::limits::MAX_SIDE_PX;
use crate::new_scene;
use crate::problem::{Problem, Report};
use crate::strokes_file::StrokesFile;

/// The end of a preset file's name.
pub const ENDING: &str = ".strokes.ron";

/// Whether a file is a preset, by its name.
pub fn is_preset(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    name.is_some_and(|name| name.ends_with(ENDING))
}

/// The name of the preset in a file: `thick oil` of `thick oil.strokes.ron`.
pub fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let bare = name.len().saturating_sub(ENDING.len());
    match name.get(bare..) {
        Some(ending) if ending.eq_ignore_ascii_case(ENDING) => name[..bare].to_owned(),
        _ => name.into_owned(),
    }
}

/// Reads a preset from its text; `path` is for messages only, no file is opened. A byte order mark is skipped.
///
/// # Errors
///
/// All that is wrong with the text, each with its position, as with a scene file.
pub fn parse(path: &Path, text: &str) -> Result<StrokesFile, Report> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (preset, located) = parse_with(path, text, |_, text| options().from_str(text))
        .map_err(|Report(problems)| Report(problems.into_iter().map(of_preset).collect()))?;
    let at = |field_path: &str| Some(located.place_of(field_path));
    let mut problems = Vec::new();
    let StrokesFile { height_px, strokes, .. } = &preset;
    if !(1..=MAX_SIDE_PX).contains(height_px) {
        let message = format!("{height_px} is out of range");
        let mend = format!("give a number from 1 to {MAX_SIDE_PX}");
        problems.push(error_in(path, at("height_px"), message, mend));
    }
    for (field, is_stated) in [("keys", !strokes.keys.is_empty()), ("layer", strokes.layer.is_some())] {
        if is_stated {
            let message = format!("a preset has no `{field}`: they belong to one scene");
            problems.push(error_in(path, at(&format!("strokes.{field}")), message, "leave it out"));
        }
    }
    let found = check::check(&in_scene(&preset)).into_iter();
    problems.extend(found.filter(|finding| finding.field_path.starts_with("strokes")).map(|finding| {
        Problem {
            severity: finding.severity,
            field_path: finding.field_path.clone().into(),
            ..error_in(path, at(&finding.field_path), finding.message, finding.mend)
        }
    }));
    if problems.is_empty() { Ok(preset) } else { Err(Report(problems)) }
}

/// Reads the file of a preset, and checks that the pictures of its brushes, which lie in its folder, can be used.
///
/// # Errors
///
/// All problems of the file, or of its pictures.
pub fn load(path: &Path) -> Result<StrokesFile, Report> {
    let preset = parse(path, &text_of(path)?)?;
    let scene = in_scene(&preset);
    let unusable = check::brush_pictures(&scene)
        .into_iter()
        .filter_map(|(name, _)| read_brush(path, name, &AssetFolders::default()).err());
    let problems: Vec<Problem> = unusable.collect();
    if problems.is_empty() { Ok(preset) } else { Err(Report(problems)) }
}

/// A scene with the preset's settings, so that they can be checked like those of a scene.
fn in_scene(preset: &StrokesFile) -> Scene {
    Scene { strokes: preset.strokes.clone(), ..new_scene::empty() }
}

/// Rewords a problem of the parser, which speaks of a scene, for a preset.
fn of_preset(problem: Problem) -> Problem {
    let message = problem
        .message
        .replace("the scene file", "the preset")
        .replace("the scene", "the preset")
        .replace("this scene", "this preset");
    let mend = problem.mend.replace(
        "compare with a scene written by `impasto new`",
        "compare with a preset that the window has saved",
    );
    Problem { message, mend, ..problem }
}

#[cfg(test)]
mod tests;
