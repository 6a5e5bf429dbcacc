use color::Lanes;
use math::{FRAC_1_PI, PI, Vec3};

use crate::bsdf::BsdfSample;
use crate::facets::{Micro, further_pdf_w, half_reflected, sample_further};
use crate::lobes::Lobes;
use crate::reflectance::Reflectance;

pub(crate) const GLOSSY: Lobes = Lobes::GLOSSY.union(Lobes::REFLECTION);

/// A rough reflecting surface: the single bounce with Fresnel, and the energy of the further bounces in the
/// reciprocal lobe of Kulla & Conty (2017, "Revisiting physically based shading at Imageworks"):
/// f_ms = (1 − E(o))(1 − E(i)) / (π (1 − E_mean)) · F_ms, F_ms = F_mean² E_mean / (1 − F_mean (1 − E_mean)).
#[derive(Clone, Copy)]
pub(crate) struct Rough {
    pub micro: Micro,
    pub reflectance: Reflectance,
    /// Of the lobe of further bounces, for sampling.
    pub alpha: f32,
    /// [`multiple`] of this surface.
    pub multiple: Lanes,
}

/// The constant factor of f_ms: F_ms / (π (1 − E_mean)); 0 where nothing is restored.
pub(crate) fn multiple(micro: &Micro, reflectance: &Reflectance) -> Lanes {
    let Some(lost) = micro.restored_mean() else { return Lanes::ZERO };
    let f = reflectance.mean();
    let f_ms = Lanes(f.0 * f.0 * (1.0 - lost) / (Lanes::ONE - f * lost).0);
    f_ms * (FRAC_1_PI / lost)
}

impl Rough {
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let h = half_reflected(wo, wi);
        let single = self.reflectance.at(wo.dot(h)) * self.micro.reflection(wo, wi, h);
        if self.multiple.is_zero() {
            return single;
        }
        single + self.multiple * (self.micro.restored(wo) * self.micro.restored(wi))
    }

    /// Probability of the lobe of further bounces: the share that a single bounce loses.
    #[inline]
    fn p_multiple(&self, wo: Vec3) -> f32 {
        if self.multiple.is_zero() { 0.0 } else { self.micro.restored(wo) }
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3) -> f32 {
        let p = self.p_multiple(wo);
        let single = (1.0 - p) * self.micro.pdf_reflected(wo, half_reflected(wo, wi));
        if p == 0.0 { single } else { single + p * further_pdf_w(wi.z, self.alpha) }
    }

    /// A direction of density [`Self::pdf_w`]; `None` below the horizon.
    #[inline]
    pub fn direction(&self, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<Vec3> {
        let wi = if u_lobe < self.p_multiple(wo) {
            sample_further(u, self.alpha)
        } else {
            self.micro.sample_reflected(wo, u)
        };
        (wi.z > 0.0).then_some(wi)
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let wi = self.direction(wo, u_lobe, u)?;
        BsdfSample::of(wi, self.eval(wo, wi), self.pdf_w(wo, wi), GLOSSY, 1.0)
    }

    /// Directional albedo, the single bounce taken at the mirror's angle.
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        let single = self.reflectance.at(wo.z);
        let Some(mean) = self.micro.restored_mean() else { return single };
        let lost = self.micro.restored(wo);
        single * (1.0 - lost) + self.multiple * (PI * mean * lost)
    }
}
