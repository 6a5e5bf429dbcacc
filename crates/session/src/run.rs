//! One run of a session: passes in index order, each folded into the film while the next is at work.

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use film::{Film, FilmError, FilmNonFinite, PassFilm};
use integrators::{Integrator, Maps};
use par::Workers;
use scene::Scene;

use crate::checkpoint::{Attempt, Saver};
use crate::grain::{Goal, is_looked_at};
use crate::job::check_memory;
use crate::pace::Pace;
use crate::preview::{Previewer, Written};
use crate::{Control, Event, Outcome, Phase, Remaining, Timings, Warning};

/// The work.
pub(crate) struct Run<'a> {
    pub scene: &'a Scene,
    pub workers: &'a Workers,
    pub maps: &'a mut Option<(u64, Maps)>,
    pub fold: Fold<'a>,
}

impl Run<'_> {
    /// Renders these passes, then saves.
    pub(crate) fn all(&mut self, missing: &[Range<u64>]) -> Result<Outcome, FilmError> {
        let outcome = self.passes(missing);
        self.fold.is_over = true;
        let start = Instant::now();
        let folded = self.fold.flush();
        self.fold.timings.add(Phase::EyePasses, start.elapsed());
        self.fold.end_previews();
        self.fold.save_at_end();
        folded.and(outcome)
    }

    fn passes(&mut self, missing: &[Range<u64>]) -> Result<Outcome, FilmError> {
        for (i, pass) in missing.iter().cloned().flatten().enumerate() {
            if self.is_fine_enough()? {
                return Ok(Outcome::FineEnough);
            }
            if i > 0 && self.fold.is_too_late(self.wanted_maps(pass).is_some()) {
                return Ok(Outcome::TimeUp);
            }
            self.fold.tell(Event::PassStarted { pass });
            if i > 0 && self.fold.stop {
                return Ok(Outcome::Stopped);
            }
            self.pass(pass)?;
        }
        Ok(Outcome::Finished)
    }

    /// Whether the grain of all passes so far is what was asked for, if it is looked at after so many.
    fn is_fine_enough(&mut self) -> Result<bool, FilmError> {
        let passes = self.fold.film.passes() + u64::from(self.fold.pending.is_some());
        if self.fold.goal.is_none() || !is_looked_at(passes) {
            return Ok(false);
        }
        let start = Instant::now();
        let looked = self.workers.run(|| self.fold.flush().map(|()| self.fold.film.grain()));
        self.fold.timings.add(Phase::EyePasses, start.elapsed());
        let Some(goal) = &mut self.fold.goal else { return Ok(false) };
        goal.found = looked?.map(|grain| (passes, grain));
        Ok(goal.is_reached())
    }

    fn pass(&mut self, pass: u64) -> Result<(), FilmError> {
        self.prepare_maps(pass)?;
        let start = Instant::now();
        let (scene, integrator) = (self.scene, self.fold.integrator);
        let maps = self.maps.as_ref().map(|(_, maps)| maps);
        let contribution = self.fold.meanwhile(self.workers, || integrator.render(scene, maps, pass))??;
        self.fold.pending = Some((pass, contribution));
        let elapsed = start.elapsed();
        self.fold.timings.add(Phase::EyePasses, elapsed);
        self.fold.pace.add_pass(elapsed);
        Ok(())
    }

    /// Index of the maps that have to be made for `pass`.
    fn wanted_maps(&self, pass: u64) -> Option<u64> {
        let wanted = self.fold.integrator.map_index(pass)?;
        (self.maps.as_ref().map(|(index, _)| *index) != Some(wanted)).then_some(wanted)
    }

    /// The maps that `pass` looks up, unless they are at hand.
    fn prepare_maps(&mut self, pass: u64) -> Result<(), FilmError> {
        let Some(index) = self.wanted_maps(pass) else { return Ok(()) };
        *self.maps = None;
        let start = Instant::now();
        let (scene, integrator) = (self.scene, self.fold.integrator);
        let photons = self.phase(Phase::Photons, || integrator.trace_photons(scene, index))?;
        if let Some(&first) = photons.nonfinite.first() {
            let count = photons.nonfinite.len() as u64;
            let warning = Warning::NonFinitePhotons { map_index: index, first, count };
            self.fold.tell(Event::Warning(warning));
        }
        let maps = self.phase(Phase::MapBuild, || integrator.build_maps(scene, photons))?;
        self.fold.tell(Event::MapsReady { map_index: index, reports: &maps.reports() });
        *self.maps = Some((index, maps));
        self.fold.pace.add_maps(start.elapsed());
        Ok(())
    }

    fn phase<R: Send>(&mut self, phase: Phase, work: impl FnOnce() -> R + Send) -> Result<R, FilmError> {
        self.fold.tell(Event::PhaseStarted(phase));
        let start = Instant::now();
        let result = self.fold.meanwhile(self.workers, work);
        let elapsed = start.elapsed();
        self.fold.timings.add(phase, elapsed);
        self.fold.tell(Event::PhaseDone { phase, elapsed });
        result
    }
}

