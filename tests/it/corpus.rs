//! Tests with good and hostile files. The small corpus, which `impasto_tests::corpus` makes, is always tested; the
//! large corpus is tested if `IMPASTO_CORPUS` names its folder. The real command checks the files within limits of
//! memory and time.

use std::path::{Path, PathBuf};
use std::process::Command;

use impasto_scene::assets::AssetFolders;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_tests::command::impasto;
use impasto_tests::corpus::{self, Outcome};

/// Limits of address space and time for one run of the command, which checks all files of a test.
const MEMORY_KIB: u32 = 1 << 20;
const SECONDS: u32 = 120;

/// What `impasto check` prints about a file.
struct Checked {
    /// The lines about the file's problems.
    said: String,
    is_good: bool,
}

impl Checked {
    fn outcome(&self) -> Outcome {
        let says = |kind: &str| self.said.contains(&format!(": {kind}: "));
        match self.is_good {
            true if says("warning") => Outcome::Warned,
            true => Outcome::Taken,
            false if says("limit") => Outcome::TooMuch,
            false => Outcome::Refused,
        }
    }
}

/// Runs `impasto check FILE …` once, within the limits; returns what it says of each file.
fn check(files: &[PathBuf]) -> Vec<Checked> {
    let script = format!("ulimit -v {MEMORY_KIB} && exec timeout {SECONDS} \"$0\" check \"$@\" 2>&1");
    let output =
        Command::new("sh").arg("-c").arg(script).arg(impasto()).args(files).output().expect("sh runs");
    let text = String::from_utf8_lossy(&output.stdout);
    let (mut checked, mut said) = (Vec::new(), String::new());
    for line in text.lines() {
        let Some(file) = files.get(checked.len()) else { panic!("more verdicts than files: {line}") };
        match line.strip_prefix(&format!("{}: ", file.display())) {
            Some(verdict) if verdict.starts_with("good, ") || verdict.starts_with("bad, ") => {
                let is_good = verdict.starts_with("good");
                checked.push(Checked { said: std::mem::take(&mut said), is_good });
            }
            _ => said += &format!("{line}\n"),
        }
    }
    let code = output.status.code();
    let stopped = files.get(checked.len());
    assert!(stopped.is_none(), "{stopped:?} ends the command, exit code {code:?}: {said}");
    let expected = if checked.iter().all(|file| file.is_good) { 0 } else { 3 };
    assert_eq!(code, Some(expected), "{said}");
    checked
}

/// The rows of a CSV file with a header line. Each row is a function from the name of a column to its value. Quoted
/// fields may hold commas and doubled quotes.
fn rows(path: &Path) -> Vec<impl Fn(&str) -> String + use<>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.lines().map(fields);
    let header = lines.next().expect("a header");
    lines
        .map(|row| {
            let header = header.clone();
            move |name: &str| {
                let column = header
                    .iter()
                    .position(|field| field == name)
                    .unwrap_or_else(|| panic!("no column {name}"));
                row[column].clone()
            }
        })
        .collect()
}

fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut rest = line.chars().peekable();
    while let Some(character) = rest.next() {
        match character {
            '"' if quoted && rest.peek() == Some(&'"') => field.extend(rest.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(std::mem::take(&mut field)),
            _ => field.push(character),
        }
    }
    fields.push(field);
    fields
}

#[test]
fn hostile_files_end_as_their_list_says() {
    let folder = tempfile::tempdir().unwrap();
    assert_ends_as_expected(&corpus::made(folder.path()));
    let Some(corpus) = corpus::shared("hostile_files_end_as_their_list_says") else { return };
    let rows = rows(&corpus.join("hostile.csv")).into_iter();
    let ours = rows.filter(|row| ["obj", "mtl", "tex", "ron"].contains(&row("kind").as_str()));
    let case = |row: &dyn Fn(&str) -> String| corpus::Case {
        name: row("id"),
        file: corpus.join(row("file")),
        expected: match row("expect").as_str() {
            "OK" => Outcome::Taken,
            "WARN" => Outcome::Warned,
            "REJECT" => Outcome::Refused,
            "LIMIT" => Outcome::TooMuch,
            other => panic!("the list expects {other:?}"),
        },
    };
    assert_ends_as_expected(&ours.map(|row| case(&row)).collect::<Vec<_>>());
}

