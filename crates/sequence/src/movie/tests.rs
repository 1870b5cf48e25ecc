//! Tests that movies keep colours and transparency: flat colours are written, and then decoded as a player does.

use super::*;

/// Flat colours, left to right: three that BT.601 and BT.709 show differently, the corners of the RGB cube, grey and
/// orange.
const COLORS: [[u8; 3]; 13] = [
    [0, 160, 0],
    [200, 30, 30],
    [20, 40, 220],
    [255, 255, 255],
    [0, 0, 0],
    [128, 128, 128],
    [255, 0, 0],
    [0, 255, 0],
    [0, 0, 255],
    [255, 255, 0],
    [255, 0, 255],
    [0, 255, 255],
    [255, 128, 0],
];

/// The alpha of each row of patches, from the top down.
const ALPHAS: [u8; 7] = [255, 128, 64, 192, 1, 254, 0];

/// Side of a patch of one colour and one alpha, in pixels.
const PATCH_PX: usize = 32;

const FRAMES: usize = 4;

/// The most by which a channel may be off, of 255.
const WITHIN: u8 = 2;

/// Whether ffmpeg and ffprobe are installed; prints a line where they are not.
///
/// # Panics
/// When one of them is missing in CI (`CI` is set).
fn has_ffmpeg() -> bool {
    let is_there = |program: &str| Command::new(program).arg("-version").output().is_ok();
    let all = is_there("ffmpeg") && is_there("ffprobe");
    assert!(all || std::env::var_os("CI").is_none(), "ffmpeg is missing; `cargo xtask test` installs it");
    if !all {
        // The test runner would show the output of `eprintln!` only if the test failed.
        let _ = writeln!(std::io::stderr(), "ignored: ffmpeg is missing; `cargo xtask test` installs it");
    }
    all
}

fn encoding(path: &Path, transparent: bool) -> &'static Encoding {
    Kind::of(path).unwrap().encoding(transparent).unwrap()
}

/// A picture of patches: a column for each colour, a row for each alpha.
struct Patches {
    alphas: &'static [u8],
    /// The last patches are this much wider and higher, so that the sides can be odd.
    extra_px: usize,
}

impl Patches {
    fn size_px(&self) -> [usize; 2] {
        [COLORS.len(), self.alphas.len()].map(|patches| patches * PATCH_PX + self.extra_px)
    }

    fn rgba_at(&self, x: usize, y: usize) -> [u8; 4] {
        let [r, g, b] = COLORS[(x / PATCH_PX).min(COLORS.len() - 1)];
        [r, g, b, self.alphas[(y / PATCH_PX).min(self.alphas.len() - 1)]]
    }

    /// Writes a movie of equal frames.
    fn write(&self, path: &Path, transparent: bool, depth: Depth) {
        let [width, height] = self.size_px();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let bytes = pixels.flat_map(|(x, y)| self.rgba_at(x, y));
        let frame: Vec<u8> = match depth {
            Depth::Eight => bytes.collect(),
            Depth::Sixteen => bytes.flat_map(|value| [value; 2]).collect(),
        };
        let format = FrameFormat { size_px: self.size_px().map(|side| side as u32), depth, fps: 24.0 };
        let encoding = encoding(path, transparent);
        encoding.ready(path).unwrap();
        let mut movie = Movie::start(path, encoding, format).unwrap();
        for _ in 0..FRAMES {
            movie.add(&frame).unwrap();
        }
        movie.finish().unwrap();
    }

    /// Asserts that every pixel in the inner half of every patch, in every frame, is what was written. `coded_px` is
    /// the size of the frames in the movie.
    fn assert_decoded(&self, path: &Path, decoder: &[&str], coded_px: [usize; 2]) {
        let arguments = [&["-v", "error"], decoder, &["-i"]].concat();
        let decoded = output("ffmpeg", &arguments, path, &["-f", "rawvideo", "-pix_fmt", "rgba", "-"]);
        let [width, height] = coded_px;
        assert_eq!(decoded.len(), width * height * 4 * FRAMES, "{}", path.display());
        for (at, found) in decoded.chunks_exact(4).enumerate() {
            let (x, y) = (at % width, at / width % height);
            let inside = |at: usize| (PATCH_PX / 4..PATCH_PX * 3 / 4).contains(&(at % PATCH_PX));
            if !inside(x) || !inside(y) || x / PATCH_PX >= COLORS.len() || y / PATCH_PX >= self.alphas.len() {
                continue;
            }
            let wanted = self.rgba_at(x, y);
            // What cannot be seen at all may have any colour.
            let seen = if wanted[3] == 0 { 3..4 } else { 0..4 };
            let near = seen.into_iter().all(|channel| found[channel].abs_diff(wanted[channel]) <= WITHIN);
            assert!(near, "{}: {wanted:?} is shown as {found:?}", path.display());
        }
    }
}

