//! Mitsuba 3 scenes (XML), and those of 0.6 where they differ.
//!
//! Facts of the format: the documentation of Mitsuba 3 and of Mitsuba 0.6, and what Mitsuba 3.9 renders. The text becomes
//! elements, these become plugins with typed parameters, and each kind of plugin is lowered in a file of its own.

mod bsdf;
mod build;
mod emitters;
mod matter;
mod medium;
mod meshes;
mod plugin;
mod principled;
mod scatter;
mod sensor;
mod serialized;
mod shapes;
mod spectrum;
mod sunsky;
mod textures;
mod transform;
mod xml;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use scenefile::desc::{ColorDesc, SceneDesc};
use scenefile::{Diagnostic, Loaded, Sources, Span};

use crate::matrix::Matrix;
use crate::report::Report;
use bsdf::{UseKey, Uv};
use plugin::{Plugin, Tag};
use shapes::Target;
use xml::{Defaults, Node};

/// Bytes of text of a scene, at most, with all that it includes and that its defaults stand for.
const MOST_BYTES: u64 = 512 << 20;

/// The state of an import.
struct Importer {
    sources: Sources,
    report: Report,
    /// Folder of the scene file.
    base: PathBuf,
    /// Further folders in which files are looked for.
    folders: Vec<PathBuf>,
    /// Files being read: their folders, and their canonical paths.
    open: Vec<(PathBuf, PathBuf)>,
    bytes_left: u64,
    defaults: Defaults,
    desc: SceneDesc,
    ids: HashMap<String, Rc<Plugin>>,
    /// Plugins so far.
    plugins: usize,
    /// Keys of the description by use; `None`: nothing scatters.
    materials: HashMap<UseKey, Option<String>>,
    textures: HashMap<(usize, Uv), ColorDesc>,
    /// How often a texture was asked for.
    texture_uses: usize,
    /// Materials that have any.
    textured: HashSet<String>,
    groups: HashMap<usize, String>,
    default_material: Option<String>,
    /// Our world from Mitsuba's.
    mirror: Matrix,
}

/// Reads and checks a scene. A file that cannot be read is a diagnostic like any other. `overrides`: `name=value`, each of which
/// replaces a `<default>`.
pub(crate) fn load(path: &Path, overrides: &[String]) -> Loaded {
    let base = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let mut importer = Importer {
        sources: Sources::default(),
        report: Report::default(),
        base: base.clone(),
        folders: Vec::new(),
        open: Vec::new(),
        bytes_left: MOST_BYTES,
        defaults: Defaults::default(),
        desc: SceneDesc { base, ..SceneDesc::default() },
        ids: HashMap::new(),
        plugins: 0,
        materials: HashMap::new(),
        textures: HashMap::new(),
        texture_uses: 0,
        textured: HashSet::new(),
        groups: HashMap::new(),
        default_material: None,
        mirror: Matrix::IDENTITY,
    };
    for text in overrides {
        match text.split_once('=') {
            Some((name, value)) => importer.defaults.give(name.trim(), value.trim()),
            None => importer.refuse_override(text, "an override reads `name=value`"),
        }
    }
    let name = path.display().to_string();
    if let Some(root) = importer.read_file(path, None, &name) {
        importer.run(&root);
    }
    let idle: Vec<String> = importer.defaults.idle().map(str::to_owned).collect();
    for name in idle {
        let text = format!("no <default> of the scene is named `{name}`");
        importer.refuse_override(&name, &text);
    }
    importer.finish()
}

impl Importer {
    fn refuse_override(&mut self, text: &str, reason: &str) {
        let file = self.sources.add("--set", text);
        let span = Span { file, start: 0, end: text.len() };
        self.report.push(Diagnostic::error("override", reason).at(span));
    }

    /// A file that the scene names, as the description does: relative to the scene's folder, else to that of the
    /// file that is being read or to one of <path>.
    fn find_file(&self, name: &str) -> PathBuf {
        let written = name.replace('\\', "/");
        let name = if Path::new(name).is_absolute() || self.base.join(name).exists() {
            Path::new(name)
        } else {
            Path::new(&written)
        };
        if name.is_absolute() || self.base.join(name).exists() {
            return name.to_path_buf();
        }
        let folders = std::iter::once(self.folder()).chain(self.folders.iter().cloned());
        for folder in folders {
            let found = folder.join(name);
            if found.exists() {
                return match found.strip_prefix(&self.base) {
                    Ok(inner) => inner.to_path_buf(),
                    Err(_) => found.canonicalize().unwrap_or(found),
                };
            }
        }
        name.to_path_buf()
    }

    /// Understands a scene.
    fn run(&mut self, root: &Node) {
        if root.tag != "scene" {
            let text = format!("this is no scene of Mitsuba: its root is <{}>", root.tag);
            self.report.error("syntax", text, root.span);
            return;
        }
        self.known_attributes(root, &["version", "id", "type"]);
        let mut all = Vec::new();
        for node in &root.children {
            match Tag::from_name(&node.tag) {
                Some(tag) if node.text("type").is_some() || tag != Tag::Texture => {
                    all.extend(self.plugin(node, tag));
                }
                // Values of the scene itself, which nothing uses.
                Some(_) => {}
                None if node.tag == "alias" => self.alias(node),
                None if matches!(
                    node.tag.as_str(),
                    "string" | "float" | "integer" | "boolean" | "ref" | "null"
                ) => {}
                None => self.unknown_element(node),
            }
        }
        let of = |tag: Tag| all.iter().filter(move |p| p.tag == tag);
        let sensors: Vec<_> = of(Tag::Sensor).collect();
        match &sensors[..] {
            [] => self.report.error("no-camera", "the scene has no sensor", root.span),
            [first, rest @ ..] => {
                if let Some(second) = rest.first() {
                    let text = "the scene has several sensors";
                    self.report.instead(text, "the first one is rendered", second.span);
                }
                self.sensor(first);
            }
        }
        match of(Tag::Integrator).next() {
            Some(integrator) => self.integrator(integrator),
            None => self.report.instead("the scene has no integrator", "paths of any length are", root.span),
        }
        for plugin in &all {
            match plugin.tag {
                Tag::Emitter => self.emitter(plugin),
                Tag::Shape => self.shape(plugin, Target::World),
                _ => {}
            }
        }
    }

    /// Another id of a plugin.
    fn alias(&mut self, node: &Node) {
        let (Some(id), Some(other)) = (self.required(node, "id"), self.required(node, "as")) else { return };
        match self.ids.get(&id).cloned() {
            Some(plugin) => {
                if self.ids.insert(other.clone(), plugin).is_some() {
                    self.report.error("duplicate", format!("the id `{other}` is given twice"), node.span);
                }
            }
            None => {
                self.report.error("unknown-id", format!("nothing before here has the id `{id}`"), node.span)
            }
        }
    }

    fn finish(mut self) -> Loaded {
        if self.sources.iter().count() == 0 {
            self.sources.add("scene", "");
        }
        if !self.report.has_error() {
            scenefile::check(&self.desc).into_iter().for_each(|d| self.report.push(d));
        }
        let diagnostics = self.report.finish();
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        Loaded { desc: (!failed).then_some(self.desc), diagnostics, sources: self.sources }
    }
}
