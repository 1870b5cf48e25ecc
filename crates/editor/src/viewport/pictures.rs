//! The worker's pictures as textures.

use egui::{ColorImage, Context, ImageData, TextureHandle, TextureId, TextureOptions};

use crate::worker::{Picture, ViewJob};

/// The last picture of each view.
#[derive(Default)]
pub struct Pictures {
    shown: Vec<Option<Shown>>,
}

struct Shown {
    texture: TextureHandle,
    size: [usize; 2],
    view: ViewJob,
    exact: bool,
}

impl Pictures {
    /// Takes a picture in; only the texture of its own view changes.
    pub fn take(&mut self, ctx: &Context, picture: Picture) {
        if self.shown.len() <= picture.index {
            self.shown.resize_with(picture.index + 1, || None);
        }
        let Picture { index, view, image, exact, .. } = picture;
        let size = image.size;
        let slot = &mut self.shown[index];
        let options = TextureOptions::LINEAR;
        match slot {
            Some(shown) if shown.size == size => shown.texture.set(ImageData::Color(image), options),
            _ => {}
        }
        let texture = match slot.take() {
            Some(shown) if shown.size == size => shown.texture,
            // A texture of another size is another texture: the old one is shown to the end of this pass.
            _ => ctx.load_texture(format!("view {index}"), ImageData::Color(image), options),
        };
        *slot = Some(Shown { texture, size, view, exact });
    }

    /// The texture of a view with what it shows, and whether it is exact.
    pub fn of(&self, index: usize) -> Option<(TextureId, &ViewJob, bool)> {
        let shown = self.shown.get(index)?.as_ref()?;
        Some((shown.texture.id(), &shown.view, shown.exact))
    }

    /// Forgets all: another document.
    pub fn clear(&mut self) {
        self.shown.clear();
    }
}

/// An empty picture, for tests of what surrounds it.
pub fn plain_image(size: [usize; 2], colour: egui::Color32) -> ColorImage {
    ColorImage::filled(size, colour)
}
