//! `impasto movie`: a movie of frames that are on the disk.

use std::path::{Path, PathBuf};

use impasto_frame_files::frame_reader::{self, Depth, FrameInfo, FramePixels};
use impasto_frame_files::{FrameList, Pattern, not_an_input, ready_folder};
use impasto_sequence::movie::{FrameFormat, Kind, Movie};
use rayon::prelude::*;

use crate::args::MovieArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::progress_bar;

/// The frames of a movie, in order, all of one size.
struct Frames {
    paths: Vec<PathBuf>,
    infos: Vec<FrameInfo>,
}

pub(crate) fn run(arguments: &MovieArguments) -> Result<(), Failure> {
    let interrupt = Interrupt::watch()?;
    let output = arguments.output.as_path();
    let Some(kind) = Kind::of(output) else {
        let words = format!("-o {}: let the name end in .mp4, .mkv, .mov or .webm", output.display());
        return Err(Failure::Usage(words));
    };
    // With --alpha, a movie that cannot be transparent is refused before any frame is read.
    kind.encoding(arguments.alpha)?;
    let paths = paths(arguments)?;
    not_an_input(output, &paths)?;
    let frames = Frames::of(paths)?;
    let transparent =
        arguments.alpha || kind.holds_transparency() && frames.are_transparent_somewhere(arguments.quiet)?;
    let encoding = kind.encoding(transparent)?;
    encoding.ready(output)?;
    ready_folder(output)?;
    interrupt.hold_off();
    let deep = encoding.deep && frames.infos.iter().any(|info| info.depth == Depth::Sixteen);
    let format = FrameFormat {
        size_px: frames.infos[0].size_px,
        depth: if deep { Depth::Sixteen } else { Depth::Eight },
        fps: arguments.fps,
    };
    let mut movie = Movie::start(output, encoding, format)?;
    let bar = progress_bar(frames.paths.len() as u64, arguments.quiet);
    let poured = frames.pour(|mut frame| {
        if interrupt.came() {
            return Err(Failure::Interrupted { done: 0 });
        }
        let lies_over_black = !transparent && !frame.is_opaque();
        if lies_over_black {
            frame.lay_over_black();
        }
        movie.add(&frame.at_depth(format.depth).rgba)?;
        bar.inc(1);
        Ok(lies_over_black)
    });
    bar.finish_and_clear();
    let lies_over_black = poured?;
    movie.finish()?;
    if !arguments.quiet {
        let count = frames.paths.len();
        eprintln!("{count} {} in {}", if count == 1 { "frame" } else { "frames" }, output.display());
        if lies_over_black {
            eprintln!(
                "what is transparent in the frames is black here; a .mov or a .webm keeps it transparent"
            );
        }
    }
    Ok(())
}

fn paths(arguments: &MovieArguments) -> Result<Vec<PathBuf>, Failure> {
    let text = arguments.pattern.as_str();
    let pattern = Pattern::parse(text, 1);
    if !arguments.more.is_empty() || !pattern.has_place() {
        let words = format!(
            "name all frames by one word with #### for the number, such as {}; -f takes some of them",
            example(text)
        );
        return Err(Failure::Usage(words));
    }
    let list = arguments.list.as_deref().map(FrameList::parse).transpose().map_err(Failure::Usage)?;
    let frames = match list {
        Some(list) => {
            let frames: Vec<i64> = list.iter().collect();
            if let Some(gone) = frames.iter().map(|&frame| pattern.path(frame)).find(|path| !path.exists()) {
                let words = format!("{} is not there: render it, or leave it out of -f", gone.display());
                return Err(Failure::Refused(words));
            }
            frames
        }
        None => frames_there(text, &pattern)?,
    };
    Ok(frames.into_iter().map(|frame| pattern.path(frame)).collect())
}

