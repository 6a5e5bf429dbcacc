//! The tests in AVX2. No fused operations: the portable path must come to the same bits, and the edge functions
//! of two triangles at a common edge must be exact opposites.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use math::Ray;

use super::traverse::{Best, traverse};
use super::{Kernel, NodeHits, PackHits, Prepared, Row4, Row8, SLAB, edges_f64};
use crate::bvh::Bvh;
use crate::node::{LANES, Node, Pack, WIDTH};

/// Proof that this processor has AVX2, BMI 1 and 2, and POPCNT: made by [`Available::detect`] alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Available(());

impl Available {
    pub fn detect() -> Option<Self> {
        let yes = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt");
        yes.then_some(Self(()))
    }
}

pub(super) fn search<const ANY: bool>(_: Available, bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32) {
    // SAFETY: the processor has what the function is compiled for, as `Available` proves.
    unsafe { search_avx2::<ANY>(bvh, ray, best, instance) }
}

#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn search_avx2<const ANY: bool>(bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32) {
    // SAFETY: as this function is compiled for them, its caller has seen to it that the processor has them.
    let kernel = unsafe { Avx2::new(ray) };
    traverse::<Avx2, ANY>(&kernel, bvh, ray, best, instance);
}

pub(super) struct Avx2 {
    /// For each axis, in 8 lanes.
    origin: [__m256; 3],
    inverse: [__m256; 3],
    inverse_far: [__m256; 3],
    near_row: [usize; 3],
    axes: [usize; 3],
    /// The origin along `axes`, in 8 lanes.
    sheared_origin: [__m256; 3],
    shear: [__m256; 3],
}

impl Avx2 {
    /// # Safety
    /// The processor must have AVX2, BMI and POPCNT; whoever holds an `Avx2` may rely on it.
    #[inline(always)]
    unsafe fn new(ray: &Ray) -> Self {
        let p = Prepared::new(ray);
        // SAFETY: by this function's contract.
        unsafe {
            let o = p.origin;
            Self {
                origin: [_mm256_set1_ps(o[0]), _mm256_set1_ps(o[1]), _mm256_set1_ps(o[2])],
                inverse: [
                    _mm256_set1_ps(p.inverse[0]),
                    _mm256_set1_ps(p.inverse[1]),
                    _mm256_set1_ps(p.inverse[2]),
                ],
                inverse_far: [
                    _mm256_set1_ps(p.inverse[0] * SLAB),
                    _mm256_set1_ps(p.inverse[1] * SLAB),
                    _mm256_set1_ps(p.inverse[2] * SLAB),
                ],
                near_row: p.near_row,
                axes: p.axes,
                sheared_origin: [
                    _mm256_set1_ps(o[p.axes[0]]),
                    _mm256_set1_ps(o[p.axes[1]]),
                    _mm256_set1_ps(o[p.axes[2]]),
                ],
                shear: [_mm256_set1_ps(p.shear[0]), _mm256_set1_ps(p.shear[1]), _mm256_set1_ps(p.shear[2])],
            }
        }
    }
}

