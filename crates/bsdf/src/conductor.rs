use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::BsdfSample;
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::fresnel::{fresnel_conductor, fresnel_conductor_mean};
use crate::ggx::{Ggx, half};
use crate::ggx_albedo::Table;
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
    let e = Table::get().mean(alpha);
    let f = fresnel_conductor_mean(n, k);
    let f_ms = Lanes(f.0 * f.0 * e / (Lanes::ONE - f * (1.0 - e)).0.max(math::Vec4::splat(1e-6)));
    f_ms * (FRAC_1_PI / (1.0 - e).max(1e-6))
}

impl Rough {
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let ggx = Ggx::new(self.alpha);
        let h = half(wo, wi);
        let single = fresnel_conductor(wo.dot(h), self.n, self.k) * (ggx.d(h) * ggx.visibility(wo.z, wi.z));
        let table = Table::get();
        let lost = (1.0 - table.at(wo.z, self.alpha)) * (1.0 - table.at(wi.z, self.alpha));
        single + self.multiple * lost
    }

    /// Probability of the cosine lobe: the share that a single bounce loses.
    #[inline]
    fn p_multiple(&self, wo: Vec3) -> f32 {
        1.0 - Table::get().at(wo.z, self.alpha)
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3) -> f32 {
        let p = self.p_multiple(wo);
        p * diffuse::pdf_w(wi.z) + (1.0 - p) * Ggx::new(self.alpha).pdf_w(wo, half(wo, wi))
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let wi = if u_lobe < self.p_multiple(wo) {
            cosine_hemisphere(u)
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
        let table = Table::get();
        let e = table.at(cos_o, self.alpha);
        let e_mean = table.mean(self.alpha);
        let f_ms = self.multiple * (math::PI * (1.0 - e_mean));
        fresnel_conductor(cos_o, self.n, self.k) * e + f_ms * (1.0 - e)
    }
}
