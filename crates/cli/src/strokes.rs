//! `impasto strokes`: the strokes of a frame as they are drawn, read back from the GPU.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use impasto_core::angle::wrap_pi;
use impasto_core::color::srgb_from_linear;
use impasto_frame_files::{not_an_input, ready_folder};
use impasto_gl_render::ResolvedStroke;
use impasto_painting::frame::{LayerRun, Stroke, StrokeSource};
use impasto_painting::{Frame, FrameOptions, Painting, SeenFrom};
use impasto_scene::whole_file;
use impasto_sequence::{Wanted, fits_in_memory};
use serde::Serialize;

use crate::args::{StrokeFormat, StrokesArguments};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::session::{self, Prepared};
use crate::talk::Loudness;

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
    taper: f32,
    bend_deg: f32,
    /// How far the ends of the stroke are bowed to the left of its middle: [`Stroke::bow`], negated where the mark is
    /// flipped. For SVG only.
    #[serde(skip)]
    bow: f32,
}

const HEADER: &str = "id,object,region,layer,x_px,y_px,depth,angle_deg,length_px,width_px,alpha,kappa,r,g,b,facing,rank,taper,bend_deg";

/// The region name of strokes that belong to no region.
const EVERYTHING_ELSE: &str = "everything else";

pub(crate) fn run(arguments: &StrokesArguments) -> Result<(), Failure> {
    let interrupt = Interrupt::watch()?;
    let loaded = session::read_scene(&arguments.scene, false)?;
    let inputs = loaded.inputs();
    if arguments.output != "-" {
        not_an_input(Path::new(&arguments.output), &inputs)?;
        ready_folder(Path::new(&arguments.output))?;
    }
    let size_px = arguments.size.unwrap_or([loaded.scene.size.0, loaded.scene.size.1]);
    let mut renderer = session::open_renderer(arguments.driver, false)?;
    fits_in_memory(&loaded.scene, Wanted::default(), size_px, &renderer)
        .map_err(|why| Failure::Refused(format!("{why}: make it smaller with --size")))?;
    let seen_from = SeenFrom::for_options(&loaded.scene, &FrameOptions::new(size_px));
    let Prepared { painting, storing } = session::prepare_scene(
        loaded,
        &arguments.scene,
        session::for_pictures(seen_from),
        Loudness::Warnings,
    )?;
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
    } else {
        interrupt.hold_off();
        let path = Path::new(&arguments.output);
        whole_file::write(path, text.as_bytes()).map_err(|error| Failure::of_file(path, error))?;
    }
    drop(storing);
    painting.fault_words().map_or(Ok(()), |fault| Err(Failure::Other(fault)))
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
        angle_deg: wrap_pi(f64::from(stroke.angle_rad + resolved.turned_rad)).to_degrees(),
        length_px: stroke.length_px,
        width_px: stroke.width_px,
        alpha: resolved.alpha,
        kappa: source.kappa,
        r,
        g,
        b,
        facing: source.facing,
        rank: source.rank,
        taper: stroke.taper,
        bend_deg: stroke.bend_rad.to_degrees(),
        bow: if stroke.mark & Stroke::FLIPPED == 0 { stroke.bow } else { -stroke.bow },
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
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
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
            row.rank,
            row.taper,
            row.bend_deg
        );
    }
    text
}

