//! A path traced again is the path of the render, to the bit.

use film::PixelSample;
use integrators::{Integrator, Maps, PathEvent, PathRecord, PhotonKind, VertexRecord, integrator};
use nephroid::desc::{DirectLight, IntegratorKind, VcmTechniques};
use nephroid::{Job, ReplayError, ReplayKey, Scene, SceneDesc, compile, load, replay};

use crate::support::root;

fn desc(kind: IntegratorKind) -> SceneDesc {
    let mut desc = load(&root().join("scenes/arena/box-spheres.toml"), &[]).desc.unwrap();
    desc.film.size = [16, 12];
    desc.render.integrator = kind;
    desc.render.seed = 3;
    desc.photon_map.photons = 1500;
    desc.photon_map.caustic_photons = 1500;
    desc.sppm.photons = Some(3000);
    desc
}

fn job(desc: &SceneDesc) -> Job {
    Job::new(desc, compile(desc, 1).unwrap().scene).unwrap()
}

/// Each integrator, and settings of it that take other ways.
fn jobs() -> Vec<Job> {
    let mut descs = [
        IntegratorKind::Path,
        IntegratorKind::PhotonMap,
        IntegratorKind::Sppm,
        IntegratorKind::Vcm,
        IntegratorKind::Auto,
    ]
    .map(desc)
    .to_vec();
    let mut without_gather = desc(IntegratorKind::PhotonMap);
    without_gather.photon_map.final_gather = 0;
    let mut by_photons = desc(IntegratorKind::Sppm);
    by_photons.sppm.direct = DirectLight::Photons;
    let mut light_tracing = desc(IntegratorKind::Vcm);
    light_tracing.vcm.techniques = VcmTechniques::LightTracing;
    descs.extend([without_gather, by_photons, light_tracing]);
    descs.iter().map(job).collect()
}

fn maps(integrator: &dyn Integrator, scene: &Scene, pass: u64) -> Option<Maps> {
    let index = integrator.map_index(pass)?;
    Some(integrator.build_maps(scene, integrator.trace_photons(scene, index)))
}

/// The pixel as the recorded light adds up to it.
fn added(record: &PathRecord) -> PixelSample {
    let mut sum = PixelSample::default();
    for event in &record.events {
        let PathEvent::Light { layer, radiance, .. } = event else { continue };
        let target = match *layer {
            "direct" => &mut sum.direct,
            "caustic" => &mut sum.caustic,
            "indirect" => &mut sum.indirect,
            other => panic!("{other}"),
        };
        target.iter_mut().zip(radiance).for_each(|(t, r)| *t += r);
    }
    sum
}

#[test]
fn a_replayed_pixel_is_that_of_the_pass() {
    for job in jobs() {
        let integrator = integrator(&job.settings, &job.scene);
        let name = integrator.name();
        let pass = 2;
        let maps = maps(&*integrator, &job.scene, pass);
        let film = integrator.render(&job.scene, maps.as_ref(), pass).unwrap();
        let mut lit = 0;
        for (i, expected) in film.pixels().iter().enumerate() {
            let pixel = [i % film.width(), i / film.width()];
            let record = integrator.replay_pixel(&job.scene, maps.as_ref(), pass, pixel);
            assert_eq!(record.sample.as_ref(), Some(expected), "{name}, pixel {pixel:?}");
            let sum = added(&record);
            let parts = |s: &PixelSample| [s.direct, s.caustic, s.indirect];
            assert_eq!(parts(&sum), parts(expected), "{name}, pixel {pixel:?}");
            lit += usize::from(sum.beauty() != [0.0; 3]);
        }
        assert!(lit > film.pixels().len() / 4, "{name}: {lit} pixels are lit");
        // A control: the path of another pass is another.
        let pixel = [8, 9];
        let [a, b] = [pass, pass + 1]
            .map(|pass| integrator.replay_pixel(&job.scene, maps.as_ref(), pass, pixel).events);
        assert!(a != b, "{name}");
    }
}

