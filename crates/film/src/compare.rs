use std::fmt;

use color::linear_to_srgb;

use crate::RgbImage;

/// Edge of the blocks of [`Comparison::block_median`], in pixels.
const BLOCK: usize = 16;

/// How far an image is from a reference, in linear radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean over pixels and channels of (x − r)²/(r² + 0.01).
    pub relmse: f64,
    /// The same over pixels without the worst 0.1 %: fireflies apart.
    pub relmse999: f64,
    /// Σx/Σr − 1: energy lost or gained.
    pub bias: f64,
    /// Median over blocks of 16 × 16 pixels (whole ones, at least half of which counts) of
    /// |mean x − mean r|/(mean r + 0.01); none where there is no such block.
    pub block_median: Option<f64>,
    /// Maximum of the same.
    pub block_max: Option<f64>,
    /// Pixels of the image with a value that is not finite; they count as black.
    pub nonfinite: u64,
    /// Mean of the FLIP difference ([`crate::flip`]) of the two as [`difference`] shows them, whole pictures; 0 for
    /// equal, at most 1.
    pub flip: f64,
}

/// What [`compare`] refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompareError {
    /// Sizes (width, height) differ.
    Size {
        /// The reference's.
        reference: [usize; 2],
        /// The image's, or the mask's number of pixels and 1.
        image: [usize; 2],
    },
    /// No pixel counts.
    Empty,
}

impl fmt::Display for CompareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { reference: [rw, rh], image: [w, h] } => {
                write!(f, "sizes differ: {w}x{h} pixels, the reference has {rw}x{rh}")
            }
            Self::Empty => {
                write!(f, "no pixel to compare: the picture is empty or the mask covers all of it")
            }
        }
    }
}

impl std::error::Error for CompareError {}

/// Compares an image with a reference, over the pixels where `mask` holds.
///
/// # Errors
/// Where sizes differ or no pixel counts.
pub fn compare(
    image: &RgbImage,
    reference: &RgbImage,
    mask: Option<&[bool]>,
) -> Result<Comparison, CompareError> {
    check_size(image, reference)?;
    let count = reference.pixels().len();
    if let Some(mask) = mask
        && mask.len() != count
    {
        let size = [reference.width(), reference.height()];
        return Err(CompareError::Size { reference: size, image: [mask.len(), 1] });
    }
    let keep = |i: usize| mask.is_none_or(|m| m[i]);
    let (x, nonfinite) = finite(image);
    let r: Vec<[f64; 3]> = reference.pixels().iter().map(|p| p.map(f64::from)).collect();
    let mut errors: Vec<f64> = (0..count)
        .filter(|&i| keep(i))
        .map(|i| mean(std::array::from_fn(|c| (x[i][c] - r[i][c]).powi(2) / (r[i][c].powi(2) + 0.01))))
        .collect();
    if errors.is_empty() {
        return Err(CompareError::Empty);
    }
    errors.sort_by(f64::total_cmp);
    let trimmed = &errors[..((errors.len() as f64 * 0.999) as usize).max(1)];
    let total = |pixels: &[[f64; 3]]| -> f64 {
        pixels.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, p)| p.iter().sum::<f64>()).sum()
    };
    let blocks = local_bias(&x, &r, reference.width(), reference.height(), keep);
    let scale = display_scale(reference);
    Ok(Comparison {
        relmse: errors.iter().sum::<f64>() / errors.len() as f64,
        relmse999: trimmed.iter().sum::<f64>() / trimmed.len() as f64,
        bias: total(&x) / total(&r) - 1.0,
        block_median: median(&blocks),
        block_max: blocks.last().copied(),
        nonfinite,
        flip: crate::flip(
            reference.width(),
            reference.height(),
            &shown(reference.pixels(), scale),
            &shown(image.pixels(), scale),
        ),
    })
}

