//! Saves the document. A message to the user names the file, and any files that the scene will not find from there.

use std::path::Path;

use super::{Editor, losses_of};
use crate::document::SaveError;

impl Editor {
    /// Saves; see [`crate::Document::save`] and [`crate::Document::save_as`].
    ///
    /// # Errors
    /// The errors of those two.
    pub fn save(&mut self, target: Option<&Path>) -> Result<(), SaveError> {
        let missing = match target {
            Some(target) => self.document.save_as(target)?,
            None => self.document.save().map(|_| Vec::new())?,
        };
        self.losses = losses_of(&self.document);
        self.say(format!("Saved {}{}", self.document.name(), without_files(&missing)));
        Ok(())
    }

    /// Saves a copy; see [`crate::Document::save_copy`].
    ///
    /// # Errors
    /// As [`crate::Document::save_copy`].
    pub fn save_copy(&mut self, target: &Path) -> Result<(), SaveError> {
        let missing = self.document.save_copy(target)?;
        self.say(format!("Saved a copy as {}{}", target.display(), without_files(&missing)));
        Ok(())
    }

    /// Saves over a file that another program has changed.
    ///
    /// # Errors
    /// See [`crate::Document::save_over`].
    pub fn save_over(&mut self) -> Result<(), SaveError> {
        self.document.save_over()?;
        self.say(format!("Saved {}", self.document.name()));
        Ok(())
    }
}

/// What follows *Saved s.ron* in the message if files that the scene names were not found.
fn without_files(missing: &[String]) -> String {
    match missing {
        [] => String::new(),
        [one] => format!(" without {one}, which was not found"),
        [first, rest @ ..] => {
            format!(" without {} files that were not found: {first}, {}", missing.len(), rest.join(", "))
        }
    }
}
