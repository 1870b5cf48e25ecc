//! Tests of `tidy`: each kind of untidiness is planted in a small tree of its own.

use super::run;

fn verdict(files: &[(&str, &str)]) -> Result<(), String> {
    let root = tempfile::tempdir().expect("a temporary folder");
    for (path, text) in files {
        let path = root.path().join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    }
    run(root.path()).map_err(|error| format!("{error:#}"))
}

/// Asserts that the planted file is found, at this place and in these words.
fn found(files: &[(&str, &str)], expected: &str) {
    let error = verdict(files).expect_err("untidy");
    assert!(error.starts_with("1 things"), "more than the planted file is found: {error}");
    assert!(error.contains(expected), "{expected} in {error}");
}

#[test]
fn a_tidy_tree_passes() {
    assert_eq!(verdict(&[("crates/core/src/lib.rs", "//! Tidy.\n"), ("LICENSE", "no newline")]), Ok(()));
}

#[test]
fn a_planted_long_file_is_named() {
    let long = "// line\n".repeat(501);
    found(&[("crates/core/src/long.rs", &long)], "crates/core/src/long.rs:501: 501 lines");
    found(
        &[("crates/gl-render/shaders/shared/long.glsl", &long)],
        "crates/gl-render/shaders/shared/long.glsl:501: 501 lines",
    );
    assert_eq!(verdict(&[("crates/core/src/long.rs", &"// line\n".repeat(500))]), Ok(()));
    // Lines after a module of tests count, and so do lines after `mod tests;`.
    let named = format!("#[cfg(test)]\nmod tests;\n{long}");
    found(&[("crates/core/src/named.rs", &named)], "crates/core/src/named.rs:501: 501 lines");
    let around = format!("// line\n#[cfg(test)]\nmod tests {{\n{long}}}\n{}", "// line\n".repeat(500));
    found(&[("crates/core/src/around.rs", &around)], "crates/core/src/around.rs:501: 501 lines");
}

#[test]
fn tests_and_tables_may_be_long() {
    let long = "// line\n".repeat(501);
    let tested = format!("//! Short.\n#[cfg(test)]\nmod tests {{\n{long}}}\n");
    let files = [
        ("tests/it/long.rs", long.as_str()),
        ("crates/core/src/poly_table.rs", long.as_str()),
        ("crates/core/src/tested.rs", tested.as_str()),
    ];
    assert_eq!(verdict(&files), Ok(()));
}

#[test]
fn an_empty_name_is_named() {
    for name in ["utils", "misc", "helpers", "common", "manager"] {
        let file = format!("crates/core/src/{name}.rs");
        found(&[(&file, "//! What?\n")], &format!("{file}:1: `{name}.rs` says nothing"));
    }
}

#[test]
fn half_a_technique_is_named() {
    let whole = [
        ("crates/gl-render/shaders/sumi_e/ink.frag", ""),
        ("crates/gl-render/src/styles/sumi_e.rs", ""),
        ("docs/techniques/sumi_e.md", ""),
        ("tests/it/sumi_e.rs", ""),
    ];
    assert_eq!(verdict(&whole), Ok(()));
    let mut material = whole;
    material[1].0 = "crates/gl-render/src/materials/sumi_e.rs";
    assert_eq!(verdict(&material), Ok(()), "a technique may be a material");
    for (missing, expected) in [
        (0, "no shader folder: crates/gl-render/shaders/sumi_e"),
        (1, "no style: crates/gl-render/src/styles/sumi_e.rs"),
        (2, "no page: docs/techniques/sumi_e.md"),
        (3, "no test module: tests/it/sumi_e.rs"),
    ] {
        let mut files = whole.to_vec();
        files.remove(missing);
        found(&files, expected);
    }
    // An overlay may take the place of the style.
    let mut overlay = whole.to_vec();
    overlay[1].0 = "crates/gl-render/src/overlays/sumi_e.rs";
    assert_eq!(verdict(&overlay), Ok(()));
}

#[test]
fn an_absolute_path_in_a_scene_is_named() {
    for path in ["/home/me/apple.obj", "C:/apple.obj", "~/apple.obj"] {
        let scene = format!("(\n    name: \"apple\",\n    mesh: \"{path}\",\n)\n");
        found(&[("scenes/apple.ron", &scene)], &format!("scenes/apple.ron:3: \"{path}\" is absolute"));
    }
    assert_eq!(verdict(&[("scenes/apple.ron", "(mesh: \"meshes/apple.obj\", tone: \"é\")\n")]), Ok(()));
}

#[test]
fn unfinished_work_and_loose_ends_are_named() {
    let unfinished = format!("//! Fine.\n// {}: later\n", concat!("TO", "DO"));
    found(&[("crates/core/src/lib.rs", &unfinished)], "crates/core/src/lib.rs:2");
    found(&[("README.md", "one\ntwo")], "README.md:2: no newline");
    found(&[("README.md", "one \ntwo\n")], "README.md:1: spaces");
    found(&[("README.md", "one\ntwo\r\n")], "README.md:2: a carriage return");
}

#[test]
fn a_lint_exception_says_why() {
    let allow = concat!("#[al", "low(dead_code)]\nfn f() {}\n");
    found(&[("crates/core/src/lib.rs", allow)], "lib.rs:1: a lint is allowed");
    let bare = concat!("#[exp", "ect(\n    dead_code\n)]\nfn f() {}\n");
    found(&[("crates/core/src/lib.rs", bare)], "lib.rs:1: a lint exception without a reason");
    let reasoned = concat!("#[exp", "ect(\n    dead_code,\n    reason = \"r\"\n)]\nfn f() {}\n");
    assert_eq!(verdict(&[("crates/core/src/lib.rs", reasoned)]), Ok(()));
}

#[test]
fn big_pictures_are_named() {
    let bytes = |kilobytes: usize| "x".repeat(kilobytes * 1024);
    found(&[("tests/goldens/a.png", &bytes(65))], "tests/goldens/a.png:1: 65 KB, where at most 64");
    found(&[("a/snapshots/b.png", &bytes(65))], "a/snapshots/b.png:1: 65 KB, where at most 64");
    found(&[("docs/pictures/a.png", &bytes(401))], "docs/pictures/a.png:1: 401 KB");
    found(&[("scenes/meshes/a.bin", &bytes(1025))], "scenes/meshes/a.bin:1: 1025 KB");
    assert_eq!(verdict(&[("tests/goldens/a.png", &bytes(64)), ("docs/pictures/a.png", &bytes(400))]), Ok(()));
}
