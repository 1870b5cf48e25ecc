//! The brush tools (Comb, Smooth or Smear, Erase, Amount, region brush): a ring that is dragged over a surface.

use glam::DVec2;
use impasto_scene::document::{Amount, Dab, Falloff, Guide, GuideMode, Region, Selector};

use super::heading::Heading;
use super::pressure::Felt;
use super::ring::{CombPreview, Needle, Ring, radius_in_model};
use super::{
    NOTHING_HERE, Paintable, Surroundings, ToolEvent, ToolOutput, amounts, erase, smear, waiting_words,
};
use crate::command::{Amounts, Command, Directions, Gesture, RegionTarget, Regions};
use crate::keymap::{Action, Modifiers};
use crate::path::{
    Faces, GuideStyle, MirrorAxes, PathPoint, PathSense, PathSettings, STAMP_SHARE, SurfacePath, mirrored,
};
use crate::picking::Hit;
use crate::refusal::Refusal;
use crate::selection::Item;
use crate::session::{RegionDoes, Tool};

#[derive(Clone, Debug, Default)]
pub(super) struct Brush {
    heading: Heading,
    /// Whether a comb may be previewed: from the first quick movement until the pointer rests or a button is down.
    previews_comb: bool,
    stroke: Option<Stroke>,
}

/// A drag under way.
#[derive(Clone, Debug)]
struct Stroke {
    does: Act,
    on: Paintable,
    path: SurfacePath,
    sense: PathSense,
    at_px: DVec2,
}

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Act {
    Comb,
    Smooth,
    Smear,
    Erase,
    /// The region brush: adds to the selected region.
    Add,
    /// The region brush with Ctrl, or set to take away: takes away from the selected region.
    TakeAway,
    /// The region brush: makes a new region.
    AddNew,
    /// Paints dabs that raise an amount.
    Raise,
    /// Paints dabs that lower an amount.
    Lower,
    /// Erases dabs of an amount.
    EraseAmount,
}

impl Brush {
    pub(super) fn is_busy(&self) -> bool {
        self.stroke.is_some()
    }

