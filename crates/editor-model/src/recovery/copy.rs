//! The file of a copy of unsaved work: a scene file with comment lines above it. The comments say what it is a copy of.
//! They also hold the text that the scene was read from, if parts of it could not be read, and the user's unfinished
//! edit of that text, if there is one.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use impasto_scene::assets::read_regular_file;
use impasto_scene::limits::MAX_SCENE_BYTES;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::save;

use crate::stamp::{Stamp, hash};

/// The first and the last comment line above the scene.
const FIRST: &str = "// Impasto: a copy of unsaved work, 1";
const LAST: &str = "// end of what it is a copy of";

/// Prefixes of lines: of the text that the scene was read from, and of that text as the user is editing it.
const SOURCE: &str = "// source| ";
const UNREAD: &str = "// edited| ";

/// Longer texts are not written above the scene.
const MAX_BESIDE_BYTES: usize = 4 << 20;

/// Unsaved work to be copied.
#[derive(Clone, Debug)]
pub struct Work {
    /// The copy without its text. The text is made from the scene when the copy is written.
    pub copy: Copy,
    /// The scene.
    pub scene: Arc<LoadedScene>,
}

/// A copy of unsaved work, with its origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Copy {
    /// The scene's own file; none if it was never saved.
    pub file: Option<PathBuf>,
    /// An absolute path in the folder that the scene's own paths are relative to.
    pub path: PathBuf,
    /// The stamp of the scene file as it was last read or saved; none if there is no file, or its stamp could not be
    /// taken then.
    pub stamp: Option<Stamp>,
    /// When the copy was made, seconds since 1970.
    pub at_unix_secs: u64,
    /// How many unsaved entries of the history there are.
    pub changes: usize,
    /// Whether parts of the scene's text could not be read, so that the copy must not overwrite the scene's file.
    pub lossy: bool,
    /// The scene as text; empty before it is written.
    pub text: String,
    /// The text that the scene was read from, if parts of it could not be read.
    pub source: Option<String>,
    /// A hash of what could not be read in that text.
    pub losses: Option<u64>,
    /// The text in `source` as the user has edited it; the scene was not read from it yet.
    pub unread: Option<String>,
}

impl Work {
    /// The text of the whole file.
    pub(super) fn to_text(&self) -> String {
        let Copy { file, path, stamp, at_unix_secs, changes, lossy, source, losses, unread, .. } = &self.copy;
        let scene = save::to_ron(&self.scene.scene);
        let mut lines = vec![FIRST.to_owned()];
        let mut line = |key: &str, value: String| lines.push(format!("// {key}: {value}"));
        if let Some(file) = file {
            line("file", escaped(file));
        }
        line("path", escaped(path));
        if let Some(Stamp { bytes, modified, hash }) = stamp {
            let nanos = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
            let nanos = nanos.map_or_else(|| "-".to_owned(), |since| since.as_nanos().to_string());
            line("stamp", format!("{bytes} {nanos} {hash:x}"));
        }
        line("at", at_unix_secs.to_string());
        line("changes", changes.to_string());
        line("lossy", lossy.to_string());
        if let Some(losses) = losses {
            line("losses", format!("{losses:x}"));
        }
        line("hash", format!("{:x}", hash(scene.as_bytes())));
        for (prefix, text) in [(SOURCE, source), (UNREAD, unread)] {
            let text = text.as_ref().filter(|text| text.len() <= MAX_BESIDE_BYTES);
            lines.extend(
                text.into_iter().flat_map(|text| text.split('\n')).map(|line| format!("{prefix}{line}")),
            );
        }
        lines.push(LAST.to_owned());
        lines.push(scene);
        lines.join("\n")
    }
}

impl Copy {
    /// Reads a copy back; none if it is not complete.
    pub(super) fn read(file: &Path) -> Option<Self> {
        // A text of empty lines takes the most space above the scene, since each line gets a prefix.
        let most_beside = (2 * (SOURCE.len() + 1) * MAX_BESIDE_BYTES) as u64;
        let bytes = read_regular_file(file, MAX_SCENE_BYTES + most_beside + (64 << 10)).ok()?;
        Self::parse(std::str::from_utf8(&bytes).ok()?)
    }

