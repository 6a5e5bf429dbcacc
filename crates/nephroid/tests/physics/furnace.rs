//! The inside of a uniformly emitting, reflecting sphere: L = Le/(1 − ρ) at every point in every direction, exactly, for
//! photon density at any radius too (a cap of chord r has the area πr²).

use crate::support::*;
use nephroid::SceneDesc;
use nephroid::desc::PhotonFilter;

fn inside(albedo: f32) -> SceneDesc {
    scene_of(look([0.2, 0.1, 0.3], [-0.4, 0.3, -1.0], 80.0), 8, vec![furnace(1.0, albedo)])
}

const ALBEDOS: [f32; 3] = [0.3, 0.5, 0.8];

#[test]
fn sphere_furnace_by_path() {
    for albedo in ALBEDOS {
        let m = brightness(&inside(albedo), PATH, 16, 64);
        assert_mean(&format!("path, albedo {albedo}"), &m, 1.0 / (1.0 - f64::from(albedo)), 0.0);
    }
}

#[test]
fn sphere_furnace_by_final_gather() {
    for albedo in ALBEDOS {
        let mut desc = inside(albedo);
        desc.film.size = [6; 2];
        let m = brightness(&desc, PHOTON_MAP, 16, 2);
        assert_mean(&format!("final gather, albedo {albedo}"), &m, 1.0 / (1.0 - f64::from(albedo)), 0.0);
    }
}

/// More neighbours than there are photons: the radius is the one given. The maps hold what has been scattered at least once.
#[test]
fn sphere_furnace_by_direct_lookup_at_four_radii() {
    let filters =
        [PhotonFilter::Constant, PhotonFilter::Cone, PhotonFilter::Epanechnikov, PhotonFilter::Constant];
    for (radius, filter) in [0.1, 0.2, 0.4, 0.8].into_iter().zip(filters) {
        for albedo in [0.5, 0.8] {
            let mut desc = inside(albedo);
            desc.film.size = [5; 2];
            desc.photon_map.photons = 10_000;
            desc.photon_map.final_gather = 0;
            desc.photon_map.knn = 1_000_000;
            desc.photon_map.radius = Some(radius);
            desc.photon_map.filter = filter;
            let m = brightness(&desc, PHOTON_MAP, 24, 1);
            let expected = 1.0 / (1.0 - f64::from(albedo));
            assert_mean(&format!("radius {radius}, albedo {albedo}"), &m, expected, 0.0);
        }
    }
}

/// The same with the k nearest, whose radius is what it comes to.
#[test]
fn sphere_furnace_by_direct_lookup_of_the_k_nearest() {
    for knn in [10, 100] {
        let mut desc = inside(0.8);
        desc.photon_map.final_gather = 0;
        desc.photon_map.knn = knn;
        let m = brightness(&desc, PHOTON_MAP, 24, 4);
        assert_mean(&format!("{knn} neighbours"), &m, 5.0, 0.0);
    }
}

/// Clear solids of any index take nothing and add nothing where the same light comes from everywhere.
#[test]
fn clear_gems_and_water_are_not_seen_in_a_white_furnace() {
    use nephroid::desc::{Brilliant, Material, Object, Shape, WaterSurface};
    let gem = Shape::RoundBrilliant(Brilliant {
        center: [0.0; 3],
        axis: [0.3, 1.0, 0.2],
        diameter: 1.4,
        table: 0.53,
        crown_degrees: 34.5,
        pavilion_degrees: 40.75,
        girdle: 0.02,
        star_length: 0.5,
        lower_half_length: 0.75,
        culet: 0.0,
    });
    let water = Shape::WaterSurface(WaterSurface {
        center: [0.0, 0.2, 0.0],
        size: [1.2, 1.2],
        depth: Some(0.5),
        resolution: 64,
        wind_speed: 3.0,
        wind_degrees: 30.0,
        fetch: 50.0,
        wave_height: Some(0.02),
        waves: 64,
        seed: 3,
        time: 0.0,
    });
    for (name, shape) in [("gem", gem), ("water", water)] {
        for ior in [1.0, 1.5] {
            let objects = vec![furnace(4.0, 0.5), Object::new(shape.clone(), Material::dielectric(ior))];
            let desc = scene_of(look([0.0, 0.6, 2.0], [0.0; 3], 40.0), 12, objects);
            assert_mean(&format!("{name}, index {ior}"), &brightness(&desc, PATH, 16, 32), 2.0, 2e-4);
        }
    }
}
