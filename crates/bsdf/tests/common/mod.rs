//! What the tests of scattering functions share: surfaces, directions and the check of one pair of them.

use color::Lanes;
use math::{Frame, Vec3};
use nephroid_bsdf::{
    Bsdf, BsdfKind, Facets, Film, Interior, Lobes, Principled, PrincipledParameters, TransportMode,
};
use sampling::{Domain, Sampler};
use testkit::{DirectionDraw, DirectionReport, Moments, Settings, check_directions};

pub const RADIANCE: TransportMode = TransportMode::Radiance;

/// A metal like gold: red, green, blue.
pub const GOLD: (Lanes, Lanes) = (Lanes::rgb(0.16, 0.42, 1.51), Lanes::rgb(3.8, 2.4, 1.88));

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn conductor(alpha: f32) -> BsdfKind {
    BsdfKind::Conductor { n: GOLD.0, k: GOLD.1, alpha }
}

/// Reflects all light: a real index of 0 leaves nothing to absorb.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn white_conductor(alpha: f32) -> BsdfKind {
    BsdfKind::Conductor { n: Lanes::ZERO, k: Lanes::splat(5.0), alpha }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn plastic(albedo: f32, eta: f32, alpha: f32) -> BsdfKind {
    BsdfKind::Plastic { albedo: Lanes::rgb(albedo, 0.3, 0.1), eta, alpha }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn phong(exponent: f32) -> BsdfKind {
    BsdfKind::Phong { diffuse: Lanes::rgb(0.4, 0.3, 0.1), specular: Lanes::rgb(0.5, 0.6, 0.4), exponent }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn rough_conductor(alpha: [f32; 2], facets: Facets, film: Film) -> BsdfKind {
    let reflectance = Lanes::rgb(0.9, 0.8, 1.0);
    BsdfKind::RoughConductor { n: GOLD.0, k: GOLD.1, reflectance, alpha, facets, film }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn glass(eta: f32, alpha: [f32; 2], facets: Facets, film: Film) -> BsdfKind {
    let (reflectance, transmittance) = (Lanes::ONE, Lanes::rgb(0.9, 0.7, 1.0));
    BsdfKind::RoughDielectric { eta, alpha, reflectance, transmittance, facets, film }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn thin(eta: f32, alpha: [f32; 2]) -> BsdfKind {
    let (reflectance, transmittance) = (Lanes::rgb(0.8, 0.9, 1.0), Lanes::rgb(0.9, 0.7, 1.0));
    BsdfKind::ThinDielectric { eta, alpha, reflectance, transmittance }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn coated_conductor(alpha: [f32; 2], coat_alpha: f32, depth: f32) -> BsdfKind {
    BsdfKind::CoatedConductor {
        n: GOLD.0,
        k: GOLD.1,
        alpha,
        eta: 1.5,
        coat_alpha,
        depth,
        facets: Facets::Conserving,
    }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn coated_diffuse(alpha: [f32; 2], facets: Facets) -> BsdfKind {
    let (albedo, specular) = (Lanes::rgb(0.8, 0.3, 0.1), Lanes::rgb(0.7, 1.0, 1.0));
    BsdfKind::CoatedDiffuse { albedo, specular, eta: 1.5, alpha, facets }
}

#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn principled(p: PrincipledParameters) -> BsdfKind {
    BsdfKind::Principled(Principled::new(&p))
}

/// Principled surfaces, each with a few of the parameters in use.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn principled_kinds() -> Vec<BsdfKind> {
    let base = PrincipledParameters { base_color: Lanes::rgb(0.8, 0.4, 0.1), ..Default::default() };
    let film = Film::new(400.0, 1.4);
    [
        base,
        PrincipledParameters { metallic: 1.0, alpha: [0.3, 0.1], film, film_weight: 0.5, ..base },
        PrincipledParameters { metallic: 0.4, clearcoat: 0.7, clearcoat_alpha: 0.02, ..base },
        PrincipledParameters {
            sheen_color: Lanes::rgb(0.6, 0.7, 0.2),
            diffuse_transmission: 0.4,
            specular: 0.5,
            ..base
        },
        PrincipledParameters { transmission: 1.0, alpha: [0.1; 2], film, ..base },
        PrincipledParameters { transmission: 0.5, alpha: [0.4; 2], clearcoat: 1.0, eta: 1.33, ..base },
        PrincipledParameters { transmission: 0.7, metallic: 0.2, interior: Interior::Thin, ..base },
        PrincipledParameters {
            transmission: 1.0,
            interior: Interior::Thin,
            alpha: [0.3; 2],
            film: Film::new(300.0, 2.0),
            film_weight: 0.9,
            ..base
        },
    ]
    .map(principled)
    .to_vec()
}

/// The kinds beyond the plain ones.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn further_kinds() -> Vec<BsdfKind> {
    use Facets::{Beckmann, Conserving, SingleBounce};
    let film = Film::new(300.0, 1.3);
    let mut kinds = vec![
        BsdfKind::RoughDiffuse { albedo: Lanes::rgb(0.8, 0.5, 0.1), roughness: 0.9 },
        BsdfKind::DiffuseTransmission {
            reflectance: Lanes::rgb(0.3, 0.2, 0.0),
            transmittance: Lanes::rgb(0.5, 0.6, 0.1),
        },
        BsdfKind::Sheen { color: Lanes::rgb(0.9, 0.5, 0.1), alpha: 0.3 },
        thin(1.5, [0.0; 2]),
        thin(1.3, [0.2, 0.4]),
        coated_diffuse([0.0; 2], Conserving),
        coated_diffuse([0.1, 0.3], Conserving),
        coated_diffuse([0.2, 0.2], Beckmann),
        glass(1.0, [0.3; 2], Conserving, Film::NONE),
        glass(1.5, [0.0; 2], Conserving, film),
    ];
    for (alpha, facets, film) in [
        ([0.0, 0.0], Conserving, Film::NONE),
        ([0.01, 0.3], Conserving, Film::NONE),
        ([0.3, 0.3], Conserving, film),
        ([0.2, 0.1], SingleBounce, Film::NONE),
        ([0.2, 0.3], Beckmann, film),
    ] {
        kinds.push(rough_conductor(alpha, facets, film));
        if alpha != [0.0; 2] {
            kinds.push(glass(1.5, alpha, facets, film));
            kinds.push(glass(1.0 / 1.33, alpha, facets, Film::NONE));
        }
    }
    for coat in [0.0, 0.1] {
        kinds.extend([[0.0, 0.0], [0.05, 0.05], [0.3, 0.6]].map(|a| coated_conductor(a, coat, 0.05)));
    }
    kinds.extend(principled_kinds());
    kinds
}

/// A surface that faces no axis, its shading normal tilted against the geometric one by `tilt` degrees.
#[allow(dead_code, reason = "each test file uses its share of this module")]
pub fn surface(kind: BsdfKind, tilt: f32) -> Bsdf {
    let frame = Frame::from_zx(Vec3::new(0.48, -0.6, 0.64), Vec3::new(0.3, 0.9, -0.2));
    let (s, c) = tilt.to_radians().sin_cos();
    Bsdf::new(kind, frame, (frame.z * c + frame.y * s).normalize())
}

/// The direction at `cos_theta` from the shading normal and azimuth `phi`.
#[allow(dead_code, reason = "each test file uses its share of this module")]
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
