use color::Lanes;
use sampling::Discrete;

/// Most cells of a pattern, if it has fewer primitives.
const MOST_CELLS: usize = 1 << 14;
/// Most places at which the factor is asked for, if there are fewer cells.
const MOST_LOOKUPS: usize = 1 << 16;
/// Most cells along a side of a primitive's square.
const MOST_SIDE: usize = 96;
/// Share of points that are drawn evenly over the surface: so that what the cells' means have missed is found all the same.
const EVEN_SHARE: f64 = 0.05;

/// Where on a surface its light comes from: a density of points, constant over cells.
///
/// Each primitive (triangle, disc, sphere) is the image of a unit square under a map that keeps areas; a cell is one of
/// `side`² squares within.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pattern {
    side: usize,
    cells: Discrete,
    /// Of points in each cell, per area.
    pdf_a: Vec<f32>,
    /// Of the factor over the surface.
    mean: Lanes,
}

/// A point that a pattern has drawn.
pub(super) struct PatternSample {
    pub prim: u32,
    /// Within the primitive's square.
    pub u: [f32; 2],
    /// Per area.
    pub pdf_a: f32,
}

impl Pattern {
    /// From the areas of the primitives and the factor on their radiance at (primitive, point of its square), averaged over about
    /// a width in units of length. `None`: it is black, or not finite.
    pub fn new(areas: &[f64], factor: impl Fn(u32, [f32; 2], f32) -> Lanes) -> Option<Self> {
        let side = ((MOST_CELLS / areas.len().max(1)).isqrt()).clamp(1, MOST_SIDE);
        let count = areas.len() * side * side;
        let parts = ((MOST_LOOKUPS / count.max(1)).isqrt()).clamp(1, 4);
        let (mut integral, mut weights) = ([0f64; 3], Vec::with_capacity(count));
        for (prim, &area) in areas.iter().enumerate() {
            let share = area / (side * side) as f64;
            let width = share.sqrt() / parts as f64;
            for cell in 0..side * side {
                let mut sum = [0f64; 3];
                for part in 0..parts * parts {
                    let fine = side * parts;
                    let at = |cell: usize, part: usize| ((cell * parts + part) as f32 + 0.5) / fine as f32;
                    let u = [at(cell % side, part % parts), at(cell / side, part / parts)];
                    let rgb = factor(prim as u32, u, width as f32).to_rgb();
                    sum.iter_mut().zip(rgb).for_each(|(s, x)| *s += f64::from(x));
                }
                let part = share / (parts * parts) as f64;
                integral.iter_mut().zip(sum).for_each(|(s, x)| *s += x * part);
                weights.push(color::luminance_f64(sum) * part);
            }
        }
        let (area, total): (f64, f64) = (areas.iter().sum(), weights.iter().sum());
        let even = EVEN_SHARE * total / (area * (side * side) as f64);
        let of = |i: usize| areas[i / (side * side)];
        let cells = Discrete::new(weights.iter().enumerate().map(|(i, w)| w + even * of(i)));
        let pdf_a = (0..count).map(|i| f64::from(cells.pmf(i)) * (side * side) as f64 / of(i));
        let pdf_a = pdf_a.map(|p| if p.is_finite() { p as f32 } else { 0.0 }).collect();
        let [r, g, b] = integral.map(|x| (x / area) as f32);
        let mean = Lanes::rgb(r, g, b);
        (total > 0.0 && total.is_finite() && mean.is_finite()).then_some(Self { side, cells, pdf_a, mean })
    }

    /// Mean of the factor over the surface.
    pub fn mean(&self) -> Lanes {
        self.mean
    }

    /// A point.
    pub fn sample(&self, u_pick: f32, u: [f32; 2]) -> PatternSample {
        let (index, _, _) = self.cells.sample(u_pick);
        let (prim, cell) = (index / (self.side * self.side), index % (self.side * self.side));
        let at = |cell: usize, u: f32| ((cell as f32 + u) / self.side as f32).min(math::ONE_MINUS_EPSILON);
        let u = [at(cell % self.side, u[0]), at(cell / self.side, u[1])];
        PatternSample { prim: prim as u32, u, pdf_a: self.pdf_a[index] }
    }

    /// Density of [`Self::sample`] per area; 0 where there is no such primitive.
    pub fn pdf_a(&self, prim: u32, u: [f32; 2]) -> f32 {
        let [i, j] = u.map(|x| ((x * self.side as f32) as usize).min(self.side - 1));
        self.pdf_a.get((prim as usize * self.side + j) * self.side + i).copied().unwrap_or(0.0)
    }
}
