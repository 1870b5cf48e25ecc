//! Fuzzes guides and painted amounts on arbitrary meshes: for any faces and any gestures, all strokes are finite.

#![no_main]

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use impasto_scene::document::{
    Amount, AmountDab, Direction, Falloff, Guide, GuideMode, GuidePoint, GuideView, PaintedAmount, Seam,
};
use impasto_scene::load::{self, LoadOptions};
use libfuzzer_sys::fuzz_target;

const SCENE: &str = include_str!("../scenes/values.ron");

fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| impasto_fuzz::folder("guides"))
}

/// Numbers made from bytes. Once there are no more bytes, zeros.
struct Numbers<'a>(std::slice::Iter<'a, u8>);

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        self.0.next().copied().unwrap_or(0)
    }

    /// A coordinate from -4 to 4 in coarse steps, so that many are equal: points in one place, straight rows, flat
    /// faces.
    fn coordinate(&mut self) -> f64 {
        f64::from(self.byte() as i8) / 32.0
    }

    fn place(&mut self) -> [f64; 3] {
        [self.coordinate(), self.coordinate(), self.coordinate()]
    }

    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }
}

fn mesh(numbers: &mut Numbers<'_>) -> String {
    let mut text = String::new();
    let vertices = 3 + numbers.below(24);
    for _ in 0..vertices {
        let [x, y, z] = numbers.place();
        writeln!(text, "v {x} {y} {z}").expect("a string");
    }
    for _ in 0..1 + numbers.below(24) {
        let [a, b, c] = [0; 3].map(|_| 1 + numbers.below(vertices));
        writeln!(text, "f {a} {b} {c}").expect("a string");
    }
    text
}

fn guide(numbers: &mut Numbers<'_>) -> Guide {
    let kind = numbers.byte();
    let point = |numbers: &mut Numbers<'_>| GuidePoint {
        at: numbers.place(),
        normal: numbers.place(),
        turn_deg: numbers.coordinate() * 90.0,
    };
    Guide {
        object: None,
        view: (kind & 1 > 0).then(|| GuideView {
            eye: numbers.place(),
            target: numbers.place(),
            frame: None,
        }),
        points: (0..2 + numbers.below(4)).map(|_| point(numbers)).collect(),
        radius: numbers.coordinate().abs(),
        strength: numbers.coordinate().abs().min(1.0),
        falloff: Falloff::default(),
        mode: if kind & 2 > 0 { GuideMode::Smooth } else { GuideMode::Comb },
        curve: kind & 4 > 0,
    }
}

fn amount(numbers: &mut Numbers<'_>) -> PaintedAmount {
    let of = Amount::ALL[numbers.below(4)];
    let dab = |numbers: &mut Numbers<'_>| AmountDab {
        at: numbers.place(),
        normal: numbers.place(),
        radius: numbers.coordinate().abs(),
        by: numbers.coordinate().abs(),
    };
    PaintedAmount { of, object: None, dabs: (0..1 + numbers.below(4)).map(|_| dab(numbers)).collect() }
}

fn direction(numbers: &mut Numbers<'_>) -> Direction {
    match numbers.below(6) {
        0 => Direction::Angle(numbers.coordinate() * 90.0),
        1 => Direction::Along(numbers.place()),
        2 => Direction::Around(numbers.place()),
        3 => Direction::Up,
        4 => Direction::Toward(numbers.place()),
        _ => Direction::Auto,
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes.iter());
    std::fs::write(folder().join("a.obj"), mesh(&mut numbers)).expect("written");
    let path = folder().join("scene.ron");
    let mut scene = load::parse(&path, SCENE).expect("the scene of this target");
    scene.regions.truncate(1);
    let region = &mut scene.regions[0];
    region.direction = direction(&mut numbers);
    region.seam = if numbers.byte() & 1 > 0 { Seam::Soft(0.2) } else { Seam::Hard };
    region.guides = (0..1 + numbers.below(4)).map(|_| guide(&mut numbers)).collect();
    region.amounts = (0..numbers.below(3)).map(|_| amount(&mut numbers)).collect();
    impasto_scene::save::write(&path, &scene).expect("written");
    let Ok(loaded) = load::load(&path, &LoadOptions::default()) else { return };
    let Ok(painting) = impasto_painting::prepare(Arc::new(loaded)) else { return };
    impasto_fuzz::assert_finite_strokes(&painting);
});
