//! Textures: colours over texture coordinates.
//!
//! `uv` has its origin at the lower left of an image, v up. A footprint is the width in uv units over which the
//! colour is averaged; 0 asks for a point.

mod checker;
mod picture;

use math::{Vec2, Vec3};

pub use checker::Checker;
pub use picture::{Encoding, Filter, ImageTexture, TextureError, Wrap};

/// `uv · scale + offset`, applied before a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvMap {
    /// Factor.
    pub scale: Vec2,
    /// Shift.
    pub offset: Vec2,
}

impl Default for UvMap {
    fn default() -> Self {
        Self { scale: Vec2::ONE, offset: Vec2::ZERO }
    }
}

impl UvMap {
    /// The mapped point.
    #[inline]
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        uv * self.scale + self.offset
    }
}

/// A texture; values are linear RGB.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The same everywhere.
    Constant([f32; 3]),
    /// Squares of two textures.
    Checker(Checker),
    /// A picture.
    Image(ImageTexture),
}

impl Texture {
    /// Linear RGB at `uv`, averaged over a square of width `footprint` (uv units, ≥ 0).
    pub fn evaluate(&self, uv: Vec2, footprint: f32) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => *rgb,
            Self::Checker(t) => t.evaluate(uv, footprint),
            Self::Image(t) => t.evaluate(uv, footprint),
        }
    }

    /// The tangent-space normal 2·rgb − 1 at `uv`, averaged like [`Self::evaluate`] and made of unit length; z > 0
    /// away from the surface. Meant for images of [`Encoding::Linear`]. Where the texture holds no direction: +z.
    pub fn evaluate_normal(&self, uv: Vec2, footprint: f32) -> Vec3 {
        let [x, y, z] = self.evaluate(uv, footprint);
        (2.0 * Vec3::new(x, y, z) - Vec3::ONE).try_normalize().unwrap_or(Vec3::Z)
    }

    /// Mean over one period.
    pub fn mean(&self) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => *rgb,
            Self::Checker(t) => t.mean(),
            Self::Image(t) => t.mean(),
        }
    }
}

#[cfg(test)]
mod tests;
