//! Suggests the known name that a mistyped one was probably meant to be.

/// The known name nearest to a mistyped one; `None` where none is near. Only the first thousand known names are
/// compared.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Long texts are no typing mistakes, and comparing them takes time proportional to the product of their lengths.
    const LONGEST: usize = 128;
    const COMPARED: usize = 1000;
    if name.len() > LONGEST {
        return None;
    }
    let lower = name.to_lowercase();
    let close =
        known.into_iter().take(COMPARED).filter(|candidate| candidate.len() <= LONGEST).map(|candidate| {
            let likeness = strsim::normalized_damerau_levenshtein(&lower, &candidate.to_lowercase());
            (likeness, candidate)
        });
    let (likeness, candidate) = close.max_by(|left, right| left.0.total_cmp(&right.0))?;
    (likeness >= 0.5).then_some(candidate)
}
