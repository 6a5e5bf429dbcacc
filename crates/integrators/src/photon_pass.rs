//! All photons of a job, traced on all threads.

use photons::Photon;
use scene::Scene;
use transport::{PhotonBalance, PhotonJob, PhotonPaths, observe_photon, trace_photons};

use crate::replay::PhotonRecording;
use crate::{NonFinitePhoton, PathRecord, PhotonKind};

/// Photon paths of one task; fixed, so that sums have one shape on any number of threads.
const CHUNK: usize = 4096;

/// What a job gave.
#[derive(Default)]
pub(crate) struct Traced {
    pub photons: Vec<Photon>,
    pub balance: PhotonBalance,
    pub nonfinite: Vec<NonFinitePhoton>,
}

/// A whole job, in index order.
pub(crate) fn trace_job(scene: &Scene, job: &PhotonJob) -> Traced {
    let batches = par::map_chunks(job.count as usize, CHUNK, |range| {
        trace_photons(scene, job, range.start as u64..range.end as u64)
    });
    let mut out = Traced::default();
    out.photons.reserve_exact(batches.iter().map(|b| b.photons.len()).sum());
    for batch in batches {
        out.photons.extend_from_slice(&batch.photons);
        out.balance = out.balance.plus(&batch.balance);
        let kind = match job.paths {
            PhotonPaths::Caustic => PhotonKind::Caustic,
            _ => PhotonKind::Global,
        };
        let nonfinite = batch.nonfinite.iter();
        out.nonfinite.extend(nonfinite.map(|&(path, depth)| NonFinitePhoton { kind, path, depth }));
    }
    out
}

/// One path of a job again.
pub(crate) fn replay_job(scene: &Scene, job: &PhotonJob, path: u64) -> PathRecord {
    let mut recording = PhotonRecording::default();
    observe_photon(scene, job, path, &mut recording);
    recording.finish()
}
