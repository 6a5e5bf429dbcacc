use crate::chi2::Rect;
use crate::quadrature::integrate_rect;

/// A rectangle cut into cells by medians of pilot samples, so that the cells are about equally likely however
/// narrow the density is.
pub(crate) struct Partition {
    /// Implicit binary tree: the children of node i are 2i + 1 and 2i + 2.
    splits: Vec<(usize, f64)>,
    levels: u32,
    cells: Vec<(Rect, Vec<[f64; 2]>)>,
}

/// Splits points at the median along their wider side. `None` where they cannot be told apart.
fn split(points: &mut [[f64; 2]]) -> Option<(usize, f64, usize)> {
    let extent = |i: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[i]), h.max(p[i])));
        high - low
    };
    if points.len() < 2 {
        return None;
    }
    let axis = usize::from(extent(1) > extent(0));
    let middle = points.len() / 2;
    points.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
    let (a, b) = (points[middle - 1][axis], points[middle][axis]);
    (b > a).then_some((axis, 0.5 * (a + b), middle))
}

fn halves(r: &Rect, axis: usize, at: f64) -> (Rect, Rect) {
    let (mut low, mut high) = (*r, *r);
    low.max[axis] = at;
    high.min[axis] = at;
    (low, high)
}

impl Partition {
    /// 2^`levels` cells.
    pub fn new(domain: Rect, pilot: Vec<[f64; 2]>, levels: u32) -> Self {
        let mut splits = Vec::new();
        let mut cells = vec![(domain, pilot)];
        for _ in 0..levels {
            let mut next = Vec::with_capacity(2 * cells.len());
            for (rect, mut points) in cells {
                // Where points do not tell, cut the longer side in half.
                let (axis, at, middle) = split(&mut points).unwrap_or_else(|| {
                    let axis = usize::from(rect.max[1] - rect.min[1] > rect.max[0] - rect.min[0]);
                    let at = 0.5 * (rect.min[axis] + rect.max[axis]);
                    points.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
                    (axis, at, points.partition_point(|p| p[axis] < at))
                });
                splits.push((axis, at));
                let (low, high) = halves(&rect, axis, at);
                let upper = points.split_off(middle);
                next.push((low, points));
                next.push((high, upper));
            }
            cells = next;
        }
        Self { splits, levels, cells }
    }

    /// Index of the cell of a point of the domain.
    pub fn cell(&self, p: [f64; 2]) -> usize {
        let mut node = 0;
        for _ in 0..self.levels {
            let (axis, at) = self.splits[node];
            node = 2 * node + 1 + usize::from(p[axis] >= at);
        }
        node + 1 - (1 << self.levels)
    }

    /// ∫f over each cell. The cells are first cut on by the pilot samples, so that peaks that the sampler knows are
    /// found; `tolerance` is absolute, for the sum.
    pub fn integrals(&self, f: &impl Fn([f64; 2]) -> f64, tolerance: f64) -> Vec<f64> {
        let total: usize = self.cells.iter().map(|c| c.1.len()).sum();
        let each = tolerance / (total as f64 / POINTS_PER_PIECE as f64).max(1.0);
        self.cells.iter().map(|(rect, points)| integrate_guided(f, rect, &mut points.clone(), each)).collect()
    }
}

/// Pilot samples in one piece of the quadrature, at most.
const POINTS_PER_PIECE: usize = 4;
/// Quarterings of a piece.
const DEPTH: u32 = 12;

fn integrate_guided(f: &impl Fn([f64; 2]) -> f64, r: &Rect, points: &mut [[f64; 2]], tolerance: f64) -> f64 {
    if points.len() > POINTS_PER_PIECE
        && let Some((axis, at, middle)) = split(points)
    {
        let (low, high) = halves(r, axis, at);
        let (a, b) = points.split_at_mut(middle);
        return integrate_guided(f, &low, a, tolerance) + integrate_guided(f, &high, b, tolerance);
    }
    let (x, y) = (graded_cuts(r, points, 0), graded_cuts(r, points, 1));
    let mut sum = 0.0;
    for x in x.windows(2) {
        for y in y.windows(2) {
            sum += integrate_rect(f, &Rect { min: [x[0], y[0]], max: [x[1], y[1]] }, tolerance, DEPTH);
        }
    }
    sum
}

/// Where to cut a side of a piece: about its points at distances that grow fourfold, so that the tail of a narrow
/// lobe in a large piece is not stepped over. Just the ends where the points fill the piece.
fn graded_cuts(r: &Rect, points: &[[f64; 2]], axis: usize) -> Vec<f64> {
    let (min, max) = (r.min[axis], r.max[axis]);
    let (low, high) =
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[axis]), h.max(p[axis])));
    let scale = (high - low).max(1e-7 * (max - min));
    let mut cuts = vec![min, max];
    if points.len() > 1 {
        let mut distance = scale;
        while low - distance > min || high + distance < max {
            cuts.extend([low - distance, high + distance].into_iter().filter(|&c| c > min && c < max));
            distance *= 4.0;
        }
        cuts.sort_unstable_by(f64::total_cmp);
    }
    cuts
}
