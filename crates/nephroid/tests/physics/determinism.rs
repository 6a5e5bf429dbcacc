//! Same scene, same seed: the same bytes, on any number of threads.

use film::{ExrOptions, encode_exr};
use nephroid::desc::{DirectLight, FilterKind, IntegratorKind, Render, VcmTechniques};
use nephroid::{Control, Job, SceneDesc, Session, compile, load};

use crate::support::{PATH, PHOTON_MAP, root};

/// A small picture. Splats of light paths go wherever they go, so they are spread by a filter that is wide.
fn small(integrator: IntegratorKind) -> SceneDesc {
    let mut desc = load(&root().join("scenes/arena/box-spheres.toml"), &[]).desc.unwrap();
    desc.film.size = [40, 24];
    desc.film.filter = FilterKind::Mitchell;
    desc.render.integrator = integrator;
    desc
}

fn exr(desc: &SceneDesc, seed: u64, threads: usize, passes: std::ops::Range<u64>) -> Vec<u8> {
    let mut desc = desc.clone();
    desc.render = Render { seed, ..desc.render };
    desc.photon_map.photons = 9_000;
    desc.photon_map.caustic_photons = 9_000;
    desc.sppm.photons = Some(9_000);
    // Scenes are compiled on as many threads, too.
    let scene = compile(&desc, threads).unwrap().scene;
    let job = Job { passes, ..Job::new(&desc, scene).unwrap() };
    let mut session = Session::new(job, threads).unwrap();
    session.run(&mut |_| Control::Continue).unwrap();
    encode_exr(session.film(), &ExrOptions::default()).unwrap()
}

#[track_caller]
fn assert_same_bytes(what: &str, desc: &SceneDesc) {
    let one = exr(desc, 5, 1, 0..2);
    for threads in [2, 3, 7, 1] {
        assert!(one == exr(desc, 5, threads, 0..2), "{what} on {threads} threads");
    }
    assert!(one != exr(desc, 6, 2, 0..2), "{what}: the seed counts");
    assert!(one != exr(desc, 5, 2, 1..3), "{what}: the pass counts");
}

#[test]
fn exr_bytes_do_not_depend_on_threads_and_replay() {
    for integrator in [PATH, PHOTON_MAP, IntegratorKind::Sppm, IntegratorKind::Auto, IntegratorKind::Vcm] {
        assert_same_bytes(&format!("{integrator:?}"), &small(integrator));
    }
    let mut sppm = small(IntegratorKind::Sppm);
    sppm.sppm.direct = DirectLight::Photons;
    assert_same_bytes("sppm, direct light by photons", &sppm);
}

#[test]
fn exr_bytes_of_each_technique_of_vcm_do_not_depend_on_threads() {
    for techniques in
        [VcmTechniques::Bdpt, VcmTechniques::LightTracing, VcmTechniques::Bpm, VcmTechniques::Ppm]
    {
        let mut desc = small(IntegratorKind::Vcm);
        desc.vcm.techniques = techniques;
        assert_same_bytes(&format!("{techniques:?}"), &desc);
    }
}
