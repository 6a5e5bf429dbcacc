//! Laws that scattering functions obey: reciprocity, energy, sides of a surface; and known values.

mod common;

use color::Lanes;
use common::{
    GOLD, RADIANCE, conductor, direction, further_kinds, mean_weight, phong, plastic, surface,
    white_conductor,
};
use math::Vec3;
use nephroid_bsdf::{
    Bsdf, BsdfKind, Facets, Film, Lobes, TransportMode, fresnel_conductor, fresnel_dielectric,
};
use sampling::{Domain, Sampler, warp};
use testkit::reciprocity_error;

const DIFFUSE: BsdfKind = BsdfKind::Diffuse { albedo: Lanes::rgb(0.7, 0.5, 0.2) };
const GLASS: BsdfKind = BsdfKind::Dielectric { eta: 1.5, tint: Lanes::ONE };
const MIRROR: BsdfKind = BsdfKind::Mirror { color: Lanes::rgb(0.9, 0.8, 0.7) };

fn every_kind() -> Vec<BsdfKind> {
    let mut kinds = vec![DIFFUSE, GLASS, MIRROR, BsdfKind::Null, BsdfKind::Black];
    kinds.push(BsdfKind::Dielectric { eta: 1.0 / 1.33, tint: Lanes::rgb(0.9, 0.5, 1.0) });
    kinds.push(BsdfKind::Dielectric { eta: 1.0, tint: Lanes::ONE });
    kinds.extend([0.0, 1.0, 50.0, 1e6].map(phong));
    kinds.extend([0.0, 1e-9, 1e-4, 1e-2, 0.3, 1.0].map(conductor));
    kinds.extend([0.0, 1e-4, 1e-2, 0.3, 1.0].map(|a| plastic(0.8, 1.5, a)));
    kinds.extend([1.0, 4.0].map(|eta| plastic(1.0, eta, 0.0)));
    kinds.extend(further_kinds());
    kinds
}

#[test]
fn f_is_reciprocal() {
    let mut s = Sampler::new(5, 0, Domain::Other, 0);
    for kind in every_kind() {
        for tilt in [0.0, 30.0] {
            let b = surface(kind, tilt);
            // Pairs at random, and pairs that the sampler draws, so that narrow lobes are met.
            let pairs: Vec<(Vec3, Vec3)> = (0..400)
                .map(|i| {
                    let wo = warp::sphere(s.next_2d());
                    let drawn = b.sample_lobes(wo, Lobes::NON_DELTA, s.next_1d(), s.next_2d(), RADIANCE);
                    (wo, drawn.filter(|_| i % 2 == 0).map_or_else(|| warp::sphere(s.next_2d()), |d| d.wi))
                })
                .collect();
            // The two modes are adjoint: what radiance gathers along a path is what flux carries back along it
            // (Veach 1997, eq. 5.14). Which of a pair goes first is told by the order of coordinates.
            let mode = |a: Vec3, c: Vec3| if a.x > c.x { RADIANCE } else { TransportMode::Importance };
            let error = reciprocity_error(pairs, 1e-6, |a, c| f64::from(b.eval(a, c, mode(a, c)).0.x));
            assert!(error < 4e-3, "{kind:?} {tilt}: {error}");
        }
    }
}

/// Refraction: f(wo, wi)/η_i² = f(wi, wo)/η_o² for radiance (Veach 1997, eq. 5.14); for a delta, the weights of the
/// two directions of one path, each over η².
#[test]
fn refraction_is_reciprocal_up_to_eta_squared() {
    let b = surface(GLASS, 0.0);
    for i in 1..50 {
        let wo = direction(&b, i as f32 / 50.0, 0.7);
        let there = b.delta_lobes(wo, RADIANCE)[1].unwrap();
        let back = b.delta_lobes(there.wi, RADIANCE)[1].unwrap();
        assert!((back.wi - wo).length() < 1e-4 / b.abs_cos(wo), "the same path back");
        let (a, c) = (there.weight.max() * there.eta.powi(2), back.weight.max() * back.eta.powi(2));
        assert!((a - c).abs() < 1e-4 / b.abs_cos(wo) && (there.eta * back.eta - 1.0).abs() < 1e-6, "{a} {c}");
        // Photons keep their flux.
        let photon = b.delta_lobes(wo, TransportMode::Importance)[1].unwrap();
        assert!((photon.weight.max() - a).abs() < 1e-6);
    }
}

