//! Buffers and their views: where the bytes of a shot are. Each piece of memory is accounted for before it is taken.

use foldhash::{HashMap, HashMapExt};

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::extensions::MESHOPT;
use crate::finding::{Checked, Findings, Severity};
use crate::uri::{self, Target};

/// Gives the bytes of a file beside the glTF file. Its arguments are the file's name (decoded, relative, with `/`
/// between folders) and the most bytes that are wanted. An error is a sentence for the user, without a full stop.
pub type Open<'a> = dyn FnMut(&str, u64) -> Result<Vec<u8>, String> + 'a;

/// The largest file beside the glTF file.
pub const MAX_FILE_BYTES: u64 = 2 << 30;

/// What all files beside the glTF file may hold together.
pub const MAX_TOTAL_BYTES: u64 = 4 << 30;

/// What the shot may take in memory beyond four times the bytes of its files. Four times is what the smallest numbers
/// (8 bits) grow to when they are read as `f32`.
pub const SPARE_BYTES: u64 = 512 << 20;

/// A view into a buffer; it was checked that the view lies inside the buffer.
#[derive(Clone, Debug)]
pub(crate) struct View {
    /// `None` where the file has no data for the buffer, as for the fallback buffer of compressed views.
    pub bytes: Option<Bytes>,
    /// Its length in the file, bytes.
    pub len: u64,
    /// Bytes from one element to the next, if the view states them.
    pub stride: Option<usize>,
    /// Where the view starts in its buffer, for alignment.
    pub offset: u64,
    /// Compressed by meshopt.
    pub is_compressed: bool,
}

/// Where the bytes of a shot come from.
pub(crate) struct Source<'o> {
    open: &'o mut Open<'o>,
    opened: HashMap<String, Bytes>,
    opened_bytes: u64,
    /// Bytes of memory that may still be taken.
    spare_bytes: u64,
    pub views: Vec<View>,
}

impl<'o> Source<'o> {
    /// A source without buffers; `file_bytes` is the length of the glTF file.
    pub fn new(open: &'o mut Open<'o>, file_bytes: u64) -> Self {
        Self {
            open,
            opened: HashMap::new(),
            opened_bytes: 0,
            spare_bytes: SPARE_BYTES + file_bytes.saturating_mul(4),
            views: Vec::new(),
        }
    }

    /// Accounts for memory that is about to be taken.
    ///
    /// # Errors
    /// [`Severity::Limit`]: it is more than is left.
    pub fn take_memory(&mut self, count: u64, bytes_each: usize, cursor: &Cursor<'_, '_>) -> Checked<()> {
        let bytes = count.saturating_mul(bytes_each as u64);
        match self.spare_bytes.checked_sub(bytes) {
            Some(left) => {
                self.spare_bytes = left;
                Ok(())
            }
            None => Err(Box::new(cursor.finding(
                Severity::Limit,
                format!("{count} elements ask for more memory than a file of this size may take"),
                "split the file, or check its accessors",
            ))),
        }
    }

    pub fn give_back_memory(&mut self, count: u64, bytes_each: usize) {
        self.spare_bytes += count * bytes_each as u64;
    }

    /// The bytes of a `uri` member, and the media type of a data URI.
    pub fn fetch(&mut self, uri: &Cursor<'_, '_>, max_bytes: u64) -> Checked<(Bytes, Option<String>)> {
        let text = uri.text()?;
        let shown = || format!("{:?}", text.chars().take(80).collect::<String>());
        match uri::target(text).map_err(|why| uri.error(format!("the name {} {why}", shown())))? {
            Target::Data(bytes, media_type) => {
                self.spare_bytes += bytes.len() as u64 * 4;
                Ok((Bytes::new(bytes), Some(media_type)))
            }
            Target::File(name) => {
                if let Some(bytes) = self.opened.get(&name) {
                    return Ok((bytes.clone(), None));
                }
                let max_bytes = max_bytes.min(MAX_FILE_BYTES).min(MAX_TOTAL_BYTES - self.opened_bytes);
                let bytes = (self.open)(&name, max_bytes).map_err(|why| {
                    let mut finding = uri.error(why);
                    finding.mend = "put the file beside the glTF file, or export as .glb".into();
                    finding
                })?;
                if bytes.len() as u64 > max_bytes {
                    let message = format!("{} is larger than the limit of {max_bytes} bytes", shown());
                    return Err(Box::new(uri.finding(Severity::Limit, message, "make the file smaller")));
                }
                self.opened_bytes += bytes.len() as u64;
                self.spare_bytes += bytes.len() as u64 * 4;
                let bytes = Bytes::new(bytes);
                self.opened.insert(name, bytes.clone());
                Ok((bytes, None))
            }
        }
    }

