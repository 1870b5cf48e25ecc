//! Tests of the painting thread: which pictures come, in which order, and which work it gives up.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, TryRecvError};
use std::time::Instant;

use impasto_gl_render::context::{self, OpenOptions};
use impasto_gl_render::{BillboardIcon, Renderer};
use impasto_painting::frame::Style;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion;

use super::*;

const SIZE_PX: [u32; 2] = [160, 90];

pub(super) fn scene() -> Arc<LoadedScene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/roll.ron");
    Arc::new(load(&path, &LoadOptions::default()).unwrap())
}

pub(super) fn view(loaded: &LoadedScene, frame: f64) -> ViewJob {
    ViewJob {
        camera: motion::camera_at(&loaded.scene, frame),
        frame,
        size_px: SIZE_PX,
        shot_height_px: SIZE_PX[1] as f32,
        shading: Shading::Painted,
        lights: Vec::new(),
        moving: false,
    }
}

/// A worker, and a channel that receives each of its wake-ups.
fn worker() -> (Worker, mpsc::Receiver<()>) {
    let (sender, woken) = mpsc::channel();
    let sender = Mutex::new(sender);
    let wake = move || sender.lock().unwrap().send(()).unwrap_or_default();
    (Worker::new(Driver::Auto, wake).unwrap(), woken)
}

/// Waits for a report for which `last` holds. Returns all reports up to then.
fn until(worker: &(Worker, mpsc::Receiver<()>), last: impl Fn(&Report) -> bool) -> Vec<Report> {
    let mut told = Vec::new();
    let began = Instant::now();
    while !told.iter().any(&last) {
        let left = Duration::from_secs(60).saturating_sub(began.elapsed());
        worker.1.recv_timeout(left).expect("the thread tells in time");
        told.extend(worker.0.poll());
    }
    told
}

fn pictures<'a>(told: &'a [Report]) -> Vec<&'a Picture> {
    let picture =
        |report: &'a Report| if let Report::Picture(picture) = report { Some(picture) } else { None };
    told.iter().filter_map(picture).collect()
}

fn is_exact(report: &Report) -> bool {
    matches!(report, Report::Picture(picture) if picture.exact)
}

fn rendered(loaded: &Arc<LoadedScene>, view: &ViewJob, style: Option<Style>) -> Vec<u8> {
    let mut painting = prepare(Arc::clone(loaded)).unwrap();
    if let Some(style) = style {
        painting = painting.in_style(style);
    }
    let frame = painting.at(view.frame, &FrameOptions::new(view.size_px));
    let context = context::open(Driver::Auto, &OpenOptions::default()).unwrap();
    Renderer::new(context).unwrap().render(&frame).unwrap().rgba8
}

fn bytes(picture: &Picture) -> Vec<u8> {
    picture.image.pixels.iter().flat_map(|pixel| pixel.to_array()).collect()
}

#[test]
fn only_the_latest_job_is_taken_and_earlier_ones_are_stale() {
    let loaded = scene();
    let mailbox = Mailbox::default();
    let job = |serial| Job { loaded: Arc::clone(&loaded), serial, views: Vec::new() };
    mailbox.put(job(1), Later::default());
    let first = mailbox.take(Duration::MAX, || {}).unwrap();
    assert!(mailbox.rests(&first, Duration::ZERO));
    mailbox.put(job(2), Later::default());
    mailbox.put(job(3), Later::default());
    assert!(mailbox.is_stale(&first));
    assert!(!mailbox.rests(&first, Duration::from_secs(20)));
    assert_eq!(mailbox.take(Duration::MAX, || {}).unwrap().job.serial, 3);
    mailbox.close();
    assert!(mailbox.take(Duration::MAX, || {}).is_none());
}

#[test]
fn a_pause_is_told_once_and_the_wait_goes_on() {
    let loaded = scene();
    let mailbox = Mailbox::default();
    let put = || {
        mailbox.put(Job { loaded: Arc::clone(&loaded), serial: 1, views: Vec::new() }, Later::default());
    };
    assert_eq!(mailbox.take(Duration::from_millis(1), put).unwrap().job.serial, 1);
    put();
    assert!(mailbox.take(Duration::ZERO, || unreachable!("a job was there")).is_some());
}

