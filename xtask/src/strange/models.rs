//! Strange OBJ and MTL files: soups, fans, slivers, spikes, piles of the same triangle, far and tiny bodies, with
//! normals and texture coordinates of every kind.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use super::chance::Chance;

/// The most triangles or corners of a strange body.
const MOST: usize = 20_000;

/// Points, and faces that name points by their index from 0.
#[derive(Default)]
struct Body {
    points: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
}

const FORMS: [fn(&mut Chance) -> Body; 12] =
    [soup, fan, pile, wide_face, ball, grid, slivers, fins, shells, tube, clusters, line];

const MATERIALS: [&str; 4] = ["red", "skin", "wood", "leaf"];
const GROUPS: [&str; 4] = ["body", "stem", "leaf", "floor"];

/// An OBJ file, with materials in `m.mtl`.
pub fn obj(chance: &mut Chance) -> Vec<u8> {
    let form = FORMS[chance.below(FORMS.len())];
    let mut body = form(chance);
    place(chance, &mut body);
    let mut text = String::new();
    for _ in 0..chance.below(3) {
        line_of(&mut text, &["mtllib ", &chance.name(&["m.mtl"])]);
    }
    for point in &body.points {
        text.push('v');
        for coordinate in point {
            let _ = write!(text, " {}", chance.number(*coordinate));
        }
        if chance.is_odd() {
            let _ = write!(text, " {}", chance.number(1.0));
        }
        text.push('\n');
    }
    let (uvs, normals) = attributes(chance, &body, &mut text);
    let is_relative = chance.happens(0.2);
    for face in &body.faces {
        if chance.happens(0.02) {
            line_of(&mut text, &["usemtl ", &chance.name(&MATERIALS)]);
        }
        if chance.happens(0.02) {
            let word = chance.of(&["g ", "o ", "s "]);
            line_of(&mut text, &[word, &chance.name(&GROUPS)]);
        }
        text.push_str(if chance.is_odd() { chance.of(&["l", "p", "fo", "curv", "F", ""]) } else { "f" });
        for &corner in face {
            let index = |of: usize, count: usize| -> f64 {
                if is_relative { of as f64 - count as f64 } else { of as f64 + 1.0 }
            };
            let _ = write!(text, " {}", chance.number(index(corner, body.points.len())));
            if uvs > 0 || normals > 0 {
                text.push('/');
            }
            if uvs > 0 {
                let _ = write!(text, "{}", chance.number(index(corner % uvs, uvs)));
            }
            if normals > 0 {
                let _ = write!(text, "/{}", chance.number(index(corner % normals, normals)));
            }
        }
        text.push_str(if chance.is_odd() { " \\\n" } else { "\n" });
    }
    text.into_bytes()
}

fn line_of(text: &mut String, words: &[&str]) {
    words.iter().for_each(|word| text.push_str(word));
    text.push('\n');
}

/// Writes texture coordinates and normals. Returns how many of each.
fn attributes(chance: &mut Chance, body: &Body, text: &mut String) -> (usize, usize) {
    let uvs = if chance.happens(0.5) { chance.count(body.points.len()) } else { 0 };
    let spread = chance.of(&[1.0, 1e-6, 1e4, 0.0]);
    for _ in 0..uvs {
        let (u, v) = (chance.between(0.0, spread), chance.between(0.0, spread));
        let _ = writeln!(text, "vt {} {}", chance.number(u), chance.number(v));
    }
    let normals = if chance.happens(0.5) { chance.count(body.points.len()) } else { 0 };
    let kind = chance.below(4);
    for _ in 0..normals {
        let normal = match kind {
            0 => [0.0, 0.0, 0.0],
            1 => [0.0, 1.0, 0.0],
            2 => [1e-30, 0.0, 0.0],
            _ => direction(chance),
        };
        let words = normal.map(|part| chance.number(part));
        let _ = writeln!(text, "vn {}", words.join(" "));
    }
    (uvs, normals)
}

fn direction(chance: &mut Chance) -> [f64; 3] {
    let (turn, height) = (chance.between(0.0, TAU), chance.between(-1.0, 1.0));
    let flat = (1.0 - height * height).sqrt();
    [flat * turn.cos(), height, flat * turn.sin()]
}

