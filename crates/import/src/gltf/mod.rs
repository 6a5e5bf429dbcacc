//! glTF 2.0, text (`.gltf`) and binary (`.glb`).
//!
//! Facts of the format: Khronos, *glTF 2.0 Specification* (2.0.1), §§ as cited, and the registered extensions by name. The
//! JSON is read into a tree with places ([`json`]), so that every message has one; the rest follows the file's own order of
//! things: bytes, accessors, meshes, nodes, materials.
//!
//! glTF's world is ours: right-handed, +y up, metres. Its texture coordinates grow downward, ours upward.

mod accessor;
mod bytes;
mod camera;
mod coats;
mod extensions;
mod fault;
mod json;
mod lights;
mod materials;
mod mesh;
mod nodes;
mod pose;
mod ranges;
mod textures;

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use scenefile::desc::SceneDesc;
use scenefile::{Diagnostic, FileId, Loaded, Sources, Span};

use crate::file::read_plain;
use crate::report::Report;
use crate::stage::{self, Given, Ground};
use accessor::Source;
use bytes::Buffers;
use fault::{Fault, Known};
use json::Value;
use materials::Surface;

/// Bytes of JSON, at most.
const MOST_TEXT: usize = 1 << 30;
/// Bytes of meshes for each byte of the files, at most, and how many in any case.
const MOST_GROWTH: u64 = 64;
const SMALL: u64 = 256 << 20;

const WHOLE: Span = Span { file: FileId(0), start: 0, end: 0 };

/// The state of an import.
struct Importer<'t> {
    source: &'t Source<'t>,
    report: Report,
    desc: SceneDesc,
    /// Bytes that meshes may still take.
    budget: u64,
    /// Names of objects that are taken, with how often.
    names: HashMap<String, usize>,
    /// By number, and whether vertices have colours.
    surfaces: HashMap<(Option<usize>, bool), Surface>,
    /// Textures by what they are.
    textures: HashMap<String, String>,
    /// Names of the bytes of images.
    images: HashMap<usize, Option<scenefile::desc::ImageSource>>,
    image_names: BTreeSet<String>,
    /// Whether a surface shines brighter than white.
    shines: bool,
}

/// Reads and checks a scene. A file that cannot be read is a diagnostic like any other.
pub(crate) fn load(path: &Path, ground: Ground) -> Loaded {
    let mut sources = Sources::default();
    let read = read_plain(path).and_then(bytes::open);
    let mut container = match read {
        Ok(container) if container.text.len() <= MOST_TEXT => container,
        read => {
            let why = read.err().unwrap_or_else(|| format!("has more than {} MiB of JSON", MOST_TEXT >> 20));
            sources.add(path, "");
            let error =
                Diagnostic::error("file", format!("the scene file {} {why}", path.display())).at(WHOLE);
            return Loaded { desc: None, diagnostics: vec![error], sources };
        }
    };
    let text = std::mem::take(&mut container.text);
    let base = path.parent().unwrap_or(Path::new(""));
    let (desc, diagnostics) =
        match json::parse(&text).and_then(|root| import(&root, &mut container, base, ground)) {
            Ok((desc, diagnostics)) => (desc, diagnostics),
            Err(fault) => (None, vec![fault.diagnostic()]),
        };
    sources.add(path, text);
    Loaded { desc, diagnostics, sources }
}

fn import(
    root: &Value<'_>,
    container: &mut bytes::Container,
    base: &Path,
    ground: Ground,
) -> Known<(Option<SceneDesc>, Vec<Diagnostic>)> {
    let version = root.get("asset").map(|asset| asset.text("version")).transpose()?.flatten();
    if !version.is_some_and(|v| v.starts_with("2.")) {
        let text = match version {
            Some(v) => format!("this is glTF {v}; version 2 can be read"),
            None => "there is no `asset.version`: this is no glTF file".to_owned(),
        };
        return Err(Fault::new("file", text, root.get("asset").map_or(WHOLE, Value::span)));
    }
    let buffers = Buffers::read(root, container, base)?;
    let budget = SMALL.max(MOST_GROWTH.saturating_mul(buffers.size() as u64));
    let source = Source { root, buffers };
    let mut importer = Importer {
        source: &source,
        report: Report::default(),
        desc: SceneDesc { base: base.to_path_buf(), ..SceneDesc::default() },
        budget,
        names: HashMap::new(),
        surfaces: HashMap::new(),
        textures: HashMap::new(),
        images: HashMap::new(),
        image_names: BTreeSet::new(),
        shines: false,
    };
    importer.extensions()?;
    importer.scene()?;
    Ok(importer.finish(ground))
}

impl<'t> Importer<'t> {
    /// A list of the whole file.
    fn list(&self, key: &str) -> Known<&'t [Value<'t>]> {
        self.source.root.array(key)
    }

    fn fault(&mut self, fault: Fault) {
        self.report.push(fault.diagnostic());
    }

    /// The value, or its mistake reported.
    fn told<T>(&mut self, known: Known<T>) -> Option<T> {
        known.map_err(|fault| self.fault(fault)).ok()
    }

    /// Counts bytes that a mesh takes.
    fn spend(&mut self, bytes: usize, span: Span) -> Known<()> {
        match self.budget.checked_sub(bytes as u64) {
            Some(left) => {
                self.budget = left;
                Ok(())
            }
            None => Err(Fault::new("too-large", "the meshes are larger than the file makes plausible", span)),
        }
    }

    /// A name for an object that no other has; `None` for none.
    fn free_name(&mut self, wanted: &str) -> Option<String> {
        if wanted.is_empty() {
            return None;
        }
        loop {
            let used = self.names.entry(wanted.to_owned()).or_default();
            *used += 1;
            if *used == 1 {
                return Some(wanted.to_owned());
            }
            let name = format!("{wanted}-{used}");
            if !self.names.contains_key(&name) {
                self.names.insert(name.clone(), 1);
                return Some(name);
            }
        }
    }

    fn finish(mut self, ground: Ground) -> (Option<SceneDesc>, Vec<Diagnostic>) {
        if !self.report.has_error() {
            let light = !self.desc.lights.is_empty() || self.shines;
            stage::complete(&mut self.desc, Given { light, ground }, &mut self.report);
            scenefile::check(&self.desc).into_iter().for_each(|d| self.report.push(d));
        }
        let diagnostics = self.report.finish();
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        ((!failed).then_some(self.desc), diagnostics)
    }
}
