//! Refusals: why a command or a gesture was not carried out, in the words to show.

use impasto_scene::problem::Report;

/// A command or a gesture that is refused, with the words to show: *skin is locked*.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

impl Refusal {
    /// The refusal of a document or a file, in the words of its first fatal problem; of its first problem if none is
    /// fatal.
    pub fn of(report: &Report) -> Self {
        let first = report.0.iter().find(|problem| problem.severity.is_fatal()).or(report.0.first());
        Self(first.map_or_else(String::new, |problem| format!("{}; {}", problem.message, problem.mend)))
    }

    pub(crate) fn new(words: impl Into<String>) -> Self {
        Self(words.into())
    }

    pub(crate) fn of_another(region: &str, own: &str, other: &str) -> Self {
        Self(format!("The region {region} is of {own}, not of {other}: choose New region"))
    }

    pub(crate) fn unknown(what: &str, name: &str) -> Self {
        Self(format!("There is no {what} named \"{name}\""))
    }
}