/// Now and then makes the body large or tiny, flattens or stretches it along an axis, or moves it far away.
fn place(chance: &mut Chance, body: &mut Body) {
    let size = chance.of(&[1.0, 1.0, 1.0, 100.0, 1e4, 1e-3, 1e-6, 1e6]);
    let mut stretch = [size; 3];
    if chance.happens(0.2) {
        stretch[chance.below(3)] *= chance.of(&[0.0, 1e-6, 1e-3, 1e3]);
    }
    let far = chance.of(&[0.0, 0.0, 0.0, 1.0, 1e3, 1e5, 1e7]);
    let offset = direction(chance).map(|part| part * far * size);
    for point in &mut body.points {
        for axis in 0..3 {
            point[axis] = point[axis] * stretch[axis] + offset[axis];
        }
    }
}

fn anywhere(chance: &mut Chance) -> [f64; 3] {
    [0; 3].map(|_: i32| chance.between(-1.0, 1.0))
}

/// Triangles at random places.
fn soup(chance: &mut Chance) -> Body {
    let count = chance.count(MOST);
    let points = (0..3 * count).map(|_| anywhere(chance)).collect();
    Body { points, faces: (0..count).map(|face| vec![3 * face, 3 * face + 1, 3 * face + 2]).collect() }
}

/// All triangles share one point; the rim may go round many times.
fn fan(chance: &mut Chance) -> Body {
    let (count, rounds) = (chance.count(MOST).max(3), chance.count(50) as f64);
    let height = chance.between(-1.0, 1.0);
    let mut points = vec![[0.0, height, 0.0]];
    points.extend((0..count).map(|at| {
        let turn = TAU * rounds * at as f64 / count as f64;
        [turn.cos(), 0.0, turn.sin()]
    }));
    Body { points, faces: (1..count).map(|at| vec![0, at, at + 1]).collect() }
}

/// The same triangle again and again, now and then the other way round.
fn pile(chance: &mut Chance) -> Body {
    let points = (0..3).map(|_| anywhere(chance)).collect();
    let faces = (0..chance.count(MOST))
        .map(|_| if chance.happens(0.1) { vec![2, 1, 0] } else { vec![0, 1, 2] })
        .collect();
    Body { points, faces }
}

/// One face with many corners, round or crossing itself.
fn wide_face(chance: &mut Chance) -> Body {
    let count = chance.count(MOST).max(3);
    let (waves, is_star) = (chance.below(40) as f64, chance.happens(0.3));
    let points = (0..count)
        .map(|at| {
            let turn = TAU * at as f64 / count as f64 * if is_star { 0.382 * count as f64 } else { 1.0 };
            let radius = 1.0 + 0.4 * (waves * turn).sin();
            [
                radius * turn.cos(),
                radius * turn.sin(),
                0.1 * chance.between(-1.0, 1.0) * f64::from(waves > 20.0),
            ]
        })
        .collect();
    Body { points, faces: vec![(0..count).collect()] }
}

/// A ball, smooth or with spikes.
fn ball(chance: &mut Chance) -> Body {
    let rings = chance.count(80).max(2);
    let spikes = chance.of(&[0.0, 0.05, 1.0, 30.0]);
    let mut points = Vec::new();
    for ring in 0..=rings {
        let tilt = std::f64::consts::PI * ring as f64 / rings as f64;
        for slice in 0..rings {
            let turn = TAU * slice as f64 / rings as f64;
            let radius = 1.0 + spikes * chance.between(0.0, 1.0).powi(8);
            points.push([
                radius * tilt.sin() * turn.cos(),
                radius * tilt.cos(),
                radius * tilt.sin() * turn.sin(),
            ]);
        }
    }
    Body { points, faces: quads(rings, rings, rings) }
}

/// Quads between `rows + 1` rows of `across` points: `joined` quads between each row and the next. If `joined` equals
/// `across`, the last of them joins the ends of the rows to their beginnings, so that the rows are rings.
fn quads(rows: usize, across: usize, joined: usize) -> Vec<Vec<usize>> {
    (0..rows)
        .flat_map(|row| (0..joined).map(move |column| (row * across, column, (column + 1) % across)))
        .map(|(row, here, next)| vec![row + here, row + next, row + across + next, row + across + here])
        .collect()
}

/// A field of quads with holes: level, rough or full of spikes.
fn grid(chance: &mut Chance) -> Body {
    let side = chance.count(120).max(2);
    let height = chance.of(&[0.0, 0.02, 0.3, 20.0]);
    let mut points = Vec::new();
    for row in 0..side {
        for column in 0..side {
            let at = |index: usize| 2.0 * index as f64 / (side - 1) as f64 - 1.0;
            points.push([at(column), height * chance.between(-1.0, 1.0), at(row)]);
        }
    }
    let mut faces = quads(side - 1, side, side - 1);
    faces.retain(|_| !chance.happens(0.05));
    Body { points, faces }
}

