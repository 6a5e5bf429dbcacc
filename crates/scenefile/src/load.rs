//! From a path or a text to a checked description.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::check::check_into;
use crate::desc::SceneDesc;
use crate::diagnostic::{Diagnostic, Report};
use crate::include::{self, Parsed};
use crate::snippet::render_all;
use crate::source::{FileId, Sources, Span};
use crate::{overrides, read};

/// Bytes of a scene file, at most: the parser takes up to 150 bytes of memory for each. Large meshes belong into mesh
/// files.
pub const MOST_BYTES: u64 = 12 << 20;

/// What became of a scene file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The description; `None` if there is any error.
    pub desc: Option<SceneDesc>,
    /// Every mistake and doubt, in the order of the text; a hundred at most.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that spans point into: the scene file, those that it includes, then one for each override.
    pub sources: Sources,
}

impl Loaded {
    /// All diagnostics as plain text; empty if there are none.
    pub fn render(&self) -> String {
        render_all(&self.diagnostics, &self.sources)
    }
}

/// Reads and checks a scene file. Never panics; a file that cannot be read is a diagnostic like any other.
///
/// `overrides` are texts like `photon_map.photons=100000`, applied in order before anything is checked.
pub fn load(path: &Path, overrides: &[String]) -> Loaded {
    match read_text(path) {
        Ok(text) => parse(&text, path, overrides),
        Err(diagnostic) => {
            let mut sources = Sources::default();
            let file = sources.add(path, "");
            let diagnostic = diagnostic.at(Span { file, start: 0, end: 0 });
            Loaded { desc: None, diagnostics: vec![diagnostic], sources }
        }
    }
}

/// The text of a file without a byte order mark.
pub(crate) fn read_text(path: &Path) -> Result<String, Diagnostic> {
    let name = path.display();
    let fail = |reason: String| Diagnostic::error("file", format!("the scene {name} {reason}"));
    let io = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => fail("is not there".into()),
        std::io::ErrorKind::PermissionDenied => fail("may not be read: permission denied".into()),
        _ => fail(format!("cannot be read: {error}")),
    };
    let meta = std::fs::metadata(path).map_err(io)?;
    if meta.is_dir() {
        return Err(fail("is a folder".into()).help("name the scene file in it"));
    }
    let too_large = || {
        fail(format!("is larger than {} MiB", MOST_BYTES >> 20))
            .help("put large meshes into PLY or OBJ files and name these")
    };
    if meta.is_file() && meta.len() > MOST_BYTES {
        return Err(too_large());
    }
    // One byte more than allowed, for pipes and files that grow.
    let mut bytes = Vec::new();
    File::open(path).map_err(io)?.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(too_large());
    }
    decode(bytes).map_err(|(reason, help)| fail(reason).maybe_help(help))
}

fn decode(bytes: Vec<u8>) -> Result<String, (String, Option<String>)> {
    let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&b| b == b'\n').count() + 1;
        let help = utf16.then(|| "it seems to be UTF-16: save it as UTF-8".to_owned());
        (format!("is not UTF-8 text: byte {valid}, in line {line}, is wrong"), help)
    })
}

/// Checks a text as if it stood in the file `path`, from whose folder relative file names start.
pub fn parse(text: &str, path: &Path, overrides: &[String]) -> Loaded {
    let tree = |text: &str, file, sources: &mut Sources| include::with_includes(text, path, file, sources);
    parse_checked(text, path, tree, overrides, |report, desc, file| check_into(report, desc, Some(file)))
}

/// [`parse`] of what [`to_toml`](crate::to_toml) wrote of a description that was good: it is not checked again, and the
/// files that it names need not be there.
pub fn reread(text: &str, base: &Path) -> Loaded {
    let alone = |text: &str, file, _: &mut Sources| include::alone(text, file);
    parse_checked(text, &base.join("scene.toml"), alone, &[], |_, _, _| {})
}

fn parse_checked(
    text: &str,
    path: &Path,
    tree: impl FnOnce(&str, FileId, &mut Sources) -> Parsed,
    overrides: &[String],
    check: impl FnOnce(&mut Report, &SceneDesc, FileId),
) -> Loaded {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut sources = Sources::default();
    let file = sources.add(path, text);
    let mut report = Report::default();
    let (desc, broken) = {
        let parsed = tree(text, file, &mut sources);
        read_tree(&mut report, parsed, file, overrides, &mut sources)
    };
    let mut desc = desc;
    desc.base = path.parent().map(Path::to_path_buf).unwrap_or_default();
    if !broken {
        check(&mut report, &desc, file);
    }
    let diagnostics = report.finish();
    let failed = diagnostics.iter().any(Diagnostic::is_error);
    Loaded { desc: (!failed).then_some(desc), diagnostics, sources }
}

/// The description, and whether the text has syntax errors, after which names and completeness mean nothing.
pub(crate) fn read_tree(
    report: &mut Report,
    parsed: Parsed,
    file: FileId,
    overrides: &[String],
    sources: &mut Sources,
) -> (SceneDesc, bool) {
    let Parsed { mut root, errors, twice } = parsed;
    let mut wrong_overrides = Vec::new();
    for text in overrides {
        if let Err(error) = overrides::apply(&mut root, text, sources) {
            wrong_overrides.push(error);
        }
    }
    let broken = !errors.is_empty();
    // What stands on lines before the first syntax error was read as written; what follows may be garbled.
    let first = errors.iter().filter_map(|e| e.labels.first()).filter(|l| l.span.file == file);
    let first = first.map(|l| l.span.start).min().unwrap_or(0);
    let text = sources.get(file).map_or("", |source| &source.text);
    let line = text.get(..first.min(text.len())).and_then(|t| t.rfind('\n')).unwrap_or(0);
    for error in errors.into_iter().chain(twice).chain(wrong_overrides) {
        report.push(error);
    }
    let mut mistakes = Report::default();
    let desc = read::scene(&mut mistakes, &root);
    if broken {
        mistakes.retain(|d| {
            d.code != "missing-key" && d.labels.iter().all(|l| l.span.file == file && l.span.end <= line)
        });
    }
    report.append(mistakes);
    (desc, broken)
}
