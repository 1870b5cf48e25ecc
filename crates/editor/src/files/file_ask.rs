//! The purposes for which the user is asked for a file, and the kinds of files that fit each.

use std::path::{Path, PathBuf};

use impasto_scene::load::strokes_file::{ENDING, is_preset};

use super::incoming::{Kind, name_of, refusal};

/// The purpose of a file that the user is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FileAsk {
    /// Open a scene, or a mesh in a new scene.
    Open,
    /// Import a mesh.
    ImportMesh,
    /// Save the scene to another file.
    SaveAs,
    /// Save a copy of the scene.
    SaveCopy,
    /// Find a mesh that the scene names.
    LocateMesh,
    /// Find a file of any kind that another file names.
    Missing,
    /// Choose a picture.
    ChoosePicture,
    /// Save a preset.
    SavePreset,
    /// Choose a preset.
    LoadPreset,
    /// Choose where rendered frames go.
    RenderOutput {
        /// The ending for a name without one.
        ending: &'static str,
    },
}

impl FileAsk {
    /// The title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene or a mesh",
            Self::ImportMesh => "Import a mesh",
            Self::SaveAs => "Save the scene as",
            Self::SaveCopy => "Save a copy of the scene",
            Self::LocateMesh => "Locate the mesh",
            Self::Missing => "Locate the missing file",
            Self::ChoosePicture => "Choose a picture",
            Self::SavePreset => "Save as a preset",
            Self::LoadPreset => "Load a preset",
            Self::RenderOutput { .. } => "Choose where the frames go",
        }
    }

    /// The kinds of files that fit; empty if any file does.
    pub fn kinds(self) -> &'static [Kind] {
        match self {
            Self::Open => &[Kind::Scene, Kind::Mesh],
            Self::ImportMesh | Self::LocateMesh => &[Kind::Mesh],
            Self::SaveAs | Self::SaveCopy => &[Kind::Scene],
            Self::Missing => &[],
            Self::SavePreset | Self::LoadPreset => &[Kind::Preset],
            Self::ChoosePicture => &[Kind::Picture],
            Self::RenderOutput { .. } => &[Kind::Picture, Kind::Exr, Kind::Movie],
        }
    }

    /// The path with the ending that a saved file needs, added if it is missing.
    pub(super) fn completed(self, path: PathBuf) -> PathBuf {
        match self {
            Self::SaveAs | Self::SaveCopy => self.as_file(path, "ron"),
            Self::SavePreset => as_preset(path),
            Self::RenderOutput { ending } => self.as_file(path, ending),
            Self::Open
            | Self::ImportMesh
            | Self::LocateMesh
            | Self::Missing
            | Self::ChoosePicture
            | Self::LoadPreset => path,
        }
    }

    /// Whether the file will be written.
    pub fn is_save(self) -> bool {
        matches!(self, Self::SaveAs | Self::SaveCopy | Self::SavePreset | Self::RenderOutput { .. })
    }

    /// Whether a file is of a kind that fits.
    ///
    /// # Errors
    /// Why it does not fit, in words to show.
    pub(crate) fn fits(self, path: &Path) -> Result<(), String> {
        match Kind::of(path) {
            _ if self.kinds().is_empty() => Ok(()),
            Some(kind) if self.kinds().contains(&kind) => Ok(()),
            None | Some(Kind::Exr | Kind::Movie) => Err(refusal(path)),
            Some(_) => Err(format!("{} is not what is asked for: {}", name_of(path), self.title())),
        }
    }

    fn as_file(self, path: PathBuf, ending: &str) -> PathBuf {
        if self.fits(&path).is_ok() {
            return path;
        }
        let mut name = path.into_os_string();
        name.push(".");
        name.push(ending);
        PathBuf::from(name)
    }
}

/// The path with the whole ending of a preset. The typed path may already have a part of that ending.
fn as_preset(mut path: PathBuf) -> PathBuf {
    if is_preset(&path) {
        return path;
    }
    for part in ["ron", "strokes"] {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(part)) {
            path.set_extension("");
        }
    }
    let mut name = path.into_os_string();
    name.push(ENDING);
    PathBuf::from(name)
}
