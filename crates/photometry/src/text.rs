//! Lines and numbers.

use std::fmt;

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhotometryError {
    /// The line, counted from 1.
    pub line: usize,
    /// What is wrong there.
    pub message: String,
}

impl PhotometryError {
    pub(crate) fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}

impl fmt::Display for PhotometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for PhotometryError {}

/// Something that a file says and that is not taken into account.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// The line, counted from 1.
    pub line: usize,
    /// What it is, and what is done instead.
    pub text: String,
}

/// The lines of a text, whatever ends them: at least one.
pub(crate) fn lines(text: &str) -> Vec<&str> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = Vec::new();
    let mut rest = text;
    while let Some(end) = rest.find(['\r', '\n']) {
        lines.push(&rest[..end]);
        let skip = if rest[end..].starts_with("\r\n") { 2 } else { 1 };
        rest = &rest[end + skip..];
    }
    lines.push(rest);
    lines
}

/// At most this much of a word is shown in a message.
const SHOWN: usize = 24;

/// A word as it is shown in messages.
pub(crate) fn shown(word: &str) -> String {
    word.chars().take(SHOWN).filter(|c| !c.is_control()).collect()
}

/// Numbers of a text one after the other, separated by blanks and commas, on any number of lines.
pub(crate) struct Numbers<'t> {
    words: Box<dyn Iterator<Item = (usize, &'t str)> + 't>,
    /// The line of the last number.
    pub line: usize,
    /// Bytes that are left at most.
    bytes: usize,
}

impl<'t> Numbers<'t> {
    /// Those from the line with that index on.
    pub fn new(lines: &'t [&'t str], first: usize) -> Self {
        let rest = &lines[first.min(lines.len())..];
        let bytes = rest.iter().map(|line| line.len() + 1).sum();
        let words = rest.iter().enumerate().flat_map(move |(i, line)| {
            line.split(|c: char| c.is_whitespace() || c == ',')
                .filter(|word| !word.is_empty())
                .map(move |word| (first + i + 1, word))
        });
        Self { words: Box::new(words), line: first + 1, bytes }
    }

    /// The next number, which is `what`.
    pub fn next(&mut self, what: &str) -> Result<f64, PhotometryError> {
        let Some((line, word)) = self.words.next() else {
            return Err(PhotometryError::new(self.line, format!("the file ends before {what}")));
        };
        self.line = line;
        self.bytes = self.bytes.saturating_sub(word.len() + 1);
        number(line, word, what)
    }

    /// The next number, a count of numbers that are to follow (`each` for each one): no more than the file can hold.
    pub fn count(&mut self, what: &str, each: usize) -> Result<usize, PhotometryError> {
        let x = self.next(what)?;
        let held = self.bytes.div_ceil(2) as f64;
        if x.fract() != 0.0 || x < 1.0 {
            return Err(PhotometryError::new(self.line, format!("{what} is {x}")));
        }
        if x * each as f64 > held {
            let message = format!("{what} is {x}, more than the file can hold");
            return Err(PhotometryError::new(self.line, message));
        }
        Ok(x as usize)
    }

    /// That many numbers, each with the line that it stands on; the caller has checked that the file can hold them.
    pub fn list(&mut self, count: usize, what: &str) -> Result<Vec<(usize, f64)>, PhotometryError> {
        if count > self.bytes.div_ceil(2) {
            let message = format!("{count} numbers ({what}) are due, more than the file can hold");
            return Err(PhotometryError::new(self.line, message));
        }
        (0..count).map(|_| self.next(what).map(|x| (self.line, x))).collect()
    }
}

/// A finite number.
pub(crate) fn number(line: usize, word: &str, what: &str) -> Result<f64, PhotometryError> {
    // Not what Rust takes for numbers besides: inf, nan.
    let digits = word.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    match word.parse::<f64>() {
        Ok(x) if digits && x.is_finite() => Ok(x),
        _ => Err(PhotometryError::new(line, format!("{what} must be a number, not `{}`", shown(word)))),
    }
}

/// Angles in degrees, strictly ascending within a range.
pub(crate) fn angles(
    found: &[(usize, f64)],
    what: &str,
    range: [f64; 2],
) -> Result<Vec<f32>, PhotometryError> {
    for (i, &(line, x)) in found.iter().enumerate() {
        if !(range[0]..=range[1]).contains(&x) {
            return Err(PhotometryError::new(line, format!("{what} of {x} degrees")));
        }
        if i > 0 && x as f32 <= found[i - 1].1 as f32 {
            let message = format!("{what} of {x} degrees after one of {}", found[i - 1].1);
            return Err(PhotometryError::new(line, message));
        }
    }
    Ok(found.iter().map(|&(_, x)| x as f32).collect())
}

/// Candela: `found` times a factor.
pub(crate) fn candela(found: &[(usize, f64)], factor: f64) -> Result<Vec<f32>, PhotometryError> {
    let one = |&(line, x): &(usize, f64)| {
        let scaled = (x * factor) as f32;
        if scaled >= 0.0 && scaled.is_finite() {
            Ok(scaled)
        } else {
            Err(PhotometryError::new(line, format!("an intensity of {x}")))
        }
    };
    found.iter().map(one).collect()
}
