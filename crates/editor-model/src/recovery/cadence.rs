//! Decides when the next copy of unsaved work is due.

/// Decides when unsaved work is copied: some time after the first edit since the last copy.
#[derive(Clone, Debug, Default)]
pub struct Cadence {
    /// The version that the last copy has.
    kept: Option<u64>,
    /// When the first edit after that copy was noticed.
    since_secs: Option<f64>,
}

impl Cadence {
    /// Whether a copy is due now: `after_secs` after the first edit since the last copy. If so, it counts as made.
    /// `edited` is a number that changes with each edit, or `None` if there are no unsaved edits. `now_secs` is on the
    /// caller's clock.
    pub fn is_due(&mut self, edited: Option<u64>, now_secs: f64, after_secs: f64) -> bool {
        let Some(version) = edited else {
            *self = Self::default();
            return false;
        };
        if self.kept == Some(version) {
            self.since_secs = None;
            return false;
        }
        let since = *self.since_secs.get_or_insert(now_secs);
        let is_due = now_secs - since >= after_secs;
        if is_due {
            self.kept_now(version);
        }
        is_due
    }

    /// Notes that a copy of this version was made.
    pub fn kept_now(&mut self, version: u64) {
        (self.kept, self.since_secs) = (Some(version), None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_due_some_time_after_the_first_edit_and_never_twice() {
        let mut cadence = Cadence::default();
        assert!(!cadence.is_due(None, 0.0, 10.0));
        assert!(!cadence.is_due(Some(5), 10.0, 10.0));
        // More edits do not delay the copy.
        assert!(!cadence.is_due(Some(6), 19.0, 10.0));
        assert!(cadence.is_due(Some(60), 20.0, 10.0));
        assert!(!cadence.is_due(Some(60), 1000.0, 10.0), "nothing new");
        // The time counts from the next edit on.
        assert!(!cadence.is_due(Some(61), 1001.0, 10.0));
        assert!(cadence.is_due(Some(61), 1011.0, 10.0));
        // An edit that is undone does not count.
        assert!(!cadence.is_due(Some(62), 1011.5, 0.9));
        assert!(!cadence.is_due(Some(61), 1011.6, 0.9));
        assert!(!cadence.is_due(Some(62), 1011.7, 0.9));
        assert!(!cadence.is_due(Some(62), 1012.5, 0.9));
        // The user saves in between.
        assert!(!cadence.is_due(None, 1012.55, 10.0));
        assert!(!cadence.is_due(Some(62), 1013.0, 10.0));
        // Edits after the save are copied, too.
        assert!(cadence.is_due(Some(63), 1023.0, 10.0));
    }
}
