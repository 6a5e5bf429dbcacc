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
