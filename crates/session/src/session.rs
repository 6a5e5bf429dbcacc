use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use film::{Film, FilmError, FilmNonFinite, PassFilm};
use integrators::{Integrator, Maps, Settings};
use par::Workers;
use scene::Scene;
use scenefile::SceneDesc;

use crate::{Control, Event, Phase, Timings, Warning, settings};

/// What to render.
#[derive(Clone, Debug)]
pub struct Job {
    /// The compiled scene.
    pub scene: Arc<Scene>,
    /// Integrator, seed and what else decides the value of a pass.
    pub settings: Settings,
    /// Indices of the passes: `0..n` for a whole render, any range for a part of one.
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
    /// The film refuses: a filter without extent, too many passes.
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
/// folded. 344 bytes a pixel; filters with negative weights take 120 more.
pub fn film_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height) * (192 + 2 * 76)
}

/// Asks the system for that many bytes, and gives them back. A system that promises more than it has is believed.
fn check_memory(bytes: u64) -> Result<(), SessionError> {
    let none = SessionError::Memory(bytes);
    let Ok(size) = usize::try_from(bytes) else { return Err(none) };
    Vec::<u8>::new().try_reserve_exact(size).map_err(|_| none)
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All passes are in the film.
    Finished,
    /// The observer stopped it; [`Session::run`] goes on where it stopped.
    Stopped,
}

/// A job in progress. The film depends on the job alone: not on threads, nor on where runs stopped.
pub struct Session {
    scene: Arc<Scene>,
    integrator: Box<dyn Integrator>,
    workers: Workers,
    passes: Range<u64>,
    done: u64,
    maps: Option<(u64, Maps)>,
    film: Film,
    timings: Timings,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session")
            .field("integrator", &self.integrator.name())
            .field("threads", &self.workers.threads())
            .field("passes", &self.passes)
            .field("done", &self.done)
            .finish_non_exhaustive()
    }
}

impl Session {
    /// A session of `job` on `threads` threads (0: one for each core).
    ///
    /// # Errors
    /// Where the job has no pass, or more than a film holds, or there is no memory or thread.
    pub fn new(job: Job, threads: usize) -> Result<Self, SessionError> {
        let integrator = integrators::integrator(&job.settings);
        Self::with_integrator(job.scene, integrator, job.passes, threads)
    }

    fn with_integrator(
        scene: Arc<Scene>,
        integrator: Box<dyn Integrator>,
        passes: Range<u64>,
        threads: usize,
    ) -> Result<Self, SessionError> {
        if passes.is_empty() {
            return Err(SessionError::NoPasses);
        }
        if passes.end - passes.start > Film::MAX_PASSES {
            return Err(FilmError::TooManyPasses.into());
        }
        check_memory(film_bytes(scene.resolution()))?;
        let workers = Workers::new(threads).map_err(SessionError::Threads)?;
        let [width, height] = scene.resolution().map(|n| n as usize);
        Ok(Self {
            integrator,
            film: Film::new(width, height),
            scene,
            workers,
            passes,
            done: 0,
            maps: None,
            timings: Timings::default(),
        })
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
        let total = self.passes.end - self.passes.start;
        let first = self.passes.start + self.done;
        let mut run = Run {
            scene: &self.scene,
            integrator: &*self.integrator,
            workers: &self.workers,
            maps: &mut self.maps,
            timings: &mut self.timings,
            eye: Duration::ZERO,
            rendered: 0,
            fold: Fold {
                film: &mut self.film,
                observer,
                stop: false,
                pending: None,
                done: &mut self.done,
                total,
                start: Instant::now(),
                per_pass: Duration::ZERO,
            },
        };
        for pass in first..self.passes.end {
            run.fold.tell(Event::PassStarted { pass });
            if run.fold.stop && pass > first {
                run.finish()?;
                return Ok(Outcome::Stopped);
            }
            run.pass(pass)?;
        }
        run.finish()?;
        Ok(Outcome::Finished)
    }

    /// The film so far.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// The film, when no more passes are wanted.
    pub fn into_film(self) -> Film {
        self.film
    }

    /// Passes of this job that are in the film.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Worker threads.
    pub fn threads(&self) -> usize {
        self.workers.threads()
    }

    /// Time spent on photons, maps and eye passes.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }
}

/// One run of a session.
struct Run<'a> {
    scene: &'a Scene,
    integrator: &'a dyn Integrator,
    workers: &'a Workers,
    maps: &'a mut Option<(u64, Maps)>,
    timings: &'a mut Timings,
    /// Spent on eye passes, and how many.
    eye: Duration,
    rendered: u32,
    fold: Fold<'a>,
}

