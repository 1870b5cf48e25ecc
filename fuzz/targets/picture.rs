//! Fuzzes pictures for textures and brushes: they are refused, or read with as many pixels as their size says.

#![no_main]

use std::path::Path;

use impasto_scene::texture;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for name in ["p.png", "p.jpg", "p.tga", "p.bmp"] {
        let Ok(decoded) = texture::decode(Path::new(name), bytes) else { continue };
        let [width, height] = decoded.texture.size_px.map(|side| side as usize);
        assert!(width > 0 && height > 0);
        assert_eq!(decoded.texture.rgba8.len(), width * height);
    }
});
