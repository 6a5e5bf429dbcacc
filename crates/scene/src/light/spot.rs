use color::Lanes;
use math::{Frame, PI, Vec3};

use super::LiSample;
use super::point::toward_point;

/// A point that shines within a cone about an axis: full intensity I within the inner half-angle, none beyond the
/// outer, between them I·(3t² − 2t³) with t running linearly in the cosine from 0 (outer) to 1 (inner).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    position: Vec3,
    frame: Frame,
    intensity: Lanes,
    /// 1 − cos of the half-angles, which keeps narrow cones exact.
    inner: f64,
    outer: f64,
    outer_angle: f32,
}

impl SpotLight {
    /// From position, axis (any length), intensity on the axis (W/sr) and half-angles in radians.
    /// `None` unless 0 ≤ inner ≤ outer ≤ π, outer > 0, the axis is not zero and all is finite.
    pub fn new(position: Vec3, axis: Vec3, intensity: Lanes, inner: f32, outer: f32) -> Option<Self> {
        let axis = axis.try_normalize()?;
        let angles = 0.0 <= inner && inner <= outer && 0.0 < outer && outer <= PI;
        let one_minus_cos = |a: f32| 2.0 * (0.5 * f64::from(a)).sin().powi(2);
        (angles && position.is_finite() && super::is_emission(intensity)).then(|| Self {
            position,
            frame: Frame::from_z(axis),
            intensity,
            inner: one_minus_cos(inner),
            outer: one_minus_cos(outer),
            outer_angle: outer,
        })
    }

    /// Position.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// 2π·I·((1 − cos inner) + (cos inner − cos outer)/2): the falloff has mean ½ in the cosine.
    pub fn power(&self) -> Lanes {
        self.intensity * self.solid_angle() as f32
    }

    /// ∫ falloff dω.
    pub(super) fn axis(&self) -> Vec3 {
        self.frame.z
    }

    pub(super) fn outer_angle(&self) -> f32 {
        self.outer_angle
    }

    pub(super) fn solid_angle(&self) -> f64 {
        std::f64::consts::PI * (self.inner + self.outer)
    }

    fn falloff(&self, w: Vec3) -> f32 {
        // 1 − cos of two unit vectors is half their squared distance, without cancellation.
        let x = 0.5 * f64::from((w - self.frame.z).length_squared());
        if x <= self.inner {
            1.0
        } else if x >= self.outer {
            0.0
        } else {
            let t = (self.outer - x) / (self.outer - self.inner);
            (t * t * (3.0 - 2.0 * t)) as f32
        }
    }

    pub(super) fn intensity_along(&self, w: Vec3) -> Lanes {
        self.intensity * self.falloff(w)
    }

    pub(super) fn pdf_w(&self, w: Vec3) -> f32 {
        (f64::from(self.falloff(w)) / self.solid_angle()) as f32
    }

    /// Proportional to intensity.
    pub(super) fn sample_direction(&self, u: [f32; 2]) -> Vec3 {
        // Shares of the cap and of the rim, in units of 2π.
        let (cap, rim) = (self.inner, 0.5 * (self.outer - self.inner));
        let mass = f64::from(u[0]) * (cap + rim);
        let x = if mass < cap {
            mass
        } else {
            let t = inverse_falloff_cdf(1.0 - ((mass - cap) / rim).min(1.0));
            self.outer - t * (self.outer - self.inner)
        };
        let sin = (x * (2.0 - x)).max(0.0).sqrt() as f32;
        let (s, c) = (2.0 * PI * u[1]).sin_cos();
        self.frame.to_world(Vec3::new(sin * c, sin * s, (1.0 - x) as f32)).normalize()
    }

    pub(super) fn may_reach(&self, to_center: Vec3, radius: f32) -> bool {
        let d = to_center.length();
        if d <= radius {
            return true;
        }
        let angle = to_center.angle_between(self.frame.z);
        angle - (radius / d).asin() < self.outer_angle + 1e-4
    }

    pub(super) fn sample_li(&self, p: Vec3) -> Option<LiSample> {
        toward_point(p, self.position, |w| self.intensity_along(w))
    }
}

/// t in [0, 1] with 2t³ − t⁴ = u, the share of ∫(3s² − 2s³) ds that lies below t. Safeguarded Newton; error < 1e-12.
fn inverse_falloff_cdf(u: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = (0.5 * u).cbrt().min(1.0);
    for _ in 0..32 {
        let f = t * t * t * (2.0 - t) - u;
        if f > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let slope = t * t * (6.0 - 4.0 * t);
        let next = t - f / slope;
        let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
        if (next - t).abs() < 1e-13 {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falloff_cdf_is_inverted() {
        for i in 0..=1000 {
            let u = f64::from(i) / 1000.0;
            let t = inverse_falloff_cdf(u);
            assert!((0.0..=1.0).contains(&t));
            assert!((2.0 * t.powi(3) - t.powi(4) - u).abs() < 1e-12, "{u} {t}");
        }
    }
}
