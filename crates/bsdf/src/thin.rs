use color::Lanes;
use math::{FRAC_1_PI, Vec3};

use crate::bsdf::{BsdfSample, DeltaLobe};
use crate::facets::{Micro, further_pdf_w, half_reflected, sample_further};
use crate::film::Film;
use crate::fresnel::fresnel_dielectric;
use crate::glass::{REFLECTION, TRANSMISSION};
use crate::lobes::Lobes;
use crate::mirror;
use crate::null;
use crate::reflectance::{Reflectance, hemispherical_mean};

/// A thin slab of a dielectric: all reflections between its two faces, in parallel, straight on. Rough: the facets
/// of reflection, and the same lobe mirrored to the other side for transmission (Burley 2015, §5.4); further bounces
/// are restored in the proportion in which the slab reflects and transmits diffuse light.
///
/// A film covers a share of one face; the other face is bare. Light interferes within the film, and the two faces, far apart
/// against a wavelength, add up without interference. As nothing absorbs, it matters neither which face the film is on nor from
/// which side it is seen (see [`Thin::slab`]).
#[derive(Clone, Copy)]
pub(crate) struct Thin {
    pub micro: Micro,
    pub alpha: f32,
    /// Index of the slab over that outside.
    pub eta: f32,
    /// Of one face.
    pub film: Film,
    /// Share of the sheet that the film covers.
    pub covered: f32,
    pub reflectance: Lanes,
    pub transmittance: Lanes,
}

/// To the side of `wo`.
#[inline]
fn folded(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.abs())
}

impl Thin {
    /// What the slab reflects. With A and B what its faces do, A + (1 − A)² B/(1 − AB) = 1 − (1 − A)(1 − B)/(1 − AB), the same
    /// from both sides; of equal faces 2A/(1 + A).
    #[inline]
    fn slab(&self, cos: f32) -> Lanes {
        let bare = fresnel_dielectric(cos, self.eta);
        let plain = Lanes::splat(2.0 * bare / (1.0 + bare));
        if self.film.is_none() || self.covered == 0.0 {
            return plain;
        }
        let filmed = Reflectance::dielectric(self.eta).under(self.film, 1.0).at(cos);
        // At grazing angles A = B = 1.
        let both = filmed.map(|a| 1.0 - (1.0 - a) * (1.0 - bare) / (1.0 - a * bare).max(1e-6));
        plain * (1.0 - self.covered) + both * self.covered
    }

    /// Mean of [`Self::slab`] over the hemisphere.
    fn slab_mean(&self) -> Lanes {
        hemispherical_mean(|mu| self.slab(mu))
    }

