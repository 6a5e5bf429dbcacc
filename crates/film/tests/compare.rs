//! Figures of comparison against an independent program (numpy, and NVIDIA's flip-evaluator 1.7) on a made picture.

#![allow(clippy::unwrap_used)] // Helpers of tests are not seen as tests.

use nephroid_film::{CompareError, RgbImage, compare, difference};

const WIDTH: usize = 56;
const HEIGHT: usize = 40;

/// A number in [0, 1) for each index: the finaliser of MurmurHash3.
fn hash(index: usize) -> f64 {
    let mut h = (index as u32).wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    f64::from((h ^ (h >> 16)) >> 8) / 16_777_216.0
}

/// The reference, and an image with noise, a band that is too bright, a firefly and two pixels that are not finite.
fn pictures() -> (RgbImage, RgbImage) {
    let (mut reference, mut image) = (Vec::new(), Vec::new());
    for i in 0..WIDTH * HEIGHT {
        let (x, y) = (i % WIDTH, i / WIDTH);
        let disc = if x.abs_diff(20).pow(2) + y.abs_diff(18).pow(2) < 64 { 2.0 } else { 0.0 };
        let band = if x > 40 { 0.25 } else { 0.0 };
        let r: [f64; 3] =
            std::array::from_fn(|c| (1 + x * y % 7) as f64 * 0.125 + ((c + 1) * x) as f64 / 64.0 + disc);
        let v: [f64; 3] = std::array::from_fn(|c| r[c] * (1.0 + 0.5 * (hash(i * 3 + c) - 0.5)) + band);
        reference.push(r.map(|v| v as f32));
        image.push(v.map(|v| v as f32));
    }
    image[3 * WIDTH + 5] = [500.0, 400.0, 300.0];
    image[7 * WIDTH + 9][1] = f32::NAN;
    image[30 * WIDTH + 50][0] = f32::INFINITY;
    (RgbImage::new(WIDTH, HEIGHT, image).unwrap(), RgbImage::new(WIDTH, HEIGHT, reference).unwrap())
}

fn assert_close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} {expected}");
}

#[test]
fn figures_agree_with_another_program() {
    let (image, reference) = pictures();
    let all = compare(&image, &reference, None).unwrap();
    assert_close(all.relmse, 506.103651458432);
    assert_close(all.relmse999, 0.027291561723001304);
    assert_close(all.bias, 0.16636497732505506);
    assert_close(all.block_median.unwrap(), 0.03523940476063122);
    assert_close(all.block_max.unwrap(), 2.1636823213897274);
    assert_eq!(all.nonfinite, 2);
    // The other program computes in single precision.
    assert!((all.flip - 0.13885998725891113).abs() < 2e-5, "{}", all.flip);

    let mask: Vec<bool> =
        (0..WIDTH * HEIGHT).map(|i| !(i % WIDTH + i / WIDTH).is_multiple_of(5) && i % WIDTH > 6).collect();
    let masked = compare(&image, &reference, Some(&mask)).unwrap();
    assert_close(masked.relmse, 0.02905623629704831);
    assert_close(masked.relmse999, 0.028401574305949164);
    assert_close(masked.bias, 0.049372373312492446);
    assert_close(masked.block_median.unwrap(), 0.033617547866705504);
    assert_close(masked.block_max.unwrap(), 0.06205610851314838);
}

#[test]
fn a_picture_equals_itself() {
    let (_, reference) = pictures();
    let same = compare(&reference, &reference, None).unwrap();
    assert_eq!((same.relmse, same.bias, same.block_max, same.flip), (0.0, 0.0, Some(0.0), 0.0));
}

#[test]
fn refusals() {
    let (image, _) = pictures();
    let other = RgbImage::new(2, 1, vec![[0.0; 3]; 2]).unwrap();
    assert!(matches!(compare(&image, &other, None), Err(CompareError::Size { .. })));
    assert!(matches!(compare(&other, &other, Some(&[true])), Err(CompareError::Size { .. })));
    assert_eq!(compare(&other, &other, Some(&[false; 2])), Err(CompareError::Empty));
    assert!(difference(&image, &other).is_err());
    // Too small for a block, yet compared.
    assert_eq!(compare(&other, &other, None).unwrap().block_median, None);
    assert!(RgbImage::new(2, 2, vec![[0.0; 3]; 3]).is_none());
    let mask = RgbImage::new(2, 1, vec![[0.0, 1.0, 0.6], [1.5, 0.0, 0.0]]).unwrap();
    assert_eq!(mask.to_mask(), [true, false]);
}

#[test]
fn the_sheet_shows_what_is_too_bright_in_red() {
    let reference = RgbImage::new(3, 1, vec![[0.2; 3], [0.5; 3], [1.0; 3]]).unwrap();
    let image = RgbImage::new(3, 1, vec![[0.305; 3], [0.5; 3], [0.495; 3]]).unwrap();
    let sheet = difference(&image, &reference).unwrap();
    assert_eq!(sheet.len(), 9);
    // Differences of +1/2, 0 and −1/2 of r + 0.01.
    assert_eq!(sheet[6..], [[128, 0, 0], [0, 0, 0], [0, 0, 128]]);
    // The 95th percentile, 0.95, becomes 0.8; 0.5 becomes 0.42105, encoded 0.6815.
    assert_eq!((sheet[1], sheet[4]), ([174; 3], [174; 3]));
}
