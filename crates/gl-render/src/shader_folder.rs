//! A folder of shaders that stand in for the program's own, looked at now and then: for whoever works on a look of their own.

use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::gl::ShaderTexts;

/// More than this is no shader.
const MOST_BYTES: u64 = 1 << 20;

/// Size and time of a file; none where it is not there.
type Look = Option<(u64, Option<SystemTime>)>;

/// The folder, and how its files looked last.
#[derive(Debug)]
pub struct ShaderFolder {
    path: PathBuf,
    known: Vec<Look>,
    /// As they looked a moment ago, where that is other: they may still be being written.
    seen: Option<Vec<Look>>,
}

impl ShaderFolder {
    /// A folder laid out as the program's own `shaders/`; it may hold any of those files. Also what they say now.
    ///
    /// # Errors
    /// Words for people: nothing of it is there, or a file cannot be read.
    pub fn open(path: &Path) -> Result<(Self, ShaderTexts), String> {
        let known = looks(path);
        let texts = read(path)?;
        if texts.is_empty() {
            let paths: Vec<&str> = ShaderTexts::paths().take(3).collect();
            return Err(format!(
                "{} holds no shader: its files are called as those of the program, such as {}",
                path.display(),
                paths.join(", ")
            ));
        }
        Ok((Self { path: path.to_owned(), known, seen: None }, texts))
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Looks once. What the files say, where they changed since they were read last, and have come to rest since: they look the
    /// same twice. Files that are gone leave their place to the program's own.
    ///
    /// # Errors
    /// Words for people: a file cannot be read.
    pub fn look(&mut self) -> Option<Result<ShaderTexts, String>> {
        let now = looks(&self.path);
        if now == self.known {
            self.seen = None;
            return None;
        }
        if self.seen.as_ref() != Some(&now) {
            self.seen = Some(now);
            return None;
        }
        (self.known, self.seen) = (now, None);
        Some(read(&self.path))
    }
}

fn looks(folder: &Path) -> Vec<Look> {
    let look = |path: &str| {
        let metadata = std::fs::metadata(folder.join(path)).ok().filter(std::fs::Metadata::is_file)?;
        Some((metadata.len(), metadata.modified().ok()))
    };
    ShaderTexts::paths().map(look).collect()
}

fn read(folder: &Path) -> Result<ShaderTexts, String> {
    let mut texts = ShaderTexts::default();
    for path in ShaderTexts::paths() {
        let file = folder.join(path);
        if !file.is_file() {
            continue;
        }
        let words = |what: &dyn std::fmt::Display| format!("{}: {what}", file.display());
        let mut text = String::new();
        let opened = std::fs::File::open(&file).map_err(|error| words(&error))?;
        opened.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(|error| words(&error))?;
        if text.len() as u64 > MOST_BYTES {
            return Err(words(&"more than 1 MB: this is no shader"));
        }
        texts.put(path, text);
    }
    Ok(texts)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_are_read_again_once_they_have_come_to_rest() {
        let folder = tempfile::tempdir().unwrap();
        let words = ShaderFolder::open(folder.path()).unwrap_err();
        assert!(words.contains("holds no shader") && words.contains("shared/"), "{words}");
        let file = folder.path().join("shared/encode.glsl");
        fs::create_dir(folder.path().join("shared")).unwrap();
        fs::write(&file, "one").unwrap();
        fs::write(folder.path().join("shared/notes.txt"), "no shader").unwrap();
        let texts = |text: &str| {
            let mut texts = ShaderTexts::default();
            texts.put("shared/encode.glsl", text.to_owned());
            texts
        };
        let (mut shaders, first) = ShaderFolder::open(folder.path()).unwrap();
        assert_eq!(first, texts("one"));
        assert_eq!(shaders.look(), None);
        fs::write(&file, "another").unwrap();
        assert_eq!(shaders.look(), None, "it may be half written");
        assert_eq!(shaders.look(), Some(Ok(texts("another"))));
        assert_eq!(shaders.look(), None);
        fs::remove_file(&file).unwrap();
        assert_eq!([shaders.look(), shaders.look()], [None, Some(Ok(ShaderTexts::default()))]);
        fs::write(&file, vec![b'x'; (MOST_BYTES + 1) as usize]).unwrap();
        assert_eq!(shaders.look(), None);
        let words = shaders.look().unwrap().unwrap_err();
        assert!(words.contains("no shader"), "{words}");
    }
}
