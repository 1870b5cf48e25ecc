//! Tables that declare the numbers of a scene file, each with its name, range and effect. Reading, checking, saving and
//! `docs/scene_file.md` follow from the tables, and so does most of the editor's inspector.

use std::ops::RangeInclusive;

/// A number of the settings `T`; `V` is `f64`, or `Option<f64>` where it may be left to a preset.
#[derive(Clone, Debug)]
pub struct Number<T, V = f64> {
    /// Its field in a scene file.
    pub field: &'static str,
    /// The values that a scene file may give.
    pub limits: RangeInclusive<f64>,
    /// What it does, in a sentence or two.
    pub effect: &'static str,
    /// Its value.
    pub get: fn(&T) -> V,
    /// A reference to its value, through which it is set.
    pub of: fn(&mut T) -> &mut V,
}

/// A row of a table: `number!(field, limits, effect)`.
macro_rules! number {
    ($field:ident, $limits:expr, $effect:expr) => {
        $crate::document::Number {
            field: stringify!($field),
            limits: $limits,
            effect: $effect.trim_ascii(),
            get: |settings| settings.$field,
            of: |settings| &mut settings.$field,
        }
    };
}

/// Declares a struct of the scene file of which every field may be left out.
///
/// Each field states its usual value behind `=`. A field with its usual value is not saved, unless it is marked
/// `saved always`. A number that states its range behind `within` is one of `numbers()`.
macro_rules! usual_fields {
    (@is_saved $differs:expr, always) => {
        true
    };
    (@is_saved $differs:expr,) => {
        $differs
    };
    (@number $field:ident, $effect:expr,) => {
        None
    };
    (@number $field:ident, $effect:expr, $limits:expr) => {
        Some($crate::document::numbers::number!($field, $limits, $effect))
    };
    (
        $(#[$about:meta])*
        pub struct $name:ident {
            $(
                $(#[doc = $effect:literal])+
                pub $field:ident: $type:ty = $usual:expr $(; within $limits:expr)? $(; saved $always:ident)?,
            )+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name {
            $($(#[doc = $effect])+ pub $field: $type,)+
        }

        impl $name {
            const NUMBERS: &'static [Option<$crate::document::Number<Self>>] =
                &[$(usual_fields!(@number $field, concat!($($effect),+), $($limits)?)),+];

            /// Every number that has a range.
            pub fn numbers() -> impl Iterator<Item = &'static $crate::document::Number<Self>> {
                Self::NUMBERS.iter().flatten()
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $usual),+ }
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                use serde::ser::SerializeStruct;
                let count = [
                    $(usual_fields!(@is_saved self.$field != Self::default().$field, $($always)?)),+
                ];
                let count = count.into_iter().filter(|is_saved| *is_saved).count();
                let mut fields = serializer.serialize_struct(stringify!($name), count)?;
                $(
                    if usual_fields!(@is_saved self.$field != Self::default().$field, $($always)?) {
                        fields.serialize_field(stringify!($field), &self.$field)?;
                    }
                )+
                fields.end()
            }
        }
    };
}

pub(super) use {number, usual_fields};
