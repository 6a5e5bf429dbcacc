//! Where the energy of photons goes.

use std::f64::consts::PI;

use nephroid::SceneDesc;
use nephroid::desc::{Dielectric, Light, LightKind, Material, Metal, Object, PointAmount, Shape};
use testkit::Moments;
use transport::{PhotonBalance, PhotonPaths};

use crate::support::*;

/// A box with an open front, with things of every material in it.
fn zoo() -> SceneDesc {
    let ball = |x: f32, y: f32, m: Material| Object::new(sphere([x, y, 0.0], 0.3), m);
    let metal = Metal::Index { n: [0.2, 0.9, 1.1], k: [3.0, 2.5, 2.0] };
    let tinted = Dielectric { color: [0.9, 0.95, 1.0].into(), ..Dielectric::default() };
    let walls = [
        ground(-1.0, 1.0),
        Shape::Quad { origin: [-1.0, -1.0, -1.0], edge_u: [2.0, 0.0, 0.0], edge_v: [0.0, 2.0, 0.0] },
        Shape::Quad { origin: [-1.0, -1.0, 1.0], edge_u: [0.0, 0.0, -2.0], edge_v: [0.0, 2.0, 0.0] },
    ];
    let mut objects: Vec<Object> =
        walls.into_iter().map(|w| Object::new(w, Material::diffuse([0.7, 0.5, 0.3]))).collect();
    objects.extend([
        ball(-0.6, -0.6, Material::dielectric(1.5)),
        ball(0.1, -0.6, tinted.into()),
        ball(0.7, -0.6, Material::conductor(metal.clone(), 0.0)),
        ball(-0.6, 0.1, Material::conductor(metal, 0.5)),
        ball(0.1, 0.1, Material::phong([0.3, 0.2, 0.1], [0.5, 0.6, 0.4], 12.0)),
        ball(0.7, 0.1, Material::plastic([0.6, 0.2, 0.5], 0.0)),
        ball(-0.6, 0.7, Material::plastic([0.6, 0.2, 0.5], 0.4)),
        Object::new(
            Shape::Icosphere { center: [0.1, 0.7, 0.0], radius: 0.25, level: 1, smooth: true },
            grey(0.8),
        ),
        lamp(disk([0.7, 0.95, 0.0], [0.0, -1.0, 0.0], 0.2), 8.0),
    ]);
    let mut desc = scene_of(look([0.0, 0.0, 4.0], [0.0; 3], 40.0), 8, objects);
    let amount = PointAmount::Intensity([1.0, 2.0, 0.5]);
    desc.lights.push(Light::from(LightKind::Point { position: [0.5, 0.45, 0.6], amount }).into());
    desc.lights.push(
        Light::from(LightKind::Directional { direction: [-1.0, -0.5, -2.0], irradiance: [0.5; 3] }).into(),
    );
    desc
}

fn balances(desc: &SceneDesc, paths: PhotonPaths, count: u64, depth: u32) -> Vec<PhotonBalance> {
    let scene = compiled(desc);
    (0..24).map(|seed| photons(&scene, paths, count, seed, depth).balance).collect()
}

fn moments(balances: &[PhotonBalance], f: impl Fn(&PhotonBalance) -> f64) -> Moments {
    Moments::of(balances.iter().map(f))
}

