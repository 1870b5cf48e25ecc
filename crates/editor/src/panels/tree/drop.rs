//! Dragging rows of the tree: an object dropped onto another becomes its child. A drop between rows changes the order,
//! and gives an object the parent of the object beside it.

use egui::{DragAndDrop, PointerButton, Rect, Response, Stroke, StrokeKind, Ui};
use impasto_editor_model::Item;
use impasto_editor_model::command::{Command, Edit};
use impasto_scene::document::Scene;

use super::rows::TreeLine;
use crate::panels::Ask;
use crate::theme::Tokens;

/// Where a dragged row would go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DropTarget<'a> {
    Before(&'a Item),
    After(&'a Item),
    Onto(&'a Item),
    /// On no item's row: below all rows, or on the row of the canvas.
    Off,
}

/// Begins to drag a row; the camera's row cannot be dragged.
pub(super) fn begin(response: &Response, item: &Item) {
    if *item != Item::Camera && response.drag_started_by(PointerButton::Primary) {
        response.dnd_set_drag_payload(item.clone());
    }
}

/// Shows where the dragged row would go, and asks for the change when it is released.
pub(super) fn drag_and_drop(
    ui: &Ui,
    scene: &Scene,
    rows: &[TreeLine],
    placed: &[Rect],
    area: Rect,
    asks: &mut Vec<Ask>,
) {
    let Some(item) = DragAndDrop::payload::<Item>(ui.ctx()) else { return };
    let Some(at) = ui.input(|input| input.pointer.latest_pos()).filter(|at| area.contains(*at)) else {
        return;
    };
    let over = placed.iter().position(|rect| rect.contains(at));
    let target = over.and_then(|index| Some((rows[index].item.as_ref()?, placed[index])));
    let (place, rect) = match target {
        Some((onto, rect)) => {
            let part = (at.y - rect.top()) / rect.height();
            let place = match part {
                ..0.3 => DropTarget::Before(onto),
                0.7.. => DropTarget::After(onto),
                _ => DropTarget::Onto(onto),
            };
            (place, rect)
        }
        None => (DropTarget::Off, area),
    };
    let Some(command) = command_of(scene, &item, place) else { return };
    let line = Stroke::new(2.0, Tokens::of(ui).accent_text);
    match place {
        DropTarget::Before(_) => _ = ui.painter().hline(rect.x_range(), rect.top(), line),
        DropTarget::After(_) => _ = ui.painter().hline(rect.x_range(), rect.bottom(), line),
        DropTarget::Onto(_) => _ = ui.painter().rect_stroke(rect, 4.0, line, StrokeKind::Inside),
        DropTarget::Off => {}
    }
    if ui.input(|input| input.pointer.any_released()) {
        DragAndDrop::clear_payload(ui.ctx());
        asks.push(Ask::Do(command));
    }
}

/// The command for dropping `dragged` at `place`; `None` if nothing would change.
fn command_of(scene: &Scene, dragged: &Item, place: DropTarget<'_>) -> Option<Command> {
    let reorder = |target: &Item, after: bool| {
        let [from, to] = [dragged, target].map(|item| index_of(scene, item));
        let (from, to) = (from?, to? + usize::from(after));
        let to = if from < to { to - 1 } else { to };
        (to != from).then(|| Command::Edit(Edit::Reorder(dragged.clone(), to)))
    };
    let set_parent = |object: &str, parent: Option<&str>| {
        let (object, parent) = (object.to_owned(), parent.map(str::to_owned));
        Command::Edit(Edit::SetParent { object, parent })
    };
    let parent_of = |name: &str| {
        let object = scene.objects.iter().find(|object| object.name == name);
        object.and_then(|object| object.parent.as_deref())
    };
    match (dragged, place) {
        (_, DropTarget::Before(target) | DropTarget::After(target) | DropTarget::Onto(target))
            if target == dragged =>
        {
            None
        }
        (Item::Object(name), DropTarget::Onto(Item::Object(onto))) => {
            (parent_of(name) != Some(onto)).then(|| set_parent(name, Some(onto)))
        }
        (
            Item::Object(name),
            DropTarget::Before(Item::Object(beside)) | DropTarget::After(Item::Object(beside)),
        ) => {
            let (DropTarget::Before(target) | DropTarget::After(target)) = place else { return None };
            let moved = reorder(target, matches!(place, DropTarget::After(_)));
            let parent = parent_of(beside);
            if parent == parent_of(name) {
                return moved;
            }
            let text =
                parent.map_or(format!("Take {name} off"), |parent| format!("Put {name} under {parent}"));
            Some(Command::Several(text, std::iter::once(set_parent(name, parent)).chain(moved).collect()))
        }
        (Item::Object(name), DropTarget::Off) => parent_of(name).is_some().then(|| set_parent(name, None)),
        (Item::Region(_), DropTarget::Before(target @ Item::Region(_)))
        | (Item::Light(_), DropTarget::Before(target @ Item::Light(_)))
        | (Item::Touch(_), DropTarget::Before(target @ Item::Touch(_))) => reorder(target, false),
        (
            Item::Region(_),
            DropTarget::After(target @ Item::Region(_)) | DropTarget::Onto(target @ Item::Region(_)),
        )
        | (
            Item::Light(_),
            DropTarget::After(target @ Item::Light(_)) | DropTarget::Onto(target @ Item::Light(_)),
        )
        | (
            Item::Touch(_),
            DropTarget::After(target @ Item::Touch(_)) | DropTarget::Onto(target @ Item::Touch(_)),
        ) => reorder(target, true),
        _ => None,
    }
}

fn index_of(scene: &Scene, item: &Item) -> Option<usize> {
    match item {
        Item::Object(name) => scene.objects.iter().position(|object| object.name == *name),
        Item::Region(name) => scene.regions.iter().position(|region| region.name == *name),
        Item::Light(name) => scene.lights.iter().position(|light| light.name == *name),
        Item::Touch(name) => scene.touches.iter().position(|touch| touch.name == *name),
        Item::Camera | Item::Guide(..) => None,
    }
}
