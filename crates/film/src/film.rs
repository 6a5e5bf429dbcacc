use std::ops::Range;

use crate::fixed::{Fixed96, small_units, units};
use crate::{FilmError, Layer, NonFinite, PassFilm, PixelSample};

/// Bits after the point of the sums of albedos and normals.
const SMALL_BITS: i32 = 36;
/// Bits after the point of the sums of squared luminances.
const SQUARE_BITS: i32 = 60;
/// Greatest squared luminance that counts: 2⁴⁵, a luminance of 5.9·10⁶.
const MAX_SQUARE: f32 = 35_184_372_088_832.0;

/// Below this, the units of a squared luminance fit 64 bits.
const SMALL_SQUARE: f32 = (1u64 << (62 - SQUARE_BITS)) as f32;

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
/// Memory: 192 bytes a pixel; 312 with a filter that has negative weights.
///
/// Radiance with a weight w (mean 1) is estimated by ⟨wL⟩ − ⟨L⟩(⟨w⟩ − 1), angle brackets for means over passes: the
/// known mean of w is a control variate, with ⟨L⟩ as its coefficient. Where w is always 1 this is the plain mean.
/// Otherwise even surfaces come out even after one pass, nothing is divided by a sum of weights that may be 0, and the
/// bias −Cov(L, w)/passes vanishes.
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
}

/// Sums of one pixel.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sums {
    /// Σ (w · luminance)².
    square: i128,
    albedo: [i64; 3],
    normal: [i64; 3],
    /// Weighted direct, caustic, indirect.
    radiance: [[Fixed96; 3]; 3],
    photon_density: Fixed96,
    /// Nearest distance; 0 for none yet.
    depth: f32,
}

/// Sums of one pixel that signed weights make necessary.
#[derive(Clone, Debug, Default, PartialEq)]
struct Unweighted {
    radiance: [[Fixed96; 3]; 3],
    weight: Fixed96,
}

impl Sums {
    fn add(&mut self, sample: &PixelSample) {
        add_parts(&mut self.radiance, sample, sample.weight);
        let luminance = sample.weight * color::luminance(sample.beauty());
        self.square += square_units(luminance * luminance);
        for i in 0..3 {
            self.albedo[i] += small_units::<SMALL_BITS>(sample.albedo[i]);
            self.normal[i] += small_units::<SMALL_BITS>(sample.normal[i]);
        }
        self.photon_density.add(sample.photon_density);
        self.depth = nearer(self.depth, sample.depth);
    }

    fn add_sums(&mut self, other: &Self) {
        self.square += other.square;
        for i in 0..3 {
            self.albedo[i] += other.albedo[i];
            self.normal[i] += other.normal[i];
        }
        add_radiance(&mut self.radiance, &other.radiance);
        self.photon_density.add_sum(other.photon_density);
        self.depth = nearer(self.depth, other.depth);
    }
}

/// A squared luminance in units of its sum.
#[inline]
fn square_units(square: f32) -> i128 {
    if square < SMALL_SQUARE {
        i128::from(small_units::<SQUARE_BITS>(square))
    } else {
        units(square.min(MAX_SQUARE), SQUARE_BITS)
    }
}

/// The lesser distance, where 0 and +∞ stand for none.
fn nearer(a: f32, b: f32) -> f32 {
    match (a > 0.0, b > 0.0) {
        (true, true) => a.min(b),
        (true, false) => a,
        _ => b,
    }
}

fn add_parts(to: &mut [[Fixed96; 3]; 3], sample: &PixelSample, weight: f32) {
    let parts = [sample.direct, sample.caustic, sample.indirect];
    for (sum, part) in to.iter_mut().zip(parts) {
        // Most passes leave most parts of a pixel black.
        if part == [0.0; 3] {
            continue;
        }
        for (s, v) in sum.iter_mut().zip(part) {
            s.add(weight * v);
        }
    }
}

fn add_radiance(to: &mut [[Fixed96; 3]; 3], from: &[[Fixed96; 3]; 3]) {
    for (t, f) in to.iter_mut().flatten().zip(from.iter().flatten()) {
        t.add_sum(*f);
    }
}

