//! The inspector of the shot's camera: edits its lens, and where it stands at the frame that is shown.

use egui::Ui;
use glam::DVec3;
use impasto_editor_model::command::{Arrange, Command, KeyOf, Pose, Time};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::Mode;
use impasto_scene::document::Lens;
use impasto_scene::limits::{FOV_Y_DEG, MIN_LENGTH};
use impasto_scene::motion::{self, CameraPose};

use super::number::Number;
use super::parts::{head, head_icon, head_note, row, section};
use super::region::vector;
use super::{Asker, pose};
use crate::icons;
use crate::panels::Ask;
use crate::theme::{Tokens, type_face};
use crate::widgets::{self, Button};

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let weak = Tokens::of(ui).weak;
    head(ui, |ui| {
        head_icon(ui, icons::CAMERA, weak);
        ui.label(egui::RichText::new("shot").font(type_face::head()));
        head_note(ui, "camera");
    });
    section(ui, "Lens", "", true, |ui| lens(ui, asker));
    let frame = asker.shown.session.frame;
    let animate = asker.shown.session.mode == Mode::Animate;
    section(ui, &format!("Pose at frame {frame}"), "", true, |ui| place(ui, asker, animate));
    if animate {
        let key = asker.stored().camera.keys.iter().find(|key| key.frame == frame);
        pose::of_key(ui, asker, KeyOf::Camera, key.map(|key| key.ease));
    }
}

fn lens(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let frame = asker.shown.session.frame;
    let [camera, was] = [asker.scene(), asker.stored()].map(|scene| motion::camera_at(scene, frame));
    let set = |lens| Command::Arrange(Arrange::SetLens(lens));
    let depths = |lens: &Lens| match *lens {
        Lens::Perspective { near, far, .. } | Lens::Orthographic { near, far, .. } => [near, far],
    };
    let [near, far] = depths(&was.lens);
    row(ui, "Projection", |ui| {
        let mut parallel = usize::from(matches!(camera.lens, Lens::Orthographic { .. }));
        if widgets::segmented(ui, &["Perspective", "Parallel"], &mut parallel).changed() {
            // What is at the target keeps its size in the picture.
            let distance = was.eye.distance(was.target).max(MIN_LENGTH);
            asker.ask(set(match was.lens {
                Lens::Perspective { fov_y_deg, .. } => {
                    let height = 2.0 * distance * (fov_y_deg.to_radians() / 2.0).tan();
                    Lens::Orthographic { height: (height * 1e4).round() / 1e4, near, far }
                }
                Lens::Orthographic { height, .. } => {
                    let fov = 2.0 * (height / 2.0 / distance).atan().to_degrees();
                    let fov_y_deg = (fov * 10.0).round() / 10.0;
                    Lens::Perspective {
                        fov_y_deg: fov_y_deg.clamp(*FOV_Y_DEG.start(), *FOV_Y_DEG.end()),
                        near,
                        far,
                    }
                }
            }));
        }
    });
    match (&camera.lens, &was.lens) {
        (Lens::Perspective { fov_y_deg: shown, .. }, Lens::Perspective { fov_y_deg: was, .. }) => {
            let number = Number {
                unit: "\u{b0}",
                range: 5.0..=120.0,
                limits: Some(FOV_Y_DEG),
                step: (1.0, 1),
                default: Some(35.0),
                ..Number::new("Field of view", "How much the picture holds from bottom to top.")
            };
            asker.number(ui, &number, [*shown, *was], |to| {
                set(Lens::Perspective { fov_y_deg: to.unwrap_or(35.0), near, far })
            });
        }
        (Lens::Orthographic { height: shown, .. }, Lens::Orthographic { height: was, .. }) => {
            let number = Number {
                range: 0.01..=20.0,
                limits: Some(MIN_LENGTH..=f64::INFINITY),
                step: (0.1, 2),
                ..Number::new("View height", "Units of the world from the picture's bottom to its top.")
            };
            asker.number(ui, &number, [*shown, *was], |to| {
                set(Lens::Orthographic { height: to.unwrap_or(1.0), near, far })
            });
        }
        _ => {}
    }
    let [near_now, far_now] = depths(&camera.lens);
    // The lens as the scene stores it, without the field of view that a key may state at this frame.
    let base = asker.stored().camera.lens.clone();
    let number = Number {
        range: 0.01..=10.0,
        limits: Some(MIN_LENGTH..=f64::INFINITY),
        step: (0.01, 3),
        default: Some(0.05),
        ..Number::new("Near", "The nearest depth that shows, in units of the world.")
    };
    asker.number(ui, &number, [near_now, near], |to| set(with_depths(&base, to.unwrap_or(0.05), far)));
    let number = Number {
        range: 1.0..=1000.0,
        limits: Some(MIN_LENGTH..=f64::INFINITY),
        step: (1.0, 1),
        default: Some(100.0),
        ..Number::new("Far", "The farthest depth that shows, in units of the world.")
    };
    asker.number(ui, &number, [far_now, far], |to| set(with_depths(&base, near, to.unwrap_or(100.0))));
}

fn with_depths(lens: &Lens, near: f64, far: f64) -> Lens {
    match *lens {
        Lens::Perspective { fov_y_deg, .. } => Lens::Perspective { fov_y_deg, near, far },
        Lens::Orthographic { height, .. } => Lens::Orthographic { height, near, far },
    }
}

fn place(ui: &mut Ui, asker: &mut Asker<'_, '_>, animate: bool) {
    let frame = asker.shown.session.frame;
    let [now, was] = [asker.scene(), asker.stored()].map(|scene| motion::camera_at(scene, frame));
    let set = |pose: CameraPose| {
        if animate {
            Command::Time(Time::PoseAtFrame(Pose::Camera(pose), frame))
        } else {
            Command::Arrange(Arrange::SetCamera { frame, pose })
        }
    };
    let pair = |of: fn(&CameraPose) -> DVec3| [of(&now).to_array(), of(&was).to_array()];
    vector(ui, asker, "Eye", "Where the camera stands, in the world.", pair(|pose| pose.eye), |eye| {
        set(CameraPose { eye: DVec3::from(eye), ..was.clone() })
    });
    vector(ui, asker, "Target", "What it looks at, in the world.", pair(|pose| pose.target), |target| {
        set(CameraPose { target: DVec3::from(target), ..was.clone() })
    });
    let number = Number {
        unit: "\u{b0}",
        step: (1.0, 1),
        default: Some(0.0),
        ..Number::new("Roll", "Turns the camera about its gaze.")
    };
    asker.number(ui, &number, [now.roll_rad.to_degrees(), was.roll_rad.to_degrees()], |to| {
        set(CameraPose { roll_rad: to.unwrap_or(0.0).to_radians(), ..was.clone() })
    });
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if Button::new("Camera to this view").show(ui).clicked() {
            asker.asks.push(Ask::Act(Action::CameraFromView));
        }
        if Button::new("To the shot").show(ui).clicked() {
            asker.asks.push(Ask::Act(Action::LookThrough));
        }
    });
}
