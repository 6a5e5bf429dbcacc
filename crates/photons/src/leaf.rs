//! Leaf scans: the only `unsafe` of this crate. The portable and the AVX2 scan do the same operations in the same
//! order without fused multiply-add, so that they give the same bits.
#![allow(unsafe_code)] // SIMD intrinsics, block by block

use math::Vec3;

/// Points of a leaf.
pub(crate) const LEAF: usize = 64;
/// Room that a scan needs in its output.
pub(crate) const ROOM: usize = LEAF + 8;

/// Positions of a leaf; unused places hold NaN, which no test accepts.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    pub(crate) x: [f32; LEAF],
    pub(crate) y: [f32; LEAF],
    pub(crate) z: [f32; LEAF],
}

impl Block {
    pub(crate) const EMPTY: Self = Self { x: [f32::NAN; LEAF], y: [f32::NAN; LEAF], z: [f32::NAN; LEAF] };

    #[inline]
    pub(crate) fn position(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }
}

/// Octahedral normals of a leaf, as [`math::octahedral_encode`] gives them.
pub(crate) type Normals = [u32; LEAF];

/// The test of a photon against the surface of a query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Unit normal at the query.
    pub(crate) normal: Vec3,
    /// Least n_p·n_x.
    pub(crate) min_cosine: f32,
    /// 1/(2τ): turns |(x_p − x)·(n_p + n_x)| into the radius from which on the photon is accepted.
    pub(crate) reach: f32,
}

/// Instructions of the scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Isa {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Isa {
    /// The fastest that this machine has.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("popcnt") {
            return Self::Avx2;
        }
        Self::Portable
    }

    /// Appends each point within √`bound` as `pack(d², base + place)` to `out`, in order of place; returns how many.
    #[inline]
    pub(crate) fn scan(self, block: &Block, center: Vec3, bound: f32, base: u32, out: &mut [u64]) -> usize {
        match self {
            Self::Portable => portable(block, None, center, bound, base, out),
            // SAFETY: `detect` made this value, so the machine has AVX2 and POPCNT.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2::scan(block, center, bound, base, out) },
        }
    }

    /// The same for photons that pass the test of `surface`; what is packed is the square of the least radius that
    /// accepts the photon.
    #[inline]
    pub(crate) fn scan_photons(
        self,
        block: &Block,
        normals: &Normals,
        surface: &Surface,
        center: Vec3,
        bound: f32,
        base: u32,
        out: &mut [u64],
    ) -> usize {
        match self {
            Self::Portable => portable(block, Some((normals, surface)), center, bound, base, out),
            // SAFETY: `detect` made this value, so the machine has AVX2 and POPCNT.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2::scan_photons(block, normals, surface, center, bound, base, out) },
        }
    }
}

/// Asks for the cache lines of `value`; changes nothing else.
#[inline]
pub(crate) fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    for offset in (0..size_of::<T>()).step_by(64) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: offset < size_of::<T>(), so the address lies in `value`; a prefetch reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast::<i8>().add(offset)) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}

/// A candidate in one word: ordered by key, then by slot (the bits of floats ≥ 0 are in the order of the floats).
#[inline]
pub(crate) fn pack(key: f32, slot: u32) -> u64 {
    u64::from(key.to_bits()) << 32 | u64::from(slot)
}

/// Key and slot of [`pack`].
#[inline]
pub(crate) fn unpack(candidate: u64) -> (f32, u32) {
    (f32::from_bits((candidate >> 32) as u32), candidate as u32)
}

fn portable(
    block: &Block,
    photons: Option<(&Normals, &Surface)>,
    center: Vec3,
    bound: f32,
    base: u32,
    out: &mut [u64],
) -> usize {
    let mut count = 0;
    for i in 0..LEAF {
        let d = block.position(i) - center;
        let mut key = (d.x * d.x + d.y * d.y) + d.z * d.z;
        let mut accepted = key <= bound;
        if let Some((normals, s)) = photons.filter(|_| accepted) {
            let n = decode(normals[i]);
            let height = ((n.x + s.normal.x) * d.x + (n.y + s.normal.y) * d.y) + (n.z + s.normal.z) * d.z;
            let reach = height * s.reach;
            let reach2 = reach * reach;
            key = if key > reach2 { key } else { reach2 };
            let cosine = (n.x * s.normal.x + n.y * s.normal.y) + n.z * s.normal.z;
            accepted = key <= bound && cosine >= s.min_cosine;
        }
        if accepted {
            out[count] = pack(key, base + i as u32);
            count += 1;
        }
    }
    count
}