    /// Reads `buffers` and `bufferViews`.
    pub fn read_views(
        &mut self,
        root: &Cursor<'_, '_>,
        bin: Option<&Bytes>,
        findings: &mut Findings,
    ) -> Checked<()> {
        let mut buffers = Vec::new();
        for (index, cursor) in root.list("buffers")?.iter().enumerate() {
            let bin = if index == 0 { bin } else { None };
            let buffer = self.read_buffer(&cursor, bin, findings);
            buffers.push(findings.take(buffer).flatten());
            if findings.is_full() {
                return Ok(());
            }
        }
        if findings.any_fatal() {
            return Ok(());
        }
        for cursor in root.list("bufferViews")?.iter() {
            let view = read_view(&cursor, &buffers, findings);
            self.views.extend(findings.take(view));
            if findings.is_full() {
                return Ok(());
            }
        }
        Ok(())
    }

    fn read_buffer(
        &mut self,
        cursor: &Cursor<'_, '_>,
        bin: Option<&Bytes>,
        findings: &mut Findings,
    ) -> Checked<Option<Buffer>> {
        let len_cursor = cursor.required("byteLength")?;
        let len = len_cursor.whole()?;
        if len == 0 {
            findings.add(len_cursor.warning("the buffer is empty", ""));
        }
        let bytes = match cursor.member("uri") {
            Some(uri) => {
                let (bytes, media_type) = self.fetch(&uri, MAX_FILE_BYTES)?;
                let is_odd =
                    |kind: &str| !matches!(kind, "application/octet-stream" | "application/gltf-buffer");
                if media_type.as_deref().is_some_and(is_odd) {
                    findings.add(uri.warning("the data URI's media type is not one of a buffer", ""));
                }
                Some(bytes)
            }
            None => bin.cloned(),
        };
        let Some(bytes) = bytes else { return Ok(Some(Buffer { bytes: None, len })) };
        let there = bytes.len() as u64;
        let Some(used) = bytes.slice(0, len) else {
            return Err(len_cursor.error(format!("the buffer states {len} bytes, and there are {there}")));
        };
        if cursor.member("uri").is_none() && there > len + 3 {
            let message = format!(
                "the .glb holds {there} bytes of which the buffer states {len}: the rest is left out"
            );
            findings.add(len_cursor.warning(message, ""));
        }
        Ok(Some(Buffer { bytes: Some(used), len }))
    }
}

struct Buffer {
    bytes: Option<Bytes>,
    len: u64,
}

fn read_view(cursor: &Cursor<'_, '_>, buffers: &[Option<Buffer>], findings: &mut Findings) -> Checked<View> {
    let buffer_cursor = cursor.required("buffer")?;
    let buffer = buffer_cursor.index(buffers.len(), "buffer")?;
    let offset = cursor.whole_or("byteOffset", 0)?;
    let len_cursor = cursor.required("byteLength")?;
    let len = len_cursor.whole()?;
    let stride = match cursor.member("byteStride") {
        None => None,
        Some(stride_cursor) => {
            let stride = stride_cursor.whole()?;
            if !(4..=252).contains(&stride) || stride % 4 != 0 {
                let message = format!("the stride {stride} is not a multiple of 4 from 4 to 252");
                return Err(stride_cursor.error(message));
            }
            if stride > len {
                findings.add(
                    stride_cursor
                        .warning(format!("the stride {stride} is beyond the view's {len} bytes"), ""),
                );
            }
            Some(stride as usize)
        }
    };
    let Some(Some(buffer)) = buffers.get(buffer) else {
        return Err(buffer_cursor.error("the buffer cannot be read"));
    };
    if offset.checked_add(len).is_none_or(|end| end > buffer.len) {
        let message = format!("bytes {offset} to {offset} + {len} are beyond the buffer's {}", buffer.len);
        return Err(len_cursor.error(message));
    }
    if let Some(target) = cursor.member("target")
        && !matches!(target.whole()?, 34962 | 34963)
    {
        findings.add(target.warning("the target is neither 34962 nor 34963", ""));
    }
    let extensions = cursor.object("extensions")?;
    let is_compressed =
        extensions.as_ref().is_some_and(|list| MESHOPT.iter().any(|name| list.member(name).is_some()));
    let bytes = buffer.bytes.as_ref().and_then(|bytes| bytes.slice(offset, len));
    Ok(View { bytes, len, stride, offset, is_compressed })
}
