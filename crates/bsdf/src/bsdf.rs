use color::Lanes;
use math::{Frame, Vec3};

use crate::diffuse;
use crate::glass::Side;
use crate::kind::BsdfKind;
use crate::lobes::{Lobes, TransportMode};
use crate::local::{self, Local};

/// A scattering function at a point.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    frame: Frame,
    ng: Vec3,
    kind: BsdfKind,
    /// [`local::prepared`] of the kind.
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
    /// A sample of a non-delta lobe, of value `f` and density `pdf_w` in all; `None` where the density is 0. `wi` is local.
    #[inline]
    pub(crate) fn of(wi: Vec3, f: Lanes, pdf_w: f32, lobes: Lobes, eta: f32) -> Option<Self> {
        (pdf_w > 0.0).then(|| Self { wi, weight: f * (wi.z.abs() / pdf_w), pdf_w, lobes, eta })
    }

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
    /// From a shading frame (z = shading normal, x = tangent, along which anisotropic kinds measure their first
    /// roughness) and the geometric normal, of either orientation: it is turned to the hemisphere of the shading normal.
    #[inline]
    pub fn new(kind: BsdfKind, frame: Frame, ng: Vec3) -> Self {
        let prepared = match kind {
            BsdfKind::Diffuse { .. }
            | BsdfKind::Mirror { .. }
            | BsdfKind::Dielectric { .. }
            | BsdfKind::Null
            | BsdfKind::Black => Lanes::ZERO,
            _ => local::prepared(&kind),
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
        self.kind.lobes()
    }

    /// Whether it scatters, and by delta lobes alone.
    #[inline]
    pub fn is_delta_only(&self) -> bool {
        self.kind.is_delta_only()
    }

    /// Whether photons are stored on it and looked up: [`BsdfKind::has_diffuse`].
    #[inline]
    pub fn has_diffuse(&self) -> bool {
        self.kind.has_diffuse()
    }

    /// f(wo, wi) per steradian, without the cosine. Delta lobes contribute 0. Symmetric in its arguments for reflection and where
    /// light is not refracted; for refraction f/η_i² is in [`TransportMode::Radiance`] and f/η_o² in the other mode, and
    /// f(wo, wi) of one mode is f(wi, wo) of the other (Veach 1997, §5.2).
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Lanes {
        self.eval_lobes(wo, wi, Lobes::ALL, mode)
    }

    /// f of the admitted lobes alone.
    #[inline]
    pub fn eval_lobes(&self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        match self.kind {
            BsdfKind::Diffuse { albedo } => {
                if self.reflects(wo, wi) && allowed.contains(diffuse::LOBES) {
                    diffuse::eval(albedo)
                } else {
                    Lanes::ZERO
                }
            }
            _ => self.eval_others(wo, wi, allowed, mode),
        }
    }

    /// [`Self::eval_lobes`] of what is not Lambertian: like all such functions out of the way of loops over paths, and
    /// by value, so that a `Bsdf` that is only diffuse need not lie in memory.
    #[inline(never)]
    fn eval_others(self, wo: Vec3, wi: Vec3, allowed: Lobes, mode: TransportMode) -> Lanes {
        match (self.side(wo), self.side(wi)) {
            (Some(side), Some(_)) => {
                self.seen_from(side).eval(self.local(wo, side), self.local(wi, side), allowed, mode)
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
        match self.kind {
            BsdfKind::Diffuse { .. } => {
                if self.reflects(wo, wi) && allowed.contains(diffuse::LOBES) {
                    diffuse::pdf_w(self.abs_cos(wi))
                } else {
                    0.0
                }
            }
            _ => self.pdf_w_others(wo, wi, allowed),
        }
    }

    #[inline(never)]
    fn pdf_w_others(self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        match (self.side(wo), self.side(wi)) {
            (Some(side), Some(_)) => {
                self.seen_from(side).pdf_w(self.local(wo, side), self.local(wi, side), allowed)
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
            _ => self.sample_others(wo, side, allowed, u_lobe, u, mode),
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
    fn sample_others(
        self,
        wo: Vec3,
        side: f32,
        allowed: Lobes,
        u_lobe: f32,
        u: [f32; 2],
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        self.seen_from(side).sample(self.local(wo, side), allowed, u_lobe, u, mode)
    }

    /// All directions into which delta lobes scatter: at most one reflected (first) and one transmitted.
    pub fn delta_lobes(&self, wo: Vec3, mode: TransportMode) -> [Option<DeltaLobe>; 2] {
        let Some(side) = self.side(wo) else { return [None; 2] };
        self.seen_from(side).delta_lobes(self.local(wo, side), mode).map(|lobe| {
            lobe.map(|l| DeltaLobe { wi: self.world(l.wi, side), ..l }).filter(|l| {
                if l.lobes.contains(Lobes::REFLECTION) {
                    self.reflects(wo, l.wi)
                } else {
                    self.transmits(wo, l.wi)
                }
            })
        })
    }

    /// Share of the flux from `wo` that is scattered at all, per lane: exact for diffuse, mirror, dielectric and
    /// smooth kinds; within the tables' 1 % for rough plastic; for rough metals and glass with Fresnel taken at the
    /// mirror's angle; for the principled model by its layers; for phong the upper bound kd + ks.
    #[inline]
    pub fn albedo(&self, wo: Vec3) -> Lanes {
        match self.kind {
            BsdfKind::Diffuse { albedo } => albedo,
            _ => self.albedo_others(wo),
        }
    }

    #[inline(never)]
    fn albedo_others(self, wo: Vec3) -> Lanes {
        let side = 1f32.copysign(self.frame.z.dot(wo));
        self.seen_from(side).albedo(self.local(wo, side))
    }

    #[inline]
    fn seen_from(&self, side: f32) -> Local {
        let side = if side > 0.0 { Side::Front } else { Side::Back };
        Local { kind: self.kind, prepared: self.prepared, side }
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
    fn world(&self, w: Vec3, side: f32) -> Vec3 {
        self.frame.to_world(Vec3::new(w.x, w.y, w.z * side))
    }
}

impl DeltaLobe {
    /// The sample that chooses this lobe with `probability`, by which the weight was divided already.
    #[inline]
    pub(crate) fn drawn(self, probability: f32) -> BsdfSample {
        BsdfSample { wi: self.wi, weight: self.weight, pdf_w: probability, lobes: self.lobes, eta: self.eta }
    }
}
