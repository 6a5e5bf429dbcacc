//! The text: elements with their defaults applied and includes in their place.
//!
//! Document types are refused, so that nothing expands but `$name`, whose results count against the bytes of a scene.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use roxmltree::{Document, ParsingOptions};
use scenefile::{Diagnostic, FileId, Span};

use super::Importer;
use crate::file;

/// Elements within elements, at most.
const MOST_DEEP: usize = 64;
/// Files within files within files.
const MOST_FILES_DEEP: usize = 15;
/// Files included, at most.
const MOST_FILES: usize = 1000;
/// Elements of one file, at most.
const MOST_NODES: u32 = 4 << 20;

/// An attribute, its defaults applied.
#[derive(Debug)]
pub(super) struct Attribute {
    pub name: String,
    pub value: String,
    pub span: Span,
}

/// An element.
#[derive(Debug)]
pub(super) struct Node {
    pub tag: String,
    pub attributes: Vec<Attribute>,
    pub children: Vec<Node>,
    /// Its start tag.
    pub span: Span,
    /// Whether its file is of a version before 2, whose names are in camel case.
    pub old: bool,
}

impl Node {
    pub(super) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|a| a.name == name)
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.attribute(name).map(|a| a.value.as_str())
    }
}

/// What `$name` stands for.
#[derive(Debug, Default)]
pub(super) struct Defaults {
    values: BTreeMap<String, String>,
    /// Values given from outside, and whether the file knows their names.
    given: BTreeMap<String, bool>,
}

impl Defaults {
    /// `name` and `value` from outside.
    pub(super) fn give(&mut self, name: &str, value: &str) {
        self.values.insert(name.to_owned(), value.to_owned());
        self.given.insert(name.to_owned(), false);
    }

    /// Names given from outside that nothing in the file asks for.
    pub(super) fn idle(&self) -> impl Iterator<Item = &str> {
        self.given.iter().filter(|(_, used)| !**used).map(|(name, _)| name.as_str())
    }

    fn note(&mut self, name: &str) {
        if let Some(used) = self.given.get_mut(name) {
            *used = true;
        }
    }
}

impl Importer {
    /// The root of a file, `None` where it cannot be read; `name`: as the user wrote it.
    pub(super) fn read_file(&mut self, path: &Path, span: Option<Span>, name: &str) -> Option<Node> {
        let fail = |this: &mut Self, reason: &str| {
            let file = this.sources.iter().count();
            let whole = Span { file: FileId(0), start: 0, end: 0 };
            if file == 0 {
                this.sources.add(path, "");
            }
            let text = format!("the scene file {name} {reason}");
            this.report.error("file", text, span.unwrap_or(whole));
            None
        };
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if self.open.iter().any(|(_, open)| *open == whole) {
            return fail(self, "includes itself");
        }
        if self.open.len() > MOST_FILES_DEEP {
            return fail(self, &format!("is included through more than {MOST_FILES_DEEP} files"));
        }
        if self.sources.iter().count() >= MOST_FILES {
            return fail(self, &format!("is one of more than {MOST_FILES}"));
        }
        let bytes = match file::read(path, self.bytes_left) {
            Ok(bytes) => bytes,
            Err(reason) => return fail(self, &reason),
        };
        self.bytes_left -= bytes.len() as u64;
        let Ok(text) = String::from_utf8(bytes) else { return fail(self, "is not UTF-8") };
        let file = FileId(self.sources.iter().count() as u32);
        let root = self.parsed(&text, file);
        self.sources.add(path, text);
        let root = root?;
        self.open.push((path.parent().map(Path::to_path_buf).unwrap_or_default(), whole));
        let root = self.settled(root);
        self.open.pop();
        root
    }

    fn parsed(&mut self, text: &str, file: FileId) -> Option<Node> {
        let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        let document = match Document::parse_with_options(text, options) {
            Ok(document) => document,
            Err(error) => {
                let at = error.pos();
                let line = text.split_inclusive('\n').take((at.row as usize).saturating_sub(1));
                let start: usize = line.map(str::len).sum::<usize>();
                let rest = text.get(start..).unwrap_or_default();
                let ahead: usize =
                    rest.chars().take((at.col as usize).saturating_sub(1)).map(char::len_utf8).sum();
                let start = (start + ahead).min(text.len());
                let span = Span { file, start, end: start };
                self.report.error("syntax", format!("this is no XML that can be read: {error}"), span);
                return None;
            }
        };
        let root = document.root_element();
        let version = root.attribute("version").unwrap_or("3");
        let major: u32 = version.split('.').next().and_then(|v| v.trim().parse().ok()).unwrap_or(3);
        self.raw(root, file, major < 2, 0)
    }

