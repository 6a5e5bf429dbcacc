//! FLIP for images shown on a display: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström & Fairchild 2020,
//! *FLIP: A Difference Evaluator for Alternating Images*. Sections and equations are that paper's.

use color::srgb_to_linear;

/// Pixels per degree of visual angle at the paper's viewing conditions (section 4.1): 0.7 m from a display 0.7 m and
/// 3840 pixels wide.
const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

/// Exponent of the colour difference (section 4.1.3).
const QC: f64 = 0.7;
/// Share of the greatest colour difference that is mapped to [`PT`] (section 4.1.3).
const PC: f64 = 0.4;
/// See [`PC`].
const PT: f64 = 0.95;
/// Exponent of the feature difference (section 4.2).
const QF: f64 = 0.5;
/// Width of the feature detectors, in degrees (section 4.2).
const FEATURE_WIDTH: f64 = 0.082;

/// Rows of the matrix from linear Rec. 709 to CIE XYZ.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [0.412_386_563_252_992, 0.357_591_490_920_625, 0.180_450_491_203_563_6],
    [0.212_636_821_677_324, 0.715_182_981_841_251, 0.072_180_196_481_425_4],
    [0.019_330_620_152_484, 0.119_197_163_640_208, 0.950_372_587_005_435],
];

/// Three values for each pixel, as planes.
type Planes = [Vec<f64>; 3];

/// Mean FLIP difference of two pictures of sRGB-encoded colours in [0, 1], row by row: 0 (equal) to 1. Viewed at the
/// paper's default, 67 pixels a degree. 0 for empty pictures and where the lengths are not width × height.
pub fn flip(width: usize, height: usize, reference: &[[f32; 3]], test: &[[f32; 3]]) -> f64 {
    let count = width * height;
    if count == 0 || reference.len() != count || test.len() != count {
        return 0.0;
    }
    let (reference, test) = (opponent(reference), opponent(test));
    let colour = colour_difference(width, height, &reference, &test);
    let feature = feature_difference(width, height, &reference[0], &test[0]);
    // Eq. 8.
    let sum: f64 = colour.iter().zip(&feature).map(|(c, f)| c.powf(1.0 - f)).sum();
    sum / count as f64
}

/// Luminance and two colour-opponent channels, Y Cx Cz (section 4.1.1, eq. 1).
fn opponent(srgb: &[[f32; 3]]) -> Planes {
    let mut planes: Planes = Default::default();
    for pixel in srgb {
        let [x, y, z] = relative_xyz(pixel.map(|v| f64::from(srgb_to_linear(v))));
        let values = [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)];
        planes.iter_mut().zip(values).for_each(|(plane, v)| plane.push(v));
    }
    planes
}

/// CIE XYZ as multiples of the white's.
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    XYZ_FROM_RGB.map(|row| dot(row, rgb) / row.iter().sum::<f64>())
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Colour difference in [0, 1] after the eye's filtering (section 4.1).
fn colour_difference(width: usize, height: usize, reference: &Planes, test: &Planes) -> Vec<f64> {
    let rgb_from_xyz = inverse(XYZ_FROM_RGB);
    let filtered = [reference, test].map(|planes| spatially_filtered(width, height, planes));
    let hunt = |planes: &Planes, i: usize| {
        // Back to linear RGB, into the display's range, to L*a*b* with Hunt's effect (section 4.1.2).
        let y = (planes[0][i] + 16.0) / 116.0;
        let relative = [planes[1][i] / 500.0 + y, y, y - planes[2][i] / 200.0];
        let xyz = std::array::from_fn(|c| relative[c] * XYZ_FROM_RGB[c].iter().sum::<f64>());
        hunt_lab(rgb_from_xyz.map(|row| dot(row, xyz).clamp(0.0, 1.0)))
    };
    // Between the display's green and blue (section 4.1.3).
    let greatest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(QC);
    (0..width * height)
        .map(|i| {
            let difference = hyab(hunt(&filtered[0], i), hunt(&filtered[1], i)).powf(QC);
            let knee = PC * greatest;
            if difference < knee {
                PT / knee * difference
            } else {
                PT + (difference - knee) / (greatest - knee) * (1.0 - PT)
            }
        })
        .collect()
}

