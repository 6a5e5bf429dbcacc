use crate::Vec3;

/// A ray: points `origin + t·direction`, 0 < t < `t_max`. The direction need not be of unit length (shadow rays
/// between two points are not).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start.
    pub origin: Vec3,
    /// Direction; `t` is measured in its length.
    pub direction: Vec3,
    /// Exclusive end.
    pub t_max: f32,
}

impl Ray {
    /// A ray without end.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_max: f32::INFINITY }
    }

    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Bound of the relative error of `n` rounded `f32` operations (Higham 2002, eq. 3.1): n·u/(1 − n·u), u = 2⁻²⁴.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * (f32::EPSILON * 0.5);
    nu / (1.0 - nu)
}

/// Where a ray that leaves along `w` starts: `p` moved along the normal `n` (either orientation) to the side of `w`,
/// past the cube of half-size `p_error` that is known to hold the true point (Pharr, Jakob & Humphreys 2023, §6.8.6).
///
/// Instead of rounding each coordinate outward, it goes a quarter farther than the cube: more than the rounding of
/// the sum, as long as `p_error` is at least four roundings of the greatest coordinate.
#[inline]
pub fn offset_ray_origin(p: Vec3, p_error: f32, n: Vec3, w: Vec3) -> Vec3 {
    let d = (1.25 * p_error * n.abs().element_sum()).copysign(w.dot(n));
    p + n * d
}
