//! Tests that shipped scenes look as they did: compares small pictures of some techniques, through both drivers, with
//! stored pictures that a person approved. `IMPASTO_BLESS=1` rewrites the stored ones: look at each.

use std::path::PathBuf;

use glam::DVec3;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{BillboardIcon, BillboardSize, LightBillboard, Picture};
use impasto_painting::FrameOptions;
use impasto_tests::command::root;
use impasto_tests::pictures::renderer;
use impasto_tests::scenes;

const SIZE_PX: [u32; 2] = [192, 108];

/// The technique, the scene that shows it, and the frame.
const SHOWN: &[(&str, &str, f64)] = &[
    ("sumi_e", "sumi_e_apple", 0.0),
    ("sumi_e", "sumi_e_bamboo", 0.0),
    ("sumi_e", "sumi_e_carp", 0.0),
    ("noise_displace", "noise_displace", 12.0),
    ("noise_displace", "explosion", 30.0),
    ("inverse_bilinear", "meadow", 0.0),
    ("light_billboards", "roll", 7.0),
];

/// How many pixels may be wrong. Drivers round differently, which changes single pixels; the limit is too small to hide
/// a wrong stroke.
const MOST_WRONG_PIXELS: usize = 20;
/// A pixel is wrong when one of its channels is off by more than this, of 255.
const MOST_OFF: u8 = 16;
/// The mean difference that the whole picture may have, of 255.
const MOST_MEAN_OFF: f64 = 0.2;

#[test]
fn shipped_scenes_look_as_they_did_on_either_driver() {
    let bless = std::env::var_os("IMPASTO_BLESS").is_some();
    let mut renderers = [Driver::Egl, Driver::Osmesa].map(|driver| (driver, renderer(driver)));
    let icons = icons();
    let mut faults = Vec::new();
    for &(technique, scene, frame) in SHOWN {
        let frame = scenes::painting(scene).at(frame, &FrameOptions::new(SIZE_PX));
        let golden = root().join(format!("tests/goldens/{technique}/{scene}.png"));
        for (driver, renderer) in &mut renderers {
            renderer.set_billboards(if technique == "light_billboards" { &icons } else { &[] });
            let picture = colors(&renderer.render(&frame).unwrap());
            if bless && *driver == Driver::Egl {
                write(&golden, &picture);
            }
            let off = Off::of(&picture, &read(&golden));
            println!("{scene} {driver:?}: {off:?}");
            if !off.is_small() {
                faults.push(format!("{scene} {driver:?} is not its golden: {off:?}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// One stroke of 14 × 4 pixels that is off by 24 of 255 is enough to fail.
#[test]
fn a_planted_stroke_fails_the_golden() {
    for &(technique, scene, _) in SHOWN {
        let golden = read(&root().join(format!("tests/goldens/{technique}/{scene}.png")));
        assert!(Off::of(&golden, &golden).is_small(), "{scene}");
        for (left, top) in [(0, 0), (90, 50), (170, 100)] {
            let mut planted = golden.clone();
            for (x, y) in (0..14 * 4).map(|index| (left + index % 14, top + index / 14)) {
                let first = 3 * (y * SIZE_PX[0] as usize + x);
                for channel in &mut planted[first..first + 3] {
                    *channel = if *channel > 128 { *channel - 24 } else { *channel + 24 };
                }
            }
            let off = Off::of(&planted, &golden);
            assert!(!off.is_small(), "{scene}: a stroke planted at {left}, {top} is not noticed: {off:?}");
        }
    }
}

#[derive(Debug)]
struct Off {
    wrong_pixels: usize,
    mean: f64,
}

impl Off {
    fn of(picture: &[u8], golden: &[u8]) -> Self {
        assert_eq!(picture.len(), golden.len());
        let off: Vec<u8> = picture.iter().zip(golden).map(|(a, b)| a.abs_diff(*b)).collect();
        Self {
            wrong_pixels: off.chunks(3).filter(|pixel| pixel.iter().any(|&off| off > MOST_OFF)).count(),
            mean: off.iter().map(|&off| f64::from(off)).sum::<f64>() / off.len() as f64,
        }
    }

    fn is_small(&self) -> bool {
        self.wrong_pixels <= MOST_WRONG_PIXELS && self.mean <= MOST_MEAN_OFF
    }
}

/// One icon of each kind, in a row over the scene.
fn icons() -> Vec<LightBillboard> {
    let all = [BillboardIcon::Sun, BillboardIcon::Point, BillboardIcon::Ambient, BillboardIcon::Ring];
    let icon = |(index, icon): (usize, BillboardIcon)| LightBillboard {
        position: DVec3::new(index as f64 * 0.6 - 0.9, 0.4, 0.8),
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
