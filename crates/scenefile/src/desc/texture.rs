//! Colours, numbers and textures.

use std::path::PathBuf;

use super::Triple;
use crate::source::Sourced;

/// A colour: constant, or looked up in a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorDesc {
    /// Linear RGB.
    Rgb(Triple),
    /// A texture by name.
    Texture(Sourced<String>),
}

impl ColorDesc {
    /// A texture by name.
    pub fn texture(name: impl Into<String>) -> Self {
        Self::Texture(name.into().into())
    }
}

impl From<Triple> for ColorDesc {
    fn from(rgb: Triple) -> Self {
        Self::Rgb(rgb)
    }
}

impl From<f32> for ColorDesc {
    fn from(grey: f32) -> Self {
        Self::Rgb([grey; 3])
    }
}

/// A number: constant, or looked up in a texture (the mean of its channels).
#[derive(Clone, Debug, PartialEq)]
pub enum FloatDesc {
    /// The same everywhere.
    Value(f32),
    /// A texture by name.
    Texture(Sourced<String>),
}

impl FloatDesc {
    /// A texture by name.
    pub fn texture(name: impl Into<String>) -> Self {
        Self::Texture(name.into().into())
    }
}

impl From<f32> for FloatDesc {
    fn from(value: f32) -> Self {
        Self::Value(value)
    }
}

/// How stored texel values become linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Decode the sRGB curve (8-bit colour images); floating-point images are linear all the same.
    #[default]
    Srgb,
    /// Take values as they are (normal maps, roughness).
    Linear,
}

/// What lies outside the unit square of texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Copies.
    #[default]
    Repeat,
    /// The border texels.
    Clamp,
    /// Mirrored copies.
    Mirror,
}

/// How texels are interpolated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFilter {
    /// Between mip levels by footprint.
    #[default]
    Trilinear,
    /// Between four texels.
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// A texture: `[textures.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// A picture file.
    Image {
        /// PNG, JPEG, HDR or EXR; see [`resolve`](super::SceneDesc::resolve).
        file: Sourced<PathBuf>,
        /// How texels become linear.
        color_space: ColorSpace,
        /// What lies outside.
        wrap: Wrap,
        /// Interpolation.
        filter: TextureFilter,
        /// Texture coordinates are multiplied by this: copies per unit of u and v.
        scale: [f32; 2],
        /// Then this is added.
        offset: [f32; 2],
    },
    /// Two colours in alternating squares of side 1/2 in scaled coordinates: one period per unit.
    Checker {
        /// Where the whole parts of 2u and 2v add up to an even number.
        a: ColorDesc,
        /// Elsewhere.
        b: ColorDesc,
        /// Texture coordinates are multiplied by this.
        scale: [f32; 2],
    },
}

impl Texture {
    /// An sRGB picture, repeated, trilinear.
    pub fn image(file: impl Into<PathBuf>) -> Self {
        Self::Image {
            file: file.into().into(),
            color_space: ColorSpace::Srgb,
            wrap: Wrap::Repeat,
            filter: TextureFilter::Trilinear,
            scale: [1.0; 2],
            offset: [0.0; 2],
        }
    }

    /// A checker of two colours.
    pub fn checker(a: impl Into<ColorDesc>, b: impl Into<ColorDesc>, scale: [f32; 2]) -> Self {
        Self::Checker { a: a.into(), b: b.into(), scale }
    }
}
