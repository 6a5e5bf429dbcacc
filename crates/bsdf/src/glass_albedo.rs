use std::array::from_fn;
use std::sync::OnceLock;

use math::Vec3;

use crate::fresnel::{fresnel_dielectric, refracted_cosine};
use crate::ggx::{ALPHA_MIN, Ggx};
use crate::ggx_albedo::{hemispherical_mean, lerp, locate};

/// Nodes in √τ (see [`crate::ggx_albedo`]).
const TAU: usize = 32;
/// Nodes in √α.
const ALPHA: usize = 16;
/// Nodes in the signed root of (η − 1)/(η + 1), evenly spaced over ±√[`T_MAX`]: dense about η = 1, where reflection at
/// grazing angles sets in, and odd in number, so that η = 1 is one.
const ETA: usize = 65;
/// Greatest index covered is 4, the least 1/4; beyond, the table is continued by its edge.
const T_MAX: f32 = 0.6;
/// Quadrature points per node and dimension.
const POINTS: usize = 24;
/// Nodes of the means in √α.
const MEAN_ALPHA: usize = 48;

/// What a single scattering event (reflection and refraction together) at a rough dielectric interface loses, for one
/// relative index η, that of the far side over that of the near side. Interpolated linearly in √τ and √α.
pub(crate) struct GlassLoss {
    losses: [[f32; TAU]; ALPHA],
    means: [f32; MEAN_ALPHA],
}

/// One for each node of η, tabulated at first use (about ten milliseconds each; a scene's glass needs four).
static NODES: [OnceLock<Box<GlassLoss>>; ETA] = [const { OnceLock::new() }; ETA];

fn alpha_of(i: usize, nodes: usize) -> f32 {
    let s = ALPHA_MIN.sqrt();
    (s + (1.0 - s) * i as f32 / (nodes - 1) as f32).powi(2)
}

fn locate_root(alpha: f32, nodes: usize) -> (usize, f32) {
    let s = ALPHA_MIN.sqrt();
    locate((alpha.max(ALPHA_MIN).sqrt() - s) / (1.0 - s), nodes)
}

fn eta_of(i: usize) -> f32 {
    let u = 2.0 * i as f32 / (ETA - 1) as f32 - 1.0;
    let t = T_MAX * u * u.abs();
    (1.0 + t) / (1.0 - t)
}

/// The value at η, linear between nodes.
fn between(eta: f32, f: impl Fn(&GlassLoss) -> f32) -> f32 {
    let t = (eta - 1.0) / ((eta + 1.0) * T_MAX);
    let (e, fe) = locate(0.5 + 0.5 * t.abs().sqrt().copysign(t), ETA);
    lerp(f(GlassLoss::node(e)), f(GlassLoss::node(e + 1)), fe)
}

/// The direction into which `wo` is refracted at the facet `h` (wo·h > 0).
#[inline]
pub(crate) fn refract(wo: Vec3, h: Vec3, eta: f32) -> Option<Vec3> {
    let c = wo.dot(h);
    refracted_cosine(c, eta).map(|cos_t| (h * (c / eta - cos_t) - wo / eta).normalize())
}

impl GlassLoss {
    fn node(i: usize) -> &'static Self {
        NODES[i].get_or_init(|| Box::new(Self::compute(eta_of(i))))
    }

    fn compute(eta: f32) -> Self {
        let at = |alpha: f32, t: usize| {
            let tau = (t as f32 / (TAU - 1) as f32).powi(2);
            let mu = (tau * alpha / (1.0 + alpha - tau)).clamp(1e-5, 1.0);
            loss(mu, alpha, eta, POINTS).max(0.0) as f32
        };
        let losses = from_fn(|a| from_fn(|t| at(alpha_of(a, ALPHA), t)));
        let mut table = Self { losses, means: [0.0; MEAN_ALPHA] };
        table.means = from_fn(|a| {
            let alpha = alpha_of(a, MEAN_ALPHA);
            hemispherical_mean(|mu| table.value(mu, alpha))
        });
        table
    }

    fn value(&self, mu: f32, alpha: f32) -> f32 {
        let alpha = alpha.clamp(ALPHA_MIN, 1.0);
        let (t, ft) = locate((mu * (1.0 + alpha) / (mu + alpha)).sqrt(), TAU);
        let (a, fa) = locate_root(alpha, ALPHA);
        let row = |r: &[f32; TAU]| lerp(r[t], r[t + 1], ft);
        lerp(row(&self.losses[a]), row(&self.losses[a + 1]), fa)
    }

    /// 1 − E(μ, α, η).
    pub fn at(mu: f32, alpha: f32, eta: f32) -> f32 {
        between(eta, |n| n.value(mu, alpha)).clamp(0.0, 1.0)
    }

    /// 2∫(1 − E(μ, α, η)) μ dμ, never 0.
    pub fn mean(alpha: f32, eta: f32) -> f32 {
        let (a, fa) = locate_root(alpha, MEAN_ALPHA);
        between(eta, |n| lerp(n.means[a], n.means[a + 1], fa)).max(1e-12)
    }
}

/// 1 − E by a quadrature of n² points over the numbers of the sampler.
fn loss(mu: f32, alpha: f32, eta: f32, n: usize) -> f64 {
    let ggx = Ggx::new(alpha);
    let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
    let mut sum = 0.0;
    for i in 0..n * n {
        let at = |k: usize| (k as f32 + 0.5) / n as f32;
        let h = ggx.sample_normal(wo, [at(i / n), at(i % n)]);
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
        sum += f64::from(1.0 - kept);
    }
    sum / (n * n) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_within_one_percent() {
        // Two near η = 1, where refraction turns into total reflection within a few per cent of η.
        for (eta, bound) in [(1.1f32, 0.02), (1.33, 0.01), (1.5, 0.01), (2.4, 0.01)] {
            for eta in [eta, 1.0 / eta] {
                for alpha in [0.02, 0.15, 0.4, 0.8] {
                    for mu in [0.03, 0.1, 0.3, 0.6, 0.75, 0.95] {
                        let (exact, table) =
                            (loss(mu, alpha, eta, 96), f64::from(GlassLoss::at(mu, alpha, eta)));
                        assert!((exact - table).abs() < bound, "{eta} {alpha} {mu}: {exact} {table}");
                    }
                }
            }
        }
    }
}
