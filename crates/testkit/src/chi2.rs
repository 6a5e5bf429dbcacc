use std::f64::consts::PI;

use math::{DVec3, Frame, Vec3};
use sampling::{Domain, Sampler};

use crate::partition::Partition;
use crate::stats::{chi2_p_value, exceeds, z_p_value};

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Least corner.
    pub min: [f64; 2],
    /// Greatest corner.
    pub max: [f64; 2],
}

impl Rect {
    /// [0, 1]².
    pub const UNIT: Self = Self { min: [0.0; 2], max: [1.0; 2] };

    /// Area.
    pub fn area(&self) -> f64 {
        (self.max[0] - self.min[0]) * (self.max[1] - self.min[1])
    }
}

/// Effort of a test. The defaults find a relative error of about 2 % (root mean square) in the shape of a density,
/// and 0.1 % in its integral, in some 50 ms.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Key of the numbers.
    pub seed: u64,
    /// Draws that lay out the cells; not counted.
    pub pilot: usize,
    /// Draws that are counted.
    pub draws: usize,
    /// log₂ of the number of cells.
    pub levels: u32,
    /// Relative difference that rounding explains between what comes with a draw (its density, its weight) and what
    /// is asked for its direction.
    pub rounding: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 1, pilot: 1 << 12, draws: 400_000, levels: 6, rounding: 5e-3 }
    }
}

impl Settings {
    pub(crate) fn sampler(&self) -> Sampler {
        Sampler::new(self.seed, 0, Domain::Other, 0)
    }
}

/// Error of the quadrature over the whole domain, for which every test allows: absolute, of a probability.
pub(crate) const QUADRATURE_ERROR: f64 = 5e-4;

/// Outcome of a χ² test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chi2 {
    /// Σ(observed − expected)²/expected over cells, one of them for draws that gave nothing.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub dof: usize,
    /// Tail probability of the statistic.
    pub p_value: f64,
    /// Quadrature of the density over the domain.
    pub integral: f64,
    /// Share of draws that gave a value.
    pub share: f64,
    /// Tail probability of the difference of the two.
    pub mass_p_value: f64,
}

impl Chi2 {
    /// What is wrong at the level `significance`: histogram, mass, or a density that integrates to more than 1.
    pub fn failures(&self, significance: f64) -> Vec<String> {
        let mut failures = Vec::new();
        if self.p_value < significance {
            failures
                .push(format!("chi² {:.1} with {} dof, p = {:.1e}", self.statistic, self.dof, self.p_value));
        }
        if self.mass_p_value < significance {
            failures.push(format!("density integrates to {:.5}, draws to {:.5}", self.integral, self.share));
        }
        if exceeds(self.integral, 1.0 + 2.0 * QUADRATURE_ERROR) {
            failures.push(format!("density integrates to {:.5} > 1", self.integral));
        }
        failures
    }
}

/// Pearson's test of counts against expectations, cells that expect fewer than five pooled: (statistic, dof, p).
/// Counts where nothing at all is expected give p = 0.
pub fn chi2_counts(observed: &[f64], expected: &[f64]) -> (f64, usize, f64) {
    let mut cells: Vec<(f64, f64)> = observed.iter().zip(expected).map(|(&o, &e)| (o, e.max(0.0))).collect();
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    for (o, e) in cells {
        match pooled.last_mut() {
            Some(last) if last.1 < 5.0 => {
                last.0 += o;
                last.1 += e;
            }
            _ => pooled.push((o, e)),
        }
    }
    let statistic: f64 = pooled
        .iter()
        .map(|&(o, e)| {
            if e > 0.0 {
                (o - e).powi(2) / e
            } else if o > 0.0 {
                f64::INFINITY
            } else {
                0.0
            }
        })
        .sum();
    let dof = pooled.len().saturating_sub(1);
    (statistic, dof, if statistic == f64::INFINITY { 0.0 } else { chi2_p_value(statistic, dof) })
}

