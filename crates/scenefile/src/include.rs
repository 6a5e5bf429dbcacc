//! `include = ["materials.toml"]`: the tables of other files become those of the scene before anything is read, so that
//! overrides, checks, hashes and what is written know nothing of it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::convert;
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::document::{self, Entry, Node, Table, Value};
use crate::load::{MOST_BYTES, read_text};
use crate::source::{FileId, Sources};
use crate::spec::{Form, Kind, SECTIONS, section};

/// The key at the head of a scene.
pub(crate) const KEY: &str = "include";
/// Files within files, at most.
const DEEPEST: usize = 16;
/// Files in all, at most.
const MOST_FILES: usize = 256;

/// The tree of a scene with all that it includes.
#[derive(Default)]
pub(crate) struct Parsed {
    pub(crate) root: Table,
    /// After one of these names and completeness mean nothing: the text is damaged or a part is missing.
    pub(crate) errors: Vec<Diagnostic>,
    /// What is given twice.
    pub(crate) twice: Vec<Diagnostic>,
}

/// The tree of a text alone; `include` is an unknown key.
pub(crate) fn alone(text: &str, file: FileId) -> Parsed {
    if text.len() as u64 > MOST_BYTES {
        let message = format!("the scene is larger than {} MiB", MOST_BYTES >> 20);
        let whole = crate::source::Span { file, start: 0, end: 0 };
        let errors = vec![Diagnostic::error("file", message).at(whole)];
        return Parsed { errors, ..Parsed::default() };
    }
    let (root, errors) = document::parse(text, file);
    Parsed { root, errors, twice: Vec::new() }
}

/// The tree of a text that stands in `path`, with the files that it includes.
pub(crate) fn with_includes(text: &str, path: &Path, file: FileId, sources: &mut Sources) -> Parsed {
    let mut parsed = alone(text, file);
    let Some(list) = take_list(&mut parsed) else { return parsed };
    let mut files = Files {
        sources,
        bytes: text.len() as u64,
        count: 0,
        open: vec![whole(path)],
        known: BTreeSet::from([whole(path)]),
    };
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    files.add(&mut parsed, list, &folder, Path::new(""));
    parsed
}

/// One name for a file, however it is written.
fn whole(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// The files that a tree includes; takes the key out of it.
fn take_list(parsed: &mut Parsed) -> Option<Vec<Node>> {
    let at = parsed.root.entries.iter().position(|entry| entry.key == KEY)?;
    let node = parsed.root.entries.remove(at).node;
    match node.value {
        Value::Array(items) => Some(items),
        _ => Some(vec![node]),
    }
}

/// What has been opened so far.
struct Files<'s> {
    sources: &'s mut Sources,
    bytes: u64,
    count: usize,
    /// Files that are being read, the scene first.
    open: Vec<PathBuf>,
    /// Every file that was read: each counts once.
    known: BTreeSet<PathBuf>,
}

