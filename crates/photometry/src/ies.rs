//! IES LM-63 (ANSI/IES LM-63-1986, -1991, -1995, -2002, -2019).

use crate::text::{Numbers, angles, candela, shown};
use crate::web::{PolarAxis, Symmetry, Web};
use crate::{Note, Photometry, PhotometryError};

/// What follows `TILT=`.
pub(crate) fn tilt(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let head = line.get(..4)?;
    let rest = line[4..].trim_start().strip_prefix('=')?;
    head.eq_ignore_ascii_case("TILT").then(|| rest.trim())
}

/// `at`: index of the line `TILT=`.
pub(crate) fn read(lines: &[&str], at: usize) -> Result<Photometry, PhotometryError> {
    let mut notes = Vec::new();
    let mut numbers = Numbers::new(lines, at + 1);
    let tilt = tilt(lines[at]).unwrap_or_default();
    if tilt.eq_ignore_ascii_case("INCLUDE") {
        numbers.next("the lamp's position in the luminaire")?;
        let count = numbers.count("the number of tilt angles", 2)?;
        numbers.list(count, "tilt angles")?;
        numbers.list(count, "tilt factors")?;
    }
    if !tilt.eq_ignore_ascii_case("NONE") {
        let text = format!("TILT={}: the lamp shines as in a luminaire that is not tilted", shown(tilt));
        notes.push(Note { line: at + 1, text });
    }
    let lamps = numbers.next("the number of lamps")?;
    let lumens = numbers.next("the lumens of a lamp")?;
    let multiplier = numbers.next("the candela multiplier")?;
    let polars = numbers.count("the number of vertical angles", 1)?;
    let planes = numbers.count("the number of horizontal angles", 1)?;
    let kind = numbers.next("the photometric type")?;
    let kind_line = numbers.line;
    for what in ["the unit of length", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    let ballast = numbers.next("the ballast factor")?;
    let factor = numbers.next("the ballast-lamp photometric factor")?;
    let watts = numbers.next("the input watts")?;
    // LM-63-2002 keeps the second factor for future use, and in LM-63-2019 the number says how the file was made.
    let factor = if is_recent(lines[0]) { 1.0 } else { factor };
    let gain = multiplier * ballast * factor;
    if !(gain > 0.0 && gain.is_finite()) {
        let message = format!("the factors on intensities are {multiplier}, {ballast} and {factor}");
        return Err(PhotometryError::new(numbers.line, message));
    }
    let vertical = numbers.list(polars, "vertical angles")?;
    let horizontal = numbers.list(planes, "horizontal angles")?;
    let due = polars.saturating_mul(planes);
    let intensities = candela(&numbers.list(due, "intensities")?, gain)?;
    let angles_of = Angles { vertical, horizontal };
    let web = match kind as i32 {
        1 if kind == 1.0 => angles_of.type_c(&intensities)?,
        2 if kind == 2.0 => angles_of.type_b(&intensities)?,
        3 if kind == 3.0 => angles_of.type_a(&intensities)?,
        _ => {
            let message = format!("the photometric type is {kind}; there are 1 (C), 2 (B) and 3 (A)");
            return Err(PhotometryError::new(kind_line, message));
        }
    };
    let lamp_lumens = (lumens > 0.0 && lamps > 0.0).then_some(lamps * lumens);
    let input_watts = (watts > 0.0).then_some(watts);
    Ok(Photometry { web, lamp_lumens, input_watts, notes })
}

/// Whether the file follows LM-63-2002 or -2019, by its first line.
fn is_recent(first: &str) -> bool {
    let first = first.to_ascii_uppercase();
    first.contains("63-2002") || first.contains("63-2019")
}

struct Angles {
    vertical: Vec<(usize, f64)>,
    horizontal: Vec<(usize, f64)>,
}

impl Angles {
    fn vertical(&self, range: [f64; 2]) -> Result<Vec<f32>, PhotometryError> {
        if let [only] = self.vertical[..] {
            return Err(PhotometryError::new(only.0, "one vertical angle alone"));
        }
        angles(&self.vertical, "a vertical angle", range)
    }

    /// Vertical angles from straight down; horizontal ones tell the symmetry.
    fn type_c(&self, candela: &[f32]) -> Result<Web, PhotometryError> {
        let polar = self.vertical([0.0, 180.0])?;
        let azimuth = angles(&self.horizontal, "a horizontal angle", [0.0, 360.0])?;
        let (first, last) = (azimuth[0], azimuth[azimuth.len() - 1]);
        let symmetry = match (first, last) {
            _ if azimuth.len() == 1 => Symmetry::Rotation,
            (0.0, 90.0) => Symmetry::Quadrants,
            (0.0, 180.0) => Symmetry::Across0,
            (90.0, 270.0) => Symmetry::Across90,
            (180.0, 360.0) => Symmetry::Across0,
            // The last plane may be left out, as it is the first one.
            (0.0, last) if last > 180.0 => Symmetry::None,
            _ => {
                let line = self.horizontal[azimuth.len() - 1].0;
                let message = format!(
                    "horizontal angles from {first} to {last}; they go from 0 to 0, 90, 180 or 360, or from 90 to 270"
                );
                return Err(PhotometryError::new(line, message));
            }
        };
        Ok(Web::turned(polar, &azimuth, candela, symmetry))
    }

    /// Vertical and horizontal angles, and intensities by both. Vertical angles are heights above the horizon, horizontal ones turn to the right; what begins at 0 is the same on
    /// the other side.
    fn both(&self, candela: &[f32]) -> Result<[Vec<f32>; 3], PhotometryError> {
        let vertical = self.vertical([-90.0, 90.0])?;
        let horizontal = angles(&self.horizontal, "a horizontal angle", [-180.0, 180.0])?;
        let n = vertical.len();
        let v = mirrored(&vertical);
        let h = if horizontal.len() == 1 {
            // One plane for all sides.
            vec![(-180.0, 0), (180.0, 0)]
        } else {
            mirrored(&horizontal)
        };
        let pick = |&(_, i): &(f32, usize)| v.iter().map(move |&(_, j)| candela[i * n + j]);
        let candela = h.iter().flat_map(pick).collect();
        let only = |list: &[(f32, usize)]| list.iter().map(|&(x, _)| x).collect();
        Ok([only(&v), only(&h), candela])
    }

    fn type_a(&self, candela: &[f32]) -> Result<Web, PhotometryError> {
        let [v, h, candela] = self.both(candela)?;
        let polar = v.iter().map(|v| v + 90.0).collect();
        Ok(Web::part(polar, h, candela, PolarAxis::Down))
    }

    fn type_b(&self, candela: &[f32]) -> Result<Web, PhotometryError> {
        let [v, h, candela] = self.both(candela)?;
        // Horizontal angles are those from the axis; they end at the axis.
        let polar: Vec<f32> = h.iter().map(|h| (h + 90.0).clamp(0.0, 180.0)).collect();
        if h.iter().any(|h| h.abs() > 90.0) {
            let line = self.horizontal[0].0;
            return Err(PhotometryError::new(line, "horizontal angles of type B beyond 90 degrees"));
        }
        let turned = (0..v.len()).flat_map(|j| (0..h.len()).map(move |i| (i, j)));
        let candela = turned.map(|(i, j)| candela[i * v.len() + j]).collect();
        Ok(Web::part(polar, v, candela, PolarAxis::Side))
    }
}

/// Angles with their indices; those that begin at 0 also negative.
fn mirrored(angles: &[f32]) -> Vec<(f32, usize)> {
    let with_index: Vec<(f32, usize)> = angles.iter().copied().zip(0..).collect();
    if angles[0] != 0.0 {
        return with_index;
    }
    let negative = with_index.iter().skip(1).rev().map(|&(x, i)| (-x, i));
    negative.chain(with_index.iter().copied()).collect()
}
