//! The pictures of the gallery, except those of noise and of ink.

/// A picture of the docs.
pub(super) struct Picture {
    pub(super) name: &'static str,
    pub(super) view: View,
    /// Whether it is rendered at the scene's own size instead of the gallery's.
    pub(super) own_size: bool,
    pub(super) columns: usize,
    /// One entry per panel. Names that begin with `--` are flags of the command line. The others are values that are
    /// set in the scene.
    pub(super) panels: &'static [&'static [(&'static str, &'static str)]],
}

pub(super) enum View {
    /// A frame of a scene, whole or a part of it: left, top, width, height.
    Scene {
        scene: &'static str,
        frame: i64,
        crop: Option<[usize; 4]>,
    },
    Brushes,
}

const fn whole(name: &'static str, scene: &'static str, frame: i64) -> Picture {
    Picture {
        name,
        view: View::Scene { scene, frame, crop: None },
        own_size: false,
        columns: 1,
        panels: &[&[]],
    }
}

/// A part of the still life: apple, lemon and cloth.
const FRUIT: [usize; 4] = [520, 270, 300, 230];

/// A part of the still life: jug and wall.
const JUG: [usize; 4] = [330, 60, 300, 230];

/// A part of the still life with different values in each panel.
const fn sweep(
    name: &'static str,
    crop: [usize; 4],
    columns: usize,
    panels: &'static [&'static [(&'static str, &'static str)]],
) -> Picture {
    let view = View::Scene { scene: "still_life", frame: 0, crop: Some(crop) };
    Picture { name, view, own_size: false, columns, panels }
}

/// Makes blades of grass broad enough to show their shape.
const BROAD: (&str, &str) = ("regions.grass.strokes.width_px", "18");

/// Lets blades of grass stand apart.
const SPARSE: (&str, &str) = ("regions.grass.strokes.coverage", "0.3");

/// A part of the meadow with different values in each panel.
const fn meadow(
    name: &'static str,
    crop: [usize; 4],
    panels: &'static [&'static [(&'static str, &'static str)]],
) -> Picture {
    let view = View::Scene { scene: "meadow", frame: 0, crop: Some(crop) };
    Picture { name, view, own_size: false, columns: 3, panels }
}

/// The source paper's rule.
const PAPER: &[(&str, &str)] = &[("strokes.preset", "paper")];

const NO_GUIDES: (&str, &str) = ("regions.deer.guides", "[]");

/// Painted amounts on the apple: the first on its left, the second on its right.
const WIDE_AND_NARROW: &str = "[(of: Width, dabs: [
    (at: (-0.135, 0.45, 0.48), normal: (-0.27, 0, 0.96), radius: 0.6, by: 2.6),
    (at: (0.455, 0.45, 0.207), normal: (0.91, 0, 0.41), radius: 0.5, by: 0.4),
])]";
const SHORT_AND_LONG: &str = "[(of: Length, dabs: [
    (at: (-0.135, 0.45, 0.48), normal: (-0.27, 0, 0.96), radius: 0.6, by: 0.35),
    (at: (0.455, 0.45, 0.207), normal: (0.91, 0, 0.41), radius: 0.5, by: 2.6),
])]";

/// Less paint on the apple's front, and more on its leaf.
const THIN: &str = "[(of: Density, dabs: [
    (at: (0.06, 0.45, 0.51), normal: (0.12, 0, 0.99), radius: 0.35, by: 0),
    (at: (0.21, 0.35, 0.46), normal: (0.42, 0, 0.9), radius: 0.4, by: 0),
    (at: (0.35, 0.25, 0.36), normal: (0.7, 0, 0.71), radius: 0.35, by: 0),
])]";
const DENSE: &str = "[(of: Density, dabs: [
    (at: (0.27, 0.9, 0.07), normal: (0, 1, 0), radius: 0.5, by: 4),
]), (of: Width, dabs: [(at: (0.27, 0.9, 0.07), normal: (0, 1, 0), radius: 0.5, by: 0.5)])]";