fn assert_ends_as_expected(cases: &[corpus::Case]) {
    assert!(cases.len() > 50, "{} cases", cases.len());
    let files: Vec<PathBuf> = cases.iter().map(|case| case.file.clone()).collect();
    let mut failures = Vec::new();
    for (case, checked) in cases.iter().zip(check(&files)) {
        let found = checked.outcome();
        // A good file may have warnings.
        let is_fine = found == case.expected || (case.expected, found) == (Outcome::Taken, Outcome::Warned);
        if !is_fine {
            failures.push(format!("{}: {:?}, not {:?}: {}", case.name, found, case.expected, checked.said));
        }
    }
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), cases.len(), failures.join("\n"));
}

#[test]
fn real_models_are_read_or_refused_with_a_reason() {
    let Some(corpus) = corpus::shared("real_models_are_read_or_refused_with_a_reason") else { return };
    // Some models in the list may not be redistributed, so their files are missing.
    let is_here = |file: &Path| file.extension().is_some_and(|extension| extension == "obj") && file.exists();
    let models: Vec<_> = rows(&corpus.join("models.csv"))
        .into_iter()
        .filter(|row| is_here(&corpus.join(row("file"))))
        .collect();
    let files: Vec<PathBuf> = models.iter().map(|row| corpus.join(row("file"))).collect();
    let mut failures = Vec::new();
    for (row, checked) in models.iter().zip(check(&files)) {
        let fine = match row("verdict").as_str() {
            "good" => checked.is_good,
            "odd" if checked.is_good => true,
            _ if checked.is_good => checked.said.contains(": warning: "),
            _ => checked.said.contains(": error: "),
        };
        if !fine {
            failures.push(format!("{} ({}): {}", row("name"), row("verdict"), checked.said));
        }
    }
    assert!(models.len() > 30, "{} models", models.len());
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), models.len(), failures.join("\n"));
}

/// Checks models of the small corpus in which random bytes were changed, left out or doubled, and the large corpus's
/// files from a fuzzer.
#[test]
fn fuzzed_files_neither_crash_nor_hang() {
    let scratch = tempfile::tempdir().unwrap();
    let mut files = changed_models(scratch.path());
    if let Some(corpus) = corpus::shared("fuzzed_files_neither_crash_nor_hang") {
        let before = files.len();
        for kind in ["obj", "mtl"] {
            let folder = corpus.join("models/fuzz-ufbx").join(kind);
            for entry in std::fs::read_dir(&folder).unwrap() {
                let own = scratch.path().join(files.len().to_string());
                std::fs::create_dir(&own).unwrap();
                std::fs::copy(entry.unwrap().path(), own.join(format!("case.{kind}"))).unwrap();
                if kind == "mtl" {
                    std::fs::write(own.join("case.obj"), WITH_MATERIAL).unwrap();
                }
                files.push(own.join("case.obj"));
            }
        }
        assert!(files.len() > before + 50, "{} files", files.len() - before);
    }
    check(&files);
}

/// An OBJ triangle with the material `a` of `case.mtl`.
const WITH_MATERIAL: &str = "mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

/// Two hundred changed copies of the small corpus's good models, each in a folder of its own.
fn changed_models(folder: &Path) -> Vec<PathBuf> {
    let originals = corpus::made(&folder.join("originals"));
    let good: Vec<Vec<u8>> = originals
        .iter()
        .filter(|case| case.expected == Outcome::Taken && case.file.ends_with("case.obj"))
        .map(|case| std::fs::read(&case.file).unwrap())
        .collect();
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % below as u64) as usize
    };
    let mut files = Vec::new();
    for index in 0..200 {
        let mut bytes = good[index % good.len()].clone();
        for _ in 0..=next(4) {
            let at = next(bytes.len());
            match next(3) {
                0 => bytes[at] = b"vf/-.e0 \n\\#"[next(11)],
                1 => drop(bytes.drain(at..(at + next(40)).min(bytes.len()))),
                _ => bytes.extend_from_within(at..(at + next(40)).min(bytes.len())),
            }
        }
        let own = folder.join(index.to_string());
        std::fs::create_dir(&own).unwrap();
        std::fs::write(own.join("case.obj"), bytes).unwrap();
        files.push(own.join("case.obj"));
    }
    files
}

