//! Lights over a plane: direct light of both integrators, and the flux of photons through a disc, against closed forms.

use std::f64::consts::PI;

use nephroid::desc::{Light, LightKind, Object, PointAmount};
use nephroid::{Layer, SceneDesc};
use testkit::Moments;
use transport::PhotonPaths;

use crate::support::*;

const ALBEDO: f64 = 0.5;
/// Radius of the disc of the photon tests.
const DISC: f64 = 1.0;

struct Case {
    name: &'static str,
    light: Source,
    /// Irradiance at the origin, W/m².
    irradiance: f64,
    /// Flux through the disc of radius [`DISC`] about the origin, W.
    flux: f64,
}

enum Source {
    Light(LightKind),
    Lamp(Box<Object>),
}

fn cases() -> Vec<Case> {
    let (h, a) = (1.25f64, DISC);
    let position = [0.0, h as f32, 0.0];
    let amount = PointAmount::Intensity([2.0; 3]);
    // A cone seen from its apex.
    let through_disc = 2.0 * PI * (1.0 - h / h.hypot(a));
    let spot = |cone_angle, falloff_angle| LightKind::Spot {
        position,
        direction: [0.0, -1.0, 0.0],
        cone_angle,
        falloff_angle,
        amount,
    };
    // Parallel coaxial discs: F = (x − √(x² − 4(a/b)²))/2, x = 1 + (1 + (a/h)²)/(b/h)² (view-factor tables).
    let b = 0.6f64;
    let x = 1.0 + (1.0 + (a / h).powi(2)) / (b / h).powi(2);
    let discs = 0.5 * (x - (x * x - 4.0 * (a / b).powi(2)).sqrt());
    let r = 0.4f64;
    vec![
        Case {
            name: "point",
            light: Source::Light(LightKind::Point { position, amount }),
            irradiance: 2.0 / (h * h),
            flux: 2.0 * through_disc,
        },
        Case {
            name: "spot",
            light: Source::Light(spot(50.0, 5.0)),
            irradiance: 2.0 / (h * h),
            flux: 2.0 * through_disc,
        },
        Case {
            name: "directional, 60° off the normal",
            light: Source::Light(LightKind::Directional {
                direction: [3f32.sqrt(), -1.0, 0.0],
                irradiance: [3.0; 3],
            }),
            irradiance: 1.5,
            flux: 1.5 * PI * a * a,
        },
        Case {
            name: "environment",
            light: Source::Light(LightKind::Environment { radiance: [0.7; 3] }),
            irradiance: 0.7 * PI,
            flux: 0.7 * PI * PI * a * a,
        },
        Case {
            name: "disc",
            light: Source::Lamp(Box::new(lamp(disk(position, [0.0, -1.0, 0.0], b as f32), 1.5))),
            irradiance: 1.5 * PI * b * b / (b * b + h * h),
            flux: 1.5 * PI * PI * b * b * discs,
        },
        Case {
            name: "sphere",
            light: Source::Lamp(Box::new(lamp(sphere(position, r as f32), 1.5))),
            irradiance: 1.5 * PI * (r / h).powi(2),
            flux: 1.5 * PI * 4.0 * PI * r * r * 0.5 * (1.0 - h / h.hypot(a)),
        },
    ]
}

fn scene(case: &Case) -> SceneDesc {
    // A spot of about 1 mm is seen: irradiance is that of the origin within 1e-5.
    let camera = look([2.0, 0.7, 0.5], [0.0; 3], 0.03);
    let mut desc = scene_of(camera, 8, vec![Object::new(ground(0.0, 2.0), grey(ALBEDO as f32))]);
    match &case.light {
        Source::Light(kind) => desc.lights.push(Light::from(kind.clone()).into()),
        Source::Lamp(object) => desc.objects.push((**object).clone().into()),
    }
    desc
}

#[test]
fn direct_light_over_a_plane_by_path() {
    direct(PATH);
}

#[test]
fn direct_light_over_a_plane_by_photon_map() {
    direct(PHOTON_MAP);
}

fn direct(integrator: nephroid::desc::IntegratorKind) {
    for case in cases() {
        let mut desc = scene(&case);
        desc.render.max_depth = Some(1);
        let m = Moments::of(runs(&desc, integrator, 16, 24, |film| mean(film, Layer::Direct)));
        // 1e-4 for the width of what is seen, and for rounding.
        assert_mean(case.name, &m, ALBEDO / PI * case.irradiance, 1e-4);
    }
}

/// Photons are counted by all that were emitted: most of them miss the disc, and many the plane.
#[test]
fn photons_bring_the_flux_of_every_light() {
    for case in cases() {
        let scene = compiled(&scene(&case));
        let near = |p: &photons::Photon| p.normal.y > 0.0 && p.position.length() < DISC as f32;
        let m = flux(&scene, PhotonPaths::Global, 200_000, 24, 1, near);
        assert_mean(case.name, &m, case.flux, 1e-4);
    }
}
