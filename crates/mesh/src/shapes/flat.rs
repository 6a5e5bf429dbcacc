use math::{Vec2, Vec3};

use super::clamped;
use super::lathe::revolve;
use super::outline::Pen;
use crate::TriangleMesh;

/// A parallelogram with the corners `origin`, `+ edge_u`, `+ edge_v`; its outside is along `edge_u` × `edge_v`.
pub fn quad(origin: Vec3, edge_u: Vec3, edge_v: Vec3) -> TriangleMesh {
    let normal = edge_u.as_dvec3().cross(edge_v.as_dvec3()).normalize_or(math::DVec3::Y).as_vec3();
    TriangleMesh {
        positions: vec![origin, origin + edge_u, origin + edge_u + edge_v, origin + edge_v],
        normals: vec![normal; 4],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

/// A closed box with the corners `min` and `max`; each face has uvs from (0, 0) to (1, 1).
pub fn box_(min: Vec3, max: Vec3) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        for side in 0..2 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let base = mesh.positions.len() as u32;
            for (s, t) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut p = Vec3::ZERO;
                for (i, k) in [(axis, side), (u, s), (v, t)] {
                    p[i] = if k == 0 { min[i] } else { max[i] };
                }
                mesh.positions.push(p);
                mesh.uvs.push(Vec2::new(s as f32, t as f32));
                mesh.normals.push(Vec3::AXES[axis] * if side == 0 { -1.0 } else { 1.0 });
            }
            let [b, d] = if side == 0 { [2, 1] } else { [1, 2] };
            mesh.indices.push([base, base + b, base + d]);
            let [b, d] = if side == 0 { [3, 2] } else { [2, 3] };
            mesh.indices.push([base, base + b, base + d]);
        }
    }
    mesh
}

/// A disk about the origin in the plane y = 0, facing +y, as a polygon of 3 to 65 536 corners on the circle.
pub fn disk(radius: f32, segments: u32) -> TriangleMesh {
    revolve(&Pen::at(radius.into(), 0.0).line(0.0, 0.0).finish(), clamped(segments))
}

/// The part of a [`disk`] outside `inner`.
pub fn annulus(inner: f32, outer: f32, segments: u32) -> TriangleMesh {
    revolve(&Pen::at(outer.into(), 0.0).line(inner.into(), 0.0).finish(), clamped(segments))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn flat_shapes_face_where_they_say() {
        let q = quad(Vec3::X, Vec3::Z * 2.0, Vec3::X * 3.0);
        assert_eq!(q.area(), 6.0);
        for (mesh, normal) in [(q, Vec3::Y), (disk(2.0, 5), Vec3::Y), (annulus(1.0, 2.0, 7), Vec3::Y)] {
            mesh.validate().unwrap();
            for i in 0..mesh.indices.len() {
                let [a, b, c] = mesh.corners(i);
                assert!((b - a).cross(c - a).normalize().dot(normal) > 1.0 - 1e-6);
                assert!(mesh.indices[i].iter().all(|&v| mesh.normals[v as usize] == normal));
            }
        }
        let area = disk(2.0, 100).area();
        assert!((area - 2.0 * 100.0 * (TAU / 100.0).sin()).abs() < 1e-5, "{area}");
    }

    #[test]
    fn boxes_are_closed_with_normals_outward() {
        let b = box_(Vec3::new(-1.0, 0.0, 2.0), Vec3::new(1.0, 3.0, 2.5));
        b.validate().unwrap();
        assert!(b.is_closed());
        assert!((b.signed_volume() - 3.0).abs() < 1e-6);
        for (i, t) in b.indices.iter().enumerate() {
            let [p, q, r] = b.corners(i);
            assert!((q - p).cross(r - p).normalize().dot(b.normals[t[0] as usize]) > 0.999);
        }
    }
}
