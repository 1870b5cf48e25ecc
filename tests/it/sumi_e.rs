//! Tests of ink on paper. First the five passes of the technique's source (docs/techniques/sumi_e.md) are compared with
//! a version on the CPU that shares no code with them. Then what our own rule adds is tested.

mod holes;
mod laid_ink;

use glam::{DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{
    CanvasFollows, Color, InkDrawing, InkLight, InkRule, Lens, Scene, StrokeSettings, Style, SumiE,
};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::presets::LayerKind;
use impasto_tests::command::root;
use impasto_tests::pictures::renderer;
use impasto_tests::scenes;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [320, 180];
const WHITE: Color = Color([1.0; 3]);

/// The source's rule on white paper.
fn source() -> SumiE {
    SumiE { rule: InkRule::Source, paper: WHITE, fibres: 0.0, ..SumiE::default() }
}

/// Our wash alone on white paper.
fn wash() -> SumiE {
    SumiE { drawing: InkDrawing::Wash, paper: WHITE, fibres: 0.0, ..SumiE::default() }
}

fn scene_in(ink: SumiE) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("ball", 200)]);
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    scene.camera.lens = Lens::Orthographic { height: 2.25, near: 0.05, far: 100.0 };
    scene.style = Style::SumiE(ink);
    scene
}

fn painting(scene: Scene, meshes: impl IntoIterator<Item = TriangleMesh>) -> Painting {
    prepare(shapes::loaded(scene, meshes)).unwrap()
}

fn drawn(renderer: &mut Renderer, scene: Scene) -> Picture {
    let size_px = [scene.size.0, scene.size.1];
    let frame = painting(scene, [shapes::sphere(96, 48)]).at(0.0, &FrameOptions::new(size_px));
    renderer.render(&frame).unwrap()
}

fn red(picture: &Picture, x: usize, y: usize) -> i32 {
    i32::from(picture.rgba8[(y * picture.size_px[0] as usize + x) * 4])
}

/// The source's rule on the CPU, written from the source's listing alone. Values are bytes, as in the source's render
/// targets. The top row is first.
struct Twin {
    width: i64,
    height: i64,
    silhouette: Vec<u8>,
    interior: Vec<u8>,
}

/// What the twin sees: corners and normals of all triangles in world space, and the view.
struct Seen<'a> {
    triangles: Vec<[(DVec3, DVec3); 3]>,
    eye: DVec3,
    /// Right, up, forward.
    axes: [DVec3; 3],
    tan_half: f64,
    covered: &'a [u32],
}

impl Twin {
    fn new(seen: &Seen<'_>, size_px: [u32; 2], ink: &SumiE) -> Self {
        let (width, height) = (i64::from(size_px[0]), i64::from(size_px[1]));
        let shade: Vec<u8> = (0..256).map(|index| shade((f64::from(index) + 0.5) / 256.0, ink)).collect();
        let light = DVec3::from(ink.to_light).normalize();
        let pixel = |index: i64| {
            let (x, y) = (index % width, index / width);
            if seen.covered[index as usize] == 0 {
                return (255, 255);
            }
            let normal = seen.normal((x as f64 + 0.5, y as f64 + 0.5), [width as f64, height as f64]);
            let diffuse = normal.z.clamp(0.0, 1.0);
            let t =
                ((diffuse - ink.silhouette_from) / (ink.silhouette_to - ink.silhouette_from)).clamp(0.0, 1.0);
            let at = (normal.dot(light).clamp(0.0, 1.0) * 256.0 - 0.5).clamp(0.0, 255.0);
            let (low, high) = (shade[at.floor() as usize], shade[at.ceil() as usize]);
            let tone = f64::from(low) + (f64::from(high) - f64::from(low)) * at.fract();
            ((t * t * (3.0 - 2.0 * t) * 255.0).round() as u8, tone.round() as u8)
        };
        let (silhouette, interior) = (0..width * height).map(pixel).unzip();
        Self { width, height, silhouette, interior }
    }

    fn low_pass(&self, picture: &[u8]) -> Vec<u8> {
        let at = |x: i64, y: i64| {
            let (x, y) = (x.clamp(0, self.width - 1), y.clamp(0, self.height - 1));
            f64::from(picture[(y * self.width + x) as usize])
        };
        let coord = [-2, 0, 2];
        (0..self.width * self.height)
            .map(|index| {
                let (x, y) = (index % self.width, index / self.width);
                let sum: f64 = (0..9).map(|tap| at(x + coord[tap % 3], y + coord[tap / 3])).sum();
                (sum / 9.0).round() as u8
            })
            .collect()
    }

