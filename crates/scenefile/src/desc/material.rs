//! Colours, textures and materials.

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

/// A refractive index.
#[derive(Clone, Debug, PartialEq)]
pub enum Ior {
    /// The index itself, relative to vacuum.
    Value(f32),
    /// A named substance: "water", "glass", "N-BK7", "diamond", …
    Glass(Sourced<String>),
}

impl From<f32> for Ior {
    fn from(ior: f32) -> Self {
        Self::Value(ior)
    }
}

impl From<&str> for Ior {
    fn from(name: &str) -> Self {
        Self::Glass(name.into())
    }
}

/// What a metal is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Metal {
    /// A named metal with measured data: "gold", "copper", …
    Named(Sourced<String>),
    /// The complex index n + ik per RGB channel.
    Index {
        /// Real part, > 0.
        n: Triple,
        /// Imaginary part, ≥ 0.
        k: Triple,
    },
}

impl From<&str> for Metal {
    fn from(name: &str) -> Self {
        Self::Named(name.into())
    }
}

/// How a surface scatters.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo, 0..=1.
        color: ColorDesc,
    },
    /// Diffuse plus the modified Phong lobe of Lafortune & Willems 1994.
    Phong {
        /// Diffuse albedo; its sum with `specular` is at most 1 in each channel.
        diffuse: ColorDesc,
        /// Specular albedo at normal incidence.
        specular: ColorDesc,
        /// Exponent of the cosine lobe, ≥ 0.
        exponent: FloatDesc,
    },
    /// Perfect reflection.
    Mirror {
        /// Reflectance, 0..=1.
        color: ColorDesc,
    },
    /// Smooth glass or liquid: reflects and refracts.
    Dielectric {
        /// Refractive index.
        ior: Ior,
        /// Factor on what is transmitted at each crossing, 0..=1.
        color: ColorDesc,
        /// Where solids overlap the highest counts; among equals the last entered.
        priority: i32,
    },
    /// Metal.
    Conductor {
        /// Its complex index.
        metal: Metal,
        /// GGX α is the square of this; 0 is smooth.
        roughness: FloatDesc,
    },
    /// A diffuse base under a dielectric coat.
    Plastic {
        /// Albedo of the base.
        color: ColorDesc,
        /// Index of the coat.
        ior: Ior,
        /// GGX α of the coat is the square of this; 0 is smooth.
        roughness: FloatDesc,
    },
}

/// A material: `[materials.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub kind: MaterialKind,
    /// A texture of tangent-space normals (OpenGL convention, +y up), by name.
    pub normal_map: Option<Sourced<String>>,
    /// Factor on the map's slopes; 1 as stored.
    pub normal_strength: f32,
    /// Whether the back side scatters as the front does; else the back is black. Dielectrics ignore it.
    pub two_sided: bool,
}

impl From<MaterialKind> for Material {
    fn from(kind: MaterialKind) -> Self {
        Self { kind, normal_map: None, normal_strength: 1.0, two_sided: true }
    }
}

impl Material {
    /// Lambertian.
    pub fn diffuse(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Diffuse { color: color.into() }.into()
    }

    /// Diffuse plus a modified Phong lobe.
    pub fn phong(diffuse: impl Into<ColorDesc>, specular: impl Into<ColorDesc>, exponent: f32) -> Self {
        let (diffuse, specular) = (diffuse.into(), specular.into());
        MaterialKind::Phong { diffuse, specular, exponent: exponent.into() }.into()
    }

    /// A perfect mirror.
    pub fn mirror(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Mirror { color: color.into() }.into()
    }

    /// Clear glass of an index or name.
    pub fn dielectric(ior: impl Into<Ior>) -> Self {
        MaterialKind::Dielectric { ior: ior.into(), color: 1.0.into(), priority: 0 }.into()
    }

    /// A metal by name.
    pub fn conductor(metal: impl Into<Metal>, roughness: f32) -> Self {
        MaterialKind::Conductor { metal: metal.into(), roughness: roughness.into() }.into()
    }

    /// A diffuse base under a coat of index 1.5.
    pub fn plastic(color: impl Into<ColorDesc>, roughness: f32) -> Self {
        MaterialKind::Plastic { color: color.into(), ior: 1.5.into(), roughness: roughness.into() }.into()
    }
}
