//! What to do with files that are dropped on the window, opened or imported.

mod adopt;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use impasto_editor_model::Document;
use impasto_editor_model::render_settings::FileKind;
use impasto_scene::load::strokes_file::is_preset;
use impasto_scene::mesh_format;

pub use adopt::{AdoptError, Adopted, adopt_mesh, adopt_picture, bring};

/// File extensions of pictures that can serve as textures and brushes.
pub const PICTURES: &[&str] = &["png", "jpg", "jpeg", "bmp", "tga", "webp"];

/// The kind of a file, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A scene, `.ron`.
    Scene,
    /// A preset, `.strokes.ron`.
    Preset,
    /// A mesh or a shot: `.obj`, `.gltf`, `.glb`.
    Mesh,
    /// A picture, one of [`PICTURES`].
    Picture,
    /// A rendered picture that only other programs read, `.exr`.
    Exr,
    /// A movie, which only other programs read.
    Movie,
}

impl Kind {
    /// The kind of a file, by its extension; none if Impasto neither reads nor writes such files.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "ron" if is_preset(path) => Some(Self::Preset),
            "ron" => Some(Self::Scene),
            "exr" => Some(Self::Exr),
            ending if FileKind::Movie.endings().contains(&ending) => Some(Self::Movie),
            _ if mesh_format::is_mesh(path) => Some(Self::Mesh),
            ending => PICTURES.contains(&ending).then_some(Self::Picture),
        }
    }
}

/// What the open document holds when files come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Present {
    /// Nothing: an untitled document that nobody has touched.
    Nothing,
    /// A scene without unsaved edits.
    Saved,
    /// A scene with unsaved edits.
    Edited,
}

impl Present {
    /// What a document holds.
    pub fn of(document: &Document) -> Self {
        let is_empty = document.file().is_none() && document.scene().objects.is_empty();
        match document.is_edited() {
            true => Self::Edited,
            false if is_empty => Self::Nothing,
            false => Self::Saved,
        }
    }
}

/// One thing to do with one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Open the scene in place of the document.
    Open(PathBuf),
    /// Make a new scene for the mesh in place of the document.
    Begin(PathBuf),
    /// Bring the mesh into the document ([`adopt_mesh`]).
    Import(PathBuf),
    /// Replace the stroke settings of the selected region, or of the scene, by the preset.
    Preset(PathBuf),
    /// Bring the picture in as the texture of the selected object, or as a brush ([`adopt_picture`]).
    Picture(PathBuf),
}

/// What to do with files that came together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// The steps, in order.
    pub steps: Vec<Step>,
    /// Whether the first step would drop unsaved edits, so that the user has to be asked.
    pub asks: bool,
    /// Why files are not taken, in words to show.
    pub refused: Vec<String>,
}

/// What to do with files that are dropped or opened together.
///
/// A scene is opened alone. A mesh starts a new scene if the document is empty, and is imported otherwise. Presets are
/// applied, and pictures become textures or brushes, if there is a scene.
pub fn plan(paths: &[PathBuf], present: Present) -> Plan {
    let mut plan = Plan::default();
    let mut known = Vec::new();
    for path in paths {
        match taken(path) {
            Ok(kind) if !known.contains(&(kind, path)) => known.push((kind, path)),
            Ok(_) => (),
            Err(words) => plan.refused.push(words),
        }
    }
    if let Some(&(_, scene)) = known.iter().find(|(kind, _)| *kind == Kind::Scene) {
        plan.steps.push(Step::Open(scene.clone()));
        plan.asks = present == Present::Edited;
        let left = known.iter().filter(|(_, path)| *path != scene);
        plan.refused.extend(left.map(|(kind, path)| match kind {
            Kind::Scene => format!("{} is left: one scene is open at a time", name_of(path)),
            _ => format!("{} is left: drop it again to bring it into {}", name_of(path), name_of(scene)),
        }));
        return plan;
    }
    let mut is_there = present != Present::Nothing;
    for (_, mesh) in known.iter().filter(|(kind, _)| *kind == Kind::Mesh) {
        let mesh = (*mesh).clone();
        plan.steps.push(if is_there { Step::Import(mesh) } else { Step::Begin(mesh) });
        is_there = true;
    }
    for (_, preset) in known.iter().filter(|(kind, _)| *kind == Kind::Preset) {
        if is_there {
            plan.steps.push(Step::Preset((*preset).clone()));
        } else {
            let words = format!("{} is for the strokes of a scene: open one first", name_of(preset));
            plan.refused.push(words);
        }
    }
    for (_, picture) in known.iter().filter(|(kind, _)| *kind == Kind::Picture) {
        if is_there {
            plan.steps.push(Step::Picture((*picture).clone()));
        } else {
            let words = format!(
                "{} could be a texture or a brush, and there is nothing to paint yet: open a mesh first",
                name_of(picture)
            );
            plan.refused.push(words);
        }
    }
    plan
}

/// The kind of a file, if it can be used.
///
/// # Errors
/// Why it cannot be used, in words to show.
pub fn taken(path: &Path) -> Result<Kind, String> {
    let name = name_of(path);
    if path.is_dir() {
        return Err(format!("{name} is a folder: drop the files in it"));
    }
    if !path.exists() {
        return Err(format!("{name} is not there: {}", path.display()));
    }
    if !path.is_file() {
        return Err(format!("{name} is a device or a pipe, not a file"));
    }
    Kind::of(path).filter(|kind| !matches!(kind, Kind::Exr | Kind::Movie)).ok_or_else(|| refusal(path))
}

/// Why a file that Impasto does not read is not taken.
pub(super) fn refusal(path: &Path) -> String {
    let name = name_of(path);
    let ending =
        path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "blend" | "fbx" | "ply" | "stl" | "dae" | "abc" | "usd" | "usda" | "usdc" | "usdz" => {
            format!("{name} is a model that Impasto does not read: export it as glTF or OBJ")
        }
        "exr" => format!("{name} is a rendered picture: Impasto writes EXR files and does not read them"),
        ending if FileKind::Movie.endings().contains(&ending) => {
            format!("{name} is a movie: Impasto writes movies and does not read them")
        }
        "mtl" => format!("{name} holds materials only: open the OBJ file that names it"),
        _ => format!("{name} is no scene (.ron), mesh (.obj, .glb) or picture (.png, .jpg)"),
    }
}

pub(crate) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
