//! What all area lights share.

use color::Lanes;
use math::{FRAC_1_PI, Frame, PI, Vec3};
use sampling::warp;

use super::emission::Origin;
use super::{LiSample, LightHit};

/// Which sides of a surface emit. The front is where the geometric normal points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// The front alone (of a sphere: the outside).
    #[default]
    Front,
    /// The back alone (of a sphere: the inside).
    Back,
    /// Both.
    Both,
}

impl Sides {
    /// The normal on the side of `w` and their cosine > 0; `None` where that side does not emit.
    #[inline]
    pub fn facing(self, ng: Vec3, w: Vec3) -> Option<(Vec3, f32)> {
        let cos = ng.dot(w);
        match self {
            Self::Front | Self::Both if cos > 0.0 => Some((ng, cos)),
            Self::Back | Self::Both if cos < 0.0 => Some((-ng, -cos)),
            _ => None,
        }
    }

    pub(super) fn may_reach(self, ng: Vec3, to_center: Vec3, radius: f32) -> bool {
        let height = ng.dot(to_center);
        match self {
            Self::Front => height > -radius,
            Self::Back => height < radius,
            Self::Both => true,
        }
    }
}

/// Equal radiance in all directions (Lambertian) on the emitting sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaEmission {
    /// Radiance, W/(m²·sr).
    pub radiance: Lanes,
    /// Emitting sides.
    pub sides: Sides,
}

impl AreaEmission {
    /// Radiance that leaves along `w`.
    #[inline]
    pub fn emitted(&self, ng: Vec3, w: Vec3) -> Lanes {
        if self.sides.facing(ng, w).is_some() { self.radiance } else { Lanes::ZERO }
    }

    /// Flux: π·L·A for each emitting side.
    pub fn power(&self, area: f32) -> Lanes {
        self.radiance * (self.spread() * area)
    }

    /// Flux over radiance and area: π for each emitting side.
    pub(super) fn spread(&self) -> f32 {
        if self.sides == Sides::Both { 2.0 * PI } else { PI }
    }

    /// Cosine-weighted over the emitting sides.
    pub(super) fn sample_direction(&self, ng: Vec3, u: [f32; 2]) -> Vec3 {
        let (n, u) = match self.sides {
            Sides::Front => (ng, u),
            Sides::Back => (-ng, u),
            Sides::Both if u[0] < 0.5 => (ng, [2.0 * u[0], u[1]]),
            Sides::Both => (-ng, [2.0 * u[0] - 1.0, u[1]]),
        };
        Frame::from_z(n).to_world(warp::cosine_hemisphere(u))
    }

    /// Density of [`Self::sample_direction`] per steradian.
    pub(super) fn pdf_le_w(&self, ng: Vec3, w: Vec3) -> f32 {
        let share = if self.sides == Sides::Both { 0.5 } else { 1.0 };
        self.sides.facing(ng, w).map_or(0.0, |(_, cos)| cos * FRAC_1_PI * share)
    }

    /// The receiver's view of a point drawn uniformly from `area`: density d²/(cos·A).
    #[inline]
    pub(super) fn li_from_area(&self, area: f32, receiver: Vec3, origin: &Origin) -> Option<LiSample> {
        let to_light = origin.p - receiver;
        let d2 = to_light.length_squared();
        let distance = d2.sqrt();
        let wi = to_light * (1.0 / distance);
        let (n, cos) = self.sides.facing(origin.ng, -wi)?;
        let pdf_w = d2 / (cos * area);
        (pdf_w.is_finite() && pdf_w > 0.0).then_some(LiSample {
            wi,
            distance,
            radiance: self.radiance,
            pdf_w,
            is_delta: false,
            p: origin.p,
            p_error: origin.p_error,
            n,
            prim: origin.prim,
        })
    }

    /// Density of [`Self::li_from_area`] per steradian.
    pub(super) fn pdf_li_w(&self, area: f32, receiver: Vec3, wi: Vec3, hit: LightHit) -> f32 {
        let Some((_, cos)) = self.sides.facing(hit.ng, -wi) else { return 0.0 };
        let pdf_w = receiver.distance_squared(hit.p) / (cos * area);
        if pdf_w.is_finite() { pdf_w } else { 0.0 }
    }
}
