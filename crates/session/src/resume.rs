use std::path::Path;
use std::time::Duration;

use film::Film;
use scenefile::Diagnostic;

use crate::checkpoint::{
    Checkpoint, CheckpointError, CheckpointErrorKind, CheckpointFile, CheckpointInfo, ReadScene,
};
use crate::job::has_end;
use crate::ranges::{missing, with_more};
use crate::{Job, Phase, Session, Timings, compile};

/// How many passes a resumed render shall have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// As many as were asked for when it began. Where a time is given and these are done: without end.
    AsAsked,
    /// So many, counted from the first that was asked for.
    Total(u64),
    /// So many more than it has; gaps are filled first.
    More(u64),
}

/// What a resumed render shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// How many passes it shall have.
    pub extent: Extent,
    /// How much more time it has. Without, and as many passes as were asked for, what is left of the time asked for, if any.
    pub time: Option<Duration>,
    /// Grain that ends it ([`Session::with_grain`]); `None`: what was asked for when it began, if any.
    pub grain: Option<f32>,
}

impl From<Extent> for Wanted {
    /// So many passes, and time and grain as they were asked for.
    fn from(extent: Extent) -> Self {
        Self { extent, time: None, grain: None }
    }
}

/// A render that can go on.
#[derive(Debug)]
pub struct Resumed {
    /// With the film of the checkpoint, which it goes on to write.
    pub session: Session,
    /// What the checkpoint said.
    pub info: CheckpointInfo,
    /// What may be wrong with the scene.
    pub warnings: Vec<Diagnostic>,
    /// What reading and compiling took.
    pub timings: Timings,
}

/// Goes on with a checkpoint file on `threads` threads (0: one for each core; their number may be another than
/// before). The session saves itself to the same file `every` so often. Where the scene came from a file of another
/// program, `read` reads that again.
///
/// # Errors
/// Where the checkpoint cannot be read or written, files of its scene were changed, or nothing is left of what was
/// asked for because the time is spent. No error: all passes are there; [`Session::missing`] is then 0.
pub fn resume(
    path: &Path,
    wanted: Wanted,
    every: Duration,
    threads: usize,
    read: ReadScene<'_>,
) -> Result<Resumed, CheckpointError> {
    let error = |kind| CheckpointError::new(path, kind);
    let mut timings = Timings::default();
    // Read first: a file that is none is no matter of locks.
    let (checkpoint, file) = timings.time(Phase::Load, || {
        Checkpoint::read_head(path)?;
        let file = CheckpointFile::open(path)?;
        Checkpoint::read(path).map(|checkpoint| (checkpoint, file))
    })?;
    let Checkpoint { info, film } = checkpoint;
    let changed = info.changed_files();
    if !changed.is_empty() {
        return Err(error(CheckpointErrorKind::Files(changed)));
    }
    let time = time_left(&info, wanted).map_err(&error)?;
    let desc = timings.time(Phase::Load, || info.scene(read)).map_err(&error)?;
    let compiled = timings.time(Phase::Compile, || compile(&desc, threads));
    let compiled = compiled.map_err(|e| error(CheckpointErrorKind::Scene(e)))?;
    let session_error = |e| error(CheckpointErrorKind::Session(e));
    let job = Job::new(&desc, compiled.scene).map_err(session_error)?;
    let grain = wanted.grain.or(info.desc.render.noise);
    let end = match (time.is_some() || wanted.grain.is_some(), grain) {
        (true, _) => End::Anew,
        (false, Some(_)) => End::AsBefore,
        (false, None) => End::None,
    };
    let job = extended(Job { passes: info.passes.clone(), ..job }, &film, wanted.extent, end);
    let job = job.map_err(&error)?;
    let mut session = Session::new(job, threads).and_then(|s| s.with_film(film)).map_err(session_error)?;
    if let Some(time) = time {
        session = session.with_time(time);
    }
    if let Some(grain) = grain {
        session = session.with_grain(grain.into());
    }
    let mut next = info.clone();
    next.desc.render.noise = grain;
    next.timings.merge(&timings);
    // The total, as of a render that was not interrupted.
    next.time = None;
    let asked = time.map(|time| info.elapsed + time);
    let session = session.with_checkpoint(file, next, every).asking(asked).saved();
    Ok(Resumed { session, info, warnings: compiled.warnings, timings })
}

/// The time that a run has.
fn time_left(info: &CheckpointInfo, wanted: Wanted) -> Result<Option<Duration>, CheckpointErrorKind> {
    match (wanted.time, wanted.extent, info.time.filter(|_| wanted.grain.is_none())) {
        (Some(time), ..) => Ok(Some(time)),
        (None, Extent::AsAsked, Some(asked)) => {
            let left = asked.saturating_sub(info.elapsed);
            // A pass is not begun that would end later, so hardly any render spends all of its time.
            if left.as_secs_f64() > 0.02 * asked.as_secs_f64() {
                return Ok(Some(left));
            }
            Err(CheckpointErrorKind::Passes(format!(
                "the {:.0} s that were asked for are spent; --time or --passes says how much more to render",
                asked.as_secs_f64()
            )))
        }
        _ => Ok(None),
    }
}

/// What else than passes ends a render.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    None,
    /// A grain that was asked for when it began.
    AsBefore,
    /// A time, or a grain that is asked for now.
    Anew,
}

/// The job with the passes that are to be there in the end.
fn extended(job: Job, film: &Film, extent: Extent, end: End) -> Result<Job, CheckpointErrorKind> {
    let start = job.passes.start;
    let present = film.pass_ranges();
    let passes = match extent {
        Extent::AsAsked if !has_end(&job.passes) && end == End::None => {
            let done = film.passes();
            return Err(CheckpointErrorKind::Passes(format!(
                "it has {done} passes, and how many there should be was never said; --time, --noise or --passes says it"
            )));
        }
        Extent::AsAsked if end == End::Anew && missing(&job.passes, present).is_empty() => {
            return Ok(job.endless());
        }
        Extent::AsAsked => job.passes.clone(),
        Extent::Total(total) if total < film.passes() => {
            let done = film.passes();
            return Err(CheckpointErrorKind::Passes(format!(
                "it has {done} passes already, more than {total}"
            )));
        }
        Extent::Total(total) => start..start.saturating_add(total),
        Extent::More(more) => with_more(start, present, more),
    };
    Ok(Job { passes, ..job })
}
