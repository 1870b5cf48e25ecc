//! Tests that movies keep colours and transparency: flat colours are written, and then decoded as a player does.

use super::*;

/// Bands of flat colour, left to right: three colours that BT.601 and BT.709 show differently, then white, black, grey.
const BANDS: [[u8; 4]; 6] = [
    [0, 160, 0, 255],
    [200, 30, 30, 255],
    [20, 40, 220, 255],
    [255, 255, 255, 255],
    [0, 0, 0, 255],
    [128, 128, 128, 255],
];
const BAND_PX: usize = 32;
const HEIGHT_PX: usize = 64;

/// Whether ffmpeg and ffprobe are installed; prints a line where they are not.
///
/// # Panics
/// When one of them is missing in CI (`CI` is set).
fn has_ffmpeg() -> bool {
    let is_there = |program: &str| Command::new(program).arg("-version").output().is_ok();
    let all = is_there("ffmpeg") && is_there("ffprobe");
    assert!(all || std::env::var_os("CI").is_none(), "ffmpeg is missing; `cargo xtask test` installs it");
    if !all {
        // Not by `eprintln!`: the test runner shows its output only for tests that fail.
        let _ = writeln!(std::io::stderr(), "ignored: ffmpeg is missing; `cargo xtask test` installs it");
    }
    all
}

fn encoding(name: &str, transparent: bool) -> Encoding {
    Encoding::of(Path::new(name), transparent).unwrap().unwrap()
}

/// Writes a movie of three equal frames of bands. `extra_px` is added to the last band's width and to the height, so
/// that the sides can be odd.
fn write(path: &Path, transparent: bool, bands: &[[u8; 4]], extra_px: usize) {
    let width = bands.len() * BAND_PX + extra_px;
    let row = (0..width).flat_map(|x| bands[(x / BAND_PX).min(bands.len() - 1)]);
    let frame: Vec<u8> = row.collect::<Vec<u8>>().repeat(HEIGHT_PX + extra_px);
    let size_px = [width as u32, (HEIGHT_PX + extra_px) as u32];
    let mut movie =
        Movie::start(path, encoding(&path.to_string_lossy(), transparent), size_px, 24.0).unwrap();
    for _ in 0..3 {
        movie.add(&frame).unwrap();
    }
    movie.finish().unwrap();
}

fn output(program: &str, arguments: &[&str], path: &Path, more: &[&str]) -> Vec<u8> {
    let output = Command::new(program).args(arguments).arg(path).args(more).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// What ffprobe says about the movie's stream, as lines of `name=value`.
fn probed(path: &Path, entries: &str) -> String {
    let entries = format!("stream={entries}");
    let arguments =
        ["-v", "error", "-select_streams", "v:0", "-of", "default=nw=1", "-show_entries", &entries];
    String::from_utf8(output("ffprobe", &arguments, path, &[])).unwrap()
}

/// The RGBA pixel in the middle of each band of the last frame. `before` are arguments of ffmpeg before its input.
fn decoded(path: &Path, bands: usize, width: usize, before: &[&str]) -> Vec<[u8; 4]> {
    let arguments = [&["-v", "error"], before, &["-i"]].concat();
    let pixels = output("ffmpeg", &arguments, path, &["-f", "rawvideo", "-pix_fmt", "rgba", "-"]);
    let frame_bytes = pixels.len() / 3;
    let row = &pixels[2 * frame_bytes + HEIGHT_PX / 2 * width * 4..][..width * 4];
    (0..bands).map(|band| row[(band * BAND_PX + BAND_PX / 2) * 4..][..4].try_into().unwrap()).collect()
}

fn assert_near(found: &[[u8; 4]], wanted: &[[u8; 4]], name: &str) {
    for (found, wanted) in found.iter().zip(wanted) {
        let near = found.iter().zip(wanted).all(|(found, wanted)| found.abs_diff(*wanted) <= 2);
        assert!(near, "{name}: {wanted:?} is shown as {found:?}");
    }
}

#[test]
fn colours_are_shown_as_they_were_painted() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, extra_px) in [("a.mp4", 0), ("odd.mp4", 1), ("a.mov", 0), ("a.mkv", 0), ("a.webm", 0)] {
        let path = folder.path().join(name);
        write(&path, false, &BANDS, extra_px);
        let told =
            probed(&path, "color_range,color_space,color_transfer,color_primaries,pix_fmt,width,height");
        let (width, height) = (BANDS.len() * BAND_PX + 2 * extra_px, HEIGHT_PX + 2 * extra_px);
        for line in [
            "pix_fmt=yuv420p",
            "color_range=tv",
            "color_space=bt709",
            "color_transfer=bt709",
            "color_primaries=bt709",
            &format!("width={width}"),
            &format!("height={height}"),
        ] {
            assert!(told.lines().any(|told| told == line), "{name}: no {line} in {told}");
        }
        assert_near(&decoded(&path, BANDS.len(), width, &[]), &BANDS, name);
    }
}

#[test]
fn transparency_is_kept_where_a_movie_has_it() {
    if !has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let bands = [[0, 160, 0, 255], [200, 30, 30, 128], [20, 40, 220, 0]];
    for (name, decoder) in [("a.mov", "prores"), ("a.webm", "libvpx-vp9")] {
        let path = folder.path().join(name);
        write(&path, true, &bands, 0);
        // ffmpeg's own VP9 decoder drops transparency.
        let mut found = decoded(&path, bands.len(), bands.len() * BAND_PX, &["-c:v", decoder]);
        assert_eq!(found[2][3], 0, "{name}");
        // A fully transparent pixel may have any colour.
        found[2] = bands[2];
        assert_near(&found, &bands, name);
        assert!(probed(&path, "color_space").contains("bt709"), "{name}");
    }
}

#[test]
fn transparency_is_refused_where_a_movie_has_none() {
    assert_eq!(Encoding::of(Path::new("a.png"), true), None);
    assert_eq!(Encoding::of(Path::new("mp4"), false), None);
    for name in ["a.mp4", "a.MKV"] {
        let words = Encoding::of(Path::new(name), true).unwrap().unwrap_err();
        assert!(words.contains(".mov") && words.contains(".webm"), "{words}");
        assert!(Encoding::of(Path::new(name), false).unwrap().is_ok());
    }
}
