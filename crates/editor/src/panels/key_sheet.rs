//! The sheet that changes keys: every command with its keys, a search, and the question whether a key may be taken from
//! another command.

use egui::{Event, Key as EguiKey, Rect, RichText, ScrollArea, Ui, vec2};
use impasto_editor_model::keymap::{Chord, CommandId, CommandKeys, Key, Keymap, Modifiers, OwnKeys, Preset};

use super::{Ask, PanelInput, row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, MarkKeys, MenuRow, key_of, search_field, sheet_with};
use crate::window::tab_pressed;

const WIDTH: f32 = 560.0;
const ROWS: f32 = 14.0;
/// Height of everything but the list, points: the rest of the sheet, and some space around it.
const AROUND_LIST: f32 = 210.0;
/// Width of the place for the reset icon at a row's end.
const END: f32 = 32.0;

/// What the sheet remembers while it is open.
#[derive(Clone, Debug, Default)]
struct Memory {
    typed: String,
    /// The row that Enter takes.
    marked: usize,
    doing: Doing,
}

#[derive(Clone, Debug, Default, PartialEq)]
enum Doing {
    #[default]
    Nothing,
    /// The next keys that are pressed become those of this command.
    Listening(CommandId),
    /// As `Listening`, after the user pressed keys that the command cannot have; the text says why.
    ListeningStill(CommandId, String),
    /// The command is to get these keys, but the listed commands have them. The sheet asks whether to take them.
    Asking(CommandId, Vec<Chord>, Vec<CommandId>),
    /// The command works only while a keyframe on a lane is selected. While one is, these keys of the keyboard would no
    /// longer reach the listed commands. The sheet asks whether the command is to get the keys all the same.
    AskingToHide(CommandId, Vec<Chord>, Vec<CommandId>),
    /// The sheet asks whether to reset all keys to the preset's.
    AskingReset,
}

/// Shows the sheet over everything. `numpad` are the keys of the number pad that were pressed in this pass. Returns
/// true once it closes.
pub fn key_sheet(
    ctx: &egui::Context,
    shown: &PanelInput<'_>,
    numpad: &[(Key, Modifiers)],
    asks: &mut Vec<Ask>,
) -> bool {
    sheet_with(ctx, "Change keys", WIDTH, |ui, memory| contents(ui, memory, shown.keymap, numpad, asks))
}

fn contents(
    ui: &mut Ui,
    memory: &mut Memory,
    keymap: &Keymap,
    numpad: &[(Key, Modifiers)],
    asks: &mut Vec<Ask>,
) -> bool {
    let escape = ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, EguiKey::Escape));
    let was_doing = memory.doing != Doing::Nothing;
    if escape {
        memory.doing = Doing::Nothing;
    }
    if let Doing::Listening(id) | Doing::ListeningStill(id, _) = memory.doing {
        let still = |words: String| Doing::ListeningStill(id, words);
        match heard(ui, numpad) {
            Heard::Nothing => {}
            Heard::Leave => memory.doing = Doing::Nothing,
            Heard::ForText => {
                memory.doing = still("Ctrl C, Ctrl X and Ctrl V stay with text. Press others.".to_owned());
            }
            Heard::Unknown => memory.doing = still("This key cannot be given. Press others.".to_owned()),
            Heard::Keys(chord) => match id.refusal(chord) {
                Some(reason) => {
                    memory.doing = still(format!("{} cannot be given: {reason}.", chord.text()));
                }
                None => choose(keymap, id, vec![chord], &mut memory.doing, asks),
            },
        }
    }
    let keys = if memory.doing == Doing::Nothing { MarkKeys::take(ui) } else { MarkKeys::default() };
    let close = head(ui, keymap);
    ui.add_space(measure::GAP);
    search(ui, memory);
    ui.add_space(measure::GAP);
    list(ui, keymap, memory, keys, asks);
    ui.add_space(12.0);
    foot(ui, keymap, memory, asks);
    close || escape && !was_doing
}

fn head(ui: &mut Ui, keymap: &Keymap) -> bool {
    let tokens = Tokens::of(ui);
    let mut close = false;
    ui.horizontal(|ui| {
        ui.label(RichText::new("Change keys").font(type_face::sheet_title()).color(tokens.text));
        let like = match keymap.preset {
            Preset::Blender => "else like Blender",
            Preset::Maya => "else like Maya",
        };
        ui.label(RichText::new(like).font(type_face::body()).color(tokens.weak));
        ui.with_layout(row_from_right(), |ui| {
            close = widgets::icon_button(ui, icons::CLOSE, "Close the change of keys").clicked();
        });
    });
    close
}

fn search(ui: &mut Ui, memory: &mut Memory) {
    let field = search_field(ui, &mut memory.typed, "Find a command or a key", "Find a key");
    if field.changed() {
        memory.marked = 0;
    }
    // The search field has the focus, except while the sheet listens for keys or asks something.
    match memory.doing {
        Doing::Nothing => field.request_focus(),
        _ => field.surrender_focus(),
    }
}