/// A sheet of three pictures side by side, sRGB-encoded (3 · width × height): reference, image, and
/// (x − r)/(r + 0.01) of their channel means, from −1 (blue: too dark) to 1 (red: too bright). The first two are
/// scaled so that the reference's 95th percentile is 0.8.
///
/// # Errors
/// Where sizes differ or the pictures are empty.
pub fn difference(image: &RgbImage, reference: &RgbImage) -> Result<Vec<[u8; 3]>, CompareError> {
    check_size(image, reference)?;
    if reference.pixels().is_empty() {
        return Err(CompareError::Empty);
    }
    let scale = display_scale(reference);
    let bytes = |p: [f32; 3]| p.map(|v| (v * 255.0 + 0.5) as u8);
    let (x, _) = finite(image);
    let (left, middle) = (shown(reference.pixels(), scale), shown(image.pixels(), scale));
    let mut sheet = Vec::with_capacity(3 * x.len());
    for row in 0..reference.height() {
        let row = row * reference.width()..(row + 1) * reference.width();
        sheet.extend(left[row.clone()].iter().chain(&middle[row.clone()]).map(|&p| bytes(p)));
        sheet.extend(row.map(|i| {
            let r = mean(reference.pixels()[i].map(f64::from));
            let relative = ((mean(x[i]) - r) / (r + 0.01)) as f32;
            bytes([relative.clamp(0.0, 1.0), 0.0, (-relative).clamp(0.0, 1.0)])
        }));
    }
    Ok(sheet)
}

fn check_size(image: &RgbImage, reference: &RgbImage) -> Result<(), CompareError> {
    let size = |i: &RgbImage| [i.width(), i.height()];
    if size(image) == size(reference) {
        return Ok(());
    }
    Err(CompareError::Size { reference: size(reference), image: size(image) })
}

fn mean(rgb: [f64; 3]) -> f64 {
    (rgb[0] + rgb[1] + rgb[2]) / 3.0
}

/// The pixels, those with a value that is not finite as black, and the number of these.
fn finite(image: &RgbImage) -> (Vec<[f64; 3]>, u64) {
    let mut bad = 0;
    let pixels = image.pixels().iter().map(|p| {
        if p.iter().all(|v| v.is_finite()) {
            return p.map(f64::from);
        }
        bad += 1;
        [0.0; 3]
    });
    (pixels.collect(), bad)
}

/// Relative difference of the means of each block, ascending.
fn local_bias(
    x: &[[f64; 3]],
    r: &[[f64; 3]],
    width: usize,
    height: usize,
    keep: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let mut blocks = Vec::new();
    for by in 0..height / BLOCK {
        for bx in 0..width / BLOCK {
            let (mut a, mut b, mut count) = (0.0, 0.0, 0usize);
            for y in by * BLOCK..(by + 1) * BLOCK {
                let row = y * width + bx * BLOCK;
                for i in (row..row + BLOCK).filter(|&i| keep(i)) {
                    a += mean(x[i]);
                    b += mean(r[i]);
                    count += 1;
                }
            }
            if 2 * count >= BLOCK * BLOCK {
                let (a, b) = (a / count as f64, b / count as f64);
                blocks.push((a - b).abs() / (b + 0.01));
            }
        }
    }
    blocks.sort_by(f64::total_cmp);
    blocks
}

fn median(sorted: &[f64]) -> Option<f64> {
    let n = sorted.len();
    Some(0.5 * (sorted.get(n.checked_sub(1)? / 2)? + sorted.get(n / 2)?))
}

/// The factor that brings the 95th percentile (linear between ranks) of the reference's channel means to 0.8.
fn display_scale(reference: &RgbImage) -> f64 {
    let mut means: Vec<f64> = reference.pixels().iter().map(|p| mean(p.map(f64::from))).collect();
    means.sort_by(f64::total_cmp);
    let rank = 0.95 * means.len().saturating_sub(1) as f64;
    let (low, high) = (means.get(rank as usize), means.get(rank.ceil() as usize));
    let percentile = match (low, high) {
        (Some(low), Some(high)) => low + (high - low) * rank.fract(),
        _ => 0.0,
    };
    0.8 / percentile.max(1e-9)
}

/// Pixels times `scale`, clipped, sRGB-encoded; with a value that is not finite: black.
fn shown(pixels: &[[f32; 3]], scale: f64) -> Vec<[f32; 3]> {
    let encode = |v: f32| linear_to_srgb((f64::from(v) * scale).clamp(0.0, 1.0) as f32);
    let shown = |p: &[f32; 3]| if p.iter().all(|v| v.is_finite()) { p.map(encode) } else { [0.0; 3] };
    pixels.iter().map(shown).collect()
}
