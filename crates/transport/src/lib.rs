//! The verbs of light transport: [`Walk`], [`direct`], [`emit`] and [`merge`]. Integrators are thin loops over
//! them. No threads, no files, no clocks.

mod direct;
mod emit;
mod merge;
mod path_class;
mod photon;
mod walk;

pub use direct::{
    Direct, Emission, direct, direct_against, direct_with, emission_at, emission_escaped, power_heuristic,
};
pub use emit::{EmittedPhoton, emit, emit_mixed, emit_toward_targets};
pub use merge::{Lookup, Merged, irradiance, merge, merge_within, nearest_irradiance};
pub use path_class::{LightLayer, PathClass};
pub use photon::{PhotonBalance, PhotonBatch, PhotonJob, PhotonPaths, trace_photons};
pub use walk::{ENDLESS_DEPTH, Scattered, Vertex, Walk};