fn list(ui: &mut Ui, keymap: &Keymap, memory: &mut Memory, keys: MarkKeys, asks: &mut Vec<Ask>) {
    let typed = memory.typed.trim().to_lowercase();
    let found: Vec<CommandKeys> =
        keymap.commands().filter(|command| command.id.is_free() && is_meant(command, &typed)).collect();
    memory.marked = keys.mark(memory.marked, found.len());
    // Decided before the lines are shown, because a click on one of them changes `memory.doing`.
    let marked = (memory.doing == Doing::Nothing).then_some(memory.marked);
    // In a low window the list is shorter, so that the line under it stays in view.
    let room = ui.ctx().content_rect().height() - AROUND_LIST;
    let high = (ROWS * measure::ROW).min(room).max(3.0 * measure::ROW);
    ui.spacing_mut().item_spacing.y = 0.0;
    let area = ScrollArea::vertical().max_height(high).min_scrolled_height(high).auto_shrink([false, false]);
    area.show(ui, |ui| {
        if found.is_empty() {
            ui.add_space(6.0);
            let words = RichText::new("No command has that name or key.").font(type_face::body());
            ui.label(words.color(Tokens::of(ui).weak));
        }
        for (index, command) in found.iter().enumerate() {
            let is_marked = marked == Some(index);
            let row = line(ui, keymap, command, is_marked, memory, asks);
            if is_marked && keys.moves() {
                row.scroll_to_me(None);
            }
            if is_marked && keys.enter {
                memory.doing = Doing::Listening(command.id);
            }
        }
    });
}

/// Whether what was typed occurs in a command's name, its place or its keys.
fn is_meant(command: &CommandKeys, typed: &str) -> bool {
    let keys = command.chords.iter().map(|chord| chord.text().to_lowercase());
    let words = [command.id.name().to_lowercase(), command.id.place().unwrap_or_default().to_lowercase()];
    words.into_iter().chain(keys).any(|words| words.contains(typed))
}

fn line(
    ui: &mut Ui,
    keymap: &Keymap,
    command: &CommandKeys,
    is_marked: bool,
    memory: &mut Memory,
    asks: &mut Vec<Ask>,
) -> egui::Response {
    let (rect, whole) =
        ui.allocate_exact_size(vec2(ui.available_width(), measure::ROW), egui::Sense::hover());
    let listens =
        matches!(memory.doing, Doing::Listening(id) | Doing::ListeningStill(id, _) if id == command.id);
    let name = command.id.name();
    let keys: Vec<String> = command.chords.iter().map(Chord::text).collect();
    let keys = match (listens, keys.is_empty()) {
        (true, _) => "Press the new keys\u{2026}".to_owned(),
        (_, true) => "none".to_owned(),
        _ => keys.join(", "),
    };
    let own = Rect::from_min_max(rect.min, rect.max - vec2(END, 0.0));
    let clicked = within(ui, own, row(), |ui| {
        let row = MenuRow { words: &name, keys: &keys, on: false, marked: listens || is_marked };
        let response = row.show(ui);
        let place = match command.id.place() {
            None => "everywhere".to_owned(),
            Some("keys on a lane") => "for keys on a lane".to_owned(),
            Some(words) if words.contains("while ") || words.contains("in a ") => words.to_owned(),
            Some(mode) => format!("in {mode}"),
        };
        response.on_hover_text(format!("Click, then press the new keys. They work {place}.")).clicked()
    });
    if clicked {
        memory.doing = Doing::Listening(command.id);
    }
    if command.is_changed {
        let end = Rect::from_min_max(rect.right_top() - vec2(END - 2.0, 0.0), rect.right_bottom());
        let label = format!("Reset the keys of {name}");
        let reset = within(ui, end, row(), |ui| widgets::icon_button(ui, icons::UNDO, &label));
        if reset.clicked() {
            choose(keymap, command.id, keymap.usual(command.id), &mut memory.doing, asks);
        }
    }
    whole
}

/// Gives a command these keys. Asks first if another command has one of them and would lose it for good. Also asks if
/// one of them would no longer reach another command while a keyframe is selected, unless they are the preset's keys.
fn choose(keymap: &Keymap, id: CommandId, chords: Vec<Chord>, doing: &mut Doing, asks: &mut Vec<Ask>) {
    let losers = keymap.losers(id, &chords);
    let hidden = if chords == keymap.usual(id) { Vec::new() } else { keymap.hidden(id, &chords) };
    if !losers.is_empty() {
        *doing = Doing::Asking(id, chords, losers);
    } else if !hidden.is_empty() {
        *doing = Doing::AskingToHide(id, chords, hidden);
    } else {
        asks.push(Ask::OwnKeys(keymap.with(id, chords).own));
        *doing = Doing::Nothing;
    }
}

