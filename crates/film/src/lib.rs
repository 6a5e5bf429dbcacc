//! Pixels: filters, sums, layers, EXR and PNG. Knows nothing of paths, scenes or clocks.
//!
//! A camera path belongs to one pixel: [`Filter::sample`] places it, and its weight makes up for the filter
//! (*filter importance sampling*, Ernst, Stamminger & Greiner 2006), so pixels share nothing and one pass is a plain
//! array, [`PassFilm`]. A [`Film`] is the exact sum of passes: integers, so any order of adding or merging gives the
//! same bits.

mod compare;
mod error;
mod exr_channels;
mod exr_file;
mod film;
mod film_file;
mod filter;
mod fixed;
mod flip;
mod grain;
mod layer;
mod named;
mod noise;
mod output;
mod pass_film;
mod png_file;
mod read;
mod section;
mod sums;
mod unfinished;

pub use compare::{CompareError, Comparison, compare, difference};
pub use error::FilmError;
pub use exr_channels::ExrChannels;
pub use exr_file::{
    ExrOptions, Precision, encode_exr, encode_exr_channels, encode_exr_rgb, write_exr, write_exr_channels,
};
pub use film::{Film, FilmNonFinite};
pub use film_file::FilmHead;
pub use filter::{Filter, FilterKind, FilterSample};
pub use flip::flip;
pub use layer::Layer;
pub use output::{OutputError, OutputErrorKind, check_writable, write_atomically, write_atomically_with};
pub use pass_film::{NonFinite, PassFilm, PixelSample};
pub use png_file::{encode_png_bytes, write_png};
pub use read::{ReadError, ReadErrorKind, RgbImage};
pub use section::{SectionError, SectionReader, SectionWriter};
pub use unfinished::{discard_leftovers, discard_unfinished};
