//! How far a picture is from a reference, by blocks.

/// Pixels along the side of a block.
const SIDE: usize = 16;

/// What blocks of 16 × 16 pixels say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Median over blocks of the ratio of their means (of all channels), picture over reference.
    pub median: f64,
    /// Root mean square of the blocks' ratios about the median, of those within the middle nine tenths.
    pub spread: f64,
    /// Mean of ((picture − reference) / reference)² over pixels, with 1 % of the reference's mean added below, without the
    /// greatest tenth of a per cent.
    pub rel_mse: f64,
}

/// Compares pictures of one size, row by row; blocks darker than a thousandth of the mean do not count. `None`: no block counts.
pub fn agreement(width: usize, picture: &[[f32; 3]], reference: &[[f32; 3]]) -> Option<Agreement> {
    let height = picture.len() / width.max(1);
    let mean = |pixels: &[[f32; 3]]| pixels.as_flattened().iter().map(|x| f64::from(*x)).sum::<f64>();
    let floor = mean(reference) / (3 * reference.len().max(1)) as f64;
    let mut ratios = Vec::new();
    for y in (0..height).step_by(SIDE) {
        for x in (0..width).step_by(SIDE) {
            let block = |pixels: &[[f32; 3]]| {
                let rows = (y..(y + SIDE).min(height))
                    .map(|row| row * width + x..row * width + (x + SIDE).min(width));
                let (sum, count) = rows
                    .fold((0.0, 0), |(sum, count), r| (sum + mean(&pixels[r.clone()]), count + 3 * r.len()));
                sum / count.max(1) as f64
            };
            let (ours, theirs) = (block(picture), block(reference));
            if theirs > 1e-3 * floor {
                ratios.push(ours / theirs);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let median = *ratios.get(ratios.len() / 2)?;
    let cut = ratios.len() / 20;
    let middle = &ratios[cut..ratios.len() - cut];
    let spread = (middle.iter().map(|r| (r - median).powi(2)).sum::<f64>() / middle.len() as f64).sqrt();
    Some(Agreement { median, spread, rel_mse: rel_mse(picture, reference, floor) })
}

fn rel_mse(picture: &[[f32; 3]], reference: &[[f32; 3]], mean: f64) -> f64 {
    let pairs = picture.as_flattened().iter().zip(reference.as_flattened());
    let error =
        |(p, r): (&f32, &f32)| ((f64::from(*p) - f64::from(*r)) / (f64::from(*r) + 0.01 * mean)).powi(2);
    let mut errors: Vec<f64> = pairs.map(error).collect();
    errors.sort_by(f64::total_cmp);
    errors.truncate(errors.len() - errors.len() / 1000);
    errors.iter().sum::<f64>() / errors.len().max(1) as f64
}

/// Means over squares of `by` pixels a side; what does not fill a square is left out.
pub fn shrunk(width: usize, pixels: &[[f32; 3]], by: usize) -> (usize, Vec<[f32; 3]>) {
    let (w, h) = (width / by, pixels.len() / width / by);
    let mut small = Vec::with_capacity(w * h);
    for y in 0..h {
        for x in 0..w {
            let mut sum = [0f64; 3];
            for j in 0..by {
                for pixel in &pixels[(y * by + j) * width + x * by..][..by] {
                    sum.iter_mut().zip(pixel).for_each(|(s, p)| *s += f64::from(*p));
                }
            }
            small.push(sum.map(|s| (s / (by * by) as f64) as f32));
        }
    }
    (w, small)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brighter_picture_is_brighter_by_its_factor() {
        let reference: Vec<[f32; 3]> = (0..40 * 33).map(|i| [1.0 + (i % 7) as f32, 2.0, 0.5]).collect();
        let picture: Vec<[f32; 3]> = reference.iter().map(|p| p.map(|x| 1.03 * x)).collect();
        let found = agreement(40, &picture, &reference).unwrap();
        assert!((found.median - 1.03).abs() < 1e-6 && found.spread < 1e-6, "{found:?}");
        assert!((found.rel_mse - 9e-4).abs() < 5e-5, "{found:?}");
        assert_eq!(agreement(40, &picture, &vec![[0.0; 3]; 40 * 33]), None);
    }

    #[test]
    fn a_shrunk_picture_keeps_its_mean() {
        let pixels: Vec<[f32; 3]> = (0..24).map(|i| [i as f32, 1.0, 0.0]).collect();
        let (w, small) = shrunk(6, &pixels, 2);
        assert_eq!((w, small.len()), (3, 6));
        assert_eq!(small[0], [(0.0 + 1.0 + 6.0 + 7.0) / 4.0, 1.0, 0.0]);
        assert_eq!(small.iter().map(|p| p[0]).sum::<f32>() / 6.0, 11.5);
    }
}