#[test]
fn a_later_job_ends_the_wait_of_the_one_before() {
    let loaded = scene();
    let mailbox = Mailbox::default();
    mailbox.put(Job { loaded: Arc::clone(&loaded), serial: 1, views: Vec::new() }, Later::default());
    let order = mailbox.take(Duration::MAX, || {}).unwrap();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| mailbox.rests(&order, Duration::from_secs(30)));
        mailbox.put(Job { loaded, serial: 2, views: Vec::new() }, Later::default());
        assert!(!waiting.join().unwrap());
    });
}

#[test]
fn at_rest_the_picture_is_the_one_a_file_would_get() {
    let loaded = scene();
    let worker = worker();
    for (shading, style) in [(Shading::Painted, None), (Shading::Shaded, Some(Style::Reference))] {
        let view = ViewJob { shading, ..view(&loaded, 3.0) };
        worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view.clone()] });
        let told = until(&worker, is_exact);
        let prepared = told.iter().filter(|report| matches!(report, Report::Prepared(_, 1))).count();
        assert_eq!(
            prepared,
            usize::from(shading == Shading::Painted),
            "a change of shading prepares nothing"
        );
        let last = *pictures(&told).last().unwrap();
        assert_eq!(last.image.size, [160, 90]);
        assert!(bytes(last) == rendered(&loaded, &view, style), "{shading:?}");
    }
}

#[test]
fn a_new_scene_is_seen_unpainted_before_its_strokes_are_prepared() {
    let loaded = scene();
    let worker = worker();
    let job = |serial| Job { loaded: Arc::clone(&loaded), serial, views: vec![view(&loaded, 3.0)] };
    worker.0.show(job(1));
    let told = until(&worker, |report| matches!(report, Report::Picture(_)));
    assert!(!told.iter().any(|report| matches!(report, Report::Prepared(..))));
    let unpainted = pictures(&told)[0];
    assert!(!unpainted.exact && unpainted.strokes == 0);
    let small = ViewJob { size_px: unpainted.image.size.map(|side| side as u32), ..view(&loaded, 3.0) };
    // Drafts differ a little: their shadows have hard edges.
    let (seen, exact) = (bytes(unpainted), rendered(&loaded, &small, Some(Style::Reference)));
    let differs: usize = seen.iter().zip(&exact).map(|(one, other)| usize::from(one.abs_diff(*other))).sum();
    assert!(differs < 2 * seen.len(), "{differs} over {} bytes", seen.len());
    until(&worker, is_exact);
    // A new version with the same meshes is no new scene: no unpainted picture comes first.
    worker.0.show(job(2));
    let told = until(&worker, is_exact);
    assert!(pictures(&told).iter().all(|picture| picture.strokes > 0));
}

/// A viewport that is taller than the shot shows the shot in its middle. Less than a hundredth of the shot's bytes
/// differ noticeably from those of a file.
#[test]
fn a_taller_picture_holds_the_shot() {
    let loaded = scene();
    let alone = view(&loaded, 3.0);
    let area = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(160.0, 130.0));
    let framing = crate::viewport::Framing::new(area, loaded.scene.size, 1.0);
    let wide = ViewJob {
        camera: framing.widened(&alone.camera),
        size_px: framing.size_px(),
        shot_height_px: framing.shot_height_px(),
        ..alone.clone()
    };
    let worker = worker();
    worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![wide] });
    let told = until(&worker, is_exact);
    let picture = *pictures(&told).last().expect("there is an exact one");
    assert_eq!(picture.image.size, [160, 130]);
    let middle = &bytes(picture)[20 * 160 * 4..110 * 160 * 4];
    let shot = rendered(&loaded, &alone, None);
    // What lies outside the shot adds shade, strokes and light near its border.
    let differ = middle.iter().zip(&shot).filter(|(one, other)| one.abs_diff(**other) > 24).count();
    assert!(differ * 100 < shot.len(), "{differ} of {}", shot.len());
}

