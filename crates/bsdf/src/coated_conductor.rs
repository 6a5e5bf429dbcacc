use color::Lanes;
use math::{FRAC_1_PI, PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::coat_albedo::{coat_albedo, coat_albedo_mean};
use crate::coat_loss::{coat_loss, coat_loss_mean, inside, outside};
use crate::conductor::GLOSSY;
use crate::facet_loss::{facet_loss, facet_loss_mean};
use crate::facets::{Facets, Micro, further_pdf_w, half_reflected, is_smooth, isotropic, sample_further};
use crate::fresnel::{fresnel_dielectric, fresnel_dielectric_mean};
use crate::glass_loss::{glass_loss, glass_loss_mean};
use crate::lobes::Lobes;
use crate::mirror;
use crate::plastic;
use crate::reflectance::Reflectance;

/// A dielectric coat over a rough metal, without a random walk. With T = 1 − E(μ) what enters the coat (E its
/// directional albedo), o′ and i′ the directions refracted at the mean plane, R the metal's Fresnel reflectance at the half vector of
/// o′ and i′, and A = e^(−τ/μo′ − τ/μi′):
///
/// f = f_coat + T(o) T(i) R A D(h′) V(o′, i′)/η² · 1/(1 − R A min(E(o), E(i))) + f_further.
///
/// The second term is exact for one reflection off the metal under a smooth coat (f cosθ dω is carried through
/// refraction), and the last factor sums the interreflections as those of mirrors: exact as the roughness vanishes. What a
/// wide lobe leaves inside (total reflection, masking) comes out in f_further = M(o) M(i)/(π M_mean) · C, M = T·(loss of
/// [`crate::coat_loss`]), built as by Kulla & Conty (2017) so that a white base under a clear coat returns all light. A rough coat widens
/// the base's lobe: α² + (1 − 1/η)² α_c²/2, the variances of slopes added at first order (compare Belcour 2018, §4).
///
/// Against a random walk through the layers, which is what pbrt-v4 renders (measured in `tests/random_walk.rs`, gold, with the walk's
/// facets conserving or single as the model's): under a smooth coat the albedo is 0 to 10 % higher, most for smooth metal near grazing,
/// where the walk keeps light that was reflected totally near the critical angle for several more bounces; under rough coats up to 20 %,
/// with single bounces at α_c = 0.3 over a smoother metal 40 %, because a facet of the coat then stops light that the mean plane
/// lets out. The lobe of further reflections is placed evenly (M·cos) where the walk makes it somewhat narrower.
#[derive(Clone, Copy)]
pub(crate) struct CoatedConductor {
    pub eta: f32,
    pub coat_alpha: f32,
    /// Roughness of the base as seen through the coat.
    pub alpha: [f32; 2],
    /// Of the metal against the coat.
    pub reflectance: Reflectance,
    /// τ: optical depth of the coat along its normal.
    pub depth: f32,
    pub facets: Facets,
    /// [`Self::further`].
    pub further: Lanes,
}

/// About the mean direction from which light from outside meets the base: a cosine of 0.88, half-way between the axes.
const INNER: Vec3 = Vec3::new(0.336, 0.336, 0.88);

/// A direction of this cosine.
fn at_cosine(mu: f32) -> Vec3 {
    Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu)
}

/// Roughness of a base of roughness `alpha` seen through a coat of roughness `coat`.
pub(crate) fn seen_through(alpha: [f32; 2], coat: f32, eta: f32) -> [f32; 2] {
    if coat == 0.0 {
        return alpha;
    }
    let bend = 1.0 - 1.0 / eta;
    let added = 0.5 * bend * bend * coat * coat;
    alpha.map(|a| (a * a + added).sqrt().min(1.0))
}

impl CoatedConductor {
    pub fn new(
        n: Lanes,
        k: Lanes,
        alpha: [f32; 2],
        eta: f32,
        coat_alpha: f32,
        depth: f32,
        facets: Facets,
    ) -> Self {
        let eta = plastic::clamped(eta);
        Self {
            eta,
            coat_alpha,
            alpha: seen_through(alpha, coat_alpha, eta),
            reflectance: Reflectance::conductor(n / eta, k / eta),
            depth: depth.max(0.0),
            facets,
            further: Lanes::ZERO,
        }
    }

