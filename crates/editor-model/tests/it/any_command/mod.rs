//! Makes any command for a scene from a few random numbers. The test of the history and a fuzz target share it.

use glam::{DAffine3, DQuat, DVec3};
use impasto_editor_model::Item;
use impasto_editor_model::command::{
    Amounts, Arrange, Command, Directions, Edit, Gesture, GuideSettings, KeyOf, Pose, PoseField,
    RegionTarget, Regions, SceneEdit, Shift, StrokeChange, StrokesOf, Time, Touches,
};
use impasto_scene::document::{
    Amount, AmountDab, BrushMix, Color, Dab, Direction, Ease, Guide, GuidePoint, LayerSettings, LightKind,
    MaterialOverride, ObjectKey, Region, STROKE_NUMBERS, Scene, Seam, Selector, Sense, Style, SumiE, Touch,
    TouchPoint,
};
use impasto_scene::motion;
use impasto_scene::new_scene::Ground;
use impasto_scene::presets::LayerKind;

/// The random numbers that one command is made from.
pub type Dice = (u8, u8, u8, f64, f64);

fn guide(x: f64, y: f64) -> Guide {
    let point = |share: f64| {
        let at = DVec3::new(x * 0.1, 1.0, y * 0.1 + share).normalize() * 0.5;
        GuidePoint { at: at.to_array(), normal: at.normalize().to_array(), turn_deg: 0.0 }
    };
    Guide {
        object: None,
        view: None,
        points: vec![point(0.0), point(0.3), point(0.7)],
        // So large that it reaches the surface of any object.
        radius: 0.9 + x.abs() * 0.01,
        strength: 0.8,
        falloff: Default::default(),
        mode: Default::default(),
        curve: false,
    }
}

