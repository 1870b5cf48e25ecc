//! Writes movies: pipes raw frames to ffmpeg, where that is installed.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use impasto_scene::whole_file::WholeFile;

use crate::failure::Failure;

#[cfg(test)]
mod tests;

/// Converts sRGB pixels to BT.709 in the limited range of television, and states that in the file. Players assume it;
/// by default ffmpeg writes BT.601 and states nothing, and players show wrong colours. H.264 and others need even
/// sides, so the picture is padded: transparent in files with transparency, else black.
const FILTERS: &str = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black@0,\
    scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,\
    setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709";

/// How a movie is encoded: ffmpeg's arguments for its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Encoding(&'static [&'static str]);

/// Endings of file names that mean a movie, with the encodings without and with transparency.
const ENCODINGS: [(&str, Encoding, Option<Encoding>); 4] = [
    ("mp4", Encoding(&["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"]), None),
    (
        "mov",
        Encoding(&["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mov"]),
        // ProRes 4444.
        Some(Encoding(&["-c:v", "prores_ks", "-profile:v", "4", "-pix_fmt", "yuva444p10le", "-f", "mov"])),
    ),
    ("mkv", Encoding(&["-pix_fmt", "yuv420p", "-f", "matroska"]), None),
    (
        "webm",
        Encoding(&["-pix_fmt", "yuv420p", "-f", "webm"]),
        Some(Encoding(&["-c:v", "libvpx-vp9", "-pix_fmt", "yuva420p", "-f", "webm"])),
    ),
];

impl Encoding {
    /// The encoding that a file's name asks for; `None` for a name that is not a movie's.
    ///
    /// # Errors
    /// A message, where transparency is wanted and this kind of file has none.
    pub(crate) fn of(path: &Path, transparent: bool) -> Option<Result<Self, String>> {
        let ending = path.extension()?.to_string_lossy().to_lowercase();
        let (_, opaque, with_alpha) = ENCODINGS.into_iter().find(|(known, ..)| *known == ending)?;
        if !transparent {
            return Some(Ok(opaque));
        }
        Some(with_alpha.ok_or_else(|| {
            format!(
                "--alpha: a .{ending} movie holds no transparency; write a .mov (ProRes 4444) or a .webm (VP9), or PNG frames"
            )
        }))
    }
}

/// A movie that is being written. The file gets its name only once it is whole; dropped before that, it leaves nothing.
pub(crate) struct Movie {
    encoder: Child,
    file: Option<WholeFile>,
    path: PathBuf,
}

impl Movie {
    /// Starts ffmpeg.
    pub(crate) fn start(
        path: &Path,
        encoding: Encoding,
        size_px: [u32; 2],
        fps: f64,
    ) -> Result<Self, Failure> {
        let file = WholeFile::create(path).map_err(|error| Failure::of_file(path, error))?;
        let mut command = Command::new("ffmpeg");
        command
            .args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba"])
            .args(["-s", &format!("{}x{}", size_px[0], size_px[1]), "-r", &fps.to_string(), "-i", "-"])
            .args(["-an", "-vf", FILTERS])
            .args(encoding.0)
            .arg(file.part_path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null());
        // Ctrl-C in a terminal goes to a whole process group. ffmpeg has a group of its own, so that only we end it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let encoder = command.spawn().map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => Failure::Refused(format!(
                "{}: movies are made by ffmpeg, which is not installed; install it (apt install ffmpeg), or write \
                 frames with -o out/frame_####.png or one animated PNG with --apng",
                path.display()
            )),
            _ => Failure::Other(format!("ffmpeg cannot be started: {error}")),
        })?;
        Ok(Self { encoder, file: Some(file), path: path.to_owned() })
    }

    /// Appends a frame.
    pub(crate) fn add(&mut self, rgba8: &[u8]) -> Result<(), Failure> {
        let Some(pipe) = &mut self.encoder.stdin else { return Ok(()) };
        pipe.write_all(rgba8)
            .map_err(|error| Failure::Other(format!("ffmpeg stopped before the last frame: {error}")))
    }

    /// Waits for ffmpeg and gives the movie its name.
    pub(crate) fn finish(mut self) -> Result<(), Failure> {
        drop(self.encoder.stdin.take());
        let status = self.encoder.wait().map_err(|error| Failure::Other(format!("ffmpeg: {error}")))?;
        if !status.success() {
            return Err(Failure::Other(format!(
                "ffmpeg ended with {status}; {} is not written",
                self.path.display()
            )));
        }
        let Some(file) = self.file.take() else { return Ok(()) };
        file.finish().map_err(|error| Failure::of_file(&self.path, error))
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
