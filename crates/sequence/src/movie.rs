//! Writes movies by piping raw frames to ffmpeg, which has to be installed. `impasto render`, `impasto movie` and the
//! window all write them here.

use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use impasto_scene::whole_file::WholeFile;
use impasto_system::{FOR_MOVIES, mend};

pub use impasto_frame_files::frame_reader::Depth;

use crate::shot::FrameError;

#[cfg(test)]
mod tests;

/// Converts sRGB pixels to BT.709 in the limited range of television, and states that in the file. Players assume
/// BT.709, but ffmpeg by default writes BT.601 and states nothing, so players would show wrong colours. The statement
/// is made by a filter, because newer versions of ffmpeg ignore the options of the same meaning.
const COLOR_FILTERS: &str = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,\
    setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709";

/// Adds a black column and a black row where a side is odd.
const EVEN_SIDES_FILTER: &str = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black,";

/// The most bytes of ffmpeg's messages that are read into memory.
const MAX_WORDS_BYTES: u64 = 16 << 10;

/// Why a movie cannot be made, in one sentence each.
#[derive(Debug, thiserror::Error)]
pub enum MovieError {
    /// Transparency is wanted, but files of this kind have none.
    #[error("{0}")]
    NoTransparency(String),
    /// ffmpeg is not installed.
    #[error("{0}")]
    NotInstalled(String),
    /// The ffmpeg that is installed lacks the encoder.
    #[error("{0}")]
    NoEncoder(String),
    /// ffmpeg does not work, or the file cannot be written.
    #[error("{0}")]
    Failed(String),
    /// A frame was not drawn.
    #[error(transparent)]
    Frame(#[from] FrameError),
}

impl MovieError {
    fn of_file(path: &Path, error: impl std::fmt::Display) -> Self {
        Self::Failed(format!("{}: {error}", path.display()))
    }
}

/// How a movie is encoded.
#[derive(Debug, PartialEq, Eq)]
pub struct Encoding {
    /// ffmpeg's name of the encoder.
    encoder: &'static str,
    /// The name that people use.
    codec: &'static str,
    /// ffmpeg's name of the layout of pixels in the file.
    pixels: &'static str,
    /// The remaining arguments for the file.
    arguments: &'static [&'static str],
    /// Whether both sides of the picture must be even.
    even_sides: bool,
    /// Whether more than eight bits a channel arrive in the file.
    pub deep: bool,
}

/// What every player takes. The arguments state the container and the quality; CRF 18 keeps strokes crisp.
const fn h264(arguments: &'static [&'static str]) -> Encoding {
    Encoding {
        encoder: "libx264",
        codec: "H.264",
        pixels: "yuv420p",
        arguments,
        even_sides: true,
        deep: false,
    }
}

/// What film editing programs take. Colour is kept at every pixel (4:4:4): where it is subsampled, as in ProRes 422,
/// the edges of saturated strokes fray.
const fn prores_4444(pixels: &'static str) -> Encoding {
    let arguments = &["-profile:v", "4", "-vendor", "apl0", "-movflags", "+faststart", "-f", "mov"];
    Encoding { encoder: "prores_ks", codec: "ProRes 4444", pixels, arguments, even_sides: false, deep: true }
}

/// What browsers take.
const fn vp9(pixels: &'static str) -> Encoding {
    let arguments = &["-crf", "20", "-b:v", "0", "-cpu-used", "4", "-row-mt", "1", "-f", "webm"];
    Encoding { encoder: "libvpx-vp9", codec: "VP9", pixels, arguments, even_sides: false, deep: false }
}

/// A kind of movie file.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// The ending of its name.
    ending: &'static str,
    opaque: Encoding,
    /// `None` where files of this kind hold no transparency.
    transparent: Option<Encoding>,
}

static KINDS: [Kind; 4] = [
    Kind {
        ending: "mp4",
        opaque: h264(&["-crf", "18", "-movflags", "+faststart", "-f", "mp4"]),
        transparent: None,
    },
    Kind { ending: "mkv", opaque: h264(&["-crf", "18", "-f", "matroska"]), transparent: None },
    Kind {
        ending: "mov",
        opaque: prores_4444("yuv444p10le"),
        transparent: Some(prores_4444("yuva444p10le")),
    },
    Kind { ending: "webm", opaque: vp9("yuv420p"), transparent: Some(vp9("yuva420p")) },
];

impl Kind {
    /// The kind that a file's name asks for; `None` for a name that is not a movie's.
    pub fn of(path: &Path) -> Option<&'static Self> {
        let ending = path.extension()?.to_string_lossy().to_lowercase();
        KINDS.iter().find(|kind| kind.ending == ending)
    }

    /// Whether files of this kind can be transparent.
    pub fn holds_transparency(&self) -> bool {
        self.transparent.is_some()
    }

    /// How a file of this kind is encoded.
    ///
    /// # Errors
    /// Transparency is wanted, but files of this kind have none.
    pub fn encoding(&'static self, transparent: bool) -> Result<&'static Encoding, MovieError> {
        if !transparent {
            return Ok(&self.opaque);
        }
        self.transparent.as_ref().ok_or_else(|| {
            MovieError::NoTransparency(format!(
                "a .{} movie holds no transparency; write a .mov (ProRes 4444) or a .webm (VP9), or PNG frames",
                self.ending
            ))
        })
    }
}

