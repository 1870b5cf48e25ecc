//! Sizes in bytes as people write them.

/// Reads a number of bytes, with or without K, M, G or T (powers of 1024) behind it.
pub(crate) fn size_bytes(text: &str) -> Result<u64, String> {
    let words = || format!("{text:?} is no size: write a number of bytes, or one such as 512M or 4G");
    let text = text.trim();
    let digits = text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
    let unit = text[digits.len()..].to_ascii_uppercase();
    let unit = unit.strip_suffix("IB").or(unit.strip_suffix('B')).unwrap_or(&unit);
    let power = ["", "K", "M", "G", "T"].iter().position(|known| *known == unit).ok_or_else(words)?;
    let number: f64 = digits.trim().parse().map_err(|_| words())?;
    if number.is_finite() && number >= 0.0 {
        Ok((number * 1024f64.powi(power as i32)) as u64)
    } else {
        Err(words())
    }
}
