//! Where a file's bytes are: the chunks of GLB, buffers in other files or in the text, views of them.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use scenefile::Span;

use super::fault::{Fault, Known};
use super::json::Value;
use crate::file::read_plain;

/// A file of either kind: text, and the binary part that goes with it.
#[derive(Debug)]
pub(super) struct Container {
    pub text: String,
    bytes: Vec<u8>,
    binary: Option<Range<usize>>,
}

/// Takes a file apart (glTF 2.0 §4.4).
///
/// # Errors
/// Why not, in words that follow the file's name.
pub(super) fn open(bytes: Vec<u8>) -> Result<Container, String> {
    if !bytes.starts_with(b"glTF") {
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(e) => {
                return Err(format!(
                    "is neither JSON nor binary glTF: byte {} is no UTF-8",
                    e.utf8_error().valid_up_to()
                ));
            }
        };
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        return Ok(Container { text, bytes: Vec::new(), binary: None });
    }
    let word = |at: usize| {
        bytes
            .get(at..at + 4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .ok_or("is cut off in its header")
    };
    let version = word(4)?;
    if version != 2 {
        return Err(format!("is binary glTF of version {version}; version 2 can be read"));
    }
    let length = word(8)? as usize;
    if length > bytes.len() {
        return Err(format!("is cut off: it has {} of its {length} bytes", bytes.len()));
    }
    let (mut text, mut binary) = (None, None);
    let mut at = 12;
    while at + 8 <= length {
        let (size, kind) = (word(at)? as usize, word(at + 4)?);
        let range = at + 8..at + 8 + size;
        if range.end > length {
            return Err(format!("has a chunk at byte {at} that reaches beyond its end"));
        }
        match kind {
            0x4e4f_534a if text.is_none() => text = Some(range.clone()),
            0x004e_4942 if binary.is_none() => binary = Some(range.clone()),
            // Others are for extensions.
            _ => {}
        }
        at = range.end.next_multiple_of(4);
    }
    let text = text.ok_or("has no JSON chunk")?;
    let text = std::str::from_utf8(&bytes[text]).map_err(|_| "has a JSON chunk that is no UTF-8")?.to_owned();
    Ok(Container { text, bytes, binary })
}

/// A file of the scene's folder that a URI names.
///
/// # Errors
/// Other hosts, absolute paths and ways out of the folder.
pub(super) fn local_path(uri: &str, span: Span) -> Known<PathBuf> {
    let refused = |why: &str| {
        let shown: String = uri.chars().take(60).flat_map(char::escape_default).collect();
        Err(Fault::new("file", format!("`{shown}` is not read: {why}"), span))
    };
    // RFC 3986, 3.1: a scheme is followed by a colon.
    let scheme = uri.split(['/', '?', '#']).next().and_then(|first| first.split_once(':'));
    if scheme.is_some() {
        return refused("only files beside the scene are");
    }
    let Some(plain) = unescaped(uri) else { return refused("it is no UTF-8 text") };
    if plain.is_empty() || plain.contains('\0') {
        return refused("it names no file");
    }
    let path = PathBuf::from(plain.replace('\\', "/"));
    if path.components().any(|part| !matches!(part, Component::Normal(_) | Component::CurDir)) {
        return refused("it leads out of the scene's folder");
    }
    Ok(path)
}

/// Undoes %XX (RFC 3986, 2.1); `None` where that gives no text.
fn unescaped(uri: &str) -> Option<String> {
    let mut out = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).filter(|d| first == b'%' && d.iter().all(u8::is_ascii_hexdigit));
        let code = digits.and_then(|d| u8::from_str_radix(std::str::from_utf8(d).ok()?, 16).ok());
        out.push(code.unwrap_or(first));
        rest = if code.is_some() { &behind[2..] } else { behind };
    }
    String::from_utf8(out).ok()
}

/// What a data URI (RFC 2397) holds, with its media type; `None`: it is none.
pub(super) fn data_uri(uri: &str, span: Span) -> Option<Known<(&str, Vec<u8>)>> {
    let rest = uri.strip_prefix("data:")?;
    let Some((head, data)) = rest.split_once(',') else {
        return Some(Err(Fault::new("file", "a data URI without a comma", span)));
    };
    let Some(kind) = head.strip_suffix(";base64") else {
        return Some(Err(Fault::new("file", "a data URI that is not base64", span)));
    };
    let decoded = base64(data.as_bytes())
        .ok_or_else(|| Fault::new("file", "the data URI holds what is no base64", span));
    Some(decoded.map(|bytes| (kind.split(';').next().unwrap_or(kind), bytes)))
}

/// Base64 (RFC 4648, §4 and §5), padded or not.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let text = text.trim_ascii_end();
    let digits = text.strip_suffix(b"==").or(text.strip_suffix(b"=")).unwrap_or(text);
    if digits.len() % 4 == 1 {
        return None;
    }
    let mut out = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for four in digits.chunks(4) {
        let mut bits = 0u32;
        for &c in four {
            let value = match c {
                b'A'..=b'Z' => c - b'A',
                b'a'..=b'z' => c - b'a' + 26,
                b'0'..=b'9' => c - b'0' + 52,
                b'+' | b'-' => 62,
                b'/' | b'_' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        bits <<= 6 * (4 - four.len());
        out.extend_from_slice(&bits.to_be_bytes()[1..four.len()]);
    }
    Some(out)
}

/// The bytes of every buffer.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// What was read or decoded.
    stores: Vec<Vec<u8>>,
    /// For each buffer, its store and its length.
    buffers: Vec<Known<(usize, usize)>>,
    /// The store that is the container's own file, and where the binary chunk is in it.
    binary: Option<Range<usize>>,
}