    /// A copy of an element without what is no element.
    fn raw(&mut self, node: roxmltree::Node<'_, '_>, file: FileId, old: bool, depth: usize) -> Option<Node> {
        let at = |r: std::ops::Range<usize>| Span { file, start: r.start, end: r.end };
        let tag = node.tag_name().name().to_owned();
        let start = node.range().start;
        let end = node.attributes().next_back().map_or(start + 1 + tag.len(), |a| a.range().end);
        let span = at(start..end);
        if depth > MOST_DEEP {
            let text = format!("elements are nested more than {MOST_DEEP} deep");
            self.report.error("syntax", text, span);
            return None;
        }
        let attributes = node
            .attributes()
            .map(|a| Attribute {
                name: a.name().to_owned(),
                value: a.value().to_owned(),
                span: at(a.range_value()),
            })
            .collect();
        let mut children = Vec::new();
        for child in node.children() {
            if child.is_element() {
                children.push(self.raw(child, file, old, depth + 1)?);
            } else if child.is_text() && child.text().is_some_and(|t| !t.trim().is_empty()) {
                self.report.error("syntax", format!("there is text within <{tag}>"), at(child.range()));
            }
        }
        Some(Node { tag, attributes, children, span, old })
    }

    /// An element with its defaults applied and its includes in their place.
    fn settled(&mut self, mut node: Node) -> Option<Node> {
        for attribute in &mut node.attributes {
            attribute.value = self.substituted(&attribute.value, attribute.span)?;
        }
        let mut children = Vec::new();
        for child in std::mem::take(&mut node.children) {
            let child = self.settled(child)?;
            match child.tag.as_str() {
                "default" => self.default(&child),
                "path" => self.search_path(&child),
                "include" => children.extend(self.include(&child)),
                _ => children.push(child),
            }
        }
        node.children = children;
        Some(node)
    }

    fn default(&mut self, node: &Node) {
        match (node.text("name"), node.text("value")) {
            (Some(name), Some(value)) if !name.is_empty() => {
                self.defaults.note(name);
                self.defaults.values.entry(name.to_owned()).or_insert_with(|| value.to_owned());
            }
            _ => self.report.error("syntax", "<default> needs `name` and `value`", node.span),
        }
    }

    /// A folder in which files are looked for.
    fn search_path(&mut self, node: &Node) {
        match node.text("value") {
            Some(value) => {
                let folder = self.open.last().map(|(f, _)| f.clone()).unwrap_or_default();
                self.folders.push(folder.join(value));
            }
            None => self.report.error("syntax", "<path> needs `value`", node.span),
        }
    }

    fn include(&mut self, node: &Node) -> Vec<Node> {
        let Some(name) = node.attribute("filename") else {
            self.report.error("syntax", "<include> needs `filename`", node.span);
            return Vec::new();
        };
        let path = self.base.join(self.find_file(&name.value));
        match self.read_file(&path, Some(name.span), &name.value) {
            Some(root) if root.tag == "scene" => root.children,
            Some(root) => vec![root],
            None => Vec::new(),
        }
    }

    /// The folder of the file being read.
    pub(super) fn folder(&self) -> PathBuf {
        self.open.last().map(|(folder, _)| folder.clone()).unwrap_or_default()
    }

    /// `$name` replaced by what it stands for, the longest name that fits.
    fn substituted(&mut self, value: &str, span: Span) -> Option<String> {
        if !value.contains('$') {
            return Some(value.to_owned());
        }
        let mut out = String::new();
        let mut rest = value;
        while let Some(at) = rest.find('$') {
            out += &rest[..at];
            rest = &rest[at + 1..];
            let known = self.defaults.values.iter().filter(|(name, _)| rest.starts_with(name.as_str()));
            let Some((name, text)) = known.max_by_key(|(name, _)| name.len()) else {
                let is_name = |c: char| c.is_alphanumeric() || c == '_';
                let name: String = rest.chars().take_while(|c| is_name(*c)).collect();
                self.report.push(
                    Diagnostic::error("undefined", format!("nothing says what `${name}` stands for"))
                        .at(span)
                        .help(format!("<default name=\"{name}\" value=\"…\"/> before here")),
                );
                return None;
            };
            out += text;
            rest = &rest[name.len()..];
            let (name, added) = (name.clone(), text.len() as u64);
            self.defaults.note(&name);
            match self.bytes_left.checked_sub(added) {
                Some(left) => self.bytes_left = left,
                None => {
                    self.report.error("too-large", "defaults grow beyond what a scene may hold", span);
                    return None;
                }
            }
        }
        Some(out + rest)
    }
}
