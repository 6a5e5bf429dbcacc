//! Materials.

use super::{ColorDesc, FloatDesc, MaterialRef, Triple};
use crate::source::Sourced;

/// A refractive index.
#[derive(Clone, Debug, PartialEq)]
pub enum Ior {
    /// The index itself, relative to vacuum.
    Value(f32),
    /// A named substance: "water", "glass", "N-BK7", "diamond", …
    Glass(Sourced<String>),
}

impl From<f32> for Ior {
    fn from(ior: f32) -> Self {
        Self::Value(ior)
    }
}

impl From<&str> for Ior {
    fn from(name: &str) -> Self {
        Self::Glass(name.into())
    }
}

/// What a metal is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Metal {
    /// A named metal with measured data: "gold", "copper", …
    Named(Sourced<String>),
    /// The complex index n + ik per RGB channel.
    Index {
        /// Real part, > 0.
        n: Triple,
        /// Imaginary part, ≥ 0.
        k: Triple,
    },
}

impl From<&str> for Metal {
    fn from(name: &str) -> Self {
        Self::Named(name.into())
    }
}

/// Roughness of the facets of a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Roughness {
    /// As the eye judges it.
    Perceived {
        /// r, 0..=1: the GGX α is r²; 0 is smooth.
        roughness: FloatDesc,
        /// −1..=1: α is r²/a along the tangent and r²·a across it, a = √(1 − 0.9·anisotropy) (Burley 2012); a negative one
        /// stretches across.
        anisotropy: FloatDesc,
    },
    /// The GGX (or Beckmann) α itself.
    Alpha {
        /// Along the tangent (growing u).
        along: FloatDesc,
        /// Across it.
        across: FloatDesc,
    },
}

impl Default for Roughness {
    /// Smooth.
    fn default() -> Self {
        0.0.into()
    }
}

impl From<FloatDesc> for Roughness {
    fn from(roughness: FloatDesc) -> Self {
        Self::Perceived { roughness, anisotropy: 0.0.into() }
    }
}

impl From<f32> for Roughness {
    fn from(roughness: f32) -> Self {
        FloatDesc::from(roughness).into()
    }
}

impl Roughness {
    /// α of an isotropic surface.
    pub fn alpha(alpha: f32) -> Self {
        Self::Alpha { along: alpha.into(), across: alpha.into() }
    }
}

/// How the facets of a rough surface are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facets {
    /// GGX with the energy of several bounces restored.
    #[default]
    Conserving,
    /// GGX, one bounce alone.
    SingleBounce,
    /// GGX, one bounce alone, masking of the two directions independent.
    Separable,
    /// Beckmann, one bounce alone.
    Beckmann,
}

/// A transparent film, thin enough for interference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Thickness in nanometres; 0: none.
    pub thickness_nm: f32,
    /// Index relative to vacuum.
    pub ior: f32,
}

impl Default for ThinFilm {
    /// None.
    fn default() -> Self {
        Self { thickness_nm: 0.0, ior: 1.3 }
    }
}

/// Glass or liquid.
#[derive(Clone, Debug, PartialEq)]
pub struct Dielectric {
    /// Refractive index.
    pub ior: Ior,
    /// The index before the surface, whatever it lies in: then the surface by itself decides how light is refracted there, as
    /// interfaces of other programs do. Absent: that of the solid which the surface lies in.
    pub outside_ior: Option<f32>,
    /// Factor on what is transmitted at each crossing, 0..=1.
    pub color: ColorDesc,
    /// Factor on what is reflected, 0..=1.
    pub specular: ColorDesc,
    /// Of the surface.
    pub roughness: Roughness,
    /// Model of the facets.
    pub facets: Facets,
    /// On the outside.
    pub film: ThinFilm,
    /// What the inside absorbs: σ in e^(−σ·d) per unit of length, ≥ 0.
    pub absorption: Triple,
    /// Where solids overlap the highest counts; among equals the last entered.
    pub priority: i32,
}

impl Default for Dielectric {
    fn default() -> Self {
        Self {
            ior: 1.5.into(),
            outside_ior: None,
            color: 1.0.into(),
            specular: 1.0.into(),
            roughness: Roughness::default(),
            facets: Facets::default(),
            film: ThinFilm::default(),
            absorption: [0.0; 3],
            priority: 0,
        }
    }
}

