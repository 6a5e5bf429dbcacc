//! White balance.

use color::{blackbody_rgb, xyz_to_rgb};

/// What makes light of one white look like that of Rec. 709, D65: von Kries's rule in Bradford's cone responses (Lam 1985), as pbrt-v4's
/// film applies it. Done to lights instead of the picture it is the same for light that meets only grey surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WhiteBalance {
    /// Factors on the cone responses.
    gains: [f64; 3],
}

/// Cone responses of XYZ.
const BRADFORD: [[f64; 3]; 3] =
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// The inverse of [`BRADFORD`].
const BACK: [[f64; 3]; 3] = [
    [0.986_992_9, -0.147_054_3, 0.159_962_7],
    [0.432_305_3, 0.518_360_3, 0.049_291_2],
    [-0.008_528_7, 0.040_042_8, 0.968_486_7],
];

/// XYZ of linear Rec. 709: the inverse of what `xyz_to_rgb` does.
const XYZ: [[f64; 3]; 3] = [
    [0.412_390_799, 0.357_584_339, 0.180_480_788],
    [0.212_639_006, 0.715_168_679, 0.072_192_315],
    [0.019_330_819, 0.119_194_780, 0.950_532_152],
];

fn apply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

impl WhiteBalance {
    /// None.
    pub(super) const NONE: Self = Self { gains: [1.0; 3] };

    /// For daylight of a colour temperature, below 4000 K light of a black body.
    pub(super) fn from_kelvin(kelvin: f64) -> Self {
        let (white, from) = (apply(&BRADFORD, apply(&XYZ, [1.0; 3])), apply(&BRADFORD, source(kelvin)));
        Self { gains: [0, 1, 2].map(|i| white[i] / from[i].max(1e-6)) }
    }

    /// The balanced colour; what leaves Rec. 709 is moved to its border.
    pub(super) fn balanced(&self, rgb: [f64; 3]) -> [f64; 3] {
        if *self == Self::NONE {
            return rgb;
        }
        let cones = apply(&BRADFORD, apply(&XYZ, rgb));
        let cones = [0, 1, 2].map(|i| cones[i] * self.gains[i]);
        xyz_to_rgb(apply(&BACK, cones)).map(|c| c.max(0.0))
    }
}

/// XYZ of a white, Y = 1. The locus of daylight: CIE 15:2004, equations 3.3 and 3.4.
fn source(kelvin: f64) -> [f64; 3] {
    if kelvin < 4000.0 {
        return apply(&XYZ, blackbody_rgb(kelvin as f32).map(f64::from));
    }
    let t = 1e3 / kelvin.min(25_000.0);
    let x = if kelvin <= 7000.0 {
        0.244_063 + t * (0.099_11 + t * (2.9678 - t * 4.6070))
    } else {
        0.237_040 + t * (0.247_48 + t * (1.9018 - t * 2.0064))
    };
    let y = -3.0 * x * x + 2.870 * x - 0.275;
    [x / y, 1.0, (1.0 - x - y) / y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_becomes_white() {
        for kelvin in [2800.0, 4000.0, 10_000.0] {
            let seen = WhiteBalance::from_kelvin(kelvin).balanced(xyz_to_rgb(source(kelvin)));
            assert!(seen.iter().all(|c| (c - 1.0).abs() < 1e-3), "{kelvin} {seen:?}");
        }
        // D65 is daylight of 6504 K.
        let d65 = xyz_to_rgb(source(6504.0));
        assert!(d65.iter().all(|c| (c - 1.0).abs() < 3e-3), "{d65:?}");
        let same = WhiteBalance::from_kelvin(6504.0).balanced([0.2, 0.5, 0.8]);
        assert!((0..3).all(|i| (same[i] - [0.2, 0.5, 0.8][i]).abs() < 0.02), "{same:?}");
        assert_eq!(WhiteBalance::NONE.balanced([0.1, -0.0, 7.0]), [0.1, 0.0, 7.0]);
    }

    #[test]
    fn the_inverse_is_one() {
        for i in 0..3 {
            let unit: [f64; 3] = std::array::from_fn(|j| f64::from(u8::from(i == j)));
            let back = apply(&BACK, apply(&BRADFORD, unit));
            assert!((0..3).all(|j| (back[j] - unit[j]).abs() < 1e-6), "{back:?}");
            let back = xyz_to_rgb(apply(&XYZ, unit));
            assert!((0..3).all(|j| (back[j] - unit[j]).abs() < 1e-6), "{back:?}");
        }
    }
}
