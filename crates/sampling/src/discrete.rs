/// A discrete distribution over `0..len`, sampled by bisection of its cumulative sums (`f64`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Discrete {
    cdf: Vec<f64>,
    total: f64,
}

impl Discrete {
    /// From weights ≥ 0. Negative and non-finite weights count as 0. Where all are 0, the distribution is uniform.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Self {
        let mut total = 0.0;
        let mut cdf: Vec<f64> = weights
            .into_iter()
            .map(|w| {
                total += if w.is_finite() { w.max(0.0) } else { 0.0 };
                total
            })
            .collect();
        if total == 0.0 {
            for (i, c) in cdf.iter_mut().enumerate() {
                *c = (i + 1) as f64;
            }
        }
        let last = cdf.last().copied().unwrap_or(1.0);
        for c in &mut cdf {
            *c /= last;
        }
        Self { cdf, total }
    }

    /// Number of outcomes.
    pub fn len(&self) -> usize {
        self.cdf.len()
    }

    /// Whether there is no outcome.
    pub fn is_empty(&self) -> bool {
        self.cdf.is_empty()
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Probability of an outcome; 0 beyond the last.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        match index {
            0 => self.cdf.first().map_or(0.0, |&c| c as f32),
            i if i < self.cdf.len() => (self.cdf[i] - self.cdf[i - 1]) as f32,
            _ => 0.0,
        }
    }

    /// Outcome for `u` in [0, 1), its probability, and `u` mapped back to [0, 1) for reuse.
    /// Outcomes of probability 0 are never drawn. An empty distribution gives (0, 0, `u`).
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        if self.cdf.len() <= 1 {
            return (0, self.cdf.len() as f32, u);
        }
        let v = f64::from(u);
        let index = self.cdf.partition_point(|&c| c <= v).min(self.cdf.len() - 1);
        let low = if index == 0 { 0.0 } else { self.cdf[index - 1] };
        let p = self.cdf[index] - low;
        (index, p as f32, (((v - low) / p) as f32).clamp(0.0, 1.0 - f32::EPSILON / 2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_follow_weights() {
        let d = Discrete::new([1.0, 0.0, 3.0, f64::NAN, 4.0]);
        let mut counts = [0; 5];
        for i in 0..8000 {
            let u = (i as f32 + 0.5) / 8000.0;
            let (k, p, v) = d.sample(u);
            assert!((0.0..1.0).contains(&v) && p == d.pmf(k));
            counts[k] += 1;
        }
        assert_eq!(counts, [1000, 0, 3000, 0, 4000]);
        assert_eq!(d.total(), 8.0);
        assert_eq!(Discrete::new([0.0, 0.0]).pmf(1), 0.5);
        assert_eq!(d.pmf(9), 0.0);
    }
}
