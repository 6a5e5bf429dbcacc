use math::{DVec2, DVec3};

use super::Profile;
use super::grid::{Grid, Vertex, turn};
use super::outline::{Station, reversed};
use crate::assemble::MAX_COUNT;
use crate::{MeshError, TriangleMesh};

/// A surface of revolution about the y axis, in `segments` equal sectors.
///
/// Where the profile encloses a solid, closed or with both ends on the axis, the surface is watertight and oriented
/// outward whichever way the profile runs. Else its outside is to the right of the direction of travel: away from the
/// axis where the profile runs up. Normals are those of the curve itself, broken at corners; u goes once round, counter-clockwise
/// seen from above, from the +x axis; v follows the profile's length. Vertices lie on the surface, flat triangles within it.
///
/// # Errors
/// Where the profile is malformed (see [`Profile`]), there are fewer than 3 segments, or too many vertices.
pub fn lathe(profile: &Profile, segments: u32) -> Result<TriangleMesh, MeshError> {
    let stations = profile.stations()?;
    if segments < 3 || 4 * stations.len() as u64 * (u64::from(segments) + 1) > MAX_COUNT as u64 {
        return Err(MeshError::whole(
            format!("{segments} segments round a profile of {} points", stations.len()),
            "give 3 segments or more, and fewer than a billion vertices",
        ));
    }
    let solid = profile.closed || (stations[0].point.x == 0.0 && stations[stations.len() - 1].point.x == 0.0);
    if solid && volume(&stations) < 0.0 {
        return Ok(revolve(&reversed(&stations), segments));
    }
    Ok(revolve(&stations, segments))
}

/// Signed volume of revolution over 2π/3, frustum by frustum.
fn volume(stations: &[Station]) -> f64 {
    stations
        .windows(2)
        .map(|w| {
            let (a, b) = (w[0].point, w[1].point);
            (b.y - a.y) * (a.x * a.x + a.x * b.x + b.x * b.x)
        })
        .sum()
}

