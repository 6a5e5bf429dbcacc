use math::{DVec2, DVec3, Vec3};

use super::clamped;
use super::grid::{Grid, Vertex, turn};
use super::lathe::revolve;
use super::outline::Pen;
use crate::TriangleMesh;

/// A closed cylinder about the y axis from y = 0 to `height`, with sharp edges.
pub fn solid_cylinder(radius: f32, height: f32, segments: u32) -> TriangleMesh {
    frustum(radius, radius, height, segments)
}

/// A closed cone about the y axis: `radius` at y = 0, `top` at `height`; a `top` of 0 is a tip.
pub fn frustum(radius: f32, top: f32, height: f32, segments: u32) -> TriangleMesh {
    let (radius, top, height) = (f64::from(radius), f64::from(top), f64::from(height));
    let pen = Pen::at(0.0, 0.0).line(radius, 0.0).line(top, height);
    let pen = if top > 0.0 { pen.line(0.0, height) } else { pen };
    revolve(&pen.finish(), clamped(segments))
}

/// The mantle of a [`frustum`].
pub fn open_frustum(radius: f32, top: f32, height: f32, segments: u32) -> TriangleMesh {
    revolve(&Pen::at(radius.into(), 0.0).line(top.into(), height.into()).finish(), clamped(segments))
}

/// A closed capsule about the y axis: a cylinder from y = 0 to `height` with a half ball on each end, in as many facets
/// a quarter turn as there are around, but at most 128.
pub fn capsule(radius: f32, height: f32, segments: u32) -> TriangleMesh {
    let (radius, height) = (f64::from(radius), f64::from(height));
    let segments = clamped(segments);
    let steps = segments.div_ceil(4).min(128);
    let mut outline = Pen::at(0.0, -radius)
        .arc(0.0, 0.0, 1.0, steps)
        .line(radius, height)
        .arc(0.0, height, 1.0, steps)
        .finish();
    // Exactly on the axis, so that the ends are points.
    if let Some(last) = outline.last_mut() {
        last.point.x = 0.0;
    }
    revolve(&outline, segments)
}

/// A closed box from `min` to `max` whose edges are rounded by `radius`, > 0 and less than half the least side, in
/// 1 to 1024 `steps` a quarter turn. Its uvs go round it as those of a sphere.
pub fn rounded_box(min: Vec3, max: Vec3, radius: f32, steps: u32) -> TriangleMesh {
    let radius = f64::from(radius);
    let (min, max) = (min.as_dvec3() + radius, max.as_dvec3() - radius);
    let steps = steps.clamp(1, 1024);
    // An octant each of a ball about each corner: columns and rows come twice where the corner changes.
    let columns = 4 * (steps + 1);
    let around = |j: u32| {
        let (quarter, step) = ((j / (steps + 1)) % 4, j % (steps + 1));
        (turn(f64::from(quarter * steps + step), 4 * steps), quarter)
    };
    let vertex = |row: u32, j: u32| {
        let (upper, step) = (row / (steps + 1), row % (steps + 1));
        let ((c, s), quarter) = around(j);
        let (cos, sin) = turn(f64::from(upper * steps + step), 4 * steps);
        let normal = DVec3::new(sin * c, -cos, -sin * s);
        let corner = DVec3::new(
            if quarter == 0 || quarter == 3 { max.x } else { min.x },
            if upper == 0 { min.y } else { max.y },
            if quarter < 2 { min.z } else { max.z },
        );
        let uv = DVec2::new(f64::from(j) / f64::from(columns), f64::from(row) / f64::from(2 * steps + 1));
        Vertex { position: corner + normal * radius, normal, uv }
    };
    let mut grid = Grid::new(columns);
    let mut last = grid.ring(|j| vertex(0, j));
    for row in 1..2 * (steps + 1) {
        let next = grid.ring(|j| vertex(row, j));
        grid.sew(last, next);
        last = next;
    }
    let mut mesh = grid.finish();
    // At the poles a whole quarter is one point.
    let positions = &mesh.positions;
    mesh.indices.retain(|t| {
        let [a, b, c] = t.map(|v| positions[v as usize]);
        a != b && b != c && c != a
    });
    let top = (2 * steps + 1) * (columns + 1);
    let [a, b, c, d] = [0, 1, 2, 3].map(|quarter| quarter * (steps + 1));
    mesh.indices.extend([[a, d, c], [a, c, b]]);
    mesh.indices.extend([[top + a, top + b, top + c], [top + a, top + c, top + d]]);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn sound(mesh: &TriangleMesh, volume: f64, area: f64) {
        mesh.validate().unwrap();
        assert!(mesh.is_closed());
        assert!((mesh.signed_volume() / volume - 1.0).abs() < 2e-3, "{} {volume}", mesh.signed_volume());
        assert!((mesh.area() / area - 1.0).abs() < 2e-3, "{} {area}", mesh.area());
        for (i, t) in mesh.indices.iter().enumerate() {
            let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
            let n = (b - a).cross(c - a);
            assert!(n.length() > 0.0, "triangle {i} has no area");
            for &v in t {
                let cosine = mesh.normals[v as usize].as_dvec3().dot(n.normalize());
                assert!(cosine > 0.9, "triangle {i}: {cosine}");
            }
        }
    }

    #[test]
    fn solids_have_their_volume_and_area() {
        let (r, h) = (0.5, 2.0);
        sound(&solid_cylinder(0.5, 2.0, 256), PI * r * r * h, 2.0 * PI * r * (r + h));
        let slope = |top: f64| PI * (r + top) * ((r - top).powi(2) + h * h).sqrt();
        sound(&frustum(0.5, 0.0, 2.0, 256), PI * r * r * h / 3.0, PI * r * r + slope(0.0));
        let volume = PI * h / 3.0 * (r * r + r * 0.25 + 0.0625);
        sound(&frustum(0.5, 0.25, 2.0, 256), volume, PI * (r * r + 0.0625) + slope(0.25));
        let volume = PI * r * r * (h + 4.0 / 3.0 * r);
        sound(&capsule(0.5, 2.0, 256), volume, 2.0 * PI * r * h + 4.0 * PI * r * r);
        assert!(!open_frustum(0.5, 0.25, 2.0, 64).is_closed());
        assert!((open_frustum(0.5, 0.25, 2.0, 512).area() / slope(0.25) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_rounded_box_has_steiners_volume() {
        // The parallel body of a box a·b·c: V + S r + π (a + b + c) r² + 4π/3 r³ (Steiner 1840).
        let (min, max, r) = (Vec3::new(-1.0, 0.0, 2.0), Vec3::new(1.0, 1.5, 3.0), 0.2);
        let [a, b, c] = [2.0 - 2.0 * r, 1.5 - 2.0 * r, 1.0 - 2.0 * r];
        let faces = 2.0 * (a * b + b * c + c * a);
        let volume = a * b * c + faces * r + PI * (a + b + c) * r * r + 4.0 / 3.0 * PI * r.powi(3);
        let area = faces + 2.0 * PI * (a + b + c) * r + 4.0 * PI * r * r;
        let mesh = rounded_box(min, max, r as f32, 24);
        sound(&mesh, volume, area);
        assert!((mesh.bounds().min - min).length() < 1e-6 && (mesh.bounds().max - max).length() < 1e-6);
        for steps in [1, 2, 3] {
            let coarse = rounded_box(min, max, 0.2, steps);
            coarse.validate().unwrap();
            assert!(coarse.is_closed(), "{steps}");
        }
    }
}
