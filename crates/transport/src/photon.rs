use std::ops::Range;

use bsdf::{BsdfKind, Lobes};
use color::Lanes;
use photons::{Photon, PhotonFlags};
use sampling::{Domain, Sampler, Streams};
use scene::Scene;

use crate::{EmittedPhoton, Observer, PathEnd, Vertex, Walk, emit, emit_mixed, emit_toward_targets};

/// Which photons are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonPaths {
    /// L (S|D)* D: all light that a surface receives.
    Global,
    /// L (S|D)* D (S|D)* D: all that has been scattered by a D surface before.
    Indirect,
    /// L S⁺ D, aimed at the specular objects.
    Caustic,
    /// As `Global`; where there are specular objects, a share of the paths is aimed at them.
    Mixed,
    /// L (S|D)⁺ D: as `Mixed`, without what comes straight from a light.
    MixedScattered,
}

/// Share of a mixture's paths that are aimed: enough for the caustics of an object that lights hardly see, and no
/// other photon carries more than 10/9 of what it would without.
const AIMED: f32 = 0.1;

/// A budget of photons.
#[derive(Clone, Copy, Debug)]
pub struct PhotonJob {
    /// Which.
    pub paths: PhotonPaths,
    /// Photons emitted in the whole job, whatever becomes of them.
    pub count: u64,
    /// Seed of the render.
    pub seed: u64,
    /// Index of the map.
    pub map_index: u64,
    /// Scattering events on a whole path, at most; a photon needs one to be seen.
    pub max_depth: u32,
}

/// Photons of a range of a job, in index order.
#[derive(Clone, Debug, Default)]
pub struct PhotonBatch {
    /// Photons, where they landed on D surfaces.
    pub photons: Vec<Photon>,
    /// Where the energy went.
    pub balance: PhotonBalance,
    /// Photons that became non-finite: (index of the path, scattering events before), the first few.
    pub nonfinite: Vec<(u64, u32)>,
}

/// Where the flux of a batch went, in W, the mean over lanes; shares of the whole job. In expectation
/// emitted = absorbed + escaped + roulette + cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotonBalance {
    /// Left the lights.
    pub emitted: f64,
    /// Taken by surfaces, and by what fills solids.
    pub absorbed: f64,
    /// Left the scene.
    pub escaped: f64,
    /// Ended by Russian roulette, less what its survivors were given.
    pub roulette: f64,
    /// Ended by the depth limit or because the job had no more use for the path.
    pub cut: f64,
}

impl PhotonBalance {
    /// The sum of two.
    #[must_use]
    pub fn plus(self, o: &Self) -> Self {
        Self {
            emitted: self.emitted + o.emitted,
            absorbed: self.absorbed + o.absorbed,
            escaped: self.escaped + o.escaped,
            roulette: self.roulette + o.roulette,
            cut: self.cut + o.cut,
        }
    }
}

/// Traces the photons of a range of path indices (Jensen 1996; Russian roulette: Arvo & Kirk 1990).
pub fn trace_photons(scene: &Scene, job: &PhotonJob, range: Range<u64>) -> PhotonBatch {
    trace(scene, job, range, &mut ())
}

/// Traces one path of a job again, and shows it to an observer.
pub fn observe_photon(
    scene: &Scene,
    job: &PhotonJob,
    path: u64,
    observer: &mut impl Observer,
) -> PhotonBatch {
    trace(scene, job, path..path + 1, observer)
}

#[inline]
fn trace(scene: &Scene, job: &PhotonJob, range: Range<u64>, observer: &mut impl Observer) -> PhotonBatch {
    let paths = (range.end - range.start) as usize;
    let mut batch = PhotonBatch { photons: Vec::with_capacity(2 * paths), ..PhotonBatch::default() };
    let share = 1.0 / job.count as f32;
    let domain = match job.paths {
        PhotonPaths::Caustic => Domain::CausticPhoton,
        _ => Domain::GlobalPhoton,
    };
    let streams = Streams::new(job.seed, job.map_index, domain);
    for path in range {
        let mut sampler = streams.path(path);
        let emitted = match job.paths {
            PhotonPaths::Caustic => emit_toward_targets(scene, &mut sampler),
            PhotonPaths::Mixed | PhotonPaths::MixedScattered if !scene.targets().is_empty() => {
                emit_mixed(scene, AIMED, &mut sampler)
            }
            _ => emit(scene, &mut sampler),
        };
        let Some(EmittedPhoton { mut walk, light }) = emitted else { continue };
        walk.throughput *= share;
        observer.started(&walk, light);
        batch.balance.emitted += flux(&walk);
        let group = PhotonFlags::of_group(scene.light_group(light));
        let end = trace_one(&mut walk, job, path, group, &mut sampler, &mut batch, observer);
        observer.ended(end);
    }
    batch
}

