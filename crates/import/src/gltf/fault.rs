//! What is wrong with a file, as an error of the functions here.

use scenefile::{Diagnostic, Span};

/// A mistake and its place.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub code: &'static str,
    pub message: String,
    pub span: Span,
}

/// A value or why there is none.
pub(super) type Known<T> = Result<T, Fault>;

impl Fault {
    pub(super) fn new(code: &'static str, message: impl Into<String>, span: Span) -> Self {
        Self { code, message: message.into(), span }
    }

    pub(super) fn diagnostic(self) -> Diagnostic {
        Diagnostic::error(self.code, self.message).at(self.span)
    }
}
