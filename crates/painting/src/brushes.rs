//! The brushes that a scene's layers use, and their marks.

use std::sync::{Arc, OnceLock};

use impasto_core::brush::{self, Mark};
use impasto_core::hash;
use impasto_scene::document::Scene;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::presets::{LayerKind, ResolvedLayer};
use rayon::prelude::*;

use crate::frame::{Brushes, Stroke};
use crate::regions::RegionRule;

/// The marks of the brushes that come with Impasto, made once in a process.
static MARKS: [OnceLock<Arc<Vec<Mark>>>; brush::NAMES.len()] =
    [const { OnceLock::new() }; brush::NAMES.len()];

/// The names of the brushes of all layers that lay paint, and of touches, sorted.
pub(crate) fn names_of(scene: &Scene, rules: &[RegionRule]) -> Vec<String> {
    let mut names: Vec<String> = rules
        .iter()
        .flat_map(|rule| LayerKind::ALL.map(|kind| rule.strokes.layer_of(kind)))
        .filter(|layer| layer.coverage > 0.0)
        .flat_map(|layer| layer.brushes.iter().cloned())
        .collect();
    names.extend(scene.touches.iter().filter_map(|touch| touch.brush.clone()));
    names.sort();
    names.dedup();
    names
}

pub(crate) fn of_names(loaded: &LoadedScene, names: Vec<String>) -> Brushes {
    make_built_in_marks(&names);
    let marks = names.iter().map(|name| marks_of(loaded, name)).collect();
    Brushes { names, marks }
}

/// Adds the marks of built-in brushes to those that all paintings of this process share, unless they are there already.
pub(crate) fn know(brushes: &Brushes) {
    for (name, marks) in brushes.names.iter().zip(&brushes.marks) {
        if let Some(index) = brush::NAMES.iter().position(|known| known == name) {
            MARKS[index].get_or_init(|| Arc::clone(marks));
        }
    }
}

/// Makes the built-in marks that have not been made yet, on all threads. It holds no lock while it works. Two callers
/// at once make the same marks; those of one caller stay, the others are dropped.
fn make_built_in_marks(names: &[String]) {
    let missing: Vec<(usize, u32)> = names
        .iter()
        .filter_map(|name| brush::NAMES.iter().position(|known| known == name))
        .filter(|&index| MARKS[index].get().is_none())
        .flat_map(|index| (0..brush::VARIANTS).map(move |variant| (index, variant)))
        .collect();
    let made: Vec<Mark> =
        missing.par_iter().map(|&(index, variant)| brush::mark_of(index, variant)).collect();
    let mut made = made.into_iter();
    for of_brush in missing.chunks(brush::VARIANTS as usize) {
        let marks = made.by_ref().take(of_brush.len()).collect();
        MARKS[of_brush[0].0].get_or_init(|| Arc::new(marks));
    }
}

fn built_in_marks(name: &str) -> Option<Arc<Vec<Mark>>> {
    let index = brush::NAMES.iter().position(|known| *known == name)?;
    let make = || Arc::new(brush::marks_of(name).unwrap_or_default());
    Some(Arc::clone(MARKS[index].get_or_init(make)))
}

fn marks_of(loaded: &LoadedScene, name: &str) -> Arc<Vec<Mark>> {
    if let Some(marks) = built_in_marks(name) {
        return marks;
    }
    let marks =
        loaded.brushes.get(name).map(|picture| brush::marks_of_picture(picture.size_px, &picture.rgba8));
    match marks.filter(|marks| !marks.is_empty()) {
        Some(marks) => Arc::new(marks),
        // Only a scene that was not checked gets here; any mark will do.
        None => marks_of(loaded, brush::NAMES[0]),
    }
}

impl Brushes {
    /// Brushes that come with Impasto, by name; names that do not exist are left out.
    pub fn of_names(names: &[&str]) -> Self {
        let mut names: Vec<String> =
            names.iter().filter(|name| brush::NAMES.contains(*name)).map(|&name| name.to_owned()).collect();
        names.sort();
        names.dedup();
        let marks = names.iter().filter_map(|name| built_in_marks(name)).collect();
        Self { names, marks }
    }

    /// For each brush that a layer names (repeats included), the index of its first mark among the marks of all
    /// brushes.
    pub(crate) fn first_marks(&self, layer: &ResolvedLayer) -> Vec<u32> {
        let index = |name: &String| self.names.binary_search(name).unwrap_or(0) as u32;
        layer.brushes.iter().map(|name| index(name) * brush::VARIANTS).collect()
    }
}

/// The mark of a stroke, as in [`Stroke::mark`]. `order` is the particle's place in its coat. Steps by irrational
/// ratios (the golden one for the marks of a brush, the plastic one for the brushes) keep particles that follow each
/// other from taking the same mark.
pub(crate) fn mark(first_marks: &[u32], order: u32, bits: u32) -> u32 {
    let step = |ratio: f64, count: u32| {
        ((f64::from(order) * ratio + f64::from(hash::unit(hash::combine(bits, 11))) * 0.2).fract()
            * f64::from(count)) as u32
    };
    let variant = step(0.618_033_988_75, brush::VARIANTS).min(brush::VARIANTS - 1);
    let count = first_marks.len() as u32;
    let brush = step(0.754_877_666_25, count).min(count.saturating_sub(1));
    let flip = hash::combine(bits, 12) & 1;
    (first_marks.get(brush as usize).copied().unwrap_or(0) + variant) | (flip * Stroke::FLIPPED)
}
