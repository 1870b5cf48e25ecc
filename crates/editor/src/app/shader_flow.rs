//! Shaders of one's own, in place of the program's: read again whenever they change, for pictures and for files.

use std::time::{Duration, Instant};

use egui::Context;
use impasto_gl_render::ShaderTexts;

use super::EditorApp;
use impasto_gl_render::shader_folder::ShaderFolder;

/// Time between two looks at the folder.
const LOOK: Duration = Duration::from_millis(500);

/// The folder, where one was named.
#[derive(Default)]
pub(super) struct ShaderFlow {
    folder: Option<ShaderFolder>,
    texts: ShaderTexts,
    next_look: Option<Instant>,
}

impl ShaderFlow {
    /// What files are drawn with.
    pub(super) fn texts(&self) -> ShaderTexts {
        self.texts.clone()
    }

    /// What a command is told to draw with the same.
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

    /// Looks at the folder, now and then.
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
                }
                Some(Err(words)) => self.toast(words, None, true),
            }
        }
        ctx.request_repaint_after(LOOK);
    }
}
