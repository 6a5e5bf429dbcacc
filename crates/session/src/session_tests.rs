use super::*;
use crate::Phase;
use film::PassFilm;
use film::{Layer, PixelSample};
use integrators::{NonFinitePhoton, PathRecord, PhotonKind, TracedPhotons};
use scenefile::SceneDesc;
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
            let kind = PhotonKind::Global;
            photons.nonfinite =
                [(9, 2), (11, 0)].map(|(path, depth)| NonFinitePhoton { kind, path, depth }).to_vec();
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
    fn replay_pixel(&self, _: &Scene, _: Option<&Maps>, _: u64, _: [usize; 2]) -> PathRecord {
        PathRecord::default()
    }
    fn photon_paths(&self, _: &Scene) -> Vec<(PhotonKind, u64)> {
        Vec::new()
    }
    fn replay_photon(&self, _: &Scene, _: u64, _: PhotonKind, _: u64) -> PathRecord {
        PathRecord::default()
    }
}

fn fake(passes: Range<u64>) -> Session {
    Session::with_integrator(job(&desc()).scene, Box::new(Fake), passes, 1).unwrap()
}

/// 1.5 and 0.5 by turns, so that the grain after n passes is known.
struct Flicker;

impl Integrator for Flicker {
    fn name(&self) -> &'static str {
        "flicker"
    }
    fn map_index(&self, _: u64) -> Option<u64> {
        None
    }
    fn trace_photons(&self, _: &Scene, _: u64) -> TracedPhotons {
        TracedPhotons::default()
    }
    fn build_maps(&self, _: &Scene, _: TracedPhotons) -> Maps {
        Maps::default()
    }
    fn render(&self, scene: &Scene, _: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        let [w, h] = scene.resolution().map(|n| n as usize);
        let value = 1.0 + if pass.is_multiple_of(2) { 0.5 } else { -0.5 };
        PassFilm::new(w, h, vec![PixelSample { direct: [value; 3], ..PixelSample::default() }; w * h])
    }
    fn replay_pixel(&self, _: &Scene, _: Option<&Maps>, _: u64, _: [usize; 2]) -> PathRecord {
        PathRecord::default()
    }
    fn photon_paths(&self, _: &Scene) -> Vec<(PhotonKind, u64)> {
        Vec::new()
    }
    fn replay_photon(&self, _: &Scene, _: u64, _: PhotonKind, _: u64) -> PathRecord {
        PathRecord::default()
    }
}

#[test]
fn a_render_ends_once_the_grain_is_fine_enough() {
    let session =
        |passes| Session::with_integrator(job(&desc()).scene, Box::new(Flicker), passes, 2).unwrap();
    // 0.5 / 1.1 / √(n − 1) ≤ 0.1 from n = 22 on; looked at are the even passes there.
    let mut one = session(0..1000).with_grain(0.1);
    assert_eq!(one.run(&mut |_| Control::Continue), Ok(Outcome::FineEnough));
    assert_eq!(one.done(), 22);
    assert_eq!(one.run(&mut |_| Control::Continue), Ok(Outcome::FineEnough), "it stays so");
    assert_eq!(one.done(), 22);
    // Stopped on the way.
    let mut cut = session(0..1000).with_grain(0.1);
    let mut runs = 0;
    while cut.run(&mut |_| Control::Stop) == Ok(Outcome::Stopped) {
        runs += 1;
    }
    assert!(runs > 5, "{runs}");
    assert_eq!(cut.film(), one.film());
    // The passes end it first; and how long it will take is told.
    let mut few = session(0..12).with_grain(0.1);
    let mut told = Vec::new();
    let outcome = few.run(&mut |event| {
        if let Event::PassDone { done, remaining, .. } = event {
            told.push((done, remaining.grain.is_some()));
        }
        Control::Continue
    });
    assert_eq!(outcome, Ok(Outcome::Finished));
    assert_eq!(told[6..9], [(7, false), (8, false), (9, true)], "after the first look");
}

