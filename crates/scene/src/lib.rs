//! The document and its files: reads, checks and saves scenes and presets, reads meshes and pictures, evaluates
//! keyframes, and says where in a file a problem is.

pub mod aovs;
pub mod assets;
pub mod built_in_mesh;
pub mod check;
pub mod document;
mod found_files;
pub mod gltf;
pub mod kept_folder;
pub mod limits;
pub mod load;
pub mod loaded;
pub mod locate;
pub mod memory;
pub mod mesh_file;
pub mod mesh_format;
pub mod morph;
pub mod motion;
mod nearest;
pub mod new_scene;
pub mod obj;
pub mod point_cache;
pub mod presets;
pub mod problem;
pub mod save;
pub mod shot;
pub mod strokes_file;
mod surface;
pub mod texture;
mod values;
pub mod whole_file;
