//! Tests of the command line as a user meets it: exit codes, messages, and files that are written whole or not at all.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use impasto_tests::command::impasto;

const CUBE: &str = "\
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

const SCENE: &str = "#![enable(implicit_some)]
(
    version: 1,
    size: (160, 90),
    timeline: (fps: 24, first: 0, last: 2),
    camera: (keys: [
        (frame: 0, eye: (1, 1.5, 6), target: (0, 0, 0)),
        (frame: 2, eye: (1, 1.5, 6), target: (0, 0, 0), roll_deg: 30),
    ]),
    objects: [(name: \"cube, \\\"big\\\"\", mesh: \"cube.obj\")],
    strokes: (length_px: 12, width_px: 4, angle_jitter_deg: 0),
)
";

/// A folder with the mesh of a cube, and a scene that shows it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
        std::fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs the command in the folder, with no display.
    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(impasto());
        command.args(arguments).current_dir(self.0.path());
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap()
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or(-1)
}

fn words(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn is_whole_png(path: &Path) -> bool {
    let bytes = std::fs::read(path).unwrap();
    bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.ends_with(b"IEND\xaeB`\x82")
}

/// A file that ends as a PNG file does, and that no command has written.
const MINE: &[u8] = b"mine\0\0\0\0IEND\xae\x42\x60\x82";

#[test]
fn render_writes_whole_frames_by_their_pattern() {
    let folder = Folder::new();
    let output = folder.run(&["render", "scene.ron", "-o", "out/f_##.png", "--contact-sheet"]);
    assert_eq!(code(&output), 0, "{}", words(&output.stderr));
    assert_eq!(words(&output.stdout), "", "stdout is for data");
    assert_eq!(folder.names("out"), ["f_00.png", "f_01.png", "f_02.png", "f_sheet.png"]);
    for name in folder.names("out") {
        assert!(is_whole_png(&folder.path("out").join(name)));
    }
    // Existing frames stay; those that are missing or cut short are rendered.
    std::fs::write(folder.path("out/f_01.png"), MINE).unwrap();
    std::fs::remove_file(folder.path("out/f_02.png")).unwrap();
    let first = std::fs::read(folder.path("out/f_00.png")).unwrap();
    std::fs::write(folder.path("out/f_00.png"), &first[..first.len() - 1]).unwrap();
    let output =
        folder.run(&["render", "scene.ron", "-o", "out/f_##.png", "--skip-existing", "--json", "-q"]);
    assert_eq!(code(&output), 0);
    assert_eq!(std::fs::read(folder.path("out/f_01.png")).unwrap(), MINE);
    assert_eq!(std::fs::read(folder.path("out/f_00.png")).unwrap(), first);
    assert!(is_whole_png(&folder.path("out/f_02.png")));
    let events: Vec<serde_json::Value> =
        words(&output.stdout).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let frames: Vec<_> =
        events.iter().filter(|event| event["event"] == "frame").map(|event| &event["frame"]).collect();
    assert_eq!(frames, [0, 2]);
}

/// Programs hear of each frame of an animation as they hear of single frames; where the picture itself goes to standard
/// output, lines for programs are refused.
#[test]
fn frames_of_one_file_are_reported_too() {
    let folder = Folder::new();
    std::fs::write(folder.path("scene.ron"), SCENE).unwrap();
    let lines = ["--json", "--progress", "openjd", "-q"];
    let output = folder.run(&[&["render", "scene.ron", "-o", "all.png", "--apng"], &lines[..]].concat());
    assert_eq!(code(&output), 0, "{}", words(&output.stderr));
    let said = words(&output.stdout);
    let events: Vec<serde_json::Value> =
        said.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    assert_eq!(events[0]["event"], "context");
    let frames: Vec<String> =
        events[1..].iter().map(|event| format!("{} {}", event["frame"], event["path"])).collect();
    assert_eq!(frames, [0, 1, 2].map(|frame| format!("{frame} \"all.png\"")));
    let progress: Vec<&str> = said.lines().filter(|line| line.starts_with("openjd_progress")).collect();
    assert_eq!(progress, ["openjd_progress: 33.3", "openjd_progress: 66.7", "openjd_progress: 100.0"]);
    for refused in [&lines[..1], &lines[1..3]] {
        let output = folder.run(&[&["render", "scene.ron", "-o", "-", "--frames", "0"], refused].concat());
        assert_eq!(code(&output), 2, "{}", words(&output.stderr));
        assert!(output.stdout.is_empty() && words(&output.stderr).contains("--json"));
    }
}

/// Whether one thread paints the frames or three do, the files have the same bytes and frames are reported in order.
#[test]
fn frames_do_not_depend_on_how_many_draw_them() {
    let folder = Folder::new();
    std::fs::write(folder.path("scene.ron"), SCENE.replace("last: 2)", "last: 13)")).unwrap();
    let render = |threads: &str, pattern: &str| {
        let output = folder.run(&[
            "render",
            "scene.ron",
            "-o",
            pattern,
            "--json",
            "-q",
            "--contact-sheet",
            "--threads",
            threads,
            "--frames",
            "0-13,3",
            "--skip-existing",
        ]);
        assert_eq!(code(&output), 0, "{}", words(&output.stderr));
        let events = words(&output.stdout);
        let events = events.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
        events
            .filter(|event| event["event"] == "frame")
            .map(|event| event["frame"].clone())
            .collect::<Vec<_>>()
    };
    std::fs::create_dir(folder.path("three")).unwrap();
    std::fs::write(folder.path("three/f_05.png"), MINE).unwrap();
    assert_eq!(render("1", "one/f_##.png"), (0..14).collect::<Vec<_>>());
    assert_eq!(render("3", "three/f_##.png"), (0..14).filter(|&frame| frame != 5).collect::<Vec<_>>());
    assert_eq!(folder.names("one"), folder.names("three"));
    for name in folder.names("one") {
        let [one, three] = ["one", "three"].map(|from| std::fs::read(folder.path(from).join(&name)).unwrap());
        // Frame 5 of `three` was there before, so it and the sheet may differ.
        assert!(name == "f_sheet.png" || name == "f_05.png" || one == three, "{name}");
    }
    // Frames that were kept are on the sheet, too.
    let sheet = || std::fs::read(folder.path("one/f_sheet.png")).unwrap();
    let before = sheet();
    assert_eq!(render("1", "one/f_##.png"), Vec::<u64>::new());
    assert!(sheet() == before);
}

#[test]
fn a_picture_streams_and_an_animation_is_one_file() {
    let folder = Folder::new();
    let output = folder.run(&["render", "scene.ron", "--frames", "1", "-o", "-"]);
    assert_eq!(code(&output), 0, "{}", words(&output.stderr));
    assert!(output.stdout.starts_with(b"\x89PNG") && output.stdout.ends_with(b"IEND\xaeB`\x82"));
    let output = folder.run(&["render", "scene.ron", "--apng", "-o", "all.png"]);
    assert_eq!(code(&output), 0, "{}", words(&output.stderr));
    let bytes = std::fs::read(folder.path("all.png")).unwrap();
    assert!(is_whole_png(&folder.path("all.png")) && bytes.windows(4).any(|word| word == b"acTL"));
    assert_eq!(
        code(&folder.run(&["render", "scene.ron", "-o", "-"])),
        2,
        "three frames do not fit one stream"
    );
}

#[test]
fn a_new_scene_renders_as_its_model_does() {
    let folder = Folder::new();
    assert_eq!(code(&folder.run(&["new", "cube.obj", "-o", "made.ron"])), 0);
    assert_eq!(code(&folder.run(&["new", "cube.obj", "-o", "made.ron"])), 3, "it is there already");
    assert_eq!(code(&folder.run(&["new", "cube.obj", "-o", "made.ron", "--force"])), 0);
    for (from, to) in [("cube.obj", "a.png"), ("made.ron", "b.png")] {
        let output = folder.run(&["render", from, "-o", to, "--size", "160x90", "--frames", "0"]);
        assert_eq!(code(&output), 0, "{}", words(&output.stderr));
    }
    let pixels = |name: &str| {
        let decoder =
            png::Decoder::new(std::io::BufReader::new(std::fs::File::open(folder.path(name)).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    };
    assert!(pixels("a.png") == pixels("b.png"));
}

#[test]
fn wrong_input_ends_with_3_a_place_and_a_mend() {
    let folder = Folder::new();
    let typo = SCENE.replace("length_px", "lenght_px");
    std::fs::write(folder.path("typo.ron"), typo).unwrap();
    let output = folder.run(&["render", "typo.ron", "-o", "out/x.png"]);
    assert_eq!(code(&output), 3);
    let said = words(&output.stderr);
    assert!(said.contains("typo.ron:11:15: error:") && said.contains("length_px"), "{said}");
    assert!(!folder.path("out").exists(), "nothing is written");

    let output = folder.run(&["check", "scene.ron", "typo.ron", "--json"]);
    assert_eq!(code(&output), 3);
    let problem: serde_json::Value =
        serde_json::from_str(words(&output.stdout).lines().next().unwrap()).unwrap();
    assert_eq!((&problem["line"], &problem["severity"]), (&11.into(), &"error".into()));
    assert_eq!(code(&folder.run(&["check", "scene.ron"])), 0);
    assert_eq!(code(&folder.run(&["render", "nothere.ron"])), 3);
}

#[test]
fn what_does_not_fit_into_memory_is_refused_with_a_mend() {
    let folder = Folder::new();
    let render = |memory: &str| {
        let set = "objects[0].particles=200000";
        folder.run(&[
            "render",
            "scene.ron",
            "--frames",
            "0",
            "-o",
            "a.png",
            "--set",
            set,
            "--memory",
            memory,
            "-v",
        ])
    };
    let refused = render("20M");
    let said = words(&refused.stderr);
    assert_eq!(code(&refused), 3, "{said}");
    assert!(
        said.contains("and 20 MiB may be taken")
            && said.contains("fewer than its 2")
            && said.contains("--memory"),
        "{said}"
    );
    assert!(!folder.path("a.png").exists());
    let fits = render("1.5GiB");
    assert_eq!(code(&fits), 0, "{}", words(&fits.stderr));
    // Each step is printed with its peak memory.
    let said = words(&fits.stderr);
    let step = said.lines().find(|line| line.trim_start().starts_with("sampling")).unwrap_or_default();
    assert!(step.contains(" ms") && (!cfg!(target_os = "linux") || step.ends_with("MiB")), "{said}");
    assert_eq!(code(&render("much")), 2);
}

#[test]
fn outputs_are_refused_before_anything_is_drawn() {
    let folder = Folder::new();
    std::fs::write(folder.path("file"), "in the way").unwrap();
    let output = folder.run(&["render", "scene.ron", "-o", "file/f_####.png"]);
    assert_eq!(code(&output), 3, "{}", words(&output.stderr));
    assert!(words(&output.stderr).contains("-o"), "{}", words(&output.stderr));
    for input in ["scene.ron", "./cube.obj"] {
        let output = folder.run(&["render", "scene.ron", "-o", input, "--frames", "0"]);
        assert_eq!(code(&output), 3, "{input}");
    }
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    let long = format!("{}.png", "x".repeat(300));
    for (output, why) in [("folder.png", "it is a folder"), (long.as_str(), "too long")] {
        let output = folder.run(&["render", "scene.ron", "-o", output, "--frames", "0"]);
        let words = words(&output.stderr);
        assert!(code(&output) == 3 && words.contains(why) && words.lines().count() == 1, "{words}");
    }
    assert_eq!(std::fs::read_to_string(folder.path("scene.ron")).unwrap(), SCENE);
    assert_eq!(std::fs::read_to_string(folder.path("cube.obj")).unwrap(), CUBE);
    assert_eq!(folder.names("."), ["cube.obj", "file", "folder.png", "scene.ron"]);
}

#[test]
fn what_takes_more_memory_than_the_process_may_have_is_refused_and_does_not_end_it() {
    let folder = Folder::new();
    let run = |arguments: &str| {
        let line = format!("ulimit -v 1500000; exec {} {arguments}", impasto().display());
        Command::new("sh").current_dir(folder.path(".")).args(["-c", &line]).output().unwrap()
    };
    let limited = |arguments: &str| run(&format!("render scene.ron -o f.png {arguments}"));
    let good = limited("--frames 0");
    assert_eq!(code(&good), 0, "{}", words(&good.stderr));
    for (arguments, says) in [
        (
            "--frames 0 --size 8192x8192",
            "a picture of 8192x8192 takes about 4800 MiB while it is drawn, and ",
        ),
        ("--frames 0 --set objects[0].particles=16000000", "MiB may be taken"),
        // `--memory` does not lift the limit of the process.
        ("--frames 0 --set objects[0].particles=16000000 --memory 8G", "MiB may be taken"),
    ] {
        let output = limited(arguments);
        let words = words(&output.stderr);
        assert!(code(&output) == 3 && words.contains(says) && words.lines().count() == 1, "{words}");
    }
    let strokes = run("strokes scene.ron -o s.csv --size 8192x8192");
    assert_eq!(code(&strokes), 3, "{}", words(&strokes.stderr));
    // `serve` refuses the order, and goes on.
    let order = r#"{"command":"render","id":1,"frames":"0","output":"f.exr","size":[8192,8192]}"#;
    let served = run(&format!("serve scene.ron <<'END'\n{order}\n{{\"command\":\"quit\"}}\nEND\n"));
    let said = words(&served.stdout);
    let refusal = said.lines().find(|line| line.contains(r#""event":"error""#)).unwrap_or_default();
    assert!(refusal.contains("8192x8192") && refusal.contains("MiB are left"), "{said}");
    assert_eq!(code(&served), 0, "{said}");
}

/// A folder with a frame's name stands for a full disk, or for a network share that goes away.
#[test]
fn a_frame_that_cannot_be_written_ends_the_render_and_those_before_it_stay() {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.path("out/f_0002.png")).unwrap();
    let output = folder.run(&["render", "scene.ron", "-o", "out/f_####.png", "--frames", "0-3"]);
    let words = words(&output.stderr);
    assert_eq!((code(&output), words.lines().count()), (5, 1), "{words}");
    assert!(
        words.contains("frame 2: out/f_0002.png: ") && words.contains("2 frames are done and whole"),
        "{words}"
    );
    assert_eq!(folder.names("out"), ["f_0000.png", "f_0001.png", "f_0002.png"]);
}

#[test]
fn a_wrong_command_line_ends_with_2() {
    let folder = Folder::new();
    for arguments in [
        &["render"][..],
        &["render", "scene.ron", "--frames", "1-"],
        &["render", "scene.ron", "--frames", "0-1000000000000"],
        &["render", "scene.ron", "--size", "0x9"],
        &["render", "scene.ron", "--size", "60000x60000"],
        &["render", "scene.ron", "-o", "picture.jpg"],
        &["render", "scene.ron", "--set", "nothing"],
        &["paint", "scene.ron"],
    ] {
        assert_eq!(code(&folder.run(arguments)), 2, "{arguments:?}");
    }
    assert_eq!(code(&folder.run(&["--help"])), 0);
}

/// The angle in degrees of each stroke, by id, layer and length, from CSV.
fn angles(text: &str) -> BTreeMap<(String, String), f64> {
    // The object's name holds a comma and quotes, so fields are counted from the end.
    let row = |line: &str| -> ((String, String), f64) {
        let fields: Vec<&str> = line.rsplitn(16, ',').collect();
        let id = line.split(',').next().unwrap().to_owned();
        // All numbers but the id stand in the last fifteen fields.
        for number in &fields[..15] {
            assert!(number.parse::<f64>().is_ok_and(f64::is_finite), "{number:?} in {line}");
        }
        // From the end: bend 0, taper 1, rank 2, facing 3, b g r 4-6, kappa 7, alpha 8, width 9, length 10, angle 11.
        let layer = fields[15].rsplit(',').next().unwrap();
        ((id, format!("{layer} {}", fields[10])), fields[11].parse().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn strokes_are_listed_as_they_are_drawn() {
    let folder = Folder::new();
    let csv = |frame: &str| words(&folder.run(&["strokes", "scene.ron", "--frame", frame]).stdout);
    let (before, after) = (csv("0"), csv("2"));
    let header = "id,object,region,layer,x_px,y_px,depth,angle_deg,length_px,width_px,alpha,kappa,r,g,b,facing,rank,taper,bend_deg";
    assert_eq!(before.lines().next(), Some(header));
    assert!(before.lines().nth(1).unwrap().contains("\"cube, \"\"big\"\"\""));
    let (before, after) = (angles(&before), angles(&after));
    let mut shared = 0;
    // Strokes of the contour are left out: they lie along the outline, which follows the view.
    for (key, angle) in before.iter().filter(|((_, layer), _)| !layer.starts_with("contour")) {
        let Some(turned) = after.get(key) else { continue };
        let off = (turned - (angle - 30.0)).rem_euclid(360.0);
        assert!(off.min(360.0 - off) <= 1e-3, "{key:?}: {angle} to {turned}");
        shared += 1;
    }
    assert!(shared >= 100, "{shared} strokes in both");

    let json = folder.run(&["strokes", "scene.ron", "--format", "json", "-o", "s.json"]);
    assert_eq!(code(&json), 0);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("s.json")).unwrap()).unwrap();
    assert_eq!(json["strokes"].as_array().unwrap().len(), csv("0").lines().count() - 1);
    let svg = words(&folder.run(&["strokes", "scene.ron", "--format", "svg"]).stdout);
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    let groups: Vec<&str> = svg.lines().filter(|line| line.starts_with("<g id=")).collect();
    let distinct: std::collections::BTreeSet<&&str> = groups.iter().collect();
    assert!(!groups.is_empty() && distinct.len() == groups.len(), "{groups:?}");
    let shapes: Vec<&str> = svg.lines().filter(|line| line.starts_with("<path ")).collect();
    assert_eq!(shapes.len(), csv("0").lines().count() - 1, "a shape per stroke");
    assert!(shapes.iter().all(|shape| shape.ends_with("/>") && shape.matches('"').count() % 2 == 0));
}

#[test]
fn info_doctor_and_completions_answer() {
    let folder = Folder::new();
    let info: serde_json::Value =
        serde_json::from_slice(&folder.run(&["info", "cube.obj", "--json"]).stdout).unwrap();
    assert_eq!(info["meshes"][0]["polygons"], 6);
    assert!(info["particles"].as_u64().unwrap() > 100);
    let doctor = folder.run(&["doctor", "--json"]);
    assert_eq!(code(&doctor), 0, "{}", words(&doctor.stdout));
    for line in words(&doctor.stdout).lines() {
        let found: serde_json::Value = serde_json::from_str(line).unwrap();
        // There is no display here, so no window; doctor does not fail for that.
        let (name, works) = if found["driver"].is_string() { ("works", true) } else { ("window", false) };
        assert_eq!(found[name], works, "{line}");
    }
    assert!(
        words(&folder.run(&["doctor"]).stdout).contains("window: none: neither WAYLAND_DISPLAY nor DISPLAY")
    );
    for shell in ["bash", "zsh", "fish"] {
        assert!(words(&folder.run(&["completions", shell]).stdout).contains("impasto"), "{shell}");
    }
    // A reader that stops reading is no error, but a full device is.
    for (command, wanted) in [("completions zsh", "0"), ("info cube.obj", "0"), ("check cube.obj", "0")] {
        let piped = format!("{} {command} | true; echo ${{PIPESTATUS[0]}}", impasto().display());
        let output =
            Command::new("bash").current_dir(folder.path(".")).args(["-c", &piped]).output().unwrap();
        let said = (words(&output.stdout), words(&output.stderr));
        assert_eq!((said.0.trim(), said.1), (wanted, String::new()), "{command}");
        let full = format!("{} {command} > /dev/full", impasto().display());
        let output = Command::new("bash").current_dir(folder.path(".")).args(["-c", &full]).output().unwrap();
        assert_eq!(code(&output), 1, "{command}");
        assert!(words(&output.stderr).contains("No space left on device"), "{command}");
    }
}

#[test]
fn edit_says_what_is_missing() {
    let folder = Folder::new();
    std::fs::write(folder.path("chair.fbx"), "").unwrap();
    for (arguments, exit, message) in [
        (&["edit", "gone.ron"][..], 3, "gone.ron is not there"),
        (&["edit", "chair.fbx"], 3, "export it as glTF or OBJ"),
        (&["edit", "scene.ron", "--driver", "voodoo"], 2, "software"),
        (&["edit"], 4, "neither DISPLAY nor WAYLAND_DISPLAY is set"),
        (&["edit", "scene.ron"], 4, "`impasto render` needs no display"),
    ] {
        let output = folder.run(arguments);
        let error = words(&output.stderr);
        assert_eq!(code(&output), exit, "{arguments:?}: {error}");
        assert!(error.contains(message) && !error.contains("panicked"), "{arguments:?}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_whole_frames_only() {
    let folder = Folder::new();
    let long = SCENE.replace("last: 2)", "last: 5000)");
    std::fs::write(folder.path("long.ron"), long).unwrap();
    let mut child = Command::new(impasto())
        .args(["render", "long.ron", "-o", "out/f_####.png", "-q"])
        .current_dir(folder.0.path())
        .spawn()
        .unwrap();
    for _ in 0..600 {
        if folder.path("out/f_0002.png").exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let names = folder.names("out");
    assert!(names.len() >= 3 && names.len() < 5000, "{} frames", names.len());
    for name in names {
        assert!(name.starts_with("f_") && is_whole_png(&folder.path("out").join(&name)), "{name}");
    }
}

/// Interrupts work even if a shell has started the command with interrupts (Ctrl-C) ignored, as it does for a job in
/// the background.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_reading_and_preparing_at_once_and_leaves_nothing() {
    use std::os::unix::process::ExitStatusExt as _;
    let folder = Folder::new();
    // With so many particles, preparing takes far longer than sending the signals.
    let many = "objects[0].particles=2000000";
    for arguments in [
        &["render", "scene.ron", "--set", many, "-o", "a.png", "--frames", "0"][..],
        &["render", "scene.ron", "--set", many, "-o", "a.png", "--apng"],
        &["strokes", "scene.ron", "--set", many, "-o", "a.csv"],
        &["measure", "scene.ron", "--set", many, "--plot", "a.svg", "-q"],
    ] {
        let mut child = Command::new("sh")
            .args(["-c", "trap '' INT; echo ready; exec \"$@\"", "sh"])
            .arg(impasto())
            .args(arguments)
            .current_dir(folder.0.path())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut ready = [0; 5];
        child.stdout.as_mut().unwrap().read_exact(&mut ready).unwrap();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            // Signals that come before the command listens for them are ignored.
            let interrupt = format!("kill -INT {} 2>/dev/null", child.id());
            Command::new("sh").args(["-c", &interrupt]).status().unwrap();
            std::thread::sleep(std::time::Duration::from_millis(20));
        };
        assert_eq!(status.signal(), Some(2), "{arguments:?}: {status}");
        assert_eq!(folder.names("."), ["cube.obj", "scene.ron"], "{arguments:?}");
    }
}

/// Tested with a pipe, since a bug here would replace the machine's `/dev/null`.
#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_written_into_and_stays() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = Folder::new();
    let pipe = folder.path("pipe.png");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for arguments in [
        &["strokes", "scene.ron", "-o", "pipe.png"][..],
        &["render", "scene.ron", "--frames", "1", "-o", "pipe.png"],
        &["render", "scene.ron", "--apng", "-o", "pipe.png"],
        &["brushes", "-o", "pipe.png"],
    ] {
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read(pipe)
        });
        let output = folder.run(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}: {}", words(&output.stderr));
        assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo(), "{arguments:?} replaced the pipe");
        let bytes = reader.join().unwrap().unwrap();
        let begin: &[u8] = if arguments[0] == "strokes" { b"id,object" } else { b"\x89PNG" };
        assert!(bytes.starts_with(begin), "{arguments:?}");
    }
}

#[test]
fn brushes_are_shown_on_a_sheet() {
    let folder = Folder::new();
    assert_eq!(code(&folder.run(&["brushes", "-o", "sheet.png"])), 0);
    let decoder =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(folder.path("sheet.png")).unwrap()));
    let reader = decoder.read_info().unwrap();
    assert!(reader.info().width > 1000 && reader.info().height > 500);
    std::fs::copy(folder.path("sheet.png"), folder.path("mark.png")).unwrap();
    assert_eq!(code(&folder.run(&["brushes", "mark.png", "-o", "with_mine.png"])), 0);
    let refused = folder.run(&["brushes", "cube.obj", "-o", "none.png"]);
    assert_eq!(code(&refused), 3, "{}", words(&refused.stderr));
    assert!(
        words(&refused.stderr).contains("cube.obj: error: the format of the picture"),
        "{}",
        words(&refused.stderr)
    );
    assert_eq!(words(&refused.stderr).trim().lines().count(), 1, "{}", words(&refused.stderr));
    assert_eq!(code(&folder.run(&["brushes", "mark.png", "-o", "mark.png"])), 3);
    assert_eq!(folder.names("."), ["cube.obj", "mark.png", "scene.ron", "sheet.png", "with_mine.png"]);
}

#[cfg(unix)]
#[test]
fn frames_are_piped_to_ffmpeg_where_it_is_installed() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new();
    let programs = folder.path("programs");
    std::fs::create_dir(&programs).unwrap();
    let render = || {
        let mut command = Command::new(impasto());
        command
            .args(["render", "scene.ron", "-o", "shot.mp4"])
            .current_dir(folder.path("."))
            .env("PATH", &programs);
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap()
    };
    let without = render();
    assert_eq!(code(&without), 3);
    assert!(words(&without.stderr).contains("ffmpeg, which is not installed; "));
    // A stand-in for ffmpeg that has an encoder, and copies its input into the file that its last argument names.
    let install = |script: &str| {
        let path = programs.join("ffmpeg");
        std::fs::write(&path, script).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    };
    let encoders =
        |name: &str| format!("#!/bin/sh\ncase \"$*\" in *-encoders*) echo ' V {name} x'; exit;; esac\n");
    install(&(encoders("libx264") + "for last; do :; done\n/bin/cat > \"$last\"\n"));
    let with = render();
    assert_eq!(code(&with), 0, "{}", words(&with.stderr));
    // Three frames, four bytes a pixel.
    assert_eq!(std::fs::metadata(folder.path("shot.mp4")).unwrap().len(), 3 * 160 * 90 * 4);
    std::fs::remove_file(folder.path("shot.mp4")).unwrap();
    install(&(encoders("libx264") + "/bin/cat > /dev/null\necho no room >&2\necho left >&2\nexit 1\n"));
    let failing = render();
    assert_eq!(code(&failing), 1, "{}", words(&failing.stderr));
    let told = words(&failing.stderr);
    assert!(told.contains("shot.mp4 is not written") && told.ends_with("no room; left\n"), "{told}");
    install(&encoders("libx265"));
    let lacking = render();
    assert_eq!(code(&lacking), 3);
    assert!(words(&lacking.stderr).contains("no encoder libx264 (H.264)"), "{}", words(&lacking.stderr));
    assert_eq!(
        folder.names("."),
        ["cube.obj", "programs", "scene.ron"],
        "a movie that failed leaves nothing"
    );
    assert_eq!(code(&folder.run(&["render", "scene.ron", "-o", "shot.mp4", "--apng"])), 2);
    let transparent = folder.run(&["render", "scene.ron", "-o", "shot.mp4", "--alpha"]);
    assert_eq!(code(&transparent), 2);
    assert!(words(&transparent.stderr).contains("holds no transparency"), "{}", words(&transparent.stderr));
}

