/// Bits after the binary point of [`Fixed96`].
const FRACTION_BITS: i32 = 40;

/// Greatest magnitude of one value that may be added: 2³³ ≈ 8.6·10⁹.
pub(crate) const MAX_VALUE: f32 = 8_589_934_592.0;

/// A sum as a 96-bit two's-complement integer of units of 2⁻⁴⁰ ≈ 9·10⁻¹³: adding is exact, so any order gives the
/// same bits. Each value is first rounded to the nearest unit (ties away from 0). Range ±2⁵⁵: 2²² values of
/// [`MAX_VALUE`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Fixed96([u32; 3]);

impl Fixed96 {
    /// The sum's words, lowest first.
    #[inline]
    pub(crate) fn words(self) -> [u32; 3] {
        self.0
    }

    /// From [`words`](Self::words).
    #[inline]
    pub(crate) fn from_words(words: [u32; 3]) -> Self {
        Self(words)
    }

    /// Adds `value`; a caller keeps its magnitude at or below [`MAX_VALUE`].
    #[inline]
    pub(crate) fn add(&mut self, value: f32) {
        if value.abs() < SMALL_VALUE {
            self.add_small(small_units::<FRACTION_BITS>(value));
        } else {
            self.add_units(units(value, FRACTION_BITS));
        }
    }

    /// Adds another sum.
    #[inline]
    pub(crate) fn add_sum(&mut self, other: Self) {
        self.add_units(other.get());
    }

    /// The sum, rounded to f64.
    #[inline]
    pub(crate) fn to_f64(self) -> f64 {
        const UNIT: f64 = 1.0 / (1u64 << FRACTION_BITS) as f64;
        let low = self.low() as i64;
        if i64::from(self.0[2] as i32) == low >> 63 { low as f64 * UNIT } else { self.get() as f64 * UNIT }
    }

    #[inline]
    fn low(self) -> u64 {
        u64::from(self.0[1]) << 32 | u64::from(self.0[0])
    }

    #[inline]
    fn get(self) -> i128 {
        (i128::from(self.0[2] as i32) << 64) | i128::from(self.low())
    }

    #[inline]
    fn add_small(&mut self, units: i64) {
        let (low, carry) = self.low().overflowing_add(units as u64);
        let high = self.0[2].wrapping_add((units >> 63) as u32).wrapping_add(u32::from(carry));
        self.0 = [low as u32, (low >> 32) as u32, high];
    }

    #[inline]
    fn add_units(&mut self, units: i128) {
        let sum = self.get().wrapping_add(units);
        self.0 = [sum as u32, (sum >> 32) as u32, (sum >> 64) as u32];
    }
}

/// Below this magnitude the units of a value fit 64 bits.
const SMALL_VALUE: f32 = (1u64 << (62 - FRACTION_BITS)) as f32;

/// [`units`] of a value whose units are fewer than 2⁶³ in magnitude. Scaling an f32 by a power of two is exact in f64,
/// and so is adding a half below 2⁵²; above, the scaled value is an even integer and the half is lost.
#[inline]
pub(crate) fn small_units<const FRACTION_BITS: i32>(value: f32) -> i64 {
    let scaled = f64::from(value) * (1u64 << FRACTION_BITS) as f64;
    (scaled + 0.5f64.copysign(scaled)) as i64
}

/// `value` in units of 2^-`fraction_bits`, rounded to nearest, ties away from 0; from the bits of the float, so that
/// no rounding mode enters. Not for infinities, and not for magnitudes of 2^(103 − `fraction_bits`) and more.
#[inline]
pub(crate) fn units(value: f32, fraction_bits: i32) -> i128 {
    let bits = value.to_bits();
    let exponent = ((bits >> 23) & 0xff) as i32;
    let hidden = if exponent == 0 { 0 } else { 1 << 23 };
    let mantissa = i128::from((bits & 0x7f_ffff) | hidden);
    // value = mantissa · 2^(exponent − 150), for exponent ≥ 1.
    let shift = exponent.max(1) - 150 + fraction_bits;
    let magnitude = if shift >= 0 {
        mantissa << shift.min(102)
    } else if shift > -26 {
        ((mantissa >> (-shift - 1)) + 1) >> 1
    } else {
        0
    };
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_rounded_to_nearest() {
        let mut total = Fixed96::default();
        for v in [0.0f32, 1.0, -1.0, 0.1, 1e-12, 4.6e-13, -4.5e-13, 1e-20, 3.7e9, -8e9, 1e-40, 12345.678] {
            let expected = (f64::from(v) * 2f64.powi(40)).round();
            assert_eq!(units(v, 40) as f64, expected, "{v}");
            if v.abs() < SMALL_VALUE {
                assert_eq!(i128::from(small_units::<40>(v)), units(v, 40), "{v}");
            }
        }
        let mut h = 1u32;
        for _ in 0..100_000 {
            h = h.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let v = f32::from_bits(h);
            if v.abs() < SMALL_VALUE {
                assert_eq!(i128::from(small_units::<40>(v)), units(v, 40), "{v}");
                let (mut fast, mut slow) = (Fixed96([h, !h, h >> 9]), Fixed96([h, !h, h >> 9]));
                fast.add(v);
                slow.add_units(units(v, 40));
                assert_eq!(fast, slow);
                assert_eq!(fast.to_f64(), slow.get() as f64 / 2f64.powi(40));
            }
        }
        for (v, sum) in [(-1.0, -1.0), (3.0, 2.0), (-2.5, -0.5), (0.5, 0.0)] {
            total.add(v);
            assert_eq!(total.to_f64(), sum);
        }
        assert_eq!(units(0.5, 0), 1);
        assert_eq!(units(0.25, 0), 0);
        assert_eq!(units(-2.5, 0), -3);
    }

    #[test]
    fn sums_do_not_depend_on_order() {
        let values: Vec<f32> = (0..1000u32)
            .map(|i| {
                let h = i.wrapping_mul(0x9e37_79b9) ^ 0x5bd1;
                let magnitude = 10f32.powi((h % 17) as i32 - 8) * (1.0 + (h >> 8) as f32 * 1e-7);
                if h & 64 == 0 { magnitude } else { -magnitude }
            })
            .collect();
        let sum = |v: &mut dyn Iterator<Item = &f32>| {
            let mut s = Fixed96::default();
            v.for_each(|&x| s.add(x));
            s
        };
        let forward = sum(&mut values.iter());
        let backward = sum(&mut values.iter().rev());
        let (mut left, right) = (sum(&mut values[..300].iter()), sum(&mut values[300..].iter()));
        left.add_sum(right);
        assert_eq!(forward, backward);
        assert_eq!(forward, left);
        let exact: f64 = values.iter().map(|&v| (f64::from(v) * 2f64.powi(40)).round() / 2f64.powi(40)).sum();
        assert!((forward.to_f64() - exact).abs() <= 1e-6 * exact.abs());
    }

    #[test]
    fn range_holds_the_greatest_sum() {
        let mut s = Fixed96::default();
        for _ in 0..1000 {
            s.add(-MAX_VALUE);
        }
        assert_eq!(s.to_f64(), -1000.0 * f64::from(MAX_VALUE));
        // 2²² values of 2³³ need 55 bits before the point, 40 after and a sign: 96.
        let mut full = Fixed96([0, 0, 0x7fff_ffff]);
        assert!(full.to_f64() > 0.999 * 2f64.powi(55));
        full.add(-1.0);
        assert!(full.to_f64() > 0.999 * 2f64.powi(55));
    }
}
