use color::Lanes;

use crate::coated_conductor::CoatedConductor;
use crate::conductor;
use crate::dielectric;
use crate::diffuse;
use crate::facets::{Facets, is_smooth};
use crate::film::Film;
use crate::glass::{self, is_matched};
use crate::lobes::Lobes;
use crate::mirror;
use crate::null;
use crate::phong;
use crate::plastic::Plastic;
use crate::principled::Principled;
use crate::translucent;

/// What a surface is made of. Reflectances are factors in [0, 1] per lane; the caller keeps them there. Roughness pairs are
/// GGX (or Beckmann) α along x and y of the frame: [0, 0] is a smooth surface, whose lobes are deltas; else
/// values below 10⁻⁴ are used as that and values above 1 as 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BsdfKind {
    /// Lambert.
    Diffuse {
        /// Reflectance.
        albedo: Lanes,
    },
    /// Energy-normalised modified Phong (Lafortune & Willems 1994).
    Phong {
        /// Reflectance of the diffuse lobe, kd.
        diffuse: Lanes,
        /// Greatest reflectance of the specular lobe (at normal incidence), ks; kd + ks ≤ 1.
        specular: Lanes,
        /// n ≥ 0.
        exponent: f32,
    },
    /// A perfect mirror, without Fresnel.
    Mirror {
        /// Reflectance.
        color: Lanes,
    },
    /// A smooth dielectric interface.
    Dielectric {
        /// Index on the side of −ns over the index on the side of +ns, > 0. The caller resolves nested media.
        eta: f32,
        /// Factor of transmitted light; reflection is not tinted.
        tint: Lanes,
    },
    /// A metal, seen alike from both sides.
    Conductor {
        /// Real part of the index, relative to that outside.
        n: Lanes,
        /// Imaginary part (extinction), relative to the index outside.
        k: Lanes,
        /// GGX roughness; 0: smooth (a delta lobe). Values in (0, 1e-4) are used as 1e-4.
        alpha: f32,
    },
    /// A dielectric coat over a diffuse base, seen alike from both sides.
    Plastic {
        /// Reflectance of the base.
        albedo: Lanes,
        /// Index of the coat over that outside; moved into [1, 4].
        eta: f32,
        /// GGX roughness of the coat; 0: smooth (a delta lobe). Values in (0, 1e-4) are used as 1e-4.
        alpha: f32,
    },
    /// No surface: light goes straight on.
    Null,
    /// Absorbs all light.
    Black,
    /// Energy-preserving Oren–Nayar (Portsmouth, Kutz & Hill 2025), seen alike from both sides.
    RoughDiffuse {
        /// Reflectance under light from all sides, for roughness 0; of a white surface always.
        albedo: Lanes,
        /// r in [0, 1]; 0 is Lambert. For Oren & Nayar's σ in radians, r = B/A,
        /// A = 1 − σ²/(2(σ² + 0.33)), B = 0.45 σ²/(σ² + 0.09).
        roughness: f32,
    },
    /// Lambertian reflection and transmission, alike from both sides.
    DiffuseTransmission {
        /// Share reflected; with `transmittance` at most 1.
        reflectance: Lanes,
        /// Share transmitted.
        transmittance: Lanes,
    },
    /// Upright fibres over black (Estevez & Kulla 2017), seen alike from both sides.
    Sheen {
        /// Reflectance of the fibres: factor of the lobe, whose albedo is below 1.
        color: Lanes,
        /// Roughness r of the paper, moved into [0.07, 1].
        alpha: f32,
    },
    /// A thin slab of a dielectric with all reflections between its faces; light crosses it straight on. Alike from both sides.
    ThinDielectric {
        /// Index of the slab over that outside, > 0.
        eta: f32,
        /// Roughness; that of transmission mirrors that of reflection.
        alpha: [f32; 2],
        /// Factor of reflected light.
        reflectance: Lanes,
        /// Factor of transmitted light.
        transmittance: Lanes,
    },
    /// A metal with all that rough metals may have; [`BsdfKind::Conductor`] is its plain form.
    RoughConductor {
        /// Real part of the index, relative to that outside.
        n: Lanes,
        /// Imaginary part (extinction), relative to the index outside.
        k: Lanes,
        /// Factor of all that is reflected.
        reflectance: Lanes,
        /// Roughness.
        alpha: [f32; 2],
        /// Model of the facets.
        facets: Facets,
        /// Interference film.
        film: Film,
    },
    /// A dielectric interface with all that it may have; [`BsdfKind::Dielectric`] is its plain smooth form. Indices within
    /// 10⁻³ of each other make no surface: light goes straight on, by a delta lobe.
    RoughDielectric {
        /// Index on the side of −ns over the index on the side of +ns, > 0. The caller resolves nested media. Energy is
        /// tabulated for [1/4, 4].
        eta: f32,
        /// Roughness.
        alpha: [f32; 2],
        /// Factor of reflected light.
        reflectance: Lanes,
        /// Factor of transmitted light.
        transmittance: Lanes,
        /// Model of the facets.
        facets: Facets,
        /// Interference film on the side of +ns (its index relative to that side).
        film: Film,
    },
    /// A dielectric coat over a diffuse base with all that it may have; [`BsdfKind::Plastic`] is its plain form. Alike from both
    /// sides. With conserving facets the base takes all that the coat's single bounce does not reflect; with the others what the
    /// coat's facets lose is lost, at each crossing and inner reflection, as in Mitsuba's `roughplastic` and, on the mean, in a random
    /// walk between the layers (pbrt-v4).
    CoatedDiffuse {
        /// Reflectance of the base (see [`crate::linear_plastic_albedo`], [`crate::absorbing_coat_albedo`]).
        albedo: Lanes,
        /// Factor of what the coat reflects.
        specular: Lanes,
        /// Index of the coat over that outside; moved into [1, 4].
        eta: f32,
        /// Roughness of the coat.
        alpha: [f32; 2],
        /// Model of the facets.
        facets: Facets,
    },
    /// A dielectric coat over a metal, alike from both sides.
    CoatedConductor {
        /// Real part of the metal's index, relative to that outside the coat.
        n: Lanes,
        /// Imaginary part (extinction), relative to the index outside the coat.
        k: Lanes,
        /// Roughness of the metal.
        alpha: [f32; 2],
        /// Index of the coat over that outside; moved into [1, 4].
        eta: f32,
        /// GGX roughness of the coat; 0: smooth (a delta lobe).
        coat_alpha: f32,
        /// Optical depth of the coat along its normal, ≥ 0 (pbrt-v4's `thickness`, where its `albedo` is 0).
        depth: f32,
        /// Model of the facets of both; all but the first are the same here (GGX, and dark with roughness as a random walk through
        /// single bounces is).
        facets: Facets,
    },
    /// Everything at once: OpenPBR's and Disney's slab, glTF's materials.
    Principled(Principled),
}