    /// Direct3D 9 samples at the upper left corner of a pixel's texel, so it gets the mean of the four texels that meet
    /// there.
    fn at_corner(&self, picture: &[u8], x: i64, y: i64, wraps: bool) -> f64 {
        let texel = |x: i64, y: i64| {
            let (x, y) = if wraps {
                (x.rem_euclid(self.width), y.rem_euclid(self.height))
            } else {
                (x.max(0), y.max(0))
            };
            f64::from(picture[(y * self.width + x) as usize]) / 255.0
        };
        0.25 * (texel(x, y) + texel(x - 1, y) + texel(x, y - 1) + texel(x - 1, y - 1))
    }

    /// One channel of the finished picture; `paper` gives the same channel of the paper at a pixel.
    fn picture(&self, paper: impl Fn(usize) -> f64) -> Vec<i32> {
        let (silhouette, interior) = (self.low_pass(&self.silhouette), self.low_pass(&self.interior));
        (0..self.width * self.height)
            .map(|index| {
                let (x, y) = (index % self.width, index / self.width);
                let c1 = self.at_corner(&interior, x, y, false);
                let c2 = self.at_corner(&silhouette, x, y, true);
                let c3 = paper(index as usize);
                let out = 1.0 - ((1.0 - c1) + (1.0 - c2) + (1.0 - c3)).clamp(0.0, 1.0);
                (out * 255.0).round() as i32
            })
            .collect()
    }
}

/// A texel of the ramp that gives the tone for each amount of light, 0..1: four plateaus, with smooth steps between
/// them where the light is 0.25, 0.5 and 0.75.
fn shade(diffuse: f64, ink: &SumiE) -> u8 {
    let mut tone = ink.tones[0];
    for step in 1..4 {
        let (from, to) = (0.25 * step as f64 - ink.softness, 0.25 * step as f64 + ink.softness);
        let t = ((diffuse - from) / (to - from)).clamp(0.0, 1.0);
        tone += (ink.tones[step] - ink.tones[step - 1]) * (3.0 * t * t - 2.0 * t * t * t);
    }
    (tone * 255.0).round() as u8
}

impl Seen<'_> {
    /// The normal, in the eye's space, of the surface that shows at a place of the picture. It is interpolated between
    /// the normals of the corners, and not made unit length again.
    fn normal(&self, (x, y): (f64, f64), [width, height]: [f64; 2]) -> DVec3 {
        let [right, up, forward] = self.axes;
        let across = (2.0 * x - width) / height * self.tan_half;
        let above = (height - 2.0 * y) / height * self.tan_half;
        let ray = forward + right * across + up * above;
        let mut best = (f64::INFINITY, f64::INFINITY, DVec3::ZERO);
        for [(a, na), (b, nb), (c, nc)] in &self.triangles {
            let (ab, ac, to_eye) = (*b - *a, *c - *a, self.eye - *a);
            let across = ray.cross(ac);
            let determinant = ab.dot(across);
            if determinant.abs() < 1e-12 {
                continue;
            }
            let v = to_eye.dot(across) / determinant;
            let w = ray.dot(to_eye.cross(ab)) / determinant;
            let distance = ac.dot(to_eye.cross(ab)) / determinant;
            // The driver's rounding may cover a pixel whose ray just misses every triangle. Such a pixel takes the
            // triangle that its ray misses least.
            let outside = (-v).max(-w).max(v + w - 1.0).max(0.0);
            let outside = if outside < 1e-9 { 0.0 } else { outside };
            if distance > 0.0 && (outside, distance) < (best.0, best.1) {
                let unit = |normal: &DVec3| normal.normalize();
                best = (outside, distance, unit(na) * (1.0 - v - w) + unit(nb) * v + unit(nc) * w);
            }
        }
        let n = best.2;
        DVec3::new(n.dot(right), n.dot(up), -n.dot(forward))
    }
}

