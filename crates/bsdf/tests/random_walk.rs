//! Layered kinds against a random walk between their two layers, as pbrt-v4 renders them: the walk is the truth for single
//! bounces at the interface and the base.

mod common;

use color::Lanes;
use common::{GOLD, direction, surface};
use math::Vec3;
use nephroid_bsdf::{Bsdf, BsdfKind, Facets, Film, TransportMode, absorbing_coat_albedo};
use sampling::{Domain, Sampler};

const IMPORTANCE: TransportMode = TransportMode::Importance;

fn interface(eta: f32, alpha: f32, facets: Facets) -> Bsdf {
    let (reflectance, transmittance, film) = (Lanes::ONE, Lanes::ONE, Film::NONE);
    let alpha = [alpha; 2];
    surface(BsdfKind::RoughDielectric { eta, alpha, reflectance, transmittance, facets, film }, 0.0)
}

/// Mean of `measure(direction, weight)` over walks that enter from `wo`: a crossing of the layer between the two loses
/// e^(−depth/cos).
fn walk(interface: &Bsdf, base: &Bsdf, wo: Vec3, depth: f32, n: u32, mut measure: impl FnMut(Vec3, Lanes)) {
    let mut s = Sampler::new(11, 0, Domain::Other, 0);
    for _ in 0..n {
        let (mut at, mut weight) = (wo, Lanes::ONE);
        for _ in 0..400 {
            let Some(d) = interface.sample(at, s.next_1d(), s.next_2d(), IMPORTANCE) else { break };
            weight *= d.weight;
            if interface.ns().dot(d.wi) > 0.0 {
                measure(d.wi, weight);
                break;
            }
            let pass = |w: Vec3| (-depth / interface.abs_cos(w)).exp();
            let Some(b) = base.sample(-d.wi, s.next_1d(), s.next_2d(), IMPORTANCE) else { break };
            weight *= b.weight * (pass(d.wi) * pass(b.wi));
            at = -b.wi;
        }
    }
}

/// Albedo of the walk and of the model, in the first three lanes.
fn albedos(kind: BsdfKind, interface: &Bsdf, base: &Bsdf, cos: f32, depth: f32) -> ([f32; 3], [f32; 3]) {
    const N: u32 = 20_000;
    let wo = direction(interface, cos, 0.4);
    let mut sum = Lanes::ZERO;
    walk(interface, base, wo, depth, N, |_, w| sum += w);
    let b = surface(kind, 0.0);
    let mut model = Lanes::ZERO;
    let mut s = Sampler::new(12, 0, Domain::Other, 0);
    for _ in 0..N {
        if let Some(d) = b.sample(wo, s.next_1d(), s.next_2d(), IMPORTANCE) {
            model += d.weight;
        }
    }
    ((sum / N as f32).to_rgb(), (model / N as f32).to_rgb())
}

/// Greatest relative difference of the model's albedo from the walk's, over angles; dark lanes in 0.3 of the brightest.
fn difference(kind: BsdfKind, interface: &Bsdf, base: BsdfKind, depth: f32) -> f32 {
    let base = surface(base, 0.0);
    let mut greatest = 0f32;
    for cos in [1.0, 0.7, 0.4, 0.15] {
        let (walk, model) = albedos(kind, interface, &base, cos, depth);
        let floor = 0.3 * walk[0].max(walk[1]).max(walk[2]);
        for (w, m) in walk.iter().zip(model) {
            greatest = greatest.max((m - w).abs() / w.max(floor));
        }
    }
    greatest
}

/// A Lambertian base under a coat of single bounces: the model is the mean of the walk.
#[test]
fn coated_diffuse() {
    let albedo = Lanes::rgb(0.9, 0.5, 0.1);
    let base = BsdfKind::Diffuse { albedo };
    for alpha in [0.0, 0.1, 0.3, 0.5] {
        for (facets, depth) in
            [(Facets::SingleBounce, 0.0), (Facets::SingleBounce, 0.01), (Facets::Beckmann, 0.0)]
        {
            let specular = Lanes::ONE;
            let kind = BsdfKind::CoatedDiffuse {
                albedo: absorbing_coat_albedo(albedo, 1.5, depth, 100),
                specular,
                eta: 1.5,
                alpha: [alpha; 2],
                facets,
            };
            let d = difference(kind, &interface(1.5, alpha, facets), base, depth);
            assert!(d < 0.03, "{facets:?} {alpha} {depth}: {d}");
        }
    }
}

/// A metal under a coat: an approximation, whose error is bounded here.
#[test]
fn coated_metals() {
    let (n, k) = GOLD;
    for facets in [Facets::Conserving, Facets::SingleBounce] {
        for coat_alpha in [0.0, 0.1, 0.3] {
            for a in [0.1, 0.3, 0.6] {
                let (alpha, reflectance, film) = ([a; 2], Lanes::ONE, Film::NONE);
                let depth = 0.01;
                let kind = BsdfKind::CoatedConductor { n, k, alpha, eta: 1.5, coat_alpha, depth, facets };
                let (n, k) = (n / 1.5, k / 1.5);
                let base = BsdfKind::RoughConductor { n, k, reflectance, alpha, facets, film };
                let d = difference(kind, &interface(1.5, coat_alpha, facets), base, depth);
                let bound = match (facets, coat_alpha) {
                    (Facets::SingleBounce, 0.0) => 0.1,
                    (Facets::SingleBounce, 0.3) => 0.4,
                    _ => 0.22,
                };
                assert!(d < bound, "{facets:?} {coat_alpha} {a}: {d}");
            }
        }
    }
}
