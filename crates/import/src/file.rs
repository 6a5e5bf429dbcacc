//! Files: plain, or compressed and no larger than allowed.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

/// The bytes of an ordinary file; one that begins like gzip is decompressed.
///
/// # Errors
/// Why not, in words that follow the file's name.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let io = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => "is not there".to_owned(),
        _ => format!("cannot be read: {error}"),
    };
    let meta = std::fs::metadata(path).map_err(io)?;
    if !meta.is_file() {
        return Err("is no ordinary file".into());
    }
    let too_large = || format!("makes more than {} MiB", most >> 20);
    if meta.len() > most {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|f| f.take(most + 1).read_to_end(&mut bytes)).map_err(io)?;
    if bytes.starts_with(&[0x1f, 0x8b]) {
        let mut plain = Vec::new();
        MultiGzDecoder::new(&bytes[..])
            .take(most + 1)
            .read_to_end(&mut plain)
            .map_err(|e| format!("cannot be decompressed: {e}"))?;
        bytes = plain;
    }
    if bytes.len() as u64 > most { Err(too_large()) } else { Ok(bytes) }
}

/// The bytes of an ordinary file, as they are.
///
/// # Errors
/// Why not, in words that follow the file's name.
pub(crate) fn read_plain(path: &Path) -> Result<Vec<u8>, String> {
    let io = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => "is not there".to_owned(),
        _ => format!("cannot be read: {error}"),
    };
    if !std::fs::metadata(path).map_err(io)?.is_file() {
        return Err("is no ordinary file".into());
    }
    std::fs::read(path).map_err(io)
}
