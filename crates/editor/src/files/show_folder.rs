//! A folder in the desktop's own way.

use std::path::Path;
use std::process::{Command, Stdio};

/// What opens a folder on this system.
const OPENER: &str = if cfg!(target_os = "macos") {
    "open"
} else if cfg!(windows) {
    "explorer"
} else {
    "xdg-open"
};

/// Shows a folder to the user.
///
/// # Errors
/// Words that name the folder, where the desktop has nothing to show it with.
pub fn show_folder(folder: &Path) -> Result<(), String> {
    let mut command = Command::new(OPENER);
    command.arg(folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().map_err(|error| {
        format!("{OPENER} cannot be started ({error}); the files are in {}", folder.display())
    })?;
    // Somebody has to hear that it ended.
    std::thread::spawn(move || drop(child.wait()));
    Ok(())
}
