use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::unfinished::Unfinished;

/// Why a file could not be written, with its path.
#[derive(Debug)]
pub struct OutputError {
    path: PathBuf,
    kind: OutputErrorKind,
}

/// The reasons of an [`OutputError`].
#[derive(Debug)]
pub enum OutputErrorKind {
    /// The path is a folder or ends without a file name.
    IsFolder,
    /// The path is a device, a pipe or the like, which a rename would replace.
    NotAFile,
    /// The folder that should hold the file is not there.
    MissingFolder(PathBuf),
    /// The folder takes no new files, as those of the system's own.
    ClosedFolder(PathBuf),
    /// The folder, or a file in it that would be replaced, may not be written.
    PermissionDenied,
    /// No space is left.
    DiskFull,
    /// A limit of the system on the size of files is reached.
    TooLarge,
    /// The picture can't be expressed in the format; the text says why.
    Encoding(String),
    /// Another error of the system.
    Io(io::Error),
}

impl OutputError {
    pub(crate) fn new(path: &Path, kind: OutputErrorKind) -> Self {
        Self { path: path.to_owned(), kind }
    }

    pub(crate) fn from_io(path: &Path, error: io::Error) -> Self {
        let kind = match error.kind() {
            io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
                OutputErrorKind::PermissionDenied
            }
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => OutputErrorKind::DiskFull,
            io::ErrorKind::FileTooLarge => OutputErrorKind::TooLarge,
            io::ErrorKind::IsADirectory => OutputErrorKind::IsFolder,
            io::ErrorKind::NotFound if folder_of(path).is_dir() => {
                OutputErrorKind::ClosedFolder(folder_of(path).to_owned())
            }
            io::ErrorKind::NotFound => OutputErrorKind::MissingFolder(folder_of(path).to_owned()),
            _ => OutputErrorKind::Io(error),
        };
        Self::new(path, kind)
    }

    /// The file that was to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The reason.
    pub fn kind(&self) -> &OutputErrorKind {
        &self.kind
    }

    /// What to do about it.
    pub fn help(&self) -> String {
        match &self.kind {
            OutputErrorKind::IsFolder => "give the name of a file, such as out.exr, in that folder".into(),
            OutputErrorKind::NotAFile => "give the name of an ordinary file".into(),
            OutputErrorKind::MissingFolder(folder) => {
                format!("create the folder {} first, or write elsewhere", folder.display())
            }
            OutputErrorKind::ClosedFolder(_) => "write to an ordinary folder".into(),
            OutputErrorKind::PermissionDenied => {
                "change the permissions of the file or its folder, or write elsewhere".into()
            }
            OutputErrorKind::DiskFull => "free some space, or write to another disk".into(),
            OutputErrorKind::TooLarge => {
                "raise the limit (ulimit -f), or write to a file system that takes larger files".into()
            }
            OutputErrorKind::Encoding(_) => "write another format or a smaller picture".into(),
            OutputErrorKind::Io(_) => "check the disk, or write elsewhere".into(),
        }
    }
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write {}: ", self.path.display())?;
        match &self.kind {
            OutputErrorKind::IsFolder => write!(f, "it is a folder"),
            OutputErrorKind::NotAFile => write!(f, "it is not an ordinary file"),
            OutputErrorKind::MissingFolder(folder) => {
                write!(f, "the folder {} does not exist", folder.display())
            }
            OutputErrorKind::ClosedFolder(folder) => {
                write!(f, "the folder {} takes no new files", folder.display())
            }
            OutputErrorKind::PermissionDenied => write!(f, "permission denied"),
            OutputErrorKind::DiskFull => write!(f, "no space is left on the disk"),
            OutputErrorKind::TooLarge => write!(f, "the system takes no file of that size"),
            OutputErrorKind::Encoding(why) => write!(f, "{why}"),
            OutputErrorKind::Io(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            OutputErrorKind::Io(error) => Some(error),
            _ => None,
        }
    }
}

/// Whether [`write_atomically`] could write `path` now; leaves nothing behind.
///
/// # Errors
/// The reason why not. A file that exists and is marked read-only counts as protected.
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    check_place(path)?;
    Unfinished::new(path).map(drop)
}

