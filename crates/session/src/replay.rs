//! One path of a render again, event by event.

use std::fmt;

use film::Film;
use integrators::{Integrator, Maps, PathRecord, PhotonKind};
use par::Workers;

use crate::Job;

/// Which path. With the job's scene, settings and seed it decides every number of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplayKey {
    /// The eye path of a pass through a pixel.
    Pixel {
        /// Index of the pass.
        pass: u64,
        /// Column, from the left.
        x: u32,
        /// Row, from the top.
        y: u32,
    },
    /// A photon path of the maps that a pass looks up.
    Photon {
        /// Index of the pass.
        pass: u64,
        /// Of which photons; `None`: of all that have a path of that index.
        kind: Option<PhotonKind>,
        /// Index of the path.
        path: u64,
    },
}

/// A path that was traced again.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Of which photons; `None` of an eye path.
    pub kind: Option<PhotonKind>,
    /// What happened along it.
    pub record: PathRecord,
}

/// Why a path cannot be traced again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReplayError {
    /// The system starts no more threads; its reason.
    Threads(String),
    /// A film has no pass of that index.
    Pass(u64),
    /// The pixel lies outside the picture.
    Pixel {
        /// Column and row.
        pixel: [u32; 2],
        /// Of the picture.
        size: [u32; 2],
    },
    /// There is no photon path of that index.
    Photon {
        /// The index.
        path: u64,
        /// Of which photons.
        kind: Option<PhotonKind>,
        /// What there is: photons and the number of their paths.
        paths: Vec<(PhotonKind, u64)>,
        /// Name of the integrator.
        integrator: &'static str,
    },
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threads(reason) => write!(f, "threads cannot be started: {reason}"),
            Self::Pass(pass) => {
                write!(f, "there is no pass {pass}: passes are numbered from 0 to {}", Film::MAX_PASSES - 1)
            }
            Self::Pixel { pixel: [x, y], size: [w, h] } => {
                write!(f, "pixel {x},{y} lies outside the picture of {w} x {h}: 0,0 to {},{}", w - 1, h - 1)
            }
            Self::Photon { paths, integrator, .. } if paths.is_empty() => {
                write!(f, "{integrator} traces no photons in this scene")
            }
            Self::Photon { path, kind, paths, integrator } => {
                let of = kind.map_or(String::new(), |kind| format!("{} ", kind.name()));
                let what: Vec<_> = paths
                    .iter()
                    .map(|(kind, n)| format!("0 to {} of the {} ones", n - 1, kind.name()))
                    .collect();
                write!(f, "{integrator} has no {of}photon path {path}: there are {}", what.join(" and "))
            }
        }
    }
}

impl std::error::Error for ReplayError {}

/// Traces one path of a job again. An eye path needs the photon maps of its pass, which are made on `threads` threads (0:
/// one for each core); a photon path costs next to nothing. `auto` runs its pilot first.
///
/// # Errors
/// Where the job has no such path.
pub fn replay(job: &Job, key: ReplayKey, threads: usize) -> Result<Vec<Replayed>, ReplayError> {
    let (ReplayKey::Pixel { pass, .. } | ReplayKey::Photon { pass, .. }) = key;
    if pass >= Film::MAX_PASSES {
        return Err(ReplayError::Pass(pass));
    }
    let size = job.scene.resolution();
    if let ReplayKey::Pixel { x, y, .. } = key
        && (x >= size[0] || y >= size[1])
    {
        return Err(ReplayError::Pixel { pixel: [x, y], size });
    }
    let workers = Workers::new(threads).map_err(ReplayError::Threads)?;
    workers.run(|| {
        let integrator = integrators::integrator(&job.settings, &job.scene);
        match key {
            ReplayKey::Pixel { x, y, .. } => {
                let maps = maps(job, &*integrator, pass);
                let pixel = [x as usize, y as usize];
                let record = integrator.replay_pixel(&job.scene, maps.as_ref(), pass, pixel);
                Ok(vec![Replayed { kind: None, record }])
            }
            ReplayKey::Photon { kind, path, .. } => photon(job, &*integrator, pass, kind, path),
        }
    })
}

fn maps(job: &Job, integrator: &dyn Integrator, pass: u64) -> Option<Maps> {
    let index = integrator.map_index(pass)?;
    Some(integrator.build_maps(&job.scene, integrator.trace_photons(&job.scene, index)))
}

fn photon(
    job: &Job,
    integrator: &dyn Integrator,
    pass: u64,
    kind: Option<PhotonKind>,
    path: u64,
) -> Result<Vec<Replayed>, ReplayError> {
    let paths = integrator.photon_paths(&job.scene);
    let wanted = |(of, n): &&(PhotonKind, u64)| path < *n && kind.is_none_or(|kind| kind == *of);
    let index = integrator.map_index(pass).unwrap_or(pass);
    let replayed: Vec<_> = paths
        .iter()
        .filter(wanted)
        .map(|&(of, _)| {
            let record = integrator.replay_photon(&job.scene, index, of, path);
            Replayed { kind: Some(of), record }
        })
        .collect();
    if replayed.is_empty() {
        return Err(ReplayError::Photon { path, kind, paths, integrator: integrator.name() });
    }
    Ok(replayed)
}
