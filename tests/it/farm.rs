//! Tests of packs (`impasto pack`) and of jobs for render farms (`impasto farm`).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use impasto_tests::command::{impasto, root};

const SCENE: &str = r#"#![enable(implicit_some)]
(
    version: 1,
    size: (48, 32),
    timeline: (fps: 24, first: 0, last: 5),
    camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0)), (frame: 5, eye: (0, 0, 4), target: (0, 0, 0), roll_deg: 30)]),
    objects: [
        (name: "sheet", mesh: "meshes/sheet.obj", particles: 300),
        (name: "other", mesh: "far/other.obj", particles: 300, keys: [(frame: 0, translation: (1, 0, -1))]),
    ],
    strokes: (length_px: 10, width_px: 4),
)
"#;

const SHEET: &str =
    "mtllib sheet.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/1 4/2\n";

/// A folder with a scene in `shot`; its mesh `far/other.obj`, and what that needs, lie in the asset folder `library`.
fn shot() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &[u8]| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    // A TGA file of 2 x 2 pixels.
    let picture = |blue: u8| {
        let head = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0];
        [&head[..], &[blue, 30, 200].repeat(4)].concat()
    };
    write("shot/scene.ron", SCENE.as_bytes());
    write("shot/unused.obj", b"nothing");
    write("shot/meshes/sheet.obj", SHEET.as_bytes());
    write("shot/meshes/sheet.mtl", b"newmtl a\nmap_Kd skin/red.tga\n");
    write("shot/meshes/skin/red.tga", &picture(40));
    write("library/far/other.obj", SHEET.replace("sheet.mtl", "mats/o.mtl").as_bytes());
    write("library/far/mats/o.mtl", b"newmtl a\nmap_Kd ../blue.tga\n");
    write("library/far/blue.tga", &picture(250));
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(impasto()).current_dir(folder).args(arguments).output().unwrap()
}

/// Runs a command that must succeed. Returns what it prints to stderr.
fn good(folder: &Path, arguments: &[&str]) -> String {
    let done = run(folder, arguments);
    let words = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success(), "{words}");
    words
}

/// Runs a command that must be refused. Returns what it prints to stderr.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let done = run(folder, arguments);
    assert!(!done.status.success());
    String::from_utf8(done.stderr).unwrap()
}

/// All files below a folder.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.insert(path.strip_prefix(folder).unwrap().to_owned(), std::fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn a_pack_holds_what_the_shot_needs_and_nothing_else_and_paints_the_same() {
    let folder = shot();
    let here = folder.path();
    good(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "pack"]);
    let packed = files(&here.join("pack"));
    let names: Vec<&str> = packed.keys().map(|path| path.to_str().unwrap()).collect();
    let wanted = [
        "far/blue.tga",
        "far/mats/o.mtl",
        "far/other.obj",
        "meshes/sheet.mtl",
        "meshes/sheet.obj",
        "meshes/skin/red.tga",
        "pack.json",
        "scene.ron",
    ];
    assert_eq!(names, wanted);
    good(here, &["render", "shot/scene.ron", "--asset-dir", "library", "-f", "3", "-o", "a.png"]);
    good(here, &["render", "pack/scene.ron", "-f", "3", "-o", "b.png"]);
    let bytes = |name: &str| std::fs::read(here.join(name)).unwrap();
    assert!(bytes("a.png") == bytes("b.png"));
    // A .tar file holds the same files and no path of this machine. It does not depend on the working directory.
    good(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "one.tar"]);
    good(&here.join("shot"), &["pack", "scene.ron", "--asset-dir", "../library", "-o", "../two.tar"]);
    assert!(bytes("one.tar") == bytes("two.tar"));
    let untar = Command::new("tar").current_dir(here).args(["xf", "one.tar"]).status().unwrap();
    assert!(untar.success());
    assert!(files(&here.join("scene")) == packed);
    let machine = here.to_str().unwrap().as_bytes();
    assert!(!bytes("one.tar").windows(machine.len()).any(|part| part == machine));
    // A pack of a pack is the pack.
    good(here, &["pack", "pack/scene.ron", "-o", "again"]);
    assert!(files(&here.join("again")) == packed);
}

