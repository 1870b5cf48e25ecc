//! A new scene for a shot, with the shot's camera, lights and motion; and a background and lights for a shot without
//! lights.

use std::path::Path;
use std::sync::Arc;

use super::axes::Axes;
use super::scheme::{self, Scheme};
use super::{bare, object_name};
use crate::document::{Brought, Color, Scene, StrokeSettings};
use crate::limits;
use crate::mesh_file::MeshFile;
use crate::motion;
use crate::shot::Shot;

/// The longer side of the picture if the shot states no size, pixels.
const LONGER_PX: f64 = 1280.0;

/// The widest aspect of a picture if the shot states no size; the tallest is its inverse.
const MOST_ASPECT: f64 = 4.0;

/// A scene that paints a shot as its file has it. The picture has the size that the shot states, or else the aspect of
/// the shot's camera. A shot without lights is lit from one side. `meshes` are those of the shot's objects.
pub fn for_shot(path: &Path, meshes: &[Arc<MeshFile>], shot: &Arc<Shot>) -> Scene {
    let name_hash = scheme::name_hash(&object_name(path));
    let scheme = Scheme::of(&meshes.iter().map(|mesh| &**mesh).collect::<Vec<_>>(), name_hash);
    let aspect = shot.camera_aspect().unwrap_or(16.0 / 9.0).clamp(1.0 / MOST_ASPECT, MOST_ASPECT);
    // Movies need even sides.
    let even = |side: f64| 2 * (side / 2.0).round() as u32;
    let [width, height] = [aspect, 1.0].map(|side| even(LONGER_PX * side / aspect.max(1.0)));
    let fits = |side: u32| (1..=limits::MAX_SIDE_PX).contains(&side);
    let stated = shot.size_px().filter(|size| size.iter().all(|&side| fits(side)));
    let mut scene = Scene {
        size: stated.map_or((width, height), |[width, height]| (width, height)),
        // A shot with lights brings a sky, which takes the place of the default.
        background: if shot.has_lights() { Color::default() } else { scheme.plain_ground() },
        shot: Some(path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()),
        // Smaller strokes than usual: an unknown shot may have much fine detail.
        strokes: StrokeSettings { scale: Some(0.7), ..Default::default() },
        ..bare()
    };
    if !shot.has_lights() {
        let mut staged = scene.clone();
        Arc::clone(shot).enter(&mut staged);
        let camera = motion::camera_at(&staged, staged.timeline.first as f64);
        scene.lights = scheme.lights(Axes::looking_from(camera.eye - camera.target), 1.0);
    }
    scene
}
