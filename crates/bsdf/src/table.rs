use std::array::from_fn;
use std::sync::OnceLock;

use std::f32::consts::FRAC_PI_2;

use math::Vec3;

use crate::ggx::ALPHA_MIN;

/// Nodes of the polar angle for roughness that is the same all round.
const ROUND: usize = 48;
/// Nodes of the polar angle for roughness of two directions.
const OVAL: usize = 32;
/// Nodes of the azimuth, from the smooth axis to the rough one.
const AZIMUTHS: usize = 13;
/// Nodes in ln α, evenly spaced over [[`ALPHA_MIN`], 1].
const ALPHAS: usize = 64;
/// Steps between nodes in the quadrature of means.
const STEPS: usize = 8;
/// Azimuths in the quadrature of means.
const MEAN_AZIMUTHS: usize = 12;

/// Up to four nodes of the parameters of a [`Law`] and their weights, of sum 1.
pub(crate) type Places = [(usize, f32); 4];

/// What a rough surface returns or loses by direction, with the parameters other than roughness on which that depends.
pub(crate) trait Law: Copy + 'static {
    /// How many sets of parameters are tabulated.
    const NODES: usize;
    /// The parameters of a node.
    fn node(i: usize) -> Self;
    /// The nodes around these parameters.
    fn place(self) -> Places;
    /// Where the cosine `mu` stands in the table for facets of roughness `alpha` in the plane of incidence: grows from 0 to 1 as `mu`
    /// does, and fast where the function changes fast.
    fn coordinate(self, mu: f32, alpha: f32) -> f32;
    /// The function by quadrature; z of `w` > 0, x is the rougher axis.
    fn value(self, alpha: [f32; 2], w: Vec3) -> f32;
    /// Factor under the integral of means.
    fn weight(self, _mu: f32) -> f32 {
        1.0
    }
    /// Its table.
    fn table() -> &'static Table<Self>;
}

/// A function of direction, tabulated for the nodes of parameters and roughnesses around those that are asked for, at first
/// use: a few milliseconds for a node. Interpolated linearly in the law's coordinate, in ln α along x and y, and in the azimuth by
/// the α along it; between nodes at equal coordinates, so that what moves with the roughness or the index moves there too.
pub(crate) struct Table<L> {
    slices: Vec<OnceLock<Box<Slice>>>,
    law: std::marker::PhantomData<fn() -> L>,
}

struct Slice {
    round: [OnceLock<Row<ROUND>>; ALPHAS],
    /// By the greater node, then the smaller: g(g − 1)/2 + s.
    oval: [OnceLock<Box<Rows>>; ALPHAS * (ALPHAS - 1) / 2],
}

struct Row<const N: usize> {
    values: [f32; N],
    mean: f32,
}

struct Rows {
    values: [[f32; OVAL]; AZIMUTHS],
    mean: f32,
}

/// Position of `x` in [0, 1] among `n` evenly spaced nodes: left node and fraction.
#[inline]
pub(crate) fn locate(x: f32, n: usize) -> (usize, f32) {
    let p = x.clamp(0.0, 1.0) * (n - 1) as f32;
    let i = (p as usize).min(n - 2);
    (i, p - i as f32)
}

#[inline]
pub(crate) fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Two nodes as [`Places`].
#[inline]
pub(crate) fn two((i, f): (usize, f32)) -> Places {
    [(i, 1.0 - f), (i + 1, f), (0, 0.0), (0, 0.0)]
}

/// Grows with μ/α, on which masking depends for small α: so tables are as smooth at α = 10⁻⁴ as at 1. With τ = μ(1 + α)/(μ + α) the
/// mean of √τ, which resolves grazing angles, and of 1 − √(1 − τ), which resolves what falls like (α/μ)².
#[inline]
pub(crate) fn graded(mu: f32, alpha: f32) -> f32 {
    let left = alpha * (1.0 - mu).max(0.0) / (mu + alpha);
    0.5 * ((1.0 - left).max(0.0).sqrt() + 1.0 - left.sqrt())
}

/// Quadrature points of a value for this roughness.
pub(crate) fn count(alpha: [f32; 2]) -> usize {
    if alpha[0] == alpha[1] { 1500 } else { 1000 }
}

/// `n` points of [0, 1)², an additive recurrence (Roberts 2018) whose error falls nearly as 1/n.
pub(crate) fn points(n: usize) -> impl Iterator<Item = [f32; 2]> {
    (0..n).map(|i| {
        let at = |step: f64| ((0.5 + step * i as f64).fract() as f32).min(math::ONE_MINUS_EPSILON);
        [at(0.754_877_666_246_692_8), at(0.569_840_290_998_053_3)]
    })
}

