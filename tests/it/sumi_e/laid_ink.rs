//! Tests how dark ink is, against closed forms: along one stroke, where strokes cross, and between two tones.

use std::sync::Arc;

use impasto_core::brush::{FILL, Mark, SIZE, VARIANTS};
use impasto_core::color::srgb_from_linear;
use impasto_painting::frame::{Brushes, Frame, LayerKind, LayerRun, Stroke, StrokeSource};
use impasto_scene::document::{MaterialOverride, ObjectKey, Scale};

use super::*;

const BLACK: Color = Color([0.0; 3]);
const LENGTH_PX: f32 = 160.0;
const WIDTH_PX: f32 = 60.0;

/// Strokes of black ink on white paper without fibres, over a sheet of tone 0.5. Their brush mark is paint all over.
fn ink_strokes(strokes: Vec<Stroke>) -> Frame {
    let mut scene = scene_in(SumiE {
        drawing: InkDrawing::Strokes,
        tones: [0.5, 0.6, 0.7, 0.8],
        dryness: 0.0,
        paper: WHITE,
        ink: BLACK,
        fibres: 0.0,
        ..SumiE::default()
    });
    scene.objects[0].scale = Scale::even(3.0);
    // The tone of an unlit surface comes from its colour alone: black gets the first tone, 0.5.
    scene.objects[0].material =
        Some(MaterialOverride { color: Some(BLACK), unlit: true, ..MaterialOverride::default() });
    scene.objects[0].keys = vec![ObjectKey { translation: [0.0, 0.0, -2.0], ..ObjectKey::at(0.0) }];
    let mut frame = painting(scene, [shapes::sheet(1)]).at(0.0, &FrameOptions::new(SIZE_PX));
    let source = StrokeSource { place: 0, particle: 0, region: 0, kappa: 1.0, facing: 1.0, rank: 0.5 };
    frame.sources = vec![source; strokes.len()];
    frame.layers = vec![LayerRun { order: 0, kind: LayerKind::Body, first: 0, count: strokes.len() as u32 }];
    frame.strokes = strokes;
    let whole = Mark { texels: vec![[255, 128, 128]; SIZE[0] * SIZE[1]] };
    let marks = Arc::new(vec![whole; VARIANTS as usize]);
    frame.brushes = Arc::new(Brushes { names: vec!["whole".to_owned()], marks: vec![marks] });
    frame
}

fn stroke(angle_deg: f32) -> Stroke {
    Stroke {
        center_px: SIZE_PX.map(|side| side as f32 * 0.5),
        depth: 1.0,
        angle_rad: angle_deg.to_radians(),
        length_px: LENGTH_PX,
        width_px: WIDTH_PX,
        body_id: 1,
        albedo_srgb8: u32::MAX,
        normal_in_world: [0.0, 0.0, 1.0],
        overrun_px: Stroke::FREE,
        ..Stroke::default()
    }
}

/// Draws the strokes. Returns the picture, and how dark each stroke is, 0..1, before its ink runs low along it.
fn drawn_strokes(renderer: &mut Renderer, strokes: Vec<Stroke>) -> (Picture, Vec<f64>) {
    let picture = renderer.render(&ink_strokes(strokes)).unwrap();
    let dark = renderer.resolved_strokes().into_iter().map(|stroke| {
        assert!(stroke.alpha > 0.99, "the stroke is there: {}", stroke.alpha);
        1.0 - f64::from(srgb_from_linear(stroke.color_linear[0]))
    });
    (picture, dark.collect())
}

/// The ink that a stroke of this darkness lays this many pixels past its middle. It falls linearly from 1.06 times the
/// darkness at the start to 0.78 times at the end.
fn carried(dark: f64, after_middle_px: f64) -> f64 {
    let share = 0.5 + after_middle_px * f64::from(FILL / LENGTH_PX);
    // The mark's tint of 128 is 0.5 above the neutral 127.5, which adds a little ink.
    dark * (1.06 + (0.78 - 1.06) * share) * (1.0 + 0.2 / 255.0)
}

/// How dark the picture is where strokes with these inks, 0..1, cross. A stroke with ink 0.6 covers 0.55 · 0.6 = 0.33
/// of a pixel, and `covers` is the share of the pixel that all strokes cover together. The picture is as dark as the
/// darkest ink, times 1 + 0.45 · (`covers` − half of that ink).
fn crossed(inks: &[f64]) -> f64 {
    let most = inks.iter().copied().fold(0.0, f64::max);
    let covers = 1.0 - inks.iter().map(|ink| 1.0 - 0.55 * ink).product::<f64>();
    most * (1.0 + 0.45 * (covers - 0.5 * most).max(0.0))
}

