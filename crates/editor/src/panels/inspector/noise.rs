//! The inspector's rows for the noise of an object's material, which moves its vertices and colours its surface.

use egui::Ui;
use impasto_editor_model::command::{Arrange, Command};
use impasto_editor_model::{NoisePart, PictureFor};
use impasto_scene::document::{
    MaterialOverride, NoiseAlong, NoiseAlpha, NoiseDisplace, NoiseForward, NoiseMix, NoiseNormals,
    NoiseSpace, Object, SurfaceNoise, VertexNoise,
};
use impasto_scene::limits::{MAX_NOISE_INTENSITY, MAX_STRENGTH, NOISE_LAYERS, NOISE_PERIOD_SECS, NOISE_RATE};

use super::Asker;
use super::number::Number;
use super::parts::{pick, reset, row, seen};
use super::picture::Picture;
use crate::widgets::{self, Tip};

/// A number of one part of the noise (vertex or surface): how it is shown, and access to its value.
struct Setting<T> {
    number: Number<'static>,
    of: fn(&mut T) -> &mut f64,
}

/// A setting of one part of the noise that offers a few words to choose from.
struct Choice<T> {
    label: &'static str,
    name: &'static str,
    effect: &'static str,
    words: &'static [&'static str],
    chosen: fn(&T) -> usize,
    set: fn(&mut T, usize),
}

fn number(name: &'static str, effect: &'static str, default: f64, range: [f64; 2]) -> Number<'static> {
    let step = if range[1] > 4.0 { (0.1, 2) } else { (0.01, 3) };
    let (range, default) = (range[0]..=range[1], Some(default));
    Number {
        range,
        limits: Some(NOISE_RATE),
        scene_decides: false,
        step,
        default,
        ..Number::new(name, effect)
    }
}

pub(super) fn rows(ui: &mut Ui, asker: &mut Asker<'_, '_>, [object, stored]: [&Object; 2]) {
    let material = stored.material.clone().unwrap_or_default();
    let noise_of = |object: &Object| object.material.as_ref().and_then(|over| over.noise_displace.clone());
    let set = |noise: Option<NoiseDisplace>| {
        let material = MaterialOverride { noise_displace: noise, ..material.clone() };
        let material = (material != MaterialOverride::default()).then_some(material);
        Command::Arrange(Arrange::SetMaterial(stored.name.clone(), material))
    };
    let mut on = noise_of(object).is_some();
    let switch = widgets::checkbox(ui, "Noise", &mut on);
    let effect = "Lets noise move its vertices, or colour its surface in place of its texture.";
    if (Tip { name: "Noise", effect, ..Tip::default() }).on(switch).changed() {
        // Neither part is on yet, so that the surface stays as it is until one is chosen.
        let unused = NoiseDisplace { vertex: None, surface: None, ..NoiseDisplace::default() };
        asker.ask(set(on.then_some(unused)));
    }
    let (Some(shown), Some(stored_noise)) = (noise_of(object), noise_of(stored)) else { return };
    let set = |noise: NoiseDisplace| set(Some(noise));
    let mut on = shown.vertex.is_some();
    if widgets::checkbox(ui, "Noise moves the vertices", &mut on).changed() {
        asker.ask(set(NoiseDisplace { vertex: on.then(VertexNoise::default), ..stored_noise.clone() }));
    }
    if let (Some(now), Some(was)) = (&shown.vertex, &stored_noise.vertex) {
        let set = |vertex| set(NoiseDisplace { vertex: Some(vertex), ..stored_noise.clone() });
        texture(ui, asker, "Vertex noise file", (object, NoisePart::Vertex), now.texture.as_deref());
        settings(ui, asker, &vertex_numbers(), [now, was], &set);
        choices(ui, asker, &VERTEX_CHOICES, [now, was], &set);
    }
    let mut on = shown.surface.is_some();
    if widgets::checkbox(ui, "Noise colours the surface", &mut on).changed() {
        asker.ask(set(NoiseDisplace { surface: on.then(SurfaceNoise::default), ..stored_noise.clone() }));
    }
    if let (Some(now), Some(was)) = (&shown.surface, &stored_noise.surface) {
        let set = |surface| set(NoiseDisplace { surface: Some(surface), ..stored_noise.clone() });
        texture(ui, asker, "Surface noise file", (object, NoisePart::Surface), now.texture.as_deref());
        layers(ui, asker, [now, was], &set);
        settings(ui, asker, &surface_numbers(), [now, was], &set);
        tint(ui, asker, [now, was], &set);
        choices(ui, asker, &SURFACE_CHOICES, [now, was], &set);
    }
    period(ui, asker, [&shown, &stored_noise], &set);
}

