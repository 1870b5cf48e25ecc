//! The user's own shaders (`--shaders`): read again whenever they change, and used for pictures and files.

use std::time::{Duration, Instant};

use egui::Context;
use impasto_gl_render::ShaderTexts;

use super::EditorApp;
use impasto_gl_render::shader_folder::ShaderFolder;

/// How often the folder is checked.
const LOOK: Duration = Duration::from_millis(500);

#[derive(Default)]
pub(super) struct ShaderFlow {
    folder: Option<ShaderFolder>,
    texts: ShaderTexts,
    next_look: Option<Instant>,
}

impl ShaderFlow {
    /// The shaders to render files with.
    pub(super) fn texts(&self) -> ShaderTexts {
        self.texts.clone()
    }

    /// The arguments with which `impasto render` uses the same shaders.
    pub(super) fn arguments(&self) -> Vec<String> {
        let folder = self.folder.as_ref().map(|folder| folder.path().to_string_lossy().into_owned());
        folder.map_or_else(Vec::new, |folder| vec!["--shaders".to_owned(), folder])
    }
}

impl EditorApp {
    /// Draws with a folder's shaders from now on.
    pub(super) fn use_shaders(&mut self, opened: Option<(ShaderFolder, ShaderTexts)>) {
        let Some((folder, texts)) = opened else { return };
        self.picture_flow.replace_shaders(texts.clone());
        self.shaders = ShaderFlow { folder: Some(folder), texts, next_look: None };
    }

    /// Checks the folder from time to time, and draws with what has changed.
    pub(super) fn look_at_shaders(&mut self, ctx: &Context) {
        let flow = &mut self.shaders;
        let Some(folder) = &mut flow.folder else { return };
        let now = Instant::now();
        if flow.next_look.is_none_or(|at| now >= at) {
            flow.next_look = Some(now + LOOK);
            match folder.look() {
                None => {}
                Some(Ok(texts)) => {
                    flow.texts.clone_from(&texts);
                    self.picture_flow.replace_shaders(texts);
                    self.presets.forget_pictures();
                }
                Some(Err(words)) => self.toast(words, None, true),
            }
        }
        ctx.request_repaint_after(LOOK);
    }
}
