//! The photon map against brute force, and its storage.

mod common;

use color::Lanes;
use math::Vec3;
use nephroid_photons::{FLATNESS, Kernel, MIN_NORMAL_COSINE, Photon, PhotonFlags, PhotonMap, Query, Scratch};
use proptest::prelude::*;
use sampling::{Domain, Sampler, warp};

/// Photons about a bumpy plane, with normals all over the sphere but mostly up.
fn cloud(seed: u64, count: usize) -> Vec<Photon> {
    let mut s = Sampler::new(seed, 0, Domain::Other, 0);
    let mut one = |_| {
        let [u, v] = s.next_2d();
        let up = warp::cosine_hemisphere(s.next_2d());
        let normal = if s.next_1d() < 0.2 { -up } else { up };
        let w = warp::cosine_hemisphere(s.next_2d());
        Photon {
            position: Vec3::new(u, v, 0.2 * s.next_1d()),
            direction: if w.dot(normal) < 0.0 { -w } else { w },
            normal,
            power: Lanes::rgb(s.next_1d(), s.next_1d(), s.next_1d()),
            depth: s.next_u32() as u8,
            flags: PhotonFlags(s.next_u32() as u8),
        }
    };
    (0..count).map(&mut one).collect()
}

/// n_p·n_x, and the least radius that accepts the photon, by the definitions in double precision.
fn acceptance(photon: &Photon, query: &Query) -> (f64, f64) {
    let (n_p, n_x) = (photon.normal.as_dvec3(), query.normal.as_dvec3());
    let d = photon.position.as_dvec3() - query.position.as_dvec3();
    let height = 0.5 * d.dot(n_p + n_x).abs();
    (n_p.dot(n_x), d.length().max(height / f64::from(FLATNESS)))
}

proptest! {
    #![proptest_config(common::cases(200))]

    #[test]
    fn gathers_equal_brute_force(
        seed in 0u64..1000,
        count in 0usize..1500,
        place in [0f32..1.0, 0f32..1.0, 0f32..0.2],
        toward in [0f32..1.0, 0f32..1.0],
        radius in 0.01f32..1.5,
        k in 2usize..400,
    ) {
        let map = PhotonMap::build(cloud(seed, count));
        let normal = warp::cosine_hemisphere(toward);
        let query = Query { position: Vec3::from(place), normal, radius, kernel: Kernel::Cone };
        let reaches: Vec<(f64, f64)> =
            (0..map.len() as u32).map(|slot| acceptance(&map.photon(slot), &query)).collect();
        let mut expected: Vec<(f64, u32)> = (0u32..)
            .zip(&reaches)
            .filter(|(_, (cosine, reach))| *cosine >= f64::from(MIN_NORMAL_COSINE) && *reach <= f64::from(radius))
            .map(|(slot, (_, reach))| (*reach, slot))
            .collect();
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Where rounding decides, single and double precision may differ: no such case.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-5 * b;
        prop_assume!(reaches.iter().all(|r| !near(r.0, f64::from(MIN_NORMAL_COSINE))));
        prop_assume!(reaches.iter().all(|r| !near(r.1, f64::from(radius))));
        prop_assume!(k > expected.len() || !near(expected[k - 2].0, expected[k - 1].0));
        let mut sorted: Vec<u32> = expected.iter().map(|a| a.1).collect();
        sorted.sort_unstable();
        prop_assert_eq!(common::slots(&map, &query), sorted);

        let mut scratch = Scratch::new();
        let mut shown = Vec::new();
        let found = map.gather_knn(&query, k, &mut scratch, |p, w| shown.push((p.slot, w.to_bits())));
        prop_assert_eq!(found.count, shown.len());
        let (used, edge) = match expected.get(k - 1) {
            Some(&(edge, _)) => (k - 1, edge),
            None => (expected.len(), f64::from(radius)),
        };
        prop_assert!((f64::from(found.radius) - edge).abs() <= 1e-5 * edge, "{:?} {}", found, edge);
        let mut slots: Vec<u32> = shown.iter().map(|s| s.0).collect();
        slots.sort_unstable();
        let mut sorted: Vec<u32> = expected[..used].iter().map(|a| a.1).collect();
        sorted.sort_unstable();
        prop_assert_eq!(slots, sorted);

        for &(slot, weight) in &shown {
            let t = map.photon(slot).position.distance(query.position) / found.radius;
            let exact = query.kernel.value(t) / (found.radius * found.radius);
            let full = query.kernel.value(0.0) / (found.radius * found.radius);
            prop_assert!((f32::from_bits(weight) - exact).abs() <= 1e-4 * full);
        }
        let portable = map.clone().portable();
        let mut again = Vec::new();
        portable.gather_knn(&query, k, &mut scratch, |p, w| again.push((p.slot, w.to_bits())));
        prop_assert_eq!(shown, again, "portable = SIMD");
        prop_assert_eq!(common::slots(&portable, &query), common::slots(&map, &query));
    }
}