/// A ball that crosses the right edge of the picture, and a cube, seen from the side.
fn two_bodies(ink: SumiE) -> (Scene, [TriangleMesh; 2]) {
    let moved = |mut mesh: TriangleMesh, by: Vec3, scale: f32| {
        mesh.positions.iter_mut().for_each(|at| *at = *at * scale + by);
        mesh
    };
    let mut scene = shapes::scene(vec![shapes::object("ball", 200), shapes::object("cube", 200)]);
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    scene.camera.keys = vec![shapes::camera_key(0.0, [1.2, 0.9, 3.6], [0.2, 0.0, 0.0])];
    scene.style = Style::SumiE(ink);
    let ball = moved(shapes::sphere(24, 12), Vec3::new(1.13, 0.2, 0.5), 0.9);
    let cube = moved(shapes::cube(), Vec3::new(-0.8, -0.3, 0.0), 0.5);
    (scene, [ball, cube])
}

#[test]
fn the_sources_five_passes_are_those_of_a_twin_on_the_cpu() {
    let ink = SumiE { tones: [0.1, 0.4, 0.7, 0.95], ..source() };
    for driver in [Driver::Egl, Driver::Osmesa] {
        let mut renderer = renderer(driver);
        let (scene, meshes) = two_bodies(ink.clone());
        let triangles = meshes
            .iter()
            .flat_map(|mesh| {
                mesh.triangles.iter().map(|corners| {
                    corners.map(|corner| {
                        let corner = corner as usize;
                        (mesh.positions[corner].as_dvec3(), mesh.normals[corner].as_dvec3())
                    })
                })
            })
            .collect();
        let [eye, target] = [[1.2, 0.9, 3.6], [0.2, 0.0, 0.0]].map(DVec3::from);
        let forward = (target - eye).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let painting = painting(scene, meshes);
        let picture = renderer.render(&painting.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        let covered = renderer.read_reference().body_id;
        let seen = Seen {
            triangles,
            eye,
            axes: [right, right.cross(forward), forward],
            tan_half: 17.5f64.to_radians().tan(),
            covered: &covered,
        };
        let twin = Twin::new(&seen, SIZE_PX, &ink);
        let expected = twin.picture(|_| 1.0);
        let worst = picture.rgba8.chunks_exact(4).zip(&expected).map(|(pixel, &twin)| {
            pixel[..3].iter().map(|&byte| (i32::from(byte) - twin).abs()).max().unwrap()
        });
        let worst = worst.max().unwrap();
        assert!(worst <= 2, "{driver:?}: off by {worst} of 255");
        // The comparison can see faults: white and near black occur, and the wrap at the edge shows.
        assert!(expected.contains(&255) && expected.iter().any(|&value| value < 10));
        let left = |rows: std::ops::Range<usize>| rows.map(|y| expected[y * SIZE_PX[0] as usize]).min();
        assert!(
            left(60..140) < Some(230),
            "the ball at the right edge darkens the left one: {:?}",
            left(60..140)
        );
    }
}

#[test]
fn the_silhouette_lies_between_its_two_cosines() {
    let mut renderer = renderer(Driver::Egl);
    let mut scene = scene_in(SumiE { tones: [1.0; 4], ..source() });
    scene.size = (640, 360);
    let picture = drawn(&mut renderer, scene);
    // The ball's radius is 160 pixels; Direct3D's sampling at corners moves the picture by half a pixel.
    let at =
        |cosine: f64| red(&picture, (320.0 + 160.0 * (1.0 - cosine * cosine).sqrt()).round() as usize, 180);
    assert!(at(0.24) <= 3, "{}", at(0.24));
    assert!((at(0.5) - 128).abs() <= 8, "{}", at(0.5));
    assert!(at(0.76) >= 252, "{}", at(0.76));
    let width = (320..480).filter(|&x| red(&picture, x, 180) < 128).count();
    let expected = 160.0 * (1.0 - 0.75f64.sqrt());
    assert!((width as f64 - expected).abs() <= 1.5, "the rim is {width} wide, not {expected}");
}

#[test]
fn the_low_pass_has_nine_taps_two_apart() {
    let mut renderer = renderer(Driver::Egl);
    let mut scene = scene_in(SumiE { tones: [0.0; 4], ..source() });
    // A cube of 0.6 pixels in the middle of a pixel; its front face has no silhouette.
    let px = 2.25 / 180.0;
    let mut cube = shapes::cube();
    let centre = Vec3::new(0.5 * px, 0.5 * px, 0.0);
    cube.positions.iter_mut().for_each(|at| *at = *at * (0.3 * px) + centre);
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    let frame = painting(scene, [cube]).at(0.0, &FrameOptions::new(SIZE_PX));
    let picture = renderer.render(&frame).unwrap();
    // The low pass makes nine dots of 1/9 of black, which is 28 of 255. Four pixels of the picture sample each dot,
    // with a weight of a quarter, so each of these pixels gets darker by 7 of 255.
    for y in 0..180 {
        for x in 0..320 {
            let inside = (158..164).contains(&x) && (87..93).contains(&y);
            assert_eq!(red(&picture, x, y), if inside { 248 } else { 255 }, "at {x}, {y}");
        }
    }
}

#[test]
fn the_highlight_stays_with_the_eye_or_with_the_scene() {
    let mut renderer = renderer(Driver::Egl);
    let mut from = |ink: SumiE, degrees: f64| {
        let mut scene = scene_in(ink);
        let (sin, cos) = degrees.to_radians().sin_cos();
        scene.camera.keys = vec![shapes::camera_key(0.0, [4.0 * sin, 0.0, 4.0 * cos], [0.0; 3])];
        drawn(&mut renderer, scene)
    };
    let mut difference = |ink: &SumiE| {
        let [a, b] = [0.0, 75.0].map(|degrees| from(ink.clone(), degrees));
        let sum: u64 = a.rgba8.iter().zip(&b.rgba8).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        sum as f64 / a.rgba8.len() as f64
    };
    // From another side, the ball is a slightly different polyhedron, so the pictures differ a little.
    assert!(difference(&source()) < 0.5);
    assert!(difference(&SumiE { light: InkLight::Eye, ..wash() }) < 0.5);
    assert!(difference(&wash()) > 4.0);
}

#[test]
fn four_tones_with_soft_steps() {
    let mut renderer = renderer(Driver::Egl);
    let tones = [0.2, 0.4, 0.6, 0.8];
    let ink = SumiE { tones, softness: 0.03, silhouette_from: 0.0, silhouette_to: 1e-3, ..source() };
    let mut scene = scene_in(ink);
    scene.size = (640, 360);
    let picture = drawn(&mut renderer, scene);
    let mut histogram = [0usize; 256];
    picture.rgba8.chunks_exact(4).for_each(|pixel| histogram[pixel[0] as usize] += 1);
    let body: usize = histogram[..250].iter().sum();
    for tone in tones {
        let at = (tone * 255.0).round() as usize;
        let near: usize = histogram[at - 1..=at + 1].iter().sum();
        assert!(near * 12 > body, "the tone {tone} has {near} of {body} pixels");
    }
    // From the dark side to the light side it only gets lighter, in small steps.
    let along: Vec<i32> = (-128..130)
        .map(|step| {
            let (x, y) = (320.0 + 0.96 * f64::from(step), 180.0 - 0.64 * f64::from(step));
            red(&picture, x as usize, y as usize)
        })
        .collect();
    let brightest = along.iter().position(|value| value == along.iter().max().unwrap()).unwrap();
    assert!(along[..=brightest].windows(2).all(|pair| pair[0] <= pair[1] + 1), "{along:?}");
    assert!(along.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 25), "{along:?}");
}

