//! Lays out the files as they are installed: `bin/` and `share/`, which the Debian package has below `/usr`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use super::{licences, succeed};

/// What is copied, from the repository into the tree. A folder is copied with all that is in it.
const COPIED: &[(&str, &str)] = &[
    ("packaging/impasto.desktop", "share/applications/impasto.desktop"),
    ("packaging/impasto.svg", "share/icons/hicolor/scalable/apps/impasto.svg"),
    ("packaging/impasto-128.png", "share/icons/hicolor/128x128/apps/impasto.png"),
    ("packaging/impasto-256.png", "share/icons/hicolor/256x256/apps/impasto.png"),
    ("packaging/impasto-scene.xml", "share/mime/packages/impasto.xml"),
    ("docs", "share/doc/impasto/docs"),
    ("scenes", "share/impasto/scenes"),
    ("blender", "share/impasto/blender"),
];

/// Whether a file is left out of all packages. `below` is the folder of the repository that it is copied from. Left out
/// are hidden files, what Python leaves behind, and the pictures of the docs, which are larger than all the rest.
fn is_left_out(name: &str, below: &str) -> bool {
    name == "__pycache__" || name.starts_with('.') || (below == "docs" && name == "pictures")
}

/// The shells, and where each looks for completions.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "share/bash-completion/completions/impasto"),
    ("zsh", "share/zsh/vendor-completions/_impasto"),
    ("fish", "share/fish/vendor_completions.d/impasto.fish"),
];

/// Lays out the tree anew in `folder`. Returns its path.
pub fn lay(root: &Path, folder: &Path, binary: &Path) -> anyhow::Result<PathBuf> {
    let tree = folder.join("tree");
    if tree.exists() {
        std::fs::remove_dir_all(&tree)?;
    }
    let program = place(&tree, "bin/impasto")?;
    succeed(
        Command::new("strip")
            .args(["--remove-section=.comment", "--output-file"])
            .args([&program, &binary.to_path_buf()]),
    )
    .context("strip comes with the C compiler")?;
    for (from, to) in COPIED {
        copy(&root.join(from), &tree.join(to), from).with_context(|| format!("{from} is packed"))?;
    }
    succeed(Command::new(binary).arg("man").arg(tree.join("share/man/man1")))?;
    for (shell, to) in COMPLETIONS {
        let said = Command::new(binary).args(["completions", shell]).output()?;
        if !said.status.success() || said.stdout.is_empty() {
            bail!("there are no completions for {shell}");
        }
        std::fs::write(place(&tree, to)?, said.stdout)?;
    }
    std::fs::write(place(&tree, "share/doc/impasto/third_party.txt")?, licences::of_dependencies(root)?)?;
    Ok(tree)
}

/// Adds the texts of the licences, which the Debian package has in places of its own.
pub fn add_licences(root: &Path, tree: &Path) -> anyhow::Result<()> {
    for (from, to) in [
        ("packaging/copyright", "copyright"),
        ("LICENSE-MIT", "LICENSE-MIT"),
        ("LICENSE-APACHE", "LICENSE-APACHE"),
    ] {
        std::fs::copy(root.join(from), place(tree, &format!("share/doc/impasto/{to}"))?)?;
    }
    Ok(())
}

/// The path of a file in the tree; makes the folder that it lies in.
fn place(tree: &Path, file: &str) -> anyhow::Result<PathBuf> {
    let path = tree.join(file);
    std::fs::create_dir_all(path.parent().context("a file lies in a folder")?)?;
    Ok(path)
}

/// Copies a file, or a folder with what is in it, except what is left out. `below` is passed to [`is_left_out`].
fn copy(from: &Path, to: &Path, below: &str) -> anyhow::Result<()> {
    if !from.is_dir() {
        std::fs::create_dir_all(to.parent().context("a file lies in a folder")?)?;
        std::fs::copy(from, to)?;
        return Ok(());
    }
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let name = entry.file_name();
        if !is_left_out(&name.to_string_lossy(), below) {
            copy(&entry.path(), &to.join(&name), below)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_scene_has_the_marks_by_which_a_desktop_knows_it() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let rules = std::fs::read_to_string(root.join("packaging/impasto-scene.xml")).expect("read");
        let marks: Vec<(usize, String)> = rules
            .split("<match ")
            .skip(1)
            .map(|rule| {
                let of = |key: &str, end: char| {
                    let rest = rule.split_once(key).expect("a key").1;
                    rest.split_once(end).expect("an end").0.replace("&quot;", "\"")
                };
                (of("offset=\"0:", '"').parse().expect("a number"), of("value=\"", '"'))
            })
            .collect();
        let mut scenes = 0;
        for entry in std::fs::read_dir(root.join("scenes")).expect("read") {
            let path = entry.expect("read").path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                let text = std::fs::read_to_string(&path).expect("read");
                let has =
                    |(last, mark): &(usize, String)| text.find(mark.as_str()).is_some_and(|at| at <= *last);
                assert!(has(&marks[0]) && marks[1..].iter().any(has), "{}", path.display());
                scenes += 1;
            }
        }
        assert!(scenes > 20 && marks.len() == 5, "{scenes} scenes, {marks:?}");
    }

    #[test]
    fn what_python_leaves_behind_and_pictures_of_the_docs_are_not_packed() {
        let from = tempfile::tempdir().expect("a temporary folder");
        let to = tempfile::tempdir().expect("a temporary folder");
        for file in ["docs/page.md", "docs/pictures/big.png", "docs/__pycache__/page.pyc", "docs/.hidden"] {
            std::fs::write(place(from.path(), file).expect("a place"), "").expect("written");
        }
        copy(&from.path().join("docs"), to.path(), "docs").expect("copied");
        let there = std::fs::read_dir(to.path()).expect("read").map(|entry| entry.expect("read").file_name());
        assert_eq!(there.collect::<Vec<_>>(), ["page.md"]);
        copy(&from.path().join("docs"), &to.path().join("scenes"), "scenes").expect("copied");
        assert!(to.path().join("scenes/pictures/big.png").is_file(), "pictures of scenes are packed");
    }
}
