//! Checkpoints: a render in a file, to go on with or to add to others.
//!
//! A file is: eight bytes that say what it is, the version of the format (u32, little-endian), then sections
//! ([`film::SectionWriter`]): the text of a [`CheckpointInfo`], and the film.

mod difference;
mod error;
mod file;
mod info;
mod merge;
mod saver;

use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use film::{Film, FilmHead, SectionReader, SectionWriter};

pub use error::{CheckpointError, CheckpointErrorKind};
pub use file::CheckpointFile;
pub use info::{CheckpointInfo, ReadScene, SceneSource};
pub use merge::{MergeError, merge};
pub(crate) use saver::{Attempt, Saver};

/// First bytes of a checkpoint. The last two tell a file that was copied as text.
const MAGIC: [u8; 8] = *b"NEPHRO\r\n";
/// Of the format; any change of it, of what the film holds or of what a pass is gives another.
const FORMAT: u32 = 2;

/// A render as it was when it was saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// What is rendered.
    pub info: CheckpointInfo,
    /// The sums of its passes.
    pub film: Film,
}

impl Checkpoint {
    /// Reads a checkpoint. Memory: the film and a few hundred kilobytes.
    ///
    /// # Errors
    /// Where the file cannot be read, is none, was cut off or damaged, or was written by another version.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let (info, head, mut input) = open(path)?;
        let film = head.read_pixels(&mut input);
        let film = film.and_then(|film| input.finish().map(|()| film));
        Ok(Self { info, film: film.map_err(|e| CheckpointError::sections(path, e))? })
    }

    /// Reads what a checkpoint says of itself; its pixels are neither read nor checked.
    ///
    /// # Errors
    /// As [`read`](Self::read), so far as the beginning of the file tells.
    pub fn read_head(path: &Path) -> Result<(CheckpointInfo, FilmHead), CheckpointError> {
        open(path).map(|(info, head, _)| (info, head))
    }

    /// Whether a file begins like a checkpoint; false where it cannot be read.
    pub fn is_one(path: &Path) -> bool {
        let mut magic = [0; MAGIC.len()];
        File::open(path).and_then(|mut f| f.read_exact(&mut magic)).is_ok() && magic == MAGIC
    }

    /// Writes a checkpoint file, atomically ([`film::write_atomically`]); its size in bytes. Does not look at who else
    /// may write it: [`CheckpointFile`] does.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<u64, film::OutputError> {
        film::write_atomically_with(path, |out| write_checkpoint(out, &self.info, &self.film))
    }
}

/// Writes a checkpoint of a film, as [`Checkpoint::read`] reads it.
///
/// # Errors
/// Where `out` refuses.
pub fn write_checkpoint(out: impl Write, info: &CheckpointInfo, film: &Film) -> io::Result<()> {
    let mut out = out;
    out.write_all(&MAGIC)?;
    out.write_all(&FORMAT.to_le_bytes())?;
    let mut out = SectionWriter::new(out);
    out.write(*b"INFO", info.to_text().as_bytes())?;
    film.write(&mut out)?;
    out.finish().map(drop)
}

/// The beginning of a checkpoint, and a reader for the pixels.
type Opened = (CheckpointInfo, FilmHead, SectionReader<BufReader<File>>);

fn open(path: &Path) -> Result<Opened, CheckpointError> {
    let error = |kind| CheckpointError::new(path, kind);
    let io_error = |e: io::Error| match e.kind() {
        io::ErrorKind::UnexpectedEof => error(CheckpointErrorKind::Other),
        _ => error(CheckpointErrorKind::Io(e)),
    };
    let mut file = BufReader::with_capacity(1 << 20, File::open(path).map_err(io_error)?);
    let mut magic = [0; MAGIC.len()];
    file.read_exact(&mut magic).map_err(io_error)?;
    if magic != MAGIC {
        return Err(error(CheckpointErrorKind::Other));
    }
    let mut format = [0; 4];
    file.read_exact(&mut format).map_err(|e| CheckpointError::sections(path, e.into()))?;
    let format = u32::from_le_bytes(format);
    if format != FORMAT {
        return Err(error(CheckpointErrorKind::Format(format)));
    }
    let mut input = SectionReader::new(file);
    let text = input.read(*b"INFO").map_err(|e| CheckpointError::sections(path, e))?;
    let info = CheckpointInfo::from_text(&text).map_err(&error)?;
    let head = FilmHead::read(&mut input).map_err(|e| CheckpointError::sections(path, e))?;
    if [head.width, head.height] != info.desc.film.size.map(|n| n as usize) {
        return Err(error(CheckpointErrorKind::Content("its film has another size than its scene".into())));
    }
    Ok((info, head, input))
}
