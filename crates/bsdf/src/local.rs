use color::Lanes;
use math::{Vec3, Vec4};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::coated_conductor::CoatedConductor;
use crate::conductor::{self, Rough};
use crate::cosine::cosine_hemisphere;
use crate::dielectric;
use crate::diffuse;
use crate::facets::{Facets, Micro, is_smooth, isotropic};
use crate::film::Film;
use crate::fresnel::fresnel_conductor;
use crate::glass::{self, Glass, Side, is_matched};
use crate::kind::BsdfKind;
use crate::lobes::{Lobes, TransportMode};
use crate::mirror;
use crate::null;
use crate::phong::Phong;
use crate::plastic::{self, Plastic};
use crate::reflectance::Reflectance;
use crate::rough_diffuse::RoughDiffuse;
use crate::sheen::{self, Sheen};
use crate::slab::{self, Slab};
use crate::thin::Thin;
use crate::translucent::Translucent;

/// A kind seen from one side: directions are local, z up on the side of `wo`.
#[derive(Clone, Copy)]
pub(crate) struct Local {
    pub kind: BsdfKind,
    /// [`prepared`] of the kind.
    pub prepared: Lanes,
    pub side: Side,
}

/// What a kind needs and can be had once per hit: constant factors of lobes, mean losses.
#[inline(never)]
pub(crate) fn prepared(kind: &BsdfKind) -> Lanes {
    match *kind {
        BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 => {
            let micro = Micro::new(Facets::Conserving, [alpha; 2]);
            conductor::multiple(&micro, &Reflectance::conductor(n, k))
        }
        BsdfKind::RoughConductor { n, k, alpha, facets, film, .. } if !is_smooth(alpha) => {
            conductor::multiple(&Micro::new(facets, alpha), &Reflectance::conductor(n, k).under(film, 1.0))
        }
        BsdfKind::Plastic { albedo, eta, alpha } => {
            plastic::base(albedo, eta, [alpha; 2], Facets::Conserving)
        }
        BsdfKind::CoatedDiffuse { albedo, eta, alpha, facets, .. } => {
            plastic::base(albedo, eta, alpha, facets)
        }
        BsdfKind::RoughDielectric { eta, alpha, facets, .. } if !is_smooth(alpha) => {
            let [front, back] = glass::means(&Micro::new(facets, alpha), eta);
            Lanes(Vec4::new(front, back, 0.0, 0.0))
        }
        BsdfKind::CoatedConductor { n, k, alpha, eta, coat_alpha, depth, facets } => {
            CoatedConductor::new(n, k, alpha, eta, coat_alpha, depth, facets).further()
        }
        BsdfKind::Principled(p) => slab::multiple(&p),
        _ => Lanes::ZERO,
    }
}