impl Kernel for Avx2 {
    #[inline(always)]
    fn node(&self, node: &Node, end: f32) -> NodeHits {
        let rows = node.rows.as_ptr().cast::<f32>();
        let mut near_out = Row8([0.0; WIDTH]);
        // SAFETY: an `Avx2` exists only where the processor has AVX2. `near_row` is 0…5, so that all loads are of
        // 8 numbers of the node's 6 rows, which are aligned to 32 bytes as the node is to 64. `Row8` is, too.
        let mask = unsafe {
            let slab = |axis: usize, row: usize, inverse: __m256| {
                let plane = _mm256_load_ps(rows.add(WIDTH * row));
                _mm256_mul_ps(_mm256_sub_ps(plane, self.origin[axis]), inverse)
            };
            // `max` and `min` return the second where the first is NaN: see the portable path.
            let mut near = _mm256_setzero_ps();
            let mut far = _mm256_set1_ps(end);
            near = _mm256_max_ps(slab(2, self.near_row[2], self.inverse[2]), near);
            far = _mm256_min_ps(slab(2, self.near_row[2] ^ 1, self.inverse_far[2]), far);
            near = _mm256_max_ps(slab(1, self.near_row[1], self.inverse[1]), near);
            far = _mm256_min_ps(slab(1, self.near_row[1] ^ 1, self.inverse_far[1]), far);
            near = _mm256_max_ps(slab(0, self.near_row[0], self.inverse[0]), near);
            far = _mm256_min_ps(slab(0, self.near_row[0] ^ 1, self.inverse_far[0]), far);
            _mm256_store_ps(near_out.0.as_mut_ptr(), near);
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far)) as u32
        };
        NodeHits { mask, near: near_out }
    }

    #[inline(always)]
    fn pack(&self, pack: &Pack, end: f32) -> PackHits {
        let rows = pack.rows.as_ptr().cast::<f32>();
        let mut out =
            PackHits { mask: 0, t: Row4([0.0; LANES]), u: Row4([0.0; LANES]), v: Row4([0.0; LANES]) };
        // SAFETY: an `Avx2` exists only where the processor has AVX2. `axes` are 0…2, so that all loads are of 8
        // numbers of the pack's 3 rows, which are aligned to 32 bytes as the pack is to 64. `Row4` is to 16.
        unsafe {
            let at = |i: usize| {
                _mm256_sub_ps(_mm256_load_ps(rows.add(WIDTH * self.axes[i])), self.sheared_origin[i])
            };
            // All vertices at once, then each corner of the triangles picks its own.
            let z = at(2);
            let x = _mm256_sub_ps(at(0), _mm256_mul_ps(self.shear[0], z));
            let y = _mm256_sub_ps(at(1), _mm256_mul_ps(self.shear[1], z));
            let z = _mm256_mul_ps(self.shear[2], z);
            let pick = |corner: usize, row: __m256| {
                let lanes = i32::from_ne_bytes(pack.corners[corner]);
                let lanes = _mm_cvtepu8_epi32(_mm_cvtsi32_si128(lanes));
                _mm256_castps256_ps128(_mm256_permutevar8x32_ps(row, _mm256_castsi128_si256(lanes)))
            };
            let (ax, ay, bx, by, cx, cy) =
                (pick(0, x), pick(0, y), pick(1, x), pick(1, y), pick(2, x), pick(2, y));
            let edge = |px: __m128, py: __m128, qx: __m128, qy: __m128| {
                _mm_sub_ps(_mm_mul_ps(px, qy), _mm_mul_ps(py, qx))
            };
            let (mut e0, mut e1, mut e2) = (edge(cx, cy, bx, by), edge(ax, ay, cx, cy), edge(bx, by, ax, ay));
            let zero = _mm_setzero_ps();
            let is_zero = |e: __m128| _mm_cmpeq_ps(e, zero);
            let zeros = _mm_or_ps(_mm_or_ps(is_zero(e0), is_zero(e1)), is_zero(e2));
            let zeros = _mm_movemask_ps(zeros) as u32 & pack.valid;
            if zeros != 0 {
                (e0, e1, e2) = repair(zeros, [ax, ay, bx, by, cx, cy], [e0, e1, e2]);
            }
            let low = _mm_min_ps(_mm_min_ps(e0, e1), e2);
            let high = _mm_max_ps(_mm_max_ps(e0, e1), e2);
            // Not (some below zero and some above).
            let outside = _mm_and_ps(_mm_cmplt_ps(low, zero), _mm_cmpgt_ps(high, zero));
            let inside = !(_mm_movemask_ps(outside) as u32) & pack.valid;
            if inside == 0 {
                return out;
            }
            let determinant = _mm_add_ps(_mm_add_ps(e0, e1), e2);
            let r = _mm_div_ps(_mm_set1_ps(1.0), determinant);
            let (az, bz, cz) = (pick(0, z), pick(1, z), pick(2, z));
            let sum = _mm_add_ps(_mm_add_ps(_mm_mul_ps(e0, az), _mm_mul_ps(e1, bz)), _mm_mul_ps(e2, cz));
            let t = _mm_mul_ps(sum, r);
            let within = _mm_and_ps(_mm_cmpgt_ps(t, zero), _mm_cmple_ps(t, _mm_set1_ps(end)));
            let within = _mm_and_ps(within, _mm_cmpneq_ps(determinant, zero));
            out.mask = inside & _mm_movemask_ps(within) as u32;
            _mm_store_ps(out.t.0.as_mut_ptr(), t);
            _mm_store_ps(out.u.0.as_mut_ptr(), _mm_mul_ps(e1, r));
            _mm_store_ps(out.v.0.as_mut_ptr(), _mm_mul_ps(e2, r));
        }
        out
    }

    #[inline(always)]
    fn prefetch(&self, address: *const u8) {
        for line in 0..4 {
            // SAFETY: a hint to the processor, which never faults, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64 * line).cast()) };
        }
    }

    fn search<const ANY: bool>(&self, bvh: &Bvh, ray: &Ray, best: &mut Best, instance: u32) {
        // SAFETY: an `Avx2` exists only where the processor has AVX2, BMI and POPCNT.
        unsafe { search_avx2::<ANY>(bvh, ray, best, instance) }
    }
}

/// The edge functions anew in f64, in the lanes of `mask`; `corners` are ax, ay, bx, by, cx, cy.
#[cold]
#[inline(never)]
#[target_feature(enable = "avx2")]
fn repair(mut mask: u32, corners: [__m128; 6], edges: [__m128; 3]) -> (__m128, __m128, __m128) {
    let lanes = |v: __m128| {
        let mut out = Row4([0.0; LANES]);
        // SAFETY: `out` holds four numbers, aligned to 16 bytes.
        unsafe { _mm_store_ps(out.0.as_mut_ptr(), v) };
        out.0
    };
    let p = corners.map(lanes);
    let mut e = edges.map(lanes);
    while mask != 0 {
        let i = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let exact = edges_f64([p[0][i], p[1][i]], [p[2][i], p[3][i]], [p[4][i], p[5][i]]);
        for (row, exact) in e.iter_mut().zip(exact) {
            row[i] = exact;
        }
    }
    let load = |row: [f32; LANES]| _mm_setr_ps(row[0], row[1], row[2], row[3]);
    (load(e[0]), load(e[1]), load(e[2]))
}
