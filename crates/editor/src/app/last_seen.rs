//! Remembers mode and view of each scene, so that it opens again as it was left.

use std::path::Path;

use glam::DVec3;
use impasto_editor_model::camera_rig::{FreeView, Looking};
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

use super::EditorApp;
use crate::files::preferences::LastView;

impl EditorApp {
    /// Remembers the size of the window, and mode and view of the open scene.
    pub(super) fn note_closing(&mut self) {
        let size = self.ctx.content_rect().size() * self.ctx.zoom_factor();
        self.preferences.window_size = (size.x, size.y);
        self.keep_preferences();
        self.note_last_seen();
    }

    pub(super) fn note_last_seen(&mut self) {
        let Some(file) = self.editor.document().file().map(Path::to_owned) else { return };
        let view = match &self.editor.looking {
            Looking::Shot => None,
            Looking::Free(free) => Some(view_of(free.pose())),
        };
        self.preferences.note_last_seen(&file, self.editor.session.mode, view);
        self.keep_preferences();
    }

    /// Restores mode and view of a scene that was just opened.
    pub(super) fn go_to_last_seen(&mut self, file: &Path) {
        let Some(seen) = self.preferences.last_seen_in(file).cloned() else { return };
        let view = self.picture_flow.view(&self.editor);
        self.editor.set_mode(seen.mode, &view);
        if let Some(view) = seen.view {
            let free = free_view(&view, &self.editor.shot());
            self.editor.looking = Looking::Free(free);
        }
    }
}

fn view_of(pose: &CameraPose) -> LastView {
    LastView {
        eye: pose.eye.to_array(),
        target: pose.target.to_array(),
        roll_deg: pose.roll_rad.to_degrees(),
        orthographic: matches!(pose.lens, Lens::Orthographic { .. }),
    }
}

/// A free view from a remembered one, with the shot's lens. If only the view or only the lens is orthographic, the lens
/// is switched as by [`FreeView::toggle_orthographic`]. The zoom of an orthographic view is not remembered.
pub(super) fn free_view(view: &LastView, shot: &CameraPose) -> FreeView {
    let mut free = FreeView::new(CameraPose {
        eye: DVec3::from(view.eye),
        target: DVec3::from(view.target),
        roll_rad: view.roll_deg.to_radians(),
        shift: glam::DVec2::ZERO,
        lens: shot.lens.clone(),
    });
    if view.orthographic != matches!(shot.lens, Lens::Orthographic { .. }) {
        free.toggle_orthographic();
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot(lens: Lens) -> CameraPose {
        CameraPose {
            eye: DVec3::new(0.0, 0.0, 4.0),
            target: DVec3::ZERO,
            roll_rad: 0.0,
            shift: glam::DVec2::ZERO,
            lens,
        }
    }

    #[test]
    fn a_view_comes_back_as_it_was_left() {
        let perspective = Lens::Perspective { fov_y_deg: 35.0, near: 0.01, far: 100.0 };
        let mut free = FreeView::new(shot(perspective.clone()));
        free.orbit(glam::DVec2::new(40.0, 12.0), DVec3::ZERO);
        let back = free_view(&view_of(free.pose()), &shot(perspective.clone()));
        assert!(back.pose().eye.distance(free.pose().eye) < 1e-9);
        assert_eq!(back.pose().lens, free.pose().lens);
        free.toggle_orthographic();
        let back = free_view(&view_of(free.pose()), &shot(perspective));
        let height = |free: &FreeView| match free.pose().lens {
            Lens::Orthographic { height, .. } => height,
            Lens::Perspective { .. } => 0.0,
        };
        assert!(height(&free) > 0.0 && (height(&back) - height(&free)).abs() < 1e-9);
    }
}
