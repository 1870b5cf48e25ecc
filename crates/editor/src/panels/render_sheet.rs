//! The sheet for rendering. The user chooses frames, their size and files there, and sees the progress of rendering.

mod format;
mod progress;

use egui::{Layout, Margin, Rect, RichText, Role, Sense, TextEdit, TextureHandle, Ui, WidgetInfo, vec2};
use impasto_editor_model::Document;
use impasto_editor_model::render_settings::{
    Fault, Field, Outcome, RenderDriver, RenderPlan, RenderProgress, RenderSettings, Which, counted_frames,
    scaled, size_4k,
};
use impasto_scene::limits::MAX_SIDE_PX;

use super::{row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, NumberField, sheet};

/// What the sheet shows.
#[derive(Clone, Copy)]
pub struct RenderShown<'a> {
    /// The document that would be rendered.
    pub document: &'a Document,
    /// The frame that is shown.
    pub frame: f64,
    /// The driver that *Automatic* chose in this window, such as *llvmpipe*. Empty if it is not known.
    pub driver: &'a str,
    /// The progress of the current or last rendering; none before the first.
    pub progress: Option<&'a RenderProgress>,
    /// The picture of the last rendered frame.
    pub picture: Option<&'a TextureHandle>,
    /// Whether finished frames can be viewed: some are there, as PNG files.
    pub viewable: bool,
}

/// What the sheet asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderAsk {
    /// Start rendering.
    Render,
    /// Stop rendering. Finished frames stay, but not those of a movie.
    Stop,
    /// Close the sheet while rendering goes on.
    WorkOn,
    /// Close the sheet.
    Close,
    /// Show the files in the desktop's file manager.
    OpenFolder,
    /// Show the finished frames in the window.
    View,
    /// Put the command on the clipboard.
    CopyCommand,
    /// Choose where the files go.
    Browse,
}

const WIDTH: f32 = 620.0;
const LABEL: f32 = 88.0;
const ROW: f32 = 34.0;
const NUMBER: f32 = 76.0;
const PRESETS: [(&str, &str); 4] =
    [("50 %", "Size 50 %"), ("100 %", "Size 100 %"), ("150 %", "Size 150 %"), ("4K", "Size 4K")];

/// Shows the sheet over everything. Returns what it asks for, if anything.
pub fn render_sheet(
    ctx: &egui::Context,
    shown: &RenderShown<'_>,
    settings: &mut RenderSettings,
) -> Option<RenderAsk> {
    // An open menu uses `Esc` and `Enter` itself. So does a field that has the focus: these keys end its focus.
    let is_theirs = egui::Popup::is_any_open(ctx) || ctx.memory(|memory| memory.focused()).is_some();
    sheet(ctx, "Render settings", WIDTH, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let runs = shown.progress.is_some_and(|progress| progress.outcome.is_none());
        let mut ask = head(ui, runs);
        ui.add_space(12.0);
        let plan = settings.plan(shown.document, shown.frame);
        ui.add_enabled_ui(!runs, |ui| {
            let fault = plan.as_ref().err();
            frames(ui, shown, settings, plan.as_ref());
            fault_under(ui, fault, Field::Frames);
            size(ui, shown, settings);
            fault_under(ui, fault, Field::Size);
            format::format(ui, shown.document.scene(), settings);
            ask = files(ui, settings, fault).or(ask);
            match &plan {
                Ok(plan) => place(ui, plan),
                Err(_) => fault_under(ui, fault, Field::Output),
            }
            driver(ui, shown, settings);
        });
        if let Some(progress) = shown.progress {
            ui.add_space(12.0);
            if progress::card(ui, progress, shown.picture, shown.viewable) {
                ask = Some(RenderAsk::View);
            }
        }
        ui.add_space(20.0);
        ask = foot(ui, shown, &plan).or(ask);
        let (escape, enter) =
            ui.input(|input| (input.key_pressed(egui::Key::Escape), input.key_pressed(egui::Key::Enter)));
        match ask {
            None if escape && !is_theirs => Some(if runs { RenderAsk::WorkOn } else { RenderAsk::Close }),
            None if enter && !is_theirs && !runs && plan.is_ok() => Some(RenderAsk::Render),
            ask => ask,
        }
    })
}

