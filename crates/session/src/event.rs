use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use film::{Film, FilmNonFinite, OutputError};
use integrators::{MapReport, NonFinitePhoton};

use crate::{Phase, PictureError, Remaining, ReplayKey};

/// What a session tells its observer.
#[derive(Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// A phase begins.
    PhaseStarted(Phase),
    /// A phase is over.
    PhaseDone {
        /// Which.
        phase: Phase,
        /// Wall-clock time.
        elapsed: Duration,
    },
    /// New photon maps are ready.
    MapsReady {
        /// Index of the maps.
        map_index: u64,
        /// What each holds.
        reports: &'a [MapReport],
    },
    /// A pass begins; a stop before it is heeded at once.
    PassStarted {
        /// Its index.
        pass: u64,
    },
    /// A pass is in the film. The next one may have begun.
    PassDone {
        /// Its index.
        pass: u64,
        /// Passes that are in the film.
        done: u64,
        /// Passes that will be in it; `None` where they have no end.
        passes: Option<u64>,
        /// Wall-clock time since the session began to run.
        elapsed: Duration,
        /// Wall-clock time until the render ends.
        remaining: Remaining,
        /// The film with this pass in it: a picture may be taken of it.
        film: &'a Film,
    },
    /// A copy of the film, which may be kept ([`crate::Session::with_snapshots`]).
    Snapshot {
        /// The film.
        film: &'a Arc<Film>,
    },
    /// The checkpoint file holds so much now.
    CheckpointWritten {
        /// The file.
        path: &'a Path,
        /// Passes in it.
        passes: u64,
        /// Its size.
        bytes: u64,
        /// Wall-clock time that writing took, beside the render but for the last one.
        elapsed: Duration,
    },
    /// A checkpoint could not be written. The older one is still there, and the render goes on and tries again.
    CheckpointFailed {
        /// Passes that were to be in it.
        passes: u64,
        /// Why.
        error: &'a OutputError,
    },
    /// The pictures show so many passes now ([`crate::Session::with_previews`]).
    PreviewWritten {
        /// Passes in them.
        passes: u64,
        /// What developing and writing took, beside the render.
        elapsed: Duration,
    },
    /// A picture could not be written while passes come; told once. The render goes on, and tries again.
    PreviewFailed {
        /// Why.
        error: &'a PictureError,
    },
    /// Something is not as it should be; the render goes on.
    Warning(Warning),
}

/// The observer's answer to an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop after the pass that runs; each run renders one at least.
    Stop,
}

/// What a session warns of.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Values of a pass that were not finite, or beyond what a film holds; each counts as 0.
    NonFinite {
        /// The first: with the seed, the key to trace its path again.
        first: FilmNonFinite,
        /// Pixels a row.
        width: usize,
        /// How many in this pass.
        count: u64,
    },
    /// Photons whose power or place was not finite; each was dropped.
    NonFinitePhotons {
        /// Index of the maps.
        map_index: u64,
        /// The first: with the seed and the index, the key to trace its path again.
        first: NonFinitePhoton,
        /// How many.
        count: u64,
    },
}

impl Warning {
    /// The path to trace again ([`crate::replay()`]).
    pub fn replay_key(&self) -> ReplayKey {
        match *self {
            Self::NonFinite { first, width, .. } => {
                let (pixel, width) = (first.at.pixel as usize, width.max(1));
                ReplayKey::Pixel { pass: first.pass, x: (pixel % width) as u32, y: (pixel / width) as u32 }
            }
            // Where maps are shared, passes have the index of the first that uses them.
            Self::NonFinitePhotons { map_index, first, .. } => {
                ReplayKey::Photon { pass: map_index, kind: Some(first.kind), path: first.path }
            }
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite { first, width, count } => {
                let pixel = first.at.pixel as usize;
                let (values, are) = if *count == 1 { ("value", "is") } else { ("values", "are") };
                write!(
                    f,
                    "{count} {values} of pass {} {are} not finite and left out; the first: pixel {},{} of layer {}",
                    first.pass,
                    pixel % (*width).max(1),
                    pixel / (*width).max(1),
                    first.at.layer.name()
                )
            }
            Self::NonFinitePhotons { map_index, first, count } => write!(
                f,
                "{count} photon{} not finite and dropped from maps {map_index}; the first: path {} after {} scattering \
                 events",
                if *count == 1 { " is" } else { "s are" },
                first.path,
                first.depth,
            ),
        }
    }
}
