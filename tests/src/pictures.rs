//! Draws frames for tests, and measures what was drawn.

use std::path::Path;

use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_gl_render::shader_folder::ShaderFolder;
use impasto_gl_render::{Picture, Renderer, ShaderTexts};

use crate::command::root;

/// The environment variable that names a folder of shader files. They replace the program's own. `cargo xtask faults`
/// plants faults that way.
const PLANTED: &str = "IMPASTO_PLANTED_SHADERS";

/// A renderer that panics when the driver reports an error.
///
/// # Panics
/// When the driver is missing. `cargo xtask test` installs EGL and, where the system still offers it, OSMesa.
pub fn renderer(driver: Driver) -> Renderer {
    let context = open(driver, &OpenOptions { debug: true }).unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(context).unwrap_or_else(|error| panic!("{error}"));
    if let Some(folder) = std::env::var_os(PLANTED) {
        let (_, texts) = ShaderFolder::open(Path::new(&folder)).unwrap_or_else(|error| panic!("{error}"));
        renderer.replace_shaders(&texts).unwrap_or_else(|error| panic!("{error}"));
    }
    renderer
}

/// A renderer with a fault planted in a shader file: `from` is replaced by `to`.
///
/// # Panics
/// When `from` is not in the file, or the faulty shader does not compile.
pub fn faulty_renderer(path: &str, from: &str, to: &str) -> Renderer {
    let text =
        std::fs::read_to_string(root().join("crates/gl-render/shaders").join(path)).expect("a shader file");
    assert!(text.contains(from), "{path} has no `{from}`");
    let mut texts = ShaderTexts::default();
    assert!(texts.put(path, text.replace(from, to)));
    let mut renderer = renderer(Driver::Egl);
    renderer.replace_shaders(&texts).unwrap_or_else(|error| panic!("{error}"));
    renderer
}

/// One number per pixel, top row first.
#[derive(Clone, Debug)]
pub struct Grey {
    /// Width and height in pixels.
    pub size_px: [usize; 2],
    /// Row by row.
    pub values: Vec<f64>,
}

impl Grey {
    /// Mean of the three channels, 0..255.
    pub fn of(picture: &Picture) -> Self {
        let values =
            picture.rgba8.chunks_exact(4).map(|p| p[..3].iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0);
        Self { size_px: picture.size_px.map(|side| side as usize), values: values.collect() }
    }

    /// The value of a pixel.
    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.values[y * self.size_px[0] + x]
    }

    /// Second moment of the gradient at a pixel, `(Jxx − Jyy) + 2i Jxy`, by Scharr's derivative. As a complex number it
    /// has twice the gradient's angle (Y up).
    pub fn double_angle(&self, x: usize, y: usize) -> (f64, f64) {
        let d = |dx: i32, dy: i32| self.at((x as i32 + dx) as usize, (y as i32 + dy) as usize);
        let gx = 3.0 * (d(1, -1) - d(-1, -1)) + 10.0 * (d(1, 0) - d(-1, 0)) + 3.0 * (d(1, 1) - d(-1, 1));
        let gy = 3.0 * (d(-1, -1) - d(-1, 1)) + 10.0 * (d(0, -1) - d(0, 1)) + 3.0 * (d(1, -1) - d(1, 1));
        (gx * gx - gy * gy, 2.0 * gx * gy)
    }

    /// [`Self::double_angle`] at every pixel, blurred by a Gaussian with the standard deviation `sigma_px`. Pixels
    /// outside the mask count as zero before the blur; the mask must leave out the outermost pixels of the picture.
    pub fn tensor_field(&self, mask: &[bool], sigma_px: f64) -> Vec<(f64, f64)> {
        let width = self.size_px[0];
        let moments = mask.iter().enumerate().map(|(index, &known)| {
            if known { self.double_angle(index % width, index / width) } else { (0.0, 0.0) }
        });
        let (real, imaginary): (Vec<f64>, Vec<f64>) = moments.unzip();
        let [real, imaginary] =
            [real, imaginary].map(|values| Self { size_px: self.size_px, values }.blurred(sigma_px).values);
        real.into_iter().zip(imaginary).collect()
    }

    /// The direction of the streaks in the whole picture, radians in (−π/2, π/2], Y up: across the mean gradient.
    pub fn streak_angle_rad(&self) -> f64 {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for y in 1..self.size_px[1] - 1 {
            for x in 1..self.size_px[0] - 1 {
                let (re, im) = self.double_angle(x, y);
                real += re;
                imaginary += im;
            }
        }
        wrap_half(0.5 * imaginary.atan2(real) + std::f64::consts::FRAC_PI_2)
    }

    /// Convolved with a Gaussian of the standard deviation `sigma_px`; the picture's edge is repeated outwards.
    pub fn blurred(&self, sigma_px: f64) -> Self {
        let reach = (3.0 * sigma_px).ceil() as i64;
        let weights: Vec<f64> =
            (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma_px).powi(2)).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let pass = |from: &Self, dx: i64, dy: i64| {
            let [width, height] = from.size_px.map(|side| side as i64);
            let value =
                |x: i64, y: i64| from.at(x.clamp(0, width - 1) as usize, y.clamp(0, height - 1) as usize);
            let values = (0..width * height).map(|index| {
                let (x, y) = (index % width, index / width);
                let taps =
                    (-reach..=reach).zip(&weights).map(|(k, weight)| weight * value(x + k * dx, y + k * dy));
                taps.sum::<f64>() / sum
            });
            Self { size_px: from.size_px, values: values.collect() }
        };
        pass(&pass(self, 1, 0), 0, 1)
    }

    /// Bilinear value, with pixel centres at whole coordinates, Y down; `None` where one of the four pixels is missing:
    /// outside the picture, and on its last row and column.
    pub fn sample(&self, x: f64, y: f64) -> Option<f64> {
        let (left, top) = (x.floor(), y.floor());
        let inside = left >= 0.0 && top >= 0.0;
        let (i, j) = (left as usize, top as usize);
        if !inside || i + 1 >= self.size_px[0] || j + 1 >= self.size_px[1] {
            return None;
        }
        let (s, t) = (x - left, y - top);
        let row = |j: usize| self.at(i, j) * (1.0 - s) + self.at(i + 1, j) * s;
        Some(row(j) * (1.0 - t) + row(j + 1) * t)
    }
}

/// Wraps the angle of an undirected line into (−π/2, π/2].
pub fn wrap_half(angle_rad: f64) -> f64 {
    let half_turn = std::f64::consts::PI;
    angle_rad - half_turn * (angle_rad / half_turn - 0.5).ceil()
}
