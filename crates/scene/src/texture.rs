//! Textures: colours over surfaces and in space.
//!
//! Texture coordinates have their origin at the lower left of an image, v up. A footprint is the width of the square over
//! which the colour is averaged; 0 asks for a point.

mod checker;
mod decode;
mod dots;
mod image_texture;
mod mapping;
mod noise;
mod perlin;
mod picture;
mod point;
mod texels;

use math::{Vec2, Vec3};

pub use checker::Checker;
pub use decode::{Pixels, TextureError};
pub use dots::Dots;
pub use image_texture::{Channel, Filter, ImageTexture, Wrap};
pub use mapping::Mapping;
pub use noise::{Noise, NoiseKind};
pub use picture::{Encoding, Picture, Wanted};
pub use point::TexturePoint;

/// A part of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The same everywhere, linear RGB.
    Constant([f32; 3]),
    /// Index of a texture.
    Texture(u32),
}

impl Source {
    /// Linear RGB at a point; black where there is no such texture.
    pub fn evaluate(self, textures: &[Texture], at: &TexturePoint<'_>) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => rgb,
            Self::Texture(id) => textures.get(id as usize).map_or([0.0; 3], |t| t.evaluate(textures, at)),
        }
    }

    /// Mean over the surface.
    pub fn mean(self, textures: &[Texture]) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => rgb,
            Self::Texture(id) => textures.get(id as usize).map_or([0.0; 3], |t| t.mean(textures)),
        }
    }
}

/// A texture; values are linear RGB. Its parts are textures of the same list.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The same everywhere.
    Constant([f32; 3]),
    /// Squares of two textures.
    Checker(Checker),
    /// Round dots of one on another.
    Dots(Dots),
    /// A picture.
    Image(ImageTexture),
    /// The product of two.
    Product(Source, Source),
    /// From the first to the second, by the mean of the third's channels.
    Mix(Source, Source, Source),
    /// Noise in space.
    Noise(Noise),
    /// Colours of vertices, white where there are none.
    VertexColor(Channel),
}

fn mean_of([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) / 3.0
}

fn lerp(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t)
}

/// Step in texture coordinates that shows the slopes of a texture without texels.
const SMALL_STEP: f32 = 5e-4;

impl Texture {
    /// Linear RGB at a point.
    pub fn evaluate(&self, textures: &[Texture], at: &TexturePoint<'_>) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => *rgb,
            Self::Checker(t) => t.evaluate(textures, at),
            Self::Dots(t) => t.evaluate(textures, at),
            Self::Image(t) => t.evaluate(at),
            Self::Product(a, b) => {
                let (a, b) = (a.evaluate(textures, at), b.evaluate(textures, at));
                std::array::from_fn(|c| a[c] * b[c])
            }
            Self::Mix(a, b, amount) => {
                let t = mean_of(amount.evaluate(textures, at));
                // Where it is all of one, the other is not looked up.
                match t {
                    0.0 => a.evaluate(textures, at),
                    1.0 => b.evaluate(textures, at),
                    _ => lerp(a.evaluate(textures, at), b.evaluate(textures, at), t),
                }
            }
            Self::Noise(t) => t.evaluate(at),
            Self::VertexColor(channel) => channel.of(at.color()),
        }
    }

    /// The tangent-space normal 2·rgb − 1 at a point, averaged like [`Self::evaluate`] and made of unit length; z > 0
    /// away from the surface. Meant for images of [`Encoding::Linear`]. Where the texture holds no direction: +z.
    pub fn evaluate_normal(&self, textures: &[Texture], at: &TexturePoint<'_>) -> Vec3 {
        let [x, y, z] = self.evaluate(textures, at);
        (2.0 * Vec3::new(x, y, z) - Vec3::ONE).try_normalize().unwrap_or(Vec3::Z)
    }

    /// Mean over one period; of a product that of the means, which is right where its parts are independent.
    pub fn mean(&self, textures: &[Texture]) -> [f32; 3] {
        match self {
            Self::Constant(rgb) => *rgb,
            Self::Checker(t) => t.mean(textures),
            Self::Dots(t) => t.mean(textures),
            Self::Image(t) => t.mean(),
            Self::Product(a, b) => {
                let (a, b) = (a.mean(textures), b.mean(textures));
                std::array::from_fn(|c| a[c] * b[c])
            }
            Self::Mix(a, b, amount) => {
                lerp(a.mean(textures), b.mean(textures), mean_of(amount.mean(textures)))
            }
            Self::Noise(t) => t.mean(),
            Self::VertexColor(_) => [1.0; 3],
        }
    }

    /// The distance on the surface over which its slopes show: half a texel, the least of its parts; `None` where it has
    /// no slopes or they are not known.
    pub fn grain(&self, textures: &[Texture], at: &TexturePoint<'_>) -> Option<f32> {
        let least = |sources: &[Source]| {
            let grains = sources.iter().filter_map(|source| match source {
                Source::Constant(_) => None,
                Source::Texture(id) => textures.get(*id as usize)?.grain(textures, at),
            });
            grains.reduce(f32::min)
        };
        match self {
            Self::Constant(_) => None,
            Self::Checker(t) => t.map.length(at, Vec2::splat(SMALL_STEP)),
            Self::Dots(t) => t.map.length(at, Vec2::splat(SMALL_STEP)),
            Self::Image(t) => t.map.length(at, t.half_texel()),
            Self::Product(a, b) => least(&[*a, *b]),
            Self::Mix(a, b, amount) => least(&[*a, *b, *amount]),
            Self::Noise(t) => t.grain(),
            Self::VertexColor(_) => at.uv_grain(SMALL_STEP),
        }
    }

    /// The mapping by which its coordinates grow over the surface; `None`: the first texture coordinates as they are.
    pub fn mapping(&self, textures: &[Texture]) -> Option<Mapping> {
        let of = |source: &Source| match source {
            Source::Constant(_) => None,
            Source::Texture(id) => textures.get(*id as usize)?.mapping(textures),
        };
        match self {
            Self::Image(t) => Some(t.map),
            Self::Checker(t) => Some(t.map),
            Self::Dots(t) => Some(t.map),
            Self::Product(a, b) | Self::Mix(a, b, _) => of(a).or_else(|| of(b)),
            Self::Constant(_) | Self::Noise(_) | Self::VertexColor(_) => None,
        }
    }

    /// Whether it is laid out by second texture coordinates itself; its parts may be besides.
    pub fn uses_second_coordinates(&self) -> bool {
        let map = match self {
            Self::Image(t) => t.map,
            Self::Checker(t) => t.map,
            Self::Dots(t) => t.map,
            _ => return false,
        };
        matches!(map, Mapping::Uv { set: 1, .. })
    }

    /// The textures that it is made of.
    pub fn parts(&self) -> impl Iterator<Item = u32> {
        let sources = match self {
            Self::Checker(t) => [Some(t.even), Some(t.odd), None],
            Self::Dots(t) => [Some(t.inside), Some(t.outside), None],
            Self::Product(a, b) => [Some(*a), Some(*b), None],
            Self::Mix(a, b, amount) => [Some(*a), Some(*b), Some(*amount)],
            Self::Constant(_) | Self::Image(_) | Self::Noise(_) | Self::VertexColor(_) => [None; 3],
        };
        sources.into_iter().flatten().filter_map(|source| match source {
            Source::Texture(id) => Some(id),
            Source::Constant(_) => None,
        })
    }
}

#[cfg(test)]
mod tests;
