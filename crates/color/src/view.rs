use crate::linear_to_srgb;

/// How linear radiance becomes what a display shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ViewTransform {
    /// Filmic: bright colours lose saturation instead of clipping. AgX (Troy Sobotka 2022, the "base" look), 16.5
    /// stops wide; a radiance of 0.18 is shown as one half.
    #[default]
    Agx,
    /// The colours as they are, clipped at 1 (IEC 61966-2-1).
    Srgb,
}

/// log₂ of the linear values that AgX shows as black and as white: 10 stops below and 6.5 above middle grey, 0.18.
const AGX_RANGE: [f64; 2] = [-12.47393, 4.026069];

/// AgX's inset: linear Rec. 709 to primaries drawn inward, so that no pure primary stays pure.
const AGX_INSET: [[f64; 3]; 3] = [
    [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
    [0.0423756549057051, 0.0784336, 0.879142973793104],
];

/// The inverse of [`AGX_INSET`], applied to the encoded values.
const AGX_OUTSET: [[f64; 3]; 3] = [
    [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
];

impl ViewTransform {
    /// All view transforms.
    pub const ALL: [Self; 2] = [Self::Agx, Self::Srgb];

    /// The name in scene files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Agx => "agx",
            Self::Srgb => "srgb",
        }
    }

    /// The view transform of that [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|v| v.name() == name)
    }

    /// sRGB-encoded display colour in [0, 1] of linear Rec. 709 radiance times 2^`exposure_ev`. Negative values and
    /// NaN count as 0, +∞ as the brightest.
    pub fn apply(self, rgb: [f32; 3], exposure_ev: f32) -> [f32; 3] {
        let scale = f64::from(exposure_ev).exp2();
        let exposed = rgb.map(|v| {
            let v = f64::from(v) * scale;
            if v.is_nan() { 0.0 } else { v.clamp(0.0, 1e30) }
        });
        match self {
            Self::Agx => agx(exposed).map(|v| v.clamp(0.0, 1.0) as f32),
            Self::Srgb => exposed.map(|v| linear_to_srgb(v.min(1.0) as f32).clamp(0.0, 1.0)),
        }
    }
}

fn agx(rgb: [f64; 3]) -> [f64; 3] {
    let [low, high] = AGX_RANGE;
    let curved =
        times(&AGX_INSET, rgb).map(|v| agx_contrast((v.log2().clamp(low, high) - low) / (high - low)));
    times(&AGX_OUTSET, curved)
}

/// AgX's curve on [0, 1]: a line of slope 2 through the pivot (10/16.5, 1/2), where middle grey lies, bent at both
/// ends by y = t/(1 + |t|ᵖ)^(1/p), with p = 3 below the pivot and 3.25 above, scaled to reach (0, 0) and (1, 1).
fn agx_contrast(x: f64) -> f64 {
    const SLOPE: f64 = 2.0;
    const PIVOT: [f64; 2] = [10.0 / 16.5, 0.5];
    let (power, reach) = if x < PIVOT[0] { (3.0, PIVOT) } else { (3.25, [1.0 - PIVOT[0], 1.0 - PIVOT[1]]) };
    // The scale s for which s·y(slope·reach.x/s) = reach.y.
    let end: f64 = SLOPE * reach[0];
    let scale = end / ((end / reach[1]).powf(power) - 1.0).powf(1.0 / power);
    let t = SLOPE * (x - PIVOT[0]) / scale;
    PIVOT[1] + scale * t / (1.0 + t.abs().powf(power)).powf(1.0 / power)
}

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_is_that_of_the_published_fit() {
        // The well-known polynomial of degree six that was fitted to AgX's table.
        let fit = |x: f64| {
            let c = [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5];
            c.iter().rev().fold(0.0, |sum, c| sum * x + c)
        };
        for i in 0..=100 {
            let x = f64::from(i) / 100.0;
            assert!((agx_contrast(x) - fit(x)).abs() < 0.006, "{x}: {} {}", agx_contrast(x), fit(x));
        }
        assert!(agx_contrast(0.0).abs() < 1e-12 && (agx_contrast(1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn outset_undoes_inset() {
        for c in 0..3 {
            let mut unit = [0.0; 3];
            unit[c] = 1.0;
            let back = times(&AGX_OUTSET, times(&AGX_INSET, unit));
            assert!((0..3).all(|i| (back[i] - unit[i]).abs() < 1e-9));
        }
    }

    #[test]
    fn greys_stay_grey_and_in_order() {
        for view in ViewTransform::ALL {
            let mut last = -1.0;
            for ev in -20..20 {
                let [r, g, b] = view.apply([0.18; 3], ev as f32);
                // AgX's published inset leaves greys grey to 10⁻⁴ in linear light.
                assert!((r - g).abs() < 5e-4 && (g - b).abs() < 5e-4, "{r} {g} {b}");
                assert!(g >= last && g <= 1.0);
                last = g;
            }
        }
        assert!((ViewTransform::Agx.apply([0.18; 3], 0.0)[1] - 0.5).abs() < 1e-3);
        assert!((ViewTransform::Srgb.apply([0.18; 3], 0.0)[1] - 0.461_356).abs() < 1e-5);
        assert_eq!(ViewTransform::Srgb.apply([0.045; 3], 2.0), ViewTransform::Srgb.apply([0.18; 3], 0.0));
    }

    #[test]
    fn bright_colours_fade_to_white() {
        let [r, g, b] = ViewTransform::Agx.apply([100.0, 0.0, 0.0], 0.0);
        assert!(r > 0.9 && g > 0.3 && b > 0.3, "{r} {g} {b}");
        assert_eq!(ViewTransform::Srgb.apply([100.0, 0.0, 0.0], 0.0), [1.0, 0.0, 0.0]);
        for view in ViewTransform::ALL {
            let shown = view.apply([f32::NAN, f32::INFINITY, -3.0], 1.0);
            assert!(shown.iter().all(|v| (0.0..=1.0).contains(v)), "{shown:?}");
        }
    }
}
