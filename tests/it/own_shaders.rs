//! Tests of a user's own shaders: they replace the program's shaders all together, or not at all.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_gl_render::{Renderer, ShaderTexts};
use impasto_painting::{Frame, FrameOptions, Painting, Quality};
use impasto_tests::command::impasto;
use impasto_tests::scenes;

const ENCODE: &str = include_str!("../../crates/gl-render/shaders/shared/encode.glsl");

fn painting() -> Arc<Painting> {
    scenes::painting("roll")
}

fn frame(painting: &Painting, quality: Quality) -> Frame {
    painting.at(0.0, &FrameOptions { quality, ..FrameOptions::new([96, 54]) })
}

fn texts(text: &str) -> ShaderTexts {
    let mut texts = ShaderTexts::default();
    assert!(texts.put("shared/encode.glsl", text.to_owned()));
    texts
}

/// A shader that paints red is used for exact pictures and for drafts; a broken shader changes nothing.
#[test]
fn a_text_takes_the_place_of_a_file_and_a_broken_one_leaves_the_last_good() {
    let painting = painting();
    let mut renderer = Renderer::new(open(Driver::Auto, &OpenOptions::default()).unwrap()).unwrap();
    let [exact, draft] = [Quality::Exact, Quality::Draft].map(|quality| frame(&painting, quality));
    let own = renderer.render(&exact).unwrap();
    let red = ENCODE.replace("return mix(high, low,", "return vec3(1.0, 0.0, 0.0) + 0.0 * mix(high, low,");
    renderer.replace_shaders(&texts(&red)).unwrap();
    for frame in [&exact, &draft] {
        let picture = renderer.render(frame).unwrap();
        assert!(picture.rgba8.chunks_exact(4).all(|pixel| pixel == [255, 0, 0, 255]));
    }
    let broken = ENCODE.replace("mix(high, low,", "mix(high, lower,");
    let words = renderer.replace_shaders(&texts(&broken)).unwrap_err().to_string();
    assert!(words.contains("shared/encode.glsl:5") && words.contains("lower"), "{words}");
    // A shader that is broken only in drafts, or only where data beside the colour is wanted, is refused at once.
    for only in ["DRAFT", "DATA"] {
        let broken = format!("{ENCODE}\n#ifdef {only}\nbroken\n#endif\n");
        renderer.replace_shaders(&texts(&broken)).unwrap_err();
    }
    assert!(renderer.render(&exact).unwrap().rgba8.starts_with(&[255, 0, 0, 255]));
    renderer.replace_shaders(&ShaderTexts::default()).unwrap();
    assert!(renderer.render(&exact).unwrap() == own);
}

/// When OSMesa's context is made current, EGL still believes that EGL's context is current. Without care, the EGL
/// renderer would then draw, and free its objects, in OSMesa's context.
#[test]
fn renderers_of_two_drivers_on_one_thread_keep_apart() {
    let painting = painting();
    let frame = frame(&painting, Quality::Exact);
    for drivers in [[Driver::Egl, Driver::Osmesa], [Driver::Osmesa, Driver::Egl]] {
        let mut renderers =
            drivers.map(|driver| Renderer::new(open(driver, &OpenOptions { debug: true }).unwrap()).unwrap());
        let red =
            ENCODE.replace("return mix(high, low,", "return vec3(1.0, 0.0, 0.0) + 0.0 * mix(high, low,");
        let [first, second] = &mut renderers;
        first.replace_shaders(&texts(&red)).unwrap();
        let own = second.render(&frame).unwrap();
        for _ in 0..2 {
            assert!(first.render(&frame).unwrap().rgba8.starts_with(&[255, 0, 0, 255]), "{drivers:?}");
            assert!(second.render(&frame).unwrap() == own, "{drivers:?}");
        }
        second.replace_shaders(&texts(&red)).unwrap();
        first.replace_shaders(&ShaderTexts::default()).unwrap();
        assert!(second.render(&frame).unwrap().rgba8.starts_with(&[255, 0, 0, 255]), "{drivers:?}");
        assert!(first.render(&frame).unwrap() == own, "{drivers:?}");
    }
}

#[test]
fn the_command_draws_with_a_folder_of_shaders_or_says_what_is_wrong_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let run = || {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/roll.ron");
        let mut command = Command::new(impasto());
        command.arg("render").arg(scene).args(["--frames", "0", "--size", "64x36", "--output", "a.png"]);
        command.args(["--shaders", "looks"]).current_dir(folder.path()).output().unwrap()
    };
    let said = |output: &std::process::Output| String::from_utf8_lossy(&output.stderr).into_owned();
    let nothing = run();
    assert!(!nothing.status.success() && said(&nothing).contains("holds no shader"), "{}", said(&nothing));
    std::fs::create_dir_all(folder.path().join("looks/shared")).unwrap();
    let file = folder.path().join("looks/shared/encode.glsl");
    std::fs::write(&file, ENCODE.replace("vec3 low", "vec3 lo")).unwrap();
    let broken = run();
    assert!(!broken.status.success() && said(&broken).contains("shared/encode.glsl:5"), "{}", said(&broken));
    assert!(!folder.path().join("a.png").exists());
    let red = ENCODE.replace("return mix(high, low,", "return vec3(1.0, 0.0, 0.0) + 0.0 * mix(high, low,");
    std::fs::write(&file, red).unwrap();
    let drawn = run();
    assert!(drawn.status.success(), "{}", said(&drawn));
    let picture = impasto_frame_files::frame_reader::read(&folder.path().join("a.png")).expect("a picture");
    assert!(
        picture.rgba.chunks_exact(4).all(|pixel| pixel == [255, 0, 0, 255]),
        "the folder's shader was not used"
    );
}
