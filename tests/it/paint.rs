//! Tests of the paint: each layer can be turned down to nothing, difficult brushes and colours work, and a painting
//! looks the same at any size.

use std::ops::Range;
use std::path::Path;

use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::{Frame, LayerKind};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{
    Color, Direction, LayerSettings, Light, LightKind, RotatingStrokes, Scene, Style,
};
use impasto_scene::load::{LoadOptions, load};
use impasto_tests::command::root;
use impasto_tests::pictures::{Grey, renderer};
use impasto_tests::scenes;
use impasto_tests::shapes;

fn options(size_px: [u32; 2]) -> FrameOptions {
    FrameOptions::new(size_px)
}

fn strokes_of(frame: &Frame, kind: LayerKind) -> usize {
    frame.layers.iter().filter(|run| run.kind == kind).map(|run| run.count as usize).sum()
}

#[test]
fn each_layer_can_be_turned_down_to_nothing() {
    // Strokes three times as large need a ninth of the particles.
    let large = ("strokes.scale", "3");
    let all = scenes::painting_with("apple", &[large]).at(0.0, &options([320, 180]));
    for kind in LayerKind::ALL {
        assert!(strokes_of(&all, kind) > 0, "{kind:?} has no strokes");
        let without = format!("[(name: \"{}\", coverage: 0)]", kind.name());
        let frame = scenes::painting_with("apple", &[large, ("strokes.layers", &without)])
            .at(0.0, &options([320, 180]));
        for other in LayerKind::ALL {
            let expected = if other == kind { 0 } else { strokes_of(&all, other) };
            assert_eq!(strokes_of(&frame, other), expected, "{other:?} without {kind:?}");
        }
    }
}

/// The mean difference, 0..255, between the red, green and blue of two RGBA pictures that have the same size and alpha.
fn mean_difference(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / (a.len() as f64 * 0.75)
}

#[test]
fn relief_canvas_and_varnish_each_show_and_each_go() {
    let mut renderer = renderer(Driver::Egl);
    let bare = [("style.relief", "0"), ("style.weave", "0"), ("style.varnish", "0")];
    let mut picture = |set: &[(&str, &str)]| {
        let set: Vec<(&str, &str)> = set.iter().copied().chain([("strokes.scale", "2")]).collect();
        // Large enough for threads of the canvas to be more than a pixel apart.
        let frame = scenes::painting_with("apple", &set).at(0.0, &options([960, 540]));
        renderer.render(&frame).unwrap().rgba8
    };
    let flat = picture(&bare);
    for (index, &(field, _)) in bare.iter().enumerate() {
        let mut set = bare;
        set[index] = (field, "1");
        let difference = mean_difference(&flat, &picture(&set));
        assert!((0.1..12.0).contains(&difference), "{field} changes the picture by {difference}");
    }
    let board = picture(&[("style.relief", "0"), ("style.canvas", "Board"), ("style.varnish", "0")]);
    assert!(board == flat, "a board has no weave");
}

#[test]
fn a_palette_keeps_values_and_takes_its_hues_only() {
    let mut renderer = renderer(Driver::Egl);
    let mut hues = |palette: &str| {
        let set = [
            ("strokes.scale", "2"),
            ("strokes.palette", palette),
            ("strokes.color_jitter", "0"),
            ("strokes.temperature", "0"),
        ];
        let frame = scenes::painting_with("apple", &set).at(0.0, &options([320, 180]));
        renderer.render(&frame).unwrap();
        let resolved = renderer.resolved_strokes();
        let shown: Vec<[f32; 3]> = resolved
            .iter()
            .filter(|stroke| stroke.alpha > 0.1)
            .map(|stroke| impasto_core::color::oklab_from_linear(stroke.color_linear))
            .collect();
        assert!(shown.len() > 200);
        let values: Vec<f32> = shown.iter().map(|lab| lab[0]).collect();
        let spread =
            values.iter().fold(0.0f32, |a, &b| a.max(b)) - values.iter().fold(1.0f32, |a, &b| a.min(b));
        // How far a colour lies from the line between grey and the pigment.
        let pigment = impasto_core::color::oklab_from_linear(
            [0x4a, 0x6a, 0x9a].map(|byte: u8| impasto_core::color::linear_from_srgb(f32::from(byte) / 255.0)),
        );
        let across = [-pigment[2], pigment[1]];
        let length = across[0].hypot(across[1]);
        let off = shown.iter().map(|lab| ((lab[1] * across[0] + lab[2] * across[1]) / length).abs());
        (spread, off.fold(0.0f32, f32::max))
    };
    let (spread, off) = hues("[\"#4a6a9a\"]");
    assert!(spread > 0.3, "with one pigment, lightness must still vary: it varies by {spread}");
    assert!(off < 0.03, "with one pigment, every colour must have its hue: one is off by {off}");
    let (_, off) = hues("[]");
    assert!(off > 0.08, "the measure must see other hues: {off}");
}

