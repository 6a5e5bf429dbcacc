//! Spectra, lanes and view transforms.

mod lanes;

pub use lanes::{LaneBasis, Lanes};
