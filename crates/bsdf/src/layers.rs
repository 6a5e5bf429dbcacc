use std::sync::LazyLock;

use math::Vec3;

use crate::coat_albedo::coat_albedo;
use crate::facet_loss::facet_loss;
use crate::fresnel::fresnel_dielectric;
use crate::ggx::{Ggx, half};
use crate::sheen::Sheen;
use crate::table::{Law, Places, Table, count, graded, locate, points, two};

/// Index of the clear coat.
pub(crate) const COAT_ETA: f32 = 1.5;

/// The layers of a principled surface above metal and dielectric: sheen over clear coat. What is below a layer that returns E(w) is
/// multiplied by min(1 − E(o), 1 − E(i)), which is reciprocal and never gains energy; what that loses, where `wi` is the more
/// grazing of the two, is tabulated ([`Layers::kept`]).
#[derive(Clone, Copy)]
pub(crate) struct Layers {
    /// Share of the surface under the coat.
    pub coat: f32,
    pub coat_alpha: f32,
    /// Greatest lane of the sheen's colour.
    pub sheen: f32,
    pub fibres: Sheen,
}

/// A lobe below the layers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Under {
    /// Facets that reflect all, further bounces restored.
    White,
    /// A single bounce in facets of a dielectric.
    Gloss,
}

impl Layers {
    pub fn none(&self) -> bool {
        self.coat == 0.0 && self.sheen == 0.0
    }

    /// What the coat alone returns.
    fn coat_at(&self, mu: f32) -> f32 {
        if self.coat == 0.0 {
            return 0.0;
        }
        self.coat * coat_albedo(at_cosine(mu), [self.coat_alpha; 2], COAT_ETA)
    }

    /// What the sheen alone returns, in its greatest lane.
    fn sheen_at(&self, mu: f32) -> f32 {
        if self.sheen == 0.0 { 0.0 } else { self.sheen * self.fibres.albedo(mu) }
    }

    /// What each returns alone, for a direction of cosine `mu`.
    pub fn above(&self, mu: f32) -> Above {
        Above { coat: self.coat_at(mu), sheen: self.sheen_at(mu) }
    }

    /// Share of a lobe's light that leaves through both layers, light that comes along `w` being met by [`Above::cover`].
    /// `above` is that of `w`.
    pub fn kept(&self, under: Under, w: Vec3, alpha: [f32; 2], above: Above) -> f32 {
        let mut kept = 1.0;
        if self.coat > 0.0 {
            let law = LayerLoss { layer: Layer::Coat(self.coat_alpha), under };
            kept = (1.0 - above.coat - self.coat * loss(law, w, alpha)).max(0.0);
        }
        kept * self.kept_by_sheen(under, w, alpha, above)
    }

    fn kept_by_sheen(&self, under: Under, w: Vec3, alpha: [f32; 2], above: Above) -> f32 {
        if self.sheen == 0.0 {
            return 1.0;
        }
        let law = LayerLoss { layer: Layer::Sheen(self.fibres), under };
        (1.0 - above.sheen - self.sheen * loss(law, w, alpha)).max(0.0)
    }

    /// What sheen and coat return together, the coat through the sheen.
    pub fn returned(&self, w: Vec3, above: Above) -> f32 {
        if above.coat == 0.0 {
            return above.sheen;
        }
        above.sheen + above.coat * self.kept_by_sheen(Under::Gloss, w, [self.coat_alpha; 2], above)
    }
}

/// What coat and sheen return, each alone, for one direction.
#[derive(Clone, Copy, Default)]
pub(crate) struct Above {
    pub coat: f32,
    pub sheen: f32,
}

impl Above {
    /// What neither returns.
    #[inline]
    pub fn passes(self) -> f32 {
        (1.0 - self.coat) * (1.0 - self.sheen)
    }

    /// Factor of what is below both, for a pair of directions.
    #[inline]
    pub fn cover(self, other: Self) -> f32 {
        (1.0 - self.coat.max(other.coat)) * self.cover_coat(other)
    }

    /// Factor of what is below the sheen.
    #[inline]
    pub fn cover_coat(self, other: Self) -> f32 {
        1.0 - self.sheen.max(other.sheen)
    }
}

fn at_cosine(mu: f32) -> Vec3 {
    Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu)
}

