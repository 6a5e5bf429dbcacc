use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use image::{DynamicImage, ImageReader};
use math::Vec2;

use super::UvMap;

/// How an image's numbers stand for light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// sRGB transfer curve (IEC 61966-2-1) for 8- and 16-bit images; floating-point images are linear.
    #[default]
    Srgb,
    /// Linear: data such as normals or roughness.
    Linear,
}

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
}

/// How texels become a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The texel that holds the point.
    Nearest,
    /// Four texels of the full picture, whatever the footprint.
    Bilinear,
    /// Bilinear in the two levels of the pyramid whose texels bracket the footprint.
    #[default]
    Trilinear,
}

/// Why an image is no texture.
#[derive(Debug)]
pub enum TextureError {
    /// The file could not be read.
    Unreadable(PathBuf, std::io::Error),
    /// The bytes are no PNG, JPEG or Radiance HDR, or a broken one.
    Undecodable(image::ImageError),
    /// The picture has no texel.
    Empty,
    /// A value is NaN or infinite.
    NotFinite,
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(path, error) => write!(f, "cannot read {}: {error}", path.display()),
            Self::Undecodable(error) => write!(f, "cannot decode the image: {error}"),
            Self::Empty => f.write_str("the image has no pixel"),
            Self::NotFinite => f.write_str("the image holds a value that is not finite"),
        }
    }
}

impl std::error::Error for TextureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Unreadable(_, error) => Some(error),
            Self::Undecodable(error) => Some(error),
            Self::Empty | Self::NotFinite => None,
        }
    }
}

/// A picture with its pyramid. Full size is stored as 3 bytes a texel for 8-bit sources and 12 for others; the
/// smaller levels add a third as many texels of 12 bytes.
#[derive(Clone, Debug)]
pub struct ImageTexture {
    width: usize,
    height: usize,
    base: Base,
    /// Levels 1.., each half the size of the last (rounded down), box-filtered in linear light.
    levels: Vec<Level>,
    mean: [f32; 3],
    /// Behaviour beyond the edges.
    pub wrap: Wrap,
    /// Interpolation.
    pub filter: Filter,
    /// Mapping of texture coordinates.
    pub map: UvMap,
}

#[derive(Clone, Debug)]
enum Base {
    Bytes(Vec<[u8; 3]>, &'static [f32; 256]),
    Floats(Vec<[f32; 3]>),
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
}

static SRGB: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear(i as f64 / 255.0)));
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| (i as f64 / 255.0) as f32));

