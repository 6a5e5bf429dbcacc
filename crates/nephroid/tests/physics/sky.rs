//! Light from a picture of the sky.

use std::path::Path;

use film::encode_exr_rgb;
use nephroid::SceneDesc;
use nephroid::desc::{IntegratorKind, Light, LightKind, Material, Object, SkyMapping, SunSky, TransformStep};
use transport::PhotonPaths;

use crate::support::*;

/// Adds a sky of `width` × `width`/2 pixels, turned by `degrees` about +y.
fn add_sky(
    desc: &mut SceneDesc,
    name: &str,
    width: usize,
    degrees: f32,
    pixel: impl Fn(usize, usize) -> [f32; 3],
) {
    let pixels: Vec<[f32; 3]> = (0..width * width / 2).map(|i| pixel(i % width, i / width)).collect();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.exr"));
    std::fs::write(&path, encode_exr_rgb(width, width / 2, &pixels, &[]).unwrap()).unwrap();
    let transform = vec![TransformStep::Rotate { axis: [0.0, 1.0, 0.0], degrees }];
    let (source, mapping) = (path.into(), SkyMapping::LatLong);
    desc.lights.push(Light::from(LightKind::Sky { source, mapping, scale: [2.0; 3], transform }).into());
}

#[test]
fn the_middle_is_toward_z_and_the_left_quarter_toward_x() {
    for (toward, degrees, expected) in [
        ([0.0, 0.0, 1.0], 0.0, 7.0),
        ([1.0, 0.0, 0.0], 0.0, 3.0),
        ([-1.0, 0.0, 0.0], 0.0, 11.0),
        ([1.0, 0.0, 0.0], 90.0, 7.0),
        ([0.0, 1.0, 0.0], 0.0, 100.0),
        ([0.0, -1.0, 0.0], 0.0, 7.0),
    ] {
        let mut desc = scene_of(look([0.0; 3], toward, 0.1), 2, vec![]);
        // Columns count up from the left; the topmost row is bright, the lowest even.
        add_sky(&mut desc, "compass", 8, degrees, |x, y| match y {
            0 => [50.0; 3],
            3 => [3.5; 3],
            _ => [x as f32; 3],
        });
        let found = brightness(&desc, PATH, 2, 1).mean;
        assert!((found - expected).abs() < 0.02 * expected, "{toward:?} {degrees}: {found} {expected}");
    }
}

/// A bright patch in a blue sky, by every integrator: it is found by light sampling, by rays and by photons alike.
#[test]
fn a_sky_with_a_bright_patch_agrees_with_path() {
    let ball = |x: f32, material: Material| Object::new(sphere([x, -0.6, 0.0], 0.4), material);
    let objects = vec![
        Object::new(ground(-1.0, 1.5), grey(0.5)),
        ball(-0.9, Material::conductor("gold", 0.5)),
        ball(0.0, grey(0.7)),
        ball(0.9, Material::plastic(0.5, 0.4)),
    ];
    let mut desc = scene_of(look([0.0, 0.4, 2.9], [0.0, -0.6, 0.0], 50.0), 16, objects);
    small_maps(&mut desc);
    add_sky(&mut desc, "patch", 32, 40.0, |x, y| match (x, y) {
        (18, 4) => [200.0, 150.0, 100.0],
        (_, 0..8) => [0.3, 0.5, 1.0],
        _ => [0.0; 3],
    });
    let path = brightness(&desc, PATH, 12, 64);
    for integrator in [PHOTON_MAP, IntegratorKind::Sppm, IntegratorKind::Vcm, IntegratorKind::Auto] {
        let found = brightness(&desc, integrator, 12, 32);
        assert_same_within(integrator.name(), &found, &path, 0.01, 1.05);
    }
}

/// Sun and sky on a glass ball, by every integrator. The sun is wide, so that paths find its caustic.
#[test]
fn sun_and_sky_agree_with_path() {
    let sky = SunSky { sun_direction: [0.6, 1.0, 0.3], sun_angle: 6.0, ..SunSky::default() };
    let ball = |x: f32, material: Material| Object::new(sphere([x, -0.55, 0.0], 0.4), material);
    let objects = vec![
        Object::new(ground(-1.0, 2.0), grey(0.5)),
        ball(-0.6, Material::dielectric(1.5)),
        ball(0.6, Material::conductor("gold", 0.4)),
    ];
    let mut desc = scene_of(look([0.0, 1.6, 2.2], [0.0, -0.9, 0.0], 40.0), 16, objects);
    small_maps(&mut desc);
    desc.lights.push(Light::from(LightKind::SunSky(sky)).into());
    let path = brightness(&desc, PATH, 8, 120);
    for integrator in [PHOTON_MAP, IntegratorKind::Sppm, IntegratorKind::Vcm, IntegratorKind::Auto] {
        let found = brightness(&desc, integrator, 12, 24);
        assert_same_within(integrator.name(), &found, &path, 0.012, 1.08);
    }
}

/// The ball's caustic of the real sun holds the flux that the ball lets through, whichever way photons are drawn.
#[test]
fn the_sun_shines_through_a_ball() {
    let sky = SunSky { sun_direction: [0.0, 1.0, 0.0], sky_scale: 0.0, ..SunSky::default() };
    let objects = vec![
        Object::new(ground(-1.0, 2.0), grey(0.5)),
        Object::new(sphere([0.0, -0.2, 0.0], 0.4), Material::dielectric(1.5)),
    ];
    let mut desc = scene_of(look([0.0, 3.0, 0.1], [0.0, -1.0, 0.0], 40.0), 16, objects);
    desc.lights.push(Light::from(LightKind::SunSky(sky)).into());
    let irradiance = scene::light::sun_irradiance(std::f32::consts::FRAC_PI_2, 3.0);
    let mean = f64::from(irradiance.iter().sum::<f32>()) / 3.0;
    // Straight through: ∫ (1 − F(θ))² 2 sin θ cos θ dθ over what lands within a circle, by quadrature.
    let n = 4000;
    let through: f64 = (0..n)
        .map(|i| {
            let s2 = (f64::from(i) + 0.5) / f64::from(n);
            let (c, ct) = ((1.0 - s2).sqrt(), (1.0 - s2 / 2.25).sqrt());
            let (rs, rp) = ((c - 1.5 * ct) / (c + 1.5 * ct), (1.5 * c - ct) / (1.5 * c + ct));
            let (i, t) = (c.acos(), ct.acos());
            let (out, turn) = (i - 2.0 * t, 2.0 * (i - t));
            // Where it leaves the ball, 0.8 above the floor at the middle, and where it lands.
            let land = -0.4 * out.sin() - (0.8 - 0.4 * out.cos()) * turn.tan();
            let lands = turn.cos() > 0.0 && land.abs() < 1.9;
            if lands { (1.0 - 0.5 * (rs * rs + rp * rp)).powi(2) / f64::from(n) } else { 0.0 }
        })
        .sum();
    let expected = mean * std::f64::consts::PI * 0.16 * through;
    let scene = compiled(&desc);
    let found = flux(&scene, PhotonPaths::Caustic, 20_000, 12, 3, |p| {
        p.depth == 2 && p.position.x.hypot(p.position.z) < 1.9
    });
    assert_mean("caustic", &found, expected, 0.004);
}
