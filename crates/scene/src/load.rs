//! Loads a scene with all files that it names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::assets::{self, AssetFolders, AssetRequest};
use crate::built_in_mesh;
use crate::check::{self, Finding};
use crate::document::{Brought, Lost, Scene, Up};
use crate::limits;
use crate::loaded::{FoundFiles, LoadedScene};
use crate::locate::Located;
use crate::mesh_file::{MeshFile, Texture};
use crate::mesh_format::{self, MeshRead, MeshReader};
use crate::new_scene::{NewScene, Placing};
use crate::point_cache::PointCache;
use crate::problem::{Problem, Report, Severity};
use crate::shot::{Choice, Shot};

mod edited;
mod field_words;
mod files;
mod overrides;
mod parse;
pub mod salvage;
mod source;
pub mod strokes_file;

use files::{Files, Readers, as_scene_problem};
use overrides::Applied;
pub use overrides::edited_text;
use parse::Parsed;
use source::error_in;

/// What the command line adds to a scene file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Where the files that the scene names may lie, besides the scene's folder.
    pub folders: AssetFolders,
    /// Values that replace those of the file, in order (`--set PATH=VALUE`): each is a field path and RON. Text needs
    /// no quotes; an item of a list is named by its index or its name, as in `objects[0].particles` and
    /// `objects.apple.particles`; `style.RotatingStrokes.solver` and `style.solver` are the same field.
    pub overrides: Vec<(String, String)>,
    /// How a mesh without a scene is placed.
    pub placing: Placing,
}

/// Reads a document from its text; `path` is for messages only, no file is opened. A byte order mark is skipped.
///
/// This finds text that is not RON, unknown fields, and values of the wrong kind. Whether the values make sense
/// together is checked by [`crate::check`].
///
/// # Errors
///
/// The unknown fields up to the first error of another kind, and that error, each with its position.
pub fn parse(path: &Path, text: &str) -> Result<Scene, Report> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    parse::parse(path, text).map(|parsed| parsed.scene)
}

/// Reads a scene file (`.ron`) with everything that it names, and checks all of it. A mesh or a shot (`.obj`, `.gltf`,
/// `.glb`) is read in the scene that [`crate::new_scene`] makes for it.
///
/// # Errors
///
/// All problems that were found, warnings included, those of the scene file first; at least one is fatal. If the text
/// cannot be parsed or the shot cannot be read, nothing else is reported.
pub fn load(path: &Path, options: &LoadOptions) -> Result<LoadedScene, Report> {
    let files = FoundFiles::default();
    let options = &LoadOptions { folders: options.folders.noting(&files), ..options.clone() };
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let loaded = match extension.as_deref() {
        Some("ron") => load_scene(path, options),
        Some(_) if mesh_format::is_mesh(path) => load_alone(path, options),
        _ => {
            let mend = "name a scene file (.ron) or a mesh (.obj, .gltf, .glb)";
            Err(Report(vec![error_in(path, None, "this is neither a scene nor a mesh", mend)]))
        }
    };
    let mut loaded = loaded.map_err(|Report(problems)| Report(beside(path, problems)))?;
    loaded.warnings = beside(path, loaded.warnings);
    if mesh_format::is_mesh(path) {
        // A scene that is saved beside the mesh will still read it.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        files.note([path, folder_of(path)], path, &name);
    }
    loaded.files = files;
    // This is not among the checks, since an edited scene may be about to get its first object.
    if loaded.scene.objects.is_empty() {
        let mend = "add one, as in objects: [(name: \"cup\", mesh: \"cup.obj\")]";
        let problem =
            error_in(path, None, "the scene has no objects: nothing is painted but its ground", mend);
        loaded.warnings.push(Problem { severity: Severity::Warning, ..problem });
    }
    Ok(loaded)
}

/// Reads a picture as a brush, as a scene in the same folder would.
///
/// # Errors
/// Where the file cannot be used, or holds no mark.
pub fn load_brush(path: &Path) -> Result<Texture, Report> {
    source::check_regular(path).map_err(|problem| Report(vec![problem]))?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    read_brush(path, &name, &AssetFolders::default())
        .map(|(texture, _)| texture)
        .map_err(|problem| Report(vec![problem]))
}

