//! Curves as tubes and ribbons.

use std::f64::consts::PI;

use crate::matrix::{add, cross, dot, length, narrow, sub, times, unit};
use crate::surfaces::Mesh;

/// What control points mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Basis {
    Bezier,
    BSpline,
}

/// What a curve becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Tube,
    Ribbon,
}

/// Parts of a segment along the curve, at most.
const STEPS: usize = 8;
/// A part bends no more than about this, in radians.
const BEND: f64 = 0.2;
/// Facets around a tube.
const SIDES: usize = 12;
/// Facets around one so thin that nobody sees them.
const FEW_SIDES: usize = 4;
/// A curve this many times longer than wide is thin.
const THIN: f64 = 20.0;

/// A mesh of the whole curve; `None` where the number of points fits neither degree nor basis.
pub(crate) fn tessellate(
    points: &[[f64; 3]],
    degree: usize,
    basis: Basis,
    form: Form,
    widths: [f64; 2],
    normals: &[[f64; 3]],
) -> Option<Mesh> {
    let (count, stride) = match basis {
        Basis::Bezier => (points.len().checked_sub(1)? / degree, degree),
        Basis::BSpline => (points.len().checked_sub(degree)?, 1),
    };
    let used = (count - usize::from(count > 0)) * stride + degree + 1;
    let fits = count > 0 && points.len() == used;
    if !fits || (form == Form::Ribbon && normals.len() != count + 1) {
        return None;
    }
    let mut mesh = Mesh::default();
    let along: Vec<(usize, f64)> = (0..count)
        .flat_map(|segment| {
            let steps = steps(&points[segment * stride..][..=degree]);
            (0..steps).map(move |step| (segment, step as f64 / steps as f64))
        })
        .chain([(count - 1, 1.0)])
        .collect();
    let total = along.len() - 1;
    let reach: f64 = points.windows(2).map(|p| length(sub(p[1], p[0]))).sum();
    let sides = if widths[0].max(widths[1]) * THIN < reach { FEW_SIDES } else { SIDES };
    // A prism is as wide as the tube in the mean over all sides (Cauchy: the mean width is the perimeter over π).
    let swell = PI / sides as f64 / (PI / sides as f64).sin();
    let mut across = None;
    for &(segment, u) in &along {
        let (p, tangent) = at(&points[segment * stride..][..=degree], u, basis);
        let whole = (segment as f64 + u) / count as f64;
        let radius = 0.5 * (widths[0] + (widths[1] - widths[0]) * whole);
        let along = unit(tangent).unwrap_or([0.0, 0.0, 1.0]);
        match form {
            Form::Ribbon => {
                let normal = add(times(normals[segment], 1.0 - u), times(normals[segment + 1], u));
                let side = unit(cross(normal, along)).unwrap_or_default();
                for s in [-1.0, 1.0] {
                    mesh.positions.push(narrow(add(p, times(side, s * radius))));
                    mesh.normals.push(narrow(unit(normal).unwrap_or_default()));
                    mesh.uvs.push([whole as f32, (0.5 * (1.0 + s)) as f32]);
                }
            }
            Form::Tube => {
                // The frame is carried along the curve without needless turning.
                let before: [f64; 3] = across.unwrap_or_else(|| any_across(along));
                let x =
                    unit(sub(before, times(along, dot(before, along)))).unwrap_or_else(|| any_across(along));
                across = Some(x);
                let y = cross(along, x);
                for side in 0..=sides {
                    let (s, c) = (2.0 * PI * (side % sides) as f64 / sides as f64).sin_cos();
                    let n = add(times(x, c), times(y, s));
                    mesh.positions.push(narrow(add(p, times(n, swell * radius))));
                    mesh.normals.push(narrow(n));
                    mesh.uvs.push([whole as f32, side as f32 / sides as f32]);
                }
            }
        }
    }
    let row = if form == Form::Tube { sides } else { 1 };
    for j in 0..total {
        for i in 0..row {
            let a = (j * (row + 1) + i) as u32;
            let (b, c, d) = (a + 1, a + row as u32 + 2, a + row as u32 + 1);
            mesh.indices.extend([[a, b, c], [a, c, d]]);
        }
    }
    Some(mesh)
}