    pub(super) fn take(&mut self, tool: Tool, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        match *event {
            ToolEvent::Hover { at_px, at_secs } => self.aim(tool, at_px, at_secs, around),
            ToolEvent::Press { at_px, at_secs, held, pressure } => {
                self.heading.forget();
                self.previews_comb = false;
                self.heading.follow(at_px, at_secs);
                self.press(tool, (at_px, held, pressure), around)
            }
            ToolEvent::Move { at_px, at_secs, pressure, .. } => {
                self.heading.follow(at_px, at_secs);
                let Some(stroke) = &mut self.stroke else { return self.aim(tool, at_px, at_secs, around) };
                stroke.at_px = at_px;
                let on = stroke.on.clone();
                stroke.path.press_by(pressure);
                stroke.path.move_to(at_px, &mut stroke.does.picks(&on, around));
                let preview = stroke.command(around);
                ToolOutput { preview, ..self.under_way(around) }
            }
            ToolEvent::Release { pressure } => {
                let stroke = self.stroke.take().map(|on| Stroke { path: on.path.lifted(pressure), ..on });
                let commit = stroke.as_ref().and_then(|on| on.command(around));
                // A command selects its region when it is applied. A drag without a command selects the region where
                // it began.
                let on = stroke.filter(|on| on.on.region.is_some() && commit.is_none());
                let select = on.map(|on| Item::Region(on.on.name));
                ToolOutput { commit, select, ..ToolOutput::saying(words(tool, around)) }
            }
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.stroke = None;
                self.heading.forget();
                ToolOutput::saying(words(tool, around))
            }
            ToolEvent::Key(_) => match &self.stroke {
                Some(stroke) => ToolOutput { preview: stroke.command(around), ..self.under_way(around) },
                None => ToolOutput::saying(words(tool, around)),
            },
        }
    }

    /// What shows while no drag is under way: rings, a needle, a preview, a label, and words for the status line.
    fn aim(&mut self, tool: Tool, at_px: DVec2, at_secs: f64, around: &Surroundings) -> ToolOutput {
        self.heading.follow(at_px, at_secs);
        let radius_px = around.options.radius_px;
        let hit = around.hit(at_px);
        let mut output = match around.paintable(hit.as_ref()) {
            // Where nothing can be painted, the status line says why; over nothing at all, the hollow ring says enough.
            Err(refusal) if hit.is_some() => ToolOutput { refusal: None, ..ToolOutput::refusing(refusal) },
            _ => ToolOutput::saying(words(tool, around)),
        };
        let Some(hit) = hit else {
            output.rings = vec![Ring::hollow(at_px, radius_px)];
            return output;
        };
        output.rings = Ring::all_on(&hit, around);
        let shown = around.painted.shown_at(&hit);
        let moving = self.heading.is_moving(at_secs);
        let lying = shown.map(|shown| DVec2::from_angle(-shown.angle_rad));
        let along = if moving { self.heading.along().or(lying) } else { lying };
        self.previews_comb = moving || self.previews_comb && !self.heading.rests(at_secs);
        if tool == Tool::Amount {
            let of = around.options.amount;
            let factor = around.painted.factor_at(&hit, of).filter(|_| self.heading.rests(at_secs));
            output.label = factor.map(|factor| format!("{} ×{factor:.2}", of.word()));
            return output;
        }
        output.comb_preview = self.comb_preview(tool, &hit, around);
        output.needle = along.map(|along| Needle { at_px, along, headed: moving });
        if let Some(shown) = shown.filter(|_| self.heading.rests(at_secs)) {
            // Both ends of a line are alike, so its angle is shown from −90° to 90°. `+ 0.0` turns −0 into 0.
            let angle_deg = shown.angle_rad.to_degrees();
            let angle_deg = (angle_deg - 180.0 * (angle_deg / 180.0).round()).round() + 0.0;
            output.label = Some(format!("{angle_deg}°  trust {:.2}", shown.trust));
        }
        output
    }

    /// The comb that a drag from here would begin; `None` if it would begin none, or previews are off or not due.
    fn comb_preview(&self, tool: Tool, hit: &Hit, around: &Surroundings) -> Option<CombPreview> {
        let options = around.options;
        let wanted = tool == Tool::Comb && options.foresee && self.previews_comb;
        if !wanted || options.front_only && !hit.front {
            return None;
        }
        let on = around.paintable(Some(hit)).ok()?;
        let along = self.heading.along()?;
        Some(CombPreview {
            object: on.object,
            region: on.region,
            position_in_model: hit.position_in_model,
            normal_in_model: hit.normal_in_model,
            radius: radius_in_model(hit, options.radius_px, around),
            at_px: around.view.project(around.world(hit.object, hit.position_in_model))?,
            along: if options.against { -along } else { along },
        })
    }

    fn press(
        &mut self,
        tool: Tool,
        (at_px, held, pressure): (DVec2, Modifiers, f64),
        around: &Surroundings,
    ) -> ToolOutput {
        let does = Act::of(tool, held, around);
        let begun = does.begin(at_px, around);
        let (on, hit) = match begun {
            Ok(begun) => begun,
            Err(refusal) => return ToolOutput::refusing(refusal),
        };
        let options = around.options;
        let settings = PathSettings {
            radius_px: options.radius_px,
            steady: options.steady,
            faces: if options.front_only { Faces::Front } else { Faces::All },
        };
        let path = SurfacePath::press(at_px, &hit, around.view, around.pose(hit.object), &settings);
        let sense = if options.against != held.ctrl { PathSense::Against } else { PathSense::Along };
        let stroke = Stroke { does, on, path: path.pressed(pressure), sense, at_px };
        let preview = stroke.command(around);
        self.stroke = Some(stroke);
        ToolOutput { preview, ..self.under_way(around) }
    }

    /// What shows during a drag: the rings, the needle and the words of the status line.
    fn under_way(&self, around: &Surroundings) -> ToolOutput {
        let Some(stroke) = &self.stroke else { return ToolOutput::default() };
        let options = stroke.felt_now(around).options(around);
        let around = &Surroundings { options: &options, ..*around };
        let radius_px = options.radius_px;
        let along = self.heading.along();
        let angle = along.map(|along| {
            let along = if stroke.sense == PathSense::Against { -along } else { along };
            // `+ 0.0` turns −0 into 0.
            let angle_deg = (along * DVec2::new(1.0, -1.0)).to_angle().to_degrees().round() + 0.0;
            format!(", {angle_deg}°")
        });
        let angle = angle.filter(|_| stroke.does == Act::Comb).unwrap_or_default();
        let (verb, name) = (stroke.does.words(around.options.amount), &stroke.on.name);
        let status = format!("{verb} {name}{angle}, radius {radius_px:.0} px   [Esc] take it back");
        let hit = around.hit(stroke.at_px).filter(|hit| hit.object == stroke.on.object);
        let rings = match &hit {
            Some(hit) => Ring::all_on(hit, around),
            None => vec![Ring::hollow(stroke.at_px, radius_px)],
        };
        let needle = along.filter(|_| !stroke.does.is_for_amounts());
        let needle = needle.map(|along| Needle { at_px: stroke.at_px, along, headed: true });
        ToolOutput { rings, needle, ..ToolOutput::saying(status) }
    }
}

