use math::{PI, Vec3};

/// Least α in use: below it directions stored as `f32` no longer resolve the lobe.
pub(crate) const ALPHA_MIN: f32 = 1e-4;

/// The GGX distribution of normals with height-correlated Smith masking (Walter et al. 2007; Heitz 2014), of
/// roughness αx along x and αy along y. Directions are local with z > 0 unless said otherwise.
#[derive(Clone, Copy)]
pub(crate) struct Ggx {
    ax: f32,
    ay: f32,
}

/// The half vector of `wo` and `wi`.
#[inline]
pub(crate) fn half(wo: Vec3, wi: Vec3) -> Vec3 {
    (wo + wi).normalize()
}

impl Ggx {
    #[inline]
    pub fn xy(alpha: [f32; 2]) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        Self { ax, ay }
    }

    /// Density of normals: 1/(π αx αy (x²/αx² + y²/αy² + z²)²).
    #[inline]
    pub fn d(&self, h: Vec3) -> f32 {
        let (x, y) = (h.x / self.ax, h.y / self.ay);
        let t = x * x + y * y + h.z * h.z;
        1.0 / (PI * self.ax * self.ay * t * t)
    }

    /// Length of the stretched direction; Λ = (stretch/|z| − 1)/2.
    #[inline]
    fn stretch(&self, w: Vec3) -> f32 {
        let (x, y) = (self.ax * w.x, self.ay * w.y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// G₂/(4 |cosθo| |cosθi|), height-correlated (Heitz 2014, eq. 99); `wi` on either side.
    #[inline]
    pub fn visibility(&self, wo: Vec3, wi: Vec3) -> f32 {
        0.5 / (wo.z * self.stretch(wi) + wi.z.abs() * self.stretch(wo)).max(1e-30)
    }

    /// G₁(o) G₁(i)/(4 |cosθo| |cosθi|), the two maskings independent (Walter et al. 2007, eq. 23); `wi` on either side.
    #[inline]
    pub fn visibility_separable(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / ((wo.z + self.stretch(wo)) * (wi.z.abs() + self.stretch(wi))).max(1e-30)
    }

    /// The bound k of the visible cap and the length of the stretched `wo` (Eto & Tokuyoshi 2023, eq. 5; with the
    /// smaller α, §4.1).
    #[inline]
    fn bound(&self, wo: Vec3) -> (f32, f32) {
        let s = 1.0 + (wo.x * wo.x + wo.y * wo.y).sqrt();
        let s2 = s * s;
        let a = self.ax.min(self.ay);
        let a2 = a * a;
        let k = (1.0 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
        (k, self.stretch(wo))
    }

    /// Density of [`Self::sample`] per steradian of `wi` (Eto & Tokuyoshi 2023, eq. 8).
    #[inline]
    pub fn pdf_w(&self, wo: Vec3, h: Vec3) -> f32 {
        let (k, t) = self.bound(wo);
        self.d(h) / (2.0 * (k * wo.z + t)).max(1e-30)
    }

    /// A normal of the cap of visible ones, cut at −`k` times the height of the stretched `wo` (Heitz 2018;
    /// Dupuy & Benyoub 2023).
    #[inline]
    fn normal(&self, wo: Vec3, u: [f32; 2], k: f32, t: f32) -> Vec3 {
        let std = Vec3::new(self.ax * wo.x, self.ay * wo.y, wo.z) / t.max(1e-30);
        let b = k * std.z;
        let z = (1.0 - u[0]) * (1.0 + b) - b;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (s, c) = (2.0 * PI * u[1]).sin_cos();
        let cap = std + Vec3::new(r * c, r * s, z);
        Vec3::new(self.ax * cap.x, self.ay * cap.y, cap.z.max(0.0)).normalize_or(Vec3::Z)
    }

    /// `wi` mirrored in a visible normal of the bounded cap (Eto & Tokuyoshi 2023). It may lie below the horizon.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        let (k, t) = self.bound(wo);
        let h = self.normal(wo, u, k, t);
        h * (2.0 * wo.dot(h)) - wo
    }

    /// A visible normal, of density D(h)·G₁(o)·(o·h)/cosθo.
    #[inline]
    pub fn sample_normal(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        self.normal(wo, u, 1.0, self.stretch(wo))
    }

    /// Density of [`Self::sample_normal`] per steradian of the normal.
    #[inline]
    pub fn pdf_normal(&self, wo: Vec3, h: Vec3) -> f32 {
        2.0 * self.d(h) * wo.dot(h).max(0.0) / (wo.z + self.stretch(wo)).max(1e-30)
    }

    /// D·G₂/(4 cosθo cosθi) · cosθi / [`Self::pdf_w`]: D cancels.
    #[inline]
    pub fn weight(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (k, t) = self.bound(wo);
        self.visibility(wo, wi) * wi.z * 2.0 * (k * wo.z + t)
    }

    /// G₂/G₁(o): the weight of a refraction in a normal of [`Self::sample_normal`], Fresnel left out.
    #[inline]
    pub fn masking_ratio(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.visibility(wo, wi) * 2.0 * wi.z.abs() * (wo.z + self.stretch(wo))
    }
}