/// Parts of a segment: by how much its control points turn.
fn steps(points: &[[f64; 3]]) -> usize {
    let legs: Vec<[f64; 3]> = points.windows(2).filter_map(|p| unit(sub(p[1], p[0]))).collect();
    let bend: f64 = legs.windows(2).map(|l| dot(l[0], l[1]).clamp(-1.0, 1.0).acos()).sum();
    ((bend / BEND).ceil() as usize).clamp(1, STEPS)
}

fn any_across(along: [f64; 3]) -> [f64; 3] {
    let axis = if along[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let across = cross(along, axis);
    times(across, 1.0 / length(across))
}

/// Point and derivative of one segment.
fn at(c: &[[f64; 3]], u: f64, basis: Basis) -> ([f64; 3], [f64; 3]) {
    let v = 1.0 - u;
    // Weights of the control points and their derivatives.
    let (w, d): (Vec<f64>, Vec<f64>) = match (basis, c.len()) {
        (Basis::Bezier, 3) => (vec![v * v, 2.0 * u * v, u * u], vec![-2.0 * v, 2.0 * (v - u), 2.0 * u]),
        (Basis::Bezier, _) => (
            vec![v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u],
            vec![-3.0 * v * v, 3.0 * v * v - 6.0 * u * v, 6.0 * u * v - 3.0 * u * u, 3.0 * u * u],
        ),
        (Basis::BSpline, 3) => (vec![v * v / 2.0, 0.5 + u * v, u * u / 2.0], vec![-v, v - u, u]),
        (Basis::BSpline, _) => {
            let (u2, u3) = (u * u, u * u * u);
            (
                vec![
                    v * v * v / 6.0,
                    (3.0 * u3 - 6.0 * u2 + 4.0) / 6.0,
                    (-3.0 * u3 + 3.0 * u2 + 3.0 * u + 1.0) / 6.0,
                    u3 / 6.0,
                ],
                vec![-v * v / 2.0, (9.0 * u2 - 12.0 * u) / 6.0, (-9.0 * u2 + 6.0 * u + 3.0) / 6.0, u2 / 2.0],
            )
        }
    };
    let sum = |w: &[f64]| w.iter().zip(c).fold([0.0; 3], |sum, (w, p)| add(sum, times(*p, *w)));
    (sum(&w), sum(&d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::wide;

    #[test]
    fn a_straight_tube() {
        let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 3.0]];
        let mesh = tessellate(&points, 3, Basis::Bezier, Form::Tube, [2.0, 1.0], &[]).unwrap();
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let radius = f64::from(p[0]).hypot(f64::from(p[1]));
            // A prism of 12 sides that is as wide as the tube in the mean.
            let swell = PI / 12.0 / (PI / 12.0).sin();
            assert!((radius - swell * (1.0 - f64::from(p[2]) / 6.0)).abs() < 1e-6, "{p:?}");
            assert!(dot(wide(*p), wide(*n)) > 0.0 && n[2].abs() < 1e-6);
        }
        let mut turned = mesh.clone();
        assert!(!turned.turn_to_normals(), "faces look outward");
    }

    #[test]
    fn bases_are_partitions_of_one_and_derivatives_fit() {
        for (basis, n) in [(Basis::Bezier, 3), (Basis::Bezier, 4), (Basis::BSpline, 3), (Basis::BSpline, 4)] {
            let ones = vec![[1.0; 3]; n];
            let c: Vec<[f64; 3]> = (0..n).map(|i| [(i * i) as f64, i as f64, 1.0 - i as f64]).collect();
            for u in [0.0, 0.3, 1.0] {
                assert!((at(&ones, u, basis).0[0] - 1.0).abs() < 1e-12);
                let h = 1e-6;
                let slope = times(sub(at(&c, u + h, basis).0, at(&c, u - h, basis).0), 0.5 / h);
                assert!(length(sub(slope, at(&c, u, basis).1)) < 1e-6, "{basis:?} {n} {u}");
            }
        }
    }

    #[test]
    fn counts_must_fit() {
        let points = vec![[0.0; 3]; 6];
        assert!(tessellate(&points, 3, Basis::Bezier, Form::Tube, [1.0; 2], &[]).is_none());
        assert!(tessellate(&points[..1], 3, Basis::BSpline, Form::Tube, [1.0; 2], &[]).is_none());
        assert!(
            tessellate(&points, 3, Basis::BSpline, Form::Ribbon, [1.0; 2], &[[0.0, 0.0, 1.0]; 2]).is_none()
        );
    }
}
