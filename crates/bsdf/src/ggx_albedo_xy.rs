use std::array::from_fn;
use std::f32::consts::FRAC_PI_2;
use std::sync::OnceLock;

use math::Vec3;

use crate::ggx::{ALPHA_MIN, Ggx};
use crate::ggx_albedo::{Loss, lerp, locate};

/// Nodes in τ (see [`crate::ggx_albedo`]), with the roughness of the azimuth as α.
const TAU: usize = 20;
/// Nodes in the azimuth, from the smooth axis to the rough one, evenly spaced in the root of the α along it.
const ALONG: usize = 9;
/// Nodes in the square root of the greater α.
const ALPHA: usize = 11;
/// Nodes in the ratio of the smaller α to the greater.
const RATIO: usize = 17;
/// Quadrature points per node and dimension.
const POINTS: usize = 20;
/// Nodes of the means in √α.
const MEAN_ALPHA: usize = 24;

type Azimuths = [[f32; TAU]; ALONG];

/// What a single bounce off a perfectly reflecting anisotropic GGX surface loses, for one ratio of its two α: as its ratio
/// to the loss of the isotropic surface of the greater α at the same τ, in which α is that along the azimuth of the
/// direction. Interpolated linearly in τ, α along the azimuth and √α.
pub(crate) struct LossXy {
    ratios: [Azimuths; ALPHA],
    means: [f32; MEAN_ALPHA],
}

/// One for each node of the ratio, tabulated at first use (some 30 ms each; a material needs two).
static NODES: [OnceLock<Box<LossXy>>; RATIO] = [const { OnceLock::new() }; RATIO];

/// The value at a ratio, linear between nodes.
fn between(ratio: f32, f: impl Fn(&LossXy) -> f32) -> f32 {
    let (r, fr) = locate(ratio, RATIO);
    lerp(f(LossXy::node(r)), f(LossXy::node(r + 1)), fr)
}

/// √α of a node.
fn root_node(i: usize, nodes: usize) -> f32 {
    let s = ALPHA_MIN.sqrt();
    s + (1.0 - s) * i as f32 / (nodes - 1) as f32
}

/// Position among the nodes of [`root_node`].
fn locate_root(alpha: f32, nodes: usize) -> (usize, f32) {
    let s = ALPHA_MIN.sqrt();
    locate((alpha.max(ALPHA_MIN).sqrt() - s) / (1.0 - s), nodes)
}

/// μ of which τ is made.
fn of_tau(tau: f32, alpha: f32) -> f32 {
    (tau * alpha / (1.0 + alpha - tau)).clamp(1e-5, 1.0)
}

/// α along the azimuth whose cosine to the rough axis is `c`.
fn alpha_along(great: f32, small: f32, c: f32) -> f32 {
    (great * great * c * c + small * small * (1.0 - c * c)).sqrt()
}

