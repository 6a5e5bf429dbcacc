use std::ops::Range;

use crate::fixed::Fixed96;
use crate::named::{LayerSums, NamedLayers};
use crate::sums::{SMALL_BITS, Sums, Unweighted, add_parts, add_radiance, to_f64, weight_of};
use crate::{FilmError, Layer, NonFinite, PassFilm};

/// A value that was kept out of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FilmNonFinite {
    /// The pass it came from.
    pub pass: u64,
    /// Where, and which layer.
    pub at: NonFinite,
}

/// The exact sum of passes.
///
/// All sums are integers (fixed point: radiance and photon density in 96 bits with units of 2⁻⁴⁰, albedo and normal
/// in 64 bits with units of 2⁻³⁶, squared luminance in 128 bits with units of 2⁻⁶⁰): adding passes in any order and
/// merging films made anywhere give the same bits. Each value is rounded once, by at most half a unit, when it is
/// added.
///
/// Memory: 192 bytes a pixel; 312 with a filter that has negative weights; 36 (72) more for each named layer.
///
/// Radiance with a weight w (mean 1) is estimated by ⟨wL⟩ − ⟨L⟩(⟨w⟩ − 1), angle brackets for means over passes: the
/// known mean of w is a control variate, with ⟨L⟩ as its coefficient. Where w is always 1 this is the plain mean.
/// Otherwise even surfaces come out even after one pass, nothing is divided by a sum of weights that may be 0, and the
/// bias −Cov(L, w)/passes vanishes.
///
/// A film may have *named layers* beside those of [`Layer`]: colours that a pass gives for every pixel, summed,
/// weighted and averaged like radiance; one for each technique, say, or each group of lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: usize,
    height: usize,
    /// Passes that are in, as disjoint ascending ranges that do not touch.
    passes: Vec<Range<u64>>,
    pixels: Vec<Sums>,
    /// Sums without weights; empty while every weight was 1, where they equal the weighted ones.
    unweighted: Vec<Unweighted>,
    /// Greatest |weight| met.
    max_weight: f32,
    nonfinite: Vec<FilmNonFinite>,
    nonfinite_count: u64,
    layers: NamedLayers,
}

impl Film {
    /// Passes that a film can hold: 2²².
    pub const MAX_PASSES: u64 = 1 << 22;