fn json(frame: &Frame, frame_number: f64, rows: &[Row<'_>]) -> String {
    let value =
        serde_json::json!({ "version": 1, "frame": frame_number, "size": frame.size_px, "strokes": rows });
    format!("{value}\n")
}

/// The strokes as paths in painting order, for a plotter or a vector editor.
fn svg(frame: &Frame, rows: &[Row<'_>]) -> String {
    let [width, height] = frame.size_px;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    if let Some(background) = frame.background {
        let tone = frame.finish.ground.map_or(background, |ground| ground.color);
        let _ = writeln!(
            text,
            "<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>",
            hex(tone.map(srgb_from_linear))
        );
    }
    let mut layer = "";
    // A layer may occur more than once, but an id must not.
    let mut times = BTreeMap::<&str, usize>::new();
    for row in rows {
        if row.layer != layer {
            if !layer.is_empty() {
                text.push_str("</g>\n");
            }
            layer = row.layer;
            let count = times.entry(layer).or_default();
            *count += 1;
            let again = if *count > 1 { format!("-{count}") } else { String::new() };
            let _ = writeln!(text, "<g id=\"{layer}{again}\">");
        }
        // SVG counts Y downwards and turns clockwise.
        let _ = writeln!(
            text,
            "<path d=\"{}\" transform=\"translate({:.2} {:.2}) rotate({:.3})\" fill=\"{}\" fill-opacity=\"{:.3}\"/>",
            outline(row),
            row.x_px,
            height as f32 - row.y_px,
            -row.angle_deg,
            hex([row.r, row.g, row.b]),
            row.alpha
        );
    }
    if !layer.is_empty() {
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text
}

fn hex(color: [f32; 3]) -> String {
    let [r, g, b] = color.map(|channel| (channel * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The outline of a stroke that lies along +X with its centre at the origin: blunt at its start, narrow and round at
/// its end, bowed, then tapered and bent.
fn outline(row: &Row<'_>) -> String {
    let (l, w) = (row.length_px * 0.5, row.width_px * 0.5);
    // This is how the shader shifts the mark. The stroke's left is up, which is negative in SVG.
    let bow_px = -row.bow * w;
    let shifted = |x: f32| bow_px * (0.176 * (x / l).powi(2) - 0.06);
    // How far the curve's handles are shifted, so that the curve passes through the shifted middle.
    let handle = (8.0 * shifted(0.0) - shifted(0.92 * l) - shifted(0.8 * l)) / 6.0;
    let (upper, lower) = (handle - w, handle + w);
    let at = |x: f32, y: f32| {
        let is_handle = x.abs() == 0.4 * l;
        let [x, y] = bent(row, [x, if is_handle { y } else { y + shifted(x) }]);
        if y == 0.0 { format!("{x:.2} 0") } else { format!("{x:.2} {y:.2}") }
    };
    let start = at(-0.92 * l, -w);
    format!(
        "M{start}C{} {} {}Q{} {}Q{} {}C{} {} {}Q{} {start}Z",
        at(-0.4 * l, upper),
        at(0.4 * l, upper),
        at(0.8 * l, -0.8 * w),
        at(l, -0.55 * w),
        at(l, 0.0),
        at(l, 0.55 * w),
        at(0.8 * l, 0.8 * w),
        at(0.4 * l, lower),
        at(-0.4 * l, lower),
        at(-0.92 * l, w),
        at(-1.04 * l, 0.0),
    )
}

/// Where a point of a straight stroke of even width goes when the stroke is tapered and bent; Y down.
fn bent(row: &Row<'_>, [x, y]: [f32; 2]) -> [f32; 2] {
    let y = y * (1.0 - row.taper * 2.0 * x / row.length_px);
    if row.bend_deg == 0.0 {
        return [x, y];
    }
    let radius_px = row.length_px / row.bend_deg.to_radians();
    let (sin, cos) = (x / radius_px).sin_cos();
    [(radius_px + y) * sin, y * cos - radius_px * (1.0 - cos)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_and_quotes_are_quoted() {
        assert_eq!(quoted("plain"), "plain");
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
    }

    #[test]
    fn an_outline_is_tapered_and_bends_to_the_left() {
        let row = |taper: f32, bend_deg: f32| Row {
            id: 0,
            object: "",
            region: "",
            layer: "",
            x_px: 0.0,
            y_px: 0.0,
            depth: 1.0,
            angle_deg: 0.0,
            length_px: 100.0,
            width_px: 10.0,
            alpha: 1.0,
            kappa: 1.0,
            r: 0.0,
            g: 0.0,
            b: 0.0,
            facing: 1.0,
            rank: 0.5,
            taper,
            bend_deg,
            bow: 0.0,
        };
        assert_eq!(bent(&row(0.0, 0.0), [30.0, 4.0]), [30.0, 4.0]);
        // The bow is 2 half widths, which is 10 px. The end lies 0.116 of the bow to the left, which is up.
        let bowed = outline(&Row { bow: 2.0, ..row(0.0, 0.0) });
        assert!(bowed.contains("50.00 -1.16"), "{bowed}");
        assert_eq!(bent(&row(1.0, 0.0), [50.0, 4.0]), [50.0, 0.0]);
        assert_eq!(bent(&row(1.0, 0.0), [-50.0, 4.0]), [-50.0, 8.0]);
        // An eighth of a circle of this radius. It bends to the left, which is up: negative Y.
        let radius = 100.0 / std::f32::consts::FRAC_PI_2;
        let [x, y] = bent(&row(0.0, 90.0), [50.0, 0.0]);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        assert!((x - radius * half).abs() < 1e-3 && (y + radius * (1.0 - half)).abs() < 1e-3, "{x} {y}");
    }

    /// The columns of the CSV are listed by hand, so each field has a different value here.
    #[test]
    fn a_column_holds_what_the_field_of_that_name_does() {
        let row = Row {
            id: 1,
            object: "an apple",
            region: "red, or not",
            layer: "body",
            x_px: 2.0,
            y_px: 3.0,
            depth: 4.0,
            angle_deg: 5.0,
            length_px: 6.0,
            width_px: 7.0,
            alpha: 8.0,
            kappa: 9.0,
            r: 10.0,
            g: 11.0,
            b: 12.0,
            facing: 13.0,
            rank: 14.0,
            taper: 15.0,
            bend_deg: 16.0,
            bow: 17.0,
        };
        let fields = serde_json::to_value(&row).expect("a row is JSON");
        let text = csv(&[row]).replace("\"red, or not\"", "red; or not");
        let [names, values] = [0, 1].map(|line| text.lines().nth(line).unwrap_or_default().split(','));
        let columns: Vec<(&str, String)> =
            names.zip(values).map(|(name, value)| (name, value.replace(';', ","))).collect();
        assert_eq!(columns.len(), fields.as_object().map_or(0, serde_json::Map::len));
        for (name, value) in columns {
            let field = &fields[name];
            let same = match field.as_f64() {
                Some(number) => value.parse() == Ok(number),
                None => field.as_str() == Some(&value),
            };
            assert!(same, "{name}: {value} beside {field}");
        }
    }
}
