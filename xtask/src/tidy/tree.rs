//! Lists the files of the repository for the tidy checks, without those that a build or a run wrote.

use std::path::Path;

use anyhow::Context as _;

/// Folders of output, and git's own: left out wherever they lie.
const OUTPUT_FOLDERS: &[&str] = &["target", "out", ".git"];

/// Every file under `root`, as a path from it with `/`, sorted.
pub fn files(root: &Path) -> anyhow::Result<Vec<String>> {
    let mut files = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(folder) = folders.pop() {
        let here = root.join(&folder);
        for entry in std::fs::read_dir(&here).with_context(|| format!("{} cannot be read", here.display()))? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
            let kind = entry.file_type()?;
            if OUTPUT_FOLDERS.contains(&name.as_str()) {
                continue;
            }
            if kind.is_dir() {
                folders.push(path);
            } else if kind.is_file() {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

/// The last part of a path.
pub fn name(file: &str) -> &str {
    file.rsplit('/').next().unwrap_or(file)
}

/// What stands after the last dot of the file's name; empty without one.
pub fn extension(file: &str) -> &str {
    name(file).rsplit_once('.').map_or("", |(_, extension)| extension)
}
