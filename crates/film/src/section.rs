//! Pieces of a binary file, each compressed where that pays, and with a checksum.
//!
//! A section is: tag (4 bytes), bytes stored and bytes meant (u32 each, little-endian; equal where nothing was
//! compressed), the stored bytes (LZ4 block format otherwise), and a CRC-32 (IEEE 802.3) of the section's index, tag,
//! both lengths and the stored bytes. So a flipped bit, a lost or a moved section is noticed.

use std::fmt;
use std::io::{self, Read, Write};

/// Most bytes of a section.
const MOST_BYTES: usize = 1 << 28;

/// Writes sections one after another.
#[derive(Debug)]
pub struct SectionWriter<W> {
    out: W,
    index: u32,
    buffer: Vec<u8>,
}

impl<W: Write> SectionWriter<W> {
    /// Into `out`, which should be buffered.
    pub fn new(out: W) -> Self {
        Self { out, index: 0, buffer: Vec::new() }
    }

    /// Writes a section.
    ///
    /// # Errors
    /// Where `out` refuses, or the section is larger than 256 MiB.
    pub fn write(&mut self, tag: [u8; 4], bytes: &[u8]) -> io::Result<()> {
        if bytes.len() > MOST_BYTES {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, "a part of it is larger than 256 MiB"));
        }
        self.buffer.resize(lz4_flex::block::get_maximum_output_size(bytes.len()), 0);
        let stored = match lz4_flex::block::compress_into(bytes, &mut self.buffer) {
            Ok(n) if n < bytes.len() => &self.buffer[..n],
            _ => bytes,
        };
        let head = head(tag, stored.len(), bytes.len());
        self.out.write_all(&head)?;
        self.out.write_all(stored)?;
        self.out.write_all(&checksum(self.index, &head, stored).to_le_bytes())?;
        self.index += 1;
        Ok(())
    }

    /// The last section, which tells the end from a file that was cut off; gives `out` back, flushed.
    ///
    /// # Errors
    /// Where `out` refuses.
    pub fn finish(mut self) -> io::Result<W> {
        self.write(*b"END ", &[])?;
        self.out.flush()?;
        Ok(self.out)
    }
}

/// Why sections cannot be read.
#[derive(Debug)]
pub enum SectionError {
    /// The file could not be read.
    Io(io::Error),
    /// The file ends too early.
    Truncated,
    /// A checksum is wrong, or what it guards makes no sense; the text says what.
    Damaged(&'static str),
}

impl fmt::Display for SectionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "{error}"),
            Self::Truncated => write!(f, "it ends too early: it was cut off"),
            Self::Damaged(what) => write!(f, "it is damaged: {what}"),
        }
    }
}

impl std::error::Error for SectionError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Truncated | Self::Damaged(_) => None,
        }
    }
}

impl From<io::Error> for SectionError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Truncated,
            _ => Self::Io(error),
        }
    }
}

/// Reads what [`SectionWriter`] wrote.
#[derive(Debug)]
pub struct SectionReader<R> {
    input: R,
    index: u32,
    stored: Vec<u8>,
}

impl<R: Read> SectionReader<R> {
    /// From `input`, which should be buffered.
    pub fn new(input: R) -> Self {
        Self { input, index: 0, stored: Vec::new() }
    }

    /// The next section, which must have that tag.
    ///
    /// # Errors
    /// Where the file cannot be read, ends, or is damaged.
    pub fn read(&mut self, tag: [u8; 4]) -> Result<Vec<u8>, SectionError> {
        let mut head = [0; 12];
        self.input.read_exact(&mut head)?;
        let length = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| head[at + i])) as usize;
        let (stored, meant) = (length(4), length(8));
        let wrong = SectionError::Damaged("a checksum is wrong");
        if stored > meant || meant > MOST_BYTES {
            return Err(wrong);
        }
        self.stored.clear();
        // Grows as bytes come, so that a damaged length takes no memory.
        if (&mut self.input).take(stored as u64).read_to_end(&mut self.stored)? < stored {
            return Err(SectionError::Truncated);
        }
        let mut sum = [0; 4];
        self.input.read_exact(&mut sum)?;
        if u32::from_le_bytes(sum) != checksum(self.index, &head, &self.stored) {
            return Err(wrong);
        }
        if head[..4] != tag {
            return Err(SectionError::Damaged("its parts are not in order"));
        }
        self.index += 1;
        if stored == meant {
            return Ok(self.stored.clone());
        }
        match lz4_flex::block::decompress(&self.stored, meant) {
            Ok(bytes) if bytes.len() == meant => Ok(bytes),
            _ => Err(SectionError::Damaged("a part cannot be decompressed")),
        }
    }

    /// The end: that section and nothing after it.
    ///
    /// # Errors
    /// Where there is none, or more.
    pub fn finish(mut self) -> Result<(), SectionError> {
        self.read(*b"END ")?;
        if self.input.read(&mut [0])? > 0 {
            return Err(SectionError::Damaged("something follows its end"));
        }
        Ok(())
    }
}

