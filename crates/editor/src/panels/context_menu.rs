//! The menu that a right click opens at the pointer: on rows of the tree, lanes and guides, and in the picture. Its
//! commands act on what is selected; their words and keys are those of the menus at the top.

use egui::containers::menu::menu_style;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Context, Id, Layout, Popup, PopupAnchor, PopupKind, Pos2, Role, Sense, Ui, WidgetInfo, vec2,
};
use impasto_editor_model::Item;
use impasto_editor_model::keymap::Action;

use super::menus::{self, Line};
use super::{Ask, PanelInput};
use crate::theme::{Tokens, measure, type_face};

use Line::{Add, Do, Separator};

const OF_OBJECT: &[Line] = &[
    Do(Action::Comb),
    Do(Action::Touch),
    Separator,
    Do(Action::Move),
    Do(Action::Turn),
    Do(Action::Scale),
    Separator,
    Do(Action::Duplicate),
    Do(Action::Rename),
    Do(Action::Delete),
    Separator,
    Do(Action::Hide),
    Do(Action::Lock),
    Separator,
    Do(Action::FrameSelected),
    Do(Action::SetKey),
];

const OF_REGION: &[Line] = &[
    Do(Action::Comb),
    Do(Action::GuideCurve),
    Do(Action::Fill),
    Do(Action::TurnDirection),
    Do(Action::Smooth),
    Do(Action::Erase),
    Do(Action::Touch),
    Do(Action::Amount),
    Do(Action::Region),
    Separator,
    Do(Action::Duplicate),
    Do(Action::Rename),
    Do(Action::Delete),
    Separator,
    Do(Action::Hide),
    Do(Action::Lock),
    Separator,
    Do(Action::SetKey),
];

const OF_TOUCH: &[Line] = &[
    Do(Action::Touch),
    Separator,
    Do(Action::Duplicate),
    Do(Action::Rename),
    Do(Action::Delete),
    Separator,
    Do(Action::Hide),
];

const OF_GUIDE: &[Line] = &[Do(Action::Duplicate), Do(Action::Delete)];

const OF_LIGHT: &[Line] = &[
    Do(Action::Move),
    Do(Action::Turn),
    Separator,
    Do(Action::Duplicate),
    Do(Action::Rename),
    Do(Action::Delete),
    Separator,
    Do(Action::SetKey),
];

const OF_CAMERA: &[Line] =
    &[Do(Action::LookThrough), Do(Action::CameraFromView), Separator, Do(Action::SetKey)];

const OF_VIEW: &[Line] = &[
    Add,
    Separator,
    Do(Action::SelectAll),
    Do(Action::SelectNone),
    Do(Action::ShowAll),
    Separator,
    Do(Action::FrameAll),
    Do(Action::ViewFront),
    Do(Action::ViewRight),
    Do(Action::ViewTop),
    Do(Action::ToggleOrthographic),
    Do(Action::LookThrough),
    Do(Action::CameraFromView),
    Separator,
    Do(Action::CycleDirections),
    Do(Action::ToggleTrust),
    Do(Action::Compare),
];

/// The item that the menu is about (`None` for the view), and where the menu opened.
#[derive(Clone)]
struct Opened {
    about: Option<Item>,
    at: Pos2,
}

fn id() -> Id {
    Id::unique("menu at the pointer")
}

/// Opens the menu of an item, or with `None` that of the view, at the pointer.
pub fn open_context_menu(ctx: &Context, about: Option<Item>) {
    let Some(at) = ctx.input(|input| input.pointer.latest_pos()) else { return };
    ctx.data_mut(|data| data.insert_temp(id(), Opened { about, at }));
    Popup::open_id(ctx, id());
    ctx.request_repaint();
}

/// Shows the menu while it is open. `Esc` and a click close it.
pub fn context_menu(ui: &Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let Some(Opened { about, at }) = ui.data(|data| data.get_temp(id())) else { return };
    let popup = Popup::new(id(), ui.ctx().clone(), PopupAnchor::Position(at), ui.layer_id());
    let popup = popup.kind(PopupKind::Menu).open_memory(None).style(menu_style);
    popup.layout(Layout::top_down_justified(Align::Min)).show(|ui| {
        let lines = match &about {
            Some(Item::Object(_)) => OF_OBJECT,
            Some(Item::Region(_)) => OF_REGION,
            Some(Item::Guide(..)) => OF_GUIDE,
            Some(Item::Touch(_)) => OF_TOUCH,
            Some(Item::Light(_)) => OF_LIGHT,
            Some(Item::Camera) => OF_CAMERA,
            None => OF_VIEW,
        };
        if let Some(about) = &about {
            head(ui, &words_of(about, shown.document.selection().items().len()));
        }
        menus::list(ui, lines, shown, asks);
    });
}

fn words_of(about: &Item, selected: usize) -> String {
    match about {
        _ if selected > 1 => format!("{selected} things"),
        Item::Guide(region, index) => format!("Guide g{} of {region}", index + 1),
        Item::Camera => "Shot camera".to_owned(),
        about => about.name().to_owned(),
    }
}

/// The name of what the menu is about, in line with the words below.
fn head(ui: &mut Ui, words: &str) {
    const INDENT: f32 = 28.0;
    let weak = Tokens::of(ui).weak;
    let mut job = LayoutJob::simple_singleline(words.to_owned(), type_face::small(), weak);
    job.wrap = TextWrapping::truncate_at_width(220.0);
    let galley = ui.painter().layout_job(job);
    let size = vec2(galley.size().x + 2.0 * INDENT, measure::HIT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let at = rect.left_center() + vec2(INDENT, -galley.size().y / 2.0);
    ui.painter().galley(at, galley, weak);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
}