#[test]
fn inks_and_paper_add_up() {
    let mut renderer = renderer(Driver::Egl);
    let tinted = SumiE { rule: InkRule::Source, ..SumiE::default() };
    let plain = drawn(&mut renderer, scene_in(source()));
    let on_paper = drawn(&mut renderer, scene_in(tinted.clone()));
    let mut empty = scene_in(tinted);
    empty.objects[0].hidden = true;
    let paper = drawn(&mut renderer, empty);
    for ((laid, plain), paper) in on_paper.rgba8.iter().zip(&plain.rgba8).zip(&paper.rgba8) {
        let [laid, plain, paper] = [laid, plain, paper].map(|byte| i32::from(*byte));
        assert!((laid - (plain + paper - 255).max(0)).abs() <= 1 || laid == 255, "{laid}: {plain}, {paper}");
    }
    assert!(paper.rgba8.chunks_exact(4).any(|pixel| pixel[2] < 235), "the paper has a tone");
}

#[test]
fn only_the_source_wraps_at_the_edge() {
    let mut renderer = renderer(Driver::Egl);
    let mut left = |ink: SumiE| {
        let (scene, meshes) = two_bodies(ink);
        let frame = painting(scene, meshes).at(0.0, &FrameOptions::new(SIZE_PX));
        let picture = renderer.render(&frame).unwrap();
        (0..180).map(|y| red(&picture, 0, y)).min()
    };
    assert!(left(source()) < Some(230));
    assert_eq!(left(wash()), Some(255));
}

