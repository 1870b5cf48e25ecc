//! Keeps the text of a scene that could not be read completely, with a list of what was lost, so that the user can
//! repair it.

use std::collections::BTreeMap;
use std::sync::Arc;

use impasto_scene::document::Scene;
use impasto_scene::load::salvage::{Loss, Salvaged};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::locate::Located;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::problem::Problem;

use crate::stamp::hash;

/// The text that a scene was read from, and what could not be read of it. `losses` may be empty: the text is then
/// stored because the user was editing it when the window was killed.
#[derive(Clone, Debug)]
pub struct Source {
    /// The text.
    pub text: String,
    /// What could not be read, in the order of the text.
    pub losses: Vec<Loss>,
    /// The scene as far as it was read.
    pub(crate) scene: Scene,
    /// Boxes in place of meshes that cannot be used, by the meshes' names.
    stand_ins: BTreeMap<String, Arc<MeshFile>>,
}

impl Source {
    /// The source of a salvaged scene; none if nothing was lost.
    pub(crate) fn of(salvaged: &Salvaged) -> Option<Self> {
        (!salvaged.losses.is_empty()).then(|| Self::with_any_losses(salvaged))
    }

    /// The source of a salvaged scene, even if nothing was lost.
    pub(crate) fn with_any_losses(salvaged: &Salvaged) -> Self {
        let Salvaged { loaded, losses, text } = salvaged;
        let names = losses.iter().filter_map(|loss| loss.mesh.as_ref());
        let stand_in = |name: &String| Some((name.clone(), Arc::clone(loaded.meshes.get(name)?)));
        let stand_ins = names.filter_map(stand_in).collect();
        Self { text: text.clone(), losses: losses.clone(), scene: loaded.scene.clone(), stand_ins }
    }

    /// The source of the scene once it is saved as `text`. Of the losses, only meshes that cannot be used are left.
    /// `None` if all meshes could be used.
    pub(crate) fn saved(&self, text: String, scene: &Scene) -> Option<Self> {
        let located = Located::of(&text);
        let in_text = |loss: &Loss| {
            let mesh = loss.mesh.as_ref()?;
            // A mesh that no object names now stays a loss, because undo may bring its object back.
            let object = scene.objects.iter().position(|object| object.mesh == *mesh);
            let field_path = object.map(|object| format!("objects[{object}].mesh"));
            let problem = Problem {
                place: located.as_ref().zip(field_path.as_ref()).map(|(text, path)| text.place_of(path)),
                field_path: field_path.unwrap_or_default().into(),
                ..loss.problem.clone()
            };
            // A fix applies to the old text, so it is dropped.
            Some(Loss { problem, fix: None, ..loss.clone() })
        };
        let losses: Vec<Loss> = self.losses.iter().filter_map(in_text).collect();
        (!losses.is_empty()).then(|| Self {
            losses,
            scene: scene.clone(),
            stand_ins: self.stand_ins.clone(),
            text,
        })
    }

    /// A hash of which parts could not be read. A later reading of the text gives the same hash if the same parts are
    /// lost again. The file's path does not matter.
    pub(crate) fn losses_hash(&self) -> u64 {
        let parts = self.losses.iter().map(|Loss { problem, mesh, .. }| {
            let place = problem.place.map(|place| (place.line, place.column));
            format!("{place:?} {} {mesh:?}\n", problem.field_path)
        });
        hash(parts.collect::<String>().as_bytes())
    }

    /// The scene with the boxes added to its meshes, so that an edited scene which names an unusable mesh still gets
    /// its box.
    pub(crate) fn held(&self, loaded: &LoadedScene) -> LoadedScene {
        let mut held = loaded.clone();
        for (name, stand_in) in &self.stand_ins {
            held.meshes.entry(name.clone()).or_insert_with(|| Arc::clone(stand_in));
        }
        held
    }

    /// Whether a mesh cannot be used and a box is shown in its place.
    pub(crate) fn has_stand_in(&self, mesh: &str) -> bool {
        self.stand_ins.contains_key(mesh)
    }
}
