//! Values that change over time: lights, the background, strokes.

use std::borrow::Cow;

use glam::{DQuat, DVec3};
use impasto_core::color::{linear_from_srgb, srgb_from_linear};

use super::span::Span;
use crate::document::{Color, Ease, Light, LightKey, ResolvedStrokes, Scene, StrokesKey};
use crate::limits::{self, MAX_COVERAGE, MAX_STROKE_PX};

/// The background at a frame.
pub fn background_at(scene: &Scene, frame: f64) -> Color {
    let keys = &scene.background_keys;
    Span::at(keys, frame)
        .map_or(scene.background, |span| mixed(&span, keys[span.left].color, keys[span.right].color))
}

/// The lights of a scene at a frame, as [`light_at`] gives each. The shot is evaluated once.
pub fn lights_at(scene: &Scene, frame: f64) -> Vec<Light> {
    let of_shot = scene.stage.shot.as_ref().map(|shot| (shot, shot.at(frame / scene.timeline.fps)));
    let at_frame = |light: &Light| match &of_shot {
        Some((shot, posed)) if light.keys.is_empty() => shot.light(light, posed),
        _ => keyed(light, frame),
    };
    scene.lights.iter().map(at_frame).collect()
}

/// A light of a scene at a frame: the light with its values at that moment and without keys. A light that comes from
/// the shot and has no keys in the scene takes its values from the shot.
pub fn light_at(scene: &Scene, light: &Light, frame: f64) -> Light {
    match scene.stage.shot.as_ref().filter(|_| light.keys.is_empty()) {
        Some(shot) => shot.light(light, &shot.at(frame / scene.timeline.fps)),
        None => keyed(light, frame),
    }
}

/// A light with the values that its keys give at a frame.
fn keyed(light: &Light, frame: f64) -> Light {
    let Some(span) = Span::at(&light.keys, frame) else { return light.clone() };
    let still = Light { keys: Vec::new(), ..light.clone() };
    let stated = Stated { keys: &light.keys, span: &span };
    Light {
        intensity: stated.mixed(
            light.intensity,
            |key| key.intensity,
            |a, b| span.mix_within(a, b, 0.0..=limits::MAX_INTENSITY),
        ),
        color: stated.mixed(light.color, |key| key.color, |a, b| mixed(&span, a, b)),
        ground: stated.mixed_if_any(light.ground, |key| key.ground, |a, b| mixed(&span, a, b)),
        direction: stated.mixed_if_any(light.direction, |key| key.direction, |a, b| turned(&span, a, b)),
        position: stated.mixed_if_any(
            light.position,
            |key| key.position,
            |a, b| span.mix_vec3(a, b).to_array(),
        ),
        ..still
    }
}

/// Interpolates keys of strokes at a frame. The result is a key at that frame.
pub fn stroke_key_at(keys: &[StrokesKey], frame: f64) -> StrokesKey {
    let Some(span) = Span::at(keys, frame) else { return StrokesKey::at(frame) };
    let (left, right) = (&keys[span.left], &keys[span.right]);
    StrokesKey {
        frame,
        size: span.mix_within(left.size, right.size, limits::KEY_STROKE_SIZE),
        coverage: span.mix_within(left.coverage, right.coverage, limits::KEY_COVERAGE),
        dryness: span.mix_within(left.dryness, right.dryness, 0.0..=1.0),
        palette_mix: span.mix_within(left.palette_mix, right.palette_mix, 0.0..=1.0),
        ease: left.ease,
    }
}

impl ResolvedStrokes {
    /// The strokes at a frame, as their keys change them.
    pub fn at(&self, frame: f64) -> Cow<'_, Self> {
        if self.keys.is_empty() {
            return Cow::Borrowed(self);
        }
        let key = stroke_key_at(&self.keys, frame);
        let [size, coverage, dryness] = [key.size, key.coverage, key.dryness].map(|value| value as f32);
        let mut strokes = self.clone();
        for layer in &mut strokes.layers {
            for side_px in [&mut layer.length_px, &mut layer.width_px] {
                *side_px = (*side_px * size).min(MAX_STROKE_PX as f32);
            }
            layer.coverage = (layer.coverage * coverage).min(MAX_COVERAGE as f32);
            layer.dryness += (1.0 - layer.dryness) * dryness;
        }
        strokes.palette_mix = key.palette_mix as f32;
        Cow::Owned(strokes)
    }

    /// Frames that show how the strokes change: each key, and three frames between two keys, or more where the ease may
    /// overshoot. Without keys, frame 0 alone.
    pub fn moments(&self) -> Vec<f64> {
        let Some(last) = self.keys.last() else { return vec![0.0] };
        let between = self.keys.windows(2).flat_map(|pair| {
            let between = if matches!(pair[0].ease, Ease::Curve(..)) { 32 } else { 4 };
            (0..between).map(move |step| {
                pair[0].frame + (pair[1].frame - pair[0].frame) * f64::from(step) / f64::from(between)
            })
        });
        between.chain([last.frame]).collect()
    }
}

/// The keys of a light, and where a frame lies between them.
struct Stated<'a> {
    keys: &'a [LightKey],
    span: &'a Span,
}

impl Stated<'_> {
    /// A value at this frame. `own` is the light's own value, which holds until a key states one.
    fn mixed<T: Copy>(&self, own: T, of: fn(&LightKey) -> Option<T>, mix: impl Fn(T, T) -> T) -> T {
        let at = |index: usize| self.keys[..=index].iter().rev().find_map(of).unwrap_or(own);
        mix(at(self.span.left), at(self.span.right))
    }

    /// As [`Stated::mixed`], for a value that the light itself may leave out. If it does, the first value that a key
    /// states holds from the start.
    fn mixed_if_any<T: Copy>(
        &self,
        own: Option<T>,
        of: fn(&LightKey) -> Option<T>,
        mix: impl Fn(T, T) -> T,
    ) -> Option<T> {
        let own = own.or_else(|| self.keys.iter().find_map(of))?;
        Some(self.mixed(own, of, mix))
    }
}