    /// C/(π M_mean), C = F² s/(1 − F (1 − s)): F the mean reflectance of the metal (and of the coat's absorption, at
    /// a mean path of three halves of its depth each way), s the mean share that leaves at each reflection. Of single
    /// bounces only what the coat reflects totally goes on, and each reflection loses what facets mask.
    pub fn further(&self) -> Lanes {
        if is_smooth(self.alpha) {
            return Lanes::ZERO;
        }
        // Light that was reflected once from within goes on at the angles at which it is reflected again.
        let escapes = 1.0 - fresnel_dielectric_mean(1.0 / self.eta);
        let (first, kept) = match self.facets {
            Facets::Conserving => (1.0, 1.0),
            Facets::SingleBounce | Facets::Separable | Facets::Beckmann => {
                let m = coat_loss_mean(self.alpha, self.eta, 0.0) / (1.0 - fresnel_dielectric_mean(self.eta));
                let first = facet_loss(INNER, self.alpha);
                let total = (m - first).max(0.0) / m.max(1e-6);
                let kept = 1.0 - facet_loss_mean(self.alpha);
                match self.coat_alpha {
                    0.0 => (total.min(1.0) * kept, kept),
                    coat => {
                        let kept = kept * (1.0 - glass_loss_mean([coat; 2], 1.0 / self.eta));
                        (total.min(1.0) * kept, kept)
                    }
                }
            }
        };
        let f = self.reflectance.mean() * (-3.0 * self.depth).exp();
        let c = f.map(|f| f * f * first * escapes / (1.0 - f * kept * (1.0 - escapes)));
        c * (FRAC_1_PI / self.lost_mean())
    }

    #[inline]
    fn smooth_base(&self) -> bool {
        is_smooth(self.alpha)
    }

    #[inline]
    fn coat(&self, mu: f32) -> f32 {
        if self.coat_alpha == 0.0 {
            fresnel_dielectric(mu, self.eta)
        } else {
            coat_albedo(at_cosine(mu), [self.coat_alpha; 2], self.eta)
        }
    }

    /// T(μ): what enters the coat.
    #[inline]
    fn enters(&self, mu: f32) -> f32 {
        let e = 1.0 - self.coat(mu);
        if self.coat_alpha == 0.0 || self.facets == Facets::Conserving {
            return e;
        }
        (e - glass_loss(at_cosine(mu), [self.coat_alpha; 2], self.eta)).max(0.0)
    }

    /// M(w).
    #[inline]
    fn lost(&self, w: Vec3) -> f32 {
        self.enters(w.z) * coat_loss(w, self.alpha, self.eta, self.coat_alpha)
    }

    /// (1/π)∫M(w) cos dω: the table is of conserving coats.
    fn lost_mean(&self) -> f32 {
        let mean = coat_loss_mean(self.alpha, self.eta, self.coat_alpha);
        if self.coat_alpha == 0.0 || self.facets == Facets::Conserving {
            return mean;
        }
        let coat = [self.coat_alpha; 2];
        let enters = 1.0 - coat_albedo_mean(coat, self.eta);
        mean * (enters - glass_loss_mean(coat, self.eta)).max(0.0) / enters
    }

    #[inline]
    fn micro(&self) -> Micro {
        Micro::new(Facets::SingleBounce, self.alpha)
    }

    /// Factor of the metal's lobe: everything but D·V.
    fn passes(&self, cos_o: f32, cos_i: f32, r: Lanes, inner_o: f32, inner_i: f32) -> Lanes {
        let (to, ti) = (self.enters(cos_o), self.enters(cos_i));
        let ra = r * (-self.depth * (1.0 / inner_o + 1.0 / inner_i)).exp();
        let back = self.coat(cos_o).min(self.coat(cos_i));
        ra.map(|x| to * ti * x / (1.0 - x * back).max(1e-6))
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let mut f = Lanes::ZERO;
        if self.coat_alpha > 0.0 {
            let h = half_reflected(wo, wi);
            let coat = Micro::new(Facets::SingleBounce, [self.coat_alpha; 2]);
            f += Lanes::splat(fresnel_dielectric(wo.dot(h), self.eta) * coat.reflection(wo, wi, h));
        }
        if !self.smooth_base() {
            let (o, i) = (inside(wo, self.eta), inside(wi, self.eta));
            let h = half_reflected(o, i);
            let dv = self.micro().reflection(o, i, h) / (self.eta * self.eta);
            f += self.passes(wo.z, wi.z, self.reflectance.at(o.dot(h)), o.z, i.z) * dv;
            f += self.further * (self.lost(wo) * self.lost(wi));
        }
        f
    }

