//! Powers, fluxes, irradiances and the choice of lights.

use std::f64::consts::PI;

use math::{Bounds3, Vec3};
use nephroid_scene::light::{
    DirectionalLight, DiskLight, EnvironmentLight, LeSample, Light, LightHit, LightPicker, PointLight, Sides,
    SphereLight, SpotLight, SunLight, TriangleLight,
};
use nephroid_scene::target::{MAX_TARGETS, Target, Targets};
use sampling::{Domain, Sampler};
use testkit::{Moments, z_p_value};

use crate::cases::*;

#[test]
fn power_is_the_flux_of_le() {
    for case in cases().into_iter().chain([spot(0.4, 0.4), spot(0.0, 0.01), disk(Sides::Back)]) {
        let all = samples(6, 20_000).map(|mut s| {
            let u = s.next_1d();
            case.light.sample_le(u, s.next_2d(), s.next_2d()).map_or(0.0, |l| flux(&l) * case.factor(&l))
        });
        let flux = Moments::of(all);
        let power = f64::from(case.light.power().0.x);
        assert!(power > 0.0);
        let z = flux.z(power, 2e-4 * power);
        assert!(z_p_value(z) > level(), "{}: {flux:?} {power}", case.name);
        // The same check sees an error of 2 %.
        assert!(z_p_value(flux.z(1.02 * power, 2e-4 * power)) < level(), "{}", case.name);
    }
}

#[test]
fn power_closed_forms() {
    let power = |l: &Light| f64::from(l.power().0.x);
    let bounds = scene_bounds();
    let r2 = 12.0 * 1.0001 * 1.0001;
    for case in cases() {
        let expected = match case.name {
            "point" => 4.0 * PI * 2.0,
            "directional" => PI * r2 * 3.0,
            "environment" => 4.0 * PI * PI * r2 * f64::from(0.7f32),
            "sphere" => PI * 2.0 * 4.0 * PI * 0.16,
            _ => continue,
        };
        assert_close(power(&case.light), expected, 1e-5);
    }
    assert_close(power(&disk(Sides::Both).light), 2.0 * power(&disk(Sides::Front).light), 1e-6);
    assert_close(power(&disk(Sides::Front).light), PI * 1.5 * PI * 0.25, 1e-5);
    // A spot by quadrature of its documented falloff: ∫ I·(3t² − 2t³) 2π d cos θ.
    let (ci, co) = (0.35f64.cos(), 0.8f64.cos());
    let n = 10_000;
    let mean: f64 = (0..n)
        .map(|i| (f64::from(i) + 0.5) / f64::from(n))
        .map(|t| t * t * (3.0 - 2.0 * t) / f64::from(n))
        .sum();
    assert_close(power(&spot(0.35, 0.8).light), 4.0 * 2.0 * PI * (1.0 - ci + (ci - co) * mean), 1e-5);
    let mut sun = DirectionalLight::new(Vec3::X, lanes(1.0)).map(Light::Directional).unwrap();
    assert!(power(&sun) == 0.0 && sun.sample_le(0.0, [0.5; 2], [0.5; 2]).is_none(), "no scene yet");
    sun.preprocess(bounds);
    assert!(power(&sun) > 0.0);
    assert!(sun.bounds().is_empty() && disk(Sides::Front).light.bounds().size().min_element() > 0.0);
}

/// Whether a path meets one of the specular objects within the first two targets.
fn meets_object(l: &LeSample) -> bool {
    let balls = [(Vec3::new(0.6, -0.7, 0.3), 1.1f32), (Vec3::new(-0.4, -1.0, 0.9), 0.8)];
    balls.iter().any(|(c, r)| {
        let v = *c - l.p;
        let along = v.dot(l.w);
        along > 0.0 && (v - l.w * along).length_squared() < r * r
    })
}

#[test]
fn aimed_photons_carry_the_flux_of_all_photons() {
    let targets = targets();
    // The two that are left out have few photons that reach anything.
    let slow = ["patterned sphere", "patterned mesh"];
    for (i, case) in cases().iter().enumerate().filter(|(_, c)| !slow.contains(&c.name)) {
        // Until the error of the mean is a quarter of a percent.
        let run = |aim: bool| {
            let mut s = Sampler::new(11, 20 + i as u64, Domain::Other, u64::from(aim));
            let mut moments = Moments::default();
            while moments.n < 1 << 22
                && (moments.n < 1 << 16 || moments.standard_error() > 2.5e-3 * moments.mean)
            {
                for _ in 0..1 << 16 {
                    let (a, b, c) = (s.next_1d(), s.next_2d(), s.next_2d());
                    let l = if aim {
                        case.light.sample_le_toward(&targets, a, b, c)
                    } else {
                        case.light.sample_le(a, b, c)
                    };
                    moments.push(l.filter(meets_object).map_or(0.0, |l| flux(&l) * case.factor(&l)));
                }
            }
            moments
        };
        let (all, aimed) = (run(false), run(true));
        let z = all.z_between(&aimed);
        assert!(z_p_value(z) > level(), "{}: {z} {all:?} {aimed:?}", case.name);
        let off = Moments { mean: 1.02 * aimed.mean, m2: 1.02 * 1.02 * aimed.m2, ..aimed };
        let planted = all.z_between(&off);
        assert!(z_p_value(planted) < level(), "{}: 2 % unseen: {planted}", case.name);
        // Aiming pays: the same count of photons has a smaller error.
        assert!(aimed.variance() < all.variance(), "{}", case.name);
    }
}

