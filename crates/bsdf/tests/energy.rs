//! White furnaces: what surfaces that absorb nothing return, and that none returns more than it gets.

mod common;

use color::Lanes;
use common::{direction, further_kinds, principled, surface};
use nephroid_bsdf::{
    Bsdf, BsdfKind, Facets, Film, Interior, PrincipledParameters, TransportMode, absorbing_coat_albedo,
    fresnel_conductor, fresnel_dielectric, fresnel_dielectric_mean, linear_plastic_albedo,
};

const ALPHAS: [f32; 6] = [1e-3, 0.01, 0.1, 0.3, 0.6, 1.0];
const COSINES: [f32; 6] = [1.0, 0.7, 0.4, 0.15, 0.05, 0.015];

/// Share of the flux from the direction at `cos` that is scattered, in three lanes: the mean over an additive recurrence in
/// the three numbers (Roberts 2018), whose error falls nearly as their count.
fn energy(b: &Bsdf, cos: f32, phi: f32) -> [f64; 3] {
    const N: u32 = 6000;
    let wo = direction(b, cos, phi);
    let mut sums = [0.0; 3];
    for i in 0..N {
        let at = |step: f64| ((0.5 + step * f64::from(i)).fract() as f32).min(math::ONE_MINUS_EPSILON);
        let u = [at(0.671_043_606_703_789_2), at(0.549_700_477_901_970_3)];
        if let Some(d) = b.sample(wo, at(0.819_172_513_396_164_4), u, TransportMode::Importance) {
            for (sum, w) in sums.iter_mut().zip(d.weight.to_rgb()) {
                *sum += f64::from(w);
            }
        }
    }
    sums.map(|s| s / f64::from(N))
}

/// Extremes over angles and azimuths of the first lane.
fn range(kind: BsdfKind, cosines: &[f32]) -> [f64; 2] {
    let b = surface(kind, 0.0);
    let mut r = [f64::INFINITY, 0.0f64];
    for &cos in cosines {
        for phi in [0.1, 1.4] {
            let e = energy(&b, cos, phi)[0];
            r = [r[0].min(e), r[1].max(e)];
        }
    }
    r
}

fn white_metal(alpha: [f32; 2]) -> BsdfKind {
    let (n, k) = (Lanes::ZERO, Lanes::splat(5.0));
    let (facets, film) = (Facets::Conserving, Film::NONE);
    BsdfKind::RoughConductor { n, k, reflectance: Lanes::ONE, alpha, facets, film }
}

/// That both extremes lie within `bound` of 1.
fn returns_all(kind: BsdfKind, cosines: &[f32], bound: f64) {
    let [low, high] = range(kind, cosines);
    assert!(low > 1.0 - bound && high < 1.0 + bound, "{kind:?}: {low:.4} … {high:.4}");
}

fn white_glass(eta: f32, alpha: [f32; 2], film: Film) -> BsdfKind {
    let (reflectance, transmittance, facets) = (Lanes::ONE, Lanes::ONE, Facets::Conserving);
    BsdfKind::RoughDielectric { eta, alpha, reflectance, transmittance, facets, film }
}

#[test]
fn white_metals() {
    for alpha in ALPHAS {
        returns_all(white_metal([alpha; 2]), &COSINES, 0.01);
        for ratio in [0.6, 0.3, 0.02] {
            returns_all(white_metal([alpha * ratio, alpha]), &COSINES, 0.013);
        }
    }
}

#[test]
fn white_glass_of_every_roughness() {
    for alpha in ALPHAS {
        for eta in [1.1, 1.33, 1.5, 2.4] {
            returns_all(white_glass(eta, [alpha; 2], Film::NONE), &COSINES, 0.01);
            // From inside, where half of the light is reflected totally.
            returns_all(white_glass(eta, [alpha; 2], Film::NONE), &COSINES.map(|c| -c), 0.015);
        }
        // Losses are those of the bare interface.
        returns_all(white_glass(1.5, [alpha; 2], Film::new(400.0, 1.3)), &COSINES, 0.025);
    }
    for (alpha, ratio) in [(0.05, 0.3), (0.3, 0.3), (1.0, 0.05)] {
        for eta in [1.1, 1.5] {
            let kind = white_glass(eta, [alpha, alpha * ratio], Film::NONE);
            returns_all(kind, &COSINES, 0.013);
            returns_all(kind, &COSINES.map(|c| -c), 0.02);
        }
    }
}

