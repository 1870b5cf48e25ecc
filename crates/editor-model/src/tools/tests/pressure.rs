//! Tests of what the pressure of a pen does, with each tool that uses it.

use impasto_scene::document::{AmountDab, Touch};

use super::*;
use crate::session::Pressure;

const LINE: [[f64; 2]; 5] = [[290.0, 185.0], [305.0, 183.0], [320.0, 185.0], [335.0, 187.0], [350.0, 185.0]];

fn drawn(tool: Tool, set: impl Fn(&mut ToolOptions), pressures: [f64; 5]) -> World {
    let mut world = World::new();
    set(&mut world.options);
    for (at, pressure) in LINE.into_iter().zip(pressures) {
        world.pressure = pressure;
        match at == LINE[0] {
            true => world.press(tool, at, NONE),
            false => world.drag_to(tool, at, NONE),
        };
    }
    world.release(tool);
    world
}

fn text(world: &World) -> String {
    impasto_scene::save::to_ron(world.document.scene())
}

fn dabs(world: &World) -> &[AmountDab] {
    &world.document.scene().regions[0].amounts[0].dabs
}

fn touch(world: &World) -> &Touch {
    &world.document.scene().touches[0]
}

const ALL: [Tool; 6] = [Tool::Comb, Tool::Smooth, Tool::Amount, Tool::Touch, Tool::Region, Tool::Erase];

#[test]
fn without_a_pen_no_setting_changes_a_byte() {
    for tool in ALL {
        let select = |pressure: Pressure| {
            let mut world = World::new();
            world.select(Item::Region("skin".to_owned()));
            world.options.pressure = pressure;
            world.drag(Tool::Comb, &LINE, NONE);
            world.drag(tool, &LINE, NONE);
            text(&world)
        };
        let plain = select(Pressure::Off);
        assert_eq!(select(Pressure::Radius), plain, "{tool:?}");
        assert_eq!(select(Pressure::Strength), plain, "{tool:?}");
    }
}

#[test]
fn off_ignores_a_pen() {
    for tool in ALL {
        let plain = text(&drawn(tool, |_| (), [1.0; 5]));
        assert_eq!(text(&drawn(tool, |_| (), [0.1, 0.5, 0.9, 0.3, 0.0])), plain, "{tool:?}");
    }
}

#[test]
fn a_comb_takes_the_mean_pressure() {
    let comb = |pressure, pressures| {
        let world = drawn(Tool::Comb, |options| options.pressure = pressure, pressures);
        let guide = &world.guides(0)[0];
        (guide.radius, guide.strength)
    };
    let full = comb(Pressure::Off, [1.0; 5]);
    let half = comb(Pressure::Radius, [0.5; 5]);
    assert!((half.0 / full.0 - 0.5).abs() < 1e-12 && half.1 == full.1, "{half:?} of {full:?}");
    let half = comb(Pressure::Strength, [0.5; 5]);
    assert_eq!(half, (full.0, 0.4));
    // The pressure rises evenly from 0 to 1, so its mean is a half: half of the strength 0.8.
    let rising = comb(Pressure::Strength, [0.0, 0.25, 0.5, 0.75, 1.0]);
    assert!((rising.1 - 0.4).abs() < 0.02, "{rising:?}");
    let least = comb(Pressure::Radius, [0.0; 5]);
    assert!((least.0 / full.0 - 0.05).abs() < 1e-12, "a pen that hardly touches still combs: {least:?}");
}

#[test]
fn each_dab_of_an_amount_has_its_own_pressure() {
    let rising = [0.2, 0.4, 0.6, 0.8, 1.0];
    let world = drawn(Tool::Amount, |options| options.pressure = Pressure::Radius, rising);
    let narrow = dabs(&world);
    assert!(narrow.windows(2).all(|pair| pair[0].radius < pair[1].radius && pair[0].by == pair[1].by));
    assert!((narrow[0].radius / narrow.last().unwrap().radius - 0.2).abs() < 0.05);
    // Each dab lies half of its own radius from the next.
    let apart = |index: usize| {
        DVec3::from(narrow[index].at).distance(DVec3::from(narrow[index + 1].at)) / narrow[index].radius
    };
    for index in 0..narrow.len() - 1 {
        assert!((apart(index) - 0.5).abs() < 0.1, "{}", apart(index));
    }
    let world = drawn(Tool::Amount, |options| options.pressure = Pressure::Strength, rising);
    let strong = dabs(&world);
    assert!(strong.windows(2).all(|pair| pair[0].by < pair[1].by && pair[0].radius == pair[1].radius));
    assert!(strong.len() < narrow.len());
}

