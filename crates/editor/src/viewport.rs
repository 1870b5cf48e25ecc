//! The viewport: the picture with everything that floats over it. It changes nothing itself, and returns the pointer's
//! events and what the chips (the floating buttons) ask for.

use egui::{Color32, CursorIcon, Id, Rect, Sense, Ui, pos2};
use glam::DVec2;
use impasto_editor_model::Session;
use impasto_editor_model::camera_rig::AxisView;
use impasto_editor_model::editor::PointerEvent;
use impasto_editor_model::keymap::Keymap;
use impasto_scene::motion::CameraPose;

mod chips;
mod contour;
mod direction_marks;
mod framing;
mod layout;
mod marks;
pub mod overlay;
mod pictures;
mod pointer;
pub mod surface_map;

use crate::panels::Ask;
use crate::theme::{Tokens, type_face};

pub use direction_marks::{HairLook, direction_marks};
pub use framing::Framing;
pub use layout::Layout;
pub use marks::Marks;
pub use pictures::Pictures;

/// What the viewport shows.
#[derive(Clone, Copy)]
pub struct ViewportInput<'a> {
    /// The last picture of each view. In a comparison, the first is the reference.
    pub pictures: &'a Pictures,
    /// Mode, shading, overlays.
    pub session: &'a Session,
    /// The key bindings in use; tooltips take the texts of keys from them.
    pub keymap: &'a Keymap,
    /// The camera of the first picture, before it is widened to the viewport.
    pub camera: &'a CameraPose,
    /// Whether the viewport looks through the shot camera.
    pub through_shot: bool,
    /// What is drawn over the picture; in a comparison, over the reference.
    pub marks: &'a Marks<'a>,
    /// The second picture of a comparison, if there is one.
    pub now: Option<Now<'a>>,
    /// The badge at the bottom left.
    pub badge: Badge,
    /// What a screen reader says of the viewport, such as *Paint, comb, shot camera, frame 0, reference*.
    pub value: &'a str,
    /// What a screen reader says of the place under the pointer, such as *10°  trust 0.97*.
    pub under_cursor: &'a str,
    /// Whether the scene is empty.
    pub empty: bool,
    /// What went wrong with the picture, in words for the user.
    pub trouble: Option<&'a str>,
}

/// The second picture of a comparison: the frame that is shown, beside or below the reference.
#[derive(Clone, Copy)]
pub struct Now<'a> {
    /// The camera at the frame that is shown, before it is widened to the viewport.
    pub camera: &'a CameraPose,
    /// The frame that is shown.
    pub frame: f64,
    /// The note beside its title, such as *apple turned −86°*.
    pub note: &'a str,
    /// What is drawn over it.
    pub marks: &'a Marks<'a>,
}

/// How the view that is shown differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Badge {
    /// The shot camera, at the reference's frame.
    Reference(f64),
    /// Another frame, through the shot camera.
    Turned {
        /// The frame that is shown.
        frame: f64,
        /// The reference's frame.
        reference: f64,
    },
    /// A free camera, at this frame.
    Free(f64),
}

/// A choice of the camera to look through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraChoice {
    /// The shot camera.
    Shot,
    /// A free camera that starts at the current pose.
    Free,
    /// A free camera that looks along an axis.
    Along(AxisView),
}

/// What the user did in the viewport.
#[derive(Debug, Default)]
pub struct ViewportEvents {
    /// What the pointer did on the picture (in a comparison, on the reference), in order.
    pub pointer: Vec<PointerEvent>,
    /// What the chips ask for.
    pub asks: Vec<Ask>,
    /// A camera that was chosen.
    pub look: Option<CameraChoice>,
    /// Whether *Recapture* was pressed: take the frame that is shown as the reference.
    pub recapture: bool,
    /// How far the axis ball was dragged, in points. This orbits the view.
    pub orbit_px: DVec2,
    /// Whether the pointer is on the picture.
    pub hovered: bool,
}

