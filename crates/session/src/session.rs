use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use film::{Film, FilmError};
use integrators::{Integrator, Maps};
use par::Workers;
use scene::Scene;
use scenefile::Diagnostic;

use crate::blank::blank;
use crate::checkpoint::{CheckpointFile, CheckpointInfo, Saver};
use crate::grain::Goal;
use crate::job::{check_memory, has_end, layer_bytes};
use crate::pace::Pace;
use crate::preview::Previewer;
use crate::ranges::{count, missing};
use crate::run::{Fold, Run};
use crate::{Control, Event, Job, Output, PictureInfo, SessionError, Timings, film_bytes};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All passes are in the film.
    Finished,
    /// The grain is as fine as was asked for.
    FineEnough,
    /// The time is up; [`Session::run`] goes on where it stopped.
    TimeUp,
    /// The observer stopped it; [`Session::run`] goes on where it stopped.
    Stopped,
}

/// A job in progress. The film depends on the job alone: not on threads, nor on where runs stopped.
pub struct Session {
    scene: Arc<Scene>,
    integrator: Box<dyn Integrator>,
    workers: Workers,
    passes: Range<u64>,
    time: Option<Duration>,
    grain: Option<f64>,
    maps: Option<(u64, Maps)>,
    film: Film,
    timings: Timings,
    saver: Option<Saver>,
    /// Passes of the film that the checkpoint file holds already.
    saved: Option<u64>,
    snapshots: Option<Duration>,
    previewer: Option<Previewer>,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session")
            .field("integrator", &self.integrator.name())
            .field("threads", &self.workers.threads())
            .field("passes", &self.passes)
            .field("done", &self.done())
            .finish_non_exhaustive()
    }
}

impl Session {
    /// A session of `job` on `threads` threads (0: one for each core).
    ///
    /// # Errors
    /// Where the job has no pass, or more than a film holds, or there is no memory or thread.
    pub fn new(job: Job, threads: usize) -> Result<Self, SessionError> {
        // What an integrator finds out about the scene at first, it finds on this many threads.
        let workers = Workers::new(threads).map_err(SessionError::Threads)?;
        let integrator = workers.run(|| integrators::integrator(&job.settings, &job.scene));
        let layers = integrators::layer_names(&job.settings, &job.scene);
        Self::on_workers(job.scene, integrator, job.passes, workers, layers)
    }

    #[cfg(test)]
    pub(crate) fn with_integrator(
        scene: Arc<Scene>,
        integrator: Box<dyn Integrator>,
        passes: Range<u64>,
        threads: usize,
    ) -> Result<Self, SessionError> {
        let workers = Workers::new(threads).map_err(SessionError::Threads)?;
        Self::on_workers(scene, integrator, passes, workers, Vec::new())
    }

    fn on_workers(
        scene: Arc<Scene>,
        integrator: Box<dyn Integrator>,
        passes: Range<u64>,
        workers: Workers,
        layers: Vec<String>,
    ) -> Result<Self, SessionError> {
        if passes.is_empty() {
            return Err(SessionError::NoPasses);
        }
        if passes.end - passes.start > Film::MAX_PASSES {
            return Err(FilmError::TooManyPasses.into());
        }
        let resolution = scene.resolution();
        check_memory(film_bytes(resolution) + layer_bytes(resolution, layers.len()))?;
        let [width, height] = resolution.map(|n| n as usize);
        Ok(Self {
            film: Film::with_layers(width, height, layers)?,
            integrator,
            scene,
            workers,
            passes,
            time: None,
            grain: None,
            maps: None,
            timings: Timings::default(),
            saver: None,
            saved: None,
            snapshots: None,
            previewer: None,
        })
    }

    /// Starts from a film that holds some passes, of the same job or one that differs in its passes alone.
    ///
    /// # Errors
    /// Where the film has another size or other layers, or this session has passes of its own that are in it.
    pub fn with_film(mut self, mut film: Film) -> Result<Self, SessionError> {
        film.merge(&self.film)?;
        self.film = film;
        Ok(self)
    }

    /// Ends each run once it has taken so long. A pass that would probably end later is not begun, but each run renders
    /// one at least.
    pub fn with_time(self, time: Duration) -> Self {
        Self { time: Some(time), ..self }
    }

    /// Ends a run once [`Film::grain`] is at most `grain`. It is looked at after the eighth pass first, then after each
    /// eighth of the passes that there are: how many passes the film has in the end does not depend on where runs stopped.
    pub fn with_grain(self, grain: f64) -> Self {
        Self { grain: Some(grain), ..self }
    }