/// The line under the list: a question, or what to press, or the button that resets all keys.
fn foot(ui: &mut Ui, keymap: &Keymap, memory: &mut Memory, asks: &mut Vec<Ask>) {
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), measure::SHEET_BUTTON), egui::Sense::hover());
    let mut next = None;
    let words = match &memory.doing {
        Doing::Nothing => "Click a command to change its keys.".to_owned(),
        Doing::Listening(id) => format!("{}: press the new keys, or Esc to leave it.", id.name()),
        Doing::ListeningStill(_, words) => words.clone(),
        Doing::Asking(_, chords, losers) => format!("{} belongs to {}.", keys_of(chords), names_of(losers)),
        Doing::AskingToHide(_, chords, hidden) => {
            format!("With a key selected, {} would no longer do {}.", keys_of(chords), names_of(hidden))
        }
        Doing::AskingReset => "All keys that you changed become the usual ones.".to_owned(),
    };
    within(ui, rect, row_from_right(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        match &memory.doing {
            Doing::Nothing => {
                let any = !keymap.own.is_empty();
                let button =
                    |ui: &mut Ui| Button::new("Reset all").name("Reset all keys").on_sheet().show(ui);
                let reset = ui.add_enabled_ui(any, button).inner;
                if reset.on_disabled_hover_text("All keys are the usual ones").clicked() {
                    next = Some(Doing::AskingReset);
                }
            }
            Doing::AskingReset => {
                if Button::new("Cancel").name("Cancel the change").on_sheet().show(ui).clicked() {
                    next = Some(Doing::Nothing);
                }
                if Button::new("Reset them").primary().on_sheet().show(ui).clicked() {
                    asks.push(Ask::OwnKeys(OwnKeys::default()));
                    next = Some(Doing::Nothing);
                }
            }
            Doing::Listening(id) | Doing::ListeningStill(id, _) => {
                if Button::new("Leave it").name("Leave the keys").on_sheet().show(ui).clicked() {
                    next = Some(Doing::Nothing);
                }
                if Button::new("No key").on_sheet().show(ui).clicked() {
                    asks.push(Ask::OwnKeys(keymap.with(*id, Vec::new()).own));
                    next = Some(Doing::Nothing);
                }
            }
            Doing::Asking(id, chords, _) | Doing::AskingToHide(id, chords, _) => {
                if Button::new("Cancel").name("Cancel the change").on_sheet().show(ui).clicked() {
                    next = Some(Doing::Nothing);
                }
                if Button::new("Take it over").primary().on_sheet().show(ui).clicked() {
                    asks.push(Ask::OwnKeys(keymap.with(*id, chords.clone()).own));
                    next = Some(Doing::Nothing);
                }
            }
        }
        let left = Rect::from_min_max(rect.min, egui::pos2(ui.cursor().right() - measure::GAP, rect.max.y));
        within(ui, left, row(), |ui| {
            let tokens = Tokens::of(ui);
            let colour = match memory.doing {
                Doing::Nothing | Doing::Listening(_) => tokens.weak,
                _ => tokens.ochre,
            };
            ui.add(egui::Label::new(RichText::new(words).font(type_face::body()).color(colour)).wrap());
        });
    });
    if let Some(next) = next {
        memory.doing = next;
    }
}

fn keys_of(chords: &[Chord]) -> String {
    chords.iter().map(Chord::text).collect::<Vec<_>>().join(", ")
}

fn names_of(commands: &[CommandId]) -> String {
    let names: Vec<String> = commands.iter().map(|id| format!("\u{201c}{}\u{201d}", id.name())).collect();
    names.join(", ")
}

/// What was pressed while keys are listened for.
enum Heard {
    Nothing,
    /// Esc, whatever is held with it.
    Leave,
    /// A key that the keymap does not know.
    Unknown,
    /// Keys that copy, cut or paste text: egui reports these as events of their own, not as keys.
    ForText,
    Keys(Chord),
}

/// What was pressed in this pass. All keys are consumed, so that nothing else acts on them.
fn heard(ui: &Ui, numpad: &[(Key, Modifiers)]) -> Heard {
    let plain = |held: egui::Modifiers| Modifiers { ctrl: held.command, shift: held.shift, alt: held.alt };
    let tab = tab_pressed(ui.ctx()).map(|held| Chord { key: Key::Tab, held: plain(held) });
    let numpad = numpad.first().map(|&(key, held)| Chord { key, held });
    let mut heard = tab.or(numpad);
    let (mut for_text, mut unknown) = (false, false);
    ui.input_mut(|input| {
        input.events.retain(|event| match event {
            Event::Key { key, pressed: true, modifiers, .. } => {
                let known = key_of(*key).map(|key| Chord { key, held: plain(*modifiers) });
                unknown |= known.is_none();
                heard = heard.or(known);
                false
            }
            Event::Copy | Event::Cut | Event::Paste(_) => {
                for_text = true;
                false
            }
            Event::Text(_) => false,
            _ => true,
        });
    });
    match heard {
        Some(Chord { key: Key::Escape, .. }) => Heard::Leave,
        Some(chord) => Heard::Keys(chord),
        None if for_text => Heard::ForText,
        None if unknown => Heard::Unknown,
        None => Heard::Nothing,
    }
}
