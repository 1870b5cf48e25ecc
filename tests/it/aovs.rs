//! Tests of what EXR files hold beside the colour. Oracles: closed forms, brute force at more samples, and the picture
//! itself.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use impasto_aovs::cryptomatte::id_bits;
use impasto_aovs::{Drawn, read};
use impasto_core::color::srgb_from_linear;
use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::aovs::AovSet;
use impasto_scene::document::{Ease, ObjectKey, Scene};
use impasto_tests::command::{impasto, root};
use impasto_tests::{pictures, scenes, shapes};

/// A picture and its channels by name; `ids` is the channel `stroke.id.X`.
struct Shot {
    picture: Picture,
    planes: BTreeMap<String, Vec<f32>>,
    ids: Vec<u32>,
}

impl Shot {
    fn plane(&self, name: &str) -> &[f32] {
        self.planes.get(name).unwrap_or_else(|| panic!("no channel {name}"))
    }

    fn at(&self, name: &str, [x, y]: [u32; 2]) -> f32 {
        self.plane(name)[(y * self.picture.size_px[0] + x) as usize]
    }

    /// How much of each pixel shows the thing of this name.
    fn matte(&self, kind: &str, name: &str) -> Vec<f32> {
        let bits = id_bits(name);
        let ranks = ["00.R", "00.B", "01.R", "01.B", "02.R", "02.B"];
        let amounts = ["00.G", "00.A", "01.G", "01.A", "02.G", "02.A"];
        let mut matte = vec![0.0; self.plane("R").len()];
        for (rank, amount) in ranks.iter().zip(amounts) {
            let ids = self.plane(&format!("{kind}{rank}"));
            let amounts = self.plane(&format!("{kind}{amount}"));
            for ((sum, id), amount) in matte.iter_mut().zip(ids).zip(amounts) {
                *sum += if id.to_bits() == bits { *amount } else { 0.0 };
            }
        }
        matte
    }
}

fn shot(renderer: &mut Renderer, painting: &Painting, number: f64, options: &FrameOptions) -> Shot {
    let frame = painting.at(number, options);
    renderer.gather_paint(true);
    let picture = renderer.render(&frame).unwrap();
    let drawn = Drawn { painting, frame: &frame, number, options, wanted: AovSet::ALL };
    let found = read(renderer, &drawn).unwrap();
    renderer.gather_paint(false);
    let (mut planes, mut ids) = (BTreeMap::new(), Vec::new());
    for Channel { name, samples } in found.channels {
        let plane = match samples {
            Samples::Half(values) => values.iter().map(|value| value.to_f32()).collect(),
            Samples::Float(values) => values,
            Samples::Uint(values) => {
                ids = values;
                continue;
            }
        };
        assert!(planes.insert(name.clone(), plane).is_none(), "{name} twice");
    }
    Shot { picture, planes, ids }
}

/// A sheet of side 2 at the origin, facing the camera, which is 4 units away. Of the layers of `shapes::scene`, it has
/// the body layer alone.
fn facing_sheet(change: impl FnOnce(&mut Scene)) -> Painting {
    let mut scene = shapes::scene(vec![shapes::object("Sheet", 3000)]);
    scene.strokes.layers = shapes::body_layer_alone();
    change(&mut scene);
    prepare(shapes::loaded(scene, [shapes::sheet(1)])).unwrap()
}

/// The vertical field of view of `shapes::scene`, degrees.
const LENS_DEG: f64 = 35.0;

const SMALL: FrameOptions = FrameOptions::new([320, 180]);

