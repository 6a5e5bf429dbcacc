//! Same scene, same seed: the same bytes, on any number of threads.

use film::{ExrOptions, encode_exr};
use nephroid::desc::{IntegratorKind, Render};
use nephroid::{Control, Job, Session, compile, load};

use crate::support::{PATH, PHOTON_MAP, root};

fn exr(integrator: IntegratorKind, seed: u64, threads: usize, passes: std::ops::Range<u64>) -> Vec<u8> {
    let mut desc = load(&root().join("scenes/arena/box-spheres.toml"), &[]).desc.unwrap();
    desc.film.size = [40, 24];
    desc.render = Render { integrator, seed, ..desc.render };
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

#[test]
fn exr_bytes_do_not_depend_on_threads_and_replay() {
    for integrator in [PATH, PHOTON_MAP, IntegratorKind::Sppm, IntegratorKind::Auto] {
        let one = exr(integrator, 5, 1, 0..2);
        for threads in [2, 3, 7, 1] {
            assert!(one == exr(integrator, 5, threads, 0..2), "{integrator:?} on {threads} threads");
        }
        assert!(one != exr(integrator, 6, 2, 0..2), "{integrator:?}: the seed counts");
        assert!(one != exr(integrator, 5, 2, 1..3), "{integrator:?}: the pass counts");
    }
}