/// The film, a pass that waits for it, and who wants to hear of it.
pub(crate) struct Fold<'a> {
    pub film: &'a mut Film,
    pub integrator: &'a dyn Integrator,
    pub observer: &'a mut (dyn FnMut(Event<'_>) -> Control + Send),
    pub stop: bool,
    pub pending: Option<(u64, PassFilm)>,
    /// Passes in the film in the end.
    pub total: Option<u64>,
    /// The last pass of the job.
    pub last: u64,
    pub start: Instant,
    pub time: Option<Duration>,
    pub goal: Option<Goal>,
    pub pace: Pace,
    pub timings: &'a mut Timings,
    pub saver: Option<&'a mut Saver>,
    pub snapshots: Option<Duration>,
    pub last_snapshot: Instant,
    pub previewer: Option<&'a mut Previewer>,
    /// No pass is begun any more.
    pub is_over: bool,
}

impl Fold<'_> {
    pub(crate) fn tell(&mut self, event: Event<'_>) {
        self.stop |= (self.observer)(event) == Control::Stop;
    }

    /// Whether one more pass, with maps to make or without, would probably end after the time.
    fn is_too_late(&self, needs_maps: bool) -> bool {
        let pass = self.pace.of(1, needs_maps.into());
        self.time.is_some_and(|time| self.start.elapsed().saturating_add(pass) > time)
    }

    /// `work` on the workers; one of them first adds the pass that waits.
    fn meanwhile<R: Send>(
        &mut self,
        workers: &Workers,
        work: impl FnOnce() -> R + Send,
    ) -> Result<R, FilmError> {
        let (folded, result) = workers.run(|| par::join(|| self.flush(), work));
        folded.map(|()| result)
    }

    /// Adds the pass that waits and tells of it; saves where it is time.
    fn flush(&mut self) -> Result<(), FilmError> {
        let Some((pass, contribution)) = self.pending.take() else { return Ok(()) };
        self.film.add(pass, &contribution)?;
        if let Some(warning) = nonfinite(pass, &contribution) {
            self.tell(Event::Warning(warning));
        }
        drop(contribution);
        let (done, passes, elapsed) = (self.film.passes(), self.total, self.start.elapsed());
        let remaining = self.remaining(pass, done, elapsed);
        let event = Event::PassDone { pass, done, passes, elapsed, remaining, film: self.film };
        self.stop |= (self.observer)(event) == Control::Stop;
        self.publish();
        Ok(())
    }

    fn remaining(&self, pass: u64, done: u64, elapsed: Duration) -> Remaining {
        let map_index = |pass| self.integrator.map_index(pass).unwrap_or_default();
        let maps = map_index(self.last).saturating_sub(map_index(pass));
        let passes = self.total.map(|total| {
            let left = total.saturating_sub(done);
            self.pace.of(left, maps.min(left))
        });
        let maps_each = |passes: u64| if map_index(self.last) > map_index(pass) { passes } else { 0 };
        let grain =
            self.goal.and_then(|g| g.left(done, |left| self.pace.of(left, maps_each(left).min(maps))));
        Remaining { passes, time: self.time.map(|time| time.saturating_sub(elapsed)), grain }
    }

    /// Hands out copies of the film where it is time.
    fn publish(&mut self) {
        if let Some(attempt) = self.saver.as_mut().and_then(|s| s.poll()) {
            self.tell_of(&attempt);
        }
        self.poll_preview();
        let snapshot = self.snapshots.is_some_and(|every| self.last_snapshot.elapsed() >= every);
        let save = self.saver.as_ref().is_some_and(|s| s.is_due());
        // The last picture is not far.
        let preview = !self.is_over && !self.stop && self.previewer.as_ref().is_some_and(|p| p.is_due());
        if !snapshot && !save && !preview {
            return;
        }
        if save {
            self.tell_saver();
        }
        let start = Instant::now();
        let copy = check_memory(self.film.memory_bytes()).is_ok().then(|| Arc::new(self.film.clone()));
        if let (Some(previewer), Some(copy), true) = (&mut self.previewer, &copy, preview) {
            previewer.start(copy.clone(), start.elapsed());
        }
        let attempt = match (&mut self.saver, &copy) {
            (Some(saver), Some(copy)) if save => saver.start(copy.clone()),
            (Some(saver), None) if save => Some(saver.save(self.film)),
            _ => None,
        };
        if let Some(attempt) = attempt {
            self.tell_of(&attempt);
        }
        if let (Some(film), true) = (copy, snapshot) {
            self.last_snapshot = Instant::now();
            self.tell(Event::Snapshot { film: &film });
        }
    }

    /// Tells what became of a preview.
    fn poll_preview(&mut self) {
        if let Some(written) = self.previewer.as_mut().and_then(|p| p.poll()) {
            self.tell_of_preview(&written);
        }
    }

    /// Waits for the preview that is under way: whoever writes the picture next is the last.
    fn end_previews(&mut self) {
        if let Some(written) = self.previewer.as_mut().and_then(|p| p.wait()) {
            self.tell_of_preview(&written);
        }
    }

    fn tell_of_preview(&mut self, written: &Written) {
        let Written { passes, elapsed, .. } = *written;
        match &written.result {
            Ok(()) => self.tell(Event::PreviewWritten { passes, elapsed }),
            Err(error) => {
                if self.previewer.as_mut().is_some_and(|p| p.tells()) {
                    self.tell(Event::PreviewFailed { error });
                }
            }
        }
    }

    /// Leaves the checkpoint file with all that the film holds.
    fn save_at_end(&mut self) {
        self.tell_saver();
        if let Some(attempt) = self.saver.as_mut().and_then(|s| s.wait()) {
            self.tell_of(&attempt);
        }
        let passes = self.film.passes();
        if passes == 0 || self.saver.as_ref().is_none_or(|s| s.has_saved(passes)) {
            return;
        }
        let attempt = self.saver.as_mut().map(|saver| saver.save(self.film));
        if let Some(attempt) = attempt {
            self.tell_of(&attempt);
        }
    }

    /// What the next checkpoint says of the time.
    fn tell_saver(&mut self) {
        if let Some(saver) = &mut self.saver {
            saver.spent(self.start.elapsed(), self.timings);
        }
    }

    fn tell_of(&mut self, attempt: &Attempt) {
        let Some(saver) = &self.saver else { return };
        let file = saver.shared_file();
        let Attempt { passes, elapsed, .. } = *attempt;
        self.tell(match &attempt.result {
            Ok(bytes) => Event::CheckpointWritten { path: file.path(), passes, bytes: *bytes, elapsed },
            Err(error) => Event::CheckpointFailed { passes, error },
        });
    }
}

fn nonfinite(pass: u64, contribution: &PassFilm) -> Option<Warning> {
    let &at = contribution.nonfinite().first()?;
    Some(Warning::NonFinite {
        first: FilmNonFinite { pass, at },
        width: contribution.width(),
        count: contribution.nonfinite_count(),
    })
}
