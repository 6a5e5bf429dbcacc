//! Two-pass photon mapping (Jensen 1996; Jensen 2001, ch. 5–7): the maps. The eye pass is in `eye`.

use film::{FilmError, PassFilm};
use photons::{Kernel, Photon, PhotonMap, Query, Scratch};
use scene::Scene;
use transport::{Lookup, PhotonJob, PhotonPaths};

use crate::eye::Eye;
use crate::irradiance::irradiance_samples;
use crate::maps::StoredMap;
use crate::photon_pass::{Traced, replay_job, trace_job};
use crate::pixels::render_pixels;
use crate::radius::median;
use crate::replay::record_pixel;
use crate::{Integrator, Maps, PathRecord, PhotonKind, PhotonMapSettings, Settings, TracedPhotons};

/// Greatest radius of lookups in the global map, in typical radii, unless it is set.
const GLOBAL_RADII: f32 = 4.0;
/// Photons at which the typical lookup radius of a map is measured.
const PROBES: usize = 256;

/// Two-pass photon mapping. Passes share the maps of index 0; each adds camera and gather samples over them.
#[derive(Clone, Debug)]
pub struct PhotonMapper {
    settings: Settings,
}

impl PhotonMapper {
    /// A photon mapper of these settings.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    /// The photons of a map; `None` where it is not needed.
    fn job(&self, scene: &Scene, kind: PhotonKind, map_index: u64) -> Option<PhotonJob> {
        let s = &self.settings.photon_map;
        let limit = self.settings.max_depth;
        let (paths, count, max_depth) = match (kind, s.final_gather) {
            _ if limit < 2 => return None,
            (PhotonKind::Caustic, _) if scene.targets().is_empty() => return None,
            (PhotonKind::Caustic, _) => (PhotonPaths::Caustic, s.caustic_photons, limit),
            (PhotonKind::Global, 0) => (PhotonPaths::Indirect, s.photons, limit),
            // A photon that gather rays see is scattered twice more: where it lies, and where it is gathered.
            (PhotonKind::Global, _) => {
                (PhotonPaths::Global, s.photons, if limit == u32::MAX { limit } else { limit - 1 })
            }
        };
        Some(PhotonJob { paths, count, seed: self.settings.seed, map_index, max_depth })
    }

    fn trace(&self, scene: &Scene, kind: PhotonKind, map_index: u64) -> Traced {
        self.job(scene, kind, map_index).map_or_else(Traced::default, |job| trace_job(scene, &job))
    }

    fn eye<'a>(&'a self, scene: &'a Scene, maps: &'a Maps) -> Eye<'a> {
        Eye { scene, settings: &self.settings.photon_map, max_depth: self.settings.max_depth, maps }
    }
}

impl Integrator for PhotonMapper {
    fn name(&self) -> &'static str {
        "photon_map"
    }

    fn map_index(&self, _pass: u64) -> Option<u64> {
        Some(0)
    }

    fn trace_photons(&self, scene: &Scene, map_index: u64) -> TracedPhotons {
        let global = self.trace(scene, PhotonKind::Global, map_index);
        let caustic = self.trace(scene, PhotonKind::Caustic, map_index);
        let mut nonfinite = global.nonfinite;
        nonfinite.extend(caustic.nonfinite);
        TracedPhotons {
            global: global.photons,
            caustic: caustic.photons,
            global_balance: global.balance,
            caustic_balance: caustic.balance,
            nonfinite,
            ..TracedPhotons::default()
        }
    }

    fn build_maps(&self, scene: &Scene, photons: TracedPhotons) -> Maps {
        let s = &self.settings.photon_map;
        let reach = scene.bounds().size().length();
        let TracedPhotons { global, caustic, .. } = photons;
        let global = store(global, s.knn, reach, s.radius);
        let caustic = store(caustic, s.caustic_knn, reach, s.caustic_radius);
        let irradiance = global
            .as_ref()
            .filter(|_| s.final_gather > 0)
            .map(|g| irradiance_samples(scene, g, &global_lookup(s, g), self.settings.seed));
        Maps { global, caustic, irradiance, ..Maps::default() }
    }

    fn render(&self, scene: &Scene, maps: Option<&Maps>, pass: u64) -> Result<PassFilm, FilmError> {
        let none = Maps::default();
        render_pixels(scene, &self.settings, pass, &self.eye(scene, maps.unwrap_or(&none)))
    }

    fn replay_pixel(&self, scene: &Scene, maps: Option<&Maps>, pass: u64, pixel: [usize; 2]) -> PathRecord {
        let none = Maps::default();
        let eye = self.eye(scene, maps.unwrap_or(&none));
        record_pixel(scene, &self.settings, pass, pixel, &eye).finish()
    }

    fn photon_paths(&self, scene: &Scene) -> Vec<(PhotonKind, u64)> {
        let count = |kind| self.job(scene, kind, 0).map(|job| (kind, job.count)).filter(|(_, n)| *n > 0);
        PhotonKind::ALL.into_iter().filter_map(count).collect()
    }

    fn replay_photon(&self, scene: &Scene, map_index: u64, kind: PhotonKind, path: u64) -> PathRecord {
        let job = self.job(scene, kind, map_index);
        job.map_or_else(PathRecord::default, |job| replay_job(scene, &job, path))
    }
}

/// How the global map is looked up.
pub(crate) fn global_lookup(s: &PhotonMapSettings, stored: &StoredMap) -> Lookup {
    let max_radius = stored.max_radius.unwrap_or(GLOBAL_RADII * stored.typical_radius);
    Lookup { knn: s.knn as usize, max_radius, kernel: s.kernel }
}

fn store(photons: Vec<Photon>, knn: u32, reach: f32, max_radius: Option<f32>) -> Option<StoredMap> {
    if photons.is_empty() {
        return None;
    }
    let map = PhotonMap::build(photons);
    let typical_radius = typical_radius(&map, knn as usize, reach);
    Some(StoredMap { map, typical_radius, max_radius })
}

/// Median over probes, spread evenly over the tree, of the distance to the k-th neighbour.
fn typical_radius(map: &PhotonMap, knn: usize, reach: f32) -> f32 {
    let mut scratch = Scratch::new();
    let step = (map.len() / PROBES).max(1);
    let radii = (0..map.len())
        .step_by(step)
        .map(|slot| {
            let p = map.photon(slot as u32);
            let query =
                Query { position: p.position, normal: p.normal, radius: reach, kernel: Kernel::Constant };
            map.gather_knn(&query, knn, &mut scratch, |_, _| ()).radius
        })
        .collect();
    median(radii).unwrap_or(reach)
}
