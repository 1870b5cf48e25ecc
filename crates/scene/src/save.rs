//! Writing a document as a scene file: readable, what is at its default left out, the same bytes every time.

use std::path::Path;

use crate::document::{
    BrushMix, Camera, CameraKey, Color, Ease, Edges, LayerSettings, Lens, Light, MaterialOverride, Object,
    ObjectKey, Reference, RotatingStrokes, Scale, Scene, StrokeSettings, Style, SumiE, Timeline, Up,
};
use crate::whole_file;

mod layout;
mod noise_displace;
mod regions;

use layout::{Fields, Value, number, text};

/// The document as text that [`crate::load::parse`] reads back as an equal document.
///
/// Colours are written with 8 bits a channel, which is all that a scene file can hold.
pub fn to_ron(scene: &Scene) -> String {
    let value = Fields::new()
        .with("version", Value::Word(scene.version.to_string()))
        .with("size", pair(scene.size))
        .unless(scene.seed == 0, "seed", || Value::Word(scene.seed.to_string()))
        .unless(scene.background == Color::default(), "background", || color(scene.background))
        .unless(scene.timeline == Timeline::default(), "timeline", || timeline(&scene.timeline))
        .unless(scene.reference == Reference::default(), "reference", || reference(&scene.reference))
        .unless(scene.further_references.is_empty(), "further_references", || {
            Value::List(scene.further_references.iter().map(reference).collect())
        })
        .with("camera", camera(&scene.camera))
        .unless(scene.lights.is_empty(), "lights", || Value::List(scene.lights.iter().map(light).collect()))
        .with("objects", Value::List(scene.objects.iter().map(object).collect()))
        .unless(scene.strokes == StrokeSettings::default(), "strokes", || strokes(&scene.strokes))
        .unless(scene.regions.is_empty(), "regions", || {
            Value::List(scene.regions.iter().map(regions::region).collect())
        })
        .with("style", style(&scene.style))
        .done();
    format!("#![enable(implicit_some)]\n{}\n", layout::lay_out(&value))
}

/// Writes a scene file so that at any moment, even after a crash, the path holds the old file or the new one, whole.
/// A link is followed: the file that it points to is replaced.
///
/// # Errors
///
/// What the file system said; the old file is then untouched.
pub fn write(path: &Path, scene: &Scene) -> std::io::Result<()> {
    whole_file::write(path, to_ron(scene).as_bytes())
}

fn pair((x, y): (u32, u32)) -> Value {
    Value::Tuple(vec![Value::Word(x.to_string()), Value::Word(y.to_string())])
}

fn vector(values: [f64; 3]) -> Value {
    Value::Tuple(values.map(number).to_vec())
}

fn color(color: Color) -> Value {
    text(&color.to_hex())
}

fn flag(value: bool) -> Value {
    Value::Word(value.to_string())
}

fn word(value: impl std::fmt::Debug) -> Value {
    Value::Word(format!("{value:?}"))
}

fn timeline(timeline: &Timeline) -> Value {
    Fields::new()
        .with("fps", number(timeline.fps))
        .with("first", Value::Word(timeline.first.to_string()))
        .with("last", Value::Word(timeline.last.to_string()))
        .done()
}

fn reference(reference: &Reference) -> Value {
    match reference {
        Reference::Frame(frame) => Value::Word(format!("Frame({frame})")),
        Reference::View { eye, target, roll_deg, fov_y_deg, frame } => Fields::new()
            .with("eye", vector(*eye))
            .with("target", vector(*target))
            .unless(*roll_deg == 0.0, "roll_deg", || number(*roll_deg))
            .maybe("fov_y_deg", fov_y_deg.map(number))
            .unless(*frame == 0, "frame", || Value::Word(frame.to_string()))
            .named("View"),
    }
}

fn camera(camera: &Camera) -> Value {
    Fields::new()
        .unless(camera.lens == Lens::default(), "lens", || lens(&camera.lens))
        .with("keys", Value::List(camera.keys.iter().map(camera_key).collect()))
        .done()
}

