use bsdf::{Bsdf, BsdfKind};
use color::Lanes;
use math::{Frame, Vec3};

use crate::{Medium, SurfaceInteraction, Texture};

/// Cosine to which a shading normal is bent back where it faces away from a viewer who sees the surface's other side.
const BENT_COSINE: f32 = 0.01;

/// The shading normal, unless `wo` lies between its horizon and the geometric normal's, as at the silhouette of a
/// smooth mesh: then it is tilted toward `wo` until both agree on the side, where otherwise nothing would be
/// scattered.
#[inline]
fn facing(ns: Vec3, ng: Vec3, wo: Vec3) -> Vec3 {
    let (cos, side) = (wo.dot(ns), wo.dot(ng));
    if cos * side > 0.0 || side == 0.0 {
        return ns;
    }
    (ns + wo * (BENT_COSINE.copysign(side) - cos)).normalize()
}

/// Index of a material in the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// A colour that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorSource {
    /// Everywhere the same.
    Constant(Lanes),
    /// Index of a texture.
    Texture(u32),
}

/// A number that may vary over the surface (the mean of a texture's channels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatSource {
    /// Everywhere the same.
    Constant(f32),
    /// Index of a texture.
    Texture(u32),
}

/// How a surface scatters; the BSDF at a point is made from it.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Smooth dielectric solid.
    Dielectric {
        /// Refractive index.
        ior: f32,
        /// Transmittance of one crossing.
        color: ColorSource,
        /// Rank among overlapping dielectrics.
        priority: i32,
    },
    /// Metal.
    Conductor {
        /// Real part of the index.
        n: Lanes,
        /// Imaginary part of the index.
        k: Lanes,
        /// GGX α is the square of this; 0 is smooth.
        roughness: FloatSource,
    },
    /// Dielectric coat over a Lambertian base.
    Plastic {
        /// Reflectance of the base.
        color: ColorSource,
        /// Index of the coat.
        ior: f32,
        /// GGX α of the coat is the square of this; 0 is smooth.
        roughness: FloatSource,
    },
    /// Reflects nothing.
    Black,
}

/// A material: its kind and what bends its normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub kind: MaterialKind,
    /// Tangent-space normal map (texture index) and its strength.
    pub normal_map: Option<(u32, f32)>,
    /// Whether the back scatters as the front does; else it is black.
    pub two_sided: bool,
    /// The BSDF kind where nothing varies over the surface (and the kind is not a dielectric, whose index depends
    /// on the medium).
    constant: Option<BsdfKind>,
}

/// What evaluating materials needs to look up.
pub(crate) struct Lookup<'a> {
    pub textures: &'a [Texture],
    /// Width of the ray's footprint on the surface, in units of length.
    pub footprint: f32,
}

impl Lookup<'_> {
    fn color(&self, source: ColorSource, hit: &SurfaceInteraction) -> Lanes {
        match source {
            ColorSource::Constant(c) => c,
            ColorSource::Texture(t) => {
                let [r, g, b] =
                    self.textures[t as usize].evaluate(hit.uv, self.footprint * hit.uv_per_length);
                Lanes::rgb(r, g, b)
            }
        }
    }

    fn float(&self, source: FloatSource, hit: &SurfaceInteraction) -> f32 {
        match source {
            FloatSource::Constant(x) => x,
            FloatSource::Texture(t) => self.color(ColorSource::Texture(t), hit).mean(),
        }
    }
}

impl Material {
    /// A material; works out what is constant.
    pub fn new(kind: MaterialKind, normal_map: Option<(u32, f32)>, two_sided: bool) -> Self {
        let mut material = Self { kind, normal_map, two_sided, constant: None };
        if material.is_uniform() && material.medium(MaterialId(0)).is_none() {
            let lookup = Lookup { textures: &[], footprint: 0.0 };
            material.constant = Some(material.bsdf_kind(None, 1.0, &lookup));
        }
        material
    }

    /// The solid that this material bounds, if it is a dielectric.
    pub fn medium(&self, id: MaterialId) -> Option<Medium> {
        match self.kind {
            MaterialKind::Dielectric { ior, priority, .. } => Some(Medium { material: id, ior, priority }),
            _ => None,
        }
    }

    /// Whether texture coordinates are of no use to it.
    pub fn needs_no_uv(&self) -> bool {
        self.is_uniform() && self.normal_map.is_none()
    }

    /// Whether nothing varies over the surface.
    fn is_uniform(&self) -> bool {
        let c = |s: ColorSource| matches!(s, ColorSource::Constant(_));
        let f = |s: FloatSource| matches!(s, FloatSource::Constant(_));
        match self.kind {
            MaterialKind::Diffuse { color }
            | MaterialKind::Mirror { color }
            | MaterialKind::Dielectric { color, .. } => c(color),
            MaterialKind::Phong { diffuse, specular, exponent } => c(diffuse) && c(specular) && f(exponent),
            MaterialKind::Conductor { roughness, .. } => f(roughness),
            MaterialKind::Plastic { color, roughness, .. } => c(color) && f(roughness),
            MaterialKind::Black => true,
        }
    }

