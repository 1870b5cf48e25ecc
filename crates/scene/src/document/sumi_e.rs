//! Ink on paper, as a scene file states it.

use serde::Deserialize;

use super::color::Color;
use super::style_settings::{CanvasFollows, Preparation, SettingRule, StyleInfo, StyleSettings};

/// Ink on paper: a dark silhouette over an interior of four tones.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SumiE {
    /// Whose rule it is drawn by.
    pub rule: InkRule,
    /// What is drawn.
    pub drawing: InkDrawing,
    /// Where the light on the interior stands.
    pub light: InkLight,
    /// Towards the light in the eye's space (X right, Y up, Z to the eye), for a light that goes with the eye.
    pub to_light: [f64; 3],
    /// The four tones, from the darkest ink to the thinnest; 0 black, 1 the paper.
    pub tones: [f64; 4],
    /// How softly one tone goes over into the next, as a share of the way from dark to light.
    pub softness: f64,
    /// Cosine to the eye at and below which the silhouette is black.
    pub silhouette_from: f64,
    /// Cosine to the eye at and above which it is no more.
    pub silhouette_to: f64,
    /// How dark the silhouette is.
    pub silhouette: f64,
    /// How far the body's own colour makes its ink darker or lighter.
    pub own_tone: f64,
    /// How much ink there is.
    pub density: f64,
    /// Deviation of the low pass, pixels at the scene's size.
    pub blur_px: f64,
    /// How much of the ink runs out into the paper, here more and there less.
    pub bleed: f64,
    /// How far it runs, pixels at the scene's size.
    pub bleed_px: f64,
    /// How much of the paper a drying brush leaves white.
    pub dryness: f64,
    /// How much of the paper's fibres is seen and felt.
    pub fibres: f64,
    /// How much of what has the seal's hue stays red.
    pub accent: f64,
    /// The paper.
    pub paper: Color,
    /// The ink at its darkest.
    pub ink: Color,
    /// Seal red.
    pub seal: Color,
    /// What the paper moves with.
    pub paper_follows: CanvasFollows,
}

/// Whose rule ink is drawn by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum InkRule {
    /// Ours: an ink that bleeds, dries and lies on a paper with fibres.
    #[default]
    Painter,
    /// The source's five passes, pixel for pixel.
    Source,
}

/// What is drawn in ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum InkDrawing {
    /// Strokes over a thin wash.
    #[default]
    Both,
    /// The wash alone.
    Wash,
    /// Strokes alone.
    Strokes,
}

/// Where the light on the interior stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum InkLight {
    /// The scene's first sun.
    #[default]
    Scene,
    /// Fixed to the eye, as in the source.
    Eye,
}

impl Default for SumiE {
    fn default() -> Self {
        Self {
            rule: InkRule::default(),
            drawing: InkDrawing::default(),
            light: InkLight::default(),
            // The source's, which is left-handed, with Z turned round.
            to_light: [0.96, 0.64, 1.08],
            tones: [0.07, 0.36, 0.68, 0.96],
            softness: 0.08,
            silhouette_from: 0.3,
            silhouette_to: 0.7,
            silhouette: 0.7,
            own_tone: 0.6,
            density: 1.0,
            blur_px: 1.6,
            bleed: 0.5,
            bleed_px: 10.0,
            dryness: 0.35,
            fibres: 1.0,
            accent: 1.0,
            paper: Color([0xf1 as f32 / 255.0, 0xe9 as f32 / 255.0, 0xd8 as f32 / 255.0]),
            ink: Color([0x17 as f32 / 255.0, 0x17 as f32 / 255.0, 0x1b as f32 / 255.0]),
            seal: Color([0xb2 as f32 / 255.0, 0x28 as f32 / 255.0, 0x1e as f32 / 255.0]),
            paper_follows: CanvasFollows::default(),
        }
    }
}

/// A number of the ink that has a range.
#[derive(Clone, Copy, Debug)]
pub struct InkNumber {
    /// Its field in a scene file.
    pub field: &'static str,
    /// The most that it may be; the least is 0.
    pub most: f64,
    /// What it does, in a few words.
    pub effect: &'static str,
    /// Where it is kept.
    pub of: fn(&mut SumiE) -> &mut f64,
}