/// Each picture is the texture of a triangle: a good one is used, a bad one is left out with a warning.
#[test]
fn real_pictures_are_worn_or_left_out() {
    let scratch = tempfile::tempdir().unwrap();
    let made = corpus::made(scratch.path()).into_iter().filter(|case| case.name.starts_with("picture_"));
    // A picture that claims too large a size makes its model fail.
    let made = made.filter(|case| case.expected != Outcome::TooMuch);
    let mut pictures: Vec<(String, PathBuf, bool)> =
        made.map(|case| (case.name, case.file, case.expected == Outcome::Warned)).collect();
    assert!(pictures.len() >= 4, "{} pictures", pictures.len());
    if let Some(corpus) = corpus::shared("real_pictures_are_worn_or_left_out") {
        let before = pictures.len();
        for row in rows(&corpus.join("models.csv")).into_iter().filter(|row| row("class") == "tex") {
            let own = scratch.path().join(row("name"));
            std::fs::create_dir(&own).unwrap();
            std::fs::write(own.join("case.obj"), WITH_MATERIAL).unwrap();
            std::fs::write(own.join("case.mtl"), "newmtl a\nmap_Kd picture.png\n").unwrap();
            std::fs::copy(corpus.join(row("file")), own.join("picture.png")).unwrap();
            pictures.push((row("name"), own.join("case.obj"), row("verdict") == "bad"));
        }
        assert!(pictures.len() > before, "models.csv lists no picture");
    }
    let files: Vec<PathBuf> = pictures.iter().map(|(_, file, _)| file.clone()).collect();
    for ((name, file, is_bad), checked) in pictures.iter().zip(check(&files)) {
        assert!(checked.is_good, "{name}: {}", checked.said);
        assert!(!is_bad || checked.said.contains(": warning: "), "{name}: {}", checked.said);
        let (read, _) = obj::read(file, file.parent().unwrap(), &AssetFolders::default()).unwrap();
        assert_eq!(read.materials[0].texture.is_none(), *is_bad, "{name}");
    }
}

/// Every mesh that is read keeps the invariants of its type.
#[test]
fn meshes_that_are_read_are_sound() {
    let scratch = tempfile::tempdir().unwrap();
    let mut files: Vec<PathBuf> = corpus::made(scratch.path()).into_iter().map(|case| case.file).collect();
    let changed = scratch.path().join("changed");
    std::fs::create_dir(&changed).unwrap();
    files.extend(changed_models(&changed));
    if let Some(corpus) = corpus::shared("meshes_that_are_read_are_sound") {
        let lists = ["hostile.csv", "models.csv"].map(|list| rows(&corpus.join(list)));
        files.extend(lists.iter().flatten().map(|row| corpus.join(row("file"))));
    }
    let mut count = 0;
    for path in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "obj")) {
        let folder = path.parent().unwrap();
        if let Ok((file, _)) = obj::read(path, folder, &AssetFolders::default()) {
            count += 1;
            assert_sound(&file, path);
        }
    }
    assert!(count > 50, "{count} meshes");
}

fn assert_sound(file: &MeshFile, path: &Path) {
    let mesh = &file.mesh;
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    let path = path.display();
    assert!(triangles > 0, "{path}");
    assert!(mesh.positions.iter().all(|at| at.is_finite()), "{path}");
    assert_eq!(mesh.normals.len(), vertices, "{path}");
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3), "{path}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices, "{path}");
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()), "{path}");
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "{path}");
    assert!(mesh.polygon_of_triangle.len() == triangles && mesh.polygon_of_triangle.is_sorted(), "{path}");
    let is_below = |numbers: &[u32], end: usize| {
        numbers.len() == triangles && numbers.iter().all(|&number| (number as usize) < end)
    };
    assert!(is_below(&mesh.group_of_triangle, file.groups.len()), "{path}");
    assert!(is_below(&mesh.material_of_triangle, file.materials.len()), "{path}");
    let area: f32 = (0..triangles)
        .map(|triangle| {
            let [a, b, c] = mesh.corners(triangle);
            (b - a).cross(c - a).length() / 2.0
        })
        .sum();
    assert!(area.is_finite() && area > 0.0, "{path}: area {area}");
    let mut channels = file.materials.iter().flat_map(|material| material.color);
    assert!(channels.all(|channel| (0.0..=1.0).contains(&channel)), "{path}");
}
