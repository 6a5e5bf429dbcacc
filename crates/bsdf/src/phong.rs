use std::f32::consts::TAU;

use color::Lanes;
use math::{FRAC_1_PI, Frame, Vec3};

use crate::bsdf::BsdfSample;
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::lobes::Lobes;
use crate::mirror;

pub(crate) const GLOSSY: Lobes = Lobes::GLOSSY.union(Lobes::REFLECTION);

/// The energy-normalised modified Phong model (Lafortune & Willems 1994, eq. 11):
/// f = kd/π + ks (n + 2)/(2π) cosⁿα, α the angle between `wi` and the mirror direction.
#[derive(Clone, Copy)]
pub(crate) struct Phong {
    pub diffuse: Lanes,
    pub specular: Lanes,
    pub exponent: f32,
}

impl Phong {
    /// The model with the lobes that are not admitted set to 0.
    #[inline]
    pub fn restricted(self, allowed: Lobes) -> Self {
        Self {
            diffuse: if allowed.contains(diffuse::LOBES) { self.diffuse } else { Lanes::ZERO },
            specular: if allowed.contains(GLOSSY) { self.specular } else { Lanes::ZERO },
            exponent: self.exponent,
        }
    }

    /// Probability of the specular lobe; `None` where all is black.
    #[inline]
    fn p_specular(&self) -> Option<f32> {
        let (d, s) = (self.diffuse.max(), self.specular.max());
        (d + s > 0.0).then(|| s / (d + s))
    }

    /// cosⁿα. The cosine is taken from the chord, which keeps its digits for narrow lobes.
    #[inline]
    fn cos_n(&self, wo: Vec3, wi: Vec3) -> f32 {
        let x = 0.5 * (wi - mirror::direction(wo)).length_squared();
        if x >= 1.0 { 0.0 } else { (self.exponent * (-x).ln_1p()).exp() }
    }

    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let cos_n = self.cos_n(wo, wi);
        self.diffuse * FRAC_1_PI + self.specular * ((self.exponent + 2.0) / TAU * cos_n)
    }

    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3) -> f32 {
        let Some(p) = self.p_specular() else { return 0.0 };
        (1.0 - p) * diffuse::pdf_w(wi.z) + p * ((self.exponent + 1.0) / TAU * self.cos_n(wo, wi))
    }

    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let p = self.p_specular()?;
        let (wi, lobes) = if u_lobe < p {
            // cos α = u^(1/(n + 1)), by way of 1 − cos α.
            let one_minus_cos = -(u[0].ln() / (self.exponent + 1.0)).exp_m1();
            let sin_a = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
            let (s, c) = (TAU * u[1]).sin_cos();
            let local = Vec3::new(sin_a * c, sin_a * s, 1.0 - one_minus_cos);
            (Frame::from_z(mirror::direction(wo)).to_world(local), GLOSSY)
        } else {
            (cosine_hemisphere(u), diffuse::LOBES)
        };
        if wi.z <= 0.0 {
            return None;
        }
        BsdfSample::of(wi, self.eval(wo, wi), self.pdf_w(wo, wi), lobes, 1.0)
    }
}
