//! Files of measured luminaires: IES LM-63 (1986–2019) and EULUMDAT, read into luminous intensity by direction.
//!
//! Errors name the line. Memory is bounded by a small multiple of the file's size.

mod eulumdat;
mod ies;
mod text;
mod web;

pub use text::{Note, PhotometryError};
pub use web::{Cell, PolarAxis, Web};

/// What a file says of a luminaire.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// Its intensities, all factors of the file included.
    pub web: Web,
    /// Luminous flux of its lamps, lm; `None` where the file gives none (absolute photometry).
    pub lamp_lumens: Option<f64>,
    /// Electrical power, W, where the file gives it.
    pub input_watts: Option<f64>,
    /// What the file says and the intensities do not show.
    pub notes: Vec<Note>,
}

/// Reads either format: LM-63 has a line that begins with `TILT=`.
///
/// # Errors
/// Of what is missing, no number, out of range or of no known symmetry, with its line.
pub fn read(bytes: &[u8]) -> Result<Photometry, PhotometryError> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text::lines(&text);
    match lines.iter().position(|line| ies::tilt(line).is_some()) {
        Some(tilt) => ies::read(&lines, tilt),
        None if lines[0].trim_start().to_ascii_uppercase().starts_with("IES") => {
            Err(PhotometryError::new(lines.len(), "the line `TILT=` is missing"))
        }
        None => eulumdat::read(&lines),
    }
}
