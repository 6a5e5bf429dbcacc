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

/// Few and many, with and without lights at infinity, and more of these than are each sampled.
fn sets() -> Vec<Vec<Light>> {
    let suns = (0..5).map(|i| {
        let w = Vec3::new(0.3 * i as f32 - 0.6, -1.0, 0.2);
        Light::Directional(DirectionalLight::new(w, Lanes::splat(0.1 + i as f32)).unwrap())
    });
    let many_suns = with_infinite(lights(3, 4).into_iter().chain(suns).collect());
    vec![with_infinite(lights(60, 1)), lights(37, 2), lights(2, 3), with_infinite(lights(6, 5)), many_suns]
}

#[test]
fn expected_numbers_are_those_of_the_draws() {
    for lights in sets() {
        let picker = DirectPicker::new(&lights);
        let mut previous = -1.0f32;
        for at in receivers(3, 12) {
            let expected: Vec<f64> = (0..lights.len()).map(|i| f64::from(picker.expected(i, &at))).collect();
            let n = 1 << 16;
            let mut counts = vec![0.0; lights.len()];
            for i in 0..n * picker.draws() {
                let (i, nth) = (i / picker.draws(), i % picker.draws());
                let drawn = picker.draw(&at, nth, (i as f32 + 0.5) / n as f32);
                assert!((0.0..1.0).contains(&drawn.u));
                if drawn.expected == 0.0 {
                    continue;
                }
                let known = expected[drawn.light];
                assert!((f64::from(drawn.expected) / known - 1.0).abs() < 1e-4, "{drawn:?} {known}");
                counts[drawn.light] += 1.0 / f64::from(n);
                previous = previous.max(drawn.u);
            }
            for (k, (c, e)) in counts.iter().zip(&expected).enumerate() {
                assert!((c - e).abs() < 2e-4 + 1e-3 * e, "{k}: {c} {e}");
            }
        }
        assert!(previous > 0.5, "what is left of the number is used again");
    }
}

/// No light that shines at a receiver is left out there.
#[test]
fn what_shines_may_be_drawn() {
    for lights in [with_infinite(lights(300, 7)), lights(3, 11), with_infinite(lights(8, 12))] {
        let picker = DirectPicker::new(&lights);
        let mut s = sampler(8);
        let (mut shone, mut dark) = (0, 0);
        for at in receivers(9, 60_000 / lights.len()) {
            for (i, light) in lights.iter().enumerate() {
                let expected = picker.expected(i, &at);
                let li = light.sample_li(at.p, at.n, s.next_1d(), s.next_2d());
                let lit = li.is_some_and(|li| {
                    !li.radiance.is_zero() && (at.n == Vec3::ZERO || li.wi.dot(at.n) > 0.0)
                });
                assert!(expected > 0.0 || !lit, "{i} at {at:?}: {light:?} {li:?}");
                shone += usize::from(lit);
                dark += usize::from(expected == 0.0);
            }
        }
        // Both happen.
        assert!(shone > 10_000 && dark > 5_000, "{shone} {dark}");
    }
}

