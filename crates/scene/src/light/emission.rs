//! What light paths of all lights at finite places share: a point, and a distribution of directions there.

use color::Lanes;
use math::{PI, Vec3, gamma};
use sampling::warp;

use super::{AreaEmission, ShapedLight, SpotLight};

/// A point of a light.
pub(super) struct Origin {
    pub p: Vec3,
    pub p_error: f32,
    /// Unit normal of the front side; zero for point-like lights.
    pub ng: Vec3,
    /// Density per area; 1 for point-like lights.
    pub pdf_a: f32,
    pub prim: u32,
}

impl Origin {
    pub fn at_point(p: Vec3) -> Self {
        Self { p, p_error: 0.0, ng: Vec3::ZERO, pdf_a: 1.0, prim: 0 }
    }
}

/// Error of a point that was computed as centre + offset with a few roundings: a cube, as for the points of shapes.
pub(super) fn error_about(center: Vec3, reach: Vec3) -> f32 {
    gamma(8) * (center.abs() + reach.abs()).max_element()
}

/// How light leaves one point.
pub(super) enum Emission<'a> {
    /// Equal intensity everywhere.
    Uniform(Lanes),
    /// A spot's cone.
    Spot(&'a SpotLight),
    /// Given by direction.
    Shaped(&'a ShapedLight),
    /// Equal radiance on the emitting sides of a surface with this front normal.
    Lambert(&'a AreaEmission, Vec3),
}

impl Emission<'_> {
    /// A direction in proportion to what leaves along it, and its density per steradian.
    pub fn sample(&self, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let w = match self {
            Self::Uniform(_) => warp::sphere(u),
            Self::Spot(spot) => spot.sample_direction(u),
            Self::Shaped(light) => light.sample_direction(u),
            Self::Lambert(surface, ng) => surface.sample_direction(*ng, u),
        };
        let pdf_w = self.pdf_w(w);
        (pdf_w > 0.0).then_some((w, pdf_w))
    }

    /// Density of [`Self::sample`] per steradian.
    pub fn pdf_w(&self, w: Vec3) -> f32 {
        match self {
            Self::Uniform(_) => warp::SPHERE_PDF_W,
            Self::Spot(spot) => spot.pdf_w(w),
            Self::Shaped(light) => light.pdf_w(w),
            Self::Lambert(surface, ng) => surface.pdf_le_w(*ng, w),
        }
    }

    /// Radiance or intensity along `w`, its cosine (1 for points) and the normal on the side of `w`; `None` where
    /// nothing leaves.
    pub fn along(&self, w: Vec3) -> Option<(Lanes, f32, Vec3)> {
        match self {
            Self::Uniform(intensity) => Some((*intensity, 1.0, Vec3::ZERO)),
            Self::Spot(spot) => {
                let intensity = spot.intensity_along(w);
                (!intensity.is_zero()).then_some((intensity, 1.0, Vec3::ZERO))
            }
            Self::Shaped(light) => {
                let intensity = light.intensity_along(w);
                (!intensity.is_zero()).then_some((intensity, 1.0, Vec3::ZERO))
            }
            Self::Lambert(surface, ng) => {
                let (n, cos) = surface.sides.facing(*ng, w)?;
                Some((surface.radiance, cos, n))
            }
        }
    }

    /// Solid angle over which the light is spread: flux over greatest intensity.
    pub fn solid_angle(&self) -> f32 {
        match self {
            Self::Uniform(_) => 4.0 * PI,
            Self::Spot(spot) => spot.solid_angle() as f32,
            Self::Shaped(light) => light.solid_angle(),
            Self::Lambert(surface, _) => surface.spread(),
        }
    }

    /// Whether light may leave from `x` toward some point of the sphere (conservative: `true` if in doubt).
    pub fn may_reach(&self, to_center: Vec3, radius: f32) -> bool {
        match self {
            Self::Uniform(_) => true,
            Self::Spot(spot) => spot.may_reach(to_center, radius),
            Self::Shaped(light) => light.may_reach(to_center, radius),
            Self::Lambert(surface, ng) => surface.sides.may_reach(*ng, to_center, radius),
        }
    }
}
