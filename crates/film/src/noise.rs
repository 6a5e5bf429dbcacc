//! How far a film is from its limit, by the spread of its passes.

use crate::Film;
use crate::fixed::Fixed96;
use crate::sums::{SQUARE_BITS, to_f64};

impl Film {
    /// Standard error of the luminance of beauty at each pixel, from the spread of the passes; none below two
    /// passes. Passes count as independent, though they are not quite: their places in a pixel follow a sequence that fills
    /// it evenly, so across edges the picture is better than the spread says. With weights it is the error of the linearised estimate (see
    /// [`Film`]), exact where all weights have one magnitude. Luminances above 5.9·10⁶ count as that, and differences
    /// below 10⁻⁹ are not seen.
    pub fn noise(&self) -> Option<Vec<f32>> {
        (self.passes() > 1)
            .then(|| (0..self.sums().len()).map(|i| self.luminance_and_error(i).1 as f32).collect())
    }

    /// Luminance of beauty at a pixel and its standard error, of two passes or more.
    pub(crate) fn luminance_and_error(&self, pixel: usize) -> (f64, f64) {
        let n = self.passes() as f64;
        let luminance = |parts: &[[Fixed96; 3]; 3]| -> f64 {
            parts.iter().map(|part| color::luminance_f64(to_f64(part))).sum()
        };
        let sums = &self.sums()[pixel];
        let weighted = luminance(&sums.radiance);
        let mut square = sums.square as f64 * (0.5f64).powi(SQUARE_BITS);
        let mut mean = weighted / n;
        if let Some(plain) = self.unweighted().get(pixel) {
            // Σe² of e = wL − ⟨L⟩(w − 1), with w² = c² for each pass.
            let (sum, weight) = (luminance(&plain.radiance), plain.weight.to_f64());
            let c2 = f64::from(self.max_weight()).powi(2);
            let average = sum / n;
            square += average * (-2.0 * (c2 * sum - weighted) + average * ((c2 + 1.0) * n - 2.0 * weight));
            mean -= average * (weight / n - 1.0);
        }
        (mean, ((square / n - mean * mean).max(0.0) / (n - 1.0)).sqrt())
    }
}
