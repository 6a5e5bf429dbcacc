use std::sync::LazyLock;

use math::Vec3;

use crate::coat_albedo::{ETA_MAX, coat_albedo};
use crate::facets::half_reflected;
use crate::fresnel::fresnel_dielectric;
use crate::ggx::Ggx;
use crate::table::{Law, Places, Table, count, graded, locate, points};

const T_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
/// Nodes in the root of (η − 1)/(η + 1).
const ETAS: usize = 32;
/// Nodes in ln α of the coat.
const COATS: usize = 12;
/// α of the first of them, which stands for smooth coats.
const COAT_MIN: f32 = 1e-3;
/// Of the light that enters a coat of index η over a white GGX surface from the direction `w`: the share that one
/// reflection off the surface does not send out again, after all mirror-like interreflection (see [`crate::coated_conductor`]).
#[derive(Clone, Copy)]
struct CoatLoss {
    eta: f32,
    coat_alpha: f32,
}

static TABLE: LazyLock<Table<CoatLoss>> = LazyLock::new(Table::new);

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
    fn enters(self, mu: f32) -> f32 {
        1.0 - if self.coat_alpha == 0.0 {
            fresnel_dielectric(mu, self.eta)
        } else {
            coat_albedo(Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu), [self.coat_alpha; 2], self.eta)
        }
    }
}

impl Law for CoatLoss {
    const NODES: usize = ETAS * COATS;

    fn node(i: usize) -> Self {
        let t = T_MAX * ((i % ETAS) as f32 / (ETAS - 1) as f32).powi(2);
        let coat = i / ETAS;
        let coat_alpha = COAT_MIN.powf(1.0 - coat as f32 / (COATS - 1) as f32);
        Self { eta: (1.0 + t) / (1.0 - t), coat_alpha: if coat == 0 { 0.0 } else { coat_alpha } }
    }

    fn place(self) -> Places {
        let (e, fe) = locate(((self.eta - 1.0).max(0.0) / ((self.eta + 1.0) * T_MAX)).sqrt(), ETAS);
        let (c, fc) = locate(1.0 - self.coat_alpha.max(COAT_MIN).ln() / COAT_MIN.ln(), COATS);
        let i = c * ETAS + e;
        [
            (i, (1.0 - fe) * (1.0 - fc)),
            (i + 1, fe * (1.0 - fc)),
            (i + ETAS, (1.0 - fe) * fc),
            (i + ETAS + 1, fe * fc),
        ]
    }

    /// Near grazing cosθ′ changes with the square of μ.
    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        0.5 * (graded(mu, alpha) + graded(mu, alpha.sqrt()))
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        let (ggx, n) = (Ggx::xy(alpha), count(alpha) / 2);
        let wo = inside(w, self.eta);
        let enters = self.enters(w.z);
        let of = |u| {
            let wi = ggx.sample(wo, u);
            let Some(out) = outside(wi, self.eta).filter(|_| wo.dot(half_reflected(wo, wi)) > 0.0) else {
                return 1.0;
            };
            1.0 - f64::from(ggx.weight(wo, wi).min(1.0) * (self.enters(out.z) / enters.max(1e-9)).min(1.0))
        };
        ((points(n).map(of).sum::<f64>() / n as f64) as f32).clamp(0.0, 1.0)
    }

    fn weight(self, mu: f32) -> f32 {
        self.enters(mu)
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}

/// The share lost. `coat_alpha` 0: a smooth coat.
#[inline]
pub(crate) fn coat_loss(w: Vec3, alpha: [f32; 2], eta: f32, coat_alpha: f32) -> f32 {
    CoatLoss::table().at(CoatLoss { eta, coat_alpha }, w, alpha).clamp(0.0, 1.0)
}

/// (1/π)∫(1 − E_coat(w))·loss cos dω: what is lost of diffuse light, never 0.
#[inline]
pub(crate) fn coat_loss_mean(alpha: [f32; 2], eta: f32, coat_alpha: f32) -> f32 {
    CoatLoss::table().mean(CoatLoss { eta, coat_alpha }, alpha).max(1e-9)
}
