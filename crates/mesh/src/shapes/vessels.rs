//! Vessels for caustics. Lengths are in metres; all stand on y = 0 about the y axis.

use math::{DVec2, DVec3};

use super::clamped;
use super::grid::{Grid, Vertex, turn};
use super::lathe::revolve;
use super::outline::{Pen, Station, offset};
use crate::TriangleMesh;

/// Height at which a disk of radius 0.0410 m is the surface of the coffee in [`coffee_cup`].
pub const COFFEE_LEVEL: f32 = 0.060;
/// Height of the surface of [`wine`].
pub const WINE_LEVEL: f32 = BOWL_WIDEST as f32;

/// A ring about the y axis: a band from y = 0 to `height` between the radii `inner` and `outer`, with edges rounded by
/// `fillet` (brought below half of width and of height). Closed; the inner wall is a cylinder with exact normals.
pub fn band(inner: f32, outer: f32, height: f32, fillet: f32, segments: u32) -> TriangleMesh {
    let (a, b, h) = (f64::from(inner), f64::from(outer), f64::from(height));
    let f = f64::from(fillet).clamp(0.0, 0.499 * (b - a).min(h).max(0.0));
    // A sharp edge is a fillet of one step and no radius.
    let round = |pen: Pen, x: f64, y: f64| if f > 0.0 { pen.arc(x, y, 1.0, 6) } else { pen };
    let pen = Pen::at(a + f, 0.0).line(b - f, 0.0);
    let pen = round(pen, b - f, f).line(b, h - f);
    let pen = round(pen, b - f, h - f).line(a + f, h);
    let pen = round(pen, a + f, h - f).line(a, f);
    revolve(&round(pen, a + f, f).closed(), clamped(segments))
}

/// A metal ring for a finger: [`band`] of 18 mm inner and 21 mm outer diameter, 6 mm high.
pub fn ring(segments: u32) -> TriangleMesh {
    band(0.009, 0.0105, 0.006, 0.0005, segments)
}

/// A coffee cup of solid china, 86.75 mm high: outer radius 43.5 mm, the inside a cylinder of radius 40 mm from
/// y = 16 mm to 85 mm over a round fillet and a flat floor at 6 mm. The handle, towards +x, is a closed shell of the same
/// mesh whose ends lie within the wall (given 16 segments or more). Both shells are closed and oriented outward.
pub fn coffee_cup(segments: u32) -> TriangleMesh {
    let outline = Pen::at(0.0, 0.003)
        .line(0.030, 0.003)
        .line(0.030, 0.0015)
        .arc(0.0315, 0.0015, 2.0, 8)
        .curve([0.033, 0.004], [0.0435, 0.004], [0.0435, 0.022], 16)
        .line(0.0435, 0.085)
        .arc(0.04175, 0.085, 2.0, 12)
        .line(0.040, 0.016)
        .arc(0.030, 0.016, -1.0, 12)
        .line(0.0, 0.006)
        .finish();
    let path = Pen::at(0.0418, 0.070).curve([0.086, 0.070], [0.086, 0.026], [0.0418, 0.026], 48).finish();
    revolve(&outline, clamped(segments)).merged(&tube(&path, 0.0035, 0.005, 24))
}

/// A closed tube along a path in the plane z = 0, of elliptic section: half axis `within` in that plane, `across` along
/// z. Its ends are flat.
fn tube(path: &[Station], within: f64, across: f64, sides: u32) -> TriangleMesh {
    let mut grid = Grid::new(sides);
    let last = path.len() - 1;
    let at = |station: usize, j: f64, radius: f64, end: f64| {
        let s = path[station];
        let (cos, sin) = turn(j, sides);
        // To the left of the direction of travel; from there columns turn to +z, so that the outside is outside.
        let left = s.leaves.perp().extend(0.0);
        let normal = if end == 0.0 {
            left * (cos * across) + DVec3::Z * (sin * within)
        } else {
            s.leaves.extend(0.0) * end
        };
        Vertex {
            position: s.point.extend(0.0) + (left * (cos * within) + DVec3::Z * (sin * across)) * radius,
            normal,
            uv: DVec2::new(j / f64::from(sides), station as f64 / last as f64),
        }
    };
    let pole = grid.pole(|j| at(0, j, 0.0, -1.0));
    let edge = grid.ring(|j| at(0, f64::from(j), 1.0, -1.0));
    grid.sew(pole, edge);
    let mut row = grid.ring(|j| at(0, f64::from(j), 1.0, 0.0));
    for i in 1..=last {
        let next = grid.ring(|j| at(i, f64::from(j), 1.0, 0.0));
        grid.sew(row, next);
        row = next;
    }
    let edge = grid.ring(|j| at(last, f64::from(j), 1.0, 1.0));
    let pole = grid.pole(|j| at(last, j, 0.0, 1.0));
    grid.sew(edge, pole);
    grid.finish()
}

/// Thickness of the wine glass's wall above the widest place.
const WALL: f64 = 0.0012;
/// How far the wine reaches into the wall.
const OVERLAP: f64 = 0.5 * WALL;
/// Height of the bowl's widest place.
const BOWL_WIDEST: f64 = 0.140;

/// The inside of the bowl from the axis to the widest place.
fn bowl() -> Vec<Station> {
    Pen::at(0.0, 0.094).curve([0.020, 0.094], [0.040, 0.112], [0.040, BOWL_WIDEST], 32).finish()
}

/// The inside of the bowl from the widest place to the rim.
fn upper_bowl() -> Vec<Station> {
    Pen::at(0.040, BOWL_WIDEST).curve([0.040, 0.165], [0.034, 0.190], [0.032, 0.2094], 32).finish()
}

