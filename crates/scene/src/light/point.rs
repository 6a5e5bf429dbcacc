use color::Lanes;
use math::{PI, Vec3};

use super::LiSample;

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: Vec3,
    intensity: Lanes,
}

impl PointLight {
    /// From position and intensity (W/sr). `None` where one is not finite or a lane is negative.
    pub fn new(position: Vec3, intensity: Lanes) -> Option<Self> {
        (position.is_finite() && super::is_emission(intensity)).then_some(Self { position, intensity })
    }

    /// Position.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Intensity, W/sr.
    pub fn intensity(&self) -> Lanes {
        self.intensity
    }

    /// 4π·I.
    pub fn power(&self) -> Lanes {
        self.intensity * (4.0 * PI)
    }

    pub(super) fn sample_li(&self, p: Vec3) -> Option<LiSample> {
        toward_point(p, self.position, |_| self.intensity)
    }
}

/// The receiver's view of a point with the intensity given by direction of flight.
pub(super) fn toward_point(p: Vec3, position: Vec3, intensity: impl Fn(Vec3) -> Lanes) -> Option<LiSample> {
    let to_light = position - p;
    let d2 = to_light.length_squared();
    let distance = d2.sqrt();
    let wi = to_light / distance;
    let radiance = intensity(-wi) / d2;
    (radiance.is_finite() && !radiance.is_zero()).then_some(LiSample {
        wi,
        distance,
        radiance,
        pdf_w: 1.0,
        is_delta: true,
        p: position,
        p_error: 0.0,
        n: Vec3::ZERO,
        prim: 0,
    })
}
