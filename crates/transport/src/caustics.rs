use std::ops::Range;

use bsdf::Lobes;
use photons::{Photon, PhotonFlags};
use sampling::{Domain, Sampler, Strata, Streams};
use scene::Scene;

use crate::photon::photon;
use crate::{EmittedPhoton, LightChain, Observer, PathEnd, Walk, emit_toward_targets_with};

/// A budget of weighted caustic photons.
#[derive(Clone, Copy, Debug)]
pub struct CausticJob {
    /// Paths emitted in the whole job.
    pub count: u64,
    /// Seed of the render.
    pub seed: u64,
    /// Index of the map.
    pub map_index: u64,
    /// Which numbers.
    pub domain: Domain,
    /// Scattering events on a whole path, at most; a photon needs one to be seen.
    pub max_depth: u32,
}

/// Photons of a range of a job, in index order.
#[derive(Clone, Debug, Default)]
pub struct CausticBatch {
    /// L S⁺ D, where they landed.
    pub photons: Vec<Photon>,
    /// [`LightChain::rivals`] of each photon.
    pub rivals: Vec<f32>,
    /// Paths that became non-finite: (index, scattering events before).
    pub nonfinite: Vec<(u64, u32)>,
}

/// Traces the caustic photons of a range of path indices: L S⁺ D, aimed at the specular objects. Points and directions
/// of emission fill their squares evenly over the paths of a map.
pub fn trace_caustics(scene: &Scene, job: &CausticJob, range: Range<u64>) -> CausticBatch {
    trace(scene, job, range, &mut ())
}

/// Traces one path of a job again, and shows it to an observer.
pub fn observe_caustic(
    scene: &Scene,
    job: &CausticJob,
    path: u64,
    observer: &mut impl Observer,
) -> CausticBatch {
    trace(scene, job, path..path + 1, observer)
}

#[inline]
fn trace(scene: &Scene, job: &CausticJob, range: Range<u64>, observer: &mut impl Observer) -> CausticBatch {
    let mut batch = CausticBatch::default();
    let streams = Streams::new(job.seed, job.map_index, job.domain);
    let mut shared = streams.path(u64::MAX);
    let key = u64::from(shared.next_u32()) << 32 | u64::from(shared.next_u32());
    for path in range {
        let strata = Strata::new(key, path);
        let [u_light, _] = strata.point(2);
        let emitted = emit_toward_targets_with(scene, u_light, strata.point(0), strata.point(1));
        let Some((EmittedPhoton { mut walk, .. }, start)) = emitted else { continue };
        walk.throughput *= 1.0 / job.count as f32;
        observer.started(&walk, start.light);
        let chain = LightChain::new(scene, start);
        let end = trace_one(walk, chain, job, path, &mut streams.path(path), &mut batch, observer);
        observer.ended(end);
    }
    batch
}

#[inline]
fn trace_one(
    mut walk: Walk<'_>,
    mut chain: LightChain,
    job: &CausticJob,
    path: u64,
    sampler: &mut Sampler,
    batch: &mut CausticBatch,
    observer: &mut impl Observer,
) -> PathEnd {
    let group = PhotonFlags::of_group(walk.scene().light_group(chain.light()));
    while let Some(vertex) = walk.next_vertex() {
        observer.reached(&walk, &vertex);
        if !walk.throughput.is_finite() {
            batch.nonfinite.push((path, walk.depth));
            return PathEnd::NonFinite;
        }
        chain.reach(&walk);
        let is_d = vertex.bsdf.has_diffuse();
        if is_d && walk.depth > 0 {
            let photon = photon(&walk, &vertex, PhotonFlags::CAUSTIC.with(group));
            observer.stored(&photon);
            batch.photons.push(photon);
            batch.rivals.push(chain.rivals(&vertex));
        }
        if walk.depth + 1 >= job.max_depth {
            return PathEnd::Depth;
        }
        let before = walk.throughput.max();
        let allowed = if is_d { Lobes::DELTA } else { Lobes::ALL };
        let Some(scattered) = walk.scatter_lobes(&vertex, allowed, sampler) else {
            return if is_d { PathEnd::Complete } else { PathEnd::Absorbed };
        };
        chain.extend(&walk, &vertex, &scattered);
        // Roulette on the albedo keeps the powers of all photons alike.
        if !walk.roulette(walk.throughput.max() / before, sampler) {
            return PathEnd::Roulette;
        }
    }
    PathEnd::Escaped
}
