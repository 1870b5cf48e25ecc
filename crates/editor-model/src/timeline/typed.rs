//! Reads frames that a person types, as `37` or `1.5 s`.

/// The frame that was typed: its number, as in `37`, or a time from frame 0, as in `1.5 s`. Rounded to a whole frame;
/// `None` for other text.
pub fn typed_frame(text: &str, fps: f64) -> Option<f64> {
    let text = text.trim().replace('\u{2212}', "-").replace(',', ".");
    let (number, frames) = match text.strip_suffix('s') {
        Some(number) => (number, fps),
        None => (text.as_str(), 1.0),
    };
    let frame = number.trim().parse::<f64>().ok()? * frames;
    frame.is_finite().then(|| frame.round())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_seconds() {
        assert_eq!(typed_frame(" 37 ", 24.0), Some(37.0));
        assert_eq!(typed_frame("1.5 s", 24.0), Some(36.0));
        assert_eq!(typed_frame("1,5s", 23.976), Some(36.0));
        assert_eq!(typed_frame("\u{2212}2", 24.0), Some(-2.0));
        for nonsense in ["", "s", "four", "inf", "nan s", "1e400"] {
            assert_eq!(typed_frame(nonsense, 24.0), None, "{nonsense}");
        }
    }
}