/// The pattern that was probably meant, if a folder or a single frame was named.
fn example(text: &str) -> String {
    let path = Path::new(text);
    if path.is_dir() {
        return path.join("####.png").display().to_string();
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let before = stem.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let digits = match stem.len() - before.len() {
        0 => 4,
        digits => digits,
    };
    let ending = path.extension().map_or("png".into(), |ending| ending.to_string_lossy());
    path.with_file_name(format!("{before}{}.{ending}", "#".repeat(digits))).display().to_string()
}

/// The numbers of all frames that exist. Gaps between them are refused.
fn frames_there(text: &str, pattern: &Pattern) -> Result<Vec<i64>, Failure> {
    let frames = pattern.frames_there().map_err(|error| Failure::of_file(Path::new(text), error))?;
    let [first, .., last] = frames[..] else {
        return match frames[..] {
            [] => {
                Err(Failure::Refused(format!("{text}: no file has such a name; look for the frames' names")))
            }
            _ => Ok(frames),
        };
    };
    let Some(gap) = frames.windows(2).find(|pair| pair[1].abs_diff(pair[0]) != 1) else { return Ok(frames) };
    let step = gap[1].abs_diff(gap[0]);
    let even = frames.windows(2).all(|pair| pair[1].abs_diff(pair[0]) == step);
    let example = if even { format!("{first}-{last}x{step}") } else { format!("{first}-{}", gap[0]) };
    Err(Failure::Refused(format!(
        "{} is not there, but frames before and after it are; render it, or name those to take, such as -f {example}",
        pattern.path(gap[0] + 1).display()
    )))
}

impl Frames {
    /// Looks at every file's header, so that a frame that does not fit is found before anything is written.
    fn of(paths: Vec<PathBuf>) -> Result<Self, Failure> {
        let mut infos: Vec<FrameInfo> = Vec::with_capacity(paths.len());
        for path in &paths {
            let info = frame_reader::info(path).map_err(|error| Failure::Refused(error.to_string()))?;
            infos.push(info);
            fits(path, info.size_px, &paths[0], infos[0].size_px)?;
        }
        Ok(Self { paths, infos })
    }

    fn read(&self, path: &Path) -> Result<FramePixels, Failure> {
        let frame = frame_reader::read(path).map_err(|error| Failure::Refused(error.to_string()))?;
        // The file may have been written anew since its header was looked at.
        fits(path, frame.size_px, &self.paths[0], self.infos[0].size_px)?;
        Ok(frame)
    }

    /// Hands each frame to `take_in`, in order. Returns whether `take_in` returned true for any.
    fn pour(&self, mut take_in: impl FnMut(FramePixels) -> Result<bool, Failure>) -> Result<bool, Failure> {
        let mut any = false;
        for path in &self.paths {
            any |= take_in(self.read(path)?)?;
        }
        Ok(any)
    }

    /// Whether any pixel of any frame is transparent. Only frames whose files have alpha are read, and only until a
    /// transparent one is found.
    fn are_transparent_somewhere(&self, quiet: bool) -> Result<bool, Failure> {
        let with_alpha: Vec<&PathBuf> = self
            .paths
            .iter()
            .zip(&self.infos)
            .filter(|(_, info)| info.has_alpha)
            .map(|(path, _)| path)
            .collect();
        let bar = progress_bar(with_alpha.len() as u64, quiet);
        bar.set_prefix("looking for transparency ");
        let found = with_alpha.into_par_iter().find_map_first(|path| {
            let transparent = self.read(path).map(|frame| !frame.is_opaque());
            bar.inc(1);
            (!matches!(transparent, Ok(false))).then_some(transparent)
        });
        bar.finish_and_clear();
        found.unwrap_or(Ok(false))
    }
}

/// Refuses a frame that is not as large as the first.
fn fits(path: &Path, size_px: [u32; 2], first: &Path, first_size_px: [u32; 2]) -> Result<(), Failure> {
    if size_px == first_size_px {
        return Ok(());
    }
    Err(Failure::Refused(format!(
        "{} is {} x {} pixels, but {} is {} x {}; render it at that size, or leave it out by -f",
        path.display(),
        size_px[0],
        size_px[1],
        first.display(),
        first_size_px[0],
        first_size_px[1],
    )))
}
