//! The styles that a scene can be drawn in: the one list of them all.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, EnumAccess, MapAccess, VariantAccess, Visitor};

use super::rotating_strokes::RotatingStrokes;
use super::style_settings::{StyleInfo, StyleSettings};
use super::sumi_e::SumiE;

/// How the scene is drawn, with the settings of that style.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub enum Style {
    /// Brush strokes that turn with what they lie on.
    RotatingStrokes(RotatingStrokes),
    /// Ink on paper.
    SumiE(SumiE),
    /// The plain render that strokes take their colours from.
    Reference,
}

impl Style {
    /// How styles are written in a scene file, for messages.
    pub(crate) const EXAMPLES: &'static str = "RotatingStrokes(), SumiE() or Reference";

    /// Every style with its usual settings, in the order in which people choose from them.
    pub fn all() -> [Self; 3] {
        [Self::default(), Self::SumiE(SumiE::default()), Self::Reference]
    }

    /// The style of this name on the command line, with its usual settings.
    pub fn named(name: &str) -> Option<Self> {
        let is_called = |info: &StyleInfo| info.file_name == name || info.alias == Some(name);
        Self::all().into_iter().find(|style| is_called(style.info()))
    }

    /// The settings, through the trait that all styles share.
    pub fn settings(&self) -> &dyn StyleSettings {
        match self {
            Self::RotatingStrokes(settings) => settings,
            Self::SumiE(settings) => settings,
            Self::Reference => &PlainRender,
        }
    }

    /// Names and words of the style.
    pub fn info(&self) -> &'static StyleInfo {
        self.settings().info()
    }
}

impl Default for Style {
    fn default() -> Self {
        Self::RotatingStrokes(RotatingStrokes::default())
    }
}

/// The plain render has no settings.
struct PlainRender;

impl StyleSettings for PlainRender {
    fn info(&self) -> &'static StyleInfo {
        &StyleInfo {
            name: "Reference",
            file_name: "reference",
            alias: None,
            label: "Plain",
            summary: "The plain render that strokes take their colours from",
            preset: None,
        }
    }
}

impl<'de> Deserialize<'de> for Style {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(variant_identifier)]
        enum Name {
            RotatingStrokes,
            SumiE,
            Reference,
        }
        struct FieldsVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for FieldsVisitor<T> {
            type Value = T;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("the fields of a style, as in (relief: 0.5)")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map))
            }
        }
        struct StyleVisitor;
        impl<'de> Visitor<'de> for StyleVisitor {
            type Value = Style;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a style such as RotatingStrokes()")
            }
            fn visit_enum<A: EnumAccess<'de>>(self, style: A) -> Result<Style, A::Error> {
                match style.variant()? {
                    (Name::RotatingStrokes, fields) => {
                        fields.struct_variant(&[], FieldsVisitor(PhantomData)).map(Style::RotatingStrokes)
                    }
                    (Name::SumiE, fields) => {
                        fields.struct_variant(&[], FieldsVisitor(PhantomData)).map(Style::SumiE)
                    }
                    (Name::Reference, nothing) => nothing.unit_variant().map(|()| Style::Reference),
                }
            }
        }
        deserializer.deserialize_enum("Style", &["RotatingStrokes", "SumiE", "Reference"], StyleVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets;

    #[test]
    fn every_style_is_listed_once_under_names_of_its_own_and_has_a_preset_that_exists() {
        let styles = Style::all();
        for (index, style) in styles.iter().enumerate() {
            let info = style.info();
            assert!(Style::EXAMPLES.contains(info.name), "{} is not among the examples", info.name);
            assert_eq!(Style::named(info.file_name).as_ref(), Some(style));
            assert!(info.preset.is_none_or(|preset| presets::names().any(|name| name == preset)));
            for other in styles[..index].iter().map(Style::info) {
                assert!(other.name != info.name && other.file_name != info.file_name);
                assert_ne!(other.label, info.label);
            }
        }
    }
}
