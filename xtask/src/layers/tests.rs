//! Wrong arrows planted in small workspaces of their own, judged through the real `cargo metadata`.

use std::path::Path;

use super::run;

const ARCHITECTURE: &str = "\
<!-- layers:begin -->
| crate | may use |
|---|---|
| `core` | nothing |
| `scene` | core |
| `tests` | all |
<!-- layers:end -->
<!-- outside:begin -->
| outside crate | reached by |
|---|---|
| `glow` | scene |
<!-- outside:end -->
";

/// A workspace with these crates: folder name, and its dependencies as Cargo.toml lines.
fn workspace(root: &Path, crates: &[(&str, &str)]) {
    let write = |path: &str, text: &str| {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    };
    write("Cargo.toml", "[workspace]\nresolver = \"3\"\nmembers = [\"crates/*\"]\nexclude = [\"outside\"]\n");
    write("ARCHITECTURE.md", ARCHITECTURE);
    // Outside crates stand in as path dependencies that are no members.
    for outside in ["glow", "middle"] {
        let dependencies = if outside == "middle" { "[dependencies]\nglow.path = \"../glow\"" } else { "" };
        let manifest = format!(
            "[package]\nname = \"{outside}\"\nversion = \"1.0.0\"\nedition = \"2024\"\n{dependencies}\n"
        );
        write(&format!("outside/{outside}/Cargo.toml"), &manifest);
        write(&format!("outside/{outside}/src/lib.rs"), "");
    }
    for (folder, dependencies) in crates {
        let manifest = format!(
            "[package]\nname = \"impasto-{folder}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n{dependencies}\n"
        );
        write(&format!("crates/{folder}/Cargo.toml"), &manifest);
        write(&format!("crates/{folder}/src/lib.rs"), "");
    }
}

fn verdict(crates: &[(&str, &str)]) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    workspace(folder.path(), crates);
    run(folder.path()).map_err(|error| format!("{error:#}"))
}

const CORE: (&str, &str) = ("core", "");
const SCENE: (&str, &str) = ("scene", "[dependencies]\nimpasto-core.path = \"../core\"");
const TESTS: (&str, &str) =
    ("tests", "[dependencies]\nimpasto-core.path = \"../core\"\nimpasto-scene.path = \"../scene\"");

#[test]
fn allowed_arrows_pass() {
    assert_eq!(verdict(&[CORE, SCENE, TESTS]), Ok(()));
}

#[test]
fn a_planted_wrong_arrow_is_named() {
    let core = ("core", "[dependencies]\nimpasto-tests.path = \"../tests\"");
    let tests = ("tests", "");
    let error = verdict(&[core, SCENE, tests]).expect_err("core may use nothing");
    assert!(error.contains("impasto-core -> impasto-tests is not allowed"), "{error}");
    assert!(error.contains("crates/core/Cargo.toml"), "{error}");
}

#[test]
fn an_arrow_of_the_tests_alone_is_an_arrow_too() {
    let core = ("core", "[dev-dependencies]\nimpasto-tests.path = \"../tests\"");
    let error = verdict(&[core, SCENE, ("tests", "")]).expect_err("core may use nothing");
    assert!(error.contains("impasto-core -> impasto-tests"), "{error}");
}

#[test]
fn an_outside_crate_stays_behind_its_owner() {
    let scene = ("scene", "[dependencies]\nglow.path = \"../../outside/glow\"");
    let tests = ("tests", "[dependencies]\nimpasto-scene.path = \"../scene\"");
    assert_eq!(verdict(&[CORE, scene, tests]), Ok(()), "through its owner it may be reached");
    let tests = ("tests", "[dependencies]\nmiddle.path = \"../../outside/middle\"");
    let error = verdict(&[CORE, SCENE, tests]).expect_err("round its owner it may not");
    assert!(error.contains("impasto-tests -> middle -> glow is not allowed"), "{error}");
}

#[test]
fn every_crate_has_a_row_and_every_row_a_crate() {
    let error = verdict(&[CORE, SCENE, TESTS, ("new", "")]).expect_err("`new` has no row");
    assert!(error.contains("impasto-new has no row"), "{error}");
    let error = verdict(&[CORE, SCENE]).expect_err("`tests` is gone");
    assert!(error.contains("row for impasto-tests"), "{error}");
}
