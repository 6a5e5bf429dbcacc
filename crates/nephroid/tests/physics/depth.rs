//! `max_depth` counts scattering events, alike in all integrators: in the furnace, depth d gives Le·(1 + ρ + … + ρᵈ).

use nephroid::Layer;

use crate::support::*;

const ALBEDO: f64 = 0.7;

fn partial_sum(depth: u32) -> f64 {
    (0..=depth as i32).map(|k| ALBEDO.powi(k)).sum()
}

#[test]
fn depths_are_partial_sums_of_the_furnace() {
    let camera = look([0.2, 0.1, 0.3], [-0.4, 0.3, -1.0], 80.0);
    let mut desc = scene_of(camera, 8, vec![furnace(1.0, ALBEDO as f32)]);
    for depth in [0, 1, 2, 3] {
        desc.render.max_depth = Some(depth);
        let expected = partial_sum(depth);
        let path = brightness(&desc, PATH, 16, 8);
        assert_mean(&format!("path, depth {depth}"), &path, expected, 1e-5);
        for final_gather in [0, 4] {
            desc.photon_map.final_gather = final_gather;
            let map = brightness(&desc, PHOTON_MAP, 16, 2);
            assert_mean(&format!("photon_map, {final_gather} rays, depth {depth}"), &map, expected, 1e-5);
        }
    }
}

/// A depth is neither one more nor one less: the sums above tell them apart.
#[test]
fn partial_sums_differ_by_more_than_the_check_allows() {
    for depth in 0..3 {
        assert!(partial_sum(depth + 1) / partial_sum(depth) > PLANTED.powi(2));
    }
}

#[test]
fn depth_1_is_direct_light_alone_and_equal_in_both_integrators() {
    let objects = vec![
        nephroid::desc::Object::new(ground(0.0, 3.0), grey(0.6)),
        nephroid::desc::Object::new(sphere([0.6, 0.5, 0.0], 0.5), grey(0.6)),
        nephroid::desc::Object::new(sphere([-0.6, 0.5, 0.0], 0.5), nephroid::desc::Material::dielectric(1.5)),
        lamp(disk([0.0, 3.0, 0.0], [0.0, -1.0, 0.0], 1.0), 4.0),
    ];
    let mut desc = scene_of(look([0.0, 2.0, 4.0], [0.0, 0.4, 0.0], 40.0), 32, objects);
    desc.render.max_depth = Some(1);
    for integrator in [PATH, PHOTON_MAP] {
        let rest = runs(&desc, integrator, 1, 2, |f| mean(f, Layer::Indirect) + mean(f, Layer::Caustic));
        assert_eq!(rest, [0.0]);
    }
    let (path, map) = (brightness(&desc, PATH, 16, 12), brightness(&desc, PHOTON_MAP, 16, 12));
    assert_same("depth 1", &map, &path, 0.0);
}
