//! Caustics of every light, with their full energy.

use nephroid::desc::{Light, LightKind, Material, Metal, Object, PointAmount, Triple};
use nephroid::{Layer, SceneDesc};
use testkit::Moments;
use transport::PhotonPaths;

use crate::oracle::{GlassSphere, Source};
use crate::support::*;

const SPHERE: GlassSphere = GlassSphere { center: 1.0, radius: 0.3, index: 1.5, floor_radius: 1.5 };

/// A glass sphere over a round floor, both about the axis x = `x`, z = 0.
fn on_axis(x: f32, s: &GlassSphere) -> [Object; 2] {
    [
        Object::new(sphere([x, s.center as f32, 0.0], s.radius as f32), Material::dielectric(s.index as f32)),
        Object::new(disk([x, 0.0, 0.0], [0.0, 1.0, 0.0], s.floor_radius as f32), grey(0.5)),
    ]
}

fn lit(s: &GlassSphere, lights: Vec<LightKind>) -> SceneDesc {
    // From the side, at the floor about the axis.
    let mut desc = scene_of(look([2.0, 1.2, 2.0], [0.0, 0.1, 0.0], 20.0), 24, on_axis(0.0, s).into());
    desc.lights.extend(lights.into_iter().map(|l| Light::from(l).into()));
    desc
}

fn point(position: Triple, intensity: Triple) -> LightKind {
    LightKind::Point { position, amount: PointAmount::Intensity(intensity) }
}

const DOWN: Triple = [0.0, -1.0, 0.0];

#[test]
fn trap_point_spot_and_directional_lights_cast_caustics() {
    let position = [0.0, 2.5, 0.0];
    let amount = PointAmount::Intensity([2.0; 3]);
    let spot = LightKind::Spot { position, direction: DOWN, cone_angle: 25.0, falloff_angle: 5.0, amount };
    let from_point = 2.0 * SPHERE.flux(Source::Point(2.5))[0];
    let parallel = SPHERE.flux(Source::Parallel)[0];
    for (name, light, expected) in [
        ("point", point(position, [2.0; 3]), from_point),
        // The sphere fills less than the inner cone.
        ("spot", spot, from_point),
        ("directional", LightKind::Directional { direction: DOWN, irradiance: [1.0; 3] }, parallel),
    ] {
        let scene = compiled(&lit(&SPHERE, vec![light]));
        let m = flux(&scene, PhotonPaths::Caustic, 8_000, 24, u32::MAX, |_| true);
        assert_mean(name, &m, expected, 5e-4);
        // Unaimed photons bring as much, with more noise.
        let caustic = |p: &photons::Photon| p.flags.contains(photons::PhotonFlags::CAUSTIC);
        let unaimed = flux(&scene, PhotonPaths::Global, 200_000, 3, u32::MAX, caustic);
        assert!((unaimed.mean / expected - 1.0).abs() < 0.05, "{name}: {unaimed:?}, expected {expected}");
    }
}

/// A small lamp is the limit of a point; of the environment, path tracing says how bright its caustic is.
#[test]
fn trap_lamps_and_environments_cast_caustics() {
    let r = 0.002f32;
    let mut tiny = lit(&SPHERE, vec![]);
    tiny.objects.push(lamp(sphere([0.0, 2.5, 0.0], r), 2.0 / (std::f32::consts::PI * r * r)).into());
    let m = flux(&compiled(&tiny), PhotonPaths::Caustic, 30_000, 24, u32::MAX, |_| true);
    assert_mean("tiny lamp", &m, 2.0 * SPHERE.flux(Source::Point(2.5))[0], 1e-3);

    let mut sky = lit(&SPHERE, vec![LightKind::Environment { radiance: [1.0; 3] }]);
    sky.photon_map.caustic_photons = 200_000;
    sky.photon_map.photons = 1;
    sky.photon_map.final_gather = 1;
    let caustic =
        |integrator, n, passes| Moments::of(runs(&sky, integrator, n, passes, |f| mean(f, Layer::Caustic)));
    // Blur carries light out of the picture.
    assert_same("environment", &caustic(PHOTON_MAP, 24, 2), &caustic(PATH, 24, 500), 0.001);
}

/// A weak blue lamp beside one that is ten thousand times stronger and red: the blue caustic has its energy, and little noise.
#[test]
fn trap_a_strong_light_does_not_starve_the_caustic_of_a_weak_one() {
    let mut desc = lit(&SPHERE, vec![point([0.0, 2.5, 0.0], [0.0, 0.0, 1.0])]);
    desc.objects.extend(on_axis(4.0, &SPHERE).map(Into::into));
    desc.lights.push(Light::from(point([4.0, 2.5, 0.0], [10_000.0, 0.0, 0.0])).into());
    let scene = compiled(&desc);
    let m = Moments::of((0..24).map(|seed| {
        let batch = photons(&scene, PhotonPaths::Caustic, 60_000, seed, u32::MAX);
        // Its own sphere's caustic on its own floor; the far sphere sends next to nothing here.
        let near = batch.photons.iter().filter(|p| p.position.x < 2.0);
        near.map(|p| f64::from(p.power.to_rgb()[2])).sum()
    }));
    let expected = SPHERE.flux(Source::Point(2.5))[0];
    assert_mean("weak lamp", &m, expected, 0.005);
    let noise = m.variance().sqrt() / m.mean;
    assert!(noise < 0.02, "60 000 photons: {noise}");
}

