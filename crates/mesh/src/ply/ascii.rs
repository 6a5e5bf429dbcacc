use super::header::Scalar;
use super::{Source, place};
use crate::MeshError;
use crate::text::{float, shown, word};

/// Words of a text.
pub(super) struct Ascii<'a> {
    bytes: &'a [u8],
    rest: &'a [u8],
}

impl<'a> Ascii<'a> {
    pub(super) fn new(bytes: &'a [u8], header: usize) -> Self {
        Self { bytes, rest: &bytes[header..] }
    }
}

impl Source for Ascii<'_> {
    fn value(&mut self, kind: Scalar) -> Result<f64, MeshError> {
        let Some(word) = word(&mut self.rest) else {
            return Err(
                self.error("the data end too early".into(), "the file is cut off: export the mesh again")
            );
        };
        let value = match kind {
            // Floats are kept as f32 in the end: rounding them once is best.
            Scalar::F32 | Scalar::F64 => float(word).map(f64::from),
            _ => std::str::from_utf8(word).ok().and_then(|w| w.parse().ok()),
        };
        value.ok_or_else(|| self.error(format!("`{}` is not a number", shown(word)), "export the mesh again"))
    }

    fn left(&self) -> usize {
        self.rest.len()
    }

    fn least_size(_: Scalar) -> usize {
        2
    }

    fn error(&self, message: String, help: &str) -> MeshError {
        MeshError::new(place(self.bytes, self.bytes.len() - self.rest.len(), true), message, help)
    }
}