fn output(program: &str, arguments: &[&str], path: &Path, more: &[&str]) -> Vec<u8> {
    let output = Command::new(program).args(arguments).arg(path).args(more).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Asserts that ffprobe says these lines of `name=value` about the movie.
fn assert_told(path: &Path, lines: &[&str]) {
    let entries = "codec_name,pix_fmt,width,height,color_range,color_space,color_transfer,color_primaries";
    let entries = format!("stream={entries}:stream_tags=alpha_mode");
    let arguments =
        ["-v", "error", "-select_streams", "v:0", "-of", "default=nw=1", "-show_entries", &entries];
    let told = String::from_utf8(output("ffprobe", &arguments, path, &[])).unwrap();
    for line in lines {
        assert!(told.lines().any(|told| told == *line), "{}: no {line} in {told}", path.display());
    }
}

/// The lines that ffprobe gives for a movie of any kind.
const BT709: [&str; 4] =
    ["color_range=tv", "color_space=bt709", "color_transfer=bt709", "color_primaries=bt709"];

#[test]
fn colours_are_shown_as_they_were_painted() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, codec, even_sides) in [
        ("a.mp4", ["codec_name=h264", "pix_fmt=yuv420p"], true),
        ("a.mkv", ["codec_name=h264", "pix_fmt=yuv420p"], true),
        // ffmpeg decodes ProRes 4444 to 12 bits.
        ("a.mov", ["codec_name=prores", "pix_fmt=yuv444p12le"], false),
        ("a.webm", ["codec_name=vp9", "pix_fmt=yuv420p"], false),
    ] {
        let path = folder.path().join(name);
        for extra_px in [0, 1] {
            let patches = Patches { alphas: &[255, 255], extra_px };
            patches.write(&path, false, Depth::Eight);
            let coded_px =
                patches.size_px().map(|side| if even_sides { side.next_multiple_of(2) } else { side });
            let sides = [format!("width={}", coded_px[0]), format!("height={}", coded_px[1])];
            assert_told(&path, &[&BT709[..], &codec, &[&sides[0], &sides[1]]].concat());
            patches.assert_decoded(&path, &[], coded_px);
        }
    }
}

#[test]
fn transparency_is_kept_where_a_movie_has_it() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // ffmpeg's own VP9 decoder drops transparency, so libvpx decodes here. ffprobe uses ffmpeg's own and names a pixel
    // format without alpha, so the tag is checked instead.
    for (name, decoder, tag) in
        [("a.mov", "prores", "pix_fmt=yuva444p12le"), ("a.webm", "libvpx-vp9", "TAG:alpha_mode=1")]
    {
        let path = folder.path().join(name);
        for extra_px in [0, 1] {
            let patches = Patches { alphas: &ALPHAS, extra_px };
            patches.write(&path, true, Depth::Eight);
            assert_told(&path, &[&BT709[..], &[tag]].concat());
            patches.assert_decoded(&path, &["-c:v", decoder], patches.size_px());
        }
    }
}

#[test]
fn sixteen_bits_a_channel_are_taken_too() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mov");
    let patches = Patches { alphas: &ALPHAS, extra_px: 0 };
    patches.write(&path, true, Depth::Sixteen);
    patches.assert_decoded(&path, &[], patches.size_px());
}

#[test]
fn transparency_is_refused_where_a_movie_has_none() {
    for name in ["a.png", "mp4", "a", ""] {
        assert_eq!(Kind::of(Path::new(name)), None, "{name}");
    }
    for name in ["a.mp4", "a.MKV"] {
        let kind = Kind::of(Path::new(name)).unwrap();
        assert!(!kind.holds_transparency() && kind.encoding(false).is_ok());
        let words = kind.encoding(true).unwrap_err().to_string();
        assert!(words.contains(".mov") && words.contains(".webm") && !words.contains('\n'), "{words}");
    }
    for name in ["a.mov", "a.webm"] {
        assert!(Kind::of(Path::new(name)).unwrap().holds_transparency());
    }
}

#[test]
fn an_encoder_that_is_missing_is_named_with_what_does_without_it() {
    if !has_ffmpeg() {
        return;
    }
    let none = Encoding {
        encoder: "libnothing",
        codec: "Nothing",
        pixels: "yuv420p",
        arguments: &["-f", "mp4"],
        even_sides: false,
        deep: false,
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    let words = none.ready(&path).unwrap_err().to_string();
    assert!(words.contains("a.mp4") && words.contains("no encoder libnothing (Nothing)"), "{words}");
    // If ffmpeg itself fails, the error holds its message, and no file is left.
    let format = FrameFormat { size_px: [512, 512], depth: Depth::Eight, fps: 24.0 };
    let mut movie = Movie::start(&path, &none, format).unwrap();
    let added = movie.add(&[0; 512 * 512 * 4]);
    let words = added.and_then(|()| movie.finish()).unwrap_err().to_string();
    assert!(words.contains("libnothing") && words.contains("a.mp4 is not written"), "{words}");
    assert_eq!(words.lines().count(), 1, "{words}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert_eq!(encoding(Path::new("a.mp4"), false).others(), [".mov", ".webm"]);
}
