//! Regions and guides.

use super::layout::{Fields, Value, number, text};
use super::{color, flag, reference, strokes, vector, word};
use crate::document::{
    Dab, Direction, Falloff, Guide, GuideMode, GuidePoint, GuideView, Patch, Region, Seam, Seed, Selector,
    Sense, StrokeSettings,
};

pub(super) fn region(region: &Region) -> Value {
    Fields::new()
        .with("name", text(&region.name))
        .with("on", selector(&region.on))
        .unless(region.direction == Direction::default(), "direction", || direction(&region.direction))
        .unless(region.guides.is_empty(), "guides", || Value::List(region.guides.iter().map(guide).collect()))
        .unless(region.seam == Seam::default(), "seam", || seam(region.seam))
        .unless(region.sense == Sense::default(), "sense", || word(region.sense))
        .maybe("reference", region.reference.as_ref().map(reference))
        .unless(region.strokes == StrokeSettings::default(), "strokes", || strokes(&region.strokes))
        .unless(region.turn_deg == 0.0, "turn_deg", || number(region.turn_deg))
        .unless(!region.hidden, "hidden", || flag(true))
        .unless(!region.locked, "locked", || flag(true))
        .maybe("color", region.color.map(color))
        .done()
}

fn selector(selector: &Selector) -> Value {
    let named = |name, parts: &[&String]| Value::Named(name, parts.iter().map(|part| text(part)).collect());
    match selector {
        Selector::Everything => Value::Word("Everything".to_owned()),
        Selector::Object(object) => named("Object", &[object]),
        Selector::Group(object, group) => named("Group", &[object, group]),
        Selector::Material(object, material) => named("Material", &[object, material]),
        Selector::Dabs(object, dabs) => {
            Value::Named("Dabs", vec![text(object), Value::List(dabs.iter().map(dab).collect())])
        }
        Selector::Flood(object, start, sharp_deg) => {
            Value::Named("Flood", vec![text(object), seed(start), number(*sharp_deg)])
        }
        Selector::Several(object, patches) => {
            Value::Named("Several", vec![text(object), Value::List(patches.iter().map(patch).collect())])
        }
    }
}

fn patch(patch: &Patch) -> Value {
    match patch {
        Patch::Whole => Value::Word("Whole".to_owned()),
        Patch::Group(group) => Value::Named("Group", vec![text(group)]),
        Patch::Material(material) => Value::Named("Material", vec![text(material)]),
        Patch::Dabs(dabs) => Value::Named("Dabs", vec![Value::List(dabs.iter().map(dab).collect())]),
        Patch::Flood(start, sharp_deg) => Value::Named("Flood", vec![seed(start), number(*sharp_deg)]),
    }
}

fn seed(seed: &Seed) -> Value {
    Fields::new().with("at", vector(seed.at)).with("normal", vector(seed.normal)).done()
}

fn dab(dab: &Dab) -> Value {
    Fields::new()
        .with("at", vector(dab.at))
        .with("normal", vector(dab.normal))
        .with("radius", number(dab.radius))
        .unless(!dab.take_away, "take_away", || flag(true))
        .done()
}

fn direction(direction: &Direction) -> Value {
    match direction {
        Direction::Angle(angle_deg) => Value::Named("Angle", vec![number(*angle_deg)]),
        Direction::Crossing(first_deg, second_deg) => {
            Value::Named("Crossing", vec![number(*first_deg), number(*second_deg)])
        }
        Direction::Along(axis) => Value::Named("Along", vec![vector(*axis)]),
        Direction::Around(axis) => Value::Named("Around", vec![vector(*axis)]),
        Direction::Toward(point) => Value::Named("Toward", vec![vector(*point)]),
        Direction::Curvature(bend) => Value::Named("Curvature", vec![word(bend)]),
        Direction::Auto | Direction::Up => word(direction),
    }
}

fn seam(seam: Seam) -> Value {
    match seam {
        Seam::Hard => word(seam),
        Seam::Soft(distance) => Value::Named("Soft", vec![number(distance)]),
    }
}

fn guide(guide: &Guide) -> Value {
    Fields::new()
        .unless(guide.mode == GuideMode::default(), "mode", || word(guide.mode))
        .unless(!guide.curve, "curve", || Value::Word("true".to_owned()))
        .maybe("object", guide.object.as_deref().map(text))
        .maybe("view", guide.view.as_ref().map(view))
        .with("points", Value::List(guide.points.iter().map(point).collect()))
        .with("radius", number(guide.radius))
        .unless(guide.strength == 1.0, "strength", || number(guide.strength))
        .unless(guide.falloff == Falloff::default(), "falloff", || word(guide.falloff))
        .done()
}

fn view(view: &GuideView) -> Value {
    Fields::new().with("eye", vector(view.eye)).with("target", vector(view.target)).done()
}

fn point(point: &GuidePoint) -> Value {
    Fields::new()
        .with("at", vector(point.at))
        .with("normal", vector(point.normal))
        .unless(point.turn_deg == 0.0, "turn_deg", || number(point.turn_deg))
        .done()
}
