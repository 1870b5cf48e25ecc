//! Tests of light icons over the picture: their places and sizes, what dims them, and that they leave nothing behind.

use std::sync::LazyLock;

use glam::{Mat4, Vec3};
use impasto_gl_render::context::Driver;
use impasto_gl_render::{BillboardIcon, BillboardSize, LightBillboard, Picture};
use impasto_painting::frame::{Frame, Style};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Lens, ObjectKey, Scale};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

mod window;

const SIZE_PX: [u32; 2] = [320, 200];

/// A sheet of side 2 in the plane z = 0, in the left half of the picture, seen from (0, 0, 4).
fn frame() -> Frame {
    static FRAME: LazyLock<Frame> = LazyLock::new(|| frame_through(Lens::default()));
    FRAME.clone()
}

fn frame_through(lens: Lens) -> Frame {
    let mut wall = shapes::object("wall", 1);
    wall.scale = Scale([1.0; 3]);
    wall.keys = vec![ObjectKey { translation: [-1.0, 0.0, 0.0], ..ObjectKey::at(0.0) }];
    let mut scene = shapes::scene(vec![wall]);
    scene.camera.lens = lens;
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(1)])).unwrap();
    painting.in_style(Style::Reference).at(0.0, &FrameOptions::new(SIZE_PX))
}

fn lamp(position: Vec3) -> LightBillboard {
    LightBillboard {
        position: position.as_dvec3(),
        icon: BillboardIcon::Point,
        size: BillboardSize::Pixels(16.0),
        ink: [1.0, 0.2, 0.0, 1.0],
    }
}

/// Where a point of the world shows, pixels from the upper left corner.
fn shown_at(frame: &Frame, position: Vec3) -> [f32; 2] {
    let clip: Mat4 = frame.view.clip_from_view * frame.view.view_from_world;
    let at = clip.project_point3(position);
    [(at.x * 0.5 + 0.5) * SIZE_PX[0] as f32, (0.5 - at.y * 0.5) * SIZE_PX[1] as f32]
}

/// The middle of the box round the pixels that differ by more than 12 (the sum over their channels), half the size of
/// that box, and the sum of these differences. `None` if there are no such pixels.
fn difference(a: &Picture, b: &Picture) -> Option<([f32; 2], [f32; 2], f64)> {
    let (mut low, mut high, mut sum) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2], 0.0);
    for (index, (a, b)) in a.rgba8.chunks(4).zip(b.rgba8.chunks(4)).enumerate() {
        let off: u32 = a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
        if off > 12 {
            let at = [(index as u32 % SIZE_PX[0]) as f32 + 0.5, (index as u32 / SIZE_PX[0]) as f32 + 0.5];
            low = [low[0].min(at[0]), low[1].min(at[1])];
            high = [high[0].max(at[0]), high[1].max(at[1])];
            sum += f64::from(off);
        }
    }
    (sum > 0.0).then(|| {
        let middle = [0, 1].map(|axis| (low[axis] + high[axis]) * 0.5);
        (middle, [0, 1].map(|axis| (high[axis] - low[axis] + 1.0) * 0.5), sum)
    })
}

#[test]
fn an_icon_is_where_its_light_projects_to() {
    let mut renderer = renderer(Driver::Egl);
    let frame = frame();
    let bare = renderer.render(&frame).unwrap();
    for position in [Vec3::new(0.5, 0.3, 0.0), Vec3::new(0.9, -0.4, -3.0), Vec3::new(0.2, 0.1, 2.0)] {
        renderer.set_billboards(&[lamp(position)]);
        let picture = renderer.render(&frame).unwrap();
        let (middle, half, _) = difference(&bare, &picture).unwrap();
        let wanted = shown_at(&frame, position);
        let off = [0, 1].map(|axis| (middle[axis] - wanted[axis]).abs());
        assert!(off[0] < 1.0 && off[1] < 1.0, "{position}: {middle:?}, not {wanted:?}");
        assert!(half.iter().all(|half| (13.0..=16.5).contains(half)), "{position}: {half:?}");
    }
}

#[test]
fn corners_lie_on_a_plane_across_the_gaze_along_the_cameras_right_and_up() {
    let frame = frame();
    let view = &frame.view;
    let [right, up, back] = [0, 1, 2].map(|row| view.view_from_world.row(row).truncate());
    let center = Vec3::new(0.7, -0.2, 1.0);
    let billboard = LightBillboard { size: BillboardSize::World(0.25), ..lamp(center) };
    let [p0, p1, p2, p3] = billboard.corners(view, SIZE_PX[1]).unwrap();
    let normal = (p1 - p0).cross(p2 - p0).normalize();
    assert!((normal.dot(back) - 1.0).abs() < 1e-6, "{normal}");
    for (corner, wanted) in [(p0, -right - up), (p1, right - up), (p2, up - right), (p3, right + up)] {
        assert!(corner.distance(center + wanted * 0.25) < 1e-6, "{corner}");
    }
}

#[test]
fn icons_keep_their_size_in_the_world_or_in_the_picture() {
    let frame = frame();
    let width = |size: BillboardSize, z: f32| {
        let billboard = LightBillboard { size, ..lamp(Vec3::new(0.0, 0.0, z)) };
        let [p0, p1, ..] = billboard.corners(&frame.view, SIZE_PX[1]).unwrap();
        (p0.distance(p1), shown_at(&frame, p1)[0] - shown_at(&frame, p0)[0])
    };
    let world = [0.0, -8.0].map(|z| width(BillboardSize::World(0.25), z));
    assert!((world[0].0 - 0.5).abs() < 1e-6 && (world[1].0 - 0.5).abs() < 1e-6, "{world:?}");
    assert!((world[0].1 / world[1].1 - 3.0).abs() < 1e-3, "not a third as wide: {world:?}");
    let pixels = [0.0, -8.0].map(|z| width(BillboardSize::Pixels(16.0), z));
    assert!((pixels[0].1 - 32.0).abs() < 1e-2 && (pixels[1].1 - 32.0).abs() < 1e-2, "{pixels:?}");
}

