use std::array::from_fn;
use std::sync::LazyLock;

use math::Vec3;

use crate::facets::{along, mean_along};
use crate::fresnel::fresnel_dielectric;
use crate::ggx_albedo::{
    ALPHA_NODES, MEAN_NODES, Place, Rows, TAU_NODES, alpha_node, for_each_sample, hemispherical_mean, lerp,
    locate, locate_alpha,
};

/// Nodes in (η − 1)/(η + 1), evenly spaced over [0, [`T_MAX`]].
const ETA_NODES: usize = 16;
/// Greatest index that the table covers.
pub(crate) const ETA_MAX: f32 = 4.0;
const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);

/// Directional albedo E(μ, α, η) of a single reflection off a rough dielectric of relative index η ≥ 1, exact
/// Fresnel included, tabulated at first use (some tens of milliseconds) as its ratio to F(μ, η), which is
/// interpolated linearly in τ and √α (see [`crate::ggx_albedo`]) and (η − 1)/(η + 1).
pub(crate) struct Table {
    ratios: Vec<Rows>,
    means: Vec<[f32; MEAN_NODES]>,
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
        let mut ratios = vec![[[0.0; TAU_NODES]; ALPHA_NODES]; ETA_NODES];
        for a in 0..ALPHA_NODES {
            for t in 0..TAU_NODES {
                let mut sums = [0.0; ETA_NODES];
                let (mu, n) = for_each_sample(t, alpha_node(a, ALPHA_NODES), |w, cos_h| {
                    if w > 0.0 {
                        for (sum, &eta) in sums.iter_mut().zip(&etas) {
                            *sum += f64::from(w * fresnel_dielectric(cos_h, eta));
                        }
                    }
                });
                for ((rows, sum), &eta) in ratios.iter_mut().zip(sums).zip(&etas) {
                    let f = fresnel_dielectric(mu, eta);
                    rows[a][t] = if f > 0.0 { (sum / n) as f32 / f } else { 1.0 };
                }
            }
        }
        let mean = |rows: &Rows, eta: f32, alpha: f32| {
            hemispherical_mean(|mu| Place::new(mu, alpha).of(rows) * fresnel_dielectric(mu, eta))
        };
        let means = ratios
            .iter()
            .zip(etas)
            .map(|(rows, eta)| from_fn(|a| mean(rows, eta, alpha_node(a, MEAN_NODES))))
            .collect();
        Self { ratios, means }
    }

    fn locate_eta(eta: f32) -> (usize, f32) {
        locate((eta - 1.0) / ((eta + 1.0) * T_MAX), ETA_NODES)
    }

    /// E(μ, α, η).
    pub fn at(&self, mu: f32, alpha: f32, eta: f32) -> f32 {
        let place = Place::new(mu, alpha);
        let (e, fe) = Self::locate_eta(eta);
        let ratio = lerp(place.of(&self.ratios[e]), place.of(&self.ratios[e + 1]), fe);
        (ratio * fresnel_dielectric(mu, eta)).min(1.0)
    }

    /// E of an anisotropic surface: that of the isotropic one with the same slopes in the plane of incidence.
    pub fn along(&self, w: Vec3, alpha: [f32; 2], eta: f32) -> f32 {
        self.at(w.z.abs(), along(w, alpha), eta)
    }

    /// (1/π)∫ of [`Self::along`]·cos over the hemisphere.
    pub fn mean_along(&self, alpha: [f32; 2], eta: f32) -> f32 {
        mean_along(alpha, |alpha| self.mean(alpha, eta))
    }

    /// 2∫E(μ, α, η) μ dμ.
    pub fn mean(&self, alpha: f32, eta: f32) -> f32 {
        let (a, fa) = locate_alpha(alpha, MEAN_NODES);
        let (e, fe) = Self::locate_eta(eta);
        let row = |r: &[f32; MEAN_NODES]| lerp(r[a], r[a + 1], fa);
        lerp(row(&self.means[e]), row(&self.means[e + 1]), fe)
    }
}
