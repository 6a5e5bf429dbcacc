use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use film::{Film, OutputError};
use par::Background;

use super::{CheckpointFile, CheckpointInfo};
use crate::Timings;

/// Saves a render now and then, beside it.
#[derive(Debug)]
pub(crate) struct Saver {
    file: Arc<CheckpointFile>,
    info: CheckpointInfo,
    /// What `info` said when this session, and this run of it, began.
    timings_before: Timings,
    elapsed_before: Duration,
    every: Duration,
    last: Instant,
    /// Passes of the checkpoint that was written last.
    saved: Option<u64>,
    pending: Option<Background<Attempt>>,
}

/// What became of a checkpoint.
#[derive(Debug)]
pub(crate) struct Attempt {
    /// Passes that are in it.
    pub passes: u64,
    /// Its size in bytes.
    pub result: Result<u64, OutputError>,
    /// What it took.
    pub elapsed: Duration,
}

impl Saver {
    pub(crate) fn new(file: CheckpointFile, info: CheckpointInfo, every: Duration) -> Self {
        Self {
            file: Arc::new(file),
            timings_before: info.timings.clone(),
            elapsed_before: info.elapsed,
            info,
            every,
            last: Instant::now(),
            saved: None,
            pending: None,
        }
    }

    pub(crate) fn file(&self) -> &CheckpointFile {
        &self.file
    }

    pub(crate) fn shared_file(&self) -> Arc<CheckpointFile> {
        self.file.clone()
    }

    /// The time that the render was given, for who goes on with it.
    pub(crate) fn ask(&mut self, time: Option<Duration>) {
        self.info.time = time;
    }

    pub(crate) fn set_outputs(&mut self, outputs: Vec<PathBuf>) {
        self.info.outputs = outputs;
    }

    /// What this run took so far, and the phases of this session.
    pub(crate) fn spent(&mut self, elapsed: Duration, timings: &Timings) {
        self.info.elapsed = self.elapsed_before + elapsed;
        self.info.timings = self.timings_before.clone();
        self.info.timings.merge(timings);
    }

    /// The film as it is when a run begins is in the file already.
    pub(crate) fn begin(&mut self, saved: Option<u64>) {
        self.last = Instant::now();
        self.saved = saved;
        self.elapsed_before = self.info.elapsed;
    }

    /// Whether it is time, and no other is being written.
    pub(crate) fn is_due(&self) -> bool {
        self.pending.is_none() && self.last.elapsed() >= self.every
    }

    /// Begins to write a snapshot on a thread of its own; writes it here where there is no thread.
    pub(crate) fn start(&mut self, film: Arc<Film>) -> Option<Attempt> {
        self.last = Instant::now();
        let (file, info, copy) = (self.file.clone(), self.info.clone(), film.clone());
        match Background::start(move || attempt(&file, &info, &copy)) {
            Ok(pending) => {
                self.pending = Some(pending);
                None
            }
            Err(_) => Some(self.save(&film)),
        }
    }

    /// Writes the film here and now.
    pub(crate) fn save(&mut self, film: &Film) -> Attempt {
        let done = attempt(&self.file, &self.info, film);
        self.last = Instant::now();
        self.noted(done)
    }

    /// What became of the snapshot that was being written, once that is known.
    pub(crate) fn poll(&mut self) -> Option<Attempt> {
        self.pending.as_ref().is_some_and(Background::is_done).then(|| self.wait()).flatten()
    }

    /// The same, waited for.
    pub(crate) fn wait(&mut self) -> Option<Attempt> {
        let done = self.pending.take()?.wait();
        Some(self.noted(done))
    }

    /// Whether the file holds so many passes.
    pub(crate) fn has_saved(&self, passes: u64) -> bool {
        self.saved == Some(passes)
    }

    fn noted(&mut self, attempt: Attempt) -> Attempt {
        if attempt.result.is_ok() {
            self.saved = Some(attempt.passes);
        }
        attempt
    }
}

fn attempt(file: &CheckpointFile, info: &CheckpointInfo, film: &Film) -> Attempt {
    let start = Instant::now();
    let result = file.write(info, film);
    Attempt { passes: film.passes(), result, elapsed: start.elapsed() }
}