fn to_f64(sum: &[Fixed96; 3]) -> [f64; 3] {
    sum.map(Fixed96::to_f64)
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
        }
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
    /// Where the sizes differ, the pass is in already, or the film is full; the film is then unchanged.
    pub fn add(&mut self, pass_index: u64, pass: &PassFilm) -> Result<(), FilmError> {
        self.check_size(pass.width(), pass.height())?;
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
        let listed = pass.nonfinite().iter().map(|&at| FilmNonFinite { pass: pass_index, at });
        self.report(listed, pass.nonfinite_count());
        self.passes = passes;
        Ok(())
    }

    /// Adds the passes of another film.
    ///
    /// # Errors
    /// Where the sizes differ, a pass is in both, or there are too many; the film is then unchanged.
    pub fn merge(&mut self, other: &Self) -> Result<(), FilmError> {
        self.check_size(other.width, other.height)?;
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
        self.report(other.nonfinite.iter().copied(), other.nonfinite_count);
        self.passes = passes;
        Ok(())
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

    /// A layer, row by row from the top, [`Layer::channels`] values a pixel; 0 before the first pass (depth: +∞).
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
                Layer::PhotonDensity => out.push((p.photon_density.to_f64() * scale) as f32),
            }
        }
        out
    }

    /// [`Layer::Beauty`] as colours.
    pub fn beauty(&self) -> Vec<[f32; 3]> {
        (0..self.pixels.len()).map(|i| self.radiance(i, &[0, 1, 2]).map(|v| v as f32)).collect()
    }

    /// Standard error of the luminance of beauty at each pixel, from the spread of the passes; none below two
    /// passes. Passes count as independent; with weights it is the error of the linearised estimate (see
    /// [`Film`]), exact where all weights have one magnitude. Luminances above 5.9·10⁶ count as that, and differences
    /// below 10⁻⁹ are not seen.
    pub fn noise(&self) -> Option<Vec<f32>> {
        let passes = self.passes();
        if passes < 2 {
            return None;
        }
        let n = passes as f64;
        let luminance = |parts: &[[Fixed96; 3]; 3]| -> f64 {
            parts.iter().map(|part| color::luminance_f64(to_f64(part))).sum()
        };
        let noise = self.pixels.iter().enumerate().map(|(i, sums)| {
            let weighted = luminance(&sums.radiance);
            let mut square = sums.square as f64 * (0.5f64).powi(SQUARE_BITS);
            let mut mean = weighted / n;
            if let Some(plain) = self.unweighted.get(i) {
                // Σe² of e = wL − ⟨L⟩(w − 1), with w² = c² for each pass.
                let (sum, weight) = (luminance(&plain.radiance), plain.weight.to_f64());
                let c2 = f64::from(self.max_weight).powi(2);
                let average = sum / n;
                square +=
                    average * (-2.0 * (c2 * sum - weighted) + average * ((c2 + 1.0) * n - 2.0 * weight));
                mean -= average * (weight / n - 1.0);
            }
            ((square / n - mean * mean).max(0.0) / (n - 1.0)).sqrt() as f32
        });
        Some(noise.collect())
    }

    /// The estimate of the sum of some of the parts direct (0), caustic (1), indirect (2).
    fn radiance(&self, pixel: usize, parts: &[usize]) -> [f64; 3] {
        let n = self.passes().max(1) as f64;
        let mut total = [0.0; 3];
        for &part in parts {
            let weighted = to_f64(&self.pixels[pixel].radiance[part]);
            let correction = self.unweighted.get(pixel).map_or([0.0; 3], |plain| {
                let excess = plain.weight.to_f64() / n - 1.0;
                to_f64(&plain.radiance[part]).map(|v| v * excess)
            });
            for c in 0..3 {
                total[c] += (weighted[c] - correction[c]) / n;
            }
        }
        total
    }

    /// Starts to keep sums without weights, which so far equal the weighted ones.
    fn split_weights(&mut self) {
        if self.unweighted.is_empty() {
            let weight = weight_of(self.passes());
            self.unweighted =
                self.pixels.iter().map(|p| Unweighted { radiance: p.radiance, weight }).collect();
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

/// The sum of the weights of `passes` passes of weight 1.
fn weight_of(passes: u64) -> Fixed96 {
    let mut sum = Fixed96::default();
    // At most 2²², which f32 holds exactly.
    sum.add(passes as f32);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples that differ by pass and pixel; sign and size of the weight by pass.
    fn pass(index: u64, weights: [f32; 2]) -> PassFilm {
        let pixels = (0..12u64)
            .map(|i| {
                let h = (index * 12 + i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let value = |k: u32| ((h >> (5 * k)) & 0x3ff) as f32 * 0.013 + 1e-4;
                PixelSample {
                    direct: [value(0), value(1), value(2)],
                    caustic: [value(3) * 100.0, 0.0, value(4)],
                    indirect: [value(5), value(6), value(7) * 1e-5],
                    albedo: [0.1, 0.2, value(1) * 0.05],
                    normal: [0.0, -1.0, value(2) * 0.01],
                    depth: if i == 3 { f32::INFINITY } else { value(8) + 1.0 },
                    photon_density: value(2) * 1e4,
                    weight: weights[(h >> 60) as usize & 1],
                }
            })
            .collect();
        PassFilm::new(4, 3, pixels).unwrap()
    }

    fn film(order: impl IntoIterator<Item = u64>, weights: [f32; 2]) -> Film {
        let mut film = Film::new(4, 3);
        for i in order {
            film.add(i, &pass(i, weights)).unwrap();
        }
        film
    }

    #[test]
    fn any_order_and_any_split_give_the_same_film() {
        for weights in [[1.0, 1.0], [1.3, -1.3]] {
            let straight = film(0..20, weights);
            assert_eq!(straight, film((0..20).rev(), weights));
            let mut merged = film([7, 3, 19], weights);
            merged.merge(&film((0..20).filter(|i| ![7, 3, 19].contains(i)), weights)).unwrap();
            assert_eq!(straight, merged);
            assert!(matches!(merged.pass_ranges(), [Range { start: 0, end: 20 }]));
            assert_ne!(straight, film(0..19, weights));
        }
        // Passes without and with signed weights, merged both ways.
        let (plain, signed) = (film(0..4, [1.0, 1.0]), film(4..6, [1.3, -1.3]));
        let (mut a, mut b) = (plain.clone(), signed.clone());
        a.merge(&signed).unwrap();
        b.merge(&plain).unwrap();
        assert_eq!(a, b);
        assert_eq!(a.passes(), 6);
    }

    #[test]
    fn layers_are_means_and_depth_the_least() {
        let film = film(0..7, [1.0, 1.0]);
        let passes: Vec<_> = (0..7).map(|i| pass(i, [1.0, 1.0])).collect();
        let beauty = film.layer(Layer::Beauty);
        assert_eq!(beauty, film.beauty().concat());
        for pixel in 0..12 {
            let samples: Vec<_> = passes.iter().map(|p| p.pixels()[pixel]).collect();
            let mean =
                |f: &dyn Fn(&PixelSample) -> f32| samples.iter().map(|s| f64::from(f(s))).sum::<f64>() / 7.0;
            for c in 0..3 {
                let expect = |value: f32, f: &dyn Fn(&PixelSample) -> f32| {
                    let m = mean(f);
                    assert!((f64::from(value) - m).abs() <= 1e-6 * m.abs() + 1e-11, "{value} {m}");
                };
                let at = |layer| film.layer(layer)[pixel * 3 + c];
                expect(beauty[pixel * 3 + c], &|s| s.beauty()[c]);
                expect(at(Layer::Direct), &|s| s.direct[c]);
                expect(at(Layer::Caustic), &|s| s.caustic[c]);
                expect(at(Layer::Indirect), &|s| s.indirect[c]);
                expect(at(Layer::Albedo), &|s| s.albedo[c]);
                expect(at(Layer::Normal), &|s| s.normal[c]);
            }
            let least = samples.iter().map(|s| s.depth).fold(f32::INFINITY, f32::min);
            assert_eq!(film.layer(Layer::Depth)[pixel], least);
        }
        assert_eq!(film.layer(Layer::Depth)[3], f32::INFINITY);
    }

    #[test]
    fn signed_weights_leave_even_surfaces_even() {
        let mut film = Film::new(1, 1);
        let sample = |weight| PixelSample { indirect: [0.5, 2.0, 0.25], weight, ..PixelSample::default() };
        for (i, weight) in [-1.3, 1.3, 1.3, -1.3].into_iter().enumerate() {
            film.add(i as u64, &PassFilm::new(1, 1, vec![sample(weight)]).unwrap()).unwrap();
            for (v, e) in film.layer(Layer::Beauty).iter().zip([0.5, 2.0, 0.25]) {
                assert!((v - e).abs() < 1e-6);
            }
        }
        assert!(film.noise().unwrap()[0] < 1e-5);
    }

    #[test]
    fn noise_is_the_standard_error() {
        for weights in [[1.0, 1.0], [1.3, -1.3]] {
            let film = film(0..9, weights);
            let noise = film.noise().unwrap();
            for (pixel, &noise) in noise.iter().enumerate() {
                let samples: Vec<_> = (0..9)
                    .map(|i| pass(i, weights).pixels()[pixel])
                    .map(|s| (f64::from(s.weight), color::luminance_f64(s.beauty().map(f64::from))))
                    .collect();
                let average = samples.iter().map(|s| s.1).sum::<f64>() / 9.0;
                let e: Vec<f64> = samples.iter().map(|(w, l)| w * l - average * (w - 1.0)).collect();
                let mean = e.iter().sum::<f64>() / 9.0;
                let variance = e.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 8.0;
                let expected = (variance / 9.0).sqrt();
                assert!((f64::from(noise) - expected).abs() < 1e-4 * expected, "{noise} {expected}");
            }
        }
        assert_eq!(film(0..1, [1.0, 1.0]).noise(), None);
    }

    #[test]
    fn refusals_leave_the_film_unchanged() {
        let mut film = film(0..3, [1.0, 1.0]);
        let before = film.clone();
        assert_eq!(film.add(1, &pass(1, [1.0, 1.0])), Err(FilmError::DuplicatePass(1)));
        assert_eq!(film.merge(&before), Err(FilmError::DuplicatePass(0)));
        assert!(matches!(film.merge(&Film::new(3, 4)), Err(FilmError::Size { .. })));
        assert_eq!(film.add(u64::MAX, &pass(9, [1.0, 1.0])), Err(FilmError::TooManyPasses));
        assert_eq!(film, before);
    }

    #[test]
    fn values_that_are_not_finite_stay_out_and_are_told() {
        let mut pixels = vec![PixelSample { direct: [1.0; 3], ..PixelSample::default() }; 12];
        pixels[2].direct[1] = f32::NAN;
        pixels[5].caustic[0] = f32::INFINITY;
        pixels[5].photon_density = f32::NAN;
        pixels[7].weight = f32::NAN;
        pixels[8].indirect[2] = 1e30;
        let pass = PassFilm::new(4, 3, pixels).unwrap();
        let found: Vec<_> = pass.nonfinite().iter().map(|n| (n.pixel, n.layer)).collect();
        assert_eq!(
            found,
            [
                (2, Layer::Direct),
                (5, Layer::Caustic),
                (5, Layer::PhotonDensity),
                (7, Layer::Beauty),
                (8, Layer::Indirect)
            ]
        );
        let mut film = Film::new(4, 3);
        film.add(3, &pass).unwrap();
        assert_eq!((film.nonfinite_count(), film.nonfinite()[0].pass), (5, 3));
        let beauty = film.beauty();
        assert!(beauty.iter().flatten().all(|v| v.is_finite()));
        assert_eq!((beauty[2], beauty[5], beauty[7], beauty[8]), ([0.0; 3], [1.0; 3], [0.0; 3], [1.0; 3]));
    }

    #[test]
    fn memory_is_as_documented() {
        assert_eq!((size_of::<Sums>(), size_of::<Unweighted>()), (192, 120));
        assert_eq!(size_of::<PixelSample>(), 72);
    }
}
