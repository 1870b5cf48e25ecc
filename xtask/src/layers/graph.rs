//! Which packages use which, read from the output of `cargo metadata`, for the check of the layers.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::PathBuf;

use anyhow::Context as _;
use serde_json::Value;

/// Which package uses which, by name. Dependencies of all kinds count: normal, build and dev.
#[derive(Debug, Default)]
pub struct Graph {
    /// The Cargo.toml of each crate of the workspace.
    ours: BTreeMap<String, String>,
    uses: BTreeMap<String, BTreeSet<String>>,
    roots: Vec<PathBuf>,
}

impl Graph {
    /// Reads the output of `cargo metadata --format-version 1`.
    pub fn from_metadata(metadata: &Value) -> anyhow::Result<Self> {
        let list = |value: &Value, what: &str| -> anyhow::Result<Vec<Value>> {
            value.as_array().cloned().with_context(|| format!("cargo metadata has no {what}"))
        };
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let members: BTreeSet<String> =
            list(&metadata["workspace_members"], "members")?.iter().map(text).collect();
        let mut graph = Self::default();
        let mut names = BTreeMap::new();
        for package in list(&metadata["packages"], "packages")? {
            let (id, name) = (text(&package["id"]), text(&package["name"]));
            if members.contains(&id) {
                graph.ours.insert(name.clone(), text(&package["manifest_path"]));
                for target in list(&package["targets"], "targets")? {
                    let is =
                        |kind: &str| target["kind"].as_array().is_some_and(|all| all.contains(&kind.into()));
                    if is("lib") || is("bin") {
                        graph.roots.push(text(&target["src_path"]).into());
                    }
                }
            }
            names.insert(id, name);
        }
        for node in list(&metadata["resolve"]["nodes"], "resolved graph")? {
            let from = names.get(&text(&node["id"])).context("a node without its package")?;
            let used = graph.uses.entry(from.clone()).or_default();
            for arrow in list(&node["deps"], "arrows")? {
                used.extend(names.get(&text(&arrow["pkg"])).cloned());
            }
        }
        Ok(graph)
    }

    /// The crates of the workspace.
    pub fn ours(&self) -> impl Iterator<Item = &str> {
        self.ours.keys().map(String::as_str)
    }

    /// The root files of the libraries and programs of the workspace.
    pub fn roots(&self) -> &[PathBuf] {
        &self.roots
    }

    /// Whether `name` is a crate of the workspace.
    pub fn is_ours(&self, name: &str) -> bool {
        self.ours.contains_key(name)
    }

    /// The Cargo.toml of a crate of the workspace.
    pub fn manifest(&self, name: &str) -> &str {
        self.ours.get(name).map_or("its Cargo.toml", String::as_str)
    }

    /// What `name` uses directly.
    pub fn direct(&self, name: &str) -> impl Iterator<Item = &String> {
        self.uses.get(name).into_iter().flatten()
    }

    /// The shortest path from our crate `from` to `to` that passes through no other crate of ours; `None` if there is
    /// none.
    pub fn path_outside(&self, from: &str, to: &str) -> Option<Vec<String>> {
        let mut queue = VecDeque::from([vec![from.to_owned()]]);
        let mut seen = BTreeSet::new();
        while let Some(path) = queue.pop_front() {
            let last = path.last()?;
            if last == to {
                return Some(path);
            }
            for next in self.direct(last).filter(|next| !self.is_ours(next)) {
                if seen.insert(next.clone()) {
                    let mut longer = path.clone();
                    longer.push(next.clone());
                    queue.push_back(longer);
                }
            }
        }
        None
    }
}
