use std::path::Path;
use std::sync::Arc;

use math::Vec2;

use super::picture::Level;
use super::{Encoding, Mapping, Picture, TextureError, TexturePoint, Wanted, lerp};

/// What lies beyond the picture's edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The texels at the edge.
    Clamp,
    /// The picture mirrored.
    Mirror,
    /// Nothing: 0.
    Black,
}

/// How texels become a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The texel that holds the point.
    Nearest,
    /// Four texels of the full picture, whatever the footprint.
    Bilinear,
    /// Bilinear in the two levels of the pyramid whose texels bracket the footprint (Williams 1983).
    #[default]
    Trilinear,
}

/// What is used of four channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// One of red, green and blue (0 to 2), for all three.
    One(u8),
    /// Opacity, for all three.
    Alpha,
}

impl Channel {
    pub(super) fn of(self, [r, g, b, a]: [f32; 4]) -> [f32; 3] {
        match self {
            Self::Rgb => [r, g, b],
            Self::One(0) => [r; 3],
            Self::One(1) => [g; 3],
            Self::One(_) => [b; 3],
            Self::Alpha => [a; 3],
        }
    }

    /// What it needs of a picture.
    pub fn wanted(self) -> Wanted {
        if self == Self::Alpha { Wanted::Alpha } else { Wanted::Color }
    }
}

/// A picture on a surface. The picture is shared with other textures of the same file.
#[derive(Clone, Debug)]
pub struct ImageTexture {
    picture: Arc<Picture>,
    /// Behaviour beyond the edges, along u and along v.
    pub wrap: [Wrap; 2],
    /// Interpolation.
    pub filter: Filter,
    /// From the surface to the picture.
    pub map: Mapping,
    /// What is used of it.
    pub channel: Channel,
    /// Whether 1 − x stands for x.
    pub invert: bool,
    /// Factor on the result.
    pub factor: [f32; 3],
}

impl ImageTexture {
    /// A picture as it is.
    pub fn new(picture: Arc<Picture>) -> Self {
        let (wrap, filter, map) = ([Wrap::default(); 2], Filter::default(), Mapping::default());
        Self { picture, wrap, filter, map, channel: Channel::Rgb, invert: false, factor: [1.0; 3] }
    }

    /// Reads and decodes a file; the content tells the format, but for TGA.
    ///
    /// # Errors
    /// As [`Picture::from_path`].
    pub fn from_path(path: &Path, encoding: Encoding) -> Result<Self, TextureError> {
        let picture = Picture::from_path(path, encoding, Wanted::Color)?;
        Ok(Self::new(Arc::new(picture.with_pyramid())))
    }

    /// Decodes a file in memory. Opacity is dropped.
    ///
    /// # Errors
    /// As [`Picture::from_bytes`].
    pub fn from_bytes(bytes: &[u8], encoding: Encoding) -> Result<Self, TextureError> {
        let picture = Picture::from_bytes(bytes, "", encoding, Wanted::Color)?;
        Ok(Self::new(Arc::new(picture.with_pyramid())))
    }

    /// Another picture, with all else as it is.
    pub fn set_picture(&mut self, picture: Arc<Picture>) {
        self.picture = picture;
    }

    /// The picture.
    pub fn picture(&self) -> &Arc<Picture> {
        &self.picture
    }

    /// Bytes of its picture.
    pub fn memory_bytes(&self) -> usize {
        self.picture.memory_bytes()
    }

    pub(super) fn mean(&self) -> [f32; 3] {
        self.finished(self.channel.of(self.picture.mean()))
    }

    /// Half a texel in mapped coordinates.
    pub(super) fn half_texel(&self) -> Vec2 {
        let [w, h] = self.picture.size();
        0.5 / Vec2::new(w as f32, h as f32)
    }