/// A glass bead of 2 cm on a plain of 1 km: nearly all photons meet it.
#[test]
fn trap_the_sun_is_aimed_at_a_tiny_sphere_in_a_big_scene() {
    let bead = GlassSphere { center: 0.05, radius: 0.02, floor_radius: 500.0, ..SPHERE };
    let scene = compiled(&lit(&bead, vec![LightKind::Directional { direction: DOWN, irradiance: [1.0; 3] }]));
    let m = flux(&scene, PhotonPaths::Caustic, 8_000, 24, u32::MAX, |_| true);
    assert_mean("bead", &m, bead.flux(Source::Parallel)[0], 1e-3);
    let stored = photons(&scene, PhotonPaths::Caustic, 8_000, 1, u32::MAX).photons.len();
    assert!(stored > 6_000, "{stored} of 8000 photons");
    // Unaimed, one in 10⁹ would.
    let unaimed = photons(&scene, PhotonPaths::Global, 8_000, 1, u32::MAX);
    assert!(unaimed.photons.iter().all(|p| !p.flags.contains(photons::PhotonFlags::CAUSTIC)));
}

/// A metal disc throws its light to the ceiling alike at roughness 0 and at every small one: what is delta, and what stores
/// photons, is decided by the kind of lobe and of material.
#[test]
fn trap_delta_is_a_property_of_the_lobe_not_of_a_roughness_threshold() {
    let thrown = |roughness: f32| {
        let metal = Metal::Index { n: [0.2; 3], k: [3.0; 3] };
        let objects = vec![
            Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], 0.5), Material::conductor(metal, roughness)),
            Object::new(disk([2.0, 2.0, 0.0], DOWN, 40.0), grey(0.5)),
        ];
        let mut desc = scene_of(look([2.0, 1.0, 2.0], [0.0; 3], 20.0), 8, objects);
        // Below the ceiling, and narrow: all of it meets the disc.
        let amount = PointAmount::Intensity([1.0; 3]);
        let spot = LightKind::Spot {
            position: [-1.0, 1.0, 0.0],
            direction: [1.0, -1.0, 0.0],
            cone_angle: 8.0,
            falloff_angle: 0.0,
            amount,
        };
        desc.lights.push(Light::from(spot).into());
        flux(&compiled(&desc), PhotonPaths::Caustic, 8_000, 24, u32::MAX, |_| true)
    };
    // Solid angle of the cone, times the reflectance at about 45°: the smooth one must have it.
    let smooth = thrown(0.0);
    let cone = 2.0 * std::f64::consts::PI * (1.0 - 8f64.to_radians().cos());
    assert_mean("smooth", &smooth, cone * conductor_reflectance(0.2, 3.0, 45f64.to_radians()), 2e-3);
    // α = roughness²: 10⁻⁶, 10⁻⁴, 10⁻², 0.05.
    for roughness in [1e-3, 1e-2, 0.1, 0.2236] {
        assert_same(&format!("roughness {roughness}"), &thrown(roughness), &smooth, 0.005);
    }
}

/// Unpolarised reflectance of a metal n + ik in vacuum (Born & Wolf 1999, §14.2), by way of the exact complex cosines.
fn conductor_reflectance(n: f64, k: f64, angle: f64) -> f64 {
    let (s, c) = angle.sin_cos();
    // a + ib = √((n + ik)² − sin²).
    let (re, im) = (n * n - k * k - s * s, 2.0 * n * k);
    let m = re.hypot(im);
    let (a, b) = ((0.5 * (m + re)).sqrt(), (0.5 * (m - re)).sqrt());
    let rs = ((a - c).powi(2) + b * b) / ((a + c).powi(2) + b * b);
    let t = s * s / c;
    rs * 0.5 * (1.0 + ((a - t).powi(2) + b * b) / ((a + t).powi(2) + b * b))
}

/// In a sky of radiance 1, over a floor of albedo 1, glass that loses nothing changes nothing: every radiance is 1, exactly,
/// at the very point where the ball touches the floor. Photons that pass the ball's own skin near that point are not the
/// floor's: counting them makes the patch 1.3 to 2 times too bright.
#[test]
fn trap_glass_that_touches_the_floor_leaves_the_contact_patch_right() {
    let floor = Object::new(disk([0.0; 3], [0.0, 1.0, 0.0], 3.0), grey(1.0));
    let ball = Object::new(sphere([0.0, 1.0, 0.0], 1.0), Material::dielectric(1.5));
    for (name, eye, target, fov) in [
        ("beside the ball", [2.2, 0.25, 0.0], [0.15, 0.0, 0.0], 14.0),
        ("through the ball", [0.0, 3.0, 0.5], [0.0, 0.0, 0.0], 16.0),
    ] {
        let mut desc = scene_of(look(eye, target, fov), 8, vec![floor.clone(), ball.clone()]);
        desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
        desc.photon_map.photons = 50_000;
        desc.photon_map.caustic_photons = 100_000;
        assert_mean(&format!("{name}, path"), &brightness(&desc, PATH, 16, 48), 1.0, 0.0);
        let m = brightness(&desc, PHOTON_MAP, 24, 4);
        // 3 % for blur and noise; the mistake makes 30 % and more.
        assert!((m.mean - 1.0).abs() < 0.03 && 3.0 * m.standard_error() < 0.03, "{name}, photon_map: {m:?}");
        assert!(p_value(&m, 1.3, 0.03) < LEVEL);
    }
}
