//! Tests of stroke quads that are cut down to where the mark has paint: the picture is that of whole quads, up to
//! rounding, and fewer pixels are drawn.

use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, Quality};
use impasto_tests::pictures::renderer;
use impasto_tests::scenes;

const PAINT: &str = include_str!("../../crates/gl-render/shaders/rotating_strokes/paint.vert");
const FRAGMENTS: &str = include_str!("../../crates/gl-render/shaders/rotating_strokes/paint.frag");

#[test]
fn cut_quads_look_as_whole_ones_do() {
    const CUT: &str = "if (amount < 0 || coarser > COARSEST)";
    assert!(PAINT.contains(CUT));
    let mut whole_quads = ShaderTexts::default();
    assert!(whole_quads.put("rotating_strokes/paint.vert", PAINT.replace(CUT, "if (true)")));
    let (mut cut, mut whole) = (renderer(Driver::Egl), renderer(Driver::Egl));
    whole.replace_shaders(&whole_quads).unwrap();
    let painting = scenes::painting("roll");
    // A large picture, and one so small that marks are read from coarse mipmap levels.
    for (size_px, quality) in
        [([320, 180], Quality::Exact), ([96, 54], Quality::Exact), ([96, 54], Quality::Draft)]
    {
        let frame = painting.at(0.0, &FrameOptions { quality, ..FrameOptions::new(size_px) });
        let [cut, whole] = [&mut cut, &mut whole].map(|renderer| renderer.render(&frame).unwrap().rgba8);
        let off: Vec<u8> =
            cut.iter().zip(&whole).map(|(a, b)| a.abs_diff(*b)).filter(|&off| off > 0).collect();
        let far_off = off.iter().filter(|&&off| off > 8).count();
        println!("{size_px:?}: {} of {} bytes differ, {far_off} by more than 8", off.len(), cut.len());
        // Interpolation rounds differently in a cut quad, so a few taps of `body_at` (paint.frag) may meet another body
        // and change their pixel a lot. Paint that was cut away would change far more pixels.
        assert!(
            off.len() * 200 < cut.len() && far_off <= 4 + cut.len() / 20_000,
            "{size_px:?}: {}, {far_off}",
            off.len()
        );
    }
}

/// Counts all fragments of the cut quads, even those that lay no paint. They must be fewer than the pixels of whole
/// quads.
#[test]
fn cut_quads_cover_fewer_pixels() {
    const DISCARD: &str = "if (alpha <= 0.0) discard;";
    assert!(FRAGMENTS.contains(DISCARD));
    let mut counted = ShaderTexts::default();
    assert!(counted.put("rotating_strokes/paint.frag", FRAGMENTS.replace(DISCARD, "")));
    let mut renderer = renderer(Driver::Egl);
    renderer.replace_shaders(&counted).unwrap();
    let painting = scenes::painting("roll");
    let frame = painting.at(0.0, &FrameOptions::new([320, 180]));
    let (_, cost) = renderer.render_timed(&frame).unwrap();
    let quads_px: f32 = renderer
        .resolved_strokes()
        .iter()
        .zip(&frame.strokes)
        .filter(|(resolved, _)| resolved.alpha > 0.004)
        .map(|(_, stroke)| stroke.length_px * stroke.width_px / (0.84 * 0.84))
        .sum();
    let covered_px = cost.overdraw * 320.0 * 180.0;
    println!("{covered_px} px of {quads_px}");
    assert!(covered_px > 0.0 && covered_px < 0.8 * f64::from(quads_px), "{covered_px} px of {quads_px}");
}
