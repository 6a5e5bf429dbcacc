use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::coat_albedo::{ETA_MAX, coat_albedo, coat_albedo_mean};
use crate::conductor::GLOSSY;
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::facets::{Facets, Micro, half_reflected, is_smooth};
use crate::fresnel::{fresnel_dielectric, fresnel_dielectric_mean};
use crate::lobes::Lobes;
use crate::mirror;
use crate::single_bounce::{Part, single_bounce, single_bounce_mean};

/// A dielectric coat over a diffuse base. With E the directional albedo of the coat (F where it is smooth), E_mean
/// its cosine-weighted mean, and F_in the mean reflectance of the coat seen from the base, light that bounces
/// between base and coat sums to
/// f_d = a (1 − F_in)/(1 − a F_in) · (1 − E(o))(1 − E(i)) / (π (1 − E_mean)).
/// For a smooth coat this is the classic smooth plastic, as (1 − E_mean) = η² (1 − F_in). It is reciprocal, and a
/// white base reflects exactly what the coat does not.
#[derive(Clone, Copy)]
pub(crate) struct Plastic {
    pub eta: f32,
    /// Roughness of the coat; [0, 0]: smooth.
    pub alpha: [f32; 2],
    pub micro: Micro,
    pub facets: Facets,
    /// Factor of what the coat reflects.
    pub specular: Lanes,
    /// [`base`] of this surface.
    pub base: Lanes,
}

/// What `eta` is moved to: [1, 4].
#[inline]
pub(crate) fn clamped(eta: f32) -> f32 {
    eta.clamp(1.0, ETA_MAX)
}

/// 1 − E_mean of the coat.
fn one_minus_mean(eta: f32, alpha: [f32; 2]) -> f32 {
    1.0 - if is_smooth(alpha) { fresnel_dielectric_mean(eta) } else { coat_albedo_mean(alpha, eta) }
}

/// Whether facets of the coat lose what bounces more than once.
fn loses(facets: Facets, alpha: [f32; 2]) -> bool {
    facets != Facets::Conserving && !is_smooth(alpha)
}

/// Means of single bounces at the coat: what it lets in, and what it reflects of light from within.
fn single_means(eta: f32, alpha: [f32; 2], facets: Facets) -> (f32, f32) {
    let mean = |part| single_bounce_mean(part, alpha, eta, facets);
    (mean(Part::Entering), mean(Part::Inner))
}

/// The constant factor of f_d. With single bounces a/(π η² (1 − a·R)), R their mean inner reflectance: then f_d is exactly what
/// a random walk between the coat and a Lambertian base gives.
pub(crate) fn base(albedo: Lanes, eta: f32, alpha: [f32; 2], facets: Facets) -> Lanes {
    let eta = clamped(eta);
    let smooth = !loses(facets, alpha);
    if !smooth {
        let (_, inner) = single_means(eta, alpha, facets);
        return albedo.map(|a| a * FRAC_1_PI / (eta * eta * (1.0 - a * inner)));
    }
    let f_in = fresnel_dielectric_mean(1.0 / eta);
    let scale = FRAC_1_PI * (1.0 - f_in) / one_minus_mean(eta, alpha);
    albedo.map(|a| a * scale / (1.0 - a * f_in))
}

/// The reflectance whose base, lit through the coat of a [`crate::BsdfKind::CoatedDiffuse`], scatters as one of reflectance
/// `albedo` would if the light that the coat throws back onto the base kept no colour: a/(1 − R) instead of a/(1 − a·R), R the
/// mean reflectance of the coat from within. For Mitsuba's `plastic` and `roughplastic` without `nonlinear`. Lanes stay in
/// [0, 1].
pub fn linear_plastic_albedo(albedo: Lanes, eta: f32, alpha: [f32; 2], facets: Facets) -> Lanes {
    let eta = clamped(eta);
    let r = if loses(facets, alpha) {
        single_means(eta, alpha, facets).1
    } else {
        fresnel_dielectric_mean(1.0 / eta)
    };
    albedo.map(|a| a / (1.0 - r + a * r))
}

