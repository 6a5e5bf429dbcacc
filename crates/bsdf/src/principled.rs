use color::Lanes;
use math::Vec4;

use crate::film::Film;
use crate::slab::{self, Missing};

/// What lies behind a principled surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interior {
    /// A solid: light is refracted, and its other side is met when it leaves.
    #[default]
    Solid,
    /// Nothing: the surface is a thin sheet, which light crosses straight on.
    Thin,
}

/// Parameters of the principled model: the slab of OpenPBR and of Disney's BSDF (Burley 2012, 2015) in this order from outside:
/// sheen, clearcoat, then metal or dielectric by `metallic`; the dielectric transmits specularly by `transmission`, or lies on a
/// diffuse base, part of which transmits by `diffuse_transmission`. Numbers are in [0, 1] unless said otherwise
/// (moved in when packed); colours are factors in [0, 1] per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledParameters {
    /// Reflectance of the diffuse base; of the metal at normal incidence; tint of transmission (its root for each crossing of the
    /// surface of a solid, all of it for a thin sheet).
    pub base_color: Lanes,
    /// Share of metal.
    pub metallic: f32,
    /// GGX roughness along x and y of the frame, values below 10⁻⁴ used as that (see [`disney_alpha`], [`gltf_alpha`]).
    pub alpha: [f32; 2],
    /// Index. Of a solid that transmits: on the side of −ns over that on the side of +ns, nested media resolved by the caller; else of the
    /// inside over the outside, an index below 1 being used as its inverse. The specular reflection under a diffuse base covers [1, 4].
    pub eta: f32,
    /// Factor of dielectric specular reflection.
    pub specular: f32,
    /// Colour of dielectric specular reflection.
    pub specular_color: Lanes,
    /// Share of the dielectric that transmits specularly.
    pub transmission: f32,
    /// What lies behind.
    pub interior: Interior,
    /// Share of the diffuse base that is transmitted.
    pub diffuse_transmission: f32,
    /// Colour of the sheen (black: none).
    pub sheen_color: Lanes,
    /// Its roughness, α of [`crate::BsdfKind::Sheen`]: for glTF the square of `sheenRoughnessFactor`.
    pub sheen_alpha: f32,
    /// Share of the surface under a clear coat of index 1.5.
    pub clearcoat: f32,
    /// GGX roughness of the coat, below 10⁻⁴ used as that.
    pub clearcoat_alpha: f32,
    /// Thin film on metal and dielectric, below the clear coat.
    pub film: Film,
    /// Share of the surface under the film.
    pub film_weight: f32,
}

impl Default for PrincipledParameters {
    /// Grey plastic of index 1.5 and α 0.25.
    fn default() -> Self {
        Self {
            base_color: Lanes::splat(0.8),
            metallic: 0.0,
            alpha: [0.25; 2],
            eta: 1.5,
            specular: 1.0,
            specular_color: Lanes::ONE,
            transmission: 0.0,
            interior: Interior::Solid,
            diffuse_transmission: 0.0,
            sheen_color: Lanes::ZERO,
            sheen_alpha: 0.25,
            clearcoat: 0.0,
            clearcoat_alpha: 1e-3,
            film: Film::NONE,
            film_weight: 1.0,
        }
    }
}

/// [`PrincipledParameters`] in 60 bytes. Colours and roughnesses keep 16 bits of their root, shares 16 bits; 0 and 1 are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    base_color: [u16; 4],
    specular_color: [u16; 4],
    sheen_color: [u16; 4],
    eta: f32,
    metallic: u16,
    alpha: [u16; 2],
    specular: u16,
    transmission: u16,
    diffuse_transmission: u16,
    sheen_alpha: u16,
    clearcoat: u16,
    clearcoat_alpha: u16,
    film_weight: u16,
    film: Film,
    interior: Interior,
    /// Roots of [`slab::Missing`].
    missing: [u16; 2],
}

const STEPS: f32 = 65535.0;

/// NaN becomes 0.
fn pack(x: f32) -> u16 {
    (x * STEPS + 0.5) as u16
}

fn unpack(x: u16) -> f32 {
    f32::from(x) / STEPS
}

fn pack_root(x: f32) -> u16 {
    pack(x.max(0.0).sqrt())
}

fn unpack_root(x: u16) -> f32 {
    let r = unpack(x);
    r * r
}

fn pack_color(c: Lanes) -> [u16; 4] {
    c.0.to_array().map(pack_root)
}

fn unpack_color(c: [u16; 4]) -> Lanes {
    Lanes(Vec4::from_array(c.map(unpack_root)))
}

impl Principled {
    /// Packs parameters.
    pub fn new(p: &PrincipledParameters) -> Self {
        let eta = if p.eta.is_finite() && p.eta > 0.0 { p.eta } else { 1.0 };
        let packed = Self {
            base_color: pack_color(p.base_color),
            specular_color: pack_color(p.specular_color),
            sheen_color: pack_color(p.sheen_color),
            eta: if p.transmission > 0.0 && p.interior == Interior::Solid { eta } else { eta.max(1.0 / eta) },
            metallic: pack(p.metallic),
            alpha: p.alpha.map(pack_root),
            specular: pack(p.specular),
            transmission: pack(p.transmission),
            diffuse_transmission: pack(p.diffuse_transmission),
            sheen_alpha: pack_root(p.sheen_alpha),
            clearcoat: pack(p.clearcoat),
            clearcoat_alpha: pack_root(p.clearcoat_alpha),
            film_weight: pack(p.film_weight),
            film: p.film,
            interior: p.interior,
            missing: [0; 2],
        };
        let Missing { base, metal } = slab::missing(&packed.parameters());
        Self { missing: [base, metal].map(pack_root), ..packed }
    }

