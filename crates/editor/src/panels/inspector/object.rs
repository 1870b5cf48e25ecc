//! The inspector of an object: its pose, mesh, material, parent and regions.

use egui::Ui;
use impasto_editor_model::command::{Arrange, Command, Edit};
use impasto_editor_model::{Item, PictureFor, Selection};
use impasto_scene::document::{Color, MaterialOverride, Object, Scene};
use impasto_scene::limits::MAX_PARTICLES_OF_OBJECT;
use impasto_scene::new_scene::Ground;

use super::number::Number;
use super::parts::{
    FieldStyle, at_end, body, head, head_icon, head_note, note, pick, reset, row, section, seen, text,
};
use super::picture::Picture;
use super::{Asker, ground, noise, pose};
use crate::icons;
use crate::panels::Ask;
use crate::panels::status_line::grouped;
use crate::panels::tree::region_color;
use crate::theme::Tokens;
use crate::widgets::{self, Button, RowMark, Tip, TreeRow};

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, name: &str) {
    let scenes = [asker.scene(), asker.stored()];
    let [Some(object), Some(stored)] =
        scenes.map(|scene| scene.objects.iter().find(|object| object.name == name))
    else {
        return;
    };
    let item = Item::Object(name.to_owned());
    let document = asker.shown.document;
    let mesh =
        document.shown().meshes.get(&object.mesh).filter(|_| !document.lacks_mesh(&object.mesh)).cloned();
    let tokens = Tokens::of(ui);
    head(ui, |ui| {
        let (icon, colour) =
            if mesh.is_some() { (icons::OBJECT, tokens.weak) } else { (icons::WARNING, tokens.vermilion) };
        head_icon(ui, icon, colour);
        asker.name(ui, "Object name", &item);
        if let Some(mesh) = &mesh {
            head_note(ui, &format!("{} triangles", grouped(mesh.mesh.triangles.len())));
        }
        at_end(ui, |ui| asker.eye_and_lock(ui, &item, "Object", [object.hidden, object.locked]));
    });
    if mesh.is_none() {
        missing(ui, asker, object);
    }
    if object.locked {
        body(ui, |ui| note(ui, &format!("{name} is locked.")));
    }
    ui.add_enabled_ui(!object.locked, |ui| {
        let first = scenes[0].objects.iter().find(|object| Ground::of_object(object).is_some());
        if first.is_some_and(|first| first.name == name) {
            body(ui, |ui| ground::choice(ui, asker));
        }
        pose::of_object(ui, asker, [object, stored]);
        if mesh.is_some() {
            section(ui, "Mesh", "", false, |ui| mesh_rows(ui, asker, [object, stored]));
        }
        section(ui, "Material", "", true, |ui| material(ui, asker, [object, stored]));
        let parent = object.parent.as_deref().unwrap_or("none");
        section(ui, "Parent", parent, false, |ui| parent_row(ui, asker, object));
    });
    let count = scenes[0].regions.iter().filter(|region| region.on.object() == Some(name)).count();
    section(ui, "Regions", &count.to_string(), false, |ui| regions(ui, asker, name));
}

/// Shown for an object whose mesh file is missing.
fn missing(ui: &mut Ui, asker: &mut Asker<'_, '_>, object: &Object) {
    body(ui, |ui| {
        let name = &object.name;
        note(
            ui,
            &format!(
                "The mesh was not found. A box stands in for it, and nothing else about the {name} was lost."
            ),
        );
        ui.add_space(4.0);
        path_row(ui, asker, object, FieldStyle::Wrong);
        let likely = asker.shown.likely_meshes.iter().find(|(missing, _)| *missing == object.mesh);
        if let Some((_, mesh)) = likely {
            let words = format!("Use {}", mesh.rsplit('/').next().unwrap_or(mesh));
            let button = Button::new(&words).name(&format!("{words} for {name}")).primary().show(ui);
            let tip = Tip { name: &words, effect: mesh, ..Tip::default() };
            if tip.on(button).clicked() {
                let (object, mesh) = (name.clone(), mesh.clone());
                asker.ask(Command::Arrange(Arrange::ReplaceMesh { object, mesh }));
            }
            ui.add_space(4.0);
        }
        let locate = format!("Locate mesh of {name}");
        let button = Button::new("Locate\u{2026}").name(&locate);
        let button = if likely.is_some() { button.show(ui) } else { button.primary().show(ui) };
        if button.clicked() {
            asker.asks.push(Ask::ChooseMesh(name.clone()));
        }
        ui.add_space(4.0);
    });
}

