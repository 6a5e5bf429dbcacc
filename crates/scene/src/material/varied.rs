//! The kinds of material that have many parameters.

use bsdf::{
    BsdfKind, Facets, Film, Interior, Principled, PrincipledParameters, absorbing_coat_albedo,
    linear_plastic_albedo,
};
use color::Lanes;

use super::source::{ColorSource, FloatSource, Place, RoughnessSource};

/// Whether a factor changes nothing. Only the lanes that colours fill are compared.
fn is_one(factor: ColorSource) -> bool {
    matches!(factor, ColorSource::Constant(lanes) if lanes.to_rgb() == [1.0; 3])
}

/// A dielectric solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricMaterial {
    /// Refractive index.
    pub ior: f32,
    /// As [`Medium::outside`](crate::Medium::outside).
    pub outside: f32,
    /// Transmittance of one crossing.
    pub color: ColorSource,
    /// Factor of what is reflected.
    pub specular: ColorSource,
    /// Of the surface.
    pub roughness: RoughnessSource,
    /// Model of its facets.
    pub facets: Facets,
    /// Thickness (nm; 0: none) and index of a film on the outside.
    pub film: [f32; 2],
    /// What the inside absorbs, per unit of length.
    pub absorption: Lanes,
    /// Rank among overlapping dielectrics.
    pub priority: i32,
}

impl DielectricMaterial {
    pub(super) fn is_uniform(&self) -> bool {
        self.color.is_constant() && self.specular.is_constant() && self.roughness.is_constant()
    }

    pub(super) fn bsdf(&self, at: &Place<'_>, eta: f32) -> BsdfKind {
        let tint = at.color(self.color);
        if is_one(self.specular) && self.film[0] == 0.0 && self.roughness.is_smooth() {
            return BsdfKind::Dielectric { eta, tint };
        }
        BsdfKind::RoughDielectric {
            eta,
            alpha: self.roughness.alpha(at),
            reflectance: at.color(self.specular),
            transmittance: tint,
            facets: self.facets,
            // Its index over that of the outside, which is ior/eta.
            film: Film::new(self.film[0], self.film[1] * eta / self.ior),
        }
    }
}

/// A metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorMaterial {
    /// Real part of the index.
    pub n: Lanes,
    /// Imaginary part of the index.
    pub k: Lanes,
    /// Factor of what is reflected.
    pub specular: ColorSource,
    /// Of the surface.
    pub roughness: RoughnessSource,
    /// Model of its facets.
    pub facets: Facets,
    /// Film on the surface.
    pub film: Film,
}

impl ConductorMaterial {
    pub(super) fn is_uniform(&self) -> bool {
        self.specular.is_constant() && self.roughness.is_constant()
    }

    pub(super) fn bsdf(&self, at: &Place<'_>) -> BsdfKind {
        let &Self { n, k, facets, film, .. } = self;
        let alpha = self.roughness.alpha(at);
        let plain = facets == Facets::Conserving || self.roughness.is_smooth();
        if is_one(self.specular) && film.is_none() && plain && alpha[0] == alpha[1] {
            return BsdfKind::Conductor { n, k, alpha: alpha[0] };
        }
        BsdfKind::RoughConductor { n, k, reflectance: at.color(self.specular), alpha, facets, film }
    }
}

/// Steps of the table of a coat that absorbs.
const COAT_STEPS: usize = 64;
/// Reflections at the base of an absorbing coat that count: all that carry anything.
const COAT_BOUNCES: u32 = 64;

/// A dielectric coat over a diffuse base.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuseMaterial {
    /// Reflectance of the base.
    pub color: ColorSource,
    /// Factor of what the coat reflects.
    pub specular: ColorSource,
    /// Index of the coat.
    pub ior: f32,
    /// Of the coat.
    pub roughness: RoughnessSource,
    /// Model of its facets.
    pub facets: Facets,
    /// Whether light thrown back onto the base takes its colour each time.
    pub nonlinear: bool,
    /// [`absorbing_coat_albedo`] of 0, 1/64, …, 1; empty where the coat is clear.
    absorbed: Vec<f32>,
}

impl CoatedDiffuseMaterial {
    /// With a coat of optical depth `depth` along its normal.
    pub fn new(
        color: ColorSource,
        specular: ColorSource,
        ior: f32,
        roughness: RoughnessSource,
        facets: Facets,
        nonlinear: bool,
        depth: f32,
    ) -> Self {
        let of = |i: usize| {
            let albedo = Lanes::splat(i as f32 / COAT_STEPS as f32);
            absorbing_coat_albedo(albedo, ior, depth, COAT_BOUNCES).0.x
        };
        let absorbed = if depth > 0.0 { (0..=COAT_STEPS).map(of).collect() } else { Vec::new() };
        Self { color, specular, ior, roughness, facets, nonlinear, absorbed }
    }

    pub(super) fn is_uniform(&self) -> bool {
        self.color.is_constant() && self.specular.is_constant() && self.roughness.is_constant()
    }

    pub(super) fn bsdf(&self, at: &Place<'_>) -> BsdfKind {
        let (alpha, facets, eta) = (self.roughness.alpha(at), self.facets, self.ior);
        let mut albedo = at.color(self.color);
        if !self.nonlinear {
            albedo = linear_plastic_albedo(albedo, eta, alpha, facets);
        }
        if !self.absorbed.is_empty() {
            albedo = albedo.map(|a| self.after_absorption(a));
        }
        BsdfKind::CoatedDiffuse { albedo, specular: at.color(self.specular), eta, alpha, facets }
    }

