//! `impasto doctor`: which drivers work here and draw correctly, and whether a window could be opened.

use std::io::Write as _;
use std::sync::Arc;

use impasto_gl_render::Renderer;
use impasto_gl_render::context::{ContextReport, Driver, OpenOptions, open};
use impasto_painting::frame::{
    Brushes, Finish, Frame, FrameLights, FrameView, LayerKind, LayerRun, Lines, Quality, Stroke,
    StrokeSource, Style,
};
use impasto_system::System;

use crate::args::DoctorArguments;
use crate::failure::Failure;

struct Finding {
    driver: Driver,
    outcome: Result<ContextReport, String>,
}

pub(crate) fn run(arguments: &DoctorArguments) -> Result<(), Failure> {
    let findings: Vec<Finding> = [Driver::Egl, Driver::Osmesa].into_iter().map(examine).collect();
    let system = System::here();
    let mut out = std::io::stdout();
    for finding in &findings {
        let parts = finding.driver.parts();
        if arguments.json {
            writeln!(out, "{}", as_json(finding, &system.packages(parts).join(" ")))?;
            continue;
        }
        match &finding.outcome {
            Ok(report) => {
                writeln!(out, "{}: works, through {}", finding.driver, report.way)?;
                writeln!(out, "  renderer {}, vendor {}", report.renderer, report.vendor)?;
                writeln!(out, "  OpenGL {}, GLSL {}", report.version, report.shading_language)?;
                writeln!(
                    out,
                    "  pictures up to {} pixels a side; the test picture is correct",
                    report.max_side_px
                )?;
            }
            Err(reason) => {
                writeln!(out, "{}: does not work: {reason}", finding.driver)?;
                writeln!(out, "  mend: {}", system.mend(parts))?;
            }
        }
    }
    #[cfg(feature = "editor")]
    print_window(&mut out, system, arguments.json)?;
    if findings.iter().any(|finding| finding.outcome.is_ok()) {
        return Ok(());
    }
    if !arguments.json {
        writeln!(out, "no driver works: nothing can be rendered here")?;
    }
    Err(Failure::Quiet(4))
}

/// Whether the editor could open a window. Rendering needs none, so a missing one does not change the exit code.
#[cfg(feature = "editor")]
fn print_window(out: &mut std::io::Stdout, system: System, json: bool) -> Result<(), Failure> {
    if system == System::NotLinux {
        if !json {
            writeln!(out, "window: not looked into: Impasto was never tried on this system")?;
        }
        return Ok(());
    }
    let found = crate::window_libraries::find();
    if json {
        let (display, packages) = (&found.display, system.packages(&found.missing).join(" "));
        let works = found.could_open();
        writeln!(
            out,
            "{}",
            serde_json::json!({
                "version": 1, "window": works, "display": display, "packages": packages,
            })
        )?;
        return Ok(());
    }
    match &found.display {
        _ if found.could_open() => {
            writeln!(out, "window: could be opened on {}", found.display.unwrap_or_default())?
        }
        None => writeln!(
            out,
            "window: none: neither WAYLAND_DISPLAY nor DISPLAY is set (only `impasto edit` needs it)"
        )?,
        Some(display) => {
            writeln!(
                out,
                "window: none on {display}: libraries are missing (only `impasto edit` needs them)"
            )?;
        }
    }
    if !found.missing.is_empty() {
        writeln!(out, "  mend: {}", system.mend(&found.missing))?;
    }
    Ok(())
}

fn examine(driver: Driver) -> Finding {
    let outcome = open(driver, &OpenOptions::default())
        .map_err(|error| {
            let reasons: Vec<String> =
                error.tried.iter().map(|way| format!("{}: {}", way.way, way.reason)).collect();
            reasons.join("; ")
        })
        .and_then(|context| {
            let report = context.report().clone();
            draws_correctly(context).map(|()| report)
        });
    Finding { driver, outcome }
}

/// Draws one stroke on a background of known colour and looks at the pixels.
fn draws_correctly(context: impasto_gl_render::context::Context) -> Result<(), String> {
    let mut renderer = Renderer::new(context).map_err(|error| error.to_string())?;
    let picture = renderer.render(&test_frame()).map_err(|error| error.to_string())?;
    let pixel = |x: usize, y: usize| -> [u8; 3] {
        let at = (y * 64 + x) * 4;
        [picture.rgba8[at], picture.rgba8[at + 1], picture.rgba8[at + 2]]
    };
    let background_is_blue = pixel(2, 2) == [0, 0, 255];
    // The stroke covers the middle; without a body under it, it is black paint.
    let middle = pixel(32, 32);
    if background_is_blue && middle[2] < 80 {
        Ok(())
    } else {
        Err(format!("the test picture is wrong: background {:?}, stroke {middle:?}", pixel(2, 2)))
    }
}

fn test_frame() -> Frame {
    let view = FrameView {
        origin_in_world: glam::DVec3::ZERO,
        view_from_world: glam::Mat4::from_translation(glam::Vec3::new(0.0, 0.0, -4.0)),
        clip_from_view: glam::camera::rh::proj::opengl::perspective(0.6, 1.0, 0.1, 10.0),
        eye_in_world: glam::Vec3::new(0.0, 0.0, 4.0),
        orthographic: false,
        near_far: [0.1, 10.0],
    };
    let stroke = Stroke {
        center_px: [32.0, 32.0],
        depth: 4.0,
        angle_rad: 0.5,
        length_px: 44.0,
        width_px: 22.0,
        normal_in_world: [0.0, 0.0, 1.0],
        ..Stroke::default()
    };
    let source = StrokeSource { place: 0, particle: 0, region: 0, kappa: 1.0, facing: 1.0, rank: 0.5 };
    Frame {
        size_px: [64, 64],
        px_scale: 1.0,
        view,
        background: Some([0.0, 0.0, 1.0]),
        lights: FrameLights { shadow_bounds: (glam::Vec3::ZERO, 1.0), ..FrameLights::default() },
        bodies: Vec::new(),
        strokes: vec![stroke],
        sources: vec![source],
        layers: vec![LayerRun { order: 0, kind: LayerKind::Body, first: 0, count: 1 }],
        lines: Lines::default(),
        brushes: Arc::new(Brushes::of_names(&["flat"])),
        palettes: Arc::default(),
        finish: Finish::default(),
        style: Style::default(),
        has_highlight_strokes: false,
        quality: Quality::Exact,
        exposure: 1.0,
    }
}

fn as_json(finding: &Finding, packages: &str) -> serde_json::Value {
    match &finding.outcome {
        Ok(report) => serde_json::json!({
            "version": 1, "driver": finding.driver.to_string(), "works": true, "way": report.way,
            "vendor": report.vendor, "renderer": report.renderer, "gl_version": report.version,
            "glsl_version": report.shading_language, "max_side_px": report.max_side_px,
        }),
        Err(reason) => serde_json::json!({
            "version": 1, "driver": finding.driver.to_string(), "works": false, "reason": reason, "packages": packages,
        }),
    }
}
