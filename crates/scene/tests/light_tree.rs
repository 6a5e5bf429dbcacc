//! Choosing among many lights.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use color::Lanes;
use math::{Bounds3, Vec3};
use nephroid_scene::light::{
    DirectPicker, DirectionalLight, DiskLight, EnvironmentLight, Light, LightPicker, PointLight, Receiver,
    Sides, SphereLight, SpotLight, TriangleLight,
};
use sampling::{Domain, Sampler, warp};
use testkit::Moments;

fn sampler(key: u64) -> Sampler {
    Sampler::new(5, key, Domain::Other, 0)
}

/// Somewhere in a box of 20 × 2 × 20.
fn place(s: &mut Sampler) -> Vec3 {
    Vec3::new(20.0 * s.next_1d() - 10.0, 2.0 * s.next_1d() + 0.2, 20.0 * s.next_1d() - 10.0)
}

/// Of every kind, some bright, most dim.
fn lights(count: usize, key: u64) -> Vec<Light> {
    let mut s = sampler(key);
    (0..count)
        .map(|i| {
            let (p, n, r) = (place(&mut s), warp::sphere(s.next_2d()), 0.05 + 0.2 * s.next_1d());
            let l = Lanes::splat((6.0 * s.next_1d() - 3.0).exp());
            let sides = [Sides::Front, Sides::Back, Sides::Both][i % 3];
            let corner = |s: &mut Sampler| p + r * warp::sphere(s.next_2d());
            match i % 6 {
                0 => PointLight::new(p, l).map(Light::Point),
                1 => SpotLight::new(p, n, l, 0.1, 0.2 + 2.9 * s.next_1d()).map(Light::Spot),
                2 => SphereLight::new(p, r, l, sides).map(Light::Sphere),
                3 => DiskLight::new(p, n, r, l, sides).map(Light::Disk),
                4 => TriangleLight::quad(p, corner(&mut s) - p, corner(&mut s) - p, l, sides)
                    .map(Light::Triangles),
                _ => {
                    let triangles =
                        (0..3).map(|_| [corner(&mut s), corner(&mut s), corner(&mut s)]).collect();
                    TriangleLight::new(triangles, l, sides).map(Light::Triangles)
                }
            }
            .unwrap()
        })
        .collect()
}

fn with_infinite(mut lights: Vec<Light>) -> Vec<Light> {
    lights.push(Light::Environment(EnvironmentLight::new(Lanes::splat(0.1)).unwrap()));
    lights.insert(3, Light::Directional(DirectionalLight::new(-Vec3::Y, Lanes::splat(0.2)).unwrap()));
    let bounds = Bounds3 { min: Vec3::splat(-10.0), max: Vec3::splat(10.0) };
    lights.iter_mut().for_each(|l| l.preprocess(bounds));
    lights
}

fn receivers(key: u64, n: usize) -> Vec<Receiver> {
    let mut s = sampler(key);
    (0..n)
        .map(|i| {
            let n = if i % 4 == 0 { Vec3::ZERO } else { warp::sphere(s.next_2d()) };
            Receiver { p: place(&mut s), n }
        })
        .collect()
}

#[test]
fn probabilities_are_those_of_the_draws() {
    for lights in [with_infinite(lights(60, 1)), lights(37, 2)] {
        let picker = DirectPicker::tree(&lights);
        for at in receivers(3, 12) {
            let pmf: Vec<f64> = (0..lights.len()).map(|i| f64::from(picker.pmf(i, &at))).collect();
            let n = 1 << 17;
            let (mut counts, mut lost, mut previous) = (vec![0.0; lights.len()], 0.0, -1.0f32);
            for i in 0..n {
                let (k, p, v) = picker.sample(&at, (i as f32 + 0.5) / n as f32);
                assert!((0.0..1.0).contains(&v));
                if p == 0.0 {
                    lost += 1.0 / f64::from(n);
                    continue;
                }
                assert!((f64::from(p) / pmf[k] - 1.0).abs() < 1e-4, "{k}: {p} {}", pmf[k]);
                counts[k] += 1.0 / f64::from(n);
                previous = previous.max(v);
            }
            assert!(previous > 0.5, "what is left of the number is used again");
            let sum: f64 = pmf.iter().sum();
            assert!((sum + lost - 1.0).abs() < 1e-3, "{sum} {lost}");
            for (k, (c, p)) in counts.iter().zip(&pmf).enumerate() {
                assert!((c - p).abs() < 1e-4 + 1e-3 * p, "{k}: {c} {p}");
            }
        }
    }
}

/// No light that shines at a receiver is left out there.
#[test]
fn what_shines_may_be_drawn() {
    let lights = with_infinite(lights(300, 7));
    let picker = DirectPicker::tree(&lights);
    let mut s = sampler(8);
    let (mut shone, mut dark) = (0, 0);
    for at in receivers(9, 200) {
        for (i, light) in lights.iter().enumerate() {
            let pmf = picker.pmf(i, &at);
            let li = light.sample_li(at.p, at.n, s.next_1d(), s.next_2d());
            let lit =
                li.is_some_and(|li| !li.radiance.is_zero() && (at.n == Vec3::ZERO || li.wi.dot(at.n) > 0.0));
            assert!(pmf > 0.0 || !lit, "{i} at {at:?}: {light:?} {li:?}");
            shone += usize::from(lit);
            dark += usize::from(pmf == 0.0);
        }
    }
    // Both happen.
    assert!(shone > 10_000 && dark > 5_000, "{shone} {dark}");
}