/// Reads a mesh file with its materials and their pictures, to be added to a scene.
///
/// # Errors
/// Where the file cannot be used; all its problems, warnings included.
pub fn load_mesh(path: &Path, folders: &AssetFolders) -> Result<(MeshFile, Vec<Problem>), Report> {
    source::check_regular(path).map_err(|problem| Report(vec![problem]))?;
    let (mesh, warnings) = MeshReader::default().read(path, None, (folder_of(path), folders), false)?;
    Ok((Arc::unwrap_or_clone(mesh), warnings))
}

/// The text of a scene file, without byte order mark. It is not parsed.
///
/// # Errors
/// The file cannot be read, is too long, or is not UTF-8.
pub fn text_of(path: &Path) -> Result<String, Report> {
    let alone = |problem| Report(vec![problem]);
    let bytes = source::read(path).map_err(alone)?;
    source::decode(path, &bytes).map(str::to_owned).map_err(alone)
}

fn load_scene(path: &Path, options: &LoadOptions) -> Result<LoadedScene, Report> {
    let parsed = parse::parse(path, &text_of(path)?)?;
    finish(path, parsed, options, None)
}

/// Loads a mesh or a shot in a new scene. The scene is written as text and read again, so that `--set` works as on a
/// file that `impasto new` writes, and both are painted alike.
fn load_alone(path: &Path, options: &LoadOptions) -> Result<LoadedScene, Report> {
    source::check_regular(path).map_err(|problem| Report(vec![problem]))?;
    let mut made = Made::default();
    let root = folder_of(path);
    if crate::gltf::is_gltf(path) {
        let (file, warnings) = made.reader.open(path, root, &options.folders)?;
        made.warnings = warnings;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let (shot, _) = Shot::new(file, &name, &Choice::default());
        if shot.has_camera() {
            // Meshes that cannot be read are reported when the scene is loaded.
            let read = |node| made.reader.read(path, Some(node), (root, &options.folders), false).ok();
            let meshes: Vec<Arc<MeshFile>> =
                shot.object_names().filter_map(read).map(|(mesh, _)| mesh).collect();
            let scene = crate::new_scene::for_shot(path, &meshes, &Arc::new(shot));
            let parsed = parse::parse(path, &crate::save::to_ron(&scene))?;
            return finish(path, parsed, options, Some(made));
        }
        if shot.span_s().is_some() {
            let severity = Severity::Warning;
            let message = "the file moves and has no camera: it is painted as a model that stands still";
            let mend = "export it with its cameras";
            made.warnings.push(Problem { severity, ..error_in(path, None, message, mend) });
        }
    }
    let (mesh, warnings) = made.reader.read(path, None, (root, &options.folders), false)?;
    made.warnings.extend(warnings);
    let NewScene { scene, up_is_unsure } = crate::new_scene::for_mesh(path, &mesh, options.placing);
    if up_is_unsure {
        made.warnings.push(unsure_of_up(path, &scene));
    }
    made.mesh = Some(mesh);
    let parsed = parse::parse(path, &crate::save::to_ron(&scene))?;
    finish(path, parsed, options, Some(made))
}

/// What was read while a scene was made for a file.
#[derive(Default)]
struct Made {
    reader: MeshReader,
    /// The whole file as one mesh.
    mesh: Option<Arc<MeshFile>>,
    warnings: Vec<Problem>,
}

fn unsure_of_up(path: &Path, scene: &Scene) -> Problem {
    let up = scene.objects.first().map_or(Up::Y, |object| object.up);
    let name = Up::ALL.iter().find(|(_, known)| *known == up).map_or("y", |(name, _)| name);
    Problem {
        severity: Severity::Warning,
        path: path.to_owned(),
        place: None,
        field_path: Box::default(),
        message: format!("which way is up is not certain; {name} was taken"),
        mend: "if it lies or hangs, turn it with --up z, --up y, --up=-y or --up x".to_owned(),
    }
}

