//! Reads as much as possible of a scene with errors, and lists what could not be read, with fixes.
//!
//! ```text
//! text ─▶ brackets ─▶ values ─▶ checks ─▶ files ─▶ a valid scene
//!    ▲        │ cut      │ field or item overwritten with spaces
//!    └────────┴──────────┴─────────┘ and again; positions stay valid, since no text moves
//! ```
//!
//! The result has passed the same checks as any scene. The file itself is not changed.

mod cut;
mod files;
mod fix;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::parse::{
    self, blank_out, blank_range, enclosing_path, enclosing_struct_path, explain, field_before,
};
use super::source::{self, error_in};
use super::{FieldLocator, LoadOptions, text_of};
use crate::check::{self, Finding};
use crate::document::Scene;
use crate::limits;
use crate::loaded::{FoundFiles, LoadedScene};
use crate::locate::{Inside, Located, Step};
use crate::problem::{Problem, Report, Severity, TextPosition};

use files::FileCache;
pub use fix::{Fix, mended};

/// All passes over one text together scan and parse about this many bytes at most.
const MOST_PARSED_BYTES: usize = 64 << 20;

/// At most this many passes are made over one text.
const MOST_PASSES: usize = 1000;

/// A scene as far as it could be read.
#[derive(Clone, Debug)]
pub struct Salvaged {
    /// The scene and its files; boxes stand in for meshes that cannot be used.
    pub loaded: LoadedScene,
    /// What could not be read, in the order of the file; empty if everything was read.
    pub losses: Vec<Loss>,
    /// The text that the scene was read from, without byte order mark.
    pub text: String,
}

/// Something that could not be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// What is wrong, and where.
    pub problem: Problem,
    /// A sentence that says what is used until this is mended.
    pub instead: String,
    /// The name, as in the document, of the mesh that a box stands in for; `None` for any other loss.
    pub mesh: Option<String>,
    /// What would mend it.
    pub fix: Option<Fix>,
}

/// Reads as much of a scene file as can be read. Of `options`, only the folders are used.
///
/// # Errors
/// There is nothing to open: the file is missing or is not text, its version is newer, or it exceeds a limit of this
/// build.
pub fn salvage(path: &Path, options: &LoadOptions) -> Result<Salvaged, Report> {
    salvage_text(path, &text_of(path)?, options)
}

/// As [`salvage`], but reads the scene from `text`. Messages name `path`, and the scene's files are found from there.
///
/// # Errors
/// As [`salvage`].
pub fn salvage_text(path: &Path, text: &str, options: &LoadOptions) -> Result<Salvaged, Report> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.len() as u64 > limits::MAX_SCENE_BYTES {
        return Err(Report(vec![source::too_long(path)]));
    }
    let mut reading = Reading {
        path,
        left: text.to_owned(),
        losses: Vec::new(),
        blanked: Vec::new(),
        of_scene: Vec::new(),
        is_cut: false,
        unlisted: 0,
    };
    let mut cache = FileCache::new(path, options);
    let most_passes = (MOST_PARSED_BYTES / text.len().max(1)).clamp(2, MOST_PASSES);
    for _ in 0..most_passes {
        if let Some(loaded) = reading.pass(&mut cache)? {
            let mut losses = reading.losses;
            losses.sort_by_key(|loss| (loss.problem.place.is_none(), loss.problem.place));
            if reading.unlisted > 0 {
                let message = format!("{} more problems are not listed", reading.unlisted);
                let problem = error_in(path, None, message, "mend those above first");
                losses.push(Loss { problem, instead: String::new(), mesh: None, fix: None });
            }
            let loaded = LoadedScene { files: options.folders.found().copied(), ..loaded };
            return Ok(Salvaged { loaded, losses, text: text.to_owned() });
        }
    }
    Err(reading.given_up())
}

/// Index of a loss in the list; `None` if the list was full, so that the loss was only counted.
type Listed = Option<usize>;

/// A text from which errors are removed pass by pass.
struct Reading<'a> {
    path: &'a Path,
    /// The text with spaces in place of errors. Bytes keep their offsets; fields may have been added at the end.
    left: String,
    losses: Vec<Loss>,
    /// The ranges that were overwritten, each with the loss that it belongs to.
    blanked: Vec<(std::ops::Range<usize>, Listed)>,
    /// The names of the scene's outermost fields that were overwritten, as the text writes them.
    of_scene: Vec<String>,
    /// Whether the end of the text was cut off.
    is_cut: bool,
    unlisted: usize,
}

