//! The document that is edited: a scene with its files, its history, and where it is saved.

mod disk;
mod mending;
mod opening;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use impasto_scene::assets::AssetFolders;
use impasto_scene::document::{Region, Scene};
use impasto_scene::load::{self, LoadOptions};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::new_scene;
use impasto_scene::problem::Report;

use crate::change::SceneChange;
use crate::command::{Arrange, Command, Done};
use crate::history::History;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};
use crate::stamp::Stamp;

pub use crate::source::Source;
pub use disk::SaveError;
pub use mending::{ProblemRow, Repair};

/// A document that is edited.
#[derive(Clone, Debug)]
pub struct Document {
    loaded: Arc<LoadedScene>,
    preview: Option<Arc<LoadedScene>>,
    /// The file that `save` writes. None if the scene was never saved, or if it was recovered from a copy and it is not
    /// known which parts of the scene's text that copy lost.
    file: Option<PathBuf>,
    history: History,
    selection: Selection,
    options: LoadOptions,
    /// The stamp of the file when it was last read or written.
    stamp: Option<Stamp>,
    /// The text that the scene was read from. It is stored only if parts of it could not be read or used, or if the
    /// user was editing it when the window was killed.
    source: Option<Arc<Source>>,
    revision: u64,
}

/// What a command, an undo or a redo did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// The text of the history, such as *Comb skin*. Empty if the history did not change.
    pub text: String,
    /// An additional message, such as *Also keyed frame 0, so that apple moves from there*.
    pub note: Option<String>,
}

/// The last frame of a new scene: five seconds at 24 frames per second.
const LAST_FRAME: i64 = 119;

/// A copy of a document's scene on which commands can be tried.
#[derive(Clone, Debug)]
pub struct Trial {
    loaded: Arc<LoadedScene>,
    folders: AssetFolders,
}

impl Trial {
    /// The scene as it would be after a command. Files may also come from the folder `also`.
    ///
    /// # Errors
    /// Why the command would be refused.
    pub fn with(&self, command: &Command, also: Option<&Path>) -> Result<LoadedScene, Refusal> {
        let mut folders = self.folders.clone();
        folders.extra.extend(also.map(Path::to_owned));
        Ok(edited(&self.loaded, &folders, command)?.0)
    }
}

fn edited(
    loaded: &LoadedScene,
    folders: &AssetFolders,
    command: &Command,
) -> Result<(LoadedScene, Done), Refusal> {
    let mut scene = loaded.scene.clone();
    let done = command.edit(&mut scene, loaded)?;
    let loaded = loaded.with_scene(scene, folders).map_err(|report| Refusal::of(&report))?;
    Ok((loaded, done))
}

impl Document {
    /// An empty document; paths of its files are relative to `folder`.
    pub fn empty(folder: &Path) -> Self {
        let mut scene = new_scene::empty();
        scene.timeline.last = LAST_FRAME;
        let loaded = LoadedScene {
            path: folder.join("untitled.ron"),
            scene,
            meshes: Default::default(),
            textures: Default::default(),
            caches: Default::default(),
            brushes: Default::default(),
            files: Default::default(),
            warnings: Vec::new(),
        };
        Self::of(loaded, None, LoadOptions::default())
    }

