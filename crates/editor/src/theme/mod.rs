//! How the window looks: colours by meaning, type, measures, and egui's own style set from them.

mod fonts;
pub mod measure;
mod style;
mod tokens;
pub mod type_face;

pub use style::{apply, fitting_scale};
pub use tokens::{DARK, LIGHT, Theme, Tokens};
