//! Tests of overlays by the shapes that they draw.

use impasto_painting::BodyShape;
use std::path::Path;
use std::sync::Arc;

use egui::epaint::ClippedShape;
use egui::{Color32, Shape, pos2, vec2};
use impasto_editor_model::picking::Picker;
use impasto_painting::{Painting, prepare};
use impasto_scene::document::Lens;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion::{self, CameraPose};

use super::*;
use crate::viewport::surface_map::{StandingBody, SurfaceMap};

const RECT: Rect = Rect { min: pos2(48.0, 80.0), max: pos2(448.0, 305.0) };

fn view() -> View {
    let camera = CameraPose {
        eye: DVec3::new(0.0, 1.0, 5.0),
        target: DVec3::ZERO,
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 100.0 },
    };
    View { camera, size_px: DVec2::new(400.0, 225.0) }
}

/// The shapes that something draws, in one flat list.
fn drawn(draw: impl Fn(&Sheet<'_>)) -> Vec<Shape> {
    let ctx = egui::Context::default();
    crate::theme::apply(&ctx, crate::theme::Theme::Dark, 1.0);
    let view = view();
    // Fonts are loaded from the second pass on.
    let mut shapes = Vec::new();
    for _ in 0..2 {
        let output = ctx.run_ui(egui::RawInput::default(), |ui| {
            let painter = ui.painter().with_clip_rect(RECT);
            draw(&Sheet { painter: &painter, rect: RECT, view: &view });
        });
        shapes = output.shapes.clone();
        output.drop_without_applying_deltas();
    }
    fn flatten(shape: Shape, all: &mut Vec<Shape>) {
        match shape {
            Shape::Vec(several) => several.into_iter().for_each(|shape| flatten(shape, all)),
            Shape::Noop => {}
            shape => all.push(shape),
        }
    }
    let mut all = Vec::new();
    shapes.into_iter().for_each(|ClippedShape { shape, .. }| flatten(shape, &mut all));
    all
}

fn segments(shapes: &[Shape], colour: Color32) -> Vec<[Pos2; 2]> {
    let segment = |shape: &Shape| match shape {
        Shape::LineSegment { points, stroke } if stroke.color == colour => Some(*points),
        _ => None,
    };
    shapes.iter().filter_map(segment).collect()
}

fn direction_line(angle_deg: f32, ink: DirectionInk) -> DirectionMark {
    DirectionMark { at_px: DVec2::new(100.0, 50.0), angle_rad: angle_deg.to_radians(), ink, faint: false }
}

#[test]
fn a_direction_line_is_twelve_long_and_its_angle_counts_up_the_screen() {
    let shapes = drawn(|sheet| direction_lines(sheet, &[direction_line(30.0, DirectionInk::Plain)]));
    let [[from, to]] = segments(&shapes, Color32::WHITE)[..] else { panic!("one white line: {shapes:?}") };
    assert_eq!(from + (to - from) * 0.5, pos2(148.0, 130.0));
    assert!(((to - from).length() - 12.0).abs() < 1e-4);
    assert!((to - from).y < 0.0, "30 degrees rise");
    assert!(((to - from).angle().to_degrees() + 30.0).abs() < 1e-3);
}

#[test]
fn trust_is_told_by_pattern_as_well_as_by_colour() {
    let of =
        |kappa| drawn(|sheet| direction_lines(sheet, &[direction_line(0.0, DirectionInk::Trust(kappa))]));
    assert_eq!(segments(&of(0.97), Color32::WHITE).len(), 1);
    assert_eq!(segments(&of(0.90), ink::OVER_PAINT.ochre).len(), 2);
    assert_eq!(segments(&of(0.72), ink::OVER_PAINT.ochre).len(), 2);
    let dots = of(0.71);
    let pink = |shape: &&Shape| matches!(shape, Shape::Circle(circle) if circle.fill == ink::OVER_PAINT.pink);
    assert_eq!(dots.iter().filter(pink).count(), 4);
    assert!(dots.iter().all(|shape| matches!(shape, Shape::Circle(_))));
}

#[test]
fn the_tag_stays_within_the_picture() {
    for at_px in [DVec2::new(200.0, 100.0), DVec2::new(398.0, 224.0), DVec2::new(1.0, 224.0)] {
        let shapes = drawn(|sheet| needle_tag(sheet, at_px, 46.0, "10°  trust 0.97"));
        let boxes: Vec<Rect> = shapes
            .iter()
            .filter_map(|shape| if let Shape::Rect(rect) = shape { Some(rect.rect) } else { None })
            .collect();
        assert_eq!(boxes.len(), 1);
        assert!(RECT.contains_rect(boxes[0]), "{at_px}: {boxes:?}");
    }
}

#[test]
fn the_veil_covers_all_but_the_shot_once() {
    let shot = Rect::from_min_size(pos2(48.0, 110.0), vec2(400.0, 160.0));
    let shapes = drawn(|sheet| shot_border(sheet.painter, RECT, shot, Color32::BLACK));
    let veils: Vec<Rect> = shapes
        .iter()
        .filter_map(|shape| if let Shape::Rect(rect) = shape { Some(rect) } else { None })
        .filter(|rect| rect.fill != Color32::TRANSPARENT)
        .map(|rect| rect.rect)
        .collect();
    let covered: f32 = veils.iter().map(Rect::area).sum();
    assert!((covered - (RECT.area() - shot.area())).abs() < 1.0);
    assert!(
        veils.iter().all(|veil| veil.intersect(shot).area() < 1e-3 || !veil.intersects(shot.shrink(0.01)))
    );
}

#[test]
fn the_grid_is_drawn_where_it_can_be_seen() {
    let shapes = drawn(floor_grid);
    assert!(shapes.len() > 100);
    for shape in &shapes {
        let Shape::LineSegment { points, .. } = shape else { panic!("{shape:?}") };
        assert!(points.iter().all(|at| at.is_finite() && at.to_vec2().length() < 3e5));
    }
}

fn painting() -> Painting {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/roll.ron");
    prepare(Arc::new(load(&path, &LoadOptions::default()).unwrap())).unwrap()
}

#[test]
fn what_the_map_shows_is_what_rays_meet() {
    let painting = painting();
    let poses = motion::poses_at(painting.scene(), 20.0);
    let bodies: Vec<StandingBody> = poses
        .iter()
        .enumerate()
        .map(|(object, &world_from_model)| StandingBody {
            surface: Arc::clone(painting.surface(object)),
            shape: BodyShape::default(),
            world_from_model,
            visible: true,
        })
        .collect();
    let mut picker = Picker::default();
    picker.update(
        &bodies.iter().map(|body| (Arc::clone(&body.surface), body.shape.clone())).collect::<Vec<_>>(),
    );
    let view = View { camera: motion::camera_at(painting.scene(), 20.0), size_px: DVec2::new(320.0, 180.0) };
    let map = SurfaceMap::new(&bodies, &view, 0.5);
    let [columns, rows] = map.size();
    let (mut seen, mut other) = (0, 0);
    for row in 0..rows {
        for column in 0..columns {
            let at_px = (DVec2::new(column as f64, row as f64) + 0.5) / map.cells_per_point();
            let hit = picker.pick(&view.ray(at_px), &poses, |_| true);
            let face = map.face(column, row);
            if face.map(|face| (face.object, face.triangle))
                != hit.map(|hit| (hit.object as u32, hit.triangle))
            {
                other += 1;
            }
            if let Some(hit) = hit {
                seen += 1;
                let depth = view.depth(hit.position_in_world);
                assert!(map.shows(at_px, depth, hit.object), "{column} {row}");
                assert!(!map.shows(at_px, depth * 1.2, hit.object), "{column} {row}: far behind");
            }
        }
    }
    assert!(seen > 1000, "{seen}");
    // If the middle of a cell is on an edge, either face may be found.
    assert!(other * 200 < columns * rows, "{other} of {}", columns * rows);
}

#[test]
fn a_guide_shows_only_where_its_surface_faces_the_eye() {
    let painting = painting();
    let poses = motion::poses_at(painting.scene(), 0.0);
    let mut picker = Picker::default();
    picker.update(
        &(0..poses.len())
            .map(|object| (Arc::clone(painting.surface(object)), BodyShape::default()))
            .collect::<Vec<_>>(),
    );
    let view = View { camera: motion::camera_at(painting.scene(), 0.0), size_px: DVec2::new(320.0, 180.0) };
    let sight = Sight { picker: &picker, poses: &poses, visible: &|_| true, view: &view };
    let line: Vec<[DVec3; 2]> = (0..10)
        .filter_map(|step| {
            picker.pick(&view.ray(DVec2::new(150.0 + f64::from(step), 90.0)), &poses, |_| true)
        })
        .map(|hit| {
            [hit.position_in_world, poses[hit.object].transform_vector3(hit.normal_in_model).normalize()]
        })
        .collect();
    assert_eq!(line.len(), 10);
    let shown = GuideCurve::seen(&line, &line[..1], &sight);
    assert_eq!((shown.runs_px.len(), shown.handles_px.len(), shown.end_shows), (1, 1, true));
    assert!((shown.handles_px[0].1 - DVec2::new(150.0, 90.0)).length() < 1e-6);
    // Nothing shows where the surface faces away.
    let turned: Vec<[DVec3; 2]> = line.iter().map(|&[at, normal]| [at, -normal]).collect();
    assert!(GuideCurve::seen(&turned, &turned, &sight).runs_px.is_empty());
    // Nor behind the surface.
    let gaze = view.axes()[2];
    let behind: Vec<[DVec3; 2]> = line.iter().map(|&[at, normal]| [at + gaze * 0.3, normal]).collect();
    assert!(GuideCurve::seen(&behind, &behind, &sight).handles_px.is_empty());
}
