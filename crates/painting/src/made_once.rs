//! Fills a `OnceLock` with a value that is made on many threads.

use std::sync::OnceLock;

/// The value in the cell. If the cell is empty, `make` makes the value, which must always be the same.
///
/// This does not call `make` inside `get_or_init`, because `make` could then not use rayon. A thread that waits for its
/// own rayon tasks runs other tasks meanwhile. If one of these asked for the same cell, it would wait forever for a
/// value that is being made further up on its own stack. Here nobody waits: two threads may make the value at once, and
/// one of the two values is dropped.
pub(crate) fn made_once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    match cell.get() {
        Some(value) => value,
        None => {
            let made = make();
            cell.get_or_init(|| made)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_may_be_asked_for_while_it_is_made() {
        let cell = OnceLock::new();
        assert_eq!(made_once(&cell, || *made_once(&cell, || 7)), &7);
        assert_eq!(made_once(&cell, || unreachable!("it is made")), &7);
    }
}
