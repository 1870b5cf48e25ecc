//! Reads pictures, without decoding them.

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::finding::{Checked, Findings, Severity};
use crate::material::Image;
use crate::source::Source;
use crate::uri::{self, Target};

const MAX_IMAGE_BYTES: u64 = 256 << 20;

/// Reads `images`; pictures in files of their own are opened only where `is_needed`.
pub(crate) fn images(
    root: &Cursor<'_, '_>,
    source: &mut Source<'_>,
    is_needed: &[bool],
    findings: &mut Findings,
) -> Checked<Vec<Image>> {
    let list = root.list("images")?;
    let mut images = Vec::new();
    for (index, cursor) in list.iter().enumerate() {
        let image = image(&cursor, source, is_needed[index], findings);
        images.extend(findings.take(image));
        if findings.is_full() {
            break;
        }
    }
    Ok(images)
}

fn image(
    cursor: &Cursor<'_, '_>,
    source: &mut Source<'_>,
    is_needed: bool,
    findings: &mut Findings,
) -> Checked<Image> {
    let mut name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
    let mut media_type = cursor.optional_text("mimeType")?.unwrap_or_default().to_owned();
    let view = cursor.optional_index("bufferView", source.views.len(), "buffer view")?;
    let bytes = match (view, cursor.member("uri")) {
        (Some(_), Some(uri)) => return Err(uri.error("the picture has both a name and a buffer view")),
        (None, None) => return Err(cursor.error("the picture has neither a name nor a buffer view")),
        (Some(view), None) => {
            let view = &source.views[view];
            if view.stride.is_some() {
                findings.add(cursor.warning("the picture's buffer view has a stride, which is left out", ""));
            }
            if media_type.is_empty() {
                findings.add(cursor.warning("\"mimeType\" is missing", ""));
            }
            if view.bytes.is_none() {
                findings.add(cursor.warning("the picture's buffer has no data: the picture is left out", ""));
            }
            view.bytes.clone()
        }
        (None, Some(uri)) => {
            let text = uri.text()?;
            let is_data = text.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"));
            if !is_data
                && name.is_empty()
                && let Ok(Target::File(file)) = uri::target(text)
            {
                name = file;
            }
            if is_data || is_needed {
                fetch(source, &uri, &mut media_type, findings)?
            } else {
                uri::target(text).map_err(|why| uri.error(format!("the name of the picture {why}")))?;
                None
            }
        }
    };
    if let Some(bytes) = &bytes {
        match sniffed(bytes) {
            Some(found) => {
                if !media_type.is_empty() && media_type != found {
                    findings
                        .add(cursor.warning(format!("the picture is {found}, and not what it states"), ""));
                }
                media_type = found.to_owned();
                if found == "image/png" && !bytes.ends_with(b"IEND\xAE\x42\x60\x82") {
                    findings.add(cursor.warning("the PNG picture does not end where it should", ""));
                }
            }
            None => {
                findings.add(cursor.warning(
                    "the picture is none of PNG, JPEG and WebP",
                    "export with pictures of these kinds",
                ))
            }
        }
    }
    Ok(Image { name, bytes, media_type })
}

/// Gets the bytes of a picture. If the caller's `open` fails, the picture is left out with a warning. It is an error if
/// the name is refused, or if `open` gives more bytes than it was asked for.
fn fetch(
    source: &mut Source<'_>,
    uri: &Cursor<'_, '_>,
    media_type: &mut String,
    findings: &mut Findings,
) -> Checked<Option<Bytes>> {
    if let Err(why) = uri::target(uri.text()?) {
        return Err(uri.error(format!("the name of the picture {why}")));
    }
    match source.fetch(uri, MAX_IMAGE_BYTES) {
        Ok((bytes, stated)) => {
            if media_type.is_empty() {
                *media_type = stated.unwrap_or_default();
            }
            Ok(Some(bytes))
        }
        Err(finding) if finding.severity == Severity::Limit => Err(finding),
        Err(mut finding) => {
            finding.severity = Severity::Warning;
            findings.add(*finding);
            Ok(None)
        }
    }
}

/// The media type, from the first bytes; `None` for another kind of file.
fn sniffed(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        Some("image/png")
    } else if bytes.starts_with(b"\xFF\xD8\xFF") {
        Some("image/jpeg")
    } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP".as_slice()) {
        Some("image/webp")
    } else {
        None
    }
}