impl Run<'_> {
    fn pass(&mut self, pass: u64) -> Result<(), FilmError> {
        self.prepare_maps(pass)?;
        let start = Instant::now();
        let (scene, integrator, maps) =
            (self.scene, self.integrator, self.maps.as_ref().map(|(_, maps)| maps));
        let contribution = self.fold.meanwhile(self.workers, || integrator.render(scene, maps, pass))??;
        self.fold.pending = Some((pass, contribution));
        let elapsed = start.elapsed();
        self.timings.add(Phase::EyePasses, elapsed);
        self.eye += elapsed;
        self.rendered += 1;
        self.fold.per_pass = self.eye / self.rendered;
        Ok(())
    }

    /// The maps that `pass` looks up, unless they are at hand.
    fn prepare_maps(&mut self, pass: u64) -> Result<(), FilmError> {
        let wanted = self.integrator.map_index(pass);
        if self.maps.as_ref().map(|(index, _)| *index) == wanted {
            return Ok(());
        }
        *self.maps = None;
        let Some(index) = wanted else { return Ok(()) };
        let (scene, integrator) = (self.scene, self.integrator);
        let photons = self.phase(Phase::Photons, || integrator.trace_photons(scene, index))?;
        if let Some(&(path, depth)) = photons.nonfinite.first() {
            let count = photons.nonfinite.len() as u64;
            self.fold.tell(Event::Warning(Warning::NonFinitePhotons {
                map_index: index,
                path,
                depth,
                count,
            }));
        }
        let maps = self.phase(Phase::MapBuild, || integrator.build_maps(scene, photons))?;
        self.fold.tell(Event::MapsReady { map_index: index, reports: &maps.reports() });
        *self.maps = Some((index, maps));
        Ok(())
    }

    fn phase<R: Send>(&mut self, phase: Phase, work: impl FnOnce() -> R + Send) -> Result<R, FilmError> {
        self.fold.tell(Event::PhaseStarted(phase));
        let start = Instant::now();
        let result = self.fold.meanwhile(self.workers, work);
        let elapsed = start.elapsed();
        self.timings.add(phase, elapsed);
        self.fold.tell(Event::PhaseDone { phase, elapsed });
        result
    }

    /// Folds the last pass.
    fn finish(&mut self) -> Result<(), FilmError> {
        let start = Instant::now();
        let result = self.fold.flush();
        self.timings.add(Phase::EyePasses, start.elapsed());
        result
    }
}

/// The film, a pass that waits for it, and who wants to hear of it.
struct Fold<'a> {
    film: &'a mut Film,
    observer: &'a mut (dyn FnMut(Event<'_>) -> Control + Send),
    stop: bool,
    pending: Option<(u64, PassFilm)>,
    /// Passes in the film, and in the end.
    done: &'a mut u64,
    total: u64,
    start: Instant,
    /// Wall-clock time of an eye pass.
    per_pass: Duration,
}