/// Prepares the apple with a brush whose picture is these bytes.
fn with_brush(folder: &Path, brush: &[u8]) -> Result<Painting, String> {
    let scenes = root().join("scenes");
    std::fs::create_dir_all(folder.join("meshes")).unwrap();
    for name in ["apple.obj", "apple.mtl", "wall.obj", "wall.mtl"] {
        std::fs::copy(scenes.join("meshes").join(name), folder.join("meshes").join(name)).unwrap();
    }
    let text = std::fs::read_to_string(scenes.join("apple.ron")).unwrap();
    std::fs::write(folder.join("scene.ron"), text).unwrap();
    std::fs::write(folder.join("mark.png"), brush).unwrap();
    let overrides = vec![("strokes.brush".to_owned(), "mark.png".to_owned())];
    let loaded = load(&folder.join("scene.ron"), &LoadOptions { overrides, ..Default::default() })
        .map_err(|report| report.to_string())?;
    prepare(loaded.into()).map_err(|error| error.to_string())
}

fn png_of(size: u32, grey: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size, size);
    encoder.set_color(png::ColorType::Grayscale);
    let texels: Vec<u8> = (0..size * size).map(|index| grey(index % size, index / size)).collect();
    encoder.write_header().unwrap().write_image_data(&texels).unwrap();
    bytes
}

#[test]
fn a_picture_of_ones_own_is_a_brush() {
    let folder = tempfile::tempdir().unwrap();
    let disc = png_of(64, |x, y| if (x as i32 - 32).pow(2) + (y as i32 - 32).pow(2) < 700 { 255 } else { 0 });
    let painting = with_brush(folder.path(), &disc).unwrap();
    let mut renderer = renderer(Driver::Egl);
    let frame = painting.at(0.0, &options([320, 180]));
    let own = renderer.render(&frame).unwrap();
    let usual = renderer.render(&scenes::painting("apple").at(0.0, &options([320, 180]))).unwrap();
    let difference = mean_difference(&own.rgba8, &usual.rgba8);
    assert!((0.3..20.0).contains(&difference), "another brush changes the picture by {difference}");
}

#[test]
fn a_picture_that_cannot_be_a_brush_is_reported() {
    let whole = png_of(64, |x, _| x as u8);
    let cases: [(&str, Vec<u8>, &str); 5] = [
        ("empty", Vec::new(), "mark.png"),
        ("cut off", whole[..whole.len() / 2].to_vec(), "mark.png"),
        ("of one grey", png_of(16, |_, _| 90), "it holds no brush mark"),
        ("no picture", b"a brush".to_vec(), "mark.png"),
        ("claims to be huge", huge(&whole), "mark.png"),
    ];
    for (name, bytes, words) in cases {
        let folder = tempfile::tempdir().unwrap();
        let said = with_brush(folder.path(), &bytes).err().unwrap_or_else(|| panic!("{name} is taken"));
        assert!(said.contains(words) && said.contains("strokes.brush"), "{name}: {said}");
        assert_eq!(said.lines().count(), 1, "{name}: {said}");
    }
}

