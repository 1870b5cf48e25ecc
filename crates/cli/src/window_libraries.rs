//! Finds out for `impasto doctor` whether a window could be opened here: looks for a display and for library files, and
//! loads nothing.

use std::path::{Path, PathBuf};

/// Libraries for a window on X11, each with its Debian package.
const X11: &[(&str, &str)] = &[
    ("libX11.so.6", "libx11-6"),
    ("libX11-xcb.so.1", "libx11-xcb1"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
    ("libEGL.so.1", "libegl1"),
];

/// Libraries for a window on Wayland, each with its Debian package.
const WAYLAND: &[(&str, &str)] = &[
    ("libwayland-client.so.0", "libwayland-client0"),
    ("libwayland-egl.so.1", "libwayland-egl1"),
    ("libxkbcommon.so.0", "libxkbcommon0"),
    ("libEGL.so.1", "libegl1"),
];

/// The display for a window, and the packages that are missing.
pub(crate) struct Found {
    /// The display that a window would be on, such as `X11 :0`, if any.
    pub(crate) display: Option<String>,
    /// The missing packages that a window on that display needs; without a display, those for X11.
    pub(crate) packages: Vec<&'static str>,
}

impl Found {
    pub(crate) fn could_open(&self) -> bool {
        self.display.is_some() && self.packages.is_empty()
    }
}

pub(crate) fn find() -> Found {
    let set = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let folders = library_folders();
    let missing = |needs: &[(&str, &'static str)]| -> Vec<&'static str> {
        let is_there = |library: &str| folders.iter().any(|folder| folder.join(library).exists());
        needs.iter().filter(|(library, _)| !is_there(library)).map(|(_, package)| *package).collect()
    };
    let wayland =
        set("WAYLAND_DISPLAY").or_else(|| set("WAYLAND_SOCKET")).map(|name| format!("Wayland {name}"));
    let x11 = set("DISPLAY").map(|name| format!("X11 {name}"));
    let for_wayland = Found { packages: missing(WAYLAND), display: wayland };
    if for_wayland.could_open() || (for_wayland.display.is_some() && x11.is_none()) {
        return for_wayland;
    }
    Found { packages: missing(X11), display: x11 }
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
