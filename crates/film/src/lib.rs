//! Pixels: filters, sums, layers, EXR and PNG. Knows nothing of paths, scenes or clocks.
//!
//! A camera path belongs to one pixel: [`Filter::sample`] places it, and its weight makes up for the filter
//! (*filter importance sampling*, Ernst, Stamminger & Greiner 2006), so pixels share nothing and one pass is a plain
//! array, [`PassFilm`]. A [`Film`] is the exact sum of passes: integers, so any order of adding or merging gives the
//! same bits.

mod error;
mod film;
mod filter;
mod fixed;
mod layer;
mod pass_film;

pub use error::FilmError;
pub use film::{Film, FilmNonFinite};
pub use filter::{Filter, FilterKind, FilterSample};
pub use layer::Layer;
pub use pass_film::{NonFinite, PassFilm, PixelSample, Tiles};
