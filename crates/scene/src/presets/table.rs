//! The presets, as numbers. Pixels are those of a picture 720 pixels high.

use super::{DEFAULT_PRESET, INK_PRESET, PAPER_PRESET};
use crate::document::{Edges, PresetNumbers, ResolvedLayer, ResolvedStrokes};

#[derive(Clone, Copy, Debug)]
pub(super) struct Preset {
    pub(super) name: &'static str,
    layers: [Layer; 7],
    /// How far past the border paint runs.
    overrun_px: f64,
    numbers: PresetNumbers,
}

#[derive(Clone, Copy, Debug)]
struct Layer {
    /// Brushes, and how often each is taken.
    brushes: &'static [(&'static str, usize)],
    size_px: [f32; 2],
    coverage: f32,
    opacity: f32,
    thickness: f32,
    dryness: f32,
    pickup: f32,
    overrun: f32,
}

const UNDERPAINTING: Layer = Layer {
    brushes: &[("flat", 6), ("dry", 1)],
    size_px: [130.0, 42.0],
    coverage: 3.8,
    opacity: 0.86,
    thickness: 0.10,
    dryness: 0.07,
    pickup: 0.10,
    overrun: 1.4,
};

const BODY: Layer = Layer {
    brushes: &[("flat", 5), ("filbert", 5), ("round", 1)],
    size_px: [78.0, 25.0],
    coverage: 2.7,
    opacity: 0.95,
    thickness: 0.50,
    dryness: 0.12,
    pickup: 0.25,
    overrun: 1.0,
};

const FORM: Layer = Layer {
    brushes: &[("filbert", 6), ("flat", 3), ("round", 2)],
    size_px: [33.0, 10.0],
    coverage: 1.25,
    opacity: 0.95,
    thickness: 0.62,
    dryness: 0.14,
    pickup: 0.18,
    overrun: 0.8,
};

const SCUMBLE: Layer = Layer {
    brushes: &[("dry", 6), ("fan", 1)],
    size_px: [86.0, 23.0],
    coverage: 0.5,
    opacity: 0.70,
    thickness: 0.45,
    dryness: 0.50,
    pickup: 0.10,
    overrun: 0.3,
};

const ACCENTS: Layer = Layer {
    brushes: &[("round", 5), ("filbert", 3), ("rigger", 2)],
    size_px: [17.0, 5.0],
    coverage: 0.2,
    opacity: 0.92,
    thickness: 0.65,
    dryness: 0.08,
    pickup: 0.10,
    overrun: 0.4,
};

const CONTOUR: Layer = Layer {
    brushes: &[("rigger", 3), ("round", 2)],
    size_px: [50.0, 4.5],
    coverage: 1.2,
    opacity: 0.88,
    thickness: 0.12,
    dryness: 0.16,
    pickup: 0.10,
    overrun: 0.5,
};

const LIGHTS: Layer = Layer {
    brushes: &[("round", 1), ("filbert", 1), ("knife", 1)],
    size_px: [21.0, 8.0],
    coverage: 0.25,
    opacity: 0.97,
    thickness: 1.35,
    dryness: 0.04,
    pickup: 0.04,
    overrun: 0.0,
};