/// The picture used in place of the built-in noise; an empty name brings the built-in noise back.
fn texture(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    name: &str,
    (object, part): (&Object, NoisePart),
    file: Option<&str>,
) {
    let of = PictureFor::Noise(object.name.clone(), part);
    let effect = "The noise is taken from this picture; without one it is the built-in noise.";
    asker.picture(ui, &Picture { label: "Picture", name, effect, of, file });
}

fn settings<T: Clone>(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    settings: &[Setting<T>],
    [now, was]: [&T; 2],
    set: &dyn Fn(T) -> Command,
) {
    for setting in settings {
        let [shown, stored] = [now, was].map(|noise| *(setting.of)(&mut noise.clone()));
        asker.number(ui, &setting.number, [shown, stored], |to| {
            let mut next = was.clone();
            *(setting.of)(&mut next) = to.or(setting.number.default).unwrap_or(stored);
            set(next)
        });
    }
}

fn choices<T: Clone>(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    choices: &[Choice<T>],
    [now, was]: [&T; 2],
    set: &dyn Fn(T) -> Command,
) {
    for choice in choices {
        let tip = Tip { name: choice.name, effect: choice.effect, ..Tip::default() };
        let picked = row(ui, choice.label, |ui| pick(ui, tip, choice.words, (choice.chosen)(now)));
        if let Some(picked) = picked {
            let mut next = was.clone();
            (choice.set)(&mut next, picked);
            asker.ask(set(next));
        }
    }
}

fn layers(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    [now, was]: [&SurfaceNoise; 2],
    set: &dyn Fn(SurfaceNoise) -> Command,
) {
    let usual = SurfaceNoise::default().layer_count;
    let number = Number {
        range: 1.0..=30.0,
        limits: Some(NOISE_LAYERS),
        default: Some(f64::from(usual)),
        ..Number::new("Noise layers", "How many layers are multiplied; 1 shows the tint alone.")
    };
    asker.number(ui, &number, [now, was].map(|noise| f64::from(noise.layer_count)), |to| {
        let layer_count = to.map_or(usual, |to| to.round() as u32);
        set(SurfaceNoise { layer_count, ..was.clone() })
    });
}

fn tint(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    [now, was]: [&SurfaceNoise; 2],
    set: &dyn Fn(SurfaceNoise) -> Command,
) {
    let usual = SurfaceNoise::default().tint;
    row(ui, "Tint", |ui| {
        asker.colour(ui, "Noise tint", seen(now.tint), |tint| set(SurfaceNoise { tint, ..was.clone() }));
        if now.tint != usual && reset(ui, "Noise tint") {
            asker.ask(set(SurfaceNoise { tint: usual, ..was.clone() }));
        }
    });
}

fn period(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    [now, was]: [&NoiseDisplace; 2],
    set: &dyn Fn(NoiseDisplace) -> Command,
) {
    let mut on = now.period_secs.is_some();
    if widgets::checkbox(ui, "Noise comes back", &mut on).changed() {
        asker.ask(set(NoiseDisplace { period_secs: on.then_some(2.0), ..was.clone() }));
    }
    if let (Some(shown), Some(stored)) = (now.period_secs, was.period_secs) {
        let number = Number {
            range: 0.1..=20.0,
            limits: Some(NOISE_PERIOD_SECS),
            unit: "s",
            step: (0.1, 2),
            default: Some(2.0),
            ..Number::new("Noise period", "After so long everything is as it was, to the bit.")
        };
        asker.number(ui, &number, [shown, stored], |to| {
            set(NoiseDisplace { period_secs: Some(to.unwrap_or(2.0)), ..was.clone() })
        });
    }
}

fn vertex_numbers() -> [Setting<VertexNoise>; 3] {
    let rate = "How fast the noise changes from place to place; near 1 the motion is busy.";
    let scale = "How far apart the least and the greatest noise put a vertex.";
    [
        Setting { number: number("Noise rate X", rate, 0.1, [0.0, 1.0]), of: |noise| &mut noise.value[0] },
        Setting { number: number("Noise rate Y", rate, 0.1, [0.0, 1.0]), of: |noise| &mut noise.value[1] },
        Setting { number: number("Noise scale", scale, 0.1, [0.0, 1.0]), of: |noise| &mut noise.scale },
    ]
}

