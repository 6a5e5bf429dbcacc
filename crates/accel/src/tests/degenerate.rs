//! Input that nobody should send.

use super::*;

fn ray_down() -> Ray {
    Ray::new(Vec3::new(0.25, 0.25, 3.0), -Vec3::Z)
}

const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

#[test]
fn nothing() {
    let bvh = Bvh::build(Geometry::new());
    assert_eq!(bvh.closest(&ray_down()), None);
    assert!(!bvh.occluded(&ray_down()) && bvh.bounds().is_empty() && bvh.memory_bytes() == 0);
    let mut outer = Geometry::new();
    assert_eq!(outer.add_instance(Arc::new(bvh), Transform::IDENTITY), Ok(0));
    assert_eq!(Bvh::build(outer).closest(&ray_down()), None);
}

#[test]
fn what_cannot_be_hit_keeps_its_id() {
    let mut geometry = Geometry::new();
    let nan = [Vec3::ZERO, Vec3::new(f32::NAN, 0.0, 0.0), Vec3::Y, Vec3::INFINITY, Vec3::X];
    geometry.add_triangles(&nan, &[[0, 1, 2], [0, 2, 3], [0, 0, 2], [7, 1, 0], [u32::MAX; 3], [0, 4, 2]]);
    geometry.add_triangles(&[], &[]);
    geometry.add_sphere(Vec3::NAN, 1.0);
    geometry.add_sphere(Vec3::ZERO, -1.0);
    geometry.add_sphere(Vec3::ZERO, f32::NAN);
    geometry.add_disk(Vec3::ZERO, Vec3::ZERO, 1.0);
    assert_eq!(geometry.add_disk(Vec3::new(0.0, 0.0, -1.0), Vec3::Z, 1.0), 6);
    let bvh = Bvh::build(geometry);
    let hit = bvh.closest(&ray_down()).unwrap();
    assert_eq!((hit.t, hit.geom, hit.prim), (3.0, 0, 5));
    let below = Ray { origin: Vec3::new(0.25, 0.25, -0.5), ..ray_down() };
    assert_eq!(bvh.closest(&below).map(|h| (h.t, h.geom)), Some((0.5, 6)));
}

#[test]
fn slivers_and_giants() {
    let mut geometry = Geometry::new();
    let line = [Vec3::ZERO, Vec3::ONE, Vec3::splat(2.0), Vec3::splat(1e38), Vec3::new(-3e38, 3e38, 1e30)];
    geometry.add_triangles(&line, &[[0, 1, 2], [2, 1, 0], [0, 3, 4], [4, 3, 1]]);
    geometry.add_sphere(Vec3::ZERO, 3e38);
    geometry.add_sphere(Vec3::ZERO, 1e-38);
    geometry.add_triangles(&TRIANGLE, &[[0, 1, 2]]);
    let bvh = Bvh::build(geometry);
    assert_eq!(bvh.closest(&ray_down()).map(|h| (h.t, h.geom)), Some((3.0, 3)));
    let other = portable(bvh);
    assert_eq!(other.closest(&ray_down()).map(|h| (h.t, h.geom)), Some((3.0, 3)));
}

#[test]
fn unsound_rays_hit_nothing() {
    let mut geometry = Geometry::new();
    geometry.add_triangles(&TRIANGLE, &[[0, 1, 2]]);
    geometry.add_sphere(Vec3::ZERO, 1.0);
    let bvh = Bvh::build(geometry);
    let good = ray_down();
    for ray in [
        Ray { direction: Vec3::ZERO, ..good },
        Ray { direction: Vec3::new(f32::NAN, 0.0, -1.0), ..good },
        Ray { direction: Vec3::NEG_INFINITY, ..good },
        Ray { origin: Vec3::INFINITY, ..good },
        Ray { origin: Vec3::new(0.0, f32::NAN, 3.0), ..good },
        Ray { t_max: f32::NAN, ..good },
        Ray { t_max: 0.0, ..good },
        Ray { t_max: -1.0, ..good },
    ] {
        assert_eq!((bvh.closest(&ray), bvh.occluded(&ray)), (None, false), "{ray:?}");
    }
}

#[test]
fn a_million_equal_triangles() {
    let mut geometry = Geometry::new();
    geometry.add_triangles(&TRIANGLE, &vec![[0, 1, 2]; 1_000_000]);
    let bvh = Bvh::build(geometry);
    let hit = bvh.closest(&Ray { t_max: 3.5, ..ray_down() }).unwrap();
    assert_eq!((hit.t, hit.prim), (3.0, 0));
    assert!(bvh.occluded(&ray_down()));
}

/// Centres in geometric progression make the surface area heuristic cut off one by one.
#[test]
fn deep_trees_are_cut_off() {
    let mut geometry = Geometry::new();
    let mut x = 1e-35f32;
    while x < 1e18 {
        for k in 0..8 {
            let s = x * (1.0 + 0.01 * k as f32);
            geometry.add_triangles(&TRIANGLE.map(|p| p * s), &[[0, 1, 2]]);
            geometry.add_sphere(Vec3::splat(s), s);
        }
        x *= 1.3;
    }
    let bvh = Bvh::build(geometry);
    for i in 0..100 {
        let ray =
            Ray::new(Vec3::new(-1.0, 0.3, 10f32.powi(i % 20)), Vec3::new(1.0, 0.1 * (i / 10) as f32, -1.0));
        assert_eq!(bvh.closest(&ray).is_some(), bvh.occluded(&ray));
    }
}
