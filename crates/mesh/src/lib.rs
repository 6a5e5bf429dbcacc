//! Triangle meshes: readers and generators.
//!
//! [`read`] loads OBJ and PLY files, [`shapes`] makes the shapes that scene files name. Every mesh that comes out of
//! here has passed [`TriangleMesh::validate`] or satisfies it by construction.

mod error;
mod triangle_mesh;

pub use error::{MeshError, Place};
pub use triangle_mesh::TriangleMesh;
