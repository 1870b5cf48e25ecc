//! Finds files that a scene may mean when one that it names is missing.

use std::path::Path;

use super::incoming::Kind;

/// Limits of the search. It goes `MAX_DEPTH` levels below the scene's folder. It reads at most `MAX_FILES` entries of
/// each folder, and finds at most `MAX_FILES` meshes in all.
const MAX_DEPTH: usize = 4;
const MAX_FILES: usize = 4000;
/// Names that differ by more letters than this, or by more than a third of their letters, are not similar.
const MAX_APART: usize = 2;

/// For each missing mesh, the mesh in the scene's folder that is likely meant: one of the same name in another
/// folder, else the one of the most similar name. Missing meshes without one are left out.
pub fn meshes_like(folder: &Path, missing: &[&str]) -> Vec<(String, String)> {
    if missing.is_empty() {
        return Vec::new();
    }
    let mut there = Vec::new();
    list(folder, "", MAX_DEPTH, &mut there);
    missing.iter().filter_map(|name| Some(((*name).to_owned(), nearest(name, &there)?.to_owned()))).collect()
}

/// Adds the meshes under a folder, by their paths relative to the scene's folder. Links are not followed.
fn list(folder: &Path, within: &str, depth: usize, found: &mut Vec<String>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten().take(MAX_FILES) {
        let Ok(kind) = entry.file_type() else { continue };
        let Some(name) = entry.file_name().to_str().map(|name| format!("{within}{name}")) else { continue };
        if found.len() >= MAX_FILES || entry.file_name().as_encoded_bytes().starts_with(b".") {
            continue;
        }
        if kind.is_file() && Kind::of(Path::new(&name)) == Some(Kind::Mesh) {
            found.push(name);
        } else if kind.is_dir() && depth > 0 {
            list(&entry.path(), &format!("{name}/"), depth - 1, found);
        }
    }
}

fn nearest<'a>(missing: &str, there: &'a [String]) -> Option<&'a str> {
    let wanted = file_name(missing);
    let rank = |name: &str| {
        let name = file_name(name);
        if name == wanted {
            return Some(0);
        }
        let [name, wanted] = [name, wanted].map(str::to_lowercase);
        let apart = letters_apart(&name, &wanted);
        let letters = wanted.chars().count().saturating_sub(".obj".len());
        (apart <= MAX_APART.min(letters / 3)).then_some(1 + apart)
    };
    there
        .iter()
        .filter_map(|name| Some((rank(name)?, name.len(), name.as_str())))
        .min()
        .map(|(.., name)| name)
}

/// The name without its folders; a scene may be written with either slash.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// How many letters must be inserted, deleted or changed (Levenshtein 1966).
fn letters_apart(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (index, letter) in a.chars().enumerate() {
        let mut corner = std::mem::replace(&mut row[0], index + 1);
        for (column, other) in b.iter().enumerate() {
            let changed = corner + usize::from(letter != *other);
            corner = row[column + 1];
            row[column + 1] = changed.min(corner + 1).min(row[column] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_name_elsewhere_comes_before_a_similar_one() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        };
        for name in ["leave.obj", "old/plants/leaf.obj", "Apple.OBJ", "stone.obj", "lemon.mtl"] {
            write(name);
        }
        let like = |name: &str| meshes_like(folder.path(), &[name]).pop().map(|(_, like)| like);
        assert_eq!(like("meshes/leaf.obj").as_deref(), Some("old/plants/leaf.obj"));
        assert_eq!(like("meshes\\leef.obj").as_deref(), Some("old/plants/leaf.obj"));
        assert_eq!(like("apple.obj").as_deref(), Some("Apple.OBJ"));
        assert_eq!(like("lemon.obj"), None, "a material is no mesh");
        assert_eq!(like("pear.obj"), None);
        assert!(meshes_like(folder.path(), &[]).is_empty());
    }
}
