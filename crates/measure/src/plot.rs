//! Draws line charts of measured values over the frames of a shot, as SVG.

use std::fmt::Write as _;

use crate::report::{MeasureReport, Series};

const WIDTH: f64 = 720.0;
const CHART_HEIGHT: f64 = 190.0;
const HEAD: f64 = 34.0;

/// The edges of a chart's drawing area, from the left and the top of the chart, which is [`CHART_HEIGHT`] high.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 696.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 146.0;

/// About how many labels an axis has.
const TICKS: f64 = 4.0;

/// The series of a report, one chart under the other, as SVG.
pub fn svg(report: &MeasureReport) -> String {
    let charts: Vec<&Series> = report.series.iter().filter(|series| !series.points.is_empty()).collect();
    let height = HEAD + CHART_HEIGHT * charts.len().max(1) as f64;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{LEFT}\" y=\"22\" font-size=\"14\" font-weight=\"bold\">{}</text>\n",
        escaped(&report.scene)
    );
    if charts.is_empty() {
        let _ = writeln!(
            text,
            "<text x=\"{LEFT}\" y=\"{}\">nothing changes over the frames of this shot</text>",
            HEAD + 40.0
        );
    }
    for (index, series) in charts.iter().enumerate() {
        let _ = writeln!(text, "<g transform=\"translate(0 {})\">", HEAD + CHART_HEIGHT * index as f64);
        chart(&mut text, series);
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text
}

fn chart(text: &mut String, series: &Series) {
    let (first, last) = (series.points[0].0, series.points[series.points.len() - 1].0);
    let frames = if last > first { [first, last] } else { [first - 0.5, first + 0.5] };
    let largest = series
        .points
        .iter()
        .map(|point| point.1)
        .filter(|value| value.is_finite())
        .fold(series.target, f64::max);
    let step = round_step(if largest > 0.0 { largest } else { 1.0 });
    let top = step * (largest / step).ceil().max(1.0);
    let x = |frame: f64| LEFT + (frame - frames[0]) / (frames[1] - frames[0]) * (RIGHT - LEFT);
    let y = |value: f64| BOTTOM - value / top * (BOTTOM - TOP);
    let unit = if series.unit.is_empty() { String::new() } else { format!(" ({})", series.unit) };
    let title = format!("{} {}{unit}", series.metric, series.title);
    let _ = writeln!(text, "<text x=\"{LEFT}\" y=\"18\" font-weight=\"bold\">{}</text>", escaped(&title));
    let lines = (top / step).round() as usize;
    for line in 0..=lines {
        let value = step * line as f64;
        let at = y(value);
        let _ = writeln!(text, "<path d=\"M{LEFT} {at:.1}H{RIGHT}\" stroke=\"#ddd\"/>");
        let _ = writeln!(
            text,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            at + 4.0,
            label(value, step)
        );
    }
    let frame_step = round_step(frames[1] - frames[0]).max(1.0);
    let mut frame = (frames[0] / frame_step).ceil() * frame_step;
    while frame <= frames[1] {
        let at = x(frame);
        let _ = writeln!(text, "<path d=\"M{at:.1} {BOTTOM}v5\" stroke=\"#666\"/>");
        let _ = writeln!(
            text,
            "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            BOTTOM + 19.0,
            label(frame, frame_step)
        );
        frame += frame_step;
    }
    let _ = writeln!(text, "<path d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" stroke=\"#666\"/>");
    let _ = writeln!(text, "<text x=\"{RIGHT}\" y=\"{}\" text-anchor=\"end\">frame</text>", BOTTOM + 34.0);
    let at = y(series.target);
    let _ =
        writeln!(text, "<path d=\"M{LEFT} {at:.1}H{RIGHT}\" stroke=\"#b3262a\" stroke-dasharray=\"5 4\"/>");
    let _ = writeln!(
        text,
        "<text x=\"{RIGHT}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#b3262a\">target</text>",
        at - 4.0
    );
    let places: Vec<(f64, f64)> = series
        .points
        .iter()
        .filter(|point| point.1.is_finite())
        .map(|&(frame, value)| (x(frame), y(value)))
        .collect();
    let line: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        text,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.6\"/>",
        line.join(" ")
    );
    for (x, y) in places {
        let _ = writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"#1f5fa8\"/>");
    }
}

/// A step that divides a length into about [`TICKS`] parts: 1, 2 or 5 times a power of ten.
fn round_step(length: f64) -> f64 {
    let raw = (length / TICKS).max(f64::MIN_POSITIVE);
    let power = 10f64.powf(raw.log10().floor());
    let factor =
        [1.0, 2.0, 5.0].into_iter().find(|factor| raw <= factor * power * (1.0 + 1e-9)).unwrap_or(10.0);
    factor * power
}

/// A number with as many digits as the step of its axis needs.
fn label(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.digits$}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Metric;

    #[test]
    fn a_chart_has_its_points_axes_and_unit() {
        let series = Series {
            metric: Metric::M4,
            title: "strokes that pop",
            target: 0.1,
            unit: "% of area",
            points: vec![(0.0, 0.0), (10.0, 0.3), (20.0, 0.1)],
        };
        let report = MeasureReport {
            scene: "a<b>.ron".to_owned(),
            driver: String::new(),
            size_px: [4, 2],
            seconds: 0.0,
            rows: Vec::new(),
            series: vec![series],
            warnings: Vec::new(),
        };
        let text = svg(&report);
        assert!(text.contains("M4 strokes that pop (% of area)") && text.contains("a&lt;b&gt;.ron"));
        assert_eq!(text.matches("<circle").count(), 3);
        assert!(text.contains(">20</text>") && text.contains(">0.3</text>"));
        assert!(svg(&MeasureReport { series: Vec::new(), ..report }).contains("nothing changes"));
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([round_step(1.0), round_step(40.0), round_step(0.07)], [0.5, 10.0, 0.02]);
        assert_eq!(label(0.04, 0.02), "0.04");
    }
}