/// A PNG whose header claims 60,000 pixels a side.
fn huge(png: &[u8]) -> Vec<u8> {
    let mut bytes = png.to_vec();
    bytes[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let crc = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    bytes
}

/// The checksum of PNG chunks.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
    })
}

/// A sphere with the given settings and as many particles as its strokes need.
fn sphere(edit: impl FnOnce(&mut Scene)) -> Painting {
    let mut scene = shapes::scene(vec![impasto_scene::document::Object {
        particles: None,
        ..shapes::object("sphere", 0)
    }]);
    edit(&mut scene);
    prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap()
}

type Edit = fn(&mut Scene);

#[test]
fn extreme_settings_still_give_a_picture() {
    let mut renderer = renderer(Driver::Egl);
    let edits: [(&str, Edit); 5] = [
        ("twentyfold coverage", |scene| {
            (scene.strokes.coverage, scene.strokes.scale) = (Some(20.0), Some(3.0));
        }),
        ("huge strokes", |scene| {
            (scene.strokes.length_px, scene.strokes.width_px) = (Some(4096.0), Some(4096.0));
        }),
        // The picture is small, because the number of such strokes grows with its number of pixels.
        ("hair-thin strokes", |scene| {
            (scene.strokes.width_px, scene.size) = (Some(0.001), (160, 90));
        }),
        ("wild colours", |scene| {
            (scene.strokes.color_jitter, scene.strokes.temperature) = (Some(10.0), Some(10.0));
        }),
        ("strokes along the contour", |scene| scene.strokes.contour = Some(1.0)),
    ];
    for (name, edit) in edits {
        let frame = sphere(edit).at(0.0, &options([160, 90]));
        assert!(frame.strokes.iter().all(|stroke| stroke.angle_rad.is_finite()), "{name}");
        let picture = renderer.render(&frame).unwrap();
        assert!(picture.rgba8.chunks(4).all(|pixel| pixel[3] == 255), "{name}");
        assert!(renderer.read_paint().iter().flatten().all(|value| value.is_finite()), "{name}");
    }
}

/// How much green differs from its mean over the 9 × 9 pixels around: the root mean square over the pixels where
/// `inside` holds.
fn roughness(rgba8: &[u8], width: usize, inside: impl Fn(usize, usize) -> bool) -> f64 {
    let green = |x: usize, y: usize| f64::from(rgba8[(y * width + x) * 4 + 1]);
    let (mut sum, mut count) = (0.0, 0.0);
    for (x, y) in (4..rgba8.len() / 4 / width - 4).flat_map(|y| (4..width - 4).map(move |x| (x, y))) {
        if inside(x, y) {
            let mean = (0..81).map(|at| green(x + at % 9 - 4, y + at / 9 - 4)).sum::<f64>() / 81.0;
            sum += (green(x, y) - mean).powi(2);
            count += 1.0;
        }
    }
    assert!(count > 1000.0);
    f64::sqrt(sum / count)
}

