//! Films as bytes: all sums, exactly.

use std::io::{Read, Write};
use std::ops::Range;

use crate::fixed::Fixed96;
use crate::named::NamedLayers;
use crate::section::{Numbers, SectionError, SectionReader, SectionWriter};
use crate::sums::{Sums, Unweighted};
use crate::{Film, FilmNonFinite, Layer, NonFinite, PassFilm};

/// Pixels of a section: with all that a film may hold for them, they fit into a second-level cache.
const CHUNK: usize = 1024;
/// Most pixels and named layers of a film that is read.
const MOST_PIXELS: u64 = 1 << 30;
const MOST_LAYERS: u32 = 1024;
/// Words of [`Sums`], of [`Unweighted`], and of one named layer.
const SUMS: usize = 47;
const UNWEIGHTED: usize = 30;
const NAMED: usize = 9;

/// What a file says of its film before the pixels come.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmHead {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// As [`Film::pass_ranges`].
    pub passes: Vec<Range<u64>>,
    /// As [`Film::layer_names`].
    pub layers: Vec<String>,
    /// As [`Film::nonfinite_count`].
    pub nonfinite_count: u64,
    nonfinite: Vec<FilmNonFinite>,
    max_weight: f32,
    weighted: bool,
}

impl Film {
    /// Writes the film: a section with its head, then one for each 1024 pixels, whose bytes are sorted by place (first
    /// bytes of all, second bytes of all, …), which compresses well since many are 0.
    ///
    /// # Errors
    /// Where `out` refuses.
    pub fn write<W: Write>(&self, out: &mut SectionWriter<W>) -> std::io::Result<()> {
        out.write(*b"FILM", &self.head().to_bytes())?;
        let (mut words, mut bytes) = (Vec::new(), Vec::new());
        let count = self.width() * self.height();
        for start in (0..count).step_by(CHUNK) {
            let end = (start + CHUNK).min(count);
            words.clear();
            (start..end).for_each(|i| self.words(i, &mut words));
            transpose(&words, end - start, &mut bytes);
            out.write(*b"PIXL", &bytes)?;
        }
        Ok(())
    }

    /// Reads what [`write`](Self::write) wrote.
    ///
    /// # Errors
    /// Where the file cannot be read, ends, or is damaged.
    pub fn read<R: Read>(input: &mut SectionReader<R>) -> Result<Self, SectionError> {
        FilmHead::read(input)?.read_pixels(input)
    }

    fn head(&self) -> FilmHead {
        FilmHead {
            width: self.width(),
            height: self.height(),
            passes: self.pass_ranges().to_vec(),
            layers: self.layer_names().to_vec(),
            nonfinite_count: self.nonfinite_count(),
            nonfinite: self.nonfinite().to_vec(),
            max_weight: self.max_weight(),
            weighted: !self.unweighted().is_empty(),
        }
    }

    /// Appends all that the film holds for a pixel.
    fn words(&self, i: usize, out: &mut Vec<u32>) {
        let sums = &self.sums()[i];
        let square = sums.square as u128;
        out.extend([0, 32, 64, 96].map(|shift| (square >> shift) as u32));
        for sum in sums.albedo.iter().chain(&sums.normal) {
            out.extend([*sum as u32, (*sum >> 32) as u32]);
        }
        out.extend(sums.radiance.as_flattened().iter().flat_map(|s| s.words()));
        out.extend(sums.photon_density.words());
        out.push(sums.depth.to_bits());
        if let Some(plain) = self.unweighted().get(i) {
            out.extend(plain.radiance.as_flattened().iter().flat_map(|s| s.words()));
            out.extend(plain.weight.words());
        }
        for layer in 0..self.layer_names().len() {
            let (sums, plain) = self.layer_sums(layer).unwrap_or_default();
            let both = [sums.get(i), plain.get(i)];
            out.extend(both.into_iter().flatten().flatten().flat_map(|s| s.words()));
        }
    }
}

impl FilmHead {
    /// Reads the head, after which [`read_pixels`](Self::read_pixels) goes on.
    ///
    /// # Errors
    /// Where the file cannot be read, ends, or is damaged.
    pub fn read<R: Read>(input: &mut SectionReader<R>) -> Result<Self, SectionError> {
        Self::from_bytes(&input.read(*b"FILM")?)
    }

