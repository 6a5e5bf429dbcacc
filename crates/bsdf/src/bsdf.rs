use color::Lanes;
use math::{Frame, Vec3};

use crate::conductor::{self, Rough};
use crate::dielectric;
use crate::diffuse;
use crate::fresnel::fresnel_conductor;
use crate::lobes::{Lobes, TransportMode};
use crate::mirror;
use crate::null;
use crate::phong::{self, Phong};
use crate::plastic::{self, Plastic};

/// What a surface is made of. Reflectances are factors in [0, 1] per lane; the caller keeps them there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BsdfKind {
    /// Lambert.
    Diffuse {
        /// Reflectance.
        albedo: Lanes,
    },
    /// Energy-normalised modified Phong (Lafortune & Willems 1994).
    Phong {
        /// Reflectance of the diffuse lobe, kd.
        diffuse: Lanes,
        /// Greatest reflectance of the specular lobe (at normal incidence), ks; kd + ks ≤ 1.
        specular: Lanes,
        /// n ≥ 0.
        exponent: f32,
    },
    /// A perfect mirror, without Fresnel.
    Mirror {
        /// Reflectance.
        color: Lanes,
    },
    /// A smooth dielectric interface.
    Dielectric {
        /// Index on the side of −ns over the index on the side of +ns, > 0. The caller resolves nested media.
        eta: f32,
        /// Factor of transmitted light; reflection is not tinted.
        tint: Lanes,
    },
    /// A metal, seen alike from both sides.
    Conductor {
        /// Real part of the index, relative to that outside.
        n: Lanes,
        /// Imaginary part (extinction), relative to the index outside.
        k: Lanes,
        /// GGX roughness; 0: smooth (a delta lobe). Values in (0, 1e-4) are used as 1e-4.
        alpha: f32,
    },
    /// A dielectric coat over a diffuse base, seen alike from both sides.
    Plastic {
        /// Reflectance of the base.
        albedo: Lanes,
        /// Index of the coat over that outside; moved into [1, 4].
        eta: f32,
        /// GGX roughness of the coat; 0: smooth (a delta lobe). Values in (0, 1e-4) are used as 1e-4.
        alpha: f32,
    },
    /// No surface: light goes straight on.
    Null,
    /// Absorbs all light.
    Black,
}

/// A scattering function at a point.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    frame: Frame,
    ng: Vec3,
    kind: BsdfKind,
    /// What the kind needs and can be had once per hit: `conductor::multiple`, `plastic::base`.
    prepared: Lanes,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The direction.
    pub wi: Vec3,
    /// f·|cos θi|/pdf, the probability of the lobe included.
    pub weight: Lanes,
    /// Density per steradian (of all admitted non-delta lobes together, as [`Bsdf::pdf_w`]); for a delta lobe, the
    /// probability of choosing it.
    pub pdf_w: f32,
    /// Properties of the lobe from which `wi` was drawn.
    pub lobes: Lobes,
    /// η_t/η_i where transmitted (index on the side of `wi` over that on the side of `wo`), else 1.
    pub eta: f32,
}

impl BsdfSample {
    /// Whether it came from a delta lobe.
    #[inline]
    pub fn is_delta(&self) -> bool {
        self.lobes.contains(Lobes::SPECULAR)
    }
}

/// One direction into which a delta lobe scatters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaLobe {
    /// The direction.
    pub wi: Vec3,
    /// Factor of the light along `wi`: the integral of f·|cos θi| over the delta.
    pub weight: Lanes,
    /// Properties of the lobe.
    pub lobes: Lobes,
    /// η_t/η_i where transmitted, else 1.
    pub eta: f32,
}

impl Bsdf {
    /// From a shading frame (z = shading normal) and the geometric normal, of either orientation: it is turned to
    /// the hemisphere of the shading normal.
    #[inline]
    pub fn new(kind: BsdfKind, frame: Frame, ng: Vec3) -> Self {
        let prepared = match kind {
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 => conductor::multiple(n, k, alpha),
            BsdfKind::Plastic { albedo, eta, alpha } => plastic::base(albedo, eta, alpha),
            _ => Lanes::ZERO,
        };
        let ng = if ng.dot(frame.z) < 0.0 { -ng } else { ng };
        Self { frame, ng, kind, prepared }
    }

    /// With both normals equal to the unit vector `n`.
    pub fn from_normal(kind: BsdfKind, n: Vec3) -> Self {
        Self::new(kind, Frame::from_z(n), n)
    }

    /// Shading frame.
    #[inline]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Shading normal.
    #[inline]
    pub fn ns(&self) -> Vec3 {
        self.frame.z
    }

    /// Geometric normal, in the hemisphere of the shading normal.
    #[inline]
    pub fn ng(&self) -> Vec3 {
        self.ng
    }

