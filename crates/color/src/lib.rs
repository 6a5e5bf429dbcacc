//! Spectra, lanes and view transforms.

mod cie;
mod ior;
mod lanes;
mod metal;
mod metal_data;
mod rgb;
mod spectrum;
mod view;
mod white;

pub use ior::{ior_names, named_ior};
pub use lanes::{LaneBasis, Lanes};
pub use metal::{Spectrum, metal_names, metal_spectra, named_metal, normal_reflectance};
pub use rgb::{
    LUMINANCE, linear_to_srgb, linear_to_srgb8, luminance, luminance_f64, srgb_to_linear, srgb8_to_linear,
};
pub use spectrum::{blackbody_rgb, emission_to_xyz, reflectance_to_rgb, xyz_to_rgb};
pub use view::{Exposure, FALSE_COLOUR_STOPS, ViewTransform, false_colour};
pub use white::{Adaptation, Illuminant, WhiteBalance, correlated_temperature};

/// A name in lower case without spaces, hyphens and underscores.
fn plain_name(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).flat_map(char::to_lowercase).collect()
}