#[test]
fn photons_come_back_as_they_went_in() {
    let photons = cloud(1, 1000);
    let map = PhotonMap::build(photons.clone());
    for slot in 0..1000 {
        let p = map.photon(slot);
        let original = photons.iter().find(|o| o.position == p.position).unwrap();
        assert!((p.direction - original.direction).length() < 7e-5);
        assert!((p.normal - original.normal).length() < 7e-5);
        let rest = |p: &Photon| (p.power, p.depth, p.flags);
        assert_eq!(rest(&p), rest(original));
    }
    assert!(photons.iter().all(|p| map.bounds().contains(p.position)));
}

#[test]
fn at_most_40_bytes_a_photon() {
    let map = PhotonMap::build(cloud(2, 100_000));
    assert!(map.bytes_per_photon() <= 40.0, "{}", map.bytes_per_photon());
    assert_eq!(PhotonMap::build(Vec::new()).bytes_per_photon(), 0.0);
}

#[test]
fn unsound_photons_are_left_out_and_counted() {
    let mut photons = cloud(3, 500);
    photons[3].position.x = f32::INFINITY;
    photons[44].power = Lanes::splat(f32::NAN);
    photons[100].normal = Vec3::ZERO;
    let map = PhotonMap::build(photons);
    assert_eq!((map.len(), map.rejected()), (497, 3));
    let query = Query { position: Vec3::ZERO, normal: Vec3::Z, radius: 9.0, kernel: Kernel::Constant };
    map.gather(&query, |p, w| assert!(p.power.is_finite() && p.direction().is_finite() && w.is_finite()));
}

#[test]
fn the_map_does_not_depend_on_the_number_of_threads() {
    let photons = cloud(4, 60_000);
    let bytes = |threads| {
        let workers = par::Workers::new(threads).unwrap();
        let map = workers.run(|| PhotonMap::build(photons.clone()));
        let mut scratch = Scratch::new();
        let mut bits = Vec::new();
        for i in 0..40 {
            let position = map.photon(i * 1000).position;
            let query = Query { position, normal: Vec3::Z, radius: 0.1, kernel: Kernel::Silverman };
            map.gather(&query, |p, w| bits.extend([p.slot, w.to_bits(), p.direction().x.to_bits()]));
            map.gather_knn(&query, 60, &mut scratch, |p, w| bits.extend([p.slot, w.to_bits()]));
        }
        bits.extend((0..map.len() as u32).map(|slot| map.photon(slot).power.0.x.to_bits()));
        bits
    };
    let one = bytes(1);
    for threads in [2, 3, 7] {
        assert!(bytes(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_million_photons_in_one_point_give_a_finite_estimate() {
    let photons = vec![common::photon(Vec3::new(1.0, 2.0, 3.0), Vec3::Z, 1e-6); 1_000_000];
    let map = PhotonMap::build(photons);
    let position = Vec3::new(1.0, 2.0, 3.0);
    let query = Query { position, normal: Vec3::Z, radius: 0.5, kernel: Kernel::Constant };
    let mut power = 0.0;
    let found = map.gather_knn(&query, 50, &mut Scratch::new(), |p, w| {
        assert!(w.is_finite());
        power += f64::from(p.power.0.x);
    });
    assert_eq!(found.count, 1_000_000, "all within the least radius, {}", found.radius);
    assert!((power - 1.0).abs() < 1e-3 && found.radius > 0.0);
}

#[test]
fn radii_without_an_area_find_nothing() {
    let map = PhotonMap::build(vec![common::photon(Vec3::ZERO, Vec3::Z, 1.0); 100]);
    for radius in [0.0, -1.0, 1e-25, f32::NAN] {
        let query = Query { position: Vec3::ZERO, normal: Vec3::Z, radius, kernel: Kernel::Constant };
        assert_eq!(map.gather(&query, |_, _| panic!("found")), 0);
        assert_eq!(map.gather_knn(&query, 10, &mut Scratch::new(), |_, _| panic!("found")).count, 0);
    }
    let query = Query { position: Vec3::ZERO, normal: Vec3::Z, radius: f32::INFINITY, kernel: Kernel::Cone };
    assert_eq!(map.gather(&query, |_, w| assert_eq!(w, 0.0)), 100);
}
