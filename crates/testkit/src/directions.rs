use math::Vec3;
use sampling::{Domain, Sampler};

use crate::chi2::{Chart, Chi2, QUADRATURE_ERROR, Settings, chi2_sphere};
use crate::partition::Partition;
use crate::stats::{Moments, exceeds, z_p_value};

/// A direction with what its sampler says of it.
#[derive(Clone, Copy, Debug)]
pub struct DirectionDraw {
    /// The direction (unit).
    pub direction: Vec3,
    /// Value over density, in one lane.
    pub weight: f64,
    /// Density per steradian; the probability, for a delta lobe.
    pub pdf_w: f64,
    /// Whether it comes from a delta lobe.
    pub delta: bool,
}

/// Outcome of [`check_directions`].
#[derive(Clone, Copy, Debug)]
pub struct DirectionReport {
    /// Histogram of the non-delta draws against the density.
    pub chi2: Chi2,
    /// Relative difference of weight · density and value that 99 % of the draws keep within (towards grazing directions
    /// rounding has the rest).
    pub weight_error: f64,
    /// The same for the density that comes with a draw and that asked for its direction.
    pub pdf_error: f64,
    /// Weights of the draws; 0 for those that gave nothing and for delta lobes.
    pub weights: Moments,
    /// Quadrature of the value over the sphere: what the mean of `weights` estimates.
    pub integral: f64,
    /// Share of draws from delta lobes.
    pub delta_share: f64,
    /// Weights of delta draws, 0 for others.
    pub delta_weights: Moments,
    /// [`Settings::rounding`].
    pub rounding: f64,
    /// Negative, infinite or NaN numbers met.
    pub invalid: u64,
}

impl DirectionReport {
    /// What is wrong at the level `significance`.
    pub fn failures(&self, significance: f64) -> Vec<String> {
        let mut failures = self.chi2.failures(significance);
        if self.invalid > 0 {
            failures.push(format!("{} values are negative or not finite", self.invalid));
        }
        if exceeds(self.weight_error, self.rounding) {
            failures.push(format!("weight·density differs from the value by {:.2e}", self.weight_error));
        }
        if exceeds(self.pdf_error, self.rounding) {
            failures.push(format!("pdf of a draw differs from the density by {:.2e}", self.pdf_error));
        }
        let tolerance = 2.0 * QUADRATURE_ERROR * self.integral.max(1e-3);
        if z_p_value(self.weights.z(self.integral, tolerance)) < significance {
            failures.push(format!(
                "mean weight {:.5} ± {:.5}, value integrates to {:.5}",
                self.weights.mean,
                self.weights.standard_error(),
                self.integral
            ));
        }
        failures
    }

    /// Mean of all weights: the directional albedo.
    pub fn albedo(&self) -> f64 {
        self.weights.mean + self.delta_weights.mean
    }
}

/// Tests a sampler of directions whole: `draw` (fed with numbers in [0, 1): one for the lobe, two for the
/// direction) against its density `pdf_w` (non-delta part) and the function `value` that it serves (cosine
/// included). Draws of delta lobes count as outside the density.
pub fn check_directions(
    settings: &Settings,
    mut draw: impl FnMut(f32, [f32; 2]) -> Option<DirectionDraw>,
    pdf_w: impl Fn(Vec3) -> f64,
    value: impl Fn(Vec3) -> f64,
) -> DirectionReport {
    let mut draw = |s: &mut Sampler| draw(s.next_1d(), s.next_2d());
    let ok = |x: f64| x.is_finite() && x >= 0.0;
    let (mut weights, mut delta_weights) = (Moments::default(), Moments::default());
    let (mut deltas, mut invalid) = (0u64, 0u64);
    let chi2 = chi2_sphere(
        settings,
        |s| {
            let drawn = draw(s);
            let smooth = drawn.filter(|d| !d.delta);
            let delta = drawn.filter(|d| d.delta);
            invalid += u64::from(drawn.is_some_and(|d| !ok(d.weight) || !ok(d.pdf_w)));
            deltas += u64::from(delta.is_some());
            weights.push(smooth.map_or(0.0, |d| d.weight));
            delta_weights.push(delta.map_or(0.0, |d| d.weight));
            smooth.map(|d| d.direction)
        },
        &pdf_w,
    );

    let relative = |a: f64, b: f64| (a - b).abs() / a.abs().max(b.abs()).max(1e-6);
    let mut sampler = Sampler::new(settings.seed, 2, Domain::Other, 0);
    let (mut weight_errors, mut pdf_errors) = (Vec::new(), Vec::new());
    let mut pilot = Vec::new();
    for d in (0..settings.pilot).filter_map(|_| draw(&mut sampler)).filter(|d| !d.delta) {
        let (p, v) = (pdf_w(d.direction), value(d.direction));
        invalid += u64::from(!ok(p) || !ok(v));
        pdf_errors.push(relative(d.pdf_w, p));
        weight_errors.push(relative(d.weight * p, v));
        pilot.push(d.direction);
    }
    let chart = Chart::about(pilot.iter().copied());
    let points = pilot.iter().map(|&w| chart.to_plane(w)).collect();
    let partition = Partition::new(Chart::DOMAIN, points, 4);
    DirectionReport {
        chi2,
        weight_error: high_quantile(weight_errors),
        pdf_error: high_quantile(pdf_errors),
        weights,
        integral: partition.integrals(&|p| value(chart.to_sphere(p)), 0.2 * QUADRATURE_ERROR).iter().sum(),
        delta_share: deltas as f64 / weights.n as f64,
        delta_weights,
        rounding: settings.rounding,
        invalid,
    }
}