    /// Weights of coat, metal and further reflections, roughly by energy; of the non-delta ones, and of the delta.
    fn shares(&self, wo: Vec3, allowed: Lobes) -> ([f32; 3], f32) {
        let e = self.coat(wo.z);
        let r = self.reflectance.at(wo.z).max();
        let (mut glossy, mut delta) = ([0.0; 3], 0.0);
        if self.coat_alpha > 0.0 {
            glossy[0] = e;
        } else {
            delta = e;
        }
        if self.smooth_base() {
            delta += (1.0 - e) * r;
        } else {
            let lost = self.lost(wo);
            glossy[1] = (1.0 - e - lost).max(0.0) * r;
            glossy[2] = lost * self.further.max() * PI * self.lost_mean();
        }
        if !allowed.contains(GLOSSY) {
            glossy = [0.0; 3];
        }
        (glossy, if allowed.contains(mirror::LOBES) { delta } else { 0.0 })
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let ([coat, base, further], delta) = self.shares(wo, allowed);
        let sum = coat + base + further + delta;
        if sum <= 0.0 {
            return 0.0;
        }
        let mut pdf = 0.0;
        if further > 0.0 {
            pdf += further * further_pdf_w(wi.z, isotropic(self.alpha));
        }
        if coat > 0.0 {
            let micro = Micro::new(Facets::SingleBounce, [self.coat_alpha; 2]);
            pdf += coat * micro.pdf_reflected(wo, half_reflected(wo, wi));
        }
        if base > 0.0 {
            let (o, i) = (inside(wo, self.eta), inside(wi, self.eta));
            // dω′/dω = cosθ/(η² cosθ′).
            let jacobian = wi.z / (self.eta * self.eta * i.z.max(1e-6));
            pdf += base * jacobian * self.micro().pdf_reflected(o, half_reflected(o, i));
        }
        pdf / sum
    }

    pub fn sample(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let ([coat, base, further], delta) = self.shares(wo, allowed);
        let sum = coat + base + further + delta;
        if sum <= 0.0 {
            return None;
        }
        let x = u_lobe * sum;
        let wi = if x < delta {
            let lobe = self.delta_lobe(wo)?;
            let p = delta / sum;
            return Some(BsdfSample {
                wi: lobe.wi,
                weight: lobe.weight / p,
                pdf_w: p,
                lobes: lobe.lobes,
                eta: 1.0,
            });
        } else if x < delta + coat {
            Micro::new(Facets::SingleBounce, [self.coat_alpha; 2]).sample_reflected(wo, u)
        } else if x < delta + coat + base || further == 0.0 {
            let i = self.micro().sample_reflected(inside(wo, self.eta), u);
            outside(i, self.eta)?.normalize()
        } else {
            sample_further(u, isotropic(self.alpha))
        };
        if wi.z <= 0.0 {
            return None;
        }
        BsdfSample::of(wi, self.eval(wo, wi), self.pdf_w(wo, wi, allowed), GLOSSY, 1.0)
    }

    /// Lobes of a coated metal of these roughnesses.
    pub fn lobes(alpha: [f32; 2], coat_alpha: f32) -> Lobes {
        match (coat_alpha > 0.0, is_smooth(alpha)) {
            (false, true) => mirror::LOBES,
            (false, false) => mirror::LOBES.union(GLOSSY),
            (true, _) => GLOSSY,
        }
    }

    /// What a smooth coat reflects, with what a smooth metal below it does.
    pub fn delta_lobe(&self, wo: Vec3) -> Option<DeltaLobe> {
        if self.coat_alpha > 0.0 {
            return None;
        }
        let mut weight = Lanes::splat(self.coat(wo.z));
        if self.smooth_base() {
            let o = inside(wo, self.eta);
            weight += self.passes(wo.z, wo.z, self.reflectance.at(o.z), o.z, o.z);
        }
        Some(mirror::lobe(wo, weight))
    }

    /// Directional albedo, the metal's Fresnel reflectance taken at the mirror's angle.
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        let cos_o = wo.z;
        let e = self.coat(cos_o);
        let inner = inside(wo, self.eta).z;
        let base = self.passes(cos_o, cos_o, self.reflectance.at(inner), inner, inner);
        if self.smooth_base() {
            return Lanes::splat(e) + base;
        }
        let further = self.further * (self.lost(wo) * PI * self.lost_mean());
        Lanes::splat(e) + base * (1.0 - coat_loss(wo, self.alpha, self.eta, self.coat_alpha)) + further
    }
}
