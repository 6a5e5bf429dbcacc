use std::sync::LazyLock;

/// Weights of linear Rec. 709 red, green and blue in the luminance Y (ITU-R BT.709, item 3.2; IEC 61966-2-1).
pub const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of a linear Rec. 709 colour, in its own unit.
#[inline]
pub fn luminance(rgb: [f32; 3]) -> f32 {
    LUMINANCE[0] as f32 * rgb[0] + LUMINANCE[1] as f32 * rgb[1] + LUMINANCE[2] as f32 * rgb[2]
}

/// The same in double precision.
#[inline]
pub fn luminance_f64(rgb: [f64; 3]) -> f64 {
    LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2]
}

/// Linear value of an sRGB-encoded one (IEC 61966-2-1, piecewise); meant for [0, 1], continued beyond.
pub fn srgb_to_linear(encoded: f32) -> f32 {
    let v = f64::from(encoded);
    (if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }) as f32
}

/// sRGB encoding of a linear value (IEC 61966-2-1, piecewise); meant for [0, 1], continued beyond.
pub fn linear_to_srgb(linear: f32) -> f32 {
    let v = f64::from(linear);
    (if v <= 0.0031308 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }) as f32
}

/// [`srgb_to_linear`] of `encoded`/255, by a table.
#[inline]
pub fn srgb8_to_linear(encoded: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear((i as f64 / 255.0) as f32)));
    TABLE[usize::from(encoded)]
}

/// [`linear_to_srgb`] as the nearest of 0 … 255; values outside [0, 1] are moved into it, NaN is 0.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    // The cast saturates, and takes NaN to 0.
    (linear_to_srgb(linear.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert_eq!(srgb8_to_linear(0), 0.0);
        assert_eq!(srgb8_to_linear(255), 1.0);
        // Mid grey of the encoding: 128/255 decodes to 0.2158605.
        assert!((srgb8_to_linear(128) - 0.215_860_5).abs() < 1e-6);
        assert!((linear_to_srgb(0.18) - 0.461_356_1).abs() < 1e-6);
        assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn every_byte_survives() {
        for byte in 0..=255 {
            assert_eq!(linear_to_srgb8(srgb8_to_linear(byte)), byte);
        }
        assert_eq!([f32::NAN, -1.0, 7.0, f32::INFINITY].map(linear_to_srgb8), [0, 0, 255, 255]);
    }
}