impl Fold<'_> {
    fn tell(&mut self, event: Event<'_>) {
        self.stop |= (self.observer)(event) == Control::Stop;
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

    /// Adds the pass that waits and tells of it.
    fn flush(&mut self) -> Result<(), FilmError> {
        let Some((pass, contribution)) = self.pending.take() else { return Ok(()) };
        self.film.add(pass, &contribution)?;
        *self.done += 1;
        if let Some(warning) = nonfinite(pass, &contribution) {
            self.tell(Event::Warning(warning));
        }
        let (done, passes) = (*self.done, self.total);
        let remaining = self.per_pass.mul_f64((passes - done) as f64);
        let event =
            Event::PassDone { pass, done, passes, elapsed: self.start.elapsed(), remaining, film: self.film };
        self.stop |= (self.observer)(event) == Control::Stop;
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use film::{Layer, PixelSample};
    use integrators::TracedPhotons;
    use scenefile::desc::{Camera, IntegratorKind, Light, LightKind, Material, Object, Shape};

    fn desc() -> SceneDesc {
        let mut desc = SceneDesc::default();
        desc.film.size = [5, 4];
        desc.render.passes = 4;
        desc.photon_map.photons = 500;
        desc.photon_map.caustic_photons = 500;
        desc.camera = Some(Camera { position: [0.0, 0.0, 4.0], ..Camera::default() }.into());
        let ball = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
        desc.objects.push(Object::new(ball, Material::diffuse(0.5)).into());
        desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
        desc
    }

    fn job(desc: &SceneDesc) -> Job {
        Job::new(desc, crate::compile(desc, 1).unwrap().scene).unwrap()
    }

    /// Renders the index of the pass; maps change every other pass; value 7 of each third pass is no number.
    struct Fake;

    impl Integrator for Fake {
        fn name(&self) -> &'static str {
            "fake"
        }
        fn map_index(&self, pass: u64) -> Option<u64> {
            Some(pass / 2)
        }
        fn trace_photons(&self, _: &Scene, map_index: u64) -> TracedPhotons {
            let mut photons = TracedPhotons::default();
            if map_index == 1 {
                photons.nonfinite = vec![(9, 2), (11, 0)];
            }
            photons
        }
        fn build_maps(&self, _: &Scene, _: TracedPhotons) -> Maps {
            Maps::default()
        }
        fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
            assert!(maps.is_some());
            let [w, h] = scene.resolution().map(|n| n as usize);
            let mut pixels = vec![PixelSample { direct: [pass as f32; 3], ..PixelSample::default() }; w * h];
            if pass % 3 == 2 {
                pixels[7].caustic[1] = f32::NAN;
            }
            PassFilm::new(w, h, pixels)
        }
    }

    fn fake(passes: Range<u64>) -> Session {
        Session::with_integrator(job(&desc()).scene, Box::new(Fake), passes, 1).unwrap()
    }

    #[test]
    fn events_come_in_order_and_maps_are_kept_while_their_index_is() {
        let mut said = Vec::new();
        let mut session = fake(2..6);
        let outcome = session.run(&mut |event| {
            said.push(match event {
                Event::PhaseStarted(phase) => format!("{phase:?}"),
                Event::PhaseDone { phase, .. } => format!("{phase:?} done"),
                Event::MapsReady { map_index, reports } => format!("maps {map_index} ({})", reports.len()),
                Event::PassDone { pass, done, passes, film, .. } => {
                    assert_eq!(film.passes(), done);
                    format!("pass {pass}, {done} of {passes}")
                }
                Event::PassStarted { pass } => format!("start {pass}"),
                Event::Warning(warning) => warning.to_string(),
            });
            Control::Continue
        });
        assert_eq!(outcome, Ok(Outcome::Finished));
        let expected = [
            "start 2",
            "Photons",
            "Photons done",
            "2 photons are not finite and dropped from maps 1; the first: path 9 after 2 scattering events",
            "MapBuild",
            "MapBuild done",
            "maps 1 (0)",
            "start 3",
            "1 value of pass 2 is not finite and left out; the first: pixel 2,1 of layer caustic",
            "pass 2, 1 of 4",
            "start 4",
            "Photons",
            "pass 3, 2 of 4",
            "Photons done",
            "MapBuild",
            "MapBuild done",
            "maps 2 (0)",
            "start 5",
            "pass 4, 3 of 4",
            "1 value of pass 5 is not finite and left out; the first: pixel 2,1 of layer caustic",
            "pass 5, 4 of 4",
        ];
        assert_eq!(said, expected);
        assert_eq!(session.film().pass_ranges().first(), Some(&(2..6)));
        assert!(session.film().layer(Layer::Direct).iter().all(|v| *v == 3.5), "the mean of 2, 3, 4, 5");
    }

    #[test]
    fn a_stop_lets_the_pass_finish_and_a_run_goes_on() {
        let mut session = fake(0..5);
        // Asked for while photons are traced: the pass they are for is still rendered.
        let stop_at_once = &mut |_: Event<'_>| Control::Stop;
        assert_eq!(session.run(stop_at_once), Ok(Outcome::Stopped));
        assert_eq!(session.done(), 1);
        assert_eq!(session.run(stop_at_once), Ok(Outcome::Stopped));
        assert_eq!(session.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
        assert_eq!(session.run(stop_at_once), Ok(Outcome::Finished), "nothing is left");
        let mut straight = fake(0..5);
        straight.run(&mut |_| Control::Continue).unwrap();
        assert_eq!(session.into_film(), straight.into_film());
    }

    #[test]
    fn a_stop_after_the_last_pass_is_a_finish() {
        let mut session = fake(0..1);
        assert_eq!(session.run(&mut |_| Control::Stop), Ok(Outcome::Finished));
    }

    #[test]
    fn films_of_any_threads_and_any_split_are_equal() {
        for integrator in [IntegratorKind::PhotonMap, IntegratorKind::Path] {
            let mut desc = desc();
            desc.render.integrator = integrator;
            let job = job(&desc);
            let film = |passes: Range<u64>, threads: usize| {
                let mut session = Session::new(Job { passes, ..job.clone() }, threads).unwrap();
                session.run(&mut |_| Control::Continue).unwrap();
                session.into_film()
            };
            let whole = film(0..4, 1);
            assert!(whole.beauty().iter().any(|p| p[0] > 0.1));
            assert_eq!(whole, film(0..4, 3));
            let mut merged = film(3..4, 2);
            merged.merge(&film(0..3, 1)).unwrap();
            assert_eq!(whole, merged, "{integrator:?}");
        }
    }

    #[test]
    fn jobs_that_cannot_run() {
        let desc = desc();
        let refused = |passes: Range<u64>| Session::new(Job { passes, ..job(&desc) }, 1).unwrap_err();
        assert_eq!(refused(3..3), SessionError::NoPasses);
        assert_eq!(refused(0..Film::MAX_PASSES + 1), SessionError::Film(FilmError::TooManyPasses));
    }

    #[test]
    fn memory_that_nobody_has_is_refused() {
        assert_eq!(film_bytes([1000, 1000]), 344_000_000);
        assert_eq!(check_memory(1 << 20), Ok(()));
        assert_eq!(check_memory(1 << 62), Err(SessionError::Memory(1 << 62)));
    }

    #[test]
    fn every_phase_is_timed() {
        let mut session = Session::new(job(&desc()), 1).unwrap();
        session.run(&mut |_| Control::Continue).unwrap();
        for phase in [Phase::Photons, Phase::MapBuild, Phase::EyePasses] {
            assert!(session.timings().get(phase) > Duration::ZERO, "{phase:?}");
        }
    }
}