#[test]
fn colour_and_layers_give_the_picture_which_no_data_changes() {
    let mut renderer = pictures::renderer(Driver::Auto);
    let clear = FrameOptions { transparent: true, ..SMALL };
    let upside_down = r#"["lights", "contour", "accents", "scumble", "form", "body", "underpainting"]"#;
    let upside_down: &[(&str, &str)] = &[("strokes.order", upside_down)];
    let cases = [
        ("still_life", SMALL, &[][..]),
        ("still_life", clear, &[]),
        ("portrait", SMALL, &[]),
        ("still_life", SMALL, upside_down),
    ];
    for (name, options, set) in cases {
        let painting = scenes::painting_with(name, set);
        let plain = renderer.render(&painting.at(7.0, &options)).unwrap();
        let shot = shot(&mut renderer, &painting, 7.0, &options);
        assert!(plain == shot.picture, "{name}: data beside the colour changes the picture");
        let planes = ["R", "G", "B", "A"].map(|letter| shot.plane(letter));
        for (index, pixel) in shot.picture.rgba8.chunks_exact(4).enumerate() {
            let alpha = planes[3][index];
            for channel in 0..3 {
                let linear = if alpha > 0.0 { planes[channel][index] / alpha } else { 0.0 };
                let encoded = srgb_from_linear(linear) * 255.0;
                let off = (encoded - f32::from(pixel[channel])).abs();
                assert!(
                    off <= 1.0 || alpha < 0.01,
                    "{name}, pixel {index}: {encoded} for {}",
                    pixel[channel]
                );
            }
        }
        let layers: Vec<String> = ["ground"]
            .into_iter()
            .map(str::to_owned)
            .chain(painting.paint_layers().iter().map(|(order, kind)| {
                match *order == painting.paint_layers()[0].0 {
                    true => kind.name().to_owned(),
                    false => format!("{}_{order}", kind.name()),
                }
            }))
            .chain(["finish".to_owned()])
            .collect();
        let mut laid = vec![[0.0f32; 4]; planes[0].len()];
        for layer in &layers {
            let own = ["R", "G", "B", "A"].map(|letter| shot.plane(&format!("layer.{layer}.{letter}")));
            for (index, laid) in laid.iter_mut().enumerate() {
                *laid = std::array::from_fn(|channel| {
                    own[channel][index] + (1.0 - own[3][index]) * laid[channel]
                });
            }
        }
        let mut largest = 0.0f32;
        for (index, laid) in laid.iter().enumerate() {
            for (laid, plane) in laid.iter().zip(planes) {
                largest = largest.max((laid - plane[index]).abs());
            }
        }
        println!("{name}: layers are off by at most {largest}");
        assert!(largest < 1e-3, "{name}: {largest}");
    }
}

#[test]
fn a_facing_sheet_has_the_depth_the_normals_and_the_places_that_it_has() {
    let painting = facing_sheet(|_| {});
    let mut renderer = pictures::renderer(Driver::Auto);
    let shot = shot(&mut renderer, &painting, 0.0, &SMALL);
    let middle = [160, 90];
    assert!((shot.at("Z", middle) - 4.0).abs() < 1e-4);
    assert_eq!(shot.at("Z", [0, 0]), 1e10);
    assert_eq!([shot.at("objectid.X", middle), shot.at("objectid.X", [0, 0])], [1.0, 0.0]);
    assert_eq!(["N.X", "N.Y", "N.Z"].map(|name| shot.at(name, middle)), [0.0, 0.0, 1.0]);
    // At the sheet, 4 units away, the picture is 2 · 4 · tan(half the field of view) units high.
    let height = 8.0 * (0.5 * LENS_DEG.to_radians()).tan();
    let px = height / 180.0;
    for pixel in [[160, 90], [150, 60], [175, 130]] {
        let wanted = [(pixel[0] as f64 + 0.5 - 160.0) * px, (90.0 - pixel[1] as f64 - 0.5) * px, 0.0];
        for (name, wanted) in ["P.X", "P.Y", "P.Z"].into_iter().zip(wanted) {
            let found = f64::from(shot.at(name, pixel));
            assert!((found - wanted).abs() < 1e-4, "{name} at {pixel:?}: {found} for {wanted}");
        }
    }
}

#[test]
fn strokes_on_a_rolled_sheet_have_the_angle_of_the_roll() {
    let mut renderer = pictures::renderer(Driver::Auto);
    for roll_deg in [7.0, 30.0, 137.0] {
        let painting = facing_sheet(|scene| {
            let start = shapes::camera_key(0.0, [0.0, 0.0, 4.0], [0.0, 0.0, 0.0]);
            let mut end = start.clone();
            (end.frame, end.roll_deg) = (10.0, roll_deg);
            scene.camera.keys = vec![start, end];
            scene.timeline.last = 10;
        });
        let still = shot(&mut renderer, &painting, 0.0, &SMALL).at("stroke.angle.X", [160, 90]);
        let turned = shot(&mut renderer, &painting, 10.0, &SMALL);
        let found = turned.at("stroke.angle.X", [160, 90]);
        // The picture turns opposite to the camera.
        let off = pictures::wrap_half(f64::from(found - still) + f64::to_radians(roll_deg));
        assert!(off.abs() < 1e-3, "{roll_deg} degrees: {found} from {still}");
        assert!(turned.at("stroke.kappa.X", [160, 90]) > 0.999);
        assert_eq!(turned.at("stroke.layer.X", [160, 90]), 2.0);
    }
}

