//! Tests of brush marks: they differ, fit their rectangles, and their paint is equalised.

use super::*;

#[test]
fn marks_differ_and_end_inside_their_rectangles() {
    let mut all: Vec<Mark> = Vec::new();
    for name in NAMES {
        let marks = marks_of(name).unwrap();
        assert_eq!(marks.len(), VARIANTS as usize);
        for (variant, mark) in marks.iter().enumerate() {
            assert!(!all.contains(mark), "{name} {variant} repeats an earlier mark");
            let border = mark.texels.iter().enumerate().filter(|(index, _)| {
                let (x, y) = (index % SIZE[0], index / SIZE[0]);
                x == 0 || y == 0 || x == SIZE[0] - 1 || y == SIZE[1] - 1
            });
            assert!(border.map(|(_, texel)| texel[0]).max() == Some(0), "{name} {variant} is cut off");
            let inked = mark.texels.iter().filter(|texel| texel[0] > 50).count() as f32;
            let share = inked / mark.texels.len() as f32;
            assert!((0.15..0.75).contains(&share), "{name} {variant} fills {share} of its rectangle");
        }
        all.extend(marks);
    }
    assert!(marks_of("broom").is_none());
}

#[test]
fn paint_is_spread_evenly() {
    for name in NAMES {
        for mark in marks_of(name).unwrap() {
            let paint: Vec<u8> = mark.texels.iter().map(|texel| texel[0]).collect();
            let whole = paint.iter().filter(|&&value| value > 0).count() as f32;
            for share in [0.1f32, 0.5, 0.9] {
                let above =
                    paint.iter().filter(|&&value| f32::from(value) / 255.0 > 1.0 - share).count() as f32;
                assert!((above / whole - share).abs() < 0.01, "{name}: {} for {share}", above / whole);
            }
        }
    }
}

#[test]
fn hairs_run_along_the_stroke() {
    // In the middle of a mark, the height changes less along the stroke than across it.
    for name in ["flat", "filbert", "dry"] {
        let mark = &marks_of(name).unwrap()[0];
        let at = |x: usize, y: usize| f32::from(mark.texels[y * SIZE[0] + x][1]);
        let (mut along, mut across) = (0.0, 0.0);
        for y in 30..66 {
            for x in 60..180 {
                along += (at(x + 3, y) - at(x, y)).abs();
                across += (at(x, y + 3) - at(x, y)).abs();
            }
        }
        assert!(across > 2.0 * along, "{name}: {along} along, {across} across");
    }
}

#[test]
fn a_picture_with_contrast_makes_a_brush() {
    let disc = |inside: [u8; 4], outside: [u8; 4]| -> Vec<[u8; 4]> {
        (0..64 * 32)
            .map(|index| {
                let (x, y) = (index % 64, index / 64);
                let (dx, dy) = ((x as f32 - 32.0) / 28.0, (y as f32 - 16.0) / 13.0);
                if dx * dx + dy * dy < 1.0 { inside } else { outside }
            })
            .collect()
    };
    let (white, black, clear) = ([255; 4], [0, 0, 0, 255], [255, 255, 255, 0]);
    let light = disc(white, black);
    assert!(has_mark([64, 32], &light));
    assert!(!has_mark([64, 32], &[white; 64 * 32]));
    assert!(!has_mark([64, 32], &[clear; 64 * 32]));
    let marks = marks_of_picture([64, 32], &light);
    assert_eq!(marks.len(), VARIANTS as usize);
    let is_disc = |mark: &Mark| {
        let at = |x: usize, y: usize| mark.texels[y * SIZE[0] + x][0];
        at(128, 48) > 0 && at(30, 15) == 0 && at(225, 80) == 0
    };
    assert!(marks.iter().all(is_disc));
    assert!(marks_of_picture([64, 32], &disc(white, clear)).iter().all(is_disc));
    assert!(marks_of_picture([64, 32], &disc(black, white)).iter().all(is_disc), "dark disc not inverted");
    // One texel, and fewer texels than the size claims.
    assert_eq!(marks_of_picture([1, 1], &[white]).len(), VARIANTS as usize);
    assert!(marks_of_picture([64, 32], &light[..10]).is_empty());
}

