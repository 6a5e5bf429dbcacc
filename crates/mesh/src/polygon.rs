//! Triangles of a polygon.

use math::{DVec3, Vec3};

/// Appends the triangles of the polygon with the given corners. Triangles and convex polygons become fans; a concave,
/// nearly planar one is cut ear by ear, so that nothing lies outside it. `emit` gets corner numbers.
/// Polygons of more than [`MAX_CLIPPED`] corners become fans.
pub(crate) fn triangulate(corners: &[Vec3], mut emit: impl FnMut([usize; 3])) {
    let n = corners.len();
    if n <= 3 || n > MAX_CLIPPED || is_convex(corners) {
        for k in 1..n.saturating_sub(1) {
            emit([0, k, k + 1]);
        }
        return;
    }
    let normal = newell(corners);
    let p: Vec<DVec3> = corners.iter().map(|p| p.as_dvec3()).collect();
    let mut left: Vec<usize> = (0..n).collect();
    // Where the last ear was: the search goes on from there, so that slivers do not pile up at one corner.
    let mut from = 0;
    while left.len() > 3 {
        let m = left.len();
        let ear = (0..m).map(|i| (from + i) % m).find(|&i| {
            let [a, b, c] = [left[(i + m - 1) % m], left[i], left[(i + 1) % m]];
            area(normal, p[a], p[b], p[c]) > 0.0
                && left.iter().filter(|&&q| q != a && q != b && q != c).all(|&q| {
                    // A corner at the very place of another does not block.
                    p[q] == p[a] || p[q] == p[b] || p[q] == p[c] || !inside(normal, p[a], p[b], p[c], p[q])
                })
        });
        // Where the polygon crosses itself no ear is left: what remains becomes a fan.
        let Some(i) = ear else { break };
        emit([left[(i + m - 1) % m], left[i], left[(i + 1) % m]]);
        left.remove(i);
        from = i % (m - 1);
    }
    for k in 1..left.len() - 1 {
        emit([left[0], left[k], left[k + 1]]);
    }
}

/// Ear clipping is cubic at worst; beyond this a file could stall the reader.
pub(crate) const MAX_CLIPPED: usize = 128;

/// Twice the area vector (Newell's method).
fn newell(corners: &[Vec3]) -> DVec3 {
    let o = corners[0].as_dvec3();
    corners.windows(2).map(|w| (w[0].as_dvec3() - o).cross(w[1].as_dvec3() - o)).sum()
}

fn area(normal: DVec3, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    (b - a).cross(c - a).dot(normal)
}

fn inside(normal: DVec3, a: DVec3, b: DVec3, c: DVec3, q: DVec3) -> bool {
    area(normal, a, b, q) >= 0.0 && area(normal, b, c, q) >= 0.0 && area(normal, c, a, q) >= 0.0
}

/// Whether the fan from corner 0 is sound: each of its triangles turns the way of the whole.
fn is_convex(corners: &[Vec3]) -> bool {
    let normal = newell(corners);
    let p = |i: usize| corners[i % corners.len()].as_dvec3();
    (0..corners.len()).all(|i| area(normal, p(i), p(i + 1), p(i + 2)) >= 0.0)
        && (1..corners.len() - 1).all(|k| area(normal, p(0), p(k), p(k + 1)) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[[f32; 2]]) -> (Vec<[usize; 3]>, Vec<f64>) {
        let p: Vec<Vec3> = corners.iter().map(|c| Vec3::new(c[0], c[1], 0.0)).collect();
        let mut triangles = Vec::new();
        triangulate(&p, |t| triangles.push(t));
        let areas = triangles
            .iter()
            .map(|t| 0.5 * area(DVec3::Z, p[t[0]].as_dvec3(), p[t[1]].as_dvec3(), p[t[2]].as_dvec3()))
            .collect();
        (triangles, areas)
    }

    #[test]
    fn a_square_is_a_fan() {
        let (t, _) = cut(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(t, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn polygons_that_cross_themselves_or_are_huge_still_end() {
        let star: Vec<[f32; 2]> = (0..101)
            .map(|i| {
                let (sin, cos) = (std::f32::consts::TAU * (i * 50) as f32 / 101.0).sin_cos();
                [cos, sin]
            })
            .collect();
        assert_eq!(cut(&star).0.len(), 99);
        let spikes: Vec<[f32; 2]> =
            (0..1000).map(|i| [i as f32, if i % 2 == 0 { 0.0 } else { 100.0 }]).collect();
        assert_eq!(cut(&spikes).0.len(), 998);
        assert_eq!(cut(&[[0.0, 0.0]; 7]).0.len(), 5);
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        // A dart whose reflex corner is 2, an L, and a comb.
        let dart = [[0.0, 0.0], [2.0, -1.0], [1.0, 0.0], [2.0, 1.0]];
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let comb =
            [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 3.0], [4.0, 1.0], [3.0, 1.0], [3.0, 3.0], [0.0, 3.0]];
        for (polygon, expected) in [(&dart[..], 1.0), (&l[..], 3.0), (&comb[..], 13.0)] {
            for start in 0..polygon.len() {
                let mut turned = polygon.to_vec();
                turned.rotate_left(start);
                let (t, areas) = cut(&turned);
                assert_eq!(t.len(), polygon.len() - 2);
                assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
                assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-6);
            }
        }
    }
}
