use color::Lanes;
use math::{Bounds3, PI, Vec3};
use sampling::warp;

use super::directional::SceneSphere;
use super::{LeSample, LiSample};
use crate::target::Targets;

/// Equal radiance from everywhere at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentLight {
    radiance: Lanes,
    scene: SceneSphere,
}

impl EnvironmentLight {
    /// From the radiance, W/(m²·sr). `None` where it is not finite or a lane is negative.
    pub fn new(radiance: Lanes) -> Option<Self> {
        super::is_emission(radiance).then(|| Self { radiance, scene: SceneSphere::default() })
    }

    /// Radiance.
    pub fn radiance(&self) -> Lanes {
        self.radiance
    }

    /// 4π²R²·L for a scene within a sphere of radius R.
    pub fn power(&self) -> Lanes {
        self.radiance * (4.0 * PI * self.scene.disc_area())
    }

    pub(super) fn preprocess(&mut self, bounds: Bounds3) {
        self.scene = SceneSphere::of(bounds);
    }

    pub(super) fn sample_li(&self, p: Vec3, u: [f32; 2]) -> Option<LiSample> {
        Some(self.scene.sample_li(p, warp::sphere(u), warp::SPHERE_PDF_W, self.radiance))
    }

    pub(super) fn pdf_li_w(&self) -> f32 {
        warp::SPHERE_PDF_W
    }

    pub(super) fn sample_le(&self, u_pos: [f32; 2], u_dir: [f32; 2]) -> Option<LeSample> {
        self.scene.sample_le(warp::sphere(u_dir), warp::SPHERE_PDF_W, self.radiance, u_pos)
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
        let w = warp::sphere(u_dir);
        self.scene.sample_le_toward(targets, w, warp::SPHERE_PDF_W, self.radiance, u_pick, u_pos)
    }
}
