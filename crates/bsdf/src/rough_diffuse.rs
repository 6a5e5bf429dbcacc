use color::Lanes;
use math::{FRAC_1_PI, Vec3};

/// The energy-preserving Oren–Nayar model (Portsmouth, Kutz & Hill 2025, "EON"): Fujii's variant of the single bounce,
/// and the lost energy in the reciprocal lobe of Kulla & Conty.
#[derive(Clone, Copy)]
pub(crate) struct RoughDiffuse {
    pub albedo: Lanes,
    pub roughness: f32,
}

/// A of the single bounce, ρ/π · A · (1 + r·s/t).
#[inline]
fn scale(r: f32) -> f32 {
    1.0 / (1.0 + (0.5 - 2.0 * FRAC_1_PI / 3.0) * r)
}

/// Directional albedo of the single bounce for ρ = 1 (ibid., eq. 14).
fn single_albedo(mu: f32, r: f32) -> f32 {
    let mu = mu.clamp(0.0, 1.0);
    let s = (1.0 - mu * mu).sqrt();
    // tanθ (1 − sin³θ), written without the pole.
    let tail = s * mu * (1.0 + s + s * s) / (1.0 + s);
    let g = s * (mu.acos() - s * mu) + 2.0 / 3.0 * (tail - s);
    scale(r) * (1.0 + r * FRAC_1_PI * g)
}

impl RoughDiffuse {
    #[inline]
    fn r(&self) -> f32 {
        self.roughness.clamp(0.0, 1.0)
    }

    /// Mean over the hemisphere of [`single_albedo`].
    #[inline]
    fn mean(&self) -> f32 {
        scale(self.r()) * (1.0 + (2.0 / 3.0 - 28.0 / 15.0 * FRAC_1_PI) * self.r())
    }

    /// ρ_ms = ρ² E_mean/(1 − ρ (1 − E_mean)).
    fn further(&self) -> Lanes {
        let e = self.mean();
        self.albedo.map(|a| a * a * e / (1.0 - a * (1.0 - e)))
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        let r = self.r();
        let s = wo.dot(wi) - wo.z * wi.z;
        let ratio = if s > 0.0 { s / wo.z.max(wi.z).max(1e-20) } else { s };
        let single = self.albedo * (scale(r) * (1.0 + r * ratio));
        let lost = 1.0 - self.mean();
        if lost < 1e-6 {
            return single * FRAC_1_PI;
        }
        let pair = (1.0 - single_albedo(wo.z, r)) * (1.0 - single_albedo(wi.z, r));
        (single + self.further() * (pair / lost)) * FRAC_1_PI
    }

    /// Directional albedo.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        let e = single_albedo(cos_o, self.r());
        self.albedo * e + self.further() * (1.0 - e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::PI;

    #[test]
    fn the_closed_form_is_the_integral() {
        for r in [0.2, 0.7, 1.0f32] {
            let n = 400;
            let mut mean = 0.0;
            for i in 0..20 {
                let mu = (i as f32 + 0.5) / 20.0;
                let wo = Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
                let mut sum = 0.0;
                for j in 0..n * 50 {
                    let z = ((j / 50) as f32 + 0.5) / n as f32;
                    let phi = PI * ((j % 50) as f32 + 0.5) / 50.0;
                    let p = (1.0 - z * z).sqrt();
                    let wi = Vec3::new(p * phi.cos(), p * phi.sin(), z);
                    let s = wo.dot(wi) - mu * z;
                    sum += z * scale(r) * (1.0 + r * if s > 0.0 { s / mu.max(z) } else { s });
                }
                let e = sum * 2.0 / (n * 50) as f32;
                assert!((e - single_albedo(mu, r)).abs() < 2e-3, "{r} {mu}: {e} {}", single_albedo(mu, r));
                mean += 2.0 * mu * single_albedo(mu, r) / 20.0;
            }
            let closed = RoughDiffuse { albedo: Lanes::ONE, roughness: r }.mean();
            assert!((mean - closed).abs() < 1e-3, "{r}: {mean} {closed}");
        }
    }
}
