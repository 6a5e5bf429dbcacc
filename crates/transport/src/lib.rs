//! The verbs of light transport: [`Walk`], [`direct`], [`emit`] and [`merge`]; with the weights of vertex connection and
//! merging [`Subpath`], [`connect`], [`connect_light`] and [`project`]. Integrators are thin loops over them. No threads, no
//! files, no clocks.

mod caustics;
mod chain;
mod connect;
mod direct;
mod emit;
mod light_densities;
mod light_path;
mod merge;
mod mis;
mod observe;
mod path_class;
mod photon;
mod project;
mod sight;
mod subpath;
mod walk;

pub use caustics::{CausticBatch, CausticJob, observe_caustic, trace_caustics};
pub use chain::{EyeChain, LightChain, LightStart};
pub use connect::{MergingWeights, connect, connect_light, emission_against_all, escape_against_all};
pub use direct::{
    Direct, Emission, LightNumbers, direct, direct_against, direct_in_chain, emission_at, emission_escaped,
    emission_in_chain, escaped_in_chain, power_heuristic,
};
pub use emit::{EmittedPhoton, emit, emit_mixed, emit_toward_targets, emit_toward_targets_with};
pub use light_densities::LightDensities;
pub use light_path::{LightClass, LightVertex, observe_light_path, trace_light_path};
pub use merge::{Lookup, Merged, Within, irradiance, merge, merge_each, merge_within, nearest_irradiance};
pub use mis::{
    Connections, End, Scattering, SubpathMis, connection_weight, direct_weight, emission_weight,
    projection_weight,
};
pub use observe::{Observer, PathEnd};
pub use path_class::{LightLayer, PathClass};
pub use photon::{PhotonBalance, PhotonBatch, PhotonJob, PhotonPaths, observe_photon, trace_photons};
pub use project::{Projection, is_seen, project};
pub use sight::is_hidden;
pub use subpath::{EyeEnd, PathVertex, Subpath};
pub use walk::{ENDLESS_DEPTH, Scattered, Sides, Vertex, Walk};
