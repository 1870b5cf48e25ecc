//! Tests of file dialogs of the desktop that answer, are missing, crash or hang.

use std::fs;
use std::thread::sleep;

use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::theme;

struct Page {
    dialogs: FileDialogs,
    answers: Vec<Answer>,
}

fn page(source: Source, choose: Choose, ask: FileAsk, start: &Path) -> Harness<'static, Page> {
    let dialogs = FileDialogs { source, choose, open: None };
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_context_setup(|ctx| theme::apply(ctx, Theme::Dark, 1.0))
        .build_ui_state(
            |ui, page: &mut Page| page.answers.extend(page.dialogs.poll(ui.ctx())),
            Page { dialogs, answers: Vec::new() },
        );
    let ctx = harness.ctx.clone();
    harness.state_mut().dialogs.open(&ctx, ask, start);
    harness
}

/// Steps until `is_done`, for ten seconds at most.
fn wait(harness: &mut Harness<'_, Page>, is_done: impl Fn(&Harness<'_, Page>) -> bool) {
    let since = Instant::now();
    while !is_done(harness) {
        assert!(since.elapsed() < Duration::from_secs(10), "not done after ten seconds");
        harness.step();
        sleep(Duration::from_millis(10));
    }
}

fn has_sheet(harness: &Harness<'_, Page>) -> bool {
    harness.query_by_label("File name").is_some()
}

/// Lets the desktop's dialog hang until the window offers its own.
fn wait_for_offer(harness: &mut Harness<'_, Page>) {
    let open = harness.state_mut().dialogs.open.as_mut().expect("open");
    open.since = open.since.checked_sub(PATIENCE).expect("a clock that runs");
    wait(harness, |harness| harness.query_by_label("Choose here instead").is_some());
    // The bar needs one pass to measure its width, and another to be placed.
    harness.run_steps(2);
}

#[test]
fn what_the_desktop_answers_is_the_answer() {
    let mut harness =
        page(Source::Desktop, |_, start| Some(start.join("a")), FileAsk::SaveAs, Path::new("/scenes"));
    wait(&mut harness, |harness| !harness.state().answers.is_empty());
    let path = Some(PathBuf::from("/scenes/a.ron"));
    assert_eq!(harness.state().answers, [Answer { ask: FileAsk::SaveAs, path }]);
    assert!(!harness.state().dialogs.is_open());
}

#[test]
fn a_name_that_gets_its_ending_replaces_no_file_unasked() {
    let home = tempfile::tempdir().expect("a temporary folder");
    let there = home.path().join("thick.strokes.ron");
    fs::write(&there, "").expect("written");
    let choose: Choose = |_, start| Some(start.with_file_name("thick"));
    let proposed = home.path().join("new.strokes.ron");
    let mut harness = page(Source::Desktop, choose, FileAsk::SavePreset, &proposed);
    wait(&mut harness, |harness| harness.query_by_label("Keep it").is_some());
    harness.run();
    assert!(harness.state().answers.is_empty());
    harness.get_by_label("Replace").click();
    harness.run();
    assert_eq!(harness.state().answers, [Answer { ask: FileAsk::SavePreset, path: Some(there) }]);
    assert_eq!(harness.state().dialogs.source, Source::Desktop);
}

#[test]
fn an_immediate_empty_answer_opens_the_windows_own_sheet() {
    let home = tempfile::tempdir().expect("a temporary folder");
    fs::write(home.path().join("apple.obj"), "").expect("written");
    let mut harness = page(Source::Desktop, |_, _| None, FileAsk::Open, home.path());
    wait(&mut harness, has_sheet);
    harness.get_by_label("apple.obj").click();
    harness.run();
    harness.get_by_label("Open").click();
    harness.run();
    let path = Some(home.path().join("apple.obj"));
    assert_eq!(harness.state().answers, [Answer { ask: FileAsk::Open, path }]);
    assert_eq!(harness.state().dialogs.source, Source::InApp, "the desktop is not asked again");
}

#[test]
fn a_crash_of_the_desktops_dialog_opens_the_windows_own_sheet() {
    let mut harness = page(Source::Desktop, |_, _| panic!("the portal broke"), FileAsk::Open, Path::new("/"));
    wait(&mut harness, has_sheet);
}

#[test]
fn an_empty_answer_after_a_while_is_a_cancel() {
    let choose: Choose = |_, _| {
        sleep(FASTEST_CANCEL * 2);
        None
    };
    let mut harness = page(Source::Desktop, choose, FileAsk::ImportMesh, Path::new("/"));
    wait(&mut harness, |harness| !harness.state().answers.is_empty());
    assert_eq!(harness.state().answers, [Answer { ask: FileAsk::ImportMesh, path: None }]);
    assert_eq!(harness.state().dialogs.source, Source::Desktop);
}

#[test]
fn a_dialog_that_hangs_can_be_replaced_or_cancelled() {
    let choose: Choose = |_, _| {
        sleep(Duration::from_secs(3600));
        None
    };
    let mut harness = page(Source::Desktop, choose, FileAsk::Open, Path::new("/"));
    harness.step();
    assert!(harness.query_by_label("Choose here instead").is_none(), "the sheet is offered too soon");
    wait_for_offer(&mut harness);
    harness.get_by_label("Choose here instead").click();
    wait(&mut harness, has_sheet);
    harness.get_by_label("Cancel").click();
    harness.run();
    assert_eq!(harness.state().answers, [Answer { ask: FileAsk::Open, path: None }]);

    let ctx = harness.ctx.clone();
    harness.state_mut().dialogs.open(&ctx, FileAsk::Open, Path::new("/"));
    wait_for_offer(&mut harness);
    harness.get_by_label("Cancel").click();
    wait(&mut harness, |harness| harness.state().answers.len() == 2);
    assert!(!harness.state().dialogs.is_open());
}

#[test]
fn one_dialog_at_a_time() {
    let mut harness = page(Source::InApp, |_, _| None, FileAsk::Open, Path::new("/"));
    let ctx = harness.ctx.clone();
    harness.state_mut().dialogs.open(&ctx, FileAsk::SaveAs, Path::new("/"));
    harness.run();
    assert!(harness.query_by_label("Save").is_none() && harness.query_by_label("Open").is_some());
}

#[test]
fn the_desktop_lists_whatever_fits() {
    let lists = |ask: FileAsk, name: &str| {
        filters(ask)[0].1.iter().any(|ending| name.ends_with(&format!(".{ending}")))
    };
    let output = FileAsk::RenderOutput { ending: "png" };
    for name in ["a.png", "a.exr", "a.mp4", "a.mov", "a.webm", "a.mkv", "A.MKV"] {
        assert!(lists(output, name), "{name}");
    }
    assert!(!lists(output, "a.jpg"), "no frame becomes a JPEG");
    for ask in [FileAsk::Open, FileAsk::ImportMesh, FileAsk::LocateMesh] {
        for name in ["a.obj", "A.OBJ", "a.gltf", "A.GLTF", "a.glb", "A.GLB"] {
            assert!(lists(ask, name), "{ask:?}: {name}");
        }
    }
    assert!(filters(FileAsk::Missing).is_empty(), "any file may be the one that is missing");
}