fn srgb_to_linear(x: f64) -> f32 {
    (if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32
}

impl ImageTexture {
    /// Reads and decodes a PNG, JPEG or Radiance HDR file; the content tells which.
    pub fn from_path(path: &Path, encoding: Encoding) -> Result<Self, TextureError> {
        let bytes = std::fs::read(path).map_err(|e| TextureError::Unreadable(path.to_owned(), e))?;
        Self::from_bytes(&bytes, encoding)
    }

    /// Decodes a PNG, JPEG or Radiance HDR file in memory. Alpha is dropped.
    pub fn from_bytes(bytes: &[u8], encoding: Encoding) -> Result<Self, TextureError> {
        let reader = ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format();
        let decoded = reader.map_err(image::ImageError::IoError).and_then(ImageReader::decode);
        Self::from_image(decoded.map_err(TextureError::Undecodable)?, encoding)
    }

    /// From a decoded image.
    pub fn from_image(image: DynamicImage, encoding: Encoding) -> Result<Self, TextureError> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let base = match &image {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
                Base::Floats(image.to_rgb32f().pixels().map(|p| p.0).collect())
            }
            DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_) => {
                let decode = |x: u16| match encoding {
                    Encoding::Srgb => srgb_to_linear(f64::from(x) / 65535.0),
                    Encoding::Linear => (f64::from(x) / 65535.0) as f32,
                };
                Base::Floats(image.to_rgb16().pixels().map(|p| p.0.map(decode)).collect())
            }
            _ => {
                let table = match encoding {
                    Encoding::Srgb => &*SRGB,
                    Encoding::Linear => &*LINEAR,
                };
                Base::Bytes(image.to_rgb8().pixels().map(|p| p.0).collect(), table)
            }
        };
        Self::with_base(width, height, base)
    }

    /// From linear RGB, row by row from the top. `TextureError::Empty` also where the counts disagree.
    pub fn from_linear(width: usize, height: usize, texels: Vec<[f32; 3]>) -> Result<Self, TextureError> {
        let fits = width.checked_mul(height) == Some(texels.len());
        if fits { Self::with_base(width, height, Base::Floats(texels)) } else { Err(TextureError::Empty) }
    }

    fn with_base(width: usize, height: usize, base: Base) -> Result<Self, TextureError> {
        if width == 0 || height == 0 {
            return Err(TextureError::Empty);
        }
        let mut levels: Vec<Level> = Vec::new();
        let mut mean = [0f64; 3];
        for y in 0..height {
            for x in 0..width {
                let texel = base.texel(y * width + x);
                mean.iter_mut().zip(texel).for_each(|(m, t)| *m += f64::from(t));
            }
        }
        let count = (width * height) as f64;
        let mean = mean.map(|m| (m / count) as f32);
        if !mean.iter().all(|m| m.is_finite()) {
            return Err(TextureError::NotFinite);
        }
        let (mut w, mut h) = (width, height);
        while w > 1 || h > 1 {
            let next = match levels.last() {
                None => halved(w, h, |i| base.texel(i)),
                Some(level) => halved(w, h, |i| level.texels[i]),
            };
            (w, h) = (next.width, next.height);
            levels.push(next);
        }
        let (wrap, filter, map) = (Wrap::default(), Filter::default(), UvMap::default());
        Ok(Self { width, height, base, levels, mean, wrap, filter, map })
    }

    /// Texels across and down.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Linear RGB of a pixel, counted row by row from the top.
    ///
    /// # Panics
    /// Where there is no such pixel.
    pub(crate) fn pixel(&self, index: usize) -> [f32; 3] {
        self.base.texel(index)
    }

    /// Bytes held.
    pub fn memory_bytes(&self) -> usize {
        let base = match &self.base {
            Base::Bytes(texels, _) => texels.len() * 3,
            Base::Floats(texels) => texels.len() * 12,
        };
        base + self.levels.iter().map(|l| l.texels.len() * 12).sum::<usize>()
    }

    pub(super) fn mean(&self) -> [f32; 3] {
        self.mean
    }

    pub(super) fn evaluate(&self, uv: Vec2, footprint: f32) -> [f32; 3] {
        let uv = self.map.apply(uv);
        match self.filter {
            Filter::Nearest => {
                let (w, h) = (self.width as f32, self.height as f32);
                self.texel(0, (uv.x * w).floor() as i64, ((1.0 - uv.y) * h).floor() as i64)
            }
            Filter::Bilinear => self.bilinear(0, uv),
            Filter::Trilinear => {
                let texels =
                    self.map.scale.abs() * footprint * Vec2::new(self.width as f32, self.height as f32);
                // A level's texel is 2^level wide; a footprint of one texel or less reads the full picture.
                let level = texels.max_element().log2().clamp(0.0, self.levels.len() as f32);
                let low = level as usize;
                let t = level - low as f32;
                let a = self.bilinear(low, uv);
                if t == 0.0 { a } else { lerp(a, self.bilinear(low + 1, uv), t) }
            }
        }
    }

    fn bilinear(&self, level: usize, uv: Vec2) -> [f32; 3] {
        let [w, h] = self.level_size(level);
        let (x, y) = (uv.x * w as f32 - 0.5, (1.0 - uv.y) * h as f32 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (i, j) = (x0 as i64, y0 as i64);
        let row = |j: i64| lerp(self.texel(level, i, j), self.texel(level, i.saturating_add(1), j), x - x0);
        lerp(row(j), row(j.saturating_add(1)), y - y0)
    }

    fn level_size(&self, level: usize) -> [usize; 2] {
        match level {
            0 => [self.width, self.height],
            _ => [self.levels[level - 1].width, self.levels[level - 1].height],
        }
    }

    fn texel(&self, level: usize, x: i64, y: i64) -> [f32; 3] {
        let [w, h] = self.level_size(level);
        let index = self.wrap.index(y, h) * w + self.wrap.index(x, w);
        match level {
            0 => self.base.texel(index),
            _ => self.levels[level - 1].texels[index],
        }
    }
}

impl Wrap {
    fn index(self, i: i64, n: usize) -> usize {
        let n = n as i64;
        let i = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let k = i.rem_euclid(2 * n);
                if k < n { k } else { 2 * n - 1 - k }
            }
        };
        i as usize
    }
}

impl Base {
    fn texel(&self, index: usize) -> [f32; 3] {
        match self {
            Self::Bytes(texels, table) => texels[index].map(|b| table[usize::from(b)]),
            Self::Floats(texels) => texels[index],
        }
    }
}

fn lerp(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t)
}

/// The next level: each texel is the mean of the box of texels that it covers, parts of texels included, so that
/// odd sizes keep the mean too.
fn halved(w: usize, h: usize, texel: impl Fn(usize) -> [f32; 3]) -> Level {
    let (width, height) = ((w / 2).max(1), (h / 2).max(1));
    let mut texels = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0f64; 3];
            for (j, wy) in cover(y, height, h) {
                for (i, wx) in cover(x, width, w) {
                    let t = texel(j * w + i);
                    sum.iter_mut().zip(t).for_each(|(s, t)| *s += wx * wy * f64::from(t));
                }
            }
            texels.push(sum.map(|s| s as f32));
        }
    }
    Level { width, height, texels }
}

/// Of `n` texels those under texel `i` of `m` ≤ `n`, each with its share (sum 1).
fn cover(i: usize, m: usize, n: usize) -> impl Iterator<Item = (usize, f64)> {
    // In units of 1/m of a texel: the box is [i·n, (i + 1)·n), texel k is [k·m, (k + 1)·m).
    let (begin, end) = (i * n, (i + 1) * n);
    (begin / m..end.div_ceil(m)).map(move |k| {
        let overlap = ((k + 1) * m).min(end) - (k * m).max(begin);
        (k, overlap as f64 / n as f64)
    })
}