#[track_caller]
fn assert_ink(picture: &Picture, [x, y]: [usize; 2], ink: f64) {
    let wanted = 255.0 * (1.0 - ink);
    let found = f64::from(red(picture, x, y));
    assert!((found - wanted).abs() <= 2.0, "at {x}, {y}: {found} for {wanted}");
}

/// How far the middle of a pixel lies past the middle of the picture along an axis, in pixels.
fn after_middle_px(at: usize, axis: usize) -> f64 {
    at as f64 + 0.5 - f64::from(SIZE_PX[axis]) * 0.5
}

#[test]
fn a_stroke_gives_less_ink_as_it_goes() {
    let mut renderer = renderer(Driver::Egl);
    // Turned by 180 degrees, the stroke has its loaded end at the other side.
    for (angle_deg, forward) in [(0.0, 1.0), (180.0, -1.0)] {
        let (picture, dark) = drawn_strokes(&mut renderer, vec![stroke(angle_deg)]);
        assert!((0.3..0.8).contains(&dark[0]), "no ink to measure: {}", dark[0]);
        for x in (90..=230).step_by(5) {
            let ink = carried(dark[0], forward * after_middle_px(x, 0));
            assert_ink(&picture, [x, 90], crossed(&[ink]));
        }
    }
}

#[test]
fn ink_is_darker_where_strokes_cross() {
    let mut renderer = renderer(Driver::Egl);
    let (picture, dark) = drawn_strokes(&mut renderer, vec![stroke(0.0), Stroke { bits: 5, ..stroke(90.0) }]);
    for x in (90..=230).step_by(5) {
        for y in [80, 90, 100] {
            let level = carried(dark[0], after_middle_px(x, 0));
            // The picture's rows go down.
            let upright = carried(dark[1], -after_middle_px(y, 1));
            match after_middle_px(x, 0).abs() {
                beside if beside < 0.5 * f64::from(WIDTH_PX) => {
                    assert_ink(&picture, [x, y], crossed(&[level, upright]));
                }
                beside if beside > 0.5 * f64::from(WIDTH_PX / FILL) + 4.0 => {
                    assert_ink(&picture, [x, y], crossed(&[level]));
                }
                _ => {}
            }
        }
    }
}

/// The sheet's normals turn so slowly towards the light that its picture shows less than 3 of the 256 texels of the
/// ramp of tones. The steps between tones are as hard as they can be: from one texel to the next.
#[test]
fn between_two_texels_of_the_ramp_tones_go_over_evenly() {
    let size_px = [640, 360];
    let (from, to) = (0.495, 0.505);
    let tones = [0.1, 0.4, 0.7, 0.95];
    let mut sheet = shapes::sheet(1);
    for (normal, at) in sheet.normals.iter_mut().zip(&sheet.positions) {
        let cosine = (if at.x < 0.0 { from } else { to }) as f32;
        *normal = Vec3::new(cosine, 0.0, (1.0 - cosine * cosine).sqrt());
    }
    let mut scene = scene_in(SumiE { tones, softness: 0.0, to_light: [1.0, 0.0, 0.0], ..source() });
    scene.size = (size_px[0], size_px[1]);
    let frame = painting(scene, [sheet]).at(0.0, &FrameOptions::new(size_px));
    let picture = renderer(Driver::Egl).render(&frame).unwrap();
    let sheet_px = 2.0 / 2.25 * 360.0;
    let mut steps = 0;
    for x in 170..470 {
        // The source's rule samples at a pixel's left edge, as Direct3D 9 does (`mix.frag`): `x`, not `x + 0.5`.
        let diffuse = from + (to - from) * ((x as f64 - 320.0) / sheet_px + 0.5);
        // The texels on either side of the step have their middles at 127.5 and 128.5 of 256.
        let share = (diffuse * 256.0 - 127.5).clamp(0.0, 1.0);
        steps += usize::from(share > 0.0 && share < 1.0);
        let wanted = 255.0 * (tones[1] + (tones[2] - tones[1]) * share);
        let found = f64::from(red(&picture, x, 180));
        assert!((found - wanted).abs() <= 2.0, "at {x}: {found} for {wanted}");
    }
    assert!(steps > 100, "the step is {steps} pixels wide");
}
