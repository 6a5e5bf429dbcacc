use std::fmt;

/// A look-up table for display colours: a file of type .cube (Adobe, Cube LUT Specification 1.0, 2013), of one or three
/// dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Lut {
    size: usize,
    is_solid: bool,
    low: [f32; 3],
    high: [f32; 3],
    values: Vec<[f32; 3]>,
}

/// Why a text is no look-up table: the line, counted from 1, and what is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LutError {
    /// The line; 0 for the text as a whole.
    pub line: usize,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for LutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.what),
            line => write!(f, "line {line}: {}", self.what),
        }
    }
}

impl std::error::Error for LutError {}

impl Lut {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// At the first line that is wrong.
    pub fn parse(text: &str) -> Result<Self, LutError> {
        let error = |line: usize, what: &str| LutError { line, what: what.to_owned() };
        let mut lut = Self { size: 0, is_solid: false, low: [0.0; 3], high: [1.0; 3], values: Vec::new() };
        for (i, line) in text.lines().enumerate() {
            let n = i + 1;
            let line = line.trim().trim_start_matches('\u{feff}');
            let mut words = line.split_whitespace();
            let Some(first) = words.next() else { continue };
            let three = |words: &mut dyn Iterator<Item = &str>| -> Option<[f32; 3]> {
                let numbers: Vec<f32> =
                    words.map(|w| w.parse().ok().filter(|v: &f32| v.is_finite())).collect::<Option<_>>()?;
                numbers.try_into().ok()
            };
            match first {
                _ if first.starts_with('#') => {}
                "TITLE" => {}
                "LUT_1D_SIZE" | "LUT_3D_SIZE" => {
                    lut.is_solid = first == "LUT_3D_SIZE";
                    let most = if lut.is_solid { 256 } else { 65536 };
                    let size = words.next().and_then(|w| w.parse().ok()).filter(|s| (2..=most).contains(s));
                    if lut.size != 0 {
                        return Err(error(n, "the size is given twice"));
                    }
                    lut.size = size.ok_or_else(|| error(n, &format!("{first} must be from 2 to {most}")))?;
                }
                "DOMAIN_MIN" => {
                    lut.low =
                        three(&mut words).ok_or_else(|| error(n, "DOMAIN_MIN must be three numbers"))?;
                }
                "DOMAIN_MAX" => {
                    lut.high =
                        three(&mut words).ok_or_else(|| error(n, "DOMAIN_MAX must be three numbers"))?;
                }
                "LUT_1D_INPUT_RANGE" | "LUT_3D_INPUT_RANGE" => {
                    let pair: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
                    let [low, high] = pair[..] else {
                        return Err(error(n, &format!("{first} must be two numbers")));
                    };
                    (lut.low, lut.high) = ([low; 3], [high; 3]);
                }
                _ => {
                    let value = three(&mut line.split_whitespace())
                        .ok_or_else(|| error(n, "neither a keyword that is known nor three numbers"))?;
                    if lut.size == 0 {
                        return Err(error(n, "colours come after LUT_1D_SIZE or LUT_3D_SIZE"));
                    }
                    lut.values.push(value);
                }
            }
        }
        if lut.size == 0 {
            return Err(error(0, "it says neither LUT_1D_SIZE nor LUT_3D_SIZE"));
        }
        if (0..3).any(|c| lut.low[c].is_nan() || lut.high[c].is_nan() || lut.low[c] >= lut.high[c]) {
            return Err(error(0, "DOMAIN_MIN must lie below DOMAIN_MAX"));
        }
        let expected = if lut.is_solid { lut.size.pow(3) } else { lut.size };
        if lut.values.len() != expected {
            let what = format!("it has {} colours; its size asks for {expected}", lut.values.len());
            return Err(LutError { line: 0, what });
        }
        Ok(lut)
    }

