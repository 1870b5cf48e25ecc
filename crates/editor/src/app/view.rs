//! Connects the viewport with the editor: gives the viewport what it shows, and carries out what the user does there.

use egui::Ui;
use impasto_editor_model::camera_rig::Looking;
use impasto_editor_model::editor::reference_frame;
use impasto_editor_model::picking::View;
use impasto_scene::motion;

use super::marks::{self, MarkCache};
use super::picture_view::PictureView;
use super::telling::value;
use super::{EditorApp, badge};
use crate::panels::Ask;
use crate::viewport::overlay::Sight;
use crate::viewport::{Badge, CameraChoice, Layout, Marks, Now, ViewportEvents, ViewportInput, viewport};

impl EditorApp {
    /// Shows the viewport, and asks the painting thread for the next pictures.
    pub(super) fn viewport(&mut self, ui: &mut Ui, asks: &mut Vec<Ask>) {
        let area = ui.max_rect();
        let scene = &self.editor.document().shown().scene;
        let (size, pixels_per_point) = (scene.size, ui.ctx().pixels_per_point());
        let is_empty = scene.objects.is_empty();
        let compares = self.editor.session.compare && !is_empty;
        self.picture_flow.set_layout(if compares {
            Layout::compare(area, size, pixels_per_point)
        } else {
            Layout::single(area, size, pixels_per_point)
        });
        let (reference_camera, reference) = motion::referred_to(scene, &scene.reference);
        let (camera, frame) = (self.editor.camera(), self.editor.session.frame);
        let first = if compares {
            PictureView { index: 0, camera: &reference_camera, frame: reference }
        } else {
            PictureView { index: 0, camera: &camera, frame }
        };
        let second = compares.then_some(PictureView { index: 1, camera: &camera, frame });
        self.marks.refresh(&self.editor, &self.picture_flow, &first);
        if let Some(second) = &second {
            self.marks.refresh(&self.editor, &self.picture_flow, second);
        }
        let view = self.picture_flow.view(&self.editor);
        self.editor.rested(ui.input(|input| input.time), &view);
        self.marks.comb_preview.follow(ui.ctx(), &self.editor, &self.picture_flow);
        let fresh = marks::fresh(&self.editor, &view, ui);
        let poses = self.editor.poses();
        let visible = |object: usize| !self.editor.document().shown().scene.objects[object].hidden;
        let sight = Sight { picker: self.editor.picker(), poses: &poses, visible: &visible, view: &view };
        let own = self.marks.marks(0, &self.editor, Some(&fresh));
        let marks = Marks { singular: MarkCache::singular(&fresh, sight), ..own };
        let now_marks = self.marks.marks(1, &self.editor, None);
        let note = self.turned_words();
        let under_cursor = self.editor.tool_output().label.clone().unwrap_or_default();
        let input = ViewportInput {
            pictures: &self.picture_flow.pictures,
            session: &self.editor.session,
            keymap: &self.editor.keymap,
            camera: first.camera,
            through_shot: self.editor.looking == Looking::Shot,
            marks: &marks,
            now: second.as_ref().map(|second| Now {
                camera: second.camera,
                frame: second.frame,
                note: &note,
                marks: &now_marks,
            }),
            badge: badge(&self.editor),
            value: &value(&self.editor),
            under_cursor: &under_cursor,
            empty: is_empty && !self.is_reading(),
            trouble: self.picture_flow.trouble.as_deref(),
        };
        let events = viewport(ui, self.picture_flow.layout(), &input);
        self.take(events, asks, &view);
        self.picture_flow.ask(&self.editor);
    }

    /// The note of Compare: how far the selected object has turned since the reference.
    fn turned_words(&self) -> String {
        let Some(object) = self.editor.active_object() else { return String::new() };
        let name = &self.editor.document().shown().scene.objects[object].name;
        self.editor
            .turned_deg(object)
            .map_or_else(String::new, |turned| format!("{name} turned {:.0}°", turned.round() + 0.0))
    }

    fn take(&mut self, events: ViewportEvents, asks: &mut Vec<Ask>, view: &View) {
        for event in events.pointer {
            // The previous event may have moved the view.
            let view = self.picture_flow.view(&self.editor);
            self.editor.pointer(&event, &view);
        }
        asks.extend(events.asks);
        let shot = self.editor.shot();
        match events.look {
            Some(CameraChoice::Shot) => self.editor.looking = Looking::Shot,
            Some(CameraChoice::Free) => drop(self.editor.looking.free(&shot)),
            Some(CameraChoice::Along(axis)) => self.editor.looking.free(&shot).look_along(axis),
            None => {}
        }
        if events.orbit_px != glam::DVec2::ZERO {
            let about = view.at_depth_of(view.size_px * 0.5, self.editor.camera().target);
            self.editor.looking.free(&shot).orbit(events.orbit_px, about);
        }
        if events.recapture {
            match badge(&self.editor) {
                Badge::Reference(_) => {
                    let frame = reference_frame(self.editor.document().scene());
                    self.toast(format!("Frame {frame} is the reference already"), None, false);
                }
                Badge::Turned { frame, .. } | Badge::Free(frame) => {
                    self.sheets.recapture = Some(frame.round() as i64);
                }
            }
        }
    }
}
