//! The settings in the render sheet (the dialog for rendering): which frames, what size, which files. Also the plan
//! that follows from these settings.
//!
//! ```text
//! RenderSettings ─▶ plan(document, frame) ─▶ RenderPlan: the document as it is now, each frame and its file
//!                                        └─▶ command: the same as an `impasto render` command line
//! ```

mod command;
mod file_kind;
mod progress;
#[cfg(test)]
mod tests;

use std::collections::HashSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use impasto_frame_files::{FrameList, Pattern, PlaceError, not_an_input, ready_folder};
use impasto_scene::aovs::AovSet;
use impasto_scene::document::Scene;
use impasto_scene::limits::{MAX_PIXELS, MAX_SIDE_PX};
use impasto_scene::loaded::LoadedScene;

use crate::document::Document;

use file_kind::FileEnding;

pub use command::shell_words;
pub use file_kind::{AovChoice, AovGroup, FileKind};
pub use progress::{Outcome, RenderProgress, Stage};

/// Where frames go unless something else is chosen, relative to the scene's folder.
pub const OUTPUT: &str = "out/frame_####.png";

/// Which frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Which {
    /// The whole shot.
    #[default]
    All,
    /// The frame that is shown.
    This,
    /// Those of [`RenderSettings::list`].
    Listed,
}

/// What draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RenderDriver {
    /// EGL where it works, else OSMesa.
    #[default]
    Automatic,
    /// EGL, on a graphics card or in software.
    Egl,
    /// OSMesa, in software.
    Osmesa,
}

/// What happens to files that are there already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// They are rendered again.
    #[default]
    Replace,
    /// Files that are whole stay, and their frames are left out.
    Keep,
}

/// The settings in the sheet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// Which frames.
    pub which: Which,
    /// The list of [`Which::Listed`], as `impasto render --frames` reads it.
    pub list: String,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Which files are written for each frame.
    pub kind: FileKind,
    /// What EXR files hold beside the colour.
    pub aovs: AovChoice,
    /// The pattern of the files, relative to the scene's folder: `####` stands for the frame number. Its ending is that
    /// of the kind.
    pub output: String,
    /// What draws.
    pub driver: RenderDriver,
    /// Whether the tone under the paint and the background are left out.
    pub transparent: bool,
}

/// A field of the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// The frames.
    Frames,
    /// Width and height.
    Size,
    /// The files.
    Output,
}

/// A setting with which nothing can be rendered, with the words to show under its field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The field.
    pub field: Field,
    /// What is wrong with the field, and how to mend it.
    pub words: String,
}

/// What will be rendered. Holds the document as it was when the plan was made.
#[derive(Clone, Debug)]
pub struct RenderPlan {
    /// The scene with its files.
    pub loaded: Arc<LoadedScene>,
    /// The frames to be rendered.
    pub frames: FrameList,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// What draws.
    pub driver: RenderDriver,
    /// Whether the tone under the paint and the background are left out.
    pub transparent: bool,
    /// What happens to files that are there.
    pub existing: Existing,
    /// Which files are written for each frame.
    pub kind: FileKind,
    aovs: AovChoice,
    pattern: Pattern,
    output: PathBuf,
    list: String,
}

impl RenderSettings {
    /// Settings for the whole shot at the scene's size.
    pub fn of(scene: &Scene) -> Self {
        Self {
            which: Which::All,
            list: whole_range(scene),
            size_px: [scene.size.0, scene.size.1],
            kind: FileKind::default(),
            aovs: AovChoice::default(),
            output: OUTPUT.to_owned(),
            driver: RenderDriver::default(),
            transparent: false,
        }
    }

    /// Chooses the kind of the files; the ending of their names follows.
    pub fn choose_kind(&mut self, kind: FileKind) {
        self.kind = kind;
        self.output = kind.renamed(&self.output);
    }

    /// Takes over a pattern for the files; the kind follows its ending.
    pub fn choose_output(&mut self, output: String) {
        self.kind = self.kind.fitting(&output);
        self.output = output;
    }

