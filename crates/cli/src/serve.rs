//! `impasto serve`: renders what another program asks for. Lines of JSON come in on standard input and go out on
//! standard output. The scene is prepared once, and again when its files have changed or a picture needs other
//! particles. `docs/serve.md` lists the lines.

mod orders;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use impasto_frame_files::exr_file::Packing;
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder};
use impasto_gl_render::{Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, Preparer, SeenFrom};
use impasto_scene::aovs::AovSet;
use impasto_scene::problem::Report;
use impasto_sequence::{Ending, FileOutcome, FrameFiles, Sequence, Wanted, fits_in_memory};
use serde_json::{Value, json};

use crate::args::ServeArguments;
use crate::failure::Failure;
use crate::render::has_ending;
use crate::session::{self, Prepared};
use orders::{Current, Order, Orders, RenderOrder};

/// The version of the format of the lines.
pub(crate) const VERSION: u32 = 1;

pub(crate) fn run(arguments: &ServeArguments) -> Result<(), Failure> {
    let orders = Orders::from_stdin();
    let mut server = Server { arguments, preparer: Preparer::default(), ready: None, renderer: None };
    tell(&json!({ "version": VERSION, "event": "started", "impasto": env!("CARGO_PKG_VERSION") }))?;
    while let Some((order, current)) = orders.next() {
        match order {
            Order::Prepare { id } => match server.ready() {
                Ok(()) => tell(&server.words_of_ready(id))?,
                Err(failure) => tell(&of_failure(id, &failure))?,
            },
            Order::Render(order) => {
                let event = match server.render(&order, &current) {
                    Ok(Ending::Done(fault)) => json!({ "event": "done", "id": order.id, "warning": fault }),
                    Ok(Ending::Stopped) => json!({ "event": "stopped", "id": order.id }),
                    Err(failure) => of_failure(order.id, &failure),
                };
                tell(&event)?;
            }
            Order::Unread(words) => tell(&json!({ "event": "error", "message": words }))?,
        }
    }
    Ok(())
}

fn tell(line: &Value) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")?;
    Ok(out.flush()?)
}

fn of_failure(id: u64, failure: &Failure) -> Value {
    let words = match failure {
        // Only what has to be mended, without the warnings.
        Failure::Input(Report(problems)) => {
            let fatal = problems.iter().filter(|problem| problem.severity.is_fatal());
            fatal.map(ToString::to_string).collect::<Vec<_>>().join("\n")
        }
        failure => failure.words().unwrap_or_default(),
    };
    json!({ "event": "error", "id": id, "message": words })
}

/// What tells whether a file is still the same: its length, and when it was written. `None` if it is not there.
type Stamp = Option<(u64, SystemTime)>;

struct Ready {
    /// The views that the scene was prepared for.
    seen_from: SeenFrom<'static>,
    prepared: Prepared,
    warnings: Vec<String>,
    inputs: Vec<PathBuf>,
    /// The stamp of each input as it was read.
    stamps: Vec<Stamp>,
}

impl Ready {
    fn is_current(&self) -> bool {
        self.inputs.iter().zip(&self.stamps).all(|(path, stamp)| stamp_of(path) == *stamp)
    }
}

fn stamp_of(path: &Path) -> Stamp {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

struct Server<'a> {
    arguments: &'a ServeArguments,
    preparer: Preparer,
    ready: Option<Ready>,
    renderer: Option<Renderer>,
}

