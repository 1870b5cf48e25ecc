//! The macro behind the table of stroke numbers: from each row it makes a field of `StrokeSettings`, of
//! `ResolvedStrokes` and of `PresetNumbers`, and an entry of `STROKE_NUMBERS`.

/// Numbers that are resolved without conversion.
pub(super) mod plain {
    pub(crate) fn of_preset(value: f32) -> f32 {
        value
    }

    pub(crate) fn of_file(value: f64) -> f32 {
        value as f32
    }

    pub(crate) fn in_file(value: f32) -> f64 {
        f64::from(value)
    }
}

/// Angles: degrees in files and presets, radians where they are resolved.
pub(super) mod angle {
    pub(crate) fn of_preset(value_deg: f32) -> f32 {
        value_deg.to_radians()
    }

    pub(crate) fn of_file(value_deg: f64) -> f32 {
        value_deg.to_radians() as f32
    }

    pub(crate) fn in_file(value_rad: f32) -> f64 {
        f64::from(value_rad).to_degrees()
    }
}

/// Declares `StrokeSettings`, `ResolvedStrokes`, `PresetNumbers` and `STROKE_NUMBERS`; `strokes.rs` says how rows are
/// written. The groups stand in the order in which a scene file is saved.
macro_rules! stroke_numbers {
    (
        body { $($(#[doc = $body_effect:literal])+ $body:ident {
            limits: $body_limits:expr, resolved: $body_resolved:expr, shown: $body_shown:expr,
        })+ }
        form { $($(#[doc = $form_effect:literal])+ $form:ident => $form_resolved:ident as $form_kind:ident {
            usual: $form_usual:expr, limits: $form_limits:expr, shown: $form_shown:expr,
        })+ }
        color { $($(#[doc = $color_effect:literal])+ $color:ident => $color_resolved:ident as $color_kind:ident {
            usual: $color_usual:expr, limits: $color_limits:expr, shown: $color_shown:expr,
        })+ }
    ) => {
        /// Stroke settings. What is left out comes from the preset; in a region without a preset, from the scene's
        /// settings.
        #[derive(Clone, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct StrokeSettings {
            /// A named set of values to start from.
            #[serde(skip_serializing_if = "is_default")]
            pub preset: Option<String>,
            /// Brush of the body layer.
            #[serde(skip_serializing_if = "is_default")]
            pub brush: Option<BrushMix>,
            $($(#[doc = $body_effect])+ #[serde(skip_serializing_if = "is_default")] pub $body: Option<f64>,)+
            $($(#[doc = $form_effect])+ #[serde(skip_serializing_if = "is_default")] pub $form: Option<f64>,)+
            /// How paint ends at the border of its body.
            #[serde(skip_serializing_if = "is_default")]
            pub edges: Option<Edges>,
            $($(#[doc = $color_effect])+ #[serde(skip_serializing_if = "is_default")] pub $color: Option<f64>,)+
            /// Pigments that all colours are mixed from, at most 16; empty means any colour.
            #[serde(skip_serializing_if = "is_default")]
            pub palette: Option<Vec<Color>>,
            /// A number from -1000 to 1000: strokes with a higher one are painted over all strokes with a lower one.
            #[serde(skip_serializing_if = "is_default")]
            pub layer: Option<i32>,
            /// What differs from the preset in single layers of paint, by name.
            #[serde(skip_serializing_if = "is_default")]
            pub layers: Vec<LayerSettings>,
            /// All seven layers of paint by name, in the order in which they are laid: the lowest first. For the whole
            /// scene alone.
            #[serde(skip_serializing_if = "is_default")]
            pub order: Vec<String>,
            /// Changes over time, frames strictly increasing; those of a region replace the scene's.
            #[serde(skip_serializing_if = "is_default")]
            pub keys: Vec<StrokesKey>,
        }

        /// Stroke settings with nothing left out.
        #[derive(Clone, Debug, PartialEq)]
        pub struct ResolvedStrokes {
            /// The layers, in the order of [`crate::presets::LayerKind::ALL`].
            pub layers: [ResolvedLayer; 7],
            $($(#[doc = $form_effect])+ pub $form_resolved: f32,)+
            $($(#[doc = $color_effect])+ pub $color_resolved: f32,)+
            /// How paint ends at its body's border.
            pub edges: Edges,
            /// Pigments; empty means any colour.
            pub palette: Vec<Color>,
            /// How far colours keep to the palette, 0..=1.
            pub palette_mix: f32,
            /// Strokes with a higher number are painted over all strokes with a lower one.
            pub layer: i32,
            /// Changes over time: see [`ResolvedStrokes::at`].
            pub keys: Vec<StrokesKey>,
        }

        /// A preset's values for all numbers that are not sizes, in the units of a scene file.
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct PresetNumbers {
            $(pub(crate) $form: f32,)+
            $(pub(crate) $color: f32,)+
        }

        impl PresetNumbers {
            /// The values of the default preset.
            pub(crate) const USUAL: Self = Self { $($form: $form_usual,)+ $($color: $color_usual,)+ };
        }

        impl ResolvedStrokes {
            /// A preset's values, with any colour allowed, on layer 0.
            pub(crate) fn new(layers: [ResolvedLayer; 7], numbers: PresetNumbers, edges: Edges) -> Self {
                Self {
                    layers,
                    $($form_resolved: $form_kind::of_preset(numbers.$form),)+
                    $($color_resolved: $color_kind::of_preset(numbers.$color),)+
                    edges,
                    palette: Vec::new(),
                    palette_mix: 1.0,
                    layer: 0,
                    keys: Vec::new(),
                }
            }

            /// Applies the stated numbers that are not sizes.
            pub(crate) fn apply_numbers(&mut self, stated: &StrokeSettings) {
                $(self.$form_resolved = stated.$form.map_or(self.$form_resolved, $form_kind::of_file);)+
                $(self.$color_resolved = stated.$color.map_or(self.$color_resolved, $color_kind::of_file);)+
            }
        }

        /// Every number of [`StrokeSettings`], in the order in which they are saved.
        pub const STROKE_NUMBERS: &[StrokeNumber] = &[
            $(StrokeNumber {
                number: number!($body, $body_limits, concat!($($body_effect),+)),
                resolved: $body_resolved,
                shown: $body_shown,
            },)+
            $(StrokeNumber {
                number: number!($form, $form_limits, concat!($($form_effect),+)),
                resolved: |strokes| $form_kind::in_file(strokes.$form_resolved),
                shown: $form_shown,
            },)+
            $(StrokeNumber {
                number: number!($color, $color_limits, concat!($($color_effect),+)),
                resolved: |strokes| $color_kind::in_file(strokes.$color_resolved),
                shown: $color_shown,
            },)+
        ];
    };
}

pub(super) use stroke_numbers;