#[test]
fn dielectric_loses_nothing() {
    for eta in [1.5, 1.0 / 1.5, 1.0, 2.4] {
        let b = surface(BsdfKind::Dielectric { eta, tint: Lanes::ONE }, 0.0);
        for i in -100..=100 {
            if i == 0 {
                continue;
            }
            let wo = direction(&b, i as f32 / 100.0, 1.0);
            let [r, t] = b.delta_lobes(wo, TransportMode::Importance);
            let sum = r.map_or(0.0, |l| l.weight.max()) + t.map_or(0.0, |l| l.weight.max());
            assert!((sum - 1.0).abs() < 1e-6, "kr + kt = {sum} at {i}");
            // Sampled: weight 1, and the two chosen in proportion to kr and kt.
            let kr = r.unwrap().weight.max();
            for (u, lobes) in [(kr * 0.999, Lobes::REFLECTION), (kr * 1.001 + 1e-6, Lobes::TRANSMISSION)] {
                if let Some(d) = b.sample(wo, u, [0.5; 2], TransportMode::Importance).filter(|_| u < 1.0) {
                    assert!(d.lobes.contains(lobes) || t.is_none() || kr == 0.0, "{d:?}");
                    assert!((d.weight.max() - 1.0).abs() < 1e-6 && (0.0..=1.0).contains(&d.pdf_w), "{d:?}");
                }
            }
        }
    }
}

#[test]
fn snell_brewster_and_total_reflection() {
    let b = Bsdf::from_normal(GLASS, Vec3::Z);
    let wo = math::spherical_direction(30f32.to_radians().cos(), 0.0);
    let t = b.delta_lobes(wo, RADIANCE)[1].unwrap();
    // sin 30°/1.5 = 1/3; from above into the denser side.
    assert!((t.wi - Vec3::new(-1.0 / 3.0, 0.0, -(8f32 / 9.0).sqrt())).length() < 1e-6 && t.eta == 1.5);
    assert!((t.weight.max() - (1.0 - fresnel_dielectric(wo.z, 1.5)) / 2.25).abs() < 1e-6);
    // From inside beyond 41.8°: all is reflected.
    let wo = -math::spherical_direction(45f32.to_radians().cos(), 0.0);
    let [r, t] = b.delta_lobes(wo, RADIANCE);
    assert!(t.is_none() && (r.unwrap().weight.max() - 1.0).abs() < 1e-6);
    assert!((r.unwrap().wi - Vec3::new(-wo.x, 0.0, wo.z)).length() < 1e-6);
    // At Brewster's angle of 56.31° reflected and refracted rays are at right angles.
    let wo = math::spherical_direction(1.5f32.atan().cos(), 0.4);
    let [r, t] = b.delta_lobes(wo, RADIANCE);
    assert!(r.unwrap().wi.dot(t.unwrap().wi).abs() < 1e-6);
}

