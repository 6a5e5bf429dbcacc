//! Diagnostics of importers: each thing is said once.

use std::collections::HashMap;

use scenefile::{Diagnostic, Severity, Span};

/// At most this many diagnostics are kept; the rest are counted.
const MOST: usize = 100;

/// Collects diagnostics; of equal messages the first place is kept and the others are counted.
#[derive(Debug, Default)]
pub(crate) struct Report {
    kept: Vec<(Diagnostic, usize)>,
    by_message: HashMap<String, usize>,
    left_out: [usize; 2],
}

impl Report {
    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        if let Some(&i) = self.by_message.get(&diagnostic.message) {
            self.kept[i].1 += 1;
        } else if self.kept.len() < MOST {
            self.by_message.insert(diagnostic.message.clone(), self.kept.len());
            self.kept.push((diagnostic, 1));
        } else {
            self.left_out[usize::from(diagnostic.is_error())] += 1;
        }
    }

    /// Something that cannot be understood or rendered.
    pub(crate) fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::error(code, message).at(span));
    }

    /// Something that is not supported: what it is and what is done instead.
    pub(crate) fn instead(&mut self, message: impl Into<String>, what: &str, span: Span) {
        self.push(Diagnostic::warning("unsupported", format!("{}: {what}", message.into())).at(span));
    }

    /// What was done where nothing is wrong.
    pub(crate) fn note(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::note(code, message).at(span));
    }

    pub(crate) fn has_error(&self) -> bool {
        self.left_out[1] > 0 || self.kept.iter().any(|(d, _)| d.is_error())
    }

    /// In the order of the text.
    pub(crate) fn finish(self) -> Vec<Diagnostic> {
        let mut all: Vec<Diagnostic> = self
            .kept
            .into_iter()
            .map(|(d, n)| match n {
                1 => d,
                2 => d.help("the same in one more place"),
                n => d.help(format!("the same in {} more places", n - 1)),
            })
            .collect();
        all.sort_by_key(|d| d.labels.first().map(|l| (l.span.file, l.span.start, l.span.end)));
        for (n, severity) in self.left_out.into_iter().zip([Severity::Warning, Severity::Error]) {
            if n > 0 {
                let message = format!("{n} more {}s are not shown", severity.name());
                all.push(Diagnostic { severity, ..Diagnostic::error("more", message) });
            }
        }
        all
    }
}
