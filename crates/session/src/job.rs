use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use film::{Film, FilmError};
use integrators::Settings;
use scene::Scene;
use scenefile::SceneDesc;

use crate::settings;

/// What to render.
#[derive(Clone, Debug)]
pub struct Job {
    /// The compiled scene.
    pub scene: Arc<Scene>,
    /// Integrator, seed and what else decides the value of a pass.
    pub settings: Settings,
    /// Indices of the passes: `0..n` for a whole render, any range for a part of one. A range of
    /// [`Film::MAX_PASSES`] has no end that anybody asked for: a time or an observer ends the render.
    pub passes: Range<u64>,
}

impl Job {
    /// All that a description asks for, of the scene that it was compiled to.
    ///
    /// # Errors
    /// Where the pixel filter is none.
    pub fn new(desc: &SceneDesc, scene: Arc<Scene>) -> Result<Self, SessionError> {
        Ok(Self { scene, settings: settings(desc)?, passes: 0..desc.render.passes.into() })
    }

    /// The same with passes without end.
    pub fn endless(self) -> Self {
        let start = self.passes.start;
        Self { passes: start..start.saturating_add(Film::MAX_PASSES), ..self }
    }
}

/// Whether a range of passes has an end that somebody asked for.
pub(crate) fn has_end(passes: &Range<u64>) -> bool {
    passes.end.saturating_sub(passes.start) < Film::MAX_PASSES
}

/// Why a session cannot run.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionError {
    /// The system starts no more threads; its reason.
    Threads(String),
    /// The job has no pass.
    NoPasses,
    /// There is no memory for the picture; the bytes that it takes.
    Memory(u64),
    /// The film refuses: a filter without extent, too many passes, a film of another size.
    Film(FilmError),
}

impl fmt::Display for SessionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threads(reason) => write!(f, "threads cannot be started: {reason}"),
            Self::NoPasses => write!(f, "there is no pass to render; one at least is needed"),
            Self::Memory(bytes) => {
                write!(
                    f,
                    "there is no memory for the picture: it takes {:.1} GiB",
                    *bytes as f64 / f64::from(1 << 30)
                )
            }
            Self::Film(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for SessionError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Film(error) => Some(error),
            Self::Threads(_) | Self::NoPasses | Self::Memory(_) => None,
        }
    }
}

impl From<FilmError> for SessionError {
    fn from(error: FilmError) -> Self {
        Self::Film(error)
    }
}

/// Memory that the picture of a render takes, in bytes: the film and two passes, one that is rendered and one that is
/// folded. 344 bytes a pixel; filters with negative weights take 120 more, a checkpoint being written 192 more.
pub fn film_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height) * (192 + 2 * 76)
}

/// Memory that layers on request take beside that: 60 bytes a pixel and layer, in the film and in two passes.
pub(crate) fn layer_bytes([width, height]: [u32; 2], layers: usize) -> u64 {
    u64::from(width) * u64::from(height) * layers as u64 * (36 + 2 * 12)
}

/// Asks the system for that many bytes, and gives them back. A system that promises more than it has is believed.
pub(crate) fn check_memory(bytes: u64) -> Result<(), SessionError> {
    let none = SessionError::Memory(bytes);
    let Ok(size) = usize::try_from(bytes) else { return Err(none) };
    Vec::<u8>::new().try_reserve_exact(size).map_err(|_| none)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_nobody_has_is_refused() {
        assert_eq!(film_bytes([1000, 1000]), 344_000_000);
        assert_eq!(check_memory(1 << 20), Ok(()));
        assert_eq!(check_memory(1 << 62), Err(SessionError::Memory(1 << 62)));
    }
}
