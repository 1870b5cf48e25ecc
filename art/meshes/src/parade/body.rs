//! The giant's body in its costume, as a distance field and as one closed skin: tunic, sash, trousers, shoes, gloves.

use glam::DVec3;

use crate::limb::{Limb, blend};
use crate::poly_mesh::{Face, Look, PolyMesh};
use crate::surface_net::{Grid, tighten, weave};

/// A part of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Neck,
    Trunk,
    Arm,
    Hand,
    Leg,
    Shoe,
}

/// Sections of the tunic, from the lowest up to the collar: x, y, z, half the width, half the depth. What lies below
/// [`HEM`] is cut off. The tables below have the same columns; they are of the left side, which is +X.
const TRUNK: [[f64; 5]; 9] = [
    [0.0, 0.54, 0.010, 0.272, 0.228],
    [0.0, 0.68, 0.010, 0.250, 0.207],
    [0.0, 0.80, 0.008, 0.214, 0.178],
    [0.0, 0.93, 0.010, 0.182, 0.156],
    [0.0, 1.06, 0.022, 0.190, 0.172],
    [0.0, 1.18, 0.014, 0.196, 0.160],
    [0.0, 1.28, 0.000, 0.196, 0.134],
    [0.0, 1.345, -0.008, 0.158, 0.108],
    [0.0, 1.385, -0.010, 0.090, 0.080],
];

const NECK: [[f64; 5]; 3] =
    [[0.0, 1.33, -0.01, 0.075, 0.07], [0.0, 1.42, -0.01, 0.070, 0.068], [0.0, 1.50, 0.0, 0.070, 0.068]];

/// The sleeve: full at the shoulder, narrow at the elbow, wide again at the wrist.
const ARM: [[f64; 5]; 6] = [
    [0.120, 1.318, -0.008, 0.070, 0.080],
    [0.190, 1.312, -0.010, 0.082, 0.084],
    [0.270, 1.225, -0.010, 0.070, 0.072],
    [0.365, 1.110, -0.010, 0.062, 0.064],
    [0.440, 1.020, -0.005, 0.064, 0.066],
    [0.500, 0.950, 0.000, 0.076, 0.078],
];

/// The glove's palm, with its fingers together.
const HAND: [[f64; 5]; 4] = [
    [0.500, 0.950, 0.000, 0.036, 0.042],
    [0.545, 0.896, 0.006, 0.042, 0.058],
    [0.578, 0.850, 0.014, 0.040, 0.060],
    [0.600, 0.806, 0.024, 0.030, 0.046],
];

const THUMB: [[f64; 5]; 3] = [
    [0.530, 0.905, 0.030, 0.026, 0.026],
    [0.542, 0.880, 0.074, 0.024, 0.024],
    [0.552, 0.852, 0.092, 0.021, 0.021],
];

/// A trouser leg, gathered at the ankle.
const LEG: [[f64; 5]; 7] = [
    [0.090, 0.86, 0.000, 0.104, 0.110],
    [0.100, 0.70, 0.004, 0.114, 0.118],
    [0.109, 0.60, 0.010, 0.099, 0.113],
    [0.115, 0.50, 0.014, 0.090, 0.103],
    [0.117, 0.34, 0.004, 0.096, 0.104],
    [0.119, 0.22, -0.008, 0.092, 0.098],
    [0.120, 0.135, -0.014, 0.064, 0.068],
];

/// Height of the tunic's hem.
const HEM: f64 = 0.640;
/// Height of the sash's middle, and half its width.
const SASH: [f64; 2] = [0.925, 0.042];

/// Heights of the buttons on the tunic's front, and how far in front they are.
const BUTTONS: [[f64; 2]; 2] = [[1.115, 0.198], [1.245, 0.158]];
const BUTTON_RADIUS: f64 = 0.036;

/// The body's parts as distance fields.
pub struct Form {
    trunk: Limb,
    neck: Limb,
    arm: Limb,
    hand: Limb,
    thumb: Limb,
    leg: Limb,
}

