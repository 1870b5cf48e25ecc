//! The areas of the window, which `F6` steps through. Each has a focus stop before its first control, so that `Tab`
//! goes on into the area.

use egui::{Context, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};

use crate::theme::Tokens;

/// The areas in the order of `F6`, with their names for screen readers.
const ORDER: [(Area, &str); 7] = [
    (Area::TopBar, "Top bar"),
    (Area::Options, "Tool options"),
    (Area::Rail, "Tools"),
    (Area::Viewport, "Picture"),
    (Area::Tree, "Scene tree"),
    (Area::Inspector, "Inspector"),
    (Area::Strip, "Timeline"),
];

/// A part of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Menus, undo, modes.
    TopBar,
    /// Settings of the tool.
    Options,
    /// Tools.
    Rail,
    /// The picture.
    Viewport,
    /// What is in the scene.
    Tree,
    /// Settings of what is selected.
    Inspector,
    /// The timeline.
    Strip,
}

/// Where the areas of the last pass lay, in the order in which they were shown.
#[derive(Clone, Debug, Default)]
struct Places {
    pass: u64,
    rects: Vec<(Area, Rect)>,
}

fn id_of(area: Area) -> Id {
    Id::unique(("area of the window", area as u8))
}

fn places_id() -> Id {
    Id::unique("areas of the window")
}

/// Shows an area, with a ring round it while the area itself has the focus and not one of its controls.
pub fn area<R>(ui: &mut Ui, area: Area, show: impl FnOnce(&mut Ui) -> R) -> R {
    let before = ui.available_rect_before_wrap();
    let corner = Rect::from_min_size(before.min, egui::Vec2::ZERO);
    let response = ui.interact(corner, id_of(area), Sense::focusable_noninteractive());
    let name = ORDER.iter().find(|(other, _)| *other == area).map_or("", |(_, name)| name);
    response.widget_info(|| WidgetInfo::labeled(Role::Group, true, name));
    let shown = show(ui);
    let rect = taken(before, ui.available_rect_before_wrap());
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|data| {
        let places: &mut Places = data.get_temp_mut_or_default(places_id());
        if places.pass != pass {
            *places = Places { pass, rects: Vec::new() };
        }
        places.rects.push((area, rect));
    });
    if response.has_focus() {
        let ring = Stroke::new(2.0, Tokens::of(ui).accent_text);
        ui.ctx().debug_painter().rect_stroke(rect.shrink(1.0), 0.0, ring, StrokeKind::Inside);
    }
    shown
}

/// The part of the `Ui` that a panel took: a strip at one side, or else all of it.
fn taken(before: Rect, after: Rect) -> Rect {
    let mut rect = before;
    if after.top() > before.top() {
        rect.max.y = after.top();
    } else if after.bottom() < before.bottom() {
        rect.min.y = after.bottom();
    } else if after.left() > before.left() {
        rect.max.x = after.left();
    } else if after.right() < before.right() {
        rect.min.x = after.right();
    }
    rect
}

/// Moves the focus to the next area, or to the first area if the focus is in none.
pub fn next_area(ctx: &Context) {
    let places: Places = ctx.data(|data| data.get_temp(places_id())).unwrap_or_default();
    let shown: Vec<(Area, Rect)> = ORDER
        .iter()
        .filter_map(|(area, _)| places.rects.iter().find(|(other, _)| other == area).copied())
        .collect();
    let focused = ctx.memory(|memory| memory.focused());
    let at = focused.and_then(|focused| {
        let itself = shown.iter().position(|(area, _)| id_of(*area) == focused);
        let within = || {
            let middle = ctx.read_response(focused)?.rect.center();
            shown.iter().position(|(_, rect)| rect.contains(middle))
        };
        itself.or_else(within)
    });
    let next = at.map_or(0, |at| (at + 1) % shown.len().max(1));
    if let Some((area, _)) = shown.get(next) {
        ctx.memory_mut(|memory| memory.request_focus(id_of(*area)));
    }
}

#[cfg(test)]
mod tests {
    use egui::{Event, Key, Modifiers, Panel, RawInput, pos2, vec2};

    use super::*;

    /// Shows a window for one pass. It has three areas, each with a button: a bar, a column and the rest.
    fn pass(ctx: &Context, events: Vec<Event>) {
        let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 300.0)));
        let output = ctx.run_ui(RawInput { events, screen_rect, ..RawInput::default() }, |ui| {
            area(ui, Area::TopBar, |ui| Panel::top("bar").show(ui, |ui| _ = ui.button("New")));
            area(ui, Area::Tree, |ui| Panel::right("column").show(ui, |ui| _ = ui.button("Add")));
            area(ui, Area::Viewport, |ui| {
                egui::CentralPanel::default().show(ui, |ui| _ = ui.button("Look"));
            });
        });
        output.drop_without_applying_deltas();
    }

    fn focused(ctx: &Context) -> Option<Id> {
        ctx.memory(|memory| memory.focused())
    }

    #[test]
    fn f6_walks_the_areas_that_are_there_and_tab_goes_on_inside() {
        let ctx = Context::default();
        pass(&ctx, Vec::new());
        let mut order = Vec::new();
        for _ in 0..4 {
            next_area(&ctx);
            pass(&ctx, Vec::new());
            order.push(focused(&ctx));
        }
        let expected = [Area::TopBar, Area::Viewport, Area::Tree, Area::TopBar].map(|area| Some(id_of(area)));
        assert_eq!(order, expected);

        let key = |pressed| Event::Key {
            key: Key::Tab,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        pass(&ctx, vec![key(true), key(false)]);
        pass(&ctx, Vec::new());
        let inside = focused(&ctx).expect("a control has the focus");
        assert_ne!(inside, id_of(Area::TopBar));
        let rect = ctx.read_response(inside).expect("it is shown").rect;
        assert!(rect.top() < 40.0 && rect.left() < 100.0, "not the bar's button: {rect:?}");
        // From a control inside, on to the next area.
        next_area(&ctx);
        pass(&ctx, Vec::new());
        assert_eq!(focused(&ctx), Some(id_of(Area::Viewport)));
    }
}
