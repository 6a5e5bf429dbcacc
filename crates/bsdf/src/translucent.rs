use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::BsdfSample;
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::lobes::Lobes;

pub(crate) const TRANSMISSION: Lobes = Lobes::DIFFUSE.union(Lobes::TRANSMISSION);

/// Lambertian reflection and Lambertian transmission.
#[derive(Clone, Copy)]
pub(crate) struct Translucent {
    pub reflectance: Lanes,
    pub transmittance: Lanes,
}

impl Translucent {
    /// With the lobes that are not admitted set to 0.
    #[inline]
    pub fn restricted(self, allowed: Lobes) -> Self {
        let keep = |l: Lanes, lobe: Lobes| if allowed.contains(lobe) { l } else { Lanes::ZERO };
        Self {
            reflectance: keep(self.reflectance, diffuse::LOBES),
            transmittance: keep(self.transmittance, TRANSMISSION),
        }
    }

    #[inline]
    pub fn eval(&self, wi: Vec3) -> Lanes {
        (if wi.z > 0.0 { self.reflectance } else { self.transmittance }) * FRAC_1_PI
    }

    #[inline]
    fn p_reflect(&self) -> Option<f32> {
        let (r, t) = (self.reflectance.max(), self.transmittance.max());
        (r + t > 0.0).then(|| r / (r + t))
    }

    #[inline]
    pub fn pdf_w(&self, wi: Vec3) -> f32 {
        let Some(p) = self.p_reflect() else { return 0.0 };
        (if wi.z > 0.0 { p } else { 1.0 - p }) * diffuse::pdf_w(wi.z.abs())
    }

    #[inline]
    pub fn sample(&self, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let p = self.p_reflect()?;
        let up = cosine_hemisphere(u);
        if up.z <= 0.0 {
            return None;
        }
        let (wi, lobes) =
            if u_lobe < p { (up, diffuse::LOBES) } else { (Vec3::new(up.x, up.y, -up.z), TRANSMISSION) };
        BsdfSample::of(wi, self.eval(wi), self.pdf_w(wi), lobes, 1.0)
    }
}
