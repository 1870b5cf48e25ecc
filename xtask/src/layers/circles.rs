//! Finds circles between the files of one crate: files that, directly or through others, use each other.
//!
//! A module may use the modules that it is inside of (`super::…`): that makes no circle, except with the crate's root.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use super::modules::{Module, Names, modules};

/// For each file, the files that it uses, each with one item that it takes from there.
type Uses = BTreeMap<PathBuf, BTreeMap<PathBuf, String>>;

/// A sentence for each group of files that use each other in a circle, in the crate with this root file. Files are
/// named relative to `workspace`.
pub fn circles(workspace: &Path, root: &Path) -> anyhow::Result<Vec<String>> {
    let uses = uses(&modules(root)?);
    let mut done = BTreeSet::new();
    let mut found = Vec::new();
    for file in uses.keys() {
        if done.contains(file) {
            continue;
        }
        let group = group(&uses, file);
        if let Some(circle) = group.iter().filter_map(|file| shortest(&uses, file)).min_by_key(Vec::len) {
            found.push(sentence(workspace, &uses, &circle, &group));
        }
        done.extend(group);
    }
    Ok(found)
}

fn uses(modules: &BTreeMap<Names, Module>) -> Uses {
    let mut uses = Uses::new();
    for (name, module) in modules {
        let used = uses.entry(module.file.clone()).or_default();
        for path in &module.paths {
            if let Some((home, item)) = resolve(modules, name, path, 0)
                && (home.is_empty() || !name.starts_with(&home))
                && modules[&home].file != module.file
            {
                used.entry(modules[&home].file.clone()).or_insert(item);
            }
        }
    }
    uses
}

/// A chain of re-exports is followed this far only, because it may itself run in a circle.
const MOST_RE_EXPORTS: usize = 16;

/// The module that defines the item of a path, and the item's name. `None` for a path to a module or into another
/// crate.
fn resolve(
    modules: &BTreeMap<Names, Module>,
    from: &Names,
    path: &[String],
    re_exports: usize,
) -> Option<(Names, String)> {
    let (mut at, mut rest) = match path[0].as_str() {
        "crate" => (Names::new(), &path[1..]),
        "self" => (from.clone(), &path[1..]),
        "super" => (parent(from)?, &path[1..]),
        first => {
            let module = modules.get(from)?;
            let is_known = modules.contains_key(&child(from, first)) || module.imports.contains_key(first);
            if !is_known {
                return None;
            }
            (from.clone(), path)
        }
    };
    while let Some((name, after)) = rest.split_first() {
        rest = after;
        let module = modules.get(&at)?;
        if name == "super" {
            at = parent(&at)?;
        } else if modules.contains_key(&child(&at, name)) {
            at = child(&at, name);
        } else if let Some(import) = module.imports.get(name) {
            if re_exports == MOST_RE_EXPORTS {
                return None;
            }
            let path = [import.as_slice(), after].concat();
            return resolve(modules, &at, &path, re_exports + 1);
        } else {
            return Some((at, name.clone()));
        }
    }
    None
}

fn child(of: &Names, name: &str) -> Names {
    let mut names = of.clone();
    names.push(name.to_owned());
    names
}

fn parent(of: &Names) -> Option<Names> {
    of.split_last().map(|(_, before)| before.to_vec())
}

/// The file itself, and all files that both use it and are used by it, directly or through others.
fn group(uses: &Uses, file: &PathBuf) -> BTreeSet<PathBuf> {
    let mut group: BTreeSet<PathBuf> =
        reached(uses, file).into_iter().filter(|other| reached(uses, other).contains(file)).collect();
    group.insert(file.clone());
    group
}

fn reached(uses: &Uses, from: &PathBuf) -> BTreeSet<PathBuf> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        for next in uses.get(file).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(next.clone()) {
                open.push(next);
            }
        }
    }
    reached
}

/// The shortest way from a file back to itself; the file is its first and its last entry. `None` if there is no way.
fn shortest(uses: &Uses, file: &PathBuf) -> Option<Vec<PathBuf>> {
    let mut queue = VecDeque::from([vec![file.clone()]]);
    let mut seen = BTreeSet::new();
    while let Some(path) = queue.pop_front() {
        for next in uses.get(path.last()?).into_iter().flat_map(BTreeMap::keys) {
            if next == file || seen.insert(next) {
                let longer = [path.as_slice(), std::slice::from_ref(next)].concat();
                if next == file {
                    return Some(longer);
                }
                queue.push_back(longer);
            }
        }
    }
    None
}

fn sentence(workspace: &Path, uses: &Uses, circle: &[PathBuf], group: &BTreeSet<PathBuf>) -> String {
    let name = |file: &PathBuf| file.strip_prefix(workspace).unwrap_or(file).display().to_string();
    let mut text =
        "files use each other in a circle; move what they share into a file of its own:".to_owned();
    for pair in circle.windows(2) {
        let item = &uses[&pair[0]][&pair[1]];
        text += &format!("\n    {} uses `{item}` of {}", name(&pair[0]), name(&pair[1]));
    }
    let others: Vec<String> = group.iter().filter(|file| !circle.contains(file)).map(name).collect();
    if !others.is_empty() {
        text += &format!("\n    tied to them: {}", others.join(", "));
    }
    text
}