/// A random command for this scene; the document may refuse it.
pub fn command(scene: &Scene, (kind, which, other, x, y): Dice) -> Command {
    let pick = |names: Vec<&str>, which: u8| -> String {
        names.get(usize::from(which) % names.len().max(1)).map_or("nobody", |name| *name).to_owned()
    };
    let object = pick(scene.objects.iter().map(|object| object.name.as_str()).collect(), which);
    let another = pick(scene.objects.iter().map(|object| object.name.as_str()).collect(), other);
    let region = pick(scene.regions.iter().map(|region| region.name.as_str()).collect(), which);
    let touch = pick(scene.touches.iter().map(|touch| touch.name.as_str()).collect(), which);
    let light = pick(scene.lights.iter().map(|light| light.name.as_str()).collect(), which);
    let guides =
        scene.regions.iter().find(|other| other.name == region).map_or(0, |region| region.guides.len());
    let of_guide = (region.clone(), usize::from(other) % guides.max(1));
    let target = if other % 4 == 0 {
        RegionTarget::NewOn(object.clone())
    } else {
        RegionTarget::Named(region.clone())
    };
    let item = match other % 6 {
        0 => Item::Camera,
        1 => Item::Light(light.clone()),
        2 => Item::Region(region.clone()),
        3 => Item::Guide(of_guide.0.clone(), of_guide.1),
        4 => Item::Touch(touch.clone()),
        _ => Item::Object(object.clone()),
    };
    let key_of = match other % 6 {
        0 => KeyOf::Camera,
        1 => KeyOf::Light(light.clone()),
        2 => KeyOf::Background,
        3 => KeyOf::Strokes(StrokesOf::Region(region.clone())),
        _ => KeyOf::Object(object.clone()),
    };
    let frame = f64::from(other % 24);
    let of = if other % 5 == 0 { StrokesOf::Scene } else { StrokesOf::Region(region.clone()) };
    let field = &STROKE_NUMBERS[usize::from(other) % STROKE_NUMBERS.len()];
    match kind % 42 {
        0 => Command::Edit(Edit::Delete(vec![item])),
        1 => Command::Edit(Edit::Duplicate(vec![item])),
        2 => Command::Edit(Edit::Rename(item, format!("name {}", other % 7))),
        3 => Command::Edit(Edit::SetParent { object, parent: (other % 3 > 0).then_some(another) }),
        4 => Command::Edit(Edit::Reorder(item, usize::from(other % 6))),
        5 => Command::Edit(Edit::SetHidden(vec![item], other % 2 == 0)),
        6 => Command::Edit(Edit::SetLocked(vec![item], other % 4 == 0)),
        7 => Command::Arrange(Arrange::ShiftMotion {
            objects: vec![object, another],
            shift: Shift {
                world_from_world: DAffine3::from_scale_rotation_translation(
                    DVec3::splat(1.0 + x.abs() * 0.05),
                    DQuat::from_euler(glam::EulerRot::XYZ, x, y, x * y),
                    DVec3::new(x, 0.1, y),
                ),
                frame,
            },
            verb: "Move",
        }),
        8 => {
            Command::Arrange(Arrange::Stretch { object, factors: DVec3::new(1.0, 1.0 + x.abs() * 0.1, 0.9) })
        }
        9 => Command::Arrange(Arrange::SetPoseField {
            object,
            frame,
            field: PoseField::Turn(usize::from(other % 3)),
            value: x * 90.0,
        }),
        10 => Command::Arrange(Arrange::SetPoseField {
            object,
            frame,
            field: PoseField::Move(usize::from(other % 3)),
            value: x,
        }),
        11 => Command::Arrange(Arrange::TurnUpright(object)),
        12 => Command::Arrange(Arrange::ScaleTo(object, 0.2 + x.abs())),
        13 => Command::Arrange(Arrange::SetMaterial(
            object,
            (other % 3 > 0)
                .then(|| MaterialOverride { color: Some(Color([0.3, 0.123, 0.9])), ..Default::default() }),
        )),
        14 => Command::Arrange(Arrange::AddLight {
            kind: [LightKind::Sun, LightKind::Point, LightKind::Ambient][usize::from(other % 3)],
            at: DVec3::new(x, 2.0, y),
            toward: DVec3::ZERO,
        }),
        15 => {
            let light = scene.lights.iter().find(|other| other.name == light).cloned();
            match light {
                Some(light) => Command::Arrange(Arrange::SetLight {
                    name: light.name.clone(),
                    light: impasto_scene::document::Light { intensity: x.abs(), ..light },
                    what: "brighter".to_owned(),
                }),
                None => Command::Scene(SceneEdit::SetSeed(u32::from(other))),
            }
        }
        16 => Command::Arrange(Arrange::SetLens(impasto_scene::document::Lens::Perspective {
            fov_y_deg: 20.0 + x.abs() * 8.0,
            near: 0.05,
            far: 100.0,
        })),
        17 => {
            let mut pose = motion::camera_at(scene, frame);
            pose.eye += DVec3::new(x * 0.1, y * 0.1, 0.3);
            Command::Arrange(Arrange::SetCamera { frame, pose })
        }
        18..=21 => Command::Directions(Directions::Stroke {
            region: target,
            gesture: [Gesture::Comb, Gesture::Smooth, Gesture::Smear, Gesture::Curve][usize::from(other % 4)],
            guides: (0..=other % 2).map(|more| guide(x + f64::from(more), y)).collect(),
        }),
        22 => Command::Directions(Directions::Erase { region, guides: vec![guide(x, y)] }),
        23 => Command::Directions(Directions::MoveGuidePoint {
            guide: of_guide,
            point: 1,
            to: guide(x, y).points[0].clone(),
        }),
        24 => Command::Directions(Directions::InsertGuidePoint {
            guide: of_guide,
            point: 1,
            at: guide(y, x).points[1].clone(),
        }),
        25 => Command::Directions(Directions::DeleteGuidePoint { guide: of_guide, point: 0 }),
        26 => Command::Directions(Directions::SetGuide {
            guide: of_guide,
            settings: GuideSettings { radius: Some(x.abs() + 0.9), strength: Some(y), falloff: None },
        }),
        27 => Command::Directions(Directions::FlipGuide(of_guide.0, of_guide.1)),
        28 => Command::Directions(Directions::SetBase {
            region: target,
            direction: match other % 5 {
                0 => Direction::Auto,
                1 => Direction::Angle(x * 40.0),
                2 => Direction::Around([0.0, 1.0, 0.0]),
                3 => Direction::Up,
                _ => Direction::Crossing(x * 9.0, y * 9.0),
            },
        }),
        29 => Command::Directions(Directions::Turn { region: target, by_deg: x * 60.0 }),
        30 => Command::Directions(Directions::Flip(target)),
        31 => Command::Directions(Directions::SetSense(
            region,
            if other % 2 == 0 { Sense::Arrows } else { Sense::Lines },
        )),
        32 => Command::Directions(Directions::Simplify { region, tolerance: 0.05 }),
        33 => Command::Directions(Directions::Recapture(i64::from(other % 12))),
        34 => Command::Regions(Regions::Add(Box::new(Region::new(
            "patch",
            Selector::Dabs(object, vec![dab(x, y)]),
        )))),
        35 => Command::Regions(match other % 4 {
            0 => Regions::SetSelector(region, Selector::Object(object)),
            1 => Regions::SetColor(region, Color([0.111, 0.5, 0.7])),
            2 => Regions::SetSeam(region, Seam::Soft(0.1)),
            _ => Regions::Paint { region, dabs: vec![dab(x, y)] },
        }),
        36 => Command::Regions(Regions::SetStroke(
            of,
            match other % 8 {
                0 => StrokeChange::Brush(Some(BrushMix(vec!["round".to_owned()]))),
                6 => StrokeChange::PaintLayer(Box::new(LayerSettings {
                    name: ["form", "lights", "ground"][usize::from(which) % 3].to_owned(),
                    hidden: (which % 2 == 0).then_some(x > 0.0),
                    ..LayerSettings::default()
                })),
                7 => {
                    let mut order = LayerKind::ALL;
                    order.rotate_left(usize::from(which) % 7);
                    StrokeChange::LayerOrder(Some(order))
                }
                1 => StrokeChange::Layer(Some(i32::from(other % 3))),
                _ => StrokeChange::Number(
                    field.number.field,
                    (other % 7 > 0).then(|| {
                        let (least, most) = (field.shown.drag.start(), field.shown.drag.end());
                        (least + (most - least) * (x.abs() / 4.0).min(1.0)) * field.shown.file_per_shown
                    }),
                ),
            },
        )),
        37 => Command::Scene(match other % 4 {
            0 if other % 8 == 4 => SceneEdit::SetGround(Ground::ALL[usize::from(which % 3)].1),
            0 => SceneEdit::SetSize(640 + u32::from(which), 360),
            1 if other % 8 == 1 => SceneEdit::SetExposure(f64::from(which) * 0.25),
            1 => SceneEdit::SetBackground(Color([0.2, 0.301, 0.4])),
            2 if other % 8 == 2 => {
                SceneEdit::SetStyle(Style::SumiE(SumiE::default()), "Style: ink".to_owned())
            }
            2 => SceneEdit::SetStyle(Style::Reference, "Style: plain".to_owned()),
            _ => SceneEdit::SetStyle(Style::default(), "Style: strokes".to_owned()),
        }),
        38 => Command::Time(match other % 5 {
            0 => Time::SetKey(key_of, frame),
            1 => Time::PoseAtFrame(
                Pose::Object(object, ObjectKey { translation: [x, y, 0.0], ..ObjectKey::at(0.0) }),
                frame,
            ),
            2 => Time::MoveKeys(vec![(key_of, frame)], f64::from(which % 5)),
            3 if other % 2 == 0 => Time::CopyKeys(vec![(key_of, frame)], f64::from(which % 5) - 2.0),
            3 => Time::DeleteKeys(vec![(key_of, frame)]),
            _ if other % 2 == 0 => Time::SetEase(vec![(key_of, frame)], Ease::Step),
            _ => Time::SetEase(vec![(key_of, frame)], Ease::Curve([0.2, -0.5], [0.4, 1.5])),
        }),
        39 => Command::Amounts(match other % 6 {
            0 => Amounts::Clear(region, usize::from(which % 3)),
            1 => Amounts::ClearAll(region),
            2 => Amounts::Erase { region, of: Amount::Width, left: Vec::new() },
            _ => Amounts::Paint {
                region: target,
                of: Amount::ALL[usize::from(which % 4)],
                object: None,
                dabs: vec![amount_dab(x, y), amount_dab(y, x)],
            },
        }),
        40 => Command::Touches(match other % 4 {
            0 => Touches::Erase(vec![touch]),
            1 => Touches::Set {
                name: touch,
                touch: Box::new(a_touch(&object, x, y)),
                what: "width".to_owned(),
            },
            _ => Touches::Lay(vec![a_touch(&object, x, y), a_touch(&object, y, x)]),
        }),
        _ => Command::Several(
            "Both".to_owned(),
            vec![
                Command::Scene(SceneEdit::SetSeed(u32::from(other))),
                Command::Time(Time::SetRange(0, i64::from(which) + 1)),
            ],
        ),
    }
}

fn a_touch(object: &str, x: f64, y: f64) -> Touch {
    let point = |share: f64| {
        let Dab { at, normal, .. } = dab(x + share, y);
        TouchPoint { at, normal }
    };
    let color = (x > 0.0).then_some(Color([0.2, 0.301, 0.4]));
    Touch { width_px: 8.0 + x.abs(), color, ..Touch::new("touch", object, vec![point(0.0), point(0.5)]) }
}

fn dab(x: f64, y: f64) -> Dab {
    let at = DVec3::new(x, 1.0, y).normalize() * 0.5;
    Dab { at: at.to_array(), normal: at.normalize().to_array(), radius: 0.1, take_away: x > 2.0 }
}

fn amount_dab(x: f64, y: f64) -> AmountDab {
    let Dab { at, normal, .. } = dab(x, y);
    AmountDab { at, normal, radius: 0.2 + x.abs() * 0.01, by: (1.0 + y * 0.1).clamp(0.5, 2.0) }
}
