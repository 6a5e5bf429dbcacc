//! A closed room of 100 000 triangles: no ray gets out, on either path.

use super::*;

/// A sphere over the faces of a cube, each side cut into n × n squares; its surface is wrinkled.
fn room(n: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut index = std::collections::HashMap::new();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for side in 0..6 {
        let mut vertex = |i: usize, j: usize| {
            let steps = |k: usize| 2 * k as i64 - n as i64;
            let far = if side % 2 == 0 { n as i64 } else { -(n as i64) };
            let mut key = [steps(i), steps(j), far];
            key.rotate_right(side / 2);
            *index.entry(key).or_insert_with(|| {
                let p = Vec3::from_array(key.map(|k| k as f32 / n as f32));
                let wrinkle = 1.0 + 0.1 * (p.x * 37.0).sin() * (p.y * 41.0).sin() * (p.z * 29.0).cos();
                positions.push(p * Vec3::new(3.0, 2.0, 1.5) * wrinkle);
                positions.len() as u32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n {
                let (a, b, c, d) = (vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    (positions, triangles)
}

fn rays(positions: &[Vec3], triangles: &[[u32; 3]], count: usize) -> Vec<Ray> {
    let mut u = Numbers::new(5);
    (0..count)
        .map(|i| {
            let origin = u.point() * if i % 2 == 0 { 0.5 } else { 0.0 };
            let triangle = triangles[(u.next() * triangles.len() as f32) as usize % triangles.len()];
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            let target = match i / 2 % 4 {
                0 => a,
                1 => 0.5 * (a + b),
                2 => a + (c - a) * u.next(),
                _ => origin + u.point() + Vec3::splat(1e-3),
            };
            // Along the axes, too.
            let direction = if i % 97 == 0 { [Vec3::X, -Vec3::Y, Vec3::Z][i % 3] } else { target - origin };
            Ray::new(origin, direction)
        })
        .collect()
}

#[test]
fn not_one_ray_is_lost() {
    let (positions, triangles) = room(92);
    assert!(triangles.len() > 100_000);
    let mut geometry = Geometry::new();
    geometry.add_triangles(&positions, &triangles);
    let bvh = Bvh::build(geometry);
    let rays = rays(&positions, &triangles, 200_000);
    let hits: Vec<_> = rays.iter().map(|r| bvh.closest(r)).collect();
    assert_eq!(hits.iter().filter(|h| h.is_none()).count(), 0);
    assert_eq!(rays.iter().filter(|r| !bvh.occluded(r)).count(), 0);
    let bits = |h: &Option<Hit>| h.map(|h| (h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.geom, h.prim));
    let bvh = portable(bvh);
    for (ray, hit) in rays.iter().zip(&hits).step_by(2) {
        assert_eq!(bits(&bvh.closest(ray)), bits(hit));
    }
}

/// The same bytes in memory, whoever builds them.
#[test]
fn trees_do_not_depend_on_threads() {
    let (positions, triangles) = room(92);
    let build = |threads| {
        let workers = par::Workers::new(threads).unwrap();
        let mut geometry = Geometry::new();
        geometry.add_triangles(&positions, &triangles);
        for i in 0..100 {
            geometry.add_sphere(positions[i * 50], 0.01);
        }
        let bvh = workers.run(|| Bvh::build(geometry));
        (format!("{:?} {:?}", bvh.nodes, bvh.spheres), format!("{:?}", bvh.packs), bvh.ids)
    };
    let one = build(1);
    for threads in [2, 3, 7] {
        assert!(one == build(threads), "{threads}");
    }
}
