//! Spheres and disks, intersected in f64: rare enough that robustness costs nothing.

use math::{Bounds3, DVec3, Ray, Vec3};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub center: Vec3,
    pub radius: f32,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Disk {
    pub center: Vec3,
    pub radius: f32,
    /// Of unit length.
    pub normal: DVec3,
}

/// A box made larger by one unit in the last place of its farthest coordinate: computed bounds are rounded.
fn rounded_out(min: Vec3, max: Vec3) -> Bounds3 {
    let pad = min.abs().max(max.abs()) * f32::EPSILON;
    Bounds3 { min: min - pad, max: max + pad }
}

impl Sphere {
    pub fn bounds(&self) -> Bounds3 {
        let r = Vec3::splat(self.radius);
        rounded_out(self.center - r, self.center + r)
    }

    /// The first 0 < t, which the caller compares with its end.
    ///
    /// The discriminant is r² − |f − (f·d/d·d) d|², free of cancellation for small and distant spheres, and the
    /// roots come without subtraction (Haines, Günther & Akenine-Möller 2019, "Precision improvements for
    /// ray/sphere intersection", §7.1). In f64, c = |f|² − r² stays good for origins on a large sphere.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f32> {
        let d = ray.direction.as_dvec3();
        let f = ray.origin.as_dvec3() - self.center.as_dvec3();
        let r = f64::from(self.radius);
        let a = d.length_squared();
        let b = -f.dot(d);
        let discriminant = r * r - (f + d * (b / a)).length_squared();
        if discriminant.is_nan() || discriminant < 0.0 {
            return None;
        }
        let root = (a * discriminant).sqrt();
        let q = if b >= 0.0 { b + root } else { b - root };
        let c = f.length_squared() - r * r;
        let (t0, t1) = (c / q, q / a);
        let (near, far) = if t0 < t1 { (t0 as f32, t1 as f32) } else { (t1 as f32, t0 as f32) };
        let t = if near > 0.0 { near } else { far };
        (t > 0.0).then_some(t)
    }
}

impl Disk {
    pub fn bounds(&self) -> Bounds3 {
        let n = self.normal;
        let reach =
            (DVec3::ONE - n * n).max(DVec3::ZERO).to_array().map(|s| s.sqrt() * f64::from(self.radius));
        let reach = DVec3::from_array(reach).as_vec3() * (1.0 + f32::EPSILON);
        let b = rounded_out(self.center - reach, self.center + reach);
        // The unit normal is rounded too: a little thickness.
        let pad = Vec3::splat(f32::EPSILON * self.radius);
        Bounds3 { min: b.min - pad, max: b.max + pad }
    }

    /// The only 0 < t, which the caller compares with its end; none for rays in the plane.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f32> {
        let d = ray.direction.as_dvec3();
        let f = self.center.as_dvec3() - ray.origin.as_dvec3();
        let t = self.normal.dot(f) / self.normal.dot(d);
        let r = f64::from(self.radius);
        let inside = (d * t - f).length_squared() <= r * r;
        let t = t as f32;
        (inside && t > 0.0).then_some(t)
    }
}
