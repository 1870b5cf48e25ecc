//! Finds out for `impasto doctor` whether a window could be opened here: looks for a display and for library files, and
//! loads nothing.

use std::path::{Path, PathBuf};

use impasto_system::{FOR_WAYLAND, FOR_X11, Part};

pub(crate) struct Found {
    /// The display that a window would be on, such as `X11 :0`, if any.
    pub(crate) display: Option<String>,
    /// What the system lacks for a window on that display; if there is no display, for one on X11.
    pub(crate) missing: Vec<Part>,
}

impl Found {
    pub(crate) fn could_open(&self) -> bool {
        self.display.is_some() && self.missing.is_empty()
    }
}

pub(crate) fn find() -> Found {
    let set = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let folders = library_folders();
    let missing = |needs: &[Part]| -> Vec<Part> {
        let is_there = |part: &Part| folders.iter().any(|folder| folder.join(part.file).exists());
        needs.iter().filter(|part| !is_there(part)).copied().collect()
    };
    let wayland =
        set("WAYLAND_DISPLAY").or_else(|| set("WAYLAND_SOCKET")).map(|name| format!("Wayland {name}"));
    let x11 = set("DISPLAY").map(|name| format!("X11 {name}"));
    let for_wayland = Found { missing: missing(FOR_WAYLAND), display: wayland };
    if for_wayland.could_open() || (for_wayland.display.is_some() && x11.is_none()) {
        return for_wayland;
    }
    Found { missing: missing(FOR_X11), display: x11 }
}

/// Where the dynamic loader usually looks.
fn library_folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = Vec::new();
    if let Some(path) = std::env::var_os("LD_LIBRARY_PATH") {
        folders.extend(std::env::split_paths(&path));
    }
    for parent in ["/usr/lib", "/lib", "/usr/lib64", "/lib64", "/usr/local/lib"].map(Path::new) {
        folders.push(parent.to_owned());
        let inside = std::fs::read_dir(parent).into_iter().flatten().flatten().map(|entry| entry.path());
        folders.extend(inside.filter(|folder| folder.to_string_lossy().ends_with("-linux-gnu")));
    }
    folders
}
