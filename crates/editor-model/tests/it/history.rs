//! Every command can be undone: after a thousand random commands and as many undos, the document equals the first one.

use std::path::Path;

use crate::any_command::{Dice, command};
use impasto_editor_model::{Document, Item, Selection};
use impasto_scene::load::LoadOptions;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

fn scene_of(name: &str) -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens")
}

fn dice() -> impl Strategy<Value = Dice> {
    (any::<u8>(), any::<u8>(), any::<u8>(), -4.0..4.0, -4.0..4.0)
}

/// Applies the commands that are not refused, checks that undo and redo of each are exact, then undoes everything.
fn walk(scene: &str, dice: &[Dice]) -> Result<(usize, usize), TestCaseError> {
    let mut document = scene_of(scene);
    let first = document.scene().clone();
    let (mut done, mut refused) = (0, 0);
    for &dice in dice {
        let before = document.scene().clone();
        let command = command(&before, dice);
        document.select(Selection::only(Item::Camera));
        let count = document.undo_count();
        match document.apply(&command) {
            Err(_) => {
                prop_assert_eq!(
                    document.scene(),
                    &before,
                    "a refused command changed something: {:?}",
                    command
                );
                refused += 1;
            }
            Ok(_) => {
                let after = document.scene().clone();
                let changed = document.undo_count() > count;
                prop_assert_eq!(changed, after != before, "entry and change differ: {:?}", command);
                if changed {
                    document.undo();
                    prop_assert_eq!(document.scene(), &before, "undo of {:?}", command);
                    document.redo();
                    prop_assert_eq!(document.scene(), &after, "redo of {:?}", command);
                    done += 1;
                }
            }
        }
    }
    let text = impasto_scene::save::to_ron(document.scene());
    let read = impasto_scene::load::parse(Path::new("edited.ron"), &text);
    prop_assert_eq!(read.as_ref().ok(), Some(document.scene()), "saving changed the scene");
    while document.undo().is_some() {}
    prop_assert_eq!(document.scene(), &first, "undoing everything does not give the first scene");
    Ok((done, refused))
}

fn a_thousand_commands(seed: u8) {
    let config = Config { cases: 1, failure_persistence: None, max_shrink_iters: 4000, ..Config::default() };
    let random = proptest::test_runner::TestRng::from_seed(config.rng_algorithm, &[seed; 32]);
    let mut runner = TestRunner::new_with_rng(config, random);
    let commands = proptest::collection::vec(dice(), 1000);
    let result = runner.run(&commands, |dice| {
        let (done, refused) = walk("touching_cubes.ron", &dice)?;
        prop_assert!(done > 300, "only {done} of a thousand did something, {refused} were refused");
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
}

// Two tests, so that they run side by side.
#[test]
fn a_thousand_commands_and_as_many_undos_give_the_first_document() {
    a_thousand_commands(2);
}

#[test]
fn a_thousand_other_commands_and_as_many_undos_give_the_first_document() {
    a_thousand_commands(3);
}

#[test]
fn short_runs_on_the_still_life() {
    let config = Config { cases: 20, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(
        config.clone(),
        proptest::test_runner::TestRng::deterministic_rng(config.rng_algorithm),
    );
    let commands = proptest::collection::vec(dice(), 0..30);
    let result = runner.run(&commands, |dice| walk("still_life.ron", &dice).map(|_| ()));
    if let Err(error) = result {
        panic!("{error}");
    }
}
