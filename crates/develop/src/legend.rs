use color::{FALSE_COLOUR_STOPS, false_colour};

/// Lumens in a watt of light, as in Ward's Radiance: luminance in cd/m² is so many times that of a pixel.
pub const LUMENS_PER_WATT: f64 = 179.0;

const WHITE: [u8; 3] = [255; 3];
const PAPER: [u8; 3] = [16; 3];

/// Characters of the legend, five rows of three dots each, the left dot is the highest bit.
const GLYPHS: &[(char, [u8; 5])] = &[
    ('0', [7, 5, 5, 5, 7]),
    ('1', [2, 6, 2, 2, 7]),
    ('2', [7, 1, 7, 4, 7]),
    ('3', [7, 1, 3, 1, 7]),
    ('4', [5, 5, 7, 1, 1]),
    ('5', [7, 4, 7, 1, 7]),
    ('6', [7, 4, 7, 5, 7]),
    ('7', [7, 1, 1, 2, 2]),
    ('8', [7, 5, 7, 5, 7]),
    ('9', [7, 5, 7, 1, 7]),
    ('.', [0, 0, 0, 0, 2]),
    ('-', [0, 0, 7, 0, 0]),
    ('e', [0, 3, 5, 6, 3]),
    ('k', [4, 5, 6, 6, 5]),
    ('M', [5, 7, 7, 5, 5]),
    ('c', [0, 3, 4, 4, 3]),
    ('d', [1, 1, 3, 5, 3]),
    ('m', [0, 6, 7, 7, 5]),
    ('/', [1, 1, 2, 4, 4]),
    ('²', [6, 2, 4, 6, 0]),
];

/// Draws the scale of false colours along the right edge, with its luminances in cd/m². Pictures with less than 64
/// pixels a side have no room for it and stay as they are.
pub(crate) fn draw(pixels: &mut [[u8; 3]], width: usize, height: usize, ev: f32) {
    if width < 64 || height < 64 {
        return;
    }
    let mut canvas = Canvas { pixels, width, dot: (width.min(height) / 220).max(1) };
    let dot = canvas.dot;
    let (bar, margin) = (6 * dot, 2 * dot);
    let labels = 5 * 4 * dot;
    let left = width - bar - labels - 3 * margin;
    let (top, bottom) = (9 * dot + margin, height - margin);
    canvas.fill([left, 0], [width, height], PAPER);
    canvas.text("cd/m²", left + margin, margin);
    for y in top..bottom {
        let place = 1.0 - (y - top) as f64 / (bottom - 1 - top).max(1) as f64;
        let colour = false_colour(place).map(|v| (v * 255.0 + 0.5) as u8);
        canvas.fill([left + margin, y], [left + margin + bar, y + 1], colour);
    }
    let mut free = usize::MAX;
    for (place, luminance) in ticks(ev) {
        let y = top + ((1.0 - place) * (bottom - 1 - top) as f64) as usize;
        let text_top = y.saturating_sub(2 * dot).clamp(top, bottom - 5 * dot);
        // From below upward; what would touch the last label is left out.
        if text_top + 6 * dot <= free {
            canvas.fill([left + margin + bar - 2 * dot, y], [left + margin + bar, y + 1], WHITE);
            canvas.text(&label(luminance), left + 2 * margin + bar, text_top);
            free = text_top;
        }
    }
}

/// Places on the scale, from below, of luminances 1, 2 and 5 times powers of ten in cd/m².
fn ticks(ev: f32) -> Vec<(f64, f64)> {
    let [low, high] = FALSE_COLOUR_STOPS;
    let bottom = (0.18 * LUMENS_PER_WATT).log2() - f64::from(ev) + low;
    let first = (bottom * 2f64.log10()).floor() as i32;
    let candidates = (first..first + 5).flat_map(|power| {
        [1.0, 2.0, 5.0]
            .map(|digit| if power < 0 { digit / 10f64.powi(-power) } else { digit * 10f64.powi(power) })
    });
    candidates
        .map(|luminance| ((luminance.log2() - bottom) / (high - low), luminance))
        .filter(|(place, _)| (0.0..=1.0).contains(place))
        .collect()
}

/// At most five characters.
fn label(luminance: f64) -> String {
    let plain = |value: f64, unit: &str| format!("{}{unit}", (value * 1e3).round() / 1e3);
    match luminance {
        x if (0.0095..9500.0).contains(&x) => plain(x, ""),
        x if (9500.0..9.5e5).contains(&x) => plain(x / 1e3, "k"),
        x if (9.5e5..9.5e8).contains(&x) => plain(x / 1e6, "M"),
        x => format!("{x:.0e}"),
    }
}

/// A picture that is drawn in, with dots of some pixels.
struct Canvas<'a> {
    pixels: &'a mut [[u8; 3]],
    width: usize,
    dot: usize,
}

impl Canvas<'_> {
    /// Fills from a corner up to, not with, another; what lies outside is left out.
    fn fill(&mut self, from: [usize; 2], to: [usize; 2], colour: [u8; 3]) {
        for row in self.pixels.chunks_exact_mut(self.width).take(to[1]).skip(from[1]) {
            row.iter_mut().take(to[0]).skip(from[0]).for_each(|pixel| *pixel = colour);
        }
    }

    fn text(&mut self, text: &str, left: usize, top: usize) {
        for (i, character) in text.chars().enumerate() {
            let Some((_, rows)) = GLYPHS.iter().find(|(c, _)| *c == character) else { continue };
            for (y, row) in rows.iter().enumerate() {
                for x in (0..3).filter(|x| row >> (2 - x) & 1 == 1) {
                    let at = [left + (4 * i + x) * self.dot, top + y * self.dot];
                    self.fill(at, at.map(|v| v + self.dot), WHITE);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_lie_where_their_colours_are() {
        for ev in [-12.0, 0.0, 3.3, 30.0] {
            let all = ticks(ev);
            assert!((9..=11).contains(&all.len()), "{ev}: {all:?}");
            for (place, luminance) in all {
                let radiance = (luminance / LUMENS_PER_WATT) as f32;
                let shown = color::ViewTransform::FalseColour.apply([radiance; 3], ev);
                let scale = false_colour(place);
                assert!((0..3).all(|c| (shown[c] - scale[c]).abs() < 1e-3), "{shown:?} {scale:?}");
                let text = label(luminance);
                assert!(text.chars().count() <= 5, "{text}");
                assert!(text.chars().all(|c| GLYPHS.iter().any(|(g, _)| *g == c)), "{text}");
            }
        }
        assert_eq!(
            [0.05, 1.0, 200.0, 5e3, 2e4, 1e6, 2e-4].map(label),
            ["0.05", "1", "200", "5000", "20k", "1M", "2e-4"]
        );
    }

    #[test]
    fn it_is_drawn_where_there_is_room() {
        let mut small = vec![[9; 3]; 63 * 80];
        draw(&mut small, 63, 80, 0.0);
        assert!(small.iter().all(|p| *p == [9; 3]));
        for [w, h] in [[64, 64], [300, 200], [1000, 70]] {
            let mut pixels = vec![[9; 3]; w * h];
            draw(&mut pixels, w, h, 0.0);
            assert_eq!(pixels[0], [9; 3]);
            assert!(pixels.iter().filter(|p| **p == WHITE).count() > 50);
        }
    }
}
