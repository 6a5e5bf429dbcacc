//! Irradiance worked out in advance at some of the photons (Christensen 1999, "Faster photon map global
//! illumination"): a gather ray then needs one neighbour instead of k.

use math::{Frame, PI, Ray, Vec3};
use photons::{FLATNESS, Kernel, MIN_NORMAL_COSINE, Photon, PhotonMap, Query, Scratch};
use sampling::{Domain, Streams};
use scene::Scene;
use transport::{Lookup, irradiance};

use crate::maps::StoredMap;

/// Irradiance is worked out at every so many photons.
const STRIDE: usize = 4;
/// Points of the disc at which it is asked whether there is surface.
const PROBES: u32 = 16;
/// Least share of the disc that is taken to be surface: less is more likely a missed probe.
const LEAST_SHARE: f32 = 0.2;

/// A map of irradiance samples: photons whose power is the irradiance at their place.
pub(crate) fn irradiance_samples(scene: &Scene, stored: &StoredMap, lookup: &Lookup, seed: u64) -> PhotonMap {
    let map = &stored.map;
    let streams = Streams::new(seed, 0, Domain::Other);
    let chunks = par::map_chunks(map.len().div_ceil(STRIDE), 1024, |range| {
        let mut scratch = Scratch::new();
        range
            .map(|i| {
                let mut sample = map.photon((i * STRIDE) as u32);
                let query = Query {
                    position: sample.position,
                    normal: sample.normal,
                    radius: lookup.max_radius,
                    kernel: lookup.kernel,
                };
                let (e, found) = irradiance(map, &query, lookup.knn, &mut scratch);
                let turn = streams.path(i as u64).next_1d();
                sample.power = e / covered(scene, &sample, found.radius, lookup.kernel, turn);
                sample.direction = sample.normal;
                sample
            })
            .collect::<Vec<_>>()
    });
    PhotonMap::build(chunks.concat())
}

/// Share of the kernel's disc that lies on the surface. At the edge of a wall part of the disc reaches beyond it,
/// where no photon can be, and the estimate would be too dark by that part.
///
/// Probes on a spiral of equal areas (Vogel 1979) are reached from the middle, at the height up to which photons
/// count, and look down for surface of a compatible normal.
fn covered(scene: &Scene, at: &Photon, radius: f32, kernel: Kernel, turn: f32) -> f32 {
    let frame = Frame::from_z(at.normal);
    let height = FLATNESS * radius;
    let lifted = at.position + at.normal * height;
    let golden_angle = PI * (3.0 - 5f32.sqrt());
    let (mut on, mut all) = (0.0, 0.0);
    for i in 0..PROBES {
        let t = ((i as f32 + 0.5) / PROBES as f32).sqrt();
        let (sin, cos) = (i as f32 * golden_angle + turn * 2.0 * PI).sin_cos();
        let step = frame.to_world(Vec3::new(cos, sin, 0.0)) * (t * radius);
        let weight = kernel.value(t);
        all += weight;
        let down = Ray { origin: lifted + step, direction: at.normal * (-2.0 * height), t_max: 1.0 };
        let blocked = scene.occluded(&Ray { origin: lifted, direction: step, t_max: 1.0 });
        if !blocked
            && scene.intersect_possible(&down).is_some_and(|s| s.ng.dot(at.normal).abs() >= MIN_NORMAL_COSINE)
        {
            on += weight;
        }
    }
    (on / all).max(LEAST_SHARE)
}
