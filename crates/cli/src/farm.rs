//! `impasto farm` writes a job for a render farm. `impasto pack` gathers all files of a scene, or checks a packed
//! folder for changes.

use std::ffi::OsString;
use std::io::Write as _;
use std::path::Path;

use clap::Parser as _;
use impasto_farm::job::{Frames, Job};
use impasto_farm::pack::{self, PackList};
use impasto_farm::{openjd, slurm};
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder};
use impasto_scene::assets::AssetFolders;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::whole_file::WholeFile;
use impasto_sequence::movie::Kind;

use crate::args::{Arguments, Command};
use crate::failure::Failure;
use crate::farm_args::{FarmArguments, FarmCommand, PackArguments, SlurmArguments};
use crate::render::has_ending;

/// Flags of `impasto render` that the job sets itself.
const OWN_FLAGS: [&str; 6] = ["-o", "--output", "-f", "--frames", "--skip-existing", "--progress"];

pub(crate) fn farm(command: &FarmCommand) -> Result<(), Failure> {
    let (arguments, text) = match command {
        FarmCommand::Openjd(arguments) => {
            let mut job = job(arguments, &["--progress", "openjd"])?;
            // The template names files relative to its own folder, and only files inside that folder.
            let folder = arguments.job.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
            for path in [&mut job.scene, &mut job.output].into_iter().chain(&mut job.movie) {
                let inside = from_folder(path, folder);
                let is_outside = *path == inside && !folder.as_os_str().is_empty();
                if is_outside
                    || Path::new(&inside).is_absolute()
                    || inside.split('/').any(|part| part == "..")
                {
                    return Err(Failure::Usage(format!(
                        "{path}: an Open Job Description names files in its own folder only: put the scene (impasto pack) and the frames there, and the job with --job"
                    )));
                }
                *path = inside;
            }
            (arguments, openjd::template(&job).map_err(Failure::Usage)?)
        }
        FarmCommand::Slurm(SlurmArguments { farm, chunk }) => {
            let frames_a_task = chunk.map(|frames| frames as usize);
            (farm, slurm::script(&job(farm, &[])?, frames_a_task).map_err(Failure::Usage)?)
        }
    };
    let Some(path) = &arguments.job else {
        return Ok(std::io::stdout().write_all(text.as_bytes())?);
    };
    not_an_input(path, std::slice::from_ref(&arguments.scene))?;
    let written = WholeFile::create(path).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.finish()
    });
    written.map_err(|error| {
        let words = format!(
            "the job cannot be written into {}: {error}; name another place with --job",
            path.display()
        );
        Failure::Refused(words)
    })?;
    eprintln!("the job is in {}", path.display());
    Ok(())
}

/// The path relative to `folder` if it lies in there, else the path unchanged.
fn from_folder(path: &str, folder: &Path) -> String {
    Path::new(path)
        .strip_prefix(folder)
        .map_or_else(|_| path.to_owned(), |path| path.to_string_lossy().into_owned())
}

fn read(scene: &Path, asset_dirs: &[std::path::PathBuf], quiet: bool) -> Result<LoadedScene, Failure> {
    let folders = AssetFolders::with(asset_dirs.to_vec());
    let loaded = load(scene, &LoadOptions { folders, ..LoadOptions::default() })?;
    if !quiet {
        loaded.warnings.iter().for_each(|warning| eprintln!("{warning}"));
    }
    Ok(loaded)
}

