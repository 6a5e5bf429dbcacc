//! The inside of a uniformly emitting, reflecting sphere: photon density is exact at any radius, since the cap of
//! chord r has the area πr². L = Le/(1 − ρ).

mod common;

use common::{assert_agree, photon, slots};
use math::{Frame, Vec3};
use nephroid_photons::{Kernel, Photon, PhotonFlags, PhotonMap, Query, Scratch};
use sampling::{Domain, Sampler, warp};

const RADIUS: f32 = 2.0;
const EMITTED: f64 = 1.5;
const ALBEDO: f32 = 0.5;

/// A pass of photons, by the walk itself: cosine emission from everywhere, diffuse reflection, roulette at ρ.
fn photons(pass: u64, paths: usize) -> Vec<Photon> {
    let area = 4.0 * std::f64::consts::PI * f64::from(RADIUS * RADIUS);
    let power = color::Lanes::splat((std::f64::consts::PI * EMITTED * area / paths as f64) as f32);
    let mut photons = Vec::new();
    for path in 0..paths {
        let mut s = Sampler::new(5, pass, Domain::GlobalPhoton, path as u64);
        let mut outward = warp::sphere(s.next_2d());
        for depth in 0..=255 {
            let w = Frame::from_z(-outward).to_world(warp::cosine_hemisphere(s.next_2d()));
            outward = (outward - w * (2.0 * w.dot(outward))).normalize();
            let normal = -outward;
            let flags = PhotonFlags::NONE;
            photons.push(Photon { position: outward * RADIUS, direction: -w, normal, power, depth, flags });
            if s.next_1d() >= ALBEDO {
                break;
            }
        }
    }
    photons
}

/// Le + Σ f·Φ·k(d/r)/r², of a BSDF that reflects on the side of the normal only, averaged over places on the sphere.
fn radiance(
    map: &PhotonMap,
    places: u32,
    gather: impl Fn(&PhotonMap, &Query, &mut dyn FnMut(Vec3, f32, f32)),
) -> f64 {
    let mut sum = 0.0;
    for i in 0..places {
        let outward = warp::sphere([(i as f32 + 0.5) / places as f32, i as f32 * 0.618_034 % 1.0]);
        let (position, normal) = (outward * RADIUS, -outward);
        let query = Query { position, normal, radius: 0.0, kernel: Kernel::Constant };
        gather(map, &query, &mut |wi, power, weight| {
            let f = if wi.dot(normal) > 0.0 { f64::from(ALBEDO) / std::f64::consts::PI } else { 0.0 };
            sum += f * f64::from(power) * f64::from(weight);
        });
    }
    EMITTED + sum / f64::from(places)
}

fn passes() -> Vec<PhotonMap> {
    (0..24).map(|pass| PhotonMap::build(photons(pass, 20_000))).collect()
}

#[test]
fn sphere_furnace_at_four_radii_and_with_every_kernel() {
    let exact = EMITTED / (1.0 - f64::from(ALBEDO));
    let maps = passes();
    for (fraction, places) in [(0.1, 60), (0.3, 24), (0.6, 10), (0.95, 6)] {
        for kernel in Kernel::ALL {
            let gather = |map: &PhotonMap, q: &Query, f: &mut dyn FnMut(Vec3, f32, f32)| {
                let q = Query { radius: fraction * RADIUS, kernel, ..*q };
                map.gather(&q, |p, w| f(p.direction(), p.power.0.x, w));
            };
            let samples: Vec<f64> = maps.iter().map(|map| radiance(map, places, gather)).collect();
            assert_agree(&samples, exact, &format!("radius {fraction} R, {kernel:?}"));
        }
    }
    for (k, places) in [(30, 120), (300, 40), (3000, 10)] {
        let gather = |map: &PhotonMap, q: &Query, f: &mut dyn FnMut(Vec3, f32, f32)| {
            let q = Query { radius: RADIUS, kernel: Kernel::Epanechnikov, ..*q };
            map.gather_knn(&q, k, &mut Scratch::new(), |p, w| f(p.direction(), p.power.0.x, w));
        };
        let samples: Vec<f64> = maps.iter().map(|map| radiance(map, places, gather)).collect();
        assert_agree(&samples, exact, &format!("{k} nearest"));
    }
}

#[test]
fn a_sphere_loses_no_photon_of_the_cap_to_its_own_curvature() {
    for concave in [-1.0, 1.0] {
        let mut s = Sampler::new(6, 0, Domain::Other, 0);
        let on_sphere = |w: Vec3| photon(w * RADIUS, w * concave, 1.0);
        let map = PhotonMap::build((0..20_000).map(|_| on_sphere(warp::sphere(s.next_2d()))).collect());
        for fraction in [0.05, 0.3, 0.6, 0.9, 0.99] {
            let radius = fraction * RADIUS;
            let (position, normal) = (Vec3::Z * RADIUS, Vec3::Z * concave);
            let query = Query { position, normal, radius, kernel: Kernel::Constant };
            let near = (0..20_000).filter(|&i| map.photon(i).position.distance(position) <= radius).count();
            assert_eq!(slots(&map, &query).len(), near, "radius {fraction} R");
        }
    }
}