/// A wine glass of solid glass, 210 mm high: bowl of inner radius 40 mm at y = 140 mm and 32 mm at the rim, wall 1.2 mm,
/// stem of radius 4 mm, foot of radius 34 mm, domed below so that it stands on its edge. Closed, oriented outward.
pub fn wine_glass(segments: u32) -> TriangleMesh {
    let inside = super::outline::reversed(&upper_bowl());
    let outside = offset(&upper_bowl(), WALL);
    // The rim is half a circle from the outer to the inner wall.
    let top = upper_bowl()[32].point;
    let middle = (top + outside[32].point) * 0.5;
    let outline = Pen::at(0.0, 0.0012)
        .curve([0.015, 0.0012], [0.025, 0.0], [0.033, 0.0], 16)
        .arc(0.033, 0.001, 2.0, 10)
        .curve([0.020, 0.002], [0.004, 0.006], [0.004, 0.020], 24)
        .line(0.004, 0.082)
        .curve([0.004, 0.090], [0.040 + WALL, 0.100], [0.040 + WALL, BOWL_WIDEST], 40)
        .follow(&outside)
        .arc(middle.x, middle.y, 2.0, 8)
        .follow(&inside)
        .follow(&super::outline::reversed(&bowl()))
        .finish();
    revolve(&outline, clamped(segments))
}

/// The wine in [`wine_glass`], filled to the widest place: a closed solid, oriented outward. It reaches 0.6 mm into the
/// glass, half of the wall, so that no film of air lies between: for nested dielectrics the glass takes precedence.
pub fn wine(segments: u32) -> TriangleMesh {
    let wetted = offset(&bowl(), OVERLAP);
    let outline = Pen::at(0.0, wetted[0].point.y).follow(&wetted).line(0.0, BOWL_WIDEST).finish();
    revolve(&outline, clamped(segments))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn sound(mesh: &TriangleMesh, least_cosine: f64) {
        mesh.validate().unwrap();
        assert!(mesh.is_closed());
        assert!(mesh.signed_volume() > 0.0);
        for (i, t) in mesh.indices.iter().enumerate() {
            let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
            let n = (b - a).cross(c - a);
            assert!(n.length() > 0.0, "triangle {i} has no area");
            for &v in t {
                let cosine = mesh.normals[v as usize].as_dvec3().dot(n.normalize());
                assert!(cosine > least_cosine, "triangle {i}: {a} {b} {c} normal off by {}", cosine.acos());
            }
        }
    }

    #[test]
    fn all_are_closed_solids() {
        for segments in [3, 48] {
            let least = if segments == 3 { 0.0 } else { 0.95 };
            for mesh in [ring(segments), coffee_cup(segments), wine_glass(segments), wine(segments)] {
                sound(&mesh, least);
            }
        }
        sound(&band(1.0, 2.0, 3.0, 0.0, 48), 0.95);
        let volume = band(1.0, 2.0, 3.0, 0.0, 360).signed_volume();
        assert!((volume / (9.0 * PI) - 1.0).abs() < 1e-3, "{volume}");
        // A filled glass of this size holds about 150 ml below its widest place.
        assert!((0.000_13..0.000_17).contains(&wine(96).signed_volume()), "{}", wine(96).signed_volume());
        assert_eq!(wine_glass(8).bounds().min.y, 0.0);
    }

    #[test]
    fn the_handle_ends_within_the_wall() {
        let cup = coffee_cup(64);
        // The caps' vertices; the wall has none with these normals and this x.
        let caps: Vec<_> = (0..cup.positions.len())
            .filter(|&i| {
                cup.normals[i].distance(math::Vec3::NEG_X) < 1e-6
                    && (cup.positions[i].x - 0.0418).abs() < 1e-6
            })
            .map(|i| cup.positions[i])
            .collect();
        assert_eq!(caps.len(), 2 * (24 + 25));
        for p in caps {
            let radius = p.x.hypot(p.z);
            assert!((0.0405..0.0430).contains(&radius) && (0.022..0.085).contains(&p.y), "{p}");
        }
    }

    #[test]
    fn the_wine_lies_within_bowl_and_wall() {
        let inside = bowl();
        let wetted = offset(&inside, OVERLAP);
        let outside = Pen::at(0.004, 0.082)
            .curve([0.004, 0.090], [0.040 + WALL, 0.100], [0.040 + WALL, BOWL_WIDEST], 400)
            .finish();
        for (i, w) in inside.iter().zip(&wetted) {
            assert!((i.point.distance(w.point) - OVERLAP).abs() < 1e-12);
            let clearance = outside.iter().map(|o| o.point.distance(w.point)).fold(f64::INFINITY, f64::min);
            assert!(clearance > 0.9 * OVERLAP, "{}: {clearance}", w.point);
        }
    }

    #[test]
    fn mirrors_have_exact_normals() {
        // Inner walls of cup and ring: flat strips of cylinders.
        for (mesh, radius, from, to) in
            [(coffee_cup(64), 0.040, 0.0161, 0.0849), (ring(64), 0.009, 0.0006, 0.0054)]
        {
            let mut found = 0;
            for (i, t) in mesh.indices.iter().enumerate() {
                let corners = mesh.corners(i);
                let on_wall = corners.iter().all(|p| (p.x.hypot(p.z) - radius).abs() < 1e-6);
                let spans = corners.iter().any(|p| p.y < from) && corners.iter().any(|p| p.y > to);
                if on_wall && spans {
                    found += 1;
                    for &v in t {
                        let (p, n) = (mesh.positions[v as usize], mesh.normals[v as usize]);
                        assert!(n.y.abs() < 1e-7 && (n.x + p.x / radius).abs() < 1e-5, "{p} {n}");
                    }
                }
            }
            assert_eq!(found, 128);
        }
    }
}