/// Tests that draws over a rectangle have the density `density` per unit of its area. A draw of `None` gives
/// nothing; the density then integrates to less than 1. Draws outside the rectangle count as `None`.
pub fn chi2_rect(
    settings: &Settings,
    domain: Rect,
    mut draw: impl FnMut(&mut Sampler) -> Option<[f64; 2]>,
    density: impl Fn([f64; 2]) -> f64,
) -> Chi2 {
    let mut sampler = settings.sampler();
    let inside = |p: &[f64; 2]| (0..2).all(|i| (domain.min[i]..=domain.max[i]).contains(&p[i]));
    let pilot: Vec<_> = (0..settings.pilot).filter_map(|_| draw(&mut sampler).filter(inside)).collect();
    let partition = Partition::new(domain, pilot, settings.levels);
    let integrals = partition.integrals(&density, 0.2 * QUADRATURE_ERROR);
    let mut counts = vec![0.0; integrals.len() + 1];
    let rest = integrals.len();
    for _ in 0..settings.draws {
        counts[draw(&mut sampler).filter(inside).map_or(rest, |p| partition.cell(p))] += 1.0;
    }
    judge(&counts, &integrals, settings.draws as f64)
}

/// `counts` has one cell more than `integrals`, for draws that gave nothing.
fn judge(counts: &[f64], integrals: &[f64], n: f64) -> Chi2 {
    let integral: f64 = integrals.iter().sum();
    let share = 1.0 - counts[integrals.len()] / n;
    let deviation = (share * (1.0 - share) / n).sqrt();
    let excess = ((integral - share).abs() - QUADRATURE_ERROR).max(0.0);
    let mass_p_value = if excess == 0.0 { 1.0 } else { z_p_value(excess / deviation) };
    // The last cell is left to the test of mass where the error of the quadrature could rule it.
    let mut expected: Vec<f64> = integrals.iter().map(|i| i * n).collect();
    let cells = if 1.0 - integral > 100.0 * QUADRATURE_ERROR {
        expected.push((1.0 - integral) * n);
        counts
    } else {
        let drawn: f64 = counts[..integrals.len()].iter().sum();
        expected.iter_mut().for_each(|e| *e *= drawn / (integral * n));
        &counts[..integrals.len()]
    };
    let (statistic, dof, p_value) = chi2_counts(cells, &expected);
    Chi2 { statistic, dof, p_value, integral, share, mass_p_value }
}

/// A chart of the sphere whose equator passes through the middle of a density, so that narrow lobes lie where
/// (z, φ) is nearly flat: dω = dz dφ.
pub(crate) struct Chart([DVec3; 3]);

impl Chart {
    /// The rectangle of (z, φ).
    pub const DOMAIN: Rect = Rect { min: [-1.0, -PI], max: [1.0, PI] };

    /// About the mean of some directions.
    pub fn about(directions: impl IntoIterator<Item = Vec3>) -> Self {
        let mean: DVec3 = directions.into_iter().map(Vec3::as_dvec3).sum();
        let frame = Frame::from_z(mean.try_normalize().unwrap_or(DVec3::Z).as_vec3());
        let x = frame.z.as_dvec3().normalize();
        let z = frame.y.as_dvec3().reject_from_normalized(x).normalize();
        Self([x, z.cross(x), z])
    }

    /// (z, φ) of a direction.
    pub fn to_plane(&self, w: Vec3) -> [f64; 2] {
        let w = w.as_dvec3().normalize();
        [self.0[2].dot(w).clamp(-1.0, 1.0), self.0[1].dot(w).atan2(self.0[0].dot(w))]
    }

    /// The direction at (z, φ).
    pub fn to_sphere(&self, [z, phi]: [f64; 2]) -> Vec3 {
        let r = (1.0 - z * z).max(0.0).sqrt();
        (self.0[0] * (r * phi.cos()) + self.0[1] * (r * phi.sin()) + self.0[2] * z).as_vec3()
    }
}

