//! Splits a file into its JSON and its bytes. The file is plain JSON, or a binary `.glb` with a JSON chunk and a chunk
//! of bytes.

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::finding::{Checked, EXPORT_ANEW, Findings, Severity};
use crate::json::Json;

const MAGIC: &[u8] = b"glTF";
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BIN_CHUNK: u32 = 0x004E_4942;

/// The two parts of a file.
pub(crate) struct Container {
    pub json: Bytes,
    /// The bytes of a `.glb`'s second chunk.
    pub bin: Option<Bytes>,
}

/// Splits a file. Every length in a `.glb` is checked against the bytes that are there.
///
/// # Errors
/// An empty file; a `.glb` that is cut short, of another version than 2, without a JSON chunk at its start, or with a
/// JSON or BIN chunk where none may be.
pub(crate) fn split(file: &Bytes, findings: &mut Findings) -> Checked<Container> {
    if file.starts_with(MAGIC) {
        return split_glb(file, findings);
    }
    let nowhere = Cursor::root(&Json::Null);
    if file.starts_with(b"\xEF\xBB\xBF") {
        findings
            .add(nowhere.warning("the text begins with a byte order mark, which glTF forbids", EXPORT_ANEW));
        return Ok(Container { json: file.slice(3, file.len() as u64 - 3).unwrap_or_default(), bin: None });
    }
    if file.is_empty() {
        return Err(nowhere.error("the file is empty"));
    }
    Ok(Container { json: file.clone(), bin: None })
}

fn split_glb(file: &Bytes, findings: &mut Findings) -> Checked<Container> {
    let nowhere = Cursor::root(&Json::Null);
    let cut_short = |what: &str| nowhere.error(format!("the .glb is cut short: {what}"));
    let word = |at: u64| {
        let bytes = file.slice(at, 4)?;
        Some(u32::from_le_bytes(<[u8; 4]>::try_from(&*bytes).ok()?))
    };
    let (Some(version), Some(stated_len)) = (word(4), word(8)) else {
        return Err(cut_short("its header has 12 bytes"));
    };
    if version != 2 {
        let severity = if version == 1 { Severity::Unsupported } else { Severity::Error };
        let message = format!("the .glb is of version {version}, and only version 2 is read");
        return Err(Box::new(nowhere.finding(severity, message, "export as glTF 2.0")));
    }
    let stated_len = u64::from(stated_len);
    if stated_len > file.len() as u64 {
        return Err(cut_short(&format!(
            "its header states {stated_len} bytes, and there are {}",
            file.len()
        )));
    }
    if stated_len < 20 {
        return Err(nowhere
            .error(format!("the .glb's header states {stated_len} bytes in all, which holds no chunk")));
    }
    if stated_len < file.len() as u64 {
        let message = format!("{} bytes after the .glb's end are left out", file.len() as u64 - stated_len);
        findings.add(nowhere.warning(message, ""));
    }
    let mut json = None;
    let mut bin = None;
    let mut at = 12;
    let mut chunk = 0;
    while at < stated_len {
        let header = if at + 8 <= stated_len { word(at).zip(word(at + 4)) } else { None };
        let Some((len, kind)) = header else {
            return Err(cut_short(&format!("chunk {chunk} has no header")));
        };
        let len = u64::from(len);
        let content = file.slice(at + 8, len).filter(|_| at + 8 + len <= stated_len).ok_or_else(|| {
            cut_short(&format!("chunk {chunk} states {len} bytes, and {} are left", stated_len - at - 8))
        })?;
        if len % 4 != 0 {
            findings
                .add(nowhere.warning(format!("the length of chunk {chunk}, {len}, is no multiple of 4"), ""));
        }
        match (kind, chunk) {
            (JSON_CHUNK, 0) => json = Some(content),
            (BIN_CHUNK, 1) => bin = Some(content),
            (_, 0) => return Err(nowhere.error("the .glb's first chunk is not JSON")),
            (JSON_CHUNK | BIN_CHUNK, _) => {
                return Err(nowhere
                    .error(format!("chunk {chunk} of the .glb is a JSON or BIN chunk where none may be")));
            }
            _ => {}
        }
        at += 8 + len;
        chunk += 1;
    }
    match json {
        Some(json) if !json.is_empty() => Ok(Container { json, bin }),
        _ => Err(nowhere.error("the .glb's JSON chunk is empty")),
    }
}
