//! Meshes cut finer and moved along their normals, without cracks.
//!
//! What must agree on both sides of an edge is decided by *points*: classes of vertices at the same position, which may differ in
//! texture coordinates and normals. An edge is cut by its own length alone, at its middle; a point has one height, the mean of its
//! vertices', and one direction. So a closed mesh stays closed, whatever meets in its seams and creases.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use math::{DVec3, Vec3};

use crate::TriangleMesh;
use crate::assemble::MAX_COUNT;
use crate::topology::{unit_or_up, weld};

/// A mesh where a crease begins that has no normals of its own, in radians.
const CREASE: f32 = std::f32::consts::FRAC_PI_6;
/// Vertices of a point whose normals differ by less, as a cosine, are shaded as one.
const SAME_NORMAL: f64 = 0.9995;
/// Area of a triangle that comes of cutting, of the square of the longest edge allowed: what the estimate goes by.
const TYPICAL_AREA: f64 = 0.22;
/// The estimate is not further off than by this factor.
const SURELY: f64 = 4.0;

/// More triangles than allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooMany {
    /// About how many it would have been.
    pub triangles: f64,
}

/// A mesh that has been cut, with its normals and the points that its vertices are of.
#[derive(Clone, Debug)]
pub struct Subdivided {
    mesh: TriangleMesh,
    /// For each vertex.
    point: Vec<u32>,
    points: u32,
}

/// Numbers by the two ends of edges.
type Edges = HashMap<(u32, u32), u32, BuildHasherDefault<EndsHasher>>;

/// Mixes two numbers quickly (after Steele, Lea & Flood 2014); nobody chooses them to collide.
#[derive(Default)]
struct EndsHasher(u64);

impl Hasher for EndsHasher {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u32(u32::from(*b)));
    }

    fn write_u32(&mut self, n: u32) {
        self.0 = self.0.rotate_left(32) ^ u64::from(n);
    }

    fn finish(&self) -> u64 {
        let mut z = self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z ^ (z >> 27)
    }
}

impl Subdivided {
    /// Cuts edges in the middle until none is longer than `longest` says of its ends. Everything that vertices have is interpolated;
    /// a mesh without normals gets smooth ones, but for creases of more than 30°.
    ///
    /// # Errors
    /// Where there would be more than `most` triangles.
    pub fn new(
        mesh: TriangleMesh,
        longest: impl Fn(Vec3, Vec3) -> f32,
        most: usize,
    ) -> Result<Self, TooMany> {
        let mesh = if mesh.normals.is_empty() { mesh.with_crease(CREASE) } else { mesh };
        let (point, points) = numbered(weld(&mesh.positions));
        let mut all = Self { mesh, point, points };
        let triangles = all.estimate(&longest);
        if triangles > SURELY * most as f64 {
            return Err(TooMany { triangles });
        }
        loop {
            let cuts = all.cuts(&longest);
            if cuts.is_empty() {
                return Ok(all);
            }
            let edges =
                |t: &[u32; 3]| (0..3).filter(|&k| cuts.contains_key(&all.edge(t[k], t[(k + 1) % 3]))).count();
            let next: usize = all.mesh.indices.iter().map(|t| 1 + edges(t)).sum();
            if next > most.min(MAX_COUNT) {
                return Err(TooMany { triangles: all.estimate(&longest).max(next as f64) });
            }
            all.cut(cuts);
        }
    }

