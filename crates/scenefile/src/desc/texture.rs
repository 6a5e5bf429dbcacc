//! Colours, numbers and textures.

use std::path::PathBuf;
use std::sync::Arc;

use super::{TransformSteps, Triple};
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
    /// The name of the texture, if it is one.
    pub fn named(&self) -> Option<&Sourced<String>> {
        match self {
            Self::Texture(name) => Some(name),
            Self::Rgb(_) => None,
        }
    }

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
    /// The name of the texture, if it is one.
    pub fn named(&self) -> Option<&Sourced<String>> {
        match self {
            Self::Texture(name) => Some(name),
            Self::Value(_) => None,
        }
    }

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
    /// Nothing: black.
    Black,
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

/// Which of an image's or vertex colour's channels are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Red, for all three.
    Red,
    /// Green, for all three.
    Green,
    /// Blue, for all three.
    Blue,
    /// Alpha, for all three; 1 where there is none. Never decoded as colour.
    Alpha,
}

/// Where a picture comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageSource {
    /// PNG, JPEG, TIFF, WebP, HDR or EXR; see [`resolve`](super::SceneDesc::resolve).
    File(Sourced<PathBuf>),
    /// The bytes of such a file, from within a scene file of another format.
    Embedded(EmbeddedImage),
}

impl From<PathBuf> for ImageSource {
    fn from(path: PathBuf) -> Self {
        Self::File(path.into())
    }
}

impl From<&str> for ImageSource {
    fn from(path: &str) -> Self {
        PathBuf::from(path).into()
    }
}

impl ImageSource {
    /// The file, if it is one.
    pub fn file(&self) -> Option<&Sourced<PathBuf>> {
        match self {
            Self::File(file) => Some(file),
            Self::Embedded(_) => None,
        }
    }

    /// How it is called in messages and scene files: the file's name as written, or that of the bytes.
    pub fn written(&self) -> std::borrow::Cow<'_, str> {
        match self {
            Self::File(file) => file.to_string_lossy(),
            Self::Embedded(image) => image.name.as_str().into(),
        }
    }
}

/// A picture file in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct EmbeddedImage {
    /// A file name that no other bytes of the description have.
    pub name: String,
    /// What would be in the file; shared.
    pub bytes: Arc<[u8]>,
}

/// Where on a texture a point of a surface lies.
#[derive(Clone, Debug, PartialEq)]
pub enum Mapping {
    /// By texture coordinates: scaled, then turned, then moved.
    Uv {
        /// Which of the mesh's sets of coordinates: 0 or 1.
        set: u8,
        /// Factors on u and v: copies per unit.
        scale: [f32; 2],
        /// Then turned about (0, 0) from u toward v, in degrees.
        rotation: f32,
        /// Then this is added.
        offset: [f32; 2],
    },
    /// By the place in the world: u = p·`u` + `offset[0]`, and so v.
    Planar {
        /// Gradient of u, 1 / scene unit.
        u: Triple,
        /// Gradient of v.
        v: Triple,
        /// Of u and v.
        offset: [f32; 2],
    },
}

impl Default for Mapping {
    /// The first texture coordinates themselves.
    fn default() -> Self {
        Self::scaled([1.0; 2])
    }
}

impl Mapping {
    /// Copies per unit of the first texture coordinates.
    pub fn scaled(scale: [f32; 2]) -> Self {
        Self::Uv { set: 0, scale, rotation: 0.0, offset: [0.0; 2] }
    }
}

/// A picture over a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// The picture.
    pub source: ImageSource,
    /// How texels become linear.
    pub color_space: ColorSpace,
    /// What lies outside, along u and along v.
    pub wrap: [Wrap; 2],
    /// Interpolation.
    pub filter: TextureFilter,
    /// Where the picture lies.
    pub mapping: Mapping,
    /// What is used of it.
    pub channel: Channel,
    /// Whether 1 − x stands for each linear value x, before `factor`.
    pub invert: bool,
    /// Factor on the linear values.
    pub factor: Triple,
}

impl Image {
    /// An sRGB picture, repeated, trilinear.
    pub fn new(source: impl Into<ImageSource>) -> Self {
        Self {
            source: source.into(),
            color_space: ColorSpace::Srgb,
            wrap: [Wrap::Repeat; 2],
            filter: TextureFilter::Trilinear,
            mapping: Mapping::default(),
            channel: Channel::Rgb,
            invert: false,
            factor: [1.0; 3],
        }
    }
}

/// Kinds of noise in space, made of Perlin's gradient noise (Perlin 1985, 2002).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKind {
    /// Fractional Brownian motion: a sum of octaves, about 0.
    Fbm,
    /// The same of absolute values (turbulence).
    Wrinkled,
    /// Waves on water in changing wind, about 0.
    Windy,
    /// A ramp of marble's colours along y, shaken by fBm.
    Marble {
        /// Factor on the place.
        scale: f32,
        /// Strength of the shaking.
        variation: f32,
    },
}

/// Noise in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Its kind.
    pub kind: NoiseKind,
    /// Octaves, 1..=32; windy has its own.
    pub octaves: u32,
    /// Factor on the amplitude from one octave to the next, 0..=1.
    pub roughness: f32,
    /// Places the texture in the world; noise varies over about one unit of its own space.
    pub transform: TransformSteps,
}

/// A texture: `[textures.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// A picture.
    Image(Image),
    /// Two colours in alternating squares of side 1/2 in mapped coordinates: one period per unit.
    Checker {
        /// Where the whole parts of 2u and 2v add up to an even number.
        a: ColorDesc,
        /// Elsewhere.
        b: ColorDesc,
        /// Mapping of the coordinates.
        mapping: Mapping,
    },
    /// Round dots scattered over the plane, at most one in a unit square of mapped coordinates.
    Dots {
        /// In a dot.
        inside: ColorDesc,
        /// Elsewhere.
        outside: ColorDesc,
        /// Mapping of the coordinates.
        mapping: Mapping,
    },
    /// The product of two.
    Product {
        /// The one.
        a: ColorDesc,
        /// The other.
        b: ColorDesc,
    },
    /// Linear interpolation of two.
    Mix {
        /// Where `amount` is 0.
        a: ColorDesc,
        /// Where it is 1.
        b: ColorDesc,
        /// Share of `b`.
        amount: FloatDesc,
    },
    /// Noise in space.
    Noise(Noise),
    /// The colours of the mesh's vertices, linear, interpolated; white where it has none.
    VertexColor {
        /// What is used of them.
        channel: Channel,
    },
}

impl Texture {
    /// An sRGB picture, repeated, trilinear.
    pub fn image(file: impl Into<PathBuf>) -> Self {
        Self::Image(Image::new(file.into()))
    }

    /// A checker of two colours.
    pub fn checker(a: impl Into<ColorDesc>, b: impl Into<ColorDesc>, scale: [f32; 2]) -> Self {
        Self::Checker { a: a.into(), b: b.into(), mapping: Mapping::scaled(scale) }
    }

    /// The names of the textures that it is made of.
    pub fn parts(&self) -> Vec<&Sourced<String>> {
        match self {
            Self::Image(_) | Self::Noise(_) | Self::VertexColor { .. } => Vec::new(),
            Self::Checker { a, b, .. }
            | Self::Dots { inside: a, outside: b, .. }
            | Self::Product { a, b } => [a, b].into_iter().filter_map(ColorDesc::named).collect(),
            Self::Mix { a, b, amount } => {
                [a, b].into_iter().filter_map(ColorDesc::named).chain(amount.named()).collect()
            }
        }
    }
}
