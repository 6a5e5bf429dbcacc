//! The rules of the radiance estimate, each by the trap that it closes.

mod common;

use common::{assert_agree, photon, slots};
use math::Vec3;
use nephroid_photons::{FLATNESS, Kernel, Photon, PhotonMap, Query, Scratch};
use sampling::{Domain, Sampler};

/// Photons uniform on the square [−1, 1]² at height z, of total power 4: one watt on the unit of area.
fn sheet(path: u64, count: usize, z: f32, normal: Vec3) -> Vec<Photon> {
    let mut s = Sampler::new(11, 0, Domain::Other, path);
    let place = |[u, v]: [f32; 2]| Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, z);
    (0..count).map(|_| photon(place(s.next_2d()), normal, 4.0 / count as f32)).collect()
}

fn query(position: Vec3, radius: f32, kernel: Kernel) -> Query {
    Query { position, normal: Vec3::Z, radius, kernel }
}

/// Irradiance at 25 places, averaged over each of many independent sheets.
fn sheets(estimate: impl Fn(&PhotonMap, Vec3) -> f64) -> Vec<f64> {
    let one = |path| {
        let map = PhotonMap::build(sheet(path, 4000, 0.0, Vec3::Z));
        let place = |i: i32| Vec3::new((i % 5 - 2) as f32 * 0.25, (i / 5 - 2) as f32 * 0.25, 0.0);
        (0..25).map(|i| estimate(&map, place(i))).sum::<f64>() / 25.0
    };
    (0..160).map(one).collect()
}

fn irradiance(map: &PhotonMap, query: &Query) -> f64 {
    let mut sum = 0.0;
    map.gather(query, |p, w| sum += f64::from(p.power.0.x) * f64::from(w));
    sum
}

#[test]
fn a_uniform_plane_is_unbiased_for_every_kernel() {
    for kernel in Kernel::ALL {
        let fixed = sheets(|map, p| irradiance(map, &query(p, 0.18, kernel)));
        assert_agree(&fixed, 1.0, &format!("fixed radius, {kernel:?}"));
    }
}

fn knn(map: &PhotonMap, k: usize, query: &Query) -> f64 {
    let mut sum = 0.0;
    map.gather_knn(query, k, &mut Scratch::new(), |p, w| sum += f64::from(p.power.0.x) * f64::from(w));
    sum
}

#[test]
fn knn_without_the_kth_photon_has_no_k_over_k_minus_1_bias() {
    for kernel in Kernel::ALL {
        let samples = sheets(|map, p| knn(map, 100, &query(p, 0.9, kernel)));
        assert_agree(&samples, 1.0, &format!("100 nearest, {kernel:?}"));
    }
    // With few photons the trap is wide: 5/4 at k = 5.
    let few: Vec<f64> = (0..40)
        .map(|path| {
            let map = PhotonMap::build(sheet(1000 + path, 40_000, 0.0, Vec3::Z));
            let place = |i: i32| Vec3::new((i % 30 - 15) as f32 * 0.06, (i / 30 - 15) as f32 * 0.06, 0.0);
            (0..900).map(|i| knn(&map, 5, &query(place(i), 0.9, Kernel::Constant))).sum::<f64>() / 900.0
        })
        .collect();
    assert_agree(&few, 1.0, "5 nearest");
}

#[test]
fn knn_that_the_greatest_radius_cuts_short_is_unbiased() {
    // On average 100 photons lie within 0.1784: about half of the queries find their k, half do not.
    let mut cut = std::cell::Cell::new(0);
    let samples = sheets(|map, p| {
        let q = query(p, 0.1784, Kernel::Epanechnikov);
        let mut sum = 0.0;
        let found = map.gather_knn(&q, 100, &mut Scratch::new(), |p, w| sum += f64::from(p.power.0.x * w));
        cut.set(cut.get() + usize::from(found.radius == q.radius));
        sum
    });
    assert!((1000..3000).contains(cut.get_mut()), "{cut:?} of 4000");
    assert_agree(&samples, 1.0, "k nearest or all");
}

#[test]
fn the_flux_is_not_weighted_by_another_cosine() {
    let mut photons = sheet(0, 4000, 0.0, Vec3::Z);
    let down = irradiance(&PhotonMap::build(photons.clone()), &query(Vec3::ZERO, 0.5, Kernel::Constant));
    photons.iter_mut().for_each(|p| p.direction = Vec3::new(0.8, 0.0, 0.6));
    let slanted = irradiance(&PhotonMap::build(photons), &query(Vec3::ZERO, 0.5, Kernel::Constant));
    assert_eq!(down, slanted);
}

