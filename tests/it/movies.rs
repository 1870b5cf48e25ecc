//! Tests of movies as a user makes them: from a scene by `impasto render`, and from frames on the disk by
//! `impasto movie`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use impasto_tests::command::impasto;
use png::{BitDepth, ColorType};

const SIZE_PX: [u32; 2] = [64, 36];

/// The colours of frames 1 to 3, in sRGB.
const COLORS: [[u8; 3]; 3] = [[200, 30, 30], [0, 160, 0], [20, 40, 220]];

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(impasto());
        command.args(arguments).current_dir(self.0.path());
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command
    }

    /// Runs the command, which must succeed, and returns what it says.
    fn run(&self, arguments: &[&str]) -> String {
        let output = self.command(arguments).output().unwrap();
        let words = words(&output);
        assert!(output.status.success(), "{arguments:?}: {words}");
        words
    }

    /// Runs `impasto movie` with these arguments. It must exit with `code`, print one line that contains all `parts`,
    /// and leave no file.
    fn refused(&self, arguments: &[&str], code: i32, parts: &[&str]) {
        let before = self.names();
        let output = self.command(&[&["movie"], arguments].concat()).output().unwrap();
        let words = words(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {words}");
        assert_eq!(words.lines().count(), 1, "{arguments:?}: {words}");
        for part in parts {
            assert!(words.contains(part), "{arguments:?}: no {part:?} in {words}");
        }
        assert_eq!(self.names(), before, "{arguments:?}");
    }

    fn names(&self) -> Vec<PathBuf> {
        let mut names: Vec<PathBuf> =
            std::fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.sort();
        names
    }

    /// Writes a frame of one colour.
    fn frame(&self, name: &str, size_px: [u32; 2], color: ColorType, depth: BitDepth, pixel: &[u8]) {
        let file = std::fs::File::create(self.path(name)).unwrap();
        let mut encoder = png::Encoder::new(file, size_px[0], size_px[1]);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&pixel.repeat((size_px[0] * size_px[1]) as usize)).unwrap();
        writer.finish().unwrap();
    }

    /// Writes frames 1 to 3, opaque but with an alpha channel, as `impasto render` does.
    fn three_frames(&self) {
        for (index, [r, g, b]) in COLORS.into_iter().enumerate() {
            let name = format!("f_{:04}.png", index + 1);
            self.frame(&name, SIZE_PX, ColorType::Rgba, BitDepth::Eight, &[r, g, b, 255]);
        }
    }

    /// The pixel in the middle of each frame of a movie.
    fn middles(&self, name: &str, decoder: &[&str]) -> Vec<[u8; 4]> {
        let frame_bytes = (SIZE_PX[0] * SIZE_PX[1] * 4) as usize;
        let middle = ((SIZE_PX[1] / 2 * SIZE_PX[0] + SIZE_PX[0] / 2) * 4) as usize;
        let decoded = decoded(&self.path(name), decoder);
        assert_eq!(decoded.len() % frame_bytes, 0, "{name}");
        decoded.chunks_exact(frame_bytes).map(|frame| frame[middle..][..4].try_into().unwrap()).collect()
    }
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The frames of a movie as a player shows them, in RGBA, one after the other.
fn decoded(path: &Path, decoder: &[&str]) -> Vec<u8> {
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error"]).args(decoder).arg("-i").arg(path);
    let output = command.args(["-f", "rawvideo", "-pix_fmt", "rgba", "-"]).output().unwrap();
    assert!(output.status.success(), "{}", words(&output));
    output.stdout
}

/// A field of the movie's video stream, as ffprobe prints it.
fn told(path: &Path, entry: &str) -> String {
    let mut command = Command::new("ffprobe");
    command.args(["-v", "error", "-select_streams", "v:0", "-of", "csv=p=0"]);
    let output = command.args(["-show_entries", &format!("stream={entry}")]).arg(path).output().unwrap();
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

fn assert_near(found: &[[u8; 4]], wanted: &[[u8; 4]], what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}");
    let near = found.iter().flatten().zip(wanted.iter().flatten()).all(|(a, b)| a.abs_diff(*b) <= 2);
    assert!(near, "{what}: {wanted:?} is shown as {found:?}");
}