impl Server<'_> {
    /// Prepares the scene, unless that is done and its files are as they were.
    fn ready(&mut self) -> Result<(), Failure> {
        if self.ready.as_ref().is_some_and(Ready::is_current) {
            return Ok(());
        }
        self.ready = None;
        let of_scene = &self.arguments.scene;
        let begun = stamp_of(&of_scene.scene);
        let loaded = session::read_scene(of_scene, true)?;
        let inputs = loaded.inputs();
        // The stamp of the scene file is from before it was read, so that a change during reading is noticed the next
        // time. The other files are known only now, after reading, so a change of one during reading goes unnoticed.
        // Whoever changes a file is expected to replace it as a whole, so that none is read half-written.
        let mut stamps: Vec<Stamp> = inputs.iter().map(|path| stamp_of(path)).collect();
        if let Some(first) = stamps.first_mut() {
            *first = begun;
        }
        let warnings = loaded.warnings.iter().map(ToString::to_string).collect();
        let seen_from = SeenFrom::SHOT;
        let wanted = session::for_pictures(seen_from);
        let prepared = session::prepare_by(&mut self.preparer, Arc::new(loaded), of_scene, wanted)?;
        self.ready = Some(Ready { prepared, seen_from, warnings, inputs, stamps });
        Ok(())
    }

    /// Pictures that are wider than the scene states show more at their sides, and need particles there. Prepares the
    /// scene again when it lacks these particles, or has too many.
    fn ready_for(&mut self, size_px: Option<[u32; 2]>) -> Result<(), Failure> {
        let Some(ready) = &mut self.ready else { return Ok(()) };
        let painting = &ready.prepared.painting;
        let scene = painting.scene();
        let size_px = size_px.unwrap_or([scene.size.0, scene.size.1]);
        let seen_from = SeenFrom::for_options(scene, &FrameOptions::new(size_px));
        if seen_from != ready.seen_from && painting.depends_on_views() {
            let loaded = Arc::clone(painting.loaded());
            let wanted = session::for_pictures(seen_from);
            ready.prepared = session::prepare_by(&mut self.preparer, loaded, &self.arguments.scene, wanted)?;
            ready.seen_from = seen_from;
        }
        Ok(())
    }

    fn words_of_ready(&self, id: u64) -> Value {
        let Some(ready) = &self.ready else { return Value::Null };
        let scene = ready.prepared.painting.scene();
        json!({
            "event": "ready",
            "id": id,
            "first": scene.timeline.first,
            "last": scene.timeline.last,
            "size": [scene.size.0, scene.size.1],
            "particles": ready.prepared.painting.particle_total(),
            "warnings": ready.warnings,
        })
    }

    fn render(&mut self, order: &RenderOrder, current: &Current) -> Result<Ending, Failure> {
        if !has_ending(&order.output, ".exr") {
            return Err(Failure::Usage(format!("output {}: let the name end in .exr", order.output)));
        }
        self.ready()?;
        self.ready_for(order.size)?;
        tell(&self.words_of_ready(order.id))?;
        let frames = FrameList::parse(&order.frames).map_err(Failure::Usage)?;
        let pattern = Pattern::parse(&order.output, frames.count());
        let Some(Ready { prepared: Prepared { painting, .. }, inputs, .. }) = &self.ready else {
            return Ok(Ending::Stopped);
        };
        for frame in frames.iter() {
            not_an_input(&pattern.path(frame), inputs)?;
        }
        ready_folder(&pattern.path(frames.iter().next().unwrap_or(0)))?;
        let scene = painting.scene();
        let aovs = AovSet::of_words(order.aovs.iter().map(String::as_str)).map_err(Failure::Usage)?;
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(session::open_renderer(self.arguments.driver, false)?),
        };
        let size_px = order.size.unwrap_or([scene.size.0, scene.size.1]);
        let wanted = Wanted {
            exr: Some(aovs),
            packing: if order.plain { Packing::Plain } else { Packing::Small },
            ..Wanted::default()
        };
        fits_in_memory(scene, wanted, size_px, renderer).map_err(Failure::Refused)?;
        let sequence = Sequence {
            painting: painting.clone(),
            options: FrameOptions { transparent: order.alpha, ..FrameOptions::new(size_px) },
            scene_name: self
                .arguments
                .scene
                .scene
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default(),
            // No state is noted: the program that asked knows what it asked for.
            state: String::new(),
            driver: session::driver(self.arguments.driver),
            shaders: ShaderTexts::default(),
            wanted,
            timed: false,
            counted: false,
        };
        let files = FrameFiles {
            frames: &frames,
            path: &|frame_number| pattern.path(frame_number),
            keep_existing: false,
        };
        let stop = || current.is_stopped();
        let mut out = 0;
        sequence.render_files(renderer, &files, &stop, |frame, outcome| {
            let path = pattern.path(frame).with_extension("exr");
            let line = match outcome {
                FileOutcome::Written(drawn) => {
                    out += 1;
                    json!({ "event": "frame", "id": order.id, "frame": frame, "path": path, "seconds": drawn.seconds })
                }
                FileOutcome::Kept => return Ok(()),
                FileOutcome::Failed(error) => {
                    let words = format!("{}: {error}", path.display());
                    json!({ "event": "failed", "id": order.id, "frame": frame, "message": words })
                }
            };
            tell(&line)?;
            // The program that asked removes each file once it has read it. If many files are left, wait for that
            // program.
            current.wait_until_taken(out, order.ahead);
            Ok::<(), Failure>(())
        })
    }
}
