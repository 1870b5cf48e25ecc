//! Cameras and lights, and how they are read.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use crate::cursor::Cursor;
use crate::extensions::LIGHTS;
use crate::finding::{Checked, Findings};

/// A camera. It looks down the −Z of its node, +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The name in the file; empty for none.
    pub name: String,
    /// What it sees, which may be animated.
    pub lens: Lens,
}

/// What a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Things shrink with distance.
    Perspective {
        /// Vertical field of view, in 0..π.
        yfov_rad: f64,
        /// Width over height of the picture that it was made for, if stated.
        aspect: Option<f64>,
        /// Nearest distance that shows, more than 0.
        znear: f64,
        /// Farthest distance that shows, more than `znear`; `None`: infinite.
        zfar: Option<f64>,
    },
    /// Things keep their size.
    Orthographic {
        /// Half the width of what shows.
        xmag: f64,
        /// Half the height of what shows.
        ymag: f64,
        /// Nearest distance that shows, not negative.
        znear: f64,
        /// Farthest distance that shows, more than `znear`.
        zfar: f64,
    },
}

/// A light. It shines down the −Z of its node; the node's scale means nothing for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The name in the file; empty for none.
    pub name: String,
    /// Its kind.
    pub kind: LightKind,
    /// Its numbers, which may be animated.
    pub values: LightValues,
}

/// The kind of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// Parallel, as from the sun: the intensity is in lux.
    Directional,
    /// From a point to all sides: the intensity is in candela.
    Point,
    /// From a point into a cone: the intensity is in candela.
    Spot,
}

/// The numbers of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightValues {
    /// Linear red, green and blue, not negative.
    pub color: [f32; 3],
    /// Lux or candela, not negative.
    pub intensity: f64,
    /// Distance at which a point or spot light ends, metres; `None`: it has no end.
    pub range_m: Option<f64>,
    /// Angle from the axis of a spot light to where it begins to fade, radians; less than `outer_cone_rad` unless one
    /// of the two is animated.
    pub inner_cone_rad: f64,
    /// Angle from the axis of a spot light to where it ends, radians, at most π/2.
    pub outer_cone_rad: f64,
}

pub(crate) fn cameras(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Vec<Camera>> {
    let list = root.list("cameras")?;
    let mut cameras = Vec::new();
    for cursor in list.iter() {
        let camera = camera(&cursor, findings);
        cameras.extend(findings.take(camera));
        if findings.is_full() {
            break;
        }
    }
    Ok(cameras)
}

fn camera(cursor: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Camera> {
    let name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
    let kind = cursor.required("type")?;
    let lens = match kind.text()? {
        "perspective" => perspective(&cursor.required("perspective")?, findings)?,
        "orthographic" => orthographic(&cursor.required("orthographic")?)?,
        _ => return Err(kind.error("the camera is neither perspective nor orthographic")),
    };
    if cursor.member("perspective").is_some() && cursor.member("orthographic").is_some() {
        findings.add(cursor.warning("the camera states both lenses: that of its type is used", ""));
    }
    Ok(Camera { name, lens })
}

fn perspective(cursor: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Lens> {
    let yfov = cursor.required("yfov")?;
    let mut yfov_rad = positive(&yfov)?;
    if yfov_rad >= PI {
        findings.add(
            yfov.warning(format!("a field of view of {yfov_rad} rad is wider than a picture can be"), ""),
        );
        yfov_rad = PI - 1e-4;
    }
    let aspect = cursor.member("aspectRatio").map(|member| positive(&member)).transpose()?;
    let znear = positive(&cursor.required("znear")?)?;
    let mut zfar = cursor.member("zfar").map(|member| positive(&member)).transpose()?;
    if zfar.is_some_and(|zfar| zfar <= znear) {
        findings.add(cursor.warning("\"zfar\" is not beyond \"znear\", and is left out", ""));
        zfar = None;
    }
    Ok(Lens::Perspective { yfov_rad, aspect, znear, zfar })
}

fn orthographic(cursor: &Cursor<'_, '_>) -> Checked<Lens> {
    let magnification = |name| {
        let member = cursor.required(name)?;
        let number = member.number()?;
        if number == 0.0 {
            Err(member.error("the camera shows nothing: its size is 0"))
        } else {
            Ok(number.abs())
        }
    };
    let near = cursor.required("znear")?;
    let znear = near.number()?;
    if znear < 0.0 {
        return Err(near.error("a negative distance"));
    }
    let far = cursor.required("zfar")?;
    let zfar = far.number()?;
    if zfar <= znear {
        return Err(far.error("\"zfar\" is not beyond \"znear\""));
    }
    Ok(Lens::Orthographic { xmag: magnification("xmag")?, ymag: magnification("ymag")?, znear, zfar })
}

fn positive(member: &Cursor<'_, '_>) -> Checked<f64> {
    let number = member.number()?;
    if number > 0.0 { Ok(number) } else { Err(member.error(format!("{number} is not more than 0"))) }
}

/// Reads the lights of KHR_lights_punctual.
pub(crate) fn lights(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Vec<Light>> {
    let Some(extensions) = root.object("extensions")? else { return Ok(Vec::new()) };
    let Some(extension) = extensions.object(LIGHTS)? else { return Ok(Vec::new()) };
    let list = extension.required("lights")?.checked_list()?;
    let mut lights = Vec::new();
    for cursor in list.iter() {
        let light = light(&cursor, findings);
        lights.extend(findings.take(light));
        if findings.is_full() {
            break;
        }
    }
    Ok(lights)
}

fn light(cursor: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Light> {
    let name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
    let type_cursor = cursor.required("type")?;
    let kind = match type_cursor.text()? {
        "directional" => LightKind::Directional,
        "point" => LightKind::Point,
        "spot" => LightKind::Spot,
        _ => return Err(type_cursor.error("the light is none of directional, point and spot")),
    };
    let mut color = cursor.numbers_or("color", [1.0; 3])?.map(|channel| channel as f32);
    let mut intensity = cursor.number_or("intensity", 1.0)?;
    if intensity < 0.0 || color.iter().any(|&channel| channel < 0.0) {
        findings.add(cursor.warning("a light takes no light away: what is negative is taken as 0", ""));
        intensity = intensity.max(0.0);
        color = color.map(|channel| channel.max(0.0));
    }
    let mut range_m = cursor.member("range").map(|range| positive(&range)).transpose()?;
    if kind == LightKind::Directional {
        range_m = None;
    }
    let (mut inner_cone_rad, mut outer_cone_rad) = (0.0, FRAC_PI_4);
    if kind == LightKind::Spot {
        let spot = cursor.required("spot")?.checked_object()?;
        inner_cone_rad = spot.number_or("innerConeAngle", 0.0)?;
        outer_cone_rad = spot.number_or("outerConeAngle", FRAC_PI_4)?;
        let is_right =
            inner_cone_rad >= 0.0 && inner_cone_rad < outer_cone_rad && outer_cone_rad <= FRAC_PI_2 + 1e-6;
        if !is_right {
            findings.add(spot.warning("the cones are not 0 ≤ inner < outer ≤ π/2, and are clamped", ""));
            outer_cone_rad = outer_cone_rad.clamp(1e-4, FRAC_PI_2);
            inner_cone_rad = inner_cone_rad.clamp(0.0, outer_cone_rad * 0.999);
        }
        outer_cone_rad = outer_cone_rad.min(FRAC_PI_2);
    }
    Ok(Light {
        name,
        kind,
        values: LightValues { color, intensity, range_m, inner_cone_rad, outer_cone_rad },
    })
}
