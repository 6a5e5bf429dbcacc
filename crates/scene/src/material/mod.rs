//! Materials: what a surface is made of, from which the BSDF at a point is made.

mod kind;
mod relief;
mod source;
mod varied;

use bsdf::{Bsdf, BsdfKind};
use color::Lanes;
use math::{Frame, Vec3};

use crate::attributes::Owner;
use crate::{Medium, SurfaceInteraction};
use relief::{facing, glossy_normal};

pub use kind::MaterialKind;
pub use source::{ColorSource, FloatSource, RoughnessSource};
pub(crate) use source::{Lookup, Place};
pub use varied::{
    CoatedConductorMaterial, CoatedDiffuseMaterial, ConductorMaterial, DielectricMaterial, PrincipledMaterial,
};

/// Index of a material in the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// How much of a surface is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opacity {
    /// 0..=1.
    pub share: FloatSource,
    /// Where the share is at least this the surface is opaque, else there is none; `None`: the share is a chance.
    pub cutoff: Option<f32>,
}

/// A material: its kind and what bends its normals.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub kind: MaterialKind,
    /// Tangent-space normal map (texture index) and its strength.
    pub normal_map: Option<(u32, f32)>,
    /// Heights (texture index) and their unit, in units of length.
    pub bump_map: Option<(u32, f32)>,
    /// Turns the tangent, from growing u toward growing v, in degrees.
    pub rotation: FloatSource,
    /// Whether the back scatters as the front does; else it is black.
    pub two_sided: bool,
    /// How much of the surface is there; `None`: all of it.
    pub opacity: Option<Opacity>,
    /// The mix that it is a part of.
    pub(crate) part_of: Option<MaterialId>,
    /// Whether it tells the direction of growing u from others.
    oriented: bool,
    /// Whether it reflects or refracts as a mirror or glass does, smooth or rough.
    mirrors: bool,
    /// The BSDF kind where nothing varies over the surface (and the kind is not a dielectric, whose index depends
    /// on the medium).
    constant: Option<BsdfKind>,
}

impl Material {
    /// A material; works out what is constant.
    pub fn new(kind: MaterialKind, normal_map: Option<(u32, f32)>, two_sided: bool) -> Self {
        let two_sided = two_sided || kind.is_crossed();
        let (oriented, mirrors) = (kind.is_anisotropic(), kind.mirrors());
        let mut material = Self {
            kind,
            normal_map,
            bump_map: None,
            rotation: FloatSource::Constant(0.0),
            two_sided,
            opacity: None,
            part_of: None,
            oriented,
            mirrors,
            constant: None,
        };
        if material.kind.is_uniform() && material.medium(MaterialId(0)).is_none() {
            material.constant = Some(material.kind.bsdf(
                None,
                1.0,
                &Lookup { textures: &[], of: Owner::Unknown, footprint: 0.0 },
            ));
        }
        material
    }

    /// The solid that this material bounds, if light enters it.
    #[inline]
    pub fn medium(&self, id: MaterialId) -> Option<Medium> {
        match &self.kind {
            MaterialKind::Dielectric(d) => {
                Some(Medium { material: id, ior: d.ior, outside: d.outside, priority: d.priority })
            }
            MaterialKind::Principled(p) if p.is_solid => {
                Some(Medium { material: id, ior: p.ior, outside: 0.0, priority: p.priority })
            }
            _ => None,
        }
    }

    /// What the solid that it bounds absorbs, per unit of length; zero where it bounds none.
    pub fn absorption(&self) -> Lanes {
        match &self.kind {
            MaterialKind::Dielectric(d) => d.absorption,
            MaterialKind::Principled(p) if p.is_solid => p.absorption,
            _ => Lanes::ZERO,
        }
    }

    /// Whether texture coordinates are of no use to it; of a mix, apart from its parts.
    pub fn needs_no_uv(&self) -> bool {
        let kind = match &self.kind {
            MaterialKind::Mix { amount, .. } => amount.is_constant(),
            kind => kind.is_uniform(),
        };
        let opacity = self.opacity.is_none_or(|o| o.share.is_constant());
        kind && opacity && self.normal_map.is_none() && self.bump_map.is_none() && !self.oriented
    }

    /// The BSDF at `hit`; `eta` is the resolved relative index where the material is a dielectric.
    #[inline]
    pub(crate) fn bsdf(&self, hit: &SurfaceInteraction, wo: Vec3, eta: f32, lookup: &Lookup<'_>) -> Bsdf {
        let kind = match self.constant {
            _ if !self.two_sided && wo.dot(hit.ng) < 0.0 => BsdfKind::Black,
            Some(kind) => kind,
            None => self.kind.bsdf(Some(&{ *hit }), eta, lookup),
        };
        let ns = match (self.normal_map, self.bump_map) {
            (None, None) if self.mirrors && hit.ns != hit.ng => glossy_normal(hit.ns, hit.ng, wo, eta),
            (None, None) => facing(hit.ns, hit.ng, wo),
            _ => self.bent_normal(&{ *hit }, wo, eta, lookup),
        };
        let frame =
            if self.oriented { self.oriented_frame(&{ *hit }, ns, lookup) } else { Frame::from_z(ns) };
        Bsdf::new(kind, frame, hit.ng)
    }
}
