use std::ops::Range;

use film::Filter;
use photons::Kernel;

use crate::RadiusSettings;

/// Which algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Path tracing, light sampling and merging with photons where that pays.
    Auto,
    /// Unidirectional path tracing with light sampling.
    Path,
    /// Two-pass photon mapping.
    PhotonMap,
    /// Stochastic progressive photon mapping.
    Sppm,
    /// Vertex connection and merging.
    Vcm,
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
    /// The part of the picture that is rendered: columns and rows; `None` for all. It decides no value of a pixel.
    pub crop: Option<[Range<usize>; 2]>,
    /// Pixel filter.
    pub filter: Filter,
    /// Layers on request.
    pub layers: LayerSettings,
    /// Two-pass photon mapping.
    pub photon_map: PhotonMapSettings,
    /// Stochastic progressive photon mapping.
    pub sppm: SppmSettings,
    /// Vertex connection and merging.
    pub vcm: VcmSettings,
}

impl Settings {
    /// Whether a pixel is to be rendered; what is not stays black.
    #[inline]
    pub(crate) fn shows(&self, x: usize, y: usize) -> bool {
        self.crop.as_ref().is_none_or(|[columns, rows]| columns.contains(&x) && rows.contains(&y))
    }
}

/// Layers that a film has on request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerSettings {
    /// One for each technique that the integrator has.
    pub techniques: bool,
    /// One for each group of lights.
    pub lights: bool,
}

/// Where a progressive estimate gets its light straight from the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectLight {
    /// From light sampling.
    Sampling,
    /// From photons.
    Photons,
}

/// Settings of stochastic progressive photon mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SppmSettings {
    /// Photons emitted each pass; `None`: as many as there are pixels.
    pub photons: Option<u64>,
    /// Radii.
    pub radius: RadiusSettings,
    /// Where direct light comes from.
    pub direct: DirectLight,
}

/// Which techniques vertex connection and merging combines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VcmTechniques {
    /// All: emission, light sampling, connections, merging, light tracing.
    Vcm,
    /// All but merging: bidirectional path tracing (Veach & Guibas 1995).
    Bdpt,
    /// Vertices of light paths, and lights themselves, joined to the camera. Lights seen through specular surfaces and
    /// what is seen in them are lost.
    LightTracing,
    /// Emission and merging at every vertex of the eye path (Vorba 2011).
    Bpm,
    /// Emission and merging at the first vertex that is not specular.
    Ppm,
}

/// Settings of vertex connection and merging.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VcmSettings {
    /// What is combined.
    pub techniques: VcmTechniques,
    /// Light paths each pass; `None`: as many as there are pixels.
    pub light_paths: Option<u64>,
    /// Radii.
    pub radius: RadiusSettings,
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
