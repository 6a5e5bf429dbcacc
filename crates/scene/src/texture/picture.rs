use std::path::Path;

use super::decode::{Numbers, Pixels, TextureError};
use super::texels::{Curve, LINEAR, SRGB, Texels, fits_half, to_half};

/// How an image's numbers stand for light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Encoding {
    /// sRGB transfer curve (IEC 61966-2-1) for 8- and 16-bit images; floating-point images are linear.
    #[default]
    Srgb,
    /// Linear: data such as normals or roughness.
    Linear,
}

/// What is kept of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Red, green and blue.
    Color,
    /// Opacity.
    Alpha,
    /// Both.
    Both,
}

/// An image in memory: 1 to 4 channels, each a byte for 8-bit files, 2 bytes for 16-bit ones, 2 for floating-point ones in the
/// range of half floats that are coloured, else 4. One channel stands for three that are equal; opacity is not kept where
/// it is 1 everywhere.
#[derive(Clone, Debug)]
pub struct Picture {
    /// 0 (opacity alone), 1 or 3.
    colors: usize,
    has_alpha: bool,
    curve: &'static Curve,
    levels: Vec<Level>,
    mean: [f32; 4],
}

#[derive(Clone, Debug)]
pub(super) struct Level {
    pub width: usize,
    pub height: usize,
    pub texels: Texels,
}

impl Picture {
    /// Reads a file, full size only.
    ///
    /// # Errors
    /// Where the file cannot be read or is no picture of a known kind, is larger than 65536 texels along a side or 1 GiB, or
    /// holds a value that is not finite.
    pub fn from_path(path: &Path, encoding: Encoding, wanted: Wanted) -> Result<Self, TextureError> {
        let bytes = std::fs::read(path).map_err(|e| TextureError::Unreadable(path.to_owned(), e))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self::from_bytes(&bytes, &name, encoding, wanted)
    }

    /// Decodes the bytes of a file, full size only; `name` tells the format where they do not (TGA).
    ///
    /// # Errors
    /// As [`Self::from_path`].
    pub fn from_bytes(
        bytes: &[u8],
        name: &str,
        encoding: Encoding,
        wanted: Wanted,
    ) -> Result<Self, TextureError> {
        Self::new(Pixels::decode(bytes, name)?, encoding, wanted)
    }

    /// From decoded numbers, full size only.
    ///
    /// # Errors
    /// Where there is no texel, or a value is not finite.
    pub fn new(pixels: Pixels, encoding: Encoding, wanted: Wanted) -> Result<Self, TextureError> {
        let pixels = pixels.kept(wanted)?;
        let (width, height) = (pixels.width, pixels.height);
        let (colors, has_alpha) = match (pixels.channels, wanted) {
            (1, Wanted::Alpha) => (0, true),
            (1, _) => (1, false),
            (2, _) => (1, true),
            (3, _) => (3, false),
            _ => (3, true),
        };
        let mut curve = &*LINEAR;
        let stride = colors + usize::from(has_alpha);
        let is_alpha = |i: usize| has_alpha && i % stride == colors;
        let texels = match pixels.numbers {
            Numbers::Bytes(bytes) => {
                if encoding == Encoding::Srgb {
                    curve = &*SRGB;
                }
                Texels::Bytes(bytes)
            }
            Numbers::Words(words) => match encoding {
                Encoding::Linear => Texels::Words(words),
                Encoding::Srgb => {
                    let linear = |(i, x): (usize, &u16)| {
                        let share = f32::from(*x) / 65535.0;
                        to_half(if is_alpha(i) { share } else { color::srgb_to_linear(share) })
                    };
                    Texels::Halves(words.iter().enumerate().map(linear).collect())
                }
            },
            Numbers::Floats(floats) => {
                if !floats.iter().all(|x| x.is_finite()) {
                    return Err(TextureError::NotFinite);
                }
                // Single channels are data, such as heights, of which more digits may count.
                if colors == 3 && floats.iter().all(|x| fits_half(*x)) {
                    Texels::Halves(floats.iter().map(|x| to_half(*x)).collect())
                } else {
                    Texels::Floats(floats)
                }
            }
        };
        let mut picture =
            Self { colors, has_alpha, curve, levels: vec![Level { width, height, texels }], mean: [0.0; 4] };
        picture.mean = picture.mean_of_all();
        Ok(picture)
    }

    /// A picture of one texel.
    pub fn one(rgb: [f32; 3]) -> Self {
        let texels = Texels::Floats(rgb.to_vec());
        let levels = vec![Level { width: 1, height: 1, texels }];
        let [r, g, b] = rgb;
        Self { colors: 3, has_alpha: false, curve: &LINEAR, levels, mean: [r, g, b, 1.0] }
    }

    fn mean_of_all(&self) -> [f32; 4] {
        let base = &self.levels[0];
        let mut sum = [0f64; 4];
        for i in 0..base.width * base.height {
            let [r, g, b] = self.rgb(base, i);
            sum.iter_mut().zip([r, g, b, self.alpha(base, i)]).for_each(|(s, x)| *s += f64::from(x));
        }
        sum.map(|s| (s / (base.width * base.height) as f64) as f32)
    }