/// Whether ffmpeg is installed; prints a line where it is not.
///
/// # Panics
/// When it is missing in CI (`CI` is set).
fn has_ffmpeg() -> bool {
    let all = ["ffmpeg", "ffprobe"].iter().all(|name| Command::new(name).arg("-version").output().is_ok());
    assert!(all || std::env::var_os("CI").is_none(), "ffmpeg is missing; `cargo xtask test` installs it");
    if !all {
        // The test runner would show the output of `eprintln!` only if the test failed.
        let line = b"ignored: ffmpeg is missing; `cargo xtask test` installs it\n";
        let _ = std::io::Write::write_all(&mut std::io::stderr(), line);
    }
    all
}

#[test]
fn frames_of_every_kind_of_png_make_a_movie() {
    if !has_ffmpeg() {
        return;
    }
    let folder = Folder::new();
    for (number, color, depth, pixel) in [
        (-1, ColorType::Grayscale, BitDepth::Eight, &[130][..]),
        (0, ColorType::Rgb, BitDepth::Eight, &[200, 30, 30]),
        (1, ColorType::Rgba, BitDepth::Eight, &[0, 160, 0, 255]),
        (2, ColorType::Rgb, BitDepth::Sixteen, &[20, 20, 40, 40, 220, 220]),
        (3, ColorType::GrayscaleAlpha, BitDepth::Sixteen, &[60, 60, 255, 255]),
    ] {
        let sign = if number < 0 { "-" } else { "" };
        folder.frame(&format!("f.{sign}{:03}.png", i32::abs(number)), SIZE_PX, color, depth, pixel);
    }
    let colors =
        [[130, 130, 130, 255], [200, 30, 30, 255], [0, 160, 0, 255], [20, 40, 220, 255], [60, 60, 60, 255]];
    for name in ["a.mp4", "a.mkv", "a.mov", "a.webm"] {
        for pattern in ["f.###.png", "f.%03d.png", "f.$F3.png"] {
            assert!(folder.run(&["movie", pattern, "-o", name]).contains("5 frames in"));
        }
        assert_near(&folder.middles(name, &[]), &colors, name);
        assert_eq!(told(&folder.path(name), "r_frame_rate"), "24/1");
        assert!(!told(&folder.path(name), "pix_fmt").starts_with("yuva"), "{name} has alpha");
    }
    // Some frames, in another order, one of them twice, at another speed.
    folder.run(&["movie", "f.###.png", "-o", "b.mov", "-f", "3-1x2,-1,3", "--fps", "24000/1001", "-q"]);
    assert_near(&folder.middles("b.mov", &[]), &[colors[4], colors[2], colors[0], colors[4]], "b.mov");
    assert_eq!(told(&folder.path("b.mov"), "r_frame_rate"), "24000/1001");
}

#[test]
fn transparent_frames_stay_transparent_where_the_movie_can_be() {
    if !has_ffmpeg() {
        return;
    }
    let folder = Folder::new();
    folder.three_frames();
    // Only the last frame is not opaque.
    folder.frame("f_0003.png", SIZE_PX, ColorType::Rgba, BitDepth::Eight, &[20, 40, 220, 128]);
    let kept = [[200, 30, 30, 255], [0, 160, 0, 255], [20, 40, 220, 128]];
    folder.run(&["movie", "f_####.png", "-o", "a.mov"]);
    assert_near(&folder.middles("a.mov", &[]), &kept, "a.mov");
    folder.run(&["movie", "f_####.png", "-o", "a.webm"]);
    assert_near(&folder.middles("a.webm", &["-c:v", "libvpx-vp9"]), &kept, "a.webm");
    let words = folder.run(&["movie", "f_####.png", "-o", "a.mp4"]);
    assert!(words.contains("is black here"), "{words}");
    // 128/255 of the colour is left.
    assert_near(&folder.middles("a.mp4", &[]), &[kept[0], kept[1], [10, 20, 110, 255]], "a.mp4");
    // Opaque frames make an opaque movie, unless the user says otherwise.
    folder.run(&["movie", "f_####.png", "-o", "b.mov", "-f", "1-2"]);
    assert_eq!(told(&folder.path("b.mov"), "pix_fmt"), "yuv444p12le");
    folder.run(&["movie", "f_####.png", "-o", "b.mov", "-f", "1-2", "--alpha"]);
    assert_eq!(told(&folder.path("b.mov"), "pix_fmt"), "yuva444p12le");
    assert_near(&folder.middles("b.mov", &[]), &kept[..2], "b.mov");
}

