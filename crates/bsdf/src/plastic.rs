use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::coat_albedo::{ETA_MAX, Table};
use crate::conductor::GLOSSY;
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::fresnel::{fresnel_dielectric, fresnel_dielectric_mean};
use crate::ggx::{Ggx, half};
use crate::lobes::Lobes;
use crate::mirror;

/// A dielectric coat over a diffuse base. With E the directional albedo of the coat (F where it is smooth), E_mean
/// its cosine-weighted mean, and F_in the mean reflectance of the coat seen from the base, light that bounces
/// between base and coat sums to
/// f_d = a (1 − F_in)/(1 − a F_in) · (1 − E(o))(1 − E(i)) / (π (1 − E_mean)).
/// For a smooth coat this is the classic smooth plastic, as (1 − E_mean) = η² (1 − F_in). It is reciprocal, and a
/// white base reflects exactly what the coat does not.
#[derive(Clone, Copy)]
pub(crate) struct Plastic {
    pub eta: f32,
    pub alpha: f32,
    /// [`base`] of this surface.
    pub base: Lanes,
}

/// What `eta` is moved to: [1, 4].
#[inline]
pub(crate) fn clamped(eta: f32) -> f32 {
    eta.clamp(1.0, ETA_MAX)
}

/// 1 − E_mean of the coat.
fn one_minus_mean(eta: f32, alpha: f32) -> f32 {
    1.0 - if alpha == 0.0 { fresnel_dielectric_mean(eta) } else { Table::get().mean(alpha, eta) }
}

/// The constant factor of f_d.
pub(crate) fn base(albedo: Lanes, eta: f32, alpha: f32) -> Lanes {
    let eta = clamped(eta);
    let f_in = fresnel_dielectric_mean(1.0 / eta);
    let scale = FRAC_1_PI * (1.0 - f_in) / one_minus_mean(eta, alpha);
    albedo.map(|a| a * scale / (1.0 - a * f_in))
}

impl Plastic {
    #[inline]
    fn coat(&self, mu: f32) -> f32 {
        if self.alpha == 0.0 {
            fresnel_dielectric(mu, self.eta)
        } else {
            Table::get().at(mu, self.alpha, self.eta)
        }
    }

    /// Lobe of the coat.
    #[inline]
    pub fn coat_lobes(alpha: f32) -> Lobes {
        if alpha == 0.0 { mirror::LOBES } else { GLOSSY }
    }

    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> Lanes {
        let mut f = Lanes::ZERO;
        if allowed.contains(diffuse::LOBES) {
            f += self.base * ((1.0 - self.coat(wo.z)) * (1.0 - self.coat(wi.z)));
        }
        if self.alpha > 0.0 && allowed.contains(GLOSSY) {
            let ggx = Ggx::new(self.alpha);
            let h = half(wo, wi);
            let fresnel = fresnel_dielectric(wo.dot(h), self.eta);
            f += Lanes::splat(fresnel * ggx.d(h) * ggx.visibility(wo.z, wi.z));
        }
        f
    }

    /// Probability of the coat among the admitted lobes: nearly in proportion to the energy (the mean of
    /// the coat is left out: it costs logarithms). `None` where there is none.
    #[inline]
    fn p_coat(&self, cos_o: f32, allowed: Lobes) -> Option<f32> {
        let e = self.coat(cos_o);
        let s = if allowed.contains(Self::coat_lobes(self.alpha)) { e } else { 0.0 };
        let d = if allowed.contains(diffuse::LOBES) { (1.0 - e) * self.base.max() * math::PI } else { 0.0 };
        (s + d > 0.0).then(|| s / (s + d))
    }

    /// Reflectance of the base through the coat, over 1 − E(o).
    fn base_albedo(&self) -> Lanes {
        self.base * (math::PI * one_minus_mean(self.eta, self.alpha))
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let Some(p) = self.p_coat(wo.z, allowed) else { return 0.0 };
        let mut pdf = (1.0 - p) * diffuse::pdf_w(wi.z);
        if self.alpha > 0.0 && p > 0.0 {
            pdf += p * Ggx::new(self.alpha).pdf_w(wo, half(wo, wi));
        }
        pdf
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let p = self.p_coat(wo.z, allowed)?;
        let (wi, lobes) = if u_lobe >= p {
            (cosine_hemisphere(u), diffuse::LOBES)
        } else if self.alpha == 0.0 {
            let lobe = self.delta_lobe(wo);
            return Some(BsdfSample {
                wi: lobe.wi,
                weight: lobe.weight / p,
                pdf_w: p,
                lobes: lobe.lobes,
                eta: 1.0,
            });
        } else {
            (Ggx::new(self.alpha).sample(wo, u), GLOSSY)
        };
        if wi.z <= 0.0 {
            return None;
        }
        let pdf_w = self.pdf_w(wo, wi, allowed);
        (pdf_w > 0.0).then(|| BsdfSample {
            wi,
            weight: self.eval(wo, wi, allowed) * (wi.z / pdf_w),
            pdf_w,
            lobes,
            eta: 1.0,
        })
    }

    /// Reflection off a smooth coat.
    #[inline]
    pub fn delta_lobe(&self, wo: Vec3) -> DeltaLobe {
        mirror::lobe(wo, Lanes::splat(fresnel_dielectric(wo.z, self.eta)))
    }

    /// Directional albedo.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        let e = self.coat(cos_o);
        Lanes::splat(e) + self.base_albedo() * (1.0 - e)
    }
}