    /// The mesh before it is moved.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Moves each point along its normal, the mean of those of its vertices, by the mean of their `heights`, one a vertex. Normals turn
    /// as the triangles around do, so that what was smooth stays smooth.
    pub fn displaced(self, heights: &[f32]) -> TriangleMesh {
        let Self { mut mesh, point, points } = self;
        let mut sums = vec![(DVec3::ZERO, 0.0f64, 0u32); points as usize];
        for (v, p) in point.iter().enumerate() {
            let sum = &mut sums[*p as usize];
            sum.1 += f64::from(heights.get(v).copied().unwrap_or_default());
            sum.2 += 1;
        }
        for (i, t) in mesh.indices.iter().enumerate() {
            for (k, angle) in angles(&mesh.corners(i)).into_iter().enumerate() {
                sums[point[t[k] as usize] as usize].0 += mesh.normals[t[k] as usize].as_dvec3() * angle;
            }
        }
        let moves: Vec<DVec3> = sums
            .iter()
            .map(|(n, sum, count)| n.normalize_or_zero() * (sum / f64::from((*count).max(1))))
            .collect();
        let before = mesh.positions.clone();
        for (position, p) in mesh.positions.iter_mut().zip(&point) {
            *position = (position.as_dvec3() + moves[*p as usize]).as_vec3();
        }
        mesh.normals = turned_normals(&mesh, &before, &point, points);
        mesh
    }

    fn edge(&self, a: u32, b: u32) -> (u32, u32) {
        let (a, b) = (self.point[a as usize], self.point[b as usize]);
        (a.min(b), a.max(b))
    }

    /// The edges to be cut, with the number of the point in the middle, which is still to come.
    fn cuts(&self, longest: &impl Fn(Vec3, Vec3) -> f32) -> Edges {
        let mut cuts = Edges::default();
        let mut next = self.points;
        for t in &self.mesh.indices {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let key = self.edge(a, b);
                if key.0 == key.1 || cuts.contains_key(&key) {
                    continue;
                }
                // The same for both sides: the lesser point first.
                let (a, b) = if self.point[a as usize] == key.0 { (a, b) } else { (b, a) };
                let [a, b] = [a, b].map(|v| self.mesh.positions[v as usize]);
                if a.distance(b) > longest(a, b) {
                    cuts.insert(key, next);
                    next += 1;
                }
            }
        }
        cuts
    }

    /// About how many triangles cutting would make.
    fn estimate(&self, longest: &impl Fn(Vec3, Vec3) -> f32) -> f64 {
        let of = |i: usize| {
            let [a, b, c] = self.mesh.corners(i);
            let edge = f64::from(longest(a, b).min(longest(b, c)).min(longest(c, a)));
            let area = 0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length();
            (area / (TYPICAL_AREA * edge * edge)).max(1.0)
        };
        (0..self.mesh.indices.len()).map(of).sum()
    }

    fn cut(&mut self, cuts: Edges) {
        self.points += cuts.len() as u32;
        let indices = std::mem::take(&mut self.mesh.indices);
        // Middles by the vertices at their ends: sides of a seam have one each.
        let mut middles: Edges = Edges::default();
        let mut next = Vec::with_capacity(2 * indices.len());
        for t in &indices {
            let middle = [0, 1, 2].map(|k| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let point = *cuts.get(&self.edge(a, b))?;
                let ends = (a.min(b), a.max(b));
                let known = middles.get(&ends).copied();
                let vertex = known.unwrap_or_else(|| self.push_middle(ends, point));
                middles.insert(ends, vertex);
                Some(vertex)
            });
            self.split(*t, middle, &mut next);
        }
        self.mesh.indices = next;
    }

    /// The triangles that one becomes, with the middles of its edges 01, 12, 20 where these are cut.
    fn split(&self, [a, b, c]: [u32; 3], middle: [Option<u32>; 3], into: &mut Vec<[u32; 3]>) {
        match middle {
            [None, None, None] => into.push([a, b, c]),
            [Some(m), None, None] => into.extend([[a, m, c], [m, b, c]]),
            [None, Some(m), None] => into.extend([[b, m, a], [m, c, a]]),
            [None, None, Some(m)] => into.extend([[c, m, b], [m, a, b]]),
            [Some(m), Some(n), None] => self.corner_and_rest(b, [n, c, a, m], into),
            [None, Some(m), Some(n)] => self.corner_and_rest(c, [n, a, b, m], into),
            [Some(n), None, Some(m)] => self.corner_and_rest(a, [n, b, c, m], into),
            [Some(ab), Some(bc), Some(ca)] => {
                into.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
        }
    }

    /// A corner between two middles, and the four-cornered rest, cut along its shorter diagonal. `rest` begins behind the corner.
    fn corner_and_rest(&self, corner: u32, [n, c, a, m]: [u32; 4], into: &mut Vec<[u32; 3]>) {
        into.push([m, corner, n]);
        let length = |p: u32, q: u32| {
            self.mesh.positions[p as usize].distance_squared(self.mesh.positions[q as usize])
        };
        // Inside of one triangle no other side has a say.
        if length(n, a) <= length(m, c) {
            into.extend([[n, c, a], [n, a, m]]);
        } else {
            into.extend([[n, c, m], [m, c, a]]);
        }
    }

    /// A vertex in the middle of two, and its number.
    fn push_middle(&mut self, (a, b): (u32, u32), point: u32) -> u32 {
        let (a, b) = (a as usize, b as usize);
        let mesh = &mut self.mesh;
        // The same whichever end comes first: sums of two commute.
        mesh.positions.push((mesh.positions[a] + mesh.positions[b]) * 0.5);
        let normal = mesh.normals[a] + mesh.normals[b];
        mesh.normals.push(normal.normalize_or(mesh.normals[a]));
        for uvs in [&mut mesh.uvs, &mut mesh.uvs2] {
            if !uvs.is_empty() {
                uvs.push((uvs[a] + uvs[b]) * 0.5);
            }
        }
        if !mesh.colors.is_empty() {
            let (one, other) = (mesh.colors[a], mesh.colors[b]);
            mesh.colors.push(std::array::from_fn(|c| 0.5 * (one[c] + other[c])));
        }
        self.point.push(point);
        self.mesh.positions.len() as u32 - 1
    }
}

