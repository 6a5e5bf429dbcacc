use crate::{Affine3A, Bounds3, Vec3};

/// An invertible affine map and its inverse; `render_from_object` by convention.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: Affine3A,
    inverse: Affine3A,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { forward: Affine3A::IDENTITY, inverse: Affine3A::IDENTITY };

    /// `None` where the map is singular or not finite.
    pub fn new(forward: Affine3A) -> Option<Self> {
        let determinant = forward.matrix3.determinant();
        if !forward.is_finite() || determinant == 0.0 {
            return None;
        }
        let inverse = forward.inverse();
        inverse.is_finite().then_some(Self { forward, inverse })
    }

    /// The matrix.
    pub fn matrix(&self) -> &Affine3A {
        &self.forward
    }

    /// The inverse matrix.
    pub fn inverse_matrix(&self) -> &Affine3A {
        &self.inverse
    }

    /// The inverse map.
    pub fn inverse(&self) -> Self {
        Self { forward: self.inverse, inverse: self.forward }
    }

    /// First `first`, then this.
    pub fn after(&self, first: &Self) -> Self {
        Self { forward: self.forward * first.forward, inverse: first.inverse * self.inverse }
    }

    /// A point.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.forward.transform_point3(p)
    }

    /// A vector.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.forward.transform_vector3(v)
    }

    /// A normal, by the inverse transpose; not normalised.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        Vec3::from(self.inverse.matrix3.transpose() * crate::Vec3A::from(n))
    }

    /// Bounds of the image of a box.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        b.transformed(&self.forward)
    }

    /// Whether it turns right hands into left ones.
    pub fn swaps_handedness(&self) -> bool {
        self.forward.matrix3.determinant() < 0.0
    }
}
