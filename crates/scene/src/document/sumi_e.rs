//! Ink on paper, as a scene file states it. *The source* below is the effect that it follows: see
//! docs/techniques/sumi_e.md.

use serde::{Deserialize, Serialize};

use super::color::Color;
use super::numbers::usual_fields;
use super::style_settings::{CanvasFollows, Preparation, SettingRule, StyleInfo, StyleSettings};

usual_fields! {
    /// Ink on paper: a dark silhouette over an interior of four tones.
    pub struct SumiE {
        /// The rule that ink follows: `Painter` is ours, `Source` that of the source, the effect that this style is
        /// based on.
        pub rule: InkRule = InkRule::Painter; saved always,
        /// What is drawn.
        pub drawing: InkDrawing = InkDrawing::Both,
        /// Where the light on the interior stands.
        pub light: InkLight = InkLight::Scene,
        /// Direction to the light. With `light: Eye` or `rule: Source` it is in the eye's space (X right, Y up, Z to
        /// the eye). Otherwise it counts only where the scene has no sun, and is in world space. The default is the
        /// source's light with Z negated, because the source is left-handed.
        pub to_light: [f64; 3] = [0.96, 0.64, 1.08],
        /// The four tones, from the darkest ink to the thinnest; 0 black, 1 the paper.
        pub tones: [f64; 4] = [0.07, 0.36, 0.68, 0.96],
        /// How much ink there is: 0 none, 1 as much as usual.
        pub density: f64 = 1.0; within 0.0..=2.0,
        /// How dark the silhouette is.
        pub silhouette: f64 = 0.7; within 0.0..=1.0,
        /// The silhouette is at its darkest where the cosine between the surface's normal and the direction to the eye
        /// is below this number.
        pub silhouette_from: f64 = 0.3; within 0.0..=1.0,
        /// There is no silhouette where the cosine between the surface's normal and the direction to the eye is above
        /// this number.
        pub silhouette_to: f64 = 0.7; within 0.0..=1.0,
        /// How softly one tone goes over into the next.
        pub softness: f64 = 0.08; within 0.0..=0.5,
        /// How far a body's own colour makes its ink darker or lighter.
        pub own_tone: f64 = 0.6; within 0.0..=1.0,
        /// How soft the ink's edges are: the standard deviation of a blur, pixels at the scene's size.
        pub blur_px: f64 = 1.6; within 0.0..=40.0,
        /// How much of the ink runs out into the paper.
        pub bleed: f64 = 0.5; within 0.0..=1.0,
        /// How far the ink runs, pixels at the scene's size.
        pub bleed_px: f64 = 10.0; within 0.0..=100.0,
        /// How much of the paper a drying brush leaves white.
        pub dryness: f64 = 0.35; within 0.0..=1.0,
        /// How much of the paper's fibres is seen.
        pub fibres: f64 = 1.0; within 0.0..=3.0,
        /// How far saturated colours of the seal's hue are painted in the seal's colour instead of ink: 0 not at all, 1
        /// wholly.
        pub accent: f64 = 1.0; within 0.0..=1.0,
        /// The paper.
        pub paper: Color = Color::from_bytes([0xf1, 0xe9, 0xd8]),
        /// The ink at its darkest.
        pub ink: Color = Color::from_bytes([0x17, 0x17, 0x1b]),
        /// Seal red.
        pub seal: Color = Color::from_bytes([0xb2, 0x28, 0x1e]),
        /// What the paper moves with.
        pub paper_follows: CanvasFollows = CanvasFollows::Picture,
    }
}

/// Which rule ink is drawn by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum InkRule {
    /// Ours: an ink that bleeds, dries and lies on a paper with fibres.
    #[default]
    Painter,
    /// The source's five passes.
    Source,
}

/// What is drawn in ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum InkLight {
    /// The scene's first sun; `to_light` if it has none.
    #[default]
    Scene,
    /// Fixed to the eye, as in the source.
    Eye,
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
            contour_and_lights: false,
            canvas_follows: self.paper_follows,
            ..Preparation::default()
        }
    }

    /// The numbers' ranges; `to_light` must not be zero, the tones must lie from 0 to 1 and not fall, and
    /// `silhouette_from` must lie below `silhouette_to`.
    fn rules(&self) -> Vec<SettingRule> {
        let mut rules: Vec<SettingRule> =
            Self::numbers().map(|number| SettingRule::range(number, self)).collect();
        rules.push(SettingRule::Direction { field: "to_light", value: self.to_light });
        let rises = self.tones.windows(2).all(|pair| pair[0] <= pair[1]);
        if !rises || self.tones.iter().any(|tone| !(0.0..=1.0).contains(tone)) {
            rules.push(SettingRule::Broken {
                field: "tones",
                message: "the four tones do not go from dark to light",
                mend: "give four numbers from 0 to 1, none below the one before",
            });
        }
        if self.silhouette_from >= self.silhouette_to {
            rules.push(SettingRule::Broken {
                field: "silhouette_from",
                message: "the silhouette ends before it begins",
                mend: "give a number below silhouette_to",
            });
        }
        rules
    }
}
