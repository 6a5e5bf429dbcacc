//! EULUMDAT (A. Stockmar 1990, as light planning programs exchange it): one value on each line, at a fixed place.

use crate::text::{angles, candela, number};
use crate::web::{Symmetry, Web};
use crate::{Note, Photometry, PhotometryError};

/// Lines before those of the lamps, the direct ratios after them, and lines of a set of lamps.
const HEAD: usize = 26;
const RATIOS: usize = 10;
const SET: usize = 6;

struct Lines<'t>(&'t [&'t str]);

impl Lines<'_> {
    /// The number on a line, counted from 1; decimals may follow a comma.
    fn number(&self, line: usize, what: &str) -> Result<f64, PhotometryError> {
        let Some(text) = self.0.get(line - 1) else {
            return Err(PhotometryError::new(self.0.len(), format!("the file ends before {what}")));
        };
        number(line, &text.trim().replace(',', "."), what)
    }

    /// The same where an empty line is as good as `absent`.
    fn number_or(&self, line: usize, absent: f64, what: &str) -> Result<f64, PhotometryError> {
        let empty = self.0.get(line - 1).is_some_and(|text| text.trim().is_empty());
        if empty { Ok(absent) } else { self.number(line, what) }
    }

    /// A whole number from `least` on, no more than there are lines.
    fn count(&self, line: usize, least: usize, what: &str) -> Result<usize, PhotometryError> {
        let x = self.number(line, what)?;
        if x.fract() != 0.0 || x < least as f64 || x > self.0.len() as f64 {
            return Err(PhotometryError::new(line, format!("{what} is {x}")));
        }
        Ok(x as usize)
    }

    fn list(&self, first: usize, count: usize, what: &str) -> Result<Vec<(usize, f64)>, PhotometryError> {
        if first + count > self.0.len() + 1 {
            let message = format!("the file ends before {what}: {count} lines are due from line {first} on");
            return Err(PhotometryError::new(self.0.len(), message));
        }
        (first..first + count).map(|line| self.number(line, what).map(|x| (line, x))).collect()
    }
}

pub(crate) fn read(lines: &[&str]) -> Result<Photometry, PhotometryError> {
    let lines = Lines(lines);
    let symmetry = lines.number(3, "the symmetry")?;
    let planes = lines.count(4, 1, "the number of C planes")?;
    let polars = lines.count(6, 2, "the number of angles in a plane")?;
    let factor = lines.number_or(24, 1.0, "the conversion factor")?;
    let sets = lines.count(HEAD, 1, "the number of sets of lamps")?;
    // The first set's.
    let lumens = lines.number(HEAD + 3, "the luminous flux of the lamps")?;
    let watts = lines.number_or(HEAD + 6, 0.0, "the power of the lamps")?;
    let mut notes = Vec::new();
    if sets > 1 {
        notes.push(Note { line: HEAD, text: format!("of {sets} sets of lamps the first one shines") });
    }
    // Intensities are for 1000 lm of the lamps.
    let gain = factor * lumens / 1000.0;
    if !(gain > 0.0 && gain.is_finite()) {
        let message = format!("the luminous flux of the lamps is {lumens}, the conversion factor {factor}");
        return Err(PhotometryError::new(HEAD + 3, message));
    }
    let first = HEAD + SET * sets + RATIOS + 1;
    let c = lines.list(first, planes, "C planes")?;
    let gamma = lines.list(first + planes, polars, "angles")?;
    let polar = angles(&gamma, "an angle", [0.0, 180.0])?;
    let azimuth = angles(&c, "a C plane", [0.0, 360.0])?;
    // Which of the planes have intensities: index of the first one and how many.
    let (symmetry, from, count) = match symmetry {
        0.0 => (Symmetry::None, 0, planes),
        1.0 => (Symmetry::Rotation, 0, 1),
        2.0 => (Symmetry::Across0, 0, planes / 2 + 1),
        3.0 => (Symmetry::Across90, 3 * planes / 4, planes / 2 + 1),
        4.0 => (Symmetry::Quadrants, 0, planes / 4 + 1),
        other => return Err(PhotometryError::new(3, format!("the symmetry is {other}; there are 0 to 4"))),
    };
    let count = count.min(planes);
    let due = count.checked_mul(polars).unwrap_or(usize::MAX / 2);
    let found = lines.list(first + planes + polars, due, "intensities")?;
    let azimuth: Vec<f32> = (0..count).map(|i| azimuth[(from + i) % planes]).collect();
    let candela = candela(&found, gain)?;
    let web = Web::turned(polar, &azimuth, &candela, symmetry);
    Ok(Photometry { web, lamp_lumens: Some(lumens), input_watts: (watts > 0.0).then_some(watts), notes })
}
