use std::array::from_fn;
use std::sync::LazyLock;

use math::Vec3;

use crate::ggx::{ALPHA_MIN, Ggx, half};

/// Nodes in τ = μ(1 + α)/(μ + α), evenly spaced over [0, 1]: what masking takes depends on μ/α for small α, so that
/// in τ the table is as smooth at α = 10⁻⁴ as at 1.
pub(crate) const TAU_NODES: usize = 40;
/// Nodes in √α, evenly spaced over [√[`ALPHA_MIN`], 1].
pub(crate) const ALPHA_NODES: usize = 16;
/// Quadrature points per node and dimension.
const POINTS: usize = 32;
/// Nodes of means in √α.
pub(crate) const MEAN_NODES: usize = 128;
/// Points of the quadrature of means, in ln μ.
const MEAN_POINTS: usize = 192;

/// One slice of a table: rows of equal α.
pub(crate) type Rows = [[f32; TAU_NODES]; ALPHA_NODES];

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

/// Position of (μ, α) in a table: node to the left and fraction, in τ and in √α.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    tau: (usize, f32),
    alpha: (usize, f32),
}

impl Place {
    #[inline]
    pub fn new(mu: f32, alpha: f32) -> Self {
        let mu = mu.max(0.0);
        let a = alpha.max(ALPHA_MIN);
        Self { tau: locate(mu * (1.0 + a) / (mu + a), TAU_NODES), alpha: locate_alpha(alpha, ALPHA_NODES) }
    }

    /// Bilinear interpolation.
    #[inline]
    pub fn of(self, rows: &Rows) -> f32 {
        let ((t, ft), (a, fa)) = (self.tau, self.alpha);
        lerp(lerp(rows[a][t], rows[a][t + 1], ft), lerp(rows[a + 1][t], rows[a + 1][t + 1], ft), fa)
    }
}

#[inline]
pub(crate) fn locate_alpha(alpha: f32, nodes: usize) -> (usize, f32) {
    const S: f32 = 0.01; // √ALPHA_MIN
    locate((alpha.max(0.0).sqrt() - S) / (1.0 - S), nodes)
}

/// α of a node.
pub(crate) fn alpha_node(i: usize, nodes: usize) -> f32 {
    let s = ALPHA_MIN.sqrt();
    (s + (1.0 - s) * i as f32 / (nodes - 1) as f32).powi(2)
}

/// 2∫E(μ) μ dμ by the midpoint rule in ln μ over [10⁻⁷, 1].
pub(crate) fn hemispherical_mean(e: impl Fn(f32) -> f32) -> f32 {
    let (mut sum, mut norm) = (0.0, 0.0);
    for i in 0..MEAN_POINTS {
        let mu = 1e-7f64.powf((i as f64 + 0.5) / MEAN_POINTS as f64);
        sum += f64::from(e(mu as f32)) * mu * mu;
        norm += mu * mu;
    }
    (sum / norm) as f32
}

/// Calls `f(weight, cos of wi to the half vector)` for quadrature points of the perfectly reflecting GGX lobe of
/// the node; the mean weight is the directional albedo. Directions below the horizon have weight 0. Returns μ of
/// the node and the number of points.
pub(crate) fn for_each_sample(tau_node: usize, alpha: f32, mut f: impl FnMut(f32, f32)) -> (f32, f64) {
    let tau = tau_node as f32 / (TAU_NODES - 1) as f32;
    let mu = (tau * alpha / (1.0 + alpha - tau)).clamp(1e-6, 1.0);
    let ggx = Ggx::new(alpha);
    let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
    for i in 0..POINTS {
        for j in 0..POINTS {
            let u = [(i as f32 + 0.5) / POINTS as f32, (j as f32 + 0.5) / POINTS as f32];
            let wi = ggx.sample(wo, u);
            let weight = if wi.z > 0.0 { ggx.weight(wo, wi).min(1.0) } else { 0.0 };
            f(weight, wo.dot(half(wo, wi)).clamp(0.0, 1.0));
        }
    }
    (mu, (POINTS * POINTS) as f64)
}

/// What a single bounce off a perfectly reflecting GGX surface loses: 1 − E(μ, α), E the directional albedo.
/// Tabulated at first use (about ten milliseconds), interpolated linearly in τ and √α; as the loss, because its
/// mean is needed to relative accuracy where it is small.
pub(crate) struct Loss {
    rows: Rows,
    means: [f32; MEAN_NODES],
}

static LOSS: LazyLock<Loss> = LazyLock::new(Loss::compute);

impl Loss {
    /// The table.
    #[inline]
    pub fn get() -> &'static Self {
        &LOSS
    }

    fn compute() -> Self {
        let rows: Rows = from_fn(|a| {
            from_fn(|t| {
                let mut sum = 0.0;
                let (_, n) = for_each_sample(t, alpha_node(a, ALPHA_NODES), |w, _| sum += f64::from(1.0 - w));
                (sum / n) as f32
            })
        });
        // Means of what `at` interpolates, so that the lobe of further bounces returns just what is lost.
        let mean = |alpha| hemispherical_mean(|mu| Place::new(mu, alpha).of(&rows));
        Self { means: from_fn(|a| mean(alpha_node(a, MEAN_NODES))), rows }
    }

    /// 1 − E(μ, α).
    #[inline]
    pub fn at(&self, mu: f32, alpha: f32) -> f32 {
        Place::new(mu, alpha).of(&self.rows)
    }

    /// 2∫(1 − E(μ, α)) μ dμ, never 0.
    #[inline]
    pub fn mean(&self, alpha: f32) -> f32 {
        let (a, fa) = locate_alpha(alpha, MEAN_NODES);
        lerp(self.means[a], self.means[a + 1], fa).max(1e-12)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 − E by a quadrature of n² points.
    fn loss(mu: f32, alpha: f32, n: i32) -> f64 {
        let ggx = Ggx::new(alpha);
        let wo = Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
        let at = |k: i32| (k as f32 + 0.5) / n as f32;
        let wi = |i: i32| ggx.sample(wo, [at(i / n), at(i % n)]);
        let weight = |wi: Vec3| if wi.z > 0.0 { f64::from(ggx.weight(wo, wi)) } else { 0.0 };
        1.0 - (0..n * n).map(|i| weight(wi(i))).sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn interpolation_is_within_half_a_percent() {
        for alpha in [1e-4, 0.001, 0.01, 0.03, 0.1, 0.3, 0.5, 0.9] {
            for mu in [0.005, 0.02, 0.05, 0.1, 0.3, 0.5, 0.95] {
                let (exact, table) = (loss(mu, alpha, 128), f64::from(Loss::get().at(mu, alpha)));
                assert!((exact - table).abs() < 0.005, "{alpha} {mu}: {exact} {table}");
            }
        }
    }

    #[test]
    fn means_are_those_of_a_finer_quadrature() {
        for alpha in [0.03, 0.1, 0.3, 0.6, 1.0] {
            let n = 60;
            let t = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
            let exact: f64 = (0..n)
                .map(|i| 4.0 * t(i).powi(3) * loss((t(i) * t(i)) as f32, alpha, 48) / f64::from(n))
                .sum();
            let table = f64::from(Loss::get().mean(alpha));
            assert!((exact - table).abs() < 1e-3 + 0.01 * exact, "{alpha}: {exact} {table}");
        }
    }
}
