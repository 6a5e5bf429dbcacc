//! Radii of progressive estimates: they shrink from pass to pass by a rule that needs no statistics, so that passes are
//! independent.

/// Where radii start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartRadius {
    /// In scene units, the same everywhere.
    World(f32),
    /// In widths of a pixel where the eye path meets the first surface that is not specular, its footprint carried
    /// through mirrors and glass.
    Pixels(f32),
}

/// The radii of a render.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusSettings {
    /// Radius of pass 0.
    pub start: StartRadius,
    /// α in (0, 1]: variance falls as passes^−α, squared bias as passes^(2α − 2); 2/3 is best for a disc (Knaus &
    /// Zwicker 2011, §5.2).
    pub alpha: f32,
}

/// Least and greatest radius that a pixel's width gives in pass 0, in diagonals of the scene's bounds.
const LEAST: f32 = 2e-5;
const GREATEST: f32 = 0.01;

/// The radii of one pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassRadius {
    start: StartRadius,
    /// On the radius of pass 0.
    factor: f32,
    least: f32,
    greatest: f32,
}

impl RadiusSettings {
    /// The radii of a pass in a scene whose bounds have that diagonal.
    pub(crate) fn of_pass(&self, pass: u64, diagonal: f32) -> PassRadius {
        PassRadius {
            start: self.start,
            factor: area_factor(pass, f64::from(self.alpha)).sqrt() as f32,
            least: LEAST * diagonal,
            greatest: GREATEST * diagonal,
        }
    }
}

impl PassRadius {
    /// Radius on an eye path whose footprint has that width at its first surface that is not specular.
    #[inline]
    pub fn at(&self, footprint: f32) -> f32 {
        let first = match self.start {
            StartRadius::World(radius) => radius,
            StartRadius::Pixels(pixels) => (pixels * footprint).clamp(self.least, self.greatest),
        };
        first * self.factor
    }
}

/// r²ᵢ/r²₀: r²ᵢ₊₁ = r²ᵢ·(i + 1 + α)/(i + 2) for passes counted from 0 (Knaus & Zwicker 2011, eq. 20, with i from 1). Cost:
/// a product of `pass` factors.
fn area_factor(pass: u64, alpha: f64) -> f64 {
    (1..=pass).map(|i| i as f64).fold(1.0, |area, i| area * ((i + alpha) / (i + 1.0)))
}

/// Of an even number the upper one; `None` of none.
pub(crate) fn median(mut radii: Vec<f32>) -> Option<f32> {
    let middle = radii.len() / 2;
    (!radii.is_empty()).then(|| *radii.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_fall_as_the_power_of_the_passes() {
        assert_eq!(area_factor(0, 0.5), 1.0);
        assert_eq!(area_factor(1, 0.5), 0.75);
        assert_eq!(area_factor(2, 0.5), 0.75 * 2.5 / 3.0);
        // r²ᵢ ≈ r²₁·i^(α − 1)/Γ(1 + α), Γ(5/3) = 0.902745.
        let alpha = 2.0 / 3.0;
        let expected = 10_000f64.powf(alpha - 1.0) / 0.902_745_292_950_933_6;
        assert!((area_factor(9_999, alpha) / expected - 1.0).abs() < 1e-4);
        assert_eq!(area_factor(500, 1.0), 1.0);
    }

    #[test]
    fn pixels_give_no_extremes() {
        let settings = RadiusSettings { start: StartRadius::Pixels(4.0), alpha: 1.0 };
        let radius = settings.of_pass(7, 10.0);
        assert_eq!(radius.at(0.01), 0.04);
        assert_eq!(radius.at(1e-9), LEAST * 10.0);
        assert_eq!(radius.at(f32::INFINITY), GREATEST * 10.0);
        let world = RadiusSettings { start: StartRadius::World(3.0), alpha: 1.0 };
        assert_eq!(world.of_pass(7, 10.0).at(0.01), 3.0);
    }
}