fn path_row(ui: &mut Ui, asker: &mut Asker<'_, '_>, object: &Object, look: FieldStyle) {
    let key = egui::Id::unique(("mesh", &object.name));
    let typed = row(ui, "Mesh", |ui| text(ui, "Mesh file", key, &object.mesh, look));
    if let Some(mesh) = typed {
        let object = object.name.clone();
        asker.ask(Command::Arrange(Arrange::ReplaceMesh { object, mesh }));
    }
}

fn mesh_rows(ui: &mut Ui, asker: &mut Asker<'_, '_>, [object, stored]: [&Object; 2]) {
    path_row(ui, asker, object, FieldStyle::Field);
    let name = &object.name;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if Button::new("Replace\u{2026}").name("Replace mesh").show(ui).clicked() {
            asker.asks.push(Ask::ChooseMesh(name.clone()));
        }
        let upright = Button::new("Turn upright").show(ui);
        let tip =
            Tip { name: "Turn upright", effect: "For a mesh that was made with Z up.", ..Tip::default() };
        if tip.on(upright).clicked() {
            asker.ask(Command::Arrange(Arrange::TurnUpright(name.clone())));
        }
        let metre = Button::new("To 1 m").name("Scale to 1 m").show(ui);
        let tip =
            Tip { name: "Scale to 1 m", effect: "Its longest side becomes one unit.", ..Tip::default() };
        if tip.on(metre).clicked() {
            asker.ask(Command::Arrange(Arrange::ScaleTo(name.clone(), 1.0)));
        }
    });
    let set = |count| Command::Arrange(Arrange::SetParticles(name.clone(), count));
    row(ui, "Particles", |ui| {
        let mut own = usize::from(object.particles.is_some());
        if widgets::segmented_of(ui, "Particles", &["Auto", "Own"], &mut own).changed() {
            asker.ask(set((own == 1).then_some(10_000)));
        }
        if let (Some(shown), Some(stored)) = (object.particles, stored.particles) {
            let number = Number {
                range: 1.0..=100_000.0,
                limits: Some(1.0..=MAX_PARTICLES_OF_OBJECT as f64),
                step: (1000.0, 0),
                unlabelled: Some(ui.available_width().min(80.0)),
                ..Number::new("Particle count", "Strokes that the object has for all sizes of the picture.")
            };
            asker.number(
                ui,
                &number,
                [shown as f64, stored as f64],
                |to| set(to.map(|to| to.round() as u64)),
            );
        }
    });
}