#[test]
fn previews_come_beside_the_passes_and_never_after_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| Output::new(&folder.path().join(name)).unwrap();
    let info = PictureInfo::new(&SceneDesc::default(), crate::SceneHash(1));
    let every = Duration::from_nanos(1);
    let outputs = [at("a.png"), at("a.exr")];
    let mut session = fake(0..200).with_previews(&outputs, &info, every);
    let mut passes = Vec::new();
    session
        .run(&mut |event| {
            if let Event::PreviewWritten { passes: shown, .. } = event {
                passes.push(shown);
            }
            Control::Continue
        })
        .unwrap();
    assert_eq!(passes.first(), Some(&1), "from the first pass on");
    assert!(passes.is_sorted());
    assert!(folder.path().join("a.png").exists() && !folder.path().join("a.exr").exists());
    // A folder that is gone is told once, and nothing stops.
    let gone = [at("none/a.png")];
    let mut session = fake(0..200).with_previews(&gone, &info, every);
    let mut failures = 0;
    let outcome = session.run(&mut |event| {
        failures += u32::from(matches!(event, Event::PreviewFailed { .. }));
        Control::Continue
    });
    assert_eq!((outcome, failures, session.done()), (Ok(Outcome::Finished), 1, 200));
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
                format!("pass {pass}, {done} of {}", passes.unwrap())
            }
            Event::PassStarted { pass } => format!("start {pass}"),
            Event::Warning(warning) => warning.to_string(),
            other => panic!("{other:?}"),
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
fn every_phase_is_timed() {
    let mut desc = desc();
    desc.render.integrator = IntegratorKind::PhotonMap;
    let mut session = Session::new(job(&desc), 1).unwrap();
    session.run(&mut |_| Control::Continue).unwrap();
    for phase in [Phase::Photons, Phase::MapBuild, Phase::EyePasses] {
        assert!(session.timings().get(phase) > Duration::ZERO, "{phase:?}");
    }
}

/// Renders and returns how it ended, the film's passes and the limits that were told after each pass.
fn timed(session: &mut Session) -> (Outcome, u64, Vec<crate::Remaining>) {
    let mut told = Vec::new();
    let outcome = session.run(&mut |event| {
        if let Event::PassDone { remaining, .. } = event {
            told.push(remaining);
        }
        Control::Continue
    });
    (outcome.unwrap(), session.done(), told)
}

#[test]
fn time_ends_a_run_after_one_pass_at_least() {
    let mut session = fake(0..5).with_time(Duration::ZERO);
    for done in 1..=4 {
        let (outcome, passes, told) = timed(&mut session);
        assert_eq!((outcome, passes), (Outcome::TimeUp, done));
        assert_eq!(told[0].time, Some(Duration::ZERO));
        assert!(told[0].passes.is_some());
    }
    assert_eq!(timed(&mut session).0, Outcome::Finished);
    assert_eq!(session.into_film(), straight(0..5));
}

#[test]
fn passes_end_a_run_before_its_time() {
    let (outcome, passes, told) = timed(&mut fake(0..5).with_time(Duration::from_secs(1000)));
    assert_eq!((outcome, passes), (Outcome::Finished, 5));
    assert!(told[0].time.unwrap() > Duration::from_secs(900));
    assert_eq!(told[4].passes, Some(Duration::ZERO));
}

#[test]
fn passes_without_end_end_with_the_time() {
    let endless = 3..3 + Film::MAX_PASSES;
    let mut session = fake(endless).with_time(Duration::from_millis(20));
    let (outcome, passes, told) = timed(&mut session);
    assert_eq!(outcome, Outcome::TimeUp);
    assert!(passes > 1 && session.total().is_none(), "{passes}");
    assert!(told.iter().all(|r| r.passes.is_none() && r.first() == r.time));
    assert_eq!(session.film().pass_ranges(), std::slice::from_ref(&(3..3 + passes)));
}

#[test]
fn a_film_is_gone_on_with_where_passes_are_missing() {
    let mut film = straight(1..2);
    film.merge(&straight(3..5)).unwrap();
    let mut session = fake(0..6).with_film(film).unwrap();
    assert_eq!((session.done(), session.missing(), session.total()), (3, 3, Some(6)));
    let mut begun = Vec::new();
    let observer = &mut |event: Event<'_>| {
        if let Event::PassStarted { pass } = event {
            begun.push(pass);
        }
        Control::Continue
    };
    assert_eq!(session.run(observer), Ok(Outcome::Finished));
    assert_eq!(begun, [0, 2, 5]);
    assert_eq!(session.into_film(), straight(0..6));
    assert!(fake(0..1).with_film(Film::new(1, 1)).is_err());
}

#[test]
fn snapshots_can_be_kept() {
    let mut kept = Vec::new();
    let mut session = fake(0..3).with_snapshots(Duration::ZERO);
    let observer = &mut |event: Event<'_>| {
        if let Event::Snapshot { film } = event {
            kept.push(film.clone());
        }
        Control::Continue
    };
    session.run(observer).unwrap();
    let passes: Vec<_> = kept.iter().map(|film| film.passes()).collect();
    assert_eq!(passes, [1, 2, 3]);
    assert_eq!(*kept[1], straight(0..2));
}

fn straight(passes: Range<u64>) -> Film {
    let mut session = fake(passes);
    session.run(&mut |_| Control::Continue).unwrap();
    session.into_film()
}
