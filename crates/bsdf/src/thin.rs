use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::facets::{Micro, further_pdf_w, half_reflected, sample_further};
use crate::fresnel::fresnel_dielectric;
use crate::glass::{REFLECTION, TRANSMISSION};
use crate::lobes::Lobes;
use crate::mirror;
use crate::null;

/// A thin slab of a dielectric: all reflections between its two faces, in parallel, straight on. Rough: the facets
/// of reflection, and the same lobe mirrored to the other side for transmission (Burley 2015, §5.4); further bounces
/// are restored in the proportion in which the slab reflects and transmits diffuse light.
#[derive(Clone, Copy)]
pub(crate) struct Thin {
    pub micro: Micro,
    pub alpha: f32,
    /// Index of the slab over that outside.
    pub eta: f32,
    pub reflectance: Lanes,
    pub transmittance: Lanes,
}

/// To the side of `wo`.
#[inline]
fn folded(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.abs())
}

impl Thin {
    /// F + (1 − F)² F/(1 − F²) = 2F/(1 + F).
    #[inline]
    fn slab(&self, cos: f32) -> f32 {
        let f = fresnel_dielectric(cos, self.eta);
        2.0 * f / (1.0 + f)
    }

    /// Mean of [`Self::slab`] over the hemisphere.
    fn slab_mean(&self) -> f32 {
        crate::reflectance::hemispherical_mean(|mu| Lanes::splat(self.slab(mu))).0.x
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> Lanes {
        let up = folded(wi);
        let h = half_reflected(wo, up);
        let (r, single) = (self.slab(wo.dot(h)), self.micro.reflection(wo, up, h));
        let (further, mean) = match self.micro.restored_mean() {
            Some(lost) => {
                (self.micro.restored(wo) * self.micro.restored(up) * FRAC_1_PI / lost, self.slab_mean())
            }
            None => (0.0, 0.0),
        };
        if wi.z > 0.0 && allowed.contains(REFLECTION) {
            self.reflectance * (r * single + mean * further)
        } else if wi.z < 0.0 && allowed.contains(TRANSMISSION) {
            self.transmittance * ((1.0 - r) * single + (1.0 - mean) * further)
        } else {
            Lanes::ZERO
        }
    }

    /// Probability of the near side, of which the share `r` is reflected.
    #[inline]
    fn p_near(&self, r: f32, allowed: Lobes) -> f32 {
        match (allowed.contains(REFLECTION), allowed.contains(TRANSMISSION)) {
            (true, false) => 1.0,
            (false, _) => 0.0,
            (true, true) => {
                let (r, t) = (r * self.reflectance.max(), (1.0 - r) * self.transmittance.max());
                if r + t > 0.0 { r / (r + t) } else { 0.5 }
            }
        }
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let lobe = if wi.z > 0.0 { REFLECTION } else { TRANSMISSION };
        if !allowed.contains(lobe) {
            return 0.0;
        }
        let up = folded(wi);
        let side = |near: f32| if wi.z > 0.0 { near } else { 1.0 - near };
        let h = half_reflected(wo, up);
        let single = self.micro.pdf_reflected(wo, h) * side(self.p_near(self.slab(wo.dot(h)), allowed));
        let p = self.micro.restored(wo);
        if p == 0.0 {
            return single;
        }
        let further = further_pdf_w(up.z, self.alpha) * side(self.p_near(self.slab_mean(), allowed));
        (1.0 - p) * single + p * further
    }

    /// A direction of density [`Self::pdf_w`].
    pub fn direction(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<Vec3> {
        if !allowed.contains(REFLECTION) && !allowed.contains(TRANSMISSION) {
            return None;
        }
        let p = self.micro.restored(wo);
        let (up, near, u_side) = if u_lobe < p {
            (sample_further(u, self.alpha), self.p_near(self.slab_mean(), allowed), u_lobe / p)
        } else {
            let up = self.micro.sample_reflected(wo, u);
            if up.z <= 0.0 {
                return None;
            }
            let r = self.slab(wo.dot(half_reflected(wo, up)));
            (up, self.p_near(r, allowed), (u_lobe - p) / (1.0 - p))
        };
        let near = u_side < near;
        (up.z > 0.0).then_some(Vec3::new(up.x, up.y, if near { up.z } else { -up.z }))
    }

    pub fn sample(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let wi = self.direction(wo, allowed, u_lobe, u)?;
        let lobes = if wi.z > 0.0 { REFLECTION } else { TRANSMISSION };
        BsdfSample::of(wi, self.eval(wo, wi, allowed), self.pdf_w(wo, wi, allowed), lobes, 1.0)
    }

    /// The smooth slab: mirrored and straight on.
    #[inline]
    pub fn delta_lobes(&self, wo: Vec3) -> [Option<DeltaLobe>; 2] {
        let r = self.slab(wo.z);
        let straight = DeltaLobe { weight: self.transmittance * (1.0 - r), ..null::lobe(wo) };
        [Some(mirror::lobe(wo, self.reflectance * r)), Some(straight)]
    }

    /// Reflectance plus transmittance, Fresnel taken at the mirror's angle.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        let r = self.slab(cos_o);
        self.reflectance * r + self.transmittance * (1.0 - r)
    }
}
