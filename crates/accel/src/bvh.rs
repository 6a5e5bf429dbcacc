use math::{Bounds3, Ray};

use crate::build;
use crate::geometry::{Geometry, Instance};
use crate::kernel::{self, Dispatch};
use crate::node::{Child, Node, Pack};
use crate::shapes::{Disk, Sphere};

/// [`Hit::instance`] of what no instance holds.
pub const NO_INSTANCE: u32 = u32::MAX;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter, in lengths of its direction.
    pub t: f32,
    /// Barycentric coordinate of the triangle's vertex 1; 0 for spheres and disks.
    pub u: f32,
    /// Barycentric coordinate of the triangle's vertex 2; 0 for spheres and disks.
    pub v: f32,
    /// Id in the [`Geometry`] of the [`Bvh`] that holds the primitive.
    pub geom: u32,
    /// Index of the triangle in its mesh; 0 for spheres and disks.
    pub prim: u32,
    /// Id of the instance in the outer [`Geometry`], or [`NO_INSTANCE`].
    pub instance: u32,
}

/// An 8-wide bounding volume hierarchy. Immutable, shared freely between threads.
pub struct Bvh {
    pub(crate) root: Option<Child>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) packs: Vec<Pack>,
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) disks: Vec<Disk>,
    pub(crate) instances: Vec<Instance>,
    /// (geom, prim): of the triangles in the order of the packs, then of the spheres, then of the disks.
    pub(crate) ids: Vec<[u32; 2]>,
    pub(crate) first_sphere_id: usize,
    pub(crate) first_disk_id: usize,
    pub(crate) bounds: Bounds3,
    pub(crate) dispatch: Dispatch,
}

impl Bvh {
    /// Builds the tree, on the threads of the enclosing `par::Workers`; the same tree on any number of them.
    ///
    /// # Panics
    /// Beyond 2²⁷ packs of triangles (some 5·10⁸ triangles) or as many of any other kind.
    pub fn build(geometry: Geometry) -> Self {
        build::build(geometry)
    }

    /// About the bytes that a triangle takes in a large tree.
    pub const BYTES_PER_TRIANGLE: u64 = 60;

    /// A tree that no ray meets, with its bounds: for looking at a scene that is not traced. Much cheaper than [`Bvh::build`].
    pub fn outline(geometry: &Geometry) -> Self {
        build::outline(geometry)
    }

    /// The first hit along the ray.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        kernel::closest(self, ray)
    }

    /// Whether there is any hit. Faster than [`Bvh::closest`].
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        kernel::occluded(self, ray)
    }

    /// A box around everything that can be hit; empty where there is nothing.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Bytes that the tree and its primitives take; instanced BVHs are not counted, since they are shared.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.packs[..])
            + size_of_val(&self.spheres[..])
            + size_of_val(&self.disks[..])
            + size_of_val(&self.instances[..])
            + size_of_val(&self.ids[..])
    }

    pub(crate) fn holds_instances(&self) -> bool {
        !self.instances.is_empty()
    }
}

impl std::fmt::Debug for Bvh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bvh")
            .field("nodes", &self.nodes.len())
            .field("packs", &self.packs.len())
            .field("spheres", &self.spheres.len())
            .field("disks", &self.disks.len())
            .field("instances", &self.instances.len())
            .field("bounds", &self.bounds)
            .finish_non_exhaustive()
    }
}
