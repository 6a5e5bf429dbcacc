//! Stochastic progressive photon mapping: what it must have right beyond what the estimator and the photons have.

use std::f64::consts::PI;

use nephroid::desc::{
    DirectLight, Emission, IntegratorKind, Light, LightKind, Material, Object, PointAmount, Shape, Sppm,
    Triple,
};
use nephroid::{Layer, SceneDesc};
use testkit::Moments;
use transport::PhotonPaths;

use crate::support::*;

const SPPM: IntegratorKind = IntegratorKind::Sppm;
const DIRECT: [DirectLight; 2] = [DirectLight::Sampling, DirectLight::Photons];
const DOWN: Triple = [0.0, -1.0, 0.0];

/// `desc` with so many photons a pass and that radius in all passes.
fn with(desc: &SceneDesc, photons: u64, radius: f32, direct: DirectLight) -> SceneDesc {
    let sppm = Sppm { photons: Some(photons), radius: Some(radius), alpha: 1.0, direct, ..Sppm::default() };
    SceneDesc { sppm, ..desc.clone() }
}

fn inside(albedo: f32) -> SceneDesc {
    scene_of(look([0.2, 0.1, 0.3], [-0.4, 0.3, -1.0], 80.0), 5, vec![furnace(1.0, albedo)])
}

/// Exact at any radius: a cap of chord r has the area πr².
#[test]
fn sphere_furnace_at_two_radii() {
    for (albedo, radius) in [(0.5, 0.15), (0.8, 0.6)] {
        for direct in DIRECT {
            let desc = with(&inside(albedo), 8_000, radius, direct);
            let m = brightness(&desc, SPPM, 24, 1);
            let expected = 1.0 / (1.0 - f64::from(albedo));
            assert_mean(&format!("albedo {albedo}, radius {radius}, {direct:?}"), &m, expected, 0.0);
        }
    }
}

/// Events of both halves of a path are counted: depth d gives 1 + ρ + … + ρᵈ.
#[test]
fn depths_are_partial_sums_of_the_furnace() {
    const ALBEDO: f32 = 0.7;
    for depth in 0..4 {
        for direct in DIRECT {
            let mut desc = with(&inside(ALBEDO), 20_000, 0.4, direct);
            desc.render.max_depth = Some(depth);
            let expected: f64 = (0..=depth as i32).map(|k| f64::from(ALBEDO).powi(k)).sum();
            assert_mean(
                &format!("depth {depth}, {direct:?}"),
                &brightness(&desc, SPPM, 16, 1),
                expected,
                1e-5,
            );
        }
    }
}

fn wall(shape: Shape, albedo: f32) -> Object {
    Object::new(shape, grey(albedo))
}

/// A closed room with a lamp under its ceiling, seen by a camera within.
fn room(balls: impl IntoIterator<Item = Object>) -> SceneDesc {
    let walls = Object {
        flip_normals: true,
        ..wall(Shape::Box { min: [-1.5, -1.0, -1.2], max: [1.5, 1.0, 3.0] }, 0.5)
    };
    let mut objects = vec![walls, lamp(disk([0.0, 0.98, 0.0], DOWN, 0.5), 5.0)];
    objects.extend(balls);
    scene_of(look([0.0, 0.0, 2.9], [0.0, -0.3, 0.0], 60.0), 32, objects)
}

fn ball(x: f32, z: f32, material: Material) -> Object {
    Object::new(sphere([x, -0.6, z], 0.4), material)
}

/// What discs that reach beyond edges may lose.
const BLUR: f64 = 0.004;

#[test]
fn agrees_with_path_in_a_diffuse_room() {
    let desc = room([ball(-0.5, 0.0, grey(0.8)), ball(0.5, 0.5, grey(0.3))]);
    let path = brightness(&desc, PATH, 16, 64);
    for direct in DIRECT {
        let sppm = brightness(&with(&desc, 12_000, 0.02, direct), SPPM, 16, 20);
        assert_same(&format!("{direct:?}"), &sppm, &path, BLUR);
    }
}