#[test]
fn what_cannot_become_a_movie_is_refused_in_one_line() {
    let folder = Folder::new();
    folder.three_frames();
    folder.refused(&["f_####.png", "-o", "a.mp4", "--alpha"], 2, &["--alpha", ".mov", ".webm"]);
    folder.refused(&["f_####.png", "-o", "a.avi"], 2, &["a.avi", ".mp4, .mkv, .mov or .webm"]);
    folder.refused(&["f_0001.png", "f_0002.png", "-o", "a.mp4"], 2, &["such as f_####.png"]);
    folder.refused(&["f.png", "-o", "a.mp4"], 2, &["such as f####.png"]);
    folder.refused(&[".", "-o", "a.mp4"], 2, &["####.png"]);
    folder.refused(&["g_####.png", "-o", "a.mp4"], 3, &["g_####.png: no file has such a name"]);
    folder.refused(&["none/####.png", "-o", "a.mp4"], 1, &["none/####.png"]);
    folder.refused(&["f_####.png", "-o", "a.mp4", "-f", "1-5"], 3, &["f_0004.png is not there"]);
    folder.refused(&["f_####.png", "-o", "a.mp4", "-f", "one"], 2, &["is no frame list"]);
    let output = folder.command(&["movie", "f_####.png", "-o", "a.mp4", "--fps", "0"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output).contains("such as 24, 23.976 or 24000/1001"), "{}", words(&output));

    // A gap in the numbers, and frames on twos.
    std::fs::copy(folder.path("f_0001.png"), folder.path("f_0005.png")).unwrap();
    folder.refused(&["f_####.png", "-o", "a.mp4"], 3, &["f_0004.png is not there", "-f 1-3"]);
    for (from, to) in
        [("f_0001.png", "twos_-4.png"), ("f_0002.png", "twos_-2.png"), ("f_0003.png", "twos_0.png")]
    {
        std::fs::copy(folder.path(from), folder.path(to)).unwrap();
    }
    folder.refused(&["twos_#.png", "-o", "a.mp4"], 3, &["twos_-3.png is not there", "-f -4-0x2"]);

    folder.frame("f_0004.png", [64, 37], ColorType::Rgb, BitDepth::Eight, &[1, 2, 3]);
    folder.refused(
        &["f_####.png", "-o", "a.mp4"],
        3,
        &["f_0004.png is 64 x 37 pixels, but f_0001.png is 64 x 36", "-f"],
    );
    let whole = std::fs::read(folder.path("f_0001.png")).unwrap();
    std::fs::write(folder.path("f_0004.png"), &whole[..whole.len() - 40]).unwrap();
    if has_ffmpeg() {
        for name in ["a.mp4", "a.mov"] {
            folder.refused(&["f_####.png", "-o", name], 3, &["f_0004.png is no whole PNG file"]);
        }
    }
    std::fs::write(folder.path("f_0004.png"), "text").unwrap();
    folder.refused(&["f_####.png", "-o", "a.mp4"], 3, &["f_0004.png is no whole PNG file"]);
}

#[cfg(unix)]
#[test]
fn no_movie_is_written_over_its_frames() {
    let folder = Folder::new();
    folder.three_frames();
    let before = std::fs::read(folder.path("f_0002.png")).unwrap();
    std::os::unix::fs::symlink("f_0002.png", folder.path("a.mp4")).unwrap();
    folder.refused(&["f_####.png", "-o", "a.mp4"], 3, &["is read by this command", "-o"]);
    std::fs::rename(folder.path("f_0002.png"), folder.path("f_0009.mp4")).unwrap();
    folder.refused(&["f_####.mp4", "-o", "f_0009.mp4"], 3, &["f_0009.mp4 is read by this command"]);
    assert_eq!(std::fs::read(folder.path("f_0009.mp4")).unwrap(), before);
}

