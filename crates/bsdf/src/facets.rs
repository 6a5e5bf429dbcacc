use math::{PI, Vec3, spherical_direction};

use crate::beckmann::Beckmann;
use crate::facet_loss::{facet_loss, facet_loss_mean};
use crate::ggx::{ALPHA_MIN, Ggx, half};

/// How the microscopic surface of a rough kind is modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facets {
    /// GGX, the energy of light that bounces more than once among the facets restored (Kulla & Conty 2017).
    #[default]
    Conserving,
    /// GGX, one bounce alone: darkens with roughness. What pbrt-v4 renders.
    SingleBounce,
    /// GGX, one bounce alone, masking separable: Mitsuba's `ggx`.
    Separable,
    /// Beckmann, one bounce alone, masking separable: Mitsuba's `beckmann`.
    Beckmann,
}

/// Facets of a given roughness. Local directions; those named `wo` have z > 0.
#[derive(Clone, Copy)]
pub(crate) enum Micro {
    Conserving {
        ggx: Ggx,
        alpha: [f32; 2],
    },
    SingleBounce(Ggx),
    Separable(Ggx),
    /// Normals are drawn from the visible ones of GGX: its tail is longer, the ratio of the two densities is at most 4/e.
    Beckmann(Beckmann, Ggx),
}

impl Micro {
    #[inline]
    pub fn new(facets: Facets, alpha: [f32; 2]) -> Self {
        match facets {
            Facets::Conserving => Self::Conserving { ggx: Ggx::xy(alpha), alpha },
            Facets::SingleBounce => Self::SingleBounce(Ggx::xy(alpha)),
            Facets::Separable => Self::Separable(Ggx::xy(alpha)),
            Facets::Beckmann => Self::Beckmann(Beckmann::xy(alpha), Ggx::xy(alpha)),
        }
    }

    /// Density of normals.
    #[inline]
    pub fn d(&self, h: Vec3) -> f32 {
        match self {
            Self::Conserving { ggx, .. } | Self::SingleBounce(ggx) | Self::Separable(ggx) => ggx.d(h),
            Self::Beckmann(b, _) => b.d(h),
        }
    }

    /// G₂/(4 |cosθo| |cosθi|).
    #[inline]
    pub fn visibility(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Conserving { ggx, .. } | Self::SingleBounce(ggx) => ggx.visibility(wo, wi),
            Self::Separable(ggx) => ggx.visibility_separable(wo, wi),
            Self::Beckmann(b, _) => b.visibility(wo, wi),
        }
    }

    /// The distribution from which facets are drawn.
    #[inline]
    fn drawn(&self) -> &Ggx {
        match self {
            Self::Conserving { ggx, .. }
            | Self::SingleBounce(ggx)
            | Self::Separable(ggx)
            | Self::Beckmann(_, ggx) => ggx,
        }
    }

    /// `wi` mirrored in a facet. It may lie below the horizon.
    #[inline]
    pub fn sample_reflected(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        self.drawn().sample(wo, u)
    }

    /// Density of [`Self::sample_reflected`] above the horizon, per steradian of `wi`, of which `h` is the half vector.
    #[inline]
    pub fn pdf_reflected(&self, wo: Vec3, h: Vec3) -> f32 {
        self.drawn().pdf_w(wo, h)
    }

    /// A normal of a facet, for refraction. It may face away from `wo`.
    #[inline]
    pub fn sample_normal(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        self.drawn().sample_normal(wo, u)
    }

    /// Density of [`Self::sample_normal`] per steradian of the normal.
    #[inline]
    pub fn pdf_normal(&self, wo: Vec3, h: Vec3) -> f32 {
        self.drawn().pdf_normal(wo, h)
    }

    /// D·G₂/(4 cosθo cosθi) of a reflection.
    #[inline]
    pub fn reflection(&self, wo: Vec3, wi: Vec3, h: Vec3) -> f32 {
        self.d(h) * self.visibility(wo, wi)
    }

    /// What a single bounce in perfect mirrors loses of the light along `w`, if it is restored; else 0.
    #[inline]
    pub fn restored(&self, w: Vec3) -> f32 {
        match self {
            Self::Conserving { alpha, .. } => facet_loss(w, *alpha),
            Self::SingleBounce(_) | Self::Separable(_) | Self::Beckmann(..) => 0.0,
        }
    }

    /// (1/π)∫ of [`Self::restored`]·cos over the hemisphere, never 0, where anything is restored.
    pub fn restored_mean(&self) -> Option<f32> {
        match self {
            Self::Conserving { alpha, .. } => Some(facet_loss_mean(*alpha)),
            Self::SingleBounce(_) | Self::Separable(_) | Self::Beckmann(..) => None,
        }
    }
}

/// Whether a roughness stands for no facets at all: a smooth surface, whose lobe is a delta.
#[inline]
pub(crate) fn is_smooth(alpha: [f32; 2]) -> bool {
    alpha == [0.0; 2]
}

/// The isotropic roughness that stands for an anisotropic one in the sampling of wide lobes: the root mean square.
#[inline]
pub(crate) fn isotropic([x, y]: [f32; 2]) -> f32 {
    if x == y { x } else { (0.5 * (x * x + y * y)).sqrt().max(ALPHA_MIN) }
}

/// The half vector of a refraction, on the side of `wo`: `eta` is the index on the side of `wi` over that on the side of
/// `wo`. `None` where the facet would show its back to either direction.
#[inline]
pub(crate) fn half_refracted(wo: Vec3, wi: Vec3, eta: f32) -> Option<Vec3> {
    let h = (wo + wi * eta).try_normalize()?;
    let h = if h.z < 0.0 { -h } else { h };
    (wo.dot(h) > 0.0 && wi.dot(h) < 0.0).then_some(h)
}

/// The half vector of a reflection.
#[inline]
pub(crate) fn half_reflected(wo: Vec3, wi: Vec3) -> Vec3 {
    half(wo, wi)
}

/// The loss of a single bounce falls like (α/μ)² above μ ≈ 2α and is level below. So the lobe of further bounces,
/// loss · μ, is followed by μ/(μ² + b²), b = 2α, whose integral inverts in closed form. A cosine lobe would leave
/// weights of 1/loss at small α.
fn further_b2(alpha: f32) -> f32 {
    4.0 * alpha.max(ALPHA_MIN).powi(2)
}

/// A direction of the lobe of further bounces (z > 0).
pub(crate) fn sample_further(u: [f32; 2], alpha: f32) -> Vec3 {
    let b2 = further_b2(alpha);
    let mu2 = b2 * (u[0] * (1.0 / b2).ln_1p()).exp_m1();
    spherical_direction(mu2.clamp(0.0, 1.0).sqrt(), 2.0 * PI * u[1])
}

/// Density of [`sample_further`].
pub(crate) fn further_pdf_w(mu: f32, alpha: f32) -> f32 {
    let b2 = further_b2(alpha);
    mu / ((mu * mu + b2) * (1.0 / b2).ln_1p() * PI)
}