#[test]
fn a_lamp_within_its_globe_sends_all_its_light_to_it() {
    let globe = Target::from_bounds(Bounds3 { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) }, 1.0);
    let far = Bounds3 { min: Vec3::new(4.0, -1.0, -1.0), max: Vec3::new(6.0, 1.0, 1.0) };
    let targets = Targets::new(vec![globe, Target::from_bounds(far, 1.0)]);
    let lamps = [
        Light::Point(PointLight::new(Vec3::new(0.1, 0.2, 0.0), lanes(1.0)).unwrap()),
        sphere(Vec3::ZERO, 0.5, Sides::Front).light,
    ];
    for lamp in lamps {
        let sent = Moments::of(samples(60, 1 << 17).map(|mut s| {
            let u = s.next_1d();
            lamp.sample_le_toward(&targets, u, s.next_2d(), s.next_2d()).map_or(0.0, |l| flux(&l))
        }));
        let power = f64::from(lamp.power().0.x);
        assert!(z_p_value(sent.z(power, 0.0)) > level(), "{sent:?} {power}");
        assert!(z_p_value(sent.z(1.02 * power, 0.0)) < level());
    }
}

/// ∫ L cos⁺ dω at `p` by a grid over the numbers of `sample_li`.
fn irradiance(light: &Light, p: Vec3, n: Vec3) -> f64 {
    let side = 400;
    let mut sum = 0.0;
    for i in 0..side * side {
        let at = |k: i32| (k as f32 + 0.5) / side as f32;
        let u = [at(i % side), at(i / side)];
        let pick = (i as f32 * 0.618_034).fract();
        if let Some(l) = light.sample_li(p, n, pick, u) {
            sum += f64::from(l.radiance.0.x * l.wi.dot(n).max(0.0) / l.pdf_w);
        }
    }
    sum / f64::from(side * side)
}

