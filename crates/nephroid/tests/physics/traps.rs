//! One test for each classic mistake in density estimation and light tracing that has no better home here. The unit tests of
//! `photons` guard the estimator alone; these go through scenes and tracing.

use std::f64::consts::PI;

use bsdf::{Lobes, TransportMode};
use math::{Ray, Vec3};
use nephroid::desc::{Light, LightKind, Material, Object, PointAmount, Shape, Triple};
use nephroid::{Lanes, Layer, Scene, SceneDesc};
use photons::{Kernel, PhotonMap, Query, Scratch};
use sampling::{Domain, Sampler};
use testkit::Moments;
use transport::{Lookup, PhotonPaths, Vertex, Walk, emit, merge};

use crate::support::*;

fn lights(mut desc: SceneDesc, kinds: Vec<LightKind>) -> SceneDesc {
    desc.lights.extend(kinds.into_iter().map(|l| Light::from(l).into()));
    desc
}

fn from_above(objects: Vec<Object>) -> SceneDesc {
    scene_of(look([0.0, 3.0, 0.0], [0.0; 3], 20.0), 8, objects)
}

/// What a ray from `origin` toward `target` meets.
fn vertex(scene: &Scene, origin: Triple, target: Triple) -> Vertex {
    let (origin, target) = (Vec3::from(origin), Vec3::from(target));
    let ray = Ray::new(origin, (target - origin).normalize());
    Walk::new(scene, TransportMode::Radiance, ray, Lanes::ONE, scene.camera_medium(ray.origin))
        .next_vertex()
        .unwrap()
}

/// A diffuse floor of albedo 0.8 under sunlight of 1 W/m² that comes 60° off the normal: radiance 0.8/π·cos 60°.
fn slanted_sun() -> (SceneDesc, f64) {
    let sun = LightKind::Directional { direction: [3f32.sqrt(), -1.0, 0.0], irradiance: [1.0; 3] };
    (lights(from_above(vec![Object::new(ground(0.0, 1.0), grey(0.8))]), vec![sun]), 0.8 / PI * 0.5)
}

/// Points of the floor away from its border.
fn grid() -> impl Iterator<Item = Triple> {
    (0..900).map(|i| [-0.6 + 0.041 * (i % 30) as f32, 0.0, -0.6 + 0.041 * (i / 30) as f32])
}

fn merged(scene: &Scene, map: &PhotonMap, lookup: &Lookup) -> f64 {
    let mut scratch = Scratch::new();
    let all = Moments::of(grid().map(|p| {
        let vertex = vertex(scene, [0.0, 3.0, 0.0], p);
        f64::from(merge(map, &vertex, lookup, &mut scratch).radiance.mean())
    }));
    all.mean
}

#[test]
fn trap_double_cosine() {
    let (desc, expected) = slanted_sun();
    let scene = compiled(&desc);
    let lookup = Lookup { knn: 1 << 20, max_radius: 0.15, kernel: Kernel::Epanechnikov };
    let m = Moments::of(
        (0..40).map(|seed| merged(&scene, &map(&scene, PhotonPaths::Global, 30_000, seed, 1), &lookup)),
    );
    assert_mean("flux has the cosine already", &m, expected, 0.0);
    // With the cosine of the rendering equation on top, half of it is left.
    assert!(p_value(&m, expected * 0.5, 0.0) < LEVEL);
}

#[test]
fn trap_the_kth_photon_of_k_is_not_counted() {
    let (desc, expected) = slanted_sun();
    let scene = compiled(&desc);
    for k in [5, 50] {
        let lookup = Lookup { knn: k, max_radius: 10.0, kernel: Kernel::Constant };
        let m = Moments::of(
            (0..40).map(|seed| merged(&scene, &map(&scene, PhotonPaths::Global, 30_000, seed, 1), &lookup)),
        );
        assert_mean(&format!("{k} neighbours"), &m, expected, 0.0);
        let trap = k as f64 / (k as f64 - 1.0);
        assert!(p_value(&m, expected * trap, 0.0) < LEVEL, "k/(k − 1) would be seen");
    }
}

/// One photon in about 68 is stored, and all that is stored is normalised by what was emitted.
#[test]
fn trap_powers_are_over_emitted_photons_not_over_stored_ones() {
    let amount = PointAmount::Intensity([1.0; 3]);
    let coin = Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], 0.5), grey(0.5));
    let desc = lights(from_above(vec![coin]), vec![LightKind::Point { position: [0.0, 2.0, 0.0], amount }]);
    let scene = compiled(&desc);
    let m = flux(&scene, PhotonPaths::Global, 400_000, 24, 1, |_| true);
    let expected = 2.0 * PI * (1.0 - 2.0 / 2f64.hypot(0.5));
    assert_mean("coin", &m, expected, 0.0);
    let stored = photons(&scene, PhotonPaths::Global, 400_000, 0, 1).photons.len() as f64;
    assert!((stored / 400_000.0 - expected / (4.0 * PI)).abs() < 1e-3);
}

