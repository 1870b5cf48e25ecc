//! The section of the inspector for the pose of an object at the frame that is shown, and the section and rows for any
//! key at that frame.

use egui::Ui;
use impasto_editor_model::command::{Arrange, Command, KeyOf, Pose, PoseField, Time};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::Mode;
use impasto_scene::document::{Ease, Object, ObjectKey};
use impasto_scene::limits::{KEY_SCALE, MAX_FRAME};
use impasto_scene::motion;

use super::Asker;
use super::number::{Number, decimals};
use super::parts::{axes, note, section};

use crate::panels::Ask;
use crate::widgets::{self, Button};

/// Width of the label before three fields, points.
pub(super) const NARROW_LABEL: f32 = 48.0;

/// The numbers of an object's pose. In Animate, a changed number keys this frame (with Auto key off, the pose stays
/// loose: shown, but not keyed). In other modes it shifts the motion.
pub(super) fn of_object(ui: &mut Ui, asker: &mut Asker<'_, '_>, [object, stored]: [&Object; 2]) {
    let frame = asker.shown.session.frame;
    let animate = asker.shown.session.mode == Mode::Animate;
    let is_keyed = object.keys.iter().any(|key| key.frame == frame);
    let title = if animate { format!("Pose at frame {frame}") } else { "Transform".to_owned() };
    let warns = animate && asker.shown.time.is_loose(&stored.name);
    let note = match (warns, animate && is_keyed) {
        (true, _) => format!("not keyed{}", asker.shown.with_keys_of(Action::SetKey, ", {} keeps it")),
        (_, true) => "keyed".to_owned(),
        _ => String::new(),
    };
    section(ui, &title, &note, true, |ui| {
        let now = motion::key_at(asker.scene(), object, frame);
        let was = motion::key_at(asker.stored(), stored, frame);
        let set = |field: PoseField, value: f64| {
            let object = stored.name.clone();
            if animate {
                Command::Time(Time::PoseAtFrame(Pose::Object(object, posed(&was, field, value)), frame))
            } else {
                Command::Arrange(Arrange::SetPoseField { object, frame, field, value })
            }
        };
        type OfAxis = fn(usize) -> PoseField;
        let rows: [(&str, [[f64; 3]; 2], OfAxis); 2] = [
            ("Move", [now.translation, was.translation], PoseField::Move),
            ("Turn", [now.rotation_deg, was.rotation_deg], PoseField::Turn),
        ];
        for (label, [now, was], of_axis) in rows {
            axes(ui, label, NARROW_LABEL, |ui, (axis, letter, name), width| {
                let turns = label == "Turn";
                let number = Number {
                    letter,
                    unit: if turns { "\u{b0}" } else { "" },
                    step: if turns { (1.0, 1) } else { (0.01, decimals(now[axis])) },
                    default: Some(0.0),
                    unlabelled: Some(width),
                    warns,
                    ..Number::new(&name, effect_of(animate))
                };
                asker.number(ui, &number, [now[axis], was[axis]], |to| set(of_axis(axis), to.unwrap_or(0.0)));
            });
        }
        super::parts::row_with(ui, "Scale", NARROW_LABEL, |ui| {
            let number = Number {
                unit: "\u{d7}",
                range: *KEY_SCALE.start()..=f64::INFINITY,
                limits: Some(KEY_SCALE),
                step: (0.01, 3),
                default: Some(1.0),
                unlabelled: Some(ui.available_width()),
                warns,
                ..Number::new("Uniform scale", effect_of(animate))
            };
            asker.number(ui, &number, [now.scale.mean(), was.scale.mean()], |to| {
                set(PoseField::Scale, to.unwrap_or(1.0))
            });
        });
    });
    if animate {
        let key = stored.keys.iter().find(|key| key.frame == frame && !warns);
        of_key(ui, asker, KeyOf::Object(stored.name.clone()), key.map(|key| key.ease));
    }
}

fn effect_of(animate: bool) -> &'static str {
    if animate { "Keys the pose at this frame." } else { "Shifts the whole motion, all keys together." }
}

fn posed(was: &ObjectKey, field: PoseField, value: f64) -> ObjectKey {
    let mut key = was.clone();
    match field {
        PoseField::Move(axis) => key.translation[axis] = value,
        PoseField::Turn(axis) => key.rotation_deg[axis] = value,
        PoseField::Scale => key.scale = key.scale.times(value / key.scale.mean(), |scale| scale),
    }
    key
}

/// The key at the frame that is shown, or a button that sets one.
pub(super) fn of_key(ui: &mut Ui, asker: &mut Asker<'_, '_>, of: KeyOf, ease: Option<Ease>) {
    section(ui, "This key", if ease.is_some() { "" } else { "none here" }, true, |ui| {
        key_rows(ui, asker, of, ease);
    });
}

/// The rows of [`of_key`].
pub(super) fn key_rows(ui: &mut Ui, asker: &mut Asker<'_, '_>, of: KeyOf, ease: Option<Ease>) {
    let frame = asker.shown.session.frame;
    let Some(ease) = ease else {
        let scene = asker.stored();
        let is_of_shot = match &of {
            KeyOf::Camera => scene.has_camera_of_shot(),
            KeyOf::Object(name) => {
                scene.objects.iter().any(|object| object.name == *name && scene.is_moved_by_shot(object))
            }
            _ => false,
        };
        if is_of_shot {
            note(
                ui,
                "It moves as the shot has it. Own keys replace that, and stay when it is exported again.",
            );
            if Button::new("Make own keys").show(ui).clicked() {
                asker.ask(Command::Time(Time::OwnKeys(of)));
            }
            return;
        }
        if Button::new("Key this frame").show(ui).clicked() {
            asker.ask(Command::Time(Time::SetKey(of, frame)));
        }
        return;
    };
    let number = Number {
        limits: Some(-MAX_FRAME..=MAX_FRAME),
        ..Number::new("Key frame", "Moves the key, and the frame that is shown with it.")
    };
    let before = asker.asks.len();
    asker.number(ui, &number, [frame, frame], |to| {
        Command::Time(Time::MoveKeys(vec![(of.clone(), frame)], to.unwrap_or(frame) - frame))
    });
    // Not previewed: a key that moved to another frame would vanish from this section during the drag. The key moves
    // on release.
    asker.asks.retain(|ask| !matches!(ask, Ask::Preview(Command::Time(Time::MoveKeys(..)))));
    // The key was moved, by a drag that ended, by typing or by a step: go to its new frame.
    if let Some(
        Ask::Do(Command::Time(Time::MoveKeys(_, by)))
        | Ask::DoMerged(Command::Time(Time::MoveKeys(_, by)), _),
    ) = asker.asks.get(before)
    {
        let session = impasto_editor_model::Session { frame: frame + by, ..asker.shown.session.clone() };
        asker.asks.push(Ask::Session(Box::new(session)));
    }
    if let Some(ease) = widgets::ease_choice(ui, ease) {
        asker.ask(Command::Time(Time::SetEase(vec![(of.clone(), frame)], ease)));
    }
}
