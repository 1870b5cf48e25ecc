//! Decides when the next copy of unsaved work is due.

/// Edits after which a copy is due, however little time they took.
pub const EDITS: u64 = 20;

/// Decides when unsaved work is copied: some time after the first edit since the last copy, or after [`EDITS`] edits.
#[derive(Clone, Debug, Default)]
pub struct Cadence {
    /// The revision that the last copy has.
    kept: Option<u64>,
    /// When the first edit after that copy was noticed.
    since_secs: Option<f64>,
}

impl Cadence {
    /// Whether a copy is due now; if so, it counts as made. `edited` is the document's revision, or `None` if it has no
    /// unsaved edits. The time is the caller's clock.
    pub fn is_due(&mut self, edited: Option<u64>, now_secs: f64, every_secs: f64) -> bool {
        let Some(revision) = edited else {
            *self = Self::default();
            return false;
        };
        if self.kept == Some(revision) {
            self.since_secs = None;
            return false;
        }
        let since = *self.since_secs.get_or_insert(now_secs);
        let from = *self.kept.get_or_insert(revision.saturating_sub(1));
        let is_due = now_secs - since >= every_secs || revision.abs_diff(from) >= EDITS;
        if is_due {
            self.kept_now(revision);
        }
        is_due
    }

    /// Notes that a copy of this revision was made.
    pub fn kept_now(&mut self, revision: u64) {
        (self.kept, self.since_secs) = (Some(revision), None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_due_after_some_time_or_many_edits_and_never_twice() {
        let mut cadence = Cadence::default();
        assert!(!cadence.is_due(None, 0.0, 120.0));
        assert!(!cadence.is_due(Some(5), 10.0, 120.0));
        assert!(!cadence.is_due(Some(6), 129.0, 120.0));
        assert!(cadence.is_due(Some(6), 130.0, 120.0));
        assert!(!cadence.is_due(Some(6), 1000.0, 120.0), "nothing new");
        // The time counts from the next edit on.
        assert!(!cadence.is_due(Some(7), 1001.0, 120.0));
        assert!(cadence.is_due(Some(7), 1121.0, 120.0));
        assert!(!cadence.is_due(Some(7 + EDITS - 1), 1122.0, 120.0));
        assert!(cadence.is_due(Some(7 + EDITS), 1122.0, 120.0), "many edits");
        // Saved in between.
        assert!(!cadence.is_due(None, 1123.0, 120.0));
        assert!(!cadence.is_due(Some(40), 1124.0, 120.0));
    }
}
