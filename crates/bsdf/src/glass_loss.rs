use std::sync::LazyLock;

use math::Vec3;

use crate::fresnel::{fresnel_dielectric, refracted_cosine};
use crate::ggx::Ggx;
use crate::table::{Law, Places, Table, count, graded, locate, points, two};

/// Greatest index covered is 4, the least 1/4; beyond, the table is continued by its edge.
const T_MAX: f32 = 0.6;
/// What a single scattering event (reflection and refraction together) at a rough dielectric interface loses, for the
/// relative index η, that of the far side over that of the near side.
#[derive(Clone, Copy)]
struct GlassLoss {
    eta: f32,
    /// Cosine of the critical angle; 0 where there is none.
    critical: f32,
}

static TABLE: LazyLock<Table<GlassLoss>> = LazyLock::new(Table::new);

impl GlassLoss {
    #[inline]
    fn of(eta: f32) -> Self {
        Self { eta, critical: (1.0 - eta * eta).max(0.0).sqrt() }
    }
}

impl Law for GlassLoss {
    /// In the signed root of (η − 1)/(η + 1), evenly spaced over ±√[`T_MAX`]: dense about η = 1, where reflection at
    /// grazing angles sets in, and odd in number, so that η = 1 is one.
    const NODES: usize = 129;

    fn node(i: usize) -> Self {
        let u = 2.0 * i as f32 / (Self::NODES - 1) as f32 - 1.0;
        let t = T_MAX * u * u.abs();
        Self::of((1.0 + t) / (1.0 - t))
    }

    fn place(self) -> Places {
        let t = (self.eta - 1.0) / ((self.eta + 1.0) * T_MAX);
        two(locate(0.5 + 0.5 * t.abs().sqrt().copysign(t), Self::NODES))
    }

    /// Light that leaves near the critical angle grazes the surface outside and is masked: there the loss changes within α.
    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        let near = graded(mu, alpha);
        if self.critical == 0.0 {
            return near;
        }
        let g = |z: f32| z / (z.abs() + alpha);
        let (below, above) = (g(self.critical), g(1.0 - self.critical));
        0.4 * near + 0.6 * (g(mu - self.critical) + below) / (above + below)
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        loss(w, alpha, self.eta, count(alpha))
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}

/// 1 − E(w) for roughness αx, αy.
#[inline]
pub(crate) fn glass_loss(w: Vec3, alpha: [f32; 2], eta: f32) -> f32 {
    GlassLoss::table().at(GlassLoss::of(eta), w, alpha).clamp(0.0, 1.0)
}

/// (1/π)∫(1 − E(w)) cos dω, never 0.
#[inline]
pub(crate) fn glass_loss_mean(alpha: [f32; 2], eta: f32) -> f32 {
    GlassLoss::table().mean(GlassLoss::of(eta), alpha).max(1e-12)
}

/// The direction into which `wo` is refracted at the facet `h` (wo·h > 0).
#[inline]
pub(crate) fn refract(wo: Vec3, h: Vec3, eta: f32) -> Option<Vec3> {
    let c = wo.dot(h);
    refracted_cosine(c, eta).map(|cos_t| (h * (c / eta - cos_t) - wo / eta).normalize())
}

fn loss(wo: Vec3, alpha: [f32; 2], eta: f32, n: usize) -> f32 {
    let ggx = Ggx::xy(alpha);
    let of = |u| {
        let h = ggx.sample_normal(wo, u);
        let c = wo.dot(h).max(0.0);
        let f = fresnel_dielectric(c, eta);
        let reflected = h * (2.0 * c) - wo;
        let mut kept = 0.0;
        if reflected.z > 0.0 {
            kept += f * ggx.masking_ratio(wo, reflected).min(1.0);
        }
        if let Some(t) = refract(wo, h, eta).filter(|t| t.z < 0.0) {
            kept += (1.0 - f) * ggx.masking_ratio(wo, t).min(1.0);
        }
        f64::from(1.0 - kept)
    };
    ((points(n).map(of).sum::<f64>() / n as f64) as f32).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_within_one_percent() {
        for eta in [1.05, 1.1f32, 1.33, 1.5, 2.4] {
            for eta in [eta, 1.0 / eta] {
                for alpha in [[0.02; 2], [0.15; 2], [0.4; 2], [0.8; 2], [0.6, 0.1], [0.05, 0.4]] {
                    for mu in [0.03, 0.1, 0.3, 0.6, 0.7, 0.75, 0.8, 0.95] {
                        for phi in [0.3, 1.3] {
                            let w = math::spherical_direction(mu, phi);
                            let (exact, table) = (loss(w, alpha, eta, 8_000), glass_loss(w, alpha, eta));
                            let bound = if alpha[0] == alpha[1] { 0.01 } else { 0.015 };
                            assert!(
                                (exact - table).abs() < bound,
                                "{eta} {alpha:?} {mu} {phi}: {exact} {table}"
                            );
                        }
                    }
                }
            }
        }
    }
}
