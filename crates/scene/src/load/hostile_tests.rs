//! Tests that broken scenes never break the reader. Thousands are read, the same in every run: each gives a scene, or a
//! problem with its position.

use super::*;

const SEED: &str = r##"#![enable(implicit_some)]
( // a scene that has everything
    version: 1, size: (1280, 720), seed: 7, background: "#e4dccb",
    timeline: (fps: 24, first: 0, last: 119), reference: Frame(0),
    camera: (
        lens: Perspective(fov_y_deg: 32, near: 0.05, far: 100),
        keys: [(frame: 0, eye: (0, 1.1, 4), target: (0, 0.5, 0), ease: Smooth), (frame: 9, eye: (1, 1, 4), target: (0, 0, 0), roll_deg: 9)],
    ),
    lights: [(name: "window", kind: Sun, direction: (-0.5, -1, -0.6)), (name: "sky", kind: Ambient, ground: "#321")],
    objects: [
        (name: "äpple", mesh: r#"m\a.obj"#, particles: 458, scale: (1, 2.0, 1), material: (color: "#b3262a"),
         keys: [(frame: 0), (frame: 60, translation: (0.8, 0, 0), rotation_deg: (0, 0, -140), ease: Step)]),
        /* a /* nested */ comment */ (name: "leaf", mesh: "m.obj", group: "leaf", parent: "äpple", up: Z),
    ],
    strokes: (preset: "oil study", length_px: Some(30)),
    regions: [(name: "r", on: Group("leaf", "g"), direction: Around((0, 1, 0)), strokes: (layer: -1, flatness: 0.5)),
        (name: "s", turn_deg: 7, hidden: true, locked: true, color: "#008df9", on: Several("leaf", [Whole, Flood((at: (0, 0, 1), normal: (0, 0, 1)), 30), Dabs([(at: (0, 0, 1), normal: (0, 0, 1), radius: 1, take_away: true)])]),
         guides: [(mode: Smooth, points: [(at: (0, 0, 1), normal: (0, 0, 1), turn_deg: 30), (at: (1, 0, 1), normal: (0, 0, 1))], radius: 1)],
         amounts: [(of: Width, object: Some("leaf"), dabs: [(at: (0, 0, 1), normal: (0, 0, 1), radius: 1, by: 1.5)])])],
    touches: [(name: "glint", on: "leaf", points: [(at: (0, 0, 1), normal: (0, 0, 1)), (at: (1, 0, 1), normal: (0, 0, 1))], width_px: 20, color: Some("#fff2cc"), opacity: 0.9, taper: 0.5, brush: Some("round"))],
    style: RotatingStrokes(solver: Tangent, underpainting: false),
)
"##;

/// Texts to break the scene with: they replace parts of it, or are put between its parts.
const NASTY: [&str; 44] = [
    "",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "'",
    "r#\"",
    "/*",
    "*/",
    "//",
    "#",
    "#!",
    "\\",
    "\0",
    "\u{feff}",
    "0",
    "-1",
    "1e999",
    "NaN",
    "inf",
    "-inf",
    "18446744073709551616",
    "99999999999999999999999999999999999999999",
    "0x",
    "1_000",
    "--",
    "1e-320",
    "Some(",
    "None",
    "()",
    "Some(Some(3))",
    "\"\\u{110000}\"",
    "\u{202e}",
    "🎨",
    "true",
    "\"\"",
    "[[[[[[[[",
    "unknown: 3,",
    "version: 2,",
];

/// A small random number generator (xorshift), so that every run makes the same cases.
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

/// Cuts a text into words, numbers and single other characters.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    let mut was_word = false;
    for character in text.chars() {
        let is_word = character.is_alphanumeric() || "._-".contains(character);
        match pieces.last_mut() {
            Some(last) if is_word && was_word => last.push(character),
            _ => pieces.push(character.to_string()),
        }
        was_word = is_word;
    }
    pieces
}

fn mutate(dice: &mut Dice) -> String {
    let mut pieces = pieces(SEED);
    for _ in 0..=dice.below(3) {
        let (at, other) = (dice.below(pieces.len()), dice.below(pieces.len()));
        match dice.below(6) {
            0 => pieces[at] = NASTY[dice.below(NASTY.len())].to_owned(),
            1 => pieces.insert(at, NASTY[dice.below(NASTY.len())].to_owned()),
            2 => drop(pieces.drain(at..(at + dice.below(9)).min(pieces.len()))),
            3 => pieces.swap(at, other),
            4 => pieces[at] = pieces[other].clone(),
            _ => {
                let copy = pieces[at..(at + 1 + dice.below(40)).min(pieces.len())].to_vec();
                drop(pieces.splice(other..other, copy));
            }
        }
    }
    pieces.concat()
}

