//! Files that changed, and scenes that could not be read whole: what the window asks for about them.

use impasto_scene::problem::Report;

use super::Editor;
use crate::document::{SaveError, Step};
use crate::refusal::Refusal;
use crate::watch::News;

/// Something to do about what is wrong with the document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mend {
    /// Mends the loss at this place of the source.
    Fix(usize),
    /// Mends everything that can be mended in one way only.
    FixCertain,
    /// A guide of a region goes onto its surface.
    Snap(String, usize),
    /// Reads this text in place of the source.
    ReadText(String),
    /// Reads the file again, as far as it can be read.
    ReadAgain,
}

impl Editor {
    /// Does something about what is wrong. Whether anything changed.
    pub fn mend(&mut self, mend: &Mend) -> bool {
        let first = |report: Report| Refusal::of(&report);
        let result = match mend {
            Mend::Fix(loss) => self.document.fix_problem(*loss),
            Mend::FixCertain => self.document.fix_certain(),
            Mend::Snap(region, guide) => self.document.snap_guide(region, *guide),
            Mend::ReadText(text) => self.document.read_text(text),
            Mend::ReadAgain => self.document.read_again().map_err(first),
        };
        self.version += 1;
        self.told(result)
    }

    /// Saves in the place of what somebody else wrote.
    ///
    /// # Errors
    /// See [`crate::Document::save_over`].
    pub fn save_over(&mut self) -> Result<(), SaveError> {
        self.document.save_over()?;
        self.say(format!("Saved {}", self.document.name()));
        Ok(())
    }

    /// Takes in what changed on the disk, where that drops no edit: view, selection and mode stay. False where the user has
    /// to be asked.
    pub fn take_in(&mut self, news: News) -> bool {
        let name = self.document.name();
        let kept = |error: String| {
            Refusal::new(format!("{name} changed on disk; what was read last stays: {error}"))
        };
        let result = match news {
            News::Scene if self.document.is_edited() => return false,
            // What is being mended by another hand shows what is left to mend.
            News::Scene if self.document.source().is_some() => {
                self.document.read_again().map_err(|report| kept(Refusal::of(&report).0))
            }
            News::Scene => self.document.reload().map_err(|report| kept(Refusal::of(&report).0)),
            News::Files => match self.document.source().map(|source| source.text.clone()) {
                Some(text) => self.document.read_text(&text),
                None => {
                    let nothing = Step { text: String::new(), note: None };
                    self.document.read_files_again().map(|()| nothing).map_err(|refusal| kept(refusal.0))
                }
            },
        };
        self.version += 1;
        match result {
            Ok(_) => self.say(format!("{name} changed on disk, and was read again")),
            Err(refusal) => self.refuse(&refusal),
        }
        true
    }
}
