//! Commands on directions: guides that gestures make, base directions of regions, references.

use impasto_scene::document::{
    Direction, Falloff, Guide, GuideMode, GuidePoint, GuideView, Reference, Region, Scene, Selector, Sense,
};
use impasto_scene::motion;

use super::{Done, finite, unlocked_object, unlocked_region};
use crate::euler::tidy;
use crate::names;
use crate::path::simplify;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// The region that a gesture works on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RegionTarget {
    /// An existing region.
    Named(String),
    /// A new region that covers the whole object of this name. The gesture and its region are one entry of the history.
    NewOn(String),
}

/// The kind of a gesture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Strokes follow it.
    Comb,
    /// Directions under it are smoothed.
    Smooth,
    /// Directions were dragged along it.
    Smear,
    /// A curve drawn by its points.
    Curve,
}

/// Settings of a whole guide; `None` keeps the old value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideSettings {
    /// How far the guide reaches, units of the object's own space.
    pub radius: Option<f64>,
    /// How far strokes on the guide follow it, 0..=1.
    pub strength: Option<f64>,
    /// How its strength falls off with distance.
    pub falloff: Option<Falloff>,
}

/// Directions and guides.
#[derive(Clone, Debug, PartialEq)]
pub enum Directions {
    /// Adds the guides of one gesture: its pieces and their mirror images.
    Stroke {
        /// The region that the guides belong to.
        region: RegionTarget,
        /// The kind of the gesture.
        gesture: Gesture,
        /// The guides. After a curve, the last one is selected.
        guides: Vec<Guide>,
    },
    /// Replaces the guides of a region, as an eraser does.
    Erase {
        /// The region.
        region: String,
        /// What is left.
        guides: Vec<Guide>,
    },
    /// Moves a point of a guide.
    MoveGuidePoint {
        /// The region and the guide's place in it.
        guide: (String, usize),
        /// Which point.
        point: usize,
        /// Where to.
        to: GuidePoint,
    },
    /// Inserts a point into a guide, before the point with this index.
    InsertGuidePoint {
        /// The region and the guide's place in it.
        guide: (String, usize),
        /// The index of that point.
        point: usize,
        /// Where.
        at: GuidePoint,
    },
    /// Removes a point from a guide; a guide with fewer than two points left is removed.
    DeleteGuidePoint {
        /// The region and the guide's place in it.
        guide: (String, usize),
        /// Which point.
        point: usize,
    },
    /// Changes radius, strength or falloff of a guide.
    SetGuide {
        /// The region and the guide's place in it.
        guide: (String, usize),
        /// What changes.
        settings: GuideSettings,
    },
    /// Turns a guide round: it points the other way.
    FlipGuide(String, usize),
    /// States the base direction of a region.
    SetBase {
        /// The region.
        region: RegionTarget,
        /// The direction.
        direction: Direction,
    },
    /// Turns all directions of a region, degrees counter-clockwise.
    Turn {
        /// The region.
        region: RegionTarget,
        /// By how much.
        by_deg: f64,
    },
    /// Turns all directions of a region round, so that strokes begin where they ended.
    Flip(RegionTarget),
    /// States whether the strokes of a region have a beginning and an end.
    SetSense(String, Sense),
    /// Removes guide points that lie within a distance of the line between their neighbours, and guides that later
    /// ones cover.
    Simplify {
        /// The region.
        region: String,
        /// The distance, units of the object's own space.
        tolerance: f64,
    },
    /// Takes a frame as the new reference. No direction changes.
    Recapture(i64),
}

