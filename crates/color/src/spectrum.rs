use crate::cie::{D65, SAMPLES, START_NM, STEP_NM, X_BAR, Y_BAR, Z_BAR};

/// From CIE XYZ to linear Rec. 709 with its white (D65, Y = 1) at (1, 1, 1); from the primaries and white point of
/// ITU-R BT.709, item 1.3 and 1.4.
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_969_941_904_52, -1.537_383_177_570_09, -0.498_610_760_293_0],
    [-0.969_243_636_280_87, 1.875_967_501_507_72, 0.041_555_057_407_175],
    [0.055_630_079_696_99, -0.203_976_958_888_97, 1.056_971_514_242_878],
];

/// Linear Rec. 709 of CIE XYZ.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    RGB_FROM_XYZ.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}

/// Tristimulus values ∫ S(λ)·(x̄, ȳ, z̄) dλ of the CIE 1931 observer, with S by wavelength in nanometres; a sum over
/// 380, 385 … 780 nm.
pub fn emission_to_xyz(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    weigh(|_, nm| spectrum(nm))
}

/// Linear Rec. 709 of a reflectance seen under D65; 1 at all wavelengths gives (1, 1, 1) exactly. Saturated
/// reflectances leave [0, 1].
pub fn reflectance_to_rgb(reflectance: impl Fn(f64) -> f64) -> [f64; 3] {
    let lit = xyz_to_rgb(weigh(|i, nm| reflectance(nm) * D65[i]));
    let white = xyz_to_rgb(weigh(|i, _| D65[i]));
    std::array::from_fn(|c| lit[c] / white[c])
}

/// What each of linear red, green and blue makes of a spectrum under D65: the mean with the positive part of the
/// channel's response as weight.
pub(crate) fn channel_means(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let (mut sums, mut weights) = ([0.0; 3], [0.0; 3]);
    for i in 0..SAMPLES {
        let value = spectrum(wavelength_nm(i));
        let response = xyz_to_rgb([X_BAR[i], Y_BAR[i], Z_BAR[i]]);
        for c in 0..3 {
            let weight = response[c].max(0.0) * D65[i];
            sums[c] += weight * value;
            weights[c] += weight;
        }
    }
    std::array::from_fn(|c| sums[c] / weights[c])
}

/// Linear Rec. 709 of a black body at `kelvin`, scaled to luminance 1.
///
/// Planck's law under the CIE 1931 observer. Below about 1 900 K blue would be slightly negative; it is 0 then, and
/// the luminance still 1. Temperatures are moved into [500, 10⁶] K, NaN to 500 K.
pub fn blackbody_rgb(kelvin: f32) -> [f32; 3] {
    let rgb = xyz_to_rgb(blackbody_xyz(kelvin)).map(|v| v.max(0.0));
    let luminance = crate::luminance_f64(rgb);
    rgb.map(|v| (v / luminance) as f32)
}

/// CIE XYZ of a black body at `kelvin`, moved as in [`blackbody_rgb`]; its scale means nothing.
pub(crate) fn blackbody_xyz(kelvin: f32) -> [f64; 3] {
    let kelvin = if kelvin.is_nan() { 500.0 } else { f64::from(kelvin).clamp(500.0, 1e6) };
    emission_to_xyz(|nm| {
        // Second radiation constant hc/k = 1.438776877 cm K (CODATA 2018); its factor in front cancels.
        (nm / 560.0).powi(-5) / (1.438_776_877e7 / (nm * kelvin)).exp_m1()
    })
}

fn weigh(value: impl Fn(usize, f64) -> f64) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    for i in 0..SAMPLES {
        let value = value(i, wavelength_nm(i)) * STEP_NM;
        xyz[0] += value * X_BAR[i];
        xyz[1] += value * Y_BAR[i];
        xyz[2] += value * Z_BAR[i];
    }
    xyz
}

fn wavelength_nm(index: usize) -> f64 {
    START_NM + STEP_NM * index as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_is_white() {
        // CIE 15: D65 has x = 0.31272, y = 0.32903.
        let xyz = weigh(|i, _| D65[i]);
        let sum: f64 = xyz.iter().sum();
        assert!((xyz[0] / sum - 0.31272).abs() < 5e-5 && (xyz[1] / sum - 0.32903).abs() < 5e-5);
        assert_eq!(reflectance_to_rgb(|_| 1.0), [1.0; 3]);
        let grey = reflectance_to_rgb(|_| 0.3);
        assert!(grey.iter().all(|v| (v - 0.3).abs() < 1e-12));
        // Rec. 709's white and luminance weights agree with its matrix.
        let white = xyz_to_rgb([0.3127 / 0.3290, 1.0, 0.3583 / 0.3290]);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-6), "{white:?}");
        let y: f64 = crate::luminance_f64(xyz_to_rgb([0.3, 0.6, 0.2]));
        assert!((y - 0.6).abs() < 1e-4);
    }

    #[test]
    fn black_bodies_have_their_published_colours() {
        // Chromaticities by an independent integration at 1 nm; 2856 K is illuminant A, x = 0.44758, y = 0.40745.
        for (kelvin, x, y) in [
            (2856.0, 0.447538, 0.407437),
            (4000.0, 0.380451, 0.376770),
            (6504.0, 0.313488, 0.323624),
            (20000.0, 0.256493, 0.257743),
        ] {
            let rgb = blackbody_rgb(kelvin).map(f64::from);
            // Rec. 709 to XYZ, by its primaries (x, y) and white.
            let xyz = [
                0.412391 * rgb[0] + 0.357584 * rgb[1] + 0.180481 * rgb[2],
                0.212639 * rgb[0] + 0.715169 * rgb[1] + 0.072192 * rgb[2],
                0.019331 * rgb[0] + 0.119195 * rgb[1] + 0.950532 * rgb[2],
            ];
            let sum: f64 = xyz.iter().sum();
            assert!((xyz[0] / sum - x).abs() < 1e-4 && (xyz[1] / sum - y).abs() < 1e-4, "{kelvin}: {xyz:?}");
        }
    }

    #[test]
    fn black_bodies_have_luminance_one() {
        for kelvin in [f32::NAN, -1.0, 500.0, 1000.0, 1900.0, 3000.0, 6500.0, 1e5, 1e9] {
            let rgb = blackbody_rgb(kelvin);
            assert!(rgb.iter().all(|v| *v >= 0.0));
            assert!((crate::luminance(rgb) - 1.0).abs() < 1e-6, "{kelvin}: {rgb:?}");
        }
        assert!(blackbody_rgb(1000.0)[0] > 4.0);
    }
}
