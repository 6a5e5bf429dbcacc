//! Takes noise out of pictures by Open Image Denoise, a library that is not part of this program: it is looked for and loaded
//! when it is wanted ([`Denoiser::find`]).
//!
//! The denoised picture is a function of the picture and its feature planes alone: the processor computes it, never a
//! graphics card.

mod api;
mod denoiser;
mod error;
mod places;

pub use denoiser::{Denoiser, Images};
pub use error::{DenoiseError, HOW_TO_GET};
pub use places::Places;
