//! Tests of what the painting thread reports for a job, picture by picture.

use std::cell::RefCell;

use impasto_gl_render::{BillboardIcon, BillboardSize, LightBillboard};
use impasto_scene::loaded::LoadedScene;

use super::*;
use crate::worker::tests::{scene, view};
use crate::worker::{Job, Later};

struct Bench {
    loaded: Arc<LoadedScene>,
    mailbox: Mailbox,
    worker: PaintWorker,
}

impl Bench {
    /// All pictures that are reported for a view, in order.
    fn pictures(&mut self, view: &ViewJob, film: &[ViewJob]) -> Vec<Picture> {
        let job = Job { loaded: Arc::clone(&self.loaded), serial: 1, views: vec![view.clone()] };
        self.mailbox.put(job, Later { ahead: Vec::new(), film: film.to_vec() });
        let order = self.mailbox.take(Duration::MAX, || {}).unwrap();
        let pictures = RefCell::new(Vec::new());
        self.worker.work(&order, &self.mailbox, &|report| {
            if let Report::Picture(picture) = report {
                pictures.borrow_mut().push(picture);
            }
        });
        pictures.into_inner()
    }
}

#[test]
fn icons_of_lights_come_back_over_the_finished_picture_only_when_a_film_stops() {
    let worker = PaintWorker::open(Driver::Auto, &|_| {});
    let mut bench = Bench { loaded: scene(), mailbox: Mailbox::default(), worker };
    let film = [3.0, 4.0].map(|frame| view(&bench.loaded, frame));
    bench.pictures(&film[0], &film);
    // The film plays: its pictures have no icons.
    let playing = ViewJob { moving: true, ..film[1].clone() };
    let played = bench.pictures(&playing, &[]);
    let [played] = &played[..] else { panic!("one picture") };
    assert!(played.exact);
    let lamp = |x: f64| {
        let (position, size) = (glam::DVec3::new(x, 0.5, 0.0), BillboardSize::Pixels(12.0));
        LightBillboard { position, icon: BillboardIcon::Point, size, ink: [1.0; 4] }
    };
    let lit = |x: f64| ViewJob { lights: vec![lamp(x)], ..film[1].clone() };
    // It stops: the same picture stays until the icon is drawn.
    let stopped = bench.pictures(&lit(0.0), &film);
    let [first, last] = &stopped[..] else { panic!("{} pictures", stopped.len()) };
    assert!(!first.exact && first.image == played.image && first.view == lit(0.0));
    assert!(last.exact && last.image != played.image);
    // A click on a light: what is shown has icons, and keeps them.
    let clicked = bench.pictures(&lit(0.3), &film);
    assert!(!clicked.is_empty() && clicked.iter().all(|picture| picture.image != played.image));
}
