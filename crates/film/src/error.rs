use std::fmt;

use crate::FilterKind;

/// What film arithmetic refuses.
#[derive(Clone, Debug, PartialEq)]
pub enum FilmError {
    /// A filter's radius is not a positive finite number (pixels).
    FilterRadius {
        /// The filter asked for.
        kind: FilterKind,
        /// The radius given.
        radius: f32,
    },
    /// Samples, tiles or films whose sizes (width, height in pixels) do not fit together.
    Size {
        /// Width and height wanted.
        expected: [usize; 2],
        /// Width and height found, or `[number of pixels, 1]` for a list.
        found: [usize; 2],
    },
    /// This pass is in the film already.
    DuplicatePass(u64),
    /// The name of a layer is empty, too long, taken, or has characters that files refuse.
    LayerName(String),
    /// Named layers that do not fit together.
    Layers {
        /// The film's.
        expected: Vec<String>,
        /// What was to be added; a pass knows their number alone, so its names are empty.
        found: Vec<String>,
    },
    /// More passes than the sums have room for ([`crate::Film::MAX_PASSES`]).
    TooManyPasses,
}

impl fmt::Display for FilmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FilterRadius { kind, radius } => {
                write!(
                    f,
                    "the radius of the {} filter must be positive and finite, not {radius}",
                    kind.name()
                )
            }
            Self::Size { expected, found } => write!(
                f,
                "sizes differ: {}x{} pixels expected, {}x{} found",
                expected[0], expected[1], found[0], found[1]
            ),
            Self::DuplicatePass(pass) => write!(f, "pass {pass} is in the film already"),
            Self::LayerName(name) => write!(
                f,
                "{name:?} cannot name a layer: it must be of 1 to 200 letters, digits, _ and -, and not taken"
            ),
            Self::Layers { expected, found } if found.iter().all(String::is_empty) => {
                write!(f, "the film has {} named layers, the pass {}", expected.len(), found.len())
            }
            Self::Layers { expected, found } => {
                write!(f, "named layers differ: [{}] and [{}]", expected.join(", "), found.join(", "))
            }
            Self::TooManyPasses => write!(f, "a film holds at most {} passes", crate::Film::MAX_PASSES),
        }
    }
}

impl std::error::Error for FilmError {}
