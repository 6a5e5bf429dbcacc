use math::{Ray, Vec2, Vec3, offset_ray_origin};

use crate::MaterialId;

/// Where a ray met a surface (`hit` by custom), in world space.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// The point.
    pub p: Vec3,
    /// Half-size of a cube about `p` that holds the true point.
    pub p_error: f32,
    /// Geometric normal, unit, outward as the shape was authored (its front).
    pub ng: Vec3,
    /// Shading normal, unit, in the hemisphere of `ng`.
    pub ns: Vec3,
    /// Direction of growing u on the surface; zero where unknown. Not normalised.
    pub dpdu: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Texture coordinates per unit of length along the surface (geometric mean of both axes); 0 where unknown.
    pub uv_per_length: f32,
    /// Distance from the ray's origin, in lengths of its direction.
    pub t: f32,
    /// Material of the object.
    pub material: MaterialId,
    /// The area light that this surface is, if any.
    pub light: Option<LightId>,
    /// Index of the triangle within its mesh; 0 for other shapes.
    pub prim: u32,
    /// Number of the object: those outside of groups come first, then those of each instance. The top bit is set where
    /// `ng` and `ns` were turned against the shape's own front (spheres alone; other shapes are turned when the scene is
    /// compiled).
    pub object: u32,
}

/// See [`SurfaceInteraction::object`].
pub(crate) const TURNED: u32 = 1 << 31;

/// Index of a light in [`crate::Scene::lights`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LightId(pub u32);

impl SurfaceInteraction {
    /// The same, copied number by number: the result of a function that is not inlined then joins that of one that is
    /// in registers, where otherwise both would be built in memory and read back before they have arrived there.
    #[inline(always)]
    pub(crate) fn unpacked(&self) -> Self {
        let copy = |v: Vec3| Vec3::new(v.x, v.y, v.z);
        Self {
            p: copy(self.p),
            p_error: self.p_error,
            ng: copy(self.ng),
            ns: copy(self.ns),
            dpdu: copy(self.dpdu),
            uv: Vec2::new(self.uv.x, self.uv.y),
            uv_per_length: self.uv_per_length,
            t: self.t,
            material: self.material,
            light: self.light,
            prim: self.prim,
            object: self.object,
        }
    }

    /// The geometric normal as the light that this surface is knows it.
    #[inline]
    pub fn authored_ng(&self) -> Vec3 {
        if self.object & TURNED != 0 { -self.ng } else { self.ng }
    }

    /// The ray that leaves along the unit vector `w`, from a point that is certainly on that side.
    #[inline]
    pub fn spawn_ray(&self, w: Vec3) -> Ray {
        Ray::new(offset_ray_origin(self.p, self.p_error, self.ng, w), w)
    }

    /// The segment to `target` (with its error cube and normal; zero normal: a point in space). Its direction is
    /// not of unit length: it ends at t = 1, just short of the target.
    #[inline]
    pub fn spawn_ray_to(&self, target: Vec3, target_error: f32, target_n: Vec3) -> Ray {
        let origin = offset_ray_origin(self.p, self.p_error, self.ng, target - self.p);
        let end = offset_ray_origin(target, target_error, target_n, origin - target);
        Ray { origin, direction: end - origin, t_max: 1.0 - 4.0 * f32::EPSILON }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hit_is_small() {
        // It is copied at every vertex of every path: what few materials need is found again by `attributes`.
        assert_eq!(size_of::<SurfaceInteraction>(), 88);
    }
}
