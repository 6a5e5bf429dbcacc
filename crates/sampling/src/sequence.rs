/// The `index`-th point of a sequence in [0, 1)² that fills the square evenly at every length: multiples of the powers
/// of the plastic number modulo 1 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), shifted
/// by a hash of `key` (Cranley & Patterson 1976), so that each point is uniform over keys. Whole numbers only: exact
/// for every index, with a period of 2³².
#[inline]
pub fn shifted_r2(key: u64, index: u64) -> [f32; 2] {
    // 2³²/ρ and 2³²/ρ², where ρ³ = ρ + 1.
    const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
    let shift = splitmix64(key);
    let coordinate = |step: u32, shift: u32| {
        let x = (index as u32).wrapping_mul(step).wrapping_add(shift);
        (x >> 8) as f32 * (1.0 / 16_777_216.0)
    };
    [coordinate(STEPS[0], shift as u32), coordinate(STEPS[1], (shift >> 32) as u32)]
}

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection of 64 bits.
fn splitmix64(key: u64) -> u64 {
    let z = key.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_point_is_uniform_over_keys() {
        for index in [0, 1, 77] {
            let mut counts = [0f64; 64];
            for key in 0..1 << 16 {
                let [x, y] = shifted_r2(key, index);
                counts[(x * 8.0) as usize * 8 + (y * 8.0) as usize] += 1.0;
            }
            // χ² with 63 degrees of freedom: mean 63, standard deviation 11.2.
            let chi2: f64 = counts.iter().map(|c| (c - 1024.0).powi(2) / 1024.0).sum();
            assert!((20.0..130.0).contains(&chi2), "{index}: {chi2}");
        }
    }

    #[test]
    fn edges_are_met_more_evenly_than_at_random() {
        // The share of 64 points on one side of a slanted edge: independent points would scatter by 0.06.
        let mut squares = 0.0;
        for key in 0..1000 {
            let share = (0..64).filter(|&i| {
                let [x, y] = shifted_r2(key, i);
                x + 0.3 * y < 0.6
            });
            squares += (share.count() as f64 / 64.0 - 0.45).powi(2);
        }
        let spread = (squares / 1000.0).sqrt();
        assert!(spread < 0.02, "{spread}");
    }
}