#[test]
fn photons_of_the_opposite_side_do_not_count() {
    let map = PhotonMap::build(sheet(0, 1000, 0.0, -Vec3::Z));
    assert_eq!(slots(&map, &query(Vec3::ZERO, 2.0, Kernel::Constant)), []);
    let below = Query { normal: -Vec3::Z, ..query(Vec3::ZERO, 2.0, Kernel::Constant) };
    assert_eq!(slots(&map, &below).len(), 1000);
}

#[test]
fn photons_behind_a_thin_wall_neither_count_nor_shrink_the_radius() {
    // Mitsuba's issue 145: rejected photons had been counted among the k, which darkened or blurred the estimate.
    let front = sheet(0, 1000, 0.0, Vec3::Z);
    let mut both = front.clone();
    both.extend(sheet(1, 30_000, -1e-5, -Vec3::Z));
    let q = query(Vec3::new(0.1, 0.2, 0.0), 1.5, Kernel::Constant);
    let found = |photons| {
        let map = PhotonMap::build(photons);
        let mut powers = Vec::new();
        let n = map.gather_knn(&q, 50, &mut Scratch::new(), |p, _| powers.push(p.power.0.x.to_bits()));
        (n, powers)
    };
    let (one, powers) = found(both);
    assert_eq!(one, found(front).0);
    assert_eq!(one.count, 49);
    assert!(powers.iter().all(|&p| p == (4.0f32 / 1000.0).to_bits()));
}

#[test]
fn photons_round_a_corner_do_not_count() {
    let mut s = Sampler::new(12, 0, Domain::Other, 0);
    let mut photons = Vec::new();
    for _ in 0..1000 {
        let [u, v] = s.next_2d();
        photons.push(photon(Vec3::new(0.0, u - 0.5, v), Vec3::X, 1.0)); // a wall on the floor: concave corner
        photons.push(photon(Vec3::new(1.0, u - 0.5, -v), Vec3::X, 1.0)); // the floor's far edge: convex corner
    }
    let map = PhotonMap::build(photons);
    for x in [0.0, 0.01, 0.5, 0.99, 1.0] {
        let q = query(Vec3::new(x, 0.0, 0.0), 0.8, Kernel::Constant);
        assert_eq!(slots(&map, &q), []);
        let n = map.gather_knn(&q, 20, &mut Scratch::new(), |_, _| panic!("round the corner"));
        assert_eq!((n.count, n.radius), (0, 0.8));
    }
}

#[test]
fn across_a_blunt_edge_only_the_flattened_ellipsoid_counts() {
    // A face tilted by 50° (compatible normals) beyond the edge x = 0: at equal distances from the edge both
    // points lie on one arc; the farther from that, the higher the photon stands over the common surface.
    let (sin, cos) = 50f32.to_radians().sin_cos();
    let normal = Vec3::new(sin, 0.0, cos);
    let on_face = |b: f32| photon(Vec3::new(b * cos, 0.0, -b * sin), normal, 1.0);
    let map = PhotonMap::build(vec![on_face(0.1), on_face(0.8)]);
    let q = query(Vec3::new(-0.1, 0.0, 0.0), 1.0, Kernel::Constant);
    let found = slots(&map, &q);
    assert_eq!(found.len(), 1);
    assert!(map.photon(found[0]).position.length() < 0.2);
}

#[test]
fn photons_on_a_parallel_sheet_count_only_within_the_flattened_ellipsoid() {
    for (height, counts) in [(0.9 * FLATNESS, true), (1.1 * FLATNESS, false)] {
        for side in [-1.0, 1.0] {
            let map = PhotonMap::build(sheet(0, 1000, side * height * 0.5, Vec3::Z));
            let found = slots(&map, &query(Vec3::ZERO, 0.5, Kernel::Constant));
            assert_eq!(!found.is_empty(), counts, "{height} {side}");
        }
    }
    // A neighbourhood that does not reach the sheet is not shrunk by it.
    let floor = sheet(0, 2000, 0.0, Vec3::Z);
    let mut both = floor.clone();
    both.extend(sheet(1, 20_000, 0.05, Vec3::Z));
    let radius = |photons| {
        PhotonMap::build(photons)
            .gather_knn(&query(Vec3::ZERO, 1.0, Kernel::Cone), 50, &mut Scratch::new(), |_, _| ())
            .radius
    };
    assert_eq!(radius(both), radius(floor));
}
