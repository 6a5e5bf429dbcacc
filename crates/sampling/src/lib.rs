//! Keyed random numbers, warps and discrete distributions.
//!
//! No generator is global, shared or stored: a [`Sampler`] is made from (seed, pass, domain, path) where it is
//! used. Warps take numbers, never a sampler, so that they can be tested on grids.

mod discrete;
mod philox;
mod sampler;
mod sequence;
mod strata;
pub mod warp;

pub use discrete::Discrete;
pub use philox::philox4x32_10;
pub use sampler::{Domain, Sampler, Streams};
pub use sequence::shifted_r2;
pub use strata::Strata;
