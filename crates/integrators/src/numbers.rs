//! Numbers at the vertices of eye paths.

use sampling::{Sampler, Strata};
use transport::LightNumbers;

/// Vertices whose numbers fill their squares evenly over the passes of a pixel; those of further ones are independent.
const EVEN_DEPTH: u32 = 2;
/// Pairs of numbers that each of these vertices has for itself: what is chosen, the direction that is scattered, and points of
/// lights, of which no light picker asks for more.
const PAIRS: u32 = 8;
const CHOICES: u32 = 0;
const DIRECTION: u32 = 1;
const POINTS: u32 = 2;

/// The numbers at one vertex.
pub(crate) struct VertexNumbers<'a> {
    strata: &'a Strata,
    sampler: &'a mut Sampler,
    depth: u32,
    /// Of a light, of a lobe.
    choices: [f32; 2],
}

impl<'a> VertexNumbers<'a> {
    /// At the vertex after so many scattering events.
    #[inline]
    pub fn new(strata: &'a Strata, sampler: &'a mut Sampler, depth: u32) -> Self {
        let mut numbers = Self { strata, sampler, depth, choices: [0.0; 2] };
        numbers.choices = numbers.pair(CHOICES);
        numbers
    }

    #[inline]
    fn pair(&mut self, which: u32) -> [f32; 2] {
        if self.depth < EVEN_DEPTH {
            self.strata.point(PAIRS * self.depth + which)
        } else {
            self.sampler.next_2d()
        }
    }

    /// For a scattering event: of a lobe, of a direction.
    #[inline]
    pub fn scatter(&mut self) -> (f32, [f32; 2]) {
        (self.choices[1], self.pair(DIRECTION))
    }
}

impl LightNumbers for VertexNumbers<'_> {
    #[inline]
    fn choice(&mut self) -> f32 {
        self.choices[0]
    }

    #[inline]
    fn point(&mut self, nth: u32) -> [f32; 2] {
        self.pair(POINTS + nth)
    }
}
