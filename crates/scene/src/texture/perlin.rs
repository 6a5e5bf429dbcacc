//! Gradient noise (Perlin 2002, *Improving Noise*), with the order of gradients that pbrt has.

/// Perlin's permutation of 0..=255 (Perlin 2002, reference implementation).
#[rustfmt::skip]
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58,
    17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9,
    129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193,
    238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157,
    184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128,
    195, 78, 66, 215, 61, 156, 180,
];

/// The product of `d` with one of twelve edge directions, by the hash of a lattice point.
fn gradient(lattice: [i64; 3], [x, y, z]: [f32; 3]) -> f32 {
    let hash = |i: i64, seed: u8| PERMUTATION[((i as u8).wrapping_add(seed)) as usize];
    let [i, j, k] = lattice;
    let h = hash(k, hash(j, hash(i, 0))) & 15;
    let first = if h < 8 || h == 12 || h == 13 { x } else { y };
    let second = if h < 4 || h == 12 || h == 13 { y } else { z };
    (if h & 1 == 0 { first } else { -first }) + (if h & 2 == 0 { second } else { -second })
}

/// Noise about 0, within ±1.04; 0 on the lattice of whole numbers, period 256 along each axis. 0 where a coordinate is
/// not finite.
pub(super) fn noise(p: [f32; 3]) -> f32 {
    if !p.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    let cell = p.map(f32::floor);
    let d: [f32; 3] = std::array::from_fn(|c| p[c] - cell[c]);
    let base = cell.map(|x| x as i64);
    // 6t⁵ − 15t⁴ + 10t³ (Perlin 2002, eq. 3).
    let [wx, wy, wz] = d.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let at = |i: usize, j: usize, k: usize| {
        let lattice =
            [base[0].wrapping_add(i as i64), base[1].wrapping_add(j as i64), base[2].wrapping_add(k as i64)];
        gradient(lattice, [d[0] - i as f32, d[1] - j as f32, d[2] - k as f32])
    };
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |j: usize, k: usize| lerp(at(0, j, k), at(1, j, k), wx);
    let face = |k: usize| lerp(row(0, k), row(1, k), wy);
    lerp(face(0), face(1), wz)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn halton(i: u32, base: u32) -> f32 {
        let (mut i, mut f, mut r) = (i + 1, 1.0f64, 0.0f64);
        while i > 0 {
            f /= f64::from(base);
            r += f * f64::from(i % base);
            i /= base;
        }
        r as f32
    }

    #[test]
    fn the_permutation_is_one() {
        let mut seen = [false; 256];
        PERMUTATION.iter().for_each(|i| seen[usize::from(*i)] = true);
        assert!(seen.iter().all(|s| *s));
    }

    #[test]
    fn zero_on_the_lattice_and_about_zero_between() {
        let (mut sum, mut squares, mut most) = (0f64, 0f64, 0f32);
        let n = 200_000;
        for i in 0..n {
            let p = [2, 3, 5].map(|base| halton(i, base) * 200.0 - 100.0);
            assert_eq!(noise(p.map(f32::floor)), 0.0);
            let x = noise(p);
            sum += f64::from(x);
            squares += f64::from(x) * f64::from(x);
            most = most.max(x.abs());
        }
        let (mean, rms) = (sum / f64::from(n), (squares / f64::from(n)).sqrt());
        assert!(mean.abs() < 0.005, "{mean}");
        assert!((0.2..0.35).contains(&rms), "{rms}");
        assert!(most < 1.04 && most > 0.8, "{most}");
    }

    #[test]
    fn continuous_and_smooth_across_cells() {
        for i in 0..2000 {
            let p = [2, 3, 5].map(|base| (halton(i, base) * 40.0).floor() - 20.0);
            let q = [7, 11].map(|base| halton(i, base) * 40.0 - 20.0);
            let h = 1e-3;
            let along = |t: f32| noise([p[0] + t, q[0], q[1]]);
            assert!((along(h) - along(-h)).abs() < 4.0 * h);
            let (left, right) = (along(0.0) - along(-h), along(h) - along(0.0));
            assert!((left - right).abs() < 1e-4, "{left} {right}");
        }
    }
}
