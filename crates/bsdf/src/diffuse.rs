use color::Lanes;
use math::FRAC_1_PI;

use crate::bsdf::BsdfSample;
use crate::cosine::cosine_hemisphere;
use crate::lobes::Lobes;

pub(crate) const LOBES: Lobes = Lobes::DIFFUSE.union(Lobes::REFLECTION);

/// Lambert: f = albedo/π.
#[inline]
pub(crate) fn eval(albedo: Lanes) -> Lanes {
    albedo * FRAC_1_PI
}

#[inline]
pub(crate) fn pdf_w(cos_i: f32) -> f32 {
    cos_i * FRAC_1_PI
}

#[inline]
pub(crate) fn sample(albedo: Lanes, u: [f32; 2]) -> Option<BsdfSample> {
    let wi = cosine_hemisphere(u);
    // The rim of the hemisphere has density 0.
    (wi.z > 0.0).then(|| BsdfSample { wi, weight: albedo, pdf_w: pdf_w(wi.z), lobes: LOBES, eta: 1.0 })
}