/// A colour between two, mixed in linear light.
fn mixed(span: &Span, Color(left): Color, Color(right): Color) -> Color {
    if span.share == 0.0 || left == right {
        return Color(left);
    }
    let linear = |channel: f32| f64::from(linear_from_srgb(channel));
    Color(std::array::from_fn(|channel| {
        srgb_from_linear(span.mix_within(linear(left[channel]), linear(right[channel]), 0.0..=1.0) as f32)
    }))
}

/// A direction between two, along the shorter arc, or along any arc if they are opposite. Their lengths do not matter.
fn turned(span: &Span, left: [f64; 3], right: [f64; 3]) -> [f64; 3] {
    let [from, to] = [left, right].map(|direction| DVec3::from(direction).normalize_or(DVec3::NEG_Y));
    if span.share == 0.0 || left == right {
        return left;
    }
    let turn = DQuat::IDENTITY.slerp(DQuat::from_rotation_arc(from, to), span.share);
    (turn * from).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{BackgroundKey, LightKind};
    use crate::{new_scene, presets};

    fn sun(keys: Vec<LightKey>) -> Light {
        Light { direction: Some([1.0, 0.0, 0.0]), intensity: 2.0, keys, ..Light::new("sun", LightKind::Sun) }
    }

    #[test]
    fn a_key_states_what_it_states_and_the_rest_stays() {
        let light = sun(vec![
            LightKey { direction: Some([0.0, -1.0, 0.0]), ..LightKey::at(10.0) },
            LightKey { intensity: Some(6.0), ease: Ease::Step, ..LightKey::at(20.0) },
            LightKey { intensity: Some(1.0), ..LightKey::at(30.0) },
        ]);
        assert_eq!(light_at(&new_scene::empty(), &light, 0.0).intensity, 2.0);
        // Before the first key, the light has that key's values.
        assert_eq!(light_at(&new_scene::empty(), &light, 0.0).direction, Some([0.0, -1.0, 0.0]));
        assert_eq!(light_at(&new_scene::empty(), &light, 15.0).intensity, 4.0);
        assert_eq!(light_at(&new_scene::empty(), &light, 29.9).intensity, 6.0);
        assert_eq!(light_at(&new_scene::empty(), &light, 99.0).intensity, 1.0);
        assert!(light_at(&new_scene::empty(), &light, 15.0).keys.is_empty());
    }

    #[test]
    fn a_sun_turns_evenly_and_colours_mix_as_light() {
        let red = Color([1.0, 0.0, 0.0]);
        let light = sun(vec![
            LightKey { direction: Some([3.0, 0.0, 0.0]), color: Some(red), ..LightKey::at(0.0) },
            LightKey { direction: Some([0.0, -0.5, 0.0]), color: Some(Color([0.0; 3])), ..LightKey::at(3.0) },
        ]);
        let at = light_at(&new_scene::empty(), &light, 1.0);
        let direction = DVec3::from(at.direction.unwrap_or_default());
        let turned_deg = direction.angle_between(DVec3::X).to_degrees();
        assert!((turned_deg - 30.0).abs() < 1e-9 && direction.y < 0.0, "{direction}");
        assert!((linear_from_srgb(at.color.0[0]) - 2.0 / 3.0).abs() < 1e-6);
        assert_eq!(light_at(&new_scene::empty(), &light, 3.0).color, Color([0.0; 3]));
        // Opposite directions give no NaN.
        let [a, b] = [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        let span = Span { left: 0, right: 1, share: 0.5 };
        assert!(DVec3::from(turned(&span, a, b)).is_normalized());
    }

    #[test]
    fn strokes_and_background_follow_their_keys() {
        let mut scene = new_scene::empty();
        let before = presets::resolve(&scene, None);
        assert_eq!(*before.at(7.0), before);
        scene.strokes.keys = vec![
            StrokesKey::at(0.0),
            StrokesKey { size: 0.5, coverage: 2.0, dryness: 0.5, palette_mix: 0.0, ..StrokesKey::at(10.0) },
        ];
        let strokes = presets::resolve(&scene, None);
        let half = strokes.at(5.0);
        assert_eq!(half.body().length_px, 0.75 * before.body().length_px);
        assert_eq!(half.body().coverage, 1.5 * before.body().coverage);
        assert_eq!(half.palette_mix, 0.5);
        let dry = strokes.at(10.0).body().dryness;
        assert!((dry - (0.5 + 0.5 * before.body().dryness)).abs() < 1e-6, "{dry}");
        assert_eq!(strokes.moments(), [0.0, 2.5, 5.0, 7.5, 10.0]);
        // An ease that overshoots asks for more strokes between the keys than at either of them. The moments come near
        // that peak.
        scene.strokes.keys[0].ease = Ease::Curve([0.1, 3.0], [0.4, 3.0]);
        let swung = presets::resolve(&scene, None);
        let coverage_at = |frame: f64| swung.at(frame).body().coverage;
        let peak = (0..=1000).map(|step| coverage_at(f64::from(step) / 100.0)).fold(0.0, f32::max);
        let met = swung.moments().into_iter().map(coverage_at).fold(0.0, f32::max);
        assert!(peak > 1.2 * coverage_at(10.0) && met > 0.99 * peak, "{met} of {peak}");
        scene.background_keys = vec![BackgroundKey { frame: 4.0, color: Color::white(), ease: Ease::Linear }];
        assert_eq!(background_at(&scene, 0.0), Color::white());
    }
}