/// The direction of cosine `mu` whose azimuth has the cosine `c` to x.
fn direction(mu: f32, c: f32) -> Vec3 {
    let r = (1.0 - mu * mu).max(0.0).sqrt();
    Vec3::new(r * c, r * (1.0 - c * c).max(0.0).sqrt(), mu)
}

fn alpha_of(node: usize) -> f32 {
    ALPHA_MIN.powf(1.0 - node as f32 / (ALPHAS - 1) as f32)
}

#[inline]
fn locate_alpha(alpha: f32) -> (usize, f32) {
    locate(1.0 - alpha.max(ALPHA_MIN).ln() / ALPHA_MIN.ln(), ALPHAS)
}

/// The cosine at a coordinate, by bisection.
fn cosine<L: Law>(law: L, x: f32, alpha: f32) -> f32 {
    let (mut low, mut high) = (1e-6, 1.0);
    for _ in 0..40 {
        let mid = 0.5 * (low + high);
        if law.coordinate(mid, alpha) < x {
            low = mid;
        } else {
            high = mid;
        }
    }
    high
}

/// 2∫weight·value μ dμ of a row.
fn mean<L: Law, const N: usize>(law: L, row: &[f32; N], alpha: f32) -> f32 {
    let (mut sum, mut before) = (0.0, (0.0f32, row[0]));
    for j in 1..=(N - 1) * STEPS {
        let x = j as f32 / ((N - 1) * STEPS) as f32;
        let (i, f) = locate(x, N);
        let (mu, value) = (cosine(law, x, alpha), lerp(row[i], row[i + 1], f));
        let weight = law.weight(0.5 * (mu + before.0));
        sum += f64::from((mu * mu - before.0 * before.0) * 0.5 * (value + before.1) * weight);
        before = (mu, value);
    }
    sum as f32
}

impl<const N: usize> Row<N> {
    fn compute<L: Law>(law: L, alpha: f32) -> Self {
        let values = from_fn(|i| {
            let mu = cosine(law, i as f32 / (N - 1) as f32, alpha);
            law.value([alpha; 2], direction(mu, 1.0))
        });
        Self { mean: mean(law, &values, alpha), values }
    }
}

/// α along the azimuth whose cosine to the rougher axis is `c`.
#[inline]
fn alpha_along(great: f32, small: f32, c2: f32) -> f32 {
    (great * great * c2 + small * small * (1.0 - c2)).sqrt()
}

/// Where an azimuth stands among [`AZIMUTHS`], from 0 at the smooth axis to 1 at the rough one: even in the angle and in the root of
/// the α along it, which is the square root of `v2` of the way between the two.
#[inline]
fn azimuth(c2: f32, v2: f32) -> f32 {
    0.5 * (v2.clamp(0.0, 1.0).sqrt() + 1.0 - c2.clamp(0.0, 1.0).sqrt().acos() / FRAC_PI_2)
}

/// How far `along` is on the way from `small` to `great`.
#[inline]
fn way(along: f32, great: f32, small: f32) -> f32 {
    (along - small) / (great - small)
}

/// The squared cosine of an azimuth, by bisection.
fn squared_cosine(place: f32, great: f32, small: f32) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let c2 = 0.5 * (low + high);
        if azimuth(c2, way(alpha_along(great, small, c2), great, small)) < place {
            low = c2;
        } else {
            high = c2;
        }
    }
    0.5 * (low + high)
}

impl Rows {
    fn compute<L: Law>(law: L, great: f32, small: f32) -> Self {
        let values = from_fn(|p| {
            let c2 = squared_cosine(p as f32 / (AZIMUTHS - 1) as f32, great, small);
            let along = alpha_along(great, small, c2);
            from_fn(|i| {
                let mu = cosine(law, i as f32 / (OVAL - 1) as f32, along);
                law.value([great, small], direction(mu, c2.sqrt()))
            })
        });
        let mut rows = Self { values, mean: 0.0 };
        for j in 0..MEAN_AZIMUTHS {
            let c = (FRAC_PI_2 * (j as f32 + 0.5) / MEAN_AZIMUTHS as f32).cos();
            let along = alpha_along(great, small, c * c);
            let (p, fp) = locate(azimuth(c * c, way(along, great, small)), AZIMUTHS);
            let row: [f32; OVAL] = from_fn(|i| lerp(rows.values[p][i], rows.values[p + 1][i], fp));
            rows.mean += mean(law, &row, along) / MEAN_AZIMUTHS as f32;
        }
        rows
    }
}

impl<L: Law> Table<L> {
    pub fn new() -> Self {
        Self { slices: (0..L::NODES).map(|_| OnceLock::new()).collect(), law: std::marker::PhantomData }
    }

