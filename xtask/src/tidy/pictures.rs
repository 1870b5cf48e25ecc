//! Checks that no picture, and no other file, is too big for the repository.

use super::finding::Finding;
use super::tree::extension;

/// Greatest size of a golden picture.
const GOLDEN_LIMIT_BYTES: u64 = 64 * 1024;
/// Greatest size of a picture of the docs.
pub const DOCS_LIMIT_BYTES: u64 = 400 * 1024;
/// Greatest size of any file.
const FILE_LIMIT_BYTES: u64 = 1024 * 1024;

/// A finding if the file is bigger than its kind may be.
pub fn check(file: &str, bytes: u64) -> Option<Finding> {
    let is_picture = matches!(extension(file), "png" | "jpg" | "jpeg" | "webp" | "gif" | "svg");
    let (limit, mend) = if is_picture && file.split('/').any(|part| part == "goldens" || part == "snapshots")
    {
        (GOLDEN_LIMIT_BYTES, "compare a smaller picture")
    } else if is_picture && file.starts_with("docs/") {
        (DOCS_LIMIT_BYTES, "show it smaller (`cargo xtask gallery` finds a size that fits)")
    } else {
        (FILE_LIMIT_BYTES, "make it from code when it is needed, or keep a smaller one")
    };
    let what = || format!("{} KB, where at most {} KB are kept", bytes.div_ceil(1024), limit / 1024);
    (bytes > limit).then(|| Finding::of_file(file, what(), mend))
}
