use crate::philox4x32_10;

/// What a stream of numbers is for; streams of different domains are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Domain {
    /// Camera paths; the path index is the pixel.
    Camera = 0,
    /// Photons of the global map.
    GlobalPhoton = 1,
    /// Photons aimed at specular objects.
    CausticPhoton = 2,
    /// What a whole pass shares (wavelengths, shutter time).
    Pass = 3,
    /// Tests and set-up work.
    Other = 4,
    /// Light paths of bidirectional methods.
    LightPath = 5,
    /// Paths that only plan what is worth tracing.
    Pilot = 6,
}

/// The numbers of one path: a PCG32 generator (O'Neill 2014) whose state and increment are the Philox image of
/// (seed, pass, domain, path). A `Copy` value of 16 bytes; nothing to save or share.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    state: u64,
    increment: u64,
}

/// The streams of all paths of (seed, pass, domain): the half of the key that they share, worked out once.
#[derive(Clone, Copy, Debug)]
pub struct Streams([u32; 2]);

impl Streams {
    /// The streams of a pass.
    pub fn new(seed: u64, pass: u64, domain: Domain) -> Self {
        // Two bijections, so that all 64 bits of each part of the key count.
        let [s0, s1, _, _] = philox4x32_10(
            [pass as u32, (pass >> 32) as u32, domain as u32, 0],
            [seed as u32, (seed >> 32) as u32],
        );
        Self([s0, s1])
    }

    /// The stream of a path.
    #[inline]
    pub fn path(&self, path: u64) -> Sampler {
        let [a, b, c, d] = philox4x32_10([path as u32, (path >> 32) as u32, 0, 0], self.0);
        Sampler {
            state: u64::from(a) << 32 | u64::from(b),
            increment: (u64::from(c) << 32 | u64::from(d)) | 1,
        }
    }
}

impl Sampler {
    /// The stream of a path. Equal keys give equal streams.
    pub fn new(seed: u64, pass: u64, domain: Domain, path: u64) -> Self {
        Streams::new(seed, pass, domain).path(path)
    }

    /// Uniform 32 bits.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.increment);
        let shifted = (((old >> 18) ^ old) >> 27) as u32;
        shifted.rotate_right((old >> 59) as u32)
    }

    /// Uniform in [0, 1), a multiple of 2⁻²⁴.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        let x = self.next_1d();
        [x, self.next_1d()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_all_heard() {
        let first = |seed, pass, domain, path| Sampler::new(seed, pass, domain, path).next_u32();
        let base = first(1, 2, Domain::Camera, 3);
        assert_eq!(base, first(1, 2, Domain::Camera, 3));
        for other in [
            first(2, 2, Domain::Camera, 3),
            first(1 << 40, 2, Domain::Camera, 3),
            first(1, 3, Domain::Camera, 3),
            first(1, 2 << 40, Domain::Camera, 3),
            first(1, 2, Domain::GlobalPhoton, 3),
            first(1, 2, Domain::Camera, 4),
            first(1, 2, Domain::Camera, 3 << 40),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn first_numbers_of_neighbouring_paths_are_uniform() {
        // χ² of the first two numbers of 2¹⁶ neighbouring paths over 16×16 cells: 255 degrees of freedom,
        // so mean 255 and standard deviation 22.6.
        let mut counts = [0f64; 256];
        for path in 0..1 << 16 {
            let [x, y] = Sampler::new(7, 0, Domain::Camera, path).next_2d();
            counts[(x * 16.0) as usize * 16 + (y * 16.0) as usize] += 1.0;
        }
        let chi2: f64 = counts.iter().map(|c| (c - 256.0).powi(2) / 256.0).sum();
        assert!((170.0..340.0).contains(&chi2), "{chi2}");
    }
}
