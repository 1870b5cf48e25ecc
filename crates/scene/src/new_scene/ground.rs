//! The ground that a model stands on: laid in its new scene, or chosen later.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use super::axes::Axes;
use super::framing::Footing;
use super::scheme::{self, Scheme};
use super::{add, object_name};
use crate::built_in_mesh;
use crate::document::{
    Color, Direction, Edges, LayerSettings, LightKind, MaterialOverride, Object, Region, Scene, Selector,
    StrokeSettings,
};
use crate::mesh_file::MeshFile;
use crate::motion;

/// The wall's strokes lean by one of these angles, degrees.
const WALL_DEG: [f64; 6] = [-38.0, -24.0, -14.0, 16.0, 27.0, 40.0];

/// What a model stands on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// A floor and a wall that fill the picture.
    #[default]
    Backdrop,
    /// A patch of floor in front of a plain background.
    Vignette,
    /// Nothing: one colour.
    Plain,
}

/// A ground as it is laid under a model.
#[derive(Debug)]
pub(super) struct Laid {
    pub object: Option<Object>,
    pub regions: Vec<Region>,
    pub background: Color,
}

impl Ground {
    /// All, with their names on the command line.
    pub const ALL: [(&'static str, Self); 3] =
        [("backdrop", Self::Backdrop), ("vignette", Self::Vignette), ("plain", Self::Plain)];

    /// Lays the ground. `taken` are the names of other objects; `seed` chooses how the wall's strokes lean.
    pub(super) fn lay(self, footing: &Footing, scheme: &Scheme, taken: &[&str], seed: u32) -> Laid {
        let names = match self {
            Self::Backdrop => ["backdrop", "wall", "the backdrop"],
            Self::Vignette => ["floor", "patch", "the floor"],
            Self::Plain => {
                return Laid { object: None, regions: Vec::new(), background: scheme.plain_ground() };
            }
        };
        let all_taken = || add::unique(names[0], &taken.iter().copied().collect());
        let free = names.into_iter().find(|name| !taken.contains(name));
        let name = free.map_or_else(all_taken, str::to_owned);
        let name = name.as_str();
        let (object, parts) = if self == Self::Backdrop {
            let wall_deg = WALL_DEG[(seed >> 8) as usize % WALL_DEG.len()];
            let parts = vec![(built_in_mesh::WALL, wall_deg, 5.0), (built_in_mesh::FLOOR, 0.0, 3.0)];
            (footing.backdrop(name), parts)
        } else {
            (footing.patch(name), vec![(built_in_mesh::FLOOR, 0.0, 4.0)])
        };
        let material = Some(MaterialOverride { color: Some(scheme.ground), ..Default::default() });
        let region = |(group, angle_deg, jitter_deg): (&str, f64, f64)| Region {
            direction: Direction::Angle(angle_deg),
            // The patch ends in ragged strokes.
            strokes: StrokeSettings {
                edges: (self == Self::Vignette).then_some(Edges::Overrun(30.0)),
                ..quiet(jitter_deg)
            },
            ..Region::new(format!("{name} {group}"), Selector::Group(name.to_owned(), group.to_owned()))
        };
        let regions = parts.into_iter().map(region).collect();
        Laid { object: Some(Object { material, ..object }), regions, background: self.background(scheme) }
    }

    fn background(self, scheme: &Scheme) -> Color {
        if self == Self::Backdrop { scheme.background() } else { scheme.plain_ground() }
    }

    /// The kind of ground that an object is; `None` if the object is no ground.
    pub fn of_object(object: &Object) -> Option<Self> {
        match object.mesh.as_str() {
            built_in_mesh::BACKDROP => Some(Self::Backdrop),
            built_in_mesh::PATCH => Some(Self::Vignette),
            _ => None,
        }
    }

    /// The ground of a scene: that of its first backdrop or patch of floor.
    pub fn of_scene(scene: &Scene) -> Self {
        scene.objects.iter().find_map(Self::of_object).unwrap_or(Self::Plain)
    }

    /// Lays this ground under the objects of a scene, as [`for_mesh`](super::for_mesh) lays it under a new model:
    /// turned to the camera, under the objects' rest shapes as they stand at the reference frame. `color` is that of
    /// the ground; `None` chooses one. The scene's background changes only if it is the default or comes from a ground.
    ///
    /// # Errors
    /// Why there can be no floor; nothing is laid then.
    pub fn lay_under(
        self,
        scene: &mut Scene,
        meshes: &BTreeMap<String, Arc<MeshFile>>,
        color: Option<Color>,
    ) -> Result<(), NoGround> {
        let Some(footing) = footing_in(scene, meshes) else {
            return if self == Self::Plain { Ok(()) } else { Err(NoGround::NothingStands) };
        };
        let looks_down = footing.axes.back.y > 0.0;
        if self != Self::Plain && !looks_down {
            return Err(NoGround::SeenFromBelow);
        }
        let models = || scene.objects.iter().filter(|object| !built_in_mesh::is_built_in(&object.mesh));
        // Several objects may be groups of one file.
        let names: BTreeSet<&str> = models().map(|object| object.mesh.as_str()).collect();
        let files: Vec<&MeshFile> = names.iter().filter_map(|&name| Some(&**meshes.get(name)?)).collect();
        let name_hash =
            models().next().map_or(0, |first| scheme::name_hash(&object_name(Path::new(&first.mesh))));
        let chosen = Scheme::of(&files, name_hash);
        let mut colored = chosen.clone();
        colored.ground = color.unwrap_or(chosen.ground);
        let keeps_background = is_of_no_ground(scene.background, [&chosen, &colored]);
        // A plain ground ignores `color` and takes the scheme's own colour. `is_of_no_ground` later recognizes that
        // colour as one that nobody chose.
        let scheme = if self == Self::Plain { chosen } else { colored };
        let taken: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
        let laid = self.lay(&footing, &scheme, &taken, name_hash);
        scene.objects.extend(laid.object);
        // The ground's regions go first. Later regions win, so those that a person has made take precedence.
        let taken: HashSet<&str> = scene.regions.iter().map(|region| region.name.as_str()).collect();
        let named = |region: Region| Region { name: add::unique(&region.name, &taken), ..region };
        let regions: Vec<Region> = laid.regions.into_iter().map(named).collect();
        scene.regions.splice(0..0, regions);
        if !keeps_background {
            scene.background = laid.background;
        }
        Ok(())
    }
}

/// Whether somebody chose this background: it is not the default, and no ground sets it with one of these schemes.
fn is_of_no_ground(background: Color, schemes: [&Scheme; 2]) -> bool {
    let given =
        schemes.into_iter().flat_map(|scheme| Ground::ALL.map(|(_, ground)| ground.background(scheme)));
    background != Color::default() && given.into_iter().all(|color| color != background)
}

/// Why no floor is laid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoGround {
    /// Nothing is seen but built-in meshes.
    #[error("Nothing is there that could stand on a ground")]
    NothingStands,
    /// The camera looks up.
    #[error("The camera looks from below: a floor would hide everything")]
    SeenFromBelow,
}

/// The footing of a scene's objects at its reference frame, without hidden ones and built-in meshes; `None` if there is
/// nothing to stand on a ground.
fn footing_in(scene: &Scene, meshes: &BTreeMap<String, Arc<MeshFile>>) -> Option<Footing> {
    let frame = motion::referred_to(scene, &scene.reference).1;
    let mut bounds: Option<[DVec3; 2]> = None;
    let placed = motion::poses_at(scene, frame).into_iter().zip(motion::hidden_at(scene, frame));
    for (object, (pose, hidden)) in scene.objects.iter().zip(placed) {
        let Some(mesh) =
            meshes.get(&object.mesh).filter(|_| !hidden && !built_in_mesh::is_built_in(&object.mesh))
        else {
            continue;
        };
        let group =
            object.group.as_ref().and_then(|group| mesh.groups.iter().position(|other| other == group));
        let world_from_file = pose.matrix3 * object.model_from_file();
        for (triangle, corners) in mesh.mesh.triangles.iter().enumerate() {
            let of_group = mesh.mesh.group_of_triangle.get(triangle);
            if group.is_some_and(|group| of_group.is_some_and(|&other| other as usize != group)) {
                continue;
            }
            for &corner in corners {
                let at = world_from_file * mesh.mesh.positions[corner as usize].as_dvec3() + pose.translation;
                bounds = Some(bounds.map_or([at; 2], |[low, high]| [low.min(at), high.max(at)]));
            }
        }
    }
    let [low, high] = bounds?;
    let camera = motion::camera_at(scene, frame);
    let axes = Axes::looking_from(camera.eye - camera.target);
    let sun = scene.lights.iter().find(|light| light.kind == LightKind::Sun);
    let light = sun.and_then(|sun| sun.direction).map_or(1.0, |goes| DVec3::from(goes).dot(axes.right));
    Some(Footing::of_bounds(low, high, axes, if light < 0.0 { -1.0 } else { 1.0 }))
}

/// Settings for a ground that does not draw the eye: large strokes that lie one way.
fn quiet(jitter_deg: f64) -> StrokeSettings {
    let layer = |(name, coverage, thickness): (&str, Option<f64>, f64)| LayerSettings {
        name: name.to_owned(),
        coverage,
        thickness: Some(thickness),
        ..Default::default()
    };
    StrokeSettings {
        scale: Some(1.6),
        angle_jitter_deg: Some(jitter_deg),
        swing_deg: Some(2.0),
        color_jitter: Some(0.35),
        grading: Some(0.5),
        layers: [
            ("body", None, 0.22),
            ("form", None, 0.12),
            ("scumble", None, 0.12),
            ("accents", None, 0.12),
            ("contour", Some(0.0), 0.0),
        ]
        .map(layer)
        .into(),
        ..Default::default()
    }
}