/// White surfaces return all light, at every roughness and angle, within 1 %.
#[test]
fn white_furnace() {
    for alpha in [1e-4, 1e-3, 5e-3, 0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0] {
        for cos_theta in [1.0, 0.9, 0.6, 0.35, 0.2, 0.1, 0.05, 0.02, 0.005] {
            for kind in [white_conductor(alpha), plastic(1.0, 1.5, alpha), plastic(1.0, 2.3, alpha)] {
                let b = surface(kind, 0.0);
                let m = mean_weight(&b, direction(&b, cos_theta, 0.5), 128);
                assert!((m.mean - 1.0).abs() < 0.01, "{kind:?} at cos {cos_theta}: {}", m.mean);
            }
        }
    }
    for eta in [1.0, 1.2, 1.5, 3.0, 4.0] {
        for cos_theta in [1.0, 0.6, 0.2, 0.02] {
            let b = surface(plastic(1.0, eta, 0.0), 0.0);
            let m = mean_weight(&b, direction(&b, cos_theta, 0.5), 128);
            assert!((m.mean - 1.0).abs() < 0.002 + 4.0 * m.standard_error(), "{eta} {cos_theta}: {m:?}");
        }
    }
}

/// `albedo` says what sampling finds, as near as its documentation promises.
#[test]
fn albedo_is_the_mean_weight() {
    for (kind, tolerance) in [
        (DIFFUSE, 1e-4),
        (MIRROR, 1e-6),
        (conductor(0.0), 1e-6),
        (conductor(0.2), 0.02),
        (conductor(0.8), 0.04),
        (plastic(0.6, 1.5, 0.0), 0.005),
        (plastic(0.6, 1.5, 0.3), 0.01),
        (BsdfKind::Null, 1e-6),
    ] {
        for cos_theta in [0.9, 0.4, 0.1] {
            let b = surface(kind, 0.0);
            let wo = direction(&b, cos_theta, 4.0);
            let (albedo, mean) = (f64::from(b.albedo(wo).0.x), mean_weight(&b, wo, 128).mean);
            assert!((albedo - mean).abs() < tolerance, "{kind:?} cos {cos_theta}: {albedo} {mean}");
        }
    }
    // Modified Phong: kd + ks at normal incidence, less towards grazing.
    let b = surface(phong(30.0), 0.0);
    let mean = |c: f32| mean_weight(&b, direction(&b, c, 0.0), 128).mean;
    assert!((mean(1.0) - 0.9).abs() < 2e-3 && mean(0.1) < 0.8);
}

/// Whatever the normals: reflection stays on the side of `wo`, transmission leaves it, and nothing is NaN.
#[test]
fn no_leaks_and_no_nan() {
    let mut s = Sampler::new(8, 0, Domain::Other, 0);
    for kind in every_kind() {
        for tilt in [0.0, 35.0, 89.0] {
            let b = surface(kind, tilt);
            for i in 0..3000 {
                let wo = match i % 4 {
                    0 => direction(&b, (s.next_1d() - 0.5) * 1e-3, 6.0 * s.next_1d()),
                    1 => direction(&b, (s.next_1d() - 0.5) * 1e-7, 6.0 * s.next_1d()),
                    2 if i % 8 == 2 => b.ns() * if i % 16 == 2 { 1.0 } else { -1.0 },
                    _ => warp::sphere(s.next_2d()),
                };
                for mode in [TransportMode::Radiance, TransportMode::Importance] {
                    let u = match i % 5 {
                        0 => [0.0, s.next_1d()],
                        1 => [math::ONE_MINUS_EPSILON, s.next_1d()],
                        _ => s.next_2d(),
                    };
                    let side = |w: Vec3| (w.dot(b.ng()) > 0.0, w.dot(b.ns()) > 0.0);
                    if let Some(d) = b.sample(wo, s.next_1d(), u, mode) {
                        assert!(
                            d.weight.is_finite() && d.weight.0.min_element() >= 0.0,
                            "{kind:?} {wo} {d:?}"
                        );
                        assert!(d.pdf_w.is_finite() && d.pdf_w > 0.0 && d.eta > 0.0, "{kind:?} {wo} {d:?}");
                        assert!((d.wi.length() - 1.0).abs() < 1e-5, "{kind:?} {wo} {d:?}");
                        let reflected = d.lobes.contains(Lobes::REFLECTION);
                        let ((g, n), (go, no)) = (side(d.wi), side(wo));
                        assert_eq!((g == go, n == no), (reflected, reflected), "{kind:?} {wo} {d:?}");
                        assert!(b.lobes().contains(d.lobes), "{kind:?} {d:?}");
                    }
                    let wi = if i % 2 == 0 { -wo } else { warp::sphere(s.next_2d()) };
                    let (f, p) = (b.eval(wo, wi, mode), b.pdf_w(wo, wi, mode));
                    assert!(
                        f.is_finite() && f.0.min_element() >= 0.0 && p.is_finite() && p >= 0.0,
                        "{kind:?}"
                    );
                    let ((g, n), (go, no)) = (side(wi), side(wo));
                    let through = b.lobes().contains(Lobes::TRANSMISSION) && g != go && n != no;
                    assert!(side(wi) == side(wo) || through || (f.is_zero() && p == 0.0), "{kind:?}: leak");
                    assert!(b.albedo(wo).is_finite());
                }
            }
        }
    }
}

