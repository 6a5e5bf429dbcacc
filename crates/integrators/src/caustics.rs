//! All weighted caustic photons of a job, traced on all threads.

use photons::Photon;
use scene::Scene;
use transport::{CausticJob, observe_caustic, trace_caustics};

use crate::replay::PhotonRecording;
use crate::{NonFinitePhoton, PathRecord, PhotonKind};

/// Photon paths of one task; fixed, so that sums have one shape on any number of threads.
const CHUNK: usize = 1024;

/// What a job gave, in index order.
#[derive(Default)]
pub(crate) struct Caustics {
    pub photons: Vec<Photon>,
    pub rivals: Vec<f32>,
    pub nonfinite: Vec<NonFinitePhoton>,
}

/// A whole job.
pub(crate) fn trace_caustic_job(scene: &Scene, job: &CausticJob) -> Caustics {
    let batches = par::map_chunks(job.count as usize, CHUNK, |range| {
        trace_caustics(scene, job, range.start as u64..range.end as u64)
    });
    let mut out = Caustics::default();
    out.photons.reserve_exact(batches.iter().map(|b| b.photons.len()).sum());
    out.rivals.reserve_exact(out.photons.capacity());
    for batch in batches {
        out.photons.extend_from_slice(&batch.photons);
        out.rivals.extend_from_slice(&batch.rivals);
        let nonfinite = batch.nonfinite.iter();
        let kind = PhotonKind::Caustic;
        out.nonfinite.extend(nonfinite.map(|&(path, depth)| NonFinitePhoton { kind, path, depth }));
    }
    out
}

/// One path of a job again.
pub(crate) fn replay_caustic_job(scene: &Scene, job: &CausticJob, path: u64) -> PathRecord {
    let mut recording = PhotonRecording::default();
    observe_caustic(scene, job, path, &mut recording);
    recording.finish()
}
