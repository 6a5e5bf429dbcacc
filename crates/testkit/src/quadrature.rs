use crate::chi2::Rect;

/// Gauss–Lobatto with four points a side over a rectangle: exact for degree 5 in each variable. Its nodes reach the
/// corners, so that a jump that cuts one off is seen.
fn lobatto(f: &impl Fn([f64; 2]) -> f64, r: &Rect) -> f64 {
    const X: f64 = 0.447_213_595_499_957_94;
    const NODES: [(f64, f64); 4] = [(-1.0, 1.0 / 12.0), (-X, 5.0 / 12.0), (X, 5.0 / 12.0), (1.0, 1.0 / 12.0)];
    let at = |i: usize, x: f64| r.min[i] + (r.max[i] - r.min[i]) * 0.5 * (x + 1.0);
    let mut sum = 0.0;
    for (x, wx) in NODES {
        for (y, wy) in NODES {
            sum += wx * wy * f([at(0, x), at(1, y)]);
        }
    }
    sum * r.area()
}

fn refine(f: &impl Fn([f64; 2]) -> f64, r: &Rect, coarse: f64, tolerance: f64, depth: u32) -> f64 {
    let mid = [0.5 * (r.min[0] + r.max[0]), 0.5 * (r.min[1] + r.max[1])];
    let quads = [
        Rect { min: r.min, max: mid },
        Rect { min: [mid[0], r.min[1]], max: [r.max[0], mid[1]] },
        Rect { min: [r.min[0], mid[1]], max: [mid[0], r.max[1]] },
        Rect { min: mid, max: r.max },
    ];
    let values = quads.map(|q| lobatto(f, &q));
    let fine: f64 = values.iter().sum();
    // NaN stays NaN, however finely it is cut.
    if depth == 0 || fine.is_nan() || (fine - coarse).abs() <= tolerance {
        return fine;
    }
    quads.iter().zip(values).map(|(q, v)| refine(f, q, v, tolerance, depth - 1)).sum()
}

/// ∫f over a rectangle, by adaptive quadrature: pieces are quartered until that changes them by no more than
/// `tolerance` (absolute, each: along jumps errors of either sign add up like their root), at most `depth` times.
pub fn integrate_rect(f: &impl Fn([f64; 2]) -> f64, r: &Rect, tolerance: f64, depth: u32) -> f64 {
    refine(f, r, lobatto(f, r), tolerance, depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_and_cut_integrands() {
        let r = Rect { min: [-1.0, -1.0], max: [1.0, 1.0] };
        let gaussian = integrate_rect(&|[x, y]| (-20.0 * (x * x + y * y)).exp(), &r, 1e-9, 12);
        assert!((gaussian - std::f64::consts::PI / 20.0).abs() < 1e-8, "{gaussian}");
        let disc = integrate_rect(&|[x, y]| f64::from(x * x + y * y < 1.0), &r, 1e-6, 9);
        assert!((disc - std::f64::consts::PI).abs() < 1e-3, "{disc}");
    }
}