    fn slice(&self, i: usize) -> &Slice {
        self.slices[i].get_or_init(|| {
            Box::new(Slice { round: from_fn(|_| OnceLock::new()), oval: from_fn(|_| OnceLock::new()) })
        })
    }

    fn round(&self, i: usize, a: usize) -> &Row<ROUND> {
        self.slice(i).round[a].get_or_init(|| Row::compute(L::node(i), alpha_of(a)))
    }

    /// Of the greater node `g` and the smaller one `s`.
    fn oval(&self, i: usize, g: usize, s: usize) -> &Rows {
        self.slice(i).oval[g * (g - 1) / 2 + s]
            .get_or_init(|| Box::new(Rows::compute(L::node(i), alpha_of(g), alpha_of(s))))
    }

    /// The function along `w`, on either side.
    #[inline]
    pub fn at(&self, law: L, w: Vec3, alpha: [f32; 2]) -> f32 {
        if alpha[0] == alpha[1] {
            self.at_cosine(law, w.z.abs(), alpha[0])
        } else {
            self.at_oval(law, w, alpha)
        }
    }

    /// The function of roughness that is the same all round.
    pub fn at_cosine(&self, law: L, mu: f32, alpha: f32) -> f32 {
        let alpha = alpha.clamp(ALPHA_MIN, 1.0);
        let (x, fx) = locate(law.coordinate(mu, alpha), ROUND);
        let (a, fa) = locate_alpha(alpha);
        let mut sum = 0.0;
        for (i, weight) in law.place() {
            if weight > 0.0 {
                let of = |row: &[f32; ROUND]| lerp(row[x], row[x + 1], fx);
                sum += weight * lerp(of(&self.round(i, a).values), of(&self.round(i, a + 1).values), fa);
            }
        }
        sum
    }

    #[inline(never)]
    fn at_oval(&self, law: L, w: Vec3, alpha: [f32; 2]) -> f32 {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        let (great, small, c) = if ax >= ay { (ax, ay, w.x) } else { (ay, ax, w.y) };
        let sin2 = w.x * w.x + w.y * w.y;
        let c2 = if sin2 > 0.0 { (c * c / sin2).min(1.0) } else { 0.5 };
        let along = alpha_along(great, small, c2);
        let x = law.coordinate(w.z.abs(), along);
        let v2 = if great > small { way(along, great, small) } else { c2 };
        let (xr, xo) = (locate(x, ROUND), locate(x, OVAL));
        let (v, swapped) = (locate(azimuth(c2, v2), AZIMUTHS), locate(azimuth(1.0 - c2, 1.0 - v2), AZIMUTHS));
        let rows = |rows: &Rows, (p, fp): (usize, f32)| {
            let of = |row: &[f32; OVAL]| lerp(row[xo.0], row[xo.0 + 1], xo.1);
            lerp(of(&rows.values[p]), of(&rows.values[p + 1]), fp)
        };
        self.corners(law, great, small, |i, g, s| match g.cmp(&s) {
            std::cmp::Ordering::Greater => rows(self.oval(i, g, s), v),
            std::cmp::Ordering::Less => rows(self.oval(i, s, g), swapped),
            std::cmp::Ordering::Equal => {
                let row = &self.round(i, g).values;
                lerp(row[xr.0], row[xr.0 + 1], xr.1)
            }
        })
    }

    /// Sum over the nodes around the parameters and both roughnesses.
    fn corners(&self, law: L, great: f32, small: f32, f: impl Fn(usize, usize, usize) -> f32) -> f32 {
        let ((g, fg), (s, fs)) = (locate_alpha(great), locate_alpha(small));
        let mut sum = 0.0;
        for (i, weight) in law.place() {
            if weight > 0.0 {
                let of = |s| lerp(f(i, g, s), f(i, g + 1, s), fg);
                sum += weight * lerp(of(s), of(s + 1), fs);
            }
        }
        sum
    }

    /// (1/π)∫ of the function, times the law's weight, times cos over the hemisphere.
    pub fn mean(&self, law: L, alpha: [f32; 2]) -> f32 {
        let [ax, ay] = alpha.map(|a| a.clamp(ALPHA_MIN, 1.0));
        if ax == ay {
            let (a, fa) = locate_alpha(ax);
            let of = |i| lerp(self.round(i, a).mean, self.round(i, a + 1).mean, fa);
            return law.place().into_iter().filter(|p| p.1 > 0.0).map(|(i, weight)| weight * of(i)).sum();
        }
        self.corners(law, ax.max(ay), ax.min(ay), |i, g, s| match g.cmp(&s) {
            std::cmp::Ordering::Greater => self.oval(i, g, s).mean,
            std::cmp::Ordering::Less => self.oval(i, s, g).mean,
            std::cmp::Ordering::Equal => self.round(i, g).mean,
        })
    }
}