/// A stroke has the same number in every frame: when the camera has rolled by half a turn, most pixels near the middle
/// show the stroke that the opposite pixel showed before.
#[test]
fn a_stroke_keeps_its_number() {
    let mut renderer = pictures::renderer(Driver::Auto);
    let painting = facing_sheet(|scene| {
        let start = shapes::camera_key(0.0, [0.0, 0.0, 4.0], [0.0, 0.0, 0.0]);
        let mut end = start.clone();
        (end.frame, end.roll_deg) = (10.0, 180.0);
        scene.camera.keys = vec![start, end];
        scene.timeline.last = 10;
    });
    let [first, last] = [0.0, 10.0].map(|number| shot(&mut renderer, &painting, number, &SMALL).ids);
    let inside = |row: u32, column: u32| (row * 320 + column) as usize;
    let (mut same, mut all) = (0, 0);
    for row in 70..110 {
        for column in 140..180 {
            all += 1;
            same += usize::from(first[inside(row, column)] == last[inside(179 - row, 319 - column)]);
        }
    }
    assert!(same * 10 > all * 8, "{same} of {all}");
}

/// A sheet moves by 0.1 units to the right and 0.05 up per frame. Its scale in pixels per unit is known.
#[test]
fn motion_is_where_the_surface_was_and_will_be() {
    let painting = facing_sheet(|scene| {
        let key = |frame: f64, at: [f64; 3]| ObjectKey {
            translation: at,
            ease: Ease::Linear,
            ..ObjectKey::at(frame)
        };
        scene.objects[0].keys = vec![key(0.0, [0.0; 3]), key(10.0, [1.0, 0.5, 0.0])];
        scene.timeline.last = 10;
    });
    let mut renderer = pictures::renderer(Driver::Auto);
    let shot = shot(&mut renderer, &painting, 4.0, &SMALL);
    let px_per_unit = 180.0 / (8.0 * (0.5 * LENS_DEG.to_radians()).tan()) as f32;
    let step = [0.1 * px_per_unit, 0.05 * px_per_unit];
    let pixel = [190, 80];
    assert_eq!(shot.at("objectid.X", pixel), 1.0);
    for (name, wanted) in [
        ("motion.X", -step[0]),
        ("motion.Y", -step[1]),
        ("motion.Z", -step[0]),
        ("motion.W", -step[1]),
        ("forward.u", step[0]),
        ("forward.v", step[1]),
        ("backward.u", -step[0]),
        ("backward.v", -step[1]),
    ] {
        let found = shot.at(name, pixel);
        assert!((found - wanted).abs() < 0.02, "{name}: {found} for {wanted}");
        assert_eq!(shot.at(name, [0, 0]), 0.0, "{name} where nothing is");
    }
}

