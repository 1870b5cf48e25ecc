//! Test files, good and hostile: a small corpus made here, and a large one in the folder that `IMPASTO_CORPUS` names.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::shapes;

/// What should become of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Read without a message.
    Taken,
    /// Read, with a warning.
    Warned,
    /// Refused with an error.
    Refused,
    /// Refused because it exceeds a limit.
    TooMuch,
}

/// A file and what should become of it.
pub struct Case {
    /// A short name; in the large corpus, its id.
    pub name: String,
    /// The scene or model.
    pub file: PathBuf,
    /// What should become of it.
    pub expected: Outcome,
}

/// The folder of the large corpus. Without one, returns `None` and writes to stderr that `test` is skipped in part.
pub fn shared(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        // Not `eprintln!`: the test runner shows its output only for failing tests.
        let _ = writeln!(std::io::stderr(), "skipped in part: {test}: IMPASTO_CORPUS names no folder");
    }
    folder
}

const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";
/// An OBJ triangle with texture coordinates and the material `a` of `case.mtl`.
const TEXTURED: &str =
    "mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";

/// Writes the small corpus into a folder, each case into a folder of its own.
///
/// # Panics
/// When the folder cannot be written.
pub fn made(folder: &Path) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut case = |name: &str, expected: Outcome, files: &[(&str, &[u8])]| {
        let own = folder.join(name);
        std::fs::create_dir_all(&own).expect("a temporary folder can be written");
        for (file, bytes) in files {
            std::fs::write(own.join(file), bytes).expect("a temporary folder can be written");
        }
        cases.push(Case { name: name.to_owned(), file: own.join(files[0].0), expected });
    };
    for (name, expected, text) in models() {
        case(name, expected, &[("case.obj", text.as_slice())]);
    }
    for (name, expected, text) in materials() {
        case(name, expected, &[("case.obj", TEXTURED.as_bytes()), ("case.mtl", text.as_slice())]);
    }
    for (name, expected, bytes) in pictures() {
        let material = b"newmtl a\nmap_Kd picture.png\n";
        let files: [(&str, &[u8]); 3] =
            [("case.obj", TEXTURED.as_bytes()), ("case.mtl", material), ("picture.png", &bytes)];
        case(name, expected, &files);
    }
    for (name, expected, text) in scenes() {
        case(name, expected, &[("case.ron", text.as_slice()), ("cube.obj", CUBE.as_bytes())]);
    }
    cases
}

type Made = (&'static str, Outcome, Vec<u8>);

fn models() -> Vec<Made> {
    use Outcome::{Refused, Taken, Warned};
    let square = |rest: &str| format!("{SQUARE}{rest}").into_bytes();
    let mut star = String::new();
    for corner in 0..64 {
        let (sin, cos) = (f64::from(corner) / 64.0 * std::f64::consts::TAU).sin_cos();
        let radius = if corner % 2 == 0 { 1.0 } else { 0.3 };
        let _ = writeln!(star, "v {} {} 0", cos * radius, sin * radius);
    }
    star += "f";
    (1..=64).for_each(|corner| star += &format!(" {corner}"));
    vec![
        ("cube", Taken, CUBE.into()),
        ("sphere", Taken, sphere().into_bytes()),
        ("windows_line_ends", Taken, CUBE.replace('\n', "\r\n").into_bytes()),
        ("byte_order_mark", Taken, [b"\xef\xbb\xbf", CUBE.as_bytes()].concat()),
        ("counted_from_the_end", Taken, square("f -4 -3 -2 -1\n")),
        ("star", Taken, star.into_bytes()),
        ("latin1_comment", Taken, [b"# caf\xe9\n", CUBE.as_bytes()].concat()),
        ("header_lies", Taken, [b"# 10000000 vertices\n", CUBE.as_bytes()].concat()),
        ("saddle", Taken, CUBE.replace("v 1 1 1\n", "v 1 1 2\n").into_bytes()),
        ("one_name_three_times", Taken, square("g a\nf 1 2 3\ng b\nf 1 3 4\ng a\nf 1 2 4\n")),
        ("library_is_missing", Warned, square("mtllib gone.mtl\nf 1 2 3 4\n")),
        ("library_from_above", Warned, square("mtllib ../../../etc/passwd\nf 1 2 3 4\n")),
        ("library_without_end", Warned, square("mtllib /dev/zero\nf 1 2 3 4\n")),
        ("normals_of_no_length", Warned, square("vn 0 0 0\nf 1//1 2//1 3//1 4//1\n")),
        ("face_of_one_corner", Warned, square("f 1 2 3 4\nf 1\n")),
        ("not_a_number", Refused, square("v nan 0 0\nf 1 2 3 5\n")),
        ("infinite", Refused, square("v 0 inf 0\nf 1 2 3 5\n")),
        ("too_large_for_its_box", Refused, b"v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n".into()),
        ("two_coordinates", Refused, b"v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n".into()),
        ("fortran_exponent", Refused, square("v 1D0 0 0\nf 1 2 3 5\n")),
        ("corner_past_the_end", Refused, square("f 1 2 9\n")),
        ("corner_of_31_digits", Refused, square("f 1 2 1000000000000000000000000000000\n")),
        ("corner_in_fractions", Refused, square("f 1 2 3.5\n")),
        ("corner_zero", Refused, square("f 0 1 2\n")),
        ("empty", Refused, Vec::new()),
        ("comments_alone", Refused, b"# nothing\n# at all\n".into()),
        ("points_alone", Refused, SQUARE.into()),
        ("lines_alone", Refused, square("l 1 2 3 4\n")),
        ("no_area", Refused, b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".into()),
        (
            "bytes_at_random",
            Refused,
            (0..4000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 21) as u8).collect(),
        ),
    ]
}

fn materials() -> Vec<Made> {
    use Outcome::{Taken, Warned};
    let utf16: Vec<u8> = "\u{feff}newmtl a\nKd 1 0 0\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    vec![
        ("mtl_plain", Taken, b"newmtl a\nKd 0.8 0.2 0.1\n".into()),
        ("mtl_mark_and_windows_line_ends", Taken, b"\xef\xbb\xbfnewmtl a\r\nKd 0.8 0.2 0.1\r\n".into()),
        ("mtl_two_channels", Warned, b"newmtl a\nKd 0.8 0.2\n".into()),
        ("mtl_infinite", Warned, b"newmtl a\nKd inf 0 0\n".into()),
        ("mtl_negative", Warned, b"newmtl a\nKd -1 0 0\n".into()),
        ("mtl_empty", Warned, Vec::new()),
        ("mtl_utf16", Warned, utf16),
        ("mtl_picture_is_missing", Warned, b"newmtl a\nmap_Kd gone.png\n".into()),
        ("mtl_picture_without_a_name", Warned, b"newmtl a\nmap_Kd\n".into()),
    ]
}

