//! What needs to know which triangles share a point: closedness and vertex normals.
//! Vertices are the same point where their positions are equal bit for bit (−0 = +0).

use math::{DVec3, Vec3};

use crate::TriangleMesh;

impl TriangleMesh {
    /// Whether the surface is watertight and consistently oriented: every edge, by its end positions, is passed
    /// as often one way as the other. Normals and uvs may differ along an edge; several shells may share the mesh.
    /// A mesh without triangles is not closed.
    pub fn is_closed(&self) -> bool {
        let point = weld(&self.positions);
        let edges = sorted_edges(&self.indices, &point);
        !edges.is_empty()
            && edges.chunk_by(|a, b| a.key == b.key).all(|run| {
                let forward = run.iter().filter(|e| e.forward).count();
                2 * forward == run.len()
            })
    }

    /// The mesh with a normal for each vertex: the mean of the adjoining triangles' normals weighted by their angles
    /// there (Thürmer & Wüthrich 1998). Vertices at the same position get the same normal.
    pub fn with_smooth_normals(self) -> Self {
        let point = weld(&self.positions);
        self.averaged(&point)
    }

    /// As [`with_smooth_normals`](Self::with_smooth_normals), but only triangles that share a vertex are averaged: where
    /// vertices lie at the same position there may be an edge.
    pub fn with_vertex_normals(self) -> Self {
        let point: Vec<u32> = (0..self.positions.len() as u32).collect();
        self.averaged(&point)
    }

    /// Normals by classes of vertices; `point`: the first of each vertex's class.
    fn averaged(mut self, point: &[u32]) -> Self {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for i in 0..self.indices.len() {
            let corner_normals = self.weighted_normals(i);
            for (v, n) in self.indices[i].iter().zip(corner_normals) {
                sums[point[*v as usize] as usize] += n;
            }
        }
        self.normals = point.iter().map(|&p| unit_or_up(sums[p as usize])).collect();
        self
    }

    /// The mesh with normals that are smooth across edges where the triangles' normals differ by at most `angle`
    /// (radians) and break at sharper or open edges; vertices on a break are split.
    pub fn with_crease(self, angle: f32) -> Self {
        let point = weld(&self.positions);
        let triangles = self.indices.len();
        let weighted: Vec<[DVec3; 3]> = (0..triangles).map(|i| self.weighted_normals(i)).collect();
        let face: Vec<DVec3> = weighted.iter().map(|w| w[0].normalize_or_zero()).collect();
        let least_cosine = f64::from(angle.clamp(0.0, math::PI)).cos() - 1e-9;

        // Corners that share a point and a smooth edge get one normal: disjoint sets over corners 3·triangle + k.
        let mut parent: Vec<u32> = (0..3 * triangles as u32).collect();
        let edges = sorted_edges(&self.indices, &point);
        for run in edges.chunk_by(|a, b| a.key == b.key) {
            if let [a, b] = run
                && a.forward != b.forward
                && face[a.triangle()].dot(face[b.triangle()]) >= least_cosine
            {
                unite(&mut parent, a.corner, b.next_corner());
                unite(&mut parent, a.next_corner(), b.corner);
            }
        }
        let mut sums = vec![DVec3::ZERO; 3 * triangles];
        for (i, w) in weighted.iter().enumerate() {
            for (k, n) in w.iter().enumerate() {
                sums[find(&mut parent, (3 * i + k) as u32) as usize] += *n;
            }
        }

        let mut split = Self::default();
        // Copies of each vertex made so far: a list by (set, new index, next).
        let mut first = vec![u32::MAX; self.positions.len()];
        let mut copies: Vec<(u32, u32)> = Vec::new();
        for (i, t) in self.indices.iter().enumerate() {
            let mut corners = [0; 3];
            for (k, &v) in t.iter().enumerate() {
                let set = find(&mut parent, (3 * i + k) as u32);
                let mut copy = first[v as usize];
                while copy != u32::MAX && copies[copy as usize].0 != set {
                    copy = copies[copy as usize].1;
                }
                if copy == u32::MAX {
                    copy = copies.len() as u32;
                    copies.push((set, first[v as usize]));
                    first[v as usize] = copy;
                    split.positions.push(self.positions[v as usize]);
                    split.normals.push(unit_or_up(sums[set as usize]));
                    split.push_attributes(&self, v as usize);
                }
                corners[k] = copy;
            }
            split.indices.push(corners);
        }
        split
    }

    /// The normal of triangle `i` times the angle at each corner; zero where it has no area.
    fn weighted_normals(&self, i: usize) -> [DVec3; 3] {
        let p = self.corners(i).map(|p| p.as_dvec3());
        let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        std::array::from_fn(|k| {
            let u = p[(k + 1) % 3] - p[k];
            let v = p[(k + 2) % 3] - p[k];
            n * u.cross(v).length().atan2(u.dot(v))
        })
    }
}

/// Any unit vector where the sum is zero: a vertex without area about it.
pub(crate) fn unit_or_up(sum: DVec3) -> Vec3 {
    sum.normalize_or(DVec3::Y).as_vec3()
}