/// On moving scenes, the motion vector of a pixel leads to where the pixel's surface point is in the next frame. That
/// place is found by moving the point with its rigid object and projecting it.
#[test]
fn motion_leads_to_the_same_point_of_the_surface_in_the_next_frame() {
    let mut renderer = pictures::renderer(Driver::Auto);
    for (name, number) in [("still_life", 40.0), ("lane", 10.0), ("roll", 20.0)] {
        let painting = scenes::painting(name);
        let here = shot(&mut renderer, &painting, number, &SMALL);
        let [now, then] = [number, number + 1.0].map(|number| painting.at(number, &SMALL));
        let clip_from_world = then.view.clip_from_view * then.view.view_from_world;
        let (mut largest, mut compared) = (0.0f32, 0);
        for index in 0..here.plane("objectid.X").len() {
            let id = here.plane("objectid.X")[index] as usize;
            if id == 0 || now.bodies[id - 1].bent.is_some() {
                continue;
            }
            let world = Vec3::from(["P.X", "P.Y", "P.Z"].map(|name| here.plane(name)[index]));
            let model = now.bodies[id - 1].world_from_model.inverse().transform_point3(world);
            let moved = then.bodies[id - 1].world_from_model.transform_point3(model);
            let clip = clip_from_world * moved.extend(1.0);
            let at = [(clip.x / clip.w + 1.0) * 160.0, (clip.y / clip.w + 1.0) * 90.0];
            let from = [(index % 320) as f32 + 0.5, 180.0 - (index / 320) as f32 - 0.5];
            let vector = ["forward.u", "forward.v"].map(|name| here.plane(name)[index]);
            let off = [0, 1].map(|axis| (from[axis] + vector[axis] - at[axis]).abs());
            largest = largest.max(off[0]).max(off[1]);
            compared += 1;
        }
        println!("{name}: {compared} pixels, at most {largest} px off");
        assert!(compared > 10_000 && largest < 0.05, "{name}: {largest} px");
    }
}

/// Compares the mattes of objects with what their shapes cover, counted at 4 × 4 places a pixel. Where a body is, the
/// mattes must sum to 1.
#[test]
fn mattes_cover_what_is_painted() {
    let mut renderer = pictures::renderer(Driver::Auto);
    let painting = scenes::painting("still_life");
    let shot = shot(&mut renderer, &painting, 0.0, &SMALL);
    let fine = FrameOptions::new([1280, 720]);
    let camera = impasto_scene::motion::camera_at(painting.scene(), 0.0);
    let frame = painting.bare(&camera, 0.0, &fine).clone();
    renderer
        .render(&impasto_painting::Frame { style: impasto_painting::frame::Style::Reference, ..frame })
        .unwrap();
    let reference = renderer.read_reference();
    let mut sums = vec![0.0f32; 320 * 180];
    for (index, object) in painting.scene().objects.iter().enumerate() {
        let mut counted = vec![0.0f32; 320 * 180];
        for (at, id) in reference.body_id.iter().enumerate() {
            if *id as usize == index + 1 {
                counted[at / 1280 / 4 * 320 + at % 1280 / 4] += 1.0 / 16.0;
            }
        }
        let matte = shot.matte("CryptoObject", &object.name);
        let off: f32 = matte.iter().zip(&counted).map(|(matte, counted)| (matte - counted).abs()).sum();
        let mean = off / matte.len() as f32;
        println!("{}: off by {mean:.4} in the mean", object.name);
        assert!(mean < 0.01, "{}: {mean}", object.name);
        for (sum, part) in sums.iter_mut().zip(&matte) {
            *sum += part;
        }
    }
    let painted = shot.plane("objectid.X");
    for kind in ["CryptoMaterial", "CryptoRegion", "CryptoStroke"] {
        let amounts = ["00.G", "00.A", "01.G", "01.A", "02.G", "02.A"];
        let all = amounts.map(|amount| shot.plane(&format!("{kind}{amount}")));
        let low = (0..sums.len())
            .filter(|&at| painted[at] > 0.0)
            .map(|at| all.iter().map(|plane| plane[at]).sum::<f32>());
        let mean = low.clone().sum::<f32>() / low.clone().count() as f32;
        println!("{kind}: {mean:.4} of what is painted in the mean, at least {}", low.fold(1.0, f32::min));
        // The file names at most six strokes a pixel, and some pixels show more.
        let least = if kind == "CryptoStroke" { 0.99 } else { 0.999 };
        assert!(mean > least, "{kind}: {mean}");
    }
    let covered = (0..sums.len()).filter(|&at| painted[at] > 0.0);
    let (least, most) =
        covered.map(|at| sums[at]).fold((1.0f32, 0.0f32), |(low, high), sum| (low.min(sum), high.max(sum)));
    println!("sums of all objects where a body is: {least} to {most}");
    assert!(least > 0.99 && most < 1.01, "{least} to {most}");
}

