use color::Lanes;
use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use super::emission::{Origin, error_about};
use super::pattern::Pattern;
use super::{AreaEmission, LiSample, LightHit, Sides};

/// A sphere. Its front is the outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereLight {
    center: Vec3,
    radius: f32,
    surface: AreaEmission,
    pattern: Option<Box<Pattern>>,
}

/// The cone of directions from a receiver to the sphere.
struct Cone {
    /// Unit vector from the receiver to the centre.
    axis: Vec3,
    /// Distance to the centre.
    distance: f64,
    /// sin² of the half-angle.
    sin2: f64,
    /// 1 − cos of the half-angle.
    one_minus_cos: f64,
}

impl SphereLight {
    /// From centre, radius and emission. `None` unless the radius is positive and all is finite and not negative.
    pub fn new(center: Vec3, radius: f32, radiance: Lanes, sides: Sides) -> Option<Self> {
        let area = 4.0 * PI * radius * radius;
        let ok = center.is_finite() && radius > 0.0 && area.is_normal() && super::is_emission(radiance);
        ok.then_some(Self { center, radius, surface: AreaEmission { radiance, sides }, pattern: None })
    }

    /// The same with a factor on the radiance that depends on the point: of (point, 0), averaged over about a width. From outside
    /// directions are drawn evenly all the same.
    pub(super) fn textured(self, factor: impl Fn(Vec3, u32, f32) -> Lanes) -> Option<Self> {
        let at = |prim: u32, u, width| factor(self.origin_at(warp::sphere(u), 0.0).p, prim, width);
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
            Some(pattern) => pattern.pdf_a(0, warp::sphere_inverse((p - self.center).normalize_or(Vec3::Z))),
        }
    }

    /// Area of the sphere.
    pub fn area(&self) -> f32 {
        4.0 * PI * self.radius * self.radius
    }

    /// Bounds of the sphere.
    pub fn bounds(&self) -> Bounds3 {
        let r = Vec3::splat(self.radius);
        Bounds3 { min: self.center - r, max: self.center + r }
    }

    pub(super) fn origin(&self, u_pick: f32, u: [f32; 2]) -> Origin {
        match &self.pattern {
            None => self.origin_at(warp::sphere(u), 1.0 / self.area()),
            Some(pattern) => {
                let s = pattern.sample(u_pick, u);
                self.origin_at(warp::sphere(s.u), s.pdf_a)
            }
        }
    }

    fn origin_at(&self, ng: Vec3, pdf_a: f32) -> Origin {
        let p_error = error_about(self.center, Vec3::splat(self.radius));
        Origin { p: self.center + ng * self.radius, p_error, ng, pdf_a, prim: 0 }
    }

    /// The cone in which the outside is seen; `None` where the receiver is to be served by sampling the area: on
    /// or within the sphere, and where only the inside shines.
    fn cone(&self, p: Vec3) -> Option<Cone> {
        let to_center = (self.center - p).as_dvec3();
        let distance = to_center.length();
        let radius = f64::from(self.radius);
        // Points on an emitting inner side may lie a rounding error outside.
        let skin = if self.surface.sides == Sides::Both { 1.0 + 1e-5 } else { 1.0 };
        if self.surface.sides == Sides::Back || distance <= radius * skin {
            return None;
        }
        let sin2 = (radius / distance).powi(2);
        let cos = ((distance - radius) * (distance + radius)).sqrt() / distance;
        Some(Cone {
            axis: (to_center / distance).as_vec3(),
            distance,
            sin2,
            one_minus_cos: sin2 / (1.0 + cos),
        })
    }

    pub(super) fn sample_li(&self, p: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        let Some(cone) = self.cone(p) else {
            let origin = self.origin(u_pick, u);
            let area = if self.pattern.is_some() { 1.0 / origin.pdf_a } else { self.area() };
            return self.surface.li_from_area(area, p, &origin);
        };
        // Uniform in the cone (Pharr, Jakob & Humphreys 2023, §6.2.4), with the polar angles at the receiver (θ)
        // and at the centre (α) in f64: sin α = (sin θ/sin θmax)·…, so that no distance cancels.
        let z = f64::from(u[0]) * cone.one_minus_cos;
        let (cos, sin2) = (1.0 - z, z * (2.0 - z));
        let sin = sin2.sqrt();
        // Distance from the foot of the centre on the ray to the surface, in radii: √(1 − sin²θ/sin²θmax).
        let half_chord = (1.0 - sin2 / cone.sin2).max(0.0).sqrt();
        let radius = f64::from(self.radius);
        // α = angle at the centre between the receiver and the point.
        let sin_max = cone.sin2.sqrt();
        let cos_alpha = sin2 / sin_max + cos * half_chord;
        let sin_alpha = sin / sin_max * cos - sin * half_chord;
        let (s, c) = (2.0 * std::f64::consts::PI * f64::from(u[1])).sin_cos();
        let frame = Frame::from_z(cone.axis);
        let local = |sin: f64, cos: f64| Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32);
        let wi = frame.to_world(local(sin, cos)).normalize();
        let ng = frame.to_world(local(sin_alpha, -cos_alpha)).normalize();
        // Law of cosines without cancellation: the near root is (D² − R²)/(D cos θ + R·half_chord).
        let gap = (cone.distance - radius) * (cone.distance + radius);
        let distance = gap / (cone.distance * cos + radius * half_chord);
        let origin = self.origin_at(ng, 0.0);
        Some(LiSample {
            wi,
            distance: distance as f32,
            radiance: self.surface.radiance,
            pdf_w: (1.0 / (2.0 * std::f64::consts::PI * cone.one_minus_cos)) as f32,
            is_delta: false,
            p: origin.p,
            p_error: origin.p_error,
            n: ng,
            prim: 0,
        })
    }

    pub(super) fn pdf_li_w(&self, p: Vec3, wi: Vec3, hit: LightHit) -> f32 {
        match self.cone(p) {
            // The far side of a sphere that also shines inward is never drawn from outside.
            Some(_) if hit.ng.dot(wi) >= 0.0 => 0.0,
            Some(cone) => (1.0 / (2.0 * std::f64::consts::PI * cone.one_minus_cos)) as f32,
            None => {
                let area = if self.pattern.is_some() { 1.0 / self.pdf_a(hit.p) } else { self.area() };
                self.surface.pdf_li_w(area, p, wi, hit)
            }
        }
    }
}