#[test]
fn drafts_come_during_a_drag_and_the_last_job_is_shown() {
    let loaded = scene();
    let worker = worker();
    let last_frame = 12.0;
    for frame in 0..=12 {
        let view = ViewJob { moving: true, ..view(&loaded, f64::from(frame)) };
        worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view] });
    }
    let told = until(
        &worker,
        |report| matches!(report, Report::Picture(picture) if picture.view.frame == last_frame && picture.strokes > 0),
    );
    // Jobs that were replaced before the thread took them draw nothing.
    assert!(pictures(&told).len() <= 13);
    let first = *pictures(&told).last().unwrap();
    assert!(!first.exact && first.image.size[0] < 160, "{:?}", first.image.size);
    // The drag ends: the same view again, now exact.
    worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view(&loaded, last_frame)] });
    let told = until(&worker, is_exact);
    assert!(pictures(&told).iter().all(|picture| picture.exact), "the shown draft is drawn again");
}

#[test]
fn a_film_comes_frame_by_frame_with_the_next_computed_ahead() {
    let loaded = scene();
    let worker = worker();
    for frame in 0..12 {
        let views =
            [frame, frame + 1].map(|frame| ViewJob { moving: true, ..view(&loaded, f64::from(frame)) });
        let [now, next] = views;
        let later = Later { ahead: vec![next], film: Vec::new() };
        worker.0.show_before(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![now.clone()] }, later);
        let told = until(
            &worker,
            |report| matches!(report, Report::Picture(picture) if picture.view.frame == now.frame && picture.strokes > 0),
        );
        assert!(pictures(&told).iter().all(|picture| picture.view == now), "frame {frame}");
    }
}

#[test]
fn a_film_is_finished_at_rest_and_then_plays_exactly() {
    let loaded = scene();
    let worker = worker();
    let film: Vec<ViewJob> = [3.0, 4.0, 0.0].map(|frame| view(&loaded, frame)).into();
    let job = |serial, view: &ViewJob| Job { loaded: Arc::clone(&loaded), serial, views: vec![view.clone()] };
    worker.0.show_before(job(1, &film[0]), Later { ahead: Vec::new(), film: film.clone() });
    let is_finished = |report: &Report| matches!(report, Report::Finished(frames, 1) if *frames == [0, 3, 4]);
    let told = until(&worker, is_finished);
    assert!(pictures(&told).iter().all(|picture| picture.view.frame == 3.0), "the film itself is not shown");
    for of_film in [&film[1], &film[2]] {
        let playing = ViewJob { moving: true, ..of_film.clone() };
        worker.0.show(job(1, &playing));
        let told = until(&worker, |report| matches!(report, Report::Picture(_)));
        let played = pictures(&told)[0];
        assert!(played.exact && played.strokes > 50, "{} strokes", played.strokes);
        assert!(bytes(played) == rendered(&loaded, of_film, None));
    }
    // Another view, or another version of the scene, is drawn and not taken from the film.
    let mut aside = ViewJob { moving: true, ..film[1].clone() };
    aside.camera.eye[0] += 0.2;
    let again = ViewJob { moving: true, ..film[2].clone() };
    for (serial, other) in [(1, &aside), (2, &again)] {
        worker.0.show(job(serial, other));
        let is_of_it = |report: &Report| matches!(report, Report::Picture(picture) if picture.strokes > 0);
        let told = until(&worker, is_of_it);
        assert!(pictures(&told).iter().all(|picture| picture.seconds > 0.0), "{serial}: not drawn");
    }
}

#[test]
fn a_picture_that_did_not_change_is_not_drawn_again() {
    let loaded = scene();
    let worker = worker();
    let [left, right] = [0.0, 5.0].map(|frame| view(&loaded, frame));
    let job =
        |right: ViewJob| Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![left.clone(), right] };
    worker.0.show(job(right));
    until(
        &worker,
        |report| matches!(report, Report::Picture(picture) if picture.exact && picture.index == 1),
    );
    worker.0.show(job(view(&loaded, 6.0)));
    let told = until(&worker, is_exact);
    assert!(pictures(&told).iter().all(|picture| picture.index == 1));
}

