use crate::Vec3;

/// An orthonormal basis; local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x (along ∂p/∂u where that is known).
    pub x: Vec3,
    /// Local y.
    pub y: Vec3,
    /// Local z: the normal.
    pub z: Vec3,
}

impl Frame {
    /// A basis about the unit vector `z` (Duff et al. 2017, "Building an orthonormal basis, revisited").
    #[inline]
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// A basis about the unit vector `z` whose x is `x` made orthogonal to it; any basis about `z` where `x` is
    /// parallel to it, zero or not finite.
    pub fn from_zx(z: Vec3, x: Vec3) -> Self {
        let t = x - z * z.dot(x);
        let len2 = t.length_squared();
        if len2 <= 1e-12 * x.length_squared() || !len2.is_finite() {
            return Self::from_z(z);
        }
        let x = t / len2.sqrt();
        Self { x, y: z.cross(x), z }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for z in [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::new(0.6, 0.0, -0.8), Vec3::new(-0.36, 0.48, 0.8)] {
            for f in [Frame::from_z(z), Frame::from_zx(z, Vec3::new(1.0, 2.0, 3.0)), Frame::from_zx(z, z)] {
                assert!((f.x.cross(f.y) - f.z).length() < 1e-6, "{f:?}");
                assert!(f.x.dot(f.y).abs() < 1e-6 && (f.x.length() - 1.0).abs() < 1e-6, "{f:?}");
                let v = Vec3::new(0.3, -0.5, 0.7);
                assert!((f.to_world(f.to_local(v)) - v).length() < 1e-6);
            }
        }
    }
}
