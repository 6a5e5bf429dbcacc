//! The sun and the sky of a clear day.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use math::Vec3;
use nephroid_scene as scene;
use scene::{Light, LightId, Scene};
use scenefile::SceneDesc;
use scenefile::desc::{Camera, LightKind, Material, Object, Shape, SunSky, TransformStep};

fn compiled(sky: SunSky) -> (Scene, usize) {
    let desc = SceneDesc {
        camera: Some(Camera::default().into()),
        objects: vec![
            Object::new(Shape::Sphere { center: [0.0; 3], radius: 1.0 }, Material::diffuse(0.5)).into(),
        ],
        lights: vec![scenefile::desc::Light::from(LightKind::SunSky(sky)).into()],
        ..SceneDesc::default()
    };
    let (scene, diagnostics) = scene::compile(&desc).unwrap();
    (scene, diagnostics.len())
}

fn day(turbidity: f32, elevation: f32) -> SunSky {
    let (s, c) = elevation.to_radians().sin_cos();
    SunSky { sun_direction: [0.0, 2.0 * s, 2.0 * c], turbidity, ..SunSky::default() }
}

fn escaped(scene: &Scene, w: Vec3) -> [f32; 3] {
    let lights = scene.environments().iter();
    lights.map(|&id| scene.light(id).escaped(w)).fold(color::Lanes::ZERO, |sum, l| sum + l).to_rgb()
}

/// Radiances of the sky and irradiances of the sun that Mitsuba 3.9.1 gives (albedo 0.3; at (0, 0, 1), (1, 0, 0.2), (0, −1, 0.5)
/// and (0, 0.9, 0.8) with z up and the sun over +y).
#[test]
fn the_models_are_those_of_other_renderers() {
    let toward = [[0.0, 1.0, 0.0], [1.0, 0.2, 0.0], [0.0, 0.5, -1.0], [0.0, 0.8, 0.9]];
    let known = [
        (
            (3.0, 45.0),
            [
                [0.02375, 0.04152, 0.08409],
                [0.07868, 0.12815, 0.2027],
                [0.04153, 0.0761, 0.14006],
                [0.18802, 0.21304, 0.24367],
            ],
            [1.46770, 1.20549, 0.88793],
        ),
        (
            (2.0, 20.0),
            [
                [0.01082, 0.02348, 0.04657],
                [0.06021, 0.09716, 0.13285],
                [0.03843, 0.06758, 0.10624],
                [0.04368, 0.06653, 0.09803],
            ],
            [1.34213, 0.99191, 0.56327],
        ),
        (
            (6.0, 60.0),
            [
                [0.08383, 0.10342, 0.14702],
                [0.10512, 0.14727, 0.22102],
                [0.0538, 0.0887, 0.15409],
                [0.28509, 0.31585, 0.34018],
            ],
            [1.38174, 1.14671, 0.88734],
        ),
    ];
    for ((turbidity, elevation), sky, sun) in known {
        let (scene, _) = compiled(SunSky { sun_scale: 0.0, ..day(turbidity, elevation) });
        for (w, expected) in toward.iter().zip(sky) {
            let found = escaped(&scene, Vec3::from(*w).normalize());
            for c in 0..3 {
                let ratio = found[c] / (expected[c] * SunSky::OVER_MITSUBA);
                assert!((ratio - 1.0).abs() < 0.01, "{turbidity} {elevation} {w:?}: {found:?} {ratio}");
            }
        }
        let found = scene::light::sun_irradiance(f32::to_radians(elevation), turbidity);
        for c in 0..3 {
            let ratio = found[c] / (sun[c] * SunSky::OVER_MITSUBA);
            assert!((ratio - 1.0).abs() < 0.005, "{turbidity} {elevation}: {found:?} {ratio}");
        }
    }
}

/// Light sampling finds the irradiance that a grid of directions has; on a clear afternoon the sky gives about 18 klux and the sun
/// 64 on a horizontal plane.
#[test]
fn irradiances() {
    let (scene, warnings) = compiled(day(3.0, 45.0));
    assert_eq!(warnings, 0);
    let sampled = |id: u32| {
        let light = scene.light(LightId(id));
        let (n, mut sum) = (300, 0.0);
        for i in 0..n * n {
            let u = [(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|x| x / n as f32);
            if let Some(l) = light.sample_li(Vec3::Y, Vec3::Y, 0.0, u) {
                sum += f64::from(color::luminance(l.radiance.to_rgb()) * l.wi.y.max(0.0) / l.pdf_w);
            }
        }
        sum / f64::from(n * n)
    };
    assert!(
        matches!(scene.light(LightId(0)), Light::Sun(_)) && matches!(scene.light(LightId(1)), Light::Sky(_))
    );
    let n = 1000;
    let mut sum = 0.0;
    for i in 0..n * n {
        // Uniform in projected area: E = π times the mean.
        let (r, phi) = (
            (((i / n) as f32 + 0.5) / n as f32).sqrt(),
            std::f32::consts::TAU * ((i % n) as f32 + 0.5) / n as f32,
        );
        let w = Vec3::new(r * phi.cos(), (1.0 - r * r).sqrt(), r * phi.sin());
        sum += f64::from(color::luminance(scene.light(LightId(1)).escaped(w).to_rgb()));
    }
    let grid = std::f64::consts::PI * sum / f64::from(n * n);
    assert!((sampled(1) / grid - 1.0).abs() < 2e-3, "{} {grid}", sampled(1));
    let [sun, sky] = [0, 1].map(|id| 179.0 * sampled(id));
    assert!((15e3..21e3).contains(&sky) && (5.5e4..7.5e4).contains(&sun), "{sky} {sun} lux");
    // Nothing comes from below.
    assert_eq!(escaped(&scene, Vec3::new(0.3, -0.5, 0.1).normalize()), [0.0; 3]);
}

#[test]
fn scales_turns_and_nights() {
    let count = |sky: SunSky| compiled(sky).0.lights().len();
    assert_eq!(count(day(3.0, 45.0)), 2);
    assert_eq!(
        [
            count(SunSky { sun_scale: 0.0, ..day(3.0, 45.0) }),
            count(SunSky { sky_scale: 0.0, ..day(3.0, 45.0) })
        ],
        [1; 2]
    );
    let (night, warnings) = compiled(day(3.0, -1.0));
    assert!(night.lights().is_empty() && warnings >= 1);
    // +y goes to +z.
    let transform = vec![TransformStep::Rotate { axis: [1.0, 0.0, 0.0], degrees: 90.0 }];
    let (upright, _) = compiled(day(4.0, 30.0));
    let (turned, _) = compiled(SunSky { transform, ..day(4.0, 30.0) });
    for w in [Vec3::new(0.1, 0.9, 0.2), Vec3::new(0.0, 0.5, 0.866), Vec3::new(0.3, 0.2, -0.8)] {
        let (w, v) = (w.normalize(), Vec3::new(w.x, -w.z, w.y).normalize());
        let (a, b) = (escaped(&upright, w), escaped(&turned, v));
        assert!(a[1] > 0.0 && (b[1] / a[1] - 1.0).abs() < 1e-3, "{a:?} {b:?}");
    }
    // Half the scale, half the light; out of range numbers from other formats do not panic.
    let (half, _) = compiled(SunSky { sky_scale: 0.5, sun_scale: 0.5, ..day(4.0, 30.0) });
    assert!((half.power().mean() / upright.power().mean() - 0.5).abs() < 1e-4);
    assert_eq!(count(SunSky { ground_albedo: [2.0, -1.0, 0.5], ..day(30.0, 90.0) }), 2);
}
