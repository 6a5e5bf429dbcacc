use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::facets::{Micro, further_pdf_w, half_reflected, half_refracted, isotropic, sample_further};
use crate::film::Film;
use crate::fresnel::{fresnel_dielectric, refracted_cosine};
use crate::glass_loss::{glass_loss, glass_loss_mean, refract};
use crate::layers::Layers;
use crate::lobes::{Lobes, TransportMode};
use crate::mirror;
use crate::reflectance::Reflectance;

pub(crate) const REFLECTION: Lobes = Lobes::GLOSSY.union(Lobes::REFLECTION);
pub(crate) const TRANSMISSION: Lobes = Lobes::GLOSSY.union(Lobes::TRANSMISSION);
const SMOOTH_TRANSMISSION: Lobes = Lobes::SPECULAR.union(Lobes::TRANSMISSION);

/// Indices that differ by less than this are the same: light goes straight on (the reflectance would be below 10⁻⁶).
const MATCHED: f32 = 1e-3;

/// Whether a relative index is that of no interface at all.
#[inline]
pub(crate) fn is_matched(eta: f32) -> bool {
    (eta - 1.0).abs() < MATCHED
}

/// From which side of the surface (+ns: front) it is seen.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Front,
    Back,
}

/// A dielectric interface seen from one side: reflection and refraction in facets (Walter et al. 2007), the energy of
/// further bounces restored on both sides. What is lost, L(o), is spread by a kernel of rank one,
/// n_i²·L(o)·L(i)/(π Σ n²·L_mean), the sum over both sides, n the index and L the loss on the side of its argument: the
/// construction of Kulla & Conty (2017) with the sides weighted by their étendue, so that it returns L(o) in all
/// and is reciprocal across the interface.
#[derive(Clone, Copy)]
pub(crate) struct Glass {
    pub micro: Micro,
    pub alpha: [f32; 2],
    /// Index of the far side over that of the near side.
    pub eta: f32,
    pub side: Side,
    pub film: Film,
    /// Share of the surface that the film covers.
    pub covered: f32,
    pub reflectance: Lanes,
    pub transmittance: Lanes,
    /// Layers on the side of +ns. They return to the inside what they do not let out: at a facet, by its angle.
    pub layers: Option<Layers>,
    /// Mean losses on the near and on the far side; 0 where nothing is restored.
    pub means: [f32; 2],
}

/// Mean losses of an interface on the side of +ns and on that of −ns.
pub(crate) fn means(micro: &Micro, eta: f32) -> [f32; 2] {
    match micro {
        Micro::Conserving { alpha, .. } => [eta, 1.0 / eta].map(|eta| glass_loss_mean(*alpha, eta)),
        Micro::SingleBounce(_) | Micro::Separable(_) | Micro::Beckmann(..) => [0.0; 2],
    }
}

impl Glass {
    /// Reflectance of a facet at the angle of cosine `c` on the near side.
    #[inline]
    fn fresnel(&self, c: f32) -> Lanes {
        let bare = fresnel_dielectric(c, self.eta);
        if self.film.is_none() || bare == 1.0 {
            return Lanes::splat(bare);
        }
        // A film that absorbs nothing reflects alike from both sides: it is always looked at from the front.
        let (c, eta) = match (self.side, refracted_cosine(c, self.eta)) {
            (Side::Back, Some(outside)) => (outside, 1.0 / self.eta),
            _ => (c, self.eta),
        };
        Reflectance::dielectric(eta).under(self.film, self.covered).at(c)
    }

    /// What a facet throws back: [`Self::fresnel`], tinted, and from inside what the layers outside return.
    #[inline]
    fn reflected(&self, c: f32, fresnel: Lanes) -> Lanes {
        let own = self.reflectance * fresnel;
        match (self.layers, self.side, refracted_cosine(c, self.eta)) {
            (Some(layers), Side::Back, Some(outside)) => {
                own + (Lanes::ONE - fresnel) * (1.0 - layers.above(outside).passes())
            }
            _ => own,
        }
    }

    /// Radiance's factor 1/η² at refraction.
    #[inline]
    fn scale(&self, mode: TransportMode) -> f32 {
        match mode {
            TransportMode::Radiance => 1.0 / (self.eta * self.eta),
            TransportMode::Importance => 1.0,
        }
    }

    #[inline]
    fn restores(&self) -> bool {
        self.means[0] > 0.0
    }

    /// Loss along `w`, on its own side.
    #[inline]
    fn loss(&self, w: Vec3) -> f32 {
        let eta = if w.z > 0.0 { self.eta } else { 1.0 / self.eta };
        glass_loss(w, self.alpha, eta)
    }

    /// Sum of mean losses, the far side weighted by η².
    #[inline]
    fn losses(&self) -> f32 {
        self.means[0] + self.eta * self.eta * self.means[1]
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        let further =
            if self.restores() { self.loss(wo) * self.loss(wi) * FRAC_1_PI / self.losses() } else { 0.0 };
        if wi.z > 0.0 {
            if !allowed.contains(REFLECTION) {
                return Lanes::ZERO;
            }
            let h = half_reflected(wo, wi);
            let c = wo.dot(h);
            let single = self.reflected(c, self.fresnel(c)) * self.micro.reflection(wo, wi, h);
            return single + self.reflectance * further;
        }
        if !allowed.contains(TRANSMISSION) {
            return Lanes::ZERO;
        }
        let eta2 = self.eta * self.eta;
        // Walter et al. 2007, eq. 21, as flux that goes from `wo` to `wi`.
        let single = half_refracted(wo, wi, self.eta).map_or(Lanes::ZERO, |h| {
            let (co, ci) = (wo.dot(h), wi.dot(h));
            let d = (co + self.eta * ci).powi(2).max(1e-20);
            let g = 4.0 * self.micro.visibility(wo, wi) * co * ci.abs();
            (Lanes::ONE - self.fresnel(co)) * (g * self.micro.d(h) * eta2 / d)
        });
        self.transmittance * (single + Lanes::splat(further * eta2)) * self.scale(mode)
    }

