use color::Lanes;

use crate::film::Film;
use crate::fresnel::{fresnel_conductor, fresnel_conductor_mean, fresnel_dielectric};

/// How a facet reflects, by angle.
#[derive(Clone, Copy)]
pub(crate) struct Reflectance {
    base: Base,
    film: Film,
    /// Share of the surface that the film covers.
    covered: f32,
}

#[derive(Clone, Copy)]
enum Base {
    Conductor { n: Lanes, k: Lanes },
    Dielectric { eta: f32 },
    Schlick { f0: Lanes },
}

impl Reflectance {
    #[inline]
    fn plain(base: Base) -> Self {
        Self { base, film: Film::NONE, covered: 0.0 }
    }

    /// Of a metal: n and k relative to the outside.
    #[inline]
    pub fn conductor(n: Lanes, k: Lanes) -> Self {
        Self::plain(Base::Conductor { n, k })
    }

    /// Of a dielectric, met from outside.
    #[inline]
    pub fn dielectric(eta: f32) -> Self {
        Self::plain(Base::Dielectric { eta })
    }

    /// F₀ + (1 − F₀)(1 − cos)⁵ (Schlick 1994, eq. 24).
    #[inline]
    pub fn schlick(f0: Lanes) -> Self {
        Self::plain(Base::Schlick { f0 })
    }

    /// Under a film that covers a share of it.
    #[inline]
    pub fn under(self, film: Film, covered: f32) -> Self {
        Self { film, covered: if film.is_none() { 0.0 } else { covered }, ..self }
    }

    /// At the angle of cosine `cos` ≥ 0, from outside.
    #[inline]
    pub fn at(&self, cos: f32) -> Lanes {
        let bare = match self.base {
            Base::Conductor { n, k } => fresnel_conductor(cos, n, k),
            Base::Dielectric { eta } => Lanes::splat(fresnel_dielectric(cos, eta)),
            Base::Schlick { f0 } => {
                let x = 1.0 - cos.clamp(0.0, 1.0);
                let x5 = x * x * x * x * x;
                f0 * (1.0 - x5) + Lanes::splat(x5)
            }
        };
        if self.covered == 0.0 { bare } else { bare * (1.0 - self.covered) + self.filmed(cos) * self.covered }
    }

    #[inline(never)]
    fn filmed(&self, cos: f32) -> Lanes {
        let (n, k) = match self.base {
            Base::Conductor { n, k } => (n, k),
            Base::Dielectric { eta } => (Lanes::splat(eta), Lanes::ZERO),
            // The real index that reflects f0.
            Base::Schlick { f0 } => (
                f0.map(|f| {
                    let r = f.clamp(0.0, 0.9999).sqrt();
                    (1.0 + r) / (1.0 - r)
                }),
                Lanes::ZERO,
            ),
        };
        self.film.reflectance(cos, n, k)
    }

    /// 2∫F(μ) μ dμ: in closed form for Schlick's, else by four-point Gauss–Legendre quadrature in μ.
    pub fn mean(&self) -> Lanes {
        match self.base {
            Base::Schlick { f0 } if self.covered == 0.0 => (f0 * 20.0 + Lanes::ONE) / 21.0,
            Base::Conductor { n, k } if self.covered == 0.0 => fresnel_conductor_mean(n, k),
            _ => hemispherical_mean(|mu| self.at(mu)),
        }
    }
}

/// 2∫F(μ) μ dμ by four-point Gauss–Legendre quadrature in μ.
pub(crate) fn hemispherical_mean(f: impl Fn(f32) -> Lanes) -> Lanes {
    const NODES: [(f32, f32); 4] = [
        (0.069_431_844, 0.173_927_42),
        (0.330_009_48, 0.326_072_57),
        (0.669_990_52, 0.326_072_57),
        (0.930_568_16, 0.173_927_42),
    ];
    NODES.iter().fold(Lanes::ZERO, |sum, &(mu, w)| sum + f(mu) * (2.0 * mu * w))
}
