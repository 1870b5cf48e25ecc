//! Movies: raw frames piped to ffmpeg, where that is installed.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use impasto_gl_render::Picture;

use crate::failure::Failure;

/// Endings of file names that mean a movie.
const ENDINGS: [&str; 4] = ["mp4", "mov", "mkv", "webm"];

/// Whether a file of this name is a movie.
pub(crate) fn is_movie(name: &str) -> bool {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// A movie that is being written. It has its own name only when it is whole; dropped before, it leaves nothing.
pub(crate) struct Movie {
    encoder: Child,
    part: Option<tempfile::TempPath>,
    path: PathBuf,
}

impl Movie {
    /// Starts ffmpeg.
    pub(crate) fn start(path: &Path, size_px: [u32; 2], fps: f64) -> Result<Self, Failure> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let ending = path.extension().map(|ending| ending.to_string_lossy()).unwrap_or_default();
        let part = tempfile::Builder::new()
            .prefix(".impasto-")
            .suffix(&format!(".{ending}"))
            .tempfile_in(folder)
            .map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?
            .into_temp_path();
        let encoder = Command::new("ffmpeg")
            .args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba"])
            .args(["-s", &format!("{}x{}", size_px[0], size_px[1]), "-r", &fps.to_string(), "-i", "-"])
            // Most players want even sides and this format.
            .args(["-an", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"])
            .arg(&part)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::NotFound => Failure::Refused(format!(
                    "{}: movies are made by ffmpeg, which is not installed; install it (apt install ffmpeg), or write \
                     frames with -o out/frame_####.png or one animated PNG with --apng",
                    path.display()
                )),
                _ => Failure::Other(format!("ffmpeg cannot be started: {error}")),
            })?;
        Ok(Self { encoder, part: Some(part), path: path.to_owned() })
    }

    /// Appends a frame.
    pub(crate) fn add(&mut self, picture: &Picture) -> Result<(), Failure> {
        let Some(pipe) = &mut self.encoder.stdin else { return Ok(()) };
        pipe.write_all(&picture.rgba8)
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
        let Some(part) = self.part.take() else { return Ok(()) };
        part.persist(&self.path).map_err(|error| Failure::Other(format!("{}: {error}", self.path.display())))
    }
}

impl Drop for Movie {
    fn drop(&mut self) {
        // Of a movie that was not finished, nothing is left running.
        drop(self.encoder.stdin.take());
        if self.encoder.try_wait().is_ok_and(|status| status.is_none()) {
            let _ = self.encoder.kill();
            let _ = self.encoder.wait();
        }
    }
}
