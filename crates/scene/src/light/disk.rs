use color::Lanes;
use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use super::emission::{Origin, error_about};
use super::{AreaEmission, LiSample, Sides};

/// A flat disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskLight {
    center: Vec3,
    frame: Frame,
    radius: f32,
    surface: AreaEmission,
}

impl DiskLight {
    /// From centre, front normal (any length), radius and emission. `None` unless the radius is positive, the
    /// normal is not zero and all is finite and not negative.
    pub fn new(center: Vec3, normal: Vec3, radius: f32, radiance: Lanes, sides: Sides) -> Option<Self> {
        let normal = normal.try_normalize()?;
        let area = PI * radius * radius;
        let ok = center.is_finite() && radius > 0.0 && area.is_normal() && super::is_emission(radiance);
        ok.then(|| Self {
            center,
            frame: Frame::from_z(normal),
            radius,
            surface: AreaEmission { radiance, sides },
        })
    }

    /// Emission.
    pub fn surface(&self) -> &AreaEmission {
        &self.surface
    }

    /// Centre.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// Unit normal of the front.
    pub fn normal(&self) -> Vec3 {
        self.frame.z
    }

    /// Area of one side.
    pub fn area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Tight bounds.
    pub fn bounds(&self) -> Bounds3 {
        let n = self.frame.z;
        let reach = self.radius * (Vec3::ONE - n * n).max(Vec3::ZERO).map(f32::sqrt);
        Bounds3 { min: self.center - reach, max: self.center + reach }
    }

    pub(super) fn origin(&self, u: [f32; 2]) -> Origin {
        let d = warp::disk(u) * self.radius;
        let (x, y) = (self.frame.x * d.x, self.frame.y * d.y);
        let p_error = error_about(self.center, x.abs() + y.abs());
        Origin { p: self.center + x + y, p_error, ng: self.frame.z, pdf_a: 1.0 / self.area(), prim: 0 }
    }

    pub(super) fn sample_li(&self, p: Vec3, u: [f32; 2]) -> Option<LiSample> {
        self.surface.li_from_area(self.area(), p, &self.origin(u))
    }
}
