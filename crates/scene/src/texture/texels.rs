//! Numbers of a picture as they are stored.

use std::sync::LazyLock;

use half::f16;

/// Numbers in as little memory as keeps what the file says.
#[derive(Clone, Debug)]
pub(super) enum Texels {
    /// Of 8-bit files.
    Bytes(Vec<u8>),
    /// Linear numbers of 16-bit files: shares of 65535.
    Words(Vec<u16>),
    /// Half floats (IEEE 754 binary16), as bits.
    Halves(Vec<u16>),
    /// What no half holds.
    Floats(Vec<f32>),
}

/// What bytes stand for, and the middles between neighbours.
#[derive(Debug)]
pub(super) struct Curve {
    pub values: [f32; 256],
    middles: [f32; 255],
    /// Where to begin looking for a value: by 1024ths.
    starts: [u8; 1025],
}

impl Curve {
    fn new(of: impl Fn(f32) -> f32) -> Self {
        let values: [f32; 256] = std::array::from_fn(|i| of(i as f32 / 255.0));
        let middles: [f32; 255] = std::array::from_fn(|i| 0.5 * (values[i] + values[i + 1]));
        let starts = std::array::from_fn(|i| {
            let x = i as f32 / 1024.0;
            middles.partition_point(|m| *m < x) as u8
        });
        Self { values, middles, starts }
    }

    /// The byte whose value is nearest.
    fn encode(&self, x: f32) -> u8 {
        let x = x.clamp(0.0, 1.0);
        let mut byte = usize::from(self.starts[(x * 1024.0) as usize]);
        while byte < 255 && self.middles[byte] < x {
            byte += 1;
        }
        byte as u8
    }
}

/// The sRGB transfer curve (IEC 61966-2-1).
pub(super) static SRGB: LazyLock<Curve> = LazyLock::new(|| Curve::new(color::srgb_to_linear));
/// Shares of 255.
pub(super) static LINEAR: LazyLock<Curve> = LazyLock::new(|| Curve::new(|x| x));

/// A half float by its bits; finite ones only. The exponent is moved by a product, which also normalises the small ones.
#[inline]
fn from_half(bits: u16) -> f32 {
    let magnitude = f32::from_bits(u32::from(bits & 0x7fff) << 13) * f32::from_bits((254 - 15) << 23);
    f32::from_bits(magnitude.to_bits() | u32::from(bits & 0x8000) << 16)
}

/// The bits of the nearest half float.
pub(super) fn to_half(x: f32) -> u16 {
    f16::from_f32(x).to_bits()
}

/// Whether a number is in the range of half floats.
pub(super) fn fits_half(x: f32) -> bool {
    x.abs() <= f16::MAX.to_f32()
}

impl Texels {
    /// A number; `curve` is that of bytes.
    #[inline]
    pub fn get(&self, i: usize, curve: &Curve) -> f32 {
        match self {
            Self::Bytes(t) => curve.values[usize::from(t[i])],
            Self::Words(t) => f32::from(t[i]) * (1.0 / 65535.0),
            Self::Halves(t) => from_half(t[i]),
            Self::Floats(t) => t[i],
        }
    }

    /// The same kind of numbers for others: `curve_of` an index is the curve of its channel.
    pub fn like(&self, values: &[f32], curve_of: impl Fn(usize) -> &'static Curve) -> Self {
        match self {
            Self::Bytes(_) => {
                Self::Bytes(values.iter().enumerate().map(|(i, x)| curve_of(i).encode(*x)).collect())
            }
            Self::Words(_) => {
                Self::Words(values.iter().map(|x| (x.clamp(0.0, 1.0) * 65535.0).round() as u16).collect())
            }
            Self::Halves(_) => Self::Halves(values.iter().map(|x| to_half(*x)).collect()),
            Self::Floats(_) => Self::Floats(values.to_vec()),
        }
    }

    pub fn memory_bytes(&self) -> usize {
        match self {
            Self::Bytes(t) => t.len(),
            Self::Words(t) | Self::Halves(t) => 2 * t.len(),
            Self::Floats(t) => 4 * t.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_what_the_standard_says() {
        for bits in (0..0x7c00).chain(0x8000..0xfc00u16) {
            let expected = f16::from_bits(bits).to_f32();
            assert_eq!(from_half(bits).to_bits(), expected.to_bits(), "{bits:x}");
            assert_eq!(to_half(expected), bits);
        }
        assert!(fits_half(65504.0) && !fits_half(65600.0) && !fits_half(f32::INFINITY));
    }

    #[test]
    fn every_byte_is_its_own_nearest() {
        for curve in [&*SRGB, &*LINEAR] {
            for i in 0..=255u8 {
                assert_eq!(curve.encode(curve.values[usize::from(i)]), i);
            }
            assert_eq!((curve.encode(-1.0), curve.encode(7.0), curve.encode(f32::NAN)), (0, 255, 0));
            // Between two bytes the nearer one.
            for i in 0..2000 {
                let x = i as f32 / 2000.0;
                let byte = usize::from(curve.encode(x));
                let error = |b: usize| (curve.values[b] - x).abs();
                assert!(byte == 0 || error(byte) <= error(byte - 1));
                assert!(byte == 255 || error(byte) <= error(byte + 1));
            }
        }
    }
}
