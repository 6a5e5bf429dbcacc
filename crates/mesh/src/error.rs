use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file a fault lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The whole file or mesh.
    Whole,
    /// A line, counted from 1.
    Line(u64),
    /// A byte offset, counted from 0.
    Byte(u64),
}

/// Why a mesh was refused: where, what is wrong or was expected, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    /// The file, where one was read.
    pub path: Option<PathBuf>,
    /// Where in the file.
    pub place: Place,
    /// What is wrong, and what was expected instead.
    pub message: String,
    /// What the user can do.
    pub help: String,
}

impl MeshError {
    pub(crate) fn new(place: Place, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { path: None, place, message: message.into(), help: help.into() }
    }

    pub(crate) fn whole(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::new(Place::Whole, message, help)
    }

    /// The same error, naming the file.
    pub fn in_file(self, path: &Path) -> Self {
        Self { path: Some(path.to_owned()), ..self }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(path) = &self.path {
            write!(f, "{}: ", path.display())?;
        }
        match self.place {
            Place::Whole => {}
            Place::Line(line) => write!(f, "line {line}: ")?,
            Place::Byte(byte) => write!(f, "byte {byte}: ")?,
        }
        write!(f, "{} ({})", self.message, self.help)
    }
}

impl std::error::Error for MeshError {}
