//! One figure for how grainy a picture is to the eye.

use crate::Film;

/// Pixels that are looked at, at most; evenly spread over larger pictures.
const MOST: usize = 1 << 18;
/// Share of the pixels, the noisiest, that do not count: fireflies and the rims of lamps.
const TRIMMED: f64 = 0.02;
/// Luminance, as a share of the median, to which errors are at least compared: what is darker looks black.
const FLOOR: f64 = 0.1;

impl Film {
    /// Error of a typical pixel as a share of its luminance: the root of the mean square of
    /// e(pixel) / (L(pixel) + 0.1 · median L), over the pixels that any light reached but for the noisiest 2 %. e is
    /// the standard error of the mean of the passes ([`Film::noise`]). 0 where no light came; none below two passes.
    ///
    /// A lamp or a firefly is a pixel like any other, and one that is black to the eye counts little. What is displayed
    /// as middle grey with an error of 1 % differs by about one of 255 steps.
    ///
    /// It is an estimate: passes count as independent, though their samples are spread evenly, which makes the error less; and
    /// rare paths that no pass has found yet are not in it, which makes it more. Against long references, with the same
    /// mean over pixels, the error was 0.7 to 1.3 times as large in four scenes, and 1.4 to 2.4 times in two where a small bright
    /// spot lights the rest of a room.
    ///
    /// Cost: about 20 ms, at most, whatever the size.
    pub fn grain(&self) -> Option<f64> {
        if self.passes() < 2 {
            return None;
        }
        let count = self.sums().len();
        let step = stride(count, self.width());
        let mut pixels: Vec<(f64, f64)> = (0..count)
            .step_by(step)
            .map(|i| self.luminance_and_error(i))
            .map(|(luminance, error)| (luminance.max(0.0), error))
            .filter(|&(luminance, error)| luminance > 0.0 || error > 0.0)
            .collect();
        let Some(last) = pixels.len().checked_sub(1) else { return Some(0.0) };
        let (_, &mut (median, _), _) = pixels.select_nth_unstable_by(last / 2, |a, b| a.0.total_cmp(&b.0));
        let floor = FLOOR * median;
        let mut squares: Vec<f64> = pixels
            .iter()
            .map(|(luminance, error)| error / (luminance + floor))
            // Where the median is black nothing is known of what looks black.
            .map(|relative| if relative.is_finite() { relative * relative } else { 1.0 })
            .collect();
        let kept = squares.len() - (TRIMMED * squares.len() as f64) as usize;
        if kept < squares.len() {
            squares.select_nth_unstable_by(kept, f64::total_cmp);
        }
        let kept = &mut squares[..kept];
        // In one order, whatever the selection did.
        kept.sort_unstable_by(f64::total_cmp);
        Some((kept.iter().sum::<f64>() / kept.len() as f64).sqrt())
    }
}

/// Every how many pixels one is looked at: no divisor of the width, so that all columns are.
fn stride(count: usize, width: usize) -> usize {
    let divides = |step: usize| step > 1 && width > 1 && gcd(step, width) > 1;
    let mut step = count.div_ceil(MOST).max(1);
    while divides(step) {
        step += 1;
    }
    step
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PassFilm, PixelSample};

    /// A film of `passes` passes whose pixels have these luminances, each ± `spread` of itself by turns.
    fn film(luminances: &[f32], spread: f32, passes: u64) -> Film {
        let mut film = Film::new(luminances.len(), 1);
        for pass in 0..passes {
            let sign = if pass % 2 == 0 { 1.0 } else { -1.0 };
            let pixel = |(i, l): (usize, &f32)| PixelSample {
                direct: [l * (1.0 + sign * (if i % 2 == 0 { spread } else { -spread })); 3],
                ..PixelSample::default()
            };
            let pixels = luminances.iter().enumerate().map(pixel).collect();
            film.add(pass, &PassFilm::new(luminances.len(), 1, pixels).unwrap()).unwrap();
        }
        film
    }

    #[test]
    fn an_even_picture_has_the_error_of_each_pixel() {
        let even = film(&[0.5; 400], 0.11, 17);
        // 0.11 / √16 of the luminance, over 1.1 of it; the mean of an odd number of passes is a little off.
        let grain = even.grain().unwrap();
        assert!((grain - 0.11 / 1.1 / 4.0).abs() < 0.001, "{grain}");
        assert_eq!(Film::new(4, 1).grain(), None);
        assert_eq!(film(&[0.0; 9], 0.3, 4).grain(), Some(0.0));
        assert_eq!(film(&[0.7; 9], 0.0, 4).grain(), Some(0.0));
    }

    #[test]
    fn lamps_fireflies_and_black_corners_do_not_rule() {
        let wall = [0.5f32; 1000];
        let plain = film(&wall, 0.1, 16).grain().unwrap();
        // Ten pixels of a lamp, ten thousand times as bright, with the same relative error.
        let mut lamp = wall;
        lamp[..10].fill(5e3);
        let with_lamp = film(&lamp, 0.1, 16).grain().unwrap();
        assert!((with_lamp / plain - 1.0).abs() < 0.01, "{with_lamp} {plain}");
        // One firefly in one pass.
        let mut flash = film(&wall, 0.1, 15);
        let mut pixels = vec![PixelSample { direct: [0.5; 3], ..PixelSample::default() }; 1000];
        pixels[7].direct = [1e5; 3];
        flash.add(15, &PassFilm::new(1000, 1, pixels).unwrap()).unwrap();
        let with_firefly = flash.grain().unwrap();
        assert!((with_firefly / plain - 1.0).abs() < 0.05, "{with_firefly} {plain}");
        // Half of the picture is nearly black, and very noisy for that.
        let mut dark = wall;
        dark[..400].fill(1e-6);
        let with_dark = film(&dark, 0.1, 16).grain().unwrap();
        assert!(with_dark < plain, "{with_dark} {plain}");
        // Nothing outside of a subject counts at all.
        let mut alone = wall;
        alone[..900].fill(0.0);
        let alone = film(&alone, 0.1, 16).grain().unwrap();
        assert!((alone / plain - 1.0).abs() < 0.01, "{alone} {plain}");
    }

    #[test]
    fn large_pictures_are_looked_at_in_all_columns() {
        for (count, width) in [(MOST, 512), (4 * MOST, 1024), (100 * MOST, 7680), (9, 1), (1 << 30, 1 << 15)]
        {
            let step = stride(count, width);
            assert!(count / step <= MOST && count / step > MOST.min(count) / 4, "{count} {width}: {step}");
            assert!(width == 1 || gcd(step, width) == 1);
        }
    }
}
