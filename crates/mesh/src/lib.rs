//! Triangle meshes: readers and generators.
//!
//! [`read`] loads OBJ, PLY and STL files, [`shapes`] makes the shapes that scene files name. Every mesh that comes out of
//! here satisfies [`TriangleMesh::validate`].

mod assemble;
mod displace;
mod error;
pub mod obj;
pub mod ply;
mod polygon;
mod read;
pub mod shapes;
pub mod stl;
mod text;
mod topology;
mod triangle_mesh;

pub use displace::{Subdivided, TooMany};
pub use error::{MeshError, Place};
pub use read::read;
pub use triangle_mesh::TriangleMesh;