#[test]
fn in_a_parallel_picture_icons_have_their_size_too() {
    let frame = frame_through(Lens::Orthographic { height: 3.0, near: 0.05, far: 100.0 });
    for z in [0.0, -8.0] {
        let [p0, p1, ..] = lamp(Vec3::new(0.3, 0.0, z)).corners(&frame.view, SIZE_PX[1]).unwrap();
        assert!((shown_at(&frame, p1)[0] - shown_at(&frame, p0)[0] - 32.0).abs() < 1e-2);
    }
}

#[test]
fn bodies_in_front_dim_an_icon_and_bodies_behind_do_not() {
    let mut renderer = renderer(Driver::Egl);
    let frame = frame();
    let bare = renderer.render(&frame).unwrap();
    let mut strength = |position: Vec3| {
        renderer.set_billboards(&[lamp(position)]);
        difference(&bare, &renderer.render(&frame).unwrap()).unwrap().2
    };
    // Two places on one ray from the eye, in front of the sheet and behind it.
    let (before, behind) = (strength(Vec3::new(-0.25, 0.1, 2.0)), strength(Vec3::new(-0.75, 0.3, -2.0)));
    assert!(behind < 0.5 * before && behind > 0.15 * before, "{before} {behind}");
}

#[test]
fn a_light_at_the_eye_or_behind_it_is_not_drawn() {
    let mut renderer = renderer(Driver::Egl);
    let frame = frame();
    let bare = renderer.render(&frame).unwrap();
    let eye = frame.view.eye_in_world;
    for position in [eye, eye + Vec3::Z * 3.0, eye - Vec3::Z * 0.01, Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        for icon in [BillboardIcon::Sun, BillboardIcon::Ring] {
            for size in
                [BillboardSize::Pixels(16.0), BillboardSize::World(1.0), BillboardSize::World(f32::NAN)]
            {
                let billboard = LightBillboard { icon, size, ..lamp(position) };
                assert_eq!(billboard.corners(&frame.view, SIZE_PX[1]), None, "{position}");
                renderer.set_billboards(&[billboard]);
                assert!(renderer.render(&frame).unwrap() == bare, "{position}");
            }
        }
    }
}

#[test]
fn a_ring_is_a_whole_thin_line_round_its_middle() {
    let mut renderer = renderer(Driver::Egl);
    let frame = frame();
    let bare = renderer.render(&frame).unwrap();
    let center = Vec3::new(0.9, 0.1, 0.0);
    let ring =
        LightBillboard { icon: BillboardIcon::Ring, size: BillboardSize::Pixels(60.0), ..lamp(center) };
    renderer.set_billboards(&[ring]);
    let picture = renderer.render(&frame).unwrap();
    let middle = shown_at(&frame, center);
    // How much the ring changes the picture at a place.
    let changed = |at: [f32; 2]| {
        let index = (at[1] as usize * SIZE_PX[0] as usize + at[0] as usize) * 4;
        (0..3).map(|c| u32::from(picture.rgba8[index + c].abs_diff(bare.rgba8[index + c]))).sum::<u32>()
    };
    for step in 0..720 {
        let (sin, cos) = (step as f32 * 0.5).to_radians().sin_cos();
        let at = |radius: f32| [middle[0] + radius * cos, middle[1] + radius * sin];
        let most = (0..9).map(|k| changed(at(55.0 + k as f32))).max().unwrap();
        assert!(most > 100, "a gap at {} degrees: {most}", step as f32 * 0.5);
        assert_eq!(changed(at(48.0)) + changed(at(66.0)), 0, "{} degrees", step as f32 * 0.5);
    }
}

#[test]
fn icons_come_and_go_without_the_picture_being_drawn_again() {
    let (mut egl, mut osmesa) = (renderer(Driver::Egl), renderer(Driver::Osmesa));
    assert_eq!(egl.with_other_billboards().unwrap(), None, "nothing was drawn yet");
    let frame = frame();
    let bare = egl.render(&frame).unwrap();
    let lamps = [BillboardIcon::Sun, BillboardIcon::Point, BillboardIcon::Ambient, BillboardIcon::Ring];
    let lamps: Vec<LightBillboard> = lamps
        .into_iter()
        .zip([-0.8, -0.3, 0.3, 0.8])
        .map(|(icon, x)| LightBillboard { icon, ..lamp(Vec3::new(x, 0.0, 0.5)) })
        .collect();
    egl.set_billboards(&lamps);
    let over = egl.with_other_billboards().unwrap().unwrap();
    assert!(over != bare && over == egl.render(&frame).unwrap());
    osmesa.set_billboards(&lamps);
    assert!(osmesa.render(&frame).unwrap() == over, "EGL and OSMesa differ");
    egl.set_billboards(&[]);
    assert!(egl.with_other_billboards().unwrap().unwrap() == bare, "icons that were taken away still show");
    assert!(egl.render(&frame).unwrap() == bare);
    // After a picture was given up, there is no picture to draw icons over.
    assert_eq!(egl.render_unless(&frame, &mut || true).unwrap(), None);
    assert_eq!(egl.with_other_billboards().unwrap(), None);
}
