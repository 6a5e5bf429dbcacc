//! What is wrong with a scene: mistakes as data.

use crate::source::Span;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing is wrong: what was done where the file leaves a choice.
    Note,
    /// The scene can be rendered, but perhaps not as meant.
    Warning,
    /// The scene cannot be rendered.
    Error,
}

impl Severity {
    /// "note", "warning" or "error".
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A place that a diagnostic points at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place; an empty span at byte 0 means the file as a whole.
    pub span: Span,
    /// What is there; may be empty.
    pub text: String,
}

/// One mistake or doubt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// A short stable name of the kind of mistake; all are in [`CODES`].
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// One sentence without a full stop.
    pub message: String,
    /// Where, the main place first; empty where the scene was made by code.
    pub labels: Vec<Label>,
    /// What to do about it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, severity: Severity::Error, message: message.into(), labels: Vec::new(), help: None }
    }

    /// A warning without a place.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, message) }
    }

    /// What was done where nothing is wrong, without a place.
    pub fn note(code: &'static str, message: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::error(code, message) }
    }

    /// Points at a place, if there is one.
    pub fn at(self, span: impl Into<Option<Span>>) -> Self {
        self.label(span, "")
    }

    /// Points at a place, if there is one, and says what is there.
    pub fn label(mut self, span: impl Into<Option<Span>>, text: impl Into<String>) -> Self {
        if let Some(span) = span.into() {
            self.labels.push(Label { span, text: text.into() });
        }
        self
    }

    /// Says what to do.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Says what to do, if that is known.
    pub fn maybe_help(mut self, text: Option<String>) -> Self {
        self.help = text.or(self.help);
        self
    }

    /// Whether the scene cannot be rendered.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Every code of a diagnostic, of this crate and of those that read scenes of other programs and compile, and what it means.
pub const CODES: &[(&str, &str)] = &[
    ("syntax", "The text is not TOML."),
    ("file", "The scene file cannot be read, or is not text."),
    ("unknown-key", "A key that its table does not have."),
    ("unknown-table", "A table that a scene does not have."),
    ("unknown-kind", "A kind, shape or choice that does not exist."),
    ("missing-key", "A key that has no default is absent."),
    ("wrong-type", "A value is of another type than its key takes."),
    ("out-of-range", "A number lies outside what its key allows, or is not finite."),
    ("conflict", "Two keys that exclude each other are both given."),
    ("duplicate-name", "Two objects, lights or instances have the same name, or two files give the same."),
    ("include", "A file cannot be included: it is none, includes itself, or is one too many."),
    ("unknown-material", "No material has this name."),
    ("unknown-preset", "No preset of materials has this name."),
    ("unknown-substance", "No metal, glass or liquid has this name."),
    ("unknown-texture", "No texture has this name."),
    ("unknown-group", "No group has this name."),
    ("texture-cycle", "A texture is made of itself."),
    ("missing-file", "A file that the scene names is not there."),
    ("unknown-format", "A file that the scene names is of no known format."),
    ("missing-material", "An object has neither a material nor emission."),
    ("degenerate", "A shape, direction or placement has no extent."),
    ("too-large", "A shape would make more triangles than fit."),
    ("no-camera", "There is no camera."),
    ("no-light", "Nothing emits light (a warning)."),
    ("empty-scene", "There is no object (a warning)."),
    ("override", "An override cannot be applied."),
    ("material-cycle", "A material is made of itself."),
    ("bad-camera", "A camera of these values shows nothing."),
    ("bad-shape", "A shape of these values has no surface."),
    ("bad-mesh", "A mesh file is damaged, or says what makes no sense."),
    ("bad-image", "A picture cannot be decoded."),
    ("bad-light", "A light of these values shines nowhere, or is not finite."),
    ("bad-photometry", "A file of a luminaire is damaged, or says what makes no sense."),
    ("photometry", "A file of a luminaire departs from its standard, or leaves something open (a warning)."),
    ("no-area", "A lamp has no area to shine from."),
    ("singular-transform", "A placement flattens space, or is not finite."),
    ("unknown-metal", "No metal has this name."),
    ("unknown-ior", "No glass or liquid has this name."),
    ("open-solid", "Glass or a liquid whose surface has holes (a warning)."),
    ("lamp-turned-away", "Everything lies behind a lamp, so that it lights nothing (a warning)."),
    ("picture-dark", "A picture that is black or nearly so, and why (a warning at the end)."),
    ("picture-white", "A picture that is white nearly everywhere, and why (a warning at the end)."),
    ("camera-inside", "The camera is inside of something, perhaps unmeant (a warning)."),
    (
        "unsupported",
        "Something of another program's scene is not rendered: what is done instead (a warning).",
    ),
    ("unknown-directive", "pbrt: no directive has this name."),
    ("unknown-element", "Mitsuba: no element has this name."),
    ("unknown-attribute", "Mitsuba: the element has no such attribute (a warning)."),
    ("unknown-parameter", "Another program's scene: the object has no such parameter (a warning)."),
    ("missing-parameter", "Another program's scene: a parameter without default is absent."),
    ("parameter", "Another program's scene: the value of a parameter makes no sense."),
    ("unknown-name", "Another program's scene: nothing has this name."),
    ("unknown-id", "Mitsuba: nothing has this id."),
    ("undefined", "Mitsuba: nothing says what a `$name` stands for."),
    ("duplicate", "Another program's scene: something is given twice."),
    ("cycle", "Another program's scene: something is made of itself."),
    ("node-cycle", "glTF: a node holds itself, or nodes are nested too deeply."),
    ("mesh", "Another program's scene: a mesh is damaged, or says what makes no sense."),
    ("spectrum", "Another program's scene: a spectrum makes no sense."),
    ("camera", "Which of several cameras is used (a note)."),
    ("ground", "Whether a ground is laid under a model (a note)."),
    ("integrator", "What the integrator that a file asks for means here (a note)."),
    ("scene", "Which of several scenes is rendered (a note)."),
    ("more", "Further mistakes were left out."),
];