#[test]
fn what_is_no_whole_pack_is_told_and_nothing_is_left() {
    let folder = shot();
    let here = folder.path();
    good(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "pack"]);
    good(here, &["pack", "--check", "pack"]);
    assert!(
        refused(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "pack"])
            .contains("is there already")
    );
    std::fs::write(here.join("pack/far/mats/o.mtl"), "newmtl b\n").unwrap();
    let said = refused(here, &["pack", "--check", "pack"]);
    assert!(said.contains("far/mats/o.mtl (its content has changed)"), "{said}");
    // All faults are reported, not only the first.
    std::fs::remove_file(here.join("pack/scene.ron")).unwrap();
    let said = refused(here, &["pack", "--check", "pack"]);
    assert!(said.contains("o.mtl (its content") && said.contains("scene.ron (it is not there)"), "{said}");
    let list = std::fs::read_to_string(here.join("pack/pack.json")).unwrap();
    let own = format!("\"impasto\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(list.contains(&own), "{list}");
    std::fs::write(here.join("pack/pack.json"), list.replace(&own, "\"impasto\": \"0.1.0\"")).unwrap();
    assert!(
        refused(here, &["pack", "--check", "pack"]).contains("was packed by impasto 0.1.0, and this is ")
    );
    assert!(refused(here, &["pack", "--check", "shot"]).contains("shot is no pack"));
    assert!(
        refused(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "pack.zip"])
            .contains("let the name end in .tar")
    );
    assert!(!here.join("pack.zip").exists());
    // Two files that would get the same place in the pack: one beside the scene, and one from the asset folder.
    std::fs::write(here.join("library/top.obj"), SHEET).unwrap();
    std::fs::write(here.join("library/sheet.mtl"), "newmtl a\nKd 1 0 0\n").unwrap();
    std::fs::write(here.join("shot/here.obj"), SHEET).unwrap();
    std::fs::write(here.join("shot/sheet.mtl"), "newmtl a\nKd 0 1 0\n").unwrap();
    let scene = SCENE.replace("meshes/sheet.obj", "here.obj").replace("far/other.obj", "top.obj");
    std::fs::write(here.join("shot/two.ron"), scene).unwrap();
    let before = files(here);
    for output in ["two", "two.tar"] {
        let words = refused(here, &["pack", "shot/two.ron", "--asset-dir", "library", "-o", output]);
        assert!(words.contains("would lie at one place, sheet.mtl"), "{words}");
    }
    // A scene with errors, and an output that is also an input.
    std::fs::write(here.join("shot/bad.ron"), SCENE.replace("300", "-3")).unwrap();
    assert!(refused(here, &["pack", "shot/bad.ron", "-o", "bad"]).contains("bad.ron:"));
    std::fs::remove_file(here.join("shot/bad.ron")).unwrap();
    let words = refused(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "shot/scene.ron"]);
    assert!(words.contains("would be written over"), "{words}");
    assert!(files(here) == before);
}

#[test]
fn shipped_scenes_are_packed_whole() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["lane", "parade", "fish"] {
        let path = root().join("scenes").join(name).with_extension("ron");
        good(folder.path(), &["pack", path.to_str().unwrap(), "-o", name, "-q"]);
        good(&folder.path().join(name), &["check", &format!("{name}.ron")]);
    }
}

