//! `impasto strokes`: the strokes of a frame as they are drawn, read back from the GPU.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use impasto_core::color::srgb_from_linear;
use impasto_gl_render::ResolvedStroke;
use impasto_painting::frame::{LayerRun, Stroke, StrokeSource};
use impasto_painting::{Frame, FrameOptions, Painting};
use serde::Serialize;

use crate::args::{StrokeFormat, StrokesArguments};
use crate::failure::Failure;
use crate::{output, picture_file, session};

/// One line of the table. Pixels from the lower left, Y up; angles counter-clockwise from +X.
#[derive(Debug, Serialize)]
struct Row<'a> {
    id: u32,
    object: &'a str,
    region: &'a str,
    layer: &'static str,
    x_px: f32,
    y_px: f32,
    depth: f32,
    angle_deg: f64,
    length_px: f32,
    width_px: f32,
    alpha: f32,
    kappa: f32,
    r: f32,
    g: f32,
    b: f32,
    facing: f32,
    rank: f32,
}

const HEADER: &str =
    "id,object,region,layer,x_px,y_px,depth,angle_deg,length_px,width_px,alpha,kappa,r,g,b,facing,rank";

/// What regions are called where none is stated.
const EVERYTHING_ELSE: &str = "everything else";

pub(crate) fn run(arguments: &StrokesArguments) -> Result<(), Failure> {
    let loaded = session::read_scene(&arguments.scene, false)?;
    let inputs = session::inputs(&loaded);
    if arguments.output != "-" {
        output::not_an_input(Path::new(&arguments.output), &inputs)?;
        output::ready_folder(Path::new(&arguments.output))?;
    }
    let size_px = arguments.size.unwrap_or([loaded.scene.size.0, loaded.scene.size.1]);
    let mut renderer = session::open_renderer(arguments.driver, false)?;
    let painting = session::prepare_scene(loaded, false)?;
    let frame_number = arguments.frame.unwrap_or(painting.scene().timeline.first as f64);
    if !frame_number.is_finite() {
        return Err(Failure::Usage("--frame wants a number".to_owned()));
    }
    let frame = painting.at(frame_number, &FrameOptions::new(size_px));
    renderer.render(&frame)?;
    let resolved = renderer.resolved_strokes();
    let of_run = |run: &LayerRun| (run.first as usize..(run.first + run.count) as usize, run.kind);
    let rows: Vec<Row<'_>> = frame
        .layers
        .iter()
        .map(of_run)
        .flat_map(|(strokes, kind)| strokes.map(move |index| (index, kind)))
        .map(|(index, kind)| {
            let row = row(&painting, &frame.strokes[index], &frame.sources[index], &resolved[index]);
            Row { layer: kind.name(), ..row }
        })
        .filter(|row| row.alpha > 0.0)
        .collect();
    let text = match arguments.format {
        StrokeFormat::Csv => csv(&rows),
        StrokeFormat::Json => json(&frame, frame_number, &rows),
        StrokeFormat::Svg => svg(&frame, &rows),
    };
    if arguments.output == "-" {
        std::io::stdout().write_all(text.as_bytes())?;
        return Ok(());
    }
    picture_file::whole(Path::new(&arguments.output), |file| Ok(file.write_all(text.as_bytes())?))
        .map_err(|error| Failure::Other(format!("{}: {error}", arguments.output)))
}

fn row<'a>(
    painting: &'a Painting,
    stroke: &Stroke,
    source: &StrokeSource,
    resolved: &ResolvedStroke,
) -> Row<'a> {
    let scene = painting.scene();
    let [r, g, b] = resolved.color_linear.map(srgb_from_linear);
    Row {
        id: source.particle,
        object: &scene.objects[stroke.body_id as usize - 1].name,
        region: scene
            .regions
            .get(source.region as usize)
            .map_or(EVERYTHING_ELSE, |region| region.name.as_str()),
        layer: "",
        x_px: resolved.center_px[0],
        y_px: resolved.center_px[1],
        depth: stroke.depth,
        angle_deg: f64::from(stroke.angle_rad).to_degrees(),
        length_px: stroke.length_px,
        width_px: stroke.width_px,
        alpha: resolved.alpha,
        kappa: source.kappa,
        r,
        g,
        b,
        facing: source.facing,
        rank: source.rank,
    }
}

/// Quotes a name where CSV needs it (RFC 4180).
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

fn csv(rows: &[Row<'_>]) -> String {
    let mut text = format!("{HEADER}\n");
    for row in rows {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            row.id,
            quoted(row.object),
            quoted(row.region),
            row.layer,
            row.x_px,
            row.y_px,
            row.depth,
            row.angle_deg,
            row.length_px,
            row.width_px,
            row.alpha,
            row.kappa,
            row.r,
            row.g,
            row.b,
            row.facing,
            row.rank
        );
    }
    text
}

fn json(frame: &Frame, frame_number: f64, rows: &[Row<'_>]) -> String {
    let value =
        serde_json::json!({ "version": 1, "frame": frame_number, "size": frame.size_px, "strokes": rows });
    format!("{value}\n")
}

fn svg(frame: &Frame, rows: &[Row<'_>]) -> String {
    let [width, height] = frame.size_px;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for row in rows {
        let [r, g, b] = [row.r, row.g, row.b].map(|channel| (channel * 255.0).round() as u8);
        // SVG counts Y downwards and turns clockwise.
        let (x, y) = (row.x_px, height as f32 - row.y_px);
        let (half_length, half_width) = (row.length_px * 0.5, row.width_px * 0.5);
        let _ = writeln!(
            text,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" rx=\"{half_width:.2}\" transform=\"rotate({:.3} {x:.2} {y:.2})\" fill=\"#{r:02x}{g:02x}{b:02x}\" fill-opacity=\"{:.3}\"/>",
            x - half_length,
            y - half_width,
            row.length_px,
            row.width_px,
            -row.angle_deg,
            row.alpha
        );
    }
    text.push_str("</svg>\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_and_quotes_are_quoted() {
        assert_eq!(quoted("plain"), "plain");
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