impl Buffers {
    /// Reads every buffer of a file, each outer file once.
    pub(super) fn read(root: &Value<'_>, container: &mut Container, base: &Path) -> Known<Self> {
        let mut this = Self {
            stores: vec![std::mem::take(&mut container.bytes)],
            buffers: Vec::new(),
            binary: container.binary.take(),
        };
        let mut known: HashMap<PathBuf, usize> = HashMap::new();
        for (i, buffer) in root.array("buffers")?.iter().enumerate() {
            let read = this.buffer(i, buffer, base, &mut known);
            this.buffers.push(read);
        }
        Ok(this)
    }

    /// All bytes that are held.
    pub(super) fn size(&self) -> usize {
        self.stores.iter().map(Vec::len).sum()
    }

    fn buffer(
        &mut self,
        index: usize,
        buffer: &Value<'_>,
        base: &Path,
        known: &mut HashMap<PathBuf, usize>,
    ) -> Known<(usize, usize)> {
        let span = buffer.span();
        let length = buffer.whole("byteLength")?.unwrap_or(0) as usize;
        let store = match buffer.text("uri")? {
            None if buffer.extension("EXT_meshopt_compression").is_some() => {
                return Err(Fault::new("unsupported", "buffers compressed by meshopt are not read", span));
            }
            None => {
                let binary = self.binary.as_ref().filter(|_| index == 0);
                let have = binary.map(|range| range.len());
                return match have {
                    Some(have) if have >= length => Ok((0, length)),
                    Some(have) => Err(short(have, length, span)),
                    None => Err(Fault::new("file", format!("buffer {index} has no data"), span)),
                };
            }
            Some(uri) => {
                let at = buffer.get("uri").map_or(span, Value::span);
                match data_uri(uri, at) {
                    Some(decoded) => {
                        self.stores.push(decoded?.1);
                        self.stores.len() - 1
                    }
                    None => {
                        let path = local_path(uri, at)?;
                        match known.get(&path) {
                            Some(&store) => store,
                            None => {
                                let bytes = read_plain(&base.join(&path)).map_err(|why| {
                                    Fault::new(
                                        "missing-file",
                                        format!("the buffer `{}` {why}", path.display()),
                                        at,
                                    )
                                })?;
                                self.stores.push(bytes);
                                known.insert(path, self.stores.len() - 1);
                                self.stores.len() - 1
                            }
                        }
                    }
                }
            }
        };
        let have = self.stores[store].len();
        if have < length { Err(short(have, length, span)) } else { Ok((store, length)) }
    }

    /// The bytes of a buffer.
    fn bytes(&self, index: usize) -> Known<&[u8]> {
        let (store, length) = self.buffers[index].clone()?;
        let start = match &self.binary {
            Some(range) if store == 0 => range.start,
            _ => 0,
        };
        Ok(&self.stores[store][start..start + length])
    }

    /// The bytes of a view and the stride between its items, if it says one.
    pub(super) fn view(&self, root: &Value<'_>, view: &Value<'_>) -> Known<(&[u8], Option<usize>)> {
        if view.extension("EXT_meshopt_compression").or(view.extension("KHR_meshopt_compression")).is_some() {
            let text = "a bufferView compressed by meshopt is not read";
            return Err(Fault::new("unsupported", text, view.span()));
        }
        let (index, _) = view
            .pick("buffer", "buffer", root.array("buffers")?)?
            .ok_or_else(|| Fault::new("missing-key", "a bufferView without `buffer`", view.span()))?;
        let bytes = self.bytes(index)?;
        let start = view.whole("byteOffset")?.unwrap_or(0) as usize;
        let length = view.whole("byteLength")?.unwrap_or(0) as usize;
        let stride = view.whole("byteStride")?.map(|s| s as usize);
        let range = start.checked_add(length).map(|end| start..end).and_then(|range| bytes.get(range));
        let range = range.ok_or_else(|| {
            let text =
                format!("bytes {start}..{start}+{length} are beyond the {} of buffer {index}", bytes.len());
            Fault::new("out-of-range", text, view.span())
        })?;
        Ok((range, stride))
    }
}

fn short(have: usize, length: usize, span: Span) -> Fault {
    Fault::new("file", format!("the buffer is cut off: it has {have} of its {length} bytes"), span)
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::FileId;

    const NOWHERE: Span = Span { file: FileId(0), start: 0, end: 0 };

    #[test]
    fn base64_of_rfc_4648() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
        ];
        for (plain, coded) in pairs {
            assert_eq!(base64(coded.as_bytes()).unwrap(), plain.as_bytes());
            assert_eq!(base64(coded.trim_end_matches('=').as_bytes()).unwrap(), plain.as_bytes());
        }
        for wrong in ["Z", "Zg=a", "Z!==", "Zm9vY"] {
            assert!(base64(wrong.as_bytes()).is_none(), "{wrong}");
        }
    }

    #[test]
    fn files_beside_the_scene_alone() {
        assert_eq!(local_path("a%20b/c.bin", NOWHERE).unwrap(), Path::new("a b/c.bin"));
        assert_eq!(local_path("./100%.bin", NOWHERE).unwrap(), Path::new("./100%.bin"));
        for uri in [
            "../x",
            "a/../../x",
            "/etc/passwd",
            "http://x/y",
            "file:///x",
            "%2e%2e/x",
            "..\\x",
            "",
            "C:\\x",
            "a\0",
            "%2Fetc",
        ] {
            assert!(local_path(uri, NOWHERE).is_err(), "{uri}");
        }
    }
}