/// Runs one task of a Slurm script, as Slurm would.
fn task(folder: &Path, script: &str, number: usize) -> Output {
    let path = format!("{}:{}", impasto().parent().unwrap().display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.current_dir(folder).arg(script).env("PATH", path).env("SLURM_JOB_ID", "1");
    shell.env("SLURM_ARRAY_TASK_ID", number.to_string()).output().unwrap()
}

#[test]
fn the_tasks_of_a_slurm_script_paint_all_frames_once() {
    let folder = shot();
    let here = folder.path();
    good(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "it's a pack", "-q"]);
    let farm = [
        "farm",
        "slurm",
        "it's a pack/scene.ron",
        "-f",
        "0-5",
        "--chunk",
        "4",
        "-o",
        "out/f.png",
        "--job",
        "job.sh",
    ];
    good(here, &[&farm[..], &["--", "--size", "24x16"]].concat());
    assert!(std::fs::read_to_string(here.join("job.sh")).unwrap().contains("#SBATCH --array=0-1\n"));
    for number in 0..2 {
        let done = task(here, "job.sh", number);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    }
    good(here, &["render", "it's a pack/scene.ron", "-o", "whole/f.png", "--size", "24x16"]);
    assert_eq!(files(&here.join("out")).len(), 6);
    assert!(files(&here.join("out")) == files(&here.join("whole")));
    // A second run keeps the frames that are there and paints the missing one.
    let stamp = || std::fs::metadata(here.join("out/f_0001.png")).unwrap().modified().unwrap();
    let before = stamp();
    std::fs::remove_file(here.join("out/f_0002.png")).unwrap();
    assert!(task(here, "job.sh", 0).status.success());
    assert!(stamp() == before && files(&here.join("out")) == files(&here.join("whole")));
    // A picture that Impasto did not make is left as it is, with a warning.
    let mut foreign = png::Encoder::new(std::fs::File::create(here.join("out/f_0001.png")).unwrap(), 1, 1);
    foreign.set_color(png::ColorType::Grayscale);
    foreign.write_header().unwrap().write_image_data(&[0]).unwrap();
    let bytes = std::fs::read(here.join("out/f_0001.png")).unwrap();
    let done = task(here, "job.sh", 0);
    let words = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success() && words.contains("f_0001.png was there and does not say"), "{words}");
    assert_eq!(std::fs::read(here.join("out/f_0001.png")).unwrap(), bytes);
    let render = ["render", "it's a pack/scene.ron", "-f", "0-3", "-o", "out/f.png", "--size", "24x16"];
    let loud = good(here, &[&render[..], &["--skip-existing"]].concat());
    assert!(loud.contains("f_0001.png was there and does not say"), "{loud}");
    assert_eq!(good(here, &[&render[..], &["--skip-existing", "--quiet"]].concat()), "");
    assert!(!task(here, "job.sh", 7).status.success());
    // Frames of another shot are not taken for this one's.
    std::fs::write(here.join("it's a pack/other.ron"), SCENE).unwrap();
    let words = refused(here, &["render", "it's a pack/other.ron", "-o", "out/f.png", "--skip-existing"]);
    assert!(words.contains("was painted from scene.ron, and this is other.ron"), "{words}");
}

#[test]
fn frames_of_another_state_are_not_taken_for_this_ones() {
    let folder = shot();
    let here = folder.path();
    let again = |more: &[&str]| {
        let render = ["render", "shot/scene.ron", "--asset-dir", "library", "-f", "0-1", "-o", "out/f.png"];
        run(here, &[&render[..], &["--skip-existing"], more].concat())
    };
    let is_taken = |more: &[&str]| {
        let done = again(more);
        let words = String::from_utf8(done.stderr).unwrap();
        let is_other = words.contains("f_0000.png was painted from another state of this scene");
        assert_ne!(done.status.success(), is_other, "{words}");
        !is_other
    };
    assert!(is_taken(&[]));
    let painted = files(&here.join("out"));
    assert!(is_taken(&[]) && is_taken(&["--threads", "1"]));
    for more in [&["--size", "64x32"][..], &["--alpha"], &["--set", "strokes.scale=2"], &["--bits", "16"]] {
        assert!(!is_taken(more), "{more:?}");
    }
    // A comment in the scene changes nothing. A changed field, or a changed byte of a mesh or texture, makes another
    // state.
    std::fs::write(here.join("shot/scene.ron"), format!("// mine\n{SCENE}")).unwrap();
    assert!(is_taken(&[]));
    std::fs::write(here.join("shot/scene.ron"), SCENE.replace("roll_deg: 30", "roll_deg: 31")).unwrap();
    assert!(!is_taken(&[]));
    std::fs::write(here.join("shot/scene.ron"), SCENE).unwrap();
    for (name, bytes) in [
        ("shot/meshes/sheet.obj", format!("# moved\n{SHEET}").into_bytes()),
        ("library/far/blue.tga", std::fs::read(here.join("shot/meshes/skin/red.tga")).unwrap()),
    ] {
        let before = std::fs::read(here.join(name)).unwrap();
        std::fs::write(here.join(name), bytes).unwrap();
        assert!(!is_taken(&[]), "{name}");
        std::fs::write(here.join(name), before).unwrap();
    }
    assert!(is_taken(&[]) && files(&here.join("out")) == painted);
}