impl Local {
    /// f of the admitted lobes; `wi` on the other side (z < 0) only where the kind transmits.
    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        if wi.z < 0.0 && !self.kind.lobes().contains(Lobes::TRANSMISSION) {
            return Lanes::ZERO;
        }
        let glossy = allowed.contains(conductor::GLOSSY);
        let diffuse = allowed.contains(diffuse::LOBES);
        match self.kind {
            BsdfKind::Phong { .. } => self.phong(allowed).eval(wo, wi),
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 && glossy => {
                self.conductor(n, k, alpha).eval(wo, wi)
            }
            BsdfKind::RoughConductor { alpha, reflectance, .. } if !is_smooth(alpha) && glossy => {
                self.rough_conductor().eval(wo, wi) * reflectance
            }
            BsdfKind::Plastic { .. } | BsdfKind::CoatedDiffuse { .. } => self.plastic().eval(wo, wi, allowed),
            BsdfKind::RoughDiffuse { albedo, roughness } if diffuse => {
                RoughDiffuse { albedo, roughness }.eval(wo, wi)
            }
            BsdfKind::DiffuseTransmission { .. } => self.translucent(allowed).eval(wi),
            BsdfKind::Sheen { color, alpha } if diffuse => color * Sheen::new(alpha).eval(wo, wi),
            BsdfKind::ThinDielectric { alpha, .. } if !is_smooth(alpha) => self.thin().eval(wo, wi, allowed),
            BsdfKind::RoughDielectric { eta, alpha, .. } if !is_smooth(alpha) && !is_matched(eta) => {
                self.glass().eval(wo, wi, allowed, mode)
            }
            BsdfKind::CoatedConductor { .. } if glossy => self.coated_conductor().eval(wo, wi),
            BsdfKind::Principled(p) => Slab::new(&p, self.side, self.prepared).eval(wo, wi, allowed, mode),
            _ => Lanes::ZERO,
        }
    }

    /// Density of the non-delta part of [`Self::sample`].
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        if wi.z < 0.0 && !self.kind.lobes().contains(Lobes::TRANSMISSION) {
            return 0.0;
        }
        let glossy = allowed.contains(conductor::GLOSSY);
        let diffuse = allowed.contains(diffuse::LOBES);
        match self.kind {
            BsdfKind::Phong { .. } => self.phong(allowed).pdf_w(wo, wi),
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 && glossy => {
                self.conductor(n, k, alpha).pdf_w(wo, wi)
            }
            BsdfKind::RoughConductor { alpha, .. } if !is_smooth(alpha) && glossy => {
                self.rough_conductor().pdf_w(wo, wi)
            }
            BsdfKind::Plastic { .. } | BsdfKind::CoatedDiffuse { .. } => {
                self.plastic().pdf_w(wo, wi, allowed)
            }
            BsdfKind::RoughDiffuse { .. } if diffuse => diffuse::pdf_w(wi.z),
            BsdfKind::DiffuseTransmission { .. } => self.translucent(allowed).pdf_w(wi),
            BsdfKind::Sheen { .. } if diffuse => sheen::PDF_W,
            BsdfKind::ThinDielectric { alpha, .. } if !is_smooth(alpha) => self.thin().pdf_w(wo, wi, allowed),
            BsdfKind::RoughDielectric { eta, alpha, .. } if !is_smooth(alpha) && !is_matched(eta) => {
                self.glass().pdf_w(wo, wi, allowed)
            }
            BsdfKind::CoatedConductor { .. } => self.coated_conductor().pdf_w(wo, wi, allowed),
            BsdfKind::Principled(p) => Slab::new(&p, self.side, self.prepared).pdf_w(wo, wi, allowed),
            _ => 0.0,
        }
    }

    /// A direction drawn from the admitted lobes.
    pub fn sample(
        &self,
        wo: Vec3,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let glossy = allowed.contains(conductor::GLOSSY);
        let diffuse = allowed.contains(diffuse::LOBES);
        match self.kind {
            BsdfKind::Phong { .. } => self.phong(allowed).sample(wo, u_lobe, u),
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 => {
                if glossy {
                    self.conductor(n, k, alpha).sample(wo, u_lobe, u)
                } else {
                    None
                }
            }
            BsdfKind::RoughConductor { alpha, reflectance, .. } if !is_smooth(alpha) => {
                let drawn = if glossy { self.rough_conductor().sample(wo, u_lobe, u) } else { None }?;
                Some(BsdfSample { weight: drawn.weight * reflectance, ..drawn })
            }
            BsdfKind::Plastic { .. } | BsdfKind::CoatedDiffuse { .. } => {
                self.plastic().sample(wo, allowed, u_lobe, u)
            }
            BsdfKind::RoughDiffuse { albedo, roughness } => {
                let wi = cosine_hemisphere(u);
                if !diffuse || wi.z <= 0.0 {
                    return None;
                }
                let f = RoughDiffuse { albedo, roughness }.eval(wo, wi);
                BsdfSample::of(wi, f, diffuse::pdf_w(wi.z), diffuse::LOBES, 1.0)
            }
            BsdfKind::DiffuseTransmission { .. } => self.translucent(allowed).sample(u_lobe, u),
            BsdfKind::Sheen { color, alpha } => {
                let wi = sheen::sample(u);
                if !diffuse || wi.z <= 0.0 {
                    return None;
                }
                let f = color * Sheen::new(alpha).eval(wo, wi);
                BsdfSample::of(wi, f, sheen::PDF_W, diffuse::LOBES, 1.0)
            }
            BsdfKind::ThinDielectric { alpha, .. } if !is_smooth(alpha) => {
                self.thin().sample(wo, allowed, u_lobe, u)
            }
            BsdfKind::RoughDielectric { eta, alpha, .. } if !is_smooth(alpha) && !is_matched(eta) => {
                self.glass().sample(wo, allowed, u_lobe, u, mode)
            }
            BsdfKind::CoatedConductor { .. } => self.coated_conductor().sample(wo, allowed, u_lobe, u),
            BsdfKind::Principled(p) => {
                Slab::new(&p, self.side, self.prepared).sample(wo, allowed, u_lobe, u, mode)
            }
            BsdfKind::Dielectric { eta, tint } => {
                dielectric::sample(wo, self.eta(eta), tint, allowed, u_lobe, mode).map(|(l, p)| l.drawn(p))
            }
            BsdfKind::Mirror { .. }
            | BsdfKind::Conductor { .. }
            | BsdfKind::RoughConductor { .. }
            | BsdfKind::ThinDielectric { .. }
            | BsdfKind::RoughDielectric { .. }
            | BsdfKind::Null => self.sample_delta(wo, allowed, u_lobe, mode),
            BsdfKind::Diffuse { .. } | BsdfKind::Black => None,
        }
    }

    /// One of the admitted delta lobes, in proportion to their greatest lanes.
    fn sample_delta(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, mode: TransportMode) -> Option<BsdfSample> {
        let admitted = self.delta_lobes(wo, mode).map(|l| l.filter(|l| allowed.contains(l.lobes)));
        match admitted {
            [Some(a), Some(b)] => {
                // Without the scaling of radiance, which says nothing of the energy.
                let (wa, wb) = (a.weight.max(), b.weight.max() * b.eta * b.eta);
                let p = if wa + wb > 0.0 { wa / (wa + wb) } else { 0.5 };
                let (lobe, p) = if u_lobe < p { (a, p) } else { (b, 1.0 - p) };
                Some(DeltaLobe { weight: lobe.weight / p, ..lobe }.drawn(p))
            }
            [Some(l), None] | [None, Some(l)] => Some(l.drawn(1.0)),
            [None, None] => None,
        }
    }

    /// All delta lobes: at most one reflected (first) and one transmitted.
    pub fn delta_lobes(&self, wo: Vec3, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
        match self.kind {
            BsdfKind::Mirror { color } => [Some(mirror::lobe(wo, color)), None],
            BsdfKind::Dielectric { eta, tint } => dielectric::delta_lobes(wo, self.eta(eta), tint, mode),
            BsdfKind::Conductor { n, k, alpha: 0.0 } => {
                [Some(mirror::lobe(wo, fresnel_conductor(wo.z, n, k))), None]
            }
            BsdfKind::RoughConductor { alpha, reflectance, .. } if is_smooth(alpha) => {
                [Some(mirror::lobe(wo, reflectance * self.reflectance().at(wo.z))), None]
            }
            BsdfKind::Plastic { .. } | BsdfKind::CoatedDiffuse { .. } => {
                let plastic = self.plastic();
                [is_smooth(plastic.alpha).then(|| plastic.delta_lobe(wo)), None]
            }
            BsdfKind::ThinDielectric { alpha, .. } if is_smooth(alpha) => self.thin().delta_lobes(wo),
            BsdfKind::RoughDielectric { eta, alpha, .. } if is_smooth(alpha) || is_matched(eta) => {
                self.glass().delta_lobes(wo, mode)
            }
            BsdfKind::CoatedConductor { .. } => [self.coated_conductor().delta_lobe(wo), None],
            BsdfKind::Null => [Some(null::lobe(wo)), None],
            _ => [None; 2],
        }
    }

    /// See [`crate::Bsdf::albedo`].
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        match self.kind {
            BsdfKind::Diffuse { albedo } => albedo,
            BsdfKind::Phong { diffuse, specular, .. } => diffuse + specular,
            BsdfKind::Mirror { color } => color,
            BsdfKind::Dielectric { eta, tint } => dielectric::albedo(wo.z, self.eta(eta), tint),
            BsdfKind::Conductor { n, k, alpha: 0.0 } => fresnel_conductor(wo.z, n, k),
            BsdfKind::Conductor { n, k, alpha } => self.conductor(n, k, alpha).albedo(wo),
            BsdfKind::RoughConductor { alpha, reflectance, .. } if is_smooth(alpha) => {
                reflectance * self.reflectance().at(wo.z)
            }
            BsdfKind::RoughConductor { reflectance, .. } => reflectance * self.rough_conductor().albedo(wo),
            BsdfKind::Plastic { .. } | BsdfKind::CoatedDiffuse { .. } => self.plastic().albedo(wo),
            BsdfKind::RoughDiffuse { albedo, roughness } => RoughDiffuse { albedo, roughness }.albedo(wo.z),
            BsdfKind::DiffuseTransmission { reflectance, transmittance } => reflectance + transmittance,
            BsdfKind::Sheen { color, alpha } => color * Sheen::new(alpha).albedo(wo.z),
            BsdfKind::ThinDielectric { .. } => self.thin().albedo(wo.z),
            BsdfKind::RoughDielectric { .. } => self.glass().albedo(wo.z),
            BsdfKind::CoatedConductor { .. } => self.coated_conductor().albedo(wo),
            BsdfKind::Principled(p) => Slab::new(&p, self.side, self.prepared).albedo(wo),
            BsdfKind::Null => Lanes::ONE,
            BsdfKind::Black => Lanes::ZERO,
        }
    }

    /// An index of −ns over +ns as far over near side.
    #[inline]
    fn eta(&self, eta: f32) -> f32 {
        match self.side {
            Side::Front => eta,
            Side::Back => 1.0 / eta,
        }
    }

    fn phong(&self, allowed: Lobes) -> Phong {
        match self.kind {
            BsdfKind::Phong { diffuse, specular, exponent } => {
                Phong { diffuse, specular, exponent }.restricted(allowed)
            }
            _ => Phong { diffuse: Lanes::ZERO, specular: Lanes::ZERO, exponent: 0.0 },
        }
    }

    fn conductor(&self, n: Lanes, k: Lanes, alpha: f32) -> Rough {
        let micro = Micro::new(Facets::Conserving, [alpha; 2]);
        Rough { micro, reflectance: Reflectance::conductor(n, k), alpha, multiple: self.prepared }
    }

    /// Of a [`BsdfKind::RoughConductor`].
    fn reflectance(&self) -> Reflectance {
        match self.kind {
            BsdfKind::RoughConductor { n, k, film, .. } => Reflectance::conductor(n, k).under(film, 1.0),
            _ => Reflectance::schlick(Lanes::ZERO),
        }
    }

    fn rough_conductor(&self) -> Rough {
        let (alpha, facets) = match self.kind {
            BsdfKind::RoughConductor { alpha, facets, .. } => (alpha, facets),
            _ => ([1.0; 2], Facets::SingleBounce),
        };
        let micro = Micro::new(facets, alpha);
        Rough { micro, reflectance: self.reflectance(), alpha: isotropic(alpha), multiple: self.prepared }
    }

    fn plastic(&self) -> Plastic {
        let (eta, alpha, specular, facets) = match self.kind {
            BsdfKind::Plastic { eta, alpha, .. } => (eta, [alpha; 2], Lanes::ONE, Facets::Conserving),
            BsdfKind::CoatedDiffuse { eta, alpha, specular, facets, .. } => (eta, alpha, specular, facets),
            _ => (1.0, [0.0; 2], Lanes::ZERO, Facets::Conserving),
        };
        Plastic {
            eta: plastic::clamped(eta),
            alpha,
            micro: Micro::new(facets, alpha),
            facets,
            specular,
            base: self.prepared,
        }
    }

    fn translucent(&self, allowed: Lobes) -> Translucent {
        match self.kind {
            BsdfKind::DiffuseTransmission { reflectance, transmittance } => {
                Translucent { reflectance, transmittance }.restricted(allowed)
            }
            _ => Translucent { reflectance: Lanes::ZERO, transmittance: Lanes::ZERO },
        }
    }

    fn thin(&self) -> Thin {
        let (eta, alpha, reflectance, transmittance) = match self.kind {
            BsdfKind::ThinDielectric { eta, alpha, reflectance, transmittance } => {
                (eta, alpha, reflectance, transmittance)
            }
            _ => (1.0, [0.0; 2], Lanes::ZERO, Lanes::ZERO),
        };
        let micro = Micro::new(Facets::Conserving, alpha);
        let (film, covered) = (Film::NONE, 0.0);
        Thin { micro, alpha: isotropic(alpha), eta, film, covered, reflectance, transmittance }
    }

    fn glass(&self) -> Glass {
        let (eta, alpha, facets, film, reflectance, transmittance) = match self.kind {
            BsdfKind::RoughDielectric { eta, alpha, facets, film, reflectance, transmittance } => {
                (eta, alpha, facets, film, reflectance, transmittance)
            }
            _ => (1.0, [0.0; 2], Facets::SingleBounce, Film::NONE, Lanes::ZERO, Lanes::ZERO),
        };
        let (front, back) = (self.prepared.0.x, self.prepared.0.y);
        Glass {
            micro: Micro::new(facets, alpha),
            alpha,
            eta: self.eta(eta),
            side: self.side,
            film,
            covered: 1.0,
            layers: None,
            reflectance,
            transmittance,
            means: if self.side == Side::Front { [front, back] } else { [back, front] },
        }
    }

    fn coated_conductor(&self) -> CoatedConductor {
        let coated = match self.kind {
            BsdfKind::CoatedConductor { n, k, alpha, eta, coat_alpha, depth, facets } => {
                CoatedConductor::new(n, k, alpha, eta, coat_alpha, depth, facets)
            }
            _ => {
                let (n, k, facets) = (Lanes::ONE, Lanes::ZERO, Facets::Conserving);
                CoatedConductor::new(n, k, [0.0; 2], 1.0, 0.0, 0.0, facets)
            }
        };
        CoatedConductor { further: self.prepared, ..coated }
    }
}
