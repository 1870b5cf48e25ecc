//! `cargo xtask tidy`: checks what neither the compiler nor clippy looks at. Each finding says where and what it is,
//! and how to mend it.

mod finding;
mod locks;
mod names;
pub mod pictures;
mod techniques;
mod text;
mod tree;

use std::path::Path;

use anyhow::bail;

use finding::Finding;

/// Fails, naming every finding, unless the tree at `root` is tidy.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let files = tree::files(root)?;
    let findings = findings(root, &files)?;
    if !findings.is_empty() {
        let lines: Vec<String> = findings.iter().map(Finding::to_string).collect();
        bail!("{} things are untidy:\n{}", lines.len(), lines.join("\n"));
    }
    println!("{} files are tidy", files.len());
    Ok(())
}

/// Everything that is untidy, by file and line.
fn findings(root: &Path, files: &[String]) -> anyhow::Result<Vec<Finding>> {
    let mut findings = techniques::check(files);
    for file in files {
        findings.extend(names::check(file));
        let bytes = std::fs::read(root.join(file))?;
        findings.extend(pictures::check(file, bytes.len() as u64));
        if let Ok(content) = std::str::from_utf8(&bytes) {
            findings.extend(text::check(file, content));
            if file.ends_with("/Cargo.lock") {
                let manifest = |name: &str| {
                    let folder = root.join("crates").join(name.strip_prefix("impasto-")?);
                    std::fs::read_to_string(folder.join("Cargo.toml")).ok()
                };
                findings.extend(locks::check(file, content, manifest));
            }
        }
    }
    findings.sort();
    Ok(findings)
}

#[cfg(test)]
mod tests;
