use math::{Vec2, Vec3};

use crate::SurfaceInteraction;
use crate::attributes::{Attributes, Owner};

/// Where a texture is looked up. What few textures ask for is found only when they do.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoint<'a> {
    /// The place in the world.
    pub p: Vec3,
    /// Width of the footprint, in units of length.
    pub width: f32,
    /// The first texture coordinates.
    pub uv: Vec2,
    /// Their growth per unit of length (geometric mean of both axes); 0 where unknown.
    pub uv_per_length: f32,
    /// The surface, and the object and triangle of it.
    pub(super) surface: (Owner<'a>, u32, u32),
}

impl TexturePoint<'static> {
    /// A point of a surface that has nothing but texture coordinates, one unit of length for each unit of them; `width`
    /// is that of the footprint.
    pub fn of_uv(uv: Vec2, width: f32) -> Self {
        Self { p: Vec3::new(uv.x, uv.y, 0.0), width, uv, uv_per_length: 1.0, surface: (Owner::Unknown, 0, 0) }
    }
}

impl<'a> TexturePoint<'a> {
    /// The point of a hit, seen over a footprint of `width` units of length.
    #[inline]
    pub(crate) fn of_hit(hit: &SurfaceInteraction, width: f32, of: Owner<'a>) -> Self {
        let surface = (of, hit.object, hit.prim);
        Self { p: hit.p, width, uv: hit.uv, uv_per_length: hit.uv_per_length, surface }
    }

    /// What the surface has here.
    pub(crate) fn attributes(&self) -> Option<Attributes<'a>> {
        let (owner, object, prim) = self.surface;
        owner.attributes(object, prim)
    }

    /// The point of the surface that lies `by` away; right where the surface is flat.
    pub(crate) fn moved(&self, by: Vec3) -> Self {
        let p = self.p + by;
        let uv = self.attributes().map_or(self.uv + Vec2::new(by.x, by.y) * self.uv_per_length, |a| a.uv(p));
        Self { p, uv, ..*self }
    }

    /// Texture coordinates of a set and their growth per unit of length; of the first where there is no second.
    #[inline]
    pub(super) fn uv_set(&self, set: u8) -> (Vec2, f32) {
        if set == 0 { (self.uv, self.uv_per_length) } else { self.second() }
    }

    #[inline(never)]
    fn second(&self) -> (Vec2, f32) {
        self.attributes().and_then(|a| a.uv2(self.p)).unwrap_or((self.uv, self.uv_per_length))
    }

    /// The colour of the vertices and their opacity.
    pub(super) fn color(&self) -> [f32; 4] {
        self.attributes().and_then(|a| a.color(self.p)).unwrap_or([1.0; 4])
    }

    /// The distance over which the first coordinates grow by `step`; `None` where that is not known.
    pub(super) fn uv_grain(&self, step: f32) -> Option<f32> {
        (self.uv_per_length > 0.0).then(|| step / self.uv_per_length)
    }
}
