//! `impasto render`: frames of a scene as pictures.

use std::collections::HashSet;
use std::io::{IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use impasto_frame_files::picture_file;
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder};
use impasto_gl_render::shader_folder::ShaderFolder;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, Rotation, StrokeColors};
use impasto_scene::document::Style;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::{ColorsChoice, RenderArguments, RotationChoice};
use crate::failure::Failure;
use crate::in_order::{Workers, in_order};
use crate::movie::{self, Movie};
use crate::painter::{Drawn, Painter, Shot, Wanted, pixels};
use crate::session;
use crate::sheet::Sheet;

/// Where the pictures go.
enum Destination {
    /// A file per frame.
    Files(Pattern),
    /// One animated file.
    Animation(PathBuf),
    /// One movie.
    Movie(PathBuf),
    /// One picture, to standard output.
    Stream,
}

/// What the command does, after everything was checked.
struct Plan {
    shot: Shot,
    renderer: Renderer,
    frames: FrameList,
    destination: Destination,
    interrupted: Arc<AtomicBool>,
}

pub(crate) fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    let frames = arguments.frames.as_deref().map(FrameList::parse).transpose().map_err(Failure::Usage)?;
    let mut plan = plan(arguments, frames)?;
    match &plan.destination {
        Destination::Files(pattern) => {
            let pattern = pattern.clone();
            plan.files(arguments, &pattern)
        }
        Destination::Animation(path) => {
            let path = path.clone();
            plan.animation(arguments, &path)
        }
        Destination::Movie(path) => {
            let path = path.clone();
            plan.movie(arguments, &path)
        }
        Destination::Stream => plan.stream(),
    }
}