/// A thin pane.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinDielectric {
    /// Refractive index.
    pub ior: Ior,
    /// Factor on what is transmitted, 0..=1.
    pub color: ColorDesc,
    /// Factor on what is reflected, 0..=1.
    pub specular: ColorDesc,
    /// Of its surfaces.
    pub roughness: Roughness,
}

impl Default for ThinDielectric {
    fn default() -> Self {
        Self { ior: 1.5.into(), color: 1.0.into(), specular: 1.0.into(), roughness: Roughness::default() }
    }
}

/// Metal.
#[derive(Clone, Debug, PartialEq)]
pub struct Conductor {
    /// Its complex index.
    pub metal: Metal,
    /// Factor on what is reflected, 0..=1.
    pub specular: ColorDesc,
    /// Of the surface.
    pub roughness: Roughness,
    /// Model of the facets.
    pub facets: Facets,
    /// On the surface.
    pub film: ThinFilm,
}

impl Default for Conductor {
    /// Smooth copper.
    fn default() -> Self {
        Self {
            metal: "copper".into(),
            specular: 1.0.into(),
            roughness: Roughness::default(),
            facets: Facets::default(),
            film: ThinFilm::default(),
        }
    }
}

/// A diffuse base under a dielectric coat.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuse {
    /// Albedo of the base.
    pub color: ColorDesc,
    /// Factor on what the coat reflects, 0..=1.
    pub specular: ColorDesc,
    /// Index of the coat.
    pub ior: Ior,
    /// Of the coat.
    pub roughness: Roughness,
    /// Model of the facets.
    pub facets: Facets,
    /// Whether light that is thrown back onto the base takes its colour again each time.
    pub nonlinear: bool,
    /// Optical depth of the coat along its normal, ≥ 0.
    pub depth: f32,
}

impl Default for CoatedDiffuse {
    fn default() -> Self {
        Self {
            color: 0.5.into(),
            specular: 1.0.into(),
            ior: 1.5.into(),
            roughness: Roughness::default(),
            facets: Facets::default(),
            nonlinear: true,
            depth: 0.0,
        }
    }
}

/// A metal under a dielectric coat.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedConductor {
    /// The metal's complex index.
    pub metal: Metal,
    /// Of the metal.
    pub roughness: Roughness,
    /// Index of the coat.
    pub ior: Ior,
    /// The coat's GGX α is the square of this; 0 is smooth.
    pub coat_roughness: FloatDesc,
    /// Optical depth of the coat along its normal, ≥ 0.
    pub depth: f32,
    /// Model of the facets.
    pub facets: Facets,
}

impl Default for CoatedConductor {
    fn default() -> Self {
        Self {
            metal: "copper".into(),
            roughness: Roughness::default(),
            ior: 1.5.into(),
            coat_roughness: 0.0.into(),
            depth: 0.0,
            facets: Facets::default(),
        }
    }
}

/// Parameters of the principled model, in this order from outside: sheen, clear coat, then metal or dielectric by `metallic`;
/// the dielectric transmits specularly by `transmission`, or lies on a diffuse base.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Reflectance of the diffuse base and of the metal; tint of transmission (its root at each crossing of a solid).
    pub base_color: ColorDesc,
    /// Share of metal.
    pub metallic: FloatDesc,
    /// Of metal and dielectric.
    pub roughness: Roughness,
    /// Index of the dielectric.
    pub ior: Ior,
    /// Factor on the dielectric's reflection.
    pub specular: FloatDesc,
    /// Its colour.
    pub specular_color: ColorDesc,
    /// Share of the dielectric that transmits specularly.
    pub transmission: FloatDesc,
    /// Whether the surface is a thin sheet; else it bounds a solid.
    pub thin: bool,
    /// Share of the diffuse base that is transmitted.
    pub diffuse_transmission: FloatDesc,
    /// Colour of the sheen; black: none.
    pub sheen_color: ColorDesc,
    /// α of the sheen is the square of this.
    pub sheen_roughness: FloatDesc,
    /// Share under a clear coat of index 1.5.
    pub clearcoat: FloatDesc,
    /// α of the coat is the square of this.
    pub clearcoat_roughness: FloatDesc,
    /// Share under a thin film.
    pub film: FloatDesc,
    /// Thickness of the film in nanometres.
    pub film_thickness_nm: FloatDesc,
    /// Index of the film.
    pub film_ior: f32,
    /// Of a solid: σ in e^(−σ·d) per unit of length, ≥ 0.
    pub absorption: Triple,
    /// Rank among overlapping solids, as for dielectrics.
    pub priority: i32,
}

