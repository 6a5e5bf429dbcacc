use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::BsdfSample;
use crate::coat_albedo::{ETA_MAX, coat_albedo, coat_albedo_mean};
use crate::conductor::{self, Rough};
use crate::cosine::cosine_hemisphere;
use crate::diffuse;
use crate::facets::{Facets, Micro, further_pdf_w, isotropic, sample_further};
use crate::ggx::ALPHA_MIN;
use crate::glass::{self, Glass, Side, is_matched};
use crate::layers::{Above, COAT_ETA, Layers, Under};
use crate::lobes::{Lobes, TransportMode};
use crate::principled::{Interior, Principled, PrincipledParameters};
use crate::reflectance::Reflectance;
use crate::sheen::{self, Sheen};
use crate::thin::Thin;
use crate::translucent;

/// The principled model at one point, seen from one side: sheen over clear coat over a mixture of metal, of what transmits
/// specularly, and of dielectric on a diffuse base. [`Layers`] cover what is below them by albedo scaling. What that keeps back
/// returns in lobes of rank one, X(o)X(i)/(π X_mean) with X what is missing (after Kelemen & Szirmay-Kalos 2001): of the diffuse base
/// that is its whole lobe, X = D = 1 − all that the layers and the dielectric return; of metal and sheets a lobe beside theirs,
/// X = P = 1 − all that they and the layers return. So each part returns all light where all is white, and f is reciprocal.
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
    layers: Layers,
    parts: Parts,
    /// Means of D and P.
    missing: Missing,
}

/// (1/π)∫ over the hemisphere, times cos, of what layers and dielectric leave to the diffuse base, and of what layers keep back
/// of metal (see [`Slab`]).
#[derive(Clone, Copy)]
pub(crate) struct Missing {
    pub base: f32,
    pub metal: f32,
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
    further: f32,
}