#[test]
fn kinds_say_what_they_are() {
    // A coat of index 1 has a lobe, of weight 0.
    for kind in every_kind().into_iter().filter(|k| *k != plastic(1.0, 1.0, 0.0)) {
        let b = surface(kind, 0.0);
        let lobes = b.lobes();
        let delta_only = lobes.contains(Lobes::SPECULAR) && !lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY);
        assert_eq!(b.is_delta_only(), delta_only, "{kind:?}");
        assert_eq!(b.has_diffuse(), lobes.contains(Lobes::DIFFUSE), "{kind:?}");
        let wo = direction(&b, 0.7, 0.0);
        let deltas = b.delta_lobes(wo, RADIANCE);
        assert_eq!(deltas.iter().flatten().count() > 0, lobes.contains(Lobes::SPECULAR), "{kind:?}");
        // A restriction is kept, and leaves what it admits.
        let drawn = |allowed: Lobes| {
            let draw = |i: usize| b.sample_lobes(wo, allowed, (i as f32 + 0.5) / 64.0, [0.3, 0.1], RADIANCE);
            (0..64).filter_map(draw).collect::<Vec<_>>()
        };
        let (by_delta, others) = (drawn(Lobes::DELTA), drawn(Lobes::NON_DELTA));
        assert_eq!(!by_delta.is_empty(), lobes.contains(Lobes::SPECULAR), "{kind:?}");
        assert_eq!(!others.is_empty(), lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY), "{kind:?}");
        assert!(by_delta.iter().all(|d| d.is_delta()) && !others.iter().any(|d| d.is_delta()));
    }
    assert!(conductor_is_glossy(1e-9), "a tiny roughness is no delta");
    assert!(size_of::<Bsdf>() <= 128);
}

fn conductor_is_glossy(alpha: f32) -> bool {
    surface(conductor(alpha), 0.0).lobes().contains(Lobes::GLOSSY)
}

/// A rough surface tends to the smooth one.
#[test]
fn small_roughness_tends_to_the_delta() {
    let (rough, smooth) = (surface(conductor(1e-4), 0.0), surface(conductor(0.0), 0.0));
    for cos_theta in [0.9, 0.5, 0.2] {
        let wo = direction(&smooth, cos_theta, 1.0);
        let lobe = smooth.delta_lobes(wo, RADIANCE)[0].unwrap();
        let f = fresnel_conductor(cos_theta, GOLD.0, GOLD.1);
        assert!((lobe.weight.0 - f.0).abs().max_element() < 1e-5);
        assert!((mean_weight(&rough, wo, 64).mean - f64::from(f.0.x)).abs() < 2e-3);
        let d = rough.sample(wo, 0.9, [0.3, 0.7], RADIANCE).unwrap();
        assert!((d.wi - lobe.wi).length() < 1e-2);
    }
}