/// Tests that drawn directions (unit) have the density `pdf_w` per steradian.
pub fn chi2_sphere(
    settings: &Settings,
    mut draw: impl FnMut(&mut Sampler) -> Option<Vec3>,
    pdf_w: impl Fn(Vec3) -> f64,
) -> Chi2 {
    let mut sampler = Sampler::new(settings.seed, 1, Domain::Other, 0);
    let chart = Chart::about((0..256).filter_map(|_| draw(&mut sampler)));
    chi2_rect(settings, Chart::DOMAIN, |s| draw(s).map(|w| chart.to_plane(w)), |p| pdf_w(chart.to_sphere(p)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::warp;

    const LEVEL: f64 = 1e-4;

    #[test]
    fn right_samplers_pass() {
        let s = Settings::default();
        for seed in 0..4 {
            let s = Settings { seed, ..s };
            let cosine = chi2_sphere(
                &s,
                |r| Some(warp::cosine_hemisphere(r.next_2d())),
                |w| f64::from(warp::cosine_hemisphere_pdf_w(w.z)),
            );
            assert_eq!(cosine.failures(LEVEL), [""; 0], "{cosine:?}");
            let sphere =
                chi2_sphere(&s, |r| Some(warp::sphere(r.next_2d())), |_| f64::from(warp::SPHERE_PDF_W));
            assert_eq!(sphere.failures(LEVEL), [""; 0], "{sphere:?}");
            let narrow = 1e-6;
            let cone = chi2_sphere(
                &s,
                |r| Some(warp::cone(r.next_2d(), narrow)),
                |w| {
                    let sin2 = f64::from(w.x).powi(2) + f64::from(w.y).powi(2);
                    let inside = w.z > 0.0 && sin2 < f64::from(narrow * (2.0 - narrow));
                    if inside { f64::from(warp::cone_pdf_w(narrow)) } else { 0.0 }
                },
            );
            assert_eq!(cone.failures(LEVEL), [""; 0], "{cone:?}");
        }
    }

    #[test]
    fn rejected_draws_are_a_cell() {
        let s = Settings::default();
        let upper = |w: Vec3| if w.z > 0.3 { f64::from(warp::SPHERE_PDF_W) } else { 0.0 };
        let t = chi2_sphere(&s, |r| Some(warp::sphere(r.next_2d())).filter(|w| w.z > 0.3), upper);
        assert_eq!(t.failures(LEVEL), [""; 0], "{t:?}");
        let nan = chi2_sphere(
            &s,
            |r| Some(warp::sphere(r.next_2d())),
            |w| if w.z > 0.9 { f64::NAN } else { 0.0796 },
        );
        assert!(!nan.failures(LEVEL).is_empty(), "{nan:?}");
        assert!((t.integral - 0.35).abs() < QUADRATURE_ERROR && (t.share - 0.35).abs() < 0.01, "{t:?}");
    }

    #[test]
    fn two_percent_in_scale_fails() {
        for scale in [1.02, 1.0 / 1.02] {
            let t = chi2_sphere(
                &Settings::default(),
                |r| Some(warp::cosine_hemisphere(r.next_2d())),
                |w| scale * f64::from(warp::cosine_hemisphere_pdf_w(w.z)),
            );
            assert!(!t.failures(LEVEL).is_empty(), "{t:?}");
        }
    }

    #[test]
    fn two_percent_in_shape_fails() {
        // The density is right in sum, and 2 % too high on one half, 2 % too low on the other.
        let t = chi2_sphere(
            &Settings::default(),
            |r| Some(warp::cosine_hemisphere(r.next_2d())),
            |w| f64::from(warp::cosine_hemisphere_pdf_w(w.z) * if w.x > 0.0 { 1.02 } else { 0.98 }),
        );
        assert!(t.mass_p_value > LEVEL && t.p_value < LEVEL, "{t:?}");
        // The same over a rectangle.
        let density =
            |e: f64| move |[x, _]: [f64; 2]| 2.0 * x * if x > 0.5f64.sqrt() { 1.0 + e } else { 1.0 - e };
        let draw = |r: &mut Sampler| {
            let [x, y] = r.next_2d();
            Some([f64::from(x).sqrt(), f64::from(y)])
        };
        let right = chi2_rect(&Settings::default(), Rect::UNIT, draw, density(0.0));
        assert_eq!(right.failures(LEVEL), [""; 0], "{right:?}");
        let wrong = chi2_rect(&Settings::default(), Rect::UNIT, draw, density(0.02));
        assert!(!wrong.failures(LEVEL).is_empty(), "{wrong:?}");
    }

    #[test]
    fn counts() {
        let (statistic, dof, p) = chi2_counts(&[10.0, 20.0, 30.0, 0.0], &[15.0, 15.0, 28.0, 2.0]);
        // The last cell is pooled with the least of the others: (10 − 17)²/17 + 25/15 + 4/28.
        assert!((statistic - (49.0 / 17.0 + 25.0 / 15.0 + 4.0 / 28.0)).abs() < 1e-12 && dof == 2);
        assert!((p - (-statistic / 2.0).exp()).abs() < 1e-9);
        assert_eq!(chi2_counts(&[5.0], &[0.0]).2, 0.0);
        let wrong: Vec<f64> = (0..64).map(|i| if i % 2 == 0 { 10_200.0 } else { 9_800.0 }).collect();
        assert!(chi2_counts(&wrong, &[10_000.0; 64]).2 < LEVEL);
    }
}