impl Reading<'_> {
    /// Makes one pass. Returns the scene if it is valid, or `None` if the text was changed and needs another pass.
    fn pass(&mut self, cache: &mut FileCache<'_>) -> Result<Option<LoadedScene>, Report> {
        let alone = |problem| Report(vec![problem]);
        let located = match source::scan_refusing(&self.left) {
            Ok(located) => located,
            Err(refused) => {
                self.cut(refused)?;
                return Ok(None);
            }
        };
        if let Err(problem) = parse::check_version(self.path, &located) {
            if parse::is_newer(&located) {
                return Err(alone(problem));
            }
            self.lose(problem, format!("It is read as version {}.", Scene::VERSION));
            if parse::version_field(&located).is_some() {
                self.blank(&located, "version");
            }
            self.add_at_end(&located, &format!("version: {}", Scene::VERSION));
            return Ok(None);
        }
        let scene = match parse::from_ron(&located, &self.left) {
            Ok(scene) => scene,
            Err(error) => {
                self.take_out(&located, &error)?;
                return Ok(None);
            }
        };
        let findings = check::check(&scene);
        if self.take_out_found(&located, &findings)? {
            return Ok(None);
        }
        let mut files = cache.read(&scene, &located);
        if !files.refused.is_empty() {
            for (problem, field_path, fix) in std::mem::take(&mut files.refused) {
                let index = self.lose(problem, "Left out until then.".to_owned());
                self.set_fix(index, fix);
                self.blank_for(&located, &field_path, index)?;
            }
            return Ok(None);
        }
        let on_meshes = check::check_with_meshes(&scene, &files.real, &files.caches);
        if self.take_out_found(&located, &on_meshes)? {
            return Ok(None);
        }
        let locator = FieldLocator { path: self.path, written: Some(&located), applied: &[], edited: None };
        let mut warnings: Vec<Problem> =
            findings.into_iter().chain(on_meshes).map(|finding| locator.problem(finding)).collect();
        super::sort_and_cap(self.path, &mut warnings, files.warnings);
        for loss in files.missing {
            self.add(loss);
        }
        let meshes = files.real.into_iter().chain(files.stand_ins).collect();
        Ok(Some(LoadedScene {
            path: self.path.to_owned(),
            scene,
            meshes,
            caches: files.caches,
            textures: files.textures,
            brushes: files.brushes,
            files: FoundFiles::default(),
            warnings,
        }))
    }

    /// Adds a loss. Beyond the limit a loss is only counted.
    fn lose(&mut self, problem: Problem, instead: String) -> Listed {
        self.add(Loss { problem, instead, mesh: None, fix: None })
    }

    fn add(&mut self, loss: Loss) -> Listed {
        if self.losses.len() >= limits::MAX_PROBLEMS {
            self.unlisted += 1;
            return None;
        }
        self.losses.push(loss);
        Some(self.losses.len() - 1)
    }

    fn set_fix(&mut self, loss: Listed, fix: Option<Fix>) {
        if let Some(index) = loss {
            self.losses[index].fix = fix;
        }
    }

    /// Ends the text before the part that cannot be scanned, and closes the open brackets.
    fn cut(&mut self, refused: crate::locate::Refused) -> Result<(), Report> {
        let cut = cut::before(&self.left, refused.offset.min(self.left.len()));
        let place = |offset| {
            Some(crate::locate::place_in(&self.left, &crate::locate::line_starts(&self.left), offset))
        };
        let problem =
            error_in(self.path, place(refused.offset), refused.message.clone(), refused.mend.clone());
        let Some(cut) = cut.filter(|_| !refused.is_limit) else {
            let severity = if refused.is_limit { Severity::Limit } else { Severity::Error };
            return Err(Report(vec![Problem { severity, ..problem }]));
        };
        let at = place(cut.read_to);
        let message = match at {
            Some(TextPosition { line, column }) => {
                format!("cannot read past line {line}, column {column}: {}", refused.message)
            }
            None => refused.message.clone(),
        };
        let instead = match cut.objects_behind {
            0 => "Everything before it is open.".to_owned(),
            1 => "Everything before it is open; 1 object after it is not.".to_owned(),
            count => format!("Everything before it is open; {count} objects after it are not."),
        };
        self.lose(Problem { message, place: at, ..problem }, instead);
        self.left = cut.text;
        self.is_cut = true;
        Ok(())
    }

    /// Removes the part at which the parser failed.
    fn take_out(&mut self, located: &Located, error: &ron::error::SpannedError) -> Result<(), Report> {
        let offset = |at: ron::error::Position| located.offset_in(&self.left, at.line, at.col);
        let span = (offset(error.span.start), offset(error.span.end));
        let unknown = match &error.code {
            ron::Error::NoSuchStructField { found, .. } => field_before(located, &self.left, found, span.1),
            ron::Error::DuplicateStructField { field, .. } => {
                field_before(located, &self.left, field, span.1)
            }
            _ => None,
        };
        let problem = explain(self.path, located, &error.code, span, unknown);
        if let Some(field) = unknown {
            let fix = fix::renamed(located, field, &error.code);
            let index = self.lose(problem, "Left out until then; its default serves.".to_owned());
            self.set_fix(index, fix);
            self.blanked.push((field.key.start as usize..field.value.end as usize, index));
            self.note_of_scene(located, field.key.start as usize);
            blank_out(&mut self.left, field);
            return Ok(());
        }
        let root_start = located.root().start as usize;
        if span.1 < root_start || matches!(error.code, ron::Error::NoSuchExtension(_)) {
            self.lose(problem, "Left out until then.".to_owned());
            blank_range(&mut self.left, 0..root_start);
            return Ok(());
        }
        let (field_path, at) = match &error.code {
            ron::Error::MissingStructField { field, .. } => {
                let path = enclosing_struct_path(located, span.1);
                if path.is_empty() {
                    return self.add_missing(located, field, problem);
                }
                let at = located.node_at(&path).map_or(span.1, |node| node.start as usize);
                (path, at)
            }
            _ => enclosing_path(located, span.0, span.1),
        };
        let node = located.node_at(&field_path);
        let within = node.map_or(at..at, |node| node.start as usize..node.end as usize);
        // A field that is missing because it was removed is not a loss of its own.
        let cause = self.blanked.iter().rev().find(|(range, _)| within.contains(&range.start));
        let index = match cause {
            Some(&(_, listed)) => {
                if let Some(index) = listed {
                    self.losses[index].instead =
                        format!("{} is left out until then.", described(&field_path));
                }
                listed
            }
            None => self.lose(problem, format!("{} is left out until then.", described(&field_path))),
        };
        self.blank_for(located, &field_path, index)
    }

    /// Adds a required field of the scene that is missing.
    fn add_missing(&mut self, located: &Located, field: &str, problem: Problem) -> Result<(), Report> {
        let written = match field {
            "version" => "version: 1",
            "objects" => "objects: []",
            "camera" => "camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))])",
            _ => return Err(Report(vec![problem])),
        };
        // A field that was cut off, mistyped or removed is reported already.
        let is_removed = self.of_scene.iter().any(|name| fix::is_near(name, field));
        if !self.is_cut && !is_removed {
            self.lose(problem, "A usual one stands in for it.".to_owned());
        }
        self.add_at_end(located, written);
        Ok(())
    }

    /// Removes everything fatal that the checks found; returns whether there was anything.
    fn take_out_found(&mut self, located: &Located, findings: &[Finding]) -> Result<bool, Report> {
        let fatal: Vec<&Finding> = findings.iter().filter(|finding| finding.severity.is_fatal()).collect();
        let locator = FieldLocator { path: self.path, written: Some(located), applied: &[], edited: None };
        let before = self.left.clone();
        let already_blanked = self.blanked.len();
        for finding in &fatal {
            if finding.field_path.is_empty() {
                continue;
            }
            let instead = format!("{} is left out until then.", described(&finding.field_path));
            let index = self.lose(locator.problem((*finding).clone()), instead);
            // Several things may be wrong with one field; it is taken out once.
            let is_out = removable_range(located, &finding.field_path, &before).is_some_and(|range| {
                let mut out = self.blanked[already_blanked..].iter();
                out.any(|(blanked, _)| blanked.start <= range.start && range.end <= blanked.end)
            });
            if !is_out {
                self.blank_for(located, &finding.field_path, index)?;
            }
        }
        if !fatal.is_empty() && self.left == before {
            return Err(self.given_up_with(fatal.iter().map(|finding| locator.problem((*finding).clone()))));
        }
        Ok(!fatal.is_empty())
    }

    /// If an outermost field of the scene begins at `start`, notes its name, since it is about to be overwritten.
    fn note_of_scene(&mut self, located: &Located, start: usize) {
        let Inside::Fields(fields) = &located.root().inside else { return };
        let field = fields.iter().find(|field| field.key.start as usize == start);
        self.of_scene.extend(field.map(|field| located.text_of(&field.key).to_owned()));
    }

    /// Overwrites a field with spaces. Returns false if it was overwritten before.
    fn blank(&mut self, located: &Located, field_path: &str) -> bool {
        let Some(range) = removable_range(located, field_path, &self.left) else { return false };
        blank_range(&mut self.left, range);
        true
    }

    /// Overwrites the [`removable_range`] of a field or item with spaces. If that range is overwritten already,
    /// overwrites the range of the value around it.
    fn blank_for(&mut self, located: &Located, field_path: &str, loss: Listed) -> Result<(), Report> {
        let mut path = field_path.to_owned();
        loop {
            if let Some(range) = removable_range(located, &path, &self.left) {
                self.note_of_scene(located, range.start);
                blank_range(&mut self.left, range.clone());
                self.blanked.push((range, loss));
                return Ok(());
            }
            let Some(cut) = path.rfind(['.', '[']) else { return Err(self.given_up()) };
            path.truncate(cut);
        }
    }

    /// Writes a field at the end of the scene, before its closing bracket.
    fn add_at_end(&mut self, located: &Located, field: &str) {
        let end = located.root().end as usize - 1;
        let before = self.left[located.root().start as usize..end].trim_end();
        let comma = if before.ends_with(['(', ',']) { "" } else { "," };
        self.left.insert_str(end, &format!("{comma} {field},"));
    }

    fn given_up(&self) -> Report {
        self.given_up_with(std::iter::empty())
    }

    fn given_up_with(&self, more: impl Iterator<Item = Problem>) -> Report {
        let problems: Vec<Problem> =
            self.losses.iter().map(|loss| loss.problem.clone()).chain(more).collect();
        if problems.is_empty() {
            return Report(vec![error_in(
                self.path,
                None,
                "nothing of the scene can be read",
                "mend it by hand",
            )]);
        }
        Report(problems)
    }
}