/// Makes the job. The scene is read too, so that its errors are found here and not on a hundred machines. `own` are
/// words that the job adds to the command line.
fn job(arguments: &FarmArguments, own: &[&str]) -> Result<Job, Failure> {
    let list = arguments.frames.as_deref().map(FrameList::parse).transpose().map_err(Failure::Usage)?;
    let is_own = |word: &String| {
        let is_attached = word.starts_with("-f") || word.starts_with("-o");
        is_attached || OWN_FLAGS.iter().any(|own| word == own || word.starts_with(&format!("{own}=")))
    };
    if let Some(word) = arguments.more.iter().find(|word| is_own(word)) {
        let words =
            format!("{word} after --: the job says it itself; leave it out, or give -o and -f before --");
        return Err(Failure::Usage(words));
    }
    let loaded = read(&arguments.scene, &arguments.asset_dirs, false)?;
    let timeline = &loaded.scene.timeline;
    let list = list.unwrap_or_else(|| FrameList::whole(timeline.first, timeline.last));
    tell_frames_beyond(&list, timeline.first, timeline.last);
    let is_of_frames =
        [".png", ".exr"].iter().any(|ending| arguments.output.to_lowercase().ends_with(ending));
    if !is_of_frames {
        let words = format!("-o {}: farms paint frames: let the name end in .png or .exr", arguments.output);
        return Err(Failure::Usage(words));
    }
    if let Some(movie) = &arguments.movie {
        if Kind::of(Path::new(movie)).is_none() {
            let words = format!("--movie {movie}: let the name end in .mp4, .mkv, .mov or .webm");
            return Err(Failure::Usage(words));
        }
        if arguments.output.to_lowercase().ends_with(".exr") {
            let words = "--movie is made of PNG frames: let -o end in .png, and add -- --exr for EXR files beside them";
            return Err(Failure::Usage(words.to_owned()));
        }
    }
    // With a count of at least two, the file's name gets a number even if the job is a single frame. Usually other
    // frames of the shot are rendered, too.
    let pattern = Pattern::parse(&arguments.output, list.count().max(2));
    let text = |path: &Path| {
        let words = || Failure::Usage(format!("{}: the name is not UTF-8", path.display()));
        path.to_str().map(str::to_owned).ok_or_else(words)
    };
    check_further(arguments, own)?;
    let mut further = Vec::new();
    for folder in &arguments.asset_dirs {
        further.extend(["--asset-dir".to_owned(), text(folder)?]);
    }
    let name = arguments.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Job {
        name,
        scene: text(&arguments.scene)?,
        frames: Frames::of(&list),
        output: pattern.text(),
        arguments: further.into_iter().chain(arguments.more.iter().cloned()).collect(),
        movie: arguments.movie.clone(),
        fps: timeline.fps,
    })
}

/// Warns of frames outside the scene's range. They show its first or last frame, so a mistyped list could waste a night
/// of rendering.
fn tell_frames_beyond(list: &FrameList, first: i64, last: i64) {
    let beyond = || list.iter().filter(|frame| !(first..=last).contains(frame));
    if let (Some(low), Some(high)) = (beyond().min(), beyond().max()) {
        let count = beyond().count();
        eprintln!(
            "warning: the scene has the frames {first} to {last}; {count} of the list lie outside (from {low} to {high}), and show what its first or last frame shows"
        );
    }
}

/// Refuses arguments after `--` that `impasto render` would refuse, so that they fail here and not on a hundred
/// machines.
fn check_further(arguments: &FarmArguments, own: &[&str]) -> Result<(), Failure> {
    let always = ["impasto", "render", "-o", &arguments.output, "-f", "0", "--skip-existing"];
    let more = arguments.more.iter().map(OsString::from);
    let words = always.iter().chain(own).map(OsString::from).chain(more);
    let words = words.chain(["--".into(), arguments.scene.clone().into_os_string()]);
    let parsed = Arguments::try_parse_from(words).map_err(|error| {
        let told = error.to_string();
        let first = told.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        Failure::Usage(format!("behind --: {first}; see impasto render --help"))
    })?;
    let Command::Render(render) = parsed.command else { return Ok(()) };
    let is_exr = render.picture.exr || arguments.output.to_lowercase().ends_with(".exr");
    if render.contact_sheet && has_ending(&arguments.output, ".exr") {
        let words = "behind --: --contact-sheet needs frames in .png: let -o end in it, and add --exr for EXR files beside them";
        return Err(Failure::Usage(words.to_owned()));
    }
    if !render.picture.aovs.is_empty() && !is_exr {
        let words = "behind --: --aov is for EXR files: let -o end in .exr, or add --exr for EXR files beside the frames";
        return Err(Failure::Usage(words.to_owned()));
    }
    Ok(())
}

pub(crate) fn pack(arguments: &PackArguments) -> Result<(), Failure> {
    let PackArguments { scene, asset_dirs, output, quiet, .. } = arguments;
    let refused = |error: pack::PackError| Failure::Refused(error.to_string());
    let (list, place) = match output {
        Some(output) => {
            let loaded = read(scene, asset_dirs, *quiet)?;
            not_an_input(output, &loaded.inputs())?;
            // A folder that exists is left for `pack::pack` to refuse: its message asks for a new folder.
            if !output.is_dir() {
                ready_folder(output)?;
            }
            (pack::pack(&loaded, output).map_err(refused)?, output)
        }
        None => (pack::check(scene).map_err(refused)?, scene),
    };
    let is_good = if output.is_none() { "every file as it was packed: " } else { "" };
    if !quiet {
        let PackList { files, scene, impasto } = list;
        let bytes: u64 = files.iter().map(|file| file.bytes).sum();
        let mib = bytes as f64 / f64::from(1 << 20);
        let count = if files.len() == 1 { "1 file".to_owned() } else { format!("{} files", files.len()) };
        eprintln!(
            "{}: {is_good}{scene}, {count}, {mib:.1} MiB, packed by impasto {impasto}",
            place.display()
        );
    }
    Ok(())
}