fn flux(walk: &Walk<'_>) -> f64 {
    f64::from(walk.throughput.mean())
}

fn trace_one(
    walk: &mut Walk<'_>,
    job: &PhotonJob,
    path: u64,
    group: PhotonFlags,
    sampler: &mut Sampler,
    batch: &mut PhotonBatch,
    observer: &mut impl Observer,
) -> PathEnd {
    let mut diffuse_events = 0u32;
    let mut specular_events = 0u32;
    loop {
        let sent = flux(walk);
        let reached = walk.next_vertex();
        batch.balance.absorbed += sent - flux(walk);
        let Some(vertex) = reached else {
            batch.balance.escaped += flux(walk);
            return PathEnd::Escaped;
        };
        observer.reached(walk, &vertex);
        if !walk.throughput.is_finite() {
            batch.nonfinite.push((path, walk.depth));
            return PathEnd::NonFinite;
        }
        let is_d = vertex.bsdf.has_diffuse();
        if is_d && wanted(job.paths, diffuse_events, specular_events) {
            let caustic = wanted(PhotonPaths::Caustic, diffuse_events, specular_events);
            let flags = if caustic { PhotonFlags::CAUSTIC } else { PhotonFlags::NONE };
            let photon = photon(walk, &vertex, flags.with(group));
            observer.stored(&photon);
            batch.photons.push(photon);
        }
        if walk.depth + 1 >= job.max_depth {
            batch.balance.cut += flux(walk);
            return PathEnd::Depth;
        }
        let allowed = match (job.paths, is_d) {
            (PhotonPaths::Caustic, true) => Lobes::DELTA,
            _ => Lobes::ALL,
        };
        let before = walk.throughput;
        let before_flux = flux(walk);
        let Some(scattered) = walk.scatter_lobes(&vertex, allowed, sampler) else {
            return match job.paths {
                PhotonPaths::Caustic if is_d => {
                    batch.balance.cut += before_flux;
                    PathEnd::Complete
                }
                _ => {
                    batch.balance.absorbed += before_flux;
                    PathEnd::Absorbed
                }
            };
        };
        let after_flux = flux(walk);
        batch.balance.absorbed += before_flux - after_flux;
        // Roulette on the albedo keeps the powers of all photons alike.
        let survival = walk.throughput.max() / before.max();
        let survived = walk.roulette(survival, sampler);
        batch.balance.roulette += after_flux - if survived { flux(walk) } else { 0.0 };
        if !survived {
            return PathEnd::Roulette;
        }
        if is_d && !scattered.lobes.contains(Lobes::SPECULAR) {
            diffuse_events += 1;
        } else {
            specular_events += 1;
        }
    }
}

fn wanted(paths: PhotonPaths, diffuse_events: u32, specular_events: u32) -> bool {
    match paths {
        PhotonPaths::Global | PhotonPaths::Mixed => true,
        PhotonPaths::MixedScattered => diffuse_events + specular_events > 0,
        PhotonPaths::Indirect => diffuse_events > 0,
        PhotonPaths::Caustic => specular_events > 0 && diffuse_events == 0,
    }
}

/// The photon that a walk from a light leaves at a vertex.
pub(crate) fn photon(walk: &Walk<'_>, vertex: &Vertex, flags: PhotonFlags) -> Photon {
    let wi = vertex.wo;
    let normal = if wi.dot(vertex.hit.ng) < 0.0 { -vertex.hit.ng } else { vertex.hit.ng };
    let power: Lanes = walk.throughput / walk.scene().presence(&vertex.hit, BsdfKind::has_diffuse);
    Photon { position: vertex.hit.p, direction: wi, normal, power, depth: walk.depth.min(255) as u8, flags }
}
