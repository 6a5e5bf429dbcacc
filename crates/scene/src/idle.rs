use math::{Ray, offset_ray_origin};

use crate::light::LeSample;
use crate::{LightId, Scene};

/// Samples along each side of a grid over a light's points, and over its directions.
const SIDE: u32 = 4;

impl Scene {
    /// Whether everything there is, the camera too, lies behind a light: behind the plane of each of its points. Exact for flat lamps where
    /// the bounds of the scene are; lights that shine to all sides, and those at infinity, are never turned away.
    pub fn is_turned_away(&self, id: LightId) -> bool {
        let bounds = self.bounds();
        let slack = 1e-4 * bounds.size().length();
        let eye = [self.camera().position()];
        let behind = |le: LeSample| {
            bounds.corners().into_iter().chain(eye).all(|point| (point - le.p).dot(le.n) <= slack)
        };
        !self.light(id).is_infinite() && !self.light(id).is_delta() && self.emission(id).all(behind)
    }

    /// Whether no ray of some 256 that leave a light meets a surface; false for lights at infinity.
    pub fn meets_nothing(&self, id: LightId) -> bool {
        let misses = |le: LeSample| {
            let origin = offset_ray_origin(le.p, le.p_error, le.n, le.w);
            self.intersect(&Ray::new(origin, le.w)).is_none()
        };
        !self.light(id).is_infinite() && self.emission(id).all(misses)
    }

    /// Emission from the middles of a grid's cells: positions and directions.
    fn emission(&self, id: LightId) -> impl Iterator<Item = LeSample> {
        let cells = SIDE.pow(4);
        let at = |k: u32| (k as f32 + 0.5) / SIDE as f32;
        (0..cells).filter_map(move |i| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|digit| at(i / SIDE.pow(digit) % SIDE));
            self.sample_le(id, (i as f32 + 0.5) / cells as f32, [a, b], [c, d])
        })
    }
}