    fn after_absorption(&self, albedo: f32) -> f32 {
        let x = albedo.clamp(0.0, 1.0) * COAT_STEPS as f32;
        let i = (x as usize).min(COAT_STEPS - 1);
        let t = x - i as f32;
        self.absorbed[i] * (1.0 - t) + self.absorbed[i + 1] * t
    }
}

/// A dielectric coat over a metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatedConductorMaterial {
    /// Real part of the metal's index.
    pub n: Lanes,
    /// Imaginary part of the metal's index.
    pub k: Lanes,
    /// Of the metal.
    pub roughness: RoughnessSource,
    /// Index of the coat.
    pub ior: f32,
    /// The coat's α is the square of this.
    pub coat_roughness: FloatSource,
    /// Optical depth of the coat along its normal.
    pub depth: f32,
    /// Model of the facets of both.
    pub facets: Facets,
}

impl CoatedConductorMaterial {
    pub(super) fn is_uniform(&self) -> bool {
        self.roughness.is_constant() && self.coat_roughness.is_constant()
    }

    pub(super) fn bsdf(&self, at: &Place<'_>) -> BsdfKind {
        let &Self { n, k, depth, facets, .. } = self;
        let coat_alpha = at.share(self.coat_roughness).powi(2);
        BsdfKind::CoatedConductor {
            n,
            k,
            alpha: self.roughness.alpha(at),
            eta: self.ior,
            coat_alpha,
            depth,
            facets,
        }
    }
}

/// Sources of [`PrincipledParameters`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledMaterial {
    /// Reflectance of base and metal, tint of transmission.
    pub base_color: ColorSource,
    /// Share of metal.
    pub metallic: FloatSource,
    /// Of metal and dielectric.
    pub roughness: RoughnessSource,
    /// Refractive index.
    pub ior: f32,
    /// Factor of dielectric reflection.
    pub specular: FloatSource,
    /// Colour of dielectric reflection.
    pub specular_color: ColorSource,
    /// Share that transmits specularly.
    pub transmission: FloatSource,
    /// What lies behind.
    pub interior: Interior,
    /// Share of the base that is transmitted.
    pub diffuse_transmission: FloatSource,
    /// Colour of the sheen.
    pub sheen_color: ColorSource,
    /// The sheen's α is the square of this.
    pub sheen_roughness: FloatSource,
    /// Share under a clear coat.
    pub clearcoat: FloatSource,
    /// The coat's α is the square of this.
    pub clearcoat_roughness: FloatSource,
    /// Share under the film.
    pub film: FloatSource,
    /// Thickness of the film, nm.
    pub film_thickness_nm: FloatSource,
    /// Index of the film.
    pub film_ior: f32,
    /// What the inside of a solid absorbs, per unit of length.
    pub absorption: Lanes,
    /// Rank among overlapping dielectrics.
    pub priority: i32,
    /// Whether light may enter a solid through it.
    pub is_solid: bool,
}

impl PrincipledMaterial {
    fn colors(&self) -> [ColorSource; 3] {
        [self.base_color, self.specular_color, self.sheen_color]
    }

    fn floats(&self) -> [FloatSource; 9] {
        [
            self.metallic,
            self.specular,
            self.transmission,
            self.diffuse_transmission,
            self.sheen_roughness,
            self.clearcoat,
            self.clearcoat_roughness,
            self.film,
            self.film_thickness_nm,
        ]
    }

    pub(super) fn is_uniform(&self) -> bool {
        self.roughness.is_constant()
            && self.colors().iter().all(|c| c.is_constant())
            && self.floats().iter().all(|f| f.is_constant())
    }

    /// Share of the surface, roughly, that stores no photons: it is all metal or all transmission, without sheen.
    pub(super) fn specular_share(&self, textures: &[crate::Texture]) -> f32 {
        if self.sheen_color != ColorSource::Constant(Lanes::ZERO) {
            return 0.0;
        }
        let share = |source: FloatSource| match source {
            FloatSource::Constant(x) if x >= 1.0 => 1.0,
            FloatSource::Constant(_) => 0.0,
            // Wherever it is 1; that may be anywhere.
            FloatSource::Texture(_) => source.mean(textures).clamp(0.05, 1.0),
        };
        share(self.metallic).max(share(self.transmission))
    }

    pub(super) fn bsdf(&self, at: &Place<'_>, eta: f32) -> BsdfKind {
        let film_weight = at.share(self.film);
        let eta = if self.is_solid { eta } else { self.ior };
        let film = if film_weight > 0.0 {
            let outside = if self.is_solid { self.ior / eta } else { 1.0 };
            Film::new(at.float(self.film_thickness_nm), self.film_ior / outside)
        } else {
            Film::NONE
        };
        BsdfKind::Principled(Principled::new(&PrincipledParameters {
            base_color: at.color(self.base_color),
            metallic: at.share(self.metallic),
            alpha: self.roughness.alpha(at),
            eta,
            specular: at.share(self.specular),
            specular_color: at.color(self.specular_color),
            transmission: at.share(self.transmission),
            interior: self.interior,
            diffuse_transmission: at.share(self.diffuse_transmission),
            sheen_color: at.color(self.sheen_color),
            sheen_alpha: at.share(self.sheen_roughness).powi(2),
            clearcoat: at.share(self.clearcoat),
            clearcoat_alpha: at.share(self.clearcoat_roughness).powi(2),
            film,
            film_weight,
        }))
    }
}
