//! Reads files with known answers: those in the folder `gltf` of the corpus that `IMPASTO_CORPUS` names. Without it,
//! the tests are skipped.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use impasto_gltf::{Finding, Gltf, Severity, read};

/// The folder of the glTF corpus; `None` if `IMPASTO_CORPUS` is not set.
fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("IMPASTO_CORPUS").map(|corpus| Path::new(&corpus).join("gltf"));
    if folder.is_none() {
        eprintln!("skipped: IMPASTO_CORPUS is not set");
    }
    folder
}

/// Reads a glTF file, and the files beside it that it names.
pub fn read_path(path: &Path) -> Result<(Gltf, Vec<Finding>), Vec<Finding>> {
    let bytes = fs::read(path).expect("the corpus is complete");
    let beside = path.parent().expect("a file is in a folder").to_owned();
    let start = Instant::now();
    let result = read(bytes, &mut |name, max_bytes| {
        let path = beside.join(name);
        let len = fs::metadata(&path).map_err(|error| format!("{name:?}: {error}"))?.len();
        if len > max_bytes {
            return Err(format!("{name:?} is too large"));
        }
        fs::read(path).map_err(|error| format!("{name:?}: {error}"))
    });
    assert!(start.elapsed() < Duration::from_secs(10), "{} took over 10 s", path.display());
    result
}

fn rows(table: &Path) -> Vec<(String, String, String)> {
    let text = fs::read_to_string(table).expect("the corpus has a table");
    let row = |line: &str| {
        let mut cells = line.splitn(3, ',').map(str::to_owned);
        Some((cells.next()?, cells.next()?, cells.next()?))
    };
    text.lines().skip(1).filter_map(row).collect()
}

#[test]
fn files_of_the_validator() {
    let Some(folder) = folder() else { return };
    let (mut valid, mut refused, mut faulty) = (0, Vec::new(), 0);
    let (mut wrong, mut silent) = (Vec::new(), Vec::new());
    for (file, errors, codes) in rows(&folder.join("validator.csv")) {
        let result = read_path(&folder.join("validator").join(&file));
        if errors == "0" {
            valid += 1;
            match result {
                Ok(_) => {}
                Err(findings) if findings[0].severity == Severity::Unsupported => {
                    refused.push(format!("{file}: {}", findings[0]));
                }
                Err(findings) => wrong.push(format!("{file}: {}", findings[0])),
            }
        } else {
            faulty += 1;
            if matches!(&result, Ok((_, warnings)) if warnings.is_empty()) {
                silent.push(format!("{file}: {codes}"));
            }
        }
    }
    eprintln!("{valid} valid files, {} refused by name:\n{}", refused.len(), refused.join("\n"));
    eprintln!("{faulty} files with errors, {} taken silently:\n{}", silent.len(), silent.join("\n"));
    assert!(wrong.is_empty(), "valid files are refused:\n{}", wrong.join("\n"));
    // Errors may stay silent in parts of a file that are not read, or where they make no difference to the reader.
    assert!(silent.len() <= MOST_SILENT, "{} files with errors are taken silently", silent.len());
}

const MOST_SILENT: usize = 8;

#[test]
fn hostile_files() {
    let Some(folder) = folder() else { return };
    for (file, expect, why) in rows(&folder.join("hostile.csv")) {
        let result = read_path(&folder.join("hostile").join(&file));
        let told = match &result {
            Ok((_, warnings)) => {
                format!("read, {}", warnings.first().map_or(String::new(), Finding::to_string))
            }
            Err(findings) => format!("refused, {}", findings[0]),
        };
        eprintln!("{file} ({expect}): {told}");
        match expect.as_str() {
            "OK" => assert!(result.is_ok(), "{file}: {told}"),
            "REJECT" => {
                let findings = result.expect_err(&file);
                let has_place = !findings[0].pointer.is_empty() || file.ends_with(".glb");
                assert!(has_place, "{file}: {told} {why}");
            }
            "LIMIT" | "ANY" => {}
            other => panic!("{other} is no answer"),
        }
    }
}