/// The words of the status line while no drag is under way. For the region brush they name the region that it paints.
fn words(tool: Tool, around: &Surroundings) -> String {
    let selected = around.selected_region().and_then(|region| around.scene().regions.get(region));
    let name = selected.map_or("a new region", |region| region.name.as_str());
    waiting_words(tool, around.options, name)
}

impl Act {
    fn of(tool: Tool, held: Modifiers, around: &Surroundings) -> Self {
        match tool {
            Tool::Smooth if around.options.smear => Self::Smear,
            Tool::Smooth => Self::Smooth,
            Tool::Erase => Self::Erase,
            Tool::Region if held.ctrl || around.options.region_does == RegionDoes::TakeAway => Self::TakeAway,
            Tool::Region if around.options.region_does == RegionDoes::New => Self::AddNew,
            Tool::Region => Self::Add,
            Tool::Amount if held.shift => Self::EraseAmount,
            Tool::Amount if around.options.lowers != held.ctrl => Self::Lower,
            Tool::Amount => Self::Raise,
            _ if held.shift => Self::Smooth,
            _ => Self::Comb,
        }
    }

    /// What the drag does, for the status line; `of` is the amount that it paints, if it paints one.
    fn words(self, of: Amount) -> String {
        let of = of.word();
        match self {
            Self::Comb => "Combing".to_owned(),
            Self::Smooth => "Smoothing".to_owned(),
            Self::Smear => "Smearing".to_owned(),
            Self::Erase => "Erasing on".to_owned(),
            Self::Add => "Adding to".to_owned(),
            Self::TakeAway => "Taking from".to_owned(),
            Self::AddNew => "Painting".to_owned(),
            Self::Raise => format!("Raising the {of} on"),
            Self::Lower => format!("Lowering the {of} on"),
            Self::EraseAmount => format!("Erasing the {of} on"),
        }
    }

    /// Whether it changes what a region covers. If so, a drag may cross other regions.
    fn is_for_regions(self) -> bool {
        matches!(self, Self::Add | Self::TakeAway | Self::AddNew)
    }

    /// Whether a drag leaves dabs, each with a radius of its own. Otherwise the whole drag has one radius.
    fn leaves_dabs(self) -> bool {
        self.is_for_regions() || matches!(self, Self::Raise | Self::Lower)
    }

    /// Whether it paints or erases an amount. If so, no needle shows.
    fn is_for_amounts(self) -> bool {
        matches!(self, Self::Raise | Self::Lower | Self::EraseAmount)
    }

    /// What a press acts on, and where it meets the surface.
    fn begin(self, at_px: DVec2, around: &Surroundings) -> Result<(Paintable, Hit), Refusal> {
        let nothing = || Refusal::new(NOTHING_HERE);
        let hit = around.hit(at_px).ok_or_else(nothing)?;
        if around.options.front_only && !hit.front {
            return Err(nothing());
        }
        if !self.is_for_regions() {
            return Ok((around.paintable(Some(&hit))?, hit));
        }
        let object = around.object(hit.object).ok_or_else(nothing)?;
        if object.locked {
            return Err(Refusal::new(format!("{} is locked", object.name)));
        }
        if self == Self::AddNew {
            let name = "new region".to_owned();
            let target = RegionTarget::NewOn(object.name.clone());
            return Ok((
                Paintable { object: hit.object, region: None, target, name, object_name: None },
                hit,
            ));
        }
        let chosen =
            around.selected_region().and_then(|index| Some((index, around.scene().regions.get(index)?)));
        let Some((index, region)) = chosen else {
            return Err(Refusal::new("Select a region to paint it, or choose New region"));
        };
        let name = region.name.clone();
        if region.locked {
            return Err(Refusal::new(format!("{name} is locked")));
        }
        match region.on.object() {
            Some(on) if on != object.name => Err(Refusal::of_another(&name, on, &object.name)),
            _ => {
                let target = RegionTarget::Named(name.clone());
                let region = Some(index);
                Ok((Paintable { object: hit.object, region, target, name, object_name: None }, hit))
            }
        }
    }

