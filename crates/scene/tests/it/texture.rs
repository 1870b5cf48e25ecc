//! Tests of hostile pictures: they are refused for the size they claim, or left out with a warning.

use std::path::Path;

use impasto_scene::problem::Severity;
use impasto_scene::texture;

fn severity(name: &str, bytes: &[u8]) -> Severity {
    texture::decode(Path::new(name), bytes).expect_err("the picture is broken").severity
}

#[test]
fn a_claim_over_the_limit_is_a_limit_and_a_broken_picture_a_warning() {
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
    png.extend_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60, 8, 6, 0, 0, 0]);
    assert_eq!(severity("a.png", &png), Severity::Limit);
    let mut tga = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 32, 8];
    tga.extend_from_slice(&[0; 64]);
    assert_eq!(severity("a.tga", &tga), Severity::Limit);
    for broken in [&b""[..], b"<svg/>", b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff\xe0", b"hello"] {
        assert_eq!(severity("a.png", broken), Severity::Warning);
    }
}