fn lens(lens: &Lens) -> Value {
    let (name, size_field, size, near, far) = match *lens {
        Lens::Perspective { fov_y_deg, near, far } => ("Perspective", "fov_y_deg", fov_y_deg, near, far),
        Lens::Orthographic { height, near, far } => ("Orthographic", "height", height, near, far),
    };
    Fields::new()
        .with(size_field, number(size))
        .with("near", number(near))
        .with("far", number(far))
        .named(name)
}

fn camera_key(key: &CameraKey) -> Value {
    Fields::new()
        .with("frame", number(key.frame))
        .with("eye", vector(key.eye))
        .with("target", vector(key.target))
        .unless(key.roll_deg == 0.0, "roll_deg", || number(key.roll_deg))
        .maybe("fov_y_deg", key.fov_y_deg.map(number))
        .unless(key.ease == Ease::default(), "ease", || word(key.ease))
        .done()
}

fn light(light: &Light) -> Value {
    Fields::new()
        .with("name", text(&light.name))
        .with("kind", word(light.kind))
        .maybe("direction", light.direction.map(vector))
        .maybe("position", light.position.map(vector))
        .unless(light.color == Color::white(), "color", || color(light.color))
        .maybe("ground", light.ground.map(color))
        .unless(light.intensity == 1.0, "intensity", || number(light.intensity))
        .done()
}

fn object(object: &Object) -> Value {
    Fields::new()
        .with("name", text(&object.name))
        .with("mesh", text(&object.mesh))
        .maybe("group", object.group.as_deref().map(text))
        .maybe("parent", object.parent.as_deref().map(text))
        .maybe("particles", object.particles.map(|particles| Value::Word(particles.to_string())))
        .unless(object.hold == 1, "hold", || Value::Word(object.hold.to_string()))
        .unless(object.scale == Scale::default(), "scale", || scale(object.scale))
        .unless(object.up == Up::default(), "up", || word(object.up))
        .maybe("morph", object.morph.as_deref().map(text))
        .maybe("material", object.material.as_ref().map(material))
        .unless(object.keys.is_empty(), "keys", || Value::List(object.keys.iter().map(object_key).collect()))
        .unless(!object.hidden, "hidden", || flag(true))
        .unless(!object.locked, "locked", || flag(true))
        .done()
}

fn scale(scale: Scale) -> Value {
    let [x, y, z] = scale.0;
    if x == y && y == z { number(x) } else { vector(scale.0) }
}

fn material(material: &MaterialOverride) -> Value {
    Fields::new()
        .maybe("color", material.color.map(color))
        .maybe("texture", material.texture.as_deref().map(text))
        .unless(!material.unlit, "unlit", || flag(true))
        .maybe("gloss", material.gloss.map(number))
        .maybe("noise_displace", material.noise_displace.as_ref().map(noise_displace::noise_displace))
        .done()
}

fn object_key(key: &ObjectKey) -> Value {
    Fields::new()
        .with("frame", number(key.frame))
        .unless(key.translation == [0.0; 3], "translation", || vector(key.translation))
        .unless(key.rotation_deg == [0.0; 3], "rotation_deg", || vector(key.rotation_deg))
        .unless(key.scale == 1.0, "scale", || number(key.scale))
        .unless(key.morph == 0.0, "morph", || number(key.morph))
        .unless(key.ease == Ease::default(), "ease", || word(key.ease))
        .done()
}