    /// Rewrites those outputs that are PNG while passes come: after the first, then `every` so often, but so rarely that it
    /// takes a twentieth of one core's time at most. Each is written from a copy of the film on a thread of its own; where there is
    /// no memory for that, there is none. The first that fails is told as an event. None is under way when a run has ended.
    pub fn with_previews(self, outputs: &[Output], info: &PictureInfo, every: Duration) -> Self {
        Self { previewer: Some(Previewer::new(outputs, info, every)), ..self }
    }

    /// Saves the render to a file `every` so often and at the end of each run. `info` is that of the scene; what it
    /// says of passes, time and timings is kept up to date.
    ///
    /// The film is copied (192 bytes a pixel or more, see [`Film`]) while the next pass runs, and the copy is
    /// compressed and written on a thread of its own. Where there is no memory for a copy, the fold waits for the disk
    /// instead. A file that cannot be written is told as an event, and tried again after `every`.
    pub fn with_checkpoint(self, file: CheckpointFile, mut info: CheckpointInfo, every: Duration) -> Self {
        info.passes = self.passes.clone();
        info.time = self.time;
        Self { saver: Some(Saver::new(file, info, every)), ..self }
    }

    /// Whoever goes on with the checkpoint shall write these pictures.
    pub fn with_outputs(mut self, outputs: Vec<PathBuf>) -> Self {
        if let Some(saver) = &mut self.saver {
            saver.set_outputs(outputs);
        }
        self
    }

    /// Who goes on with the checkpoint shall think that so much time was asked for, from the beginning.
    pub(crate) fn asking(mut self, time: Option<Duration>) -> Self {
        if let Some(saver) = &mut self.saver {
            saver.ask(time);
        }
        self
    }

    /// The checkpoint file holds the film as it is now: a run that adds nothing need not write it again.
    pub(crate) fn saved(self) -> Self {
        Self { saved: Some(self.film.passes()), ..self }
    }

    /// Gives the observer a copy of the film, to keep, `every` so often: [`Event::Snapshot`].
    pub fn with_snapshots(self, every: Duration) -> Self {
        Self { snapshots: Some(every), ..self }
    }

    /// Renders the passes that are missing, in index order. The observer hears of every step, on any thread.
    ///
    /// A pass is folded into the film while the next one is at work, so that no thread waits for the sums.
    ///
    /// # Errors
    /// Where the film cannot take a pass; those before it stay.
    pub fn run(
        &mut self,
        observer: &mut (dyn FnMut(Event<'_>) -> Control + Send),
    ) -> Result<Outcome, SessionError> {
        let missing = missing(&self.passes, self.film.pass_ranges());
        let start = Instant::now();
        if let Some(saver) = &mut self.saver {
            saver.begin(self.saved);
        }
        let fold = Fold {
            total: has_end(&self.passes).then(|| self.film.passes() + count(&missing)),
            last: self.passes.end - 1,
            film: &mut self.film,
            integrator: &*self.integrator,
            observer,
            stop: false,
            pending: None,
            start,
            time: self.time,
            goal: self.grain.map(Goal::new),
            pace: Pace::default(),
            timings: &mut self.timings,
            saver: self.saver.as_mut(),
            snapshots: self.snapshots,
            last_snapshot: start,
            previewer: self.previewer.as_mut(),
            is_over: false,
        };
        let mut run = Run { scene: &self.scene, workers: &self.workers, maps: &mut self.maps, fold };
        let outcome = run.all(&missing);
        self.saved =
            self.saver.as_ref().is_some_and(|s| s.has_saved(self.film.passes())).then(|| self.film.passes());
        outcome.map_err(Into::into)
    }

    /// Why the picture is black or white all over, as `info` shows it; `None` where it is not.
    pub fn blank(&self, info: &PictureInfo) -> Option<Diagnostic> {
        blank(&self.film, &self.scene, info)
    }

    /// Worker threads.
    pub fn threads(&self) -> usize {
        self.workers.threads()
    }

    /// Passes that are in the film.
    pub fn done(&self) -> u64 {
        self.film.passes()
    }

    /// Passes that the job asks for and the film has not.
    pub fn missing(&self) -> u64 {
        count(&missing(&self.passes, self.film.pass_ranges()))
    }

    /// Passes that will be in the film in the end; `None` where they have no end.
    pub fn total(&self) -> Option<u64> {
        has_end(&self.passes).then(|| self.done() + self.missing())
    }

    /// Whether the checkpoint file holds all that the film does; `None` without such a file.
    pub fn is_saved(&self) -> Option<bool> {
        self.saver.as_ref().map(|_| self.saved == Some(self.done()))
    }

    /// The film so far.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Ends the session; the checkpoint file may be written by others from now on.
    pub fn into_film(self) -> Film {
        self.film
    }

    /// Time spent on photons, maps and eye passes, in all runs of this session.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// Where the render is saved.
    pub fn checkpoint_file(&self) -> Option<&CheckpointFile> {
        self.saver.as_ref().map(Saver::file)
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