impl Directions {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::Stroke { region, gesture, guides } => {
                let name = target(scene, region)?;
                if guides.is_empty() {
                    return Err(Refusal::new("Nothing to paint here: the ring must lie on an object"));
                }
                let edited = unlocked_region(scene, &name)?;
                let is_first = *gesture == Gesture::Comb && edited.guides.is_empty();
                edited.guides.extend(guides.iter().cloned());
                let item = match gesture {
                    Gesture::Curve => Item::Guide(name.clone(), edited.guides.len() - 1),
                    _ => Item::Region(name.clone()),
                };
                let text = match gesture {
                    Gesture::Comb => format!("Comb {name}"),
                    Gesture::Smooth => format!("Smooth {name}"),
                    Gesture::Smear => format!("Smear {name}"),
                    Gesture::Curve => "Draw guide".to_owned(),
                };
                let done = Done::new(text).selecting(Selection::only(item));
                Ok(match is_first {
                    true => done
                        .noting(format!("The first stroke turns all of {name}; the next ones share it out")),
                    false => done,
                })
            }
            Self::Erase { region, guides } => {
                unlocked_region(scene, region)?.guides.clone_from(guides);
                let selection = Selection::only(Item::Region(region.clone()));
                Ok(Done::new(format!("Erase on {region}")).selecting(selection))
            }
            Self::MoveGuidePoint { guide, point, to } => {
                *guide_of(scene, guide)?.points.get_mut(*point).ok_or_else(no_point)? = to.clone();
                Ok(edited(guide))
            }
            Self::InsertGuidePoint { guide, point, at } => {
                let points = &mut guide_of(scene, guide)?.points;
                points.insert((*point).min(points.len()), at.clone());
                Ok(edited(guide))
            }
            Self::DeleteGuidePoint { guide, point } => {
                let points = &mut guide_of(scene, guide)?.points;
                if *point >= points.len() {
                    return Err(no_point());
                }
                points.remove(*point);
                if points.len() >= 2 {
                    return Ok(edited(guide));
                }
                unlocked_region(scene, &guide.0)?.guides.remove(guide.1);
                let selection = Selection::only(Item::Region(guide.0.clone()));
                Ok(Done::new(format!("Delete guide g{} of {}", guide.1 + 1, guide.0)).selecting(selection))
            }
            Self::SetGuide { guide, settings } => set_guide(guide_of(scene, guide)?, settings),
            Self::FlipGuide(region, index) => {
                flip(guide_of(scene, &(region.clone(), *index))?);
                Ok(Done::new(format!("Flip guide g{}", index + 1)))
            }
            Self::SetBase { region, direction } => {
                let name = target(scene, region)?;
                unlocked_region(scene, &name)?.direction = direction.clone();
                let words = words_of(direction);
                let selection = Selection::only(Item::Region(name.clone()));
                Ok(Done::new(format!("Fill {name}: {words}")).selecting(selection))
            }
            Self::Turn { region, by_deg } => {
                let name = target(scene, region)?;
                turn(unlocked_region(scene, &name)?, finite(*by_deg)?);
                let selection = Selection::only(Item::Region(name.clone()));
                Ok(Done::new(format!("Turn {name} {}°", tidy(*by_deg))).selecting(selection))
            }
            Self::Flip(region) => {
                let name = target(scene, region)?;
                let edited = unlocked_region(scene, &name)?;
                turn(edited, 180.0);
                let selection = Selection::only(Item::Region(name.clone()));
                Ok(Done::new(format!("Flip {name}")).selecting(selection))
            }
            Self::SetSense(name, sense) => {
                unlocked_region(scene, name)?.sense = *sense;
                Ok(Done::new(match sense {
                    Sense::Lines => format!("{name}: lines"),
                    Sense::Arrows => format!("{name}: arrows"),
                }))
            }
            Self::Simplify { region, tolerance } => simplify(unlocked_region(scene, region)?, *tolerance),
            Self::Recapture(frame) => recapture(scene, *frame),
        }
    }
}

fn edited((_, index): &(String, usize)) -> Done {
    Done::new(format!("Edit guide g{}", index + 1))
}

fn no_point() -> Refusal {
    Refusal::new("The guide has no such point")
}

/// The name of the region that a gesture works on; the region is made if it does not exist yet.
pub(super) fn target(scene: &mut Scene, region: &RegionTarget) -> Result<String, Refusal> {
    match region {
        RegionTarget::Named(name) => Ok(name.clone()),
        RegionTarget::NewOn(object) => {
            unlocked_object(scene, object)?;
            let name = names::unique(object, scene.regions.iter().map(|region| region.name.as_str()));
            // Inserted first, because later regions win: those that cover a part of the object take precedence.
            scene.regions.insert(0, Region::new(name.clone(), Selector::Object(object.clone())));
            Ok(name)
        }
    }
}

fn guide_of<'a>(scene: &'a mut Scene, (region, index): &(String, usize)) -> Result<&'a mut Guide, Refusal> {
    let guide = unlocked_region(scene, region)?.guides.get_mut(*index);
    guide.ok_or_else(|| Refusal::new(format!("{region} has no guide g{}", index + 1)))
}