#[test]
fn wet_paint_of_one_value_runs_together_and_keeps_its_outline() {
    let mut renderer = renderer(Driver::Egl);
    let size_px = [640, 360];
    let mut picture = |pickup: &str| {
        let layers = ["underpainting", "body", "form", "scumble", "accents", "contour", "lights"]
            .map(|name| format!("(name: \"{name}\", pickup: {pickup})"))
            .join(", ");
        let layers = format!("[{layers}]");
        let frame = scenes::painting_with(
            "apple",
            &[("strokes.layers", &layers), ("style.weave", "0"), ("style.relief", "0")],
        )
        .at(0.0, &options(size_px));
        let picture = renderer.render(&frame).unwrap().rgba8;
        (picture, renderer.read_reference().body_id)
    };
    let (wet, ids) = picture("0.25");
    let (dry, _) = picture("0");
    let (width, height) = (size_px[0] as usize, size_px[1] as usize);
    let id = |x: usize, y: usize| ids[y * width + x];
    let fruit = id(width / 2, height / 2);
    let deep = |x: usize, y: usize| (0..9).all(|at| id(x + at % 3 * 12 - 12, y + at / 3 * 12 - 12) == fruit);
    let inside =
        |x: usize, y: usize| (16..width - 16).contains(&x) && (16..height - 16).contains(&y) && deep(x, y);
    let [of_wet, of_dry] = [&wet, &dry].map(|picture| roughness(picture, width, inside));
    assert!(of_wet < 0.84 * of_dry, "wet {of_wet}, dry {of_dry}");
    let border = |x: usize, y: usize| {
        (16..width - 16).contains(&x) && (16..height - 16).contains(&y) && id(x - 1, y) != id(x + 1, y)
    };
    let step = |picture: &[u8]| {
        let at = |x: usize, y: usize| f64::from(picture[(y * width + x) * 4]);
        let borders =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| border(x, y));
        let steps: Vec<f64> = borders.map(|(x, y)| (at(x + 4, y) - at(x - 4, y)).abs()).collect();
        steps.iter().sum::<f64>() / steps.len() as f64
    };
    assert!(step(&wet) > 0.9 * step(&dry), "{} {}", step(&wet), step(&dry));
}

#[test]
fn paint_ends_at_a_crease() {
    let mut renderer = renderer(Driver::Egl);
    let size_px = [640, 360];
    // A cube from above: its lit top meets its dark front in a level crease, and strokes stand upright on both.
    let mut scene = shapes::scene(vec![shapes::object("cube", 6000)]);
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 3.6, 4.4], [0.0; 3]);
    scene.lights = vec![Light {
        direction: Some([0.0, -1.0, -0.12]),
        color: Color::default(),
        intensity: 2.0,
        ..Light::new("sun", LightKind::Sun)
    }];
    scene.regions[0].direction = Direction::Angle(90.0);
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(160.0), Some(24.0));
    (scene.strokes.fit, scene.strokes.layers) = (Some(0.0), shapes::body_layer_alone());
    let painting = prepare(shapes::loaded(scene, [shapes::cube()])).unwrap();
    renderer.render(&painting.at(0.0, &options(size_px))).unwrap();
    let paint = renderer.read_paint();
    // The mean green of a row of the picture; rows go down. It is high on the top of the cube and low on its front. The
    // strokes are so few that they leave gaps, which are not counted.
    let row = |y: usize| {
        let painted = paint[y * 640 + 280..y * 640 + 360].iter().filter(|pixel| pixel[3] > 0.9);
        let greens: Vec<f64> = painted.map(|pixel| f64::from(pixel[1])).collect();
        assert!(greens.len() > 40, "{} pixels of row {y} are painted", greens.len());
        greens.iter().sum::<f64>() / greens.len() as f64
    };
    let mean = |rows: Range<usize>| rows.clone().map(row).sum::<f64>() / rows.len() as f64;
    let (lit, dark) = (mean(104..116), mean(218..230));
    let share = |rows: Range<usize>| (mean(rows) - dark) / (lit - dark);
    // The crease is at row 161. Strokes from its other side are long enough to reach the rows that are checked here: if
    // they ran on past the crease, the first share would be 0.75.
    assert!(share(122..150) > 0.95, "dark strokes run on over the top: {}", share(122..150));
    assert!(share(178..200) < 0.18, "light strokes run on over the front: {}", share(178..200));
}