    /// A film without passes.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            passes: Vec::new(),
            pixels: vec![Sums::default(); width * height],
            unweighted: Vec::new(),
            max_weight: 1.0,
            nonfinite: Vec::new(),
            nonfinite_count: 0,
            layers: NamedLayers::default(),
        }
    }

    /// A film without passes that has named layers, which every pass must bring ([`PassFilm::with_layers`]).
    ///
    /// # Errors
    /// Where a name is empty, longer than 200 bytes, that of a [`Layer`], given twice, or has other characters than
    /// letters, digits, `_` and `-`.
    pub fn with_layers(width: usize, height: usize, names: Vec<String>) -> Result<Self, FilmError> {
        let layers = NamedLayers::new(names, width * height)?;
        Ok(Self { layers, ..Self::new(width, height) })
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Adds the pass of that index; passes may come in any order.
    ///
    /// # Errors
    /// Where the sizes or the named layers differ, the pass is in already, or the film is full; the film is then
    /// unchanged.
    pub fn add(&mut self, pass_index: u64, pass: &PassFilm) -> Result<(), FilmError> {
        self.check_size(pass.width(), pass.height())?;
        self.layers.check_values(pass)?;
        let range = pass_index..pass_index.checked_add(1).ok_or(FilmError::TooManyPasses)?;
        let passes = self.united(std::slice::from_ref(&range))?;
        if pass.pixels().iter().any(|p| p.weight != 1.0) {
            self.split_weights();
        }
        for (sums, sample) in self.pixels.iter_mut().zip(pass.pixels()) {
            sums.add(sample);
        }
        for (sums, sample) in self.unweighted.iter_mut().zip(pass.pixels()) {
            add_parts(&mut sums.radiance, sample, 1.0);
            sums.weight.add(sample.weight);
            self.max_weight = self.max_weight.max(sample.weight.abs());
        }
        self.layers.add(pass);
        let listed = pass.nonfinite().iter().map(|&at| FilmNonFinite { pass: pass_index, at });
        self.report(listed, pass.nonfinite_count());
        self.passes = passes;
        Ok(())
    }

    /// Adds the passes of another film.
    ///
    /// # Errors
    /// Where the sizes or the named layers differ, a pass is in both, or there are too many; the film is then unchanged.
    pub fn merge(&mut self, other: &Self) -> Result<(), FilmError> {
        self.check_size(other.width, other.height)?;
        self.layers.check_names(&other.layers)?;
        let passes = self.united(&other.passes)?;
        if other.unweighted.is_empty() {
            if !self.unweighted.is_empty() {
                let weight = weight_of(other.passes());
                for (sums, from) in self.unweighted.iter_mut().zip(&other.pixels) {
                    add_radiance(&mut sums.radiance, &from.radiance);
                    sums.weight.add_sum(weight);
                }
            }
        } else {
            self.split_weights();
            for (sums, from) in self.unweighted.iter_mut().zip(&other.unweighted) {
                add_radiance(&mut sums.radiance, &from.radiance);
                sums.weight.add_sum(from.weight);
            }
            self.max_weight = self.max_weight.max(other.max_weight);
        }
        for (sums, from) in self.pixels.iter_mut().zip(&other.pixels) {
            sums.add_sums(from);
        }
        self.layers.merge(&other.layers);
        self.report(other.nonfinite.iter().copied(), other.nonfinite_count);
        self.passes = passes;
        Ok(())
    }

    /// Memory that it takes, in bytes.
    pub fn memory_bytes(&self) -> u64 {
        let sums = size_of_val(&*self.pixels) + size_of_val(&*self.unweighted) + self.layers.memory_bytes();
        sums as u64
    }

    /// Number of passes.
    pub fn passes(&self) -> u64 {
        self.passes.iter().map(|r| r.end - r.start).sum()
    }

    /// Which passes: disjoint ascending ranges that do not touch.
    pub fn pass_ranges(&self) -> &[Range<u64>] {
        &self.passes
    }

    /// The first values that were kept out, by pass, pixel and layer; at most [`PassFilm::NONFINITE_LISTED`].
    pub fn nonfinite(&self) -> &[FilmNonFinite] {
        &self.nonfinite
    }

    /// How many values were kept out.
    pub fn nonfinite_count(&self) -> u64 {
        self.nonfinite_count
    }

    /// A layer, row by row from the top, [`Layer::channels`] values a pixel; 0 before the first pass (depth: +∞;
    /// noise: 0 before the second).
    pub fn layer(&self, layer: Layer) -> Vec<f32> {
        let scale = 1.0 / self.passes().max(1) as f64;
        let small = scale * (0.5f64).powi(SMALL_BITS);
        let mut out = Vec::with_capacity(self.pixels.len() * layer.channels());
        for (i, p) in self.pixels.iter().enumerate() {
            match layer {
                Layer::Beauty => out.extend(self.radiance(i, &[0, 1, 2]).map(|v| v as f32)),
                Layer::Direct => out.extend(self.radiance(i, &[0]).map(|v| v as f32)),
                Layer::Caustic => out.extend(self.radiance(i, &[1]).map(|v| v as f32)),
                Layer::Indirect => out.extend(self.radiance(i, &[2]).map(|v| v as f32)),
                Layer::Albedo => out.extend(p.albedo.map(|v| (v as f64 * small) as f32)),
                Layer::Normal => out.extend(p.normal.map(|v| (v as f64 * small) as f32)),
                Layer::Depth => out.push(if p.depth > 0.0 { p.depth } else { f32::INFINITY }),
                Layer::Noise => return self.noise().unwrap_or_else(|| vec![0.0; self.pixels.len()]),
                Layer::PhotonDensity => out.push((p.photon_density.to_f64() * scale) as f32),
            }
        }
        out
    }

    /// Names of the named layers, in the order given.
    pub fn layer_names(&self) -> &[String] {
        self.layers.names()
    }

    /// A named layer by its place among [`layer_names`](Self::layer_names): linear Rec. 709, row by row; none beyond.
    pub fn named_layer(&self, index: usize) -> Option<Vec<[f32; 3]>> {
        let n = self.passes().max(1) as f64;
        let (sums, plain) = self.layer_sums(index)?;
        let colour = |(i, sum): (usize, &[Fixed96; 3])| {
            let plain = plain.get(i).zip(self.unweighted.get(i));
            estimate(to_f64(sum), plain.map(|(p, w)| (to_f64(p), w.weight.to_f64())), n).map(|v| v as f32)
        };
        Some(sums.iter().enumerate().map(colour).collect())
    }

    /// [`Layer::Beauty`] as colours.
    pub fn beauty(&self) -> Vec<[f32; 3]> {
        (0..self.pixels.len()).map(|i| self.radiance(i, &[0, 1, 2]).map(|v| v as f32)).collect()
    }

    /// The estimate of the sum of some of the parts direct (0), caustic (1), indirect (2).
    fn radiance(&self, pixel: usize, parts: &[usize]) -> [f64; 3] {
        let n = self.passes().max(1) as f64;
        let mut total = [0.0; 3];
        for &part in parts {
            let weighted = to_f64(&self.pixels[pixel].radiance[part]);
            let plain = self.unweighted.get(pixel);
            let plain = plain.map(|plain| (to_f64(&plain.radiance[part]), plain.weight.to_f64()));
            for (t, v) in total.iter_mut().zip(estimate(weighted, plain, n)) {
                *t += v;
            }
        }
        total
    }

    /// From parts that belong together: size, passes, sums with and without weights and the greatest weight, what was
    /// kept out, named layers.
    pub(crate) fn from_parts(
        [width, height]: [usize; 2],
        passes: Vec<Range<u64>>,
        (pixels, unweighted, max_weight): (Vec<Sums>, Vec<Unweighted>, f32),
        (nonfinite, nonfinite_count): (Vec<FilmNonFinite>, u64),
        layers: NamedLayers,
    ) -> Self {
        Self { width, height, passes, pixels, unweighted, max_weight, nonfinite, nonfinite_count, layers }
    }

    pub(crate) fn sums(&self) -> &[Sums] {
        &self.pixels
    }

    pub(crate) fn unweighted(&self) -> &[Unweighted] {
        &self.unweighted
    }

    /// Sums of a named layer, weighted and not (see [`NamedLayers::sums`]).
    pub(crate) fn layer_sums(&self, index: usize) -> Option<LayerSums<'_>> {
        self.layers.sums(index, self.pixels.len())
    }

    pub(crate) fn max_weight(&self) -> f32 {
        self.max_weight
    }

    /// Starts to keep sums without weights, which so far equal the weighted ones.
    fn split_weights(&mut self) {
        if self.unweighted.is_empty() {
            let weight = weight_of(self.passes());
            self.unweighted =
                self.pixels.iter().map(|p| Unweighted { radiance: p.radiance, weight }).collect();
            self.layers.split_weights();
        }
    }

    fn check_size(&self, width: usize, height: usize) -> Result<(), FilmError> {
        if [width, height] == [self.width, self.height] {
            return Ok(());
        }
        Err(FilmError::Size { expected: [self.width, self.height], found: [width, height] })
    }

    /// The passes of this film and `more`, which is ascending and disjoint.
    fn united(&self, more: &[Range<u64>]) -> Result<Vec<Range<u64>>, FilmError> {
        let mut all: Vec<Range<u64>> =
            self.passes.iter().chain(more).filter(|r| r.start < r.end).cloned().collect();
        all.sort_by_key(|r| r.start);
        let mut united: Vec<Range<u64>> = Vec::with_capacity(all.len());
        for range in all {
            match united.last_mut() {
                Some(last) if range.start < last.end => return Err(FilmError::DuplicatePass(range.start)),
                Some(last) if range.start == last.end => last.end = range.end,
                _ => united.push(range),
            }
        }
        if united.iter().map(|r| r.end - r.start).sum::<u64>() > Self::MAX_PASSES {
            return Err(FilmError::TooManyPasses);
        }
        Ok(united)
    }

    fn report(&mut self, more: impl Iterator<Item = FilmNonFinite>, count: u64) {
        self.nonfinite.extend(more);
        self.nonfinite.sort();
        self.nonfinite.truncate(PassFilm::NONFINITE_LISTED);
        self.nonfinite_count += count;
    }
}

/// The mean of n passes from a weighted sum and, where weights differ, the sum without weights and that of weights
/// (see [`Film`]).
fn estimate(weighted: [f64; 3], plain: Option<([f64; 3], f64)>, n: f64) -> [f64; 3] {
    let correction = plain.map_or([0.0; 3], |(sum, weight)| sum.map(|v| v * (weight / n - 1.0)));
    std::array::from_fn(|c| (weighted[c] - correction[c]) / n)
}

#[cfg(test)]
#[path = "film_tests.rs"]
mod tests;