/// All presets, the default first.
pub(super) const PRESETS: [Preset; 6] = [
    // A few large strokes for the masses, small ones only where something happens.
    Preset {
        name: DEFAULT_PRESET,
        layers: [UNDERPAINTING, BODY, FORM, SCUMBLE, ACCENTS, CONTOUR, LIGHTS],
        overrun_px: 3.0,
        numbers: PresetNumbers::USUAL,
    },
    // Short, loaded dabs of broken colour, side by side.
    Preset {
        name: "impressionist",
        layers: [
            Layer { size_px: [92.0, 36.0], ..UNDERPAINTING },
            Layer {
                brushes: &[("filbert", 5), ("flat", 3), ("knife", 1)],
                size_px: [36.0, 14.0],
                coverage: 2.1,
                thickness: 0.9,
                dryness: 0.10,
                pickup: 0.12,
                ..BODY
            },
            Layer { size_px: [22.0, 9.0], coverage: 0.8, thickness: 1.0, ..FORM },
            Layer { coverage: 0.5, size_px: [48.0, 16.0], ..SCUMBLE },
            Layer { size_px: [15.0, 6.0], thickness: 1.0, ..ACCENTS },
            Layer { size_px: [26.0, 5.0], coverage: 0.7, ..CONTOUR },
            LIGHTS,
        ],
        overrun_px: 4.0,
        numbers: PresetNumbers {
            angle_jitter_deg: 14.0,
            swing_deg: 9.0,
            size_jitter: 0.2,
            color_jitter: 2.4,
            temperature: 2.4,
            grading: 0.8,
            ..PresetNumbers::USUAL
        },
    },
    // Little paint on a stiff brush: marks of single bristles, and what shows between them.
    Preset {
        name: "dry brush",
        layers: [
            Layer { thickness: 0.04, ..UNDERPAINTING },
            Layer {
                brushes: &[("dry", 5), ("fan", 1)],
                coverage: 3.0,
                opacity: 0.85,
                thickness: 0.25,
                dryness: 0.30,
                pickup: 0.05,
                ..BODY
            },
            Layer {
                brushes: &[("dry", 4), ("flat", 2)],
                coverage: 1.4,
                dryness: 0.34,
                thickness: 0.3,
                ..FORM
            },
            Layer { coverage: 1.6, dryness: 0.58, thickness: 0.3, ..SCUMBLE },
            Layer { brushes: &[("rigger", 2), ("dry", 3)], thickness: 0.3, ..ACCENTS },
            Layer { brushes: &[("rigger", 2), ("dry", 1)], coverage: 1.1, dryness: 0.3, ..CONTOUR },
            Layer { brushes: &[("dry", 1), ("round", 1)], thickness: 0.7, ..LIGHTS },
        ],
        overrun_px: 4.0,
        numbers: PresetNumbers { angle_jitter_deg: 6.0, color_jitter: 0.8, ..PresetNumbers::USUAL },
    },
    // Flat, opaque and crisp: planes of one colour.
    Preset {
        name: "gouache",
        layers: [
            Layer { thickness: 0.02, dryness: 0.04, ..UNDERPAINTING },
            Layer {
                brushes: &[("flat", 6), ("round", 2)],
                opacity: 1.0,
                thickness: 0.06,
                dryness: 0.05,
                pickup: 0.0,
                ..BODY
            },
            Layer { opacity: 1.0, thickness: 0.08, dryness: 0.05, pickup: 0.0, ..FORM },
            Layer { coverage: 0.25, thickness: 0.05, pickup: 0.0, ..SCUMBLE },
            Layer { opacity: 1.0, thickness: 0.08, pickup: 0.0, ..ACCENTS },
            Layer { coverage: 1.1, opacity: 1.0, thickness: 0.05, pickup: 0.0, ..CONTOUR },
            Layer { opacity: 1.0, thickness: 0.12, pickup: 0.0, ..LIGHTS },
        ],
        overrun_px: 1.5,
        numbers: PresetNumbers { angle_jitter_deg: 6.0, color_jitter: 0.7, ..PresetNumbers::USUAL },
    },
    // Few strokes of a wet brush, some of a dry one, and a line where the form ends.
    Preset {
        name: INK_PRESET,
        layers: [
            Layer { coverage: 0.0, ..UNDERPAINTING },
            Layer {
                brushes: &[("round", 3), ("flat", 3), ("filbert", 2)],
                size_px: [88.0, 27.0],
                coverage: 1.1,
                opacity: 0.9,
                thickness: 0.0,
                dryness: 0.16,
                pickup: 0.0,
                overrun: 1.6,
            },
            Layer {
                brushes: &[("round", 4), ("rigger", 1)],
                size_px: [66.0, 8.5],
                coverage: 1.5,
                thickness: 0.0,
                dryness: 0.10,
                pickup: 0.0,
                ..FORM
            },
            Layer {
                brushes: &[("dry", 1)],
                coverage: 0.5,
                opacity: 0.9,
                thickness: 0.0,
                dryness: 0.62,
                pickup: 0.0,
                ..SCUMBLE
            },
            Layer { coverage: 0.2, thickness: 0.0, pickup: 0.0, ..ACCENTS },
            Layer { coverage: 0.0, ..CONTOUR },
            Layer { coverage: 0.0, ..LIGHTS },
        ],
        overrun_px: 4.0,
        numbers: PresetNumbers {
            angle_jitter_deg: 5.0,
            swing_deg: 5.0,
            fit: 0.0,
            contour: 0.9,
            size_jitter: 0.24,
            temperature: 0.0,
            grading: 0.0,
            ..PresetNumbers::USUAL
        },
    },
    Preset {
        name: PAPER_PRESET,
        layers: [
            Layer { coverage: 0.0, ..UNDERPAINTING },
            Layer {
                brushes: &[("filbert", 1)],
                size_px: [24.0, 8.0],
                coverage: 3.0,
                thickness: 0.0,
                pickup: 0.0,
                ..BODY
            },
            Layer { coverage: 0.0, ..FORM },
            Layer { coverage: 0.0, ..SCUMBLE },
            Layer { coverage: 0.0, ..ACCENTS },
            Layer { coverage: 0.0, ..CONTOUR },
            Layer { coverage: 0.0, ..LIGHTS },
        ],
        overrun_px: 2.6,
        numbers: PresetNumbers {
            fit: 0.0,
            angle_jitter_deg: 0.0,
            swing_deg: 0.0,
            size_jitter: 0.0,
            color_jitter: 0.0,
            temperature: 0.0,
            grading: 0.0,
            ..PresetNumbers::USUAL
        },
    },
];

impl ResolvedStrokes {
    /// A preset's values, its pixels multiplied by `size`.
    pub(super) fn of_preset(preset: &Preset, size: f32) -> Self {
        let sized = |layer: Layer| {
            let mut layer = ResolvedLayer::from(layer);
            (layer.length_px, layer.width_px) = (layer.length_px * size, layer.width_px * size);
            layer
        };
        let edges = Edges::Overrun(preset.overrun_px * f64::from(size));
        Self::new(preset.layers.map(sized), preset.numbers, edges)
    }
}

impl From<Layer> for ResolvedLayer {
    fn from(layer: Layer) -> Self {
        let repeated =
            layer.brushes.iter().flat_map(|&(name, times)| std::iter::repeat_n(name.to_owned(), times));
        Self {
            brushes: repeated.collect(),
            hidden: false,
            length_px: layer.size_px[0],
            width_px: layer.size_px[1],
            coverage: layer.coverage,
            opacity: layer.opacity,
            thickness: layer.thickness,
            dryness: layer.dryness,
            pickup: layer.pickup,
            overrun: layer.overrun,
        }
    }
}
