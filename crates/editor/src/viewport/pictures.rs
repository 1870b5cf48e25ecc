//! Keeps the latest picture of each view as a texture for egui.

use egui::{Context, ImageData, TextureHandle, TextureId, TextureOptions};

use crate::worker::{Picture, ViewJob};

/// The last picture of each view.
#[derive(Default)]
pub struct Pictures {
    shown: Vec<Option<ShownPicture>>,
}

struct ShownPicture {
    texture: TextureHandle,
    view: ViewJob,
    serial: u64,
    exact: bool,
}

impl Pictures {
    /// Takes a new picture; only the texture of its view changes.
    pub fn take(&mut self, ctx: &Context, picture: Picture) {
        let Picture { index, view, serial, image, exact, .. } = picture;
        if self.shown.len() <= index {
            self.shown.resize_with(index + 1, || None);
        }
        let options = TextureOptions::LINEAR;
        match &mut self.shown[index] {
            Some(shown) => {
                shown.texture.set(ImageData::Color(image), options);
                (shown.view, shown.serial, shown.exact) = (view, serial, exact);
            }
            empty => {
                let texture = ctx.load_texture(format!("view {index}"), ImageData::Color(image), options);
                *empty = Some(ShownPicture { texture, view, serial, exact });
            }
        }
    }

    /// The texture of a view, the view as it was drawn, and whether the picture is exact.
    pub fn of(&self, index: usize) -> Option<(TextureId, &ViewJob, bool)> {
        let shown = self.shown.get(index)?.as_ref()?;
        Some((shown.texture.id(), &shown.view, shown.exact))
    }

    /// Whether the latest picture is exact, and shows this view of the scene with this serial.
    pub fn is_exact(&self, index: usize, view: &ViewJob, serial: u64) -> bool {
        let shown = self.shown.get(index).and_then(Option::as_ref);
        shown.is_some_and(|shown| shown.exact && shown.serial == serial && shown.view.looks_like(view))
    }

    /// Drops all pictures: another document was opened, or the scene has become empty.
    pub fn clear(&mut self) {
        self.shown.clear();
    }
}
