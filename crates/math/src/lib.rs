//! Vectors, frames, transforms, rays and bounds.
//!
//! Everything is right-handed. Positions and directions are `f32` ([`Vec3`]); sums that need more use [`DVec3`].
//! A vector named `w`, `wi` or `wo` is of unit length and points away from the surface.

mod bounds;
mod frame;
mod ray;
mod spherical;
mod transform;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use glam::{Affine3A, DVec2, DVec3, Mat3, Mat4, Quat, Vec2, Vec3, Vec3A, Vec4};
pub use ray::{Ray, gamma, offset_ray_origin};
pub use spherical::{octahedral_decode, octahedral_encode, reflect, refract, spherical_direction};
pub use transform::Transform;

/// 1/π.
pub const FRAC_1_PI: f32 = std::f32::consts::FRAC_1_PI;
/// π.
pub const PI: f32 = std::f32::consts::PI;
/// Greatest `f32` below 1: the upper end of the numbers that samplers return.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;