impl Shares {
    fn sum(&self) -> f32 {
        let specular = self.coat + self.metal + self.gloss + self.clear + self.further;
        specular + self.reflected + self.transmitted + self.sheen
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

/// The layers of a slab.
fn layers(p: &PrincipledParameters) -> Layers {
    Layers {
        coat: p.clearcoat,
        coat_alpha: p.clearcoat_alpha.max(ALPHA_MIN),
        sheen: p.sheen_color.max(),
        fibres: Sheen::new(p.sheen_alpha),
    }
}

/// Index for the tables of the dielectric's reflection.
fn table_eta(eta: f32) -> f32 {
    eta.max(1.0 / eta).clamp(1.0, ETA_MAX)
}

/// What a slab needs to know of one direction.
#[derive(Clone, Copy, Default)]
struct Along {
    above: Above,
    /// What the dielectric over the diffuse base reflects.
    gloss: f32,
    /// D, where there is a base.
    base: f32,
    /// P, where there is metal or sheet.
    kept_back: f32,
}

/// The parts of a slab of which [`Along`] tells.
#[derive(Clone, Copy)]
struct Parts {
    base: bool,
    kept_back: bool,
}

impl Parts {
    fn of(p: &PrincipledParameters, layers: &Layers) -> Self {
        let sheet = p.transmission > 0.0 && p.interior == Interior::Thin;
        Self {
            base: p.metallic < 1.0 && p.transmission < 1.0,
            kept_back: !layers.none() && (p.metallic > 0.0 || sheet),
        }
    }

    fn along(self, p: &PrincipledParameters, layers: &Layers, w: Vec3) -> Along {
        let gloss = if self.base {
            (p.specular_color * p.specular).max() * coat_albedo(w, p.alpha, table_eta(p.eta))
        } else {
            0.0
        };
        if layers.none() {
            return Along { gloss, base: 1.0 - gloss, ..Along::default() };
        }
        let above = layers.above(w.z.abs());
        let left = 1.0 - layers.returned(w, above);
        let below = |under| layers.kept(under, w, p.alpha, above);
        let base = if self.base { (left - gloss * below(Under::Gloss)).max(0.0) } else { 0.0 };
        let kept_back = if self.kept_back { (left - below(Under::White)).max(0.0) } else { 0.0 };
        Along { above, gloss, base, kept_back }
    }
}

/// [`Missing`] of a slab, never 0, by eight-point Gauss–Legendre quadrature in √μ.
pub(crate) fn missing(p: &PrincipledParameters) -> Missing {
    let p = &PrincipledParameters { alpha: p.alpha.map(|a| a.max(ALPHA_MIN)), ..*p };
    let layers = layers(p);
    let parts = Parts::of(p, &layers);
    if layers.none() {
        let tint = (p.specular_color * p.specular).max();
        let gloss = if parts.base { tint * coat_albedo_mean(p.alpha, table_eta(p.eta)) } else { 0.0 };
        return Missing { base: 1.0 - gloss, metal: 0.0 };
    }
    const NODES: [(f32, f32); 8] = [
        (0.019_855_07, 0.050_614_27),
        (0.101_666_76, 0.111_190_52),
        (0.237_233_8, 0.156_853_32),
        (0.408_282_68, 0.181_341_89),
        (0.591_717_3, 0.181_341_89),
        (0.762_766_2, 0.156_853_32),
        (0.898_333_25, 0.111_190_52),
        (0.980_144_9, 0.050_614_27),
    ];
    let azimuths = if p.alpha[0] == p.alpha[1] { 1 } else { 3 };
    let mut mean = Missing { base: 0.0, metal: 0.0 };
    for (t, weight) in NODES {
        for i in 0..azimuths {
            let phi = std::f32::consts::FRAC_PI_2 * (i as f32 + 0.5) / azimuths as f32;
            // μ = t²: dense towards grazing.
            let w = math::spherical_direction(t * t, phi);
            let weight = 4.0 * t * t * t * weight / azimuths as f32;
            let along = parts.along(p, &layers, w);
            mean.base += weight * along.base;
            mean.metal += weight * along.kept_back;
        }
    }
    Missing { base: mean.base.max(1e-6), metal: mean.metal.max(1e-6) }
}

impl Slab {
    /// `multiple` is [`multiple`] of the same.
    pub fn new(packed: &Principled, side: Side, multiple: Lanes) -> Self {
        let mut p = packed.parameters();
        p.alpha = p.alpha.map(|a| a.max(ALPHA_MIN));
        p.clearcoat_alpha = p.clearcoat_alpha.max(ALPHA_MIN);
        let alpha = isotropic(p.alpha);
        let (eta, layers) = (table_eta(p.eta), layers(&p));
        let micro = Micro::new(Facets::Conserving, p.alpha);
        let tint = p.specular_color * p.specular;
        let clear = if !packed.has_transmission() {
            Clear::None
        } else if p.interior == Interior::Thin {
            let (reflectance, transmittance) = (tint, p.base_color);
            let (film, covered) = (p.film, p.film_weight);
            Clear::Thin(Thin { micro, alpha, eta: p.eta, film, covered, reflectance, transmittance })
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
                layers: (!layers.none()).then_some(layers),
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
            parts: Parts::of(&p, &layers),
            layers,
            missing: packed.missing(),
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

    fn along(&self, w: Vec3) -> Along {
        if self.outer == Side::Front {
            self.parts.along(&self.p, &self.layers, w)
        } else {
            // From inside only what leaves is met by layers.
            let above = if self.layers.none() { Above::default() } else { self.layers.above(w.z.abs()) };
            Along { above, ..Along::default() }
        }
    }

    /// Factor of what lies below sheen and coat.
    fn covered(&self, wo: Vec3, wi: Vec3, o: Above, i: Above) -> f32 {
        if self.layers.none() {
            return 1.0;
        }
        // A sided slab is covered on its front alone; any other on both sides.
        let sided = matches!(self.clear, Clear::Solid(_));
        let seen = |w: Vec3| !sided || (w.z > 0.0) == (self.outer == Side::Front);
        match (seen(wo), seen(wi)) {
            (true, true) => o.cover(i),
            (true, false) => o.passes(),
            (false, true) => i.passes(),
            (false, false) => 1.0,
        }
    }

    /// Colour of the lobe beside those of metal and sheet.
    fn further(&self) -> Lanes {
        let sheet = if matches!(self.clear, Clear::Thin(_)) { self.dielectric().0 } else { 0.0 };
        self.p.base_color * self.p.base_color * self.p.metallic + self.p.base_color * sheet
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        self.eval_from(&self.along(wo), wo, wi, allowed, mode)
    }

    /// [`Self::eval`], `o` being [`Self::along`] of `wo`.
    fn eval_from(&self, o: &Along, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        let i = self.along(wi);
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
        if !f.is_zero() {
            f *= self.covered(wo, wi, o.above, i.above);
        }
        if outer && rest * share > 0.0 && allowed.contains(lobe) {
            let pair = o.base * i.base * FRAC_1_PI / self.missing.base;
            f += self.p.base_color * (rest * share * pair);
        }
        if outer && reflects && !self.layers.none() {
            if allowed.contains(conductor::GLOSSY) {
                if self.p.clearcoat > 0.0 {
                    let cover = o.above.cover_coat(i.above);
                    f += self.coat.eval(wo, wi) * (self.p.clearcoat * cover);
                }
                if self.parts.kept_back {
                    let pair = o.kept_back * i.kept_back * FRAC_1_PI / self.missing.metal;
                    f += self.further() * pair;
                }
            }
            if self.layers.sheen > 0.0 && allowed.contains(diffuse::LOBES) {
                f += self.p.sheen_color * self.layers.fibres.eval(wo, wi);
            }
        }
        f
    }

    /// About the energy of each part.
    fn shares(&self, o: &Along, wo: Vec3, allowed: Lobes) -> Shares {
        let mut s = Shares::default();
        let (clear, rest) = self.dielectric();
        if allowed.contains(glass::REFLECTION) || allowed.contains(glass::TRANSMISSION) {
            s.clear = clear;
        }
        if self.outer == Side::Back {
            return s;
        }
        let base = rest * o.base * self.p.base_color.max();
        if allowed.contains(conductor::GLOSSY) {
            s.coat = o.above.coat;
            s.further = o.kept_back * self.further().max();
            s.metal = self.p.metallic * self.metal.reflectance.at(wo.z).max();
            s.gloss = rest * o.gloss;
        }
        if allowed.contains(diffuse::LOBES) {
            s.reflected = base * (1.0 - self.p.diffuse_transmission);
            s.sheen = o.above.sheen;
        }
        if allowed.contains(translucent::TRANSMISSION) {
            s.transmitted = base * self.p.diffuse_transmission;
        }
        s
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        self.pdf_from(&self.shares(&self.along(wo), wo, allowed), wo, wi, allowed)
    }

    /// [`Self::pdf_w`] by the shares of `wo`.
    fn pdf_from(&self, s: &Shares, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
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
        if s.further > 0.0 {
            pdf += s.further * further_pdf_w(wi.z, self.metal.alpha);
        }
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
        let o = self.along(wo);
        let s = self.shares(&o, wo, allowed);
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
        } else if chosen(s.further).is_some() {
            (sample_further(u, self.metal.alpha), conductor::GLOSSY)
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
        let f = self.eval_from(&o, wo, wi, allowed, mode);
        BsdfSample::of(wi, f, self.pdf_from(&s, wo, wi, allowed), lobes, eta)
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
        let o = self.along(wo);
        let gloss = self.tint() * coat_albedo(wo, self.p.alpha, self.eta);
        let below = through + self.metal.reflectance.at(cos_o) * self.p.metallic + gloss * rest;
        let coat = Lanes::splat(o.above.coat) + below * (1.0 - o.above.coat);
        let sheen = self.p.sheen_color * self.layers.fibres.albedo(cos_o);
        let base = self.p.base_color * (rest * o.base);
        sheen + coat * (1.0 - o.above.sheen) + base + self.further() * o.kept_back
    }
}
