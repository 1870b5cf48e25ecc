//! The editor's own controls. Each has a name, which screen readers say and by which tests find it. Each can be reached
//! with the keyboard and is at least 24 points high.

mod axis_ball;
mod brush_thumbnail;
mod button;
mod check;
mod chip;
mod color_square;
mod combo;
mod dialog;
mod draw;
mod field;
mod key_cap;
mod menu_row;
mod mode_switch;
mod open_menu;
mod rail_button;
mod reach;
mod section;
mod segmented;
mod tip;
mod toast;
mod toggle_group;
mod tree_row;

pub use axis_ball::{AxisBall, BallResponse};
pub use brush_thumbnail::brush_thumbnail;
pub use button::{Button, field_button, icon_button, icon_toggle, primary_button};
pub use check::{checkbox, checkbox_named, radio, radio_named};
pub use chip::{chip, chip_divider};
pub use color_square::color_square;
pub use combo::{combo, drop_down};
pub(crate) use dialog::sheet;
pub use dialog::{Dialog, DialogResponse, dialog};
pub use field::{FieldResponse, NumberField};
pub use key_cap::{key_cap, key_hint};
pub use menu_row::MenuRow;
pub use mode_switch::mode_switch;
pub(crate) use open_menu::{note_open_menu, press_closes_menu};
pub use rail_button::rail_button;
pub(crate) use reach::{enter_part, reach, reachable, reached};
pub use section::section;
pub use segmented::{segmented, segmented_named, segmented_of, segmented_width};
pub use tip::Tip;
pub use toast::{Toast, toasts};
pub use toggle_group::{TOGGLE_GROUP, toggle_group};
pub use tree_row::{RowMark, RowResponse, TreeRow};
