//! Diagnostics of importers: each thing is said once.

use std::collections::HashMap;

use scenefile::desc::Sppm;
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

    /// That a file asks for `sppm`, and what its settings mean here.
    pub(crate) fn asks_for_sppm(&mut self, sppm: &Sppm, span: Span) {
        let radius = sppm.radius.map_or("no radius".to_owned(), |radius| format!("a radius of {radius}"));
        let photons = sppm
            .photons
            .map_or("as many photons a pass as pixels".to_owned(), |n| format!("{n} photons a pass"));
        let message = format!("the file asks for `sppm`, with {radius} and {photons}");
        let help = "`--integrator auto` is usually better: it has less noise, and needs neither radius nor number of photons";
        self.push(Diagnostic::note("integrator", message).at(span).help(help));
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

/// The known name nearest to a misspelt one, if any is near.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let name: Vec<char> = name.chars().take(64).collect();
    let distance = |other: &str| {
        let other: Vec<char> = other.chars().collect();
        let mut row: Vec<usize> = (0..=other.len()).collect();
        for (i, a) in name.iter().enumerate() {
            let mut diagonal = row[0];
            row[0] = i + 1;
            for (j, b) in other.iter().enumerate() {
                let kept = diagonal + usize::from(a != b);
                diagonal = row[j + 1];
                row[j + 1] = kept.min(diagonal + 1).min(row[j] + 1);
            }
        }
        row[other.len()]
    };
    let near = 1 + name.len() / 4;
    known.map(|k| (distance(k), k)).filter(|(d, _)| *d <= near).min().map(|(_, k)| k)
}
