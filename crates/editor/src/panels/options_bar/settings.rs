//! The settings of each tool: what the options bar shows of them, and where.

use impasto_editor_model::session::{Axes, FillKind, Pressure, RegionBy, RegionDoes, Tool, ToolOptions};
use impasto_scene::document::{Amount, Color, LightKind};

/// When a setting is on the bar. Otherwise, or if there is no room, it is in the menu at the bar's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BarPlace {
    Always,
    /// In a wide window.
    Wide,
    /// In a wide window, at the bar's right end.
    WideRight,
    Never,
}

/// One setting of a tool.
pub(super) struct Setting {
    pub(super) place: BarPlace,
    /// The words before the control; empty for none.
    pub(super) label: &'static str,
    pub(super) control: Control,
    /// Whether a line separates it from the setting before.
    pub(super) apart: bool,
    /// Why it is disabled now, if it is.
    pub(super) off: Option<&'static str>,
}

pub(super) enum Control {
    Choice(Choice),
    Number(Number),
    Check { words: &'static str, get: fn(&mut ToolOptions) -> &mut bool },
    Mirror,
    Colour { name: &'static str, get: fn(&mut ToolOptions) -> &mut Color },
}

/// A choice between a few words, of which one is on.
pub(super) struct Choice {
    /// The words of each choice, and its name for screen readers and tests.
    pub(super) words: &'static [(&'static str, &'static str)],
    pub(super) get: fn(&ToolOptions) -> usize,
    pub(super) set: fn(&mut ToolOptions, usize),
}

pub(super) struct Number {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) range: (f64, f64),
    pub(super) width: f32,
    /// The shown value is this many times the stored one (100 for a percentage).
    pub(super) times: f64,
    pub(super) get: fn(&mut ToolOptions) -> &mut f64,
    pub(super) effect: &'static str,
}

fn at(place: BarPlace, label: &'static str, control: Control) -> Setting {
    Setting { place, label, control, apart: false, off: None }
}

fn apart(setting: Setting) -> Setting {
    Setting { apart: true, ..setting }
}

/// A choice between the listed values of an option, in their order.
macro_rules! choice {
    ($field:ident: [$($value:expr => $words:literal, $name:literal;)*]) => {
        Control::Choice(Choice {
            words: &[$(($words, $name)),*],
            get: |options| [$($value),*].iter().position(|value| *value == options.$field).unwrap_or(0),
            set: |options, index| {
                if let Some(value) = [$($value),*].get(index) {
                    options.$field = *value;
                }
            },
        })
    };
}

fn radius() -> Setting {
    let number = Number {
        name: "Brush radius",
        unit: "px",
        range: (4.0, 200.0),
        width: 78.0,
        times: 1.0,
        get: |options| &mut options.radius_px,
        effect: "How far from the pointer the brush reaches.",
    };
    at(BarPlace::Always, "Radius", Control::Number(number))
}

fn strength() -> Setting {
    let number = Number {
        name: "Brush strength",
        unit: "%",
        range: (0.0, 100.0),
        width: 72.0,
        times: 100.0,
        get: |options| &mut options.strength,
        effect: "How far strokes give in to the brush.",
    };
    at(BarPlace::Always, "Strength", Control::Number(number))
}

fn falloff() -> Setting {
    at(
        BarPlace::Wide,
        "Falloff",
        choice!(even: [false => "Soft", "Soft falloff"; true => "Even", "Even falloff";]),
    )
}

fn steady() -> Setting {
    let number = Number {
        name: "Steady",
        unit: "%",
        range: (0.0, 100.0),
        width: 78.0,
        times: 100.0,
        get: |options| &mut options.steady,
        effect: "The brush follows on a string, so that a trembling hand draws a calm line.",
    };
    at(BarPlace::Wide, "Steady", Control::Number(number))
}

/// What a pen's pressure changes. Once a pen was seen, the setting is on the bar of a wide window. Before that, it is
/// in the menu, disabled, and says why.
fn pressure(has_pen: bool) -> Setting {
    let control = choice!(pressure: [
        Pressure::Off => "Off", "Pressure off";
        Pressure::Radius => "Radius", "Pressure radius";
        Pressure::Strength => "Strength", "Pressure strength";
    ]);
    let place = if has_pen { BarPlace::Wide } else { BarPlace::Never };
    let off = (!has_pen).then_some("No pen that tells its pressure was seen yet");
    Setting { off, ..at(place, "Pressure", control) }
}

fn mirror() -> Setting {
    apart(at(BarPlace::Always, "Mirror", Control::Mirror))
}

fn front_only() -> Setting {
    let control = Control::Check { words: "Front faces only", get: |options| &mut options.front_only };
    at(BarPlace::WideRight, "", control)
}

fn foresee() -> Setting {
    let control =
        Control::Check { words: "Show what a stroke would do", get: |options| &mut options.foresee };
    at(BarPlace::Never, "", control)
}

fn brush(has_pen: bool) -> [Setting; 5] {
    [apart(radius()), strength(), falloff(), steady(), pressure(has_pen)]
}

fn axes() -> Setting {
    apart(at(
        BarPlace::Always,
        "Axes",
        choice!(axes: [
            Axes::World => "World", "World axes";
            Axes::Local => "Local", "Local axes";
            Axes::View => "View", "View axes";
        ]),
    ))
}

fn snap(turns: bool) -> Setting {
    let control = if turns {
        choice!(snap: [false => "Off", "Snap off"; true => "5\u{b0}", "Snap";])
    } else {
        choice!(snap: [false => "Off", "Snap off"; true => "0.1", "Snap";])
    };
    at(BarPlace::Always, "Snap", control)
}

fn angle(name: &'static str, get: fn(&mut ToolOptions) -> &mut f64, most: f64) -> Setting {
    let number = Number {
        name,
        unit: "\u{b0}",
        range: (if most > 90.0 { -most } else { 0.0 }, most),
        width: 64.0,
        times: 1.0,
        get,
        effect: if most > 90.0 {
            "Direction in the picture, from level."
        } else {
            "The flood stops where faces bend by more."
        },
    };
    at(BarPlace::Always, "Angle", Control::Number(number))
}

/// The settings of a tool, in the order of the bar. `has_pen`: whether a pen that reports its pressure was seen.
pub(super) fn of(tool: Tool, options: &ToolOptions, has_pen: bool) -> Vec<Setting> {
    let mut settings = Vec::new();
    match tool {
        Tool::Select => settings.push(axes()),
        Tool::Move | Tool::Scale => settings.extend([axes(), snap(false)]),
        Tool::Turn => settings.extend([axes(), snap(true)]),
        Tool::AddLight => settings.push(apart(at(
            BarPlace::Always,
            "",
            choice!(light: [
                LightKind::Sun => "Sun", "Sun";
                LightKind::Point => "Lamp", "Lamp";
                LightKind::Spot => "Spot", "Spot";
                LightKind::Ambient => "Sky", "Sky";
            ]),
        ))),
        Tool::Comb => {
            let sense = choice!(against: [false => "Along", "Along"; true => "Against", "Against";]);
            settings.push(at(BarPlace::Always, "", sense));
            settings.extend(brush(has_pen));
            settings.extend([mirror(), front_only(), foresee()]);
        }
        Tool::GuideCurve => {
            settings.extend([apart(radius()), strength(), falloff(), mirror(), front_only()]);
        }
        Tool::Fill => {
            settings.push(at(
                BarPlace::Always,
                "",
                choice!(fill: [
                    FillKind::Automatic => "Automatic", "Automatic";
                    FillKind::Curvature => "Curvature", "Curvature";
                    FillKind::Up => "Up", "Up";
                    FillKind::Along => "Along", "Along";
                    FillKind::Around => "Around", "Around";
                    FillKind::Angle => "Angle", "Angle";
                ]),
            ));
            if options.fill == FillKind::Angle {
                settings.push(apart(angle("Fill angle", |options| &mut options.fill_angle_deg, 180.0)));
            }
        }
        Tool::TurnDirection => settings.push(at(
            BarPlace::Always,
            "",
            choice!(flip: [true => "Flip", "Flip"; false => "By angle", "By angle";]),
        )),
        Tool::Smooth => {
            let smear = choice!(smear: [false => "Smooth", "Smooth out"; true => "Smear", "Smear";]);
            settings.push(at(BarPlace::Always, "", smear));
            settings.extend(brush(has_pen));
            settings.extend([mirror(), front_only()]);
        }
        Tool::Erase => {
            settings.extend([apart(radius()), falloff(), pressure(has_pen), mirror(), front_only()]);
        }
        Tool::Amount => settings.extend(amount(has_pen)),
        Tool::Touch => settings.extend(touch(options, has_pen)),
        Tool::Region => region(&mut settings, options, has_pen),
        Tool::Pick | Tool::ShotCamera => (),
    }
    settings
}

fn amount(has_pen: bool) -> Vec<Setting> {
    let of = choice!(amount: [
        Amount::Width => "Width", "Paint width";
        Amount::Length => "Length", "Paint length";
        Amount::Density => "Density", "Paint density";
        Amount::Flatness => "Flatness", "Paint flatness";
    ]);
    let way = choice!(lowers: [false => "Raise", "Raise"; true => "Lower", "Lower";]);
    vec![
        at(BarPlace::Always, "", of),
        apart(at(BarPlace::Always, "", way)),
        apart(radius()),
        strength(),
        steady(),
        pressure(has_pen),
        mirror(),
        front_only(),
    ]
}

fn touch(options: &ToolOptions, has_pen: bool) -> Vec<Setting> {
    let does = choice!(touch_erases: [false => "Lay", "Lay touches"; true => "Erase", "Erase strokes";]);
    let number = |name: &'static str, (unit, times), range, get, effect| Number {
        name,
        unit,
        range,
        width: 72.0,
        times,
        get,
        effect,
    };
    let radius = number(
        "Touch radius",
        ("px", 1.0),
        (2.0, 100.0),
        |options: &mut ToolOptions| &mut options.touch_radius_px,
        "Half the width of the stroke, as the ring shows it.",
    );
    let mut settings =
        vec![at(BarPlace::Always, "", does), apart(at(BarPlace::Always, "Radius", Control::Number(radius)))];
    if !options.touch_erases {
        let from = choice!(touch_from_picture: [
            false => "Colour", "Touch in a colour";
            true => "Picture", "Touch as the picture";
        ]);
        settings.push(apart(at(BarPlace::Always, "", from)));
        if !options.touch_from_picture {
            let color =
                Control::Colour { name: "Colour of touches", get: |options| &mut options.touch_color };
            settings.push(at(BarPlace::Always, "", color));
        }
        let opacity = number(
            "Touch opacity",
            ("%", 100.0),
            (0.0, 100.0),
            |options: &mut ToolOptions| &mut options.touch_opacity,
            "How far the stroke covers what is below.",
        );
        let taper = number(
            "Touch taper",
            ("%", 100.0),
            (-100.0, 100.0),
            |options: &mut ToolOptions| &mut options.touch_taper,
            "How much narrower the stroke ends than it begins.",
        );
        settings.push(apart(at(BarPlace::Wide, "Opacity", Control::Number(opacity))));
        settings.push(at(BarPlace::Wide, "Taper", Control::Number(taper)));
    }
    settings.extend([steady(), pressure(has_pen), front_only()]);
    settings
}

fn region(settings: &mut Vec<Setting>, options: &ToolOptions, has_pen: bool) {
    settings.push(at(
        BarPlace::Always,
        "",
        choice!(region_by: [
            RegionBy::Brush => "Brush", "Region by brush";
            RegionBy::Flood => "Flood", "Region by flood";
            RegionBy::Group => "Group", "Region by group";
            RegionBy::Material => "Material", "Region by material";
        ]),
    ));
    settings.push(apart(at(
        BarPlace::Always,
        "",
        choice!(region_does: [
            RegionDoes::New => "New", "New region";
            RegionDoes::Add => "Add", "Add to region";
            RegionDoes::TakeAway => "Take away", "Take away from region";
        ]),
    )));
    match options.region_by {
        RegionBy::Brush => {
            settings.extend([apart(radius()), pressure(has_pen), mirror(), front_only()]);
        }
        RegionBy::Flood => {
            settings.push(apart(angle("Flood angle", |options| &mut options.flood_deg, 90.0)));
        }
        RegionBy::Group | RegionBy::Material => (),
    }
}
