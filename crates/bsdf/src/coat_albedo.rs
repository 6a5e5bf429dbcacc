use std::array::from_fn;
use std::sync::LazyLock;

use crate::fresnel::fresnel_dielectric;
use crate::ggx_albedo::{ALPHA_NODES, MU_NODES, for_each_sample, hemispherical_mean, lerp, locate};

/// Nodes in (η − 1)/(η + 1), evenly spaced over [0, [`T_MAX`]].
const ETA_NODES: usize = 16;
/// Greatest index that the table covers.
pub(crate) const ETA_MAX: f32 = 4.0;
const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);

/// Directional albedo E(μ, α, η) of a single reflection off a rough dielectric of relative index η ≥ 1, exact
/// Fresnel included, tabulated at first use (some tens of milliseconds) and interpolated linearly in √μ, √α and
/// (η − 1)/(η + 1).
pub(crate) struct Table {
    rows: Vec<[[f32; MU_NODES]; ALPHA_NODES]>,
    means: Vec<[f32; ALPHA_NODES]>,
}

static TABLE: LazyLock<Table> = LazyLock::new(Table::compute);

impl Table {
    /// The table.
    #[inline]
    pub fn get() -> &'static Self {
        &TABLE
    }

    fn compute() -> Self {
        let etas: [f32; ETA_NODES] = from_fn(|i| {
            let t = T_MAX * i as f32 / (ETA_NODES - 1) as f32;
            (1.0 + t) / (1.0 - t)
        });
        let mut rows = vec![[[0.0; MU_NODES]; ALPHA_NODES]; ETA_NODES];
        for m in 0..MU_NODES {
            let mu = (m as f32 / (MU_NODES - 1) as f32).powi(2);
            for (table, &eta) in rows.iter_mut().zip(&etas) {
                table[0][m] = fresnel_dielectric(mu, eta);
            }
            for a in 1..ALPHA_NODES {
                let mut sums = [0.0; ETA_NODES];
                let n = for_each_sample(m, a, |w, cos_h| {
                    for (sum, &eta) in sums.iter_mut().zip(&etas) {
                        *sum += f64::from(w * fresnel_dielectric(cos_h, eta));
                    }
                });
                for (table, sum) in rows.iter_mut().zip(sums) {
                    table[a][m] = ((sum / n) as f32).min(1.0);
                }
            }
        }
        Self { means: rows.iter().map(|t| t.map(|row| hemispherical_mean(&row))).collect(), rows }
    }

    fn locate_eta(eta: f32) -> (usize, f32) {
        locate((eta - 1.0) / ((eta + 1.0) * T_MAX), ETA_NODES)
    }

    /// E(μ, α, η).
    pub fn at(&self, mu: f32, alpha: f32, eta: f32) -> f32 {
        let (m, fm) = locate(mu.max(0.0).sqrt(), MU_NODES);
        let (a, fa) = locate(alpha.max(0.0).sqrt(), ALPHA_NODES);
        let (e, fe) = Self::locate_eta(eta);
        let row = |r: &[f32; MU_NODES]| lerp(r[m], r[m + 1], fm);
        let plane = |p: &[[f32; MU_NODES]; ALPHA_NODES]| lerp(row(&p[a]), row(&p[a + 1]), fa);
        lerp(plane(&self.rows[e]), plane(&self.rows[e + 1]), fe)
    }

    /// 2∫E(μ, α, η) μ dμ.
    pub fn mean(&self, alpha: f32, eta: f32) -> f32 {
        let (a, fa) = locate(alpha.max(0.0).sqrt(), ALPHA_NODES);
        let (e, fe) = Self::locate_eta(eta);
        let row = |r: &[f32; ALPHA_NODES]| lerp(r[a], r[a + 1], fa);
        lerp(row(&self.means[e]), row(&self.means[e + 1]), fe)
    }
}
