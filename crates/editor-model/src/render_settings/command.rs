//! The `impasto render` command line that renders the same frames as the editor's render sheet, for the user to copy.

use super::{Existing, FileKind, RenderDriver, RenderPlan};
use crate::document::Document;

impl RenderPlan {
    /// The arguments with which `impasto` writes the same files.
    ///
    /// # Errors
    /// If the scene has no file, or was read with losses, because the command reads the file. Unsaved edits are no
    /// error, but the command does not see them.
    pub fn command(&self, document: &Document) -> Result<Vec<String>, String> {
        let Some(file) = document.file() else {
            return Err("Save the scene first: a command reads its file".to_owned());
        };
        if document.loss_count() > 0 {
            return Err("Mend the scene's problems first: a command reads its file".to_owned());
        }
        let file = std::path::absolute(file).map_err(|error| error.to_string())?;
        let mut words: Vec<String> = vec!["render".to_owned(), file.to_string_lossy().into_owned()];
        let [width, height] = self.size_px;
        // Written with `=`, because the list of frames may begin with a minus.
        words.push(format!("--frames={}", self.list));
        words.extend(["--size".to_owned(), format!("{width}x{height}")]);
        words.extend(["--output".to_owned(), self.output.to_string_lossy().into_owned()]);
        match self.kind {
            FileKind::Png8 | FileKind::Exr | FileKind::Movie => {}
            FileKind::Png16 => words.extend(["--bits".to_owned(), "16".to_owned()]),
            FileKind::PngAndExr => words.push("--exr".to_owned()),
        }
        let aovs = self.aovs.command_words(&self.loaded.scene).filter(|_| self.kind.has_exr());
        words.extend(aovs.into_iter().flat_map(|names| ["--aov".to_owned(), names]));
        match self.driver {
            RenderDriver::Automatic => {}
            RenderDriver::Egl => words.extend(["--driver".to_owned(), "egl".to_owned()]),
            RenderDriver::Osmesa => words.extend(["--driver".to_owned(), "osmesa".to_owned()]),
        }
        if self.transparent {
            words.push("--alpha".to_owned());
        }
        if self.existing == Existing::Keep {
            words.push("--skip-existing".to_owned());
        }
        Ok(words)
    }
}

/// A command as it is typed into a shell.
pub fn shell_words(program: &str, arguments: &[String]) -> String {
    let quoted = |word: &str| {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_=./:,+".contains(c);
        if !word.is_empty() && word.chars().all(is_plain) {
            word.to_owned()
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    };
    let words = std::iter::once(program).chain(arguments.iter().map(String::as_str)).map(quoted);
    words.collect::<Vec<_>>().join(" ")
}