/// L*a*b* with a* and b* scaled by L*/100 (section 4.1.2).
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| {
        const DELTA: f64 = 6.0 / 29.0;
        if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

/// HyAB distance (section 4.1.3, eq. 4).
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Filters by the contrast sensitivity of each channel (section 4.1.1, table 1).
fn spatially_filtered(width: usize, height: usize, planes: &Planes) -> Planes {
    // (a, b) of the sums of Gaussians a·√(π/b)·exp(−π²x²/b), x in degrees.
    const TERMS: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
    let pi2 = std::f64::consts::PI.powi(2);
    let radius = (3.0 * (0.04 / (2.0 * pi2)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    std::array::from_fn(|channel| {
        let terms: Vec<(f64, Vec<f64>)> = TERMS[channel]
            .iter()
            .map(|&(a, b)| {
                let kernel: Vec<f64> = (-radius..=radius)
                    .map(|x| (-pi2 * (f64::from(x) / PIXELS_PER_DEGREE).powi(2) / b).exp())
                    .collect();
                (a * (std::f64::consts::PI / b).sqrt(), kernel)
            })
            .collect();
        let total: f64 = terms.iter().map(|(a, k)| a * k.iter().sum::<f64>().powi(2)).sum();
        let mut sum = vec![0.0; width * height];
        for (a, kernel) in &terms {
            let blurred = convolved(width, height, &planes[channel], kernel, kernel);
            sum.iter_mut().zip(&blurred).for_each(|(s, v)| *s += a / total * v);
        }
        sum
    })
}

/// Difference of edges and points in [0, 1] (section 4.2).
fn feature_difference(width: usize, height: usize, reference: &[f64], test: &[f64]) -> Vec<f64> {
    let sd = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * sd).ceil() as i32;
    let taps = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { (-radius..=radius).map(|x| f(f64::from(x))).collect() };
    let gauss = |x: f64| (-x * x / (2.0 * sd * sd)).exp();
    let blur = balanced(taps(&gauss));
    let edge = balanced(taps(&|x| -x * gauss(x)));
    let point = balanced(taps(&|x| (x * x / (sd * sd) - 1.0) * gauss(x)));
    let features = |plane: &[f64]| -> [Vec<f64>; 2] {
        let light: Vec<f64> = plane.iter().map(|y| (y + 16.0) / 116.0).collect();
        [&edge, &point].map(|kernel| {
            let across = convolved(width, height, &light, kernel, &blur);
            let down = convolved(width, height, &light, &blur, kernel);
            across.iter().zip(&down).map(|(a, d)| a.hypot(*d)).collect()
        })
    };
    let (a, b) = (features(reference), features(test));
    (0..width * height)
        .map(|i| {
            // Eq. 6 and 7.
            let difference = (a[0][i] - b[0][i]).abs().max((a[1][i] - b[1][i]).abs());
            (difference / std::f64::consts::SQRT_2).powf(QF)
        })
        .collect()
}

/// Scales the positive taps to the sum 1 and the negative ones to −1.
fn balanced(mut taps: Vec<f64>) -> Vec<f64> {
    let positive: f64 = taps.iter().filter(|v| **v > 0.0).sum();
    let negative: f64 = -taps.iter().filter(|v| **v < 0.0).sum::<f64>();
    taps.iter_mut().for_each(|v| *v /= if *v > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) });
    taps
}

/// Convolution with `across` along rows and `down` along columns; the picture's edge is repeated outside.
fn convolved(width: usize, height: usize, plane: &[f64], across: &[f64], down: &[f64]) -> Vec<f64> {
    let mut rows = vec![0.0; width * height];
    let mut out = rows.clone();
    let inside =
        |i: usize, tap: usize, taps: usize, len: usize| (i + tap).saturating_sub(taps / 2).min(len - 1);
    for y in 0..height {
        let row = &plane[y * width..(y + 1) * width];
        for x in 0..width {
            let sum = across.iter().enumerate().map(|(t, k)| k * row[inside(x, t, across.len(), width)]);
            rows[y * width + x] = sum.sum();
        }
    }
    for y in 0..height {
        for (t, k) in down.iter().enumerate() {
            let from = inside(y, t, down.len(), height) * width;
            let (source, target) = (&rows[from..from + width], &mut out[y * width..(y + 1) * width]);
            target.iter_mut().zip(source).for_each(|(o, v)| *o += k * v);
        }
    }
    out
}

/// Inverse by cofactors.
fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * minor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / determinant))
}
