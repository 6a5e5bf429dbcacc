use film::Filter;
use photons::Kernel;

/// Which algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Unidirectional path tracing with light sampling.
    Path,
    /// Two-pass photon mapping.
    PhotonMap,
}

/// What to compute, apart from the scene.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The algorithm.
    pub kind: IntegratorKind,
    /// Seed of every random number.
    pub seed: u64,
    /// Scattering events on a path, at most; 1 is direct light alone. `u32::MAX`: no limit.
    pub max_depth: u32,
    /// Pixel filter.
    pub filter: Filter,
    /// Two-pass photon mapping.
    pub photon_map: PhotonMapSettings,
}

/// Settings of two-pass photon mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonMapSettings {
    /// Photons emitted for the global map.
    pub photons: u64,
    /// Photons emitted for the caustic map.
    pub caustic_photons: u64,
    /// Neighbours of a lookup in the global map.
    pub knn: u32,
    /// Neighbours of a lookup in the caustic map.
    pub caustic_knn: u32,
    /// Kernel of the global map.
    pub kernel: Kernel,
    /// Kernel of the caustic map.
    pub caustic_kernel: Kernel,
    /// Greatest lookup radius in the global map, in scene units; `None`: found from the photons.
    pub radius: Option<f32>,
    /// Greatest lookup radius in the caustic map, in scene units; `None`: found from the pixel footprint.
    pub caustic_radius: Option<f32>,
    /// Gather rays a camera sample; 0: direct lookup in the global map.
    pub final_gather: u32,
    /// Factor on the caustic map's light; 1 is right.
    pub caustic_gain: f32,
}
