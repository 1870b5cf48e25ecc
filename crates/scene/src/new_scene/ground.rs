//! What a model stands on in its new scene.

use crate::built_in_mesh;
use crate::document::{
    Color, Direction, Edges, LayerSettings, MaterialOverride, Object, Region, Selector, StrokeSettings,
};

use super::framing::View;
use super::scheme::Scheme;

/// The wall's strokes lean by one of these angles, degrees.
const WALL_DEG: [f64; 6] = [-38.0, -24.0, -14.0, 16.0, 27.0, 40.0];

/// What a model stands on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// A floor and a wall that fill the picture.
    #[default]
    Backdrop,
    /// A patch of floor before a plain background.
    Vignette,
    /// Nothing: one colour.
    Plain,
}

/// A ground as it is laid under a model.
#[derive(Debug)]
pub(super) struct Laid {
    pub object: Option<Object>,
    pub regions: Vec<Region>,
    pub background: Color,
}

impl Ground {
    /// All, with their names on the command line.
    pub const ALL: [(&'static str, Self); 3] =
        [("backdrop", Self::Backdrop), ("vignette", Self::Vignette), ("plain", Self::Plain)];

    /// Lays the ground. `taken` are the names of other objects; `seed` chooses how the wall's strokes lean.
    pub(super) fn lay(self, view: &View, scheme: &Scheme, taken: &[&str], seed: u32) -> Laid {
        let names = match self {
            Self::Backdrop => ["backdrop", "wall", "the backdrop"],
            Self::Vignette => ["floor", "patch", "the floor"],
            Self::Plain => {
                return Laid { object: None, regions: Vec::new(), background: scheme.plain_ground() };
            }
        };
        let name = names.into_iter().find(|name| !taken.contains(name)).unwrap_or(names[0]);
        let (object, parts) = if self == Self::Backdrop {
            let wall_deg = WALL_DEG[(seed >> 8) as usize % WALL_DEG.len()];
            let parts = vec![(built_in_mesh::WALL, wall_deg, 5.0), (built_in_mesh::FLOOR, 0.0, 3.0)];
            (view.backdrop(name), parts)
        } else {
            (view.patch(name), vec![(built_in_mesh::FLOOR, 0.0, 4.0)])
        };
        let material = Some(MaterialOverride { color: Some(scheme.ground), ..Default::default() });
        let region = |(group, angle_deg, jitter_deg): (&str, f64, f64)| Region {
            direction: Direction::Angle(angle_deg),
            // The patch ends in ragged strokes.
            strokes: StrokeSettings {
                edges: (self == Self::Vignette).then_some(Edges::Overrun(30.0)),
                ..quiet(jitter_deg)
            },
            ..Region::new(format!("{name} {group}"), Selector::Group(name.to_owned(), group.to_owned()))
        };
        let regions = parts.into_iter().map(region).collect();
        let background = if self == Self::Backdrop { scheme.background() } else { scheme.plain_ground() };
        Laid { object: Some(Object { material, ..object }), regions, background }
    }
}

/// Settings for a ground that does not draw the eye: large strokes that lie one way.
fn quiet(jitter_deg: f64) -> StrokeSettings {
    let layer = |(name, coverage, thickness): (&str, Option<f64>, f64)| LayerSettings {
        name: name.to_owned(),
        coverage,
        thickness: Some(thickness),
        ..Default::default()
    };
    StrokeSettings {
        scale: Some(1.6),
        angle_jitter_deg: Some(jitter_deg),
        swing_deg: Some(2.0),
        color_jitter: Some(0.35),
        grading: Some(0.5),
        layers: [
            ("body", None, 0.22),
            ("form", None, 0.12),
            ("scumble", None, 0.12),
            ("accents", None, 0.12),
            ("contour", Some(0.0), 0.0),
        ]
        .map(layer)
        .into(),
        ..Default::default()
    }
}
