//! One layer of paint as the inspector edits it: what is stated for it, its numbers, and the commands that change them.

use egui::Ui;
use impasto_editor_model::command::{Command, StrokeChange};
use impasto_scene::document::{LayerNumber, LayerSettings, ResolvedStrokes, StrokeSettings};
use impasto_scene::presets::{self, GROUND, LayerKind};

use super::Asker;
use super::edited_strokes::EditedStrokes;
use super::number::Number;

/// A layer of paint, or the tone under all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EditedLayer {
    Paint(LayerKind),
    Ground,
}

impl EditedLayer {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Paint(kind) => kind.name(),
            Self::Ground => GROUND,
        }
    }

    pub(super) fn effect(self) -> &'static str {
        match self {
            Self::Ground => "The tone under all layers.",
            Self::Paint(LayerKind::Underpainting) => "Large, thin and earthy, under everything.",
            Self::Paint(LayerKind::Body) => "The bulk of the paint.",
            Self::Paint(LayerKind::Form) => "Smaller strokes where the form turns.",
            Self::Paint(LayerKind::Scumble) => "Broken, dry strokes in patches.",
            Self::Paint(LayerKind::Accents) => "Small strokes where colours meet.",
            Self::Paint(LayerKind::Contour) => "Thin lines where a body ends, lost and found.",
            Self::Paint(LayerKind::Lights) => "A few thick strokes on highlights.",
            Self::Paint(LayerKind::Touches) => "Strokes placed by hand, over all others.",
        }
    }

    /// What `own` states for the layer; if it states nothing, settings with only the layer's name.
    pub(super) fn stated(self, own: &StrokeSettings) -> LayerSettings {
        let known = own.layers.iter().find(|layer| layer.name == self.name());
        let empty = LayerSettings { name: self.name().to_owned(), ..LayerSettings::default() };
        known.cloned().unwrap_or(empty)
    }

    /// A copy of `own` with `change` applied to what it states for the layer.
    fn without(self, own: &StrokeSettings, change: impl Fn(&mut LayerSettings)) -> StrokeSettings {
        let mut settings = own.clone();
        settings.layers.iter_mut().filter(|layer| layer.name == self.name()).for_each(change);
        settings
    }

    /// Whether the layer is hidden (its eye is shut). `resolved` must be what `own` resolves to.
    pub(super) fn is_hidden(self, resolved: &ResolvedStrokes, own: &StrokeSettings) -> bool {
        match self {
            Self::Paint(kind) => resolved.layer_of(kind).hidden,
            Self::Ground => self.stated(own).hidden == Some(true),
        }
    }

    /// The command that shows the layer if it is hidden, else hides it. It leaves `hidden` unstated if the layer has
    /// the wanted state without it.
    pub(super) fn toggle(self, asker: &Asker<'_, '_>, place: &EditedStrokes<'_>) -> Command {
        let wanted = !self.is_hidden(&place.resolved[1], place.own[1]);
        let unstated = self.without(place.own[1], |layer| layer.hidden = None);
        let usual = self.is_hidden(&place.resolve(asker.stored(), &unstated), &unstated);
        let hidden = (wanted != usual).then_some(wanted);
        place.set_layer(LayerSettings { hidden, ..self.stated(place.own[1]) })
    }

    fn value(self, of: &LayerNumber, resolved: &ResolvedStrokes, own: &StrokeSettings) -> f64 {
        tidy(match self {
            Self::Paint(kind) => *(of.resolved)(&mut resolved.layer_of(kind).clone()),
            Self::Ground => presets::stated_ground(own).opacity,
        })
    }

    /// Shows one of its numbers. Returns whether the edited region or scene states it.
    pub(super) fn number(
        self,
        ui: &mut Ui,
        asker: &mut Asker<'_, '_>,
        place: &EditedStrokes<'_>,
        of: &LayerNumber,
        number: Number<'_>,
    ) -> bool {
        let stated = self.stated(place.own[1]);
        let is_own = (of.number.get)(&stated).is_some();
        let default = is_own.then(|| {
            let unstated = self.without(place.own[1], |layer| *(of.number.of)(layer) = None);
            self.value(of, &place.resolve(asker.stored(), &unstated), &unstated)
        });
        let values = [0, 1].map(|which| self.value(of, &place.resolved[which], place.own[which]));
        let limits = Some(of.number.limits.clone());
        let number = Number { of: self.name(), default, limits, scene_decides: false, ..number };
        asker.number(ui, &number, values, |to| self.with(place, of, to));
        is_own
    }

    /// The command that states one of its numbers, or with `None` leaves it to the scene and the presets.
    pub(super) fn with(self, place: &EditedStrokes<'_>, of: &LayerNumber, to: Option<f64>) -> Command {
        let mut stated = self.stated(place.own[1]);
        *(of.number.of)(&mut stated) = to;
        place.set_layer(stated)
    }
}

impl EditedStrokes<'_> {
    /// The command that puts `layer` in place of what is stated for the layer of the same name.
    pub(super) fn set_layer(&self, layer: LayerSettings) -> Command {
        self.set(StrokeChange::PaintLayer(Box::new(layer)))
    }
}

/// Rounds away the digits that only the conversion from 32 to 64 bits added.
fn tidy(value: f32) -> f64 {
    (f64::from(value) * 1e6).round() / 1e6
}

/// How a number of a layer is shown; `None` for the opacity, which is shown in the list.
pub(super) fn shown(of: &'static LayerNumber) -> Option<Number<'static>> {
    let share = |name| Number::share(name, of.number.effect);
    let px =
        |name, range| Number { unit: "px", range, step: (1.0, 1), ..Number::new(name, of.number.effect) };
    Some(match of.number.field {
        "length_px" => px("Layer length", 1.0..=160.0),
        "width_px" => px("Layer width", 0.5..=60.0),
        "coverage" => Number {
            label: Some("Coverage"),
            unit: "\u{d7}",
            range: 0.0..=8.0,
            step: (0.1, 2),
            ..share("Layer coverage")
        },
        "thickness" => Number { range: 0.0..=2.0, ..share("Thickness") },
        "dryness" => share("Layer dryness"),
        "pickup" => share("Layer pickup"),
        _ => return None,
    })
}
