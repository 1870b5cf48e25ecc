use super::{Mode, assembled};

#[test]
fn strips_wind_alike_and_drop_their_stitches() {
    let strip = assembled(Mode::Strip, 5, |corner| corner as u32);
    assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    // Two quads joined by repeated corners (the stitches). The winding goes on alternating across the stitches.
    let joined = [0, 1, 2, 3, 3, 4, 4, 5, 6, 7];
    let strip = assembled(Mode::Strip, joined.len(), |corner| joined[corner]);
    assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]]);
}

#[test]
fn fans_go_round_their_first_corner() {
    assert_eq!(assembled(Mode::Fan, 4, |corner| corner as u32 + 7), [[8, 9, 7], [9, 10, 7]]);
}

#[test]
fn too_few_corners_make_no_triangle() {
    for mode in [Mode::Triangles, Mode::Strip, Mode::Fan] {
        assert!(assembled(mode, 2, |corner| corner as u32).is_empty());
        assert!(assembled(mode, 0, |corner| corner as u32).is_empty());
    }
    assert_eq!(assembled(Mode::Triangles, 5, |corner| corner as u32), [[0, 1, 2]]);
}
