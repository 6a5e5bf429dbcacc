//! Pictures of what is there while a render goes on, written beside it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use film::Film;
use par::Background;

use crate::{Output, OutputKind, PictureError, PictureInfo};

/// A picture comes at the earliest after so many times what the last one took: all of them take a twentieth of one core
/// at most.
const PAUSE: u32 = 20;

/// Rewrites pictures now and then.
#[derive(Debug)]
pub(crate) struct Previewer {
    work: Arc<Work>,
    every: Duration,
    /// When the next one is due.
    due: Instant,
    pending: Option<(Duration, Background<Written>)>,
    /// That it fails was told.
    told: bool,
}

#[derive(Debug)]
struct Work {
    outputs: Vec<Output>,
    info: PictureInfo,
}

/// What became of a preview.
#[derive(Debug)]
pub(crate) struct Written {
    /// Passes that are in it.
    pub passes: u64,
    pub result: Result<(), PictureError>,
    /// What developing and writing took.
    pub elapsed: Duration,
}

impl Previewer {
    /// Of the outputs that people look at.
    pub(crate) fn new(outputs: &[Output], info: &PictureInfo, every: Duration) -> Self {
        let seen = |output: &&Output| match output.kind() {
            OutputKind::Png => true,
            OutputKind::Exr => false,
        };
        let outputs = outputs.iter().filter(seen).cloned().collect();
        let work = Arc::new(Work { outputs, info: info.clone() });
        Self { work, every, due: Instant::now(), pending: None, told: false }
    }

    /// Whether it is time, and no other is being written.
    pub(crate) fn is_due(&self) -> bool {
        !self.work.outputs.is_empty() && self.pending.is_none() && Instant::now() >= self.due
    }

    /// Begins to write, on a thread of its own; where there is none, nothing is written. `copied`: what the copy of the film
    /// took.
    pub(crate) fn start(&mut self, film: Arc<Film>, copied: Duration) {
        self.due = Instant::now() + self.every;
        let work = self.work.clone();
        self.pending =
            Background::start(move || work.write(&film)).ok().map(|background| (copied, background));
    }

    /// What became of the one that was being written, once that is known.
    pub(crate) fn poll(&mut self) -> Option<Written> {
        self.pending.as_ref().is_some_and(|(_, work)| work.is_done()).then(|| self.wait()).flatten()
    }

    /// The same, waited for.
    pub(crate) fn wait(&mut self) -> Option<Written> {
        let (copied, work) = self.pending.take()?;
        let written = work.wait();
        let pause = (copied + written.elapsed).saturating_mul(PAUSE);
        self.due = self.due.max(Instant::now() + pause);
        Some(written)
    }

    /// Whether a failure is to be told: the first is.
    pub(crate) fn tells(&mut self) -> bool {
        !std::mem::replace(&mut self.told, true)
    }
}

impl Work {
    fn write(&self, film: &Film) -> Written {
        let start = Instant::now();
        let result = self.outputs.iter().try_for_each(|output| output.write(film, &self.info));
        Written { passes: film.passes(), result, elapsed: start.elapsed() }
    }
}
