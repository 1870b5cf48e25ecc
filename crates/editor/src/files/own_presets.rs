//! Presets of the user's own: the folder that they are kept in, and the pictures of brushes that go with them.

use std::path::{Path, PathBuf};

use impasto_editor_model::Document;
use impasto_editor_model::command::{Command, Regions, StrokesOf};
use impasto_editor_model::document::Trial;
use impasto_scene::assets::{AssetFolders, AssetRequest};
use impasto_scene::load::strokes_file::{self, is_preset, name_of};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::problem::Report;
use impasto_scene::save;
use impasto_scene::strokes_file::StrokesFile;
use impasto_scene::whole_file::failure_in_words;

use super::incoming::adopt_picture;
use super::preferences::config_folder;

/// The most presets that are listed.
const MOST: usize = 200;

/// A preset of the user's own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnPreset {
    /// Its name.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
}

impl OwnPreset {
    /// The name of its picture among those of all presets.
    pub fn key(&self) -> String {
        self.path.to_string_lossy().into_owned()
    }
}

/// The folder of the user's presets; none if the user has no home.
pub fn presets_folder() -> Option<PathBuf> {
    Some(config_folder()?.join("presets"))
}

/// The presets in a folder, by name; none if the folder is not there.
pub fn presets_in(folder: &Path) -> Vec<OwnPreset> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.flatten().map(|entry| entry.path()).filter(|path| is_preset(path) && path.is_file());
    let mut found: Vec<OwnPreset> = paths.map(|path| OwnPreset { name: name_of(&path), path }).collect();
    found.sort_by(|a, b| (&a.name, &a.path).cmp(&(&b.name, &b.path)));
    found.truncate(MOST);
    found
}

/// Writes a preset to `path`, and copies the pictures of its brushes into the folder of `path`. `file_of` finds the
/// file of a brush.
///
/// # Errors
/// Why it was not saved, in words to show. Pictures may have been copied by then.
pub fn save_preset(
    mut preset: StrokesFile,
    file_of: impl Fn(&str) -> Option<PathBuf>,
    path: &Path,
) -> Result<(), String> {
    let words = |why: String| format!("the preset could not be saved to {}: {why}", path.display());
    let is_readable = |preset: &StrokesFile| {
        let read = strokes_file::parse(path, &save::preset_to_ron(preset));
        read.map(drop).map_err(|report| words(in_words(&report)))
    };
    is_readable(&preset)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    take_brushes_along(&mut preset, file_of, folder).map_err(words)?;
    is_readable(&preset)?;
    save::write_preset(path, &preset).map_err(|error| words(failure_in_words(&error)))
}

/// The command that applies the preset in the file `path`. Once it is known that the document takes the preset, its
/// pictures are copied beside the scene.
///
/// # Errors
/// Why it cannot be applied, in words to show. If the reason is a picture, other pictures may have been copied before.
pub fn preset_command(document: &Document, of: &StrokesOf, path: &Path) -> Result<Command, String> {
    let mut preset = strokes_file::load(path).map_err(|report| in_words(&report))?;
    let command = |preset: &StrokesFile| {
        let (of, preset, name) = (of.clone(), Box::new(preset.clone()), name_of(path));
        Command::Regions(Regions::ApplyPreset { of, preset, name })
    };
    if let Some(refusal) = document.would_refuse(&command(&preset.without_pictures())) {
        return Err(refusal.to_string());
    }
    let file_of = |name: &str| {
        let root = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let root = root.unwrap_or(Path::new("."));
        let request = AssetRequest { beside: path, root, name, max_bytes: u64::MAX };
        AssetFolders::default().find(&request).ok()
    };
    take_brushes_along(&mut preset, file_of, document.folder())?;
    Ok(command(&preset))
}

/// The scene of `trial` with the preset in the file `path` applied. The preset's pictures are not copied. `None` if the
/// preset cannot be applied.
pub fn seen_with_preset(trial: &Trial, of: &StrokesOf, path: &Path) -> Option<LoadedScene> {
    let preset = Box::new(strokes_file::load(path).ok()?);
    let command = Command::Regions(Regions::ApplyPreset { of: of.clone(), preset, name: name_of(path) });
    trial.with(&command, path.parent()).ok()
}

/// The first problems of a preset.
fn in_words(Report(problems): &Report) -> String {
    let words: Vec<String> = problems.iter().take(3).map(ToString::to_string).collect();
    words.join("; ")
}

