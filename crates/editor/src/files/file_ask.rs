//! The purposes for which the user is asked for a file, and the kinds of files that fit each.

use std::path::PathBuf;

use super::incoming::Kind;

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
    /// Choose where rendered frames go.
    RenderOutput,
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
            Self::RenderOutput => "Choose where the frames go",
        }
    }

    /// The kinds of files that fit.
    pub fn kinds(self) -> &'static [Kind] {
        match self {
            Self::Open => &[Kind::Scene, Kind::Mesh],
            Self::ImportMesh | Self::LocateMesh => &[Kind::Mesh],
            Self::SaveAs | Self::SaveCopy => &[Kind::Scene],
            Self::RenderOutput => &[Kind::Picture],
        }
    }

    /// The path with the ending that a saved file needs, added if it is missing.
    pub(super) fn completed(self, path: PathBuf) -> PathBuf {
        match self {
            Self::SaveAs | Self::SaveCopy => as_file(path, Kind::Scene, ".ron"),
            Self::RenderOutput => as_file(path, Kind::Picture, ".png"),
            Self::Open | Self::ImportMesh | Self::LocateMesh => path,
        }
    }

    /// Whether the file will be written.
    pub fn is_save(self) -> bool {
        matches!(self, Self::SaveAs | Self::SaveCopy | Self::RenderOutput)
    }
}

fn as_file(path: PathBuf, kind: Kind, ending: &str) -> PathBuf {
    if Kind::of(&path) == Some(kind) {
        return path;
    }
    let mut name = path.into_os_string();
    name.push(ending);
    PathBuf::from(name)
}