fn plan(arguments: &RenderArguments, frames: Option<FrameList>) -> Result<Plan, Failure> {
    let quiet = arguments.talk.quiet;
    let verbose = arguments.talk.verbose > 0;
    let mut loaded = session::read_scene(&arguments.scene, quiet)?;
    if arguments.turntable {
        loaded = impasto_measure::turntable(&loaded);
    }
    // A scene that is in this style already keeps its settings.
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
    match &destination {
        Destination::Files(pattern) => {
            for frame in frames.iter() {
                not_an_input(&pattern.path(frame), &inputs)?;
            }
            ready_folder(&pattern.path(0))?;
        }
        Destination::Animation(path) | Destination::Movie(path) => {
            not_an_input(path, &inputs)?;
            ready_folder(path)?;
        }
        Destination::Stream => {}
    }
    let size_px = arguments.size.unwrap_or([loaded.scene.size.0, loaded.scene.size.1]);
    let scene_name =
        loaded.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut renderer = session::open_renderer(arguments.driver, verbose)?;
    let mut shaders = None;
    if let Some(folder) = &arguments.shaders {
        let (_, texts) = ShaderFolder::open(folder).map_err(Failure::Refused)?;
        renderer.replace_shaders(&texts)?;
        shaders = Some(texts);
    }
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // A second signal while the frame is finishing changes nothing.
    ctrlc::set_handler(move || flag.store(true, Ordering::SeqCst))
        .map_err(|error| Failure::Other(error.to_string()))?;
    let options = FrameOptions {
        size_px,
        shot_height_px: None,
        keep_stroke_px: arguments.keep_stroke_px,
        transparent: arguments.alpha,
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
    let shot = Shot {
        painting: session::prepare_scene(loaded, &arguments.scene, verbose)?,
        options,
        scene_name,
        driver: arguments.driver,
        shaders,
        verbose,
        counted: verbose || arguments.json,
    };
    Ok(Plan { shot, renderer, frames, destination, interrupted })
}

fn destination(arguments: &RenderArguments, frames: &FrameList) -> Result<Destination, Failure> {
    if arguments.output == "-" {
        if frames.count() != 1 || arguments.apng || arguments.contact_sheet {
            let words = "-o - writes one PNG to standard output: name one frame with --frames";
            return Err(Failure::Usage(words.to_owned()));
        }
        return Ok(Destination::Stream);
    }
    if movie::is_movie(&arguments.output) {
        if arguments.apng || arguments.contact_sheet || arguments.skip_existing {
            let words = "-o MOVIE makes one movie and nothing else: leave --apng, --contact-sheet and --skip-existing out";
            return Err(Failure::Usage(words.to_owned()));
        }
        return Ok(Destination::Movie(PathBuf::from(&arguments.output)));
    }
    if !arguments.output.to_lowercase().ends_with(".png") {
        let words = format!("-o {}: let the name end in .png, or in .mp4 for a movie", arguments.output);
        return Err(Failure::Usage(words));
    }
    if arguments.apng {
        let has_place = arguments.output.contains('#')
            || arguments.output.contains('%')
            || arguments.output.contains("$F");
        let pattern = Pattern::parse(&arguments.output, frames.count());
        return Ok(Destination::Animation(if has_place {
            pattern.beside("all")
        } else {
            PathBuf::from(&arguments.output)
        }));
    }
    Ok(Destination::Files(Pattern::parse(&arguments.output, frames.count())))
}

impl Plan {
    fn files(&mut self, arguments: &RenderArguments, pattern: &Pattern) -> Result<(), Failure> {
        let verbose = self.shot.verbose;
        let bar = progress_bar(self.frames.count(), arguments);
        let count = self.frames.count();
        let mut sheet = arguments.contact_sheet.then(|| Sheet::new(count, self.shot.options.size_px));
        let (mut done, mut failed, start) = (0, 0, Instant::now());
        let driver = self.renderer.report().renderer.clone();
        if arguments.json {
            let driver = self.renderer.report().to_string();
            let line = serde_json::json!({ "version": 1, "event": "context", "driver": driver });
            writeln!(std::io::stdout(), "{line}")?;
        }
        // A frame that is named twice is there when it is named again.
        let mut begun = HashSet::new();
        let wants = |frame_number: i64| {
            let skips = arguments.skip_existing
                && (pattern.path(frame_number).exists() || !begun.insert(frame_number));
            if skips {
                bar.inc(1);
            }
            !skips
        };
        let wanted = if sheet.is_some() { Wanted::FileAndPicture } else { Wanted::File };
        let all = self.each(wanted, wants, |frame_number, drawn| {
            let path = pattern.path(frame_number);
            let written = drawn.and_then(|drawn| {
                picture_file::whole(&path, |file| Ok(file.write_all(&drawn.png)?))
                    .map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
                Ok(drawn)
            });
            match written {
                Ok(Drawn { picture, strokes, told, seconds, .. }) => {
                    done += 1;
                    if let (Some(sheet), Some(picture)) = (&mut sheet, &picture) {
                        sheet.add(picture);
                    }
                    if verbose {
                        bar.suspend(|| {
                            eprintln!("frame {frame_number}: {seconds:.2} s, {}\n{told}", path.display());
                        });
                    }
                    if arguments.json {
                        let line = serde_json::json!({
                            "version": 1, "event": "frame", "frame": frame_number, "path": path, "strokes": strokes, "seconds": seconds,
                        });
                        writeln!(std::io::stdout(), "{line}")?;
                    }
                }
                Err(failure) => {
                    failed += 1;
                    bar.suspend(|| {
                        eprintln!("frame {frame_number}: {}", failure.words().unwrap_or_default())
                    });
                }
            }
            bar.inc(1);
            Ok(())
        })?;
        if !all {
            return Err(Failure::Interrupted { done });
        }
        bar.finish_and_clear();
        if let Some(sheet) = sheet {
            let path = pattern.beside("sheet");
            picture_file::write(&path, pixels(&sheet.picture()), &self.shot.provenance("sheet", &driver))
                .map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
        }
        if failed > 0 {
            return Err(Failure::SomeFrames { failed, done });
        }
        if !arguments.talk.quiet {
            let seconds = start.elapsed().as_secs_f64();
            eprintln!(
                "{done} frames in {seconds:.1} s, {}",
                pattern.path(0).parent().unwrap_or(&PathBuf::new()).display()
            );
        }
        Ok(())
    }

    fn animation(&mut self, arguments: &RenderArguments, path: &Path) -> Result<(), Failure> {
        let bar = progress_bar(self.frames.count(), arguments);
        let count = u32::try_from(self.frames.count()).map_err(|error| Failure::Usage(error.to_string()))?;
        let fps = self.shot.painting.scene().timeline.fps;
        let provenance = self.shot.provenance("all", &self.renderer.report().renderer);
        let size_px = self.shot.options.size_px;
        let (mut stopped, mut done) = (None, 0);
        let written = picture_file::whole(path, |file| {
            let mut encoder = picture_file::encoder(file, size_px, &provenance)?;
            encoder.set_compression(png::Compression::Fast);
            encoder.set_animated(count, 0)?;
            // Milliseconds resolve every common rate.
            encoder.set_frame_delay((1000.0 / fps).round().clamp(1.0, 65535.0) as u16, 1000)?;
            let mut writer = encoder.write_header()?;
            let drawn = self.pictures(|picture| {
                writer.write_image_data(&picture.rgba8).map_err(|error| Failure::Other(error.to_string()))?;
                done += 1;
                bar.inc(1);
                Ok(())
            });
            if let Err(failure) = drawn {
                stopped = Some(failure);
                anyhow::bail!("a frame failed");
            }
            writer.finish()?;
            Ok(())
        });
        bar.finish_and_clear();
        if let Some(failure) = stopped {
            return Err(failure);
        }
        written.map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
        if !arguments.talk.quiet {
            eprintln!("{done} frames in {}", path.display());
        }
        Ok(())
    }

    fn movie(&mut self, arguments: &RenderArguments, path: &Path) -> Result<(), Failure> {
        let bar = progress_bar(self.frames.count(), arguments);
        let fps = self.shot.painting.scene().timeline.fps;
        let mut movie = Movie::start(path, self.shot.options.size_px, fps)?;
        self.pictures(|picture| {
            movie.add(picture)?;
            bar.inc(1);
            Ok(())
        })?;
        movie.finish()?;
        bar.finish_and_clear();
        if !arguments.talk.quiet {
            eprintln!("{} frames in {}", self.frames.count(), path.display());
        }
        Ok(())
    }

    fn stream(&mut self) -> Result<(), Failure> {
        let frame_number = self.frames.iter().next().unwrap_or(0);
        let drawn = Painter::new(&self.shot, &mut self.renderer).draw(frame_number, Wanted::File)?;
        std::io::stdout().write_all(&drawn.png)?;
        Ok(())
    }

    /// All pictures, in their order; the first failure ends it, and so does a signal.
    fn pictures(&mut self, mut take_in: impl FnMut(&Picture) -> Result<(), Failure>) -> Result<(), Failure> {
        let all = self.each(
            Wanted::Picture,
            |_| true,
            |_, drawn| drawn?.picture.as_ref().map_or(Ok(()), &mut take_in),
        )?;
        if all { Ok(()) } else { Err(Failure::Interrupted { done: 0 }) }
    }

    /// Draws the frames that `wants` names, on as many threads as is worth it, and hands each over in its turn. After a signal no
    /// more are begun; whether none came.
    fn each(
        &mut self,
        wanted: Wanted,
        mut wants: impl FnMut(i64) -> bool + Send,
        take_in: impl FnMut(i64, Result<Drawn, Failure>) -> Result<(), Failure>,
    ) -> Result<bool, Failure> {
        let Self { shot, renderer, frames, interrupted, .. } = self;
        let driver = renderer.report().renderer.clone();
        let mut painter = Painter::new(shot, renderer);
        let mut all = true;
        let jobs = frames
            .iter()
            .take_while(|_| {
                all = !interrupted.load(Ordering::SeqCst);
                all
            })
            .filter(|&frame_number| wants(frame_number));
        let workers = Workers {
            own: Box::new(move |frame_number| painter.draw(frame_number, wanted)),
            helpers: shot.helpers(frames.count()),
            open: &|| shot.helper(&driver, wanted),
        };
        in_order(jobs, workers, take_in)?;
        Ok(all)
    }
}

fn progress_bar(count: u64, arguments: &RenderArguments) -> ProgressBar {
    let shown = std::io::stderr().is_terminal() && !arguments.talk.quiet;
    let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(count), target);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    bar
}
