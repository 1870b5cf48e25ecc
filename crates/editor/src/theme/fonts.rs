//! The fonts of the window.

use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

use super::type_face::{ICONS, SEMIBOLD};

const INTER: &[u8] = include_bytes!("../../fonts/Inter-Regular.otf");
const INTER_SEMIBOLD: &[u8] = include_bytes!("../../fonts/Inter-SemiBold.otf");

/// Inter, with egui's own fonts as a fallback for glyphs that it lacks.
pub(super) fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let mut icons = egui_material_icons::font_insert().data;
    // The icon fills its em square; an offset would push it off the line that it is centred on.
    icons.tweak.y_offset_factor = 0.0;
    for (name, data) in [
        ("Inter", FontData::from_static(INTER)),
        (SEMIBOLD, FontData::from_static(INTER_SEMIBOLD)),
        (ICONS, icons),
    ] {
        fonts.font_data.insert(name.to_owned(), Arc::new(data));
    }
    let proportional = fonts.families.entry(FontFamily::Proportional).or_default();
    let semibold: Vec<_> = std::iter::once(SEMIBOLD.to_owned()).chain(proportional.iter().cloned()).collect();
    proportional.insert(0, "Inter".to_owned());
    fonts.families.insert(FontFamily::Name(SEMIBOLD.into()), semibold);
    fonts.families.insert(FontFamily::Name(ICONS.into()), vec![ICONS.to_owned()]);
    fonts
}
