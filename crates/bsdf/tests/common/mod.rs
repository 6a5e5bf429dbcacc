//! What the tests of scattering functions share: surfaces, directions and the check of one pair of them.

use color::Lanes;
use math::{Frame, Vec3};
use nephroid_bsdf::{Bsdf, BsdfKind, Lobes, TransportMode};
use sampling::{Domain, Sampler};
use testkit::{DirectionDraw, DirectionReport, Moments, Settings, check_directions};

pub const RADIANCE: TransportMode = TransportMode::Radiance;

/// A metal like gold: red, green, blue.
pub const GOLD: (Lanes, Lanes) = (Lanes::rgb(0.16, 0.42, 1.51), Lanes::rgb(3.8, 2.4, 1.88));

pub fn conductor(alpha: f32) -> BsdfKind {
    BsdfKind::Conductor { n: GOLD.0, k: GOLD.1, alpha }
}

/// Reflects all light: a real index of 0 leaves nothing to absorb.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn white_conductor(alpha: f32) -> BsdfKind {
    BsdfKind::Conductor { n: Lanes::ZERO, k: Lanes::splat(5.0), alpha }
}

pub fn plastic(albedo: f32, eta: f32, alpha: f32) -> BsdfKind {
    BsdfKind::Plastic { albedo: Lanes::rgb(albedo, 0.3, 0.1), eta, alpha }
}

pub fn phong(exponent: f32) -> BsdfKind {
    BsdfKind::Phong { diffuse: Lanes::rgb(0.4, 0.3, 0.1), specular: Lanes::rgb(0.5, 0.6, 0.4), exponent }
}

/// A surface that faces no axis, its shading normal tilted against the geometric one by `tilt` degrees.
pub fn surface(kind: BsdfKind, tilt: f32) -> Bsdf {
    let frame = Frame::from_zx(Vec3::new(0.48, -0.6, 0.64), Vec3::new(0.3, 0.9, -0.2));
    let (s, c) = tilt.to_radians().sin_cos();
    Bsdf::new(kind, frame, (frame.z * c + frame.y * s).normalize())
}

/// The direction at `cos_theta` from the shading normal and azimuth `phi`.
pub fn direction(b: &Bsdf, cos_theta: f32, phi: f32) -> Vec3 {
    b.frame().to_world(math::spherical_direction(cos_theta, phi)).normalize()
}

/// Runs the whole check of `testkit` on the admitted lobes, in the first lane.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn check(b: &Bsdf, wo: Vec3, allowed: Lobes, settings: &Settings) -> DirectionReport {
    let lane = |l: Lanes| f64::from(l.0.x);
    check_directions(
        settings,
        |u_lobe, u| {
            b.sample_lobes(wo, allowed, u_lobe, u, RADIANCE).map(|s| DirectionDraw {
                direction: s.wi,
                weight: lane(s.weight),
                pdf_w: f64::from(s.pdf_w),
                delta: s.is_delta(),
            })
        },
        |wi| f64::from(b.pdf_w_lobes(wo, wi, allowed, RADIANCE)),
        |wi| lane(b.eval_lobes(wo, wi, allowed, RADIANCE)) * f64::from(b.abs_cos(wi)),
    )
}

/// Mean weight over stratified numbers: the directional albedo in the first lane. Its error is less than its
/// standard error as the strata see it.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn mean_weight(b: &Bsdf, wo: Vec3, side: usize) -> Moments {
    let mut s = Sampler::new(3, 0, Domain::Other, 0);
    Moments::of((0..side * side).map(|i| {
        let jitter = s.next_2d();
        let at = |k: usize, j: f32| ((k as f32 + j) / side as f32).min(math::ONE_MINUS_EPSILON);
        // The golden ratio spreads the number of the lobe over the strata.
        let u_lobe = (i as f32 * 0.618_034 + jitter[0]).fract();
        b.sample(wo, u_lobe, [at(i % side, jitter[0]), at(i / side, jitter[1])], RADIANCE)
            .map_or(0.0, |s| f64::from(s.weight.0.x))
    }))
}
