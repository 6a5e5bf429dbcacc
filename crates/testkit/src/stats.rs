use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// The level at which each of `tests` independent tests is to be judged so that all pass together with probability
/// 1 − `family` under the null hypothesis (Šidák 1967).
pub fn significance(family: f64, tests: usize) -> f64 {
    -((-family).ln_1p() / tests.max(1) as f64).exp_m1()
}

/// P(X ≥ `statistic`) for χ² with `dof` degrees of freedom; 1 where there are none, 0 where the statistic is NaN.
pub fn chi2_p_value(statistic: f64, dof: usize) -> f64 {
    if statistic.is_nan() {
        return 0.0;
    }
    ChiSquared::new(dof as f64).map_or(1.0, |d| d.sf(statistic.max(0.0)))
}

/// P(|Z| ≥ |`z`|) for the standard normal; 0 where `z` is NaN.
pub fn z_p_value(z: f64) -> f64 {
    if z.is_nan() {
        return 0.0;
    }
    2.0 * Normal::standard().sf(z.abs())
}

/// Whether `x` is not known to be at most `bound`: NaN exceeds everything.
pub(crate) fn exceeds(x: f64, bound: f64) -> bool {
    x.is_nan() || x > bound
}

/// Mean and variance of a stream of numbers (Welford 1962).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Count.
    pub n: u64,
    /// Mean.
    pub mean: f64,
    /// Sum of squared distances from the mean.
    pub m2: f64,
}

impl Moments {
    /// Of all values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut m = Self::default();
        values.into_iter().for_each(|x| m.push(x));
        m
    }

    /// Adds a value.
    pub fn push(&mut self, x: f64) {
        self.n += 1;
        let d = x - self.mean;
        self.mean += d / self.n as f64;
        self.m2 += d * (x - self.mean);
    }

    /// Unbiased variance of a value; 0 for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.n < 2 { 0.0 } else { self.m2 / (self.n - 1) as f64 }
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        if self.n == 0 { f64::INFINITY } else { (self.variance() / self.n as f64).sqrt() }
    }

    /// Distance of the mean from `expected` in standard errors. `tolerance` (absolute, e.g. the error of a
    /// quadrature) is taken off the distance first. Infinite where values that do not vary miss `expected`, NaN where one of them is.
    pub fn z(&self, expected: f64, tolerance: f64) -> f64 {
        let d = self.mean - expected;
        if d.is_nan() {
            return f64::NAN;
        }
        let excess = (d.abs() - tolerance).max(0.0);
        if excess == 0.0 { 0.0 } else { excess.copysign(d) / self.standard_error() }
    }

    /// Distance of two means in standard errors of their difference.
    pub fn z_between(&self, other: &Self) -> f64 {
        let d = self.mean - other.mean;
        if d == 0.0 { 0.0 } else { d / self.standard_error().hypot(other.standard_error()) }
    }
}

/// Two-sided p-value that two samples have the same mean, variances unequal (Welch 1947): right for a handful of
/// values, where a z-test is not. `None` where either has fewer than two values.
pub fn welch_p_value(a: &Moments, b: &Moments) -> Option<f64> {
    if a.n < 2 || b.n < 2 {
        return None;
    }
    let (va, vb) = (a.variance() / a.n as f64, b.variance() / b.n as f64);
    let v = va + vb;
    let d = a.mean - b.mean;
    if v == 0.0 {
        return Some(if d == 0.0 { 1.0 } else { 0.0 });
    }
    let dof = v * v / (va * va / (a.n - 1) as f64 + vb * vb / (b.n - 1) as f64);
    StudentsT::new(0.0, 1.0, dof).ok().map(|t| 2.0 * t.sf((d / v.sqrt()).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::{Domain, Sampler};

    #[test]
    fn tails() {
        // Tables: χ²(0.95; 10) = 18.307; z(0.975) = 1.95996; 1 − 0.99^(1/10) = 0.0010045.
        assert!((chi2_p_value(18.307, 10) - 0.05).abs() < 1e-5);
        assert!((z_p_value(-1.959_964) - 0.05).abs() < 1e-6);
        assert!((significance(0.01, 10) - 0.001_004_5).abs() < 1e-7);
        assert_eq!((chi2_p_value(f64::NAN, 3), z_p_value(f64::NAN), chi2_p_value(0.0, 0)), (0.0, 0.0, 1.0));
        // Student's t with 2 dof: two-sided 5 % at 4.303.
        let m = |mean| Moments { n: 2, mean, m2: 1.0 };
        assert!((welch_p_value(&m(0.0), &m(4.302_65)).unwrap() - 0.05).abs() < 1e-3);
    }

    #[test]
    fn a_mean_off_by_two_percent_fails() {
        let mut s = Sampler::new(1, 0, Domain::Other, 0);
        let m = Moments::of((0..100_000).map(|_| f64::from(s.next_1d())));
        assert!(z_p_value(m.z(0.5, 0.0)) > 1e-3, "{m:?}");
        assert!(z_p_value(m.z(0.5 * 1.02, 0.0)) < 1e-9);
        assert!(z_p_value(m.z(0.5 / 1.02, 1e-4)) < 1e-9);
        let n = Moments::of((0..100_000).map(|_| 1.02 * f64::from(s.next_1d())));
        assert!(z_p_value(m.z_between(&n)) < 1e-9 && welch_p_value(&m, &n).unwrap() < 1e-9);
        assert!((m.variance() - 1.0 / 12.0).abs() < 1e-3);
        assert_eq!(z_p_value(Moments::of([0.5, f64::NAN, 0.5]).z(0.5, 0.1)), 0.0);
    }
}