impl Files<'_> {
    /// Adds the files of a list. `folder` is where their names start from, `prefix` the way there from the scene's folder.
    fn add(&mut self, into: &mut Parsed, list: Vec<Node>, folder: &Path, prefix: &Path) {
        for node in list {
            let Value::Text(name) = &node.value else {
                let mut report = Report::default();
                convert::wrong_type(&mut report, &format!("`{KEY}`"), "a list of file names", &node);
                into.errors.extend(report.finish());
                continue;
            };
            match self.open(name, folder, &node) {
                Ok(Some(text)) => self.merge(into, &text, name, [folder, prefix]),
                Ok(None) => {}
                Err(error) => into.errors.push(error.at(node.span)),
            }
        }
    }

    /// The text of a file; `None` where it was read before.
    fn open(&mut self, name: &str, folder: &Path, node: &Node) -> Result<Option<String>, Diagnostic> {
        let path = folder.join(name);
        let key = whole(&path);
        if self.open.contains(&key) {
            let message = format!("{} includes itself", quoted(name));
            return Err(Diagnostic::error("include", message).help("take one of the includes away"));
        }
        if self.known.contains(&key) {
            return Ok(None);
        }
        if self.open.len() > DEEPEST || self.count == MOST_FILES {
            let message = format!("{} is one file too many", quoted(name));
            let help = format!("a scene may have {MOST_FILES} files, nested {DEEPEST} deep");
            return Err(Diagnostic::error("include", message).help(help));
        }
        if Path::new(name).extension().is_none_or(|e| !e.eq_ignore_ascii_case("toml")) {
            let message = format!("{} is no scene file: only .toml can be included", quoted(name));
            return Err(Diagnostic::error("include", message)
                .help("`nephroid convert` makes a .toml of a scene of another program"));
        }
        let text = read_text(&path)?;
        self.bytes += text.len() as u64;
        if self.bytes > MOST_BYTES {
            let message = format!("with {} the scene is larger than {} MiB", quoted(name), MOST_BYTES >> 20);
            return Err(Diagnostic::error("file", message).at(node.span));
        }
        self.count += 1;
        self.known.insert(key);
        Ok(Some(text))
    }

    /// Adds one file and what it includes in turn.
    fn merge(&mut self, into: &mut Parsed, text: &str, name: &str, [folder, prefix]: [&Path; 2]) {
        let path = folder.join(name);
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let file = self.sources.add(&path, text);
        let mut own = alone(text, file);
        let list = take_list(&mut own);
        let up = |of: &Path| of.parent().map(Path::to_path_buf).unwrap_or_default();
        let prefix = up(&prefix.join(name));
        move_files(&mut own.root, &prefix);
        into.errors.append(&mut own.errors);
        for entry in own.root.entries {
            join(&mut into.root, entry, &mut into.twice);
        }
        if let Some(list) = list {
            self.open.push(whole(&path));
            self.add(into, list, &up(&path), &prefix);
            self.open.pop();
        }
    }
}

/// Adds a table of an included file to those that are there.
fn join(root: &mut Table, entry: Entry, twice: &mut Vec<Diagnostic>) {
    let Some(there) = root.entries.iter_mut().find(|other| other.key == entry.key) else {
        root.entries.push(entry);
        return;
    };
    let form = section(&entry.key).map(|section| section.form);
    match (&mut there.node.value, entry.node.value, form) {
        (Value::Array(there), Value::Array(more), Some(Form::List)) => there.extend(more),
        (Value::Table(there), Value::Table(more), Some(Form::Named | Form::Table)) => {
            for part in more.entries {
                match there.entries.iter().find(|other| other.key == part.key) {
                    Some(other) => twice.push(given_twice(other, &part)),
                    None => there.entries.push(part),
                }
            }
        }
        (_, value, _) => {
            let node = Node { value, span: entry.node.span };
            twice.push(given_twice(there, &Entry { node, ..entry }));
        }
    }
}

fn given_twice(there: &Entry, more: &Entry) -> Diagnostic {
    Diagnostic::error("duplicate-name", format!("{} is given in two files", quoted(&more.key)))
        .at(more.key_span)
        .label(there.key_span, "the other")
        .help("rename or remove one of the two")
}

/// Names of files start from the folder of the file that they stand in: makes them start from that of the scene.
fn move_files(table: &mut Table, prefix: &Path) {
    if prefix.as_os_str().is_empty() {
        return;
    }
    for entry in &mut table.entries {
        let is_file = is_file(&entry.key);
        match &mut entry.node.value {
            Value::Text(text) if is_file => *text = prefix.join(&*text).to_string_lossy().into_owned(),
            Value::Table(inner) => move_files(inner, prefix),
            Value::Array(items) => {
                for item in items {
                    if let Value::Table(inner) = &mut item.value {
                        move_files(inner, prefix);
                    }
                }
            }
            Value::Text(_) | Value::Integer(_) | Value::Number(_) | Value::Bool(_) | Value::Datetime => {}
        }
    }
}

/// Whether a key names a file, in any table.
fn is_file(key: &str) -> bool {
    SECTIONS.iter().any(|section| {
        let keys = section.keys.iter().chain(section.variants().iter().flat_map(|variant| variant.keys()));
        keys.into_iter().any(|spec| spec.name == key && matches!(spec.kind, Kind::File(_)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_names_a_file_in_one_table_does_so_in_all() {
        for section in SECTIONS {
            let variants = section.variants().iter().flat_map(|variant| variant.keys());
            for key in section.keys.iter().chain(variants) {
                assert_eq!(is_file(key.name), matches!(key.kind, Kind::File(_)), "{}", key.name);
            }
        }
    }
}