#[test]
fn irradiance_closed_forms() {
    let up = Vec3::Y;
    // Point and spot over a plane: I cos θ/d².
    let p = Vec3::new(1.0, -1.0, 0.5);
    let point = PointLight::new(Vec3::new(0.3, 1.4, -0.2), lanes(2.0)).map(Light::Point).unwrap();
    let d = Vec3::new(0.3, 1.4, -0.2) - p;
    let d3 = f64::from(d.length()).powi(3);
    assert_close(irradiance(&point, p, up), 2.0 * f64::from(d.y) / d3, 1e-5);
    let spot = SpotLight::new(Vec3::new(0.0, 2.0, 0.0), -up, lanes(4.0), 0.2, 0.6).map(Light::Spot).unwrap();
    assert_close(irradiance(&spot, Vec3::ZERO, up), 1.0, 1e-5);
    let theta = 0.4f64;
    let t = (theta.cos() - 0.6f64.cos()) / (0.2f64.cos() - 0.6f64.cos());
    let expected = 4.0 * t * t * (3.0 - 2.0 * t) * theta.cos().powi(3) / 4.0;
    assert_close(irradiance(&spot, Vec3::X * (2.0 * theta.tan()) as f32, up), expected, 1e-4);
    assert_eq!(irradiance(&spot, Vec3::X * 1.4, up), 0.0, "beyond the outer angle");
    // Sun and sky.
    let sun = DirectionalLight::new(Vec3::new(0.0, -3.0, 4.0), lanes(2.0)).map(Light::Directional).unwrap();
    assert_close(irradiance(&sun, p, up), 1.2, 1e-6);
    // The disc of the sun, of any size.
    for angle in [0.001f32, 0.00465, 0.1, 1.0] {
        let sun = SunLight::new(Vec3::new(0.0, 3.0, -4.0), angle, lanes(2.0)).map(Light::Sun).unwrap();
        assert_close(irradiance(&sun, p, Vec3::new(0.0, 0.6, -0.8)), 2.0, 1e-3);
        if angle < 0.6 {
            assert_close(irradiance(&sun, p, up), 1.2, 1e-3);
        }
        let seen =
            |off: f32| sun.escaped(Vec3::new(0.0, (0.6f32.asin() + off).sin(), -(0.6f32.asin() + off).cos()));
        assert!(seen(0.999 * angle) == seen(0.0) && seen(1.001 * angle).is_zero());
    }
    let sky = EnvironmentLight::new(lanes(2.0)).map(Light::Environment).unwrap();
    assert_close(irradiance(&sky, p, up), 2.0 * PI, 1e-3);
    // Disc on its axis: πL r²/(r² + h²).
    for (r, h) in [(0.5f32, 2.0f32), (1.0, 0.3), (0.01, 5.0)] {
        let light = DiskLight::new(up * h, -up, r, lanes(1.5), Sides::Front).map(Light::Disk).unwrap();
        let (r2, h2) = (f64::from(r * r), f64::from(h * h));
        assert_close(irradiance(&light, Vec3::ZERO, up), 1.5 * PI * r2 / (r2 + h2), 2e-3);
        let dark = DiskLight::new(up * h, up, r, lanes(1.5), Sides::Front).map(Light::Disk).unwrap();
        assert_eq!(irradiance(&dark, Vec3::ZERO, up), 0.0, "the back of a one-sided lamp");
    }
    // Sphere straight above, from far away to almost touching: πL(R/d)².
    for d in [1.000_01f32, 1.01, 3.0, 1e3, 1e5] {
        let light = SphereLight::new(up * d, 1.0, lanes(2.0), Sides::Front).map(Light::Sphere).unwrap();
        assert_close(irradiance(&light, Vec3::ZERO, up), 2.0 * PI / f64::from(d).powi(2), 1e-3);
    }
    // Inside a sphere that shines inward, anywhere: πL.
    let shell = SphereLight::new(Vec3::ZERO, 1.0, lanes(2.0), Sides::Back).map(Light::Sphere).unwrap();
    for y in [0.0, -0.5, -0.9] {
        assert_close(irradiance(&shell, up * y, up), 2.0 * PI, 5e-3);
    }
    // A parallel rectangle a × b at height h over one corner (Lambert): sums of atan terms.
    let (a, b, h) = (0.8f64, 1.2f64, 0.7f64);
    let edge = |x: f64, y: f64| x / (h * h + x * x).sqrt() * (y / (h * h + x * x).sqrt()).atan();
    let expected = 0.5 * (edge(a, b) + edge(b, a));
    let quad =
        TriangleLight::quad(up * h as f32, Vec3::X * a as f32, Vec3::Z * b as f32, lanes(1.0), Sides::Back)
            .map(Light::Triangles)
            .unwrap();
    let (x, z) = (Vec3::X * a as f32, Vec3::Z * b as f32);
    assert!(quad.emitted(x.cross(z).normalize(), -up).is_zero());
    let front =
        TriangleLight::quad(up * h as f32, x, z, lanes(1.0), Sides::Front).map(Light::Triangles).unwrap();
    assert_close(irradiance(&front, Vec3::ZERO, up), expected, 2e-3);
    assert_eq!(irradiance(&quad, Vec3::ZERO, up), 0.0);
}