/// For each vertex the least index of a vertex at the same position.
pub(crate) fn weld(positions: &[Vec3]) -> Vec<u32> {
    // Adding zero turns −0 into +0.
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut order: Vec<([u32; 3], u32)> =
        positions.iter().enumerate().map(|(i, &p)| (key(p), i as u32)).collect();
    order.sort_unstable();
    let mut point = vec![0; positions.len()];
    for run in order.chunk_by(|a, b| a.0 == b.0) {
        for (_, i) in run {
            point[*i as usize] = run[0].1;
        }
    }
    point
}

struct Edge {
    /// Lesser point in the upper half, greater one in the lower half.
    key: u64,
    /// Corner 3·triangle + k where the edge starts.
    corner: u32,
    /// Whether it runs from the lesser point to the greater.
    forward: bool,
}

impl Edge {
    fn triangle(&self) -> usize {
        self.corner as usize / 3
    }

    fn next_corner(&self) -> u32 {
        if self.corner % 3 == 2 { self.corner - 2 } else { self.corner + 1 }
    }
}

/// All edges between different points, equal ones side by side.
fn sorted_edges(indices: &[[u32; 3]], point: &[u32]) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(3 * indices.len());
    for (i, t) in indices.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (point[t[k] as usize], point[t[(k + 1) % 3] as usize]);
            if a != b {
                let key = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
                edges.push(Edge { key, corner: (3 * i + k) as u32, forward: a < b });
            }
        }
    }
    edges.sort_unstable_by_key(|e| (e.key, e.corner));
    edges
}

fn find(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        let grandparent = parent[parent[i as usize] as usize];
        parent[i as usize] = grandparent;
        i = grandparent;
    }
    i
}

/// The lesser root stays, so that the result does not depend on the order.
fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;
    use math::{Affine3A, Transform};

    fn unit_box() -> TriangleMesh {
        shapes::box_(Vec3::ZERO, Vec3::ONE)
    }

    #[test]
    fn a_box_is_closed_until_a_triangle_is_lost_or_turned() {
        let closed = unit_box();
        assert!(closed.is_closed());
        let mut lost = closed.clone();
        lost.indices.pop();
        assert!(!lost.is_closed());
        let mut turned = closed.clone();
        turned.indices[3].swap(0, 1);
        assert!(!turned.is_closed());
        assert!(!TriangleMesh::default().is_closed());
    }

    #[test]
    fn volume_follows_orientation_and_mirrors() {
        let cube = unit_box();
        assert!((cube.signed_volume() - 1.0).abs() < 1e-12);
        assert!((cube.area() - 6.0).abs() < 1e-12);
        assert!((cube.clone().flipped().signed_volume() + 1.0).abs() < 1e-12);
        let mirror = Transform::new(Affine3A::from_scale(Vec3::new(-2.0, 1.0, 1.0))).unwrap();
        let mirrored = cube.transformed(&mirror);
        assert!((mirrored.signed_volume() - 2.0).abs() < 1e-12);
        mirrored.validate().unwrap();
        for t in &mirrored.indices {
            let [a, b, c] = t.map(|v| mirrored.positions[v as usize]);
            assert!((b - a).cross(c - a).dot(mirrored.normals[t[0] as usize]) > 0.0);
        }
    }

    #[test]
    fn smooth_normals_of_a_box_point_along_its_diagonals() {
        let smooth = unit_box().with_smooth_normals();
        for (p, n) in smooth.positions.iter().zip(&smooth.normals) {
            let diagonal = (*p - Vec3::splat(0.5)).normalize();
            assert!(n.dot(diagonal) > 1.0 - 1e-6, "{p} {n}");
        }
    }

    #[test]
    fn vertex_normals_of_a_box_of_24_vertices_are_its_faces_own() {
        let cube = unit_box().with_vertex_normals();
        assert_eq!(cube.positions.len(), 24);
        for t in &cube.indices {
            let [a, b, c] = t.map(|v| cube.positions[v as usize]);
            let n = (b - a).cross(c - a).normalize();
            assert!(t.iter().all(|&v| cube.normals[v as usize].dot(n) > 1.0 - 1e-6));
        }
    }

    #[test]
    fn creases_split_a_box_but_not_a_sphere() {
        let mut cube = unit_box().with_smooth_normals();
        assert_eq!(cube.positions.len(), 24);
        cube = cube.with_crease(0.5);
        cube.validate().unwrap();
        assert_eq!(cube.positions.len(), 24);
        for t in &cube.indices {
            let [a, b, c] = t.map(|v| cube.positions[v as usize]);
            let n = (b - a).cross(c - a).normalize();
            assert!(t.iter().all(|&v| cube.normals[v as usize].dot(n) > 1.0 - 1e-6));
        }
        // Welded by position, 8 points; smoothed across everything, each keeps its three faces in one set.
        let rounded = cube.with_crease(math::PI);
        assert!(rounded.normals.iter().all(|n| n.abs().max_element() < 0.6));

        let sphere = shapes::icosphere(1.0, 2);
        let creased = sphere.clone().with_crease(0.6);
        assert_eq!(creased.positions.len(), sphere.positions.len());
        for (p, n) in creased.positions.iter().zip(&creased.normals) {
            assert!(n.dot(*p) > 0.999);
        }
    }
}