/// Applies overrides, checks the scene, and reads its files. `made` is what was read while the scene was made for a
/// mesh or a shot; `None` for a scene file.
fn finish(
    path: &Path,
    parsed: Parsed,
    options: &LoadOptions,
    made: Option<Made>,
) -> Result<LoadedScene, Report> {
    let written = made.is_none().then(|| parsed.located.clone());
    let Made { reader, mesh: known_mesh, warnings: of_made } = made.unwrap_or_default();
    let (Parsed { mut scene, .. }, applied) = overrides::apply(parsed, &options.overrides)?;
    let brought = enter_shot(&reader, path, &mut scene, &options.folders);
    let locator = FieldLocator { path, written: written.as_ref(), applied: &applied, edited: None };
    let mut problems: Vec<Problem> =
        check::check(&scene).into_iter().map(|finding| locator.problem(finding)).collect();
    let brought = match brought {
        Ok((findings, warnings)) => {
            problems.extend(findings.into_iter().map(|finding| locator.problem(finding)));
            warnings
        }
        // Without its shot the scene lacks objects, so the other findings would mislead.
        Err(Report(of_shot)) => {
            let at = |problem| locator.of_file(problem, "shot");
            return Err(Report(of_shot.into_iter().map(at).collect()));
        }
    };
    let own_name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let known_mesh = known_mesh.map(|mesh| (own_name, mesh));
    let readers = Readers {
        mesh: &|name, with_points| match &known_mesh {
            // The mesh was read without its points, so it is read again. Its warnings are known.
            Some((known, _)) if *known == name && with_points => {
                let read = read_mesh(&reader, path, name, &options.folders, true);
                read.map(|(mesh, _)| (mesh, Vec::new()))
            }
            Some((known, mesh)) if *known == name => Ok((Arc::clone(mesh), Vec::new())),
            _ => read_mesh(&reader, path, name, &options.folders, with_points),
        },
        cache: &|name| read_cache(path, name, &options.folders),
        texture: &|name| read_texture(path, name, &options.folders).map(shared),
        brush: &|name| read_brush(path, name, &options.folders).map(shared),
    };
    let files = Files::read(&scene, &readers, |problem, field_path| locator.of_file(problem, field_path));
    let in_meshes = check::check_with_meshes(&scene, &files.meshes, &files.caches);
    problems.extend(in_meshes.into_iter().map(|finding| locator.problem(finding)));
    let of_files = of_made.into_iter().chain(brought).chain(files.problems).collect();
    sort_and_cap(path, &mut problems, of_files);
    if problems.iter().any(|problem| problem.severity.is_fatal()) {
        return Err(Report(problems));
    }
    let Files { meshes, caches, textures, brushes, .. } = files;
    let files = FoundFiles::default();
    Ok(LoadedScene {
        path: path.to_owned(),
        scene,
        meshes,
        caches,
        textures,
        brushes,
        files,
        warnings: problems,
    })
}

/// Findings about the document, and warnings about the file of its shot.
type ShotRead = Result<(Vec<Finding>, Vec<Problem>), Report>;

/// Reads the shot that a document names, and puts it on the stage. Does nothing if a shot is there already.
fn enter_shot(reader: &MeshReader, scene_path: &Path, scene: &mut Scene, folders: &AssetFolders) -> ShotRead {
    let Some(name) = scene.shot.clone().filter(|_| scene.stage.shot.is_none()) else {
        return Ok((Vec::new(), Vec::new()));
    };
    let root = folder_of(scene_path);
    let max_bytes = crate::gltf::MAX_FILE_BYTES;
    let request = AssetRequest { name: &name, beside: scene_path, root, max_bytes };
    let at_shot =
        |error: assets::AssetError| Report(vec![error.to_problem(Severity::Error, scene_path, None)]);
    let path = folders.find(&request).map_err(at_shot)?;
    if !crate::gltf::is_gltf(&path) {
        let message = format!("{name:?} is no glTF file");
        return Err(Report(vec![error_in(scene_path, None, message, "name a .glb or .gltf file")]));
    }
    let (file, mut warnings) = reader.open(&path, root, folders)?;
    let (shot, odd) = Shot::new(file, &name, &Choice::of(scene));
    warnings.extend(odd.into_iter().map(|[message, mend]| {
        let severity = Severity::Warning;
        Problem { severity, ..error_in(&path, None, message, mend) }
    }));
    let rate = shot.rate_of_keys();
    let lost = Arc::new(shot).enter(scene);
    let fps = scene.timeline.fps;
    if let Some(rate) = rate.filter(|rate| (rate - fps).abs() > 1e-3) {
        let message = format!("its keys lie {rate} to a second, and the scene plays {fps} frames a second");
        let mend =
            format!("so that frames have the same numbers, write timeline: (fps: {rate}) in the scene");
        let severity = Severity::Warning;
        warnings.push(Problem { severity, ..error_in(&path, None, message, mend) });
    }
    Ok((lost.into_iter().map(lost_object).collect(), warnings))
}

