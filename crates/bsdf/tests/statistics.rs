//! χ² of every sampler against its density, and of both against f, over a grid of parameters and directions.

mod common;

use color::Lanes;
use common::{check, conductor, direction, phong, plastic, surface};
use nephroid_bsdf::{BsdfKind, Lobes};
use testkit::{Settings, significance};

/// (cosine of wo to the shading normal, tilt of the geometric normal in degrees).
const GEOMETRY: [(f32, f32); 6] =
    [(1.0, 0.0), (0.6, 0.0), (0.1, 0.0), (0.01, 0.0), (-0.5, 25.0), (0.3, 40.0)];

/// Tests in this file: kinds × geometry × about three p-values.
const TESTS: usize = 18 * 5 * 3;

fn check_all(kinds: &[BsdfKind], allowed: Lobes) {
    check_rounded(kinds, &GEOMETRY, allowed, Settings::default().rounding);
}

/// `rounding`: narrow lobes near grazing incidence amplify the rounding of directions to `f32` (of 6e-8, by
/// 1/(α cosθ)).
fn check_rounded(kinds: &[BsdfKind], geometry: &[(f32, f32)], allowed: Lobes, rounding: f64) {
    let level = significance(0.01, TESTS);
    for (i, &kind) in kinds.iter().enumerate() {
        for (j, (cos_theta, tilt)) in geometry.iter().copied().enumerate() {
            let b = surface(kind, tilt);
            let wo = direction(&b, cos_theta, 2.0);
            let settings = Settings { seed: (10 * i + j) as u64, rounding, ..Settings::default() };
            let report = check(&b, wo, allowed, &settings);
            assert_eq!(report.failures(level), [""; 0], "{kind:?}, cos {cos_theta}, tilt {tilt}: {report:?}");
            assert!(report.albedo() <= 1.01, "{kind:?}, cos {cos_theta}, tilt {tilt}: {report:?}");
        }
    }
}

#[test]
fn diffuse() {
    check_all(&[BsdfKind::Diffuse { albedo: Lanes::rgb(0.7, 0.5, 0.2) }], Lobes::ALL);
}

#[test]
fn phong_of_every_exponent() {
    check_all(&[0.0, 10.0, 1e5].map(phong), Lobes::ALL);
}

#[test]
fn phong_by_lobe() {
    check_all(&[phong(20.0)], Lobes::DIFFUSE | Lobes::REFLECTION);
    check_all(&[phong(20.0)], Lobes::GLOSSY | Lobes::REFLECTION);
}

#[test]
fn conductor_smoother() {
    // At 1e-4 and cos 0.01 the lobe is as narrow as the rounding of directions.
    check_rounded(&[1e-4].map(conductor), &[(1.0, 0.0), (0.1, 0.0)], Lobes::ALL, 0.05);
    check_all(&[0.01].map(conductor), Lobes::ALL);
}

#[test]
fn conductor_rougher() {
    check_all(&[0.1, 0.4, 1.0].map(conductor), Lobes::ALL);
}

#[test]
fn plastic_with_a_smooth_coat() {
    check_all(&[plastic(0.8, 1.5, 0.0), plastic(0.0, 1.5, 0.0)], Lobes::ALL);
    check_all(&[plastic(0.8, 1.5, 0.0)], Lobes::NON_DELTA);
}

#[test]
fn plastic_with_a_rough_coat() {
    check_rounded(&[plastic(0.8, 1.5, 1e-3)], &GEOMETRY, Lobes::ALL, 0.05);
    let kinds = [plastic(0.8, 1.5, 0.1), plastic(0.5, 2.0, 0.5)];
    check_all(&kinds, Lobes::ALL);
    check_all(&[plastic(0.8, 1.5, 0.3)], Lobes::GLOSSY | Lobes::REFLECTION);
}

/// The tests above would see an error of 2 %: α of the density off by 2 % from that of the sampler, an exponent, or
/// the share of a lobe.
#[test]
fn planted_errors_fail() {
    let level = significance(0.01, TESTS);
    let more_specular = match phong(30.0) {
        BsdfKind::Phong { diffuse, specular, exponent } => {
            BsdfKind::Phong { diffuse, specular: specular * 1.06, exponent } // probability 0.6 → 0.614
        }
        other => other,
    };
    for (right, wrong) in [
        (conductor(0.01), conductor(0.0102)),
        (conductor(0.3), conductor(0.306)),
        (phong(300.0), phong(306.0 + 3.0)),
        (phong(30.0), more_specular),
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
