//! Shipped scenes of each technique, small, as they were looked at and found good, through either driver. `IMPASTO_BLESS=1` writes
//! them anew: look at each.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{BillboardIcon, BillboardSize, LightBillboard, Picture};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::load::{LoadOptions, load};
use impasto_tests::command::root;
use impasto_tests::pictures::renderer;

const SIZE_PX: [u32; 2] = [192, 108];

/// The technique, the scene that shows it, the frame.
const SHOWN: &[(&str, &str, f64)] = &[
    ("sumi_e", "sumi_e_apple", 0.0),
    ("sumi_e", "sumi_e_bamboo", 0.0),
    ("sumi_e", "sumi_e_carp", 0.0),
    ("noise_displace", "noise_displace", 12.0),
    ("noise_displace", "explosion", 30.0),
    ("inverse_bilinear", "meadow", 0.0),
    ("light_billboards", "roll", 7.0),
];

/// Strokes may lie in another order by a rounding; the picture as a whole may not.
const MOST_OFF: f64 = 1.0;

#[test]
fn shipped_scenes_look_as_they_did_on_either_driver() {
    for &(technique, scene, frame) in SHOWN {
        let path = root().join(format!("scenes/{scene}.ron"));
        let loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        let painting = prepare(Arc::new(loaded)).unwrap();
        let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
        let golden = root().join(format!("tests/goldens/{technique}/{scene}.png"));
        for driver in [Driver::Egl, Driver::Osmesa] {
            let mut renderer = renderer(driver);
            if technique == "light_billboards" {
                renderer.set_billboards(&icons());
            }
            let picture = colors(&renderer.render(&frame).unwrap());
            if std::env::var_os("IMPASTO_BLESS").is_some() && driver == Driver::Egl {
                write(&golden, &picture);
            }
            let expected = read(&golden);
            let off: f64 = picture.iter().zip(&expected).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
            let mean = off / expected.len() as f64;
            println!("{scene} {driver:?}: {mean:.3} of 255 from its golden");
            assert!(mean < MOST_OFF, "{scene} {driver:?}: {mean} of 255 from its golden");
        }
    }
}

/// One of each, in a row over the scene.
fn icons() -> Vec<LightBillboard> {
    let all = [BillboardIcon::Sun, BillboardIcon::Point, BillboardIcon::Ambient, BillboardIcon::Ring];
    let icon = |(index, icon): (usize, BillboardIcon)| LightBillboard {
        position: Vec3::new(index as f32 * 0.6 - 0.9, 0.4, 0.8),
        icon,
        size: BillboardSize::Pixels(11.0),
        ink: [1.0, 0.85, 0.5, 1.0],
    };
    all.into_iter().enumerate().map(icon).collect()
}

fn colors(picture: &Picture) -> Vec<u8> {
    picture.rgba8.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect()
}

fn read(path: &PathBuf) -> Vec<u8> {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(([info.width, info.height], info.color_type), (SIZE_PX, png::ColorType::Rgb));
    bytes
}

fn write(path: &PathBuf, colors: &[u8]) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), SIZE_PX[0], SIZE_PX[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header().unwrap().write_image_data(colors).unwrap();
}
