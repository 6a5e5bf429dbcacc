use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::BsdfSample;
use crate::coat_albedo::{ETA_MAX, coat_albedo, coat_albedo_mean};
use crate::conductor::{self, Rough};
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::facets::{Facets, Micro, isotropic};
use crate::ggx::ALPHA_MIN;
use crate::glass::{self, Glass, Side, is_matched};
use crate::lobes::{Lobes, TransportMode};
use crate::principled::{Interior, Principled, PrincipledParameters};
use crate::reflectance::Reflectance;
use crate::sheen::{self, Sheen};
use crate::thin::Thin;
use crate::translucent;

/// Index of the clear coat.
const COAT_ETA: f32 = 1.5;

/// The principled model at one point, seen from one side. Layers cover one another by albedo scaling: what is below one that
/// reflects E(μ) is multiplied by min(1 − E(o), 1 − E(i)), which is reciprocal and never gains energy; the diffuse base below
/// the dielectric by (1 − E(o))(1 − E(i))/(1 − E_mean), which loses none (Kelemen & Szirmay-Kalos 2001).
/// Seen from inside, a solid only transmits and reflects specularly: its other parts absorb there.
pub(crate) struct Slab {
    p: PrincipledParameters,
    /// Index for the tables of the dielectric's reflection.
    eta: f32,
    /// Whether sheen, coat, metal and base are seen.
    outer: Side,
    metal: Rough,
    gloss: Rough,
    clear: Clear,
    coat: Rough,
    sheen: Sheen,
}

/// The part that transmits specularly.
enum Clear {
    None,
    Solid(Glass),
    Thin(Thin),
}

/// Weights of the parts in sampling.
#[derive(Default)]
struct Shares {
    coat: f32,
    metal: f32,
    gloss: f32,
    clear: f32,
    reflected: f32,
    transmitted: f32,
    sheen: f32,
}

impl Shares {
    fn sum(&self) -> f32 {
        self.coat + self.metal + self.gloss + self.clear + self.reflected + self.transmitted + self.sheen
    }
}

/// A single bounce in facets of roughness `alpha`.
fn single(alpha: [f32; 2], reflectance: Reflectance) -> Rough {
    let micro = Micro::new(Facets::SingleBounce, alpha);
    Rough { micro, reflectance, alpha: isotropic(alpha), multiple: Lanes::ZERO }
}

/// What the metal of a slab reflects in a facet.
fn metallic(p: &PrincipledParameters) -> Reflectance {
    Reflectance::schlick(p.base_color).under(p.film, p.film_weight)
}

/// [`conductor::multiple`] of the metal, by which a slab is prepared once per hit.
pub(crate) fn multiple(packed: &Principled) -> Lanes {
    let p = packed.parameters();
    if p.metallic == 0.0 {
        return Lanes::ZERO;
    }
    let micro = Micro::new(Facets::Conserving, p.alpha.map(|a| a.max(ALPHA_MIN)));
    conductor::multiple(&micro, &metallic(&p))
}

impl Slab {
    /// `multiple` is [`multiple`] of the same.
    pub fn new(packed: &Principled, side: Side, multiple: Lanes) -> Self {
        let mut p = packed.parameters();
        p.alpha = p.alpha.map(|a| a.max(ALPHA_MIN));
        p.clearcoat_alpha = p.clearcoat_alpha.max(ALPHA_MIN);
        let alpha = isotropic(p.alpha);
        let eta = p.eta.max(1.0 / p.eta).clamp(1.0, ETA_MAX);
        let micro = Micro::new(Facets::Conserving, p.alpha);
        let tint = p.specular_color * p.specular;
        let clear = if !packed.has_transmission() {
            Clear::None
        } else if p.interior == Interior::Thin {
            let (reflectance, transmittance) = (tint, p.base_color);
            Clear::Thin(Thin { micro, alpha, eta, reflectance, transmittance })
        } else {
            // Equal indices make no surface; facets of almost equal ones are the nearest that can be sampled.
            let eta = if is_matched(p.eta) { 1.0 + 2e-3 } else { p.eta };
            let [front, back] = glass::means(&micro, eta);
            Clear::Solid(Glass {
                micro,
                alpha: p.alpha,
                eta: if side == Side::Front { eta } else { 1.0 / eta },
                side,
                film: p.film,
                covered: p.film_weight,
                reflectance: tint,
                transmittance: p.base_color.map(f32::sqrt),
                means: if side == Side::Front { [front, back] } else { [back, front] },
            })
        };
        Self {
            eta,
            outer: if packed.is_sided() { side } else { Side::Front },
            metal: Rough { micro, reflectance: metallic(&p), alpha, multiple },
            gloss: single(p.alpha, Reflectance::dielectric(eta).under(p.film, p.film_weight)),
            clear,
            coat: single([p.clearcoat_alpha; 2], Reflectance::dielectric(COAT_ETA)),
            sheen: Sheen::new(p.sheen_alpha),
            p,
        }
    }

