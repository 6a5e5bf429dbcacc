use color::luminance_f64;

use crate::Planes;

/// What is shown in the middle of the scale.
const MIDDLE: f64 = 0.18;

/// Share of the cells at either end that does not count: lamps in view, caustics, black corners.
const TRIMMED: f64 = 0.2;

/// Stops above the middle that the cell at [`BRIGHT`] may have.
const HEADROOM: f64 = 3.0;
const BRIGHT: f64 = 0.95;

/// Stops by which bright parts make a picture darker at most, so that no lamp in view can blacken it.
const MOST_DARKER: f64 = 2.0;

/// Share of lit cells below which there is nothing to go by.
const LEAST_LIT: f64 = 0.004;

/// The exposure in EV that a picture asks for; `None` where it is black (then 0 is as good as any).
///
/// A meter that half knows what it looks at. The mean of log₂ luminance is shown as middle grey (Reinhard et al. 2002,
/// equation 1), with these changes: it is of means over cells, not of pixels, so that grain does not count; a fifth of
/// the cells at either end is left out, so that lamps, caustics and void corners do not; and where the albedo a is
/// known, half of log₂(a/0.18) is taken off, so that snow stays bright and coal dark. Where the brightest twentieth
/// would be more than 3 stops above the middle (a spot at night), the picture is darker by the excess, up to 2 stops.
pub fn automatic_exposure(planes: &Planes) -> Option<f32> {
    let cells = planes.cells();
    let lit: Vec<[f64; 2]> = cells
        .iter()
        .filter_map(|cell| {
            let luminance = luminance_f64(cell.radiance);
            let albedo = luminance_f64(cell.albedo);
            let albedo = if albedo > 0.0 { albedo.clamp(0.03, 0.9) } else { MIDDLE };
            (luminance > 0.0).then(|| [luminance.log2() - 0.5 * (albedo / MIDDLE).log2(), luminance.log2()])
        })
        .collect();
    if (lit.len() as f64) < (LEAST_LIT * cells.len() as f64).max(1.0) {
        return None;
    }
    let mut keys: Vec<f64> = lit.iter().map(|pair| pair[0]).collect();
    keys.sort_by(f64::total_cmp);
    let cut = (TRIMMED * keys.len() as f64) as usize;
    let kept = &keys[cut..keys.len() - cut];
    let mean = kept.iter().sum::<f64>() / kept.len() as f64;
    let mut bright: Vec<f64> = lit.iter().map(|pair| pair[1]).collect();
    bright.sort_by(f64::total_cmp);
    let bright = bright[((BRIGHT * bright.len() as f64) as usize).min(bright.len() - 1)];
    let excess = (bright - mean - HEADROOM).clamp(0.0, MOST_DARKER);
    let ev = MIDDLE.log2() - mean - excess;
    // A tenth of a stop is not seen, and can be typed.
    Some(((ev.clamp(-64.0, 64.0) * 10.0).round() / 10.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, of: impl Fn(usize, usize) -> f32) -> Planes {
        let at = |i: usize| [of(i % width, i / width); 3];
        Planes { width, height, beauty: (0..width * height).map(at).collect(), ..Planes::default() }
    }

    fn ev(planes: &Planes) -> f32 {
        automatic_exposure(planes).unwrap()
    }

    #[test]
    fn grey_comes_to_the_middle_whatever_its_radiance() {
        for stops in [-20.0, -3.0, 0.0, 13.0] {
            let even = picture(80, 60, |_, _| 0.18 * f32::exp2(stops));
            assert!((ev(&even) + stops).abs() < 0.051, "{stops}: {}", ev(&even));
        }
    }

    #[test]
    fn black_has_no_exposure() {
        assert_eq!(automatic_exposure(&picture(40, 30, |_, _| 0.0)), None);
        assert_eq!(automatic_exposure(&Planes::default()), None);
        let broken = picture(40, 30, |_, _| f32::NAN);
        assert_eq!(automatic_exposure(&broken), None);
        // One firefly in the dark is no picture.
        let mut planes = picture(640, 480, |x, y| if (x, y) == (9, 9) { 1e6 } else { 0.0 });
        planes.depth = vec![1.0; 640 * 480];
        assert_eq!(automatic_exposure(&planes), None);
    }

    #[test]
    fn lamps_fireflies_and_caustics_hardly_count() {
        let plain = ev(&picture(200, 150, |_, _| 0.5));
        let firefly = picture(200, 150, |x, y| if (x, y) == (77, 31) { 1e7 } else { 0.5 });
        let caustic = picture(200, 150, |x, y| if x < 20 && y < 12 { 40.0 } else { 0.5 });
        for other in [firefly, caustic] {
            assert!((ev(&other) - plain).abs() < 0.11, "{} {plain}", ev(&other));
        }
        // A lamp over a tenth of the view, a million times brighter.
        let lamp = ev(&picture(200, 150, |x, _| if x < 20 { 5e5 } else { 0.5 }));
        assert!((-2.1..0.0).contains(&(lamp - plain)), "{lamp} {plain}");
    }

    #[test]
    fn nothing_is_not_counted_and_neither_is_the_sky_over_a_scene() {
        let ball = |x: usize, y: usize| (x as f32 - 100.0).hypot(y as f32 - 75.0) < 40.0;
        let plain = ev(&picture(200, 150, |_, _| 0.5));
        for background in [0.0, 1e4] {
            let mut planes = picture(200, 150, |x, y| if ball(x, y) { 0.5 } else { background });
            planes.depth =
                (0..200 * 150).map(|i| if ball(i % 200, i / 200) { 3.0 } else { f32::INFINITY }).collect();
            assert!((ev(&planes) - plain).abs() < 0.11, "{background}: {}", ev(&planes));
        }
        // Without depth what is black is nothing.
        let planes = picture(200, 150, |x, y| if ball(x, y) { 0.5 } else { 0.0 });
        assert!((ev(&planes) - plain).abs() < 0.3);
        // A sky alone is the picture.
        let mut sky = picture(200, 150, |_, _| 1e4);
        sky.depth = vec![f32::INFINITY; 200 * 150];
        assert!((ev(&sky) + (1e4f32 / 0.18).log2()).abs() < 0.1);
    }

    #[test]
    fn snow_stays_bright_and_coal_dark() {
        let under = |albedo: f32| {
            let mut planes = picture(64, 48, |_, _| albedo);
            planes.albedo = vec![[albedo; 3]; 64 * 48];
            albedo * ev(&planes).exp2()
        };
        assert!(under(0.8) > 0.3 && under(0.8) < 0.5, "{}", under(0.8));
        assert!(under(0.04) > 0.05 && under(0.04) < 0.1, "{}", under(0.04));
    }

    #[test]
    fn a_spot_at_night_is_not_burnt_out() {
        let night = picture(200, 150, |x, _| if x < 24 { 1.0 } else { 0.001 });
        let plain = picture(200, 150, |_, _| 0.001);
        assert!((ev(&night) - ev(&plain) + 2.0).abs() < 0.11, "{} {}", ev(&night), ev(&plain));
    }
}
