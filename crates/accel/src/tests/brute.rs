//! Trees against lists of single primitives, and primitives against textbook formulas in f64.

use super::*;

#[derive(Clone, Debug)]
enum Shape {
    Mesh(Vec<[Vec3; 3]>),
    Sphere(Vec3, f32),
    Disk(Vec3, Vec3, f32),
}

#[derive(Clone, Debug)]
struct Case {
    shapes: Vec<Shape>,
    instances: Vec<Affine3A>,
    rays: Vec<Ray>,
}

/// Coordinates either anywhere or on a coarse grid, where ties, edges and planes are met all the time.
fn point(grid: bool) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-4.0f32..4.0).prop_map(move |p| {
        let p = Vec3::from_array(p);
        if grid { p.round() } else { p }
    })
}

fn shape(grid: bool) -> impl Strategy<Value = Shape> {
    prop_oneof![
        4 => prop::collection::vec(prop::array::uniform3(point(grid)), 1..30).prop_map(Shape::Mesh),
        1 => (point(grid), 0.1f32..2.0).prop_map(|(c, r)| Shape::Sphere(c, r)),
        1 => (point(grid), point(grid), 0.1f32..2.0).prop_map(|(c, n, r)| Shape::Disk(c, n, r)),
    ]
}

fn case() -> impl Strategy<Value = Case> {
    any::<bool>().prop_flat_map(|grid| {
        let placed = (point(grid), point(grid), 0.3f32..2.0).prop_map(move |(t, axis, s)| {
            let turn = if grid { math::Quat::IDENTITY } else { math::Quat::from_scaled_axis(axis) };
            Affine3A::from_scale_rotation_translation(Vec3::new(s, 1.0, 1.5), turn, t)
        });
        let ray = (point(grid), point(grid), prop_oneof![Just(f32::INFINITY), 0.1f32..4.0])
            .prop_map(|(origin, direction, t_max)| Ray { origin, direction, t_max });
        (
            prop::collection::vec(shape(grid), 0..8),
            prop::collection::vec(placed, 0..5),
            prop::collection::vec(ray, 30),
        )
            .prop_map(|(shapes, instances, rays)| Case { shapes, instances, rays })
    })
}