/// Coats with and without roughness, rough and smooth metal, glass.
#[test]
fn agrees_with_path_in_a_room_of_all_materials() {
    let gold = |roughness: f32| Material::conductor("gold", roughness);
    let desc = room([
        ball(-1.0, 0.0, Material::plastic(0.6, 0.3)),
        ball(0.0, -0.3, Material::plastic(0.6, 0.0)),
        ball(1.0, 0.0, gold(0.5)),
        ball(-0.5, 0.7, Material::dielectric(1.5)),
        ball(0.5, 0.7, gold(0.0)),
        Object::new(sphere([0.0, 0.0, 0.0], 0.25), Material::phong([0.4, 0.3, 0.2], [0.5; 3], 20.0)),
    ]);
    let path = brightness(&desc, PATH, 16, 96);
    for direct in DIRECT {
        let sppm = brightness(&with(&desc, 10_000, 0.02, direct), SPPM, 16, 28);
        assert_same(&format!("{direct:?}"), &sppm, &path, BLUR);
    }
}

/// Layer by layer: glass over a floor, a lamp that paths find often.
#[test]
fn layers_agree_with_path_under_a_glass_sphere() {
    let objects = vec![
        wall(ground(0.0, 1.0), 0.8),
        Object::new(sphere([0.0, 0.5, 0.0], 0.4), Material::dielectric(1.5)),
        lamp(disk([0.0, 2.5, 0.0], DOWN, 2.0), 1.0),
    ];
    let desc = scene_of(look([0.0, 0.7, 2.0], [0.0, 0.1, 0.0], 22.0), 16, objects);
    let desc = with(&desc, 12_000, 0.02, DirectLight::Sampling);
    let layers = [Layer::Direct, Layer::Caustic];
    let means = |integrator, passes| -> Vec<Moments> {
        let films = runs(&desc, integrator, 16, passes, |film| layers.map(|layer| mean(film, layer)));
        (0..2).map(|i| Moments::of(films.iter().map(|m| m[i]))).collect()
    };
    for (layer, (sppm, path)) in layers.iter().zip(means(SPPM, 240).iter().zip(&means(PATH, 480))) {
        assert_same(&format!("{layer:?}"), sppm, path, 0.003);
    }
}

/// A spot light close over a floor: the estimate's bias is as the square of the radius, so that two radii tell what none
/// would show.
#[test]
fn two_radii_extrapolate_to_none() {
    const HEIGHT: f32 = 0.5;
    let light = LightKind::Spot {
        position: [0.0, HEIGHT, 0.0],
        direction: DOWN,
        cone_angle: 30.0,
        falloff_angle: 0.0,
        amount: PointAmount::Intensity([1.0; 3]),
    };
    let mut desc = scene_of(look([0.0, 0.4, 0.0], [0.0; 3], 4.0), 4, vec![wall(ground(0.0, 4.0), 0.6)]);
    desc.lights.push(Light::from(light).into());
    let path = brightness(&desc, PATH, 2, 2).mean;
    let expected = 0.6 / PI / f64::from(HEIGHT).powi(2);
    assert!((path / expected - 1.0).abs() < 2e-3, "{path} against {expected}");
    let at = |radius: f32| {
        let desc = with(&desc, 40_000, radius, DirectLight::Photons);
        Moments::of(runs(&desc, SPPM, 24, 4, |film| mean(film, Layer::Beauty)))
    };
    let (near, far) = (at(0.06), at(0.12));
    // E falls as 1 − 3/2·(x/h)² about the middle, of which the kernel sees the mean: r²/3.
    let bias = -0.5 * f64::from(0.12 / HEIGHT).powi(2);
    let found = far.mean / path - 1.0;
    assert!((found / bias - 1.0).abs() < 0.25, "bias {found}, expected about {bias}");
    // The same seeds, radii apart: taken as independent, which overstates the error.
    let weights = [4.0 / 3.0, -1.0 / 3f64];
    let m2 = weights[0].powi(2) * near.m2 + weights[1].powi(2) * far.m2;
    let extrapolated = Moments { n: near.n, mean: weights[0] * near.mean + weights[1] * far.mean, m2 };
    // What is left is of the fourth order: 0.1 %.
    assert_mean("extrapolated", &extrapolated, path, 0.002);
    assert!(p_value(&far, path, 0.002 * path) < LEVEL, "one radius alone is told from none");
}

