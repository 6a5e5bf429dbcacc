use std::collections::HashMap;

use math::{DVec2, DVec3, Vec3};

use super::clamped;
use super::grid::{Grid, Vertex, turn};
use super::lathe::revolve;
use super::outline::Pen;
use crate::TriangleMesh;

/// An open tube about the y axis from y = 0 to `height`, in 3 to 65 536 flat strips; its outside is away from the axis
/// ([`TriangleMesh::flipped`] for a mirror that faces inward). Normals are exactly radial, vertices on the cylinder.
pub fn cylinder(radius: f32, height: f32, segments: u32) -> TriangleMesh {
    let r = f64::from(radius);
    revolve(&Pen::at(r, 0.0).line(r, height.into()).finish(), clamped(segments))
}

/// An open cone about the y axis: `radius` at y = 0, the tip at `height`.
pub fn cone(radius: f32, height: f32, segments: u32) -> TriangleMesh {
    revolve(&Pen::at(radius.into(), 0.0).line(0.0, height.into()).finish(), clamped(segments))
}

/// A torus about the y axis, centred at the origin: `sides` round a tube of radius `minor` whose middle runs at `major`.
pub fn torus(major: f32, minor: f32, segments: u32, sides: u32) -> TriangleMesh {
    let (major, minor) = (f64::from(major), f64::from(minor));
    let outline = Pen::at(major + minor, 0.0).arc(major, 0.0, 4.0, clamped(sides)).closed();
    revolve(&outline, clamped(segments))
}

/// A sphere about the origin with poles on the y axis, in `rings` (2 to 65 536) from pole to pole; v goes from the
/// lower pole to the upper one.
pub fn uv_sphere(radius: f32, segments: u32, rings: u32) -> TriangleMesh {
    let rings = rings.clamp(2, 1 << 16);
    let segments = clamped(segments);
    let mut grid = Grid::new(segments);
    let vertex = |i: u32, j: f64| {
        // From the lower pole, by a turn of half a circle.
        let (cos, sin) = turn(f64::from(i), 2 * rings);
        let (c, s) = turn(j, segments);
        let normal = DVec3::new(sin * c, -cos, -sin * s);
        let uv = DVec2::new(j / f64::from(segments), f64::from(i) / f64::from(rings));
        Vertex { position: normal * f64::from(radius), normal, uv }
    };
    let mut last = grid.pole(|j| vertex(0, j));
    for i in 1..=rings {
        let row =
            if i == rings { grid.pole(|j| vertex(i, j)) } else { grid.ring(|j| vertex(i, f64::from(j))) };
        grid.sew(last, row);
        last = row;
    }
    grid.finish()
}

/// A sphere about the origin: an icosahedron whose triangles are cut in four `level` times (0 to 9), 20·4^level in all,
/// with no poles. It has no uvs.
pub fn icosphere(radius: f32, level: u32) -> TriangleMesh {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut directions = Vec::new();
    for axis in 0..3 {
        for (one, long) in [(-1.0, -golden), (1.0, -golden), (-1.0, golden), (1.0, golden)] {
            let mut p = DVec3::ZERO;
            p[axis] = one;
            p[(axis + 1) % 3] = long;
            directions.push(p.normalize());
        }
    }
    // Faces are the triples at edge length; twelve points make the search short.
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let near = |a: usize, b: usize| (directions[a].distance(directions[b]) - edge).abs() < 1e-9;
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outward = directions[a].dot(directions[b].cross(directions[c])) > 0.0;
                    let [a, b, c] = [a, b, c].map(|i| i as u32);
                    faces.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..level.min(9) {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::with_capacity(faces.len() * 3 / 2);
        let mut finer = Vec::with_capacity(4 * faces.len());
        for &[a, b, c] in &faces {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    directions.push((directions[i as usize] + directions[j as usize]).normalize());
                    directions.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    TriangleMesh {
        positions: directions.iter().map(|d| (*d * f64::from(radius)).as_vec3()).collect(),
        normals: directions.iter().map(|d| d.as_vec3()).collect::<Vec<Vec3>>(),
        indices: faces,
        ..TriangleMesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn spheres_are_closed_spheres() {
        let exact = 4.0 / 3.0 * PI * 8.0;
        let spheres = [
            (icosphere(2.0, 0), 0.45),
            (icosphere(2.0, 4), 0.01),
            (uv_sphere(2.0, 3, 2), 0.9),
            (uv_sphere(2.0, 96, 48), 0.01),
        ];
        for (mesh, tolerance) in spheres {
            mesh.validate().unwrap();
            assert!(mesh.is_closed());
            let volume = mesh.signed_volume();
            assert!(volume < exact && volume > exact * (1.0 - tolerance), "{volume}");
            for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
                assert!((p.length() - 2.0).abs() < 1e-6);
                assert!((*n * 2.0 - *p).length() < 1e-6 || p.x == 0.0 && p.z == 0.0);
            }
        }
        assert_eq!(icosphere(1.0, 3).indices.len(), 20 * 64);
        assert_eq!(icosphere(1.0, 3).positions.len(), 10 * 64 + 2);
    }

    #[test]
    fn tori_have_their_volume_and_normals() {
        let mesh = torus(2.0, 0.5, 128, 64);
        mesh.validate().unwrap();
        assert!(mesh.is_closed());
        let exact = 2.0 * PI * PI * 2.0 * 0.25;
        assert!((mesh.signed_volume() / exact - 1.0).abs() < 3e-3);
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let middle = Vec3::new(p.x, 0.0, p.z).normalize() * 2.0;
            assert!(((*p - middle) * 2.0 - *n).length() < 1e-5);
        }
    }

    #[test]
    fn a_cylinder_has_radial_normals() {
        let mesh = cylinder(3.0, 2.0, 92);
        mesh.validate().unwrap();
        assert!(!mesh.is_closed());
        assert_eq!(mesh.bounds().max, Vec3::new(3.0, 2.0, 3.0));
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((Vec3::new(p.x, 0.0, p.z) / 3.0 - *n).length() < 2e-7);
        }
        let [a, b, c] = mesh.corners(0);
        assert!((b - a).cross(c - a).dot(mesh.normals[0]) > 0.0);
        let tip = cone(1.0, 1.0, 12);
        tip.validate().unwrap();
        assert_eq!(tip.bounds().max.y, 1.0);
    }
}