fn add(geometry: &mut Geometry, shape: &Shape) -> u32 {
    match shape {
        Shape::Mesh(triangles) => {
            let indices: Vec<_> =
                (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            geometry.add_triangles(&triangles.concat(), &indices)
        }
        &Shape::Sphere(c, r) => geometry.add_sphere(c, r),
        &Shape::Disk(c, n, r) => geometry.add_disk(c, n, r),
    }
}

/// A tree for each primitive, with the ids that it has in the whole.
fn singles(shapes: &[Shape]) -> Vec<(Bvh, u32, u32)> {
    let mut out = Vec::new();
    for (geom, shape) in shapes.iter().enumerate() {
        let parts = match shape {
            Shape::Mesh(triangles) => triangles.iter().map(|&t| Shape::Mesh(vec![t])).collect(),
            other => vec![other.clone()],
        };
        for (prim, part) in parts.iter().enumerate() {
            let mut geometry = Geometry::new();
            add(&mut geometry, part);
            out.push((Bvh::build(geometry), geom as u32, prim as u32));
        }
    }
    out
}

/// The first of all hits, by t and then by ids.
fn first(hits: impl Iterator<Item = Hit>) -> Option<Hit> {
    hits.min_by(|a, b| {
        let key = |h: &Hit| (h.instance, h.geom, h.prim);
        a.t.total_cmp(&b.t).then(key(a).cmp(&key(b)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn tree_is_list_and_portable_is_avx2(case in case()) {
        let mut inner = Geometry::new();
        case.shapes.iter().for_each(|s| { add(&mut inner, s); });
        let inner = Arc::new(Bvh::build(inner));
        let mut outer = Geometry::new();
        case.shapes.iter().for_each(|s| { add(&mut outer, s); });
        let mut placed = Vec::new();
        for (i, &m) in case.instances.iter().enumerate() {
            let transform = Transform::new(m).unwrap();
            let geom = outer.add_instance(inner.clone(), transform).unwrap();
            prop_assert_eq!(geom as usize, case.shapes.len() + i);
            placed.push((geom, transform));
        }
        let outer = Bvh::build(outer);
        let singles = singles(&case.shapes);
        let mut expected = Vec::new();
        for ray in &case.rays {
            let own = singles.iter().filter_map(|(bvh, geom, prim)| {
                bvh.closest(ray).map(|h| Hit { geom: *geom, prim: *prim, ..h })
            });
            let instanced = placed.iter().flat_map(|(instance, transform)| {
                let m = *transform.inverse_matrix();
                let ray = Ray {
                    origin: m.transform_point3(ray.origin),
                    direction: m.transform_vector3(ray.direction),
                    t_max: ray.t_max,
                };
                singles.iter().filter_map(move |(bvh, geom, prim)| {
                    bvh.closest(&ray).map(|h| Hit { geom: *geom, prim: *prim, instance: *instance, ..h })
                })
            });
            let hit = first(own.chain(instanced));
            prop_assert_eq!(outer.closest(ray), hit);
            prop_assert_eq!(outer.occluded(ray), hit.is_some());
            expected.push(hit);
        }
        let outer = portable(outer);
        for (ray, hit) in case.rays.iter().zip(expected) {
            prop_assert_eq!(outer.closest(ray), hit);
            prop_assert_eq!(outer.occluded(ray), hit.is_some());
        }
    }

    /// Möller & Trumbore 1997 in f64, where it is sure of its answer.
    #[test]
    fn triangle_is_textbook(corners in prop::array::uniform3(point(false)), origin in point(false), to in point(false)) {
        let mut geometry = Geometry::new();
        add(&mut geometry, &Shape::Mesh(vec![corners]));
        let ray = Ray { origin, direction: to - origin, t_max: 3.0 };
        let hit = Bvh::build(geometry).closest(&ray);
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (o, d) = (origin.as_dvec3(), ray.direction.as_dvec3());
        let (e1, e2) = (b - a, c - a);
        let p = d.cross(e2);
        let det = e1.dot(p);
        prop_assume!(det.abs() > 1e-3);
        let u = (o - a).dot(p) / det;
        let q = (o - a).cross(e1);
        let (v, t) = (d.dot(q) / det, e2.dot(q) / det);
        let margin = u.min(v).min(1.0 - u - v).min(t).min(3.0 - t);
        if margin > 1e-3 {
            let hit = hit.unwrap();
            prop_assert!((f64::from(hit.t) - t).abs() < 1e-3 * t.max(1.0), "{hit:?} {t}");
            prop_assert!((f64::from(hit.u) - u).abs() < 1e-3 && (f64::from(hit.v) - v).abs() < 1e-3);
            prop_assert_eq!((hit.geom, hit.prim, hit.instance), (0, 0, NO_INSTANCE));
        } else if margin < -1e-3 {
            prop_assert_eq!(hit, None);
        }
    }

    /// Wherever the sphere is and however large, the hit lies on it as well as f32 can say, and a ray from its
    /// surface inward meets the far side.
    #[test]
    fn sphere_hits_lie_on_the_sphere(
        center in point(false), far in 0.0f32..5.0, size in -4.0f32..6.0, from in point(false), inside in point(false),
    ) {
        let radius = 10f32.powf(size);
        let center = center * 10f32.powf(far);
        let sphere = Sphere { center, radius };
        let target = center.as_dvec3() + 0.2 * f64::from(radius) * inside.as_dvec3() / 4.0;
        let origin = (center.as_dvec3() + from.as_dvec3().normalize_or_zero() * (3.0 * f64::from(radius))).as_vec3();
        let ray = Ray::new(origin, (target - origin.as_dvec3()).as_vec3());
        prop_assume!(ray.direction.is_normalized() || ray.direction.length() > 1e-6);
        // Rounding of the origin itself may spoil the aim where the sphere is tiny and far.
        prop_assume!(center.length() < 1e4 * radius);
        let t = sphere.intersect(&ray).unwrap();
        let at = |t: f64| origin.as_dvec3() + ray.direction.as_dvec3() * t;
        let error = |p: math::DVec3| (p.distance(center.as_dvec3()) - f64::from(radius)).abs();
        let ulp = 1e-7 * f64::from(t) * ray.direction.as_dvec3().length();
        prop_assert!(error(at(f64::from(t))) <= 2.0 * ulp, "{} {ulp}", error(at(f64::from(t))));
        // On from there, a little inward: the far side.
        let t_in = f64::from(t) + 1e-3;
        let inner = Ray::new(at(t_in).as_vec3(), ray.direction);
        if inner.origin.as_dvec3().distance(center.as_dvec3()) < 0.9999 * f64::from(radius) {
            let t = f64::from(sphere.intersect(&inner).unwrap());
            let exit = inner.origin.as_dvec3() + inner.direction.as_dvec3() * t;
            prop_assert!(error(exit) <= 1e-6 * f64::from(radius), "{}", error(exit));
        }
    }
}

#[test]
fn planted_hits() {
    let mut geometry = Geometry::new();
    let ball = geometry.add_sphere(Vec3::new(0.0, 0.0, 1.0), 0.5);
    let plate = geometry.add_disk(Vec3::ZERO, Vec3::Z * 3.0, 2.0);
    let quad = [Vec3::new(-5.0, -5.0, -1.0), Vec3::new(5.0, -5.0, -1.0), Vec3::new(5.0, 5.0, -1.0)];
    let mesh = geometry.add_triangles(&quad, &[[0, 1, 2]]);
    let bvh = Bvh::build(geometry);
    let down = |x: f32, y: f32| bvh.closest(&Ray::new(Vec3::new(x, y, 5.0), Vec3::new(0.0, 0.0, -2.0)));
    assert_eq!(down(0.0, 0.0).map(|h| (h.geom, h.t)), Some((ball, 1.75)));
    assert_eq!(down(1.0, 0.0).map(|h| (h.geom, h.t)), Some((plate, 2.5)));
    let hit = down(4.0, -4.0).unwrap();
    assert_eq!((hit.geom, hit.t, hit.prim), (mesh, 3.0, 0));
    assert!(
        (quad[0] * (1.0 - hit.u - hit.v) + quad[1] * hit.u + quad[2] * hit.v)
            .distance(Vec3::new(4.0, -4.0, -1.0))
            < 1e-5
    );
    assert_eq!(down(-4.0, 4.0), None);
    let up = Ray { t_max: 0.4999, ..Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::Y) };
    assert_eq!((bvh.closest(&up), bvh.occluded(&up)), (None, false), "inside the ball, too short");
    assert!(bvh.occluded(&Ray { t_max: 0.5001, ..up }), "its inside is hit");
    assert_eq!(bvh.closest(&Ray { t_max: 0.5, ..up }), None, "the end is exclusive");
    assert!((1.5..1.500_001).contains(&bvh.bounds().max.z), "{:?}", bvh.bounds());
}

#[test]
fn disk_hits() {
    let disk = Disk { center: Vec3::X, radius: 1.0, normal: math::DVec3::Y };
    let down = |x: f32| disk.intersect(&Ray::new(Vec3::new(x, 2.0, 0.0), -Vec3::Y));
    assert_eq!((down(0.0), down(2.0), down(2.001), down(-0.001)), (Some(2.0), Some(2.0), None, None));
    assert_eq!(disk.intersect(&Ray::new(Vec3::ZERO, Vec3::X)), None, "in its plane");
}

#[test]
fn instances_nest_one_level_only() {
    let mut leaf = Geometry::new();
    leaf.add_sphere(Vec3::ZERO, 1.0);
    let leaf = Arc::new(Bvh::build(leaf));
    let mut middle = Geometry::new();
    assert_eq!(middle.add_instance(leaf, Transform::IDENTITY), Ok(0));
    let middle = Arc::new(Bvh::build(middle));
    let mut outer = Geometry::new();
    assert_eq!(outer.add_instance(middle, Transform::IDENTITY), Err(NestedInstance));
    assert_eq!(outer.add_sphere(Vec3::ZERO, 1.0), 0);
}
