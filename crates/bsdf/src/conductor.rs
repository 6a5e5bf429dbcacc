use color::Lanes;
use math::{FRAC_1_PI, PI, Vec3, spherical_direction};

use crate::bsdf::BsdfSample;
use crate::fresnel::{fresnel_conductor, fresnel_conductor_mean};
use crate::ggx::{ALPHA_MIN, Ggx, half};
use crate::ggx_albedo::Loss;
use crate::lobes::Lobes;

pub(crate) const GLOSSY: Lobes = Lobes::GLOSSY.union(Lobes::REFLECTION);

/// A GGX-rough conductor: the single bounce with exact Fresnel, and the energy of the further bounces in the
/// reciprocal lobe of Kulla & Conty (2017, "Revisiting physically based shading at Imageworks"):
/// f_ms = (1 − E(o))(1 − E(i)) / (π (1 − E_mean)) · F_ms, F_ms = F_mean² E_mean / (1 − F_mean (1 − E_mean)).
#[derive(Clone, Copy)]
pub(crate) struct Rough {
    pub n: Lanes,
    pub k: Lanes,
    pub alpha: f32,
    /// [`multiple`] of this surface.
    pub multiple: Lanes,
}

/// The constant factor of f_ms: F_ms / (π (1 − E_mean)).
pub(crate) fn multiple(n: Lanes, k: Lanes, alpha: f32) -> Lanes {
    let lost = Loss::get().mean(alpha);
    let f = fresnel_conductor_mean(n, k);
    let f_ms = Lanes(f.0 * f.0 * (1.0 - lost) / (Lanes::ONE - f * lost).0);
    f_ms * (FRAC_1_PI / lost)
}

/// The loss 1 − E(μ) falls like (α/μ)² above μ ≈ 2α and is level below. So the lobe of further bounces, loss · μ,
/// is followed by μ/(μ² + b²), b = 2α, whose integral inverts in closed form. A cosine lobe would leave weights of
/// 1/loss at small α.
fn multiple_b2(alpha: f32) -> f32 {
    4.0 * alpha.max(ALPHA_MIN).powi(2)
}

fn sample_multiple(u: [f32; 2], alpha: f32) -> Vec3 {
    let b2 = multiple_b2(alpha);
    let mu2 = b2 * (u[0] * (1.0 / b2).ln_1p()).exp_m1();
    spherical_direction(mu2.clamp(0.0, 1.0).sqrt(), 2.0 * PI * u[1])
}

fn multiple_pdf_w(mu: f32, alpha: f32) -> f32 {
    let b2 = multiple_b2(alpha);
    mu / ((mu * mu + b2) * (1.0 / b2).ln_1p() * PI)
}

impl Rough {
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let ggx = Ggx::new(self.alpha);
        let h = half(wo, wi);
        let single = fresnel_conductor(wo.dot(h), self.n, self.k) * (ggx.d(h) * ggx.visibility(wo.z, wi.z));
        let loss = Loss::get();
        single + self.multiple * (loss.at(wo.z, self.alpha) * loss.at(wi.z, self.alpha))
    }

    /// Probability of the lobe of further bounces: the share that a single bounce loses.
    #[inline]
    fn p_multiple(&self, wo: Vec3) -> f32 {
        Loss::get().at(wo.z, self.alpha)
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3) -> f32 {
        let p = self.p_multiple(wo);
        p * multiple_pdf_w(wi.z, self.alpha) + (1.0 - p) * Ggx::new(self.alpha).pdf_w(wo, half(wo, wi))
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let wi = if u_lobe < self.p_multiple(wo) {
            sample_multiple(u, self.alpha)
        } else {
            Ggx::new(self.alpha).sample(wo, u)
        };
        if wi.z <= 0.0 {
            return None;
        }
        let pdf_w = self.pdf_w(wo, wi);
        (pdf_w > 0.0).then(|| BsdfSample {
            wi,
            weight: self.eval(wo, wi) * (wi.z / pdf_w),
            pdf_w,
            lobes: GLOSSY,
            eta: 1.0,
        })
    }

    /// Directional albedo, the single bounce taken at the mirror's angle.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        let loss = Loss::get();
        let lost = loss.at(cos_o, self.alpha);
        let f_ms = self.multiple * (PI * loss.mean(self.alpha));
        fresnel_conductor(cos_o, self.n, self.k) * (1.0 - lost) + f_ms * lost
    }
}