const VERTEX_CHOICES: [Choice<VertexNoise>; 3] = [
    Choice {
        label: "Space",
        name: "Noise space",
        effect: "In the world, a thing that moves goes through the noise; in the object, the noise goes with it.",
        words: &["World", "Object"],
        chosen: |noise| usize::from(noise.space == NoiseSpace::Local),
        set: |noise, picked| noise.space = [NoiseSpace::World, NoiseSpace::Local][picked],
    },
    Choice {
        label: "Along",
        name: "Noise along",
        effect: "Each axis is moved by a channel of the noise, or the surface in and out along its normals.",
        words: &["Axes", "Normals"],
        chosen: |noise| usize::from(noise.along == NoiseAlong::Normal),
        set: |noise, picked| noise.along = [NoiseAlong::Channels, NoiseAlong::Normal][picked],
    },
    Choice {
        label: "Shading",
        name: "Noise shading",
        effect: "Light falls on the surface as it is at rest, or as it is moved.",
        words: &["At rest", "As moved"],
        chosen: |noise| usize::from(noise.normals == NoiseNormals::Displaced),
        set: |noise, picked| noise.normals = [NoiseNormals::Kept, NoiseNormals::Displaced][picked],
    },
];

fn surface_numbers() -> [Setting<SurfaceNoise>; 9] {
    let within = |most: f64, number: Number<'static>| Number { limits: Some(0.0..=most), ..number };
    let repeats = "How often the texture is repeated.";
    let begins = "Where the texture begins, in lengths of it.";
    let bright = "Multiplies the tint; more than 1 shines.";
    let clear = "How much it hides of what is behind.";
    let glow = "How much of what is bright is spread as a glow.";
    let from = "The brightness above which the surface glows.";
    let speed = "How fast the layers move against each other.";
    [
        Setting { number: number("Noise speed", speed, 1.0, [0.0, 10.0]), of: |noise| &mut noise.speed },
        Setting {
            number: number("Noise tiling U", repeats, 1.0, [0.0, 8.0]),
            of: |noise| &mut noise.tiling[0],
        },
        Setting {
            number: number("Noise tiling V", repeats, 1.0, [0.0, 8.0]),
            of: |noise| &mut noise.tiling[1],
        },
        Setting {
            number: number("Noise offset U", begins, 0.0, [0.0, 1.0]),
            of: |noise| &mut noise.tile_offset[0],
        },
        Setting {
            number: number("Noise offset V", begins, 0.0, [0.0, 1.0]),
            of: |noise| &mut noise.tile_offset[1],
        },
        Setting {
            number: within(MAX_NOISE_INTENSITY, number("Noise intensity", bright, 1.0, [0.0, 8.0])),
            of: |noise| &mut noise.intensity,
        },
        Setting {
            number: within(1.0, number("Noise opacity", clear, 1.0, [0.0, 1.0])),
            of: |noise| &mut noise.opacity,
        },
        Setting {
            number: within(MAX_STRENGTH, number("Noise bloom", glow, 0.0, [0.0, 2.0])),
            of: |noise| &mut noise.bloom,
        },
        Setting {
            number: within(MAX_NOISE_INTENSITY, number("Bloom threshold", from, 1.0, [0.0, 4.0])),
            of: |noise| &mut noise.threshold,
        },
    ]
}

const SURFACE_CHOICES: [Choice<SurfaceNoise>; 3] = [
    Choice {
        label: "Forward",
        name: "Noise forward",
        effect: "Which layers move forward; the others move back.",
        words: &["Odd layers", "Even layers"],
        chosen: |noise| usize::from(noise.forward == NoiseForward::Even),
        set: |noise, picked| noise.forward = [NoiseForward::Odd, NoiseForward::Even][picked],
    },
    Choice {
        label: "Mix",
        name: "Noise mix",
        effect: "The root gets darker with more layers; the mean stays as light as the texture.",
        words: &["Root", "Mean"],
        chosen: |noise| usize::from(noise.mix == NoiseMix::Mean),
        set: |noise, picked| noise.mix = [NoiseMix::Root, NoiseMix::Mean][picked],
    },
    Choice {
        label: "Alpha",
        name: "Noise alpha",
        effect: "See-through where the texture is, or where the noise is dark.",
        words: &["Of the texture", "Of its grey"],
        chosen: |noise| usize::from(noise.alpha == NoiseAlpha::Grey),
        set: |noise, picked| noise.alpha = [NoiseAlpha::Texture, NoiseAlpha::Grey][picked],
    },
];
