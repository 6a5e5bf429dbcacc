use crate::stats::{Moments, welch_p_value, z_p_value};

/// Means over blocks of `block`² pixels of an image stored row by row, `channels` numbers a pixel (their mean is
/// taken): one value a block, row by row. Blocks at the right and lower edge may be smaller.
pub fn block_means(pixels: &[f32], width: usize, channels: usize, block: usize) -> Vec<f64> {
    let row = width * channels;
    let height = pixels.len() / row.max(1);
    let across = width.div_ceil(block);
    let mut blocks = vec![(0.0, 0usize); across * height.div_ceil(block)];
    for (y, line) in pixels.chunks_exact(row.max(1)).enumerate() {
        for (x, pixel) in line.chunks_exact(channels).enumerate() {
            let b = &mut blocks[y / block * across + x / block];
            b.0 += pixel.iter().map(|&v| f64::from(v)).sum::<f64>();
            b.1 += channels;
        }
    }
    blocks.into_iter().map(|(sum, n)| sum / n as f64).collect()
}

/// Outcome of [`compare_blocks`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockReport {
    /// Least p-value of a block, corrected for the number of blocks (Šidák).
    pub block_p_value: f64,
    /// Index of that block.
    pub worst: usize,
    /// p-value of the mean of the whole image: finds a small bias that all blocks share.
    pub mean_p_value: f64,
    /// Mean of the first over mean of the second.
    pub ratio: f64,
    /// Median over blocks of that ratio; blocks that are black in the second are left out.
    pub median_ratio: f64,
}

/// Compares two renderers by block means of independent renders: `a[i]` and `b[j]` are the [`block_means`] of one
/// render each. With a single `b` it is taken as exact. `None` where a side is empty, `a` has fewer than two
/// renders, or lengths differ.
pub fn compare_blocks(a: &[Vec<f64>], b: &[Vec<f64>]) -> Option<BlockReport> {
    let blocks = a.first()?.len();
    if a.len() < 2 || b.is_empty() || blocks == 0 || a.iter().chain(b).any(|r| r.len() != blocks) {
        return None;
    }
    let p_value = |x: &Moments, y: &Moments| {
        welch_p_value(x, y).unwrap_or_else(|| {
            // One exact value: Student's test is Welch's with a second variance of 0, of any count.
            welch_p_value(x, &Moments { n: 1 << 40, ..*y }).unwrap_or_else(|| z_p_value(f64::NAN))
        })
    };
    let column = |runs: &[Vec<f64>], i: usize| Moments::of(runs.iter().map(|r| r[i]));
    let whole = |runs: &[Vec<f64>]| Moments::of(runs.iter().map(|r| r.iter().sum::<f64>() / blocks as f64));
    let (mut least, mut worst) = (f64::INFINITY, 0);
    let mut ratios = Vec::new();
    for i in 0..blocks {
        let (x, y) = (column(a, i), column(b, i));
        let p = p_value(&x, &y);
        if p < least || p.is_nan() {
            (least, worst) = (if p.is_nan() { 0.0 } else { p }, i);
        }
        if y.mean > 0.0 {
            ratios.push(x.mean / y.mean);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let (x, y) = (whole(a), whole(b));
    Some(BlockReport {
        block_p_value: -(blocks as f64 * (-least).ln_1p()).exp_m1(),
        worst,
        mean_p_value: p_value(&x, &y),
        ratio: x.mean / y.mean,
        median_ratio: ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::{Domain, Sampler};

    /// Block means of noisy renders of a gradient: per pixel ±50 %, `factor` on the right half.
    fn renders(runs: u64, first: u64, factor: f32) -> Vec<Vec<f64>> {
        let render = |run: u64| {
            let mut s = Sampler::new(9, run, Domain::Other, 0);
            let pixels: Vec<f32> = (0..64 * 64 * 3)
                .map(|i| {
                    let x = i / 3 % 64;
                    let bias = if x >= 32 { factor } else { 1.0 };
                    (1.0 + x as f32 / 64.0) * (0.5 + s.next_1d()) * bias
                })
                .collect();
            block_means(&pixels, 64, 3, 16)
        };
        (first..first + runs).map(render).collect()
    }

    #[test]
    fn equal_images_pass_and_two_percent_fails() {
        let (a, b) = (renders(16, 0, 1.0), renders(16, 100, 1.0));
        let same = compare_blocks(&a, &b).unwrap();
        assert!(same.block_p_value > 0.01 && same.mean_p_value > 0.01, "{same:?}");
        let off = compare_blocks(&renders(16, 200, 1.02), &b).unwrap();
        assert!(off.block_p_value < 1e-3 && off.mean_p_value < 1e-4 && off.ratio > 1.005, "{off:?}");
        assert_eq!(off.worst % 4 / 2, 1, "on the right");
        let exact = vec![(0..16).map(|i| 1.0 + (f64::from(i % 4) * 16.0 + 7.5) / 64.0).collect()];
        let same = compare_blocks(&a, &exact).unwrap();
        assert!(same.block_p_value > 0.01 && (same.median_ratio - 1.0).abs() < 0.01, "{same:?}");
        let off = compare_blocks(&renders(16, 300, 0.98), &exact).unwrap();
        assert!(off.block_p_value < 1e-3, "{off:?}");
        assert_eq!(compare_blocks(&a[..1], &b), None);
    }

    #[test]
    fn blocks_at_the_edge() {
        let m = block_means(&[1.0, 1.0, 5.0, 1.0, 1.0, 7.0], 3, 1, 2);
        assert_eq!(m, [1.0, 6.0]);
    }
}
