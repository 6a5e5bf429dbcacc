//! What a film adds up for a pixel.

use crate::PixelSample;
use crate::fixed::{Fixed96, small_units, units};
use crate::pass_film::SMALL;

/// Bits after the point of the sums of albedos and normals.
pub(crate) const SMALL_BITS: i32 = 36;
/// Bits after the point of the sums of squared luminances.
pub(crate) const SQUARE_BITS: i32 = 60;
/// Greatest squared luminance that counts: 2⁴⁵, a luminance of 5.9·10⁶.
pub(crate) const MAX_SQUARE: f32 = 35_184_372_088_832.0;

/// Below this, the units of a squared luminance fit 64 bits.
const SMALL_SQUARE: f32 = (1u64 << (62 - SQUARE_BITS)) as f32;

/// Sums of one pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sums {
    /// Σ (w · luminance)².
    pub(crate) square: i128,
    pub(crate) albedo: [i64; 3],
    pub(crate) normal: [i64; 3],
    /// Weighted direct, caustic, indirect.
    pub(crate) radiance: [[Fixed96; 3]; 3],
    pub(crate) photon_density: Fixed96,
    /// Nearest distance; 0 for none yet.
    pub(crate) depth: f32,
}

/// Sums of one pixel that signed weights make necessary.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Unweighted {
    pub(crate) radiance: [[Fixed96; 3]; 3],
    pub(crate) weight: Fixed96,
}

impl Sums {
    pub(crate) fn add(&mut self, sample: &PixelSample) {
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

    /// Whether so many passes can add up to this, so far as sums could overflow otherwise.
    pub(crate) fn is_of(&self, passes: u64) -> bool {
        let limit = passes as i64 * small_units::<SMALL_BITS>(SMALL);
        let small = self.albedo.iter().chain(&self.normal).all(|v| (-limit..=limit).contains(v));
        let most = i128::from(passes).saturating_mul(units(MAX_SQUARE, SQUARE_BITS));
        small && (0..=most).contains(&self.square) && self.depth >= 0.0
    }

    pub(crate) fn add_sums(&mut self, other: &Self) {
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

pub(crate) fn add_parts(to: &mut [[Fixed96; 3]; 3], sample: &PixelSample, weight: f32) {
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

pub(crate) fn add_radiance(to: &mut [[Fixed96; 3]; 3], from: &[[Fixed96; 3]; 3]) {
    for (t, f) in to.iter_mut().flatten().zip(from.iter().flatten()) {
        t.add_sum(*f);
    }
}

pub(crate) fn to_f64(sum: &[Fixed96; 3]) -> [f64; 3] {
    sum.map(Fixed96::to_f64)
}

/// The sum of the weights of `passes` passes of weight 1.
pub(crate) fn weight_of(passes: u64) -> Fixed96 {
    let mut sum = Fixed96::default();
    // At most 2²², which f32 holds exactly.
    sum.add(passes as f32);
    sum
}
