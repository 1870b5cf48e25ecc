//! Numbers of an OBJ text: to the bit what the standard library makes of them, and most of them sooner.

/// Powers of ten that double precision holds exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// A word as a finite number.
pub(super) fn finite(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse::<f64>().ok().filter(|number| number.is_finite())
}

/// The finite number that begins at `at`, and where it ends: at white space, and not at the end of the text. `None` also
/// where a `\` might join lines.
#[inline]
pub(super) fn next(text: &[u8], at: usize) -> Option<(f64, usize)> {
    if let Some(read) = decimal(text, at) { Some(read) } else { word(text, at) }
}

/// The same for whatever the standard library takes.
#[inline(never)]
fn word(text: &[u8], at: usize) -> Option<(f64, usize)> {
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, 0x0b | b'\\');
    let end = at + text[at..].iter().position(is_end)?;
    if text[end] == b'\\' { None } else { Some((finite(&text[at..end])?, end)) }
}

/// A number without an exponent whose digits and power of ten are both exact in double precision: then one division
/// rounds as it should (Clinger 1990).
#[inline]
fn decimal(text: &[u8], start: usize) -> Option<(f64, usize)> {
    let first = *text.get(start)?;
    let start = start + usize::from(matches!(first, b'-' | b'+'));
    let mut digits = 0u64;
    let (mut at, mut point) = (start, None);
    let last = loop {
        let byte = *text.get(at)?;
        let digit = byte.wrapping_sub(b'0');
        if digit <= 9 {
            digits = digits.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if byte == b'.' && point.is_none() {
            point = Some(at);
        } else {
            break byte;
        }
        at += 1;
    };
    let count = at - start - usize::from(point.is_some());
    let decimals = point.map_or(0, |point| at - point - 1);
    let is_exact = (1..=19).contains(&count) && digits <= 1 << 53;
    if !is_exact || !matches!(last, b' ' | b'\t' | b'\n' | b'\r') {
        return None;
    }
    let size = digits as f64 / POWERS_OF_TEN[decimals];
    Some((if first == b'-' { -size } else { size }, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_what_the_standard_library_reads() {
        let mut words: Vec<String> =
            ["-0", "+.5", "5.", "1e-3", "9007199254740993", "0.1234567890123456789", "-1e400"]
                .map(str::to_owned)
                .to_vec();
        for bits in 0..3000u64 {
            let value = f64::from_bits(bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 2);
            words.extend([
                format!("{value:e}"),
                format!("{:.6}", value % 1e3),
                format!("-{:.17}", value % 10.0),
            ]);
        }
        for word in words {
            let text = format!("{word} ");
            let read = next(text.as_bytes(), 0);
            let expected = word.parse::<f64>().ok().filter(|number| number.is_finite());
            assert_eq!(read.map(|(number, _)| number.to_bits()), expected.map(f64::to_bits), "{word}");
            assert!(read.is_none_or(|(_, end)| end == word.len()), "{word}");
        }
        for word in ["", ".", "-", "1.2.3", "1,5", "nan", "inf", "1\\", "0x1", "--1", "1e"] {
            assert_eq!(next(format!("{word}\n1").as_bytes(), 0), None, "{word}");
        }
        assert_eq!(next(b"12", 0), None);
    }
}
