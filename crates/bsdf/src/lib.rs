//! Scattering functions.
//!
//! A [`Bsdf`] is a small `Copy` value made at a hit: a shading frame, a geometric normal and one of a closed set of
//! kinds. Directions are unit vectors in the space of the frame that point away from the surface; `wo` is known and
//! `wi` is sampled, whichever way light travels ([`TransportMode`] says which). [`Bsdf::eval`] returns f without the
//! cosine; the cosine in [`BsdfSample::weight`] is that to the *shading* normal.
//!
//! Sides. A reflecting lobe needs `wi` and `wo` on the same side of the geometric *and* of the shading normal, a
//! transmitting lobe on opposite sides of both. Elsewhere f, densities and samples are 0, so that no light leaks
//! through a surface whatever its shading normals; the rule is symmetric, so camera paths and photons agree.
//! Opaque kinds scatter on the side of `wo`, front and back alike; of those that transmit, solids have a front (+ns, outside)
//! and a back, thin ones are alike from both sides.
//!
//! Rough kinds measure roughness along x and y of the frame: hand in a frame whose x is the tangent
//! ([`math::Frame::from_zx`]) where a material is anisotropic. What several bounces among facets or between layers return is
//! tabulated at first use ([`Facets`] says what is restored): some ten milliseconds for each table in use, the same on every
//! run.

mod beckmann;
mod bsdf;
mod coat_albedo;
mod coat_loss;
mod coated_conductor;
mod conductor;
mod cosine;
mod dielectric;
mod diffuse;
mod facet_loss;
mod facets;
mod film;
mod fresnel;
mod ggx;
mod glass;
mod glass_loss;
mod kind;
mod layers;
mod lobes;
mod local;
mod mirror;
mod null;
mod phong;
mod plastic;
mod principled;
mod reflectance;
mod rough_diffuse;
mod sheen;
mod single_bounce;
mod slab;
mod table;
mod thin;
mod translucent;

pub use bsdf::{Bsdf, BsdfSample, DeltaLobe};
pub use facets::Facets;
pub use film::Film;
pub use fresnel::{fresnel_conductor, fresnel_dielectric, fresnel_dielectric_mean};
pub use kind::BsdfKind;
pub use lobes::{Lobes, TransportMode};
pub use plastic::{absorbing_coat_albedo, linear_plastic_albedo};
pub use principled::{Interior, Principled, PrincipledParameters, disney_alpha, disney_eta, gltf_alpha};