    /// Whether all the light that it scatters counts as specular for photon maps: it bounds no surface on which
    /// photons are stored. By kind, never by roughness.
    pub fn is_specular(&self) -> bool {
        matches!(
            self.kind,
            MaterialKind::Mirror { .. } | MaterialKind::Dielectric { .. } | MaterialKind::Conductor { .. }
        )
    }

    /// Share of the light that it throws on specularly, roughly: how much a caustic photon aimed at it is worth.
    pub fn specular_weight(&self, textures: &[Texture]) -> f32 {
        let mean = |s: ColorSource| match s {
            ColorSource::Constant(c) => c.mean(),
            ColorSource::Texture(t) => {
                let [r, g, b] = textures[t as usize].mean();
                (r + g + b) / 3.0
            }
        };
        match self.kind {
            MaterialKind::Mirror { color } => mean(color),
            MaterialKind::Dielectric { .. } | MaterialKind::Conductor { .. } => 1.0,
            // Only the delta reflection of a smooth coat is specular.
            MaterialKind::Plastic { ior, roughness: FloatSource::Constant(0.0), .. } => {
                bsdf::fresnel_dielectric(1.0, ior)
            }
            _ => 0.0,
        }
    }

    #[inline(never)]
    fn bsdf_kind(&self, hit: Option<&SurfaceInteraction>, eta: f32, lookup: &Lookup<'_>) -> BsdfKind {
        let color = |s: ColorSource| match (s, hit) {
            (ColorSource::Constant(c), _) => c,
            (s, Some(hit)) => lookup.color(s, hit),
            (_, None) => Lanes::ZERO,
        };
        let float = |s: FloatSource| match (s, hit) {
            (FloatSource::Constant(x), _) => x,
            (s, Some(hit)) => lookup.float(s, hit),
            (_, None) => 0.0,
        };
        match self.kind {
            MaterialKind::Diffuse { color: c } => BsdfKind::Diffuse { albedo: color(c) },
            MaterialKind::Phong { diffuse, specular, exponent } => BsdfKind::Phong {
                diffuse: color(diffuse),
                specular: color(specular),
                exponent: float(exponent),
            },
            MaterialKind::Mirror { color: c } => BsdfKind::Mirror { color: color(c) },
            MaterialKind::Dielectric { color: c, .. } => BsdfKind::Dielectric { eta, tint: color(c) },
            MaterialKind::Conductor { n, k, roughness } => {
                BsdfKind::Conductor { n, k, alpha: float(roughness).powi(2) }
            }
            MaterialKind::Plastic { color: c, ior, roughness } => {
                BsdfKind::Plastic { albedo: color(c), eta: ior, alpha: float(roughness).powi(2) }
            }
            MaterialKind::Black => BsdfKind::Black,
        }
    }

    /// The BSDF at `hit`; `eta` is the resolved relative index where the material is a dielectric.
    #[inline]
    pub(crate) fn bsdf(&self, hit: &SurfaceInteraction, wo: Vec3, eta: f32, lookup: &Lookup<'_>) -> Bsdf {
        let kind = match self.constant {
            _ if !self.two_sided && wo.dot(hit.ng) < 0.0 => BsdfKind::Black,
            Some(kind) => kind,
            None => self.bsdf_kind(Some(&{ *hit }), eta, lookup),
        };
        let ns = match self.normal_map {
            None => hit.ns,
            Some((texture, strength)) => self.bent_normal(&{ *hit }, texture, strength, lookup),
        };
        // No kind is anisotropic: any frame about the normal will do.
        Bsdf::new(kind, Frame::from_z(facing(ns, hit.ng, wo)), hit.ng)
    }

    #[inline(never)]
    fn bent_normal(
        &self,
        hit: &SurfaceInteraction,
        texture: u32,
        strength: f32,
        lookup: &Lookup<'_>,
    ) -> Vec3 {
        let base = Frame::from_zx(hit.ns, hit.dpdu);
        let local =
            lookup.textures[texture as usize].evaluate_normal(hit.uv, lookup.footprint * hit.uv_per_length);
        let bent = Vec3::new(local.x * strength, local.y * strength, local.z.max(1e-3));
        let mut ns = base.to_world(bent).normalize();
        // A normal that turned past the geometric horizon is brought back to it.
        let c = ns.dot(hit.ng);
        if c < 0.01 {
            ns = (ns + hit.ng * (0.01 - c)).normalize();
        }
        ns
    }
}
