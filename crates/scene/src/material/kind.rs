use bsdf::BsdfKind;
use color::Lanes;

use super::source::{ColorSource, FloatSource, Lookup, Place, RoughnessSource};
use super::varied::{
    CoatedConductorMaterial, CoatedDiffuseMaterial, ConductorMaterial, DielectricMaterial, PrincipledMaterial,
};
use crate::{MaterialId, SurfaceInteraction, Texture};

/// How a surface scatters; the BSDF at a point is made from it.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian, both sides.
    Diffuse {
        /// Reflectance.
        color: ColorSource,
    },
    /// Lambertian and modified Phong lobe.
    Phong {
        /// Diffuse reflectance.
        diffuse: ColorSource,
        /// Reflectance of the lobe.
        specular: ColorSource,
        /// Exponent of the lobe.
        exponent: FloatSource,
    },
    /// Perfect mirror.
    Mirror {
        /// Reflectance.
        color: ColorSource,
    },
    /// Dielectric solid.
    Dielectric(DielectricMaterial),
    /// Metal.
    Conductor(ConductorMaterial),
    /// Dielectric coat over a Lambertian base.
    Plastic {
        /// Reflectance of the base.
        color: ColorSource,
        /// Index of the coat.
        ior: f32,
        /// Of the coat.
        roughness: RoughnessSource,
    },
    /// Oren–Nayar, both sides.
    RoughDiffuse {
        /// Reflectance.
        color: ColorSource,
        /// 0..=1.
        roughness: FloatSource,
    },
    /// Lambertian to both sides.
    DiffuseTransmission {
        /// Share reflected.
        reflectance: ColorSource,
        /// Share transmitted.
        transmittance: ColorSource,
    },
    /// Fibres.
    Sheen {
        /// Reflectance of the fibres.
        color: ColorSource,
        /// α is the square of this.
        roughness: FloatSource,
    },
    /// A thin pane.
    ThinDielectric {
        /// Refractive index.
        ior: f32,
        /// Factor of what is transmitted.
        color: ColorSource,
        /// Factor of what is reflected.
        specular: ColorSource,
        /// Of its surfaces.
        roughness: RoughnessSource,
    },
    /// Dielectric coat over a Lambertian base, with all that it may have.
    CoatedDiffuse(Box<CoatedDiffuseMaterial>),
    /// Dielectric coat over a metal.
    CoatedConductor(CoatedConductorMaterial),
    /// Everything at once.
    Principled(Box<PrincipledMaterial>),
    /// One of two materials, by chance; see [`crate::Scene::intersect`].
    Mix {
        /// The one.
        a: MaterialId,
        /// The other.
        b: MaterialId,
        /// Share of `b`.
        amount: FloatSource,
    },
    /// Reflects nothing.
    Black,
}

impl MaterialKind {
    /// Whether nothing varies over the surface.
    pub(super) fn is_uniform(&self) -> bool {
        match self {
            Self::Diffuse { color } | Self::Mirror { color } => color.is_constant(),
            Self::Phong { diffuse, specular, exponent } => {
                diffuse.is_constant() && specular.is_constant() && exponent.is_constant()
            }
            Self::Dielectric(m) => m.is_uniform(),
            Self::Conductor(m) => m.is_uniform(),
            Self::Plastic { color, roughness, .. } => color.is_constant() && roughness.is_constant(),
            Self::RoughDiffuse { color, roughness } | Self::Sheen { color, roughness } => {
                color.is_constant() && roughness.is_constant()
            }
            Self::DiffuseTransmission { reflectance, transmittance } => {
                reflectance.is_constant() && transmittance.is_constant()
            }
            Self::ThinDielectric { color, specular, roughness, .. } => {
                color.is_constant() && specular.is_constant() && roughness.is_constant()
            }
            Self::CoatedDiffuse(m) => m.is_uniform(),
            Self::CoatedConductor(m) => m.is_uniform(),
            Self::Principled(m) => m.is_uniform(),
            Self::Mix { .. } => false,
            Self::Black => true,
        }
    }

    /// Whether it scatters differently along the tangent and across it.
    pub(super) fn is_anisotropic(&self) -> bool {
        let roughness = match self {
            Self::Dielectric(m) => m.roughness,
            Self::Conductor(m) => m.roughness,
            Self::Plastic { roughness, .. } | Self::ThinDielectric { roughness, .. } => *roughness,
            Self::CoatedDiffuse(m) => m.roughness,
            Self::CoatedConductor(m) => m.roughness,
            Self::Principled(m) => m.roughness,
            Self::Diffuse { .. }
            | Self::Phong { .. }
            | Self::Mirror { .. }
            | Self::RoughDiffuse { .. }
            | Self::DiffuseTransmission { .. }
            | Self::Sheen { .. }
            | Self::Mix { .. }
            | Self::Black => return false,
        };
        !roughness.is_isotropic() && !roughness.is_smooth()
    }