/// A finding about an object that the document states and the shot does not have.
fn lost_object(Lost { index, name, near }: Lost) -> Finding {
    let stays = "what the scene states for it stays in the file";
    Finding {
        severity: Severity::Warning,
        field_path: format!("objects[{index}].name"),
        message: format!("the shot has no object {name:?}"),
        mend: near.map_or_else(|| stays.to_owned(), |near| format!("did you mean {near:?}? If not, {stays}")),
    }
}

/// What was read, behind an `Arc` as scenes hold it.
fn shared<T>((read, warnings): (T, Vec<Problem>)) -> (Arc<T>, Vec<Problem>) {
    (Arc::new(read), warnings)
}

/// Gives findings their position: in the file or, for a field that `--set` has set, on the command line.
struct FieldLocator<'a> {
    path: &'a Path,
    /// The file as it was written; `None` for a scene that was generated or edited.
    written: Option<&'a Located>,
    applied: &'a [Applied],
    /// `Some` for a document that was edited in memory. It has no text, so messages begin with their field.
    edited: Option<&'a Scene>,
}

impl FieldLocator<'_> {
    fn problem(&self, finding: Finding) -> Problem {
        let Finding { severity, field_path, message, mend } = finding;
        let problem = Problem {
            severity,
            path: PathBuf::new(),
            place: None,
            field_path: Box::default(),
            message,
            mend,
        };
        self.at_field(problem, &field_path)
    }

    fn of_file(&self, problem: Problem, field_path: &str) -> Problem {
        self.at_field(as_scene_problem(problem, self.path, None), field_path)
    }

    fn at_field(&self, problem: Problem, field_path: &str) -> Problem {
        let problem = Problem { field_path: field_path.into(), ..problem };
        if let Some(scene) = self.edited {
            let message = match field_path {
                "" => problem.message,
                _ => format!("{}: {}", edited::named_path(scene, field_path), problem.message),
            };
            return Problem { path: self.path.to_owned(), place: None, message, ..problem };
        }
        if let Some(applied) = self.applied.iter().rev().find(|applied| applied.covers(field_path)) {
            return Problem { path: applied.option.clone(), place: None, ..problem };
        }
        let place =
            self.written.filter(|_| !field_path.is_empty()).map(|located| located.place_of(field_path));
        Problem { path: self.path.to_owned(), place, ..problem }
    }
}

/// Puts the scene file's problems first, by position, then those of the files that it names: all fatal ones, then all
/// warnings, both in the order in which the scene uses the files. Of the problems of these files, keeps at most
/// [`limits::MAX_PROBLEMS`]; a last problem says how many were left out.
fn sort_and_cap(path: &Path, problems: &mut Vec<Problem>, mut of_files: Vec<Problem>) {
    let is_of_scene = |problem: &Problem| problem.path == path;
    problems.extend(of_files.extract_if(.., |problem| is_of_scene(problem)));
    problems.sort_by_key(|problem| (problem.place.is_none(), problem.place));
    // A fatal problem is never left out in favour of a warning.
    of_files.sort_by_key(|problem| !problem.severity.is_fatal());
    let left_out = of_files.len().saturating_sub(limits::MAX_PROBLEMS);
    let is_fatal = of_files.iter().skip(limits::MAX_PROBLEMS).any(|problem| problem.severity.is_fatal());
    of_files.truncate(limits::MAX_PROBLEMS);
    problems.append(&mut of_files);
    if left_out > 0 {
        let severity = if is_fatal { Severity::Error } else { Severity::Warning };
        let message = format!("{left_out} more problems of its files are not listed");
        problems.push(Problem { severity, ..error_in(path, None, message, "mend those above first") });
    }
}

