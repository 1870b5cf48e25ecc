//! Tiles of noise that colour bodies, on the GPU: each is uploaded once. Those that nothing holds in memory any more
//! are freed when a new one is uploaded.

use std::rc::Rc;
use std::sync::{Arc, Weak};

use impasto_core::noise_displace::Tile;
use impasto_painting::Frame;

use crate::gl::{Format, GlError, Gpu, Texture};

pub(crate) struct NoiseTiles {
    gpu: Gpu,
    tiles: Vec<(Weak<Tile>, Rc<Texture>)>,
}

impl NoiseTiles {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        Self { gpu: gpu.clone(), tiles: Vec::new() }
    }

    /// Uploads those tiles of a frame's visible bodies that are not on the GPU yet.
    pub(crate) fn prepare(&mut self, frame: &Frame) -> Result<(), GlError> {
        let noises = frame.bodies.iter().filter(|body| !body.hidden).filter_map(|body| body.noise.as_ref());
        for noise in noises {
            if let Some(layers) = &noise.noise.layers {
                self.upload(&layers.tile)?;
            }
        }
        Ok(())
    }

    /// The texture of a tile of the frame that was prepared last.
    pub(crate) fn get(&self, tile: &Arc<Tile>) -> Option<&Texture> {
        let is_it = |weak: &Weak<Tile>| std::ptr::eq(weak.as_ptr(), Arc::as_ptr(tile));
        self.tiles.iter().find(|(weak, _)| is_it(weak)).map(|(_, texture)| &**texture)
    }

    fn upload(&mut self, tile: &Arc<Tile>) -> Result<(), GlError> {
        if self.get(tile).is_some() {
            return Ok(());
        }
        self.tiles.retain(|(tile, _)| tile.strong_count() > 0);
        let size = tile.size().map(|side| side as u32);
        let texels = bytemuck::cast_slice(tile.texels());
        let texture = Texture::with_driver_levels(&self.gpu, Format::Rgba32F, size, texels)?;
        self.tiles.push((Arc::downgrade(tile), Rc::new(texture)));
        Ok(())
    }
}
