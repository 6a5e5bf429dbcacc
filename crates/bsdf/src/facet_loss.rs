use std::sync::LazyLock;

use math::Vec3;

use crate::ggx::Ggx;
use crate::table::{Law, Places, Table, count, graded, points};

/// 1 − E(w): what a single bounce off a perfectly reflecting GGX surface loses.
#[derive(Clone, Copy)]
struct FacetLoss;

static TABLE: LazyLock<Table<FacetLoss>> = LazyLock::new(Table::new);

impl Law for FacetLoss {
    const NODES: usize = 1;

    fn node(_: usize) -> Self {
        Self
    }

    fn place(self) -> Places {
        [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]
    }

    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        graded(mu, alpha)
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        loss(alpha, w, count(alpha))
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}

/// 1 − E(w) for roughness αx, αy.
#[inline]
pub(crate) fn facet_loss(w: Vec3, alpha: [f32; 2]) -> f32 {
    FacetLoss::table().at(FacetLoss, w, alpha).max(0.0)
}

/// (1/π)∫(1 − E(w)) cos dω, never 0.
#[inline]
pub(crate) fn facet_loss_mean(alpha: [f32; 2]) -> f32 {
    FacetLoss::table().mean(FacetLoss, alpha).max(1e-12)
}

fn loss(alpha: [f32; 2], w: Vec3, n: usize) -> f32 {
    let ggx = Ggx::xy(alpha);
    let of = |u| {
        let wi = ggx.sample(w, u);
        f64::from(1.0 - if wi.z > 0.0 { ggx.weight(w, wi).min(1.0) } else { 0.0 })
    };
    (points(n).map(of).sum::<f64>() / n as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_within_one_percent() {
        for (ax, ay) in [
            (1e-4, 1e-4),
            (0.01, 0.01),
            (0.1, 0.1),
            (0.5, 0.5),
            (0.9, 0.1),
            (0.5, 0.3),
            (0.1, 0.6),
            (0.3, 0.01),
            (0.02, 0.15),
            (1.0, 0.7),
            (0.31, 0.3),
        ] {
            for mu in [0.005, 0.02, 0.1, 0.3, 0.6, 0.95] {
                for phi in [0.2, 0.8, 1.4, 2.5] {
                    let w = math::spherical_direction(mu, phi);
                    let (exact, table) = (loss([ax, ay], w, 20_000), facet_loss(w, [ax, ay]));
                    let bound = if ax == ay { 0.004 } else { 0.008 };
                    assert!((exact - table).abs() < bound, "{ax} {ay} {mu} {phi}: {exact} {table}");
                }
            }
        }
    }

    #[test]
    fn means_are_those_of_a_finer_quadrature() {
        for alpha in [[0.03; 2], [0.1; 2], [0.6; 2], [1.0; 2], [0.6, 0.1], [0.02, 0.3]] {
            let n = 4000;
            let exact = points(n)
                .map(|[u, v]| {
                    let w = math::spherical_direction(u * u, std::f32::consts::FRAC_PI_2 * v);
                    f64::from(4.0 * u * u * u * loss(alpha, w, 400))
                })
                .sum::<f64>()
                / n as f64;
            let table = f64::from(facet_loss_mean(alpha));
            assert!((exact - table).abs() < 5e-4 + 0.015 * exact, "{alpha:?}: {exact} {table}");
        }
    }
}
