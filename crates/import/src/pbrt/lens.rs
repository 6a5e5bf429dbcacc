//! Lens systems, as far as a thin lens stands for them.

/// Bytes of a lens file, at most.
pub(super) const MOST_BYTES: u64 = 1 << 20;

/// The focal length in mm of a system of rows of curvature radius, thickness, index behind and aperture, from the front, in mm; `None`
/// where the text has no such rows or the system no power.
///
/// Paraxial: each surface multiplies (height, slope) by a matrix, and −1 over the lower left element of the product is the focal length
/// (Gauss 1841).
pub(super) fn focal_length_mm(text: &str) -> Option<f64> {
    let words = text.lines().map(|l| l.split('#').next().unwrap_or_default()).flat_map(str::split_whitespace);
    let numbers: Vec<f64> = words.map(|w| w.parse().ok()).collect::<Option<_>>()?;
    if numbers.is_empty() || !numbers.len().is_multiple_of(4) {
        return None;
    }
    let (mut height, mut slope, mut index) = (1.0, 0.0, 1.0);
    for row in numbers.chunks_exact(4) {
        let (radius, thickness) = (row[0], row[1]);
        // A stop and air have the index 0 in these files.
        let behind = if row[2] == 0.0 { 1.0 } else { row[2] };
        if radius != 0.0 {
            slope = (index * slope - (behind - index) / radius * height) / behind;
            index = behind;
        }
        height += slope * thickness;
    }
    let focal = -1.0 / slope;
    (focal.is_finite() && focal != 0.0).then_some(focal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_systems() {
        // A plano-convex lens of n = 1.5: f = R/(n − 1); the plane is one of a great radius.
        let plano = focal_length_mm("# front\n50 0 1.5 10\n1e12 5 1 10\n").unwrap();
        assert!((plano - 100.0).abs() < 1e-6, "{plano}");
        // The lensmaker's equation for a lens of 6 mm: 1/f = (n − 1)(1/R1 − 1/R2 + (n − 1)d/(n R1 R2)).
        let thick = focal_length_mm("50 6 1.5 10\n0 0 0 5\n-40 3 1 10\n").unwrap();
        let exact = 1.0 / (0.5 * (1.0 / 50.0 + 1.0 / 40.0 - 0.5 * 6.0 / (1.5 * 50.0 * 40.0)));
        assert!((thick - exact).abs() < 1e-9, "{thick} {exact}");
        assert_eq!(focal_length_mm("50 6 1.5"), None);
        assert_eq!(focal_length_mm("0 0 0 5"), None);
        assert_eq!(focal_length_mm("a b c d"), None);
    }
}