    #[inline]
    fn tint(&self) -> Lanes {
        self.p.specular_color * self.p.specular
    }

    /// Shares of the dielectric: what transmits specularly, and the rest.
    #[inline]
    fn dielectric(&self) -> (f32, f32) {
        let d = 1.0 - self.p.metallic;
        (d * self.p.transmission, d * (1.0 - self.p.transmission))
    }

    /// What the coat reflects of light along `w`; 0 inside.
    fn coat_albedo(&self, mu: f32) -> f32 {
        if self.p.clearcoat == 0.0 {
            return 0.0;
        }
        self.p.clearcoat * coat_albedo(Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu), [self.p.clearcoat_alpha; 2], COAT_ETA)
    }

    fn sheen_albedo(&self, mu: f32) -> f32 {
        let most = self.p.sheen_color.max();
        if most == 0.0 { 0.0 } else { most * self.sheen.albedo(mu) }
    }

    /// What the dielectric over the diffuse base reflects.
    fn gloss_albedo(&self, w: Vec3) -> f32 {
        self.tint().max() * coat_albedo(w, self.p.alpha, self.eta)
    }

    /// Factor of what lies below sheen and coat.
    fn covered(&self, wo: Vec3, wi: Vec3) -> f32 {
        // A sided slab is covered on its front alone; any other on both sides.
        let sided = matches!(self.clear, Clear::Solid(_));
        let seen = |w: Vec3| !sided || (w.z > 0.0) == (self.outer == Side::Front);
        let under = |e: &dyn Fn(f32) -> f32| {
            let left = |w: Vec3| if seen(w) { 1.0 - e(w.z.abs()) } else { 1.0 };
            left(wo).min(left(wi))
        };
        let coat = if self.p.clearcoat == 0.0 { 1.0 } else { under(&|mu| self.coat_albedo(mu)) };
        if self.p.sheen_color.is_zero() { coat } else { coat * under(&|mu| self.sheen_albedo(mu)) }
    }

    /// (1 − E(o))(1 − E(i))/(π (1 − E_mean)) of the dielectric over the diffuse base.
    fn base_factor(&self, wo: Vec3, wi: Vec3) -> f32 {
        let mean = self.tint().max() * coat_albedo_mean(self.p.alpha, self.eta);
        (1.0 - self.gloss_albedo(wo)) * (1.0 - self.gloss_albedo(wi)) * FRAC_1_PI / (1.0 - mean)
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        let (clear, rest) = self.dielectric();
        let reflects = wi.z > 0.0;
        let outer = self.outer == Side::Front;
        let mut f = match &self.clear {
            Clear::None => Lanes::ZERO,
            Clear::Solid(g) => g.eval(wo, wi, allowed, mode) * clear,
            Clear::Thin(t) => t.eval(wo, wi, allowed) * clear,
        };
        if outer && reflects && allowed.contains(conductor::GLOSSY) {
            if self.p.metallic > 0.0 {
                f += self.metal.eval(wo, wi) * self.p.metallic;
            }
            if rest > 0.0 {
                f += self.gloss.eval(wo, wi) * self.tint() * rest;
            }
        }
        let (lobe, share) = if reflects {
            (diffuse::LOBES, 1.0 - self.p.diffuse_transmission)
        } else {
            (translucent::TRANSMISSION, self.p.diffuse_transmission)
        };
        if outer && rest * share > 0.0 && allowed.contains(lobe) {
            f += self.p.base_color * (rest * share * self.base_factor(wo, wi));
        }
        if !f.is_zero() {
            f *= self.covered(wo, wi);
        }
        if outer && reflects {
            if self.p.clearcoat > 0.0 && allowed.contains(conductor::GLOSSY) {
                let sheen = (1.0 - self.sheen_albedo(wo.z)).min(1.0 - self.sheen_albedo(wi.z));
                f += self.coat.eval(wo, wi) * (self.p.clearcoat * sheen);
            }
            if !self.p.sheen_color.is_zero() && allowed.contains(diffuse::LOBES) {
                f += self.p.sheen_color * self.sheen.eval(wo, wi);
            }
        }
        f
    }

    /// About the energy of each part.
    fn shares(&self, wo: Vec3, allowed: Lobes) -> Shares {
        let mut s = Shares::default();
        let (clear, rest) = self.dielectric();
        if allowed.contains(glass::REFLECTION) || allowed.contains(glass::TRANSMISSION) {
            s.clear = clear;
        }
        if self.outer == Side::Back {
            return s;
        }
        let e = if rest > 0.0 { self.gloss_albedo(wo) } else { 0.0 };
        let base = rest * (1.0 - e) * self.p.base_color.max();
        if allowed.contains(conductor::GLOSSY) {
            s.coat = self.coat_albedo(wo.z);
            s.metal = self.p.metallic * self.metal.reflectance.at(wo.z).max();
            s.gloss = rest * e;
        }
        if allowed.contains(diffuse::LOBES) {
            s.reflected = base * (1.0 - self.p.diffuse_transmission);
            s.sheen = self.sheen_albedo(wo.z);
        }
        if allowed.contains(translucent::TRANSMISSION) {
            s.transmitted = base * self.p.diffuse_transmission;
        }
        s
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let s = self.shares(wo, allowed);
        let sum = s.sum();
        if sum <= 0.0 {
            return 0.0;
        }
        let mut pdf = 0.0;
        if s.clear > 0.0 {
            pdf += s.clear
                * match &self.clear {
                    Clear::None => 0.0,
                    Clear::Solid(g) => g.pdf_w(wo, wi, allowed),
                    Clear::Thin(t) => t.pdf_w(wo, wi, allowed),
                };
        }
        if wi.z < 0.0 {
            return (pdf + s.transmitted * diffuse::pdf_w(-wi.z)) / sum;
        }
        pdf += s.reflected * diffuse::pdf_w(wi.z) + s.sheen * sheen::PDF_W;
        for (share, part) in [(s.coat, &self.coat), (s.metal, &self.metal), (s.gloss, &self.gloss)] {
            if share > 0.0 {
                pdf += share * part.pdf_w(wo, wi);
            }
        }
        pdf / sum
    }

    pub fn sample(
        &self,
        wo: Vec3,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let s = self.shares(wo, allowed);
        let mut x = u_lobe * s.sum();
        // Whether the part of this share is the one; if so, x becomes its own number in [0, 1).
        let mut chosen = |share: f32| {
            if x < share {
                x = (x / share).min(math::ONE_MINUS_EPSILON);
                return Some(x);
            }
            x -= share;
            None
        };
        let (wi, lobes) = if let Some(v) = chosen(s.clear) {
            let wi = match &self.clear {
                Clear::None => None,
                Clear::Solid(g) => g.direction(wo, allowed, v, u),
                Clear::Thin(t) => t.direction(wo, allowed, v, u),
            }?;
            (wi, if wi.z > 0.0 { glass::REFLECTION } else { glass::TRANSMISSION })
        } else if let Some(v) = chosen(s.coat) {
            (self.coat.direction(wo, v, u)?, conductor::GLOSSY)
        } else if let Some(v) = chosen(s.metal) {
            (self.metal.direction(wo, v, u)?, conductor::GLOSSY)
        } else if let Some(v) = chosen(s.gloss) {
            (self.gloss.direction(wo, v, u)?, conductor::GLOSSY)
        } else if chosen(s.reflected).is_some() {
            (cosine_hemisphere(u), diffuse::LOBES)
        } else if chosen(s.transmitted).is_some() {
            let w = cosine_hemisphere(u);
            (Vec3::new(w.x, w.y, -w.z), translucent::TRANSMISSION)
        } else if s.sheen > 0.0 {
            (sheen::sample(u), diffuse::LOBES)
        } else {
            return None;
        };
        let eta = match &self.clear {
            Clear::Solid(g) if wi.z < 0.0 => g.eta,
            _ => 1.0,
        };
        BsdfSample::of(wi, self.eval(wo, wi, allowed, mode), self.pdf_w(wo, wi, allowed), lobes, eta)
    }

    /// About the directional albedo: layers by albedo scaling, Fresnel taken at the mirror's angle.
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        let cos_o = wo.z;
        let (clear, rest) = self.dielectric();
        let through = match &self.clear {
            Clear::None => Lanes::ZERO,
            Clear::Solid(g) => g.albedo(cos_o),
            Clear::Thin(t) => t.albedo(cos_o),
        } * clear;
        if self.outer == Side::Back {
            return through;
        }
        let e = coat_albedo(wo, self.p.alpha, self.eta);
        let gloss = self.tint() * e;
        let dielectric = gloss + self.p.base_color * (1.0 - gloss.max());
        let below = through + self.metal.reflectance.at(cos_o) * self.p.metallic + dielectric * rest;
        let (coat, fuzz) = (self.coat_albedo(cos_o), self.sheen_albedo(cos_o));
        let coated = Lanes::splat(coat) + below * (1.0 - coat);
        self.p.sheen_color * self.sheen.albedo(cos_o) + coated * (1.0 - fuzz)
    }
}