/// Revolves stations; the outside is to the right of the direction of travel.
pub(super) fn revolve(stations: &[Station], segments: u32) -> TriangleMesh {
    let mut grid = Grid::new(segments);
    let total: f64 = stations.windows(2).map(|w| w[0].point.distance(w[1].point)).sum();
    let mut along = 0.0;
    let mut last = None;
    for (i, s) in stations.iter().enumerate() {
        if i > 0 {
            along += stations[i - 1].point.distance(s.point) / total;
        }
        let vertex = |j: f64, tangent: DVec2| {
            let (cos, sin) = turn(j, segments);
            let normal = -tangent.perp();
            Vertex {
                position: DVec3::new(s.point.x * cos, s.point.y, -s.point.x * sin),
                normal: DVec3::new(normal.x * cos, normal.y, -normal.x * sin),
                uv: DVec2::new(j / f64::from(segments), along),
            }
        };
        let row = |grid: &mut Grid, tangent: DVec2| {
            if s.point.x == 0.0 {
                grid.pole(|j| vertex(j, tangent))
            } else {
                grid.ring(|j| vertex(f64::from(j), tangent))
            }
        };
        if i == 0 {
            last = Some(row(&mut grid, s.leaves));
            continue;
        }
        let arrival = row(&mut grid, s.arrives);
        if let Some(last) = last {
            grid.sew(last, arrival);
        }
        last =
            Some(if s.is_smooth() || i == stations.len() - 1 { arrival } else { row(&mut grid, s.leaves) });
    }
    grid.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::{Vec2, Vec3};
    use std::f64::consts::{PI, TAU};

    fn profile(points: &[[f32; 2]]) -> Profile {
        Profile::polyline(points.iter().map(|&p| p.into()).collect())
    }

    fn sound(mesh: &TriangleMesh) {
        mesh.validate().unwrap();
        for (i, t) in mesh.indices.iter().enumerate() {
            let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
            let n = (b - a).cross(c - a);
            assert!(n.length() > 0.0, "triangle {i} has no area");
            for &v in t {
                let cosine = mesh.normals[v as usize].as_dvec3().dot(n.normalize());
                assert!(cosine > 0.5, "triangle {i}: normal off by {}", cosine.acos());
            }
        }
    }

    #[test]
    fn a_solid_is_closed_and_oriented_outward_either_way() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]];
        let mut backwards = points;
        backwards.reverse();
        for points in [points, backwards] {
            let mesh = lathe(&profile(&points), 64).unwrap();
            sound(&mesh);
            assert!(mesh.is_closed());
            // A prism over the inscribed 64-gon.
            let exact = 2.0 * 0.5 * 64.0 * (TAU / 64.0).sin();
            assert!((mesh.signed_volume() / exact - 1.0).abs() < 1e-6, "{} {exact}", mesh.signed_volume());
            let wall = mesh.normals.iter().filter(|n| n.y == 0.0).count();
            assert_eq!(wall, 2 * 65);
        }
    }

    #[test]
    fn a_ring_is_closed_and_outward() {
        for points in [
            [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]],
            [[1.0, 0.0], [1.0, 1.0], [2.0, 1.0], [2.0, 0.0]],
        ] {
            let ring = Profile { closed: true, ..profile(&points) };
            let mesh = lathe(&ring, 128).unwrap();
            sound(&mesh);
            assert!(mesh.is_closed());
            assert!((mesh.signed_volume() / (3.0 * PI) - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_sampled_arc_becomes_a_sphere() {
        for (n, steps) in [(32, 1), (6, 16)] {
            let points = (0..=n).map(|i| {
                let (sin, cos) = (PI * f64::from(i) / f64::from(n)).sin_cos();
                // The ends exactly on the axis.
                Vec2::new(if i % n == 0 { 0.0 } else { sin as f32 }, -cos as f32)
            });
            let mesh =
                lathe(&Profile { points: points.collect(), closed: false, steps, crease: 0.6 }, 96).unwrap();
            sound(&mesh);
            assert!(mesh.is_closed());
            for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
                assert!((p.length() - 1.0).abs() < 3e-3, "{p}");
                assert!(n.angle_between(*p) < 1.5e-2, "{p} {n}");
            }
        }
    }

    #[test]
    fn cones_have_slanted_normals_at_the_tip() {
        let mesh = lathe(&profile(&[[1.0, 0.0], [0.0, 1.0]]), 16).unwrap();
        sound(&mesh);
        assert!(!mesh.is_closed());
        assert!(mesh.normals.iter().all(|n| (n.y - 0.5f32.sqrt()).abs() < 1e-6));
    }

    #[test]
    fn a_spline_keeps_its_points_and_its_corners() {
        let points = [[0.0, 0.0], [1.0, 0.2], [1.5, 1.0], [1.2, 2.0], [1.2, 2.0], [0.5, 2.1], [0.0, 2.6]];
        let vase = Profile { steps: 7, ..profile(&points) };
        let stations = vase.stations().unwrap();
        assert_eq!(stations.len(), 5 * 7 + 1);
        for p in points {
            let p = Vec2::from(p).as_dvec2();
            assert!(stations.iter().any(|s| s.point.distance(p) < 1e-12), "{p}");
        }
        assert!(!stations[21].is_smooth());
        let mesh = lathe(&vase, 24).unwrap();
        mesh.validate().unwrap();
        assert!(mesh.is_closed());
        assert!(mesh.signed_volume() > 0.0);
    }

    #[test]
    fn bad_profiles_are_refused() {
        let p = |points: &[[f32; 2]]| lathe(&profile(points), 16);
        assert!(p(&[]).is_err());
        assert!(p(&[[1.0, 0.0], [1.0, 0.0]]).is_err());
        assert!(p(&[[0.0, 0.0], [0.0, 1.0]]).is_err());
        assert!(p(&[[1.0, 0.0], [f32::NAN, 1.0]]).is_err());
        assert!(p(&[[-1.0, 0.0], [1.0, 1.0]]).is_err());
        assert!(p(&[[1.0, 0.0], [0.0, 1.0], [1.0, 2.0]]).is_err());
        let good = profile(&[[1.0, 0.0], [1.0, 1.0], [2.0, 0.5]]);
        assert!(lathe(&good, 2).is_err());
        assert!(lathe(&good, u32::MAX).is_err());
        assert!(lathe(&Profile { steps: 0, ..good.clone() }, 16).is_err());
        assert!(lathe(&Profile { crease: f32::NAN, ..good.clone() }, 16).is_err());
        assert!(lathe(&Profile { closed: true, points: good.points[..2].to_vec(), ..good }, 16).is_err());
        assert_eq!(Vec3::ZERO, lathe(&profile(&[[0.0, 0.0], [1.0, 0.0]]), 3).unwrap().positions[0]);
    }
}
