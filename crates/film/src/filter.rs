use math::Vec2;

use crate::FilmError;

/// Nodes of the table of half a profile.
const NODES: usize = 257;
/// Cells of the table that finds the place in a CDF.
const GUIDES: usize = 512;

/// Shape of a pixel filter; all are separable: f(x, y) = f(x)·f(y).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FilterKind {
    /// Constant. Default radius 0.5: the pixel's own square.
    Box,
    /// 1 − |x|/radius. Default radius 2.
    Triangle,
    /// exp(−x²/2σ²) less its value at the edge, σ = radius/3. Default radius 1.5, so σ = 0.5.
    Gaussian,
    /// Mitchell & Netravali 1988, B = C = 1/3, eq. 8, stretched to the radius. Default radius 2. It has negative
    /// lobes: weights are ±c with c = (∫|f|)² ≈ 1.2.
    Mitchell,
    /// The four-term window of Harris 1978 (minimum side lobes, −92 dB). Default radius 2.
    BlackmanHarris,
}

impl FilterKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Box, Self::Triangle, Self::Gaussian, Self::Mitchell, Self::BlackmanHarris];

    /// The name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Triangle => "triangle",
            Self::Gaussian => "gaussian",
            Self::Mitchell => "mitchell",
            Self::BlackmanHarris => "blackman-harris",
        }
    }

    /// The kind of that [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }

    /// Radius where none is given, in pixels.
    pub const fn default_radius(self) -> f32 {
        match self {
            Self::Box => 0.5,
            Self::Gaussian => 1.5,
            Self::Triangle | Self::Mitchell | Self::BlackmanHarris => 2.0,
        }
    }

    /// The profile at `t` = |x|/radius in [0, 1], not normalised.
    fn profile(self, t: f64) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Triangle => 1.0 - t,
            Self::Gaussian => (-4.5 * t * t).exp() - (-4.5f64).exp(),
            Self::Mitchell => {
                // Mitchell & Netravali 1988, eq. 8, B = C = 1/3, times 18; x in [0, 2].
                let x = 2.0 * t;
                if x < 1.0 {
                    (21.0 * x - 36.0) * x * x + 16.0
                } else {
                    ((-7.0 * x + 36.0) * x - 60.0) * x + 32.0
                }
            }
            Self::BlackmanHarris => {
                // Harris 1978, eq. 33 and its table, with 0 at the window's middle.
                let a = std::f64::consts::PI * t;
                0.35875 + 0.48829 * a.cos() + 0.14128 * (2.0 * a).cos() + 0.01168 * (3.0 * a).cos()
            }
        }
    }

    /// Where the profile crosses 0 inside its support, as |x|/radius.
    const fn zero(self) -> Option<f64> {
        match self {
            Self::Mitchell => Some(4.0 / 7.0),
            _ => None,
        }
    }
}

/// Where a camera ray goes through the image, and what its radiance counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// From the centre of the pixel, in pixels.
    pub offset: Vec2,
    /// f/p: 1 for filters that are nowhere negative, ±c for others; its mean is 1.
    pub weight: f32,
}

/// A pixel filter that is sampled by its shape (Ernst, Stamminger & Greiner 2006).
///
/// The profile is the piecewise linear function through 257 values of the half (within 10⁻⁴ of the formula's greatest
/// value), scaled to ∫f = 1. Samples follow |f| of *that* function exactly, by inverting its piecewise quadratic CDF in f64;
/// so weights are constants but for their sign. The map from numbers to offsets is monotone: stratification survives.
#[derive(Clone, Debug)]
pub struct Filter {
    kind: FilterKind,
    radius: f32,
    /// Nodes of |x|/radius, ascending from 0 to 1.
    x: Vec<f64>,
    /// f at the nodes, per unit of x, where ∫f = 1 over [−1, 1].
    f: Vec<f64>,
    /// ∫₀ˣ|f| / ∫₀¹|f| at the nodes.
    cdf: Vec<f64>,
    /// For each k the first node whose CDF is at least k/512.
    guide: Vec<u16>,
    /// ∫|f| over [−1, 1], at least 1.
    mass: f64,
}

impl Default for Filter {
    fn default() -> Self {
        Self::build(FilterKind::BlackmanHarris, FilterKind::BlackmanHarris.default_radius())
    }
}

