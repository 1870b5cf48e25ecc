//! Tests of tapered and bent strokes: each point of the mark is drawn where taper and bend take it.

use std::sync::{Arc, LazyLock};

use glam::DVec2;
use impasto_core::brush::{FILL, Mark, SIZE};
use impasto_gl_render::context::Driver;
use impasto_painting::frame::{Brushes, Finish, Frame, LayerKind, LayerRun, Quality, Stroke, StrokeSource};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Color, MaterialOverride, ObjectKey, Scale};
use impasto_tests::pictures::{Grey, renderer};
use impasto_tests::shapes;

use super::{chance, on_two_triangles};

const SIZE_PX: [u32; 2] = [320, 240];

/// A frame with these strokes alone, in flat paint over black. Marks 0 and 1 are full of paint: the tint of mark 0
/// rises along the stroke, that of mark 1 across it. Mark 2 is a filbert's.
fn frame(strokes: Vec<Stroke>, quality: Quality) -> Frame {
    static BARE: LazyLock<Frame> = LazyLock::new(bare);
    let mut frame = BARE.clone();
    frame.quality = quality;
    let source = StrokeSource { place: 0, particle: 0, region: 0, kappa: 1.0, facing: 1.0, rank: 0.5 };
    frame.sources = vec![source; strokes.len()];
    frame.layers = vec![LayerRun { order: 0, kind: LayerKind::Body, first: 0, count: strokes.len() as u32 }];
    frame.strokes = strokes;
    frame
}

fn bare() -> Frame {
    let mut wall = shapes::object("wall", 1);
    wall.scale = Scale([50.0; 3]);
    wall.material =
        Some(MaterialOverride { color: Some(Color([0.7; 3])), unlit: true, ..Default::default() });
    wall.keys = vec![ObjectKey { translation: [0.0, 0.0, -95.0], ..ObjectKey::at(0.0) }];
    let painting = prepare(shapes::loaded(shapes::scene(vec![wall]), [shapes::sheet(1)])).unwrap();
    let mut frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
    let ramp = |along: usize| Mark {
        texels: (0..SIZE[0] * SIZE[1])
            .map(|index| {
                let at = [index % SIZE[0], index / SIZE[0]];
                [255, 128, (255.0 * (at[along] as f64 + 0.5) / SIZE[along] as f64).round() as u8]
            })
            .collect(),
    };
    let filbert = Brushes::of_names(&["filbert"]).marks[0][0].clone();
    frame.brushes = Arc::new(Brushes {
        names: vec!["ramps".to_owned()],
        marks: vec![Arc::new(vec![ramp(0), ramp(1), filbert])],
    });
    frame.background = Some([0.0; 3]);
    frame.finish = Finish::default();
    frame
}

fn stroke(mark: u32) -> Stroke {
    Stroke {
        center_px: [161.0, 118.5],
        depth: 4.0,
        angle_rad: 0.3,
        length_px: 120.0,
        width_px: 40.0,
        body_id: 1,
        albedo_srgb8: 0x00b4_b4b4,
        mark,
        normal_in_world: [0.0, 0.0, 1.0],
        overrun_px: Stroke::FREE,
        ..Stroke::default()
    }
}

/// Where the point (u, v) of a stroke's mark lies in the picture, Y up.
fn place(stroke: &Stroke, at: DVec2) -> DVec2 {
    let fill = f64::from(FILL);
    let along = (at.x - 0.5) * f64::from(stroke.length_px) / fill;
    let width = f64::from(stroke.width_px) * (1.0 + f64::from(stroke.taper) * (1.0 - 2.0 * at.x));
    let across = (at.y - 0.5) * width / fill;
    let along = along + across * f64::from(stroke.skew);
    let bend = f64::from(stroke.bend_rad);
    let straight = if bend == 0.0 {
        DVec2::new(along, across)
    } else {
        // Turn about the centre of the arc, which is on the stroke's left if the bend is positive, else on its right.
        let radius = f64::from(stroke.length_px) / bend;
        let turned = along / radius;
        DVec2::new((radius - across) * turned.sin(), radius - (radius - across) * turned.cos())
    };
    let center = DVec2::from(stroke.center_px.map(f64::from));
    center + DVec2::from_angle(f64::from(stroke.angle_rad)).rotate(straight)
}

/// What the picture shows at a place, 0..255.
fn shown(picture: &Grey, at: DVec2) -> f64 {
    picture.sample(at.x - 0.5, f64::from(SIZE_PX[1]) - at.y - 0.5).unwrap()
}

#[test]
fn a_point_of_the_mark_lies_where_taper_and_bend_take_it() {
    let mut renderer = renderer(Driver::Egl);
    let shapes = [
        (0.0, 60.0, 0.0),
        (0.8, 0.0, 0.0),
        (-1.0, 0.0, 0.0),
        (0.5, -150.0, 0.0),
        (0.9, 90.0, 0.0),
        (0.6, 30.0, 0.4),
    ];
    for mark in [0, 1] {
        let plain = stroke(mark);
        let straight = Grey::of(&renderer.render(&frame(vec![plain], Quality::Exact)).unwrap());
        for (taper, bend_deg, skew) in shapes {
            let bend_rad = f32::to_radians(bend_deg);
            let shaped = Stroke { taper, bend_rad, skew, ..plain };
            let picture = Grey::of(&renderer.render(&frame(vec![shaped], Quality::Exact)).unwrap());
            let (mut worst, mut range) = (0.0_f64, [255.0_f64, 0.0]);
            for index in 0..2000 {
                let at = DVec2::new(chance(index, 0), chance(index, 1)) * 0.8 + 0.1;
                let wanted = shown(&straight, place(&plain, at));
                let found = shown(&picture, place(&shaped, at));
                worst = worst.max((found - wanted).abs());
                range = [range[0].min(wanted), range[1].max(wanted)];
            }
            println!(
                "mark {mark}, taper {taper}, bend {bend_deg}, skew {skew}: off by {worst:.2} of {range:?}"
            );
            assert!(range[1] - range[0] > 20.0, "the ramp must show: {range:?}");
            assert!(worst < 1.5, "mark {mark}, taper {taper}, bend {bend_deg}, skew {skew}: {worst}");
        }
    }
}