    fn finished(&self, rgb: [f32; 3]) -> [f32; 3] {
        let rgb = if self.invert { rgb.map(|x| 1.0 - x) } else { rgb };
        std::array::from_fn(|c| rgb[c] * self.factor[c])
    }

    pub(super) fn evaluate(&self, at: &TexturePoint<'_>) -> [f32; 3] {
        let (uv, width) = self.map.apply(at);
        let levels = self.picture.levels();
        let rgb = match self.filter {
            Filter::Nearest => self.nearest(&levels[0], uv),
            Filter::Bilinear => self.bilinear(&levels[0], uv),
            Filter::Trilinear => {
                let [w, h] = self.picture.size();
                let texels = width * Vec2::new(w as f32, h as f32);
                // A level's texel is 2^level wide; a footprint of one texel or less reads the full picture.
                let level = texels.max_element().log2().clamp(0.0, (levels.len() - 1) as f32);
                let low = level as usize;
                let t = level - low as f32;
                let a = self.bilinear(&levels[low], uv);
                if t == 0.0 { a } else { lerp(a, self.bilinear(&levels[low + 1], uv), t) }
            }
        };
        self.finished(rgb)
    }

    fn nearest(&self, level: &Level, uv: Vec2) -> [f32; 3] {
        let (w, h) = (level.width, level.height);
        let x = self.wrap[0].index((uv.x * w as f32).floor() as i64, w);
        let y = self.wrap[1].index(((1.0 - uv.y) * h as f32).floor() as i64, h);
        match (x, y) {
            (Some(x), Some(y)) => self.texel(level, y * w + x),
            _ => [0.0; 3],
        }
    }

    fn texel(&self, level: &Level, index: usize) -> [f32; 3] {
        match self.channel {
            Channel::Rgb => self.picture.rgb(level, index),
            Channel::One(c) => [self.picture.rgb(level, index)[usize::from(c.min(2))]; 3],
            Channel::Alpha => [self.picture.alpha(level, index); 3],
        }
    }

    fn bilinear(&self, level: &Level, uv: Vec2) -> [f32; 3] {
        match (self.picture.plain(level), self.channel) {
            // Most pictures by far.
            (Some((bytes, values)), Channel::Rgb) => self.between(level, uv, |i| {
                let texel = &bytes[3 * i..3 * i + 3];
                [values[usize::from(texel[0])], values[usize::from(texel[1])], values[usize::from(texel[2])]]
            }),
            _ => self.between(level, uv, |i| self.texel(level, i)),
        }
    }

    /// Between the four texels whose centres are nearest.
    #[inline]
    fn between(&self, level: &Level, uv: Vec2, texel: impl Fn(usize) -> [f32; 3]) -> [f32; 3] {
        let (w, h) = (level.width, level.height);
        let (x, y) = (uv.x * w as f32 - 0.5, (1.0 - uv.y) * h as f32 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (i, j) = (x0 as i64, y0 as i64);
        let columns = [self.wrap[0].index(i, w), self.wrap[0].index(i.saturating_add(1), w)];
        let rows = [self.wrap[1].index(j, h), self.wrap[1].index(j.saturating_add(1), h)];
        let at = |i: Option<usize>, j: Option<usize>| match (i, j) {
            (Some(i), Some(j)) => texel(j * w + i),
            _ => [0.0; 3],
        };
        let row = |j: Option<usize>| lerp(at(columns[0], j), at(columns[1], j), x - x0);
        lerp(row(rows[0]), row(rows[1]), y - y0)
    }
}

impl Wrap {
    /// The texel that stands at place `i` of `n`; `None`: nothing does.
    #[inline]
    fn index(self, i: i64, n: usize) -> Option<usize> {
        if (0..n as i64).contains(&i) {
            return Some(i as usize);
        }
        let n = n as i64;
        let i = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let k = i.rem_euclid(2 * n);
                if k < n { k } else { 2 * n - 1 - k }
            }
            Self::Black => return None,
        };
        Some(i as usize)
    }
}
