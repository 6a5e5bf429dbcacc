use crate::linear_to_srgb;

/// How linear radiance becomes what a display shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ViewTransform {
    /// Filmic: bright colours lose saturation instead of clipping. AgX (Troy Sobotka 2022, the "base" look), 16.5
    /// stops wide; a radiance of 0.18 is shown as one half.
    Agx,
    /// AgX with the "punchy" look of its author: power 1.35, then saturation 1.4. The default: in plain AgX gold and
    /// pools look grey.
    #[default]
    AgxPunchy,
    /// The shape of ACES' reference rendering, by Stephen Hill's fit (2016), scaled so that 0.18 is shown as 0.18.
    AcesLike,
    /// The colours as they are, clipped at 1 (IEC 61966-2-1).
    Srgb,
    /// Luminance as a colour of a scale, see [`false_colour`].
    FalseColour,
}

/// How bright a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// As the picture itself asks for.
    #[default]
    Auto,
    /// Radiance is multiplied by 2 to this power.
    Ev(f32),
}

impl Exposure {
    /// Least and greatest exposure that may be asked for, in EV.
    pub const RANGE: [f32; 2] = [-64.0, 64.0];
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
    pub const ALL: [Self; 5] = [Self::Agx, Self::AgxPunchy, Self::AcesLike, Self::Srgb, Self::FalseColour];

    /// The name in scene files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Agx => "agx",
            Self::AgxPunchy => "agx-punchy",
            Self::AcesLike => "aces-like",
            Self::Srgb => "srgb",
            Self::FalseColour => "false-colour",
        }
    }

    /// The view transform of that [`name`](Self::name); false-color is one too.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = if name == "false-color" { "false-colour" } else { name };
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
            Self::Agx => agx(exposed, |curved| curved).map(|v| v.clamp(0.0, 1.0) as f32),
            Self::AgxPunchy => agx(exposed, punchy).map(|v| v.clamp(0.0, 1.0) as f32),
            Self::AcesLike => aces(exposed).map(|v| linear_to_srgb(v as f32).clamp(0.0, 1.0)),
            Self::Srgb => exposed.map(|v| linear_to_srgb(v.min(1.0) as f32).clamp(0.0, 1.0)),
            Self::FalseColour => false_colour(scale_place(crate::luminance_f64(exposed))),
        }
    }
}

fn agx(rgb: [f64; 3], look: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 3] {
    let [low, high] = AGX_RANGE;
    let curved =
        times(&AGX_INSET, rgb).map(|v| agx_contrast((v.log2().clamp(low, high) - low) / (high - low)));
    times(&AGX_OUTSET, look(curved))
}

/// The "punchy" look: power, then saturation about the luma (ASC CDL 1.2).
fn punchy(curved: [f64; 3]) -> [f64; 3] {
    let powered = curved.map(|v| v.max(0.0).powf(1.35));
    let luma = crate::luminance_f64(powered);
    powered.map(|v| luma + 1.4 * (v - luma))
}

/// Linear Rec. 709 to the primaries of the fit, desaturated as ACES' reference rendering is.
const ACES_IN: [[f64; 3]; 3] =
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];

/// Back to linear Rec. 709.
const ACES_OUT: [[f64; 3]; 3] =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

/// Radiance is multiplied by it first, so that 0.18 stays 0.18.
const ACES_SCALE: f64 = 1.4552;

fn aces(rgb: [f64; 3]) -> [f64; 3] {
    let curved = times(&ACES_IN, rgb.map(|v| v.min(1e6) * ACES_SCALE))
        .map(|v| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081));
    times(&ACES_OUT, curved).map(|v| v.clamp(0.0, 1.0))
}

/// Stops below and above middle grey, 0.18, at the ends of the scale of [`ViewTransform::FalseColour`]: ten, three
/// decades.
pub const FALSE_COLOUR_STOPS: [f64; 2] = [-6.0, 4.0];

/// Where an exposed luminance lies on the scale: 0 at its lower end, 1 at its upper one.
fn scale_place(luminance: f64) -> f64 {
    let [low, high] = FALSE_COLOUR_STOPS;
    ((luminance.max(1e-30) / 0.18).log2() - low) / (high - low)
}

/// sRGB-encoded colour of a place on the scale: from black by blue, green, yellow and red to white.
pub fn false_colour(place: f64) -> [f32; 3] {
    const COLOURS: [[f64; 3]; 8] = [
        [0.02, 0.01, 0.08],
        [0.20, 0.10, 0.55],
        [0.10, 0.40, 0.90],
        [0.10, 0.72, 0.62],
        [0.45, 0.80, 0.20],
        [0.97, 0.83, 0.15],
        [0.90, 0.25, 0.10],
        [1.00, 0.93, 0.90],
    ];
    let last = COLOURS.len() - 1;
    let at = place.clamp(0.0, 1.0) * last as f64;
    let below = (at as usize).min(last - 1);
    let share = at - below as f64;
    std::array::from_fn(|c| (COLOURS[below][c] * (1.0 - share) + COLOURS[below + 1][c] * share) as f32)
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
        for view in ViewTransform::ALL.into_iter().filter(|v| *v != ViewTransform::FalseColour) {
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
        let aces = ViewTransform::AcesLike.apply([0.18; 3], 0.0)[1];
        assert!((aces - 0.461_356).abs() < 2e-3, "{aces}");
        assert!((ViewTransform::AgxPunchy.apply([0.18; 3], 0.0)[1] - 0.5f32.powf(1.35)).abs() < 2e-3);
        assert_eq!(ViewTransform::Srgb.apply([0.045; 3], 2.0), ViewTransform::Srgb.apply([0.18; 3], 0.0));
    }

    #[test]
    fn punchy_is_more_saturated() {
        let spread = |view: ViewTransform| {
            let [r, _, b] = view.apply([0.5, 0.3, 0.1], 0.0);
            r - b
        };
        assert!(spread(ViewTransform::AgxPunchy) > 1.2 * spread(ViewTransform::Agx));
    }

    #[test]
    fn the_scale_of_false_colours_moves_with_the_exposure() {
        let view = ViewTransform::FalseColour;
        assert_eq!(view.apply([0.18; 3], 0.0), view.apply([0.18 * 8.0; 3], -3.0));
        assert_eq!(view.apply([0.0; 3], 0.0), false_colour(0.0));
        assert_eq!(view.apply([0.18 * 17.0; 3], 0.0), false_colour(1.0));
        assert!((scale_place(0.18) - 0.6).abs() < 1e-9);
        // A step of a stop shows.
        let colours: Vec<_> = (-6..=4).map(|ev| view.apply([0.18; 3], ev as f32)).collect();
        for pair in colours.windows(2) {
            let step: f32 = (0..3).map(|c| (pair[0][c] - pair[1][c]).abs()).sum();
            assert!(step > 0.15, "{pair:?}");
        }
        assert_eq!(ViewTransform::from_name("false-color"), Some(view));
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
