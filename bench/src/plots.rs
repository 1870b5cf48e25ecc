//! Draws the plots of the benchmarks as SVG: cost per particle against the number of particles.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use plotters::prelude::*;

/// The colours of the curves, distinguishable with colour blindness too (Okabe and Ito 2008).
const COLORS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// The plot that a curve belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plot {
    /// Sampling.
    Sampling,
    /// Lists of neighbours.
    Neighbours,
    /// Preparing, the solve alone, and frames.
    Growth,
}

impl Plot {
    const ALL: [Self; 3] = [Self::Growth, Self::Sampling, Self::Neighbours];

    fn file_and_title(self) -> (&'static str, &'static str) {
        match self {
            Self::Sampling => ("sampling.svg", "sampling: nanoseconds per particle"),
            Self::Neighbours => ("neighbours.svg", "lists of neighbours: nanoseconds per particle"),
            Self::Growth => ("growth.svg", "preparing and frames: nanoseconds per particle"),
        }
    }
}

/// Seconds of one step at several counts.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The step.
    pub name: &'static str,
    /// The plot that it is drawn in.
    pub plot: Plot,
    /// Pairs of count and seconds; counts rise.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// Seconds per particle at a measured count.
    pub fn secs_per_particle(&self, count: f64) -> Option<f64> {
        self.points.iter().find(|point| point.0 == count).map(|(count, secs)| secs / count)
    }

    /// The most seconds per particle at any count below this one.
    pub fn most_secs_below(&self, count: f64) -> f64 {
        let below = self.points.iter().filter(|point| point.0 < count);
        below.map(|(count, secs)| secs / count).fold(0.0, f64::max)
    }
}

/// Draws the plots that have curves; returns their files.
///
/// # Errors
/// Where a file cannot be written.
pub fn draw(folder: &Path, curves: &[Curve]) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for plot in Plot::ALL {
        let curves: Vec<&Curve> =
            curves.iter().filter(|curve| curve.plot == plot && !curve.points.is_empty()).collect();
        if !curves.is_empty() {
            let (file, title) = plot.file_and_title();
            let file = folder.join(file);
            draw_one(&file, title, &curves).map_err(|error| anyhow!("{}: {error}", file.display()))?;
            files.push(file);
        }
    }
    Ok(files)
}

fn draw_one(file: &Path, title: &str, curves: &[&Curve]) -> Result<(), Box<dyn std::error::Error>> {
    let nanoseconds = |&(count, secs): &(f64, f64)| (count, secs / count * 1e9);
    let all: Vec<(f64, f64)> = curves.iter().flat_map(|curve| curve.points.iter().map(nanoseconds)).collect();
    let range = |numbers: &mut dyn Iterator<Item = f64>, slack: f64| {
        let (least, greatest) = numbers.fold((f64::INFINITY, 0f64), |(least, greatest), number| {
            (least.min(number), greatest.max(number))
        });
        least / slack..greatest * slack
    };
    let counts = range(&mut all.iter().map(|point| point.0), 1.0);
    let costs = range(&mut all.iter().map(|point| point.1), 2.0);
    let area = SVGBackend::new(file, (900, 560)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(counts.log_scale(), costs.log_scale())?;
    chart
        .configure_mesh()
        .bold_line_style(BLACK.mix(0.2))
        .light_line_style(BLACK.mix(0.06))
        .x_desc("particles")
        .y_desc("ns per particle")
        .x_label_formatter(&|count| format!("{count:.0e}"))
        .y_label_formatter(&|cost| format!("{cost}"))
        .draw()?;
    for (index, curve) in curves.iter().enumerate() {
        let color = COLORS[index % COLORS.len()];
        let points: Vec<(f64, f64)> = curve.points.iter().map(nanoseconds).collect();
        chart
            .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
            .label(curve.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2)));
        chart.draw_series(points.into_iter().map(|point| Circle::new(point, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 14))
        .draw()?;
    area.present()?;
    Ok(())
}