    /// Opens a scene file (`.ron`), or a mesh or a shot (`.obj`, `.gltf`, `.glb`) in a new scene of its own.
    ///
    /// # Errors
    /// Everything that is wrong with the files, each with its place.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Report> {
        let stamp = Stamp::of(path);
        let mut loaded = load::load(path, options)?;
        let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron"));
        if !is_scene {
            loaded.scene.timeline.last = LAST_FRAME;
            // The first object gets regions for its groups or materials, or one for all of it, ready to be painted.
            let mesh = loaded
                .scene
                .objects
                .first()
                .and_then(|object| Some((object, loaded.meshes.get(&object.mesh)?)));
            let regions = mesh.map_or_else(Vec::new, |(object, mesh)| new_scene::regions_of(object, mesh));
            let first = loaded.scene.regions.len();
            for (index, region) in regions.into_iter().enumerate() {
                let color = Some(new_scene::REGION_COLORS[(first + index) % new_scene::REGION_COLORS.len()]);
                loaded.scene.regions.push(Region { color, ..region });
            }
        }
        let file = is_scene.then(|| path.to_owned());
        let stamp = stamp.filter(|_| is_scene);
        // The mesh that was opened is selected.
        let mesh = loaded.scene.objects.first().filter(|_| !is_scene);
        let selection =
            mesh.map_or_else(Selection::default, |object| Selection::only(Item::Object(object.name.clone())));
        Ok(Self { stamp, selection, ..Self::of(loaded, file, options.clone()) })
    }

    fn of(loaded: LoadedScene, file: Option<PathBuf>, options: LoadOptions) -> Self {
        let is_saved = file.is_some() || loaded.scene.objects.is_empty();
        Self {
            loaded: Arc::new(loaded),
            preview: None,
            file,
            history: History::new(is_saved),
            selection: Selection::default(),
            options,
            stamp: None,
            source: None,
            revision: 0,
        }
    }

    /// The scene without any preview.
    pub fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    /// The scene with its files, without any preview.
    pub fn loaded(&self) -> &Arc<LoadedScene> {
        &self.loaded
    }

    /// The scene with its files as it is shown: with the preview of a command, if there is one.
    pub fn shown(&self) -> &Arc<LoadedScene> {
        self.preview.as_ref().unwrap_or(&self.loaded)
    }

    /// What is selected.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// Sets the selection; things that do not exist are left out. Makes no entry in the history.
    pub fn select(&mut self, mut selection: Selection) {
        let scene = &self.loaded.scene;
        selection.retain(|item| item.is_in(scene));
        self.selection = selection;
    }

    /// Shows the scene as a command would leave it, until [`Document::end_preview`], a command, undo, redo, or reading
    /// again.
    ///
    /// # Errors
    /// As [`Document::apply`]; what was shown before stays.
    pub fn preview(&mut self, command: &Command) -> Result<(), Refusal> {
        let (loaded, _) = self.edited(command)?;
        self.preview = Some(Arc::new(loaded));
        Ok(())
    }

    /// Why a command would be refused; none if it would be carried out.
    pub fn would_refuse(&self, command: &Command) -> Option<Refusal> {
        self.edited(command).err()
    }

    /// A copy of the scene as it is now. Commands can be tried on it on any thread.
    pub fn trial(&self) -> Trial {
        Trial { loaded: self.held(), folders: self.options.folders.clone() }
    }

    /// Ends a preview.
    pub fn end_preview(&mut self) {
        self.preview = None;
    }

    /// Carries a command out: makes one entry in the history, or none if it changes nothing.
    ///
    /// # Errors
    /// Why it is refused, in the words to show. Only a preview ends then; all else stays as it was.
    pub fn apply(&mut self, command: &Command) -> Result<Step, Refusal> {
        self.preview = None;
        let (loaded, done) = self.edited(command)?;
        let before = self.selection.clone();
        let change = SceneChange::between(&self.loaded.scene, &loaded.scene);
        if change.is_some() {
            self.loaded = Arc::new(loaded);
        }
        self.select(done.selection.unwrap_or_else(|| before.clone()));
        let Some(change) = change else { return Ok(Step { text: String::new(), note: done.note }) };
        self.revision += 1;
        self.history.push(done.text.clone(), change, [before, self.selection.clone()]);
        Ok(Step { text: done.text, note: done.note })
    }

    /// As [`Document::apply`], for changes in small steps: steps with the same `key` within a second of each other are
    /// one entry.
    ///
    /// # Errors
    /// As [`Document::apply`].
    pub fn apply_merged(&mut self, command: &Command, key: &str, at_secs: f64) -> Result<Step, Refusal> {
        if !self.history.mergeable(key, at_secs) {
            let count = self.history.count();
            let step = self.apply(command)?;
            if self.history.count() != count || !step.text.is_empty() {
                self.history.mark_last(key.to_owned(), at_secs);
            }
            return Ok(step);
        }
        self.preview = None;
        let (loaded, done) = self.edited(command)?;
        let mut first = self.loaded.scene.clone();
        if let Some(change) = self.history.last_change() {
            change.undo(&mut first);
        }
        let change = SceneChange::between(&first, &loaded.scene);
        self.loaded = Arc::new(loaded);
        self.revision += 1;
        if self.history.replace_last(change, self.selection.clone()) {
            self.history.mark_last(key.to_owned(), at_secs);
        }
        Ok(Step { text: done.text, note: done.note })
    }

    fn edited(&self, command: &Command) -> Result<(LoadedScene, Done), Refusal> {
        edited(&self.held(), &self.options.folders, command)
    }

    /// An edited scene with its files; refused if anything is wrong with it.
    fn with_files(&self, scene: Scene) -> Result<LoadedScene, Refusal> {
        self.held().with_scene(scene, &self.options.folders).map_err(|report| Refusal::of(&report))
    }

    /// The scene, with a box in place of each mesh that cannot be used.
    fn held(&self) -> Arc<LoadedScene> {
        let held = self.source.as_ref().map(|source| Arc::new(source.held(&self.loaded)));
        held.unwrap_or_else(|| Arc::clone(&self.loaded))
    }

    /// Stores a mesh that was already read, so that it is not read again. `mesh` is its path relative to the scene's
    /// folder. If a mesh is stored for this path already, that one stays. The scene does not change.
    pub fn hold_mesh(&mut self, mesh: &str, file: Arc<MeshFile>) {
        let mut loaded = (*self.loaded).clone();
        loaded.meshes.entry(mesh.to_owned()).or_insert(file);
        self.loaded = Arc::new(loaded);
    }

    /// Reads a mesh by its path relative to the scene's folder and adds an object for it, with regions for its groups
    /// or materials.
    ///
    /// # Errors
    /// What is wrong with the file, in the words to show.
    pub fn import(&mut self, mesh: &str) -> Result<Step, Refusal> {
        let file = match self.loaded.meshes.get(mesh) {
            Some(file) => Arc::clone(file),
            None => {
                let path = self.folder().join(mesh);
                let read =
                    load::load_mesh(&path, &self.options.folders).map_err(|report| Refusal::of(&report))?;
                Arc::new(read.0)
            }
        };
        // The command then need not read the file again.
        self.hold_mesh(mesh, Arc::clone(&file));
        self.apply(&Command::Arrange(Arrange::Import { mesh: mesh.to_owned(), file }))
    }

    /// Undoes the last entry of the history; `None` if there is no entry to undo.
    pub fn undo(&mut self) -> Option<Step> {
        self.preview = None;
        let entry = self.history.undo()?.clone();
        if let Some([before, _]) = entry.sources {
            self.source = before;
        }
        let mut scene = self.loaded.scene.clone();
        entry.change.undo(&mut scene);
        self.go_to(scene, entry.selections[0].clone(), entry.text)
    }

    /// Redoes the entry that was undone last; `None` if there is no entry to redo.
    pub fn redo(&mut self) -> Option<Step> {
        self.preview = None;
        let entry = self.history.redo()?.clone();
        if let Some([_, after]) = entry.sources {
            self.source = after;
        }
        let mut scene = self.loaded.scene.clone();
        entry.change.redo(&mut scene);
        self.go_to(scene, entry.selections[1].clone(), entry.text)
    }

    /// Goes to a scene of the history. The scene was valid once, so only its files can be at fault now. If they are,
    /// the files loaded so far stay, and the step's note says what is wrong.
    fn go_to(&mut self, scene: Scene, selection: Selection, text: String) -> Option<Step> {
        self.revision += 1;
        let loaded = self.with_files(scene.clone());
        let note = loaded.as_ref().err().map(ToString::to_string);
        self.loaded = Arc::new(loaded.unwrap_or_else(|_| LoadedScene { scene, ..(*self.loaded).clone() }));
        self.select(selection);
        Some(Step { text, note })
    }

    /// The text of the entry that would be undone.
    pub fn undo_text(&self) -> Option<&str> {
        self.history.next_undo().map(|entry| entry.text.as_str())
    }

    /// The text of the entry that would be redone.
    pub fn redo_text(&self) -> Option<&str> {
        self.history.next_redo().map(|entry| entry.text.as_str())
    }

    /// How many entries can be undone.
    pub fn undo_count(&self) -> usize {
        self.history.count()
    }

    /// Whether there are unsaved edits.
    pub fn is_edited(&self) -> bool {
        !self.history.is_saved()
    }

    /// How many entries of the history separate the scene from its file.
    pub fn changes(&self) -> usize {
        self.history.since_saved()
    }

    /// A number that grows with every change of the scene.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The file that `save` writes.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The document's name in the title bar: *still_life.ron*, *Untitled*.
    pub fn name(&self) -> String {
        let file = self.file.as_ref().and_then(|file| file.file_name());
        file.map_or_else(|| "Untitled".to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// The proposed file of a copy: *still_life_copy.ron*.
    pub fn suggested_copy(&self) -> PathBuf {
        let own = self.suggested_file();
        let stem = own.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        own.with_file_name(format!("{stem}_copy.ron"))
    }

    /// The folder that paths in the scene are relative to.
    pub fn folder(&self) -> &Path {
        let folder = self.loaded.path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new("."))
    }

    /// Makes the scene's paths relative to another folder. Does so only if the scene was never saved and names no
    /// files; returns whether it did.
    pub fn live_in(&mut self, folder: &Path) -> bool {
        let is_free = self.file.is_none() && self.files_named().next().is_none();
        if is_free {
            self.preview = None;
            let path = folder.join("untitled.ron");
            self.loaded = Arc::new(LoadedScene { path, ..(*self.loaded).clone() });
        }
        is_free
    }

    /// The proposed file for saving: the scene's own, or one named after its first object, or *untitled.ron*.
    pub fn suggested_file(&self) -> PathBuf {
        if let Some(file) = &self.file {
            return file.clone();
        }
        let stem = self.scene().objects.first().map_or("untitled", |object| object.name.as_str());
        let stem: String =
            stem.chars().map(|c| if c.is_alphanumeric() || "-_ ".contains(c) { c } else { '_' }).collect();
        self.folder().join(format!("{stem}.ron"))
    }
}
