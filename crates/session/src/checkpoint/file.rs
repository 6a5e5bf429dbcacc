use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use film::Film;

use super::{CheckpointError, CheckpointErrorKind, CheckpointInfo, write_checkpoint};
use crate::output::identity;

/// A checkpoint file that this process alone writes: a file beside it, `.NAME.lock`, is locked until this is dropped.
/// (The checkpoint itself cannot be locked, since each new one replaces it.) File systems without locks are trusted.
#[derive(Debug)]
pub struct CheckpointFile {
    path: PathBuf,
    lock: PathBuf,
    /// Keeps the lock.
    _locked: File,
}

impl CheckpointFile {
    /// For a new render: `path` must not exist.
    ///
    /// # Errors
    /// Where it does, or has the name of another kind of file, or cannot be written, or another process writes it.
    pub fn create(path: &Path) -> Result<Self, CheckpointError> {
        let file = Self::open(path)?;
        if path.symlink_metadata().is_ok() {
            return Err(CheckpointError::new(path, CheckpointErrorKind::Exists));
        }
        Ok(file)
    }

    /// To go on with one.
    ///
    /// # Errors
    /// Where it has the name of another kind of file, cannot be written, or another process writes it.
    pub fn open(path: &Path) -> Result<Self, CheckpointError> {
        let error = |kind| CheckpointError::new(path, kind);
        let other = path.extension().is_some_and(|extension| {
            ["exr", "png", "toml", "obj", "ply", "jpg", "hdr"]
                .iter()
                .any(|e| extension.eq_ignore_ascii_case(e))
        });
        if other {
            return Err(error(CheckpointErrorKind::Name));
        }
        let output = |e| error(CheckpointErrorKind::Output(e));
        film::check_writable(path).map_err(output)?;
        let mut name = OsString::from(".");
        name.push(path.file_name().unwrap_or_default());
        name.push(".lock");
        let lock = path.with_file_name(name);
        let io_error = |e| error(CheckpointErrorKind::Io(e));
        // Another process may remove the file between opening and locking it; a few times, not for ever.
        for _ in 0..100 {
            let locked = File::options().create(true).append(true).open(&lock).map_err(io_error)?;
            match locked.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(error(CheckpointErrorKind::Busy)),
                Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(e)) => return Err(io_error(e)),
            }
            if is_at(&locked, &lock) {
                film::discard_leftovers(path);
                return Ok(Self { path: path.to_owned(), lock, _locked: locked });
            }
        }
        Err(error(CheckpointErrorKind::Busy))
    }

    /// Where.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether this is that file.
    pub fn is(&self, path: &Path) -> bool {
        identity(path) == identity(&self.path)
    }

    /// Replaces the checkpoint, atomically; its size in bytes.
    ///
    /// # Errors
    /// Where it cannot be written; the older one is then still there.
    pub fn write(&self, info: &CheckpointInfo, film: &Film) -> Result<u64, film::OutputError> {
        film::write_atomically_with(&self.path, |out| write_checkpoint(out, info, film))
    }
}

impl Drop for CheckpointFile {
    fn drop(&mut self) {
        // While it is locked, so that no other process's lock is taken away.
        fs::remove_file(&self.lock).ok();
    }
}

/// Whether the open file is still the one of that name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |m: fs::Metadata| (m.dev(), m.ino());
    let there = fs::metadata(path).map(id).ok();
    there.is_some() && there == file.metadata().map(id).ok()
}

/// A file that is open cannot be removed here.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}