#[test]
fn dim_lights_are_not_starved() {
    let targets = targets();
    let point = |x: f32, i: f32| Light::Point(PointLight::new(Vec3::new(x, 1.5, 0.0), lanes(i)).unwrap());
    let lights = vec![point(0.0, 1e4), point(0.5, 1.0), point(-0.5, 0.0)];
    for (picker, floor) in
        [(LightPicker::caustics(&lights, &targets), 0.25), (LightPicker::photons(&lights), 0.0)]
    {
        let pmf: Vec<f32> = (0..3).map(|i| picker.pmf(i)).collect();
        assert!((pmf.iter().sum::<f32>() - 1.0).abs() < 1e-6 && pmf[2] == 0.0, "{pmf:?}");
        assert!(pmf[1] >= floor && pmf[0] > pmf[1], "{pmf:?}");
        if floor == 0.0 {
            assert_close(f64::from(pmf[1] / pmf[0]), 1e-4, 1e-3);
        }
        // Shares as announced.
        let mut counts = [0.0; 3];
        let n = 50_000;
        for i in 0..n {
            let (k, p, _) = picker.sample((i as f32 + 0.5) / n as f32);
            assert_eq!(p, picker.pmf(k));
            counts[k] += 1.0;
        }
        for (c, p) in counts.iter().zip(&pmf) {
            assert!((c / f64::from(n) - f64::from(*p)).abs() < 1e-4, "{counts:?} {pmf:?}");
        }
    }
    // By power that reaches the targets: a bright spot that grazes them gets little more than the floor, lamps
    // that look away get nothing.
    let spot =
        |axis| SpotLight::new(Vec3::new(0.0, 1.5, 0.0), axis, lanes(1e4), 0.1, 0.2).map(Light::Spot).unwrap();
    let disk = |n| DiskLight::new(Vec3::Y * 1.5, n, 0.1, lanes(1e4), Sides::Front).map(Light::Disk).unwrap();
    let quad = TriangleLight::quad(Vec3::Y, Vec3::Z, Vec3::X, lanes(1e4), Sides::Front)
        .map(Light::Triangles)
        .unwrap();
    let lights = [spot(Vec3::Y), disk(Vec3::Y), quad, point(0.0, 1.0), disk(-Vec3::Y)];
    let picker = LightPicker::caustics(&lights, &targets);
    let pmf: Vec<f32> = (0..5).map(|i| picker.pmf(i)).collect();
    assert!(pmf[..3] == [0.0; 3] && pmf[3] >= 0.25 && pmf[4] > pmf[3], "{pmf:?}");
    // The estimate is the flux that arrives: of a point, the boxes' share of the sphere.
    let lit = [point(0.0, 1.0), point(0.0, 3.0)];
    let picker = LightPicker::caustics(&lit, &targets);
    assert!((picker.pmf(0) - 0.375).abs() < 1e-6, "{}", picker.pmf(0));
    let none = LightPicker::far(&[]);
    assert!(none.is_empty() && none.sample(0.5).1 == 0.0);
}

#[test]
fn many_targets_are_merged_without_losing_any() {
    let all: Vec<Target> = samples(70, 300)
        .map(|mut s| {
            let c = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 4.0 - Vec3::splat(2.0);
            let r = Vec3::splat(0.05 + 0.1 * s.next_1d());
            Target::from_bounds(Bounds3 { min: c - r, max: c + r }, s.next_1d())
        })
        .collect();
    let targets = Targets::new(all.clone());
    assert_eq!(targets.len(), MAX_TARGETS);
    assert_eq!(targets.as_slice(), Targets::new(all.clone()).as_slice());
    for t in &all {
        let held = |m: &Target| {
            let sphere = t.bounds.corners().iter().all(|c| c.distance(m.center) <= m.radius);
            sphere && t.bounds.corners().iter().all(|c| m.bounds.contains(*c))
        };
        assert!(targets.as_slice().iter().any(held));
    }
    let broken = Target { radius: f32::NAN, ..all[0] };
    assert!(Targets::new(vec![broken]).is_empty());
    let point = PointLight::new(Vec3::ZERO, lanes(1.0)).map(Light::Point).unwrap();
    let nothing = Targets::default();
    assert!(point.sample_le_toward(&nothing, 0.5, [0.5; 2], [0.5; 2]).is_none());
    let start = LightHit { p: Vec3::ZERO, ng: Vec3::ZERO, prim: 0 };
    assert_eq!(point.pdf_le_toward(&nothing, &start, Vec3::X).1, 0.0);
}

#[test]
fn lights_that_make_no_sense_are_refused() {
    let (o, l) = (Vec3::ZERO, lanes(1.0));
    assert!(PointLight::new(Vec3::NAN, l).is_none() && PointLight::new(o, lanes(-1.0)).is_none());
    assert!(PointLight::new(o, lanes(f32::INFINITY)).is_none());
    assert!(SpotLight::new(o, o, l, 0.1, 0.2).is_none() && SpotLight::new(o, Vec3::X, l, 0.3, 0.2).is_none());
    assert!(SpotLight::new(o, Vec3::X, l, 0.0, 0.0).is_none());
    assert!(DirectionalLight::new(o, l).is_none() && EnvironmentLight::new(lanes(f32::NAN)).is_none());
    assert!(SunLight::new(o, 0.1, l).is_none() && SunLight::new(Vec3::X, 0.0, l).is_none());
    assert!(SunLight::new(Vec3::X, 2.0, l).is_none() && SunLight::new(Vec3::X, f32::NAN, l).is_none());
    assert!(SphereLight::new(o, 0.0, l, Sides::Front).is_none());
    assert!(DiskLight::new(o, Vec3::X, -1.0, l, Sides::Front).is_none());
    assert!(DiskLight::new(o, o, 1.0, l, Sides::Front).is_none());
    assert!(TriangleLight::new(vec![[o, Vec3::X, Vec3::X]], l, Sides::Front).is_none(), "no area");
    assert!(TriangleLight::new(vec![], l, Sides::Front).is_none());
}