/// Classes by their first vertices, as numbers without gaps, and how many there are.
fn numbered(first: Vec<u32>) -> (Vec<u32>, u32) {
    let mut number = vec![0; first.len()];
    let mut count = 0;
    for (v, f) in first.iter().enumerate() {
        // The first of a class comes before the others.
        if *f as usize == v {
            number[v] = count;
            count += 1;
        } else {
            number[v] = number[*f as usize];
        }
    }
    (number, count)
}

/// Angles of a triangle, in radians.
fn angles(corners: &[Vec3; 3]) -> [f64; 3] {
    let p = corners.map(|p| p.as_dvec3());
    std::array::from_fn(|k| {
        let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        u.cross(v).length().atan2(u.dot(v))
    })
}

/// Normals of a mesh that has been moved, its own being those of before: each turns as the triangles around its point do that
/// have about the same normal there, weighted by their angles. So a facet's own normal does not show through.
fn turned_normals(mesh: &TriangleMesh, before: &[Vec3], point: &[u32], points: u32) -> Vec<Vec3> {
    // Corners 3·triangle + k of each point, one behind the other.
    let mut starts = vec![0u32; points as usize + 1];
    let corners = || mesh.indices.iter().flatten().map(|v| point[*v as usize] as usize);
    corners().for_each(|p| starts[p + 1] += 1);
    for p in 0..points as usize {
        starts[p + 1] += starts[p];
    }
    let mut fill = starts.clone();
    let mut of_point = vec![0u32; 3 * mesh.indices.len()];
    for (corner, p) in corners().enumerate() {
        of_point[fill[p] as usize] = corner as u32;
        fill[p] += 1;
    }
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
    let faces: Vec<[DVec3; 2]> = mesh
        .indices
        .iter()
        .map(|t| [before, &mesh.positions].map(|all| normal(t.map(|v| all[v as usize].as_dvec3()))))
        .collect();
    let vertex = |corner: u32| mesh.indices[corner as usize / 3][corner as usize % 3] as usize;
    let mut done = vec![None; mesh.positions.len()];
    for corners in starts.windows(2).map(|w| &of_point[w[0] as usize..w[1] as usize]) {
        for &corner in corners {
            let v = vertex(corner);
            if done[v].is_some() {
                continue;
            }
            let own = mesh.normals[v].as_dvec3();
            let mut sum = DVec3::ZERO;
            for &other in corners {
                let n = mesh.normals[vertex(other)].as_dvec3();
                if n.dot(own) < SAME_NORMAL {
                    continue;
                }
                let i = other as usize / 3;
                let [from, to] = faces[i];
                sum += turned(n, from, to) * angles(&mesh.corners(i))[other as usize % 3];
            }
            done[v] = Some(unit_or_up(sum));
        }
    }
    done.into_iter().zip(&mesh.normals).map(|(n, old)| n.unwrap_or(*old)).collect()
}