/// The general kinds contain the plain ones.
#[test]
fn general_kinds_contain_plain_ones() {
    let (n, k) = GOLD;
    let (facets, film, one) = (Facets::Conserving, Film::NONE, Lanes::ONE);
    let albedo = Lanes::rgb(0.8, 0.3, 0.1);
    for a in [0.0, 0.05, 0.4] {
        let alpha = [a; 2];
        let pairs = [
            (conductor(a), BsdfKind::RoughConductor { n, k, reflectance: one, alpha, facets, film }),
            (
                plastic(0.8, 1.5, a),
                BsdfKind::CoatedDiffuse { albedo, specular: one, eta: 1.5, alpha, facets },
            ),
            (
                BsdfKind::Diffuse { albedo },
                BsdfKind::DiffuseTransmission { reflectance: albedo, transmittance: Lanes::ZERO },
            ),
            (BsdfKind::Diffuse { albedo }, BsdfKind::RoughDiffuse { albedo, roughness: 0.0 }),
        ];
        for (plain, general) in pairs {
            let (p, g) = (surface(plain, 0.0), surface(general, 0.0));
            for cos in [0.9, 0.3] {
                let (wo, wi) = (direction(&p, cos, 0.1), direction(&p, 0.7, 3.0));
                let (a, b) = (p.eval(wo, wi, RADIANCE), g.eval(wo, wi, RADIANCE));
                assert!((a - b).0.abs().max_element() <= 1e-5 * a.max(), "{general:?}: {a:?} {b:?}");
                let (a, b) = (p.pdf_w(wo, wi, RADIANCE), g.pdf_w(wo, wi, RADIANCE));
                assert!((a - b).abs() <= 1e-5 * a, "{general:?}: {a} {b}");
                let [a, b] = [p, g].map(|s| s.delta_lobes(wo, RADIANCE)[0].map(|l| l.weight.to_rgb()));
                assert_eq!(a, b, "{general:?}");
            }
        }
    }
}

/// Rough glass tends to smooth glass, on both sides and in both modes; and radiance is scaled against flux by η².
#[test]
fn rough_glass_tends_to_the_delta() {
    let (reflectance, transmittance) = (Lanes::ONE, Lanes::ONE);
    let (facets, film) = (Facets::Conserving, Film::NONE);
    let rough = |a: f32| {
        let alpha = [a; 2];
        surface(BsdfKind::RoughDielectric { eta: 1.5, alpha, reflectance, transmittance, facets, film }, 0.0)
    };
    let (smooth, fine) = (surface(GLASS, 0.0), rough(1e-3));
    for cos in [0.9, 0.5, -0.95, -0.8] {
        let wo = direction(&smooth, cos, 1.0);
        for mode in [RADIANCE, TransportMode::Importance] {
            for lobe in smooth.delta_lobes(wo, mode).into_iter().flatten() {
                let side = if lobe.eta == 1.0 { Lobes::REFLECTION } else { Lobes::TRANSMISSION };
                let draw = |i: usize| {
                    let u = [(i as f32 + 0.5) / 64.0, (i as f32 * 0.618).fract()];
                    fine.sample_lobes(wo, Lobes::GLOSSY | side, 0.99, u, mode)
                };
                let drawn: Vec<_> = (0..64).filter_map(draw).collect();
                let mean = drawn.iter().map(|d| d.weight.max()).sum::<f32>() / 64.0;
                assert!((mean / lobe.weight.max() - 1.0).abs() < 0.02, "{cos} {mode:?}: {mean} {lobe:?}");
                assert!(drawn.iter().all(|d| (d.eta - lobe.eta).abs() < 1e-6));
                let near = drawn.iter().filter(|d| (d.wi - lobe.wi).length() < 0.01).count();
                assert!(near > 32, "{cos} {mode:?}: {near} of 64 near {lobe:?}");
            }
        }
    }
    let b = rough(0.3);
    for cos in [0.7, -0.95] {
        let wo = direction(&b, cos, 0.0);
        let allowed = Lobes::GLOSSY | Lobes::TRANSMISSION;
        let draw = |mode| b.sample_lobes(wo, allowed, 0.9, [0.7, 0.6], mode).unwrap();
        let (radiance, flux) = (draw(RADIANCE), draw(TransportMode::Importance));
        let ratio = flux.weight.max() / radiance.weight.max() / (flux.eta * flux.eta);
        assert!((ratio - 1.0).abs() < 1e-5 && flux.wi == radiance.wi, "{ratio}");
    }
}