impl Form {
    pub fn new() -> Self {
        Self {
            trunk: Limb::through(&TRUNK),
            neck: Limb::through(&NECK),
            arm: Limb::through(&ARM),
            hand: Limb::through(&HAND),
            thumb: Limb::through(&THUMB),
            leg: Limb::through(&LEG),
        }
    }

    fn trunk(&self, point: DVec3) -> f64 {
        let sash = (0.016 - 0.35 * (point.y - SASH[0]).abs().max(SASH[1] - 0.02) + 0.0077).clamp(0.0, 0.016);
        cut(self.trunk.distance(point) - sash, HEM - point.y)
    }

    /// How far a point lies from each part; both sides are alike.
    pub fn parts(&self, point: DVec3) -> [(Part, f64); 6] {
        let point = DVec3::new(point.x.abs(), point.y, point.z);
        let wrist = ARM[5];
        let out = (DVec3::from_slice(&wrist[..3]) - DVec3::from_slice(&ARM[4][..3])).normalize();
        // The cuff is cut off straight.
        let past_cuff = (point - DVec3::from_slice(&wrist[..3])).dot(out) + 0.012;
        let arm = cut(self.arm.distance(point), past_cuff);
        let hand = blend(self.hand.distance(point), self.thumb.distance(point), 0.03);
        let leg = self.leg.distance(point).max(0.115 - point.y);
        [
            (Part::Neck, self.neck.distance(point)),
            (Part::Trunk, self.trunk(point)),
            (Part::Arm, arm),
            (Part::Hand, hand),
            (Part::Leg, leg),
            (Part::Shoe, shoe(point)),
        ]
    }

    /// The part that a point of the skin lies on.
    pub fn part(&self, point: DVec3) -> Part {
        let nearest = |a: (Part, f64), b: (Part, f64)| if b.1 < a.1 { b } else { a };
        self.parts(point).into_iter().reduce(nearest).map_or(Part::Trunk, |(part, _)| part)
    }

    /// The distance to `part` minus the distance to the nearest other part: negative where the skin belongs to `part`.
    fn ahead(&self, point: DVec3, part: Part) -> f64 {
        let (mut own, mut others) = (f64::INFINITY, f64::INFINITY);
        for (other, distance) in self.parts(point) {
            let nearest = if other == part { &mut own } else { &mut others };
            *nearest = distance.min(*nearest);
        }
        own - others
    }

    /// About how far a point lies from the skin, negative inside.
    pub fn distance(&self, point: DVec3) -> f64 {
        let [neck, trunk, arm, hand, leg, shoe] = self.parts(point).map(|(_, distance)| distance);
        let upper = blend(blend(trunk, arm, 0.06), neck, 0.02);
        let upper = blend(upper, hand, 0.008);
        let lower = blend(leg, shoe, 0.012);
        blend(upper, lower, 0.01).min(button(point))
    }
}

/// The distance to the intersection of two bodies, given the distance to each; the edge between them is rounded.
fn cut(a: f64, b: f64) -> f64 {
    -blend(-a, -b, 0.03)
}

/// Distance from the nearest button.
fn button(point: DVec3) -> f64 {
    let to = |[y, z]: [f64; 2]| (point - DVec3::new(0.0, y, z)).length() - BUTTON_RADIUS;
    BUTTONS.into_iter().map(to).fold(f64::INFINITY, f64::min)
}

/// Distance from the left shoe: a round heel and a big round toe, flat below.
fn shoe(point: DVec3) -> f64 {
    let ball = |at: [f64; 3], half: [f64; 3]| {
        let (away, half) = (point - DVec3::from_array(at), DVec3::from_array(half));
        let (scaled, slope) = ((away / half).length(), (away / (half * half)).length());
        if slope > 0.0 { scaled * (scaled - 1.0) / slope } else { -half.min_element() }
    };
    let heel = ball([0.120, 0.040, -0.030], [0.068, 0.082, 0.082]);
    let middle = ball([0.123, 0.030, 0.060], [0.066, 0.076, 0.110]);
    let toe = ball([0.130, 0.030, 0.160], [0.084, 0.082, 0.098]);
    let ankle = ball([0.120, 0.100, -0.020], [0.062, 0.050, 0.066]);
    let whole = blend(blend(blend(heel, middle, 0.05), toe, 0.05), ankle, 0.03);
    whole.max(-point.y)
}

