//! Regions, their directions, and the guides that comb them, as a scene file states them.

mod amounts;

use serde::{Deserialize, Serialize};

use super::{Color, Reference, Stage, StrokeSettings, is_default, is_one, one};

pub use amounts::{Amount, AmountDab, PaintedAmount};

/// A part of the scene with settings of its own.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Unique.
    pub name: String,
    /// What it covers.
    pub on: Selector,
    /// Base direction of its strokes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub direction: Direction,
    /// Gestures on the surface that strokes follow: within their radius, or, where the direction is `Auto`, in the
    /// whole region. A later one overrules an earlier one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub guides: Vec<Guide>,
    /// Where a brush has changed the width, length, density or flatness of the region's strokes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub amounts: Vec<PaintedAmount>,
    /// How its directions meet those of the regions that it lies on.
    #[serde(default, skip_serializing_if = "is_default")]
    pub seam: Seam,
    /// Whether its strokes have a beginning and an end.
    #[serde(default, skip_serializing_if = "is_default")]
    pub sense: Sense,
    /// The pose that its directions refer to; left out, the scene's.
    #[serde(default, skip_serializing_if = "is_default")]
    pub reference: Option<Reference>,
    /// Settings that differ from the scene's.
    #[serde(default, skip_serializing_if = "is_default")]
    pub strokes: StrokeSettings,
    /// Turns all its directions, stated and combed: degrees counter-clockwise, as seen in the reference pose.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turn_deg: f64,
    /// Its strokes are left out of the picture; all else stays as it was.
    #[serde(default, skip_serializing_if = "is_default")]
    pub hidden: bool,
    /// The editor does not change it; no other effect.
    #[serde(default, skip_serializing_if = "is_default")]
    pub locked: bool,
    /// Its colour in the editor's overlays; no other effect.
    #[serde(default, skip_serializing_if = "is_default")]
    pub color: Option<Color>,
}

/// What a region covers.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Selector {
    /// All objects.
    Everything,
    /// A whole object, by name.
    Object(String),
    /// All objects of a collection of the shot. The collection has the name that it had in the program that wrote the
    /// shot.
    Collection(String),
    /// A material of this name, on every object that has it.
    EachMaterial(String),
    /// A group of an object's mesh: object, group.
    Group(String, String),
    /// A material of an object's mesh: object, material.
    Material(String, String),
    /// What dabs of a brush have touched: object, dabs, in the order of painting.
    Dabs(String, Vec<Dab>),
    /// What is reached from a face without crossing a sharp edge: the object, where the flood begins, and an angle,
    /// degrees, from 0 to 180. An edge is sharp if its two faces are turned from each other by this angle or more.
    Flood(String, Seed, f64),
    /// Patches of one object, in order: each adds to those before it, and dabs with `take_away` cut them.
    Several(String, Vec<Patch>),
}

/// One piece of what a region covers on its object.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Patch {
    /// The whole object.
    Whole,
    /// A group of its mesh.
    Group(String),
    /// A material of its mesh.
    Material(String),
    /// What dabs have touched.
    Dabs(Vec<Dab>),
    /// What is reached from a face: where the flood begins, and the angle of a sharp edge, as in the selector `Flood`.
    Flood(Seed, f64),
}

/// Where a flood begins: at the face nearest to `at`. If several faces are about equally near, it begins at one that
/// faces the way `normal` points.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Seed {
    /// The place, in the object's own space.
    pub at: [f64; 3],
    /// Normal of the surface there, in the object's own space.
    pub normal: [f64; 3],
}

/// One touch of a brush on a surface; all in the object's own space.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Dab {
    /// The place, in the object's own space.
    pub at: [f64; 3],
    /// Normal of the surface there; only a surface turned from it by less than 90° is touched.
    pub normal: [f64; 3],
    /// How far it reaches, more than 0, units of the object's own space.
    pub radius: f64,
    /// Whether it removes what it touches instead of adding it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub take_away: bool,
}

/// Base direction of strokes.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Direction {
    /// As a painter would begin: along the longest axis of each part, almost level on flat backdrops. If the region has
    /// guides that comb, they decide its directions instead.
    #[default]
    Auto,
    /// Degrees counter-clockwise from the picture's +X, as seen in the reference pose.
    Angle(f64),
    /// Two families of strokes that cross: the angle of each, as with `Angle`.
    Crossing(f64, f64),
    /// Along this axis of the object's own space, on the surface.
    Along([f64; 3]),
    /// Round this axis of the object's own space, along the surface.
    Around([f64; 3]),
    /// Up the surface, towards the object's own +Y.
    Up,
    /// Towards a point of the object's own space, along the surface.
    Toward([f64; 3]),
    /// Along the surface's least or greatest bend.
    Curvature(Bend),
}

/// Which of the two principal curvatures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Bend {
    /// The direction in which the surface bends least: along a log.
    Min,
    /// The direction in which it bends most: round a log.
    Max,
}

/// How directions meet at a region's border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Seam {
    /// Directions change from one stroke to the next.
    #[default]
    Hard,
    /// Directions turn into each other over this distance on either side of the border, units of the object's own
    /// space.
    Soft(f64),
}

/// Whether strokes have a beginning and an end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Sense {
    /// A direction and its opposite are the same: a field of lines.
    #[default]
    Lines,
    /// Strokes run the way that directions and guides point: a field of arrows.
    Arrows,
}

