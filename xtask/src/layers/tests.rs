//! Tests of the layer check: wrong arrows are planted in small workspaces and judged through the real `cargo metadata`.

use std::path::Path;

use super::circles::circles;
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

/// Writes a workspace with these crates: folder names, and their dependencies as Cargo.toml lines.
fn workspace(root: &Path, crates: &[(&str, &str)]) {
    let write = |path: &str, text: &str| {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    };
    write("Cargo.toml", "[workspace]\nresolver = \"3\"\nmembers = [\"crates/*\"]\nexclude = [\"outside\"]\n");
    write("ARCHITECTURE.md", ARCHITECTURE);
    // Outside crates are replaced by path dependencies that are not members.
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
fn a_dev_dependency_is_an_arrow_too() {
    let core = ("core", "[dev-dependencies]\nimpasto-tests.path = \"../tests\"");
    let error = verdict(&[core, SCENE, ("tests", "")]).expect_err("core may use nothing");
    assert!(error.contains("impasto-core -> impasto-tests"), "{error}");
}

#[test]
fn an_outside_crate_stays_behind_its_owner() {
    let scene = ("scene", "[dependencies]\nglow.path = \"../../outside/glow\"");
    let tests = ("tests", "[dependencies]\nimpasto-scene.path = \"../scene\"");
    assert_eq!(verdict(&[CORE, scene, tests]), Ok(()), "`tests` may reach `glow` through its owner");
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

/// The findings about a crate with these source files. Its root is `lib.rs`.
fn circles_in(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    }
    circles(folder.path(), &folder.path().join("lib.rs")).expect("the files can be read")
}

#[test]
fn files_that_use_each_other_are_a_circle() {
    let found = circles_in(&[
        ("lib.rs", "mod a; mod b; pub use a::A;"),
        ("a.rs", "use crate::b::{self, B}; pub struct A(B);"),
        ("b.rs", "pub struct B; fn of(_: Option<crate::a::A>) {}"),
    ]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("a.rs uses `B` of b.rs\n    b.rs uses `A` of a.rs"), "{}", found[0]);
}

#[test]
fn a_circle_of_three_is_told_with_what_hangs_on_it() {
    let found = circles_in(&[
        ("lib.rs", "mod a; mod b; mod c; mod d; mod e;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "use crate::c::C; use crate::d::D; pub struct B(C);"),
        ("c.rs", "use crate::a; use crate::e::E; pub fn c() { a::A::new() } pub struct C;"),
        ("d.rs", "use crate::e::E; use crate::a::A; use crate::b::B; pub struct D;"),
        ("e.rs", "pub struct E;"),
    ]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("b.rs uses `D` of d.rs\n    d.rs uses `B` of b.rs"), "{}", found[0]);
    assert!(found[0].contains("tied to them: a.rs, c.rs"), "{}", found[0]);
    let three = circles_in(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "use crate::c::C; pub struct B(C);"),
        ("c.rs", "use crate::a; pub fn c() { a::A::new() } pub struct C;"),
    ]);
    let told = "a.rs uses `B` of b.rs\n    b.rs uses `C` of c.rs\n    c.rs uses `A` of a.rs";
    assert!(three.len() == 1 && three[0].contains(told), "{three:?}");
}

#[test]
fn a_child_may_use_its_parent_but_not_in_a_circle_through_others() {
    let child = ("a/child.rs", "use super::A; pub struct Child(A);");
    let parent = ("a.rs", "mod child; pub fn a(_: child::Child) {} pub struct A;");
    assert_eq!(circles_in(&[("lib.rs", "mod a;"), parent, child]), Vec::<String>::new());
    let child = ("a/child.rs", "use crate::b::B; pub struct Child(B);");
    let other = ("b.rs", "use super::a::A; pub struct B(A);");
    let found = circles_in(&[("lib.rs", "mod a; mod b;"), parent, child, other]);
    let circle =
        "a/child.rs uses `B` of b.rs\n    b.rs uses `A` of a.rs\n    a.rs uses `Child` of a/child.rs";
    assert!(found.len() == 1 && found[0].contains(circle), "{found:?}");
}

#[test]
fn a_re_export_counts_as_the_file_that_defines_it() {
    let found = circles_in(&[
        ("lib.rs", "mod a;"),
        ("a/mod.rs", "mod b; mod c; pub use b::B;"),
        ("a/b.rs", "pub struct B(super::c::C);"),
        ("a/c.rs", "use crate::a::B; pub struct C(B);"),
    ]);
    assert!(found.len() == 1 && found[0].contains("a/c.rs uses `B` of a/b.rs"), "{found:?}");
    // A re-export alone is not a use.
    let found = circles_in(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub use crate::b::B; pub struct A;"),
        ("b.rs", "use crate::a::A; pub struct B(A);"),
    ]);
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn tests_and_comments_make_no_circle() {
    let a = "/// See [`crate::b::B`].\npub struct A;\n#[cfg(test)]\nuse crate::b::B;\n#[cfg(test)]\nmod tests { use crate::b::B; }";
    let b = "use crate::a::A; // crate::a\npub struct B(A);";
    assert_eq!(circles_in(&[("lib.rs", "mod a; mod b;"), ("a.rs", a), ("b.rs", b)]), Vec::<String>::new());
}

#[test]
fn a_circle_fails_the_workspace() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    workspace(folder.path(), &[CORE, SCENE, TESTS]);
    let source = folder.path().join("crates/core/src");
    std::fs::write(source.join("lib.rs"), "mod a; pub fn root() { a::a(); }").expect("written");
    std::fs::write(source.join("a.rs"), "pub fn a() { crate::root(); }").expect("written");
    let error = format!("{:#}", run(folder.path()).expect_err("a circle"));
    assert!(error.contains("crates/core/src/a.rs uses `root` of crates/core/src/lib.rs"), "{error}");
}