/// "Until enough photons are stored" would never end here.
#[test]
fn trap_a_scene_that_stores_nothing_ends() {
    let objects = vec![
        Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], 1.0), Material::mirror(0.9)),
        Object::new(sphere([0.5, 0.5, 0.0], 0.3), Material::dielectric(1.5)),
        lamp(disk([0.0, 5.0, 0.0], DOWN, 4.0), 2.0),
    ];
    let desc = from_above(objects);
    let scene = compiled(&desc);
    for paths in [PhotonPaths::Global, PhotonPaths::Indirect, PhotonPaths::Caustic] {
        let batch = photons(&scene, paths, 10_000, 0, u32::MAX);
        assert!(batch.photons.is_empty() && batch.balance.emitted > 0.0);
    }
    let (path, map) = (brightness(&desc, PATH, 16, 40), brightness(&desc, PHOTON_MAP, 16, 20));
    assert_same("mirrors and glass only", &map, &path, 0.0);
}

const DOWN: Triple = [0.0, -1.0, 0.0];

/// A closed room with a partition without thickness, light on one side only: the other side is black.
#[test]
fn trap_light_does_not_pass_a_wall_without_thickness() {
    let room =
        Object { flip_normals: true, ..Object::new(Shape::Box { min: [-1.0; 3], max: [1.0; 3] }, grey(0.7)) };
    let partition = Object::new(
        Shape::Quad { origin: [0.0, -1.0, -1.0], edge_u: [0.0, 2.0, 0.0], edge_v: [0.0, 0.0, 2.0] },
        grey(0.7),
    );
    let bulb = lamp(disk([0.5, 0.99, 0.0], DOWN, 0.3), 10.0);
    // Frontal views of the partition from both sides; 1.8 of its 2 units of width, 0.9 away.
    let view = |x: f32| look([x, 0.0, 0.0], [0.0; 3], 90.0);
    for final_gather in [0, 8] {
        let mut desc = scene_of(view(0.9), 32, vec![room.clone(), partition.clone(), bulb.clone()]);
        desc.photon_map.photons = 50_000;
        desc.photon_map.final_gather = final_gather;
        let lit = film(&desc, &compiled(&desc), PHOTON_MAP, 1, 1).beauty();
        desc.camera = Some(view(-0.9).into());
        let dark = film(&desc, &compiled(&desc), PHOTON_MAP, 1, 1).beauty();
        let lit_mean = lit.iter().map(|p| f64::from(p[0])).sum::<f64>() / lit.len() as f64;
        let dark_mean = dark.iter().map(|p| f64::from(p[0])).sum::<f64>() / dark.len() as f64;
        assert!(lit_mean > 0.1);
        // Gather rays see the dark floor at the wall's foot, where the maps of the lit floor reach through.
        let bar = if final_gather == 0 { 0.0 } else { 0.01 };
        assert!(dark_mean <= bar * lit_mean, "{final_gather} rays: {dark_mean} of {lit_mean}");
    }
    // The check can fail: a partition that ends short of the wall lets light round it.
    let short = Object::new(
        Shape::Quad { origin: [0.0, -1.0, -1.0], edge_u: [0.0, 2.0, 0.0], edge_v: [0.0, 0.0, 1.9] },
        grey(0.7),
    );
    let leaky = scene_of(view(-0.9), 32, vec![room, short, bulb]);
    let seen = film(&leaky, &compiled(&leaky), PHOTON_MAP, 1, 1).beauty();
    assert!(seen.iter().any(|p| p[0] > 0.01));
}

/// Light straight down along a wall leaves the wall dark, right up to the lit floor.
#[test]
fn trap_photons_round_a_corner_do_not_count() {
    let wall = Shape::Quad { origin: [1.0, 0.0, -1.0], edge_u: [0.0, 0.0, 2.0], edge_v: [0.0, 1.0, 0.0] };
    let objects = vec![Object::new(ground(0.0, 1.0), grey(0.8)), Object::new(wall, grey(0.8))];
    let sun = LightKind::Directional { direction: DOWN, irradiance: [1.0; 3] };
    let scene = compiled(&lights(from_above(objects), vec![sun]));
    let map = map(&scene, PhotonPaths::Global, 100_000, 0, 1);
    let mut scratch = Scratch::new();
    for knn in [50, 1 << 20] {
        let lookup = Lookup { knn, max_radius: 0.2, kernel: Kernel::Constant };
        for height in [1e-4, 1e-3, 0.01, 0.05] {
            let seen = vertex(&scene, [-0.5, 0.5, 0.1], [1.0, height, 0.1]);
            assert!(seen.hit.ng.x.abs() > 0.99, "the wall is met");
            assert_eq!(merge(&map, &seen, &lookup, &mut scratch).count, 0, "at height {height}");
            // There were photons to be mistaken for the wall's.
            let normal = Vec3::Y;
            let floor =
                Query { position: Vec3::new(1.0, 0.0, 0.1), normal, radius: 0.2, kernel: Kernel::Constant };
            assert!(map.gather(&floor, |_, _| ()) > 100);
        }
    }
}

