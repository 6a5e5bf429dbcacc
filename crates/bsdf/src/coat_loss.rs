use std::array::from_fn;
use std::sync::LazyLock;

use math::Vec3;

use crate::coat_albedo::ETA_MAX;
use crate::facets::half_reflected;
use crate::fresnel::fresnel_dielectric;
use crate::ggx::{ALPHA_MIN, Ggx};
use crate::ggx_albedo::{lerp, locate};

/// Nodes in √μ, in √α and in (η − 1)/(η + 1).
const MU: usize = 24;
const ALPHA: usize = 14;
const ETA: usize = 10;
const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
/// Quadrature points per node and dimension.
const POINTS: usize = 20;
const MEAN_POINTS: usize = 96;

/// Of the light that enters a smooth coat of index η over a white GGX surface of roughness α from the direction μ: the
/// share that one reflection off the surface does not send out again, after all mirror-like interreflection
/// (see [`crate::coated_conductor`]). Tabulated at first use (about 0.1 s), interpolated linearly in √μ, √α and
/// (η − 1)/(η + 1).
pub(crate) struct CoatLoss {
    losses: Vec<[[f32; MU]; ALPHA]>,
    means: Vec<[f32; ALPHA]>,
}

static LOSS: LazyLock<CoatLoss> = LazyLock::new(CoatLoss::compute);

/// The direction inside a coat that leads to `w` outside (both point away from the base).
#[inline]
pub(crate) fn inside(w: Vec3, eta: f32) -> Vec3 {
    let (x, y) = (w.x / eta, w.y / eta);
    Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// The reverse; `None` where all is reflected.
#[inline]
pub(crate) fn outside(w: Vec3, eta: f32) -> Option<Vec3> {
    let (x, y) = (w.x * eta, w.y * eta);
    let z2 = 1.0 - x * x - y * y;
    (z2 > 0.0 && w.z > 0.0).then(|| Vec3::new(x, y, z2.sqrt()))
}

impl CoatLoss {
    /// The table.
    pub fn get() -> &'static Self {
        &LOSS
    }

    fn compute() -> Self {
        let s = ALPHA_MIN.sqrt();
        let losses: Vec<[[f32; MU]; ALPHA]> = (0..ETA)
            .map(|e| {
                let t = T_MAX * e as f32 / (ETA - 1) as f32;
                let eta = (1.0 + t) / (1.0 - t);
                from_fn(|a| {
                    let alpha = (s + (1.0 - s) * a as f32 / (ALPHA - 1) as f32).powi(2);
                    from_fn(|m| loss((m as f32 / (MU - 1) as f32).powi(2).max(1e-4), alpha, eta, POINTS))
                })
            })
            .collect();
        let mut table = Self { losses, means: Vec::new() };
        table.means = (0..ETA)
            .map(|e| {
                let t = T_MAX * e as f32 / (ETA - 1) as f32;
                let eta = (1.0 + t) / (1.0 - t);
                from_fn(|a| {
                    let alpha = (s + (1.0 - s) * a as f32 / (ALPHA - 1) as f32).powi(2);
                    table.integrate(alpha, eta)
                })
            })
            .collect();
        table
    }

    fn integrate(&self, alpha: f32, eta: f32) -> f32 {
        let mut sum = 0.0;
        for i in 0..MEAN_POINTS {
            let t = (i as f32 + 0.5) / MEAN_POINTS as f32;
            let mu = t * t;
            let enters = 1.0 - fresnel_dielectric(mu, eta);
            sum += f64::from(4.0 * mu * t * enters * self.at(mu, alpha, eta));
        }
        (sum / MEAN_POINTS as f64) as f32
    }

    fn place(alpha: f32, eta: f32) -> [(usize, f32); 2] {
        let s = ALPHA_MIN.sqrt();
        let a = locate((alpha.max(ALPHA_MIN).sqrt() - s) / (1.0 - s), ALPHA);
        [a, locate((eta - 1.0) / ((eta + 1.0) * T_MAX), ETA)]
    }

    /// The share lost.
    pub fn at(&self, mu: f32, alpha: f32, eta: f32) -> f32 {
        let (m, fm) = locate(mu.max(0.0).sqrt(), MU);
        let [(a, fa), (e, fe)] = Self::place(alpha, eta);
        let of = |n: &[[f32; MU]; ALPHA]| {
            lerp(lerp(n[a][m], n[a][m + 1], fm), lerp(n[a + 1][m], n[a + 1][m + 1], fm), fa)
        };
        lerp(of(&self.losses[e]), of(&self.losses[e + 1]), fe)
    }

    /// 2∫(1 − F(μ))·loss μ dμ: what is lost of diffuse light, never 0.
    pub fn mean(&self, alpha: f32, eta: f32) -> f32 {
        let [(a, fa), (e, fe)] = Self::place(alpha, eta);
        let row = |n: &[f32; ALPHA]| lerp(n[a], n[a + 1], fa);
        lerp(row(&self.means[e]), row(&self.means[e + 1]), fe).max(1e-9)
    }
}

/// By a quadrature over the numbers of the sampler.
fn loss(mu: f32, alpha: f32, eta: f32, n: usize) -> f32 {
    let ggx = Ggx::new(alpha);
    let wo = inside(Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu), eta);
    let enters = 1.0 - fresnel_dielectric(mu, eta);
    let mut sum = 0.0;
    for i in 0..n * n {
        let at = |k: usize| (k as f32 + 0.5) / n as f32;
        let wi = ggx.sample(wo, [at(i / n), at(i % n)]);
        if let Some(out) = outside(wi, eta).filter(|_| wo.dot(half_reflected(wo, wi)) > 0.0) {
            let leaves = 1.0 - fresnel_dielectric(out.z, eta);
            sum += f64::from(ggx.weight(wo, wi).min(1.0) * (leaves / enters.max(1e-9)).min(1.0));
        }
    }
    (1.0 - sum / (n * n) as f64).clamp(0.0, 1.0) as f32
}