/// The slab's two faces: R = 2F/(1 + F), and what is not reflected goes straight on.
#[test]
fn thin_glass_in_closed_form() {
    let (reflectance, transmittance) = (Lanes::ONE, Lanes::ONE);
    let kind = BsdfKind::ThinDielectric { eta: 1.5, alpha: [0.0; 2], reflectance, transmittance };
    let b = surface(kind, 0.0);
    for cos in [1.0, 0.4, -0.1] {
        let wo = direction(&b, cos, 2.0);
        let [r, t] = b.delta_lobes(wo, RADIANCE).map(Option::unwrap);
        let f = fresnel_dielectric(b.abs_cos(wo), 1.5);
        assert!((r.weight.max() - 2.0 * f / (1.0 + f)).abs() < 1e-6);
        assert!((r.weight.max() + t.weight.max() - 1.0).abs() < 1e-6);
        assert!((t.wi + wo).length() < 1e-6 && t.eta == 1.0);
    }
}

/// Veach's factor makes the scattering of a photon with a tilted shading normal the adjoint of that of radiance:
/// f·|wi·ns|/|wi·ng| is exchanged for f·|wo·ns|/|wo·ng|.
#[test]
fn shading_correction() {
    let b = surface(DIFFUSE, 30.0);
    let (wo, wi) = (direction(&b, 0.8, 1.0), direction(&b, 0.5, 1.5));
    let ratio = |w: Vec3| b.abs_cos(w) / w.dot(b.ng()).abs();
    assert!((b.shading_correction(wo, wi) * ratio(wi) - ratio(wo)).abs() < 1e-6);
    assert_eq!(surface(DIFFUSE, 0.0).shading_correction(wo, wi), 1.0);
}

/// Samples of facets weigh little whatever the roughness and the angle: no fireflies are born in a BSDF (normals drawn by D·cosθ
/// would weigh up to G(o)/cosθ: Walter et al. 2007, §5.3).
#[test]
fn weights_are_bounded() {
    let mut s = Sampler::new(9, 0, Domain::Other, 0);
    let one = Lanes::ONE;
    let mut greatest = |kind: BsdfKind| {
        let b = surface(kind, 0.0);
        let mut most = 0f32;
        for i in 0..4000 {
            let cos = [1.0, 0.5, 0.1, 0.02, -0.8, -0.3, -0.05][i % 7];
            let wo = direction(&b, cos, 6.0 * s.next_1d());
            let drawn = b.sample(wo, s.next_1d(), s.next_2d(), TransportMode::Importance);
            most = most.max(drawn.map_or(0.0, |d| d.weight.0.x));
        }
        most
    };
    for alpha in [[1e-3; 2], [0.05; 2], [0.3; 2], [1.0; 2], [0.9, 0.1], [0.02, 0.3]] {
        for (facets, bound) in [
            (Facets::Conserving, 2.5),
            (Facets::SingleBounce, 1.001),
            (Facets::Separable, 1.001),
            (Facets::Beckmann, 2.7),
        ] {
            let film = Film::NONE;
            let (n, k) = (Lanes::ZERO, Lanes::splat(5.0));
            let metal = BsdfKind::RoughConductor { n, k, reflectance: one, alpha, facets, film };
            let eta = 1.5;
            let glass =
                BsdfKind::RoughDielectric { eta, alpha, reflectance: one, transmittance: one, facets, film };
            for kind in [metal, glass] {
                let most = greatest(kind);
                assert!(most < bound, "{kind:?}: {most}");
            }
        }
    }
}