#[test]
fn what_cannot_be_prepared_is_told_and_the_thread_goes_on() {
    let loaded = scene();
    let mut broken = LoadedScene::clone(&loaded);
    broken.meshes.clear();
    let worker = worker();
    worker.0.show(Job { loaded: Arc::new(broken), serial: 1, views: vec![view(&loaded, 0.0)] });
    let told = until(&worker, |report| matches!(report, Report::Failed(_)));
    assert!(
        told.iter().any(|report| matches!(report, Report::Failed(words) if words.contains("was not read"))),
        "the words say what is missing"
    );
    let vast = ViewJob { size_px: [1 << 20, 8], ..view(&loaded, 0.0) };
    worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 2, views: vec![vast] });
    until(&worker, |report| matches!(report, Report::Failed(words) if words.contains("limit")));
    worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 2, views: vec![view(&loaded, 0.0)] });
    until(&worker, is_exact);
}

#[test]
fn a_panic_is_told_and_the_next_job_is_drawn() {
    let loaded = scene();
    let (sender, woken) = mpsc::channel();
    let sender = Mutex::new(sender);
    let calls = AtomicUsize::new(0);
    let wake = move || {
        // The first call comes while the thread works.
        if calls.fetch_add(1, Ordering::Relaxed) == 0 {
            panic!("planted");
        }
        sender.lock().unwrap().send(()).unwrap_or_default();
    };
    let worker = (Worker::new(Driver::Auto, wake).unwrap(), woken);
    let job = || Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view(&loaded, 0.0)] };
    worker.0.show(job());
    until(&worker, |report| matches!(report, Report::Failed(words) if words.contains("planted")));
    worker.0.show(job());
    until(&worker, is_exact);
}

/// Edits come in bursts, as in a drag. Each changes the seed, the length of strokes, the lights or the camera.
#[test]
fn after_a_thousand_edits_the_last_is_shown_and_few_are_kept() {
    let loaded = scene();
    let worker = worker();
    let (mut edits, mut shown, mut told) = (Vec::new(), 0, Vec::new());
    for serial in 1..=1000u64 {
        let mut edited = LoadedScene::clone(&loaded);
        let random = impasto_core::hash::combine(11, serial as u32);
        match random % 4 {
            0 => edited.scene.seed = random,
            1 => edited.scene.strokes.length_px = Some(f64::from(8 + random % 30)),
            2 => {
                edited.scene.lights.iter_mut().for_each(|light| light.intensity = f64::from(random % 7) / 3.0)
            }
            _ => {
                edited.scene.camera.keys.iter_mut().for_each(|key| key.eye[0] += f64::from(random % 9) / 10.0)
            }
        }
        let edited = Arc::new(edited);
        edits.push(Arc::downgrade(&edited));
        let is_last_of_burst = serial - shown
            >= u64::from(1 + impasto_core::hash::combine(12, shown as u32) % 400)
            || serial == 1000;
        let view = ViewJob { moving: !is_last_of_burst, ..view(&edited, f64::from(random % 20)) };
        worker.0.show(Job { loaded: edited, serial, views: vec![view] });
        if is_last_of_burst {
            shown = serial;
            told = until(&worker, |report| match report {
                Report::Picture(picture) => picture.serial == serial && (picture.exact || serial < 1000),
                _ => false,
            });
        }
    }
    let picture = *pictures(&told).last().unwrap();
    let last = edits.last().unwrap().upgrade().unwrap();
    assert_eq!(bytes(picture), rendered(&last, &view(&last, picture.view.frame), None));
    let kept = edits.iter().filter(|edit| edit.upgrade().is_some()).count();
    assert!(kept <= 3, "{kept} scenes are still kept");
    drop(worker);
    drop(told);
    drop(last);
    assert!(edits.iter().all(|edit| edit.upgrade().is_none()), "a scene outlives the worker");
}

#[test]
fn closing_in_the_midst_of_work_ends_the_thread() {
    let loaded = scene();
    let worker = worker();
    worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view(&loaded, 0.0)] });
    until(&worker, |report| matches!(report, Report::Picture(_)));
    let (worker, woken) = worker;
    drop(worker);
    // The thread owns the sender, so the channel is disconnected only if the thread ended while the worker was dropped.
    let end = loop {
        if let Err(end) = woken.try_recv() {
            break end;
        }
    };
    assert_eq!(end, TryRecvError::Disconnected, "the thread is still at work");
}