    pub fn eval(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> Lanes {
        let up = folded(wi);
        let h = half_reflected(wo, up);
        let (r, single) = (self.slab(wo.dot(h)), self.micro.reflection(wo, up, h));
        let (further, mean) = match self.micro.restored_mean() {
            Some(lost) => {
                (self.micro.restored(wo) * self.micro.restored(up) * FRAC_1_PI / lost, self.slab_mean())
            }
            None => (0.0, Lanes::ZERO),
        };
        if wi.z > 0.0 && allowed.contains(REFLECTION) {
            self.reflectance * (r * single + mean * further)
        } else if wi.z < 0.0 && allowed.contains(TRANSMISSION) {
            self.transmittance * ((Lanes::ONE - r) * single + (Lanes::ONE - mean) * further)
        } else {
            Lanes::ZERO
        }
    }

    /// Probability of the near side, of which the share `r` is reflected.
    #[inline]
    fn p_near(&self, r: Lanes, allowed: Lobes) -> f32 {
        match (allowed.contains(REFLECTION), allowed.contains(TRANSMISSION)) {
            (true, false) => 1.0,
            (false, _) => 0.0,
            (true, true) => {
                let (r, t) = ((r * self.reflectance).max(), ((Lanes::ONE - r) * self.transmittance).max());
                if r + t > 0.0 { r / (r + t) } else { 0.5 }
            }
        }
    }

    pub fn pdf_w(&self, wo: Vec3, wi: Vec3, allowed: Lobes) -> f32 {
        let lobe = if wi.z > 0.0 { REFLECTION } else { TRANSMISSION };
        if !allowed.contains(lobe) {
            return 0.0;
        }
        let up = folded(wi);
        let side = |near: f32| if wi.z > 0.0 { near } else { 1.0 - near };
        let h = half_reflected(wo, up);
        let single = self.micro.pdf_reflected(wo, h) * side(self.p_near(self.slab(wo.dot(h)), allowed));
        let p = self.micro.restored(wo);
        if p == 0.0 {
            return single;
        }
        let further = further_pdf_w(up.z, self.alpha) * side(self.p_near(self.slab_mean(), allowed));
        (1.0 - p) * single + p * further
    }

    /// A direction of density [`Self::pdf_w`].
    pub fn direction(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<Vec3> {
        if !allowed.contains(REFLECTION) && !allowed.contains(TRANSMISSION) {
            return None;
        }
        let p = self.micro.restored(wo);
        let (up, near, u_side) = if u_lobe < p {
            (sample_further(u, self.alpha), self.p_near(self.slab_mean(), allowed), u_lobe / p)
        } else {
            let up = self.micro.sample_reflected(wo, u);
            if up.z <= 0.0 {
                return None;
            }
            let r = self.slab(wo.dot(half_reflected(wo, up)));
            (up, self.p_near(r, allowed), (u_lobe - p) / (1.0 - p))
        };
        let near = u_side < near;
        (up.z > 0.0).then_some(Vec3::new(up.x, up.y, if near { up.z } else { -up.z }))
    }

    pub fn sample(&self, wo: Vec3, allowed: Lobes, u_lobe: f32, u: [f32; 2]) -> Option<BsdfSample> {
        let wi = self.direction(wo, allowed, u_lobe, u)?;
        let lobes = if wi.z > 0.0 { REFLECTION } else { TRANSMISSION };
        BsdfSample::of(wi, self.eval(wo, wi, allowed), self.pdf_w(wo, wi, allowed), lobes, 1.0)
    }

    /// The smooth slab: mirrored and straight on.
    #[inline]
    pub fn delta_lobes(&self, wo: Vec3) -> [Option<DeltaLobe>; 2] {
        let r = self.slab(wo.z);
        let straight = DeltaLobe { weight: self.transmittance * (Lanes::ONE - r), ..null::lobe(wo) };
        [Some(mirror::lobe(wo, self.reflectance * r)), Some(straight)]
    }

    /// Reflectance plus transmittance, Fresnel taken at the mirror's angle.
    pub fn albedo(&self, cos_o: f32) -> Lanes {
        let r = self.slab(cos_o);
        self.reflectance * r + self.transmittance * (Lanes::ONE - r)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use color::reflectance_to_rgb;

    use super::*;
    use crate::facets::Facets;

    /// What a film on a base reflects at one wavelength, by its characteristic matrix (Born & Wolf 1999, §1.6).
    fn face(cos: f64, eta: f64, base: f64, thickness: f64, nm: f64) -> f64 {
        let sin2 = 1.0 - cos * cos;
        let (c2, c3) = ((1.0 - sin2 / (eta * eta)).sqrt(), (1.0 - sin2 / (base * base)).sqrt());
        let (s, c) = (TAU * eta * thickness * c2 / nm).sin_cos();
        let of = |p1: f64, p2: f64, p3: f64| {
            let (re, im) = ((p1 * c, p3 * c), (p1 * p3 * s / p2, p2 * s));
            ((re.0 - re.1).powi(2) + (im.0 - im.1).powi(2)) / ((re.0 + re.1).powi(2) + (im.0 + im.1).powi(2))
        };
        0.5 * (of(cos, eta * c2, base * c3) + of(cos, c2 / eta, c3 / base))
    }

    /// The sheet by counting what leaves after each bounce between its faces, seen from the side of the face `a`.
    fn sheet(a: f64, b: f64) -> f64 {
        let (mut reflected, mut inside) = (a, 1.0 - a);
        for _ in 0..200 {
            let back = inside * b;
            reflected += back * (1.0 - a);
            inside = back * a;
        }
        reflected
    }

    fn filmed(eta: f32, film: Film, covered: f32) -> Thin {
        let micro = Micro::new(Facets::Conserving, [0.0; 2]);
        Thin { micro, alpha: 0.0, eta, film, covered, reflectance: Lanes::ONE, transmittance: Lanes::ONE }
    }

    #[test]
    fn sheets_under_films_are_those_of_transfer_matrices() {
        for (d, eta, base) in [(300.0, 2.0, 1.5), (120.0, 1.38, 1.5), (600.0, 1.3, 1.8)] {
            let thin = filmed(base as f32, Film::new(d, eta), 1.0);
            for cos in [1.0, 0.6, 0.2] {
                let bare = face(cos, 1.0, base, 0.0, 500.0);
                let film = |nm| face(cos, f64::from(eta), base, f64::from(d), nm);
                let [front, back] = [
                    reflectance_to_rgb(|nm| sheet(film(nm), bare)),
                    reflectance_to_rgb(|nm| sheet(bare, film(nm))),
                ];
                let found = thin.slab(cos as f32).to_rgb();
                for i in 0..3 {
                    assert!((front[i] - back[i]).abs() < 1e-9);
                    let error = (f64::from(found[i]) - front[i]).abs();
                    // Saturated colours of films lie outside of RGB and are moved in, which is most of this.
                    assert!(error < 0.015, "{d} {eta} {base} {cos}: {found:?} {front:?}");
                }
            }
        }
    }

    #[test]
    fn a_film_colours_a_pane() {
        let [r, g, b] = filmed(1.5, Film::new(300.0, 2.0), 1.0).slab(1.0).to_rgb();
        for (found, expected) in [(r, 0.044), (g, 0.152), (b, 0.201)] {
            assert!((found - expected).abs() < 1e-3, "{r} {g} {b}");
        }
        // Half of it covered is half of each; a film of the pane's own index and none change nothing.
        let half = filmed(1.5, Film::new(300.0, 2.0), 0.5).slab(1.0).to_rgb();
        assert!((half[2] - 0.5 * (b + 0.08 / 1.04)).abs() < 1e-3, "{half:?}");
        for thin in [filmed(1.5, Film::new(300.0, 1.5), 1.0), filmed(1.5, Film::NONE, 1.0)] {
            assert!((thin.slab(0.7) - filmed(1.5, Film::NONE, 0.0).slab(0.7)).0.abs().max_element() < 1e-3);
        }
        // Grazing light is all reflected, whatever the film.
        assert!(
            (filmed(1.5, Film::new(300.0, 2.0), 1.0).slab(0.0) - Lanes::ONE).0.abs().max_element() < 1e-3
        );
    }
}
