//! The menus of the top bar: their commands, in order.

use egui::containers::menu::{MenuBar, SubMenu, menu_style};
use egui::{Align2, Popup, RichText, Ui};
use impasto_editor_model::Item;
use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::{DirectionLines, Mode};

use super::{Ask, PanelInput, file_name, problems, row, text_width, tree, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::MenuRow;

/// One line of a menu.
#[derive(Clone, Copy)]
pub(super) enum Line {
    /// A command that may have a key.
    Do(Action),
    Separator,
    Recent,
    /// What can be added to the scene.
    Add,
    /// Puts the command that renders the scene on the clipboard.
    CopyRenderCommand,
    Problems,
    FirstRun,
    KeySheet,
    /// A submenu, with its name and its lines.
    Sub(&'static str, &'static [Line]),
}

use Line::{Add, CopyRenderCommand, Do, FirstRun, KeySheet, Problems, Recent, Separator, Sub};

const MENUS: [(&str, &[Line]); 4] = [
    (
        "File",
        &[
            Do(Action::NewScene),
            Do(Action::OpenScene),
            Recent,
            Do(Action::ImportMesh),
            Separator,
            Do(Action::Save),
            Do(Action::SaveAs),
            Do(Action::SaveCopy),
            Do(Action::Revert),
            Separator,
            Do(Action::Render),
            Do(Action::ExportMovie),
            CopyRenderCommand,
            Separator,
            Do(Action::Quit),
        ],
    ),
    (
        "Edit",
        &[
            Do(Action::Undo),
            Do(Action::Redo),
            Separator,
            Do(Action::SelectAll),
            Do(Action::SelectNone),
            Separator,
            Do(Action::Add),
            Do(Action::Duplicate),
            Do(Action::Rename),
            Do(Action::Delete),
            Separator,
            Do(Action::Hide),
            Do(Action::ShowAll),
            Do(Action::Lock),
            Separator,
            Sub("Tools", TOOLS),
            Sub("Time", TIME),
            Separator,
            KeySheet,
        ],
    ),
    (
        "View",
        &[
            Do(Action::Arrange),
            Do(Action::Paint),
            Do(Action::Animate),
            Do(Action::TogglePaint),
            Do(Action::NextMode),
            Separator,
            Do(Action::FrameSelected),
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
            Separator,
            Do(Action::ToggleColumn),
            Do(Action::MaximiseViewport),
            Do(Action::NextArea),
            Problems,
        ],
    ),
    ("Help", &[Do(Action::Palette), Do(Action::Shortcuts), FirstRun]),
];

const TOOLS: &[Line] = &[
    Do(Action::Select),
    Do(Action::Move),
    Do(Action::Turn),
    Do(Action::Scale),
    Separator,
    Do(Action::Comb),
    Do(Action::GuideCurve),
    Do(Action::Fill),
    Do(Action::TurnDirection),
    Do(Action::Smooth),
    Do(Action::Erase),
    Do(Action::Touch),
    Do(Action::Amount),
    Do(Action::Region),
    Do(Action::Pick),
    Separator,
    Do(Action::SizeRadius),
    Do(Action::SizeStrength),
    Do(Action::SmallerRadius),
    Do(Action::LargerRadius),
    Do(Action::FlipUnderCursor),
];

const TIME: &[Line] = &[
    Do(Action::SetKey),
    Do(Action::Curves),
    Separator,
    Do(Action::Play),
    Do(Action::StepBack),
    Do(Action::StepOn),
    Do(Action::PreviousKey),
    Do(Action::NextKey),
    Do(Action::FirstFrame),
    Do(Action::LastFrame),
];

/// Every action of the menus, in their order, each once.
pub(super) fn actions() -> Vec<Action> {
    fn collect(lines: &[Line], found: &mut Vec<Action>) {
        for line in lines {
            match line {
                Do(action) => found.push(*action),
                Sub(_, lines) => collect(lines, found),
                _ => (),
            }
        }
    }
    let mut found = Vec::new();
    for (_, lines) in MENUS {
        collect(lines, &mut found);
    }
    found
}

pub(super) fn menus(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    const PADDING: f32 = 10.0;
    let wide = MENUS.iter().map(|(name, _)| text_width(ui, name, type_face::body()) + 2.0 * PADDING).sum();
    let size = egui::vec2(wide, measure::BUTTON);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    // A menu bar takes all the width that it is given.
    within(ui, rect, row(), |ui| {
        let style = |style: &mut egui::Style| {
            menu_style(style);
            style.spacing.button_padding = egui::vec2(PADDING, 4.0);
            style.spacing.item_spacing.x = 0.0;
        };
        MenuBar::new().style(style).ui(ui, |ui| {
            for (name, lines) in MENUS {
                ui.menu_button(name, |ui| list(ui, lines, shown, asks));
            }
        });
    });
}

/// Shows the lines of a menu, as wide as the widest of them.
pub(super) fn list(ui: &mut Ui, lines: &[Line], shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let names = lines.iter().map(|line| {
        let keys = if let Do(action) = line { shown.keys_of(*action) } else { String::new() };
        MenuRow { words: words_of(*line), keys: &keys, ..MenuRow::default() }.width(ui)
    });
    let wide = names.fold(0.0, f32::max);
    ui.set_width(wide);
    for line in lines {
        match *line {
            Do(action) => {
                let keys = shown.keys_of(action);
                let row =
                    MenuRow { words: action.name(), keys: &keys, on: is_on(shown, action), marked: false };
                if usable(ui, shown.why_not(action), row) {
                    asks.push(Ask::Act(action));
                }
            }
            Separator => {
                ui.add_space(4.0);
                let line = ui.max_rect().x_range();
                ui.painter().hline(line, ui.cursor().top(), (1.0, Tokens::of(ui).div));
                ui.add_space(5.0);
            }
            Recent => sub(ui, words_of(*line), |ui| recent(ui, shown, asks)),
            Sub(name, lines) => sub(ui, name, |ui| list(ui, lines, shown, asks)),
            Add => sub(ui, words_of(*line), |ui| tree::add_menu(ui, shown, asks)),
            CopyRenderCommand => {
                let command = copied_command(shown);
                let reason = command.as_ref().err().copied();
                if usable(ui, reason, MenuRow { words: words_of(*line), ..MenuRow::default() }) {
                    asks.extend(command);
                }
            }
            KeySheet => {
                if usable(ui, None, MenuRow { words: words_of(*line), ..MenuRow::default() }) {
                    asks.push(Ask::KeySheet);
                }
            }
            Problems => {
                let listed = listed_problems(shown);
                let reason = listed.as_ref().err().copied();
                if usable(ui, reason, MenuRow { words: words_of(*line), ..MenuRow::default() }) {
                    asks.extend(listed);
                }
            }
            FirstRun => {
                if usable(ui, None, MenuRow { words: words_of(*line), ..MenuRow::default() }) {
                    asks.push(Ask::Welcome);
                }
            }
        }
    }
}

/// The request to copy the command that renders the scene, or why there is none.
fn copied_command(shown: &PanelInput<'_>) -> Result<Ask, &'static str> {
    let file = shown.document.file().ok_or("Save the scene first")?;
    Ok(Ask::Copy(render_command(&file.to_string_lossy())))
}

/// The request to show the list of problems, or why there is none.
fn listed_problems(shown: &PanelInput<'_>) -> Result<Ask, &'static str> {
    (problems::count(shown) > 0).then_some(Ask::ShowProblems).ok_or("Nothing is wrong")
}

/// The menu entries whose request is not an action. Each has its words, and the request or why it cannot be made.
pub(super) fn others(shown: &PanelInput<'_>) -> [(&'static str, Result<Ask, &'static str>); 4] {
    [
        (words_of(Problems), listed_problems(shown)),
        (words_of(CopyRenderCommand), copied_command(shown)),
        (words_of(FirstRun), Ok(Ask::Welcome)),
        (words_of(KeySheet), Ok(Ask::KeySheet)),
    ]
}

fn words_of(line: Line) -> &'static str {
    match line {
        Do(action) => action.name(),
        Add => Action::Add.name(),
        Sub(name, _) => name,
        Recent => "Open recent",
        CopyRenderCommand => "Copy render command",
        Problems => "List of problems",
        FirstRun => "First run sheet",
        KeySheet => "Change keys",
        Separator => "",
    }
}

/// A row; with a `reason`, it is disabled and the reason is its tooltip. Returns whether it was clicked.
fn usable(ui: &mut Ui, reason: Option<&str>, row: MenuRow<'_>) -> bool {
    let response = ui.add_enabled_ui(reason.is_none(), |ui| row.show(ui)).inner;
    match reason {
        Some(reason) => response.on_disabled_hover_text(reason).clicked(),
        None => response.clicked(),
    }
}

fn sub(ui: &mut Ui, words: &str, contents: impl FnOnce(&mut Ui)) {
    let response = MenuRow { words, ..MenuRow::default() }.show(ui);
    let at = response.rect.right_center() - egui::vec2(16.0, 0.0);
    let arrow = (icons::FOLDED.glyph(), type_face::icon(18.0));
    ui.painter().text(at, Align2::CENTER_CENTER, arrow.0, arrow.1, Tokens::of(ui).weak);
    SubMenu::new().show(ui, &response, contents);
}

fn recent(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    if shown.recent.is_empty() {
        let words = RichText::new("Scenes you save will be listed here.").font(type_face::small());
        ui.set_width(240.0);
        ui.add_space(4.0);
        ui.label(words.color(Tokens::of(ui).weak));
        ui.add_space(4.0);
    }
    let names: Vec<_> = shown.recent.iter().map(|path| file_name(path)).collect();
    let rows = names.iter().map(|words| MenuRow { words, ..MenuRow::default() });
    let wide = rows.clone().map(|row| row.width(ui)).fold(0.0, f32::max);
    ui.set_width(wide.max(160.0));
    for (row, path) in rows.zip(shown.recent) {
        if row.show(ui).on_hover_text(path.display().to_string()).clicked() {
            asks.push(Ask::Open(path.clone()));
            Popup::close_all(ui.ctx());
        }
    }
}

/// Whether the state that an action sets or toggles is on.
pub(super) fn is_on(shown: &PanelInput<'_>, action: Action) -> bool {
    let session = shown.session;
    let scene = shown.document.scene();
    let hidden_and_locked = || match shown.document.selection().active()? {
        Item::Object(name) => {
            let object = scene.objects.iter().find(|object| object.name == *name)?;
            Some([object.hidden, object.locked])
        }
        Item::Region(name) => {
            let region = scene.regions.iter().find(|region| region.name == *name)?;
            Some([region.hidden, region.locked])
        }
        Item::Touch(name) => {
            let touch = scene.touches.iter().find(|touch| touch.name == *name)?;
            Some([touch.hidden, false])
        }
        Item::Camera | Item::Light(_) | Item::Guide(..) => None,
    };
    match action {
        Action::Hide => hidden_and_locked().is_some_and(|[hidden, _]| hidden),
        Action::Lock => hidden_and_locked().is_some_and(|[_, locked]| locked),
        Action::Arrange => session.mode == Mode::Arrange,
        Action::Paint => session.mode == Mode::Paint,
        Action::Animate => session.mode == Mode::Animate,
        Action::CycleDirections => session.overlays.direction_lines != DirectionLines::Off,
        Action::ToggleTrust => session.overlays.trust,
        Action::Compare => session.compare,
        Action::ToggleColumn => shown.has_column,
        Action::Curves => session.shows_curves(),
        _ => false,
    }
}

/// The shell command that renders a scene, with the special characters of the path escaped.
fn render_command(path: &str) -> String {
    let mut quoted = String::new();
    for letter in path.chars() {
        if matches!(letter, '"' | '\\' | '$' | '`') {
            quoted.push('\\');
        }
        quoted.push(letter);
    }
    format!("impasto render \"{quoted}\"")
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn the_menus_hold_every_command_once() {
        let listed = actions();
        let once: HashSet<_> = listed.iter().collect();
        assert_eq!(once.len(), listed.len(), "an action is in the menus twice");
        let within_others = |action: &Action| {
            matches!(
                action,
                Action::ReadSource
                    | Action::NudgeKeysBack
                    | Action::NudgeKeysOn
                    | Action::HoldAxis(_)
                    | Action::HoldPlane(_)
                    | Action::Confirm
                    | Action::Cancel
                    | Action::TakeBack
            )
        };
        let missing: Vec<_> =
            Action::all().filter(|action| !once.contains(action) && !within_others(action)).collect();
        assert_eq!(missing, []);
    }

    #[test]
    fn a_shell_reads_the_path_as_it_is() {
        let command = render_command("a \"b\" $HOME\\`c`.ron");
        assert_eq!(command, "impasto render \"a \\\"b\\\" \\$HOME\\\\\\`c\\`.ron\"");
    }
}
