//! Search of the tree, generic over the instructions that test boxes and triangles.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod portable;
mod traverse;

use math::Ray;

use crate::bvh::{Bvh, Hit, NO_INSTANCE};
use crate::node::{LANES, Node, Pack, WIDTH};
use traverse::Best;

/// The instructions to use, found out once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dispatch {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Available),
}

impl Dispatch {
    /// The fastest that this processor has.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(available) = avx2::Available::detect() {
            return Self::Avx2(available);
        }
        Self::Portable
    }
}

#[inline]
pub(crate) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    let mut best = Best::new(ray.t_max);
    if is_sound(ray) {
        match bvh.dispatch {
            Dispatch::Portable => portable::search::<false>(bvh, ray, &mut best, NO_INSTANCE),
            #[cfg(target_arch = "x86_64")]
            Dispatch::Avx2(available) => avx2::search::<false>(available, bvh, ray, &mut best, NO_INSTANCE),
        }
    }
    best.into_hit()
}

#[inline]
pub(crate) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    let mut best = Best::new(ray.t_max);
    if is_sound(ray) {
        match bvh.dispatch {
            Dispatch::Portable => portable::search::<true>(bvh, ray, &mut best, NO_INSTANCE),
            #[cfg(target_arch = "x86_64")]
            Dispatch::Avx2(available) => avx2::search::<true>(available, bvh, ray, &mut best, NO_INSTANCE),
        }
    }
    best.found
}

/// Finite, with somewhere to go.
#[inline]
fn is_sound(ray: &Ray) -> bool {
    let d = ray.direction.abs().max_element();
    ray.t_max > 0.0 && ray.origin.is_finite() && ray.direction.is_finite() && d > 0.0
}

/// A ray as the box and triangle tests want it.
#[derive(Clone, Copy)]
pub(super) struct Prepared {
    origin: [f32; 3],
    /// 1/direction; ±∞ where it is 0.
    inverse: [f32; 3],
    /// For each axis, the row of a node that the ray meets first; the other differs in bit 0.
    near_row: [usize; 3],
    /// The axes in the order of Woop et al. 2013, §3.1: the longest of the direction last, right-handed.
    axes: [usize; 3],
    /// Their shear constants S_x, S_y, S_z.
    shear: [f32; 3],
}

/// Greatest relative error of a computed distance to a plane, both ways: 2γ(3), rounded up (Ize 2013, "Robust BVH
/// ray traversal").
const SLAB: f32 = 1.0 + 4.0e-7;

impl Prepared {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        let size = d.map(f32::abs);
        let z = if size[0] > size[1] {
            if size[0] > size[2] { 0 } else { 2 }
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let (mut x, mut y) = (if z == 2 { 0 } else { z + 1 }, if z == 0 { 2 } else { z - 1 });
        if d[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let inverse = d.map(|d| 1.0 / d);
        let row = |axis: usize| 2 * axis + usize::from(d[axis].is_sign_negative());
        Self {
            origin: o,
            inverse,
            near_row: [row(0), row(1), row(2)],
            axes: [x, y, z],
            shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]],
        }
    }
}

/// Children of a node that a ray meets.
pub(super) struct NodeHits {
    /// One bit for each.
    mask: u32,
    /// Where the ray enters them, or 0 where it starts inside.
    near: Row8,
}

#[repr(align(32))]
pub(super) struct Row8([f32; WIDTH]);

/// Triangles of a pack that a ray meets at 0 < t ≤ end.
pub(super) struct PackHits {
    mask: u32,
    t: Row4,
    u: Row4,
    v: Row4,
}

#[repr(align(16))]
pub(super) struct Row4([f32; LANES]);

/// The two tests, prepared for one ray. Every implementation returns the same bits.
pub(super) trait Kernel {
    /// Boxes that the ray meets at t ≤ `end`; never one too few.
    fn node(&self, node: &Node, end: f32) -> NodeHits;

    /// Triangles that the ray meets at 0 < t ≤ `end`.
    fn pack(&self, pack: &Pack, end: f32) -> PackHits;

    /// Begins to load the four cache lines from `address`, which may be anything.
    fn prefetch(&self, address: *const u8);

    /// Searches an instance's tree with the same instructions.
    fn search<const ANY: bool>(&self, bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32);
}

/// Edge functions in f64, where one of them came out as zero (Woop et al. 2013, §3.2): products of f32 are exact
/// there, so that the signs are right. `a`, `b`, `c` are the sheared corners.
#[cold]
fn edges_f64(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> [f32; 3] {
    let edge = |p: [f32; 2], q: [f32; 2]| {
        (f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0])) as f32
    };
    [edge(c, b), edge(a, c), edge(b, a)]
}
