//! Tests how far a reference decides the directions of a surface that it sees at a slant: wholly if the cosine between
//! view and normal is 0.5 or more, not at all below 0.2, and in part between (docs/techniques/rotating_strokes.md).

use glam::{DMat2, DMat3, DVec2, DVec3};
use impasto_painting::frame::LayerKind;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Direction, Lens, ObjectKey};
use impasto_scene::motion::CameraPose;
use impasto_tests::shapes;

const ANGLE_DEG: f64 = 35.0;
const LENS: Lens = Lens::Orthographic { height: 3.0, near: 0.05, far: 100.0 };

/// The eye of the later view, which sees the sheet strongly slanted in two directions.
const LATER_EYE: DVec3 = DVec3::new(1.5, 3.4, 1.9);

/// The sheet's axes and normal, turned about Y so that the reference sees it at this cosine.
fn sheet_axes(facing: f64) -> DMat3 {
    DMat3::from_rotation_y(facing.acos())
}

/// The expected angle of a stroke in the later view. The reference, in which the stroke's direction is stated, decides
/// `share` of it; a camera straight in front of the sheet decides the rest.
fn expected_deg(facing: f64, share: f64) -> f64 {
    let axes = sheet_axes(facing);
    let gaze = -LATER_EYE.normalize();
    let right = gaze.cross(DVec3::Y).normalize();
    let up = right.cross(gaze);
    let shown = |axis: DVec3| DVec2::new(right.dot(axis), up.dot(axis));
    let later_from_sheet = DMat2::from_cols(shown(axes.x_axis), shown(axes.y_axis));
    // The reference sees the sheet narrowed by `facing`; the camera in front sees it undistorted.
    let sheet_from_reference = DMat2::from_diagonal(DVec2::new(1.0 / facing, 1.0));
    let turn = |map: DMat2| DVec2::new(map.x_axis.x + map.y_axis.y, map.x_axis.y - map.y_axis.x);
    let stated = turn(later_from_sheet * sheet_from_reference);
    let straight = turn(later_from_sheet);
    ANGLE_DEG + (stated * share + straight * (1.0 - share)).to_angle().to_degrees()
}

/// The mean angle of the sheet's strokes in the later view.
fn found_deg(facing: f64) -> f64 {
    let mut scene = shapes::scene(vec![shapes::object("sheet", 3000)]);
    scene.camera.lens = LENS;
    (scene.strokes.contour, scene.strokes.flatness) = (Some(0.0), Some(1.0));
    scene.strokes.layers = shapes::body_layer_alone();
    scene.regions[0].direction = Direction::Angle(ANGLE_DEG);
    let turned_deg = facing.acos().to_degrees();
    scene.objects[0].keys = vec![ObjectKey { rotation_deg: [0.0, turned_deg, 0.0], ..ObjectKey::at(0.0) }];
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(4)])).unwrap();
    let later =
        CameraPose { eye: LATER_EYE, target: DVec3::ZERO, roll_rad: 0.0, shift: DVec2::ZERO, lens: LENS };
    let frame = painting.seen_by(&later, 0.0, &FrameOptions::new([640, 360]));
    let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
    let strokes = &frame.strokes[body.first as usize..(body.first + body.count) as usize];
    // The side of the sheet that the reference sees.
    let normal = sheet_axes(facing).z_axis.as_vec3();
    let angles: Vec<f64> = strokes
        .iter()
        .filter(|stroke| normal.dot(stroke.normal_in_world.into()) > 0.5)
        .map(|stroke| f64::from(stroke.angle_rad).to_degrees())
        .collect();
    assert!(angles.len() > 200, "{} strokes", angles.len());
    angles.iter().sum::<f64>() / angles.len() as f64
}

/// The share of a direction that the reference decides, if it decides nothing below a cosine of 0.2 and all of it from
/// the cosine `wholly_from` on.
fn share(facing: f64, wholly_from: f64) -> f64 {
    let t = ((facing - 0.2) / (wholly_from - 0.2)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[test]
fn a_reference_is_blended_in_between_cosines_of_0_2_and_0_5() {
    for facing in [0.15, 0.25, 0.30, 0.35, 0.40, 0.45, 0.55, 0.8] {
        let (found, expected) = (found_deg(facing), expected_deg(facing, share(facing, 0.5)));
        println!("facing {facing}: {found:.3} degrees where {expected:.3} are expected");
        assert!(
            (found - expected).abs() < 0.02,
            "references do not blend in from 0.2 to 0.5: facing {facing} gives {found}, not {expected} degrees"
        );
    }
    // The angles would differ if the blend ended elsewhere.
    let off = expected_deg(0.3, share(0.3, 0.35)) - expected_deg(0.3, share(0.3, 0.5));
    assert!(off.abs() > 0.5, "the test sees nothing: {off}");
}