    fn parse(text: &str) -> Option<Self> {
        let (head, scene) = text.split_once(&format!("\n{LAST}\n"))?;
        let mut lines = head.split('\n');
        if lines.next()? != FIRST {
            return None;
        }
        let beside = |prefix: &str| {
            let lines: Vec<&str> = lines.clone().filter_map(|line| line.strip_prefix(prefix)).collect();
            (!lines.is_empty()).then(|| lines.join("\n"))
        };
        let (source, unread) = (beside(SOURCE), beside(UNREAD));
        let is_beside = |line: &&str| line.starts_with(SOURCE) || line.starts_with(UNREAD);
        let heads = lines.filter(|line| !is_beside(line));
        let pairs: Vec<(&str, &str)> =
            heads.filter_map(|line| line.strip_prefix("// ")?.split_once(": ")).collect();
        let value = |key: &str| pairs.iter().find(|pair| pair.0 == key).map(|pair| pair.1);
        let stamp = || {
            let mut parts = value("stamp")?.split(' ');
            let bytes = parts.next()?.parse().ok()?;
            let nanos: Option<u64> = parts.next()?.parse().ok();
            let modified = nanos.and_then(|nanos| UNIX_EPOCH.checked_add(Duration::from_nanos(nanos)));
            Some(Stamp { bytes, modified, hash: u64::from_str_radix(parts.next()?, 16).ok()? })
        };
        let is_whole = u64::from_str_radix(value("hash")?, 16).ok()? == hash(scene.as_bytes());
        is_whole.then_some(())?;
        Some(Self {
            file: value("file").map(unescaped),
            path: value("path").map(unescaped)?,
            stamp: stamp(),
            at_unix_secs: value("at")?.parse().ok()?,
            changes: value("changes")?.parse().ok()?,
            lossy: value("lossy")?.parse().ok()?,
            text: scene.to_owned(),
            source,
            losses: value("losses").and_then(|losses| u64::from_str_radix(losses, 16).ok()),
            unread,
        })
    }

    /// What the work is called: *still_life.ron*, *Untitled*.
    pub fn name(&self) -> String {
        let name = self.file.as_ref().and_then(|file| file.file_name());
        name.map_or_else(|| "Untitled".to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// How old it is, for people: *5 minutes ago*.
    pub fn age(&self, now: SystemTime) -> String {
        let now = now.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let minutes = now.saturating_sub(self.at_unix_secs) / 60;
        let (count, what) = match minutes {
            0 => return "just now".to_owned(),
            1..60 => (minutes, "minute"),
            60..1440 => (minutes / 60, "hour"),
            _ => (minutes / 1440, "day"),
        };
        if count == 1 { format!("1 {what} ago") } else { format!("{count} {what}s ago") }
    }

    /// Whether the scene file has other bytes now than when the scene was last read from it or saved, or is gone.
    pub fn is_of_another_file(&self) -> bool {
        self.file.as_ref().is_some_and(|file| Stamp::is_other(self.stamp.as_ref(), file))
    }
}

/// A path on one line of text, every byte kept: `%` and what is not printable ASCII are written as `%xx`.
fn escaped(path: &Path) -> String {
    let is_plain = |byte: u8| (b' '..0x7f).contains(&byte) && byte != b'%';
    let bytes = path.as_os_str().as_encoded_bytes().iter();
    bytes
        .map(|&byte| if is_plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02x}") })
        .collect()
}

fn unescaped(text: &str) -> PathBuf {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let code = (first == b'%').then(|| behind.get(..2)).flatten();
        let code = code.and_then(|code| u8::from_str_radix(std::str::from_utf8(code).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &behind[2..] } else { behind };
    }
    path_of(bytes)
}

#[cfg(unix)]
fn path_of(bytes: Vec<u8>) -> PathBuf {
    use std::os::unix::ffi::OsStringExt as _;
    PathBuf::from(std::ffi::OsString::from_vec(bytes))
}

#[cfg(not(unix))]
fn path_of(bytes: Vec<u8>) -> PathBuf {
    PathBuf::from(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages_are_told_in_whole_units() {
        let copy = |at_unix_secs| Copy {
            file: None,
            path: PathBuf::new(),
            stamp: None,
            at_unix_secs,
            changes: 0,
            lossy: false,
            text: String::new(),
            source: None,
            losses: None,
            unread: None,
        };
        let now = UNIX_EPOCH + Duration::from_secs(1_000_000);
        let age = |ago: u64| copy(1_000_000 - ago).age(now);
        assert_eq!(
            [0, 59, 60, 119, 120].map(age),
            ["just now", "just now", "1 minute ago", "1 minute ago", "2 minutes ago"]
        );
        assert_eq!(
            [3600, 7200, 86_400, 200_000].map(age),
            ["1 hour ago", "2 hours ago", "1 day ago", "2 days ago"]
        );
        // A clock that was set back.
        assert_eq!(copy(2_000_000).age(now), "just now");
    }

    #[cfg(unix)]
    #[test]
    fn any_path_comes_back() {
        for bytes in [b"/a b/100%.ron".to_vec(), b"/\xff\n\xc3\xa9/%zz%".to_vec()] {
            let path = path_of(bytes);
            let text = escaped(&path);
            assert!(text.is_ascii() && !text.contains('\n'));
            assert_eq!(unescaped(&text), path);
        }
    }
}
