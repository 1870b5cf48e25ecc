//! Tests of eases against their closed forms.

use super::*;

const NAMED: [Ease; 6] = [Ease::Step, Ease::Linear, Ease::Smooth, Ease::In, Ease::Out, Ease::Bounce];

fn times() -> impl Iterator<Item = f64> {
    (0..=10_000).map(|step| f64::from(step) / 10_000.0)
}

#[test]
fn every_ease_begins_at_0_and_ends_at_1() {
    let curves = [[[0.0, -2.0], [1.0, 3.0]], [[1.0, 0.0], [0.0, 1.0]], [[0.5, 3.0], [0.5, -2.0]]]
        .map(|[first, second]| Ease::Curve(first, second));
    for ease in NAMED.into_iter().chain(curves) {
        assert_eq!([-1.0, 0.0, 1.0, 2.0].map(|time| ease.share(time)), [0.0, 0.0, 1.0, 1.0], "{ease:?}");
    }
}

#[test]
fn in_and_out_are_parabolas() {
    for time in times() {
        assert!((Ease::In.share(time) - time.powi(2)).abs() < 1e-15);
        assert!((Ease::Out.share(time) - (1.0 - (1.0 - time).powi(2))).abs() < 1e-15);
    }
}

#[test]
fn a_ball_bounces_three_times_ever_lower() {
    let shares: Vec<f64> = times().map(|time| Ease::Bounce.share(time)).collect();
    assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
    assert!(Ease::Bounce.share(1.0 - f64::EPSILON / 2.0) > 1.0 - 1e-15);
    // In elevenths of the time: the ball meets the floor at 4, 8, 10 and 11, and half way between them it is at the top
    // of a bounce.
    for (floor, top, height) in [(4.0, 6.0, 0.25), (8.0, 9.0, 0.0625), (10.0, 10.5, 0.015_625)] {
        assert!((Ease::Bounce.share(floor / 11.0) - 1.0).abs() < 1e-12);
        assert!((Ease::Bounce.share(top / 11.0) - (1.0 - height)).abs() < 1e-12);
    }
    let lows = shares.windows(3).filter(|three| three[1] < three[0] && three[1] <= three[2]).count();
    assert_eq!(lows, 3);
}

#[test]
fn curves_that_are_other_eases_agree_with_them() {
    for (first, second) in [([0.0, 0.0], [1.0, 1.0]), ([0.3, 0.3], [0.3, 0.3]), ([1.0, 1.0], [0.0, 0.0])] {
        for time in times() {
            let share = Ease::Curve(first, second).share(time);
            assert!((share - time).abs() < 1e-9, "{share} at {time}");
        }
    }
    for ease in [Ease::Linear, Ease::Smooth, Ease::In, Ease::Out] {
        let [first, second] = ease.handles();
        for time in times() {
            let share = Ease::Curve(first, second).share(time);
            assert!((share - ease.share(time)).abs() < 1e-12, "{ease:?} at {time}: {share}");
        }
    }
}

/// Points of a curve by its definition, repeated division of its polygon (de Casteljau).
fn divided([first, second]: [[f64; 2]; 2], part: f64) -> [f64; 2] {
    let mut points = vec![[0.0, 0.0], first, second, [1.0, 1.0]];
    while points.len() > 1 {
        let between = |pair: &[[f64; 2]]| [0, 1].map(|at| pair[0][at] + (pair[1][at] - pair[0][at]) * part);
        points = points.windows(2).map(between).collect();
    }
    points[0]
}

#[test]
fn a_curve_is_solved_for_its_time() {
    let handles = [
        [[0.25, 0.1], [0.25, 1.0]],
        [[0.42, 0.0], [0.58, 1.0]],
        [[0.0, -2.0], [1.0, 3.0]],
        [[0.0, 3.0], [0.0, -2.0]],
        [[1.0, 0.5], [1.0, 0.7]],
    ];
    for [first, second] in handles {
        for part in times() {
            let [time, share] = divided([first, second], part);
            let found = Ease::Curve(first, second).share(time);
            // The tolerance is wide because x hardly changes near the ends of some of these curves.
            assert!((found - share).abs() < 1e-6, "{first:?} {second:?}: {found} for {share} at {time}");
        }
    }
    // The steepest curve of all, vertical in its middle: x = 1/2 + 4 (part − 1/2)³.
    let steep = Ease::Curve([1.0, 0.0], [0.0, 1.0]);
    assert!((steep.share(0.5) - 0.5).abs() < 1e-5);
    // `ease` of CSS, as browsers compute it.
    assert!((Ease::USUAL_CURVE.share(0.5) - 0.802_403_387).abs() < 1e-8, "{}", Ease::USUAL_CURVE.share(0.5));
}

#[test]
fn a_curve_that_rises_never_falls() {
    for ends in 0..=20_u32 {
        let [first, second] = [f64::from(ends % 5) / 4.0, f64::from(ends / 5) / 4.0];
        // y rises along the curve. If the share falls, an earlier part of the curve was found for a later time.
        let curve = Ease::Curve([first, 0.4], [second, 0.6]);
        let shares: Vec<f64> = times().map(|time| curve.share(time)).collect();
        assert!(shares.is_sorted(), "{curve:?}");
    }
}

#[test]
fn the_reach_is_that_of_what_is_passed() {
    let curves = [
        [[0.3, -2.0], [0.6, 3.0]],
        [[0.3, 3.0], [0.6, 3.0]],
        [[0.1, 0.2], [0.6, 0.9]],
        [[0.5, -1.0], [0.5, -2.0]],
    ];
    for [first, second] in curves {
        let curve = Ease::Curve(first, second);
        let least = times().map(|time| curve.share(time)).fold(f64::INFINITY, f64::min);
        let most = times().map(|time| curve.share(time)).fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = curve.reach();
        assert!(
            (low - least).abs() < 1e-4 && (high - most).abs() < 1e-4,
            "{curve:?}: {low} {high} {least} {most}"
        );
        assert!(low <= least && high >= most);
    }
    assert_eq!(NAMED.map(Ease::reach), [[0.0, 1.0]; 6]);
}