    /// The usual ending of the kind; the name of a movie may have another.
    pub fn ending(&self) -> &'static str {
        self.kind.endings()[0]
    }

    /// The chosen frames as a list.
    pub fn frames(&self, scene: &Scene, shown: f64) -> String {
        match self.which {
            Which::All => whole_range(scene),
            Which::This => format!("{}", shown.round() as i64),
            Which::Listed => self.list.trim().to_owned(),
        }
    }

    /// The plan for rendering the document as it is now.
    ///
    /// # Errors
    /// The fault of the first field that has one.
    pub fn plan(&self, document: &Document, shown: f64) -> Result<RenderPlan, Fault> {
        let fault = |field: Field| move |words: String| Fault { field, words };
        let list = self.frames(document.scene(), shown);
        let frames = FrameList::parse(&list).map_err(fault(Field::Frames))?;
        check_size(self.size_px).map_err(fault(Field::Size))?;
        let mut output = output_file(&self.output, document.folder()).map_err(fault(Field::Output))?;
        let kind = self.kind.fitting(&self.output);
        if kind != FileKind::Movie {
            // Files are written with the ending in small letters, however it was typed.
            output.set_extension(kind.endings()[0]);
        }
        if kind == FileKind::Movie && self.transparent && !is_clear(&output) {
            let words = "this kind of movie holds no transparency: let the name end in .mov or .webm";
            return Err(fault(Field::Output)(words.to_owned()));
        }
        // A movie is one file, whatever its name contains.
        let count = if kind == FileKind::Movie { 1 } else { frames.count() };
        let pattern = Pattern::parse(&output.to_string_lossy(), count);
        Ok(RenderPlan {
            loaded: Arc::clone(document.loaded()),
            frames,
            size_px: self.size_px,
            driver: self.driver,
            transparent: self.transparent,
            existing: Existing::Replace,
            kind,
            aovs: self.aovs,
            pattern,
            output,
            list,
        })
    }
}

impl RenderPlan {
    /// The same plan, but whole files that are there already stay.
    pub fn keeping(self) -> Self {
        Self { existing: Existing::Keep, ..self }
    }

    /// The file of a frame. If two files are written for it, both have this name, each with its own ending. A movie is
    /// one file for all frames.
    pub fn path(&self, frame: i64) -> PathBuf {
        match self.kind {
            FileKind::Movie => self.output.clone(),
            _ => self.pattern.path(frame),
        }
    }

    /// What EXR files hold beside the colour; `None` where none are written.
    pub fn aovs(&self) -> Option<AovSet> {
        self.kind.has_exr().then(|| self.aovs.set(&self.loaded.scene))
    }

    /// The pattern of all files, as an absolute path.
    pub fn output(&self) -> &Path {
        &self.output
    }

    /// The folder of all files.
    pub fn folder(&self) -> &Path {
        self.output.parent().unwrap_or(Path::new("/"))
    }

    /// Whether the files lie outside the scene's folder.
    pub fn is_outside(&self) -> bool {
        let folder = self.loaded.path.parent().unwrap_or(Path::new(""));
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let goes_up = |path: &Path| path.components().any(|part| part == std::path::Component::ParentDir);
        self.output.strip_prefix(folder).map_or(true, goes_up)
    }

    /// How many of its frames have a file already, whole or not.
    pub fn existing_count(&self) -> usize {
        let there = names_in(self.folder());
        let is_named = |path: PathBuf| path.file_name().is_some_and(|name| there.contains(name));
        let is_there = |frame: &i64| self.kind.files(&self.path(*frame)).into_iter().any(is_named);
        self.frames.iter().filter(is_there).count()
    }

