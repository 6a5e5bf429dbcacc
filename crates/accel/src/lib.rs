//! Ray tracing: triangles, spheres, disks and instances in one 8-wide bounding volume hierarchy.
//!
//! ```
//! use nephroid_accel::{Bvh, Geometry};
//! use math::{Ray, Vec3};
//!
//! let mut geometry = Geometry::default();
//! let ball = geometry.add_sphere(Vec3::ZERO, 1.0);
//! let bvh = Bvh::build(geometry);
//! let hit = bvh.closest(&Ray::new(Vec3::new(0.0, 0.0, 5.0), -Vec3::Z)).unwrap();
//! assert_eq!((hit.geom, hit.t), (ball, 4.0));
//! ```
//!
//! # What a hit is
//! Both sides of everything are hit, where 0 < t < `t_max`. Of hits at the same t the lowest (instance, geom,
//! prim) wins, so that the answer does not depend on the order of the search. Rays that are not finite hit
//! nothing. Triangles that share an edge, bit for bit, leave no gap (Woop, Benthin & Wald 2013).
//!
//! # Kernels
//! [`Bvh::build`] asks the processor once for AVX2; elsewhere a portable path runs, whose hits are equal bit for bit.

mod build;
mod bvh;
mod geometry;
mod kernel;
mod node;
mod pages;
mod shapes;

pub use bvh::{Bvh, Hit, NO_INSTANCE};
pub use geometry::{Geometry, NestedInstance};

#[cfg(test)]
mod tests;