impl Filter {
    /// A filter of `radius` pixels (half its width), or of the kind's default radius.
    ///
    /// # Errors
    /// [`FilmError::FilterRadius`] where the radius is not positive and finite.
    pub fn new(kind: FilterKind, radius: Option<f32>) -> Result<Self, FilmError> {
        let radius = radius.unwrap_or(kind.default_radius());
        if !(radius.is_finite() && radius > 0.0) {
            return Err(FilmError::FilterRadius { kind, radius });
        }
        Ok(Self::build(kind, radius))
    }

    fn build(kind: FilterKind, radius: f32) -> Self {
        let mut x: Vec<f64> = (0..NODES).map(|i| i as f64 / (NODES - 1) as f64).collect();
        if let Some(zero) = kind.zero() {
            let at = x.partition_point(|&t| t < zero);
            x.insert(at, zero);
        }
        let mut f: Vec<f64> = x.iter().map(|&t| kind.profile(t)).collect();
        // A node where the formula is 0 must be exactly 0, so that no cell changes sign.
        for (t, v) in x.iter().zip(&mut f) {
            if kind.zero() == Some(*t) || v.abs() < 1e-12 {
                *v = 0.0;
            }
        }
        let cells = |values: &[f64]| -> Vec<f64> {
            (1..x.len()).map(|i| (x[i] - x[i - 1]) * 0.5 * (values[i] + values[i - 1])).collect()
        };
        let scale = 0.5 / cells(&f).iter().sum::<f64>();
        f.iter_mut().for_each(|v| *v *= scale);
        let magnitudes: Vec<f64> = f.iter().map(|v| v.abs()).collect();
        let half_mass: f64 = cells(&magnitudes).iter().sum();
        let mut cdf = Vec::with_capacity(x.len());
        cdf.push(0.0);
        let mut sum = 0.0;
        for cell in cells(&magnitudes) {
            sum += cell;
            cdf.push(sum / half_mass);
        }
        // Weights of non-negative filters are exactly 1.
        let mass = if f.iter().any(|&v| v < 0.0) { 2.0 * half_mass } else { 1.0 };
        let guide =
            (0..=GUIDES).map(|k| cdf.partition_point(|&c| c < k as f64 / GUIDES as f64) as u16).collect();
        Self { kind, radius, x, f, cdf, guide, mass }
    }

    /// The shape.
    pub fn kind(&self) -> FilterKind {
        self.kind
    }

    /// Half the width, in pixels.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The sample of `u` in [0, 1)².
    pub fn sample(&self, u: [f32; 2]) -> FilterSample {
        let (x, wx) = self.sample_axis(u[0]);
        let (y, wy) = self.sample_axis(u[1]);
        FilterSample { offset: Vec2::new(x, y), weight: (wx * wy) as f32 }
    }

    /// f at `offset` pixels from the pixel's centre, per square pixel: ∫f = 1; 0 outside the radius.
    pub fn evaluate(&self, offset: Vec2) -> f32 {
        (self.evaluate_axis(offset.x) * self.evaluate_axis(offset.y)) as f32
    }

    /// Calls `f` with column, row and weight of each pixel of a film of that `size` whose filter reaches a point of the
    /// film (in pixels; pixel (i, j) covers [i, i + 1) × [j, j + 1)): light that arrives there counts in it with that
    /// weight, as radiance of a pixel does that was sampled with [`Self::sample`].
    pub fn spread(&self, point: Vec2, size: [usize; 2], mut f: impl FnMut(usize, usize, f32)) {
        // Pixels with |centre − point| ≤ radius.
        let range = |x: f32, n: usize| {
            let first = (x - self.radius - 0.5).ceil().max(0.0) as usize;
            first..((x + self.radius + 0.5).floor().max(0.0) as usize).min(n)
        };
        let columns = range(point.x, size[0]);
        let mut across = [0.0; Self::SPREAD];
        let wide = columns.len() > Self::SPREAD;
        let weight_of = |column: usize| self.evaluate_axis(point.x - (column as f32 + 0.5));
        for (weight, column) in across.iter_mut().zip(columns.clone()) {
            *weight = weight_of(column);
        }
        for row in range(point.y, size[1]) {
            let down = self.evaluate_axis(point.y - (row as f32 + 0.5));
            for (i, column) in columns.clone().enumerate() {
                let across = if wide { weight_of(column) } else { across[i] };
                let weight = (down * across) as f32;
                if weight != 0.0 {
                    f(column, row, weight);
                }
            }
        }
    }