    /// Whether it reflects or refracts by facets, smooth or rough.
    pub(super) fn mirrors(&self) -> bool {
        match self {
            Self::Mirror { .. }
            | Self::Dielectric(_)
            | Self::ThinDielectric { .. }
            | Self::Conductor(_)
            | Self::Plastic { .. }
            | Self::CoatedDiffuse(_)
            | Self::CoatedConductor(_)
            | Self::Principled(_) => true,
            Self::Black
            | Self::Diffuse { .. }
            | Self::Phong { .. }
            | Self::RoughDiffuse { .. }
            | Self::DiffuseTransmission { .. }
            | Self::Sheen { .. }
            | Self::Mix { .. } => false,
        }
    }

    /// Whether light may pass through the surface.
    pub(super) fn is_crossed(&self) -> bool {
        let none = FloatSource::Constant(0.0);
        match self {
            Self::Dielectric(_) | Self::ThinDielectric { .. } | Self::DiffuseTransmission { .. } => true,
            Self::Principled(m) => m.transmission != none || m.diffuse_transmission != none,
            _ => false,
        }
    }

    /// Share of the light that it throws on specularly, roughly: how much a caustic photon aimed at it is worth; 0 where it has
    /// no specular event anywhere, and for mixes, whose parts have theirs. By kind, never by roughness.
    pub fn specular_weight(&self, textures: &[Texture]) -> f32 {
        // Only the delta reflection of a smooth coat is specular.
        let coat = |ior: f32, roughness: RoughnessSource| match roughness.is_smooth() {
            true => bsdf::fresnel_dielectric(1.0, ior),
            false if roughness.is_constant() => 0.0,
            // A map may have smooth places.
            false => 0.5 * bsdf::fresnel_dielectric(1.0, ior),
        };
        match self {
            Self::Mirror { color } => color.mean(textures),
            Self::Dielectric(_)
            | Self::Conductor(_)
            | Self::ThinDielectric { .. }
            | Self::CoatedConductor(_) => 1.0,
            Self::Plastic { ior, roughness, .. } => coat(*ior, *roughness),
            Self::CoatedDiffuse(m) => coat(m.ior, m.roughness),
            Self::Principled(m) => m.specular_share(textures),
            Self::Diffuse { .. }
            | Self::Phong { .. }
            | Self::RoughDiffuse { .. }
            | Self::DiffuseTransmission { .. }
            | Self::Sheen { .. }
            | Self::Mix { .. }
            | Self::Black => 0.0,
        }
    }

    /// The kind of BSDF at a hit, which may be absent where nothing varies.
    #[inline(never)]
    pub(crate) fn bsdf(&self, hit: Option<&SurfaceInteraction>, eta: f32, lookup: &Lookup<'_>) -> BsdfKind {
        let at = &Place { hit, lookup };
        match self {
            Self::Diffuse { color } => BsdfKind::Diffuse { albedo: at.color(*color) },
            Self::Phong { diffuse, specular, exponent } => BsdfKind::Phong {
                diffuse: at.color(*diffuse),
                specular: at.color(*specular),
                exponent: at.float(*exponent).max(0.0),
            },
            Self::Mirror { color } => BsdfKind::Mirror { color: at.color(*color) },
            Self::Dielectric(m) => m.bsdf(at, eta),
            Self::Conductor(m) => m.bsdf(at),
            Self::Plastic { color, ior, roughness } => plastic(at.color(*color), *ior, roughness.alpha(at)),
            Self::RoughDiffuse { color, roughness } => {
                BsdfKind::RoughDiffuse { albedo: at.color(*color), roughness: at.share(*roughness) }
            }
            Self::DiffuseTransmission { reflectance, transmittance } => {
                let (r, t) = (at.color(*reflectance), at.color(*transmittance));
                // Maps may add up to more than the light that there is.
                let over = (r + t).map(|sum| sum.max(1.0).recip());
                BsdfKind::DiffuseTransmission { reflectance: r * over, transmittance: t * over }
            }
            Self::Sheen { color, roughness } => {
                BsdfKind::Sheen { color: at.color(*color), alpha: at.share(*roughness).powi(2) }
            }
            Self::ThinDielectric { ior, color, specular, roughness } => BsdfKind::ThinDielectric {
                eta: *ior,
                alpha: roughness.alpha(at),
                reflectance: at.color(*specular),
                transmittance: at.color(*color),
            },
            Self::CoatedDiffuse(m) => m.bsdf(at),
            Self::CoatedConductor(m) => m.bsdf(at),
            Self::Principled(m) => m.bsdf(at, eta),
            // No hit has such a material: one of its two is chosen as the surface is met.
            Self::Mix { .. } | Self::Black => BsdfKind::Black,
        }
    }
}

fn plastic(albedo: Lanes, eta: f32, alpha: [f32; 2]) -> BsdfKind {
    if alpha[0] == alpha[1] {
        return BsdfKind::Plastic { albedo, eta, alpha: alpha[0] };
    }
    let (specular, facets) = (Lanes::ONE, bsdf::Facets::Conserving);
    BsdfKind::CoatedDiffuse { albedo, specular, eta, alpha, facets }
}