#[cfg(unix)]
#[test]
fn an_interrupt_between_frames_leaves_no_movie() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new();
    folder.three_frames();
    // A stand-in for ffmpeg: it lists the encoder, writes the file `began` when it starts, and reads slowly.
    let programs = folder.path("programs");
    std::fs::create_dir(&programs).unwrap();
    let script = "#!/bin/sh\ncase \"$*\" in *-encoders*) echo ' V libx264 H.264'; exit;; esac\n\
        : > began\nwhile [ \"$(/bin/dd bs=9216 count=1 2>/dev/null | /usr/bin/wc -c)\" -gt 0 ]; do /bin/sleep 0.02; done\n";
    std::fs::write(programs.join("ffmpeg"), script).unwrap();
    std::fs::set_permissions(programs.join("ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let list = "1-3,".repeat(20_000) + "1";
    let mut child = folder
        .command(&["movie", "f_####.png", "-o", "a.mp4", "-q", "-f", &list])
        .env("PATH", &programs)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    for _ in 0..600 {
        if folder.path("began").exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let left: Vec<String> =
        folder.names().iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(left, ["began", "f_0001.png", "f_0002.png", "f_0003.png", "programs"]);
}

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

const SCENE: &str = "#![enable(implicit_some)]
(
    version: 1,
    size: (64, 36),
    timeline: (fps: 24, first: 0, last: 1),
    camera: (keys: [(frame: 0, eye: (0, 0, 3), target: (0, 0, 0))]),
    objects: [(name: \"triangle\", mesh: \"triangle.obj\")],
    strokes: (length_px: 12, width_px: 4),
)
";

/// The transparency of a painted movie is that of the painted PNG.
#[test]
fn a_scene_is_painted_into_a_transparent_movie() {
    if !has_ffmpeg() {
        return;
    }
    let folder = Folder::new();
    std::fs::write(folder.path("triangle.obj"), TRIANGLE).unwrap();
    std::fs::write(folder.path("scene.ron"), SCENE).unwrap();
    folder.run(&["render", "scene.ron", "--alpha", "-f", "0", "-o", "f.png"]);
    let file = std::io::BufReader::new(std::fs::File::open(folder.path("f.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut picture = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut picture).unwrap();
    let alphas = |pixels: &[u8]| pixels.chunks_exact(4).map(|pixel| pixel[3]).collect::<Vec<_>>();
    let painted = alphas(&picture);
    assert!(painted.contains(&0) && painted.contains(&255));
    folder.run(&["render", "scene.ron", "--alpha", "-f", "0", "-o", "a.mov"]);
    let shown = alphas(&decoded(&folder.path("a.mov"), &[]));
    let off = painted.iter().zip(&shown).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    assert!(painted.len() == shown.len() && off <= 2, "{off}");
    // Without --alpha nothing is transparent.
    folder.run(&["render", "scene.ron", "-f", "0", "-o", "b.mov"]);
    assert_eq!(told(&folder.path("b.mov"), "pix_fmt"), "yuv444p12le");
    // VP9 blurs edges a little, so only pixels away from edges are compared.
    folder.run(&["render", "scene.ron", "--alpha", "-f", "0", "-o", "a.webm"]);
    let shown = alphas(&decoded(&folder.path("a.webm"), &["-c:v", "libvpx-vp9"]));
    let width = SIZE_PX[0] as usize;
    let mut compared = [0, 0];
    for at in 4 * width + 4..painted.len() - 4 * width - 4 {
        let around = (0..81).map(|index| painted[at + index / 9 * width + index % 9 - 4 * width - 4]);
        if around.clone().all(|alpha| alpha == painted[at]) && [0, 255].contains(&painted[at]) {
            compared[usize::from(painted[at] == 255)] += 1;
            assert!(painted[at].abs_diff(shown[at]) <= 2, "{} is {}", painted[at], shown[at]);
        }
    }
    assert!(compared.iter().all(|&pixels| pixels > 20), "{compared:?}");
}
