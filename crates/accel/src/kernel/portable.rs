//! The tests in plain Rust, which compilers turn into what vector instructions the target has.

use math::Ray;

use super::traverse::{Best, traverse};
use super::{Kernel, NodeHits, PackHits, Prepared, Row4, Row8, SLAB, edges_f64};
use crate::bvh::Bvh;
use crate::node::{LANES, Node, Pack, WIDTH};

pub(super) struct Portable(Prepared);

pub(super) fn search<const ANY: bool>(bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32) {
    traverse::<Portable, ANY>(&Portable(Prepared::new(ray)), bvh, ray, best, instance);
}

/// As the x86 instructions: the second where either is NaN.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl Kernel for Portable {
    #[inline(always)]
    fn node(&self, node: &Node, end: f32) -> NodeHits {
        let ray = &self.0;
        let mut near = [0f32; WIDTH];
        let mut far = [end; WIDTH];
        // A NaN, 0·∞, means that the ray lies in the plane of a box's side: it does not bound the ray.
        for axis in (0..3).rev() {
            let (enter, leave) = (&node.rows[ray.near_row[axis]], &node.rows[ray.near_row[axis] ^ 1]);
            let (o, inverse) = (ray.origin[axis], ray.inverse[axis]);
            for i in 0..WIDTH {
                near[i] = max((enter[i] - o) * inverse, near[i]);
                far[i] = min((leave[i] - o) * (inverse * SLAB), far[i]);
            }
        }
        let mut mask = 0;
        for i in 0..WIDTH {
            mask |= u32::from(near[i] <= far[i]) << i;
        }
        NodeHits { mask, near: Row8(near) }
    }

    #[inline(always)]
    fn pack(&self, pack: &Pack, end: f32) -> PackHits {
        let ray = &self.0;
        let [x, y, z] = ray.axes;
        let (mut mask, mut t, mut u, mut v) = (0, [0f32; LANES], [0f32; LANES], [0f32; LANES]);
        for lane in 0..LANES {
            if pack.valid >> lane & 1 == 0 {
                continue;
            }
            let corner = |i: usize| {
                let vertex = pack.corners[i][lane] as usize;
                let at = |axis: usize| pack.rows[axis][vertex] - ray.origin[axis];
                let pz = at(z);
                ([at(x) - ray.shear[0] * pz, at(y) - ray.shear[1] * pz], ray.shear[2] * pz)
            };
            let ((a, az), (b, bz), (c, cz)) = (corner(0), corner(1), corner(2));
            let edge = |p: [f32; 2], q: [f32; 2]| p[0] * q[1] - p[1] * q[0];
            let mut e = [edge(c, b), edge(a, c), edge(b, a)];
            if e.contains(&0.0) {
                e = edges_f64(a, b, c);
            }
            if e.iter().any(|&e| e < 0.0) && e.iter().any(|&e| e > 0.0) {
                continue;
            }
            let determinant = e[0] + e[1] + e[2];
            let r = 1.0 / determinant;
            t[lane] = (e[0] * az + e[1] * bz + e[2] * cz) * r;
            u[lane] = e[1] * r;
            v[lane] = e[2] * r;
            mask |= u32::from(t[lane] > 0.0 && t[lane] <= end && determinant != 0.0) << lane;
        }
        PackHits { mask, t: Row4(t), u: Row4(u), v: Row4(v) }
    }

    #[inline(always)]
    fn prefetch(&self, _: *const u8) {}

    fn search<const ANY: bool>(&self, bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32) {
        search::<ANY>(bvh, ray, best, instance);
    }
}
