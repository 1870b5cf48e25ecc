//! Tests that a picture is the same however little of its data a renderer keeps (of huge pictures it keeps less).

use impasto_gl_render::context::Driver;
use impasto_gl_render::{Keeps, Renderer};
use impasto_painting::{Frame, FrameOptions};
use impasto_scene::document::Style;
use impasto_tests::pictures::renderer;
use impasto_tests::scenes::painting_with;

const SIZES_PX: [[u32; 2]; 2] = [[160, 91], [121, 70]];

/// The data of a picture that can be read back in any case, however little was kept.
#[derive(PartialEq)]
struct Told {
    rgba8: Vec<u8>,
    linear: Vec<[f32; 4]>,
    depth: Vec<f32>,
    body_id: Vec<u32>,
}

fn told(renderer: &mut Renderer, frame: &Frame, keeps: Keeps) -> Told {
    renderer.keep(keeps);
    let picture = renderer.render(frame).unwrap();
    let reference = renderer.read_reference();
    Told {
        rgba8: picture.rgba8,
        linear: renderer.read_linear(),
        depth: reference.depth,
        body_id: reference.body_id,
    }
}

#[test]
fn a_picture_is_the_same_whatever_is_kept_of_it() {
    let mut renderer = renderer(Driver::Egl);
    let few =
        |name: &str, object: usize| painting_with(name, &[(&format!("objects[{object}].particles"), "2000")]);
    let simple = few("simple_objects", 1);
    let paintings =
        [few("sumi_e_apple", 0), few("noise_displace", 0), simple.in_style(Style::Reference), simple.clone()];
    for painting in &paintings {
        for size_px in SIZES_PX {
            let frame = painting.at(0.0, &FrameOptions::new(size_px));
            let whole = told(&mut renderer, &frame, Keeps::Everything);
            assert!(whole.body_id.iter().any(|&id| id > 0));
            for keeps in [Keeps::Picture, Keeps::Surfaces, Keeps::Picture, Keeps::Everything] {
                let name = painting.scene().style.info().name;
                assert!(told(&mut renderer, &frame, keeps) == whole, "{name}, {keeps:?}, {size_px:?}");
            }
        }
    }
}

#[test]
fn surfaces_are_told_where_they_are_kept_and_missing_where_not() {
    let mut renderer = renderer(Driver::Egl);
    let painting = painting_with("simple_objects", &[("objects[1].particles", "2000")]);
    let frame = painting.at(0.0, &FrameOptions::new(SIZES_PX[0]));
    told(&mut renderer, &frame, Keeps::Everything);
    let whole = renderer.read_surfaces(&frame).unwrap();
    assert!(!renderer.read_paint().is_empty());
    told(&mut renderer, &frame, Keeps::Surfaces);
    assert!(renderer.read_surfaces(&frame).unwrap() == whole);
    assert!(renderer.read_paint().is_empty());
    told(&mut renderer, &frame, Keeps::Picture);
    let missing = renderer.read_surfaces(&frame).unwrap_err().to_string();
    assert!(missing.contains("surfaces of the last picture"), "{missing}");
}

#[test]
fn what_one_renderer_drew_is_read_after_another_has_drawn() {
    let few = |name: &str| painting_with(name, &[("objects[0].particles", "2000")]);
    let [apple, noise] = ["sumi_e_apple", "noise_displace"]
        .map(|name| few(name).in_style(Style::Reference).at(0.0, &FrameOptions::new(SIZES_PX[0])));
    let [mut first, mut other] = [renderer(Driver::Egl), renderer(Driver::Egl)];
    let drawn = told(&mut first, &apple, Keeps::Everything);
    assert!(told(&mut other, &noise, Keeps::Everything).depth != drawn.depth);
    let again = first.read_reference();
    assert!(again.depth == drawn.depth && again.body_id == drawn.body_id);
}

#[test]
fn only_huge_pictures_are_kept_in_part() {
    assert_eq!(Keeps::of_size([4096, 4096], false), Keeps::Everything);
    assert_eq!(Keeps::of_size([7680, 4320], false), Keeps::Picture);
    assert_eq!(Keeps::of_size([7680, 4320], true), Keeps::Surfaces);
}
