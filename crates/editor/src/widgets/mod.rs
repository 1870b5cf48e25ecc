//! The house's own controls. Every one takes the name that a screen reader says and a test finds it by, can be reached by
//! the keyboard, and is at least 24 points high.

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
mod mode_switch;
mod rail_button;
mod section;
mod segmented;
mod tip;
mod toast;
mod tree_row;

pub use axis_ball::{AxisBall, BallResponse};
pub use brush_thumbnail::brush_thumbnail;
pub use button::{Button, icon_button, icon_toggle, primary_button};
pub use check::{checkbox, radio};
pub use chip::{chip, chip_divider};
pub use color_square::color_square;
pub use combo::combo;
pub use dialog::{Dialog, DialogResponse, dialog};
pub use field::{FieldResponse, NumberField};
pub use key_cap::{key_cap, key_hint};
pub use mode_switch::mode_switch;
pub use rail_button::rail_button;
pub use section::section;
pub use segmented::{segmented, switches};
pub use tip::Tip;
pub use toast::{Toast, toasts};
pub use tree_row::{RowMark, RowResponse, TreeRow};
