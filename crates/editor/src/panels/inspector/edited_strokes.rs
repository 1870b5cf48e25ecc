//! The stroke settings that the inspector edits: those of a region or of the whole scene.

use impasto_editor_model::command::{Command, Regions, StrokeChange, StrokesOf};
use impasto_scene::document::{Scene, StrokeSettings};
use impasto_scene::presets::{self, ResolvedStrokes};

use super::Asker;

/// The stroke settings of a region or of the scene. In each pair, the first is as shown, with the change being
/// previewed; the second is as stored.
pub(super) struct EditedStrokes<'a> {
    pub(super) of: StrokesOf,
    pub(super) own: [&'a StrokeSettings; 2],
    /// Preset, scene and region combined. Hidden layers keep their coverage here, so that it can be shown.
    pub(super) resolved: [ResolvedStrokes; 2],
    /// The region's index in the scene as it is shown; `None` for the scene's own settings.
    pub(super) index: Option<usize>,
}

impl<'a> EditedStrokes<'a> {
    /// The settings of the region of this name, or of the scene if `region` is `None`. Returns `None` if the shown or
    /// the stored scene lacks the region.
    pub(super) fn new(asker: &Asker<'a, '_>, region: Option<&str>) -> Option<Self> {
        let scenes = [asker.scene(), asker.stored()];
        let index_in =
            |scene: &Scene| scene.regions.iter().position(|other| Some(other.name.as_str()) == region);
        let indices = scenes.map(index_in);
        if region.is_some() && indices.contains(&None) {
            return None;
        }
        let own = |which: usize| {
            let scene = scenes[which];
            indices[which].map_or(&scene.strokes, |index| &scene.regions[index].strokes)
        };
        let resolved = |which: usize| {
            let of_region = indices[which].map(|index| &scenes[which].regions[index].strokes);
            presets::resolve_with(scenes[which], &scenes[which].strokes, of_region)
        };
        Some(Self {
            of: region.map_or(StrokesOf::Scene, |name| StrokesOf::Region(name.to_owned())),
            own: [own(0), own(1)],
            resolved: [resolved(0), resolved(1)],
            index: indices[0],
        })
    }

    /// What the settings would resolve to if this region or the scene stated `own`.
    pub(super) fn resolve(&self, scene: &Scene, own: &StrokeSettings) -> ResolvedStrokes {
        match self.index {
            Some(_) => presets::resolve_with(scene, &scene.strokes, Some(own)),
            None => presets::resolve_with(scene, own, None),
        }
    }

    pub(super) fn set(&self, change: StrokeChange) -> Command {
        Command::Regions(Regions::SetStroke(self.of.clone(), change))
    }
}