/// Triangles at most a thousandth of a unit wide; some have no width.
fn slivers(chance: &mut Chance) -> Body {
    let mut body = Body::default();
    for _ in 0..chance.count(MOST) {
        let (from, to) = (anywhere(chance), anywhere(chance));
        let width = chance.of(&[1e-3, 1e-6, 1e-9, 0.0]);
        let first = body.points.len();
        body.points.extend([from, to, [0, 1, 2].map(|axis| to[axis] + width * f64::from(axis == 1))]);
        body.faces.push(vec![first, first + 1, first + 2]);
    }
    body
}

/// Many faces that share one edge.
fn fins(chance: &mut Chance) -> Body {
    let mut points = vec![[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let count = chance.count(MOST);
    points.extend((0..count).map(|_| anywhere(chance)));
    Body { points, faces: (0..count).map(|fin| vec![0, 1, fin + 2]).collect() }
}

/// Cubes within cubes, some inside out.
fn shells(chance: &mut Chance) -> Body {
    let mut body = Body::default();
    let step = chance.of(&[1e-7, 1e-3, 0.02]);
    for shell in 0..chance.count(300) {
        let (half, first) = (1.0 + step * shell as f64, body.points.len());
        for corner in 0..8 {
            body.points.push([0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { half } else { -half }));
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let mut corners: Vec<usize> = face.iter().map(|corner| first + corner).collect();
            if chance.happens(0.3) {
                corners.reverse();
            }
            body.faces.push(corners);
        }
    }
    body
}

/// A tube along a knot, thick or as thin as a hair, with up to one and a half twists.
fn tube(chance: &mut Chance) -> Body {
    let (steps, sides) = (chance.count(600).max(3), chance.count(24).max(2));
    let thickness = chance.of(&[0.3, 0.02, 1e-4]);
    let (knots, twists) = (chance.below(7) as f64, chance.below(4) as f64 * 0.5);
    let mut points = Vec::new();
    for step in 0..=steps {
        let turn = TAU * step as f64 / steps as f64;
        let middle = [
            (2.0 + (knots * turn).cos()) * turn.cos() * 0.4,
            (knots * turn).sin() * 0.4,
            (2.0 + (knots * turn).cos()) * turn.sin() * 0.4,
        ];
        for side in 0..sides {
            let around = TAU * (side as f64 / sides as f64) + twists * turn;
            let (out, up) = (thickness * around.cos(), thickness * around.sin());
            points.push([middle[0] + out * turn.cos(), middle[1] + up, middle[2] + out * turn.sin()]);
        }
    }
    Body { points, faces: quads(steps, sides, sides) }
}

/// A cloud of triangles. A part of their corners lies far away from the rest.
fn clusters(chance: &mut Chance) -> Body {
    let mut body = soup(chance);
    let gap = chance.of(&[10.0, 1e4, 1e8]);
    let near = chance.below(body.points.len());
    for point in body.points.iter_mut().skip(near) {
        point[0] += gap;
    }
    body
}

/// All points on one line, or at one place.
fn line(chance: &mut Chance) -> Body {
    let mut body = soup(chance);
    let along = direction(chance).map(|part| part * f64::from(u8::from(chance.happens(0.7))));
    for point in &mut body.points {
        let at = point[0];
        *point = along.map(|part| part * at);
    }
    body
}

/// A file of materials.
pub fn mtl(chance: &mut Chance) -> Vec<u8> {
    let mut text = String::new();
    for _ in 0..chance.count(12) {
        line_of(&mut text, &["newmtl ", &chance.name(&MATERIALS)]);
        for _ in 0..chance.below(8) {
            let key = chance.of(&[
                "Kd", "Ks", "Ns", "map_Kd", "Ka", "Ke", "d", "Tr", "illum", "map_Bump", "Ni", "Pm", "kd",
            ]);
            text.push_str(key);
            if key.starts_with("map") {
                let options = chance.of(&[
                    "",
                    "-s 2 2 1 ",
                    "-o .5 .5 ",
                    "-clamp on ",
                    "-bm 0.2 ",
                    "-mm 0 ",
                    "-texres x ",
                ]);
                line_of(&mut text, &[" ", options, &chance.name(&["t.png", "none.png"])]);
                continue;
            }
            for _ in 0..chance.of(&[1, 3, 3, 3, 4]) {
                let usual = chance.between(0.0, 1.0);
                let _ = write!(text, " {}", chance.number(usual));
            }
            text.push('\n');
        }
    }
    text.into_bytes()
}