/// Asserts that a text is a scene, or is refused with a position and a way to mend it. A scene that passes the checks
/// must also read back equal once it is saved, and have finite poses. Returns whether the text was taken as a scene.
fn assert_handled(text: &str) -> bool {
    let path = Path::new("s.ron");
    let lines = text.matches('\n').count() + 1;
    let assert_complete = |problem: &Problem| {
        let place = problem.place.unwrap_or_else(|| panic!("no place: {problem}\n{text}"));
        let is_inside = place.line <= lines && place.column <= text.len() + 1;
        assert!(is_inside, "a place outside the text: {problem}\n{text}");
        assert!(!problem.mend.is_empty() && !problem.message.is_empty(), "no mend: {problem}\n{text}");
        assert!(problem.to_string().len() < 900, "{} bytes:\n{problem}", problem.to_string().len());
    };
    let parsed = match parse::parse(path, text.strip_prefix('\u{feff}').unwrap_or(text)) {
        Ok(parsed) => parsed,
        Err(Report(problems)) => {
            assert!(problems.iter().any(|problem| problem.severity.is_fatal()), "nothing fatal\n{text}");
            problems.iter().for_each(assert_complete);
            return false;
        }
    };
    let Parsed { scene, located } = parsed;
    let findings = check::check(&scene);
    let is_good = !findings.iter().any(|finding| finding.severity.is_fatal());
    let locator = FieldLocator { path, written: Some(&located), applied: &[], edited: None };
    findings.into_iter().for_each(|finding| assert_complete(&locator.problem(finding)));
    if is_good {
        let saved = crate::save::to_ron(&scene);
        assert_eq!(parse(path, &saved).as_ref(), Ok(&scene), "{saved}");
        for frame in [-1e9, 0.0, 4.5, 1e9] {
            assert!(crate::motion::camera_at(&scene, frame).view_from_world().is_finite(), "{text}");
            assert!(crate::motion::poses_at(&scene, frame).iter().all(glam::DAffine3::is_finite), "{text}");
        }
    }
    true
}

#[test]
fn the_seed_is_good() {
    let scene = parse(Path::new("s.ron"), SEED).unwrap();
    assert_eq!(check::check(&scene), []);
}

#[test]
fn mutated_scenes_are_taken_or_refused_with_a_place() {
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15);
    let taken = (0..6600).filter(|_| assert_handled(&mutate(&mut dice))).count();
    // Both outcomes must occur often enough to be tested.
    assert!((300..5000).contains(&taken), "{taken} of 6600 taken");
}

#[test]
fn scenes_cut_off_anywhere_are_refused_with_a_place() {
    let end = SEED.rfind(')').unwrap();
    for at in (0..=end).filter(|&at| SEED.is_char_boundary(at)) {
        assert!(!assert_handled(&SEED[..at]), "taken, cut at {at}");
    }
}

#[test]
fn any_value_may_come_from_the_command_line() {
    let fields = [
        "size",
        "seed",
        "background",
        "timeline.fps",
        "reference",
        "camera.keys[0].eye",
        "camera.keys[1]",
        "lights",
        "objects.leaf.parent",
        "objects[0].scale[1]",
        "objects[0]",
        "strokes",
        "regions.r.on",
        "style.solver",
        "new",
        "",
        "..",
        "[0]",
        "camera.keys[99999999999999999999]",
        "objects[",
        "a[0].b",
        "style.Reference.x",
        "Style",
        "objects.äpple.name",
    ];
    for field in fields {
        for value in NASTY.iter().chain(&fields) {
            let parsed = parse::parse(Path::new("s.ron"), SEED).unwrap();
            let sets = [(field.to_owned(), (*value).to_owned())];
            if let Err(Report(problems)) = overrides::apply(parsed, &sets) {
                assert!(!problems.is_empty());
                for problem in problems {
                    assert!(problem.path.to_string_lossy().starts_with("--set "), "{problem}");
                    assert!(!problem.mend.is_empty(), "{problem}");
                }
            }
        }
    }
}

#[test]
fn random_bytes_are_no_scene() {
    let mut dice = Dice(42);
    for _ in 0..2000 {
        let mut bytes = SEED.as_bytes().to_vec();
        for _ in 0..=dice.below(4) {
            let at = dice.below(bytes.len());
            bytes[at] = dice.below(256) as u8;
        }
        match source::decode(Path::new("s.ron"), &bytes) {
            Ok(text) => drop(assert_handled(text)),
            Err(problem) => assert!(problem.place.is_some() && !problem.mend.is_empty(), "{problem}"),
        }
    }
}
