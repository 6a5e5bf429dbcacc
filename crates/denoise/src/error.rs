use std::fmt;
use std::path::PathBuf;

/// How one comes by the library: one sentence.
pub const HOW_TO_GET: &str = "`pip install pyoidn` brings Open Image Denoise with its weights; or set NEPHROID_OIDN to its \
                              library, or to the folder that it lies in";

/// Why no picture is denoised.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DenoiseError {
    /// The library is nowhere where it is looked for.
    NotFound,
    /// `NEPHROID_OIDN` names a place without the library.
    NotThere(PathBuf),
    /// The file is no library, or one that can't be loaded here: which, and what the system says.
    Unloadable(PathBuf, String),
    /// The library lacks a function: it is another one, or too old.
    Lacks(PathBuf, &'static str),
    /// The library's major version, which is not 2.
    Version(PathBuf, i32),
    /// What the library says went wrong.
    Failed(String),
    /// The picture has no pixel, or a plane has another number of pixels.
    Size,
}

impl DenoiseError {
    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotFound | Self::Lacks(..) | Self::Version(..) => HOW_TO_GET,
            Self::NotThere(_) => {
                "set NEPHROID_OIDN to the library, or to the folder that it lies in, or unset it"
            }
            Self::Unloadable(..) => "set NEPHROID_OIDN to a library of version 2 for this machine",
            Self::Failed(_) => "it may lack memory: denoise later, or a smaller picture",
            Self::Size => "give planes of the picture's size",
        }
    }
}

impl fmt::Display for DenoiseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound => write!(f, "Open Image Denoise is not found"),
            Self::NotThere(path) => {
                write!(f, "Open Image Denoise is not at {}, which NEPHROID_OIDN names", path.display())
            }
            Self::Unloadable(path, why) => {
                write!(f, "cannot load Open Image Denoise from {}: {why}", path.display())
            }
            Self::Lacks(path, name) => {
                write!(f, "{} is not Open Image Denoise 2: it has no function {name}", path.display())
            }
            Self::Version(path, major) => {
                write!(f, "{} is Open Image Denoise {major}; version 2 is needed", path.display())
            }
            Self::Failed(why) => write!(f, "Open Image Denoise failed: {why}"),
            Self::Size => write!(f, "a picture to be denoised has no pixel, or planes of other sizes"),
        }
    }
}

impl std::error::Error for DenoiseError {}
