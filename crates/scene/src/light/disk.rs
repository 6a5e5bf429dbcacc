use color::Lanes;
use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use super::emission::{Origin, error_about};
use super::pattern::Pattern;
use super::{AreaEmission, LiSample, LightHit, Sides};

/// A flat disc.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskLight {
    center: Vec3,
    frame: Frame,
    radius: f32,
    surface: AreaEmission,
    pattern: Option<Box<Pattern>>,
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
            pattern: None,
        })
    }

    /// The same with a factor on the radiance that depends on the point: of (point, 0), averaged over about a width.
    pub(super) fn textured(self, factor: impl Fn(Vec3, u32, f32) -> Lanes) -> Option<Self> {
        let at = |prim: u32, u, width| factor(self.origin_at(u, 0.0).p, prim, width);
        let pattern = Some(Box::new(Pattern::new(&[f64::from(self.area())], at)?));
        Some(Self { pattern, ..self })
    }

    /// Emission, without what a texture makes of it.
    pub fn surface(&self) -> &AreaEmission {
        &self.surface
    }

    pub(super) fn surface_mut(&mut self) -> &mut AreaEmission {
        &mut self.surface
    }

    pub(super) fn pattern(&self) -> Option<&Pattern> {
        self.pattern.as_deref()
    }

    /// Density of points per area.
    pub(super) fn pdf_a(&self, p: Vec3) -> f32 {
        match &self.pattern {
            None => 1.0 / self.area(),
            Some(pattern) => {
                let d = self.frame.to_local(p - self.center) / self.radius;
                pattern.pdf_a(0, warp::disk_inverse(math::Vec2::new(d.x, d.y)))
            }
        }
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

    pub(super) fn origin(&self, u_pick: f32, u: [f32; 2]) -> Origin {
        match &self.pattern {
            None => self.origin_at(u, 1.0 / self.area()),
            Some(pattern) => {
                let s = pattern.sample(u_pick, u);
                self.origin_at(s.u, s.pdf_a)
            }
        }
    }

    fn origin_at(&self, u: [f32; 2], pdf_a: f32) -> Origin {
        let d = warp::disk(u) * self.radius;
        let (x, y) = (self.frame.x * d.x, self.frame.y * d.y);
        let p_error = error_about(self.center, x.abs() + y.abs());
        Origin { p: self.center + x + y, p_error, ng: self.frame.z, pdf_a, prim: 0 }
    }

    pub(super) fn sample_li(&self, p: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        let origin = self.origin(u_pick, u);
        let area = if self.pattern.is_some() { 1.0 / origin.pdf_a } else { self.area() };
        self.surface.li_from_area(area, p, &origin)
    }

    pub(super) fn pdf_li_w(&self, receiver: Vec3, wi: Vec3, hit: LightHit) -> f32 {
        let area = if self.pattern.is_some() { 1.0 / self.pdf_a(hit.p) } else { self.area() };
        self.surface.pdf_li_w(area, receiver, wi, hit)
    }
}
