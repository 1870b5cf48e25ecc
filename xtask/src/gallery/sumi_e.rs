//! Lists the gallery's pictures of ink on paper. Some show whole scenes; most show one setting of the style at several
//! values, side by side.

use super::list::{Picture, View};

/// A part of the apple in ink: left, top, width and height in pixels of the scene's own size.
const APPLE: [usize; 4] = [440, 440, 400, 330];

/// A part of the bamboo, with leaves: left, top, width and height as above.
const LEAVES: [usize; 4] = [0, 100, 360, 330];

type Panels = &'static [&'static [(&'static str, &'static str)]];

const fn whole(name: &'static str, panels: Panels) -> Picture {
    let view = View::Scene { scene: name, frame: 0, crop: None };
    Picture { name, view, own_size: true, columns: 3, panels }
}

const fn part(name: &'static str, (scene, crop): (&'static str, [usize; 4]), panels: Panels) -> Picture {
    let view = View::Scene { scene, frame: 0, crop: Some(crop) };
    Picture { name, view, own_size: true, columns: 3, panels }
}

const fn apple(name: &'static str, panels: Panels) -> Picture {
    part(name, ("sumi_e_apple", APPLE), panels)
}

const fn leaves(name: &'static str, panels: Panels) -> Picture {
    part(name, ("sumi_e_bamboo", LEAVES), panels)
}

const WASH: (&str, &str) = ("style.drawing", "Wash");

pub(super) const PICTURES: &[Picture] = &[
    whole("sumi_e_bamboo", &[&[]]),
    whole("sumi_e_carp", &[&[]]),
    whole("sumi_e_apple", &[&[("style.rule", "Source")], &[]]),
    leaves("sumi_e_drawing", &[&[WASH], &[("style.drawing", "Strokes")], &[("style.drawing", "Both")]]),
    apple("sumi_e_light", &[&[("style.light", "Scene")], &[("style.light", "Eye")]]),
    apple(
        "sumi_e_tones",
        &[
            &[WASH, ("style.tones", "(0.3, 0.6, 0.85, 1)")],
            &[WASH],
            &[WASH, ("style.tones", "(0, 0.15, 0.4, 0.8)")],
        ],
    ),
    apple(
        "sumi_e_softness",
        &[&[WASH, ("style.softness", "0.01")], &[WASH], &[WASH, ("style.softness", "0.4")]],
    ),
    apple(
        "sumi_e_silhouette",
        &[&[WASH, ("style.silhouette", "0")], &[WASH], &[WASH, ("style.silhouette", "1")]],
    ),
    apple(
        "sumi_e_silhouette_range",
        &[
            &[WASH, ("style.silhouette_from", "0.05"), ("style.silhouette_to", "0.35")],
            &[WASH],
            &[WASH, ("style.silhouette_from", "0.5"), ("style.silhouette_to", "0.95")],
        ],
    ),
    leaves("sumi_e_own_tone", &[&[("style.own_tone", "0")], &[], &[("style.own_tone", "1")]]),
    leaves("sumi_e_density", &[&[("style.density", "0.5")], &[], &[("style.density", "1.6")]]),
    apple("sumi_e_blur_px", &[&[WASH, ("style.blur_px", "0")], &[WASH], &[WASH, ("style.blur_px", "8")]]),
    leaves("sumi_e_bleed", &[&[WASH, ("style.bleed", "0")], &[WASH], &[WASH, ("style.bleed", "1")]]),
    leaves(
        "sumi_e_bleed_px",
        &[
            &[WASH, ("style.bleed", "1"), ("style.bleed_px", "3")],
            &[WASH, ("style.bleed", "1")],
            &[WASH, ("style.bleed", "1"), ("style.bleed_px", "30")],
        ],
    ),
    leaves("sumi_e_dryness", &[&[("style.dryness", "0")], &[], &[("style.dryness", "1")]]),
    leaves("sumi_e_fibres", &[&[("style.fibres", "0")], &[], &[("style.fibres", "3")]]),
    part(
        "sumi_e_accent",
        ("sumi_e_carp", [640, 40, 400, 330]),
        &[&[("style.accent", "0")], &[], &[("style.seal", "\"#8a5a1a\"")]],
    ),
    leaves(
        "sumi_e_colours",
        &[
            &[],
            &[("style.paper", "\"#e3dccb\""), ("style.ink", "\"#3a2414\"")],
            &[("style.paper", "\"#f4f4f2\""), ("style.ink", "\"#101c30\"")],
        ],
    ),
];