#[test]
fn a_model_is_placed_as_the_command_says_and_a_scene_is_not() {
    let folder = Folder::new();
    let written = |arguments: &[&str]| {
        let output = folder.run(&[&["new", "cube.obj", "--force", "-o", "made.ron"], arguments].concat());
        assert_eq!(code(&output), 0, "{}", words(&output.stderr));
        std::fs::read_to_string(folder.path("made.ron")).unwrap()
    };
    assert!(written(&["--up", "-z"]).contains("up: NegZ"));
    assert!(!written(&["--up", "y"]).contains("up:"));
    assert_ne!(written(&["--view", "left"]), written(&["--view", "right"]));
    let output = folder.run(&["render", "scene.ron", "--up", "z", "-o", "x.png"]);
    let told = words(&output.stderr);
    assert!(code(&output) != 0 && told.contains("--up, --view and --ground place a model"), "{told}");
}

#[test]
fn files_beside_a_relative_path_are_told_by_relative_paths() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("sub")).unwrap();
    std::fs::write(folder.path("sub/cube.obj"), format!("mtllib cube.mtl\nusemtl a\n{CUBE}")).unwrap();
    std::fs::write(folder.path("sub/cube.mtl"), "newmtl a\nmap_Kd gone.png\n").unwrap();
    let told = words(&folder.run(&["check", "sub/cube.obj"]).stderr);
    let begins = |told: &str, with: &str| told.lines().any(|line| line.starts_with(with));
    assert!(begins(&told, "sub/cube.mtl:2:1: warning: \"gone.png\" was not found"), "{told}");
    let inside = Command::new(impasto()).args(["check", "cube.obj"]).current_dir(folder.path("sub")).output();
    let told = words(&inside.unwrap().stderr);
    assert!(begins(&told, "cube.mtl:2:1: warning"), "{told}");
    let whole = folder.path("sub/cube.obj");
    let told = words(&folder.run(&["check", &whole.to_string_lossy()]).stderr);
    assert!(begins(&told, &format!("{}:2:1: warning", folder.path("sub/cube.mtl").display())), "{told}");
}
