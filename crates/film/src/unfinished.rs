//! Files under way: what a program that ends in the middle must not leave behind.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::TempPath;

use crate::OutputError;
use crate::output::folder_of;

/// The temporary files of this process.
struct Register {
    paths: Vec<PathBuf>,
    /// No file is begun or renamed any more.
    closed: bool,
}

static REGISTER: Mutex<Register> = Mutex::new(Register { paths: Vec::new(), closed: false });

fn register() -> MutexGuard<'static, Register> {
    REGISTER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file that [`crate::write_atomically`] has under way, on whatever thread, and lets no other
/// begin: for a program that is about to end. Files that were renamed before are whole; those that would be written
/// later are refused.
pub fn discard_unfinished() {
    let mut register = register();
    register.closed = true;
    for path in register.paths.drain(..) {
        // One that is gone already is no loss.
        fs::remove_file(path).ok();
    }
}

/// Removes what a process left of a file that it was writing when it was killed. Only for who knows that nobody else
/// writes `path` now.
pub fn discard_leftovers(path: &Path) {
    let prefix = prefix(path);
    let leftover = |name: &OsStr| {
        let (name, prefix) = (name.as_encoded_bytes(), prefix.as_encoded_bytes());
        // Between them stand six letters and digits.
        name.len() == prefix.len() + 6 + SUFFIX.len()
            && name.starts_with(prefix)
            && name.ends_with(SUFFIX.as_bytes())
    };
    let Ok(entries) = fs::read_dir(folder_of(path)) else { return };
    for entry in entries.flatten().filter(|entry| leftover(&entry.file_name())) {
        // What cannot be removed does no harm.
        fs::remove_file(entry.path()).ok();
    }
}

const SUFFIX: &str = ".part";

/// What the names of the temporary files for `path` begin with.
fn prefix(path: &Path) -> OsString {
    let mut prefix = OsString::from(".");
    match path.file_name() {
        // Longer ones would leave no room for the rest.
        Some(name) if name.len() <= 200 => prefix.push(name),
        _ => prefix.push("nephroid"),
    }
    prefix.push("-");
    prefix
}

/// The name of a temporary file; the file is removed when this is dropped.
#[derive(Debug)]
pub(crate) struct Unfinished {
    /// Until it is renamed.
    path: Option<TempPath>,
}

impl Unfinished {
    /// A new file in the folder of `path`, which it is to replace.
    pub(crate) fn new(path: &Path) -> Result<(Self, File), OutputError> {
        let prefix = prefix(path);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX);
        #[cfg(unix)]
        {
            // As any new file: readable as the user's mask allows.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        // Held while the file is made, so that it is known from its first moment.
        let mut register = register();
        if register.closed {
            return Err(OutputError::from_io(path, ended()));
        }
        let file = builder.tempfile_in(folder_of(path)).map_err(|e| OutputError::from_io(path, e))?;
        register.paths.push(file.path().to_owned());
        let (file, path) = file.into_parts();
        Ok((Self { path: Some(path) }, file))
    }

    /// Gives it its final name, in place of what has that now.
    pub(crate) fn persist(mut self, path: &Path) -> io::Result<()> {
        let mut register = register();
        if register.closed {
            return Err(ended());
        }
        let Some(temporary) = self.path.take() else { return Ok(()) };
        register.paths.retain(|p| *p != *temporary);
        temporary.persist(path).map_err(|e| e.error)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Some(temporary) = self.path.take() {
            register().paths.retain(|p| *p != *temporary);
        }
    }
}

fn ended() -> io::Error {
    io::Error::new(io::ErrorKind::Interrupted, "the program is ending")
}
