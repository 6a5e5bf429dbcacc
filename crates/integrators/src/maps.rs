use photons::{Photon, PhotonMap};
use transport::PhotonBalance;

/// Photons before their maps are built.
#[derive(Clone, Debug, Default)]
pub struct TracedPhotons {
    pub(crate) global: Vec<Photon>,
    pub(crate) caustic: Vec<Photon>,
    /// Energy balance of the global photons, in W.
    pub global_balance: PhotonBalance,
    /// Energy balance of the caustic photons, in W.
    pub caustic_balance: PhotonBalance,
    /// Photons that became non-finite and were dropped: index of the path and scattering events before.
    pub nonfinite: Vec<(u64, u32)>,
}

/// What the eye pass looks up.
#[derive(Clone, Debug, Default)]
pub struct Maps {
    pub(crate) global: Option<StoredMap>,
    pub(crate) caustic: Option<StoredMap>,
    /// Irradiance at some of the global photons, for gather rays that end on Lambertian surfaces.
    pub(crate) irradiance: Option<PhotonMap>,
}

/// A map and the radii that fit it.
#[derive(Clone, Debug)]
pub(crate) struct StoredMap {
    pub map: PhotonMap,
    /// Median distance to the k-th neighbour among probes.
    pub typical_radius: f32,
    /// Greatest radius of lookups as set; `None`: automatic.
    pub max_radius: Option<f32>,
}

/// What a map holds, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapReport {
    /// "global" or "caustic".
    pub name: &'static str,
    /// Photons stored.
    pub photons: usize,
    /// Bytes, index included.
    pub bytes: usize,
    /// Median radius of lookups at the photons themselves, in scene units.
    pub typical_radius: f32,
}

impl Maps {
    /// One report a map.
    pub fn reports(&self) -> Vec<MapReport> {
        let report = |name, stored: &Option<StoredMap>| {
            stored.as_ref().map(|s| MapReport {
                name,
                photons: s.map.len(),
                bytes: s.map.memory_bytes(),
                typical_radius: s.typical_radius,
            })
        };
        [report("global", &self.global), report("caustic", &self.caustic)].into_iter().flatten().collect()
    }
}