#[test]
fn other_shaders_draw_the_same_scene_anew_and_broken_ones_are_told() {
    let loaded = scene();
    let worker = worker();
    let job = || Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view(&loaded, 3.0)] };
    let texts = |text: &str| {
        let mut texts = ShaderTexts::default();
        assert!(texts.put("shared/encode.frag", text.to_owned()));
        assert!(texts.put("rotating_strokes/finish.frag", text.to_owned()));
        texts
    };
    worker.0.show(job());
    let before = bytes(pictures(&until(&worker, is_exact)).last().unwrap());
    worker.0.replace_shaders(texts("broken"));
    worker.0.show(job());
    let told = until(&worker, |report| matches!(report, Report::Failed(_)));
    assert!(pictures(&told).is_empty(), "a picture comes though the shaders are broken");
    worker.0.replace_shaders(ShaderTexts::default());
    worker.0.show(job());
    assert!(bytes(pictures(&until(&worker, is_exact)).last().unwrap()) == before);
}

#[test]
fn other_lights_over_the_same_picture_draw_no_stroke_again() {
    let loaded = scene();
    let worker = worker();
    let bare = view(&loaded, 3.0);
    let lamp = LightBillboard {
        position: glam::DVec3::new(0.0, 0.5, 0.0),
        icon: BillboardIcon::Point,
        size: BillboardSize::Pixels(12.0),
        ink: [1.0; 4],
    };
    let lit = ViewJob { lights: vec![lamp], ..bare.clone() };
    let show = |view: &ViewJob| {
        worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view.clone()] });
        until(&worker, is_exact)
    };
    let first = show(&bare);
    let first = pictures(&first).last().map(|picture| (bytes(picture), picture.strokes)).unwrap();
    let told = show(&lit);
    let [over] = &pictures(&told)[..] else { panic!("one picture, and no draft of it") };
    assert!(over.view == lit && over.strokes == first.1 && bytes(over) != first.0);
    let told = show(&bare);
    let [again] = &pictures(&told)[..] else { panic!("one picture, and no draft of it") };
    assert!(bytes(again) == first.0);
}

/// A level floor of 300 x 300 units before the shot's camera.
fn large_floor() -> Arc<LoadedScene> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "floor.obj",
        "v -150 0 -150\nv 150 0 -150\nv 150 0 150\nv -150 0 150\nvn 0 1 0\nf 4//1 3//1 2//1 1//1\n",
    );
    write(
        "scene.ron",
        r#"(version: 1, size: (320, 180), timeline: (fps: 24, first: 0, last: 0),
            camera: (keys: [(frame: 0, eye: (0, 1.6, 5), target: (0, 0.9, 0))]),
            objects: [(name: "floor", mesh: "floor.obj")])"#,
    );
    Arc::new(load(&folder.path().join("scene.ron"), &LoadOptions::default()).unwrap())
}

#[test]
fn a_free_camera_at_rest_sees_a_large_floor_painted_and_the_shot_stays_as_it_is() {
    let loaded = large_floor();
    let worker = worker();
    let shot = view(&loaded, 0.0);
    let mut away = shot.clone();
    away.camera.eye += glam::DVec3::new(70.0, 0.0, 40.0);
    away.camera.target += glam::DVec3::new(75.0, 0.0, 60.0);
    let shown = |view: &ViewJob, last: &dyn Fn(&Report) -> bool| {
        worker.0.show(Job { loaded: Arc::clone(&loaded), serial: 1, views: vec![view.clone()] });
        let told = until(&worker, last);
        let prepared = told.iter().filter(|report| matches!(report, Report::Prepared(_, 1))).count();
        let last = *pictures(&told).last().unwrap();
        (prepared, last.strokes, bytes(last))
    };
    let (prepared, strokes, picture) = shown(&shot, &is_exact);
    assert_eq!(prepared, 1);
    assert!(picture == rendered(&loaded, &shot, None));
    // A drag does not wait for strokes.
    let moving = ViewJob { moving: true, ..away.clone() };
    let is_picture = |report: &Report| matches!(report, Report::Picture(_));
    assert_eq!(shown(&moving, &is_picture).0, 0);
    let (prepared, there, _) = shown(&away, &is_exact);
    assert!(prepared == 1 && there * 2 > strokes, "{there} strokes, {strokes} in the shot");
    let (prepared, _, again) = shown(&shot, &is_exact);
    assert!(prepared == 1 && again == picture);
}