    /// A function that finds the surface under a pixel, if the drag may go there. A drag stays on the object where it
    /// began. Unless it changes what a region covers, it also stays in the region where it began.
    fn picks<'a>(
        self,
        on: &'a Paintable,
        around: &'a Surroundings<'_>,
    ) -> impl FnMut(DVec2) -> Option<Hit> + 'a {
        move |at_px| {
            let hit = around.hit(at_px).filter(|hit| hit.object == on.object)?;
            let within = self.is_for_regions() || {
                let region = around.painted.region_at(&hit);
                region.filter(|&region| region < around.scene().regions.len()) == on.region
            };
            within.then_some(hit)
        }
    }
}

impl Stroke {
    /// The factors by which the pen's pressure changes the ring that is shown.
    fn felt_now(&self, around: &Surroundings) -> Felt {
        match self.does.leaves_dabs() {
            true => Felt::of(self.path.pressure(), around.options),
            false => Felt::of_path(&self.path, around.options),
        }
    }

    /// The command that a release of the button would give now; `None` if it would change nothing.
    fn command(&self, around: &Surroundings) -> Option<Command> {
        let path = self.path.finished(&mut self.does.picks(&self.on, around));
        let felt = Felt::of_path(&path, around.options);
        let path = if self.does.leaves_dabs() { path } else { path.narrowed(felt.radius) };
        let directions = |gesture: Gesture, guides: Vec<Guide>| {
            let region = self.on.target.clone();
            (!guides.is_empty()).then_some(Command::Directions(Directions::Stroke {
                region,
                gesture,
                guides,
            }))
        };
        match self.does {
            Act::Comb => directions(Gesture::Comb, self.guides(&path, GuideMode::Comb, around)),
            Act::Smooth => directions(Gesture::Smooth, self.guides(&path, GuideMode::Smooth, around)),
            Act::Smear => directions(Gesture::Smear, self.guides(&path, GuideMode::Comb, around)),
            Act::Erase => self.erased(&path, around),
            Act::Add | Act::TakeAway | Act::AddNew => Some(self.dabbed(&path, around)),
            Act::Raise | Act::Lower => self.raised(&path, around),
            Act::EraseAmount => self.amounts_erased(&path, around),
        }
    }

    /// The guides of a path's pieces, then the mirror images of those guides.
    fn guides(&self, path: &SurfacePath, mode: GuideMode, around: &Surroundings) -> Vec<Guide> {
        let options = around.options;
        let style = GuideStyle {
            mode,
            object: self.on.object_name.clone(),
            strength: Felt::of_path(path, options).strength(options.strength),
            falloff: if options.even { Falloff::Flat } else { Falloff::Smooth },
            sense: self.sense,
        };
        let [seen, reference] = around.views(self.on.object, self.on.region);
        let own = if self.does == Act::Smear {
            let stamps = path.stamps();
            let shown = stamps.iter().map(|stamp| {
                let hit = around.hit(stamp.at_px).filter(|hit| hit.object == self.on.object)?;
                around.painted.shown_at(&hit).map(|shown| shown.angle_rad)
            });
            let carried = smear::carried(shown);
            path.guides_turned(&style, [&seen, &reference], &|point, line_rad| {
                smear::turn_deg(point, line_rad, &stamps, &carried)
            })
        } else {
            path.guides(&style, &seen, &reference)
        };
        let flips = mirror_axes(around).flips();
        let mut nearest =
            |at, facing, farthest| around.picker.closest_on_surface(self.on.object, at, facing, farthest);
        let mut guides = own.clone();
        for flip in flips {
            guides
                .extend(own.iter().flat_map(|guide| mirrored(guide, flip, &seen, &reference, &mut nearest)));
        }
        guides
    }