/// Without a background, alpha is the coverage by paint, and so is the sum of all mattes.
#[test]
fn without_a_background_mattes_add_up_to_alpha() {
    let mut renderer = pictures::renderer(Driver::Auto);
    let painting = scenes::painting("still_life");
    let clear = FrameOptions { transparent: true, ..SMALL };
    let shot = shot(&mut renderer, &painting, 0.0, &clear);
    let mut sums = vec![0.0f32; 320 * 180];
    for object in &painting.scene().objects {
        for (sum, part) in sums.iter_mut().zip(shot.matte("CryptoObject", &object.name)) {
            *sum += part;
        }
    }
    let largest =
        sums.iter().zip(shot.plane("A")).map(|(sum, alpha)| (sum - alpha).abs()).fold(0.0, f32::max);
    println!("sums of mattes are off alpha by at most {largest}");
    assert!(largest < 0.01, "{largest}");
}

fn render(folder: &Path, scene: &str, arguments: &[&str]) -> Output {
    let scene = root().join("scenes").join(scene);
    let mut command = Command::new(impasto());
    command.arg("render").arg(scene).args(["-f", "0", "--size", "96x54"]).args(arguments);
    command.current_dir(folder).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn the_command_writes_what_is_asked_for_and_says_what_a_style_lacks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let done = render(path, "roll.ron", &["-o", "a.exr", "--aov", "depth,stroke"]);
    assert!(done.status.success(), "{}", said(&done));
    let names = |file: &str| {
        let meta = exr::meta::MetaData::read_from_file(path.join(file), false).unwrap();
        let list = &meta.headers[0].channels.list;
        list.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>()
    };
    let wanted = [
        "A",
        "B",
        "G",
        "R",
        "Z",
        "stroke.angle.X",
        "stroke.id.X",
        "stroke.kappa.X",
        "stroke.layer.X",
        "stroke.rank.X",
    ];
    assert_eq!(names("a.exr"), wanted);
    let ink = render(path, "roll.ron", &["-o", "b.exr", "--aov", "all", "--style", "sumi_e"]);
    assert!(ink.status.success() && said(&ink).contains("stroke.id") && said(&ink).contains("left out"));
    assert!(
        names("b.exr").iter().any(|name| name == "Z")
            && !names("b.exr").iter().any(|name| name.contains("stroke"))
    );
    let both = render(path, "roll.ron", &["-o", "c.png", "--exr", "--bits", "16"]);
    assert!(both.status.success() && path.join("c.png").exists(), "{}", said(&both));
    assert_eq!(names("c.exr"), ["A", "B", "G", "R"]);
    // A whole file is left as it is; one that was cut short is written again.
    let whole = std::fs::read(path.join("a.exr")).unwrap();
    let skip = || render(path, "roll.ron", &["-o", "a.exr", "--aov", "depth,stroke", "--skip-existing"]);
    let before = std::fs::metadata(path.join("a.exr")).unwrap().modified().unwrap();
    assert!(skip().status.success());
    assert_eq!(std::fs::metadata(path.join("a.exr")).unwrap().modified().unwrap(), before);
    std::fs::write(path.join("a.exr"), &whole[..whole.len() / 2]).unwrap();
    assert!(skip().status.success());
    assert!(std::fs::read(path.join("a.exr")).unwrap() == whole, "other bytes the second time");
}

#[test]
fn mistakes_are_told_with_the_mend() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (arguments, words) in [
        (&["-o", "a.exr", "--aov", "dpeth"][..], "\"depth\""),
        (&["-o", "a.png", "--aov", "depth"], "--exr"),
        (&["-o", "a.mp4", "--exr"], "--exr"),
        (&["-o", "a.exr", "--apng"], ".png"),
        (&["-o", "a.tiff"], ".exr"),
        (&["-o", "a.png", "--bits", "12"], "8 or 16"),
        (&["-o", "a.png", "--exposure", "99"], "16"),
        (&["-o", "a.exr", "--set", "aovs=[\"depht\"]"], "\"depth\""),
    ] {
        let done = render(path, "roll.ron", arguments);
        assert!(!done.status.success() && said(&done).contains(words), "{arguments:?}: {}", said(&done));
        assert_eq!(said(&done).matches("error").count(), 1, "{arguments:?}: {}", said(&done));
    }
    assert_eq!(std::fs::read_dir(path).unwrap().count(), 0, "a file was written");
}