#[test]
fn a_touch_is_as_wide_or_as_opaque_as_it_is_pressed() {
    let touched = |pressure, pressures| {
        let world = drawn(Tool::Touch, |options| options.pressure = pressure, pressures);
        let touch = touch(&world);
        (touch.width_px, touch.opacity)
    };
    let full = touched(Pressure::Off, [1.0; 5]);
    assert_eq!(touched(Pressure::Radius, [0.5; 5]), ((full.0 * 5.0).round() / 10.0, full.1));
    assert_eq!(touched(Pressure::Strength, [0.5; 5]), (full.0, full.1 * 0.5));
}

/// The width of a touch, as a share of its width at full pressure. `path` has the X of each place in pixels and the
/// pressure there; `released` is the greatest pressure, as the release reports it.
fn touched_width(steady: f64, path: &[(f64, f64)], released: f64) -> f64 {
    let mut world = World::new();
    (world.options.pressure, world.options.steady) = (Pressure::Radius, steady);
    for (step, &(x, pressure)) in path.iter().enumerate() {
        world.pressure = pressure;
        match step {
            0 => world.press(Tool::Touch, [x, 185.0], NONE),
            _ => world.drag_to(Tool::Touch, [x, 185.0], NONE),
        };
    }
    world.pressure = released;
    world.release(Tool::Touch);
    let soft = touch(&world).width_px;
    let mut world = World::new();
    world.click(Tool::Touch, [320.0, 185.0], NONE);
    soft / touch(&world).width_px
}

#[test]
fn a_pen_that_is_set_down_slowly_presses_as_hard_as_it_got() {
    let steady = World::new().options.steady;
    let width = touched_width(steady, &[(320.0, 0.02), (320.0, 0.3), (320.0, 0.6)], 0.6);
    assert!((width - 0.6).abs() < 0.02, "{width}");
}

#[test]
fn the_ring_shows_what_is_painted() {
    let mut world = World::new();
    world.options.pressure = Pressure::Radius;
    world.pressure = 0.5;
    let wide = |output: &ToolOutput| {
        let ring = output.rings.last().unwrap();
        ring.points_px.iter().map(|at| at.distance(ring.at_px)).fold(0.0, f64::max)
    };
    let before = wide(&world.hover(Tool::Comb, LINE[0]));
    world.press(Tool::Comb, LINE[0], NONE);
    let during = wide(&world.drag_to(Tool::Comb, LINE[1], NONE));
    assert!((during / before - 0.5).abs() < 0.05, "{during} of {before}");
}

#[test]
fn a_press_under_the_string_is_as_hard_as_the_pen_got() {
    // The pointer trembles by less than the length of the string that steadies strokes (24 pixels), so it does not pull
    // the string. The release reports the greatest pressure, even if the pressure rose without a movement.
    let width = touched_width(0.2, &[(320.0, 0.02), (322.0, 0.4), (319.0, 0.3), (323.0, 0.1)], 0.6);
    assert!((width - 0.6).abs() < 0.02, "{width}");
}

#[test]
fn the_release_of_a_drag_makes_it_no_harder() {
    let radius = |released: f64| {
        let mut world = World::new();
        world.options.pressure = Pressure::Radius;
        world.pressure = 0.5;
        world.press(Tool::Comb, LINE[0], NONE);
        for at in &LINE[1..] {
            world.drag_to(Tool::Comb, *at, NONE);
        }
        world.pressure = released;
        world.release(Tool::Comb);
        world.guides(0)[0].radius
    };
    assert_eq!(radius(1.0), radius(0.5));
}
