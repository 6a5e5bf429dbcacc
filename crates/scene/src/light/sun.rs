use color::Lanes;
use math::{Bounds3, Frame, PI, Vec3};
use sampling::warp;

use super::directional::SceneSphere;
use super::sun_data::{ELEVATIONS, IRRADIANCE};
use super::{LeSample, LiSample};
use crate::target::Targets;

/// A disc at infinity of equal radiance: the sun. Directions are drawn evenly over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunLight {
    /// Unit vector toward its middle.
    to_sun: Vec3,
    /// 1 − cos of its half-angle.
    one_minus_cos: f32,
    radiance: Lanes,
    scene: SceneSphere,
}

impl SunLight {
    /// From the direction toward it (any length), half the angle across it (radians, in (0, π/2]) and the irradiance on a plane
    /// that faces it (W/m²). `None` where the direction is zero or something is out of range.
    pub fn new(to_sun: Vec3, half_angle: f32, irradiance: Lanes) -> Option<Self> {
        let to_sun = to_sun.try_normalize()?;
        if !(half_angle > 0.0 && half_angle <= 0.5 * PI) {
            return None;
        }
        let (sin, half) = (f64::from(half_angle).sin(), (0.5 * f64::from(half_angle)).sin());
        // ∫ cos dω over the disc is π sin².
        let radiance = irradiance * (1.0 / (std::f64::consts::PI * sin * sin)) as f32;
        let one_minus_cos = (2.0 * half * half) as f32;
        let ok = one_minus_cos > 0.0 && super::is_emission(radiance);
        ok.then(|| Self { to_sun, one_minus_cos, radiance, scene: SceneSphere::default() })
    }

    /// Radiance that comes from the direction `w`.
    pub fn radiance(&self, w: Vec3) -> Lanes {
        if self.pdf_w(w) > 0.0 { self.radiance } else { Lanes::ZERO }
    }

    /// Density per steradian with which light sampling draws `w`.
    pub fn pdf_w(&self, w: Vec3) -> f32 {
        let inside = 0.5 * (w - self.to_sun).length_squared() <= self.one_minus_cos;
        if inside { warp::cone_pdf_w(self.one_minus_cos) } else { 0.0 }
    }

    /// ∫L dω times the area of a great disc of the scene's sphere.
    pub fn power(&self) -> Lanes {
        self.radiance * (2.0 * PI * self.one_minus_cos * self.scene.disc_area())
    }

    /// A direction toward it; within a rounding of its rim it counts as inside.
    fn sample(&self, u: [f32; 2]) -> Vec3 {
        // A little less than the disc, so that no direction is rounded out of it: of its area a millionth.
        let u = [u[0] * (1.0 - 1e-6), u[1]];
        Frame::from_z(self.to_sun).to_world(warp::cone(u, self.one_minus_cos)).normalize()
    }

    pub(super) fn preprocess(&mut self, bounds: Bounds3) {
        self.scene = SceneSphere::of(bounds);
    }

    pub(super) fn sample_li(&self, p: Vec3, u: [f32; 2]) -> Option<LiSample> {
        let pdf_w = warp::cone_pdf_w(self.one_minus_cos);
        Some(self.scene.sample_li(p, self.sample(u), pdf_w, self.radiance))
    }

    pub(super) fn sample_le(&self, u_pos: [f32; 2], u_dir: [f32; 2]) -> Option<LeSample> {
        let pdf_w = warp::cone_pdf_w(self.one_minus_cos);
        self.scene.sample_le(-self.sample(u_dir), pdf_w, self.radiance, u_pos)
    }

    pub(super) fn pdf_le_a(&self, p: Vec3, w: Vec3) -> f32 {
        self.scene.pdf_a(p, w)
    }

    pub(super) fn sample_le_toward(
        &self,
        targets: &Targets,
        u_pick: f32,
        u_pos: [f32; 2],
        u_dir: [f32; 2],
    ) -> Option<LeSample> {
        let pdf_w = warp::cone_pdf_w(self.one_minus_cos);
        self.scene.sample_le_toward(targets, -self.sample(u_dir), pdf_w, self.radiance, u_pick, u_pos)
    }
}

/// Irradiance of the sun on a plane that faces it, W/m² in linear RGB, at an elevation above the horizon in radians (0 below)
/// through air of a turbidity, moved into [1, 10]. Linear between the elevations and turbidities of its table.
pub fn sun_irradiance(elevation: f32, turbidity: f32) -> [f32; 3] {
    if elevation.is_nan() || elevation < 0.0 {
        return [0.0; 3];
    }
    let place = |x: f32, last: usize| {
        let x = x.clamp(0.0, last as f32);
        let low = (x as usize).min(last - 1);
        (low, x - low as f32)
    };
    let at = (elevation / (0.5 * PI)).min(1.0).sqrt() * (ELEVATIONS - 1) as f32;
    let (i, s) = place(at, ELEVATIONS - 1);
    let (j, t) = place(turbidity - 1.0, IRRADIANCE.len() - 1);
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    std::array::from_fn(|c| {
        let of = |table: &[[f32; 3]; ELEVATIONS]| lerp(table[i][c], table[i + 1][c], s);
        lerp(of(&IRRADIANCE[j]), of(&IRRADIANCE[j + 1]), t)
    })
}