/// A vector, turned as the shortest way takes one unit vector to another.
fn turned(n: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let (axis, cos) = (from.cross(to), from.dot(to));
    if from == DVec3::ZERO || to == DVec3::ZERO {
        return n;
    }
    if cos < -0.999 {
        return to;
    }
    // Rodrigues' formula, the axis not of unit length.
    n * cos + axis.cross(n) + axis * (axis.dot(n) / (1.0 + cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;
    use math::Vec2;

    fn fine(mesh: TriangleMesh, edge: f32) -> Subdivided {
        Subdivided::new(mesh, |_, _| edge, 1 << 22).unwrap()
    }

    fn longest(mesh: &TriangleMesh) -> f32 {
        let edges = |i: usize| {
            let [a, b, c] = mesh.corners(i);
            [a.distance(b), b.distance(c), c.distance(a)]
        };
        (0..mesh.indices.len()).flat_map(edges).fold(0.0, f32::max)
    }

    fn solids() -> Vec<TriangleMesh> {
        vec![
            shapes::box_(Vec3::ZERO, Vec3::new(1.0, 2.0, 0.3)),
            shapes::uv_sphere(1.0, 24, 12),
            shapes::icosphere(1.0, 2),
            shapes::torus(1.0, 0.3, 24, 12),
            shapes::coffee_cup(24),
            shapes::solid_cylinder(0.5, 2.0, 7),
            TriangleMesh { normals: Vec::new(), ..shapes::teapot_solid(4) },
        ]
    }

    #[test]
    fn cutting_changes_no_surface_and_leaves_no_long_edge() {
        for mesh in solids() {
            let (area, volume) = (mesh.area(), mesh.signed_volume());
            let edge = 0.11;
            let cut = fine(mesh.clone(), edge);
            cut.mesh().validate().unwrap();
            assert!(cut.mesh().is_closed());
            assert!(longest(cut.mesh()) <= edge, "{}", longest(cut.mesh()));
            assert!((cut.mesh().area() / area - 1.0).abs() < 1e-5);
            assert!((cut.mesh().signed_volume() / volume - 1.0).abs() < 1e-5);
            // Not many more triangles than needed, and no slivers but those that were there.
            let least = area / (f64::from(edge * edge) * 0.433);
            assert!(
                (cut.mesh().indices.len() as f64) < 5.0 * least + 2.0 * mesh.indices.len() as f64,
                "{} {least}",
                cut.mesh().indices.len()
            );
        }
    }

    #[test]
    fn lengths_may_differ_over_the_mesh() {
        let at = |p: Vec3| 0.02 + 0.2 * p.x.abs();
        for mesh in solids() {
            let cut = Subdivided::new(mesh, |a, b| at(a).min(at(b)), 1 << 22).unwrap();
            assert!(cut.mesh().is_closed());
        }
    }

    #[test]
    fn what_was_closed_stays_closed_however_it_is_moved() {
        for (n, mesh) in solids().into_iter().enumerate() {
            let cut = fine(mesh, 0.05);
            // Different on both sides of every seam: by the number of the vertex.
            let heights: Vec<f32> = (0..cut.mesh().positions.len())
                .map(|v| 0.01 * ((v * 7919 % 101) as f32 / 50.0 - 1.0))
                .collect();
            let moved = cut.displaced(&heights);
            moved.validate().unwrap();
            assert!(moved.is_closed(), "solid {n}");
        }
    }

    #[test]
    fn a_sphere_that_grows_is_a_sphere() {
        let cut = fine(shapes::uv_sphere(1.0, 64, 32), 0.04);
        let heights = vec![0.25; cut.mesh().positions.len()];
        let grown = cut.displaced(&heights);
        for (p, n) in grown.positions.iter().zip(&grown.normals) {
            assert!((p.length() - 1.25).abs() < 4e-3, "{}", p.length());
            // Smooth: the facets, 5.6° apart, are not seen in the normals.
            assert!(n.dot(p.normalize()) > 1.0 - 2e-4, "{p} {n}");
        }
    }

    #[test]
    fn normals_are_those_of_the_waves() {
        // z = h(x) over a plane and r = 1 + h(φ) around a tube, against the derivative.
        let flat = fine(shapes::quad(Vec3::ZERO, Vec3::X, Vec3::Y), 0.01);
        let heights: Vec<f32> = flat.mesh().positions.iter().map(|p| 0.02 * (20.0 * p.x).sin()).collect();
        let waves = flat.displaced(&heights);
        for (p, n) in waves.positions.iter().zip(&waves.normals) {
            if (0.02..0.98).contains(&p.x) {
                let wanted = Vec3::new(-0.4 * (20.0 * p.x).cos(), 0.0, 1.0).normalize();
                assert!(n.dot(wanted) > 0.999, "{p} {n} {wanted}");
            }
        }
        let tube = fine(shapes::cylinder(1.0, 0.5, 48), 0.02);
        let angle = |p: Vec3| p.z.atan2(p.x);
        let heights: Vec<f32> = tube.mesh().positions.iter().map(|p| 0.1 * (8.0 * angle(*p)).sin()).collect();
        let waves = tube.displaced(&heights);
        for (p, n) in waves.positions.iter().zip(&waves.normals) {
            if (0.03..0.47).contains(&p.y) {
                let (sin, cos) = angle(*p).sin_cos();
                let (out, along) = (Vec3::new(cos, 0.0, sin), Vec3::new(-sin, 0.0, cos));
                let r = 1.0 + 0.1 * (8.0 * angle(*p)).sin();
                let wanted = (out * r - along * 0.8 * (8.0 * angle(*p)).cos()).normalize();
                assert!(n.dot(wanted) > 0.998, "{p} {n} {wanted}");
            }
        }
    }

    #[test]
    fn creases_stay_and_carry_what_vertices_have() {
        let mut mesh = shapes::box_(Vec3::ZERO, Vec3::ONE);
        mesh.uvs2 = mesh.uvs.clone();
        mesh.colors = mesh.positions.iter().map(|p| [p.x, p.y, p.z, 1.0]).collect();
        let cut = fine(mesh, 0.1);
        for (i, p) in cut.mesh().positions.iter().enumerate() {
            assert_eq!(cut.mesh().colors[i][..3], p.to_array());
            assert_eq!(cut.mesh().uvs[i], cut.mesh().uvs2[i]);
            assert!(cut.mesh().uvs[i].cmpge(Vec2::ZERO).all());
        }
        let heights = vec![0.1; cut.mesh().positions.len()];
        let grown = cut.displaced(&heights);
        // Edges move along their diagonals, faces straight out, and their normals stay.
        let inner = |x: f32| (0.15..0.85).contains(&x);
        for (p, n) in grown.positions.iter().zip(&grown.normals) {
            if inner(p.x) && inner(p.y) {
                assert!(
                    n.abs().distance(Vec3::Z) < 1e-5 && (p.z + 0.1).min((p.z - 1.1).abs()).abs() < 1e-5,
                    "{p} {n}"
                );
            }
        }
        assert_eq!(grown.bounds().max.x, 1.1);
    }

    #[test]
    fn too_many_are_told_beforehand() {
        let quad = shapes::quad(Vec3::ZERO, Vec3::X, Vec3::Y);
        let error = Subdivided::new(quad.clone(), |_, _| 1e-5, 100_000).unwrap_err();
        assert!((1e10..1e11).contains(&error.triangles), "{}", error.triangles);
        let made = Subdivided::new(quad.clone(), |_, _| 0.01, 1 << 20).unwrap().mesh().indices.len() as f64;
        let told = Subdivided::new(quad, |_, _| 0.01, 100).unwrap_err().triangles;
        assert!((0.5..2.0).contains(&(told / made)), "{told} {made}");
    }
}
