use color::Lanes;
use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use super::{LeSample, LiSample};
use crate::target::Targets;

/// The sphere about the scene that lights at infinity shine on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SceneSphere {
    pub center: Vec3,
    pub radius: f32,
}

impl SceneSphere {
    /// A trifle larger than the box, so that rounding leaves no rim unlit. Radius 0 for an empty box.
    pub fn of(bounds: Bounds3) -> Self {
        if bounds.is_empty() {
            return Self::default();
        }
        let (center, radius) = bounds.bounding_sphere();
        Self { center, radius: radius * 1.0001 }
    }

    /// Area of a great disc.
    pub fn disc_area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Centre of the disc that light along `w` comes from.
    pub fn entry(&self, w: Vec3) -> Vec3 {
        self.center - w * self.radius
    }

    /// Light that arrives at `p` along −`wi`.
    pub fn sample_li(&self, p: Vec3, wi: Vec3, pdf_w: f32, radiance: Lanes) -> LiSample {
        LiSample {
            wi,
            distance: f32::INFINITY,
            radiance,
            pdf_w,
            is_delta: false,
            p: p + wi * (2.0 * self.radius),
            p_error: 0.0,
            n: Vec3::ZERO,
            prim: 0,
        }
    }

    /// A path along `w` that starts on that disc, uniform in area.
    pub fn sample_le(&self, w: Vec3, pdf_w: f32, radiance: Lanes, u: [f32; 2]) -> Option<LeSample> {
        let d = warp::disk(u) * self.radius;
        let frame = Frame::from_z(w);
        let p = self.entry(w) + frame.x * d.x + frame.y * d.y;
        self.leave(p, w, pdf_w, radiance, 1.0 / self.disc_area())
    }

    /// A path along `w` that starts in the shadow, cast backwards on the disc's plane, of a target.
    pub fn sample_le_toward(
        &self,
        targets: &Targets,
        w: Vec3,
        pdf_w: f32,
        radiance: Lanes,
        u_pick: f32,
        u: [f32; 2],
    ) -> Option<LeSample> {
        let (p, pdf_a) = targets.sample_shadow(self.entry(w), w, u_pick, u)?;
        self.leave(p, w, pdf_w, radiance, pdf_a)
    }

    fn leave(&self, p: Vec3, w: Vec3, pdf_w: f32, radiance: Lanes, pdf_a: f32) -> Option<LeSample> {
        let ok = self.radius > 0.0 && pdf_a > 0.0 && pdf_a.is_finite();
        ok.then_some(LeSample { p, p_error: 0.0, n: w, w, radiance, cos: 1.0, pdf_a, pdf_w, prim: 0 })
    }

    /// Density per area of [`Self::sample_le`] for a path through `p` along `w`.
    pub fn pdf_a(&self, p: Vec3, w: Vec3) -> f32 {
        let v = p - self.center;
        let off = v - w * v.dot(w);
        let inside = self.radius > 0.0 && off.length_squared() <= self.radius * self.radius;
        if inside { 1.0 / self.disc_area() } else { 0.0 }
    }
}

/// Parallel light from infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    direction: Vec3,
    irradiance: Lanes,
    scene: SceneSphere,
}

impl DirectionalLight {
    /// From the direction of flight (any length) and the irradiance on a surface facing it (W/m²).
    /// `None` where the direction is zero, something is not finite or a lane is negative.
    pub fn new(direction: Vec3, irradiance: Lanes) -> Option<Self> {
        let direction = direction.try_normalize()?;
        super::is_emission(irradiance).then(|| Self { direction, irradiance, scene: SceneSphere::default() })
    }

    /// Unit direction of flight.
    pub fn direction(&self) -> Vec3 {
        self.direction
    }

    /// E·πR² for a scene within a sphere of radius R.
    pub fn power(&self) -> Lanes {
        self.irradiance * self.scene.disc_area()
    }

    pub(super) fn preprocess(&mut self, bounds: Bounds3) {
        self.scene = SceneSphere::of(bounds);
    }

    pub(super) fn sample_li(&self, p: Vec3) -> Option<LiSample> {
        let li = self.scene.sample_li(p, -self.direction, 1.0, self.irradiance);
        Some(LiSample { is_delta: true, ..li })
    }

    pub(super) fn sample_le(&self, u: [f32; 2]) -> Option<LeSample> {
        self.scene.sample_le(self.direction, 1.0, self.irradiance, u)
    }

    pub(super) fn pdf_le_a(&self, p: Vec3) -> f32 {
        self.scene.pdf_a(p, self.direction)
    }

    pub(super) fn sample_le_toward(&self, targets: &Targets, u_pick: f32, u: [f32; 2]) -> Option<LeSample> {
        self.scene.sample_le_toward(targets, self.direction, 1.0, self.irradiance, u_pick, u)
    }
}
