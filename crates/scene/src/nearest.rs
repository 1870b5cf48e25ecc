//! Suggests the known name that a mistyped one was probably meant to be.

/// The known name nearest to a mistyped one; `None` if none is near. Two names of which one begins with the other, such
/// as `Wall` and `Wall.001`, count as near. Only the first thousand known names are compared.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Long texts are no typing mistakes, and comparing them takes time proportional to the product of their lengths.
    const LONGEST: usize = 128;
    const COMPARED: usize = 1000;
    /// If the shorter name has fewer bytes than this, a common beginning is chance.
    const BEGINNING: usize = 3;
    /// The least likeness that counts.
    const ALIKE: f64 = 0.5;
    if name.len() > LONGEST {
        return None;
    }
    let lower = name.to_lowercase();
    let close =
        known.into_iter().take(COMPARED).filter(|candidate| candidate.len() <= LONGEST).map(|candidate| {
            let other = candidate.to_lowercase();
            let likeness = strsim::normalized_damerau_levenshtein(&lower, &other);
            let shorter = lower.len().min(other.len());
            let continues = shorter >= BEGINNING && (lower.starts_with(&other) || other.starts_with(&lower));
            (if continues { likeness.max(ALIKE) } else { likeness }, candidate)
        });
    let (likeness, candidate) = close.max_by(|left, right| left.0.total_cmp(&right.0))?;
    (likeness >= ALIKE).then_some(candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_and_other_ends_are_near_and_chance_is_not() {
        let known = ["Lamp", "WallBack", "Fern", "Bo"];
        assert_eq!(nearest("Lmap", known), Some("Lamp"));
        assert_eq!(nearest("Wall", known), Some("WallBack"));
        assert_eq!(nearest("Fern.001", known), Some("Fern"));
        assert_eq!(nearest("Bottle", known), None);
        assert_eq!(nearest("Chair", known), None);
    }
}