impl Default for Principled {
    fn default() -> Self {
        Self {
            base_color: 0.5.into(),
            metallic: 0.0.into(),
            roughness: 0.5.into(),
            ior: 1.5.into(),
            specular: 1.0.into(),
            specular_color: 1.0.into(),
            transmission: 0.0.into(),
            thin: false,
            diffuse_transmission: 0.0.into(),
            sheen_color: 0.0.into(),
            sheen_roughness: 0.3.into(),
            clearcoat: 0.0.into(),
            clearcoat_roughness: 0.03.into(),
            film: 0.0.into(),
            film_thickness_nm: 400.0.into(),
            film_ior: 1.3,
            absorption: [0.0; 3],
            priority: 0,
        }
    }
}

impl Principled {
    /// Whether it may bound a solid that light enters: some of it transmits specularly, and it is no thin sheet.
    pub fn is_solid(&self) -> bool {
        !self.thin && self.transmission != FloatDesc::Value(0.0) && self.metallic != FloatDesc::Value(1.0)
    }
}

/// How a surface scatters.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo, 0..=1.
        color: ColorDesc,
    },
    /// Diffuse plus the modified Phong lobe of Lafortune & Willems 1994.
    Phong {
        /// Diffuse albedo; its sum with `specular` is at most 1 in each channel.
        diffuse: ColorDesc,
        /// Specular albedo at normal incidence.
        specular: ColorDesc,
        /// Exponent of the cosine lobe, ≥ 0.
        exponent: FloatDesc,
    },
    /// Perfect reflection.
    Mirror {
        /// Reflectance, 0..=1.
        color: ColorDesc,
    },
    /// Glass or liquid: reflects and refracts.
    Dielectric(Dielectric),
    /// Metal.
    Conductor(Conductor),
    /// A diffuse base under a dielectric coat.
    Plastic {
        /// Albedo of the base.
        color: ColorDesc,
        /// Index of the coat.
        ior: Ior,
        /// Of the coat.
        roughness: Roughness,
    },
    /// Energy-preserving Oren–Nayar.
    RoughDiffuse {
        /// Albedo, 0..=1.
        color: ColorDesc,
        /// 0..=1; 0 is Lambertian.
        roughness: FloatDesc,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// Share reflected; its sum with `transmittance` is at most 1 in each channel.
        reflectance: ColorDesc,
        /// Share transmitted.
        transmittance: ColorDesc,
    },
    /// Upright fibres over black.
    Sheen {
        /// Reflectance of the fibres.
        color: ColorDesc,
        /// α of the lobe is the square of this.
        roughness: FloatDesc,
    },
    /// A thin pane: light crosses it straight on.
    ThinDielectric(ThinDielectric),
    /// A diffuse base under a dielectric coat, with all that it may have.
    CoatedDiffuse(CoatedDiffuse),
    /// A metal under a dielectric coat.
    CoatedConductor(CoatedConductor),
    /// The slab of Disney's BSDF and OpenPBR.
    Principled(Box<Principled>),
    /// Two materials, of which chance chooses one wherever light comes.
    Mix {
        /// The one.
        a: MaterialRef,
        /// The other.
        b: MaterialRef,
        /// Share of `b`, 0..=1.
        amount: FloatDesc,
    },
}

/// A material: `[materials.NAME]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub kind: MaterialKind,
    /// A texture of tangent-space normals (OpenGL convention, +y up), by name.
    pub normal_map: Option<Sourced<String>>,
    /// How much of the surface is there, 0..=1; the rest lets all rays pass. Lamps are opaque.
    pub opacity: FloatDesc,
    /// Where opacity is at least this the surface is opaque, else there is none; absent: opacity is a chance.
    pub opacity_cutoff: Option<f32>,
    /// Factor on the map's slopes; 1 as stored.
    pub normal_strength: f32,
    /// A texture of heights (the mean of its channels) by which normals are bent, by name.
    pub bump_map: Option<Sourced<String>>,
    /// Height in scene units where the texture is 1.
    pub bump_height: f32,
    /// Turns the tangent, from growing u toward growing v, in degrees.
    pub rotation: FloatDesc,
    /// Whether the back side scatters as the front does; else the back is black. Ignored by what
    /// light passes through.
    pub two_sided: bool,
}