fn head(ui: &mut Ui, runs: bool) -> Option<RenderAsk> {
    let tokens = Tokens::of(ui);
    let top = ui.max_rect();
    ui.label(RichText::new("Render").font(type_face::title()).color(tokens.text));
    let corner = Rect::from_min_size(top.right_top() + vec2(-24.0, -5.0), vec2(28.0, 28.0));
    let close =
        within(ui, corner, row(), |ui| widgets::icon_button(ui, icons::CLOSE, "Close render settings"));
    ui.add_space(12.0);
    let line = ui.available_rect_before_wrap().expand2(vec2(measure::SHEET_PADDING, 0.0));
    ui.painter().hline(line.x_range(), line.top(), (1.0, tokens.div));
    close.clicked().then_some(if runs { RenderAsk::WorkOn } else { RenderAsk::Close })
}

/// A row with its label at the left.
fn labelled<R>(ui: &mut Ui, label: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    // Painted without an accessibility node: a screen reader gets the name from the control.
    let colour = Tokens::of(ui).weak;
    ui.painter().text(rect.left_center(), egui::Align2::LEFT_CENTER, label, type_face::body(), colour);
    within(ui, rect.with_min_x(rect.left() + LABEL), row(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        contents(ui)
    })
}

/// Words under a field, aligned with it.
fn under(ui: &mut Ui, words: &str, colour: egui::Color32) {
    ui.horizontal(|ui| {
        ui.add_space(LABEL);
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.label(RichText::new(words).font(type_face::small()).color(colour));
    });
    ui.add_space(4.0);
}

fn fault_under(ui: &mut Ui, fault: Option<&Fault>, field: Field) {
    if let Some(fault) = fault.filter(|fault| fault.field == field) {
        under(ui, &fault.words, Tokens::of(ui).vermilion);
    }
}

/// A field of text. Its response counts as changed after every letter.
fn text(ui: &mut Ui, name: &str, wide: f32, typed: &mut String, wrong: bool) -> egui::Response {
    let tokens = Tokens::of(ui);
    let mut frame = egui::Frame::new().fill(tokens.field).corner_radius(measure::CORNER);
    if wrong {
        frame = frame.stroke((1.0, tokens.vermilion));
    }
    let edit = TextEdit::singleline(typed)
        .font(type_face::number())
        .text_color(tokens.text)
        .frame(frame.inner_margin(Margin::symmetric(8, 4)))
        .desired_width(wide);
    let response = ui.add(edit);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::TextInput, ui.is_enabled(), name);
        info.current_text_value = Some(typed.clone());
        info
    });
    response
}

fn weak(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak));
}

fn frames(
    ui: &mut Ui,
    shown: &RenderShown<'_>,
    settings: &mut RenderSettings,
    plan: Result<&RenderPlan, &Fault>,
) {
    const CHOICES: [Which; 3] = [Which::All, Which::This, Which::Listed];
    let names = [("All", "All frames"), ("This frame", "This frame"), ("Range", "Range of frames")];
    labelled(ui, "Frames", |ui| {
        let mut chosen = CHOICES.iter().position(|which| *which == settings.which).unwrap_or(0);
        let mut list = settings.frames(shown.document.scene(), shown.frame);
        if widgets::segmented_named(ui, &names, &mut chosen).changed() {
            settings.which = CHOICES[chosen];
            if settings.which == Which::Listed {
                settings.list.clone_from(&list);
            }
        }
        let wrong = plan.is_err_and(|fault| fault.field == Field::Frames);
        if text(ui, "Frames", 130.0, &mut list, wrong).changed() {
            (settings.which, settings.list) = (Which::Listed, list);
        }
        if let Ok(plan) = plan {
            weak(ui, &counted_frames(plan.frames.count()));
        }
    });
}

fn size(ui: &mut Ui, shown: &RenderShown<'_>, settings: &mut RenderSettings) {
    let scene = shown.document.scene();
    labelled(ui, "Size", |ui| {
        let most = f64::from(MAX_SIDE_PX);
        for (side, name) in ["Width px", "Height px"].into_iter().enumerate() {
            if side == 1 {
                weak(ui, "\u{d7}");
            }
            let mut value = f64::from(settings.size_px[side]);
            let field = NumberField::new(name, &mut value, 1.0..=f64::INFINITY).limits(1.0..=most);
            if field.unlabelled(NUMBER).show(ui).changed {
                settings.size_px[side] = value as u32;
            }
        }
        let sizes = [scaled(scene, 50), scaled(scene, 100), scaled(scene, 150), size_4k(scene)];
        let mut chosen = sizes.iter().position(|size| *size == settings.size_px).unwrap_or(usize::MAX);
        if widgets::segmented_named(ui, &PRESETS, &mut chosen).changed() {
            settings.size_px = sizes[chosen];
        }
        let own = scene.size.1;
        if settings.size_px[1] != own {
            let finer = settings.size_px[1] > own;
            weak(ui, if finer { "finer" } else { "coarser" });
        }
    });
}

