use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use film::SectionError;

use super::FORMAT;
use super::info::PROGRAM;

/// Why a checkpoint cannot be used, with its path.
#[derive(Debug)]
pub struct CheckpointError {
    path: PathBuf,
    kind: CheckpointErrorKind,
}

/// The reasons of a [`CheckpointError`].
#[derive(Debug)]
#[non_exhaustive]
pub enum CheckpointErrorKind {
    /// The file could not be read.
    Io(io::Error),
    /// It is no checkpoint.
    Other,
    /// It has a version of the format that this program does not know.
    Format(u32),
    /// Another version of the program wrote it; its name.
    Program(String),
    /// It was cut off or damaged.
    Sections(SectionError),
    /// Its content makes no sense; the text says why.
    Content(String),
    /// A new render would replace it.
    Exists,
    /// Its name is that of another kind of file.
    Name,
    /// Another process writes it.
    Busy,
    /// The file cannot be written.
    Output(film::OutputError),
    /// Files that the scene reads are gone or were changed: each with the reason.
    Files(Vec<(PathBuf, String)>),
    /// The passes cannot be gone on with; the text says why.
    Passes(String),
    /// The scene does not compile any more; every reason.
    Scene(crate::CompileError),
    /// It cannot be rendered here.
    Session(crate::SessionError),
}

impl CheckpointError {
    /// Of the file at `path`.
    pub fn new(path: &Path, kind: CheckpointErrorKind) -> Self {
        Self { path: path.to_owned(), kind }
    }

    pub(crate) fn sections(path: &Path, error: SectionError) -> Self {
        let kind = match error {
            SectionError::Io(error) => CheckpointErrorKind::Io(error),
            other => CheckpointErrorKind::Sections(other),
        };
        Self::new(path, kind)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The reason.
    pub fn kind(&self) -> &CheckpointErrorKind {
        &self.kind
    }

    /// What to do about it, where anything can be done.
    pub fn help(&self) -> Option<String> {
        let path = self.path.display();
        match &self.kind {
            CheckpointErrorKind::Exists => Some(format!(
                "go on with it by `nephroid resume {path}`, give another name, or remove it first"
            )),
            CheckpointErrorKind::Name => Some("end the name of a checkpoint in .neph".into()),
            CheckpointErrorKind::Busy => Some("wait for that render, or give another name".into()),
            CheckpointErrorKind::Output(error) => Some(error.help()),
            CheckpointErrorKind::Program(_) | CheckpointErrorKind::Format(_) => {
                Some("use the program that wrote it: passes of two versions need not fit together".into())
            }
            CheckpointErrorKind::Sections(_) => Some("use a copy of it, or render again".into()),
            CheckpointErrorKind::Files(_) => {
                Some("put back the files that it was begun with, or render again".into())
            }
            _ => None,
        }
    }
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match &self.kind {
            CheckpointErrorKind::Io(error) => write!(f, "cannot read {path}: {error}"),
            CheckpointErrorKind::Other => write!(f, "cannot read {path}: it is no checkpoint"),
            CheckpointErrorKind::Format(found) => write!(
                f,
                "cannot read {path}: it is of format {found}, and this program knows format {FORMAT}"
            ),
            CheckpointErrorKind::Program(found) => {
                write!(f, "cannot use {path}: {found} wrote it, and this is {PROGRAM}")
            }
            CheckpointErrorKind::Sections(error) => write!(f, "cannot read {path}: {error}"),
            CheckpointErrorKind::Content(why) => write!(f, "cannot read {path}: {why}"),
            CheckpointErrorKind::Exists => {
                write!(f, "cannot begin a checkpoint at {path}: there is such a file already")
            }
            CheckpointErrorKind::Name => {
                write!(f, "cannot write a checkpoint to {path}: that is the name of another kind of file")
            }
            CheckpointErrorKind::Busy => write!(f, "cannot write {path}: another render writes it"),
            CheckpointErrorKind::Output(error) => write!(f, "{error}"),
            CheckpointErrorKind::Files(files) => {
                write!(f, "cannot go on with {path}: what its scene reads is not what it was")?;
                files.iter().try_for_each(|(file, why)| write!(f, "\n  {}: {why}", file.display()))
            }
            CheckpointErrorKind::Passes(why) => write!(f, "cannot go on with {path}: {why}"),
            CheckpointErrorKind::Scene(error) => write!(f, "cannot go on with {path}: {error}"),
            CheckpointErrorKind::Session(error) => write!(f, "cannot go on with {path}: {error}"),
        }
    }
}

impl std::error::Error for CheckpointError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            CheckpointErrorKind::Io(error) => Some(error),
            CheckpointErrorKind::Sections(error) => Some(error),
            CheckpointErrorKind::Output(error) => Some(error),
            CheckpointErrorKind::Scene(error) => Some(error),
            CheckpointErrorKind::Session(error) => Some(error),
            _ => None,
        }
    }
}