#[test]
fn replayed_photons_are_those_of_the_maps() {
    for job in jobs() {
        let integrator = integrator(&job.settings, &job.scene);
        let (name, index) = (integrator.name(), integrator.map_index(1));
        let kinds = integrator.photon_paths(&job.scene);
        let Some(index) = index else {
            assert!(kinds.is_empty(), "{name}");
            continue;
        };
        let reports = maps(&*integrator, &job.scene, 1).unwrap().reports();
        let stored: usize = reports.iter().map(|report| report.photons).sum();
        let mut replayed = 0;
        for (kind, paths) in kinds {
            for path in 0..paths {
                let record = integrator.replay_photon(&job.scene, index, kind, path);
                replayed += record.events.iter().filter(|e| matches!(e, PathEvent::Stored { .. })).count();
            }
        }
        assert_eq!(replayed, stored, "{name}");
    }
}

/// Against the photons themselves.
#[test]
fn an_observed_photon_path_is_that_of_its_job() {
    let job = job(&desc(IntegratorKind::Sppm));
    let photons = transport::PhotonJob {
        paths: transport::PhotonPaths::Mixed,
        count: 600,
        seed: 3,
        map_index: 1,
        max_depth: 9,
    };
    let all = transport::trace_photons(&job.scene, &photons, 0..600);
    let mut again = Vec::new();
    for path in 0..600 {
        again.extend(transport::observe_photon(&job.scene, &photons, path, &mut ()).photons);
    }
    assert!(!again.is_empty() && again == all.photons);
}

#[test]
fn records_tell_the_way() {
    let job = job(&desc(IntegratorKind::Path));
    let mut steps = 0;
    for x in 0..16 {
        let replayed = replay(&job, ReplayKey::Pixel { pass: 0, x, y: 9 }, 1).unwrap();
        let events = &replayed[0].record.events;
        let vertices: Vec<&VertexRecord> = events
            .iter()
            .filter_map(|event| if let PathEvent::Vertex(v) = event { Some(v) } else { None })
            .collect();
        for (depth, pair) in vertices.windows(2).enumerate() {
            let [a, b] = [&pair[0], &pair[1]];
            assert_eq!((a.depth as usize, b.depth as usize), (depth, depth + 1));
            let step: f32 = a.position.iter().zip(b.position).map(|(p, q)| (p - q).powi(2)).sum();
            assert!((step.sqrt() - b.distance).abs() < 1e-3 * b.distance, "{x}: vertex {depth}");
            assert!(a.material.is_some() && a.object.is_some(), "{x}: vertex {depth}");
            steps += 1;
        }
        assert!(matches!(events.last(), Some(PathEvent::End(_))));
    }
    assert!(steps > 16, "{steps}");
}

#[test]
fn what_there_is_not_is_refused_with_what_there_is() {
    let said = |kind, key| replay(&job(&desc(kind)), key, 1).unwrap_err().to_string();
    let pixel = |x, y, pass| ReplayKey::Pixel { pass, x, y };
    assert!(said(IntegratorKind::Path, pixel(16, 0, 0)).contains("0,0 to 15,11"));
    assert!(said(IntegratorKind::Path, pixel(0, 12, 0)).contains("16 x 12"));
    assert!(said(IntegratorKind::Path, pixel(0, 0, 1 << 22)).contains("4194303"));
    let photon = |kind, path| ReplayKey::Photon { pass: 0, kind, path };
    assert!(said(IntegratorKind::Path, photon(None, 0)).contains("no photons"));
    assert!(said(IntegratorKind::Sppm, photon(None, 3000)).contains("0 to 2999"));
    let caustic = Some(PhotonKind::Caustic);
    assert!(said(IntegratorKind::Sppm, photon(caustic, 0)).contains("caustic photon path 0"));
    let both = replay(&job(&desc(IntegratorKind::PhotonMap)), photon(None, 1499), 1).unwrap();
    assert_eq!(both.len(), 2);
    let error = replay(&job(&desc(IntegratorKind::PhotonMap)), photon(None, 1500), 1).unwrap_err();
    assert!(matches!(error, ReplayError::Photon { path: 1500, .. }), "{error}");
}
