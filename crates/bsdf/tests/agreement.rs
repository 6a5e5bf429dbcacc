//! Values of f·|cos θi| that another renderer gives: Mitsuba 3.9.1, variant `scalar_rgb`, radiance mode. The base of
//! its `roughplastic` is up to two per cent darker than the integral makes it, probably by the few angles of which its mean inner
//! reflectance is taken.

mod common;

use color::Lanes;
use common::{GOLD, RADIANCE};
use math::{Frame, Vec3, spherical_direction};
use nephroid_bsdf::{Bsdf, BsdfKind, Facets, Film};

/// (cosine, azimuth) of wo and of wi, and the value in red, green and blue.
type Row = ([f32; 2], [f32; 2], [f32; 3]);

/// The first row that differs by more than `bound`, as text.
fn first_off(kind: BsdfKind, rows: &[Row], bound: f32) -> Option<String> {
    let b = Bsdf::new(kind, Frame { x: Vec3::X, y: Vec3::Y, z: Vec3::Z }, Vec3::Z);
    rows.iter().find_map(|&(o, i, expected)| {
        let [wo, wi] = [o, i].map(|[c, phi]| spherical_direction(c, phi));
        let found = (b.eval(wo, wi, RADIANCE) * b.abs_cos(wi)).to_rgb();
        let near = found.iter().zip(expected).all(|(f, e)| (f - e).abs() < bound * e + 1e-5);
        (!near).then(|| format!("{kind:?} {o:?} {i:?}: {found:?} {expected:?}"))
    })
}

fn within(kind: BsdfKind, rows: &[Row], bound: f32) -> bool {
    first_off(kind, rows, bound).is_none()
}

fn agrees(kind: BsdfKind, rows: &[Row], bound: f32) {
    assert_eq!(first_off(kind, rows, bound), None);
}

fn glass(facets: Facets) -> BsdfKind {
    let (reflectance, transmittance, film) = (Lanes::ONE, Lanes::ONE, Film::NONE);
    BsdfKind::RoughDielectric { eta: 1.5, alpha: [0.3; 2], reflectance, transmittance, facets, film }
}

fn metal(facets: Facets) -> BsdfKind {
    let (n, k) = GOLD;
    let (reflectance, alpha, film) = (Lanes::ONE, [0.3, 0.1], Film::NONE);
    BsdfKind::RoughConductor { n, k, reflectance, alpha, facets, film }
}

fn plastic(facets: Facets) -> BsdfKind {
    let (albedo, specular) = (Lanes::rgb(0.9, 0.5, 0.1), Lanes::ONE);
    BsdfKind::CoatedDiffuse { albedo, specular, eta: 1.5, alpha: [0.3; 2], facets }
}

/// `roughdielectric`, α = 0.3, index 1.5.
#[test]
fn rough_dielectric() {
    let ggx = [
        ([0.9, 0.3], [0.8, 3.0], [0.02521, 0.02521, 0.02521]),
        ([0.9, 0.3], [0.5, 1.0], [0.00127, 0.00127, 0.00127]),
        ([0.5, 0.3], [0.45, 3.3], [0.1066, 0.1066, 0.1066]),
        ([0.3, 1.0], [0.4, 4.5], [0.03738, 0.03738, 0.03738]),
        ([0.8, 0.0], [-0.8, 3.0], [0.62925, 0.62925, 0.62925]),
        ([-0.8, 0.0], [0.6, 3.3], [4.68251, 4.68251, 4.68251]),
        ([0.5, 1.0], [-0.7, 4.0], [1.54784, 1.54784, 1.54784]),
    ];
    let beckmann = [
        ([0.9, 0.3], [0.8, 3.0], [0.03206, 0.03206, 0.03206]),
        ([0.5, 0.3], [0.45, 3.3], [0.14456, 0.14456, 0.14456]),
        ([0.3, 1.0], [0.4, 4.5], [0.04752, 0.04752, 0.04752]),
        ([0.8, 0.0], [-0.8, 3.0], [0.03763, 0.03763, 0.03763]),
        ([-0.8, 0.0], [0.6, 3.3], [7.2108, 7.2108, 7.2108]),
        ([0.5, 1.0], [-0.7, 4.0], [1.89, 1.89, 1.89]),
    ];
    agrees(glass(Facets::Separable), &ggx, 1e-3);
    agrees(glass(Facets::Beckmann), &beckmann, 1e-3);
    // The correlated masking of pbrt differs by more than that.
    assert!(!within(glass(Facets::SingleBounce), &ggx, 1e-3));
}

/// `roughconductor`, α = 0.3 and 0.1.
#[test]
fn rough_conductor() {
    let ggx = [
        ([0.9, 0.3], [0.8, 3.0], [0.40235, 0.3287, 0.1624]),
        ([0.9, 0.3], [0.5, 1.0], [0.00469, 0.00383, 0.00189]),
        ([0.5, 0.3], [0.45, 3.3], [0.73171, 0.60417, 0.32311]),
        ([0.3, 1.0], [0.4, 4.5], [0.4414, 0.36922, 0.2073]),
    ];
    let beckmann = [
        ([0.9, 0.3], [0.8, 3.0], [0.54529, 0.44547, 0.22009]),
        ([0.5, 0.3], [0.45, 3.3], [1.16629, 0.963, 0.51501]),
        ([0.3, 1.0], [0.4, 4.5], [0.20529, 0.17172, 0.09641]),
    ];
    agrees(metal(Facets::Separable), &ggx, 1e-3);
    agrees(metal(Facets::Beckmann), &beckmann, 1e-3);
    assert!(!within(metal(Facets::SingleBounce), &ggx, 1e-3));
}

/// `roughplastic` with `nonlinear`, α = 0.3, index 1.5.
#[test]
fn rough_plastic() {
    let ggx = [
        ([0.9, 0.3], [0.8, 3.0], [0.16992, 0.08877, 0.03572]),
        ([0.9, 0.3], [0.5, 1.0], [0.08663, 0.03876, 0.00747]),
        ([0.5, 0.3], [0.45, 3.3], [0.1773, 0.13765, 0.11174]),
        ([0.3, 1.0], [0.4, 4.5], [0.09427, 0.06237, 0.04151]),
    ];
    let beckmann = [
        ([0.9, 0.3], [0.8, 3.0], [0.20957, 0.10224, 0.04296]),
        ([0.9, 0.3], [0.5, 1.0], [0.10506, 0.04155, 0.00647]),
        ([0.5, 0.3], [0.45, 3.3], [0.23205, 0.17915, 0.14993]),
        ([0.3, 1.0], [0.4, 4.5], [0.11763, 0.07524, 0.05183]),
    ];
    agrees(plastic(Facets::Separable), &ggx, 0.01);
    agrees(plastic(Facets::Beckmann), &beckmann, 0.02);
}
