//! Finds what the overlay shows of motion in the mode Animate: the path of the selected object with its keys, and its
//! outlines at the keys before and after. Also finds the boxes in place of missing meshes.

use glam::{DAffine3, DVec3};
use impasto_editor_model::editor::Editor;
use impasto_painting::Painting;
use impasto_scene::document::{Object, Scene};
use impasto_scene::motion;

use super::picture_view::PictureView;
use crate::viewport::Framing;
use crate::viewport::overlay::{MissingMesh, MotionPath, Outline};
use crate::viewport::surface_map::{StandingBody, SurfaceMap};

/// A path is made of at most about this many places.
const MAX_PLACES: f64 = 400.0;
/// Ghosts, the object's outlines at other frames, are made from a coarse map with this many cells per point of the
/// window.
const CELLS_PER_POINT: f64 = 0.3;

/// The path of an object from its first key to its last; none if it does not move.
pub(super) fn path(scene: &Scene, object: usize) -> Option<MotionPath> {
    let keys = &scene.objects.get(object)?.keys;
    let (first, last) = (keys.first()?.frame, keys.last()?.frame);
    let place = |frame: f64| motion::poses_at(scene, frame)[object].translation;
    let step = ((last - first) / MAX_PLACES).max(1.0);
    let count = ((last - first) / step).floor() as usize;
    let places = (0..=count).map(|index| first + index as f64 * step).chain([last]);
    let places: Vec<DVec3> = places.map(place).collect();
    let moves = places.iter().any(|at| at.distance_squared(places[0]) > 1e-12);
    let keys = keys.iter().map(|key| (key.frame, place(key.frame))).collect();
    moves.then_some(MotionPath { places, keys })
}

/// The object's outlines at the keys before and after the frame, seen by the current camera.
pub(super) fn ghosts(
    painting: &Painting,
    picture: &PictureView<'_>,
    framing: &Framing,
    object: usize,
) -> Vec<Outline> {
    let Some(keys) = painting.scene().objects.get(object).map(|object| &object.keys) else {
        return Vec::new();
    };
    let frames = keys.iter().map(|key| key.frame);
    let before = frames.clone().rfind(|frame| *frame < picture.frame);
    let after = frames.clone().find(|frame| *frame > picture.frame);
    let view = framing.view(picture.camera);
    let ghost = |frame: f64| {
        let mut bodies = StandingBody::all(painting, frame);
        for (index, body) in bodies.iter_mut().enumerate() {
            body.visible &= index == object;
        }
        Outline::new(&SurfaceMap::new(&bodies, &view, CELLS_PER_POINT), |other| other == object)
    };
    before.into_iter().chain(after).map(ghost).collect()
}

/// Boxes for objects whose meshes were not found, at their current poses.
pub(super) fn missing(editor: &Editor, poses: &[DAffine3]) -> Vec<MissingMesh> {
    let document = editor.document();
    let boxed = |(index, object): (usize, &Object)| {
        let is_missing = !object.hidden && document.lacks_mesh(&object.mesh);
        let bounds = editor.picker().bounds_in_model(index).filter(|_| is_missing)?;
        let pose = poses.get(index)?;
        let corner =
            |corner: usize| DVec3::from_array([0, 1, 2].map(|axis| bounds[corner >> axis & 1][axis]));
        let corners = std::array::from_fn(|index| pose.transform_point3(corner(index)));
        Some(MissingMesh { name: object.name.clone(), corners })
    };
    document.shown().scene.objects.iter().enumerate().filter_map(boxed).collect()
}

#[cfg(test)]
mod tests {
    use impasto_scene::document::ObjectKey;

    use super::*;

    #[test]
    fn a_path_goes_from_key_to_key_and_what_stands_still_has_none() {
        let path_of = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
        let mut scene = impasto_scene::load::load(&path_of, &Default::default()).expect("it opens").scene;
        assert_eq!(path(&scene, 1), None);
        let key = |frame, x| ObjectKey { translation: [x, 0.0, 0.0], ..ObjectKey::at(frame) };
        scene.objects[1].keys = vec![key(0.0, -1.0), key(60.0, 1.0)];
        let track = path(&scene, 1).expect("it moves");
        assert_eq!(track.keys, [(0.0, DVec3::NEG_X), (60.0, DVec3::X)]);
        assert_eq!((track.places.first(), track.places.last()), (Some(&DVec3::NEG_X), Some(&DVec3::X)));
        assert_eq!(track.places.len(), 62, "one for each frame 0 to 60, and the last key");
        scene.objects[1].keys[1].frame = 1e9;
        assert!(path(&scene, 1).is_some_and(|track| track.places.len() <= 402), "too many places");
        assert_eq!(path(&scene, 9), None);
    }
}
