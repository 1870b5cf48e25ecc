//! Tests of the pictures of presets: each preset gets a picture of its own, and a new list ends the old one.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::mpsc;
use std::time::Duration;

use impasto_editor_model::Document;
use impasto_editor_model::command::{Command, Regions, StrokeChange, StrokesOf};
use impasto_scene::load::LoadOptions;

use super::*;

/// The apple with each of these presets.
fn apples(presets: &[&str]) -> Vec<Wanted> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let trial = document.trial();
    let with = |preset: &&str| {
        let change = StrokeChange::Preset(Some((*preset).to_owned()));
        let command = Command::Regions(Regions::SetStroke(StrokesOf::Scene, change));
        let trial = trial.clone();
        let scene = Arc::new(move || trial.with(&command, None).ok());
        Wanted { name: (*preset).to_owned(), scene, frame: 0.0 }
    };
    presets.iter().map(with).collect()
}

/// A picture that never comes: making its scene sends to `begun`, and then waits for `may_go_on`.
fn held(begun: mpsc::Sender<()>, may_go_on: mpsc::Receiver<()>) -> Wanted {
    let channels = Mutex::new((begun, may_go_on));
    let scene = Arc::new(move || {
        let (begun, may_go_on) = &*channels.lock().unwrap();
        let _ = begun.send(());
        let _ = may_go_on.recv();
        None
    });
    Wanted { name: "held".to_owned(), scene, frame: 0.0 }
}

#[test]
fn each_preset_gets_a_picture_of_its_own_and_a_new_list_ends_the_old_one() {
    let (woken, wakes) = mpsc::channel();
    let wake = move || {
        let _ = woken.send(());
    };
    let pictures = PresetPictures::start(Driver::Auto, wake).expect("a thread");
    // The old list's first picture is under way when the new list comes. Its second picture must never be begun.
    let [(first, begins), (second, begins_too)] = [mpsc::channel(), mpsc::channel()];
    let [(go_on, may_go_on), (stay, may_stay)] = [mpsc::channel(), mpsc::channel()];
    pictures.want(vec![held(first, may_go_on), held(second, may_stay)], ShaderTexts::default());
    begins.recv_timeout(Duration::from_secs(60)).expect("the first is begun");
    pictures.want(apples(&["gouache", "no such preset", "impressionist"]), ShaderTexts::default());
    drop((go_on, stay));
    let mut seen: BTreeMap<String, ColorImage> = BTreeMap::new();
    while seen.len() < 2 {
        wakes.recv_timeout(Duration::from_secs(120)).expect("a picture");
        seen.extend(pictures.take());
    }
    assert_eq!(seen.keys().collect::<Vec<_>>(), ["gouache", "impressionist"]);
    assert!(begins_too.try_recv().is_err(), "the old list went on");
    let [one, other] = ["gouache", "impressionist"].map(|name| &seen[name]);
    assert_eq!((one.size, other.size), ([288, 162], [288, 162]));
    let apart = one.pixels.iter().zip(&other.pixels).filter(|(a, b)| a.r().abs_diff(b.r()) > 12).count();
    assert!(apart > one.pixels.len() / 20, "{apart} pixels differ");
}

#[test]
fn small_pictures_have_the_shape_of_the_scene() {
    assert_eq!(small_size([1280, 720]), [288, 162]);
    assert_eq!(small_size([720, 1280]), [91, 162]);
    assert_eq!(small_size([4000, 1]), [288, 1]);
}