fn material(ui: &mut Ui, asker: &mut Asker<'_, '_>, of_object: [&Object; 2]) {
    let [object, stored] = of_object;
    let [shown, stored] = [object, stored].map(|object| object.material.clone().unwrap_or_default());
    let set = |material: MaterialOverride| {
        let material = (material != MaterialOverride::default()).then_some(material);
        Command::Arrange(Arrange::SetMaterial(object.name.clone(), material))
    };
    let file = asker.shown.document.shown().meshes.get(&object.mesh);
    row(ui, "Colour", |ui| {
        // With several materials, or a picture, there is no single colour to show, so white is shown.
        let of_mesh = match file.map(|file| &file.materials[..]) {
            Some([only]) if only.texture.is_none() && shown.texture.is_none() => Color(only.color),
            _ => Color::white(),
        };
        let colour = seen(shown.color.unwrap_or(of_mesh));
        let square = asker.colour(ui, "Material colour", colour, |color| {
            set(MaterialOverride { color: Some(color), ..stored.clone() })
        });
        let effect = "In place of the colours and pictures of the mesh. A texture is multiplied by it.";
        Tip { name: "Colour", effect, ..Tip::default() }.on(square);
        if shown.color.is_some() {
            if reset(ui, "Material colour") {
                asker.ask(set(MaterialOverride { color: None, ..stored.clone() }));
            }
        } else {
            note(ui, if shown.texture.is_some() { "as the picture" } else { "as the mesh" });
        }
    });
    let of = PictureFor::Texture(object.name.clone());
    let effect = "A picture on its surface, in place of those of the mesh: PNG, JPEG, BMP, TGA or WebP.";
    let texture = shown.texture.as_deref();
    asker.picture(ui, &Picture { label: "Texture", name: "Texture file", effect, of, file: texture });
    if texture.is_some() && file.is_some_and(|file| file.mesh.uvs.is_empty()) {
        note(ui, "The mesh has no UV coordinates, so nothing says where the picture lies.");
    }
    let of_file =
        file.and_then(|file| file.materials.first()).map_or(0.0, |material| f64::from(material.gloss));
    let gloss = Number {
        default: shown.gloss.map(|_| of_file),
        ..Number::share("Gloss", "Strength of highlights: 0 matt, 1 glazed.")
    };
    let values = [shown.gloss, stored.gloss].map(|gloss| gloss.unwrap_or(of_file));
    asker.number(ui, &gloss, values, |gloss| set(MaterialOverride { gloss, ..stored.clone() }));
    let mut unlit = shown.unlit;
    if widgets::checkbox(ui, "Without light or shadow", &mut unlit).changed() {
        asker.ask(set(MaterialOverride { unlit, ..stored.clone() }));
    }
    noise::rows(ui, asker, of_object);
}

fn parent_row(ui: &mut Ui, asker: &mut Asker<'_, '_>, object: &Object) {
    let scene = asker.stored();
    let others = scene.objects.iter().filter(|other| !is_under(scene, other, &object.name));
    let names: Vec<&str> = std::iter::once("none").chain(others.map(|other| other.name.as_str())).collect();
    let parent = object.parent.as_deref();
    let chosen =
        parent.and_then(|parent| names[1..].iter().position(|name| *name == parent)).map_or(0, |at| at + 1);
    row(ui, "Parent", |ui| {
        let tip = Tip { name: "Parent", effect: "It moves with this object.", ..Tip::default() };
        if let Some(picked) = pick(ui, tip, &names, chosen) {
            let parent = (picked > 0).then(|| names[picked].to_owned());
            asker.ask(Command::Edit(Edit::SetParent { object: object.name.clone(), parent }));
        }
    });
}

/// Whether an object is `name`, or a descendant of it. Also true if its parents form a cycle.
fn is_under(scene: &Scene, object: &Object, name: &str) -> bool {
    let mut next = Some(object);
    for _ in 0..=scene.objects.len() {
        let Some(object) = next else { return false };
        if object.name == name {
            return true;
        }
        next = scene.objects.iter().find(|other| Some(&other.name) == object.parent.as_ref());
    }
    true
}

fn regions(ui: &mut Ui, asker: &mut Asker<'_, '_>, name: &str) {
    let scene = asker.scene();
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut any = false;
    for region in scene.regions.iter().filter(|region| region.on.object() == Some(name)) {
        any = true;
        let response = TreeRow {
            name: &region.name,
            spoken: &format!("Go to {}", region.name),
            mark: RowMark::Colour(region_color(scene, &region.name)),
            depth: 0,
            expanded: None,
            selected: false,
            note: "",
            keyed: false,
            hidden: region.hidden,
            locked: region.locked,
        }
        .show_bare(ui)
        .response;
        if response.clicked() {
            asker.asks.push(Ask::Select(Selection::only(Item::Region(region.name.clone()))));
        }
    }
    if !any {
        note(ui, "No regions. Comb over it, and it gets one.");
    }
}
