use std::sync::LazyLock;

use math::Vec3;

use crate::ggx::{Ggx, half};

/// Nodes of the table in √μ and in √α, both evenly spaced over [0, 1].
pub(crate) const MU_NODES: usize = 32;
pub(crate) const ALPHA_NODES: usize = 24;
/// Quadrature points per node and dimension.
const POINTS: usize = 32;

/// Position of `x` in [0, 1] among `n` evenly spaced nodes: left node and fraction.
#[inline]
pub(crate) fn locate(x: f32, n: usize) -> (usize, f32) {
    let p = x.clamp(0.0, 1.0) * (n - 1) as f32;
    let i = (p as usize).min(n - 2);
    (i, p - i as f32)
}

#[inline]
pub(crate) fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 2∫E μ dμ of a row of values at the nodes of √μ, linear between them: exact for the interpolant, hence for what
/// [`Table::at`] returns. With μ = t² the integrand is 4E(t)t³, of degree 4 on each piece.
pub(crate) fn hemispherical_mean(row: &[f32]) -> f32 {
    let h = 1.0 / (row.len() - 1) as f64;
    let mut sum = 0.0;
    for (i, pair) in row.windows(2).enumerate() {
        // Three-point Gauss–Legendre: exact to degree 5.
        for (x, w) in [(-0.6f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6f64.sqrt(), 5.0 / 18.0)] {
            let f = 0.5 * (x + 1.0);
            let t = (i as f64 + f) * h;
            let e = f64::from(pair[0]) * (1.0 - f) + f64::from(pair[1]) * f;
            sum += w * h * 4.0 * e * t.powi(3);
        }
    }
    sum as f32
}

/// Calls `f(weight, cos of wi to the half vector)` for quadrature points of the perfectly reflecting GGX lobe of
/// (node of μ, node of α ≥ 1); the mean of the weights is the directional albedo.
pub(crate) fn for_each_sample(mu_node: usize, alpha_node: usize, mut f: impl FnMut(f32, f32)) -> f64 {
    let node = |i: usize, n: usize| (i as f32 / (n - 1) as f32).powi(2);
    let mu = node(mu_node, MU_NODES).max(1e-5);
    let ggx = Ggx::new(node(alpha_node, ALPHA_NODES));
    let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
    for i in 0..POINTS {
        for j in 0..POINTS {
            let u = [(i as f32 + 0.5) / POINTS as f32, (j as f32 + 0.5) / POINTS as f32];
            let wi = ggx.sample(wo, u);
            if wi.z > 0.0 {
                let h = half(wo, wi);
                f(ggx.weight(wo, wi), wo.dot(h).clamp(0.0, 1.0));
            }
        }
    }
    (POINTS * POINTS) as f64
}

/// Directional albedo E(μ, α) of a single bounce off a perfectly reflecting GGX surface, tabulated at first use
/// (some milliseconds) and interpolated linearly in √μ and √α.
pub(crate) struct Table {
    rows: [[f32; MU_NODES]; ALPHA_NODES],
    means: [f32; ALPHA_NODES],
}

static TABLE: LazyLock<Table> = LazyLock::new(Table::compute);

impl Table {
    /// The table.
    #[inline]
    pub fn get() -> &'static Self {
        &TABLE
    }

    fn compute() -> Self {
        let mut rows = [[1.0; MU_NODES]; ALPHA_NODES];
        for (a, row) in rows.iter_mut().enumerate().skip(1) {
            for (m, e) in row.iter_mut().enumerate() {
                let mut sum = 0.0;
                let n = for_each_sample(m, a, |w, _| sum += f64::from(w));
                *e = ((sum / n) as f32).min(1.0);
            }
        }
        Self { means: rows.map(|row| hemispherical_mean(&row)), rows }
    }

    /// E(μ, α).
    #[inline]
    pub fn at(&self, mu: f32, alpha: f32) -> f32 {
        let (m, fm) = locate(mu.max(0.0).sqrt(), MU_NODES);
        let (a, fa) = locate(alpha.max(0.0).sqrt(), ALPHA_NODES);
        let row = |r: &[f32; MU_NODES]| lerp(r[m], r[m + 1], fm);
        lerp(row(&self.rows[a]), row(&self.rows[a + 1]), fa)
    }

    /// 2∫E(μ, α) μ dμ.
    #[inline]
    pub fn mean(&self, alpha: f32) -> f32 {
        let (a, fa) = locate(alpha.max(0.0).sqrt(), ALPHA_NODES);
        lerp(self.means[a], self.means[a + 1], fa)
    }
}