impl From<MaterialKind> for Material {
    fn from(kind: MaterialKind) -> Self {
        Self {
            kind,
            normal_map: None,
            opacity: 1.0.into(),
            opacity_cutoff: None,
            normal_strength: 1.0,
            bump_map: None,
            bump_height: 1.0,
            rotation: 0.0.into(),
            two_sided: true,
        }
    }
}

impl From<Dielectric> for Material {
    fn from(kind: Dielectric) -> Self {
        MaterialKind::Dielectric(kind).into()
    }
}

impl From<ThinDielectric> for Material {
    fn from(kind: ThinDielectric) -> Self {
        MaterialKind::ThinDielectric(kind).into()
    }
}

impl From<Conductor> for Material {
    fn from(kind: Conductor) -> Self {
        MaterialKind::Conductor(kind).into()
    }
}

impl From<CoatedDiffuse> for Material {
    fn from(kind: CoatedDiffuse) -> Self {
        MaterialKind::CoatedDiffuse(kind).into()
    }
}

impl From<CoatedConductor> for Material {
    fn from(kind: CoatedConductor) -> Self {
        MaterialKind::CoatedConductor(kind).into()
    }
}

impl From<Principled> for Material {
    fn from(kind: Principled) -> Self {
        MaterialKind::Principled(Box::new(kind)).into()
    }
}

impl MaterialKind {
    /// Its name in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Diffuse { .. } => "diffuse",
            Self::Phong { .. } => "phong",
            Self::Mirror { .. } => "mirror",
            Self::Dielectric(_) => "dielectric",
            Self::Conductor(_) => "conductor",
            Self::Plastic { .. } => "plastic",
            Self::RoughDiffuse { .. } => "rough-diffuse",
            Self::DiffuseTransmission { .. } => "diffuse-transmission",
            Self::Sheen { .. } => "sheen",
            Self::ThinDielectric(_) => "thin-dielectric",
            Self::CoatedDiffuse(_) => "coated-diffuse",
            Self::CoatedConductor(_) => "coated-conductor",
            Self::Principled(_) => "principled",
            Self::Mix { .. } => "mix",
        }
    }

    /// Whether its back may be black: nothing passes through it.
    pub fn has_two_sided(&self) -> bool {
        !matches!(
            self,
            Self::Mix { .. }
                | Self::Dielectric(_)
                | Self::ThinDielectric(_)
                | Self::DiffuseTransmission { .. }
                | Self::Principled(_)
        )
    }
}

impl Material {
    /// Lambertian.
    pub fn diffuse(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Diffuse { color: color.into() }.into()
    }

    /// Diffuse plus a modified Phong lobe.
    pub fn phong(diffuse: impl Into<ColorDesc>, specular: impl Into<ColorDesc>, exponent: f32) -> Self {
        let (diffuse, specular) = (diffuse.into(), specular.into());
        MaterialKind::Phong { diffuse, specular, exponent: exponent.into() }.into()
    }

    /// A perfect mirror.
    pub fn mirror(color: impl Into<ColorDesc>) -> Self {
        MaterialKind::Mirror { color: color.into() }.into()
    }

    /// Clear glass of an index or name.
    pub fn dielectric(ior: impl Into<Ior>) -> Self {
        Dielectric { ior: ior.into(), ..Dielectric::default() }.into()
    }

    /// A metal by name.
    pub fn conductor(metal: impl Into<Metal>, roughness: f32) -> Self {
        Conductor { metal: metal.into(), roughness: roughness.into(), ..Conductor::default() }.into()
    }

    /// A diffuse base under a coat of index 1.5.
    pub fn plastic(color: impl Into<ColorDesc>, roughness: f32) -> Self {
        MaterialKind::Plastic { color: color.into(), ior: 1.5.into(), roughness: roughness.into() }.into()
    }
}