pub(super) const PICTURES: &[Picture] = &[
    whole("still_life", "still_life", 0),
    whole("still_life_rolled", "still_life", 90),
    sweep("still_life_crop", [560, 250, 420, 290], 1, &[&[]]),
    // An apple as the scene states it, then with width, length and density painted onto it.
    Picture {
        name: "amounts",
        view: View::Scene { scene: "apple", frame: 0, crop: Some([440, 140, 410, 420]) },
        own_size: true,
        columns: 2,
        panels: &[
            &[],
            &[("regions.apple.amounts", WIDE_AND_NARROW)],
            &[("regions.apple.amounts", SHORT_AND_LONG)],
            &[("regions.apple.amounts", THIN), ("regions.apple leaf.amounts", DENSE)],
        ],
    },
    whole("landscape", "landscape", 0),
    Picture { own_size: true, ..whole("portrait", "portrait", 0) },
    whole("simple_objects", "simple_objects", 0),
    whole("fish", "fish", 0),
    whole("falling_log", "falling_log", 12),
    whole("meadow", "meadow", 0),
    whole("lane", "lane", 24),
    Picture {
        name: "bending",
        view: View::Scene { scene: "parade", frame: 0, crop: None },
        own_size: false,
        columns: 2,
        panels: &[&[("--frames", "0")], &[("--frames", "12")], &[("--frames", "24")], &[("--frames", "36")]],
    },
    meadow(
        "stroke_taper",
        [100, 550, 300, 150],
        &[
            &[("regions.grass.strokes.taper", "0"), BROAD, SPARSE],
            &[("regions.grass.strokes.taper", "0.6"), BROAD, SPARSE],
            &[("regions.grass.strokes.taper", "1"), BROAD, SPARSE],
        ],
    ),
    meadow(
        "stroke_bend",
        [820, 0, 360, 270],
        &[
            &[("regions.sky.strokes.bend_deg", "0")],
            &[("regions.sky.strokes.bend_deg", "-45")],
            &[("regions.sky.strokes.bend_deg", "-110")],
        ],
    ),
    // A globe and a deer whose strokes follow combed guides, turned all the way round.
    Picture {
        columns: 2,
        panels: &[
            &[("--frames", "0")],
            &[("--frames", "90")],
            &[("--frames", "180")],
            &[("--frames", "270")],
        ],
        ..whole("reveal", "reveal", 0)
    },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("reveal_paper_and_ours", "reveal", 140) },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("grain_paper_and_ours", "grain", 15) },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("thin_plate_paper_and_ours", "thin_plate", 50) },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("orbit_paper_and_ours", "orbit_still_life", 30) },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("morph_paper_and_ours", "morph", 30) },
    Picture { columns: 2, panels: &[PAPER, &[]], ..whole("zoom_paper_and_ours", "zoom", 60) },
    Picture {
        columns: 3,
        panels: &[&[("--frames", "0")], &[("--frames", "15")], &[("--frames", "30")]],
        ..whole("morph", "morph", 0)
    },
    Picture {
        columns: 2,
        panels: &[&[("--frames", "0")], &[("--frames", "24")]],
        ..whole("scale_pulse", "scale_pulse", 0)
    },
    // What the source paper's figures 2 and 3 show: strokes laid on as a texture, and as billboards.
    Picture {
        columns: 2,
        panels: &[&[("strokes.preset", "paper"), ("--rotation", "mapped")], PAPER],
        ..whole("mapped", "orbit_still_life", 30)
    },
    Picture { columns: 2, panels: &[&[], &[("--colors", "trust")]], ..whole("trust", "reveal", 110) },
    Picture {
        name: "directions",
        view: View::Scene { scene: "reveal", frame: 0, crop: Some([590, 60, 440, 510]) },
        own_size: false,
        columns: 3,
        panels: &[
            &[NO_GUIDES],
            &[NO_GUIDES, ("regions.deer.direction", "Angle(35)")],
            &[NO_GUIDES, ("regions.deer.direction", "Up")],
            &[NO_GUIDES, ("regions.deer.direction", "Around((1, 0, 0))")],
            &[NO_GUIDES, ("regions.deer.direction", "Curvature(Min)")],
            &[],
        ],
    },
    // The camera has rolled by 30°, and the strokes have turned with the surface.
    Picture {
        name: "roll",
        view: View::Scene { scene: "roll", frame: 30, crop: None },
        own_size: false,
        columns: 1,
        panels: &[&[]],
    },
    Picture {
        name: "paper_beside_ours",
        view: View::Scene { scene: "turntable", frame: 30, crop: Some([340, 60, 600, 640]) },
        own_size: false,
        columns: 2,
        panels: &[&[("strokes.preset", "paper")], &[]],
    },
    Picture { name: "brushes", view: View::Brushes, own_size: false, columns: 1, panels: &[&[]] },
    sweep(
        "paint_layers",
        FRUIT,
        3,
        &[
            &[("strokes.layers", LAYERS_0)],
            &[("strokes.layers", LAYERS_1)],
            &[("strokes.layers", LAYERS_2)],
            &[("strokes.layers", LAYERS_3)],
            &[("strokes.layers", LAYERS_4)],
            &[],
        ],
    ),
    sweep(
        "paint_presets",
        FRUIT,
        3,
        &[
            &[],
            &[("strokes.preset", "impressionist")],
            &[("strokes.preset", "dry brush")],
            &[("strokes.preset", "gouache")],
            &[("strokes.preset", "paper")],
            &[("strokes.palette", ZORN)],
        ],
    ),
    sweep(
        "paint_scale",
        JUG,
        3,
        &[
            &[("regions.jug.strokes.scale", "0.4"), ("regions.wall.strokes.scale", "0.4")],
            &[],
            &[("regions.jug.strokes.scale", "1.8"), ("regions.wall.strokes.scale", "1.8")],
        ],
    ),
    sweep(
        "paint_coverage",
        JUG,
        4,
        &[&[("strokes.coverage", "0.8")], &[("strokes.coverage", "1.6")], &[], &[("strokes.coverage", "8")]],
    ),
    sweep(
        "paint_opacity",
        FRUIT,
        3,
        &[
            &[("strokes.layers", "[(name: \"body\", opacity: 0.4), (name: \"form\", opacity: 0.4)]")],
            &[("strokes.layers", "[(name: \"body\", opacity: 0.7), (name: \"form\", opacity: 0.7)]")],
            &[],
        ],
    ),
    sweep(
        "paint_dryness",
        JUG,
        3,
        &[
            &[("strokes.layers", "[(name: \"body\", dryness: 0)]")],
            &[("strokes.layers", "[(name: \"body\", dryness: 0.3)]")],
            &[("strokes.layers", "[(name: \"body\", dryness: 0.6)]")],
        ],
    ),
    sweep(
        "paint_pickup",
        FRUIT,
        3,
        &[
            &[("strokes.layers", "[(name: \"body\", pickup: 0), (name: \"form\", pickup: 0)]")],
            &[],
            &[("strokes.layers", "[(name: \"body\", pickup: 0.8), (name: \"form\", pickup: 0.8)]")],
        ],
    ),
    sweep(
        "paint_angle_jitter",
        JUG,
        4,
        &[
            &[("strokes.angle_jitter_deg", "0"), ("strokes.swing_deg", "0")],
            &[],
            &[("strokes.angle_jitter_deg", "20")],
            &[("strokes.angle_jitter_deg", "45")],
        ],
    ),
    sweep("paint_swing", JUG, 3, &[&[("strokes.swing_deg", "0")], &[], &[("strokes.swing_deg", "25")]]),
    Picture {
        name: "paint_fit",
        view: View::Scene { scene: "still_life", frame: 0, crop: Some([400, 20, 270, 300]) },
        own_size: false,
        columns: 3,
        panels: &[&[("strokes.fit", "0")], &[("strokes.fit", "0.5")], &[]],
    },
    sweep(
        "paint_contour_layer",
        FRUIT,
        3,
        &[
            &[("strokes.layers", "[(name: \"contour\", coverage: 0)]")],
            &[],
            &[("strokes.layers", "[(name: \"contour\", coverage: 4)]")],
        ],
    ),
    // The contour is set in the apple's region, because that region states a contour of its own. The direction is an
    // angle here, because strokes that run up would lie along most of the outline even with a contour of 0.
    sweep(
        "paint_contour",
        FRUIT,
        3,
        &[
            &[("regions.apple.direction", "Angle(35)"), ("regions.apple.strokes.contour", "0")],
            &[("regions.apple.direction", "Angle(35)"), ("regions.apple.strokes.contour", "0.5")],
            &[("regions.apple.direction", "Angle(35)"), ("regions.apple.strokes.contour", "1")],
        ],
    ),
    sweep(
        "paint_direction",
        FRUIT,
        3,
        &[
            &[("regions.apple.direction", "Auto")],
            &[("regions.apple.direction", "Angle(35)")],
            &[("regions.apple.direction", "Crossing(-58, 4)")],
            &[("regions.apple.direction", "Along((1, 0, 0))")],
            &[("regions.apple.direction", "Around((0, 1, 0))")],
            &[("regions.apple.direction", "Up")],
        ],
    ),
    sweep(
        "paint_size_jitter",
        JUG,
        3,
        &[&[("strokes.size_jitter", "0")], &[], &[("strokes.size_jitter", "0.5")]],
    ),
    sweep(
        "paint_edges",
        FRUIT,
        4,
        &[
            &[("strokes.edges", "Clip")],
            &[],
            &[("strokes.edges", "Overrun(9)")],
            &[("strokes.edges", "Free")],
        ],
    ),
    sweep(
        "paint_color_jitter",
        FRUIT,
        4,
        &[
            &[("strokes.color_jitter", "0")],
            &[],
            &[("strokes.color_jitter", "2.5")],
            &[("strokes.color_jitter", "6")],
        ],
    ),
    sweep(
        "paint_temperature",
        FRUIT,
        4,
        &[
            &[("strokes.temperature", "0")],
            &[],
            &[("strokes.temperature", "2.5")],
            &[("strokes.temperature", "6")],
        ],
    ),
    sweep("paint_grading", JUG, 3, &[&[("strokes.grading", "0")], &[("strokes.grading", "0.5")], &[]]),
    sweep(
        "paint_thickness",
        FRUIT,
        3,
        &[
            &[("strokes.layers", "[(name: \"body\", thickness: 0), (name: \"form\", thickness: 0)]")],
            &[],
            &[("strokes.layers", "[(name: \"body\", thickness: 1.5), (name: \"form\", thickness: 1.5)]")],
        ],
    ),
    sweep(
        "paint_relief",
        FRUIT,
        4,
        &[&[("style.relief", "0")], &[], &[("style.relief", "2")], &[("style.relief", "5")]],
    ),
    sweep(
        "paint_canvas",
        JUG,
        4,
        &[&[("style.canvas", "Board")], &[], &[("style.weave", "2.5")], &[("style.weave", "6")]],
    ),
    sweep("paint_varnish", FRUIT, 3, &[&[("style.varnish", "0")], &[], &[("style.varnish", "4")]]),
];

const ZORN: &str = "[\"#b3302a\", \"#d9a23a\", \"#2a2a2c\", \"#efe8da\"]";

const LAYERS_0: &str = "[(name: \"underpainting\", coverage: 0), (name: \"body\", coverage: 0), (name: \"form\", coverage: 0), (name: \"scumble\", coverage: 0), (name: \"accents\", coverage: 0), (name: \"lights\", coverage: 0)]";
const LAYERS_1: &str = "[(name: \"body\", coverage: 0), (name: \"form\", coverage: 0), (name: \"scumble\", coverage: 0), (name: \"accents\", coverage: 0), (name: \"lights\", coverage: 0)]";
const LAYERS_2: &str = "[(name: \"form\", coverage: 0), (name: \"scumble\", coverage: 0), (name: \"accents\", coverage: 0), (name: \"lights\", coverage: 0)]";
const LAYERS_3: &str =
    "[(name: \"scumble\", coverage: 0), (name: \"accents\", coverage: 0), (name: \"lights\", coverage: 0)]";
const LAYERS_4: &str = "[(name: \"accents\", coverage: 0), (name: \"lights\", coverage: 0)]";
