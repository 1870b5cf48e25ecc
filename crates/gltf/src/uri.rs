//! The URIs in a glTF file: refuses file names that lead elsewhere, and decodes data URIs.

/// What a URI stands for.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The bytes and the media type of a data URI.
    Data(Vec<u8>, String),
    /// A file beside the glTF file or in a folder below: percent-decoded, relative, with `/` between folders.
    File(String),
}

/// What a URI stands for, without opening anything.
///
/// # Errors
/// Names that are empty, absolute, not UTF-8, lead out of the folder, or hold NUL or `\`; other schemes than `data:`; a
/// data URI that is not well-formed. The error says why, as a sentence without its subject.
pub(crate) fn target(uri: &str) -> Result<Target, &'static str> {
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        return data(&uri[5..]);
    }
    if uri.starts_with(':') || has_scheme(uri) {
        return Err("has a scheme: only files beside the glTF file and data URIs are read");
    }
    // `?` and `#` are part of the name here, and begin no query or fragment: exporters write them unescaped.
    let name = String::from_utf8(percent_decoded(uri)?).map_err(|_| "is not UTF-8 when decoded")?;
    check_name(&name)?;
    Ok(Target::File(name))
}

/// Whether a URI or a name begins with something like `https:` or `C:`.
fn has_scheme(uri: &str) -> bool {
    let Some((scheme, _)) = uri.split_once(':') else { return false };
    scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.'))
}

fn check_name(name: &str) -> Result<(), &'static str> {
    if name.is_empty() {
        return Err("is empty");
    }
    if name.contains('\0') {
        return Err("holds a NUL");
    }
    if name.contains('\\') {
        return Err("holds a backslash: folders are separated by / in glTF");
    }
    if name.starts_with('/') || has_scheme(name) {
        return Err("is absolute: only files beside the glTF file are read");
    }
    let mut depth = 0_i64;
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." => depth -= 1,
            _ => depth += 1,
        }
        if depth < 0 {
            return Err("leaves the folder of the glTF file");
        }
    }
    Ok(())
}

fn percent_decoded(text: &str) -> Result<Vec<u8>, &'static str> {
    let mut decoded = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        rest = after;
        if *first != b'%' {
            decoded.push(*first);
            continue;
        }
        match after {
            [high, low, after @ ..] if high.is_ascii_hexdigit() && low.is_ascii_hexdigit() => {
                decoded.push(hex_digit(*high) << 4 | hex_digit(*low));
                rest = after;
            }
            // A lone percent sign in a name: exporters forget to escape it.
            _ => decoded.push(b'%'),
        }
    }
    Ok(decoded)
}

fn hex_digit(digit: u8) -> u8 {
    match digit {
        b'0'..=b'9' => digit - b'0',
        b'a'..=b'f' => digit - b'a' + 10,
        _ => digit - b'A' + 10,
    }
}

fn data(content: &str) -> Result<Target, &'static str> {
    let (header, payload) = content.split_once(',').ok_or("is a data URI without a comma")?;
    let mut parameters = header.split(';');
    let media_type = parameters.next().unwrap_or_default().to_ascii_lowercase();
    let is_base64 = parameters.any(|parameter| parameter.trim().eq_ignore_ascii_case("base64"));
    let bytes = if is_base64 { base64_decoded(payload)? } else { percent_decoded(payload)? };
    Ok(Target::Data(bytes, media_type))
}

/// Standard and URL-safe base64, with or without padding. Escaped characters (`%3D`) and white space are taken too.
fn base64_decoded(text: &str) -> Result<Vec<u8>, &'static str> {
    const TABLE: [u8; 256] = base64_table();
    let escaped;
    let text = if text.contains('%') {
        escaped = percent_decoded(text)?;
        escaped.as_slice()
    } else {
        text.as_bytes()
    };
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let mut held = 0_u32;
    let mut held_bits = 0;
    let mut padding = 0;
    for &character in text {
        let digit = TABLE[character as usize];
        if digit < 64 && padding == 0 {
            held = held << 6 | u32::from(digit);
            held_bits += 6;
            if held_bits >= 8 {
                held_bits -= 8;
                decoded.push((held >> held_bits) as u8);
            }
        } else if character == b'=' && padding < 2 {
            padding += 1;
        } else if !character.is_ascii_whitespace() {
            return Err("is a data URI whose base64 holds a strange character");
        }
    }
    if held_bits == 6 { Err("is a data URI whose base64 is cut short") } else { Ok(decoded) }
}

const fn base64_table() -> [u8; 256] {
    let mut table = [255; 256];
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut index = 0;
    while index < 64 {
        table[digits[index] as usize] = index as u8;
        index += 1;
    }
    table[b'-' as usize] = 62;
    table[b'_' as usize] = 63;
    table
}

#[cfg(test)]
mod tests;