/// Shows the viewport. `layout` says where its pictures lie. The caller makes the layout, because what is drawn over
/// the pictures depends on it too.
pub fn viewport(ui: &mut Ui, layout: &Layout, input: &ViewportInput<'_>) -> ViewportEvents {
    let tokens = Tokens::of(ui);
    let area = layout.area();
    let first = &layout.framings()[0];
    let id = ui.scope_id().with("viewport");
    let response = ui.interact(area, id, Sense::click_and_drag());
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Viewport");
        info.current_text_value = Some(input.value.to_owned());
        info
    });
    let painter = ui.painter().with_clip_rect(area);
    // In the light theme `field` is white, which would be brighter than any picture.
    let is_dark = ui.visuals().dark_mode;
    let background = if input.now.is_some() && is_dark { tokens.field } else { tokens.app };
    painter.rect_filled(area, 0.0, background);
    for (index, framing) in layout.framings().iter().enumerate() {
        if let Some((texture, view, _)) = input.pictures.of(index) {
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let place = framing.place_of(view.size_px, view.shot_height_px);
            painter.with_clip_rect(framing.viewport()).image(texture, place, uv, Color32::WHITE);
        }
    }
    draw_marks(ui, first, input.camera, input.marks);
    if let (Some(now), Some(framing)) = (&input.now, layout.framings().get(1)) {
        draw_marks(ui, framing, now.camera, now.marks);
        layout::titles(&painter, layout, now, input, tokens);
    } else if input.through_shot && !input.empty {
        overlay::shot_border(&painter, area, first.shot(), tokens.app);
    }

    let mut events = ViewportEvents::default();
    if !input.empty {
        chips::show(ui, area, input, &mut events);
    }
    let mut pointer = ui.data_mut(|data| data.get_temp::<pointer::Pointer>(id)).unwrap_or_default();
    let layer = response.layer_id;
    let ctx = ui.ctx().clone();
    // Chips and dialogs lie in egui layers of their own: there the pointer is not over the picture.
    let over = |at| first.viewport().contains(at) && ctx.layer_id_at(at).is_none_or(|found| found == layer);
    events.pointer = pointer.events(ui, first, over);
    events.hovered = pointer.is_inside();
    if input.marks.hides_pointer && (pointer.is_inside() || pointer.is_dragging()) {
        ui.ctx().set_cursor_icon(CursorIcon::None);
    }
    ui.data_mut(|data| data.insert_temp(id, pointer));

    if input.empty {
        let font = type_face::title();
        let words = "Drop a mesh here, or open a scene";
        painter.text(area.center(), egui::Align2::CENTER_CENTER, words, font, tokens.weak);
    }
    if let Some(words) = input.trouble {
        trouble(&painter, area, words, tokens);
    }
    if ui.input(|input| !input.raw.hovered_files.is_empty()) {
        let edge = (2.0, tokens.accent_text);
        painter.rect_filled(area, 0.0, tokens.accent.gamma_multiply(0.16));
        painter.rect_stroke(area.shrink(1.0), 0.0, edge, egui::StrokeKind::Inside);
    }
    live_label(ui, id, area, input.under_cursor);
    events
}

fn draw_marks(ui: &Ui, framing: &Framing, camera: &CameraPose, marks: &Marks<'_>) {
    let painter = ui.painter().with_clip_rect(framing.viewport());
    let view = framing.view(camera);
    marks.draw(&overlay::Sheet { painter: &painter, rect: framing.viewport(), view: &view });
}

fn trouble(painter: &egui::Painter, area: Rect, words: &str, tokens: &Tokens) {
    let most = (area.width() - 80.0).max(80.0);
    let galley = painter.layout(words.to_owned(), type_face::body(), tokens.vermilion, most);
    let rect = Rect::from_center_size(area.center(), galley.size() + egui::vec2(32.0, 24.0));
    painter.rect(rect, 6.0, tokens.panel, (1.0, tokens.vermilion), egui::StrokeKind::Inside);
    painter.galley(rect.min + egui::vec2(16.0, 12.0), galley, tokens.vermilion);
}

/// A label for screen readers only.
fn live_label(ui: &Ui, id: Id, area: Rect, words: &str) {
    let at = Rect::from_min_size(area.left_bottom(), egui::Vec2::ZERO);
    let label = ui.interact(at, id.with("under the cursor"), Sense::hover());
    label.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::Status, true, "Under the cursor");
        info.current_text_value = Some(words.to_owned());
        info
    });
}
