//! The history: steps that can be undone and redone, and which of them are saved.

use std::sync::Arc;

use crate::change::SceneChange;
use crate::selection::Selection;
use crate::source::Source;

/// The history forgets its oldest entries beyond this many bytes.
const BUDGET_BYTES: usize = 256 << 20;

/// Steps with the same merge key this close in time become one entry.
const MERGE_SECONDS: f64 = 1.0;

/// One step that can be undone.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) text: String,
    pub(crate) change: SceneChange,
    /// What was selected before and after.
    pub(crate) selections: [Selection; 2],
    pub(crate) merge_key: Option<String>,
    pub(crate) at_secs: f64,
    /// The document's source text before and after; none if the step does not change it.
    pub(crate) sources: Option<[Option<Arc<Source>>; 2]>,
    serial: u64,
}

/// Done and undone steps, and after which of them the file was saved.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    done: Vec<Entry>,
    undone: Vec<Entry>,
    next_serial: u64,
    /// The serial of the last entry that was dropped to save memory.
    forgotten: u64,
    /// The serial of the last done entry when the file was saved, or `forgotten` if no entry was done then. None if the
    /// file was never saved in a state of this history.
    saved: Option<u64>,
}

impl History {
    pub(crate) fn new(is_saved: bool) -> Self {
        Self { saved: is_saved.then_some(0), next_serial: 1, ..Self::default() }
    }

    pub(crate) fn push(&mut self, text: String, change: SceneChange, selections: [Selection; 2]) {
        self.undone.clear();
        let serial = self.next_serial;
        self.next_serial += 1;
        self.done.push(Entry {
            text,
            change,
            selections,
            merge_key: None,
            at_secs: f64::NEG_INFINITY,
            sources: None,
            serial,
        });
        let mut bytes: usize = self.done.iter().map(|entry| entry.change.bytes()).sum();
        while bytes > BUDGET_BYTES && self.done.len() > 1 {
            let oldest = self.done.remove(0);
            bytes -= oldest.change.bytes();
            self.forgotten = oldest.serial;
        }
    }

    /// Whether a step with this key at this time joins the last entry; never if the file was saved after that entry.
    pub(crate) fn mergeable(&self, key: &str, at_secs: f64) -> bool {
        self.undone.is_empty()
            && self.done.last().is_some_and(|entry| {
                entry.merge_key.as_deref() == Some(key)
                    && (at_secs - entry.at_secs).abs() <= MERGE_SECONDS
                    && self.saved != Some(entry.serial)
            })
    }

    pub(crate) fn mark_last(&mut self, merge_key: String, at_secs: f64) {
        if let Some(entry) = self.done.last_mut() {
            (entry.merge_key, entry.at_secs) = (Some(merge_key), at_secs);
        }
    }

    pub(crate) fn mark_sources(&mut self, sources: [Option<Arc<Source>>; 2]) {
        if let Some(entry) = self.done.last_mut() {
            entry.sources = Some(sources);
        }
    }

    pub(crate) fn last_change(&self) -> Option<&SceneChange> {
        self.done.last().map(|entry| &entry.change)
    }

    /// Replaces the change of the last entry. Without a change, removes the entry. Returns whether the entry is still
    /// there.
    pub(crate) fn replace_last(&mut self, change: Option<SceneChange>, selection: Selection) -> bool {
        let Some(change) = change else {
            self.done.pop();
            return false;
        };
        if let Some(entry) = self.done.last_mut() {
            entry.change = change;
            entry.selections[1] = selection;
        }
        !self.done.is_empty()
    }

    pub(crate) fn undo(&mut self) -> Option<&Entry> {
        let entry = self.done.pop()?;
        self.undone.push(entry);
        self.undone.last()
    }

    pub(crate) fn redo(&mut self) -> Option<&Entry> {
        let entry = self.undone.pop()?;
        self.done.push(entry);
        self.done.last()
    }

    pub(crate) fn next_undo(&self) -> Option<&Entry> {
        self.done.last()
    }

    pub(crate) fn next_redo(&self) -> Option<&Entry> {
        self.undone.last()
    }

    pub(crate) fn mark_saved(&mut self) {
        self.saved = Some(self.here());
    }

    /// How many steps of undo or redo lead back to the saved state. If it cannot be reached, the number of done steps.
    pub(crate) fn since_saved(&self) -> usize {
        let Some(saved) = self.saved else { return self.done.len() };
        if saved == self.forgotten {
            return self.done.len();
        }
        let done = self.done.iter().rposition(|entry| entry.serial == saved);
        let undone = self.undone.iter().rposition(|entry| entry.serial == saved);
        match (done, undone) {
            (Some(index), _) => self.done.len() - 1 - index,
            (None, Some(index)) => self.undone.len() - index,
            (None, None) => self.done.len(),
        }
    }

    pub(crate) fn is_saved(&self) -> bool {
        self.saved == Some(self.here())
    }

    pub(crate) fn count(&self) -> usize {
        self.done.len()
    }

    fn here(&self) -> u64 {
        self.done.last().map_or(self.forgotten, |entry| entry.serial)
    }
}
