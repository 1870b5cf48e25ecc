//! Presets of the user's own: the folder that they are kept in, and the pictures of brushes that go with them.

use std::path::{Path, PathBuf};

use impasto_scene::load::strokes_file::{is_preset, name_of};
use impasto_scene::strokes_file::StrokesFile;

use super::incoming::{AdoptError, adopt_picture};
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

/// Makes the pictures of a preset's brushes available in `folder`: copies those that lie elsewhere, and names them as
/// they are found from there. `file_of` finds the file of a brush; a brush without a file keeps its name. No file is
/// overwritten.
///
/// # Errors
/// Why a picture could not be used or copied.
pub fn take_brushes_along(
    preset: &mut StrokesFile,
    file_of: impl Fn(&str) -> Option<PathBuf>,
    folder: &Path,
) -> Result<(), AdoptError> {
    let mut renamed: Vec<(String, String)> = Vec::new();
    for name in preset.brush_pictures() {
        if let Some(file) = file_of(name) {
            renamed.push((name.to_owned(), adopt_picture(&file, folder, "brushes")?.name));
        }
    }
    preset.rename_brushes(|name| {
        renamed.iter().find(|(before, _)| before == name).map(|(_, after)| after.clone())
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use impasto_scene::document::BrushMix;
    use impasto_scene::load::strokes_file::load;
    use impasto_scene::new_scene;
    use impasto_scene::save::write_preset;

    use super::*;

    /// A light dot on a dark ground.
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
        let mut preset = StrokesFile::of(&painted, None);
        take_brushes_along(&mut preset, |name| Some(scene.join(name)), presets).unwrap();
        let path = presets.join("thick.strokes.ron");
        write_preset(&path, &preset).unwrap();
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
        assert_ne!(names[0], "brushes/mine/mine.png", "the other picture stays");
        let [from, to] =
            [scene.join("mine.png"), other.join(&names[0])].map(|path| std::fs::read(path).unwrap());
        assert_eq!(from, to);
    }
}
