//! Checks that the lock files of the packages outside the workspace still list the dependencies of our crates.
//! Otherwise `cargo xtask bench` and `cargo xtask fuzz`, which build with `--locked`, would fail.

use std::collections::BTreeSet;

use super::finding::Finding;

/// A finding for each dependency of one of our crates that the lock file does not list. `file` is its path, and `lock`
/// its text. `manifest` gives the text of the `Cargo.toml` of one of our crates by its name; `None` for others.
pub fn check(file: &str, lock: &str, manifest: impl Fn(&str) -> Option<String>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in lock.split("[[package]]").skip(1) {
        let name = quoted(package).next().unwrap_or_default();
        let Some(manifest) = manifest(name) else { continue };
        let (_, listed) = package.split_once("dependencies = [").unwrap_or_default();
        let locked: BTreeSet<&str> = quoted(listed).filter_map(|entry| entry.split(' ').next()).collect();
        for missing in dependencies(&manifest).into_iter().filter(|dependency| !locked.contains(dependency)) {
            let what = format!("`{name}` has no dependency `{missing}` here");
            findings.push(Finding::of_file(file, what, "run `cargo fetch` in its folder"));
        }
    }
    findings
}

/// The names of the packages that a manifest depends on, without optional and dev-dependencies.
fn dependencies(manifest: &str) -> Vec<&str> {
    let mut counts = false;
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            counts =
                line == "[dependencies]" || line.starts_with("[target.") && line.ends_with(".dependencies]");
        } else if counts
            && !line.contains("optional = true")
            && let Some(name) = line.split(['.', ' ', '=']).next().filter(|name| !name.is_empty())
            && !name.starts_with('#')
        {
            found.push(name);
        }
    }
    found
}

fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dependency_that_the_lock_lacks_is_found() {
        let lock = "version = 4\n\n[[package]]\nname = \"a\"\nversion = \"1.0.0\"\ndependencies = [\n \"glam\",\n \
                    \"rustix 1.1.6\",\n]\n\n[[package]]\nname = \"b\"\nversion = \"1.0.0\"\n";
        let manifest = "[package]\nname = \"a\"\n\n[dependencies]\nglam.workspace = true\n\n# A disk.\n\
                        [target.'cfg(unix)'.dependencies]\nrustix = \"1\"\nlibc.workspace = true\n\
                        window = { path = \"w\", optional = true }\n\n[dev-dependencies]\ntempfile = \"3\"\n";
        let found = check("bench/Cargo.lock", lock, |name| (name == "a").then(|| manifest.to_owned()));
        let words: Vec<String> = found.iter().map(Finding::to_string).collect();
        assert!(words.len() == 1 && words[0].contains("`libc`"), "{words:?}");
        let nothing = check("bench/Cargo.lock", lock, |name| (name == "b").then(String::new));
        assert!(nothing.is_empty());
    }
}