    /// The kind.
    #[inline]
    pub fn kind(&self) -> &BsdfKind {
        &self.kind
    }

    /// |cos| of the angle to the shading normal: the cosine in [`BsdfSample::weight`], by which f of [`Self::eval`]
    /// is to be multiplied for direct light.
    #[inline]
    pub fn abs_cos(&self, w: Vec3) -> f32 {
        self.frame.z.dot(w).abs()
    }

    /// Veach's correction for shading normals, by which light paths multiply the weight of a sample and connections
    /// multiply f·|cos θi|, `wo` being where the photon came from: |wo·ns||wi·ng| / (|wo·ng||wi·ns|)
    /// (Veach 1997, eq. 5.19). 1 where the normals agree; unbounded as `wo` grazes the surface.
    #[inline]
    pub fn shading_correction(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (ns, ng) = (self.frame.z, self.ng);
        if ns == ng {
            return 1.0;
        }
        let denominator = wo.dot(ng).abs() * wi.dot(ns).abs();
        if denominator > 0.0 { wo.dot(ns).abs() * wi.dot(ng).abs() / denominator } else { 0.0 }
    }

    /// Properties of all its lobes together.
    #[inline]
    pub fn lobes(&self) -> Lobes {
        match self.kind {
            BsdfKind::Diffuse { .. } => diffuse::LOBES,
            BsdfKind::Phong { .. } => diffuse::LOBES | phong::GLOSSY,
            BsdfKind::Mirror { .. } => mirror::LOBES,
            BsdfKind::Dielectric { .. } => dielectric::REFLECTION | dielectric::TRANSMISSION,
            BsdfKind::Conductor { alpha: 0.0, .. } => mirror::LOBES,
            BsdfKind::Conductor { .. } => conductor::GLOSSY,
            BsdfKind::Plastic { alpha, .. } => diffuse::LOBES | Plastic::coat_lobes(alpha),
            BsdfKind::Null => null::LOBES,
            BsdfKind::Black => Lobes::NONE,
        }
    }

    /// Whether it scatters, and by delta lobes alone.
    #[inline]
    pub fn is_delta_only(&self) -> bool {
        match self.kind {
            BsdfKind::Mirror { .. } | BsdfKind::Dielectric { .. } | BsdfKind::Null => true,
            BsdfKind::Conductor { alpha, .. } => alpha == 0.0,
            BsdfKind::Diffuse { .. }
            | BsdfKind::Phong { .. }
            | BsdfKind::Plastic { .. }
            | BsdfKind::Black => false,
        }
    }

    /// Whether it has a diffuse lobe, by kind: the surfaces on which photons are stored and looked up by the
    /// two-pass map (diffuse, phong, plastic). Never a matter of roughness.
    #[inline]
    pub fn has_diffuse(&self) -> bool {
        matches!(self.kind, BsdfKind::Diffuse { .. } | BsdfKind::Phong { .. } | BsdfKind::Plastic { .. })
    }