impl Encoding {
    /// Makes sure that ffmpeg is there and has the encoder, before any work is done for the movie.
    ///
    /// # Errors
    /// What is missing.
    pub fn ready(&self, path: &Path) -> Result<(), MovieError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-loglevel", "error", "-encoders"]).stdin(Stdio::null());
        let told = command.output().map_err(|error| not_started(path, &error))?;
        if !told.status.success() {
            let why = one_line(&String::from_utf8_lossy(&told.stderr));
            let words = format!(
                "{}: ffmpeg does not work here, it ended with {}: {why}",
                path.display(),
                told.status
            );
            return Err(MovieError::Failed(words));
        }
        let told = String::from_utf8_lossy(&told.stdout);
        // Each line holds flags, the name and a description.
        let mut names = told.lines().filter_map(|line| line.split_whitespace().nth(1));
        if names.any(|name| name == self.encoder) {
            return Ok(());
        }
        Err(MovieError::NoEncoder(format!(
            "{}: the ffmpeg that is installed has no encoder {} ({}); this may bring one that has it: {}; or \
             let the name end in {}, which need others",
            path.display(),
            self.encoder,
            self.codec,
            mend(FOR_MOVIES),
            self.others().join(" or ")
        )))
    }

    /// The endings of movies that need another encoder.
    fn others(&self) -> Vec<String> {
        let others = KINDS.iter().filter(|kind| kind.opaque.encoder != self.encoder);
        others.map(|kind| format!(".{}", kind.ending)).collect()
    }
}

/// What ffmpeg said, in one line.
fn one_line(words: &str) -> String {
    let lines: Vec<&str> = words.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    if lines.is_empty() { "it said nothing".to_owned() } else { lines.join("; ") }
}

fn not_started(path: &Path, error: &std::io::Error) -> MovieError {
    match error.kind() {
        std::io::ErrorKind::NotFound => MovieError::NotInstalled(format!(
            "{}: movies are made by ffmpeg, which is not installed; {}",
            path.display(),
            mend(FOR_MOVIES)
        )),
        _ => MovieError::Failed(format!("ffmpeg cannot be started: {error}")),
    }
}

/// The frames of a movie.
#[derive(Clone, Copy, Debug)]
pub struct FrameFormat {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// How many bits a channel has.
    pub depth: Depth,
    /// Frames a second.
    pub fps: f64,
}

/// A movie that is being written. The file gets its name only once it is whole; dropped before that, it leaves nothing.
pub struct Movie {
    encoder: Child,
    /// Collects what ffmpeg says.
    words: Option<JoinHandle<String>>,
    file: Option<WholeFile>,
    path: PathBuf,
}

impl Movie {
    /// Starts ffmpeg.
    pub fn start(path: &Path, encoding: &Encoding, frames: FrameFormat) -> Result<Self, MovieError> {
        let file = WholeFile::create(path).map_err(|error| MovieError::of_file(path, error))?;
        let pixel_format = match frames.depth {
            Depth::Eight => "rgba",
            Depth::Sixteen => "rgba64be",
        };
        let [width, height] = frames.size_px;
        let even = if encoding.even_sides { EVEN_SIDES_FILTER } else { "" };
        let mut command = Command::new("ffmpeg");
        command
            .args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", pixel_format])
            .args(["-s", &format!("{width}x{height}"), "-r", &frames.fps.to_string(), "-i", "-"])
            .args(["-an", "-vf", &format!("{even}{COLOR_FILTERS}"), "-c:v", encoding.encoder])
            .args(["-pix_fmt", encoding.pixels])
            .args(encoding.arguments)
            .arg(file.part_path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        // Ctrl-C in a terminal goes to a whole process group. ffmpeg has a group of its own, so that only we end it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut encoder = command.spawn().map_err(|error| not_started(path, &error))?;
        let words = encoder.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut words = Vec::new();
                let _ = (&mut pipe).take(MAX_WORDS_BYTES).read_to_end(&mut words);
                // The rest is read too: ffmpeg would wait for ever on a full pipe.
                let _ = std::io::copy(&mut pipe, &mut std::io::sink());
                String::from_utf8_lossy(&words).into_owned()
            })
        });
        Ok(Self { encoder, words, file: Some(file), path: path.to_owned() })
    }

    /// Appends a frame: four channels a pixel.
    pub fn add(&mut self, rgba: &[u8]) -> Result<(), MovieError> {
        let Some(pipe) = &mut self.encoder.stdin else { return Ok(()) };
        match pipe.write_all(rgba) {
            Ok(()) => Ok(()),
            Err(error) => Err(self.ended().err().unwrap_or_else(|| {
                MovieError::Failed(format!("ffmpeg stopped before the last frame: {error}"))
            })),
        }
    }

    /// Waits for ffmpeg and gives the movie its name.
    pub fn finish(mut self) -> Result<(), MovieError> {
        self.ended()?;
        let Some(file) = self.file.take() else { return Ok(()) };
        file.finish().map_err(|error| MovieError::of_file(&self.path, error))
    }

    /// Waits for ffmpeg.
    ///
    /// # Errors
    /// In one line, what ffmpeg said as it failed.
    fn ended(&mut self) -> Result<(), MovieError> {
        drop(self.encoder.stdin.take());
        let status = self.encoder.wait().map_err(|error| MovieError::Failed(format!("ffmpeg: {error}")))?;
        let words = self.words.take().and_then(|words| words.join().ok()).unwrap_or_default();
        if status.success() {
            return Ok(());
        }
        let why = one_line(&words);
        Err(MovieError::Failed(format!(
            "{} is not written: ffmpeg ended with {status}: {why}",
            self.path.display()
        )))
    }
}

impl Drop for Movie {
    fn drop(&mut self) {
        // An unfinished movie leaves no ffmpeg running.
        drop(self.encoder.stdin.take());
        if self.encoder.try_wait().is_ok_and(|status| status.is_none()) {
            let _ = self.encoder.kill();
            let _ = self.encoder.wait();
        }
    }
}