#[derive(Clone, Copy)]
enum Layer {
    Coat(f32),
    Sheen(Sheen),
}

/// ∫lobe · max(E(i) − E(o), 0) of a layer above a lobe that is normalised to 1.
#[derive(Clone, Copy)]
struct LayerLoss {
    layer: Layer,
    under: Under,
}

static TABLE: LazyLock<Table<LayerLoss>> = LazyLock::new(Table::new);

/// Nodes in ln α of coats, from [`COAT_MIN`] to 1; then nodes in √α of sheens.
const COATS: usize = 12;
const COAT_MIN: f32 = 1e-3;
const SHEENS: usize = 8;
/// Points of the quadrature of further bounces.
const FURTHER: usize = 48;

fn loss(law: LayerLoss, w: Vec3, alpha: [f32; 2]) -> f32 {
    LayerLoss::table().at(law, w, alpha).max(0.0)
}

impl LayerLoss {
    fn layer_at(self, mu: f32) -> f32 {
        match self.layer {
            Layer::Coat(alpha) => coat_albedo(at_cosine(mu), [alpha; 2], COAT_ETA),
            Layer::Sheen(fibres) => fibres.albedo(mu),
        }
    }
}

impl Law for LayerLoss {
    const NODES: usize = 2 * (COATS + SHEENS);

    fn node(i: usize) -> Self {
        let (layer, under) = (i / 2, if i.is_multiple_of(2) { Under::White } else { Under::Gloss });
        let layer = if layer < COATS {
            Layer::Coat(COAT_MIN.powf(1.0 - layer as f32 / (COATS - 1) as f32))
        } else {
            let s = Sheen::ALPHA_MIN.sqrt();
            Layer::Sheen(Sheen::new((s + (1.0 - s) * (layer - COATS) as f32 / (SHEENS - 1) as f32).powi(2)))
        };
        Self { layer, under }
    }

    fn place(self) -> Places {
        let (i, f) = match self.layer {
            Layer::Coat(alpha) => locate(1.0 - alpha.max(COAT_MIN).ln() / COAT_MIN.ln(), COATS),
            Layer::Sheen(fibres) => {
                let s = Sheen::ALPHA_MIN.sqrt();
                let (i, f) = locate((fibres.alpha().sqrt() - s) / (1.0 - s), SHEENS);
                (i + COATS, f)
            }
        };
        two((i, f)).map(|(i, weight)| (2 * i + usize::from(self.under == Under::Gloss), weight))
    }

    fn coordinate(self, mu: f32, alpha: f32) -> f32 {
        0.5 * (graded(mu, alpha) + graded(mu, 0.3))
    }

    fn value(self, alpha: [f32; 2], w: Vec3) -> f32 {
        let (ggx, n, above) = (Ggx::xy(alpha), count(alpha), self.layer_at(w.z));
        let (mut sum, mut norm) = (0.0, 0.0);
        for u in points(n) {
            let wi = ggx.sample(w, u);
            if wi.z > 0.0 {
                let fresnel = match self.under {
                    Under::White => 1.0,
                    Under::Gloss => fresnel_dielectric(w.dot(half(w, wi)).clamp(0.0, 1.0), COAT_ETA),
                };
                let weight = f64::from(ggx.weight(w, wi).min(1.0) * fresnel);
                norm += weight;
                sum += weight * f64::from((self.layer_at(wi.z) - above).max(0.0));
            }
        }
        let single = if norm > 0.0 { (sum / norm) as f32 } else { 0.0 };
        if self.under == Under::Gloss {
            return single;
        }
        // Further bounces leave by loss(i)·cosθi.
        let (mut sum, mut norm) = (0.0, 0.0);
        for i in 0..FURTHER {
            let t = (i as f32 + 0.5) / FURTHER as f32;
            let (wi, dt) = (math::spherical_direction(t * t, 2.4 * i as f32), t * t * t);
            let weight = facet_loss(wi, alpha) * dt;
            norm += weight;
            sum += weight * (self.layer_at(wi.z) - above).max(0.0);
        }
        let lost = facet_loss(w, alpha);
        single * (1.0 - lost) + sum / norm.max(1e-20) * lost
    }

    fn table() -> &'static Table<Self> {
        &TABLE
    }
}
