//! Shows a folder in the desktop's file manager.

use std::path::Path;
use std::process::{Command, Stdio};

/// The program that opens a folder on this system.
const OPENER: &str = if cfg!(target_os = "macos") {
    "open"
} else if cfg!(windows) {
    "explorer"
} else {
    "xdg-open"
};

/// Shows a folder in the desktop's file manager.
///
/// # Errors
/// If the program cannot be started: a message that names the folder.
pub fn show_folder(folder: &Path) -> Result<(), String> {
    let mut command = Command::new(OPENER);
    command.arg(folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().map_err(|error| {
        format!("{OPENER} cannot be started ({error}); the files are in {}", folder.display())
    })?;
    // Waits for the program to end, so that it does not stay a zombie.
    std::thread::spawn(move || drop(child.wait()));
    Ok(())
}