/// Irradiance from a thousand lamps: the same as by even choice and as the sum over all, with less noise.
#[test]
fn a_thousand_lamps_with_less_noise() {
    let mut s = sampler(20);
    let lights: Vec<Light> = (0..1000)
        .map(|_| {
            PointLight::new(place(&mut s), Lanes::splat((4.0 * s.next_1d()).exp())).map(Light::Point).unwrap()
        })
        .collect();
    let (tree, even) = (DirectPicker::new(&lights), DirectPicker::Even(LightPicker::direct(&lights)));
    assert!(matches!(tree, DirectPicker::Tree(_)));
    let contribution = |i: usize, at: &Receiver| {
        let li = lights[i].sample_li(at.p, at.n, 0.0, [0.5; 2]).unwrap();
        f64::from(li.radiance.mean() * li.wi.dot(at.n).max(0.0))
    };
    let (mut ratio, mut off, mut shifted) = (0.0, Vec::new(), Vec::new());
    let floor = Vec3::new(1.0, 0.0, 1.0);
    let at: Vec<Receiver> = (0..16).map(|_| Receiver { p: place(&mut s) * floor, n: Vec3::Y }).collect();
    for at in at {
        let exact: f64 = (0..lights.len()).map(|i| contribution(i, &at)).sum();
        let run = |picker: &DirectPicker, s: &mut Sampler, n: usize, asked: &Receiver| {
            Moments::of((0..n).map(|_| {
                let (i, p, _) = picker.sample(&at, s.next_1d());
                // Of probabilities at another place, for the control.
                let p = if asked == &at { p } else { picker.pmf(i, asked) };
                if p > 0.0 { contribution(i, &at) / f64::from(p) } else { 0.0 }
            }))
        };
        let (a, b) = (run(&tree, &mut s, 20_000, &at), run(&even, &mut s, 20_000, &at));
        ratio += b.variance() / a.variance() / 16.0;
        off.push(a.mean / exact - 1.0);
        assert!(a.z(exact, 0.0).abs() < 4.5, "{a:?} {exact}");
        assert!(b.z(exact, 0.0).abs() < 4.5, "{b:?} {exact}");
        let beside = Receiver { p: at.p + Vec3::X * 0.5, ..at };
        shifted.push(run(&tree, &mut s, 20_000, &beside).mean / exact - 1.0);
    }
    let bias = off.iter().sum::<f64>() / 16.0;
    assert!(bias.abs() < 0.01, "{bias}");
    assert!(ratio > 10.0, "variance is less by {ratio}");
    // Half a metre off in the probabilities shows.
    assert!(shifted.iter().any(|x| x.abs() > 0.05), "{shifted:?}");
}

#[test]
fn odd_sets_of_lights() {
    let none = DirectPicker::tree(&[]);
    let at = Receiver { p: Vec3::ZERO, n: Vec3::ZERO };
    assert_eq!(none.sample(&at, 0.3).1, 0.0);
    // All at one place, one dark.
    let point = |x| Light::Point(PointLight::new(Vec3::ONE, Lanes::splat(x)).unwrap());
    let lights: Vec<Light> = (0..500).map(|i| point(i as f32)).collect();
    let picker = DirectPicker::tree(&lights);
    assert_eq!(picker.pmf(0, &at), 0.0);
    for k in [1, 250, 499] {
        let expected = k as f32 / (499.0 * 250.0);
        assert!((picker.pmf(k, &at) / expected - 1.0).abs() < 1e-3, "{k}");
    }
    // At a light itself.
    let here = Receiver { p: Vec3::ONE, n: Vec3::Y };
    let (_, p, _) = picker.sample(&here, 0.5);
    assert!(p.is_finite());
    // Intensities over twenty orders of magnitude along a line: deep and whole.
    let line: Vec<Light> = (0..200)
        .map(|i| {
            PointLight::new(Vec3::X * i as f32, Lanes::splat(10f32.powf(i as f32 / 10.0 - 10.0))).unwrap()
        })
        .map(Light::Point)
        .collect();
    let picker = DirectPicker::tree(&line);
    let sum: f32 = (0..200).map(|i| picker.pmf(i, &Receiver { p: Vec3::Y, n: Vec3::ZERO })).sum();
    assert!((sum - 1.0).abs() < 1e-4, "{sum}");
    // A sky alone.
    let mut sky = vec![Light::Environment(EnvironmentLight::new(Lanes::ONE).unwrap())];
    sky[0].preprocess(Bounds3 { min: Vec3::ZERO, max: Vec3::ONE });
    assert_eq!(DirectPicker::tree(&sky).pmf(0, &at), 1.0);
}
