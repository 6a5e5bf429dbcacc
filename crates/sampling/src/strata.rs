/// Points in [0, 1)² that fill the square evenly over the passes of one pixel, for as many dimensions as are asked for:
/// the (0, 2)-sequence of Sobol', for each pair of dimensions shuffled and scrambled on its own (Owen 1995, by the hash of
/// Laine & Karras 2011; padding by shuffling: Burley 2020, "Practical hash-based Owen scrambling").
///
/// Each point is uniform over keys; for one key, any 2ᵏ points that start at a multiple of 2ᵏ hit each of the elementary
/// boxes of area 2⁻ᵏ once. A `Copy` value of 8 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Strata {
    key: u32,
    index: u32,
}

impl Strata {
    /// Point `index` of the sequences of `key`. Indices count modulo 2³².
    #[inline]
    pub fn new(key: u64, index: u64) -> Self {
        Self { key: hash(key as u32 ^ hash((key >> 32) as u32)), index: index as u32 }
    }

    /// The point in the `pair`-th pair of dimensions; both coordinates are multiples of 2⁻²⁴.
    #[inline]
    pub fn point(&self, pair: u32) -> [f32; 2] {
        let seed = hash(self.key ^ pair.wrapping_mul(0x9E37_79B9));
        let shuffled = scramble_reversed(self.index.reverse_bits(), seed).reverse_bits();
        // The first coordinate of Sobol' is the index with its bits reversed: twice reversed is not at all.
        let x = scramble_reversed(shuffled, hash(seed ^ 0x68BC_21EB)).reverse_bits();
        let y = scramble_reversed(second_reversed(shuffled), hash(seed ^ 0x02E5_BE93)).reverse_bits();
        [unit(x), unit(y)]
    }
}

/// The second coordinate of Sobol', bits reversed: digit j is the sum modulo 2 of C(i, j) times bit i of the index, and
/// C(i, j) is odd where the binary digits of j are among those of i (Lucas 1878): five steps, one for each digit.
#[inline]
fn second_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0F0F_0F0F;
    x ^= (x >> 8) & 0x00FF_00FF;
    x ^= (x >> 16) & 0x0000_FFFF;
    x
}

/// Owen's scrambling of a number whose bits are reversed: each bit is flipped as a hash of those below it says.
#[inline]
fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x = x.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6C50_B47C);
    x ^= x.wrapping_mul(0xB82F_1E52);
    x ^= x.wrapping_mul(0xC7AF_E638);
    x ^= x.wrapping_mul(0x8D22_F6E6);
    x
}

/// A bijection of 32 bits that leaves no trace of its input ("lowbias32", Wellons 2018).
#[inline]
fn hash(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7FEB_352D);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846C_A68B);
    x ^ (x >> 16)
}

#[inline]
fn unit(x: u32) -> f32 {
    (x >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_elementary_box_is_hit_once() {
        for key in 0..20u64 {
            for start in [0, 256, 4096] {
                for pair in 0..3 {
                    let points: Vec<_> = (0..256).map(|i| Strata::new(key, start + i).point(pair)).collect();
                    for columns in 0..=8u32 {
                        let (nx, ny) = (1usize << columns, 1usize << (8 - columns));
                        let mut hit = [false; 256];
                        for [x, y] in &points {
                            let cell = (x * nx as f32) as usize * ny + (y * ny as f32) as usize;
                            assert!(!std::mem::replace(&mut hit[cell], true), "key {key}, {nx} columns");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn each_point_is_uniform_over_keys_and_pairs_are_independent() {
        for index in [0, 1, 77] {
            let (mut one, mut two) = ([0f64; 64], [0f64; 64]);
            for key in 0..1 << 16 {
                let strata = Strata::new(key, index);
                let ([x, y], [z, _]) = (strata.point(0), strata.point(1));
                one[(x * 8.0) as usize * 8 + (y * 8.0) as usize] += 1.0;
                two[(x * 8.0) as usize * 8 + (z * 8.0) as usize] += 1.0;
            }
            for counts in [one, two] {
                // χ² with 63 degrees of freedom: mean 63, standard deviation 11.2.
                let chi2: f64 = counts.iter().map(|c| (c - 1024.0).powi(2) / 1024.0).sum();
                assert!((20.0..130.0).contains(&chi2), "{index}: {chi2}");
            }
        }
        // Over one pixel's passes two pairs must not move together either.
        let mut counts = [0f64; 64];
        for index in 0..1 << 14 {
            let strata = Strata::new(5, index);
            let ([x, _], [z, _]) = (strata.point(0), strata.point(1));
            counts[(x * 8.0) as usize * 8 + (z * 8.0) as usize] += 1.0;
        }
        let chi2: f64 = counts.iter().map(|c| (c - 256.0).powi(2) / 256.0).sum();
        assert!(chi2 < 130.0, "{chi2}");
    }
}
