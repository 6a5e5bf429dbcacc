use color::Lanes;
use math::Vec3;

use super::point::toward_point;
use super::{GoniometricShape, LiSample, ProfileShape, SlideShape};

/// A point whose intensity is given by direction: as measured, or as a picture has it.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedLight {
    position: Vec3,
    shape: IntensityShape,
    power: Lanes,
    solid_angle: f32,
}

/// Intensity by direction.
#[derive(Clone, Debug, PartialEq)]
pub enum IntensityShape {
    /// Of a photometric file.
    Profile(ProfileShape),
    /// A picture of the whole sphere.
    Goniometric(GoniometricShape),
    /// A picture that is thrown.
    Slide(SlideShape),
}

impl IntensityShape {
    /// ∫ intensity dω, and the greatest intensity.
    fn flux_and_peak(&self) -> (Lanes, f32) {
        match self {
            Self::Profile(shape) => shape.flux_and_peak(),
            Self::Goniometric(shape) => shape.flux_and_peak(),
            Self::Slide(shape) => shape.flux_and_peak(),
        }
    }
}

impl ShapedLight {
    /// `None` where the position or the flux is not finite, or all is black.
    pub fn new(position: Vec3, shape: IntensityShape) -> Option<Self> {
        let (power, peak) = shape.flux_and_peak();
        let solid_angle = power.mean() / peak;
        let lit = super::is_emission(power) && solid_angle > 0.0 && solid_angle.is_finite();
        (position.is_finite() && lit).then_some(Self { position, shape, power, solid_angle })
    }

    /// Position.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// What shapes it.
    pub fn shape(&self) -> &IntensityShape {
        &self.shape
    }

    /// ∫ intensity dω.
    pub fn power(&self) -> Lanes {
        self.power
    }

    /// Flux over greatest intensity.
    pub(super) fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// W/sr along the unit vector `w`.
    pub fn intensity_along(&self, w: Vec3) -> Lanes {
        match &self.shape {
            IntensityShape::Profile(shape) => shape.intensity(w),
            IntensityShape::Goniometric(shape) => shape.intensity(w),
            IntensityShape::Slide(shape) => shape.intensity(w),
        }
    }

    /// Density of [`Self::sample_direction`] per steradian; not 0 where there is light.
    pub(super) fn pdf_w(&self, w: Vec3) -> f32 {
        match &self.shape {
            IntensityShape::Profile(shape) => shape.pdf_w(w),
            IntensityShape::Goniometric(shape) => shape.pdf_w(w),
            IntensityShape::Slide(shape) => shape.pdf_w(w),
        }
    }

    /// About in proportion to the luminance of the intensity.
    pub(super) fn sample_direction(&self, u: [f32; 2]) -> Vec3 {
        match &self.shape {
            IntensityShape::Profile(shape) => shape.sample(u),
            IntensityShape::Goniometric(shape) => shape.sample(u),
            IntensityShape::Slide(shape) => shape.sample(u),
        }
    }

    /// `true` if in doubt.
    pub(super) fn may_reach(&self, to_center: Vec3, radius: f32) -> bool {
        let (axis, angle) = match &self.shape {
            IntensityShape::Profile(shape) => shape.cone(),
            IntensityShape::Goniometric(_) => return true,
            IntensityShape::Slide(shape) => shape.cone(),
        };
        let d = to_center.length();
        d <= radius || to_center.angle_between(axis) - (radius / d).asin() < angle + 1e-4
    }

    #[inline(never)]
    pub(super) fn sample_li(&self, p: Vec3) -> Option<LiSample> {
        toward_point(p, self.position, |w| self.intensity_along(w))
    }
}