#[test]
fn what_noise_colours_takes_no_light_and_has_no_normal() {
    let mut renderer = pictures::renderer(Driver::Egl);
    let options = FrameOptions::new([160, 90]);
    let shot = shot(&mut renderer, &scenes::painting("explosion"), 12.0, &options);
    let [x, y, z] = ["N.X", "N.Y", "N.Z"].map(|name| shot.plane(name));
    let mut coloured = 0;
    for at in 0..x.len() {
        for name in ["light.R", "light.G", "light.B", "shadow.X"] {
            let value = shot.plane(name)[at];
            assert!(value.is_finite(), "{name} is {value} at pixel {at}");
            if [x[at], y[at], z[at]] == [0.0; 3] && shot.plane("objectid.X")[at] > 0.0 {
                coloured += 1;
                assert_eq!(value, 1.0, "{name} at pixel {at}");
            }
        }
    }
    // Each pixel is counted four times, once per channel.
    assert!(coloured > 4 * 100, "the fire is not seen: {coloured}");
}

#[test]
fn exposure_brightens_what_is_shown_and_leaves_the_linear_picture() {
    let mut renderer = pictures::renderer(Driver::Auto);
    let painting = scenes::painting("roll");
    let plain = shot(&mut renderer, &painting, 0.0, &SMALL);
    let options = FrameOptions { exposure_stops: 1.0, ..SMALL };
    let bright = shot(&mut renderer, &painting, 0.0, &options);
    assert_eq!(plain.planes["R"], bright.planes["R"]);
    for (index, pixel) in bright.picture.rgba8.chunks_exact(4).enumerate() {
        let wanted = srgb_from_linear((2.0 * plain.plane("G")[index]).min(1.0)) * 255.0;
        assert!((wanted - f32::from(pixel[1])).abs() < 1.5, "pixel {index}: {} for {wanted}", pixel[1]);
    }
}

#[test]
fn paint_is_lit_anew_and_a_file_that_is_none_is_one_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let run = |arguments: &[&str]| {
        Command::new(impasto()).arg("relight").args(arguments).current_dir(path).output().unwrap()
    };
    let painted = render(path, "roll.ron", &["-o", "a.exr", "--aov", "paint.color,paint.normal"]);
    assert!(painted.status.success() && render(path, "roll.ron", &["-o", "bare.exr"]).status.success());
    let done = run(&["a.exr", "--light", "1,0.5,0.5", "-o", "lit.png"]);
    assert!(done.status.success() && path.join("lit.png").exists(), "{}", said(&done));
    let whole = std::fs::read(path.join("a.exr")).unwrap();
    // A header that claims a picture of 10,000 x 10,000: the end of its data window is changed.
    let window = whole.windows(11).position(|name| name == b"dataWindow\0").unwrap() + 11 + 6 + 4 + 8;
    let mut huge = whole.clone();
    huge[window..window + 8].copy_from_slice(&[9999u32.to_le_bytes(), 9999u32.to_le_bytes()].concat());
    for (name, bytes) in [
        ("text.exr", b"no picture".to_vec()),
        ("empty.exr", Vec::new()),
        ("cut.exr", whole[..whole.len() * 2 / 3].to_vec()),
        ("head.exr", whole[..200].to_vec()),
        ("huge.exr", huge),
    ] {
        std::fs::write(path.join(name), bytes).unwrap();
        let done = run(&[name, "--light", "1,1,1", "-o", "none.png"]);
        let words = said(&done);
        assert!(done.status.code().is_some_and(|code| code != 0 && code < 100), "{name}: {words}");
        assert_eq!(words.matches("error").count(), 1, "{name}: {words}");
        assert!(words.contains(name) && !words.contains("panicked"), "{name}: {words}");
    }
    for (arguments, words) in [
        (&["bare.exr", "--light", "1,1,1", "-o", "none.png"][..], "--aov paint.color,paint.normal"),
        (&["a.exr", "--light", "1,1,-1", "-o", "none.png"], "X,Y,Z"),
        (&["a.exr", "--light", "1,1,1", "-o", "none.jpg"], ".png"),
        (&["gone.exr", "--light", "1,1,1", "-o", "none.png"], "gone.exr"),
    ] {
        let done = run(arguments);
        assert!(!done.status.success() && said(&done).contains(words), "{arguments:?}: {}", said(&done));
    }
    assert!(!path.join("none.png").exists());
}