/// Veach's adjoint factor (1997, eq. 5.19). Light is scattered by a smooth-shaded icosahedron to a square of the floor; the flux
/// of photons there is what path tracing sees from above. Without the factor it is not.
#[test]
fn trap_shading_normals_need_the_adjoint_factor_on_light_paths() {
    let ball = Shape::Icosphere { center: [0.0, 0.5, 0.0], radius: 0.5, level: 1, smooth: true };
    let objects = vec![
        Object::new(ball, grey(0.9)),
        Object::new(disk([0.0, -0.3, 0.0], [0.0, 1.0, 0.0], 3.0), grey(0.5)),
    ];
    // The picture is the square of side 0.8 about (1.1, −0.3, 0), seen from 1 above.
    let middle = [1.1f32, -0.3, 0.0];
    let camera = look([1.1, 0.7, 0.0], middle, 2.0 * 0.4f32.atan().to_degrees());
    let spot = LightKind::Spot {
        position: [2.5, 1.5, 0.5],
        direction: [-2.5, -1.0, -0.5],
        cone_angle: 10.0,
        falloff_angle: 0.0,
        amount: PointAmount::Intensity([5.0; 3]),
    };
    let mut desc = lights(scene_of(camera, 16, objects), vec![spot]);
    desc.render.max_depth = Some(2);
    let radiance = Moments::of(runs(&desc, PATH, 16, 320, |film| mean(film, Layer::Indirect)));
    let scene = compiled(&desc);
    let in_square =
        |p: Vec3| (p.x - middle[0]).abs() < 0.4 && p.z.abs() < 0.4 && (p.y - middle[1]).abs() < 1e-3;
    // L = ρ/π · Φ/A.
    let per_flux = 0.5 / PI / 0.64;
    let scaled = |m: Moments| Moments { mean: m.mean * per_flux, m2: m.m2 * per_flux * per_flux, ..m };
    let right = flux(&scene, PhotonPaths::Indirect, 300_000, 16, 2, |p| in_square(p.position));
    let right = scaled(right);
    // The same photons without it.
    let without = Moments::of((0..16).map(|seed| {
        let traced = (0..150_000).filter_map(|path| {
            let mut s = Sampler::new(seed, 0, Domain::GlobalPhoton, path);
            let mut walk = emit(&scene, &mut s)?.walk;
            let v = walk.next_vertex()?;
            let sample =
                v.bsdf.sample_lobes(v.wo, Lobes::ALL, s.next_1d(), s.next_2d(), TransportMode::Importance)?;
            let hit = scene.intersect(&v.hit.spawn_ray(sample.wi))?;
            in_square(hit.p).then(|| f64::from((walk.throughput * sample.weight).mean()))
        });
        traced.sum::<f64>() / 150_000.0
    }));
    let without = scaled(without);
    let p = testkit::welch_p_value(&right, &radiance).unwrap();
    assert!(p >= LEVEL, "with the factor: {right:?}, {radiance:?}, p = {p}");
    let p = testkit::welch_p_value(&without, &radiance).unwrap();
    assert!(p < LEVEL, "the factor matters: {without:?}, {radiance:?}, p = {p}");
}

/// Radiance grows by η² where it enters a denser medium, flux does not: under water, over a white floor, in a sky of radiance 1,
/// everything looks as bright as the sky. (η² = 1.77 once too often or too seldom.)
#[test]
fn trap_radiance_scales_by_eta_squared_and_flux_does_not() {
    let water =
        Object::new(Shape::Box { min: [-4.2, -0.2, -4.2], max: [4.2, 0.5, 4.2] }, Material::dielectric(1.33));
    let floor = Object::new(ground(0.0, 4.0), grey(1.0));
    let mut desc = scene_of(look([0.4, 3.0, 0.6], [0.0; 3], 60.0), 8, vec![water, floor]);
    desc.photon_map.photons = 100_000;
    desc.photon_map.caustic_photons = 100_000;
    let desc = lights(desc, vec![LightKind::Environment { radiance: [1.0; 3] }]);
    assert_mean("path", &brightness(&desc, PATH, 16, 48), 1.0, 0.0);
    assert_mean("photon_map", &brightness(&desc, PHOTON_MAP, 32, 4), 1.0, 0.005);
}

/// Smooth normals that differ from the faces' own, seen by the eye: `photon_map` and `path` agree on what is lit.
#[test]
fn smooth_meshes_look_the_same_in_both_integrators() {
    let ball = Shape::Icosphere { center: [0.0, 0.5, 0.0], radius: 0.5, level: 1, smooth: true };
    let objects = vec![
        Object::new(ball, grey(0.8)),
        Object::new(ground(0.0, 2.0), grey(0.8)),
        lamp(disk([1.0, 2.5, 1.0], [-0.3, -1.0, -0.3], 0.5), 5.0),
    ];
    let mut desc = scene_of(look([0.0, 0.6, 2.5], [0.0, 0.5, 0.0], 24.0), 16, objects);
    // Small radii: the maps blur across the ball, which is 0.5 wide.
    desc.photon_map.photons = 100_000;
    desc.photon_map.knn = 30;
    let (path, map) = (brightness(&desc, PATH, 16, 96), brightness(&desc, PHOTON_MAP, 16, 32));
    assert_same("smooth mesh", &map, &path, 0.005);
}
