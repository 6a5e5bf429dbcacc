use std::array::from_fn;
use std::sync::LazyLock;

use math::{PI, Vec3};

use crate::table::{lerp, locate};

/// Fibres that stand on a surface: the distribution of normals sin^(1/α) with its fitted masking (Estevez & Kulla 2017,
/// "Production friendly microfacet sheen BRDF"), without Fresnel. Local directions with z > 0.
#[derive(Clone, Copy)]
pub(crate) struct Sheen {
    alpha: f32,
}

/// The fit of ln Λ at α = 0 and 1 (ibid., table 1), mixed by (1 − α)².
fn curve(x: f32, t: f32) -> f32 {
    let at = |one: f32, zero: f32| lerp(one, zero, t);
    let (a, b, c) = (at(21.5473, 25.3245), at(3.82987, 3.32435), at(0.19823, 0.16801));
    let (d, e) = (at(-1.97760, -1.27393), at(-4.32054, -4.85967));
    a / (1.0 + b * x.powf(c)) + d * x + e
}

impl Sheen {
    /// Least α in use: below it the fitted masking lets the model return more light than it gets at grazing angles.
    pub const ALPHA_MIN: f32 = 0.07;

    #[inline]
    pub fn new(alpha: f32) -> Self {
        Self { alpha: alpha.clamp(Self::ALPHA_MIN, 1.0) }
    }

    /// As clamped.
    pub fn alpha(self) -> f32 {
        self.alpha
    }

    fn lambda(self, cos: f32) -> f32 {
        let t = (1.0 - self.alpha).powi(2);
        let cos = cos.clamp(0.0, 1.0);
        let l = if cos < 0.5 { curve(cos, t) } else { 2.0 * curve(0.5, t) - curve(1.0 - cos, t) };
        l.exp()
    }

    /// f for fibres that absorb nothing.
    pub fn eval(self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        let sin2 = (h.x * h.x + h.y * h.y).min(1.0);
        let d = (2.0 + 1.0 / self.alpha) * sin2.powf(0.5 / self.alpha) / (2.0 * PI);
        let g = 1.0 / (1.0 + self.lambda(wo.z) + self.lambda(wi.z));
        d * g / (4.0 * wo.z * wi.z).max(1e-12)
    }

    /// Directional albedo, in [0, 1].
    pub fn albedo(self, mu: f32) -> f32 {
        let (m, fm) = locate(mu.max(0.0).sqrt(), MU);
        let s = Sheen::ALPHA_MIN.sqrt();
        let (a, fa) = locate((self.alpha.sqrt() - s) / (1.0 - s), ALPHA);
        let row = |r: &[f32; MU]| lerp(r[m], r[m + 1], fm);
        lerp(row(&TABLE[a]), row(&TABLE[a + 1]), fa)
    }
}

/// Density of [`sample`]: even over the hemisphere, which suits a lobe that is wide and brightest at grazing angles.
pub(crate) const PDF_W: f32 = 0.5 / PI;

/// A direction of the hemisphere.
pub(crate) fn sample(u: [f32; 2]) -> Vec3 {
    math::spherical_direction(1.0 - u[0], 2.0 * PI * u[1])
}

/// Nodes in √μ and in √α.
const MU: usize = 24;
const ALPHA: usize = 16;

/// Directional albedos, tabulated at first use (about 30 ms).
static TABLE: LazyLock<Vec<[f32; MU]>> = LazyLock::new(|| {
    let s = Sheen::ALPHA_MIN.sqrt();
    let row = |a: usize| {
        let alpha = (s + (1.0 - s) * a as f32 / (ALPHA - 1) as f32).powi(2);
        from_fn(|m| albedo(Sheen::new(alpha), (m as f32 / (MU - 1) as f32).powi(2).max(1e-4), 32, 24))
    };
    (0..ALPHA).map(row).collect()
});

/// ∫f cos over the hemisphere: midpoint rule in √z and in the azimuth from that of `wo` to that opposite.
fn albedo(sheen: Sheen, mu: f32, n: usize, azimuths: usize) -> f32 {
    let wo = Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
    let mut sum = 0.0;
    for i in 0..n {
        let t = (i as f32 + 0.5) / n as f32;
        let z = t * t;
        for j in 0..azimuths {
            let wi = math::spherical_direction(z, PI * (j as f32 + 0.5) / azimuths as f32);
            sum += f64::from(sheen.eval(wo, wi) * z * 2.0 * t);
        }
    }
    (sum * std::f64::consts::TAU / (n * azimuths) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_integral() {
        for alpha in [0.07, 0.1, 0.15, 0.4, 0.8] {
            let sheen = Sheen::new(alpha);
            for mu in [0.01, 0.05, 0.2, 0.5, 0.9] {
                let (table, exact) = (sheen.albedo(mu), albedo(sheen, mu, 200, 200));
                assert!((table - exact).abs() < 0.02 && exact < 1.0, "{alpha} {mu}: {table} {exact}");
            }
        }
    }
}
