//! `impasto brushes`: the marks of all brushes on one sheet.

use std::path::Path;

use impasto_core::brush::{self, HEIGHT_SCALE, Mark};
use impasto_frame_files::picture_file::{self, Pixels, Provenance};
use impasto_frame_files::{not_an_input, ready_folder};
use impasto_gl_render::Picture;
use impasto_scene::load::load_brush;

use crate::args::BrushesArguments;
use crate::failure::Failure;

/// Free pixels round each mark.
const GAP_PX: usize = 12;

/// The variant and the dryness of each mark in a row. A texel whose paint (0..1) is below the dryness is left bare.
const COLUMNS: [(usize, f32); 6] = [(0, 0.02), (1, 0.02), (2, 0.02), (3, 0.25), (4, 0.50), (5, 0.75)];

/// Linear colours of the sheet and of the paint, and what half-mixed paint adds where the tint is 1.
const CANVAS: [f32; 3] = [0.72, 0.66, 0.55];
const PAINT: [f32; 3] = [0.10, 0.045, 0.03];
const HALF_MIXED: [f32; 3] = [0.05, 0.028, 0.016];

pub(crate) fn run(arguments: &BrushesArguments) -> Result<(), Failure> {
    let path = Path::new(&arguments.output);
    not_an_input(path, &arguments.pictures)?;
    ready_folder(path)?;
    let mut rows: Vec<(String, Vec<Mark>)> = Vec::new();
    for name in brush::NAMES {
        rows.push((name.to_owned(), brush::marks_of(name).unwrap_or_default()));
    }
    for picture in &arguments.pictures {
        rows.push((picture.display().to_string(), marks_of_picture(picture)?));
    }
    let picture = sheet(&rows);
    let provenance = Provenance {
        scene: "brushes".to_owned(),
        state: String::new(),
        frame: "sheet".to_owned(),
        driver: String::new(),
    };
    let pixels = Pixels { size_px: picture.size_px, rgba8: &picture.rgba8 };
    picture_file::write(path, pixels, &provenance).map_err(|error| Failure::of_file(path, error))?;
    eprintln!("{}, from the top:", path.display());
    for (name, _) in &rows {
        eprintln!("  {name}");
    }
    eprintln!("each as three wet marks, then ever drier ones");
    Ok(())
}

fn marks_of_picture(path: &Path) -> Result<Vec<Mark>, Failure> {
    let picture = load_brush(path)?;
    Ok(brush::marks_of_picture(picture.size_px, &picture.rgba8))
}

fn sheet(rows: &[(String, Vec<Mark>)]) -> Picture {
    let [width, height] = brush::SIZE;
    let size = [COLUMNS.len() * (width + GAP_PX) + GAP_PX, rows.len() * (height + GAP_PX) + GAP_PX];
    let mut pixels = vec![CANVAS; size[0] * size[1]];
    for (row, (_, marks)) in rows.iter().enumerate() {
        for (column, &(variant, dryness)) in COLUMNS.iter().enumerate() {
            let Some(mark) = marks.get(variant) else { continue };
            let (left, top) = (GAP_PX + column * (width + GAP_PX), GAP_PX + row * (height + GAP_PX));
            for y in 0..height {
                for x in 0..width {
                    let at = (top + y) * size[0] + left + x;
                    pixels[at] = painted(mark, [x, y], dryness, pixels[at]);
                }
            }
        }
    }
    let byte = |linear: f32| (impasto_core::color::srgb_from_linear(linear) * 255.0).round() as u8;
    let rgba8 = pixels.iter().flat_map(|&[r, g, b]| [byte(r), byte(g), byte(b), 255]).collect();
    Picture { size_px: size.map(|side| side as u32), rgba8 }
}

/// A texel of a mark, painted over the colour `below` and lit from the upper left.
fn painted(mark: &Mark, [x, y]: [usize; 2], dryness: f32, below: [f32; 3]) -> [f32; 3] {
    let [width, height] = brush::SIZE;
    // The first row of a mark is its lower edge.
    let texel = |x: usize, y: usize| mark.texels[(height - 1 - y.min(height - 1)) * width + x.min(width - 1)];
    let [paint, _, tint] = texel(x, y);
    let alpha = ((f32::from(paint) / 255.0 - dryness) / 0.06).clamp(0.0, 1.0);
    let height_at = |x: usize, y: usize| f32::from(texel(x, y)[1]) / 255.0 * HEIGHT_SCALE;
    let slope = height_at(x + 1, y + 1) - height_at(x.saturating_sub(1), y.saturating_sub(1));
    let shade = (1.0 + 0.9 * slope).clamp(0.4, 2.2);
    let tint = f32::from(tint) / 127.5 - 1.0;
    std::array::from_fn(|channel| {
        let color = (PAINT[channel] + tint * HALF_MIXED[channel]).max(0.0) * shade;
        below[channel] + (color - below[channel]) * alpha
    })
}
