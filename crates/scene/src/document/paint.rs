//! Layers of paint, brushes, and how paint ends at borders, as a scene file states them.

use serde::{Deserialize, Serialize};

use super::color::Color;
use super::numbers::number;
use super::{Number, is_default};
use crate::limits::{MAX_COVERAGE, MAX_STROKE_PX, MAX_THICKNESS};

/// A number of [`LayerSettings`].
#[derive(Clone, Debug)]
pub struct LayerNumber {
    /// Its name, its range in a scene file, what it does, and how to get and set it.
    pub number: Number<LayerSettings, Option<f64>>,
    /// A reference to the same number of a resolved layer, through which it is set.
    pub resolved: fn(&mut ResolvedLayer) -> &mut f32,
}

/// Declares [`LayerSettings`] and [`ResolvedLayer`] with these numbers.
macro_rules! layer_numbers {
    ($($(#[doc = $effect:literal])+ $field:ident: $limits:expr,)+) => {
        /// One layer of paint: its own strokes, laid over those of the layers before it.
        #[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
        #[serde(deny_unknown_fields)]
        pub struct LayerSettings {
            /// `underpainting`, `body`, `form`, `scumble`, `accents`, `contour` or `lights`; `ground` is the tone under
            /// all of them.
            pub name: String,
            /// Brush, or a mix of brushes.
            #[serde(default, skip_serializing_if = "is_default")]
            pub brush: Option<BrushMix>,
            /// Leaves the layer out of the picture, and keeps its numbers. A hidden `ground` loses only its tone: the
            /// wash of the body's colour stays. In a region, `false` shows a layer that the scene hides.
            #[serde(default, skip_serializing_if = "is_default")]
            pub hidden: Option<bool>,
            $($(#[doc = $effect])+ #[serde(default, skip_serializing_if = "is_default")] pub $field: Option<f64>,)+
            /// Tone of the ground; for `ground` alone.
            #[serde(default, skip_serializing_if = "is_default")]
            pub color: Option<Color>,
        }

        impl LayerSettings {
            /// Every number of a layer.
            pub const NUMBERS: &'static [LayerNumber] = &[
                $(LayerNumber {
                    number: number!($field, $limits, concat!($($effect),+)),
                    resolved: |layer| &mut layer.$field,
                },)+
            ];
        }

        /// One layer of paint with nothing left out.
        #[derive(Clone, Debug, PartialEq)]
        pub struct ResolvedLayer {
            /// Brushes by name; one named twice is taken twice as often. At least one.
            pub brushes: Vec<String>,
            /// Whether the layer is left out of the picture.
            pub hidden: bool,
            $($(#[doc = $effect])+ pub $field: f32,)+
            /// How far this layer runs past the border of its body: a factor on the pixels of [`Edges::Overrun`].
            pub overrun: f32,
        }
    };
}

layer_numbers! {
    /// How long strokes are, pixels at the scene's size.
    length_px: 0.001..=MAX_STROKE_PX,
    /// How wide strokes are, pixels at the scene's size.
    width_px: 0.001..=MAX_STROKE_PX,
    /// How many strokes lie over each other; 0 leaves the layer out.
    coverage: 0.0..=MAX_COVERAGE,
    /// How much a stroke hides of what lies under it; for `ground`, how much its tone hides the body's colour.
    opacity: 0.0..=1.0,
    /// How high the paint stands: 0 is flat, 1 a full brush.
    thickness: 0.0..=MAX_THICKNESS,
    /// How much of its mark the brush leaves out.
    dryness: 0.0..=1.0,
    /// How wet the paint is: how much paint a stroke takes up from below, and how far it runs together with paint of
    /// the same colour.
    pickup: 0.0..=1.0,
}

/// A brush by name, a picture of the user's own, or a list of brushes and pictures: one named twice is taken twice as
/// often. In a picture, light is paint; if its background is light, dark is paint.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushMix(pub Vec<String>);

/// How paint ends at the border of its body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Edges {
    /// Cut off along the border.
    Clip,
    /// Ragged: it runs past the border by up to about this many pixels (at the scene's size), in some places by less.
    Overrun(f64),
    /// Not cut: whole strokes run past the border.
    Free,
}
