//! Spectra, lanes and view transforms.

mod lanes;
mod rgb;

pub use lanes::{LaneBasis, Lanes};
pub use rgb::{LUMINANCE, luminance, luminance_f64};