/// The normal of the paint is that of its height field. Paint of height 1 is 1.6 px thick, and its slopes are
/// exaggerated 2.2 times, so that light shows a stroke's furrows.
#[test]
fn the_normal_of_the_paint_is_that_of_its_height() {
    const STEEPNESS: f64 = 2.2 * 1.6;
    let mut renderer = renderer(Driver::Auto);
    let size_px = [640, 360];
    for relief in [0.5, 1.0, 2.0] {
        let painting = sphere(|scene| {
            scene.style =
                Style::RotatingStrokes(RotatingStrokes { relief, weave: 0.0, ..Default::default() });
            // Wet paint has less relief where it ran together.
            let dry = |kind: LayerKind| LayerSettings {
                name: kind.name().to_owned(),
                pickup: Some(0.0),
                coverage: (kind != LayerKind::Body).then_some(0.0),
                ..LayerSettings::default()
            };
            scene.strokes.layers = LayerKind::ALL.map(dry).into();
        });
        renderer.gather_paint(true);
        renderer.render(&painting.at(0.0, &options(size_px))).unwrap();
        let surface = renderer.read_paint_surface().unwrap();
        let height = Grey {
            size_px: size_px.map(|side| side as usize),
            values: surface.normal_and_height.iter().map(|pixel| f64::from(pixel[3].to_f32())).collect(),
        };
        // Compares the slopes of the normals with those of the paint's height, which are found from the heights at the
        // corners of a square of 1.2 px. Rows go down.
        let (mut both, mut alone, mut off) = (0.0, 0.0, 0.0);
        for (x, y) in
            (2..size_px[1] as usize - 2).flat_map(|y| (2..size_px[0] as usize - 2).map(move |x| (x, y)))
        {
            let at = |dx: f64, dy: f64| height.sample(x as f64 + 0.6 * dx, y as f64 - 0.6 * dy).unwrap();
            let [right_above, left_above, right_below, left_below] =
                [at(1.0, 1.0), at(-1.0, 1.0), at(1.0, -1.0), at(-1.0, -1.0)];
            let slope = [
                (right_above + right_below - left_above - left_below) / 2.4,
                (right_above + left_above - right_below - left_below) / 2.4,
            ];
            let n =
                surface.normal_and_height[y * size_px[0] as usize + x].map(|value| f64::from(value.to_f32()));
            for axis in 0..2 {
                let (found, wanted) = (-n[axis] / n[2], STEEPNESS * relief * slope[axis]);
                both += found * wanted;
                alone += wanted * wanted;
                off += (found - wanted).powi(2);
            }
        }
        assert!(alone > 100.0, "there is no relief to compare: {alone}");
        assert!((both / alone - 1.0).abs() < 0.01, "relief {relief} stands {} times as steep", both / alone);
        assert!(off < 1e-3 * alone, "relief {relief}: normals are off by {off} of {alone}");
    }
}

/// The colours of the pixels after the picture was reduced to `small` by averaging.
fn reduced(renderer: &mut Renderer, painting: &Painting, size_px: [u32; 2], small: [u32; 2]) -> Vec<f64> {
    let picture = renderer.render(&painting.at(0.0, &options(size_px))).unwrap();
    let by = [size_px[0] / small[0], size_px[1] / small[1]];
    let mut values = Vec::new();
    for y in 0..small[1] {
        for x in 0..small[0] {
            for channel in 0..3 {
                let mut sum = 0.0;
                for (dx, dy) in (0..by[1]).flat_map(|dy| (0..by[0]).map(move |dx| (dx, dy))) {
                    let at = ((y * by[1] + dy) * size_px[0] + x * by[0] + dx) * 4 + channel;
                    sum += f64::from(picture.rgba8[at as usize]);
                }
                values.push(sum / f64::from(by[0] * by[1]));
            }
        }
    }
    values
}

#[test]
fn the_same_painting_at_any_size() {
    let mut renderer = renderer(Driver::Egl);
    let painting = scenes::painting("still_life");
    let small = [320, 180];
    let middle = reduced(&mut renderer, &painting, [1280, 720], small);
    for size_px in [[640, 360], [1920, 1080]] {
        let other = reduced(&mut renderer, &painting, size_px, small);
        let mean = middle.iter().zip(&other).map(|(a, b)| (a - b).abs()).sum::<f64>() / middle.len() as f64;
        println!("{size_px:?} against 1280 x 720, both reduced: mean difference {mean:.2}/255");
        assert!(mean <= 8.0, "{size_px:?}: {mean}");
        assert!(mean > 0.01, "two sizes give one picture: nothing was compared");
    }
}
