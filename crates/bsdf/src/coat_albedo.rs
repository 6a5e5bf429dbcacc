use std::sync::LazyLock;

use math::Vec3;

use crate::fresnel::{fresnel_dielectric, fresnel_dielectric_mean};
use crate::ggx::{Ggx, half};
use crate::table::{Law, Places, Table, count, graded, locate, points, two};

/// Greatest index that the table covers.
pub(crate) const ETA_MAX: f32 = 4.0;
const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
/// Directional albedo E(w) of a single reflection off a rough dielectric of relative index η ≥ 1, exact Fresnel included, as its
/// ratio to F(μ, η).
#[derive(Clone, Copy)]
struct CoatAlbedo {
    eta: f32,
}

static TABLE: LazyLock<Table<CoatAlbedo>> = LazyLock::new(Table::new);

impl Law for CoatAlbedo {
    /// In the root of (η − 1)/(η + 1).
    const NODES: usize = 48;

    fn node(i: usize) -> Self {
        let t = T_MAX * (i as f32 / (Self::NODES - 1) as f32).powi(2);
        // A ratio has a limit as η goes to 1.
        Self { eta: ((1.0 + t) / (1.0 - t)).max(1.0 + 1e-4) }
    }

    fn place(self) -> Places {
        two(locate(((self.eta - 1.0).max(0.0) / ((self.eta + 1.0) * T_MAX)).sqrt(), Self::NODES))
    }

    /// Fresnel's reflectance rises below μ ≈ √(η² − 1).
    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        0.5 * (graded(mu, alpha) + graded(mu, (self.eta * self.eta - 1.0).max(1e-4).sqrt()))
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        albedo(alpha, w, self.eta, count(alpha)) / fresnel_dielectric(w.z, self.eta)
    }

    fn weight(self, mu: f32) -> f32 {
        fresnel_dielectric(mu, self.eta) / fresnel_dielectric_mean(self.eta).max(1e-12)
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}

/// E(w).
pub(crate) fn coat_albedo(w: Vec3, alpha: [f32; 2], eta: f32) -> f32 {
    let f = fresnel_dielectric(w.z.abs(), eta);
    if f == 0.0 {
        return 0.0;
    }
    (CoatAlbedo::table().at(CoatAlbedo { eta }, w, alpha) * f).clamp(0.0, 1.0)
}

/// (1/π)∫E(w) cos dω.
pub(crate) fn coat_albedo_mean(alpha: [f32; 2], eta: f32) -> f32 {
    let f = fresnel_dielectric_mean(eta);
    if f == 0.0 { 0.0 } else { CoatAlbedo::table().mean(CoatAlbedo { eta }, alpha) * f }
}

fn albedo(alpha: [f32; 2], w: Vec3, eta: f32, n: usize) -> f32 {
    let ggx = Ggx::xy(alpha);
    let of = |u| {
        let wi = ggx.sample(w, u);
        if wi.z <= 0.0 {
            return 0.0;
        }
        f64::from(ggx.weight(w, wi).min(1.0) * fresnel_dielectric(w.dot(half(w, wi)).clamp(0.0, 1.0), eta))
    };
    (points(n).map(of).sum::<f64>() / n as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_within_half_a_percent() {
        for eta in [1.01, 1.05, 1.33, 1.5, 2.5] {
            for alpha in [[1e-3; 2], [0.1; 2], [0.4; 2], [1.0; 2], [0.6, 0.1], [0.05, 0.4]] {
                for mu in [0.01, 0.05, 0.2, 0.5, 0.9] {
                    for phi in [0.2, 1.3] {
                        let w = math::spherical_direction(mu, phi);
                        let (exact, table) = (albedo(alpha, w, eta, 10_000), coat_albedo(w, alpha, eta));
                        assert!((exact - table).abs() < 0.005, "{eta} {alpha:?} {mu} {phi}: {exact} {table}");
                    }
                }
            }
        }
    }

    #[test]
    fn means_are_those_of_a_finer_quadrature() {
        for (alpha, eta) in [([0.1; 2], 1.5), ([0.8; 2], 1.1), ([0.5, 0.1], 2.0)] {
            let n = 4000;
            let exact = points(n)
                .map(|[u, v]| {
                    let w = math::spherical_direction(u * u, std::f32::consts::FRAC_PI_2 * v);
                    f64::from(4.0 * u * u * u * albedo(alpha, w, eta, 400))
                })
                .sum::<f64>()
                / n as f64;
            let table = f64::from(coat_albedo_mean(alpha, eta));
            assert!((exact - table).abs() < 1e-3, "{alpha:?} {eta}: {exact} {table}");
        }
    }
}