    /// A display colour, looked up: linear between the entries, in three dimensions among the four corners of a
    /// tetrahedron (Kasson et al. 1995), which keeps greys grey. Beyond the domain the nearest entry counts.
    pub fn apply(&self, colour: [f32; 3]) -> [f32; 3] {
        let last = self.size - 1;
        let at: [(usize, f32); 3] = std::array::from_fn(|c| {
            let place = (colour[c] - self.low[c]) / (self.high[c] - self.low[c]);
            let place = if place.is_nan() { 0.0 } else { place.clamp(0.0, 1.0) * last as f32 };
            let below = (place as usize).min(last - 1);
            (below, place - below as f32)
        });
        if !self.is_solid {
            return std::array::from_fn(|c| {
                let (i, share) = at[c];
                self.values[i][c] * (1.0 - share) + self.values[i + 1][c] * share
            });
        }
        // From the lower corner one step along each axis, those of the greatest shares first.
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| at[*b].1.total_cmp(&at[*a].1));
        let stride = [1, self.size, self.size * self.size];
        let mut index = (0..3).map(|c| at[c].0 * stride[c]).sum::<usize>();
        let mut out = self.values[index].map(|v| v * (1.0 - at[order[0]].1));
        for (step, axis) in order.into_iter().enumerate() {
            index += stride[axis];
            let next = order.get(step + 1).map_or(0.0, |axis| at[*axis].1);
            for (out, value) in out.iter_mut().zip(self.values[index]) {
                *out += value * (at[axis].1 - next);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solid(size: usize, of: impl Fn([f32; 3]) -> [f32; 3]) -> String {
        let mut text = format!("# a look\nTITLE \"x y\"\nLUT_3D_SIZE {size}\n\n");
        let part = |i: usize| i as f32 / (size - 1) as f32;
        for b in 0..size {
            for g in 0..size {
                for r in 0..size {
                    let [r, g, b] = of([part(r), part(g), part(b)]);
                    text += &format!("{r} {g} {b}\n");
                }
            }
        }
        text
    }

    #[test]
    fn linear_tables_are_exact() {
        let of = |[r, g, b]: [f32; 3]| [0.5 * r + 0.2 * g, g, 1.0 - b];
        let lut = Lut::parse(&solid(5, of)).unwrap();
        for colour in [[0.0; 3], [1.0; 3], [0.3, 0.9, 0.1], [0.11, 0.12, 0.95], [0.7, 0.2, 0.7]] {
            let (found, expected) = (lut.apply(colour), of(colour));
            assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-6), "{found:?} {expected:?}");
        }
        assert_eq!(lut.apply([7.0, -3.0, f32::NAN]), of([1.0, 0.0, 0.0]));
    }

    #[test]
    fn tables_of_one_dimension_and_domains() {
        let text = "LUT_1D_SIZE 3\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 2 2 2\n0 0 0\n0.25 0.5 1\n1 1 1\n";
        let lut = Lut::parse(text).unwrap();
        assert_eq!(lut.apply([1.0, 0.5, 2.0]), [0.25, 0.25, 1.0]);
    }

    #[test]
    fn what_is_no_table() {
        for (text, said) in [
            ("", "neither LUT_1D_SIZE nor"),
            ("LUT_3D_SIZE 1\n", "line 1: LUT_3D_SIZE must be from 2 to 256"),
            ("LUT_3D_SIZE 2\n0 0 0\n", "has 1 colours; its size asks for 8"),
            ("0 0 0\n", "line 1: colours come after"),
            ("LUT_1D_SIZE 2\n0 0 0\n0 0 nan\n", "line 3: neither"),
            ("LUT_1D_SIZE 2\nDOMAIN_MIN 1 1 1\n0 0 0\n1 1 1\n", "DOMAIN_MIN must lie below"),
            ("LUT_1D_SIZE 2\nLUT_3D_SIZE 2\n", "line 2: the size is given twice"),
            ("\u{1}PNG", "line 1: neither"),
        ] {
            let found = Lut::parse(text).unwrap_err().to_string();
            assert!(found.contains(said), "{text:?}: {found}");
        }
    }
}