#[test]
fn white_slabs_and_coats() {
    let coated = |alpha| BsdfKind::CoatedDiffuse {
        albedo: Lanes::ONE,
        specular: Lanes::ONE,
        eta: 1.5,
        alpha,
        facets: Facets::Conserving,
    };
    for alpha in ALPHAS {
        let thin = |alpha| BsdfKind::ThinDielectric {
            eta: 1.5,
            alpha,
            reflectance: Lanes::ONE,
            transmittance: Lanes::ONE,
        };
        returns_all(thin([alpha; 2]), &COSINES, 0.01);
        returns_all(thin([alpha, alpha * 0.2]), &COSINES, 0.013);
        returns_all(coated([alpha; 2]), &COSINES, 0.01);
        returns_all(coated([alpha, alpha * 0.3]), &COSINES, 0.013);
        let rough = BsdfKind::RoughDiffuse { albedo: Lanes::ONE, roughness: alpha };
        returns_all(rough, &COSINES, 0.01);
    }
}

#[test]
fn white_coated_metals() {
    for eta in [1.2, 1.5, 2.0] {
        for alpha in ALPHAS {
            for coat_alpha in [0.0, 0.1, 0.5] {
                let oval = (alpha == 0.6 && eta == 1.5).then_some([alpha, 0.2 * alpha]);
                for alpha in [Some([alpha; 2]), oval].into_iter().flatten() {
                    let (n, k, depth) = (Lanes::ZERO, Lanes::splat(5.0), 0.0);
                    let facets = Facets::Conserving;
                    let kind = BsdfKind::CoatedConductor { n, k, alpha, eta, coat_alpha, depth, facets };
                    returns_all(kind, &COSINES, 0.015);
                }
            }
        }
    }
}

/// The smooth coat over a smooth metal has a closed form.
#[test]
fn a_smooth_coat_over_a_smooth_metal() {
    let kind = common::coated_conductor([0.0; 2], 0.0, 0.1);
    let b = surface(kind, 0.0);
    for cos in COSINES {
        let wo = direction(&b, cos, 1.0);
        let inner = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
        let f = fresnel_dielectric(cos, 1.5);
        let r = fresnel_conductor(inner, common::GOLD.0 / 1.5, common::GOLD.1 / 1.5).0.x;
        let a = (-0.2 / inner).exp();
        let expected = f + (1.0 - f) * (1.0 - f) * r * a / (1.0 - f * r * a);
        let found = b.delta_lobes(wo, TransportMode::Radiance)[0].unwrap().weight.0.x;
        assert!((found - expected).abs() < 1e-5, "{cos}: {found} {expected}");
    }
}

#[test]
fn white_principled() {
    for alpha in ALPHAS {
        let p = PrincipledParameters { base_color: Lanes::ONE, alpha: [alpha; 2], ..Default::default() };
        let clearcoat = PrincipledParameters { clearcoat: 1.0, clearcoat_alpha: 0.05, ..p };
        let sheen = PrincipledParameters { sheen_color: Lanes::ONE, ..p };
        let sheet = PrincipledParameters { transmission: 1.0, interior: Interior::Thin, ..p };
        for (p, bound) in [
            (p, 0.01),
            (PrincipledParameters { metallic: 1.0, ..p }, 0.01),
            (PrincipledParameters { transmission: 1.0, ..p }, 0.01),
            (sheet, 0.01),
            (PrincipledParameters { film: Film::new(300.0, 2.0), film_weight: 0.8, ..sheet }, 0.01),
            (PrincipledParameters { diffuse_transmission: 0.5, ..p }, 0.01),
            (clearcoat, 0.01),
            (PrincipledParameters { metallic: 1.0, ..clearcoat }, 0.013),
            (sheen, 0.01),
            (PrincipledParameters { metallic: 0.5, ..sheen }, 0.015),
            (PrincipledParameters { clearcoat: 0.7, ..sheen }, 0.02),
        ] {
            returns_all(principled(p), &COSINES, bound);
        }
    }
}

#[test]
fn nothing_gains() {
    for kind in further_kinds() {
        let b = surface(kind, 0.0);
        let bound = 1.015;
        for cos in COSINES {
            for cos in [cos, -cos] {
                let e = energy(&b, cos, 0.5);
                assert!(e.iter().all(|&e| e < bound), "{kind:?} at {cos}: {e:?}");
            }
        }
    }
}

/// [`nephroid_bsdf::absorbing_coat_albedo`] and its like keep what needs no keeping.
#[test]
fn coat_conversions() {
    let a = Lanes::rgb(0.0, 0.5, 1.0);
    let same = absorbing_coat_albedo(a, 1.5, 0.0, 1000);
    assert!((same - a).0.abs().max_element() < 2e-3, "{same:?}");
    let less = absorbing_coat_albedo(a, 1.5, 0.01, 5);
    assert!(less.0.y < 0.49 && less.0.z < 0.96 && less.0.z > 0.8, "{less:?}");
    // a/(1 − F) instead of a/(1 − aF): less where a < 1.
    let linear = linear_plastic_albedo(a, 1.5, [0.0; 2], Facets::Conserving);
    let f = fresnel_dielectric_mean(1.0 / 1.5);
    assert!((linear.0.y / (1.0 - linear.0.y * f) - 0.5 / (1.0 - f)).abs() < 1e-5 && linear.0.z == 1.0);
}
