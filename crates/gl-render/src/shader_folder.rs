//! A folder with the user's own shaders, which replace those of the program and are read again when they change.

use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::gl::ShaderTexts;

/// A larger file is not a shader.
const MOST_BYTES: u64 = 1 << 20;

/// Size and time of a file; `None` where it does not exist.
type FileStamp = Option<(u64, Option<SystemTime>)>;

/// The folder, and the files that were last read from it.
#[derive(Debug)]
pub struct ShaderFolder {
    path: PathBuf,
    /// Size and time of the files when they were last read.
    read: Vec<FileStamp>,
    /// Size and time of the files at the last check, if they differed from `read`: some may still be half written.
    changing: Option<Vec<FileStamp>>,
}

impl ShaderFolder {
    /// Opens a folder laid out like the program's own `shaders/`, with any of those files in it, and reads them.
    ///
    /// # Errors
    /// A message: none of the files exists, or one cannot be read.
    pub fn open(path: &Path) -> Result<(Self, ShaderTexts), String> {
        let stamps = stamps(path);
        let texts = read(path)?;
        if texts.is_empty() {
            let paths: Vec<&str> = ShaderTexts::paths().take(3).collect();
            return Err(format!(
                "{} holds no shader: its files need the names of the program's own, such as {}",
                path.display(),
                paths.join(", ")
            ));
        }
        Ok((Self { path: path.to_owned(), read: stamps, changing: None }, texts))
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Checks the files once. Changed files are read again only when two checks in a row find the same sizes and times,
    /// since a file that still changes may be half written. The program's own text replaces a file that is gone. `None`
    /// where nothing is read.
    ///
    /// # Errors
    /// A message: a file cannot be read.
    pub fn look(&mut self) -> Option<Result<ShaderTexts, String>> {
        let now = stamps(&self.path);
        if now == self.read {
            self.changing = None;
            return None;
        }
        if self.changing.as_ref() != Some(&now) {
            self.changing = Some(now);
            return None;
        }
        (self.read, self.changing) = (now, None);
        Some(read(&self.path))
    }
}

fn stamps(folder: &Path) -> Vec<FileStamp> {
    let stamp = |path: &str| {
        let metadata = std::fs::metadata(folder.join(path)).ok().filter(std::fs::Metadata::is_file)?;
        Some((metadata.len(), metadata.modified().ok()))
    };
    ShaderTexts::paths().map(stamp).collect()
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
    fn files_are_read_again_once_they_no_longer_change() {
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