/// The reflectance of a base under a clear coat of index `eta` that stands for one of reflectance `albedo` under a coat
/// which absorbs: a crossing at the cosine μ (inside) lets e^(−`depth`/μ) pass, and of the reflections at the base the
/// first `bounces` alone count. For pbrt-v4's `coateddiffuse`, where `depth` is `thickness` (0.01 unless given; it absorbs although
/// `albedo` is 0) and a walk of `maxdepth` events meets the base about `maxdepth`/2 times. The absorption is
/// averaged over directions. Lanes stay in [0, 1].
pub fn absorbing_coat_albedo(albedo: Lanes, eta: f32, depth: f32, bounces: u32) -> Lanes {
    const STEPS: u32 = 512;
    let eta = clamped(eta);
    let f_in = fresnel_dielectric_mean(1.0 / eta);
    // Means of what leaves in one crossing, and of what comes back after two.
    let (mut out, mut back) = (0.0, 0.0);
    for i in 0..STEPS {
        let mu = (i as f32 + 0.5) / STEPS as f32;
        let f = fresnel_dielectric(mu, 1.0 / eta);
        let pass = (-depth.max(0.0) / mu).exp();
        out += 2.0 * mu * (1.0 - f) * pass / STEPS as f32;
        back += 2.0 * mu * f * pass * pass / STEPS as f32;
    }
    let crossed = (out / (1.0 - f_in)).min(1.0);
    albedo.map(|a| {
        let round = a * back;
        let sum = a * crossed * crossed * (1.0 - round.powf(bounces as f32)) / (1.0 - round);
        (sum / (1.0 + sum * f_in)).clamp(0.0, 1.0)
    })
}

impl Plastic {
    #[inline]
    fn coat(&self, w: Vec3) -> f32 {
        if is_smooth(self.alpha) {
            fresnel_dielectric(w.z, self.eta)
        } else if loses(self.facets, self.alpha) {
            single_bounce(Part::Reflected, w, self.alpha, self.eta, self.facets)
        } else {
            coat_albedo(w, self.alpha, self.eta)
        }
    }

    /// What enters through the coat.
    #[inline]
    fn enters(&self, w: Vec3) -> f32 {
        if loses(self.facets, self.alpha) {
            return single_bounce(Part::Entering, w, self.alpha, self.eta, self.facets);
        }
        1.0 - self.coat(w)
    }

    /// Lobe of the coat.
    #[inline]
    pub fn coat_lobes(alpha: [f32; 2]) -> Lobes {
        if is_smooth(alpha) { mirror::LOBES } else { GLOSSY }
    }

    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> Lanes {
        let mut f = Lanes::ZERO;
        if allowed.contains(diffuse::LOBES) {
            f += self.base * (self.enters(wo) * self.enters(wi));
        }
        if !is_smooth(self.alpha) && allowed.contains(GLOSSY) {
            let h = half_reflected(wo, wi);
            let fresnel = fresnel_dielectric(wo.dot(h), self.eta);
            f += self.specular * (fresnel * self.micro.reflection(wo, wi, h));
        }
        f
    }

    /// Probability of the coat among the admitted lobes: nearly in proportion to the energy (the mean of
    /// the coat is left out: it costs logarithms). `None` where there is none.
    #[inline]
    fn p_coat(&self, wo: Vec3, allowed: Lobes) -> Option<f32> {
        let e = self.coat(wo);
        let s = if allowed.contains(Self::coat_lobes(self.alpha)) { e * self.specular.max() } else { 0.0 };
        let d = if allowed.contains(diffuse::LOBES) { (1.0 - e) * self.base.max() * math::PI } else { 0.0 };
        (s + d > 0.0).then(|| s / (s + d))
    }

    /// Reflectance of the base through the coat, over what enters.
    fn base_albedo(&self) -> Lanes {
        let mean = if loses(self.facets, self.alpha) {
            single_means(self.eta, self.alpha, self.facets).0
        } else {
            one_minus_mean(self.eta, self.alpha)
        };
        self.base * (math::PI * mean)
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let Some(p) = self.p_coat(wo, allowed) else { return 0.0 };
        let mut pdf = (1.0 - p) * diffuse::pdf_w(wi.z);
        if !is_smooth(self.alpha) && p > 0.0 {
            pdf += p * self.micro.pdf_reflected(wo, half_reflected(wo, wi));
        }
        pdf
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let p = self.p_coat(wo, allowed)?;
        let (wi, lobes) = if u_lobe >= p {
            (cosine_hemisphere(u), diffuse::LOBES)
        } else if is_smooth(self.alpha) {
            let lobe = self.delta_lobe(wo);
            return Some(BsdfSample {
                wi: lobe.wi,
                weight: lobe.weight / p,
                pdf_w: p,
                lobes: lobe.lobes,
                eta: 1.0,
            });
        } else {
            (self.micro.sample_reflected(wo, u), GLOSSY)
        };
        if wi.z <= 0.0 {
            return None;
        }
        BsdfSample::of(wi, self.eval(wo, wi, allowed), self.pdf_w(wo, wi, allowed), lobes, 1.0)
    }

    /// Reflection off a smooth coat.
    #[inline]
    pub fn delta_lobe(&self, wo: Vec3) -> DeltaLobe {
        mirror::lobe(wo, self.specular * fresnel_dielectric(wo.z, self.eta))
    }

    /// Directional albedo.
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        let e = self.coat(wo);
        self.specular * e + self.base_albedo() * self.enters(wo)
    }
}
