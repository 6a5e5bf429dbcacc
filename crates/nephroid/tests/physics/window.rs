//! A part of the picture of an arena scene, sampled alone.

use std::ops::Range;

use nephroid::SceneDesc;
use nephroid::desc::{Camera, IntegratorKind};
use testkit::Moments;

use crate::support::*;

/// Half the width of the picture of `scenes/arena` at distance 1 from the eye; it has 256 × 256 pixels.
const HALF: f64 = 12.5 / 35.0;
const EYE: [f32; 3] = [2.78, 2.73, -8.0];

/// A camera that sees a rectangle of pixels of the arena's picture and little else, and the weight of each of its pixels.
pub struct Window {
    size: usize,
    camera: Camera,
    weights: Vec<f64>,
}

type Vec3 = [f64; 3];

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: Vec3) -> Vec3 {
    a.map(|v| v / dot(a, a).sqrt())
}

fn sum(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] + s * b[i])
}

impl Window {
    /// Of `columns` and `rows`, cut into about `size`² pixels.
    pub fn new(columns: Range<f64>, rows: Range<f64>, size: usize) -> Self {
        // Vectors are (right, up, ahead) as the arena's camera sees it.
        let plane = |column: f64, row: f64| [HALF * (column / 128.0 - 1.0), HALF * (1.0 - row / 128.0), 1.0];
        let middle = plane(0.5 * (columns.start + columns.end), 0.5 * (rows.start + rows.end));
        let axis = unit(middle);
        let right = unit([axis[2], 0.0, -axis[0]]);
        let up = unit(sum([0.0, 1.0, 0.0], -axis[1], axis));
        let reach = [
            (columns.start, rows.start),
            (columns.end, rows.start),
            (columns.start, rows.end),
            (columns.end, rows.end),
        ]
        .map(|(c, r)| plane(c, r))
        .map(|d| (dot(d, right) / dot(d, axis)).abs().max((dot(d, up) / dot(d, axis)).abs()));
        let tan = 1.01 * reach.into_iter().fold(0.0, f64::max);
        let step = 2.0 * tan / size as f64;
        // Directions have the component 1 along the axis; then dA of the arena's plane over dA of this one is the inverse cube
        // of the component along the arena's axis.
        let weight = |i: usize| {
            let x = -tan + ((i % size) as f64 + 0.5) * step;
            let y = tan - ((i / size) as f64 + 0.5) * step;
            let d = sum(sum(axis, x, right), y, up);
            let (column, row) = (128.0 * (1.0 + d[0] / d[2] / HALF), 128.0 * (1.0 - d[1] / d[2] / HALF));
            if columns.contains(&column) && rows.contains(&row) { d[2].powi(-3) } else { 0.0 }
        };
        let weights: Vec<f64> = (0..size * size).map(weight).collect();
        let area = (columns.end - columns.start) * (rows.end - rows.start) * (HALF / 128.0).powi(2);
        let seen = weights.iter().sum::<f64>() * step * step;
        assert!((seen / area - 1.0).abs() < 0.02, "the window is seen whole: {seen} of {area}");
        // +x is left in the picture.
        let target = [EYE[0] - middle[0] as f32, EYE[1] + middle[1] as f32, EYE[2] + 1.0];
        let camera = look(EYE, target, 2.0 * (tan.atan().to_degrees() as f32));
        Self { size, camera, weights }
    }

    /// Means over the window of `f(film)`, three channels a pixel, one by one.
    pub fn means(
        &self,
        desc: &SceneDesc,
        integrator: IntegratorKind,
        n: u64,
        passes: u32,
        layers: &[nephroid::Layer],
    ) -> [Moments; 3] {
        let mut desc = desc.clone();
        desc.film.size = [self.size as u32; 2];
        desc.camera = Some(self.camera.clone().into());
        let total: f64 = self.weights.iter().sum();
        let runs = runs(&desc, integrator, n, passes, |film| {
            let mut sums = [0.0; 3];
            for layer in layers {
                for (pixel, weight) in film.layer(*layer).chunks_exact(3).zip(&self.weights) {
                    (0..3).for_each(|c| sums[c] += weight * f64::from(pixel[c]) / total);
                }
            }
            sums
        });
        std::array::from_fn(|c| Moments::of(runs.iter().map(|m| m[c])))
    }
}