/// The dark side of a wall without thickness is black.
#[test]
fn light_does_not_pass_a_wall_without_thickness() {
    let walls = Object { flip_normals: true, ..wall(Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, 0.7) };
    let partition =
        Shape::Quad { origin: [0.0, -1.0, -1.0], edge_u: [0.0, 2.0, 0.0], edge_v: [0.0, 0.0, 2.0] };
    let objects = vec![walls, wall(partition, 0.7), lamp(disk([0.5, 0.99, 0.0], DOWN, 0.3), 10.0)];
    let view = |x: f32| look([x, 0.0, 0.0], [0.0; 3], 90.0);
    for direct in DIRECT {
        let mut desc = scene_of(view(0.9), 32, objects.clone());
        desc.sppm = Sppm { direct, photons: Some(50_000), ..Sppm::default() };
        let beauty = |desc: &SceneDesc| mean(&film(desc, &compiled(desc), SPPM, 1, 2), Layer::Beauty);
        assert!(beauty(&desc) > 0.1);
        desc.camera = Some(view(-0.9).into());
        assert_eq!(beauty(&desc), 0.0);
    }
}

/// Photons of the mixture bring the flux that unaimed ones bring, whatever the light.
#[test]
fn aimed_photons_leave_energies_as_they_are() {
    let amount = PointAmount::Intensity([1.0; 3]);
    let position = [0.3, 2.0, 0.0];
    let spot = LightKind::Spot { position, direction: DOWN, cone_angle: 40.0, falloff_angle: 10.0, amount };
    let both = Emission { two_sided: true, ..Emission::radiance([1.0; 3]) };
    let back = Object { flip_normals: true, ..lamp(disk(position, [0.0, 1.0, 0.0], 0.5), 1.0) };
    let lamps = [
        ("disk", lamp(disk(position, DOWN, 0.5), 1.0)),
        ("back of a disk", back),
        ("both sides of a disk", Object::lamp(disk(position, DOWN, 0.5), both)),
        ("sphere", lamp(sphere(position, 0.2), 1.0)),
        ("lamp in the glass", lamp(sphere([0.0, 0.6, 0.0], 0.2), 1.0)),
    ];
    let lights = [
        ("point", LightKind::Point { position, amount }),
        ("spot", spot),
        ("directional", LightKind::Directional { direction: [0.5, -1.0, 0.2], irradiance: [1.0; 3] }),
        ("environment", LightKind::Environment { radiance: [1.0; 3] }),
    ];
    let scene = |extra: Option<Object>, light: Option<LightKind>| {
        let mut objects = vec![
            wall(ground(0.0, 2.0), 0.5),
            wall(
                Shape::Quad {
                    origin: [-2.0, 0.0, -2.0],
                    edge_u: [4.0, 0.0, 0.0],
                    edge_v: DOWN.map(|v| -3.0 * v),
                },
                0.5,
            ),
            Object::new(sphere([0.0, 0.6, 0.0], 0.4), Material::dielectric(1.5)),
            Object::new(sphere([1.2, 0.3, 0.5], 0.1), Material::mirror(0.9)),
        ];
        objects.extend(extra);
        let mut desc = scene_of(look([0.0, 2.0, 5.0], [0.0; 3], 40.0), 8, objects);
        desc.lights.extend(light.map(|kind| Light::from(kind).into()));
        compiled(&desc)
    };
    let scenes = lamps
        .into_iter()
        .map(|(name, object)| (name, scene(Some(object), None)))
        .chain(lights.into_iter().map(|(name, light)| (name, scene(None, Some(light)))));
    let mut quieter = 0;
    for (name, scene) in scenes {
        let all = |paths| flux(&scene, paths, 40_000, 16, u32::MAX, |_| true);
        assert_same(name, &all(PhotonPaths::Mixed), &all(PhotonPaths::Global), 0.0);
        let tiny = |paths| {
            let caustic = |p: &photons::Photon| p.flags.contains(photons::PhotonFlags::CAUSTIC);
            flux(&scene, paths, 30_000, 16, u32::MAX, caustic)
        };
        let (mixed, unaimed) = (tiny(PhotonPaths::MixedScattered), tiny(PhotonPaths::Global));
        let p = testkit::welch_p_value(&mixed, &unaimed).unwrap();
        assert!(p >= LEVEL, "caustics of {name}: {mixed:?} against {unaimed:?}, p = {p}");
        quieter += usize::from(mixed.variance() < unaimed.variance());
    }
    assert!(quieter >= 7, "caustics have less noise by {quieter} of 9 lights");
}