/// [`math::octahedral_decode`] in the operations of the AVX2 scan.
fn decode(code: u32) -> Vec3 {
    let d = |c: u32| c as f32 * (2.0 / 65534.0) - 1.0;
    let (x, y) = (d(code & 0xffff), d(code >> 16));
    let z = (1.0 - x.abs()) - y.abs();
    let t = if -z > 0.0 { -z } else { 0.0 };
    let (x, y) = (x - t.copysign(x), y - t.copysign(y));
    let scale = 1.0 / ((x * x + y * y) + z * z).sqrt();
    Vec3::new(x * scale, y * scale, z * scale)
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use math::Vec3;

    use super::{Block, LEAF, Normals, ROOM, Surface};

    /// For each mask of eight lanes the set lanes in order, a byte each.
    static LANES: [u64; 256] = {
        let mut table = [0u64; 256];
        let mut mask = 0;
        while mask < 256 {
            let (mut lane, mut at) = (0, 0);
            while lane < 8 {
                if mask >> lane & 1 == 1 {
                    table[mask] |= lane << (8 * at);
                    at += 1;
                }
                lane += 1;
            }
            mask += 1;
        }
        table
    };

    /// Writes the candidates of the lanes in `mask` to `out[count..]`; returns the new count.
    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn append(key: __m256, mask: i32, first: u32, out: &mut [u64], count: usize) -> usize {
        let mask = mask as usize & 0xff;
        let lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(LANES[mask] as i64));
        let key = _mm256_permutevar8x32_epi32(_mm256_castps_si256(key), lanes);
        let slot = _mm256_add_epi32(lanes, _mm256_set1_epi32(first as i32));
        let low = _mm256_unpacklo_epi32(slot, key);
        let high = _mm256_unpackhi_epi32(slot, key);
        debug_assert!(count + 8 <= out.len());
        // SAFETY: at most 8·(group index) candidates came before, so that count + 8 ≤ LEAF ≤ ROOM − 8, and the
        // callers check that `out` holds ROOM.
        unsafe {
            let to = out.as_mut_ptr().add(count).cast::<__m256i>();
            _mm256_storeu_si256(to, _mm256_permute2x128_si256::<0x20>(low, high));
            _mm256_storeu_si256(to.add(1), _mm256_permute2x128_si256::<0x31>(low, high));
        }
        count + mask.count_ones() as usize
    }

    /// Eight values from `from[first..]`.
    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn load(from: &[f32; LEAF], first: usize) -> __m256 {
        debug_assert!(first + 8 <= LEAF);
        // SAFETY: every caller steps `first` by 8 below LEAF = 64.
        unsafe { _mm256_loadu_ps(from.as_ptr().add(first)) }
    }

    #[target_feature(enable = "avx2,popcnt")]
    pub(super) fn scan(block: &Block, center: Vec3, bound: f32, base: u32, out: &mut [u64]) -> usize {
        assert!(out.len() >= ROOM);
        let (cx, cy, cz) = (_mm256_set1_ps(center.x), _mm256_set1_ps(center.y), _mm256_set1_ps(center.z));
        let bound = _mm256_set1_ps(bound);
        let mut count = 0;
        for first in (0..LEAF).step_by(8) {
            let x = _mm256_sub_ps(load(&block.x, first), cx);
            let y = _mm256_sub_ps(load(&block.y, first), cy);
            let z = _mm256_sub_ps(load(&block.z, first), cz);
            let key = dot(x, y, z, x, y, z);
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(key, bound));
            // Also where the mask is empty: a branch here is mispredicted too often.
            count = append(key, mask, base + first as u32, out, count);
        }
        count
    }

    #[target_feature(enable = "avx2,popcnt")]
    pub(super) fn scan_photons(
        block: &Block,
        normals: &Normals,
        surface: &Surface,
        center: Vec3,
        bound: f32,
        base: u32,
        out: &mut [u64],
    ) -> usize {
        assert!(out.len() >= ROOM);
        let (cx, cy, cz) = (_mm256_set1_ps(center.x), _mm256_set1_ps(center.y), _mm256_set1_ps(center.z));
        let n = surface.normal;
        let (sx, sy, sz) = (_mm256_set1_ps(n.x), _mm256_set1_ps(n.y), _mm256_set1_ps(n.z));
        let (reach, min_cosine) = (_mm256_set1_ps(surface.reach), _mm256_set1_ps(surface.min_cosine));
        let bound = _mm256_set1_ps(bound);
        let mut count = 0;
        for first in (0..LEAF).step_by(8) {
            let x = _mm256_sub_ps(load(&block.x, first), cx);
            let y = _mm256_sub_ps(load(&block.y, first), cy);
            let z = _mm256_sub_ps(load(&block.z, first), cz);
            let d2 = dot(x, y, z, x, y, z);
            if _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(d2, bound)) == 0 {
                continue;
            }
            // SAFETY: first + 8 ≤ LEAF = normals.len().
            let code = unsafe { _mm256_loadu_si256(normals.as_ptr().add(first).cast()) };
            let (nx, ny, nz) = decode(code);
            let height = dot(_mm256_add_ps(nx, sx), _mm256_add_ps(ny, sy), _mm256_add_ps(nz, sz), x, y, z);
            let height = _mm256_mul_ps(height, reach);
            let key = _mm256_max_ps(d2, _mm256_mul_ps(height, height));
            let cosine = dot(nx, ny, nz, sx, sy, sz);
            // A key ≤ bound implies d² ≤ bound; NaN (unused places) fails the ordered comparison.
            let near = _mm256_cmp_ps::<_CMP_LE_OQ>(key, bound);
            let compatible = _mm256_cmp_ps::<_CMP_GE_OQ>(cosine, min_cosine);
            let mask = _mm256_movemask_ps(_mm256_and_ps(near, compatible));
            if mask != 0 {
                count = append(key, mask, base + first as u32, out, count);
            }
        }
        count
    }

    /// (a·x + b·y) + c·z, rounded after each operation.
    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn dot(a: __m256, b: __m256, c: __m256, x: __m256, y: __m256, z: __m256) -> __m256 {
        _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(a, x), _mm256_mul_ps(b, y)), _mm256_mul_ps(c, z))
    }

    /// Eight times `super::decode`.
    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn decode(code: __m256i) -> (__m256, __m256, __m256) {
        let sign = _mm256_set1_ps(-0.0);
        let one = _mm256_set1_ps(1.0);
        let step = _mm256_set1_ps(2.0 / 65534.0);
        let low = _mm256_and_si256(code, _mm256_set1_epi32(0xffff));
        let x = _mm256_sub_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(low), step), one);
        let y = _mm256_sub_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_srli_epi32::<16>(code)), step), one);
        let z = _mm256_sub_ps(_mm256_sub_ps(one, _mm256_andnot_ps(sign, x)), _mm256_andnot_ps(sign, y));
        let t = _mm256_max_ps(_mm256_xor_ps(z, sign), _mm256_setzero_ps());
        let x = _mm256_sub_ps(x, _mm256_or_ps(t, _mm256_and_ps(x, sign)));
        let y = _mm256_sub_ps(y, _mm256_or_ps(t, _mm256_and_ps(y, sign)));
        let scale = _mm256_div_ps(one, _mm256_sqrt_ps(dot(x, y, z, x, y, z)));
        (_mm256_mul_ps(x, scale), _mm256_mul_ps(y, scale), _mm256_mul_ps(z, scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::{octahedral_decode, octahedral_encode};
    use sampling::{Domain, Sampler, warp};

    #[test]
    fn decoding_agrees_with_math() {
        let mut s = Sampler::new(3, 0, Domain::Other, 0);
        for _ in 0..10_000 {
            let code = octahedral_encode(warp::sphere(s.next_2d()));
            assert!((decode(code) - octahedral_decode(code)).length() < 2e-7);
        }
    }

    #[test]
    fn portable_and_detected_scan_give_the_same_bits() {
        let mut s = Sampler::new(4, 0, Domain::Other, 0);
        for round in 0..400 {
            let mut block = Block::EMPTY;
            let mut normals = [0; LEAF];
            for (i, normal) in normals.iter_mut().enumerate().take(round % LEAF + 1) {
                block.x[i] = s.next_1d() - 0.5;
                block.y[i] = s.next_1d() - 0.5;
                block.z[i] = 0.1 * s.next_1d() - 0.05;
                *normal = octahedral_encode(warp::cosine_hemisphere(s.next_2d()));
            }
            let surface = Surface { normal: warp::sphere(s.next_2d()), min_cosine: 0.5, reach: 2.5 };
            let bound = if round % 7 == 0 { f32::INFINITY } else { 0.3 * s.next_1d() };
            let (mut a, mut b) = ([0; ROOM], [0; ROOM]);
            let m = Isa::Portable.scan(&block, Vec3::ZERO, bound, 640, &mut a);
            let n = Isa::detect().scan(&block, Vec3::ZERO, bound, 640, &mut b);
            assert_eq!(a[..m], b[..n]);
            let m = Isa::Portable.scan_photons(&block, &normals, &surface, Vec3::ZERO, bound, 640, &mut a);
            let n = Isa::detect().scan_photons(&block, &normals, &surface, Vec3::ZERO, bound, 640, &mut b);
            assert_eq!(a[..m], b[..n]);
        }
    }
}