/// A gesture on the surface of an object that strokes follow; all in the object's own space, so that it holds at any
/// frame and survives a new mesh.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Guide {
    /// What it does with the strokes that it reaches.
    #[serde(default, skip_serializing_if = "is_default")]
    pub mode: GuideMode,
    /// Set point by point, as one curve. Strokes follow it like any gesture; only lists of guides show the difference.
    #[serde(default, skip_serializing_if = "is_default")]
    pub curve: bool,
    /// The object, where the region covers more than one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub object: Option<String>,
    /// The view in which the guide was drawn: seen from there, strokes look as they were drawn. Left out, the
    /// reference.
    #[serde(default, skip_serializing_if = "is_default")]
    pub view: Option<GuideView>,
    /// At least two points of the surface, in the order of the gesture.
    pub points: Vec<GuidePoint>,
    /// How far it reaches, more than 0, units of the object's own space.
    pub radius: f64,
    /// How far strokes on it follow it, from 0, not at all, to 1, wholly.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub strength: f64,
    /// How its strength falls off towards its radius.
    #[serde(default, skip_serializing_if = "is_default")]
    pub falloff: Falloff,
}

/// What a guide does with the strokes that it reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum GuideMode {
    /// Strokes lie along it.
    #[default]
    Comb,
    /// The guide states no direction. It loosens stated directions and those combed by earlier guides, so that strokes
    /// blend with their surroundings. Later guides that comb overrule this one.
    Smooth,
}

/// Where a guide was looked at from when it was drawn.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GuideView {
    /// The eye, in the object's own space.
    pub eye: [f64; 3],
    /// What it looked at, in the object's own space.
    pub target: [f64; 3],
    /// The frame whose shape the body had when the guide was drawn; left out, the body's rest.
    #[serde(default, skip_serializing_if = "is_default")]
    pub frame: Option<f64>,
}

/// One point of a guide.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GuidePoint {
    /// The place, in the object's own space.
    pub at: [f64; 3],
    /// Normal of the surface there.
    pub normal: [f64; 3],
    /// How far strokes are turned from the gesture's own line here: degrees counter-clockwise, as seen in the guide's
    /// view. Between two points, the turn changes evenly.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turn_deg: f64,
}

/// How the strength of a guide falls off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Falloff {
    /// (1 − (r/R)²)², where r is the distance from the guide and R the guide's radius.
    #[default]
    Smooth,
    /// 1 − r/R.
    Linear,
    /// Full up to the radius.
    Flat,
}

impl Region {
    /// A region without settings of its own.
    pub fn new(name: impl Into<String>, on: Selector) -> Self {
        Self {
            name: name.into(),
            on,
            direction: Direction::default(),
            guides: Vec::new(),
            amounts: Vec::new(),
            seam: Seam::default(),
            sense: Sense::default(),
            reference: None,
            strokes: StrokeSettings::default(),
            turn_deg: 0.0,
            hidden: false,
            locked: false,
            color: None,
        }
    }
}

/// One piece of what a selector covers, borrowed from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatchRef<'a> {
    /// The whole object.
    Whole,
    /// A group, by name.
    Group(&'a str),
    /// A material, by name.
    Material(&'a str),
    /// Dabs, in the order of painting.
    Dabs(&'a [Dab]),
    /// A flood: where it begins, and the angle from which an edge counts as sharp, degrees.
    Flood(&'a Seed, f64),
}

impl Patch {
    fn as_ref(&self) -> PatchRef<'_> {
        match self {
            Self::Whole => PatchRef::Whole,
            Self::Group(group) => PatchRef::Group(group),
            Self::Material(material) => PatchRef::Material(material),
            Self::Dabs(dabs) => PatchRef::Dabs(dabs),
            Self::Flood(seed, sharp_deg) => PatchRef::Flood(seed, *sharp_deg),
        }
    }
}

impl Selector {
    /// The object that it lies on; `None` if it may lie on several.
    pub fn object(&self) -> Option<&str> {
        match self {
            Self::Everything | Self::Collection(_) | Self::EachMaterial(_) => None,
            Self::Object(object)
            | Self::Group(object, _)
            | Self::Material(object, _)
            | Self::Dabs(object, _)
            | Self::Flood(object, ..)
            | Self::Several(object, _) => Some(object),
        }
    }

    /// Whether it may cover a part of an object.
    pub fn reaches(&self, stage: &Stage, object: &str) -> bool {
        match self {
            Self::Everything | Self::EachMaterial(_) => true,
            Self::Collection(name) => {
                stage.shot.as_ref().is_some_and(|shot| shot.in_collection(name, object) == Some(true))
            }
            _ => self.object() == Some(object),
        }
    }

    /// What it covers on each object that it lies on: a single patch, or those of `Several` in order.
    pub fn patches(&self) -> Vec<PatchRef<'_>> {
        match self {
            Self::Everything | Self::Object(_) | Self::Collection(_) => vec![PatchRef::Whole],
            Self::EachMaterial(material) => vec![PatchRef::Material(material)],
            Self::Group(_, group) => vec![PatchRef::Group(group)],
            Self::Material(_, material) => vec![PatchRef::Material(material)],
            Self::Dabs(_, dabs) => vec![PatchRef::Dabs(dabs)],
            Self::Flood(_, seed, sharp_deg) => vec![PatchRef::Flood(seed, *sharp_deg)],
            Self::Several(_, patches) => patches.iter().map(Patch::as_ref).collect(),
        }
    }
}
