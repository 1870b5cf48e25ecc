//! `impasto render`: frames of a scene as pictures.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use impasto_frame_files::frame_reader::{self, Depth, FrameFileError};
use impasto_frame_files::picture_file::{self, Pixels};
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder, scene_of, state_of};
use impasto_gl_render::shader_folder::ShaderFolder;
use impasto_gl_render::{Cost, PassTime, Picture, Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, Rotation, SeenFrom, StrokeColors};
use impasto_scene::document::{Scene, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::memory;
use impasto_scene::whole_file::WholeFile;
use impasto_sequence::movie::{Encoding, FrameFormat, Kind, Movie};
use impasto_sequence::{
    Drawn, Ending, FileOutcome, FrameError, FrameFiles, PngDepth, Sequence, Wanted, fits_in_memory,
};

use crate::args::{ColorsChoice, RenderArguments, RotationChoice};
use crate::cache::Storing;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::{FrameLines, Progress, progress_bar};
use crate::session::{self, Prepared};
use crate::sheet::Sheet;

#[derive(Clone)]
enum Destination {
    /// A file per frame.
    Files(Pattern),
    /// One animated PNG file.
    Animation(PathBuf),
    Movie(PathBuf, &'static Encoding),
    /// One picture, to standard output.
    Stream,
}

/// What the command does, after everything was checked.
struct Plan {
    sequence: Sequence,
    renderer: Renderer,
    frames: FrameList,
    destination: Destination,
    storing: Storing,
}

pub(crate) fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    let interrupt = Interrupt::watch()?;
    let frames = arguments.frames.as_deref().map(FrameList::parse).transpose().map_err(Failure::Usage)?;
    let mut plan = plan(arguments, frames)?;
    interrupt.hold_off();
    let fault = match plan.destination.clone() {
        Destination::Files(pattern) => plan.files(arguments, &pattern, &interrupt),
        Destination::Animation(path) => plan.animation(arguments, &path, &interrupt),
        Destination::Movie(path, encoding) => plan.movie(arguments, &path, encoding, &interrupt),
        Destination::Stream => plan.stream(&interrupt),
    }?;
    drop(plan.storing);
    fault.map_or(Ok(()), |fault| Err(Failure::Other(fault)))
}

/// What is wrong with frames that were drawn nevertheless, in words: for example, a point cache could not be read.
/// `None` if nothing is wrong.
type Fault = Option<String>;

fn plan(arguments: &RenderArguments, frames: Option<FrameList>) -> Result<Plan, Failure> {
    let verbose = arguments.talk.verbose > 0;
    let mut loaded = session::read_scene(&arguments.scene, arguments.talk.quiet)?;
    if arguments.turntable {
        loaded = impasto_measure::turntable(&loaded);
    }
    // If the scene has this style already, its settings of the style stay.
    if let Some(style) = arguments.style.as_deref().and_then(Style::named)
        && style.info() != loaded.scene.style.info()
    {
        loaded.scene.style = style;
    }
    let timeline = &loaded.scene.timeline;
    let frames = frames.unwrap_or_else(|| FrameList::whole(timeline.first, timeline.last));
    let inputs = loaded.inputs();
    not_an_input(Path::new(&arguments.output), &inputs)?;
    let destination = destination(arguments, &frames)?;
    let wanted = wanted(arguments, &destination, &loaded.scene)?;
    match &destination {
        Destination::Files(pattern) => {
            for frame in frames.iter() {
                for ending in ["png", "exr"] {
                    not_an_input(&pattern.path(frame).with_extension(ending), &inputs)?;
                }
            }
            if arguments.contact_sheet && arguments.skip_existing && has_ending(&arguments.output, ".exr") {
                let words = "--contact-sheet with --skip-existing needs frames in .png: let -o end in it, with --exr for EXR files beside them";
                return Err(Failure::Usage(words.to_owned()));
            }
            if arguments.contact_sheet {
                not_an_input(&sheet_path(pattern), &inputs)?;
            }
            ready_folder(&pattern.path(frames.iter().next().unwrap_or(0)))?;
        }
        Destination::Animation(path) | Destination::Movie(path, _) => {
            not_an_input(path, &inputs)?;
            ready_folder(path)?;
        }
        Destination::Stream => {}
    }
    let size_px = arguments.size.unwrap_or([loaded.scene.size.0, loaded.scene.size.1]);
    let scene_name = name_of(&loaded);
    let mut renderer = session::open_renderer(arguments.driver, verbose)?;
    fits_in_memory(&loaded.scene, wanted, size_px, &renderer)
        .map_err(|why| Failure::Refused(format!("{why}: make it smaller with --size")))?;
    let mut shaders = ShaderTexts::default();
    if let Some(folder) = &arguments.shaders {
        (_, shaders) = ShaderFolder::open(folder).map_err(Failure::Refused)?;
        renderer.replace_shaders(&shaders)?;
    }
    let options = FrameOptions {
        keep_stroke_px: arguments.keep_stroke_px,
        transparent: arguments.alpha,
        exposure_stops: arguments.picture.exposure,
        rotation: match arguments.rotation {
            RotationChoice::On => Rotation::On,
            RotationChoice::Off => Rotation::Off,
            RotationChoice::Random => Rotation::Random,
            RotationChoice::Mapped => Rotation::Mapped,
        },
        colors: match arguments.colors {
            ColorsChoice::Scene => StrokeColors::Scene,
            ColorsChoice::Trust => StrokeColors::Trust,
        },
        ..FrameOptions::new(size_px)
    };
    let state = impasto_sequence::state(&loaded, &options, &wanted, &shaders);
    if let Destination::Files(pattern) = &destination
        && arguments.skip_existing
    {
        frames.iter().try_for_each(|frame| of_this_scene(&pattern.path(frame), &scene_name, &state))?;
    }
    let seen_from = SeenFrom::for_options(&loaded.scene, &options);
    let Prepared { painting, storing } = session::prepare_scene(
        loaded,
        &arguments.scene,
        session::for_pictures(seen_from),
        arguments.talk.loudness(),
    )?;
    let sequence = Sequence {
        painting,
        options,
        scene_name,
        state,
        driver: session::driver(arguments.driver),
        shaders,
        wanted,
        timed: verbose,
        counted: verbose || arguments.json,
    };
    Ok(Plan { sequence, renderer, frames, destination, storing })
}

/// Refuses a file that was painted from another scene, or from another state of this one: `--skip-existing` must not
/// take it for a finished frame.
fn of_this_scene(path: &Path, own_scene: &str, own_state: &str) -> Result<(), Failure> {
    let other = match (scene_of(path), state_of(path)) {
        (Some(scene), _) if scene != own_scene => format!("{scene}, and this is {own_scene}"),
        (_, Some(state)) if state != own_state => {
            "another state of this scene or its files, or with other settings".to_owned()
        }
        _ => return Ok(()),
    };
    let mend = "name another -o, or leave out --skip-existing to write over it";
    Err(Failure::Refused(format!("{} was painted from {other}: {mend}", path.display())))
}

fn name_of(loaded: &LoadedScene) -> String {
    loaded.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Reads the picture of a frame whose file existed already.
fn picture_in(path: &Path) -> Result<Picture, FrameFileError> {
    let frame = frame_reader::read(&path.with_extension("png"))?.at_depth(Depth::Eight);
    Ok(Picture { size_px: frame.size_px, rgba8: frame.rgba })
}

fn sheet_path(pattern: &Pattern) -> PathBuf {
    pattern.beside("sheet").with_extension("png")
}

fn wanted(arguments: &RenderArguments, destination: &Destination, scene: &Scene) -> Result<Wanted, Failure> {
    let picture = &arguments.picture;
    let only_exr = has_ending(&arguments.output, ".exr");
    let exr = match destination {
        Destination::Files(_) if only_exr || picture.exr => {
            Some(picture.aovs_of(scene, arguments.talk.quiet)?)
        }
        _ if !picture.aovs.is_empty() || picture.exr => {
            let words =
                "--aov and --exr are for EXR files: let -o end in .exr, or add --exr to frames in .png";
            return Err(Failure::Usage(words.to_owned()));
        }
        _ => None,
    };
    let png = Some(picture.bits).filter(|_| !only_exr);
    Ok(match destination {
        Destination::Files(_) => Wanted { picture: arguments.contact_sheet, png, exr, ..Wanted::default() },
        Destination::Stream => Wanted { png, ..Wanted::default() },
        Destination::Animation(_) | Destination::Movie(..) if picture.bits == PngDepth::Sixteen => {
            let words = "--bits 16 is for PNG files of single frames: leave it out, or let -o end in .png without --apng";
            return Err(Failure::Usage(words.to_owned()));
        }
        Destination::Animation(_) | Destination::Movie(..) => Wanted::PICTURE,
    })
}

/// Whether a file name has this ending, in small letters or capitals.
pub(crate) fn has_ending(output: &str, ending: &str) -> bool {
    output.to_lowercase().ends_with(ending)
}

fn destination(arguments: &RenderArguments, frames: &FrameList) -> Result<Destination, Failure> {
    if arguments.output == "-" {
        if frames.count() != 1 || arguments.apng || arguments.contact_sheet {
            let words = "-o - writes one PNG to standard output: name one frame with --frames";
            return Err(Failure::Usage(words.to_owned()));
        }
        if arguments.json || arguments.progress == Progress::Openjd {
            let words = "-o - writes a PNG to standard output: leave --json and --progress openjd out";
            return Err(Failure::Usage(words.to_owned()));
        }
        return Ok(Destination::Stream);
    }
    if let Some(kind) = Kind::of(Path::new(&arguments.output)) {
        if arguments.apng || arguments.contact_sheet || arguments.skip_existing {
            let words = "-o MOVIE makes one movie and nothing else: leave --apng, --contact-sheet and --skip-existing out";
            return Err(Failure::Usage(words.to_owned()));
        }
        let (path, encoding) = (PathBuf::from(&arguments.output), kind.encoding(arguments.alpha)?);
        encoding.ready(&path)?;
        return Ok(Destination::Movie(path, encoding));
    }
    if !has_ending(&arguments.output, ".png") && !has_ending(&arguments.output, ".exr") {
        let words =
            format!("-o {}: let the name end in .png, in .exr, or in .mp4 for a movie", arguments.output);
        return Err(Failure::Usage(words));
    }
    if arguments.apng {
        if has_ending(&arguments.output, ".exr") {
            return Err(Failure::Usage("--apng writes a PNG file: let -o end in .png".to_owned()));
        }
        // For one frame, `parse` adds no number to the name. If the user wrote a place for one, `all` stands there.
        let pattern = Pattern::parse(&arguments.output, 1);
        return Ok(Destination::Animation(if pattern.has_place() {
            pattern.beside("all")
        } else {
            PathBuf::from(&arguments.output)
        }));
    }
    Ok(Destination::Files(Pattern::parse(&arguments.output, frames.count())))
}

impl Plan {
    fn files(
        &mut self,
        arguments: &RenderArguments,
        pattern: &Pattern,
        interrupt: &Interrupt,
    ) -> Result<Fault, Failure> {
        let Self { sequence, renderer, frames, .. } = self;
        let bar = progress_bar(frames.count(), arguments.talk.quiet);
        let mut sheet = arguments.contact_sheet.then(|| Sheet::new(frames.count(), sequence.options.size_px));
        let (mut done, mut kept, mut failed, start) = (0, 0, 0, Instant::now());
        // Files that existed already and do not say from which state they were painted.
        let mut foreign = Vec::new();
        let sheet_provenance = sequence.provenance("sheet", renderer);
        let mut lines = FrameLines::new(arguments.json, arguments.progress, frames.count());
        lines.begin(renderer)?;
        let files = FrameFiles {
            frames,
            path: &|frame_number| pattern.path(frame_number),
            keep_existing: arguments.skip_existing,
        };
        let ending =
            sequence.render_files(renderer, &files, &|| interrupt.came(), |frame_number, outcome| {
                let path = pattern.path(frame_number);
                match outcome {
                    FileOutcome::Kept => {
                        kept += 1;
                        of_this_scene(&path, &sequence.scene_name, &sequence.state)?;
                        if state_of(&path).is_none() {
                            foreign.push(path.clone());
                        }
                        if let Some(sheet) = &mut sheet {
                            match sheet.shows_next().then(|| picture_in(&path)) {
                                Some(Ok(picture)) => sheet.add(&picture),
                                Some(Err(error)) => {
                                    sheet.leave_out();
                                    if !arguments.talk.quiet {
                                        bar.suspend(|| eprintln!("warning: the sheet has a gap: {error}"));
                                    }
                                }
                                None => sheet.leave_out(),
                            }
                        }
                    }
                    // This ends the command: a folder that is full or gone would take no further frame either.
                    FileOutcome::Failed(FrameError::Write(error)) => {
                        let words = format!("frame {frame_number}: {}: {error}", path.display());
                        return Err(Failure::NotWritten { words, done });
                    }
                    FileOutcome::Failed(error) => {
                        failed += 1;
                        if let Some(sheet) = &mut sheet {
                            sheet.leave_out();
                        }
                        bar.suspend(|| eprintln!("frame {frame_number}: {}: {error}", path.display()));
                    }
                    FileOutcome::Written(drawn) => {
                        done += 1;
                        if let (Some(sheet), Some(picture)) = (&mut sheet, &drawn.picture) {
                            sheet.add(picture);
                        }
                        if let Some(cost) = &drawn.cost {
                            let costs = cost_words(&drawn, cost);
                            bar.suspend(|| {
                                eprintln!(
                                    "frame {frame_number}: {:.2} s, {}\n{costs}",
                                    drawn.seconds,
                                    path.display()
                                );
                            });
                        }
                        lines.painted(frame_number, &path, &drawn)?;
                    }
                }
                bar.inc(1);
                lines.passed(frame_number)?;
                Ok::<(), Failure>(())
            })?;
        let Ending::Done(fault) = ending else { return Err(Failure::Interrupted { done }) };
        bar.finish_and_clear();
        if let [first, more @ ..] = &foreign[..]
            && !arguments.talk.quiet
        {
            let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
            eprintln!(
                "warning: {}{more} was there and does not say from what it was painted: remove what is not yours, and render again",
                first.display()
            );
        }
        if let Some(sheet) = sheet {
            let path = sheet_path(pattern);
            let picture = sheet.picture();
            let pixels = Pixels { size_px: picture.size_px, rgba8: &picture.rgba8 };
            picture_file::write(&path, pixels, &sheet_provenance)
                .map_err(|error| Failure::of_file(&path, error))?;
        }
        if failed > 0 {
            return Err(Failure::SomeFrames { failed, done });
        }
        if !arguments.talk.quiet {
            let seconds = start.elapsed().as_secs_f64();
            let frames = if done == 1 { "frame" } else { "frames" };
            let first = pattern.path(files.frames.iter().next().unwrap_or(0));
            let folder = first.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
            let into = if files.frames.count() == 1 { first.as_path() } else { folder };
            let kept = if kept > 0 { format!(" ({kept} were there)") } else { String::new() };
            eprintln!("{done} {frames} in {seconds:.1} s, into {}{kept}", into.display());
        }
        Ok(fault)
    }

    fn animation(
        &mut self,
        arguments: &RenderArguments,
        path: &Path,
        interrupt: &Interrupt,
    ) -> Result<Fault, Failure> {
        let of_file = |error: anyhow::Error| Failure::of_file(path, error);
        let count = u32::try_from(self.frames.count()).map_err(|error| Failure::Usage(error.to_string()))?;
        let fps = self.sequence.painting.scene().timeline.fps;
        let provenance = self.sequence.provenance("all", &self.renderer);
        let mut file = WholeFile::create(path).map_err(|error| of_file(error.into()))?;
        let size_px = self.sequence.options.size_px;
        let mut writer =
            picture_file::begin_animation(&mut file, size_px, count, fps, &provenance).map_err(of_file)?;
        let fault = self.pictures(arguments, path, interrupt, |rgba8| {
            writer.write_image_data(rgba8).map_err(|error| of_file(error.into()))
        })?;
        writer.finish().map_err(|error| of_file(error.into()))?;
        file.finish().map_err(|error| of_file(error.into()))?;
        self.tell_done(arguments, path);
        Ok(fault)
    }

    fn movie(
        &mut self,
        arguments: &RenderArguments,
        path: &Path,
        encoding: &Encoding,
        interrupt: &Interrupt,
    ) -> Result<Fault, Failure> {
        let frames = FrameFormat {
            size_px: self.sequence.options.size_px,
            depth: Depth::Eight,
            fps: self.sequence.painting.scene().timeline.fps,
        };
        let mut movie = Movie::start(path, encoding, frames)?;
        let fault = self.pictures(arguments, path, interrupt, |rgba8| Ok(movie.add(rgba8)?))?;
        movie.finish()?;
        self.tell_done(arguments, path);
        Ok(fault)
    }

    fn stream(&mut self, interrupt: &Interrupt) -> Result<Fault, Failure> {
        let Self { sequence, renderer, frames, .. } = self;
        let ending = sequence.render(renderer, frames, &|| interrupt.came(), |drawn| {
            Ok::<(), Failure>(
                drawn.files.iter().try_for_each(|(_, bytes)| std::io::stdout().write_all(bytes))?,
            )
        })?;
        of_all(ending)
    }

    /// Hands the pixels of all frames of the file `path` to `take_in`, in order, until one fails or a signal comes.
    fn pictures(
        &mut self,
        arguments: &RenderArguments,
        path: &Path,
        interrupt: &Interrupt,
        mut take_in: impl FnMut(&[u8]) -> Result<(), Failure>,
    ) -> Result<Fault, Failure> {
        let Self { sequence, renderer, frames, .. } = self;
        let bar = progress_bar(frames.count(), arguments.talk.quiet);
        let mut lines = FrameLines::new(arguments.json, arguments.progress, frames.count());
        lines.begin(renderer)?;
        let mut numbers = frames.iter();
        let ending = sequence.render(renderer, frames, &|| interrupt.came(), |drawn| {
            if let Some(picture) = &drawn.picture {
                take_in(&picture.rgba8)?;
            }
            bar.inc(1);
            if let Some(frame_number) = numbers.next() {
                lines.painted(frame_number, path, &drawn)?;
                lines.passed(frame_number)?;
            }
            Ok::<(), Failure>(())
        });
        bar.finish_and_clear();
        of_all(ending?)
    }

    fn tell_done(&self, arguments: &RenderArguments, path: &Path) {
        if !arguments.talk.quiet {
            let count = self.frames.count();
            eprintln!("{count} {} in {}", if count == 1 { "frame" } else { "frames" }, path.display());
        }
    }
}

/// The fault of a rendering into one file or to standard output. A rendering that was stopped is an error, because it
/// has left nothing of use.
fn of_all(ending: Ending) -> Result<Fault, Failure> {
    match ending {
        Ending::Done(fault) => Ok(fault),
        Ending::Stopped => Err(Failure::Interrupted { done: 0 }),
    }
}

fn cost_words(drawn: &Drawn, cost: &Cost) -> String {
    let memory = memory::peak_bytes()
        .map_or_else(String::new, |bytes| format!(", {} MiB at most so far", bytes >> 20));
    let (painted, strokes) = (drawn.painted_strokes.unwrap_or_default(), drawn.strokes);
    let mut text =
        format!("  {painted} strokes of {strokes} in question, overdraw {:.1}{memory}", cost.overdraw);
    let mut passes: Vec<PassTime> = Vec::new();
    for pass in &cost.passes {
        match passes.iter_mut().find(|known| known.name == pass.name) {
            Some(known) => known.seconds += pass.seconds,
            None => passes.push(*pass),
        }
    }
    for pass in passes {
        // Writing to a String cannot fail.
        let _ = write!(text, "\n  {:<14}{:>8.1} ms", pass.name, pass.seconds * 1e3);
    }
    text
}
