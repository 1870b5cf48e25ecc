//! The fonts and sizes of all text: Inter for words, Hack for numbers and code, Material Symbols Rounded for icons.

use egui::{FontFamily, FontId};

/// The family of headings and main buttons: Inter SemiBold.
pub const SEMIBOLD: &str = "semibold";
/// The family of icons.
pub const ICONS: &str = "icons";

/// Words: Inter 13.
pub fn body() -> FontId {
    FontId::proportional(13.0)
}

/// Notes and hints: Inter 12.
pub fn small() -> FontId {
    FontId::proportional(12.0)
}

/// Heads of panels and sections: Inter SemiBold 13.
pub fn head() -> FontId {
    semibold(13.0)
}

/// Titles of dialogs, of the steps on the welcome sheet, and of the sheets for files and rendering: Inter SemiBold 15.
pub fn title() -> FontId {
    semibold(15.0)
}

/// Titles of all other sheets: Inter SemiBold 20.
pub fn sheet_title() -> FontId {
    semibold(20.0)
}

/// Numbers and code: Hack 12.
pub fn number() -> FontId {
    FontId::monospace(12.0)
}

/// Numbers on the ruler, letters on the rail: Hack 10.
pub fn ruler() -> FontId {
    FontId::monospace(10.0)
}

/// An icon of `size` points.
pub fn icon(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name(ICONS.into()))
}

fn semibold(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name(SEMIBOLD.into()))
}
