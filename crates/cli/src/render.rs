//! `impasto render`: frames of a scene as pictures.

use std::fmt::Write as _;
use std::io::{IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use impasto_editor::files::shader_folder::ShaderFolder;
use impasto_frame_files::picture_file::{self, Provenance};
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder};
use impasto_gl_render::{Cost, PassTime, Picture, Renderer};
use impasto_painting::{Frame, FrameOptions, Painting, Rotation, StrokeColors};
use impasto_scene::document::{Style, SumiE};
use impasto_scene::memory;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::{ColorsChoice, RenderArguments, RotationChoice, StyleChoice};
use crate::failure::Failure;
use crate::movie::{self, Movie};
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
    painting: Painting,
    renderer: Renderer,
    frames: FrameList,
    options: FrameOptions,
    destination: Destination,
    scene_name: String,
    interrupted: Arc<AtomicBool>,
    verbose: bool,
    /// Of the last frame, where `verbose`.
    cost: Cost,
}

/// Strokes that are less than this there are not painted.
const LEAST_ALPHA: f32 = 0.004;

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
    match arguments.style {
        Some(StyleChoice::Reference) => loaded.scene.style = Style::Reference,
        Some(StyleChoice::RotatingStrokes) if !matches!(loaded.scene.style, Style::RotatingStrokes(_)) => {
            loaded.scene.style = Style::default();
        }
        Some(StyleChoice::SumiE) if !matches!(loaded.scene.style, Style::SumiE(_)) => {
            loaded.scene.style = Style::SumiE(SumiE::default());
        }
        Some(StyleChoice::RotatingStrokes | StyleChoice::SumiE) | None => {}
    }
    let timeline = &loaded.scene.timeline;
    let frames = frames.unwrap_or_else(|| FrameList::whole(timeline.first, timeline.last));
    let inputs = loaded.inputs();
    not_an_input(std::path::Path::new(&arguments.output), &inputs)?;
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
    if let Some(folder) = &arguments.shaders {
        let (_, texts) = ShaderFolder::open(folder).map_err(Failure::Refused)?;
        renderer.replace_shaders(&texts)?;
    }
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // A second signal while the frame is finishing changes nothing.
    ctrlc::set_handler(move || flag.store(true, Ordering::SeqCst))
        .map_err(|error| Failure::Other(error.to_string()))?;
    Ok(Plan {
        painting: session::prepare_scene(loaded, &arguments.scene, verbose)?,
        renderer,
        frames,
        options: FrameOptions {
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
        },
        destination,
        scene_name,
        interrupted,
        verbose,
        cost: Cost::default(),
    })
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
        let verbose = arguments.talk.verbose > 0;
        let bar = progress_bar(self.frames.count(), arguments);
        let mut sheet =
            arguments.contact_sheet.then(|| Sheet::new(self.frames.count(), self.options.size_px));
        let (mut done, mut failed, start) = (0, 0, Instant::now());
        if arguments.json {
            let driver = self.renderer.report().to_string();
            let line = serde_json::json!({ "version": 1, "event": "context", "driver": driver });
            writeln!(std::io::stdout(), "{line}")?;
        }
        for frame_number in self.frames.clone().iter() {
            if self.interrupted.load(Ordering::SeqCst) {
                return Err(Failure::Interrupted { done });
            }
            let path = pattern.path(frame_number);
            if arguments.skip_existing && path.exists() {
                bar.inc(1);
                continue;
            }
            let begun = Instant::now();
            let drawn = self.draw(frame_number).and_then(|(frame, picture)| {
                picture_file::write(&path, pixels(&picture), &self.provenance(frame_number))
                    .map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
                Ok((frame, picture))
            });
            match drawn {
                Ok((frame, picture)) => {
                    done += 1;
                    if let Some(sheet) = &mut sheet {
                        sheet.add(&picture);
                    }
                    let seconds = begun.elapsed().as_secs_f64();
                    if verbose {
                        let told = self.told(&frame);
                        bar.suspend(|| {
                            eprintln!("frame {frame_number}: {seconds:.2} s, {}\n{told}", path.display());
                        });
                    }
                    if arguments.json {
                        let line = serde_json::json!({
                            "version": 1, "event": "frame", "frame": frame_number, "path": path, "strokes": self.drawn(), "seconds": seconds,
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
        }
        bar.finish_and_clear();
        if let Some(sheet) = sheet {
            let path = pattern.beside("sheet");
            picture_file::write(&path, pixels(&sheet.picture()), &self.provenance_of("sheet"))
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

    fn animation(&mut self, arguments: &RenderArguments, path: &std::path::Path) -> Result<(), Failure> {
        let bar = progress_bar(self.frames.count(), arguments);
        let count = u32::try_from(self.frames.count()).map_err(|error| Failure::Usage(error.to_string()))?;
        let fps = self.painting.scene().timeline.fps;
        let provenance = self.provenance_of("all");
        let size_px = self.options.size_px;
        let (mut stopped, mut done) = (None, 0);
        let written = picture_file::whole(path, |file| {
            let mut encoder = picture_file::encoder(file, size_px, &provenance)?;
            encoder.set_compression(png::Compression::Fast);
            encoder.set_animated(count, 0)?;
            // Milliseconds resolve every common rate.
            encoder.set_frame_delay((1000.0 / fps).round().clamp(1.0, 65535.0) as u16, 1000)?;
            let mut writer = encoder.write_header()?;
            for frame_number in self.frames.clone().iter() {
                if self.interrupted.load(Ordering::SeqCst) {
                    stopped = Some(Failure::Interrupted { done: 0 });
                    anyhow::bail!("interrupted");
                }
                match self.draw(frame_number) {
                    Ok((_, picture)) => writer.write_image_data(&picture.rgba8)?,
                    Err(failure) => {
                        stopped = Some(failure);
                        anyhow::bail!("a frame failed");
                    }
                }
                done += 1;
                bar.inc(1);
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

    fn movie(&mut self, arguments: &RenderArguments, path: &std::path::Path) -> Result<(), Failure> {
        let bar = progress_bar(self.frames.count(), arguments);
        let fps = self.painting.scene().timeline.fps;
        let mut movie = Movie::start(path, self.options.size_px, fps)?;
        for frame_number in self.frames.clone().iter() {
            if self.interrupted.load(Ordering::SeqCst) {
                return Err(Failure::Interrupted { done: 0 });
            }
            let (_, picture) = self.draw(frame_number)?;
            movie.add(&picture)?;
            bar.inc(1);
        }
        movie.finish()?;
        bar.finish_and_clear();
        if !arguments.talk.quiet {
            eprintln!("{} frames in {}", self.frames.count(), path.display());
        }
        Ok(())
    }

    fn stream(&mut self) -> Result<(), Failure> {
        let frame_number = self.frames.iter().next().unwrap_or(0);
        let (_, picture) = self.draw(frame_number)?;
        let mut bytes = Vec::new();
        picture_file::encode(&mut bytes, pixels(&picture), &self.provenance(frame_number))
            .map_err(|error| Failure::Other(error.to_string()))?;
        std::io::stdout().write_all(&bytes)?;
        Ok(())
    }

    fn draw(&mut self, frame_number: i64) -> Result<(Frame, Picture), Failure> {
        let begun = Instant::now();
        let frame = self.painting.at(frame_number as f64, &self.options);
        let picture = if self.verbose {
            let solved = begun.elapsed().as_secs_f64();
            let (picture, mut cost) = self.renderer.render_timed(&frame)?;
            cost.passes.insert(0, PassTime { name: "solve", seconds: solved });
            self.cost = cost;
            picture
        } else {
            self.renderer.render(&frame)?
        };
        Ok((frame, picture))
    }

    /// How many strokes of the last frame were painted.
    fn drawn(&self) -> usize {
        self.renderer.resolved_strokes().iter().filter(|stroke| stroke.alpha > LEAST_ALPHA).count()
    }

    /// What the last frame was made of: strokes, overdraw, memory, seconds of each pass.
    fn told(&self, frame: &Frame) -> String {
        let strokes = self.drawn();
        let overdraw = self.cost.overdraw;
        let memory = memory::peak_bytes()
            .map_or_else(String::new, |bytes| format!(", {} MiB at most so far", bytes >> 20));
        let mut text = format!(
            "  {strokes} strokes of {} in question, overdraw {overdraw:.1}{memory}",
            frame.strokes.len()
        );
        let mut passes: Vec<PassTime> = Vec::new();
        for pass in &self.cost.passes {
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

    fn provenance(&self, frame_number: i64) -> Provenance {
        self.provenance_of(&frame_number.to_string())
    }

    fn provenance_of(&self, frame: &str) -> Provenance {
        Provenance {
            scene: self.scene_name.clone(),
            frame: frame.to_owned(),
            driver: self.renderer.report().renderer.clone(),
        }
    }
}

fn pixels(picture: &Picture) -> picture_file::Pixels<'_> {
    (picture.size_px, &picture.rgba8)
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
