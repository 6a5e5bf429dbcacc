//! Searches against brute force: same points, same order among ties, on every kind of degenerate cloud.

mod common;

use math::Vec3;
use nephroid_photons::{Hit, KdTree, Scratch};
use proptest::prelude::*;

/// Random, gridded, collinear, coplanar and coinciding points.
fn clouds() -> impl Strategy<Value = Vec<Vec3>> {
    let cloud = |point: BoxedStrategy<[f32; 3]>| prop::collection::vec(point, 0..2500);
    let real = || -1f32..1f32;
    let grid = || (-4i8..=4).prop_map(|i| f32::from(i) * 0.25);
    prop_oneof![
        cloud([real(), real(), real()].boxed()),
        cloud([grid(), grid(), grid()].boxed()),
        cloud(real().prop_map(|x| [x, 2.0 * x, -x]).boxed()),
        cloud((real(), grid()).prop_map(|(x, y)| [x, y, 0.5]).boxed()),
        cloud(prop_oneof![Just([0.25; 3]), Just([-0.5, 0.0, 0.5])].boxed()),
    ]
    .prop_map(|points| points.into_iter().map(Vec3::from).collect())
}

fn centers() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        [-1.2f32..1.2, -1.2f32..1.2, -1.2f32..1.2].prop_map(Vec3::from),
        [-5i8..=5, -5i8..=5, -5i8..=5].prop_map(|p| Vec3::from(p.map(|i| f32::from(i) * 0.25))),
    ]
}

/// All points within `radius`, nearest first.
fn brute_force(tree: &KdTree, center: Vec3, radius: f32) -> Vec<Hit> {
    let distance2 = |slot| {
        let d = tree.position(slot) - center;
        (d.x * d.x + d.y * d.y) + d.z * d.z
    };
    let mut hits: Vec<Hit> =
        (0..tree.len() as u32).map(|slot| Hit { slot, distance2: distance2(slot) }).collect();
    hits.retain(|h| h.distance2 <= radius * radius);
    sort(&mut hits);
    hits
}

fn sort(hits: &mut [Hit]) {
    hits.sort_by(|a, b| a.distance2.total_cmp(&b.distance2).then(a.slot.cmp(&b.slot)));
}

proptest! {
    #![proptest_config(common::cases(300))]

    #[test]
    fn searches_equal_brute_force(
        points in clouds(),
        center in centers(),
        radius in prop_oneof![0f32..2.5, Just(0.0), Just(0.25), Just(f32::INFINITY)],
        k in 1usize..2800,
    ) {
        let (tree, order) = KdTree::build(&points);
        let mut seen = order.clone();
        seen.sort_unstable();
        prop_assert_eq!(seen, (0..points.len() as u32).collect::<Vec<_>>());
        for (slot, &index) in order.iter().enumerate() {
            prop_assert_eq!(tree.position(slot as u32), points[index as usize]);
        }
        let expected = brute_force(&tree, center, radius);
        let portable = tree.clone().portable();
        let mut scratch = Scratch::new();

        let within = |tree: &KdTree| {
            let mut hits = Vec::new();
            tree.within(center, radius, |h| hits.push(h));
            hits
        };
        let found = within(&tree);
        prop_assert_eq!(&found, &within(&portable), "portable = SIMD, in order");
        let mut sorted = found;
        sort(&mut sorted);
        prop_assert_eq!(&sorted, &expected);

        let nearest = tree.nearest(center, k, radius, &mut scratch);
        let (kth, found): (_, Vec<Hit>) = (nearest.kth(), nearest.hits().collect());
        prop_assert_eq!(kth, expected.get(k - 1).copied());
        if kth.is_some() {
            prop_assert_eq!(found.last().copied(), kth);
        }
        let mut sorted = found.clone();
        sort(&mut sorted);
        prop_assert_eq!(&sorted[..], &expected[..k.min(expected.len())]);
        let again: Vec<Hit> = portable.nearest(center, k, radius, &mut scratch).hits().collect();
        prop_assert_eq!(found, again, "portable = SIMD, in order");
    }
}

#[test]
fn empty_trees_and_senseless_queries_find_nothing() {
    let mut scratch = Scratch::new();
    let (empty, order) = KdTree::build(&[]);
    assert!(empty.is_empty() && order.is_empty() && empty.bounds().is_empty());
    assert!(empty.nearest(Vec3::ZERO, 5, f32::INFINITY, &mut scratch).is_empty());
    empty.within(Vec3::ZERO, f32::INFINITY, |_| panic!("found in an empty tree"));
    let (tree, _) = KdTree::build(&[Vec3::ZERO; 200]);
    assert!(tree.nearest(Vec3::ZERO, 0, 1.0, &mut scratch).is_empty());
    for (center, radius) in [(Vec3::ZERO, -1.0), (Vec3::ZERO, f32::NAN), (Vec3::NAN, 1.0)] {
        assert!(tree.nearest(center, 5, radius, &mut scratch).is_empty());
        tree.within(center, radius, |_| panic!("found at {center} within {radius}"));
    }
    assert_eq!(tree.nearest(Vec3::ZERO, usize::MAX, 1.0, &mut scratch).len(), 200);
}

#[test]
fn points_that_are_not_finite_are_left_out() {
    let mut points = vec![Vec3::ONE; 130];
    points[7].x = f32::NAN;
    points[100].y = f32::NEG_INFINITY;
    let (tree, order) = KdTree::build(&points);
    assert_eq!((tree.len(), order.len()), (128, 128));
    assert!(!order.contains(&7) && !order.contains(&100));
    let mut hits = 0;
    tree.within(Vec3::ONE, f32::INFINITY, |_| hits += 1);
    assert_eq!(hits, 128, "unused places of a leaf are never found");
}

#[test]
fn huge_coordinates_do_not_break_the_search() {
    let points: Vec<Vec3> = (0..300).map(|i| Vec3::splat((i as f32 - 150.0) * 2e36)).collect();
    let (tree, _) = KdTree::build(&points);
    let mut scratch = Scratch::new();
    assert_eq!(tree.nearest(Vec3::ZERO, 1, f32::INFINITY, &mut scratch).kth().unwrap().distance2, 0.0);
    let mut hits = 0;
    tree.within(Vec3::ZERO, 1e18, |_| hits += 1);
    assert_eq!(hits, 1);
}

#[test]
fn a_million_equal_points_neither_hang_nor_overflow() {
    let mut points = vec![Vec3::new(0.1, 0.2, 0.3); 1_000_000];
    points.push(Vec3::ONE);
    let (tree, _) = KdTree::build(&points);
    let mut scratch = Scratch::new();
    for k in [1, 100, 5000] {
        let nearest = tree.nearest(points[0], k, 1.0, &mut scratch);
        assert_eq!((nearest.len(), nearest.kth().unwrap().distance2), (k, 0.0));
    }
    let mut hits = 0;
    tree.within(points[0], 0.0, |_| hits += 1);
    assert_eq!(hits, 1_000_000);
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 20) as f32 / 4096.0 // many ties
    };
    let points: Vec<Vec3> = (0..50_000).map(|_| Vec3::new(next(), next(), 0.0)).collect();
    let orders: Vec<Vec<u32>> = [1, 2, 3, 7]
        .into_iter()
        .map(|threads| par::Workers::new(threads).unwrap().run(|| KdTree::build(&points).1))
        .collect();
    assert!(orders.iter().all(|o| *o == orders[0]));
}
