//! χ² of the kinds beyond the plain ones, over a grid of parameters and directions.

mod common;

use color::Lanes;
use common::{
    check, coated_conductor, coated_diffuse, direction, glass, principled_kinds, rough_conductor, surface,
    thin,
};
use nephroid_bsdf::{BsdfKind, Facets, Film, Lobes};
use testkit::{Settings, significance};

/// (cosine of wo to the shading normal, tilt of the geometric normal in degrees).
const GEOMETRY: [(f32, f32); 2] = [(0.75, 0.0), (-0.2, 25.0)];

/// Tests in this file: kinds × geometry × about three p-values.
const TESTS: usize = 52 * 2 * 3;

fn check_all(kinds: &[BsdfKind], allowed: Lobes) {
    let level = significance(0.01, TESTS);
    for (i, &kind) in kinds.iter().enumerate() {
        for (j, (cos_theta, tilt)) in GEOMETRY.iter().copied().enumerate() {
            let b = surface(kind, tilt);
            let wo = direction(&b, cos_theta, 2.0);
            let settings = Settings { seed: (10 * i + j) as u64, draws: 200_000, ..Settings::default() };
            let report = check(&b, wo, allowed, &settings);
            assert_eq!(report.failures(level), [""; 0], "{kind:?}, cos {cos_theta}, tilt {tilt}: {report:?}");
        }
    }
}

#[test]
fn wide_lobes() {
    let (reflectance, transmittance) = (Lanes::rgb(0.3, 0.2, 0.0), Lanes::rgb(0.5, 0.6, 0.1));
    let kinds = [
        BsdfKind::RoughDiffuse { albedo: Lanes::rgb(0.8, 0.5, 0.1), roughness: 0.9 },
        BsdfKind::DiffuseTransmission { reflectance, transmittance },
        BsdfKind::Sheen { color: Lanes::rgb(0.9, 0.5, 0.1), alpha: 0.3 },
        BsdfKind::Sheen { color: Lanes::rgb(0.9, 0.5, 0.1), alpha: 0.1 },
    ];
    check_all(&kinds, Lobes::ALL);
    check_all(&kinds[1..2], Lobes::DIFFUSE | Lobes::TRANSMISSION);
}

#[test]
fn conductors() {
    let film = Film::new(350.0, 1.4);
    check_all(
        &[
            rough_conductor([0.3, 0.05], Facets::Conserving, Film::NONE),
            rough_conductor([0.1, 0.6], Facets::Conserving, film),
            rough_conductor([0.3, 0.3], Facets::SingleBounce, Film::NONE),
            rough_conductor([0.1, 0.2], Facets::Beckmann, Film::NONE),
        ],
        Lobes::ALL,
    );
}

#[test]
fn dielectrics() {
    let film = Film::new(350.0, 1.3);
    check_all(
        &[
            glass(1.5, [0.05; 2], Facets::Conserving, Film::NONE),
            glass(1.5, [0.5; 2], Facets::Conserving, Film::NONE),
            glass(1.0 / 1.33, [0.2; 2], Facets::Conserving, Film::NONE),
            glass(1.5, [0.3, 0.1], Facets::Conserving, film),
            glass(1.8, [0.3; 2], Facets::SingleBounce, Film::NONE),
            glass(1.5, [0.2, 0.1], Facets::Beckmann, Film::NONE),
        ],
        Lobes::ALL,
    );
}

#[test]
fn dielectrics_by_lobe() {
    let kinds = [glass(1.5, [0.3; 2], Facets::Conserving, Film::NONE), thin(1.5, [0.3; 2])];
    check_all(&kinds, Lobes::GLOSSY | Lobes::REFLECTION);
    check_all(&kinds, Lobes::GLOSSY | Lobes::TRANSMISSION);
    check_all(&[thin(1.5, [0.2, 0.4])], Lobes::ALL);
}

#[test]
fn coats() {
    check_all(
        &[
            coated_diffuse([0.1, 0.3], Facets::Conserving),
            coated_diffuse([0.2, 0.2], Facets::Beckmann),
            coated_conductor([0.1, 0.1], 0.0, 0.05),
            coated_conductor([0.3, 0.6], 0.1, 0.0),
            coated_conductor([0.0, 0.0], 0.3, 0.0),
        ],
        Lobes::ALL,
    );
    check_all(&[coated_conductor([0.2, 0.2], 0.0, 0.05)], Lobes::NON_DELTA);
}

#[test]
fn principled() {
    check_all(&principled_kinds(), Lobes::ALL);
}

/// An error of 2 % in what these lobes have that plainer ones have not would be seen.
#[test]
fn planted_errors_fail() {
    let level = significance(0.01, TESTS);
    let conserving = |a| rough_conductor(a, Facets::Conserving, Film::NONE);
    let rough_glass = |eta, a: f32| glass(eta, [a; 2], Facets::Conserving, Film::NONE);
    for (right, wrong) in [
        (conserving([0.3, 0.1]), conserving([0.306, 0.1])),
        (conserving([0.3, 0.1]), conserving([0.1, 0.3])),
        (rough_glass(1.5, 0.2), rough_glass(1.53, 0.2)),
        (rough_glass(1.5, 0.2), rough_glass(1.5, 0.204)),
        (coated_conductor([0.2; 2], 0.0, 0.0), coated_conductor([0.206; 2], 0.0, 0.0)),
    ] {
        let (a, b) = (surface(right, 0.0), surface(wrong, 0.0));
        let wo = direction(&a, 0.6, 2.0);
        let t = testkit::chi2_sphere(
            &Settings::default(),
            |s| a.sample(wo, s.next_1d(), s.next_2d(), common::RADIANCE).map(|s| s.wi),
            |wi| f64::from(b.pdf_w(wo, wi, common::RADIANCE)),
        );
        assert!(!t.failures(level).is_empty(), "{right:?} {t:?}");
    }
}

/// Both roughnesses, anisotropy and grazing angles.
#[test]
fn anisotropic_and_grazing() {
    let level = significance(0.01, TESTS);
    let settings = |seed| Settings { seed, draws: 200_000, rounding: 0.02, ..Settings::default() };
    let mut seed = 1000;
    for alpha in [[0.9, 0.1], [0.02, 0.3]] {
        for facets in [Facets::Conserving, Facets::Separable, Facets::Beckmann] {
            for kind in [rough_conductor(alpha, facets, Film::NONE), glass(1.5, alpha, facets, Film::NONE)] {
                for cos_theta in [0.9, 0.05] {
                    let b = surface(kind, 0.0);
                    seed += 1;
                    let report = check(&b, direction(&b, cos_theta, 0.4), Lobes::ALL, &settings(seed));
                    assert_eq!(report.failures(level), [""; 0], "{kind:?}, cos {cos_theta}: {report:?}");
                }
            }
        }
    }
}