impl SumiE {
    /// Every number with a range.
    pub const NUMBERS: &'static [InkNumber] = &[
        number("density", 2.0, "How much ink there is: 0 none, 1 as ground.", |ink| &mut ink.density),
        number("silhouette", 1.0, "How dark the silhouette is.", |ink| &mut ink.silhouette),
        number("silhouette_from", 1.0, "Cosine to the eye below which the silhouette is black.", |ink| {
            &mut ink.silhouette_from
        }),
        number("silhouette_to", 1.0, "Cosine to the eye above which there is no silhouette.", |ink| {
            &mut ink.silhouette_to
        }),
        number("softness", 0.5, "How softly one tone goes over into the next.", |ink| &mut ink.softness),
        number("own_tone", 1.0, "How far a body's own colour makes its ink darker or lighter.", |ink| {
            &mut ink.own_tone
        }),
        number("blur_px", 40.0, "How soft the ink's edges are, in pixels.", |ink| &mut ink.blur_px),
        number("bleed", 1.0, "How much of the ink runs out into the paper.", |ink| &mut ink.bleed),
        number("bleed_px", 100.0, "How far the ink runs, in pixels.", |ink| &mut ink.bleed_px),
        number("dryness", 1.0, "How much of the paper a drying brush leaves white.", |ink| &mut ink.dryness),
        number("fibres", 3.0, "How much of the paper's fibres is seen.", |ink| &mut ink.fibres),
        number("accent", 1.0, "How much of what has the seal's hue stays red.", |ink| &mut ink.accent),
    ];

    /// The names of the fields in a scene file.
    pub(crate) const FIELDS: &'static [&'static str] = &[
        "rule",
        "drawing",
        "light",
        "to_light",
        "tones",
        "softness",
        "silhouette_from",
        "silhouette_to",
        "silhouette",
        "own_tone",
        "density",
        "blur_px",
        "bleed",
        "bleed_px",
        "dryness",
        "fibres",
        "accent",
        "paper",
        "ink",
        "seal",
        "paper_follows",
    ];

    /// The value of a number.
    pub fn value(&self, number: &InkNumber) -> f64 {
        *(number.of)(&mut self.clone())
    }
}

impl StyleSettings for SumiE {
    fn info(&self) -> &'static StyleInfo {
        &StyleInfo {
            name: "SumiE",
            file_name: "sumi_e",
            alias: Some("sumi-e"),
            label: "Ink",
            summary: "Ink on paper",
            preset: Some("ink"),
        }
    }

    fn preparation(&self) -> Preparation {
        Preparation {
            has_strokes: self.rule == InkRule::Painter && self.drawing != InkDrawing::Wash,
            underpainting: false,
            canvas_follows: self.paper_follows,
            ..Preparation::default()
        }
    }

    /// The numbers' ranges, and what must go up: the tones, and where the silhouette begins and ends.
    fn rules(&self) -> Vec<SettingRule> {
        let range = |number: &InkNumber| SettingRule::Range {
            field: number.field,
            value: self.value(number),
            most: number.most,
        };
        let mut rules: Vec<SettingRule> = Self::NUMBERS.iter().map(range).collect();
        rules.push(SettingRule::Direction { field: "to_light", value: self.to_light });
        let rises = self.tones.windows(2).all(|pair| pair[0] <= pair[1]);
        if !rises || self.tones.iter().any(|tone| !(0.0..=1.0).contains(tone)) {
            rules.push(SettingRule::Broken {
                field: "tones",
                message: "the four tones do not go from dark to light",
                advice: "give four numbers from 0 to 1, none below the one before",
            });
        }
        if self.silhouette_from >= self.silhouette_to {
            rules.push(SettingRule::Broken {
                field: "silhouette_from",
                message: "the silhouette ends before it begins",
                advice: "give a number below silhouette_to",
            });
        }
        rules
    }
}

const fn number(
    field: &'static str,
    most: f64,
    effect: &'static str,
    of: fn(&mut SumiE) -> &mut f64,
) -> InkNumber {
    InkNumber { field, most, effect, of }
}