#[test]
fn targets_are_white_and_of_the_pictures_size() {
    let mut renderer = renderer(Driver::Egl);
    for ink in [source(), wash()] {
        let ball = painting(scene_in(ink.clone()), [shapes::sphere(32, 16)]);
        let mut hidden = scene_in(ink);
        hidden.objects[0].hidden = true;
        let empty = painting(hidden, [shapes::sphere(32, 16)]);
        let first = renderer.render(&ball.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        for size_px in [[1, 1], [501, 3], [90, 210]] {
            let picture = renderer.render(&ball.at(0.0, &FrameOptions::new(size_px))).unwrap();
            assert_eq!(picture.rgba8.len(), (size_px[0] * size_px[1] * 4) as usize);
        }
        let bare = renderer.render(&empty.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        assert!(bare.rgba8.iter().all(|&byte| byte == 255), "nothing is left of what was drawn before");
        let again = renderer.render(&ball.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        assert!(again == first, "what was drawn before must not matter");
    }
}

#[test]
fn any_model_can_be_drawn() {
    let mut renderer = renderer(Driver::Egl);
    for name in ["apple", "fish", "turntable"] {
        for style in ["SumiE(rule: Source)", "SumiE(accent: 0)"] {
            let painting = scenes::painting_with(name, &[("style", style)]);
            let picture = renderer.render(&painting.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
            let dark = picture.rgba8.chunks_exact(4).filter(|pixel| pixel[0] < 110).count();
            assert!(dark > 100, "{name} in {style}: {dark} dark pixels");
            let light = picture.rgba8.chunks_exact(4).filter(|pixel| pixel[0] > 190).count();
            assert!(light > 3000, "{name} in {style}: {light} light pixels");
        }
    }
}

#[test]
fn both_drivers_draw_the_same_ink() {
    let (mut egl, mut osmesa) = (renderer(Driver::Egl), renderer(Driver::Osmesa));
    for ink in [SumiE::default(), SumiE { rule: InkRule::Source, ..SumiE::default() }] {
        let (mut scene, meshes) = two_bodies(ink);
        scene.objects.iter_mut().for_each(|object| object.particles = None);
        let frame = painting(scene, meshes).at(0.0, &FrameOptions::new([333, 187]));
        let (a, b) = (egl.render(&frame).unwrap(), osmesa.render(&frame).unwrap());
        assert!(a.rgba8.chunks_exact(4).any(|pixel| pixel[0] < 120), "there is ink to compare");
        assert!(a == b, "EGL and OSMesa differ");
    }
}

#[test]
fn paper_that_follows_the_camera_moves_with_what_it_looks_at() {
    let mut renderer = renderer(Driver::Egl);
    let mut after_slide = |paper_follows: CanvasFollows, x: f64| {
        let mut scene = scene_in(SumiE { paper_follows, fibres: 3.0, ..SumiE::default() });
        scene.objects[0].hidden = true;
        scene.timeline.last = 1;
        let key = |frame: f64, x: f64| shapes::camera_key(frame, [x, 0.0, 4.0], [x, 0.0, 0.0]);
        scene.camera.keys = vec![key(0.0, 0.0), key(1.0, x)];
        let painting = painting(scene, [shapes::sphere(8, 4)]);
        renderer.render(&painting.at(1.0, &FrameOptions::new(SIZE_PX))).unwrap()
    };
    // The camera slides to the right by 32 pixels.
    let x = 32.0 * 2.25 / 180.0;
    let (still, moved) = (after_slide(CanvasFollows::Camera, 0.0), after_slide(CanvasFollows::Camera, x));
    let off = |shift: usize| -> f64 {
        let sum: i32 = (0..180)
            .flat_map(|y| (0..250).map(move |x| (x, y)))
            .map(|(x, y)| (red(&still, x + shift, y) - red(&moved, x, y)).abs())
            .sum();
        f64::from(sum) / (180.0 * 250.0)
    };
    assert!(off(32) < 0.6, "the paper did not slide by 32 pixels, as the camera did: off by {}", off(32));
    assert!(off(0) > 2.0, "the measure must see a slide: {}", off(0));
    assert!(after_slide(CanvasFollows::Picture, x) == after_slide(CanvasFollows::Picture, 0.0));
}

#[test]
fn a_picture_three_times_as_large_has_lines_three_times_as_wide() {
    let mut renderer = renderer(Driver::Egl);
    let scene = || scene_in(SumiE { bleed: 0.0, dryness: 0.0, blur_px: 3.0, ..wash() });
    let painting = painting(scene(), [shapes::sphere(96, 48)]);
    let mut at = |scale: u32| {
        let size_px = SIZE_PX.map(|side| side * scale);
        renderer.render(&painting.at(0.0, &FrameOptions::new(size_px))).unwrap()
    };
    let (small, large) = (at(1), at(3));
    let mut sum = 0;
    for y in 0..180 {
        for x in 0..320 {
            sum += (red(&small, x, y) - red(&large, 3 * x + 1, 3 * y + 1)).abs();
        }
    }
    let mean = f64::from(sum) / (320.0 * 180.0);
    assert!(mean < 1.5, "the pictures differ by {mean}");
}

#[test]
fn what_is_red_stays_red_and_all_else_is_ink() {
    let mut renderer = renderer(Driver::Egl);
    let mut reddest = |color: [f32; 3], accent: f64| {
        let mut scene = scene_in(SumiE { accent, ..SumiE::default() });
        scene.objects[0].particles = None;
        scene.objects[0].material = Some(impasto_scene::document::MaterialOverride {
            color: Some(Color(color)),
            ..Default::default()
        });
        let picture = drawn(&mut renderer, scene);
        let of = |pixel: &[u8]| i32::from(pixel[0]) - i32::from(pixel[1]);
        picture.rgba8.chunks_exact(4).filter(|pixel| of(pixel) > 60).count()
    };
    assert!(reddest([0.7, 0.15, 0.12], 1.0) > 3000);
    assert_eq!(reddest([0.7, 0.15, 0.12], 0.0), 0);
    assert_eq!(reddest([0.2, 0.5, 0.2], 1.0), 0);
}

#[test]
fn layers_that_ink_does_not_draw_have_no_strokes() {
    let layers = |style: Style| {
        let mut scene = scene_in(SumiE::default());
        scene.style = style;
        scene.objects[0].particles = None;
        // A preset in which every layer has strokes.
        scene.strokes = StrokeSettings { preset: Some("oil study".to_owned()), ..Default::default() };
        let frame = painting(scene, [shapes::sphere(96, 48)]).at(0.0, &FrameOptions::new(SIZE_PX));
        frame.layers.iter().filter(|layer| layer.count > 0).map(|layer| layer.kind).collect::<Vec<_>>()
    };
    let of_paint = [LayerKind::Underpainting, LayerKind::Contour, LayerKind::Lights];
    let in_paint = layers(Style::default());
    assert!(of_paint.iter().all(|kind| in_paint.contains(kind)), "{in_paint:?}");
    let in_ink = layers(Style::SumiE(SumiE::default()));
    assert_eq!(in_ink, [LayerKind::Body, LayerKind::Form, LayerKind::Scumble, LayerKind::Accents]);
}

#[test]
fn bad_ink_is_one_clear_error() {
    let path = root().join("scenes/apple.ron");
    for (style, says) in [
        ("SumiE(tones: (0.1, 0.5))", "four tones"),
        ("SumiE(tones: (0.9, 0.5, 0.7, 1))", "dark to light"),
        ("SumiE(tones: (NaN, 0.5, 0.7, 1))", "dark to light"),
        ("SumiE(blur_px: NaN)", "out of range"),
        ("SumiE(bleed: -1)", "out of range"),
        ("SumiE(silhouette_from: 0.8)", "silhouette"),
        ("SumiE(to_light: (0, 0, 0))", "direction"),
        ("SumiE(blead: 1)", "bleed"),
    ] {
        let overrides = vec![("style".to_owned(), style.to_owned())];
        let report = load(&path, &LoadOptions { overrides, ..Default::default() }).unwrap_err().to_string();
        assert!(report.contains(says), "{style}: {report}");
    }
}
