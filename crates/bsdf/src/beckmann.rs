use math::{PI, Vec3};

use crate::ggx::ALPHA_MIN;

/// The Beckmann distribution of normals, of roughness αx along x and αy along y, with separable Smith masking in
/// Walter's rational fit (Walter et al. 2007, §5.2; its error is below 0.35 %).
#[derive(Clone, Copy)]
pub(crate) struct Beckmann {
    ax: f32,
    ay: f32,
}

impl Beckmann {
    #[inline]
    pub fn xy(alpha: [f32; 2]) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        Self { ax, ay }
    }

    /// Density of normals: exp(−tan²θ (cos²φ/αx² + sin²φ/αy²))/(π αx αy cos⁴θ).
    #[inline]
    pub fn d(&self, h: Vec3) -> f32 {
        let z2 = h.z * h.z;
        if z2 == 0.0 {
            return 0.0;
        }
        let (x, y) = (h.x / self.ax, h.y / self.ay);
        (-(x * x + y * y) / z2).exp() / (PI * self.ax * self.ay * z2 * z2)
    }

    /// Smith's G₁.
    #[inline]
    fn g1(&self, w: Vec3) -> f32 {
        let (x, y) = (self.ax * w.x, self.ay * w.y);
        let a = w.z.abs() / (x * x + y * y).sqrt().max(1e-30);
        if a >= 1.6 { 1.0 } else { a * (3.535 + 2.181 * a) / (1.0 + a * (2.276 + 2.577 * a)) }
    }

    /// G₁(o) G₁(i)/(4 |cosθo| |cosθi|).
    #[inline]
    pub fn visibility(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.g1(wo) * self.g1(wi) / (4.0 * wo.z * wi.z.abs()).max(1e-30)
    }
}