#[test]
fn two_triangles_would_be_seen() {
    let straight = stroke(1);
    let tapered = Stroke { taper: 0.8, ..straight };
    let corners =
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| place(&tapered, DVec2::new(u, v)));
    let worst = (0..2000).map(|index| {
        let at = DVec2::new(chance(index, 0), chance(index, 1));
        (on_two_triangles(place(&tapered, at), corners) - at).abs().max_element()
    });
    // Points of the mark would be off by up to `worst`, in shares of its length or width. The test above notices about
    // 0.06 of the width: it allows 1.5 grey levels, and the ramp rises by 27 across the mark.
    assert!(worst.fold(0.0, f64::max) > 0.3);
}

#[test]
fn a_stroke_without_shape_has_the_same_bytes_beside_shaped_ones() {
    for quality in [Quality::Exact, Quality::Draft] {
        let mut renderer = renderer(Driver::Egl);
        for angle_rad in [0.0, 0.3, 2.9] {
            let plain = Stroke { angle_rad, ..stroke(2) };
            // A shaped stroke far outside the picture, so that nothing of it shows.
            let shaped = Stroke { center_px: [-9000.0, 50.0], taper: 0.5, bend_rad: 1.0, ..plain };
            let alone = renderer.render(&frame(vec![plain], quality)).unwrap();
            let beside = renderer.render(&frame(vec![shaped, plain], quality)).unwrap();
            assert!(alone.rgba8.chunks(4).any(|pixel| pixel[0] > 60), "there is paint to compare");
            assert!(alone == beside, "{quality:?}, {angle_rad}");
        }
    }
}

#[test]
fn extreme_shapes_are_drawn_alike_by_both_drivers() {
    let (mut egl, mut osmesa) = (renderer(Driver::Egl), renderer(Driver::Osmesa));
    let mut strokes = Vec::new();
    for (index, taper) in [-1.0, -0.3, 0.0, 1.0].into_iter().enumerate() {
        for (row, bend_rad) in [-3.1, -1e-7, 1e-3, 3.1].into_iter().enumerate() {
            for (length_px, width_px) in [(60.0, 12.0), (0.01, 0.01), (30.0, 1e-3)] {
                let wild = Stroke { taper, bend_rad, length_px, width_px, ..stroke(2) };
                let most_rad = wild.most_bend_rad();
                let center_px = [40.0 + 80.0 * index as f32, 30.0 + 60.0 * row as f32];
                strokes.push(Stroke { center_px, bend_rad: bend_rad.clamp(-most_rad, most_rad), ..wild });
            }
        }
    }
    for quality in [Quality::Exact, Quality::Draft] {
        let frame = frame(strokes.clone(), quality);
        let (a, b) = (egl.render(&frame).unwrap(), osmesa.render(&frame).unwrap());
        assert!(a.rgba8.chunks(4).filter(|pixel| pixel[0] > 60).count() > 3000, "there is paint");
        assert!(a == b, "EGL and OSMesa differ: {quality:?}");
    }
}

#[test]
fn strokes_of_a_scene_take_taper_and_bend_but_the_underpainting_does_not() {
    let of = |taper: Option<f64>, bend_deg: Option<f64>| {
        let mut scene = shapes::scene(vec![shapes::object("ball", 4000)]);
        scene.strokes.taper = taper;
        scene.strokes.bend_deg = bend_deg;
        scene.strokes.size_jitter = Some(0.2);
        prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap().at(0.0, &FrameOptions::new(SIZE_PX))
    };
    let (plain, stated) = (of(None, None), of(Some(0.0), Some(0.0)));
    assert_eq!(plain.strokes, stated.strokes, "a stated taper and bend of 0 change strokes");
    let shaped = of(Some(0.75), Some(-40.0));
    let mut bends = Vec::new();
    for run in &shaped.layers {
        for stroke in &shaped.strokes[run.first as usize..][..run.count as usize] {
            if run.kind == LayerKind::Underpainting {
                assert!(!stroke.is_shaped());
            } else {
                assert_eq!(stroke.taper, 0.75);
                assert!(stroke.bend_rad < 0.0 && stroke.bend_rad.abs() <= stroke.most_bend_rad());
                bends.push(stroke.bend_rad.to_degrees());
            }
        }
    }
    bends.sort_by(f32::total_cmp);
    let middle = bends[bends.len() / 2];
    assert!((middle + 40.0).abs() < 4.0, "{middle}");
    assert!(bends[bends.len() / 10] < -45.0 && bends[bends.len() * 9 / 10] > -35.0, "bends do not vary");
}
