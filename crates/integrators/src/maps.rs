use photons::{Photon, PhotonMap};
use transport::PhotonBalance;

use crate::NonFinitePhoton;
use crate::vcm::{LightSide, LightTrace};

/// Photons before their maps are built.
#[derive(Clone, Debug, Default)]
pub struct TracedPhotons {
    pub(crate) global: Vec<Photon>,
    pub(crate) caustic: Vec<Photon>,
    /// [`transport::LightChain::rivals`] of the caustic photons; empty where nothing weighs them.
    pub(crate) rivals: Vec<f32>,
    /// What light paths of vertex connection and merging leave beside `global`.
    pub(crate) light_trace: LightTrace,
    /// Median radius of lookups, in scene units, where it is known before the map is; else 0.
    pub(crate) typical_radius: f32,
    /// Energy balance of the global photons, in W.
    pub global_balance: PhotonBalance,
    /// Energy balance of the caustic photons, in W.
    pub caustic_balance: PhotonBalance,
    /// Photons that became non-finite and were dropped.
    pub nonfinite: Vec<NonFinitePhoton>,
}

/// What the eye pass looks up.
#[derive(Clone, Debug, Default)]
pub struct Maps {
    pub(crate) global: Option<StoredMap>,
    pub(crate) caustic: Option<StoredMap>,
    /// [`transport::LightChain::rivals`] of the caustic photons in the map's order; empty where nothing weighs them.
    pub(crate) rivals: Vec<f32>,
    /// Irradiance at some of the global photons, for gather rays that end on Lambertian surfaces.
    pub(crate) irradiance: Option<PhotonMap>,
    /// Photons of one pass, for lookups within radii that pixels give.
    pub(crate) merging: Option<StoredMap>,
    /// What is known of the photons of `merging` for vertex connection and merging, and its splats.
    pub(crate) light_side: LightSide,
}

/// A map and the radii that fit it.
#[derive(Clone, Debug)]
pub(crate) struct StoredMap {
    pub map: PhotonMap,
    /// Median radius of lookups at probes.
    pub typical_radius: f32,
    /// Greatest radius of lookups as set; `None`: automatic.
    pub max_radius: Option<f32>,
}

/// What a map holds, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapReport {
    /// "global", "caustic" or "photon".
    pub name: &'static str,
    /// Photons stored.
    pub photons: usize,
    /// Bytes, index and what weights need of each photon included.
    pub bytes: usize,
    /// Median radius of lookups, in scene units.
    pub typical_radius: f32,
}

impl Maps {
    /// One report a map.
    pub fn reports(&self) -> Vec<MapReport> {
        let report = |name, stored: &Option<StoredMap>, beside: usize| {
            stored.as_ref().map(|s| MapReport {
                name,
                photons: s.map.len(),
                bytes: s.map.memory_bytes() + beside,
                typical_radius: s.typical_radius,
            })
        };
        let all = [
            report("global", &self.global, 0),
            report("caustic", &self.caustic, size_of_val(&self.rivals[..])),
            report("photon", &self.merging, size_of_val(&self.light_side.paths[..])),
        ];
        all.into_iter().flatten().collect()
    }
}