#[test]
fn a_template_is_one_that_runners_take_and_odd_ones_are_refused() {
    let folder = shot();
    let here = folder.path();
    good(here, &["pack", "shot/scene.ron", "--asset-dir", "library", "-o", "job/pack", "-q"]);
    good(
        here,
        &[
            "farm",
            "openjd",
            "job/pack/scene.ron",
            "-f",
            "5,1-3",
            "-o",
            "job/out/f.png",
            "--job",
            "job/template.yaml",
            "--movie",
            "job/film.mp4",
        ],
    );
    let text = std::fs::read_to_string(here.join("job/template.yaml")).unwrap();
    for line in [
        "specificationVersion: jobtemplate-2023-09",
        "    default: \"pack/scene.ron\"",
        "    default: \"1-3,5\"",
        "    default: \"f_####.png\"",
        "    default: \"film.mp4\"",
        "      - dependsOn: Paint",
    ] {
        assert!(text.lines().any(|known| known == line), "{line}\n{text}");
    }
    let openjd = |more: &[&str], words: &str| {
        let told = refused(here, &[&["farm", "openjd", "job/pack/scene.ron"], more].concat());
        assert!(told.contains(words), "{told}");
    };
    openjd(&["-o", "elsewhere/f.png", "--job", "job/t.yaml"], "names files in its own folder only");
    openjd(&["-o", "../f.png"], "names files in its own folder only");
    openjd(&["-o", "f{{.png"], "two opening braces");
    openjd(&["-f", "1-1000000000"], "the limit is");
    openjd(&["-o", "film.mp4"], "farms paint frames");
    openjd(&["-o", "f.exr", "--movie", "a.mp4"], "--exr");
    openjd(&["--", "--output", "x.png"], "the job says it itself");
    openjd(&["--", "-f3"], "the job says it itself");
    openjd(&["--", "--apng"], "cannot be used with");
    openjd(&["-o", "f_####.exr", "--", "--contact-sheet"], "needs frames in .png");
    openjd(&["--", "--sizee", "1x1"], "unexpected argument '--sizee'");
    openjd(&["--", "--aov", "all"], "add --exr");
    std::fs::write(here.join("bad.ron"), "(version: 1, camera: 7)").unwrap();
    assert!(refused(here, &["farm", "openjd", "bad.ron"]).contains("bad.ron:1:"));
    let done = run(
        here,
        &["render", "job/pack/scene.ron", "-f", "1-2", "-o", "o.png", "--progress", "openjd", "-q"],
    );
    let said = String::from_utf8(done.stdout).unwrap();
    assert_eq!(
        said.lines().step_by(2).collect::<Vec<_>>(),
        ["openjd_progress: 50.0", "openjd_progress: 100.0"]
    );
    // The runner itself checks the template, if it is installed.
    match Command::new("openjd").current_dir(here).args(["check", "job/template.yaml"]).output() {
        Ok(done) => assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout)),
        Err(_) => eprintln!("skipped: there is no openjd here (pip install openjd-cli)"),
    }
}