/// Writes a file so that `path` holds either what it held before or all of `bytes`: into a temporary file of the same
/// folder, which is synchronised and renamed. On an error the temporary file is removed.
///
/// # Errors
/// As [`check_writable`], and where writing fails on the way.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_atomically_with(path, |out| out.write_all(bytes)).map(drop)
}

/// [`write_atomically`] of what `content` writes, piece by piece; the size of the file in bytes.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_atomically_with(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<u64, OutputError> {
    check_place(path)?;
    let (unfinished, file) = Unfinished::new(path)?;
    let io_error = |e| OutputError::from_io(path, e);
    let mut out = BufWriter::with_capacity(1 << 20, &file);
    content(&mut out).and_then(|()| out.flush()).map_err(io_error)?;
    drop(out);
    file.sync_all().map_err(io_error)?;
    let size = file.metadata().map_err(io_error)?.len();
    unfinished.persist(path).map_err(io_error)?;
    // The rename itself reaches the disk with the folder; not every system lets a folder be opened for that.
    if let Ok(folder) = File::open(folder_of(path)) {
        folder.sync_all().ok();
    }
    Ok(size)
}

fn check_place(path: &Path) -> Result<(), OutputError> {
    let refuse = |kind| Err(OutputError::new(path, kind));
    if path.file_name().is_none() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return refuse(OutputErrorKind::IsFolder);
    }
    let folder = folder_of(path);
    match fs::metadata(folder) {
        Ok(m) if m.is_dir() => {}
        Ok(_) => return refuse(OutputErrorKind::MissingFolder(folder.to_owned())),
        Err(e) => return Err(OutputError::from_io(path, e)),
    }
    match fs::metadata(path) {
        Ok(m) if m.is_dir() => refuse(OutputErrorKind::IsFolder),
        Ok(m) if !m.is_file() => refuse(OutputErrorKind::NotAFile),
        Ok(m) if m.permissions().readonly() => refuse(OutputErrorKind::PermissionDenied),
        _ => Ok(()),
    }
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn replaces_whole_files_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        check_writable(&path).unwrap();
        assert!(entries(folder.path()).is_empty());
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two!").unwrap();
        check_writable(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two!");
        assert_eq!(entries(folder.path()), ["a.exr"]);
    }

    #[test]
    fn refusals_name_the_reason() {
        let folder = tempfile::tempdir().unwrap();
        let kind = |path: &Path| {
            let error = check_writable(path).unwrap_err();
            assert!(error.to_string().contains(&path.display().to_string()) && !error.help().is_empty());
            let written = write_atomically(path, b"x").unwrap_err();
            assert_eq!(written.to_string(), error.to_string());
            error.kind
        };
        assert!(matches!(kind(folder.path()), OutputErrorKind::IsFolder));
        assert!(matches!(kind(&folder.path().join("x.exr/")), OutputErrorKind::IsFolder));
        assert!(matches!(kind(&folder.path().join("no/x.exr")), OutputErrorKind::MissingFolder(_)));
        let file = folder.path().join("file");
        fs::write(&file, "keep").unwrap();
        assert!(matches!(kind(&file.join("x.exr")), OutputErrorKind::MissingFolder(_)));
        let mut permissions = fs::metadata(&file).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).unwrap();
        assert!(matches!(kind(&file), OutputErrorKind::PermissionDenied));
        assert_eq!(fs::read(&file).unwrap(), b"keep");
        assert_eq!(entries(folder.path()), ["file"]);
        #[cfg(unix)]
        assert!(matches!(kind(Path::new("/dev/null")), OutputErrorKind::NotAFile));
    }

    #[test]
    fn errors_of_the_system_are_told_apart() {
        let kind = |e: io::ErrorKind| OutputError::from_io(Path::new("a/b"), e.into()).kind;
        assert!(matches!(kind(io::ErrorKind::StorageFull), OutputErrorKind::DiskFull));
        assert!(matches!(kind(io::ErrorKind::PermissionDenied), OutputErrorKind::PermissionDenied));
        assert!(matches!(kind(io::ErrorKind::TimedOut), OutputErrorKind::Io(_)));
    }
}
