//! A glass ball that touches the floor.

use nephroid::SceneDesc;
use nephroid::desc::{IntegratorKind, Material, Object, Triple, VcmTechniques};

use crate::support::*;

const DOWN: Triple = [0.0, -1.0, 0.0];

const MERGING: [IntegratorKind; 3] = [IntegratorKind::Auto, IntegratorKind::Sppm, IntegratorKind::Vcm];

/// A glass ball that touches the floor, under a lamp.
fn ball(eye: Triple, target: Triple, fov: f32) -> SceneDesc {
    let objects = vec![
        Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], 3.0), grey(0.6)),
        Object::new(sphere([0.0, 1.0, 0.0], 1.0), Material::dielectric(1.5)),
        lamp(disk([0.8, 4.0, 0.3], DOWN, 0.6), 10.0),
    ];
    scene_of(look(eye, target, fov), 48, objects)
}

/// Seen from the side under the ball's belly, where light tracing finds what shines through it; and the caustic.
#[test]
fn a_ball_on_the_floor_is_as_merging_free_vcm_says() {
    for (name, eye, target, fov) in [
        ("contact patch", [2.2, 0.25, 0.0], [0.1, 0.0, 0.0], 8.0),
        ("contact patch from behind", [-2.2, 0.25, 0.0], [-0.1, 0.0, 0.0], 8.0),
        ("caustic", [-2.5, 0.5, 0.0], [-0.35, 0.0, -0.1], 20.0),
    ] {
        let mut desc = ball(eye, target, fov);
        desc.vcm.techniques = VcmTechniques::Bdpt;
        desc.vcm.light_paths = Some(10_000);
        let expected = brightness(&desc, IntegratorKind::Vcm, 12, 240);
        println!("{name}: bdpt {expected:?} ± {:.5}", expected.standard_error() / expected.mean);
        desc.vcm.techniques = VcmTechniques::Vcm;
        desc.vcm.light_paths = Some(5_000);
        desc.sppm.photons = Some(5_000);
        for integrator in MERGING {
            let found = brightness(
                &desc,
                integrator,
                12,
                if integrator == IntegratorKind::Auto { 1200 } else { 200 },
            );
            println!(
                "{name}: {integrator:?} {:+.3} % ± {:.3} %",
                100.0 * (found.mean / expected.mean - 1.0),
                100.0 * found.standard_error() / found.mean
            );
            let noise = found.standard_error().hypot(expected.standard_error());
            assert!(3.0 * noise < 0.02 * expected.mean, "{name}, {integrator:?}: too noisy");
            assert!(
                (found.mean / expected.mean - 1.0).abs() < 0.03,
                "{name}, {integrator:?}: {found:?} {expected:?}"
            );
        }
    }
}