    /// Means of what layers leave to the base and keep back of metal.
    #[inline]
    pub(crate) fn missing(&self) -> Missing {
        let [base, metal] = self.missing.map(unpack_root);
        Missing { base, metal }
    }

    /// Unpacks them.
    pub fn parameters(&self) -> PrincipledParameters {
        PrincipledParameters {
            base_color: unpack_color(self.base_color),
            metallic: unpack(self.metallic),
            alpha: self.alpha.map(unpack_root),
            eta: self.eta,
            specular: unpack(self.specular),
            specular_color: unpack_color(self.specular_color),
            transmission: unpack(self.transmission),
            interior: self.interior,
            diffuse_transmission: unpack(self.diffuse_transmission),
            sheen_color: unpack_color(self.sheen_color),
            sheen_alpha: unpack_root(self.sheen_alpha),
            clearcoat: unpack(self.clearcoat),
            clearcoat_alpha: unpack_root(self.clearcoat_alpha),
            film: self.film,
            film_weight: unpack(self.film_weight),
        }
    }

    /// Whether any of it is dielectric.
    fn has_dielectric(&self) -> bool {
        self.metallic < u16::MAX
    }

    /// Whether it has a diffuse lobe: a base that is neither all metal nor all transmission, or sheen.
    pub fn has_diffuse(&self) -> bool {
        self.sheen_color != [0; 4] || (self.has_dielectric() && self.transmission < u16::MAX)
    }

    /// Whether it transmits specularly.
    pub fn has_transmission(&self) -> bool {
        self.has_dielectric() && self.transmission > 0
    }

    /// Whether part of its diffuse base transmits.
    pub fn has_diffuse_transmission(&self) -> bool {
        self.has_dielectric() && self.transmission < u16::MAX && self.diffuse_transmission > 0
    }

    /// Whether its two sides differ, as those of a solid that light enters do.
    pub fn is_sided(&self) -> bool {
        self.has_transmission() && self.interior == Interior::Solid
    }
}

/// GGX α along x and y of Disney's `roughness` and `anisotropic` (Burley 2012, §5.4; Mitsuba's `principled`): r²/a and
/// r²·a, a = √(1 − 0.9·anisotropic).
pub fn disney_alpha(roughness: f32, anisotropic: f32) -> [f32; 2] {
    let (r2, aspect) = (roughness * roughness, (1.0 - 0.9 * anisotropic.clamp(0.0, 1.0)).sqrt());
    [(r2 / aspect).min(1.0), r2 * aspect]
}

/// GGX α along the direction of anisotropy and across it, of glTF's `roughnessFactor` and `anisotropyStrength`
/// (KHR_materials_anisotropy).
pub fn gltf_alpha(roughness: f32, strength: f32) -> [f32; 2] {
    let r2 = roughness * roughness;
    [r2 + (1.0 - r2) * strength * strength, r2]
}

/// The index of Disney's `specular` (Burley 2015, §3.2): 2/(1 − √(0.08·specular)) − 1.
pub fn disney_eta(specular: f32) -> f32 {
    2.0 / (1.0 - (0.08 * specular.clamp(0.0, 1.0)).sqrt()) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_keeps_what_matters() {
        let p = PrincipledParameters {
            base_color: Lanes::rgb(0.001, 0.5, 1.0),
            metallic: 1.0,
            alpha: [1e-3, 0.3],
            sheen_color: Lanes::rgb(0.2, 0.0, 0.0),
            ..Default::default()
        };
        let q = Principled::new(&p).parameters();
        assert!((q.base_color - p.base_color).0.abs().max_element() < 1e-5 && q.base_color.0.z == 1.0);
        assert!(q.metallic == 1.0 && q.sheen_color.0.y == 0.0 && (q.alpha[0] / 1e-3 - 1.0).abs() < 1e-3);
        assert_eq!(Principled::new(&q), Principled::new(&p));
        assert!(size_of::<Principled>() <= 60);
        let bad = PrincipledParameters { metallic: f32::NAN, eta: f32::NAN, specular: 7.0, ..p };
        let q = Principled::new(&bad).parameters();
        assert_eq!((q.metallic, q.eta, q.specular), (0.0, 1.0, 1.0));
    }

    #[test]
    fn conversions() {
        assert!((disney_eta(0.5) - 1.5).abs() < 1e-6);
        assert_eq!(disney_alpha(0.5, 0.0), [0.25, 0.25]);
        let [x, y] = disney_alpha(0.5, 1.0);
        assert!((x / y - 10.0).abs() < 1e-4 && (x * y - 0.0625).abs() < 1e-6);
        assert_eq!(gltf_alpha(0.5, 1.0), [1.0, 0.25]);
    }
}
