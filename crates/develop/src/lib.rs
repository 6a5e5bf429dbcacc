//! Development: from the planes of a film to what a display shows. Knows no scene, path, clock or file.
//!
//! film → [`Planes`] → mix → expose → white balance → view → look-up table → legend. All of it is a function of the
//! film and the [`Display`] alone.

mod display;
mod exposure;
mod legend;
mod lut;
mod planes;
mod white;

pub use display::{Display, Settled};
pub use exposure::automatic_exposure;
pub use legend::LUMENS_PER_WATT;
pub use lut::{Lut, LutError};
pub use planes::{MixError, Planes};
pub use white::{AUTO_DEGREE, light_of};