/// The body: one closed skin.
pub fn body(form: &Form) -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "body",
        "The giant's body.",
        &[
            ("tunic", "#e0a32e"),
            ("trousers", "#2c3f78"),
            ("shoes", "#c23a2c"),
            ("gloves", "#f3ead6"),
            ("sash", "#c8402f"),
            ("neck", "#e2ab84"),
        ],
    );
    let field = |point| form.distance(point);
    let cell = 0.0250;
    let low = DVec3::new(-26.5 * cell, -0.0305, -0.245);
    let grid = Grid { low, high: DVec3::new(26.5 * cell, 1.60, 0.285), cell: DVec3::splat(cell) };
    let bare = Look { group: "body", material: "tunic" };
    // Woven a little too thick, so that thin parts are not torn; `tighten` then pulls the points onto the body.
    let points = weave(&mut mesh, &grid, |point| field(point) - 0.004, bare);
    tighten(&mut mesh, points, field, 5);
    trim(&mut mesh, |at| (at.y - SASH[0]).abs() - SASH[1]);
    trim(&mut mesh, |at| button(at) - 0.006);
    for part in [Part::Neck, Part::Hand, Part::Leg, Part::Shoe] {
        trim(&mut mesh, |at| form.ahead(at, part));
    }
    for face in &mut mesh.faces {
        let sum = face.corners.iter().map(|&corner| mesh.positions[corner]).sum::<DVec3>();
        let middle = sum / face.corners.len() as f64;
        face.look.material = material(form, middle);
    }
    mesh
}

/// Lays edges of a mesh along the line where `side` is zero, so that two cloths meet there without a jagged border. Of
/// each edge that crosses the line, the nearer end is moved onto the crossing. A quad that the line then crosses from
/// corner to corner is cut in two.
fn trim(mesh: &mut PolyMesh, side: impl Fn(DVec3) -> f64) {
    let mut sides: Vec<f64> = mesh.positions.iter().map(|&at| side(at)).collect();
    for face in &mesh.faces {
        for (index, &from) in face.corners.iter().enumerate() {
            let to = face.corners[(index + 1) % face.corners.len()];
            if sides[from] * sides[to] < 0.0 {
                let share = sides[from] / (sides[from] - sides[to]);
                let crossing = mesh.positions[from].lerp(mesh.positions[to], share);
                let nearer = if share < 0.5 { from } else { to };
                mesh.positions[nearer] = crossing;
                sides[nearer] = 0.0;
            }
        }
    }
    let faces = std::mem::take(&mut mesh.faces);
    for Face { mut corners, look } in faces {
        let on_line = |corner: usize| sides[corner] == 0.0;
        if corners.len() == 4 && on_line(corners[1]) && on_line(corners[3]) {
            corners.rotate_left(1);
        }
        let crossed = corners.len() == 4 && sides[corners[1]] * sides[corners[3]] < 0.0;
        if crossed && on_line(corners[0]) && on_line(corners[2]) {
            mesh.faces.push(Face { corners: vec![corners[0], corners[1], corners[2]], look });
            mesh.faces.push(Face { corners: vec![corners[0], corners[2], corners[3]], look });
        } else {
            mesh.faces.push(Face { corners, look });
        }
    }
}

/// The cloth at a place of the skin.
fn material(form: &Form, at: DVec3) -> &'static str {
    match form.part(at) {
        Part::Neck => "neck",
        _ if button(at) < 0.006 => "sash",
        Part::Trunk if (at.y - SASH[0]).abs() < SASH[1] => "sash",
        Part::Trunk | Part::Arm => "tunic",
        Part::Hand => "gloves",
        Part::Leg => "trousers",
        Part::Shoe => "shoes",
    }
}
