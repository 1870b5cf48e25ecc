//! Tests of drafts. Their strokes have the colours of the exact picture. With a recall, a draft has all strokes that
//! were present in the previous picture, and only some of the others.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use glam::Vec3;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, Painting, Quality, Recall};
use impasto_scene::motion;
use impasto_tests::pictures::renderer;
use impasto_tests::scenes;

const DRAFT: FrameOptions = FrameOptions { quality: Quality::Draft, ..FrameOptions::new([320, 180]) };

fn still_life() -> Arc<Painting> {
    scenes::painting("still_life")
}

fn seen(painting: &Painting, recall: Option<&Recall>) -> Frame {
    let camera = motion::camera_at(painting.scene(), 0.0);
    let mut frame = painting.bare(&camera, 0.0, &DRAFT);
    frame.lay(painting.strokes(&camera, 0.0, &DRAFT, recall));
    frame
}

fn places(frame: &Frame) -> BTreeSet<u32> {
    frame.sources.iter().map(|source| source.place).collect()
}

#[test]
fn present_strokes_are_drawn_at_once_and_the_others_within_32_pictures() {
    let painting = still_life();
    let all = seen(&painting, None);
    assert!(all.strokes.len() > 10_000, "{}", all.strokes.len());
    // Every third stroke counts as present in the previous picture.
    let there = |index: usize| index.is_multiple_of(3);
    let mut found = BTreeSet::new();
    for turn in 0..32 {
        let recall = Recall::of(&painting, &all, there, turn);
        let frame = seen(&painting, Some(&recall));
        assert!(frame.strokes.len() < all.strokes.len() * 3 / 4, "{turn}: {}", frame.strokes.len());
        let now = places(&frame);
        for (index, source) in all.sources.iter().enumerate().filter(|(index, _)| there(*index)) {
            assert!(now.contains(&source.place), "{turn}: stroke {index} was there");
        }
        // The strokes that are drawn are as in a frame without a recall, and in the same order.
        let same = all.sources.iter().zip(&all.strokes).filter(|(source, _)| now.contains(&source.place));
        assert!(same.map(|(_, stroke)| stroke).eq(&frame.strokes), "{turn}");
        assert_eq!(frame.layers.iter().map(|run| run.count as usize).sum::<usize>(), frame.strokes.len());
        found.extend(now);
    }
    assert!(found == places(&all), "{} of {}", found.len(), all.strokes.len());
}

#[test]
fn large_strokes_are_late_by_one_picture_at_most() {
    let painting = still_life();
    let all = seen(&painting, None);
    let body = |frame: &Frame| -> BTreeSet<u32> {
        let runs = frame.layers.iter().filter(|run| run.kind == LayerKind::Body);
        runs.flat_map(|run| &frame.sources[run.first as usize..][..run.count as usize])
            .map(|source| source.place)
            .collect()
    };
    let asked = |turn: u32| body(&seen(&painting, Some(&Recall::of(&painting, &all, |_| false, turn))));
    let both: BTreeSet<u32> = asked(0).union(&asked(1)).copied().collect();
    assert!(body(&all) == both, "{} of {}", both.len(), body(&all).len());
}

#[test]
fn another_painting_draws_all_its_strokes() {
    let painting = still_life();
    let none = Recall::of(&painting, &seen(&painting, None), |_| false, 0);
    let again = scenes::painting_with("still_life", &[]);
    assert_eq!(seen(&again, Some(&none)).strokes, seen(&again, None).strokes);
}

/// The colours of the strokes whose alpha is over 0.9, by their places in the painting order.
fn colors(quality: Quality) -> HashMap<u32, Vec3> {
    let mut renderer = renderer(Driver::Auto);
    let frame = still_life().at(0.0, &FrameOptions { quality, ..DRAFT });
    renderer.render(&frame).unwrap();
    let resolved = renderer.resolved_strokes();
    let there = frame.sources.iter().zip(&resolved).filter(|(_, stroke)| stroke.alpha > 0.9);
    there.map(|(source, stroke)| (source.place, Vec3::from(stroke.color_linear))).collect()
}

#[test]
fn strokes_of_a_draft_have_the_colours_of_the_exact_picture() {
    let (exact, draft) = (colors(Quality::Exact), colors(Quality::Draft));
    let away = |(place, color): (&u32, &Vec3)| exact.get(place).map(|exact| exact.distance(*color));
    let mut away: Vec<f32> = draft.iter().filter_map(away).collect();
    away.sort_by(f32::total_cmp);
    assert!(away.len() > 1000, "{}", away.len());
    let at = |share: f32| away[(share * away.len() as f32) as usize];
    assert!(at(0.5) < 0.004 && at(0.95) < 0.09, "{} {}", at(0.5), at(0.95));
}