/// What 99 % of the values do not exceed; NaN is greatest. 0 for none.
fn high_quantile(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() * 99 / 100).copied().unwrap_or(0.0)
}

/// Greatest relative difference of f(a, b) and f(b, a) over pairs of directions; `pairs` says which. Values below
/// `floor` of the greatest met are compared as if they were that.
pub fn reciprocity_error(
    pairs: impl IntoIterator<Item = (Vec3, Vec3)>,
    floor: f64,
    f: impl Fn(Vec3, Vec3) -> f64,
) -> f64 {
    let values: Vec<(f64, f64)> = pairs.into_iter().map(|(a, b)| (f(a, b), f(b, a))).collect();
    let greatest = values.iter().fold(0f64, |m, v| m.max(v.0.abs()).max(v.1.abs()));
    values
        .iter()
        .map(|(a, b)| (a - b).abs() / a.abs().max(b.abs()).max(floor * greatest).max(f64::MIN_POSITIVE))
        .fold(0.0, |m, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::warp;

    const LEVEL: f64 = 1e-4;

    /// Half delta (weight 0.4 in all), half Lambert of albedo 0.3; errors planted by factors.
    fn report(pdf_factor: f64, weight_factor: f64, value_factor: f64, share: f32) -> DirectionReport {
        let pdf = |w: Vec3| 0.5 * f64::from(warp::cosine_hemisphere_pdf_w(w.z));
        check_directions(
            &Settings::default(),
            |u_lobe, u| {
                let delta = u_lobe >= share;
                let direction = if delta { Vec3::Z } else { warp::cosine_hemisphere(u) };
                let weight = if delta { 0.8 } else { 0.6 * weight_factor };
                Some(DirectionDraw {
                    direction,
                    weight,
                    pdf_w: if delta { 0.5 } else { pdf(direction) },
                    delta,
                })
            },
            |w| pdf_factor * pdf(w),
            |w| value_factor * 0.6 * pdf(w),
        )
    }

    #[test]
    fn a_mixture_with_a_delta_passes() {
        let r = report(1.0, 1.0, 1.0, 0.5);
        assert_eq!(r.failures(LEVEL), [""; 0], "{r:?}");
        assert!((r.delta_share - 0.5).abs() < 0.01 && (r.albedo() - 0.7).abs() < 0.005, "{r:?}");
        assert!((r.chi2.integral - 0.5).abs() < 1e-3 && (r.integral - 0.3).abs() < 1e-3, "{r:?}");
    }

    #[test]
    fn two_percent_anywhere_fails() {
        for (pdf, weight, value, share) in [
            (1.02, 1.0, 1.0, 0.5),
            (0.98, 1.0, 1.0, 0.5),
            (1.0, 1.02, 1.0, 0.5),
            (1.0, 1.0, 0.98, 0.5),
            (1.0, 1.0, 1.0, 0.51),
        ] {
            let r = report(pdf, weight, value, share);
            assert!(!r.failures(LEVEL).is_empty(), "{pdf} {weight} {value} {share}: {r:?}");
        }
        // Weight and value wrong alike: the mean weight is compared with the quadrature of the same wrong value,
        // so only a furnace with a known albedo tells.
        let r = report(1.0, 1.02, 1.02, 0.5);
        assert!(r.failures(LEVEL).is_empty() && z_p_value(r.weights.z(0.3, 1e-4)) < LEVEL, "{r:?}");
    }

    #[test]
    fn reciprocity_sees_two_percent() {
        let pairs = |s: &mut Sampler| {
            (0..100).map(|_| (warp::sphere(s.next_2d()), warp::sphere(s.next_2d()))).collect::<Vec<_>>()
        };
        let pairs = pairs(&mut Settings::default().sampler());
        let f = |e: f64| {
            move |a: Vec3, b: Vec3| f64::from((a + b).length()) * if a.x > b.x { 1.0 + e } else { 1.0 }
        };
        assert!(reciprocity_error(pairs.iter().copied(), 1e-3, f(0.0)) < 1e-6);
        assert!(reciprocity_error(pairs.iter().copied(), 1e-3, f(0.02)) > 0.019);
        assert_eq!(reciprocity_error(pairs.iter().copied(), 1e-3, |_, _| f64::NAN), f64::INFINITY);
    }
}