/// A light bar on a dark picture reaches two of its borders. These alone would pass for a light background, but all
/// four borders decide whether a mark is dark on light.
#[test]
fn a_light_mark_that_reaches_two_borders_of_its_picture_is_no_dark_one() {
    let upright = |x: usize, y: usize| match (x, y) {
        (0 | 7, _) => [0, 0, 0, 255],
        (_, 0 | 63) => [255; 4],
        _ => [230, 230, 230, 255],
    };
    let tall: Vec<[u8; 4]> = (0..8 * 64).map(|index| upright(index % 8, index / 8)).collect();
    let wide: Vec<[u8; 4]> = (0..64 * 8).map(|index| upright(index / 64, index % 64)).collect();
    for (size_px, texels, dark) in [([8, 64], tall, [24, 48]), ([64, 8], wide, [128, 11])] {
        for mark in marks_of_picture(size_px, &texels) {
            let paint = |[column, row]: [usize; 2]| mark.texels[row * SIZE[0] + column][0];
            assert!(paint([128, 48]) > 0 && paint(dark) == 0, "{size_px:?} was inverted");
        }
    }
}

/// For each row of each mark of a brush, if the row has paint: its number, and the columns of its first and last texel
/// with paint.
fn ends_of_rows(name: &str) -> Vec<(usize, [usize; 2])> {
    let rows = |mark: &Mark| -> Vec<(usize, [usize; 2])> {
        let inked = |row: usize| {
            let texels = &mark.texels[row * SIZE[0]..][..SIZE[0]];
            let first = texels.iter().position(|texel| texel[0] > 0)?;
            Some((row, [first, texels.iter().rposition(|texel| texel[0] > 0)?]))
        };
        (0..SIZE[1]).filter_map(inked).collect()
    };
    marks_of(name).unwrap().iter().flat_map(rows).collect()
}

#[test]
fn a_round_brush_sets_down_and_lifts_off_round() {
    // How many columns the paint reaches from the middle of a mark towards this end: the mean over the rows whose
    // distance from the middle row is in `rows`.
    let reach = |name: &str, end: usize, rows: std::ops::Range<usize>| {
        let all = ends_of_rows(name);
        let near = all.iter().filter(|(row, _)| rows.contains(&row.abs_diff(SIZE[1] / 2)));
        let reach: Vec<f64> = near.map(|(_, ends)| ends[end].abs_diff(SIZE[0] / 2) as f64).collect();
        reach.iter().sum::<f64>() / reach.len() as f64
    };
    for end in [0, 1] {
        let [round, knife] = ["round", "knife"].map(|name| reach(name, end, 0..6) - reach(name, end, 28..32));
        assert!(round > 8.0, "end {end} of a round mark is {round} columns longer in its middle");
        assert!(knife.abs() < 4.0, "end {end} of a knife's mark is {knife} columns longer in its middle");
    }
}

/// Paint is pushed aside along the edges.
#[test]
fn paint_is_thicker_beside_its_edges() {
    for name in ["flat", "filbert", "knife"] {
        let (mut beside, mut within) = ((0.0, 0.0), (0.0, 0.0));
        for mark in marks_of(name).unwrap() {
            for column in 60..160 {
                let height = |row: usize| f64::from(mark.texels[row * SIZE[0] + column][1]);
                let Some(edge) = (0..SIZE[1]).find(|&row| mark.texels[row * SIZE[0] + column][0] > 0) else {
                    continue;
                };
                for row in edge + 2..=edge + 4 {
                    beside = (beside.0 + height(row), beside.1 + 1.0);
                }
                for row in edge + 9..=edge + 15 {
                    within = (within.0 + height(row), within.1 + 1.0);
                }
            }
        }
        let times = (beside.0 / beside.1) / (within.0 / within.1);
        assert!(times > 1.1, "{name}: {times} times as thick beside its edge");
    }
}
