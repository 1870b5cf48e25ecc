//! Carries out what the panels ask for, and the editor's requests to the window.

use egui::Context;
use impasto_editor_model::editor::{Mend, Request};
use impasto_editor_model::picking::View;

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::panels::work::WorkKind;
use crate::panels::{self, Ask};

impl EditorApp {
    pub(super) fn answer(&mut self, ask: Ask, ctx: &Context, view: &View) {
        match ask {
            Ask::Do(command) => drop(self.editor.run(&command)),
            Ask::DoMerged(command, key) => {
                let now = ctx.input(|input| input.time);
                self.editor.run_merged(&command, &key, now);
            }
            Ask::Preview(command) => self.editor.preview(&command),
            Ask::EndPreview => self.editor.end_preview(),
            Ask::Select(selection) => self.editor.select(selection),
            Ask::Act(action) => self.editor.act(action, view),
            Ask::Session(session) => {
                let mode = session.mode;
                let tool = session.tool();
                if mode != self.editor.session.mode {
                    self.editor.set_mode(mode, view);
                } else if tool != self.editor.session.tool() {
                    self.editor.take_up(tool, view);
                } else {
                    self.editor.session = *session;
                }
                self.keep_pressure();
            }
            Ask::Timeline(event) => self.editor.timeline(event),
            Ask::Mend(mend) => self.mend(mend),
            Ask::SaveCopy => self.save_asking(FileAsk::SaveCopy),
            Ask::ShowProblems => self.sheets.problems = !self.sheets.problems,
            Ask::Settle(index, settle) => self.settle(index, settle),
            Ask::BringFile(to) => {
                let start = self.editor.document().folder().to_owned();
                self.files.bring_to = Some(to);
                self.files.dialogs.open(ctx, FileAsk::Missing, &start);
            }
            Ask::ChoosePicture(of) => {
                self.files.picture_for = Some(of);
                let start = self.editor.document().folder().to_owned();
                self.files.dialogs.open(ctx, FileAsk::ChoosePicture, &start);
            }
            Ask::NamePicture(of, name) => self.name_picture(&of, name),
            Ask::Menu(item) => panels::open_context_menu(ctx, item),
            Ask::Reach(control) => {
                (self.folds.column, self.folds.everything) = (false, false);
                panels::reach(ctx, &control);
            }
            Ask::TakeUp(tool) => self.editor.take_up(tool, view),
            Ask::Prefer(preference) => self.prefer(preference, ctx),
            Ask::Open(path) => self.open_asking(&path),
            Ask::Copy(words) => ctx.copy_text(words),
            Ask::ChooseMesh(object) => self.choose_mesh(object),
            Ask::Recapture(frame) => self.sheets.recapture = Some(frame),
            Ask::StopWork(WorkKind::Reading) => self.stop_reading(),
            Ask::StopWork(WorkKind::Preparing) => {
                self.picture_flow.stop_preparing();
                self.toast("Preparing was stopped: the picture is the one before", None, false);
            }
            Ask::StopWork(WorkKind::Rendering) => {}
            Ask::ListPresets => self.list_presets(),
            Ask::PicturePresets(of) => self.picture_presets(of),
            Ask::SavePreset(of) => self.ask_for_preset(FileAsk::SavePreset, of, ctx),
            Ask::LoadPreset(of) => self.ask_for_preset(FileAsk::LoadPreset, of, ctx),
            Ask::UsePreset(of, path) => self.use_preset(of, &path),
            Ask::Welcome => self.sheets.welcome = true,
            Ask::KeySheet => self.sheets.keys = true,
            Ask::OwnKeys(own) => self.keep_own_keys(&own),
        }
    }

    pub(super) fn requests(&mut self, ctx: &Context) {
        for request in self.editor.take_requests() {
            let start = self.editor.document().folder().to_owned();
            match request {
                Request::New => self.new_asking(),
                Request::Open => self.files.dialogs.open(ctx, FileAsk::Open, &start),
                Request::Save if self.editor.document().file().is_some() => self.save_own_asking(),
                Request::Save | Request::SaveAs => self.save_asking(FileAsk::SaveAs),
                Request::SaveCopy => self.save_asking(FileAsk::SaveCopy),
                Request::TakeFaces(command, taken) => self.sheets.take_faces = Some((*command, taken)),
                Request::Quit => self.quit_asking(),
                Request::Revert => self.mend(Mend::ReadAgain),
                Request::Import => self.files.dialogs.open(ctx, FileAsk::ImportMesh, &start),
                Request::ReadSource => {
                    if let Some(text) = panels::problems::unread_text(ctx, self.editor.document()) {
                        self.mend(Mend::ReadText(text));
                    }
                }
                Request::Palette => self.sheets.palette = true,
                Request::Shortcuts => self.sheets.shortcuts = true,
                Request::Rename => drop(panels::rename(ctx, self.editor.document())),
                Request::Add => panels::open_add_menu(ctx),
                Request::Menu(item) => panels::open_context_menu(ctx, item),
                Request::ToggleColumn => self.folds.column = !self.folds.column,
                Request::MaximiseViewport => self.folds.everything = !self.folds.everything,
                Request::NextArea => panels::next_area(ctx),
                Request::Render => self.open_render_sheet(),
                Request::ExportMovie => self.open_movie_sheet(),
                Request::Recapture(frame) => self.sheets.recapture = Some(frame),
            }
        }
    }
}
