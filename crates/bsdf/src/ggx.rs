use math::{PI, Vec3};

/// Least α in use: below it directions stored as `f32` no longer resolve the lobe.
pub(crate) const ALPHA_MIN: f32 = 1e-4;

/// The isotropic GGX distribution of normals with height-correlated Smith masking (Walter et al. 2007; Heitz 2014).
/// Directions are local with z > 0.
#[derive(Clone, Copy)]
pub(crate) struct Ggx {
    alpha2: f32,
    alpha: f32,
}

/// The half vector of `wo` and `wi`.
#[inline]
pub(crate) fn half(wo: Vec3, wi: Vec3) -> Vec3 {
    (wo + wi).normalize()
}

impl Ggx {
    #[inline]
    pub fn new(alpha: f32) -> Self {
        let alpha = alpha.clamp(ALPHA_MIN, 1.0);
        Self { alpha, alpha2: alpha * alpha }
    }

    /// Density of normals: α²/(π (sin²θ + α² cos²θ)²). The sine comes from x and y, not from 1 − z².
    #[inline]
    pub fn d(&self, h: Vec3) -> f32 {
        let t = h.x * h.x + h.y * h.y + self.alpha2 * (h.z * h.z);
        self.alpha2 / (PI * t * t)
    }

    /// G₂/(4 cosθo cosθi), height-correlated (Heitz 2014, eq. 99).
    #[inline]
    pub fn visibility(&self, cos_o: f32, cos_i: f32) -> f32 {
        let l = |a: f32, b: f32| a * (self.alpha2 + (1.0 - self.alpha2) * b * b).sqrt();
        0.5 / (l(cos_o, cos_i) + l(cos_i, cos_o)).max(1e-30)
    }

    /// The bound k of the visible cap and the length of the stretched `wo` (Eto & Tokuyoshi 2023, eq. 5).
    #[inline]
    fn bound(&self, wo: Vec3) -> (f32, f32) {
        let sin2 = wo.x * wo.x + wo.y * wo.y;
        let s = 1.0 + sin2.sqrt();
        let s2 = s * s;
        let k = (1.0 - self.alpha2) * s2 / (s2 + self.alpha2 * wo.z * wo.z);
        (k, (self.alpha2 * sin2 + wo.z * wo.z).sqrt())
    }

    /// Density of [`Self::sample`] per steradian of `wi` (Eto & Tokuyoshi 2023, eq. 8).
    #[inline]
    pub fn pdf_w(&self, wo: Vec3, h: Vec3) -> f32 {
        let (k, t) = self.bound(wo);
        self.d(h) / (2.0 * (k * wo.z + t)).max(1e-30)
    }

    /// `wi` mirrored in a visible normal (Heitz 2018) of the bounded cap (Eto & Tokuyoshi 2023). It may lie below
    /// the horizon.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        let (k, t) = self.bound(wo);
        let std = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z) / t.max(1e-30);
        let b = k * std.z;
        let z = (1.0 - u[0]) * (1.0 + b) - b;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (s, c) = (2.0 * PI * u[1]).sin_cos();
        let cap = std + Vec3::new(r * c, r * s, z);
        let h = Vec3::new(self.alpha * cap.x, self.alpha * cap.y, cap.z.max(0.0)).normalize_or(Vec3::Z);
        h * (2.0 * wo.dot(h)) - wo
    }

    /// D·G₂/(4 cosθo cosθi) · cosθi / [`Self::pdf_w`]: D cancels.
    #[inline]
    pub fn weight(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (k, t) = self.bound(wo);
        self.visibility(wo.z, wi.z) * wi.z * 2.0 * (k * wo.z + t)
    }
}
