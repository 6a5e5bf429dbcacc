use super::{Mapping, Source, Texture, TexturePoint};

/// Squares of two textures: the first where ⌊u⌋ + ⌊v⌋ is even, after mapping; one square is 1×1.
#[derive(Clone, Debug)]
pub struct Checker {
    /// What fills the square at [0, 1)²; looked up by the coordinates before mapping.
    pub even: Source,
    /// What fills its neighbours.
    pub odd: Source,
    /// Mapping of texture coordinates; a scale of 10 gives 10 squares per unit.
    pub map: Mapping,
}

impl Checker {
    pub(super) fn evaluate(&self, textures: &[Texture], at: &TexturePoint<'_>) -> [f32; 3] {
        let (p, width) = self.map.apply(at);
        // The sign of a square is the product of two square waves, and so is its mean over a box.
        let sign = mean_square_wave(p.x, width.x) * mean_square_wave(p.y, width.y);
        let t = (0.5 + 0.5 * sign) as f32;
        // Inside a square only its own texture is looked up.
        let texture = |t: Source, share: f32| if share > 0.0 { t.evaluate(textures, at) } else { [0.0; 3] };
        let (even, odd) = (texture(self.even, t), texture(self.odd, 1.0 - t));
        std::array::from_fn(|c| t * even[c] + (1.0 - t) * odd[c])
    }

    pub(super) fn mean(&self, textures: &[Texture]) -> [f32; 3] {
        let (even, odd) = (self.even.mean(textures), self.odd.mean(textures));
        std::array::from_fn(|c| 0.5 * (even[c] + odd[c]))
    }
}

/// Mean over [x − width/2, x + width/2] of the wave that is +1 on [0, 1), −1 on [1, 2), with period 2.
fn mean_square_wave(x: f32, width: f32) -> f64 {
    let (x, width) = (f64::from(x), f64::from(width));
    // Below 10⁻⁶ of a square the difference of integrals has no digits left.
    if width < 1e-6 * (1.0 + x.abs()) {
        return if x.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
    }
    let integral = |x: f64| 1.0 - (x.rem_euclid(2.0) - 1.0).abs();
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

#[cfg(test)]
mod tests {
    use math::Vec2;

    use super::*;

    #[test]
    fn filtered_is_the_mean_of_points() {
        let t = Checker {
            even: Source::Constant([1.0, 0.5, 0.0]),
            odd: Source::Constant([0.0, 0.25, 2.0]),
            map: Mapping::uv(0, Vec2::new(3.0, -2.0), 0.0, Vec2::new(0.2, 0.7)),
        };
        let at = |u: f32, v: f32, width: f32| t.evaluate(&[], &TexturePoint::of_uv(Vec2::new(u, v), width));
        for (u, v, width) in [(0.1, 0.2, 0.3), (-4.3, 7.7, 0.05), (0.5, 0.5, 1.7), (2.0, 3.0, 0.6)] {
            let n = 400;
            let mut sum = [0f64; 3];
            for i in 0..n * n {
                let offset = |i: i32| ((i as f32 + 0.5) / n as f32 - 0.5) * width;
                let point = at(u + offset(i % n), v + offset(i / n), 0.0);
                sum.iter_mut().zip(point).for_each(|(s, p)| *s += f64::from(p));
            }
            let box_mean = at(u, v, width);
            for (s, b) in sum.iter().zip(box_mean) {
                assert!((s / f64::from(n * n) - f64::from(b)).abs() < 0.01, "{u} {v} {width}");
            }
        }
        assert_eq!(at(0.01, 0.01, 0.0), [1.0, 0.5, 0.0]);
        let far = at(0.3, 0.3, 1e4);
        assert!(far.iter().zip(t.mean(&[])).all(|(a, b)| (a - b).abs() < 1e-3));
    }
}
