use std::sync::LazyLock;

use math::Vec3;

use crate::coat_albedo::ETA_MAX;
use crate::facets::{Facets, Micro};
use crate::fresnel::fresnel_dielectric;
use crate::glass_loss::refract;
use crate::table::{Law, Places, Table, count, graded, locate, points, two};

const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
/// Nodes in the root of (η − 1)/(η + 1).
const ETAS: usize = 48;
const PARTS: [Part; 3] = [Part::Reflected, Part::Entering, Part::Inner];
const FACETS: [Facets; 3] = [Facets::SingleBounce, Facets::Separable, Facets::Beckmann];

/// A share of the light that meets a rough dielectric of index η ≥ 1 and is scattered once.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// Reflected, of light from outside.
    Reflected,
    /// Refracted, of light from outside.
    Entering,
    /// Reflected, of light from inside.
    Inner,
}

/// [`Part`] for facets that lose what bounces more than once.
#[derive(Clone, Copy)]
struct SingleBounce {
    eta: f32,
    part: Part,
    facets: Facets,
}

static TABLE: LazyLock<Table<SingleBounce>> = LazyLock::new(Table::new);

impl Law for SingleBounce {
    const NODES: usize = ETAS * PARTS.len() * FACETS.len();

    fn node(i: usize) -> Self {
        let t = T_MAX * ((i % ETAS) as f32 / (ETAS - 1) as f32).powi(2);
        let kind = i / ETAS;
        Self {
            eta: (1.0 + t) / (1.0 - t),
            part: PARTS[kind % PARTS.len()],
            facets: FACETS[kind / PARTS.len()],
        }
    }

    fn place(self) -> Places {
        let facets = FACETS.iter().position(|&f| f == self.facets).unwrap_or(0);
        let part = PARTS.iter().position(|&p| p == self.part).unwrap_or(0);
        let first = (facets * PARTS.len() + part) * ETAS;
        two(locate(((self.eta - 1.0).max(0.0) / ((self.eta + 1.0) * T_MAX)).sqrt(), ETAS))
            .map(|(i, weight)| (first + i, weight))
    }

    /// Of what Fresnel's reflectance does from outside and, about the critical angle, from inside.
    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        let steep = (self.eta * self.eta - 1.0).max(1e-4).sqrt();
        if self.part != Part::Inner {
            return 0.5 * (graded(mu, alpha) + graded(mu, steep));
        }
        let critical = steep / self.eta;
        let g = |z: f32| z / (z.abs() + alpha);
        let (below, above) = (g(critical), g(1.0 - critical));
        0.5 * graded(mu, alpha) + 0.5 * (g(mu - critical) + below) / (above + below)
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        let (micro, n) = (Micro::new(self.facets, alpha), count(alpha));
        let eta = if self.part == Part::Inner { 1.0 / self.eta } else { self.eta };
        let of = |u| {
            let h = micro.sample_normal(w, u);
            let c = w.dot(h);
            if c <= 0.0 {
                return 0.0;
            }
            let f = fresnel_dielectric(c, eta);
            let (wi, share) = if self.part == Part::Entering {
                (refract(w, h, eta).filter(|wi| wi.z < 0.0), 1.0 - f)
            } else {
                (Some(h * (2.0 * c) - w).filter(|wi| wi.z > 0.0), f)
            };
            let Some(wi) = wi else { return 0.0 };
            let g = 4.0 * micro.visibility(w, wi) * wi.z.abs() * c * micro.d(h);
            f64::from(share * g / micro.pdf_normal(w, h).max(1e-20))
        };
        (points(n).map(of).sum::<f64>() / n as f64) as f32
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}

/// The share for light along `w`.
pub(crate) fn single_bounce(part: Part, w: Vec3, alpha: [f32; 2], eta: f32, facets: Facets) -> f32 {
    SingleBounce::table().at(SingleBounce { eta, part, facets }, w, alpha).clamp(0.0, 1.0)
}

/// The share for diffuse light.
pub(crate) fn single_bounce_mean(part: Part, alpha: [f32; 2], eta: f32, facets: Facets) -> f32 {
    SingleBounce::table().mean(SingleBounce { eta, part, facets }, alpha).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What enters and what is reflected inside obey the same étendue: (1 − R)·η² is what enters, less what facets lose.
    #[test]
    fn smooth_facets_are_fresnels() {
        for facets in FACETS {
            let at = |part, mu: f32| {
                single_bounce(part, math::spherical_direction(mu, 0.3), [1e-3; 2], 1.5, facets)
            };
            for mu in [0.3f32, 0.6, 1.0] {
                let f = fresnel_dielectric(mu, 1.5);
                assert!((at(Part::Reflected, mu) - f).abs() < 3e-3, "{facets:?} {mu}");
                assert!((at(Part::Entering, mu) - 1.0 + f).abs() < 3e-3, "{facets:?} {mu}");
                assert!(
                    (at(Part::Inner, mu) - fresnel_dielectric(mu, 1.0 / 1.5)).abs() < 3e-3,
                    "{facets:?} {mu}"
                );
            }
        }
    }
}