    /// The points at which the brush touches the surface along a path, spaced by `share` times the brush's radius.
    /// Their mirror images follow, except those that no surface is near.
    fn touched(&self, path: &SurfacePath, share: f64, around: &Surroundings) -> Vec<PathPoint> {
        let mut touched = match self.does.leaves_dabs() {
            true => path.stamps_of(share, &|point| Felt::at(point, around.options).radius),
            false => path.stamps_apart(share),
        };
        let own = touched.len();
        for flip in mirror_axes(around).flips() {
            for index in 0..own {
                let stamp = touched[index];
                let (at, normal) = (stamp.position * flip, stamp.normal * flip);
                let reach = path.radius() * 0.5;
                if let Some(found) = around.picker.closest_on_surface(self.on.object, at, normal, reach) {
                    touched.push(PathPoint { position: found.position, normal: found.normal, ..stamp });
                }
            }
        }
        touched
    }

    fn erased(&self, path: &SurfacePath, around: &Surroundings) -> Option<Command> {
        let region = around.scene().regions.get(self.on.region?)?;
        let touched = self.touched(path, STAMP_SHARE, around);
        let object = around.object(self.on.object)?.name.as_str();
        let guides: Vec<Guide> = region
            .guides
            .iter()
            .flat_map(|guide| match guide.object.as_deref().or(region.on.object()) {
                Some(on) if on == object => erase::cut(guide, &touched, path.radius()),
                _ => vec![guide.clone()],
            })
            .collect();
        let erase =
            || Command::Directions(Directions::Erase { region: region.name.clone(), guides: guides.clone() });
        (guides != region.guides).then(erase)
    }

    /// The command for the dabs of a drag that raises or lowers an amount; `None` if they would change nothing.
    fn raised(&self, path: &SurfacePath, around: &Surroundings) -> Option<Command> {
        let options = around.options;
        let raises = self.does == Act::Raise;
        let touched = self.touched(path, amounts::DAB_SHARE, around);
        let mut dabs = amounts::dabs(&touched, path.radius(), |point| {
            let felt = Felt::at(point, options);
            (felt.radius, amounts::factor(options.amount, raises, options.strength * felt.strength))
        });
        dabs.retain(|dab| dab.by != 1.0);
        (!dabs.is_empty()).then(|| {
            Command::Amounts(Amounts::Paint {
                region: self.on.target.clone(),
                of: options.amount,
                object: self.on.object_name.clone(),
                dabs,
            })
        })
    }

    fn amounts_erased(&self, path: &SurfacePath, around: &Surroundings) -> Option<Command> {
        let region = around.scene().regions.get(self.on.region?)?;
        let object = around.object(self.on.object)?.name.as_str();
        let of = around.options.amount;
        let touched = self.touched(path, STAMP_SHARE, around);
        let left = amounts::erased(region, (of, object), &touched, path.radius());
        let region_name = region.name.clone();
        (left != region.amounts).then_some(Command::Amounts(Amounts::Erase { region: region_name, of, left }))
    }

    fn dabbed(&self, path: &SurfacePath, around: &Surroundings) -> Command {
        let take_away = self.does == Act::TakeAway;
        let dabs: Vec<Dab> = self
            .touched(path, STAMP_SHARE, around)
            .iter()
            .map(|stamp| Dab {
                at: stamp.position.to_array(),
                normal: stamp.normal.to_array(),
                radius: path.radius() * Felt::at(stamp, around.options).radius,
                take_away,
            })
            .collect();
        match &self.on.target {
            RegionTarget::Named(region) => Command::Regions(Regions::Paint { region: region.clone(), dabs }),
            RegionTarget::NewOn(object) => {
                let name = format!("{object} part");
                Command::Regions(Regions::Add(Box::new(Region::new(
                    name,
                    Selector::Dabs(object.clone(), dabs),
                ))))
            }
        }
    }
}

pub(super) fn mirror_axes(around: &Surroundings) -> MirrorAxes {
    let [x, y, z] = around.options.mirror;
    MirrorAxes { x, y, z }
}

/// Radius of the brush at a hit, in the object's own units.
pub(super) fn radius_at(hit: &Hit, around: &Surroundings) -> f64 {
    radius_in_model(hit, around.options.radius_px, around)
}