impl BsdfKind {
    /// Properties of all its lobes together.
    #[inline]
    pub fn lobes(&self) -> Lobes {
        match *self {
            Self::Diffuse { .. } => diffuse::LOBES,
            Self::Phong { .. } => diffuse::LOBES | phong::GLOSSY,
            Self::Mirror { .. } => mirror::LOBES,
            Self::Dielectric { .. } => dielectric::REFLECTION | dielectric::TRANSMISSION,
            Self::Plastic { alpha, .. } => diffuse::LOBES | Plastic::coat_lobes([alpha; 2]),
            Self::Conductor { alpha, .. } => reflection([alpha; 2]),
            Self::Null => null::LOBES,
            Self::Black => Lobes::NONE,
            _ => self.lobes_of_others(),
        }
    }

    #[inline(never)]
    fn lobes_of_others(&self) -> Lobes {
        match *self {
            Self::RoughDiffuse { .. } | Self::Sheen { .. } => diffuse::LOBES,
            Self::DiffuseTransmission { .. } => diffuse::LOBES | translucent::TRANSMISSION,
            Self::RoughConductor { alpha, .. } => reflection(alpha),
            Self::ThinDielectric { alpha, .. } => both_sides(alpha),
            Self::RoughDielectric { eta, film, .. } if is_matched(eta) && film.is_none() => null::LOBES,
            Self::RoughDielectric { eta, alpha, .. } => {
                both_sides(if is_matched(eta) { [0.0; 2] } else { alpha })
            }
            Self::CoatedDiffuse { alpha, .. } => diffuse::LOBES | reflection(alpha),
            Self::CoatedConductor { alpha, coat_alpha, .. } => CoatedConductor::lobes(alpha, coat_alpha),
            Self::Principled(p) => {
                let mut lobes = conductor::GLOSSY;
                if p.has_transmission() {
                    lobes = lobes | glass::TRANSMISSION;
                }
                if p.has_diffuse() {
                    lobes = lobes | diffuse::LOBES;
                }
                if p.has_diffuse_transmission() {
                    lobes = lobes | translucent::TRANSMISSION;
                }
                lobes
            }
            _ => Lobes::NONE,
        }
    }

    /// Whether it scatters, and by delta lobes alone.
    #[inline]
    pub fn is_delta_only(&self) -> bool {
        let lobes = self.lobes();
        lobes.contains(Lobes::SPECULAR) && !lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY)
    }

    /// Whether it has a lobe flagged [`Lobes::DIFFUSE`]: a surface on which photons are stored and looked up. By kind: Lambert,
    /// Phong's, plastic's and coated bases, Oren–Nayar, diffuse transmission, sheen. The principled model has one unless it is all metal or
    /// all specular transmission (weights of exactly 1) and without sheen: a lobe of weight 0 is none. Never a matter of
    /// roughness: metals, coated metals and glass have none, however rough.
    #[inline]
    pub fn has_diffuse(&self) -> bool {
        self.lobes().contains(Lobes::DIFFUSE)
    }
}

/// Reflection in facets of roughness `alpha`.
fn reflection(alpha: [f32; 2]) -> Lobes {
    if is_smooth(alpha) { mirror::LOBES } else { conductor::GLOSSY }
}

/// Reflection and transmission in facets of roughness `alpha`.
fn both_sides(alpha: [f32; 2]) -> Lobes {
    if is_smooth(alpha) {
        dielectric::REFLECTION | dielectric::TRANSMISSION
    } else {
        glass::REFLECTION | glass::TRANSMISSION
    }
}