#[test]
fn a_photon_pass_accounts_for_all_that_was_emitted() {
    for (paths, depth) in [
        (PhotonPaths::Global, u32::MAX),
        (PhotonPaths::Global, 3),
        (PhotonPaths::Indirect, u32::MAX),
        (PhotonPaths::Caustic, u32::MAX),
        (PhotonPaths::Caustic, 4),
    ] {
        let balances = balances(&zoo(), paths, 20_000, depth);
        // Roulette takes from some what it gives to others: in expectation nothing.
        let roulette = moments(&balances, |b| b.roulette);
        let p = p_value(&roulette, 0.0, 0.0);
        assert!(p >= LEVEL, "{paths:?} to depth {depth}: roulette takes {roulette:?}, p = {p:.1e}");
        // All else, against what was emitted: within its own standard error, and 2 % would be seen.
        let rest = moments(&balances, |b| b.absorbed + b.escaped + b.cut);
        let emitted = moments(&balances, |b| b.emitted);
        assert_same(&format!("{paths:?} to depth {depth}"), &rest, &emitted, 0.0);
        // With the roulette's account, to rounding.
        for b in &balances {
            let gap = b.emitted - (b.absorbed + b.escaped + b.roulette + b.cut);
            assert!(gap.abs() < 1e-6 * b.emitted, "{b:?}");
            assert!(b.absorbed > 0.0 && b.escaped > 0.0);
            assert_eq!(b.cut > 0.0, depth < u32::MAX || paths == PhotonPaths::Caustic);
        }
    }
}

#[test]
fn photons_leave_with_the_power_of_the_scene() {
    let desc = zoo();
    let power = f64::from(compiled(&desc).power().mean());
    let emitted = moments(&balances(&desc, PhotonPaths::Global, 20_000, 1), |b| b.emitted);
    // Directional light is measured through the bounds of the scene: rounding.
    assert_mean("emitted", &emitted, power, 1e-4);
}

/// Aimed at a sphere from a point within sight: what the sphere's cone takes of it.
#[test]
fn aimed_photons_leave_with_the_power_that_meets_the_target() {
    let objects = vec![Object::new(sphere([0.0; 3], 0.5), Material::dielectric(1.5))];
    let mut desc = scene_of(look([0.0, 0.0, 4.0], [0.0; 3], 40.0), 8, objects);
    let amount = PointAmount::Intensity([3.0; 3]);
    desc.lights.push(Light::from(LightKind::Point { position: [0.0, 2.0, 0.0], amount }).into());
    let emitted = moments(&balances(&desc, PhotonPaths::Caustic, 2_000, u32::MAX), |b| b.emitted);
    let cone = 2.0 * PI * (1.0 - (1.0f64 - 0.0625).sqrt());
    // Targets grow by 10⁻⁴ of their radius.
    assert_mean("aimed", &emitted, 3.0 * cone, 5e-4);
}

/// In a closed room of albedo ρ without roulette's help: P is absorbed, and P(1 + ρ + ρ² + …) is received.
#[test]
fn a_closed_room_receives_the_geometric_series_and_absorbs_the_power() {
    let room = Shape::Box { min: [-1.0; 3], max: [1.0; 3] };
    for (material, albedo) in [(grey(0.6), 0.6f64), (grey(0.25), 0.25)] {
        let objects = vec![
            Object { flip_normals: true, ..Object::new(room.clone(), material) },
            Object::new(sphere([0.3, -0.4, 0.2], 0.4), Material::dielectric(1.5)),
            Object::new(sphere([-0.5, -0.4, 0.2], 0.3), Material::mirror(1.0)),
        ];
        let mut desc = scene_of(look([0.0, 0.0, 0.9], [0.0; 3], 60.0), 8, objects);
        let amount = PointAmount::Intensity([1.0; 3]);
        desc.lights.push(Light::from(LightKind::Point { position: [0.1, 0.7, 0.1], amount }).into());
        let scene = compiled(&desc);
        let batches: Vec<_> =
            (0..24).map(|seed| photons(&scene, PhotonPaths::Global, 10_000, seed, u32::MAX)).collect();
        let received = Moments::of(
            batches.iter().map(|b| b.photons.iter().map(|p| f64::from(p.power.mean())).sum::<f64>()),
        );
        assert_mean("received", &received, 4.0 * PI / (1.0 - albedo), 0.0);
        let absorbed = Moments::of(batches.iter().map(|b| b.balance.absorbed));
        assert_mean("absorbed", &absorbed, 4.0 * PI, 0.0);
        assert!(batches.iter().all(|b| b.balance.escaped == 0.0), "the room is tight");
    }
}
