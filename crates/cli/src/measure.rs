//! `impasto measure`: how steady scenes are, in numbers.

use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

use impasto_frame_files::{not_an_input, ready_folder};
use impasto_measure::{MeasureError, MeasureOptions, MeasureReport, Progress, measure, plot, turntable};
use impasto_scene::whole_file;

use crate::args::MeasureArguments;
use crate::cache::CacheArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::scene_args::{PlacingArguments, SceneArguments};
use crate::session;

/// The exit code where a metric misses its target.
const MISSED: u8 = 1;

pub(crate) fn run(arguments: &MeasureArguments) -> Result<(), Failure> {
    if let Some(plot) = &arguments.plot {
        check_plot(plot, arguments.scenes.len())?;
    }
    let interrupt = Interrupt::watch()?;
    let mut all_hold = true;
    for (index, path) in arguments.scenes.iter().enumerate() {
        let scene = SceneArguments {
            placing: PlacingArguments::default(),
            scene: path.clone(),
            asset_dirs: arguments.asset_dirs.clone(),
            set: arguments.set.clone(),
            memory: None,
            // The thread pool is built once, with the first scene.
            threads: arguments.threads.filter(|_| index == 0),
            cache: CacheArguments::default(),
        };
        let mut loaded = session::read_scene(&scene, arguments.quiet)?;
        if let Some(plot) = &arguments.plot {
            not_an_input(plot, &loaded.inputs())?;
            ready_folder(plot)?;
        }
        if arguments.turntable {
            loaded = turntable(&loaded);
        }
        let options = MeasureOptions {
            size_px: arguments.size,
            metrics: if arguments.only.is_empty() {
                MeasureOptions::default().metrics
            } else {
                arguments.only.clone()
            },
            driver: session::driver(arguments.driver),
            ..MeasureOptions::default()
        };
        let report = measure(&Arc::new(loaded), &options, &mut |progress: &Progress| {
            if !arguments.quiet {
                let Progress { metric, done, of } = progress;
                eprintln!("{}: {metric} {} ({} of {of})", path.display(), metric.title(), done + 1);
            }
        })?;
        all_hold &= report.holds();
        print(&report, arguments, &interrupt)?;
    }
    if all_hold { Ok(()) } else { Err(Failure::Quiet(MISSED)) }
}

fn print(report: &MeasureReport, arguments: &MeasureArguments, interrupt: &Interrupt) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    if arguments.json {
        let text = serde_json::to_string(report).map_err(|error| Failure::Other(error.to_string()))?;
        writeln!(out, "{text}")?;
    } else {
        write!(out, "{}", report.table())?;
    }
    let Some(path) = &arguments.plot else { return Ok(()) };
    let text = plot::svg(report);
    interrupt.hold_off();
    whole_file::write(path, text.as_bytes()).map_err(|error| Failure::of_file(path, error))
}

fn check_plot(plot: &Path, scenes: usize) -> Result<(), Failure> {
    if plot.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("svg")) {
        return Err(Failure::Usage(format!("--plot {}: charts are written as .svg only", plot.display())));
    }
    if scenes > 1 {
        return Err(Failure::Usage("--plot takes one scene at a time".to_owned()));
    }
    Ok(())
}

impl From<MeasureError> for Failure {
    fn from(error: MeasureError) -> Self {
        match error {
            MeasureError::Context(error) => error.into(),
            MeasureError::Render(error) => error.into(),
            MeasureError::Prepare(error) => Self::Refused(error.to_string()),
        }
    }
}