    /// f(wo, wi) per steradian, without the cosine. Delta lobes contribute 0; symmetric in its arguments.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Lanes {
        self.eval_lobes(wo, wi, Lobes::ALL, mode)
    }

    /// f of the admitted lobes alone.
    #[inline]
    pub fn eval_lobes(&self, wo: Vec3, wi: Vec3, allowed: Lobes, _mode: TransportMode) -> Lanes {
        if !self.reflects(wo, wi) {
            return Lanes::ZERO;
        }
        match self.kind {
            BsdfKind::Diffuse { albedo } if allowed.contains(diffuse::LOBES) => diffuse::eval(albedo),
            BsdfKind::Diffuse { .. } => Lanes::ZERO,
            _ => self.eval_glossy(wo, wi, allowed),
        }
    }

    /// [`Self::eval_lobes`] of what is not Lambertian: like all such functions out of the way of loops over paths, and
    /// by value, so that a `Bsdf` that is only diffuse need not lie in memory.
    #[inline(never)]
    fn eval_glossy(self, wo: Vec3, wi: Vec3, allowed: Lobes) -> Lanes {
        match self.kind {
            BsdfKind::Phong { .. } => {
                let (wo, wi) = self.local_pair(wo, wi);
                self.phong(allowed).eval(wo, wi)
            }
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 && allowed.contains(conductor::GLOSSY) => {
                let (wo, wi) = self.local_pair(wo, wi);
                Rough { n, k, alpha, multiple: self.prepared }.eval(wo, wi)
            }
            BsdfKind::Plastic { eta, alpha, .. } => {
                let (wo, wi) = self.local_pair(wo, wi);
                self.plastic(eta, alpha).eval(wo, wi, allowed)
            }
            _ => Lanes::ZERO,
        }
    }

    /// Density per steradian of the non-delta part of [`Self::sample`], the probabilities of its lobes included:
    /// where there are delta lobes it integrates to less than 1.
    #[inline]
    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> f32 {
        self.pdf_w_lobes(wo, wi, Lobes::ALL, mode)
    }

    /// Density of the non-delta part of [`Self::sample_lobes`] under the same restriction.
    #[inline]
    pub fn pdf_w_lobes(&self, wo: Vec3, wi: Vec3, allowed: Lobes, _mode: TransportMode) -> f32 {
        if !self.reflects(wo, wi) {
            return 0.0;
        }
        match self.kind {
            BsdfKind::Diffuse { .. } if allowed.contains(diffuse::LOBES) => diffuse::pdf_w(self.abs_cos(wi)),
            BsdfKind::Diffuse { .. } => 0.0,
            _ => self.pdf_w_glossy(wo, wi, allowed),
        }
    }

    #[inline(never)]
    fn pdf_w_glossy(self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        match self.kind {
            BsdfKind::Phong { .. } => {
                let (wo, wi) = self.local_pair(wo, wi);
                self.phong(allowed).pdf_w(wo, wi)
            }
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 && allowed.contains(conductor::GLOSSY) => {
                let (wo, wi) = self.local_pair(wo, wi);
                Rough { n, k, alpha, multiple: self.prepared }.pdf_w(wo, wi)
            }
            BsdfKind::Plastic { eta, alpha, .. } => {
                let (wo, wi) = self.local_pair(wo, wi);
                self.plastic(eta, alpha).pdf_w(wo, wi, allowed)
            }
            _ => 0.0,
        }
    }

    /// Draws `wi` for numbers in [0, 1). `None`: the path ends here (absorbed, or the direction drawn lies on a
    /// side to which the surface does not scatter).
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: [f32; 2], mode: TransportMode) -> Option<BsdfSample> {
        self.sample_lobes(wo, Lobes::ALL, u_lobe, u, mode)
    }

    /// Draws `wi` from the admitted lobes alone ([`Lobes::DELTA`], [`Lobes::NON_DELTA`], …); probabilities and
    /// weight are those of the restricted function.
    #[inline]
    pub fn sample_lobes(
        &self,
        wo: Vec3,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let side = self.side(wo)?;
        let drawn = match self.kind {
            BsdfKind::Diffuse { albedo } if allowed.contains(diffuse::LOBES) => diffuse::sample(albedo, u),
            BsdfKind::Diffuse { .. } | BsdfKind::Black => None,
            _ => self.draw(self.local(wo, side), side, allowed, u_lobe, u, mode),
        }?;
        let wi = self.world(drawn.wi, side);
        let valid = if drawn.lobes.contains(Lobes::REFLECTION) {
            self.reflects(wo, wi)
        } else {
            self.transmits(wo, wi)
        };
        valid.then_some(BsdfSample { wi, ..drawn })
    }

    /// A local direction of what is not Lambertian.
    #[inline(never)]
    fn draw(
        self,
        local: Vec3,
        side: f32,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        match self.kind {
            BsdfKind::Diffuse { .. } | BsdfKind::Black => None,
            BsdfKind::Phong { .. } => self.phong(allowed).sample(local, u_lobe, u),
            BsdfKind::Conductor { n, k, alpha } if alpha > 0.0 => {
                let rough = Rough { n, k, alpha, multiple: self.prepared };
                if allowed.contains(conductor::GLOSSY) { rough.sample(local, u_lobe, u) } else { None }
            }
            BsdfKind::Plastic { eta, alpha, .. } => {
                self.plastic(eta, alpha).sample(local, allowed, u_lobe, u)
            }
            BsdfKind::Dielectric { eta, tint } => {
                let eta = if side > 0.0 { eta } else { 1.0 / eta };
                dielectric::sample(local, eta, tint, allowed, u_lobe, mode).map(|(l, p)| l.drawn(p))
            }
            BsdfKind::Mirror { .. } | BsdfKind::Conductor { .. } | BsdfKind::Null => {
                let [lobe, _] = self.local_delta_lobes(local, side, mode);
                lobe.filter(|l| allowed.contains(l.lobes)).map(|l| l.drawn(1.0))
            }
        }
    }

    /// All directions into which delta lobes scatter: at most one reflected (first) and one transmitted.
    pub fn delta_lobes(&self, wo: Vec3, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
        let Some(side) = self.side(wo) else { return [None; 2] };
        self.local_delta_lobes(self.local(wo, side), side, mode).map(|lobe| {
            lobe.map(|l| DeltaLobe { wi: self.world(l.wi, side), ..l }).filter(|l| {
                if l.lobes.contains(Lobes::REFLECTION) {
                    self.reflects(wo, l.wi)
                } else {
                    self.transmits(wo, l.wi)
                }
            })
        })
    }

    fn local_delta_lobes(&self, wo: Vec3, side: f32, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
        match self.kind {
            BsdfKind::Mirror { color } => [Some(mirror::lobe(wo, color)), None],
            BsdfKind::Dielectric { eta, tint } => {
                dielectric::delta_lobes(wo, if side > 0.0 { eta } else { 1.0 / eta }, tint, mode)
            }
            BsdfKind::Conductor { n, k, alpha: 0.0 } => {
                [Some(mirror::lobe(wo, fresnel_conductor(wo.z, n, k))), None]
            }
            BsdfKind::Plastic { eta, alpha, .. } if alpha == 0.0 => {
                [Some(self.plastic(eta, alpha).delta_lobe(wo)), None]
            }
            BsdfKind::Null => [Some(null::lobe(wo)), None],
            _ => [None; 2],
        }
    }

    /// Share of the flux from `wo` that is scattered at all, per lane: exact for diffuse, mirror, dielectric and
    /// smooth kinds; within the tables' 1 % for rough plastic; for rough conductors with Fresnel taken at the
    /// mirror's angle; for phong the upper bound kd + ks.
    #[inline]
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        match self.kind {
            BsdfKind::Diffuse { albedo } => albedo,
            _ => self.albedo_glossy(wo),
        }
    }

    #[inline(never)]
    fn albedo_glossy(self, wo: Vec3) -> Lanes {
        let cos_o = self.abs_cos(wo);
        match self.kind {
            BsdfKind::Diffuse { albedo } => albedo,
            BsdfKind::Phong { diffuse, specular, .. } => diffuse + specular,
            BsdfKind::Mirror { color } => color,
            BsdfKind::Dielectric { eta, tint } => {
                let outside = self.frame.z.dot(wo) > 0.0;
                dielectric::albedo(cos_o, if outside { eta } else { 1.0 / eta }, tint)
            }
            BsdfKind::Conductor { n, k, alpha: 0.0 } => fresnel_conductor(cos_o, n, k),
            BsdfKind::Conductor { n, k, alpha } => {
                Rough { n, k, alpha, multiple: self.prepared }.albedo(cos_o)
            }
            BsdfKind::Plastic { eta, alpha, .. } => self.plastic(eta, alpha).albedo(cos_o),
            BsdfKind::Null => Lanes::ONE,
            BsdfKind::Black => Lanes::ZERO,
        }
    }

    #[inline]
    fn phong(&self, allowed: Lobes) -> Phong {
        match self.kind {
            BsdfKind::Phong { diffuse, specular, exponent } => {
                Phong { diffuse, specular, exponent }.restricted(allowed)
            }
            _ => Phong { diffuse: Lanes::ZERO, specular: Lanes::ZERO, exponent: 0.0 },
        }
    }

    #[inline]
    fn plastic(&self, eta: f32, alpha: f32) -> Plastic {
        Plastic { eta: plastic::clamped(eta), alpha, base: self.prepared }
    }

    /// +1 where `w` lies above both normals, −1 below both, `None` between or within them.
    #[inline]
    fn side(&self, w: Vec3) -> Option<f32> {
        let (s, g) = (self.frame.z.dot(w), self.ng.dot(w));
        if s > 0.0 && g > 0.0 {
            Some(1.0)
        } else if s < 0.0 && g < 0.0 {
            Some(-1.0)
        } else {
            None
        }
    }

    #[inline]
    fn reflects(&self, wo: Vec3, wi: Vec3) -> bool {
        self.side(wo).is_some_and(|side| self.side(wi) == Some(side))
    }

    #[inline]
    fn transmits(&self, wo: Vec3, wi: Vec3) -> bool {
        self.side(wo).is_some_and(|side| self.side(wi) == Some(-side))
    }

    /// Local direction, z turned so that the side of `wo` is up.
    #[inline]
    fn local(&self, w: Vec3, side: f32) -> Vec3 {
        let l = self.frame.to_local(w);
        Vec3::new(l.x, l.y, l.z * side)
    }

    #[inline]
    fn local_pair(&self, wo: Vec3, wi: Vec3) -> (Vec3, Vec3) {
        let side = 1f32.copysign(self.frame.z.dot(wo));
        (self.local(wo, side), self.local(wi, side))
    }

    #[inline]
    fn world(&self, w: Vec3, side: f32) -> Vec3 {
        self.frame.to_world(Vec3::new(w.x, w.y, w.z * side))
    }
}

impl DeltaLobe {
    /// The sample that chooses this lobe with `probability`, by which the weight was divided already.
    #[inline]
    fn drawn(self, probability: f32) -> BsdfSample {
        BsdfSample { wi: self.wi, weight: self.weight, pdf_w: probability, lobes: self.lobes, eta: self.eta }
    }
}