    /// Columns whose weights [`Self::spread`] keeps: those of a radius of 8.
    const SPREAD: usize = 16;

    /// Mean density, per square pixel, of the places that [`Self::sample`] gives, at such places: ∫f²/(∫|f|)². 1 for the
    /// default box. The smaller it is, the more pixels share what lands on the film.
    pub fn density(&self) -> f32 {
        // Simpson's rule on each cell is exact for the square of a linear function.
        let cell = |i: usize| {
            let (a, b) = (self.f[i - 1], self.f[i]);
            (self.x[i] - self.x[i - 1]) * (a * a + a * b + b * b) / 3.0
        };
        let half: f64 = (1..self.x.len()).map(cell).sum();
        let axis = 2.0 * half / (self.mass * self.mass * f64::from(self.radius));
        (axis * axis) as f32
    }

    fn evaluate_axis(&self, x: f32) -> f64 {
        let t = (f64::from(x) / f64::from(self.radius)).abs();
        if t > 1.0 || t.is_nan() {
            return 0.0;
        }
        let i = self.x.partition_point(|&node| node < t).clamp(1, self.x.len() - 1);
        let s = (t - self.x[i - 1]) / (self.x[i] - self.x[i - 1]);
        (self.f[i - 1] + s * (self.f[i] - self.f[i - 1])) / f64::from(self.radius)
    }

