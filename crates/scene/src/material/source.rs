use color::Lanes;

use crate::attributes::Owner;
use crate::texture::TexturePoint;
use crate::{SurfaceInteraction, Texture};

/// A colour that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorSource {
    /// Everywhere the same.
    Constant(Lanes),
    /// Index of a texture.
    Texture(u32),
}

/// A number that may vary over the surface (the mean of a texture's channels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatSource {
    /// Everywhere the same.
    Constant(f32),
    /// Index of a texture.
    Texture(u32),
}

impl ColorSource {
    /// Whether it is the same everywhere.
    pub fn is_constant(self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// Mean over the surface and the channels.
    pub fn mean(self, textures: &[Texture]) -> f32 {
        match self {
            Self::Constant(c) => c.mean(),
            Self::Texture(t) => {
                let [r, g, b] = textures[t as usize].mean(textures);
                (r + g + b) / 3.0
            }
        }
    }
}

impl FloatSource {
    /// Whether it is the same everywhere.
    pub fn is_constant(self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// Mean over the surface.
    pub fn mean(self, textures: &[Texture]) -> f32 {
        match self {
            Self::Constant(x) => x,
            Self::Texture(t) => ColorSource::Texture(t).mean(textures),
        }
    }
}

/// GGX roughness that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RoughnessSource {
    /// α is r²/a along the tangent and r²·a across it, a = √(1 − 0.9·anisotropy) (Burley 2012, §5.4); a negative anisotropy
    /// exchanges the two.
    Perceived {
        /// r.
        roughness: FloatSource,
        /// −1..=1.
        anisotropy: FloatSource,
    },
    /// α itself.
    Alpha {
        /// Along the tangent.
        along: FloatSource,
        /// Across it.
        across: FloatSource,
    },
}

impl RoughnessSource {
    fn parts(self) -> [FloatSource; 2] {
        let (Self::Perceived { roughness: a, anisotropy: b } | Self::Alpha { along: a, across: b }) = self;
        [a, b]
    }

    /// Whether it is the same everywhere.
    pub fn is_constant(self) -> bool {
        self.parts().iter().all(|part| part.is_constant())
    }

    /// Whether the surface is smooth everywhere.
    pub fn is_smooth(self) -> bool {
        let none = FloatSource::Constant(0.0);
        match self {
            Self::Perceived { roughness, .. } => roughness == none,
            Self::Alpha { along, across } => along == none && across == none,
        }
    }

    /// Whether it is the same along the tangent and across it.
    pub fn is_isotropic(self) -> bool {
        match self {
            Self::Perceived { anisotropy, .. } => anisotropy == FloatSource::Constant(0.0),
            Self::Alpha { along, across } => along == across,
        }
    }

    /// α along the tangent and across it, in [0, 1].
    pub(crate) fn alpha(self, at: &Place<'_>) -> [f32; 2] {
        match self {
            Self::Perceived { roughness, anisotropy } => {
                let (r, a) = (at.share(roughness), at.float(anisotropy).clamp(-1.0, 1.0));
                let [x, y] = bsdf::disney_alpha(r, a.abs());
                if a < 0.0 { [y, x] } else { [x, y] }
            }
            Self::Alpha { along, across } => [at.share(along), at.share(across)],
        }
    }
}

/// What evaluating materials needs to look up.
pub(crate) struct Lookup<'a> {
    pub textures: &'a [Texture],
    /// What the points that are looked up are of.
    pub of: Owner<'a>,
    /// Width of the ray's footprint on the surface, in units of length.
    pub footprint: f32,
}

/// A point of a surface to look sources up at; `hit` may be absent where all of them are constant.
pub(crate) struct Place<'a> {
    pub hit: Option<&'a SurfaceInteraction>,
    pub lookup: &'a Lookup<'a>,
}

impl Place<'_> {
    fn texture(&self, texture: u32) -> [f32; 3] {
        match self.hit {
            Some(hit) => {
                let at = TexturePoint::of_hit(hit, self.lookup.footprint, self.lookup.of);
                self.lookup.textures[texture as usize].evaluate(self.lookup.textures, &at)
            }
            None => [0.0; 3],
        }
    }

    /// A reflectance: textures are moved into [0, 1].
    pub fn color(&self, source: ColorSource) -> Lanes {
        match source {
            ColorSource::Constant(c) => c,
            ColorSource::Texture(t) => {
                let [r, g, b] = self.texture(t).map(|x| x.clamp(0.0, 1.0));
                Lanes::rgb(r, g, b)
            }
        }
    }

    /// A factor ≥ 0 on emission.
    pub fn emission(&self, texture: u32) -> Lanes {
        let [r, g, b] = self.texture(texture).map(|x| x.max(0.0));
        Lanes::rgb(r, g, b)
    }

    pub fn float(&self, source: FloatSource) -> f32 {
        match source {
            FloatSource::Constant(x) => x,
            FloatSource::Texture(t) => {
                let [r, g, b] = self.texture(t);
                (r + g + b) / 3.0
            }
        }
    }

    /// A number in [0, 1].
    pub fn share(&self, source: FloatSource) -> f32 {
        self.float(source).clamp(0.0, 1.0)
    }
}
