//! `impasto relight`: lights the paint of an EXR file anew. It needs no scene and draws nothing: the flat colour of the
//! paint and its normal are enough.

use std::path::Path;

use impasto_core::color::srgb_from_linear;
use impasto_frame_files::exr_file::{self, Planes};
use impasto_frame_files::picture_file::{self, Pixels, Provenance};
use impasto_frame_files::{not_an_input, ready_folder};

use crate::args::RelightArguments;
use crate::failure::Failure;

/// The channels that are read: the paint's colour before light falls on it, and its normal.
const CHANNELS: [&str; 7] = [
    "paint.color.R",
    "paint.color.G",
    "paint.color.B",
    "paint.color.A",
    "paint.normal.X",
    "paint.normal.Y",
    "paint.normal.Z",
];

pub(crate) fn run(arguments: &RelightArguments) -> Result<(), Failure> {
    let output = Path::new(&arguments.output);
    if !arguments.output.to_lowercase().ends_with(".png") {
        return Err(Failure::Usage(format!("-o {}: let the name end in .png", arguments.output)));
    }
    not_an_input(output, std::slice::from_ref(&arguments.frame))?;
    let planes = exr_file::read(&arguments.frame, &CHANNELS).map_err(|fault| {
        Failure::Other(format!(
            "{}: {fault}; render it with --aov paint.color,paint.normal",
            arguments.frame.display()
        ))
    })?;
    ready_folder(output)?;
    let rgba8 = relit(&planes, arguments.light);
    let name = arguments.frame.file_name().map(|name| name.to_string_lossy().into_owned());
    let provenance = Provenance {
        scene: name.unwrap_or_default(),
        state: String::new(),
        frame: "relit".to_owned(),
        driver: "none".to_owned(),
    };
    let pixels = Pixels { size_px: planes.size_px, rgba8: &rgba8 };
    picture_file::write(output, pixels, &provenance).map_err(|error| Failure::of_file(output, error))
}

/// The picture in this light, lit much as `rotating_strokes/finish.frag` lights paint: shading relative to a flat
/// canvas, and a small highlight, but no dark furrows. sRGB with straight alpha, four bytes a pixel.
fn relit(planes: &Planes, light: [f32; 3]) -> Vec<u8> {
    let [r, g, b, a, x, y, z] = [0, 1, 2, 3, 4, 5, 6].map(|index| &planes.values[index]);
    let to_light = unit(light);
    let halfway = unit([to_light[0], to_light[1], to_light[2] + 1.0]);
    let dot = |left: [f32; 3], right: [f32; 3]| left[0] * right[0] + left[1] * right[1] + left[2] * right[2];
    let mut rgba8 = Vec::with_capacity(4 * r.len());
    for index in 0..r.len() {
        let normal = unit([x[index], y[index], z[index]]);
        let shade = (dot(normal, to_light) / to_light[2]).clamp(0.25, 1.9);
        let shine = (dot(normal, halfway).max(0.0).powi(42) - halfway[2].powi(42)).max(0.0);
        let alpha = a[index].clamp(0.0, 1.0);
        let flat = [r[index], g[index], b[index]].map(|value| value / alpha.max(1e-6));
        let value = dot(flat, [0.2126, 0.7152, 0.0722]).clamp(0.0, 1.0);
        for color in flat {
            let lit = color * (1.0 + 0.62 * (shade - 1.0)) + 0.09 * shine * (0.35 + 0.65 * value.sqrt());
            rgba8.push((srgb_from_linear(lit) * 255.0).round() as u8);
        }
        rgba8.push((alpha * 255.0).round() as u8);
    }
    rgba8
}

fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = vector.iter().map(|axis| axis * axis).sum::<f32>().sqrt();
    vector.map(|axis| axis / length.max(1e-6))
}

/// Reads a direction towards a light: three numbers, the last more than 0.
pub(crate) fn direction(text: &str) -> Result<[f32; 3], String> {
    let words = || "write it as X,Y,Z, such as -1,1,1: right, up, towards you; Z is more than 0".to_owned();
    let numbers: Vec<f32> =
        text.split(',').map(|part| part.trim().parse().map_err(|_| words())).collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] if z > 0.0 && [x, y, z].iter().all(|axis| axis.abs() < 1e6) => Ok([x, y, z]),
        _ => Err(words()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planes(normal: [f32; 3]) -> Planes {
        let flat = [0.2, 0.4, 0.1, 1.0];
        let values = flat.into_iter().chain(normal).map(|value| vec![value]).collect();
        Planes { size_px: [1, 1], values }
    }

    #[test]
    fn flat_paint_keeps_its_colour_in_any_light_and_a_slope_turns_lighter_towards_it() {
        let flat = planes([0.0, 0.0, 1.0]);
        let own = [0.2, 0.4, 0.1].map(|value: f32| (srgb_from_linear(value) * 255.0).round() as u8);
        for light in [[-1.0, 1.0, 1.0], [0.3, -0.8, 2.0], [0.0, 0.0, 1.0]] {
            assert_eq!(relit(&flat, light)[..3], own, "{light:?}");
        }
        let slope = planes(unit([0.3, 0.0, 1.0]));
        assert!(relit(&slope, [1.0, 0.0, 1.0])[1] > own[1] + 10);
        assert!(relit(&slope, [-1.0, 0.0, 1.0])[1] < own[1] - 10);
    }

    #[test]
    fn a_light_is_three_numbers_and_stands_before_the_picture() {
        assert_eq!(direction("-1, 2,0.5"), Ok([-1.0, 2.0, 0.5]));
        for wrong in ["1,2", "1,2,3,4", "a,b,c", "1,1,0", "1,1,-1", "nan,1,1", "1,inf,1"] {
            assert!(direction(wrong).unwrap_err().contains("X,Y,Z"), "{wrong}");
        }
    }
}
