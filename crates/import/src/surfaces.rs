//! Meshes, and the curved shapes that become meshes.

use std::f64::consts::PI;

use mesh::TriangleMesh;
use scenefile::desc::Triple;

use crate::matrix::{add, cross, dot, length, narrow, sub, times, unit, wide};

/// Parts of a full turn.
const AROUND: usize = 128;
/// Parts of other curved directions.
const ALONG: usize = 32;
/// Parts of each side of a patch that is not flat.
const PATCH: usize = 12;
/// Vertices of such a patch.
pub(crate) const PATCH_VERTICES: u64 = ((PATCH + 1) * (PATCH + 1)) as u64;

/// Triangles over shared vertices; the front is where they turn counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mesh {
    pub positions: Vec<Triple>,
    /// One a vertex, or none.
    pub normals: Vec<Triple>,
    /// One a vertex, or none.
    pub uvs: Vec<[f32; 2]>,
    pub indices: Vec<[u32; 3]>,
}

impl From<TriangleMesh> for Mesh {
    fn from(mesh: TriangleMesh) -> Self {
        Self {
            positions: mesh.positions.iter().map(|p| p.to_array()).collect(),
            normals: mesh.normals.iter().map(|n| n.to_array()).collect(),
            uvs: mesh.uvs.iter().map(|t| t.to_array()).collect(),
            indices: mesh.indices,
        }
    }
}

impl Mesh {
    /// Vertices without triangles.
    pub(crate) fn new(positions: &[[f64; 3]], normals: &[[f64; 3]], uvs: &[[f64; 2]]) -> Self {
        Self {
            positions: positions.iter().copied().map(narrow).collect(),
            normals: normals.iter().map(|n| narrow(unit(*n).unwrap_or_default())).collect(),
            uvs: uvs.iter().map(|t| t.map(|x| x as f32)).collect(),
            indices: Vec::new(),
        }
    }

    /// Twice the area, along the normal of the front.
    fn face(&self, t: [u32; 3]) -> [f64; 3] {
        let [a, b, c] = t.map(|v| wide(self.positions[v as usize]));
        cross(sub(b, a), sub(c, a))
    }

    /// Drops triangles without area, turns faces to the side of their normals, and gives normals where they are zero.
    pub(crate) fn repair(&mut self) {
        let mut indices = std::mem::take(&mut self.indices);
        indices.retain(|t| length(self.face(*t)) as f32 > 0.0);
        self.indices = indices;
        if self.normals.contains(&[0.0; 3]) {
            let mut sums = vec![[0.0; 3]; self.positions.len()];
            for t in &self.indices {
                for v in t {
                    sums[*v as usize] = add(sums[*v as usize], self.face(*t));
                }
            }
            for (normal, sum) in self.normals.iter_mut().zip(sums) {
                if *normal == [0.0; 3] {
                    // A vertex that no triangle uses may have any.
                    *normal = narrow(unit(sum).unwrap_or([0.0, 0.0, 1.0]));
                }
            }
        }
        self.turn_to_normals();
    }

    /// As pbrt: a face's front is the side of its vertices' normals. Whether any was turned.
    pub(crate) fn turn_to_normals(&mut self) -> bool {
        if self.normals.is_empty() {
            return false;
        }
        let mut any = false;
        for i in 0..self.indices.len() {
            let t = self.indices[i];
            let normal = t.iter().fold([0.0; 3], |sum, v| add(sum, wide(self.normals[*v as usize])));
            if dot(self.face(t), normal) < 0.0 {
                self.indices[i].swap(1, 2);
                any = true;
            }
        }
        any
    }

    /// A grid of `nu` × `nv` cells; `at` gives point and normal for u and v in 0..=1.
    fn grid(nu: usize, nv: usize, at: impl Fn(f64, f64) -> ([f64; 3], [f64; 3])) -> Self {
        let mut mesh = Self::default();
        for j in 0..=nv {
            for i in 0..=nu {
                let (u, v) = (i as f64 / nu as f64, j as f64 / nv as f64);
                let (p, n) = at(u, v);
                mesh.positions.push(narrow(p));
                mesh.normals.push(narrow(unit(n).unwrap_or_default()));
                mesh.uvs.push([u as f32, v as f32]);
            }
        }
        mesh.sew(0, nu, nv);
        mesh
    }