fn strokes(settings: &StrokeSettings) -> Value {
    Fields::new()
        .maybe("preset", settings.preset.as_deref().map(text))
        .maybe("brush", settings.brush.as_ref().map(brush))
        .maybe("length_px", settings.length_px.map(number))
        .maybe("width_px", settings.width_px.map(number))
        .maybe("scale", settings.scale.map(number))
        .maybe("coverage", settings.coverage.map(number))
        .maybe("flatness", settings.flatness.map(number))
        .maybe("offset", settings.offset.map(number))
        .maybe("size_follow", settings.size_follow.map(number))
        .maybe("taper", settings.taper.map(number))
        .maybe("bend_deg", settings.bend_deg.map(number))
        .maybe("angle_jitter_deg", settings.angle_jitter_deg.map(number))
        .maybe("swing_deg", settings.swing_deg.map(number))
        .maybe("contour", settings.contour.map(number))
        .maybe("size_jitter", settings.size_jitter.map(number))
        .maybe("edges", settings.edges.map(edges))
        .maybe("color_jitter", settings.color_jitter.map(number))
        .maybe("temperature", settings.temperature.map(number))
        .maybe("grading", settings.grading.map(number))
        .maybe(
            "palette",
            settings.palette.as_ref().map(|colors| Value::List(colors.iter().copied().map(color).collect())),
        )
        .maybe("layer", settings.layer.map(|layer| Value::Word(layer.to_string())))
        .unless(settings.layers.is_empty(), "layers", || {
            Value::List(settings.layers.iter().map(layer).collect())
        })
        .done()
}

fn layer(layer: &LayerSettings) -> Value {
    Fields::new()
        .with("name", text(&layer.name))
        .maybe("brush", layer.brush.as_ref().map(brush))
        .maybe("length_px", layer.length_px.map(number))
        .maybe("width_px", layer.width_px.map(number))
        .maybe("coverage", layer.coverage.map(number))
        .maybe("opacity", layer.opacity.map(number))
        .maybe("thickness", layer.thickness.map(number))
        .maybe("dryness", layer.dryness.map(number))
        .maybe("pickup", layer.pickup.map(number))
        .maybe("color", layer.color.map(color))
        .done()
}

fn brush(BrushMix(names): &BrushMix) -> Value {
    match &names[..] {
        [name] => text(name),
        names => Value::List(names.iter().map(|name| text(name)).collect()),
    }
}

fn edges(edges: Edges) -> Value {
    match edges {
        Edges::Overrun(px) => Value::Named("Overrun", vec![number(px)]),
        Edges::Clip | Edges::Free => word(edges),
    }
}

fn style(style: &Style) -> Value {
    match style {
        Style::Reference => Value::Word("Reference".to_owned()),
        Style::RotatingStrokes(style) => {
            let usual = RotatingStrokes::default();
            Fields::new()
                .with("solver", word(style.solver))
                .unless(style.underpainting, "underpainting", || flag(false))
                .unless(style.canvas == usual.canvas, "canvas", || word(style.canvas))
                .unless(style.weave == usual.weave, "weave", || number(style.weave))
                .unless(style.canvas_follows == usual.canvas_follows, "canvas_follows", || {
                    word(style.canvas_follows)
                })
                .unless(style.relief == usual.relief, "relief", || number(style.relief))
                .unless(style.varnish == usual.varnish, "varnish", || number(style.varnish))
                .named("RotatingStrokes")
        }
        Style::SumiE(ink) => sumi_e(ink),
    }
}

fn sumi_e(ink: &SumiE) -> Value {
    let usual = SumiE::default();
    let start = Fields::new()
        .with("rule", word(ink.rule))
        .unless(ink.drawing == usual.drawing, "drawing", || word(ink.drawing))
        .unless(ink.light == usual.light, "light", || word(ink.light))
        .unless(ink.to_light == usual.to_light, "to_light", || vector(ink.to_light))
        .unless(ink.tones == usual.tones, "tones", || Value::Tuple(ink.tones.map(number).to_vec()));
    let numbers = SumiE::NUMBERS.iter().fold(start, |fields, of| {
        let value = ink.value(of);
        fields.unless(value == usual.value(of), of.field, || number(value))
    });
    numbers
        .unless(ink.paper == usual.paper, "paper", || color(ink.paper))
        .unless(ink.ink == usual.ink, "ink", || color(ink.ink))
        .unless(ink.seal == usual.seal, "seal", || color(ink.seal))
        .unless(ink.paper_follows == usual.paper_follows, "paper_follows", || word(ink.paper_follows))
        .named("SumiE")
}

#[cfg(test)]
mod tests;