fn files(ui: &mut Ui, settings: &mut RenderSettings, fault: Option<&Fault>) -> Option<RenderAsk> {
    labelled(ui, "Files", |ui| {
        let wrong = fault.is_some_and(|fault| fault.field == Field::Output);
        let wide = ui.available_width() - 88.0;
        let mut output = settings.output.clone();
        if text(ui, "Output files", wide, &mut output, wrong).changed() {
            settings.choose_output(output);
        }
        let browse = Button::new("Browse\u{2026}").name("Browse for output files");
        browse.show(ui).clicked().then_some(RenderAsk::Browse)
    })
}

/// Says where the files go.
fn place(ui: &mut Ui, plan: &RenderPlan) {
    let tokens = Tokens::of(ui);
    let folder = plan.folder().display();
    if plan.is_outside() {
        under(ui, &format!("in {folder}, outside the scene\u{2019}s folder"), tokens.ochre);
    } else {
        under(ui, &format!("in {folder}"), tokens.weak);
    }
}

fn driver(ui: &mut Ui, shown: &RenderShown<'_>, settings: &mut RenderSettings) {
    const DRIVERS: [RenderDriver; 3] = [RenderDriver::Automatic, RenderDriver::Egl, RenderDriver::Osmesa];
    labelled(ui, "Driver", |ui| {
        let automatic = match shown.driver {
            "" => "Automatic".to_owned(),
            name => format!("Automatic ({name})"),
        };
        let names = [automatic.as_str(), "EGL", "OSMesa, in software"];
        let mut chosen = DRIVERS.iter().position(|driver| *driver == settings.driver).unwrap_or(0);
        if widgets::combo(ui, "Driver", None, &names, &mut chosen).changed() {
            settings.driver = DRIVERS[chosen];
        }
        ui.add_space(12.0);
        widgets::checkbox(ui, "Transparent background", &mut settings.transparent);
    });
}

fn foot(ui: &mut Ui, shown: &RenderShown<'_>, plan: &Result<RenderPlan, Fault>) -> Option<RenderAsk> {
    let mut ask = None;
    let high = vec2(ui.available_width(), measure::SHEET_BUTTON);
    ui.allocate_ui_with_layout(high, Layout::left_to_right(egui::Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        let open = Button::new("Open folder").icon(icons::OPEN_FOLDER).plain();
        let has_files = shown.progress.is_some_and(|progress| progress.done() > 0);
        let response = ui.add_enabled_ui(has_files, |ui| open.show(ui)).inner;
        if response.on_disabled_hover_text("No frame is rendered yet").clicked() {
            ask = Some(RenderAsk::OpenFolder);
        }
        let command = plan.as_ref().map_err(|fault| fault.words.clone());
        let command = command.and_then(|plan| plan.command(shown.document));
        let copy = Button::new("Copy as command").icon(icons::COPY).plain();
        let response = ui.add_enabled_ui(command.is_ok(), |ui| copy.show(ui)).inner;
        if response.on_disabled_hover_text(command.err().unwrap_or_default()).clicked() {
            ask = Some(RenderAsk::CopyCommand);
        }
        ui.with_layout(row_from_right(), |ui| {
            ui.spacing_mut().item_spacing.x = measure::GAP;
            ask = verbs(ui, shown, plan).or(ask);
        });
    });
    ask
}

fn verbs(ui: &mut Ui, shown: &RenderShown<'_>, plan: &Result<RenderPlan, Fault>) -> Option<RenderAsk> {
    match shown.progress {
        Some(progress) if progress.outcome.is_none() => {
            let stop = Button::new("Stop").danger().on_sheet();
            let stop = ui.add_enabled_ui(!progress.stopping, |ui| stop.show(ui)).inner;
            let on = Button::new("Work on while it renders").on_sheet().show(ui);
            if stop.clicked() { Some(RenderAsk::Stop) } else { on.clicked().then_some(RenderAsk::WorkOn) }
        }
        progress => {
            let again = progress.is_some_and(|progress| progress.outcome != Some(Outcome::Done));
            let count = plan.as_ref().map_or(0, |plan| plan.frames.count());
            let words = match (count, again) {
                (0, _) => "Render".to_owned(),
                (count, false) => format!("Render {}", counted_frames(count)),
                (count, true) => format!("Render {} again", counted_frames(count)),
            };
            let button = Button::new(&words).name("Start rendering").primary().on_sheet();
            let response = ui.add_enabled_ui(plan.is_ok(), |ui| button.show(ui)).inner;
            let why = plan.as_ref().err().map(|fault| fault.words.clone()).unwrap_or_default();
            response.on_disabled_hover_text(why).clicked().then_some(RenderAsk::Render)
        }
    }
}