fn read_mesh(
    reader: &MeshReader,
    scene: &Path,
    name: &str,
    folders: &AssetFolders,
    with_points: bool,
) -> MeshRead {
    if built_in_mesh::is_built_in(name) {
        let unknown = || {
            let message = format!("Impasto has no mesh {name:?} of its own");
            Report(vec![error_in(
                scene,
                None,
                message,
                format!("there are {:?} and {:?}", built_in_mesh::ALL[0], built_in_mesh::ALL[1]),
            )])
        };
        return built_in_mesh::of_name(name).map(|mesh| (Arc::new(mesh), Vec::new())).ok_or_else(unknown);
    }
    let root = folder_of(scene);
    let (file, node) = mesh_format::file_and_node(name);
    let max_bytes = mesh_format::max_bytes(Path::new(file));
    let request = AssetRequest { name: file, beside: scene, root, max_bytes };
    let path = folders
        .find(&request)
        .map_err(|error| Report(vec![error.to_problem(Severity::Error, scene, None)]))?;
    reader.read(&path, node, (root, folders), with_points)
}

fn read_cache(scene: &Path, name: &str, folders: &AssetFolders) -> Result<Arc<PointCache>, Problem> {
    let request = AssetRequest { name, beside: scene, root: folder_of(scene), max_bytes: u64::MAX };
    let refused = |error: assets::AssetError| error.to_problem(Severity::Error, scene, None);
    let path = folders.find(&request).map_err(refused)?;
    if !path.is_file() {
        return Err(refused(assets::AssetError::NotAFile(path)));
    }
    let faulty = |[message, mend]: [String; 2]| error_in(&path, None, message, mend);
    PointCache::open(&path).map(Arc::new).map_err(faulty)
}

type PictureRead = Result<(Texture, Vec<Problem>), Problem>;

/// Reads a texture that the scene names. One that cannot be used is an error, since the scene asks for it by name.
fn read_texture(scene: &Path, name: &str, folders: &AssetFolders) -> PictureRead {
    let max_bytes = crate::texture::MAX_FILE_BYTES;
    let request = AssetRequest { name, beside: scene, root: folder_of(scene), max_bytes };
    match crate::texture::read(folders, &request) {
        Ok(decoded) => Ok((decoded.texture, decoded.warnings)),
        Err(problem) => Err(Problem {
            severity: problem.severity.max(Severity::Error),
            mend: problem.mend.replace("it is left out; ", ""),
            ..problem
        }),
    }
}

/// Reads a picture that is a brush. One that cannot be used, or holds no mark, is an error.
fn read_brush(scene: &Path, name: &str, folders: &AssetFolders) -> PictureRead {
    let (texture, warnings) = read_texture(scene, name, folders)?;
    if impasto_core::brush::has_mark(texture.size_px, &texture.rgba8) {
        return Ok((texture, warnings));
    }
    let mend = "paint a light mark on a dark ground, or a mark with transparency round it";
    Err(Problem {
        severity: Severity::Error,
        ..error_in(scene, None, format!("{name}: the picture is of one grey; it holds no brush mark"), mend)
    })
}

/// If `path` is relative, makes the paths of problems in its folder or below relative in the same way.
fn beside(path: &Path, mut problems: Vec<Problem>) -> Vec<Problem> {
    let given = path.parent().unwrap_or(Path::new(""));
    if let Some(real) = folder_of(path).canonicalize().ok().filter(|_| path.is_relative()) {
        for problem in &mut problems {
            if let Ok(rest) = problem.path.strip_prefix(&real) {
                problem.path = given.join(rest);
            }
        }
    }
    problems
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod tests;