fn set_guide(guide: &mut Guide, settings: &GuideSettings) -> Result<Done, Refusal> {
    let mut text = "Guide";
    if let Some(radius) = settings.radius {
        if finite(radius)? <= 0.0 {
            return Err(Refusal::new("A guide reaches further than nothing"));
        }
        (guide.radius, text) = (radius, "Guide radius");
    }
    if let Some(strength) = settings.strength {
        (guide.strength, text) = (finite(strength)?.clamp(0.0, 1.0), "Guide strength");
    }
    if let Some(falloff) = settings.falloff {
        (guide.falloff, text) = (falloff, "Guide falloff");
    }
    Ok(Done::new(text))
}

fn flip(guide: &mut Guide) {
    guide.points.reverse();
}

fn turn(region: &mut Region, by_deg: f64) {
    let turned = tidy((region.turn_deg + by_deg + 180.0).rem_euclid(360.0) - 180.0);
    region.turn_deg = if turned == -180.0 { 180.0 } else { turned };
}

/// The name of a base direction in the history.
pub(crate) fn words_of(direction: &Direction) -> String {
    match direction {
        Direction::Auto => "automatic".to_owned(),
        Direction::Angle(angle) => format!("{}°", tidy(*angle)),
        Direction::Crossing(a, b) => format!("crossing {}° and {}°", tidy(*a), tidy(*b)),
        Direction::Along(_) => "along".to_owned(),
        Direction::Around(_) => "around".to_owned(),
        Direction::Up => "up".to_owned(),
        Direction::Toward(_) => "toward a point".to_owned(),
        Direction::Curvature(_) => "curvature".to_owned(),
    }
}

/// Removes points within `tolerance` of the line between their neighbours, and guides that a later guide covers at full
/// strength.
fn simplify(region: &mut Region, tolerance: f64) -> Result<Done, Refusal> {
    let before = region.guides.len();
    let covers = |later: &Guide, earlier: &Guide| {
        later.strength >= 1.0
            && later.object == earlier.object
            && (later.mode, later.falloff) == (GuideMode::Comb, Falloff::Flat)
            && earlier.points.iter().all(|point| {
                later.points.iter().any(|over| {
                    let apart = glam::DVec3::from(point.at).distance(glam::DVec3::from(over.at));
                    apart + earlier.radius <= later.radius
                })
            })
    };
    let guides = std::mem::take(&mut region.guides);
    for (index, guide) in guides.iter().enumerate() {
        if !guides[index + 1..].iter().any(|later| covers(later, guide)) {
            let points = simplify::guide_within(&guide.points, tolerance);
            region.guides.push(Guide { points, ..guide.clone() });
        }
    }
    let after = region.guides.len();
    Ok(Done::new(format!("Simplify {before} guides to {after}")))
}

/// Changes the scene's reference. The old one is written into the guides and regions that were stated in it, so that no
/// direction changes.
fn recapture(scene: &mut Scene, frame: i64) -> Result<Done, Refusal> {
    let new = Reference::Frame(frame);
    if scene.reference == new {
        return Err(Refusal::new(format!("Frame {frame} is the reference already")));
    }
    let old = std::mem::replace(&mut scene.reference, new);
    let (camera, at) = motion::referred_to(scene, &old);
    let poses = motion::poses_at(scene, at);
    let bends: Vec<bool> = scene.objects.iter().map(|object| motion::bends(scene, object)).collect();
    let objects = &scene.objects;
    let view_of = |object: Option<&str>| {
        let index = objects.iter().position(|other| Some(other.name.as_str()) == object)?;
        let model_from_world = poses[index].inverse();
        let [eye, target] =
            [camera.eye, camera.target].map(|at| model_from_world.transform_point3(at).to_array());
        Some(GuideView { eye, target, frame: bends[index].then_some(at) })
    };
    let mut regions = std::mem::take(&mut scene.regions);
    for region in &mut regions {
        let on = region.on.object().map(str::to_owned);
        // If a region has a reference of its own, its guides refer to that reference.
        let follows_the_scene = region.reference.is_none();
        for guide in region.guides.iter_mut().filter(|guide| follows_the_scene && guide.view.is_none()) {
            guide.view = view_of(guide.object.as_deref().or(on.as_deref()));
        }
        let is_of_the_picture =
            matches!(region.direction, Direction::Auto | Direction::Angle(_) | Direction::Crossing(..));
        if region.reference.is_none() && is_of_the_picture {
            region.reference = Some(old.clone());
        }
    }
    scene.regions = regions;
    Ok(Done::new(format!("Reference: frame {frame}")))
}
