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
