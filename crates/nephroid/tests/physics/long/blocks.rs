//! z-tests of pictures by blocks of 16 × 16 pixels, against another picture whose noise is known.

use nephroid::RgbImage;
use testkit::{Moments, significance, welch_p_value};

use crate::support::PLANTED;

/// Edge of a block.
const EDGE: usize = 16;
/// Chance that a right picture fails because of one of its blocks.
const FAMILY: f64 = 1e-3;
/// Share of the blocks in which an error of 2 % must be found.
const POWER: f64 = 0.5;

/// Means of luminance over each block, of the pixels that count; blocks of which less than half counts are left out.
pub struct Blocks {
    pub means: Vec<f64>,
    /// Pixels that count, over those of a block.
    pub shares: Vec<f64>,
}

/// The blocks of a picture of 256 × 256 pixels.
pub fn blocks(picture: &RgbImage, mask: Option<&[bool]>) -> Blocks {
    let (width, height) = (picture.width(), picture.height());
    let mut out = Blocks { means: Vec::new(), shares: Vec::new() };
    for top in (0..height).step_by(EDGE) {
        for left in (0..width).step_by(EDGE) {
            let (mut sum, mut count) = (0.0, 0usize);
            for i in (0..EDGE * EDGE).map(|k| (top + k / EDGE) * width + left + k % EDGE) {
                if mask.is_none_or(|mask| mask[i]) {
                    sum += color::luminance_f64(picture.pixels()[i].map(f64::from));
                    count += 1;
                }
            }
            if 2 * count >= EDGE * EDGE {
                out.means.push(sum / count as f64);
                out.shares.push(count as f64 / (EDGE * EDGE) as f64);
            }
        }
    }
    out
}

/// A value whose standard error is known.
fn known(mean: f64, error: f64) -> Moments {
    let n = 1u64 << 40;
    Moments { n, mean, m2: (error * n as f64).powi(2) }
}

/// Fails unless every block of the mean of independent renders is that of the reference within the noise of both, and
/// unless the same test finds an error of 2 % in most of them. `error`: standard error of a block of the reference, of
/// its radiance. `tolerance`: the bias that is owned up to, of a block's radiance.
#[track_caller]
pub fn assert_blocks(
    what: &str,
    renders: &[RgbImage],
    reference: &RgbImage,
    mask: Option<&[bool]>,
    error: f64,
    tolerance: f64,
) {
    let expected = blocks(reference, mask);
    let each: Vec<Vec<f64>> = renders.iter().map(|r| blocks(r, mask).means).collect();
    let found: Vec<Moments> =
        (0..expected.means.len()).map(|b| Moments::of(each.iter().map(|means| means[b]))).collect();
    let p = |b: usize, factor: f64| {
        let (mean, share) = (expected.means[b], expected.shares[b]);
        let m = Moments { mean: found[b].mean * factor, m2: found[b].m2 * factor * factor, ..found[b] };
        let slack = tolerance * mean;
        let m = Moments { mean: m.mean - (m.mean - mean).clamp(-slack, slack), ..m };
        if m.mean == mean {
            1.0
        } else {
            welch_p_value(&m, &known(mean, error * mean / share.sqrt())).unwrap()
        }
    };
    let level = significance(FAMILY, found.len());
    let errors = || found.iter().zip(&expected.means).map(|(m, r)| m.mean / r - 1.0);
    let total = found.iter().map(|m| m.mean).sum::<f64>() / expected.means.iter().sum::<f64>() - 1.0;
    let worst = (0..found.len()).min_by(|&a, &b| p(a, 1.0).total_cmp(&p(b, 1.0))).unwrap();
    let noise =
        (found.iter().zip(&expected.means).map(|(m, r)| (m.standard_error() / r).powi(2)).sum::<f64>()
            / found.len() as f64)
            .sqrt();
    let rms = (errors().map(|e| e * e).sum::<f64>() / found.len() as f64).sqrt();
    let report = format!(
        "{what}: {} blocks, reference {:.4} in the worst, number {worst}, all {:+.3} %, rms {:.3} % (noise {:.3} %), worst {:+.3} % ± {:.3} %, p = {:.1e} of {level:.1e}",
        found.len(),
        expected.means[worst],
        100.0 * total,
        100.0 * rms,
        100.0 * noise,
        100.0 * (found[worst].mean / expected.means[worst] - 1.0),
        100.0 * found[worst].standard_error() / expected.means[worst],
        p(worst, 1.0),
    );
    println!("{report}");
    assert!(p(worst, 1.0) >= level, "{report}");
    for factor in [PLANTED, 1.0 / PLANTED] {
        let seen = (0..found.len()).filter(|&b| p(b, factor) < 0.05).count();
        assert!(
            seen as f64 >= POWER * found.len() as f64,
            "{report}: a factor of {factor:.3} is seen in {seen} blocks only"
        );
    }
}