    /// Probability of reflection at a facet.
    #[inline]
    fn p_reflect(&self, c: f32, allowed: Lobes) -> f32 {
        match (allowed.contains(REFLECTION), allowed.contains(TRANSMISSION)) {
            (true, false) => 1.0,
            (false, _) => 0.0,
            (true, true) => {
                let f = self.fresnel(c);
                let (r, t) = (self.reflected(c, f).max(), (self.transmittance * (Lanes::ONE - f)).max());
                if r + t > 0.0 { r / (r + t) } else { 0.5 }
            }
        }
    }

    /// Probability of the near side among further bounces.
    #[inline]
    fn p_near(&self, allowed: Lobes) -> f32 {
        match (allowed.contains(REFLECTION), allowed.contains(TRANSMISSION)) {
            (true, false) => 1.0,
            (false, _) => 0.0,
            (true, true) => self.means[0] / self.losses(),
        }
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let p_further = if self.restores() { self.loss(wo) } else { 0.0 };
        let (single, side) = if wi.z > 0.0 {
            let h = half_reflected(wo, wi);
            let c = wo.dot(h);
            let pdf = self.micro.pdf_normal(wo, h) / (4.0 * c).max(1e-20);
            (pdf * self.p_reflect(c, allowed), if p_further > 0.0 { self.p_near(allowed) } else { 0.0 })
        } else {
            let pdf = half_refracted(wo, wi, self.eta).map_or(0.0, |h| {
                let (co, ci) = (wo.dot(h), wi.dot(h));
                let d = (co + self.eta * ci).powi(2).max(1e-20);
                // dω_h/dω_i (Walter et al. 2007, eq. 17).
                let jacobian = self.eta * self.eta * ci.abs() / d;
                self.micro.pdf_normal(wo, h) * jacobian * (1.0 - self.p_reflect(co, allowed))
            });
            (pdf, if p_further > 0.0 { 1.0 - self.p_near(allowed) } else { 0.0 })
        };
        let further = if side > 0.0 { side * further_pdf_w(wi.z.abs(), isotropic(self.alpha)) } else { 0.0 };
        (1.0 - p_further) * single + p_further * further
    }

    /// A direction of density [`Self::pdf_w`].
    pub fn direction(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<Vec3> {
        if !allowed.contains(REFLECTION) && !allowed.contains(TRANSMISSION) {
            return None;
        }
        let p_further = if self.restores() { self.loss(wo) } else { 0.0 };
        if u_lobe < p_further {
            let w = sample_further(u, isotropic(self.alpha));
            let near = u_lobe < p_further * self.p_near(allowed);
            return (w.z > 0.0).then_some(Vec3::new(w.x, w.y, if near { w.z } else { -w.z }));
        }
        let u_lobe = (u_lobe - p_further) / (1.0 - p_further);
        let h = self.micro.sample_normal(wo, u);
        let c = wo.dot(h);
        if c <= 0.0 {
            return None;
        }
        if u_lobe < self.p_reflect(c, allowed) {
            let wi = (h * (2.0 * c) - wo).normalize();
            (wi.z > 0.0).then_some(wi)
        } else {
            refract(wo, h, self.eta).filter(|wi| wi.z < 0.0)
        }
    }

    pub fn sample(
        &self,
        wo: Vec3,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let wi = self.direction(wo, allowed, u_lobe, u)?;
        let (lobes, eta) = if wi.z > 0.0 { (REFLECTION, 1.0) } else { (TRANSMISSION, self.eta) };
        BsdfSample::of(wi, self.eval(wo, wi, allowed, mode), self.pdf_w(wo, wi, allowed), lobes, eta)
    }

    /// The smooth interface: mirrored and refracted directions.
    pub fn delta_lobes(&self, wo: Vec3, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
        if is_matched(self.eta) && self.film.is_none() {
            let through =
                DeltaLobe { wi: -wo, weight: self.transmittance, lobes: SMOOTH_TRANSMISSION, eta: 1.0 };
            return [None, Some(through)];
        }
        let f = self.fresnel(wo.z);
        let transmitted = refracted_cosine(wo.z, self.eta).map(|cos_t| DeltaLobe {
            wi: Vec3::new(-wo.x / self.eta, -wo.y / self.eta, -cos_t).normalize(),
            weight: self.transmittance * (Lanes::ONE - f) * self.scale(mode),
            lobes: SMOOTH_TRANSMISSION,
            eta: self.eta,
        });
        [Some(mirror::lobe(wo, self.reflectance * f)), transmitted]
    }

    /// Reflectance plus transmittance of flux, Fresnel taken at the mirror's angle.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        if is_matched(self.eta) && self.film.is_none() {
            return self.transmittance;
        }
        let f = self.fresnel(cos_o);
        self.reflectance * f + self.transmittance * (Lanes::ONE - f)
    }
}
