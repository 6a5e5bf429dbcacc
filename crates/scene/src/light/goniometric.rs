use color::{Lanes, luminance};
use math::{Transform, Vec3};
use scenefile::desc::SkyMapping;

use super::SkyLight;

/// Intensity as a picture of the whole sphere has it: drawn from as a sky is.
#[derive(Clone, Debug, PartialEq)]
pub struct GoniometricShape {
    sphere: SkyLight,
    peak: f32,
}

impl GoniometricShape {
    /// From linear RGB, row by row from the top, of which the luminance counts, times `intensity` (W/sr). `None` where
    /// counts disagree, a picture of equal areas is not square, something is negative or not finite, or all is black.
    pub fn new(
        mapping: SkyMapping,
        size: [usize; 2],
        pixels: impl IntoIterator<Item = [f32; 3]>,
        intensity: [f32; 3],
        world_from_light: Transform,
    ) -> Option<Self> {
        let pixels: Vec<[f32; 3]> =
            pixels.into_iter().map(|rgb| intensity.map(|i| i * luminance(rgb))).collect();
        let peak = pixels.iter().map(|rgb| (rgb[0] + rgb[1] + rgb[2]) / 3.0).fold(0.0, f32::max);
        SkyLight::new(mapping, size, pixels, world_from_light).map(|sphere| Self { sphere, peak })
    }

    pub(super) fn flux_and_peak(&self) -> (Lanes, f32) {
        (self.sphere.integral(), self.peak)
    }

    pub(super) fn intensity(&self, w: Vec3) -> Lanes {
        self.sphere.radiance(w)
    }

    pub(super) fn pdf_w(&self, w: Vec3) -> f32 {
        self.sphere.pdf_w(w)
    }

    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        self.sphere.draw(u)
    }
}
