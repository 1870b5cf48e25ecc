//! The menu in the head of the scene tree that adds meshes, lights and regions to the scene.

use std::collections::BTreeSet;

use egui::{Popup, Response, ScrollArea, Ui};
use glam::DVec3;
use impasto_editor_model::Item;
use impasto_editor_model::command::{Arrange, Command, Regions};
use impasto_editor_model::keymap::Action;
use impasto_scene::document::{LightKind, Region, Scene, Selector};
use impasto_scene::motion;

use crate::icons::{self, Icon};
use crate::panels::column_state::ColumnState;
use crate::panels::{Ask, PanelInput};
use crate::widgets::Button;

pub(super) fn menu(button: &Response, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let asked = ColumnState::with(&button.ctx, |state| std::mem::take(&mut state.opens_add_menu));
    if asked {
        Popup::open_id(&button.ctx, Popup::default_response_id(button));
    }
    Popup::menu(button).width(190.0).show(|ui| entries(ui, shown, asks));
}

pub(in crate::panels) fn entries(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.set_min_width(190.0);
    // The menu is never higher than the window.
    let most = ui.ctx().content_rect().height() - 80.0;
    ScrollArea::vertical().max_height(most).show(ui, |ui| {
        for Addition { icon, words, ask } in additions(shown) {
            if Button::new(&words).icon(icon).plain().show(ui).clicked() {
                asks.push(ask);
                ui.close();
            }
        }
    });
}

pub(in crate::panels) struct Addition {
    icon: Icon,
    /// What it is, such as *Lamp*.
    pub(in crate::panels) words: String,
    pub(in crate::panels) ask: Ask,
}

/// Everything that can be added to the scene as it is.
pub(in crate::panels) fn additions(shown: &PanelInput<'_>) -> Vec<Addition> {
    let words = "Import mesh\u{2026}".to_owned();
    let mut all = vec![Addition { icon: icons::OBJECT, words, ask: Ask::Act(Action::ImportMesh) }];
    let kinds = [
        ("Sun", LightKind::Sun),
        ("Lamp", LightKind::Point),
        ("Spot", LightKind::Spot),
        ("Sky", LightKind::Ambient),
    ];
    all.extend(kinds.into_iter().map(|(words, kind)| Addition {
        icon: icons::LIGHT,
        words: words.to_owned(),
        ask: Ask::Do(Command::Arrange(light(shown, kind))),
    }));
    let object = object_of(shown.document.scene(), shown.document.selection().active());
    let regions = object.map(|object| regions(shown, object)).unwrap_or_default();
    all.extend(regions.into_iter().map(|region| Addition {
        icon: icons::REGION,
        words: match &region.on {
            Selector::Object(object) => format!("Region on {object}"),
            _ => format!("Region {}", region.name),
        },
        ask: Ask::Do(Command::Regions(Regions::Add(Box::new(region)))),
    }));
    all
}

/// A light above the camera's line of sight and to its left. It shines at the camera's target.
fn light(shown: &PanelInput<'_>, kind: LightKind) -> Arrange {
    let camera = motion::camera_at(shown.document.scene(), shown.session.frame);
    let back = camera.eye - camera.target;
    let left = back.cross(DVec3::Y).normalize_or(DVec3::NEG_X) * back.length();
    let at = camera.target + 0.5 * back + 0.5 * left + DVec3::Y * (0.7 * back.length());
    Arrange::AddLight { kind, at, toward: camera.target }
}

/// The selected object, or the object that the selected region, guide or touch is on.
fn object_of<'a>(scene: &'a Scene, active: Option<&'a Item>) -> Option<&'a str> {
    match active? {
        Item::Object(name) => Some(name),
        Item::Region(name) | Item::Guide(name, _) => {
            scene.regions.iter().find(|region| region.name == *name)?.on.object()
        }
        Item::Touch(name) => {
            scene.touches.iter().find(|touch| touch.name == *name).map(|touch| touch.on.as_str())
        }
        Item::Camera | Item::Light(_) => None,
    }
}

/// Regions that the object could have but does not have yet: the whole of it, its groups, its materials.
fn regions(shown: &PanelInput<'_>, object: &str) -> Vec<Region> {
    let loaded = shown.document.loaded();
    let of_object = loaded.scene.objects.iter().find(|other| other.name == object);
    let mut wanted = vec![Region::new(object, Selector::Object(object.to_owned()))];
    if let Some(mesh) = of_object.and_then(|object| loaded.meshes.get(&object.mesh)) {
        let groups = mesh.groups.iter().filter(|name| mesh.groups.len() > 1 && !name.is_empty());
        wanted.extend(
            groups.map(|group| Region::new(group, Selector::Group(object.to_owned(), group.clone()))),
        );
        let named = mesh.materials.iter().filter(|of| mesh.materials.len() > 1 && !of.name.is_empty());
        wanted.extend(named.map(|material| {
            let on = Selector::Material(object.to_owned(), material.name.clone());
            Region::new(material.name.clone(), on)
        }));
    }
    // A group and a material of the same name usually cover the same faces.
    let part = |region: &Region| match &region.on {
        Selector::Group(_, name) | Selector::Material(_, name) => Some(name.clone()),
        _ => None,
    };
    let mut parts = BTreeSet::new();
    wanted.retain(|region| part(region).is_none_or(|name| parts.insert(name)));
    let taken = |region: &Region| {
        loaded.scene.regions.iter().any(|other| {
            other.on.object() == Some(object)
                && (other.on == region.on || part(other).is_some() && part(other) == part(region))
        })
    };
    wanted.retain(|region| !taken(region));
    wanted
}