    fn sew(&mut self, first: usize, nu: usize, nv: usize) {
        for j in 0..nv {
            for i in 0..nu {
                let a = (first + j * (nu + 1) + i) as u32;
                let (b, c, d) = (a + 1, a + nu as u32 + 2, a + nu as u32 + 1);
                self.indices.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
}

/// Parts of a turn of so many degrees.
fn around(degrees: f64) -> usize {
    ((AROUND as f64 * degrees / 360.0).ceil() as usize).max(1)
}

fn circle(u: f64, degrees: f64) -> [f64; 2] {
    let (s, c) = (u * degrees.to_radians()).sin_cos();
    [c, s]
}

/// A part of a sphere about the origin, normals outward.
pub(crate) fn sphere(radius: f64, zmin: f64, zmax: f64, degrees: f64) -> Mesh {
    let [low, high] = [zmin, zmax].map(|z| (z / radius).clamp(-1.0, 1.0).acos());
    Mesh::grid(around(degrees), AROUND / 2, |u, v| {
        let [c, s] = circle(u, degrees);
        let theta = low + (high - low) * v;
        // Poles are points, to the bit.
        let sin = if theta >= PI || theta <= 0.0 { 0.0 } else { theta.sin() };
        let n = [c * sin, s * sin, theta.cos()];
        (times(n, radius), n)
    })
}

/// A ring at a height, normal +z.
pub(crate) fn disk(radius: f64, inner: f64, height: f64, degrees: f64) -> Mesh {
    Mesh::grid(around(degrees), 1, |u, v| {
        let [c, s] = circle(u, degrees);
        let r = radius + (inner - radius) * v;
        ([c * r, s * r, height], [0.0, 0.0, 1.0])
    })
}

/// An open tube about z, normals outward.
pub(crate) fn cylinder(radius: f64, zmin: f64, zmax: f64, degrees: f64) -> Mesh {
    Mesh::grid(around(degrees), 1, |u, v| {
        let [c, s] = circle(u, degrees);
        ([c * radius, s * radius, zmin + (zmax - zmin) * v], [c, s, 0.0])
    })
}

/// An open cone about z with its tip at `height`, normals outward.
pub(crate) fn cone(radius: f64, height: f64, degrees: f64) -> Mesh {
    Mesh::grid(around(degrees), ALONG, |u, v| {
        let [c, s] = circle(u, degrees);
        let r = radius * (1.0 - v);
        ([c * r, s * r, v * height], [height * c, height * s, radius])
    })
}

/// An open bowl about z of `radius` at `zmax`, normals outward.
pub(crate) fn paraboloid(radius: f64, zmin: f64, zmax: f64, degrees: f64) -> Mesh {
    Mesh::grid(around(degrees), ALONG, |u, v| {
        let [c, s] = circle(u, degrees);
        let z = zmin + (zmax - zmin) * v;
        let r = radius * (z / zmax).sqrt();
        // Of r² = radius²·z/zmax.
        let slope = radius * radius / (2.0 * zmax);
        ([c * r, s * r, z], [c * r, s * r, -slope])
    })
}

/// Patches between four corners (0,0), (1,0), (0,1), (1,1), normals along ∂p/∂u × ∂p/∂v. Flat ones are two triangles.
pub(crate) fn bilinear(mesh: &Mesh, patches: &[[u32; 4]]) -> Mesh {
    let mut out = Mesh::default();
    for patch in patches {
        let p = patch.map(|v| wide(mesh.positions[v as usize]));
        let corner = |list: &[Triple], i: usize| list.get(patch[i] as usize).copied().map(wide);
        let normals: Vec<_> = (0..4).filter_map(|i| corner(&mesh.normals, i)).collect();
        let uvs: Vec<[f64; 2]> =
            patch.iter().filter_map(|v| mesh.uvs.get(*v as usize)).map(|t| t.map(f64::from)).collect();
        let flat_normal = cross(sub(p[1], p[0]), sub(p[2], p[0]));
        let size = length(sub(p[3], p[0])).max(length(sub(p[1], p[2])));
        let bend = dot(flat_normal, sub(p[3], p[0])).abs() / length(flat_normal).max(f64::MIN_POSITIVE);
        let flat = bend < 1e-5 * size;
        let n = if flat { 1 } else { PATCH };
        let first = out.positions.len();
        for j in 0..=n {
            for i in 0..=n {
                let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                let w = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
                let mix = |c: &[[f64; 3]]| (0..4).fold([0.0; 3], |sum, k| add(sum, times(c[k], w[k])));
                out.positions.push(narrow(mix(&p)));
                let du = add(times(sub(p[1], p[0]), 1.0 - v), times(sub(p[3], p[2]), v));
                let dv = add(times(sub(p[2], p[0]), 1.0 - u), times(sub(p[3], p[1]), u));
                let normal = if normals.len() == 4 { mix(&normals) } else { cross(du, dv) };
                out.normals.push(narrow(unit(normal).unwrap_or_default()));
                let uv = match uvs.len() {
                    4 => [0, 1].map(|k| (0..4).map(|c| uvs[c][k] * w[c]).sum::<f64>() as f32),
                    _ => [u as f32, v as f32],
                };
                out.uvs.push(uv);
            }
        }
        out.sew(first, n, n);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(mut mesh: Mesh) -> (f64, Mesh) {
        let before = mesh.clone();
        mesh.repair();
        // The normals given are those of the surface: nothing needs turning.
        for (t, u) in mesh.indices.iter().zip(before.indices.iter().filter(|t| before.face(**t) != [0.0; 3]))
        {
            assert!(dot(mesh.face(*t), wide(mesh.normals[t[0] as usize])) > 0.0, "{t:?} {u:?}");
        }
        let area = mesh.indices.iter().map(|t| length(mesh.face(*t)) / 2.0).sum();
        (area, mesh)
    }

    #[test]
    fn areas_and_sides() {
        let near = |area: f64, exact: f64| assert!((area / exact - 1.0).abs() < 3e-3, "{area} {exact}");
        near(checked(sphere(2.0, -2.0, 2.0, 360.0)).0, 16.0 * PI);
        // A zone's area is that of its cylinder (Archimedes).
        near(checked(sphere(2.0, 0.0, 1.0, 180.0)).0, 2.0 * PI * 2.0 * 1.0 / 2.0);
        near(checked(disk(2.0, 1.0, 5.0, 90.0)).0, 3.0 * PI / 4.0);
        near(checked(cylinder(0.5, -1.0, 2.0, 360.0)).0, 3.0 * PI);
        near(checked(cone(3.0, 4.0, 360.0)).0, PI * 3.0 * 5.0);
        near(checked(paraboloid(1.0, 0.0, 1.0, 360.0)).0, PI / 6.0 * (5f64.powf(1.5) - 1.0));
        for (mesh, out) in [(sphere(1.0, -1.0, 1.0, 360.0), true), (cylinder(1.0, 0.0, 1.0, 360.0), true)] {
            let (_, mesh) = checked(mesh);
            let away = |t: &[u32; 3]| dot(mesh.face(*t), wide(mesh.positions[t[0] as usize])) > 0.0;
            assert_eq!(mesh.indices.iter().all(away), out);
        }
    }

    #[test]
    fn patches() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0]];
        let (area, flat) = checked(bilinear(&Mesh::new(&corners, &[], &[]), &[[0, 1, 2, 3]]));
        assert_eq!((area, flat.indices.len()), (2.0, 2));
        assert_eq!(flat.normals[0], [0.0, 0.0, 1.0]);
        let mut bent = corners;
        bent[3][2] = 1.0;
        let (area, bent) = checked(bilinear(&Mesh::new(&bent, &[], &[]), &[[0, 1, 2, 3]]));
        assert!(area > 2.0 && bent.indices.len() == 2 * PATCH * PATCH);
    }

    #[test]
    fn faces_turn_to_their_normals() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut mesh = Mesh::new(&corners, &[[0.0, 0.0, -3.0]; 3], &[]);
        mesh.indices = vec![[0, 1, 2], [0, 0, 1]];
        mesh.repair();
        assert_eq!(mesh.indices, [[0, 2, 1]]);
        let mut zero = Mesh::new(&corners, &[[0.0; 3]; 3], &[]);
        zero.indices = vec![[0, 1, 2]];
        zero.repair();
        assert_eq!((zero.normals[1], zero.indices[0]), ([0.0, 0.0, 1.0], [0, 1, 2]));
    }
}