    /// Reads the sums of all pixels.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_pixels<R: Read>(self, input: &mut SectionReader<R>) -> Result<Film, SectionError> {
        let count = self.width * self.height;
        let planes = if self.weighted { 2 } else { 1 };
        let words = SUMS + (planes - 1) * UNWEIGHTED + planes * NAMED * self.layers.len();
        let (mut pixels, mut unweighted) = (Vec::new(), Vec::new());
        let mut named = vec![[Vec::new(), Vec::new()]; self.layers.len()];
        let mut record = vec![0; words];
        for start in (0..count).step_by(CHUNK) {
            let n = (count - start).min(CHUNK);
            let bytes = input.read(*b"PIXL")?;
            if bytes.len() != n * words * 4 {
                return Err(SectionError::Damaged("a part has another size"));
            }
            for i in 0..n {
                for (w, word) in record.iter_mut().enumerate() {
                    *word = u32::from_le_bytes(std::array::from_fn(|b| bytes[(4 * w + b) * n + i]));
                }
                let mut words = Words(&record);
                pixels.push(words.sums(self.count())?);
                if self.weighted {
                    unweighted.push(Unweighted { radiance: words.radiance(), weight: words.fixed() });
                }
                for layer in &mut named {
                    layer[..planes].iter_mut().for_each(|sums| sums.push(words.colour()));
                }
            }
        }
        let flat = |which: usize| named.iter().flat_map(|layer| &layer[which]).copied().collect();
        let layers = NamedLayers::from_parts(self.layers, flat(0), flat(1));
        Ok(Film::from_parts(
            [self.width, self.height],
            self.passes,
            (pixels, unweighted, self.max_weight),
            (self.nonfinite, self.nonfinite_count),
            layers,
        ))
    }

    /// Number of passes.
    pub fn count(&self) -> u64 {
        self.passes.iter().map(|r| r.end - r.start).sum()
    }

    fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        let mut number = |n: u64| out.extend(n.to_le_bytes());
        number(self.width as u64);
        number(self.height as u64);
        number(self.passes.len() as u64);
        self.passes.iter().flat_map(|r| [r.start, r.end]).for_each(&mut number);
        number(self.nonfinite_count);
        number(self.nonfinite.len() as u64);
        for n in &self.nonfinite {
            out.extend(n.pass.to_le_bytes());
            out.extend(n.at.pixel.to_le_bytes());
            out.push(Layer::ALL.iter().position(|l| *l == n.at.layer).unwrap_or_default() as u8);
        }
        out.extend(self.max_weight.to_le_bytes());
        out.push(self.weighted.into());
        out.extend((self.layers.len() as u32).to_le_bytes());
        for name in &self.layers {
            out.push(name.len() as u8);
            out.extend(name.as_bytes());
        }
        out
    }

    fn from_bytes(bytes: &[u8]) -> Result<Self, SectionError> {
        let wrong = || SectionError::Damaged("its head makes no sense");
        let mut numbers = Numbers(bytes);
        let (width, height) = (numbers.u64()?, numbers.u64()?);
        if width.checked_mul(height).is_none_or(|n| n > MOST_PIXELS) {
            return Err(wrong());
        }
        let mut passes: Vec<Range<u64>> = Vec::new();
        for _ in 0..numbers.u64()? {
            let range = numbers.u64()?..numbers.u64()?;
            if range.is_empty() || passes.last().is_some_and(|last| last.end >= range.start) {
                return Err(wrong());
            }
            passes.push(range);
        }
        let nonfinite_count = numbers.u64()?;
        let mut nonfinite = Vec::new();
        for _ in 0..numbers.u64()? {
            let (pass, pixel, layer) = (numbers.u64()?, numbers.u32()?, numbers.u8()?);
            let layer = *Layer::ALL.get(usize::from(layer)).ok_or_else(wrong)?;
            nonfinite.push(FilmNonFinite { pass, at: NonFinite { pixel, layer } });
        }
        let max_weight = f32::from_bits(numbers.u32()?);
        let weighted = numbers.u8()?;
        let count = numbers.u32()?;
        if count > MOST_LAYERS || weighted > 1 || !max_weight.is_finite() {
            return Err(wrong());
        }
        let name = |n: &mut Numbers<'_>| n.u8().and_then(|length| n.text(length.into()));
        let layers = (0..count).map(|_| name(&mut numbers)).collect::<Result<Vec<_>, _>>()?;
        let head = Self {
            width: width as usize,
            height: height as usize,
            passes,
            layers,
            nonfinite_count,
            nonfinite,
            max_weight,
            weighted: weighted == 1,
        };
        let good = numbers.0.is_empty()
            && head.nonfinite.len() <= PassFilm::NONFINITE_LISTED
            && NamedLayers::check(&head.layers).is_ok()
            && head.count() <= Film::MAX_PASSES;
        if good { Ok(head) } else { Err(wrong()) }
    }
}

/// Sorts the bytes of `count` records by their place in a record.
fn transpose(words: &[u32], count: usize, out: &mut Vec<u8>) {
    out.clear();
    out.resize(words.len() * 4, 0);
    let record = words.len() / count.max(1);
    for (i, words) in words.chunks_exact(record.max(1)).enumerate() {
        for (w, word) in words.iter().enumerate() {
            for (b, byte) in word.to_le_bytes().into_iter().enumerate() {
                out[(4 * w + b) * count + i] = byte;
            }
        }
    }
}

/// The words of a pixel, taken one after another; there are as many as are taken.
struct Words<'a>(&'a [u32]);

impl Words<'_> {
    fn take<const N: usize>(&mut self) -> [u32; N] {
        let words = std::array::from_fn(|i| self.0.get(i).copied().unwrap_or_default());
        self.0 = self.0.get(N..).unwrap_or_default();
        words
    }

    fn fixed(&mut self) -> Fixed96 {
        Fixed96::from_words(self.take())
    }

    fn colour(&mut self) -> [Fixed96; 3] {
        std::array::from_fn(|_| self.fixed())
    }

    fn radiance(&mut self) -> [[Fixed96; 3]; 3] {
        std::array::from_fn(|_| self.colour())
    }

    fn i64(&mut self) -> i64 {
        let [low, high] = self.take();
        (u64::from(high) << 32 | u64::from(low)) as i64
    }

    /// Sums of so many passes; refuses what these cannot add up to and what could overflow later.
    fn sums(&mut self, passes: u64) -> Result<Sums, SectionError> {
        let square: [u32; 4] = self.take();
        let square = square.iter().rev().fold(0u128, |sum, word| sum << 32 | u128::from(*word)) as i128;
        let albedo = std::array::from_fn(|_| self.i64());
        let normal = std::array::from_fn(|_| self.i64());
        let (radiance, photon_density) = (self.radiance(), self.fixed());
        let depth = f32::from_bits(self.take::<1>()[0]);
        let sums = Sums { square, albedo, normal, radiance, photon_density, depth };
        if sums.is_of(passes) { Ok(sums) } else { Err(SectionError::Damaged("a sum is out of range")) }
    }
}
