//! Loop subdivision (Loop 1987), with the boundary rules and limit positions of Hoppe et al. 1994.

use std::collections::HashMap;
use std::f64::consts::PI;

use scenefile::desc::Triple;

use crate::matrix::{add, cross, dot, sub, times, wide};
use crate::surfaces::Mesh;

/// Neighbours of a vertex in order around it; those of a border begin and end on it.
struct Ring {
    around: Vec<u32>,
    border: bool,
}

/// Subdivides and moves the vertices to the limit surface, whose normals come with them. `None` where three triangles
/// meet at an edge, or the triangles at a vertex form no fan.
pub(super) fn subdivide(positions: &[Triple], indices: &[[u32; 3]], levels: u32) -> Option<Mesh> {
    let mut points: Vec<[f64; 3]> = positions.iter().copied().map(wide).collect();
    let mut faces: Vec<[u32; 3]> =
        indices.iter().copied().filter(|[a, b, c]| a != b && b != c && c != a).collect();
    for _ in 0..levels {
        (points, faces) = refined(&points, &faces)?;
    }
    let rings = rings(points.len(), &faces)?;
    let limit: Vec<[f64; 3]> = points.iter().zip(&rings).map(|(p, ring)| limit(*p, ring, &points)).collect();
    let normals: Vec<[f64; 3]> = limit.iter().zip(&rings).map(|(p, ring)| normal(*p, ring, &limit)).collect();
    let mut mesh = Mesh::new(&limit, &normals, &[]);
    mesh.indices = faces;
    Some(mesh)
}

