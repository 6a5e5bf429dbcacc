//! A camera that sees all directions.

use math::{Frame, Ray, Vec2, Vec3};
use scenefile::desc::SkyMapping;

use super::{CameraError, CameraSample, WePdf, WiSample};
use crate::sphere_map;

/// All directions from one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    pub(super) position: Vec3,
    /// The axes of the mapping in the world.
    frame: Frame,
    pub(super) forward: Vec3,
    pub(super) resolution: [u32; 2],
    mapping: SkyMapping,
}

impl Globe {
    /// `frame`: x to the right, y up, z backward.
    pub(super) fn new(
        position: Vec3,
        Frame { x: right, y: up, z: back }: Frame,
        mapping: SkyMapping,
        resolution: [u32; 2],
    ) -> Result<Self, CameraError> {
        // +z of the mapping is forward; what is up is +y where that is on top of the picture, and −y where −y is.
        let frame = match mapping {
            SkyMapping::LatLong => Frame { x: -right, y: up, z: -back },
            SkyMapping::EqualArea => Frame { x: right, y: -up, z: -back },
        };
        Self { position, frame, forward: -back, resolution, mapping }.with_resolution(resolution)
    }

    pub(super) fn with_resolution(self, resolution: [u32; 2]) -> Result<Self, CameraError> {
        if resolution.contains(&0) { Err(CameraError::NoPixels) } else { Ok(Self { resolution, ..self }) }
    }

    fn size(&self) -> Vec2 {
        Vec2::new(self.resolution[0] as f32, self.resolution[1] as f32)
    }

    /// Solid angle of a pixel at a height of the unit square.
    fn pixel_angle(&self, v: f32) -> f32 {
        let size = self.size();
        sphere_map::solid_angle(self.mapping, f64::from(v)) as f32 / (size.x * size.y)
    }

    fn place(&self, local: Vec3) -> Vec2 {
        sphere_map::square(self.mapping, local).into()
    }

    pub(super) fn holds(&self, film_position: Vec2) -> bool {
        film_position.cmpge(Vec2::ZERO).all() && film_position.cmplt(self.size()).all()
    }

    #[inline(never)]
    pub(super) fn sample_we(&self, film_position: Vec2) -> CameraSample {
        let [u, v] = (film_position / self.size()).to_array();
        let at = sphere_map::continued(self.mapping, [f64::from(u), f64::from(v)]);
        let w = self.frame.to_world(sphere_map::direction(self.mapping, at)).normalize();
        // About a pole a pixel is wider than where it is drawn: its mean is that of a quarter of a row away.
        let least = 0.25 / self.size().y;
        let spread = self.pixel_angle(v.abs().max(least).min(1.0 - least)).sqrt();
        CameraSample { ray: Ray::new(self.position, w), weight: 1.0, spread, width: 0.0 }
    }

    /// Film position of a direction (any length).
    #[inline(never)]
    pub(super) fn film_position(&self, direction: Vec3) -> Option<Vec2> {
        let d = self.frame.to_local(direction).try_normalize()?;
        let f = self.place(d) * self.size();
        // A place of 1 is that of 0 on the sphere.
        let last = |x: f32, size: f32| if x >= size { size - 0.5 * size * f32::EPSILON } else { x };
        let f = Vec2::new(last(f.x, self.size().x), last(f.y, self.size().y));
        self.holds(f).then_some(f)
    }

    #[inline(never)]
    pub(super) fn pdf_we(&self, direction: Vec3) -> WePdf {
        let angle = self.pixel_angle(self.place(self.frame.to_local(direction)).y);
        WePdf::PerSteradian(if angle > 0.0 { 1.0 / f64::from(angle) } else { 0.0 })
    }

    #[inline(never)]
    pub(super) fn sample_wi(&self, p: Vec3) -> Option<WiSample> {
        let film_position = self.film_position(p - self.position)?;
        let d2 = p.distance_squared(self.position);
        let distance = d2.sqrt();
        let importance = 1.0 / (self.pixel_angle(film_position.y / self.size().y) * d2);
        let wi = (self.position - p) / distance;
        let p = self.position;
        importance.is_finite().then_some(WiSample { wi, distance, p, film_position, importance, pdf_w: 1.0 })
    }
}