    /// The frames that have a PNG file of this rendering when `done` frames are finished, each with that file; empty if
    /// the kind has no PNG. With [`Existing::Replace`] only the first `done` frames of the list count, because files of
    /// later frames are left from an earlier rendering. With [`Existing::Keep`] every file that is there counts.
    pub fn finished(&self, done: u64) -> Vec<(i64, PathBuf)> {
        if !self.kind.has_png() {
            return Vec::new();
        }
        let there = names_in(self.folder());
        let ours = match self.existing {
            Existing::Replace => usize::try_from(done).unwrap_or(usize::MAX),
            Existing::Keep => usize::MAX,
        };
        let frames = self.frames.iter().take(ours).map(|frame| (frame, self.path(frame)));
        frames.filter(|(_, path)| path.file_name().is_some_and(|name| there.contains(name))).collect()
    }

    /// Makes the folder; checks that files can be written there, and that none is a file that the scene is read from.
    ///
    /// # Errors
    /// When files cannot be written there, or one would replace a file that the scene is read from.
    pub fn ready(&self) -> Result<(), PlaceError> {
        ready_folder(&self.output)?;
        let (inputs, there) = (self.loaded.inputs(), names_in(self.folder()));
        let is_there = |path: &PathBuf| path.file_name().is_some_and(|name| there.contains(name));
        let files = self.frames.iter().flat_map(|frame| self.kind.files(&self.path(frame)));
        files.filter(is_there).try_for_each(|path| not_an_input(&path, &inputs))
    }

    /// The name of the scene's file, which the rendered files record.
    pub fn scene_name(&self) -> String {
        self.loaded.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }
}

fn names_in(folder: &Path) -> HashSet<OsString> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name()).collect()
}

/// All frames of the scene's timeline, as a list.
fn whole_range(scene: &Scene) -> String {
    let timeline = &scene.timeline;
    if timeline.first == timeline.last {
        timeline.first.to_string()
    } else {
        format!("{}-{}", timeline.first, timeline.last)
    }
}

/// A count in words: *1 frame*, *120 frames*.
pub fn counted_frames(count: u64) -> String {
    if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") }
}

/// The scene's size, scaled to `percent`.
pub fn scaled(scene: &Scene, percent: u32) -> [u32; 2] {
    [scene.size.0, scene.size.1].map(|side| side.saturating_mul(percent).div_ceil(100).max(1))
}

/// The scene's shape, with 3840 pixels along its longer side.
pub fn size_4k(scene: &Scene) -> [u32; 2] {
    let sides = [scene.size.0, scene.size.1].map(f64::from);
    let scale = 3840.0 / sides[0].max(sides[1]);
    sides.map(|side| ((side * scale).round() as u32).max(1))
}

fn check_size(size_px: [u32; 2]) -> Result<(), String> {
    if size_px.contains(&0) {
        return Err("a picture has at least one pixel each way".to_owned());
    }
    let pixels = u64::from(size_px[0]) * u64::from(size_px[1]);
    if size_px.iter().any(|&side| side > MAX_SIDE_PX) || pixels > MAX_PIXELS {
        return Err(format!("the limit is {MAX_SIDE_PX} pixels a side and {MAX_PIXELS} in all"));
    }
    Ok(())
}

/// Whether a movie of this name can be transparent.
fn is_clear(movie: &Path) -> bool {
    let ending = movie.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    ["mov", "webm"].contains(&ending.as_str())
}

/// The pattern that was typed, as an absolute path.
fn output_file(typed: &str, folder: &Path) -> Result<PathBuf, String> {
    let typed = typed.trim();
    let name = Path::new(typed).file_name().map(|name| name.to_string_lossy().into_owned());
    let Some(name) = name.filter(|_| !typed.ends_with(['/', '\\'])) else {
        return Err(format!("name a file, such as {OUTPUT}"));
    };
    if typed.contains('\0') {
        return Err("a name cannot hold this character".to_owned());
    }
    if FileEnding::of(&name).is_none() {
        let words = "let the name end in .png or .exr, or in .mp4, .mov, .webm or .mkv for a movie";
        return Err(words.to_owned());
    }
    let path = folder.join(typed);
    let path = std::path::absolute(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    if path.to_str().is_none() {
        return Err(format!("{}: the folder's name is no text", path.display()));
    }
    Ok(path)
}