/// Makes the pictures of a preset's brushes available in `folder`: copies those that lie elsewhere, and renames the
/// brushes to the pictures' paths relative to `folder`. No file is overwritten.
fn take_brushes_along(
    preset: &mut StrokesFile,
    file_of: impl Fn(&str) -> Option<PathBuf>,
    folder: &Path,
) -> Result<(), String> {
    let found = preset.brush_pictures().into_iter().map(|name| {
        let file = file_of(name).ok_or_else(|| format!("the file of the brush {name} is not there"))?;
        Ok((name.to_owned(), file))
    });
    // All files must be found before any is copied.
    let found: Vec<(String, PathBuf)> = found.collect::<Result<_, String>>()?;
    let mut renamed: Vec<(String, String)> = Vec::new();
    for (name, file) in found {
        let adopted = adopt_picture(&file, folder, "brushes").map_err(|error| error.to_string())?;
        renamed.push((name, adopted.name));
    }
    preset.rename_brushes(|name| {
        renamed.iter().find(|(before, _)| before == name).map(|(_, after)| after.clone())
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use impasto_scene::document::{BrushMix, Region, Selector};
    use impasto_scene::load::LoadOptions;
    use impasto_scene::load::strokes_file::load;
    use impasto_scene::new_scene;

    use super::*;

    /// Writes a picture for a brush: a light square on black.
    fn mark(path: &Path, side: u32) {
        let picture = image::RgbaImage::from_fn(side, side, |x, y| {
            let inside = x.abs_diff(side / 2) < side / 4 && y.abs_diff(side / 2) < side / 4;
            image::Rgba(if inside { [255; 4] } else { [0, 0, 0, 255] })
        });
        picture.save(path).unwrap();
    }

    #[test]
    fn a_preset_goes_to_the_folder_and_into_another_scene_with_its_pictures() {
        let places = [0; 3].map(|_| tempfile::tempdir().unwrap());
        let [scene, presets, other] = places.each_ref().map(tempfile::TempDir::path);
        mark(&scene.join("mine.png"), 64);
        let mut painted = new_scene::empty();
        painted.strokes.brush = Some(BrushMix(vec!["mine.png".to_owned(), "flat".to_owned()]));
        let preset = StrokesFile::of(&painted, None);
        let path = presets.join("thick.strokes.ron");
        save_preset(preset, |name| Some(scene.join(name)), &path).unwrap();
        std::fs::write(presets.join("other.ron"), "").unwrap();
        let listed = presets_in(presets);
        assert_eq!(listed, [OwnPreset { name: "thick".to_owned(), path: path.clone() }]);
        assert!(presets_in(&presets.join("none")).is_empty());

        let mut there = load(&path).expect("its picture lies beside it");
        // The other scene has another picture of the same name.
        std::fs::create_dir_all(other.join("brushes/mine")).unwrap();
        mark(&other.join("brushes/mine/mine.png"), 32);
        take_brushes_along(&mut there, |name| Some(presets.join(name)), other).unwrap();
        let Some(BrushMix(names)) = &there.strokes.brush else { panic!("{there:?}") };
        assert_eq!(names[1], "flat");
        assert_ne!(names[0], "brushes/mine/mine.png", "the preset names the other picture");
        let [from, to] =
            [scene.join("mine.png"), other.join(&names[0])].map(|path| std::fs::read(path).unwrap());
        assert_eq!(from, to);
    }

    fn files_in(folder: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().path()).collect()
    }

    #[test]
    fn what_could_not_be_read_again_is_not_saved() {
        let folder = tempfile::tempdir().unwrap();
        let presets = folder.path().join("presets");
        std::fs::create_dir(&presets).unwrap();
        mark(&folder.path().join("mine.png"), 64);
        let path = presets.join("thick.strokes.ron");
        let at_hand = |name: &str| Some(folder.path().join(name)).filter(|file| file.is_file());
        let mut scene = new_scene::empty();
        scene.strokes.brush = Some(BrushMix(vec!["mine.png".to_owned(), "gone.png".to_owned()]));
        let words = save_preset(StrokesFile::of(&scene, None), at_hand, &path).unwrap_err();
        assert!(words.contains("thick.strokes.ron") && words.contains("gone.png"), "{words}");
        assert_eq!(files_in(&presets), [""; 0].map(PathBuf::from), "the picture that exists was copied");
        scene.strokes.brush = Some(BrushMix(vec!["mine.png".to_owned()]));
        scene.strokes.length_px = Some(f64::INFINITY);
        let words = save_preset(StrokesFile::of(&scene, None), at_hand, &path).unwrap_err();
        assert!(words.contains("out of range") || words.contains("inf"), "{words}");
        assert_eq!(files_in(&presets), [""; 0].map(PathBuf::from));
        scene.strokes.length_px = Some(40.0);
        save_preset(StrokesFile::of(&scene, None), at_hand, &path).unwrap();
        assert!(load(&path).is_ok());
    }

    #[test]
    fn a_preset_that_the_scene_refuses_leaves_no_file_beside_it() {
        let places = [0; 2].map(|_| tempfile::tempdir().unwrap());
        let [presets, home] = places.each_ref().map(tempfile::TempDir::path);
        mark(&presets.join("mine.png"), 64);
        let mut scene = new_scene::empty();
        scene.strokes.brush = Some(BrushMix(vec!["mine.png".to_owned()]));
        let path = presets.join("thick.strokes.ron");
        save_preset(StrokesFile::of(&scene, None), |name| Some(presets.join(name)), &path).unwrap();
        let file = home.join("scene.ron");
        let mut other = new_scene::empty();
        other.regions.push(Region { locked: true, ..Region::new("skin", Selector::Everything) });
        save::write(&file, &other).unwrap();
        let mut document = Document::open(&file, &LoadOptions::default()).unwrap();
        let of_skin = StrokesOf::Region("skin".to_owned());
        let words = preset_command(&document, &of_skin, &path).unwrap_err();
        assert!(words.contains("skin"), "{words}");
        assert_eq!(files_in(home), std::slice::from_ref(&file));
        let command = preset_command(&document, &StrokesOf::Scene, &path).unwrap();
        document.apply(&command).unwrap();
        let brush = BrushMix(vec!["brushes/mine/mine.png".to_owned()]);
        assert_eq!(document.scene().strokes.brush, Some(brush));
        assert!(home.join("brushes/mine/mine.png").is_file());
    }
}
