//! Lengths in the window, in points: sizes of bars, rows, buttons and icons, and the space around them.

/// Height of the top bar.
pub const TOP_BAR: f32 = 40.0;
/// Height of the bar under the top bar, with the tool's settings.
pub const OPTIONS_BAR: f32 = 40.0;
/// Height of the status line.
pub const STATUS_LINE: f32 = 24.0;
/// Height of the timeline while it is one strip.
pub const STRIP: f32 = 44.0;
/// Width of the tool rail.
pub const RAIL: f32 = 48.0;
/// Height of a row in menus, in lists of commands and keys, and in the inspector's list of paint layers.
pub const ROW: f32 = 28.0;
/// Height of a row in the scene tree, and in the sheet for files.
pub const TREE_ROW: f32 = 26.0;
/// Height of a section's head.
pub const SECTION_HEAD: f32 = 30.0;
/// Height of a field.
pub const FIELD: f32 = 24.0;
/// Width of the label at the left of a field.
pub const LABEL: f32 = 100.0;
/// Width of the place at a row's end for its reset icon.
pub const ROW_END: f32 = 24.0;
/// Height of a button.
pub const BUTTON: f32 = 28.0;
/// Height of a sheet's buttons.
pub const SHEET_BUTTON: f32 = 34.0;
/// Side of a button on the rail.
pub const RAIL_BUTTON: f32 = 38.0;
/// Height of a chip over the picture.
pub const CHIP: f32 = 32.0;
/// Space at the left of a row in the sheet for files, before its icon.
pub const PANEL_PADDING: f32 = 12.0;
/// Space between controls.
pub const GAP: f32 = 8.0;
/// Space around the contents of a sheet.
pub const SHEET_PADDING: f32 = 24.0;
/// Corner radius of fields and buttons.
pub const CORNER: f32 = 4.0;
/// Corner radius of groups and chips.
pub const GROUP_CORNER: f32 = 6.0;
/// Corner radius of sheets and dialogs.
pub const SHEET_CORNER: f32 = 8.0;
/// The least side of anything that can be clicked.
pub const HIT: f32 = 24.0;
/// Size of an icon in a button.
pub const ICON: f32 = 18.0;
/// Size of an icon beside small text.
pub const SMALL_ICON: f32 = 16.0;
/// Size of an icon on the rail.
pub const RAIL_ICON: f32 = 20.0;
