use std::sync::Arc;

use math::{Bounds3, Transform, Vec3};

use crate::bvh::Bvh;
use crate::shapes::{Disk, Sphere};

/// What a [`Bvh`] is built from: triangle meshes, spheres, disks and instances of other BVHs.
///
/// Each `add_…` returns the id of what it added; ids count up from 0 in the order of the calls. What cannot be hit
/// (a triangle with an index out of range, a number that is not finite, a negative radius, a zero normal) keeps its
/// id and is left out of the tree.
#[derive(Default)]
pub struct Geometry {
    pub(crate) positions: Vec<Vec3>,
    /// Indices into `positions`.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// (geom, index of the triangle in its mesh), for each of `triangles`.
    pub(crate) triangle_ids: Vec<[u32; 2]>,
    pub(crate) spheres: Vec<(Sphere, u32)>,
    pub(crate) disks: Vec<(Disk, u32)>,
    pub(crate) instances: Vec<Instance>,
    next_geom: u32,
}

/// A placed BVH.
pub(crate) struct Instance {
    pub bvh: Arc<Bvh>,
    pub transform: Transform,
    pub geom: u32,
}

/// The BVH to be instanced holds instances itself; only one level is supported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NestedInstance;

impl std::fmt::Display for NestedInstance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an instance of geometry that itself holds instances: only one level is supported")
    }
}

impl std::error::Error for NestedInstance {}

impl Geometry {
    /// Nothing yet; the same as `default`.
    pub fn new() -> Self {
        Self::default()
    }

    fn next_id(&mut self) -> u32 {
        self.next_geom += 1;
        self.next_geom - 1
    }

    /// A mesh: `indices` are triples into `positions`. Returns its geom id; a hit's `prim` is the index into `indices`.
    pub fn add_triangles(&mut self, positions: &[Vec3], indices: &[[u32; 3]]) -> u32 {
        let geom = self.next_id();
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(positions);
        self.triangles.reserve(indices.len());
        self.triangle_ids.reserve(indices.len());
        for (prim, triangle) in indices.iter().enumerate() {
            let corners = triangle.map(|i| positions.get(i as usize).copied().unwrap_or(Vec3::NAN));
            let degenerate = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
            if !degenerate && corners.iter().all(|p| p.is_finite()) {
                self.triangles.push(triangle.map(|i| base + i));
                self.triangle_ids.push([geom, prim as u32]);
            }
        }
        geom
    }

    /// A sphere, hit from inside and outside.
    pub fn add_sphere(&mut self, center: Vec3, radius: f32) -> u32 {
        let geom = self.next_id();
        if center.is_finite() && radius > 0.0 && radius.is_finite() {
            self.spheres.push((Sphere { center, radius }, geom));
        }
        geom
    }

    /// A flat disk; `normal` need not be of unit length.
    pub fn add_disk(&mut self, center: Vec3, normal: Vec3, radius: f32) -> u32 {
        let geom = self.next_id();
        let unit = normal.as_dvec3().normalize_or_zero();
        if center.is_finite()
            && normal.is_finite()
            && unit.length_squared() > 0.0
            && radius > 0.0
            && radius.is_finite()
        {
            self.disks.push((Disk { center, radius, normal: unit }, geom));
        }
        geom
    }

    /// A placed copy of `bvh`, which is shared, not copied; `transform` maps it to this geometry's space.
    ///
    /// # Errors
    /// [`NestedInstance`] where `bvh` holds instances; no id is used up.
    pub fn add_instance(&mut self, bvh: Arc<Bvh>, transform: Transform) -> Result<u32, NestedInstance> {
        if bvh.holds_instances() {
            return Err(NestedInstance);
        }
        let geom = self.next_id();
        if !bvh.bounds().is_empty() && Instance::bounds_of(&bvh, &transform).size().is_finite() {
            self.instances.push(Instance { bvh, transform, geom });
        }
        Ok(geom)
    }
}

impl Instance {
    fn bounds_of(bvh: &Bvh, transform: &Transform) -> Bounds3 {
        let b = transform.bounds(&bvh.bounds());
        // The ray goes to the instance's space with rounding errors; the box makes room for them.
        let pad = Vec3::splat(4e-6 * b.min.abs().max(b.max.abs()).max_element());
        Bounds3 { min: b.min - pad, max: b.max + pad }
    }

    pub fn bounds(&self) -> Bounds3 {
        Self::bounds_of(&self.bvh, &self.transform)
    }
}
