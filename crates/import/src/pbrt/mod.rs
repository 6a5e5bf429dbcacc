//! pbrt-v4, and v3 where its names differ.
//!
//! Facts of the format: the file format pages of pbrt-v4 and pbrt-v3, and the book (Pharr, Jakob & Humphreys 2023).
//! The parser follows the directives and keeps the graphics state; each kind of thing is lowered in a file of its own.
//!
//! pbrt's camera looks along +z with +x on the right and +y up, a left-handed frame; ours is right-handed. Where the
//! camera's transform does not swap hands by itself the whole world is mirrored at x = 0, which shows the same picture.

mod area;
mod camera;
mod color;
mod directives;
mod film;
mod image_map;
mod infinite;
mod lens;
mod lexer;
mod lights;
mod lower;
mod materials;
mod media;
mod metals;
mod opacity;
mod params;
mod parser;
mod roughness;
mod shapes;
mod soft;
mod state;
mod subdivision;
mod textures;
mod version3;
mod white;

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use scenefile::desc::{Group, SceneDesc};
use scenefile::{Diagnostic, FileId, Loaded, Sources, Span};

use crate::file;
use crate::matrix::Matrix;
use crate::report::Report;
use lower::MaterialUse;
use media::Filling;
use params::Params;
use state::{Graphics, Scope};
use textures::Textures;
use white::WhiteBalance;

/// Bytes of text of a scene, at most, with all that it includes, decompressed.
const MOST_BYTES: u64 = 512 << 20;
/// Files within files within files.
const MOST_DEEP: usize = 32;
/// Files included, at most.
const MOST_FILES: usize = 10_000;

/// A text being read.
struct Open {
    file: FileId,
    /// The next byte.
    at: usize,
    path: PathBuf,
    /// The same, canonical.
    whole: PathBuf,
    /// Scopes that were open when it began.
    scopes: usize,
    /// Restored at its end.
    graphics: Option<Box<Graphics>>,
}

/// What was said before the world began, and is understood when it begins.
#[derive(Default)]
struct Preamble {
    camera: Option<(Params, Matrix, String)>,
    film: Option<(Params, String)>,
    filter: Option<(Params, String)>,
    sampler: Option<(Params, String)>,
    integrator: Option<(Params, String)>,
    /// Columns and rows of the picture that are rendered, each from and up to.
    crop: Option<[[u32; 2]; 2]>,
    /// Of the film, in mm.
    diagonal_mm: f64,
}

/// An object between its begin and its end.
struct OpenObject {
    name: String,
    group: Group,
}

/// The state of an import.
struct Importer {
    sources: Sources,
    report: Report,
    /// Folder of the scene file, where pbrt looks for files.
    base: PathBuf,
    open: Vec<Open>,
    bytes_left: u64,
    peeked: Option<(lexer::Token, Span)>,
    desc: SceneDesc,
    preamble: Preamble,
    in_world: bool,
    graphics: Graphics,
    scopes: Vec<Scope>,
    coordinate_systems: HashMap<String, Matrix>,
    textures: Textures,
    materials: BTreeMap<String, MaterialUse>,
    /// Copies of materials, by the key of the original and what is different.
    variants: HashMap<String, String>,
    /// What named media absorb, as far as they are rendered.
    media: HashMap<String, Option<Filling>>,
    object: Option<OpenObject>,
    /// Vertices of shapes that became meshes.
    vertices: u64,
    /// Where the last object is one of curves: whether it lies in the open object, and how many there are then.
    curves_at: Option<(bool, usize)>,
    /// Whether version 3 wrote the scene: it ends with a directive that version 4 does not have.
    is_version_3: bool,
    /// Our world from pbrt's.
    mirror: Matrix,
    /// Brightness of film and sensor.
    gain: f64,
    /// What the film takes for white.
    white: WhiteBalance,
}

/// Reads and checks a scene. A file that cannot be read is a diagnostic like any other.
pub(crate) fn load(path: &Path) -> Loaded {
    let mut importer = Importer::new(path);
    let nowhere = Span { file: FileId(0), start: 0, end: 0 };
    let name = path.display().to_string();
    if importer.open_file(path, nowhere, &name).is_ok() {
        importer.run();
    }
    importer.finish()
}