/// One triangle becomes four.
#[allow(clippy::type_complexity, reason = "points and faces")]
fn refined(points: &[[f64; 3]], faces: &[[u32; 3]]) -> Option<(Vec<[f64; 3]>, Vec<[u32; 3]>)> {
    let rings = rings(points.len(), faces)?;
    let mut out: Vec<[f64; 3]> = points.iter().zip(&rings).map(|(p, ring)| moved(*p, ring, points)).collect();
    // Each edge with the vertices opposite to it.
    let mut opposite: HashMap<(u32, u32), Vec<u32>> = HashMap::with_capacity(faces.len() * 3 / 2);
    for [a, b, c] in faces {
        for (i, j, k) in [(a, b, c), (b, c, a), (c, a, b)] {
            opposite.entry((*i.min(j), *i.max(j))).or_default().push(*k);
        }
    }
    let mut middles: HashMap<(u32, u32), u32> = HashMap::with_capacity(opposite.len());
    let mut finer = Vec::with_capacity(4 * faces.len());
    for &[a, b, c] in faces {
        let mut middle = |i: u32, j: u32| {
            let key = (i.min(j), i.max(j));
            *middles.entry(key).or_insert_with(|| {
                let ends = add(points[i as usize], points[j as usize]);
                out.push(match opposite.get(&key).map(Vec::as_slice) {
                    Some([k, l]) => {
                        add(times(ends, 0.375), times(add(points[*k as usize], points[*l as usize]), 0.125))
                    }
                    _ => times(ends, 0.5),
                });
                (out.len() - 1) as u32
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Some((out, finer))
}

/// Weight of each neighbour of a vertex of valence n (Warren's choice for Loop's scheme).
fn beta(n: usize) -> f64 {
    if n == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * n as f64) }
}

fn sum(around: &[u32], points: &[[f64; 3]]) -> [f64; 3] {
    around.iter().fold([0.0; 3], |sum, v| add(sum, points[*v as usize]))
}

/// The two neighbours along the border.
fn along(ring: &Ring) -> [u32; 2] {
    [ring.around[0], ring.around[ring.around.len() - 1]]
}

fn moved(p: [f64; 3], ring: &Ring, points: &[[f64; 3]]) -> [f64; 3] {
    weighed(p, ring, points, 0.125, beta(ring.around.len()))
}

/// Limit positions: 1/5 of each border neighbour, 1/(n + 3/(8β)) of each inner one.
fn limit(p: [f64; 3], ring: &Ring, points: &[[f64; 3]]) -> [f64; 3] {
    let n = ring.around.len();
    weighed(p, ring, points, 0.2, 1.0 / (n as f64 + 3.0 / (8.0 * beta(n))))
}

fn weighed(p: [f64; 3], ring: &Ring, points: &[[f64; 3]], border: f64, inner: f64) -> [f64; 3] {
    let n = ring.around.len();
    if n == 0 {
        return p;
    }
    if ring.border {
        return add(times(p, 1.0 - 2.0 * border), times(sum(&along(ring), points), border));
    }
    add(times(p, 1.0 - n as f64 * inner), times(sum(&ring.around, points), inner))
}

/// From two tangents of the limit surface.
fn normal(p: [f64; 3], ring: &Ring, points: &[[f64; 3]]) -> [f64; 3] {
    let n = ring.around.len();
    if n < 2 {
        return [0.0; 3];
    }
    let at = |i: usize| points[ring.around[i] as usize];
    let (mut s, mut t) = ([0.0; 3], [0.0; 3]);
    if !ring.border {
        for i in 0..n {
            let angle = 2.0 * PI * i as f64 / n as f64;
            s = add(s, times(at(i), angle.cos()));
            t = add(t, times(at(i), angle.sin()));
        }
    } else {
        s = add(at(n - 1), times(at(0), -1.0));
        t = match n {
            2 => add(add(at(0), at(1)), times(p, -2.0)),
            3 => add(at(1), times(p, -1.0)),
            4 => add(times(add(at(0), at(3)), -1.0), add(times(add(at(1), at(2)), 2.0), times(p, -2.0))),
            _ => {
                let theta = PI / (n - 1) as f64;
                let ends = times(add(at(0), at(n - 1)), theta.sin());
                (1..n - 1).fold(ends, |t, k| {
                    add(t, times(at(k), (2.0 * theta.cos() - 2.0) * (k as f64 * theta).sin()))
                })
            }
        };
    }
    let across = cross(s, t);
    // Tangents of a border do not say which way is out; the triangles around do.
    let edge = |i: usize| sub(at(i), p);
    let front = (1..n).fold([0.0; 3], |front, i| add(front, cross(edge(i - 1), edge(i))));
    if dot(front, across) < 0.0 { times(across, -1.0) } else { across }
}

/// The neighbours of every vertex, counter-clockwise.
fn rings(count: usize, faces: &[[u32; 3]]) -> Option<Vec<Ring>> {
    // For each vertex the directed edges opposite to it.
    let mut spokes: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count];
    for &[a, b, c] in faces {
        spokes[a as usize].push((b, c));
        spokes[b as usize].push((c, a));
        spokes[c as usize].push((a, b));
    }
    spokes.into_iter().map(ring).collect()
}

fn ring(mut spokes: Vec<(u32, u32)>) -> Option<Ring> {
    let Some(&(first, _)) = spokes.first() else { return Some(Ring { around: Vec::new(), border: false }) };
    spokes.sort_unstable();
    let next = |from: u32| {
        let i = spokes.partition_point(|s| s.0 < from);
        // Two triangles on one side of an edge: no surface.
        let twice = spokes.get(i + 1).is_some_and(|s| s.0 == from);
        if twice { Err(()) } else { Ok(spokes.get(i).filter(|s| s.0 == from).map(|s| s.1)) }
    };
    // A border begins where no triangle ends.
    let mut ends: Vec<u32> = spokes.iter().map(|s| s.1).collect();
    ends.sort_unstable();
    let begin = spokes.iter().map(|s| s.0).find(|v| ends.binary_search(v).is_err());
    let mut around = vec![begin.unwrap_or(first)];
    while let Some(v) = next(around[around.len() - 1]).ok()? {
        if v == around[0] || around.len() > spokes.len() {
            break;
        }
        around.push(v);
    }
    let border = begin.is_some();
    let whole = around.len() == spokes.len() + usize::from(border);
    whole.then_some(Ring { around, border })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::length;

    #[test]
    fn an_octahedron_becomes_round() {
        let p = [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
        let f = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let mesh = subdivide(&p, &f, 3).unwrap();
        assert_eq!((mesh.indices.len(), mesh.positions.len()), (512, 258));
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let radial = dot(wide(*p), wide(*n)) / length(wide(*p));
            assert!(radial > 0.95, "{p:?} {n:?}");
        }
        // The limit of a vertex of valence 4: its neighbours cancel, 1 − 4/(4 + 4) of it is left.
        let tip = subdivide(&p, &f, 0).unwrap().positions[0];
        assert!((f64::from(tip[0]) - 0.5).abs() < 1e-6);
        // However fine the mesh, an original vertex goes to the same place.
        let fine = subdivide(&p, &f, 4).unwrap().positions[0];
        assert!(length(sub(wide(fine), wide(tip))) < 1e-6);
    }

    #[test]
    fn a_flat_sheet_stays_flat_and_faces_its_side() {
        let p: Vec<Triple> = (0..25).map(|i| [(i % 5) as f32, (i / 5) as f32, 0.0]).collect();
        let mut f = Vec::new();
        for i in (0..20u32).filter(|i| i % 5 < 4) {
            f.extend([[i, i + 1, i + 6], [i, i + 6, i + 5]]);
        }
        let mesh = subdivide(&p, &f, 2).unwrap();
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert_eq!(p[2], 0.0);
            assert!(n[2] > 0.999, "{p:?} {n:?}");
        }
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let p = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [0., -1., 0.]];
        assert!(subdivide(&p, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]], 1).is_none());
    }
}