    /// The same with smaller versions of itself, each half the size of the last (rounded down) and the mean, in linear light, of
    /// the texels that it stands for; a third more memory.
    pub fn with_pyramid(mut self) -> Self {
        let (stride, colors) = (self.colors + usize::from(self.has_alpha), self.colors);
        let (has_alpha, curve) = (self.has_alpha, self.curve);
        let curve_of = |i: usize| if has_alpha && i % stride == colors { &*LINEAR } else { curve };
        let (mut w, mut h) = (self.levels[0].width, self.levels[0].height);
        let mut last: Vec<f32> = Vec::new();
        while w > 1 || h > 1 {
            let base = &self.levels[0].texels;
            let (width, height) = ((w / 2).max(1), (h / 2).max(1));
            // Each level is made of the unrounded one before.
            last = if self.levels.len() == 1 {
                halved([w, h], [width, height], stride, |i| base.get(i, curve_of(i)))
            } else {
                halved([w, h], [width, height], stride, |i| last[i])
            };
            let texels = base.like(&last, curve_of);
            self.levels.push(Level { width, height, texels });
            (w, h) = (width, height);
        }
        self
    }

    /// Texels across and down.
    pub fn size(&self) -> [usize; 2] {
        [self.levels[0].width, self.levels[0].height]
    }

    /// Linear RGB of a texel, counted row by row from the top.
    ///
    /// # Panics
    /// Where there is no such texel.
    pub fn pixel(&self, index: usize) -> [f32; 3] {
        self.rgb(&self.levels[0], index)
    }

    /// Bytes held.
    pub fn memory_bytes(&self) -> usize {
        self.levels.iter().map(|level| level.texels.memory_bytes()).sum()
    }

    /// Mean of red, green, blue and opacity.
    pub fn mean(&self) -> [f32; 4] {
        self.mean
    }

    pub(super) fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The bytes of three colours each, and what they stand for, where a level is stored so.
    pub(super) fn plain<'a>(&self, level: &'a Level) -> Option<(&'a [u8], &'static [f32; 256])> {
        match &level.texels {
            Texels::Bytes(bytes) if self.colors == 3 && !self.has_alpha => Some((bytes, &self.curve.values)),
            _ => None,
        }
    }

    #[inline]
    pub(super) fn rgb(&self, level: &Level, index: usize) -> [f32; 3] {
        let i = index * (self.colors + usize::from(self.has_alpha));
        match self.colors {
            3 => std::array::from_fn(|c| level.texels.get(i + c, self.curve)),
            1 => [level.texels.get(i, self.curve); 3],
            _ => [1.0; 3],
        }
    }

    #[inline]
    pub(super) fn alpha(&self, level: &Level, index: usize) -> f32 {
        if self.has_alpha { level.texels.get(index * (self.colors + 1) + self.colors, &LINEAR) } else { 1.0 }
    }

    /// Whether it holds what is wanted.
    pub fn holds(&self, wanted: Wanted) -> bool {
        wanted == Wanted::Alpha || self.colors > 0
    }
}

/// The next level: each texel is the mean of the box of texels that it covers, parts of texels included, so that odd
/// sizes keep the mean too.
fn halved(
    [w, h]: [usize; 2],
    [width, height]: [usize; 2],
    stride: usize,
    value: impl Fn(usize) -> f32,
) -> Vec<f32> {
    let mut out = Vec::with_capacity(width * height * stride);
    let even = w == 2 * width && h == 2 * height;
    for y in 0..height {
        let rows: Vec<(usize, f32)> = cover(y, height, h).collect();
        for x in 0..width {
            if even {
                let i = (2 * y * w + 2 * x) * stride;
                let below = i + w * stride;
                out.extend((0..stride).map(|c| {
                    let pairs = (value(i + c) + value(i + stride + c))
                        + (value(below + c) + value(below + stride + c));
                    0.25 * pairs
                }));
                continue;
            }
            for c in 0..stride {
                let mut sum = 0.0;
                for (j, wy) in &rows {
                    for (i, wx) in cover(x, width, w) {
                        sum += wx * wy * value((j * w + i) * stride + c);
                    }
                }
                out.push(sum);
            }
        }
    }
    out
}

/// Of `n` texels those under texel `i` of `m` ≤ `n`, each with its share (sum 1).
fn cover(i: usize, m: usize, n: usize) -> impl Iterator<Item = (usize, f32)> {
    // In units of 1/m of a texel: the box is [i·n, (i + 1)·n), texel k is [k·m, (k + 1)·m).
    let (begin, end) = (i * n, (i + 1) * n);
    (begin / m..end.div_ceil(m)).map(move |k| {
        let overlap = ((k + 1) * m).min(end) - (k * m).max(begin);
        (k, overlap as f32 / n as f32)
    })
}
