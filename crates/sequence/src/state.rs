//! The state of a frame: one short text that stands for everything that the frame depends on. It is noted in the
//! frame's file, so that a frame of another state is not taken for a finished one.

use impasto_gl_render::ShaderTexts;
use impasto_painting::FrameOptions;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::save;

use crate::Wanted;

/// A hash of the scene as it was read (with what the command line changed), the bytes of all files that it reads, the
/// settings of its frames, the wanted kinds of files, replaced shaders, and the program's version: 32 hexadecimal
/// digits. It does not depend on where the files lie. A file that cannot be opened any more counts as empty.
pub fn state(loaded: &LoadedScene, options: &FrameOptions, wanted: &Wanted, shaders: &ShaderTexts) -> String {
    let mut sum = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        sum.update(&(bytes.len() as u64).to_le_bytes());
        sum.update(bytes);
    };
    add(env!("CARGO_PKG_VERSION").as_bytes());
    add(save::to_ron(&loaded.scene).as_bytes());
    add(format!("{options:?} {:?} {:?} {shaders:?}", wanted.png, wanted.exr).as_bytes());
    // The text of the scene file does not count: the scene itself is counted above, and comments change no picture.
    let is_text =
        |path: &std::path::Path| path == loaded.path && path.extension().is_some_and(|it| it == "ron");
    let of_file = |path: &std::path::PathBuf| {
        let mut sum = blake3::Hasher::new();
        // If reading fails, the bytes that were read until then count.
        let _ = std::fs::File::open(path).and_then(|file| sum.update_reader(file).map(|_| ()));
        *sum.finalize().as_bytes()
    };
    let mut files: Vec<[u8; 32]> =
        loaded.inputs().iter().filter(|path| !is_text(path)).map(of_file).collect();
    files.sort_unstable();
    add(files.as_flattened());
    sum.finalize().to_hex()[..32].to_owned()
}