/// At most this many diagnostics are kept; the rest are counted.
const MOST: usize = 100;

/// Collects diagnostics, at most a hundred.
#[derive(Debug, Default)]
pub(crate) struct Report {
    kept: Vec<Diagnostic>,
    left_out: usize,
}

impl Report {
    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        if self.kept.len() < MOST {
            self.kept.push(diagnostic);
        } else {
            self.left_out += 1;
        }
    }

    pub(crate) fn has_error(&self) -> bool {
        self.kept.iter().any(Diagnostic::is_error)
    }

    /// Counts a mistake that would be left out anyway, so that nobody needs to put it into words; whether it was.
    pub(crate) fn count_if_full(&mut self) -> bool {
        let full = self.kept.len() >= MOST;
        self.left_out += usize::from(full);
        full
    }

    /// Keeps some; those left out before are forgotten.
    pub(crate) fn retain(&mut self, keep: impl Fn(&Diagnostic) -> bool) {
        self.kept.retain(keep);
        self.left_out = 0;
    }

    pub(crate) fn append(&mut self, other: Self) {
        for diagnostic in other.kept {
            self.push(diagnostic);
        }
        self.left_out += other.left_out;
    }

    /// In the order of the text, warnings among errors.
    pub(crate) fn finish(mut self) -> Vec<Diagnostic> {
        self.kept.sort_by_key(|d| d.labels.first().map(|l| (l.span.file, l.span.start, l.span.end)));
        if self.left_out > 0 {
            self.kept
                .push(Diagnostic::error("more", format!("{} more mistakes are not shown", self.left_out)));
        }
        self.kept
    }
}

/// A user's string between backticks: control characters escaped, 60 characters at most.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("`");
    for (i, c) in text.chars().enumerate() {
        if i == 60 {
            out.push('…');
            break;
        }
        if c.is_control() { out.extend(c.escape_default()) } else { out.push(c) }
    }
    out.push('`');
    out
}