impl LossXy {
    fn node(i: usize) -> &'static Self {
        NODES[i].get_or_init(|| Box::new(Self::compute(i as f32 / (RATIO - 1) as f32)))
    }

    fn compute(ratio: f32) -> Self {
        let ratios = from_fn(|a| {
            let great = root_node(a, ALPHA).powi(2);
            let small = (great * ratio).max(ALPHA_MIN);
            from_fn(|p| {
                let v = p as f32 / (ALONG - 1) as f32;
                let along = small + (great - small) * v * v;
                from_fn(|t| Self::ratio(great, small, along, t))
            })
        });
        let mut table = Self { ratios, means: [0.0; MEAN_ALPHA] };
        table.means = from_fn(|a| {
            let great = root_node(a, MEAN_ALPHA).powi(2);
            table.integrate(great, (great * ratio).max(ALPHA_MIN))
        });
        table
    }

    /// The ratio at a node, by a quadrature over the numbers of the sampler.
    fn ratio(great: f32, small: f32, along: f32, tau_node: usize) -> f32 {
        let c2 = (along * along - small * small) / (great * great - small * small).max(1e-12);
        let (c, s) = (c2.clamp(0.0, 1.0).sqrt(), (1.0 - c2).clamp(0.0, 1.0).sqrt());
        let tau = tau_node as f32 / (TAU - 1) as f32;
        let mu = of_tau(tau, along);
        let r = (1.0 - mu * mu).max(0.0).sqrt();
        let wo = Vec3::new(r * c, r * s, mu);
        let ggx = Ggx::xy([great, small]);
        let mut lost = 0.0;
        for i in 0..POINTS * POINTS {
            let at = |k: usize| (k as f32 + 0.5) / POINTS as f32;
            let wi = ggx.sample(wo, [at(i / POINTS), at(i % POINTS)]);
            lost += f64::from(1.0 - if wi.z > 0.0 { ggx.weight(wo, wi).min(1.0) } else { 0.0 });
        }
        let lost = (lost / (POINTS * POINTS) as f64) as f32;
        (lost / Loss::get().at(of_tau(tau, great), great).max(1e-7)).clamp(0.0, 8.0)
    }

    /// (1/π)∫ loss · cos over the hemisphere: midpoint rule in √μ and in the azimuth.
    fn integrate(&self, great: f32, small: f32) -> f32 {
        const MU: usize = 48;
        const AZIMUTHS: usize = 12;
        let mut sum = 0.0;
        for i in 0..MU {
            let t = (i as f32 + 0.5) / MU as f32;
            // μ = t³: dense towards grazing, where a smooth surface loses all that it loses.
            let (mu, weight) = (t.powi(3), 6.0 * t.powi(5));
            let r = (1.0 - mu * mu).sqrt();
            for j in 0..AZIMUTHS {
                let phi = FRAC_PI_2 * (j as f32 + 0.5) / AZIMUTHS as f32;
                let w = Vec3::new(r * phi.cos(), r * phi.sin(), mu);
                sum += f64::from(weight * self.value(w, [great, small]));
            }
        }
        (sum / (MU * AZIMUTHS) as f64) as f32
    }

    /// 1 − E(w) of a surface of the table's ratio, near enough.
    fn value(&self, w: Vec3, [ax, ay]: [f32; 2]) -> f32 {
        let (great, small, c, s) = if ax >= ay { (ax, ay, w.x, w.y) } else { (ay, ax, w.y, w.x) };
        let sin = c.hypot(s);
        let along = alpha_along(great, small, if sin > 0.0 { c.abs() / sin } else { 1.0 });
        let mu = w.z.abs();
        let tau = mu * (1.0 + along) / (mu + along);
        let (t, ft) = locate(tau, TAU);
        let (p, fp) = locate(((along - small).max(0.0) / (great - small).max(1e-12)).sqrt(), ALONG);
        let (a, fa) = locate_root(great, ALPHA);
        let azimuths =
            |n: &Azimuths| lerp(lerp(n[p][t], n[p][t + 1], ft), lerp(n[p + 1][t], n[p + 1][t + 1], ft), fp);
        let ratio = lerp(azimuths(&self.ratios[a]), azimuths(&self.ratios[a + 1]), fa);
        (ratio * Loss::get().at(of_tau(tau, great), great)).clamp(0.0, 1.0)
    }

    /// 1 − E(w) for roughness αx, αy.
    pub fn at(w: Vec3, alpha: [f32; 2]) -> f32 {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        between(ax.min(ay) / ax.max(ay), |n| n.value(w, [ax, ay]))
    }

    /// (1/π)∫(1 − E(w)) cos dω, never 0.
    pub fn mean(alpha: [f32; 2]) -> f32 {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        let (great, small) = (ax.max(ay), ax.min(ay));
        let (a, fa) = locate_root(great, MEAN_ALPHA);
        between(small / great, |n| lerp(n.means[a], n.means[a + 1], fa)).max(1e-12)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_within_one_percent() {
        let n = 96;
        for (ax, ay) in [(0.9, 0.1), (0.5, 0.3), (0.1, 0.6), (0.3, 0.01), (0.02, 0.15), (1.0, 0.7)] {
            for mu in [0.02, 0.1, 0.3, 0.6, 0.95] {
                for phi in [0.2, 0.8, 1.4, 2.5] {
                    let (ggx, r) = (Ggx::xy([ax, ay]), (1.0f32 - mu * mu).sqrt());
                    let wo = Vec3::new(r * f32::cos(phi), r * f32::sin(phi), mu);
                    let at = |k: i32| (k as f32 + 0.5) / n as f32;
                    let weight = |wi: Vec3| if wi.z > 0.0 { f64::from(ggx.weight(wo, wi)) } else { 0.0 };
                    let exact = 1.0
                        - (0..n * n).map(|i| weight(ggx.sample(wo, [at(i / n), at(i % n)]))).sum::<f64>()
                            / f64::from(n * n);
                    let table = f64::from(LossXy::at(wo, [ax, ay]));
                    assert!((exact - table).abs() < 0.01, "{ax} {ay} {mu} {phi}: {exact} {table}");
                }
            }
        }
    }

    #[test]
    fn equal_roughness_is_the_isotropic_table() {
        for alpha in [0.05, 0.3, 1.0] {
            let (xy, iso) = (LossXy::mean([alpha; 2]), Loss::get().mean(alpha));
            assert!((xy - iso).abs() < 0.001 + 0.01 * iso, "{alpha}: {xy} {iso}");
        }
    }
}