    /// Offset along one axis in pixels, and the weight.
    fn sample_axis(&self, u: f32) -> (f32, f64) {
        let signed = 2.0 * f64::from(u) - 1.0;
        if self.kind == FilterKind::Box {
            return ((signed * f64::from(self.radius)) as f32, self.mass);
        }
        let target = signed.abs().min(1.0);
        let mut i = usize::from(self.guide[(target * GUIDES as f64) as usize]).max(1);
        while i < self.cdf.len() - 1 && self.cdf[i] < target {
            i += 1;
        }
        let (a, b) = (self.f[i - 1].abs(), self.f[i].abs());
        // Within the cell |f| = a + (b − a)s; the share r of the cell's mass solves a·s + (b − a)s²/2 = r(a + b)/2.
        let r = ((target - self.cdf[i - 1]) / (self.cdf[i] - self.cdf[i - 1])).clamp(0.0, 1.0);
        let root = ((1.0 - r) * a * a + r * b * b).sqrt();
        let s = if a + root > 0.0 { (r * (a + b) / (a + root)).clamp(0.0, 1.0) } else { r.sqrt() };
        let x = self.x[i - 1] + s * (self.x[i] - self.x[i - 1]);
        let negative = self.f[i - 1] < 0.0 || self.f[i] < 0.0;
        let offset = (x * f64::from(self.radius) * signed.signum()) as f32;
        (offset, if negative { -self.mass } else { self.mass })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filters() -> impl Iterator<Item = Filter> {
        FilterKind::ALL
            .into_iter()
            .flat_map(|kind| [None, Some(0.7), Some(3.0)].map(|radius| Filter::new(kind, radius).unwrap()))
    }

    /// ∫f over [a, b] along one axis, by Simpson's rule.
    fn integral(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> f64 {
        let n = 4000;
        let h = (b - a) / f64::from(n);
        let inner: f64 = (1..n).map(|i| f(a + h * f64::from(i)) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
        (f(a) + f(b) + inner) * h / 3.0
    }

    #[test]
    fn integrates_to_one() {
        for filter in filters() {
            let r = f64::from(filter.radius);
            let sum = integral(&|x| filter.evaluate_axis(x as f32), -r, r);
            assert!((sum - 1.0).abs() < 1e-5, "{:?} {r}: {sum}", filter.kind);
            assert_eq!(filter.evaluate(Vec2::new(filter.radius * 1.001, 0.0)), 0.0);
            assert_eq!(filter.evaluate(Vec2::new(f32::NAN, 0.0)), 0.0);
        }
    }

    #[test]
    fn follows_the_published_formula() {
        // Values of the formulas at |x| = radius/4, normalised by closed-form integrals: Mitchell & Netravali's has
        // unit integral (k(0.5) = 0.5347222); of Harris's window the integral is 2·radius·0.35875; the Gaussian's by erf.
        let expected = [
            (FilterKind::Box, 1.0),
            (FilterKind::Mitchell, 77.0 / 144.0),
            (FilterKind::BlackmanHarris, (0.35875 + (0.48829 - 0.01168) * 0.5f64.sqrt()) / (4.0 * 0.35875)),
            (
                FilterKind::Gaussian,
                ((-0.28125f64).exp() - (-4.5f64).exp()) / (1.2499305 - 3.0 * (-4.5f64).exp()),
            ),
        ];
        for (kind, value) in expected {
            let filter = Filter::new(kind, None).unwrap();
            let found = filter.evaluate_axis(filter.radius / 4.0);
            assert!((found - value).abs() < 2e-5, "{kind:?}: {found} {value}");
        }
    }

    #[test]
    fn samples_follow_the_shape() {
        // Stratified numbers: the counts of cells of the offsets are those of |f|, whose share is known by
        // integration, to within one sample an edge; a filter 2 % wider would be off by hundreds.
        let n = 100_000;
        for filter in filters() {
            let r = f64::from(filter.radius);
            let mut counts = [0.0f64; 16];
            let mut weights = 0.0;
            for i in 0..n {
                let u = (i as f32 + 0.5) / n as f32;
                let sample = filter.sample([u, 0.5]);
                let f = filter.evaluate_axis(sample.offset.x);
                assert!(f64::from(sample.weight) * f >= -1e-9 || f.abs() < 1e-4, "sign of the weight");
                assert!(sample.offset.x.abs() <= filter.radius);
                let cell = (f64::from(sample.offset.x) / r * 8.0 + 8.0).floor().clamp(0.0, 15.0);
                counts[cell as usize] += 1.0;
                weights += f64::from(sample.weight) / filter.mass;
            }
            let magnitude = |x: f64| filter.evaluate_axis(x as f32).abs();
            for (cell, count) in counts.into_iter().enumerate() {
                let a = (cell as f64 / 8.0 - 1.0) * r;
                let expected = integral(&magnitude, a, a + r / 8.0) / filter.mass * n as f64;
                assert!(
                    (count - expected).abs() < 4.0 + 1e-3 * expected,
                    "{:?} {cell}: {count} {expected}",
                    filter.kind
                );
            }
            assert!((weights / n as f64 - 1.0).abs() < 1e-4, "mean weight of {:?}", filter.kind);
        }
    }

    #[test]
    fn weights_are_constants() {
        for filter in filters() {
            let expected = (filter.mass * filter.mass) as f32;
            assert_eq!(expected == 1.0, filter.kind != FilterKind::Mitchell);
            for i in 0..64 {
                let weight = filter.sample([i as f32 / 64.0, (i * 7 % 64) as f32 / 64.0]).weight;
                assert_eq!(weight.abs(), expected);
            }
        }
        let least = Filter::new(FilterKind::Box, None).unwrap().sample([0.0, math::ONE_MINUS_EPSILON]).offset;
        assert_eq!((least.x, least.y.min(0.49999)), (-0.5, 0.49999));
    }

    #[test]
    fn what_lands_on_the_film_is_spread_as_pixels_see_it() {
        for filter in filters() {
            // Every pixel that is reached, each with the value of the filter.
            for point in [Vec2::new(9.3, 8.01), Vec2::new(10.0, 9.5), Vec2::new(0.2, 19.99)] {
                let mut found = vec![0.0; 400];
                filter.spread(point, [20, 20], |x, y, weight| found[y * 20 + x] += weight);
                for (i, weight) in found.into_iter().enumerate() {
                    let centre = Vec2::new((i % 20) as f32 + 0.5, (i / 20) as f32 + 0.5);
                    assert_eq!(weight, filter.evaluate(point - centre), "{:?} {point} {i}", filter.kind);
                }
            }
            // ∫f²: the mean of f, with sign, over samples of |f|.
            let n = 10_000;
            let mean = (0..n).map(|i| {
                let sample = filter.sample([(i as f32 + 0.5) / n as f32, 0.5]);
                filter.evaluate_axis(sample.offset.x).abs() / filter.mass
            });
            let axis = mean.sum::<f64>() / f64::from(n);
            assert!((f64::from(filter.density()) / (axis * axis) - 1.0).abs() < 1e-3, "{:?}", filter.kind);
        }
        assert_eq!(Filter::new(FilterKind::Box, None).unwrap().density(), 1.0);
    }

    #[test]
    fn bad_radii_are_refused() {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(Filter::new(FilterKind::Gaussian, Some(radius)).is_err());
        }
    }
}