fn head(tag: [u8; 4], stored: usize, meant: usize) -> [u8; 12] {
    let mut head = [0; 12];
    head[..4].copy_from_slice(&tag);
    // At most MOST_BYTES.
    head[4..8].copy_from_slice(&(stored as u32).to_le_bytes());
    head[8..].copy_from_slice(&(meant as u32).to_le_bytes());
    head
}

fn checksum(index: u32, head: &[u8; 12], stored: &[u8]) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(&index.to_le_bytes());
    sum.update(head);
    sum.update(stored);
    sum.finalize()
}

/// Numbers of a section, little-endian, read one after another.
#[derive(Debug)]
pub(crate) struct Numbers<'a>(pub(crate) &'a [u8]);

impl Numbers<'_> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], SectionError> {
        let (first, rest) = self.0.split_first_chunk().ok_or(SectionError::Damaged("a part is too short"))?;
        self.0 = rest;
        Ok(*first)
    }

    pub(crate) fn u8(&mut self) -> Result<u8, SectionError> {
        Ok(u8::from_le_bytes(self.bytes()?))
    }

    pub(crate) fn u32(&mut self) -> Result<u32, SectionError> {
        Ok(u32::from_le_bytes(self.bytes()?))
    }

    pub(crate) fn u64(&mut self) -> Result<u64, SectionError> {
        Ok(u64::from_le_bytes(self.bytes()?))
    }

    pub(crate) fn text(&mut self, length: usize) -> Result<String, SectionError> {
        let wrong = SectionError::Damaged("a name is wrong");
        let Some((text, rest)) = self.0.split_at_checked(length) else { return Err(wrong) };
        self.0 = rest;
        String::from_utf8(text.to_owned()).map_err(|_| wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_come_back_and_are_small_where_they_can_be() {
        let noise: Vec<u8> = (0..1000u32).map(|i| (i.wrapping_mul(0x9e37_79b9) >> 13) as u8).collect();
        let mut writer = SectionWriter::new(Vec::new());
        writer.write(*b"even", &[7; 100_000]).unwrap();
        writer.write(*b"none", &[]).unwrap();
        writer.write(*b"nois", &noise).unwrap();
        let bytes = writer.finish().unwrap();
        assert!(bytes.len() < 2000, "{}", bytes.len());
        let mut reader = SectionReader::new(&bytes[..]);
        assert_eq!(reader.read(*b"even").unwrap(), [7; 100_000]);
        assert_eq!(reader.read(*b"none").unwrap(), []);
        assert_eq!(reader.read(*b"nois").unwrap(), noise);
        reader.finish().unwrap();
        let mut reader = SectionReader::new(&bytes[..]);
        assert!(matches!(reader.read(*b"odd "), Err(SectionError::Damaged(_))));
    }

    #[test]
    fn sections_cannot_change_places() {
        let write = |texts: [&[u8]; 2]| {
            let mut writer = SectionWriter::new(Vec::new());
            texts.iter().for_each(|t| writer.write(*b"text", t).unwrap());
            writer.finish().unwrap()
        };
        let bytes = write([b"a", b"b"]);
        let size = 12 + 1 + 4;
        let swapped = [&bytes[size..2 * size], &bytes[..size], &bytes[2 * size..]].concat();
        assert!(matches!(SectionReader::new(&swapped[..]).read(*b"text"), Err(SectionError::Damaged(_))));
    }
}