fn pictures() -> Vec<Made> {
    use Outcome::{Taken, TooMuch, Warned};
    let good = png([16, 16], true);
    let cut = good[..good.len() / 2].to_vec();
    vec![
        ("picture_good", Taken, good),
        ("picture_cut", Warned, cut),
        ("picture_empty", Warned, Vec::new()),
        ("picture_of_words", Warned, b"<svg></svg>".into()),
        ("picture_claims_60000", TooMuch, png([60_000, 60_000], false)),
    ]
}

/// A PNG of this size; only its header if `with_pixels` is false.
fn png(size_px: [u32; 2], with_pixels: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size_px[0], size_px[1]);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a header");
    if with_pixels {
        let channel = |index: u32| (index * 37 % 200) as u8 + 20;
        let pixels: Vec<u8> = (0..size_px[0] * size_px[1] * 3).map(channel).collect();
        writer.write_image_data(&pixels).expect("pixels");
        writer.finish().expect("an end");
    } else {
        // Dropping the writer would write an end, and only the header is wanted.
        std::mem::forget(writer);
    }
    bytes
}

fn scenes() -> Vec<Made> {
    use Outcome::{Refused, Taken, TooMuch, Warned};
    let scene = |fields: &str| {
        format!("(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), {fields})\n")
            .into_bytes()
    };
    let cube = |more: &str| scene(&format!("objects: [(name: \"a\", mesh: \"cube.obj\"{more})]"));
    let utf16 = String::from_utf8_lossy(&cube("")).encode_utf16().flat_map(u16::to_le_bytes).collect();
    vec![
        ("ron_plain", Taken, cube("")),
        ("ron_no_particles", Warned, cube(", particles: 0")),
        ("ron_too_many_particles", TooMuch, cube(", particles: 18446744073709551615")),
        (
            "ron_frames_1e12",
            TooMuch,
            scene("timeline: (last: 1000000000000), objects: [(name: \"a\", mesh: \"cube.obj\")]"),
        ),
        ("ron_typo", Refused, cube(", partcles: 5")),
        ("ron_mesh_is_missing", Refused, scene("objects: [(name: \"a\", mesh: \"gone.obj\")]")),
        ("ron_mesh_from_above", Refused, scene("objects: [(name: \"a\", mesh: \"../cube/case.obj\")]")),
        ("ron_mesh_without_end", Refused, scene("objects: [(name: \"a\", mesh: \"/dev/zero\")]")),
        ("ron_comment_alone", Refused, b"// nothing\n".into()),
        ("ron_comment_without_end", Refused, [b"/*", cube("").as_slice()].concat()),
        ("ron_string_without_end", Refused, scene("objects: [(name: \"a")),
        ("ron_deep", Refused, [b"[".repeat(100_000), b"]".repeat(100_000)].concat()),
        ("ron_deep_comment", Refused, b"/*".repeat(100_000)),
        ("ron_number_of_many_digits", Refused, scene(&format!("seed: {}", "9".repeat(100_000)))),
        ("ron_of_zeros", Refused, vec![0; 1000]),
        ("ron_utf16", Refused, utf16),
        ("ron_json", Refused, b"{\"version\": 1}\n".into()),
    ]
}

/// A sphere with texture coordinates and normals.
fn sphere() -> String {
    let mesh = shapes::sphere(16, 8);
    let mut text = String::new();
    for at in &mesh.positions {
        let _ = writeln!(text, "v {} {} {}", at.x, at.y, at.z);
    }
    for at in &mesh.uvs {
        let _ = writeln!(text, "vt {} {}", at.x, at.y);
    }
    for at in &mesh.normals {
        let _ = writeln!(text, "vn {} {} {}", at.x, at.y, at.z);
    }
    for [a, b, c] in mesh.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + 1)) {
        let _ = writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
    }
    text
}