/// Irradiance from a thousand lamps and from six: the same as by even choice and as the sum over all, with less noise.
#[test]
fn many_lamps_and_few_with_less_noise() {
    for (count, least, step) in [(1000, 10.0, 0.5), (6, 3.0, 3.0)] {
        let mut s = sampler(20);
        let lights: Vec<Light> = (0..count)
            .map(|_| {
                PointLight::new(place(&mut s), Lanes::splat((4.0 * s.next_1d()).exp()))
                    .map(Light::Point)
                    .unwrap()
            })
            .collect();
        let (picker, even) = (DirectPicker::new(&lights), LightPicker::photons(&lights));
        assert_eq!(picker.draws(), 1);
        let contribution = |i: usize, at: &Receiver| {
            let li = lights[i].sample_li(at.p, at.n, 0.0, [0.5; 2]).unwrap();
            f64::from(li.radiance.mean() * li.wi.dot(at.n).max(0.0))
        };
        let (mut ratio, mut off, mut shifted) = (0.0, Vec::new(), Vec::new());
        let floor = Vec3::new(1.0, 0.0, 1.0);
        let at: Vec<Receiver> = (0..16).map(|_| Receiver { p: place(&mut s) * floor, n: Vec3::Y }).collect();
        for at in at {
            let exact: f64 = (0..lights.len()).map(|i| contribution(i, &at)).sum();
            let over = |i: usize, p: f32| if p > 0.0 { contribution(i, &at) / f64::from(p) } else { 0.0 };
            let run = |s: &mut Sampler, asked: &Receiver| {
                Moments::of((0..20_000).map(|_| {
                    let drawn = picker.draw(&at, 0, s.next_1d());
                    // Of probabilities at another place, for the control.
                    let own = asked == &at;
                    over(drawn.light, if own { drawn.expected } else { picker.expected(drawn.light, asked) })
                }))
            };
            let a = run(&mut s, &at);
            let b = Moments::of((0..20_000).map(|_| {
                let (i, p, _) = even.sample(s.next_1d());
                over(i, p)
            }));
            ratio += b.variance() / a.variance() / 16.0;
            off.push(a.mean / exact - 1.0);
            assert!(a.z(exact, 0.0).abs() < 4.5, "{a:?} {exact}");
            assert!(b.z(exact, 0.0).abs() < 4.5, "{b:?} {exact}");
            let beside = Receiver { p: at.p + Vec3::X * step, ..at };
            shifted.push(run(&mut s, &beside).mean / exact - 1.0);
        }
        let bias = off.iter().sum::<f64>() / 16.0;
        assert!(bias.abs() < 0.01, "{bias}");
        assert!(ratio > least, "{count}: variance is less by {ratio}");
        // Probabilities of a place beside it show.
        assert!(shifted.iter().any(|x| x.abs() > 0.05), "{shifted:?}");
    }
}

#[test]
fn odd_sets_of_lights() {
    let none = DirectPicker::new(&[]);
    let at = Receiver { p: Vec3::ZERO, n: Vec3::ZERO };
    assert_eq!((none.draws(), none.expected(0, &at)), (0, 0.0));
    // All at one place, one dark.
    let point = |x| Light::Point(PointLight::new(Vec3::ONE, Lanes::splat(x)).unwrap());
    let lights: Vec<Light> = (0..500).map(|i| point(i as f32)).collect();
    let picker = DirectPicker::new(&lights);
    assert_eq!(picker.expected(0, &at), 0.0);
    let expected: Vec<f32> = (0..500).map(|i| picker.expected(i, &at)).collect();
    assert!((expected.iter().sum::<f32>() - 1.0).abs() < 1e-3);
    // By power, but for the part that falls on all alike.
    for k in [100, 250, 499] {
        let by_power = k as f32 / (499.0 * 250.0);
        assert!((expected[k] / by_power - 1.0).abs() < 0.3, "{k}: {} {by_power}", expected[k]);
    }
    // At a light itself.
    let here = Receiver { p: Vec3::ONE, n: Vec3::Y };
    assert!(picker.draw(&here, 0, 0.5).expected.is_finite());
    // Intensities over twenty orders of magnitude along a line: deep and whole.
    let line: Vec<Light> = (0..200)
        .map(|i| {
            PointLight::new(Vec3::X * i as f32, Lanes::splat(10f32.powf(i as f32 / 10.0 - 10.0))).unwrap()
        })
        .map(Light::Point)
        .collect();
    let picker = DirectPicker::new(&line);
    let sum: f32 = (0..200).map(|i| picker.expected(i, &Receiver { p: Vec3::Y, n: Vec3::ZERO })).sum();
    assert!((sum - 1.0).abs() < 1e-4, "{sum}");
    // A sky alone.
    let mut sky = vec![Light::Environment(EnvironmentLight::new(Lanes::ONE).unwrap())];
    sky[0].preprocess(Bounds3 { min: Vec3::ZERO, max: Vec3::ONE });
    assert_eq!(DirectPicker::new(&sky).expected(0, &at), 1.0);
}