/// The range of text to overwrite in order to remove a field. It covers the innermost field or list item on the field's
/// path that the text states, with the comma behind it. `None` if there is none, or if only spaces are left there.
fn removable_range(located: &Located, field_path: &str, left: &str) -> Option<std::ops::Range<usize>> {
    let mut node = located.root();
    let mut range = None;
    for step in Step::split(field_path) {
        let outer = located.through_some(node);
        match (&outer.inside, step) {
            (Inside::Fields(fields), Step::Field(name)) => {
                let Some(field) = fields.iter().find(|field| located.text_of(&field.key) == name) else {
                    break;
                };
                range = Some(field.key.start as usize..field.value.end as usize);
                node = &field.value;
            }
            (Inside::Items(items), Step::Index(index)) => {
                let Some(item) = items.get(index) else { break };
                // One number of a tuple cannot be left out alone.
                if located.text_of(outer).starts_with('[') {
                    range = Some(item.start as usize..item.end as usize);
                }
                node = item;
            }
            _ => break,
        }
    }
    let range = parse::with_comma(left, range?);
    let is_left = left.get(range.clone())?.chars().any(|character| !character.is_whitespace());
    is_left.then_some(range)
}

/// What a message calls a value: *The object* or *The key* for an item of a list, else the name of its field.
fn described(field_path: &str) -> String {
    let last = field_path.rsplit('.').next().unwrap_or(field_path);
    match last.split_once('[') {
        Some((list, _)) => format!("The {}", list.strip_suffix('s').unwrap_or(list).replace('_', " ")),
        None if last.is_empty() => "It".to_owned(),
        None => format!("`{last}`"),
    }
}