impl Importer {
    fn new(path: &Path) -> Self {
        let base = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Self {
            sources: Sources::default(),
            report: Report::default(),
            base: base.clone(),
            open: Vec::new(),
            bytes_left: MOST_BYTES,
            peeked: None,
            desc: SceneDesc { base, ..SceneDesc::default() },
            preamble: Preamble::default(),
            in_world: false,
            graphics: Graphics::default(),
            scopes: Vec::new(),
            coordinate_systems: HashMap::new(),
            textures: Textures::default(),
            materials: BTreeMap::new(),
            variants: HashMap::new(),
            media: HashMap::new(),
            object: None,
            vertices: 0,
            curves_at: None,
            is_version_3: false,
            mirror: Matrix::IDENTITY,
            gain: 1.0,
            white: WhiteBalance::NONE,
        }
    }

    /// Opens a text to be read next; `name`: as the user wrote it.
    fn open_file(&mut self, path: &Path, span: Span, name: &str) -> Result<(), ()> {
        let fail = |this: &mut Self, reason: &str| {
            if this.open.is_empty() {
                this.sources.add(path, "");
            }
            this.report.error("file", format!("the scene file {name} {reason}"), span);
            Err(())
        };
        // The same file through another name is the same file.
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if self.open.iter().any(|open| open.whole == whole) {
            return fail(self, "includes itself");
        }
        if self.open.len() >= MOST_DEEP {
            return fail(self, &format!("is included through more than {MOST_DEEP} files"));
        }
        if self.sources.iter().count() >= MOST_FILES {
            return fail(self, &format!("is one of more than {MOST_FILES}"));
        }
        let bytes = match file::read(path, self.bytes_left) {
            Ok(bytes) => bytes,
            Err(reason) => return fail(self, &reason),
        };
        self.bytes_left -= bytes.len() as u64;
        // Comments are in any encoding, the format itself is ASCII.
        let text =
            String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned());
        let file = self.sources.add(path, text);
        let at = if self.text(file).starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let ended = |line: &str| line.trim_start().starts_with("WorldEnd");
        if self.open.is_empty() && self.text(file).lines().rev().take(100).any(ended) {
            self.is_version_3 = true;
        }
        let scopes = self.scopes.len();
        self.open.push(Open { file, at, path: path.to_path_buf(), whole, scopes, graphics: None });
        Ok(())
    }

    fn text(&self, file: FileId) -> &str {
        self.sources.get(file).map_or("", |source| &source.text)
    }

    fn slice(&self, span: Span) -> &str {
        self.text(span.file).get(span.start..span.end).unwrap_or_default()
    }

    /// A file that the scene names, relative to the scene's folder: pbrt looks there; else beside the text that names
    /// it.
    fn find_file(&self, name: &str) -> PathBuf {
        let name = Path::new(name);
        if name.is_absolute() || self.base.join(name).exists() {
            return name.to_path_buf();
        }
        let folder = self.open.last().and_then(|open| open.path.parent()).unwrap_or(Path::new(""));
        let beside = folder.join(name);
        match beside.strip_prefix(&self.base) {
            Ok(inner) if beside.exists() => inner.to_path_buf(),
            _ if beside.exists() => beside.canonicalize().unwrap_or(beside),
            _ => name.to_path_buf(),
        }
    }

    fn finish(mut self) -> Loaded {
        for scope in std::mem::take(&mut self.scopes) {
            self.report.error(
                "syntax",
                format!("`{}` without `{}`", scope.begin(), scope.end()),
                scope.span(),
            );
        }
        if !self.in_world && !self.report.has_error() {
            let whole = Span { file: FileId(0), start: 0, end: 0 };
            self.report.error("syntax", "there is no `WorldBegin`", whole);
        }
        if !self.report.has_error() {
            scenefile::check(&self.desc).into_iter().for_each(|d| self.report.push(d));
        }
        let diagnostics = self.report.finish();
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        Loaded { desc: (!failed).then_some(self.desc), diagnostics, sources: self.sources }
    }
}
