//! Lights in the viewport: where their icons are, which one is under the pointer, and how one is moved.

use glam::{DMat3, DQuat, DVec2, DVec3};
use impasto_scene::document::{Light, LightKey, LightKind};
use impasto_scene::motion;

use super::Editor;
use crate::command::{self, Command};
use crate::euler;
use crate::picking::View;
use crate::selection::Item;
use crate::session::Mode;
use crate::transform::{Operation, TransformDelta};

/// How far from the middle of the scene a sun's icon is, world units.
const AWAY: f64 = 2.0;

/// The pointer is on an icon up to this distance from the icon's middle, pixels.
const REACH_PX: f64 = 14.0;

/// Where a light has its icon.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPlace {
    /// The light, as it is at the frame that is shown.
    pub light: Light,
    /// Position of the icon in world space. The icon of a lamp or a spot is where the light stands, that of a sun is in
    /// the direction that the sun shines from, and that of a sky is above the scene.
    pub position: DVec3,
}

impl Editor {
    /// Where the lights of the shown scene have their icons. Empty outside of Arrange, and while two pictures are
    /// compared.
    pub fn light_places(&self) -> Vec<LightPlace> {
        if self.session.mode != Mode::Arrange || self.session.compare {
            return Vec::new();
        }
        let (middle, frame, scene) = (self.middle(), self.session.frame, &self.document.shown().scene);
        let lights = motion::lights_at(scene, frame).into_iter();
        let place = |light: Light| Some(LightPlace { position: place_of(&light, middle)?, light });
        lights.filter_map(place).collect()
    }

    fn middle(&self) -> DVec3 {
        let objects = 0..self.document.shown().scene.objects.len();
        let bounds = self.picker.bounds_in_world(objects, &self.poses());
        bounds.map_or(DVec3::ZERO, |[low, high]| (low + high) * 0.5)
    }

    /// The light whose icon is under the pointer; of several, the nearest to the eye.
    pub(super) fn light_at(&self, at_px: DVec2, view: &View) -> Option<Item> {
        let is_under = |place: &LightPlace| {
            view.project(place.position).is_some_and(|icon_px| icon_px.distance(at_px) <= REACH_PX)
        };
        let nearest = self
            .light_places()
            .into_iter()
            .filter(is_under)
            .min_by(|a, b| view.depth(a.position).total_cmp(&view.depth(b.position)))?;
        Some(Item::Light(nearest.light.name))
    }

    pub(super) fn active_light(&self) -> Option<LightPlace> {
        let Some(Item::Light(name)) = self.document.selection().active() else { return None };
        self.light_places().into_iter().find(|place| place.light.name == *name)
    }

    /// The command that moves or turns a light. If the light has keys, the command sets a key at the frame that is
    /// shown. `None` if lights of this kind cannot be moved or turned like that. The columns of `axes` are the axes of
    /// `delta` in world space.
    pub(super) fn light_command(&self, name: &str, delta: TransformDelta, axes: DMat3) -> Option<Command> {
        // The light without the preview, as it was when the drag began.
        let (stored, frame) = (self.document.scene(), self.session.frame);
        let light = motion::light_at(stored, stored.lights.iter().find(|light| light.name == name)?, frame);
        let middle = self.middle();
        let tidy = |at: DVec3| Some(at.map(euler::tidy).to_array());
        let stated = match (light.kind, delta) {
            (LightKind::Point | LightKind::Spot, TransformDelta::Move(by)) => {
                let position = DVec3::from(light.position?) + axes * by;
                LightKey { position: tidy(position), ..LightKey::at(frame) }
            }
            (LightKind::Sun, TransformDelta::Move(by)) => {
                // The icon goes round the scene at a constant distance.
                let direction = (middle - place_of(&light, middle)? - axes * by).try_normalize()?;
                LightKey { direction: tidy(direction), ..LightKey::at(frame) }
            }
            (LightKind::Sun | LightKind::Spot, TransformDelta::Turn { axis, angle_rad }) => {
                let turn = DQuat::from_axis_angle((axes * axis).normalize_or(DVec3::Y), angle_rad);
                let direction = turn * DVec3::from(light.direction?).try_normalize()?;
                LightKey { direction: tidy(direction), ..LightKey::at(frame) }
            }
            _ => return None,
        };
        let what = if stated.direction.is_some() { "direction" } else { "place" };
        command::set_light(stored, name, stated, what)
    }
}

/// Why an operation cannot be done with a kind of light; `None` if it can.
pub(super) fn refusal(kind: LightKind, operation: Operation) -> Option<&'static str> {
    match (kind, operation) {
        (LightKind::Ambient, _) => Some("A sky comes from all around: it has no place"),
        (_, Operation::Move) | (LightKind::Sun | LightKind::Spot, Operation::Turn) => None,
        (_, Operation::Turn) => Some("A lamp shines all round: it can only be moved"),
        (_, Operation::Scale) => Some("A light has no size: its intensity is in the inspector"),
    }
}

fn place_of(light: &Light, middle: DVec3) -> Option<DVec3> {
    Some(match light.kind {
        LightKind::Point | LightKind::Spot => DVec3::from(light.position?),
        LightKind::Sun => middle - DVec3::from(light.direction?).normalize_or(DVec3::NEG_Y) * AWAY,
        LightKind::Ambient => middle + DVec3::Y * (0.75 * AWAY),
    })
}
