//! Reads one table by its specification: unknown keys, missing keys, and typed values.

use std::path::PathBuf;

use crate::convert;
use crate::desc::{ColorDesc, FloatDesc, Ior, Triple};
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::document::{Entry, Node, Table, Value};
use crate::nearest::nearest;
use crate::source::{Sourced, Span};
use crate::spec::{ANY, Key, Kind, Preset, Range, Section, Variant, section};

/// A table being read. Every getter returns `None` after it has reported a mistake.
pub(crate) struct Reader<'a> {
    pub(crate) table: &'a Table,
    pub(crate) span: Span,
    /// "material `white`".
    pub(crate) what: String,
    section: &'static Section,
    variant: Option<&'static Variant>,
}

/// "a", "b" or "c".
fn either(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("\"{one}\""),
        [first @ .., last] => {
            let first = first.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            format!("{first} or \"{last}\"")
        }
    }
}

/// The table that a value must be.
pub(crate) fn as_table<'a>(report: &mut Report, what: &str, node: &'a Node) -> Option<&'a Table> {
    match &node.value {
        Value::Table(table) => Some(table),
        _ => {
            convert::wrong_type(report, what, "a table", node);
            None
        }
    }
}

impl<'a> Reader<'a> {
    /// Reads the switch and checks that every key is known; what each of them holds is left to the getters.
    pub(crate) fn new(
        report: &mut Report,
        section: &'static Section,
        what: String,
        table: &'a Table,
        span: Span,
    ) -> Self {
        let mut reader = Self { table, span, what, section, variant: None };
        reader.variant = reader.read_switch(report);
        reader.check_keys(report);
        reader
    }

    /// The kind; `None` where there is one only, or after a mistake.
    pub(crate) fn variant(&self) -> Option<&'static str> {
        self.variant.map(|variant| variant.name)
    }

    fn read_switch(&self, report: &mut Report) -> Option<&'static Variant> {
        let switch = self.section.switch?;
        let names = || switch.variants.iter().map(|variant| variant.name);
        let Some(entry) = self.table.get(switch.key) else {
            if let Some(preset) = switch.preset {
                return self.section.variant(preset);
            }
            if report.count_if_full() {
                return None;
            }
            let preset = self.section.name == "materials";
            let or = if preset { "; or name a `preset`" } else { "" };
            let other = nearest(switch.key, self.table.entries.iter().map(|entry| entry.key.as_str()));
            let mut error =
                Diagnostic::error("missing-key", format!("missing `{}` in {}", switch.key, self.what))
                    .at(self.span)
                    .help(format!("it is {}{or}", either(&names().collect::<Vec<_>>())));
            let keys = || self.table.entries.iter().map(|entry| entry.key.as_str());
            if let Some(other) = nearest(crate::preset::KEY, keys()).filter(|_| preset) {
                error = error.help(format!("did you mean `{}` by `{other}`?", crate::preset::KEY));
            } else if let Some(other) = other {
                error = error.help(format!("did you mean `{}` by `{other}`?", switch.key));
            }
            report.push(error);
            return None;
        };
        let Value::Text(name) = &entry.node.value else {
            let expected = format!("a string ({})", either(&names().collect::<Vec<_>>()));
            convert::wrong_type(report, &format!("`{}`", switch.key), &expected, &entry.node);
            return None;
        };
        let variant = self.section.variant(name);
        if variant.is_none() && !report.count_if_full() {
            let noun = if switch.key == "shape" { "shape" } else { self.section.name.trim_end_matches('s') };
            let kind = if noun == "shape" { "shape".to_owned() } else { format!("kind of {noun}") };
            let message = format!("unknown {kind} {}", quoted(name));
            report.push(convert::unknown_word(&message, name, names, &entry.node));
        }
        variant
    }

    /// The keys of this kind; while the kind is unknown, of every kind.
    fn keys(&self) -> Vec<&'static Key> {
        let own = self.section.keys.iter();
        match self.variant {
            Some(variant) => own.chain(variant.keys()).collect(),
            None => own.chain(self.section.variants().iter().flat_map(Variant::keys)).collect(),
        }
    }

    fn check_keys(&self, report: &mut Report) {
        let keys = self.keys();
        let switch = self.section.switch.map(|switch| switch.key);
        let names = || keys.iter().map(|key| key.name).chain(switch);
        let mut absent: Option<Vec<&str>> = None;
        for entry in &self.table.entries {
            let known = keys.iter().any(|key| key.name == entry.key) || switch == Some(&entry.key);
            if known || report.count_if_full() {
                continue;
            }
            let message = format!("unknown key {} in {}", quoted(&entry.key), self.what);
            let others: Vec<&str> = self
                .section
                .variants()
                .iter()
                .filter(|variant| variant.keys().any(|key| key.name == entry.key))
                .map(|variant| variant.name)
                .collect();
            let absent =
                absent.get_or_insert_with(|| names().filter(|name| self.table.get(name).is_none()).collect());
            let help = if let Some(name) = nearest(&entry.key, absent.iter().copied()) {
                format!("did you mean `{name}`?")
            } else if let (Some(switch), false) = (switch, others.is_empty()) {
                format!("only {switch} = {} has it", either(&others))
            } else {
                format!("it has the keys {}", names().collect::<Vec<_>>().join(", "))
            };
            report.push(Diagnostic::error("unknown-key", message).at(entry.key_span).help(help));
        }
    }

    /// The specification of a key that this code reads.
    fn key(&self, name: &str) -> &'static Key {
        const NONE: Key =
            Key { name: "", kind: Kind::Bool, unit: "", preset: Preset::Required, doc: "Not in the table." };
        self.keys().into_iter().find(|key| key.name == name).unwrap_or(&NONE)
    }

    /// What the file gives for a key.
    pub(crate) fn given(&self, name: &str) -> Option<&'a Entry> {
        self.table.get(name)
    }

    /// `radius` of object `ball`.
    pub(crate) fn label(&self, name: &str) -> String {
        format!("`{name}` of {}", self.what)
    }

    /// Reports a missing key.
    pub(crate) fn missing(&self, report: &mut Report, name: &str) {
        if report.count_if_full() {
            return;
        }
        let key = self.key(name);
        let text = key.kind.text();
        let unit = if key.unit.is_empty() { String::new() } else { format!(" in {}", key.unit) };
        report.push(
            Diagnostic::error("missing-key", format!("missing `{name}` in {}", self.what))
                .at(self.span)
                .help(format!("`{name}` is {text}{unit}: {}", key.doc)),
        );
    }

    /// Reports two keys that exclude each other.
    pub(crate) fn conflict(&self, report: &mut Report, a: &Entry, b: &Entry) {
        let message = format!("`{}` and `{}` exclude each other in {}", a.key, b.key, self.what);
        report.push(Diagnostic::error("conflict", message).at(b.key_span).label(a.key_span, "the other"));
    }

    fn take<T>(
        &self,
        report: &mut Report,
        name: &str,
        read: impl FnOnce(&mut Report, &str, &Key, &Node) -> Option<T>,
        preset: impl FnOnce(&Preset) -> Option<T>,
    ) -> Option<T> {
        let key = self.key(name);
        match (self.given(name), &key.preset) {
            (Some(entry), _) => read(report, &self.label(name), key, &entry.node),
            (None, Preset::Required) => {
                self.missing(report, name);
                None
            }
            (None, given) => preset(given),
        }
    }

    /// `Some(None)` where the key is absent.
    fn take_optional<T>(
        &self,
        report: &mut Report,
        name: &str,
        read: impl FnOnce(&mut Report, &str, &Key, &Node) -> Option<T>,
    ) -> Option<Option<T>> {
        let Some(entry) = self.given(name) else { return Some(None) };
        let none = matches!(&entry.node.value, Value::Text(text) if text == "none");
        let key = self.key(name);
        if none && matches!(key.kind, Kind::Number(_) | Kind::Integer(..)) {
            return Some(None);
        }
        read(report, &self.label(name), key, &entry.node).map(Some)
    }

    pub(crate) fn bool(&self, report: &mut Report, name: &str) -> Option<bool> {
        let read = |report: &mut Report, what: &str, _: &Key, node: &Node| match node.value {
            Value::Bool(value) => Some(value),
            _ => {
                convert::wrong_type(report, what, "true or false", node);
                None
            }
        };
        self.take(report, name, read, |preset| match preset {
            Preset::Bool(value) => Some(*value),
            _ => Some(false),
        })
    }

    pub(crate) fn integer<T: TryFrom<i128>>(&self, report: &mut Report, name: &str) -> Option<T> {
        let value = self.take(report, name, read_integer, |preset| match preset {
            Preset::Integer(value) => Some(*value),
            _ => None,
        })?;
        T::try_from(value).ok()
    }

    pub(crate) fn optional_integer<T: TryFrom<i128>>(
        &self,
        report: &mut Report,
        name: &str,
    ) -> Option<Option<T>> {
        match self.take_optional(report, name, read_integer)? {
            Some(value) => T::try_from(value).ok().map(Some),
            None => Some(None),
        }
    }

    pub(crate) fn number(&self, report: &mut Report, name: &str) -> Option<f32> {
        self.take(report, name, read_number, preset_number)
    }

    pub(crate) fn optional_number(&self, report: &mut Report, name: &str) -> Option<Option<f32>> {
        self.take_optional(report, name, read_number)
    }

    pub(crate) fn size(&self, report: &mut Report, name: &str) -> Option<[u32; 2]> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            let Kind::Size(min, max) = key.kind else { return None };
            let pair = match &node.value {
                Value::Array(items) if items.len() == 2 => items,
                _ => {
                    convert::wrong_type(report, what, &key.kind.text(), node);
                    return None;
                }
            };
            let width = convert::integer(report, &format!("the width in {what}"), min, max, &pair[0]);
            let height = convert::integer(report, &format!("the height in {what}"), min, max, &pair[1]);
            Some([width? as u32, height? as u32])
        };
        self.take(report, name, read, |preset| match preset {
            Preset::Pair(pair) => Some(pair.map(|x| x as u32)),
            _ => None,
        })
    }

    pub(crate) fn optional_window(&self, report: &mut Report, name: &str) -> Option<Option<[u32; 4]>> {
        self.take_optional(report, name, |report, what, key, node| {
            let items = match &node.value {
                Value::Array(items) if items.len() == 4 => items,
                _ => {
                    convert::wrong_type(report, what, &key.kind.text(), node);
                    return None;
                }
            };
            let side = |report: &mut Report, i: usize| convert::integer(report, what, 0, 65536, &items[i]);
            let sides = [0, 1, 2, 3].map(|i| side(report, i).map(|n| n as u32));
            let [x0, y0, x1, y1] = sides;
            Some([x0?, y0?, x1?, y1?])
        })
    }

    pub(crate) fn pair(&self, report: &mut Report, name: &str) -> Option<[f32; 2]> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::pair(report, what, range(key), node)
        };
        self.take(report, name, read, |preset| match preset {
            Preset::Pair(pair) => Some(pair.map(|x| x as f32)),
            Preset::Number(x) => Some([*x as f32; 2]),
            _ => None,
        })
    }

    pub(crate) fn point(&self, report: &mut Report, name: &str) -> Option<Triple> {
        self.take(report, name, read_point, preset_triple)
    }

    pub(crate) fn optional_point(&self, report: &mut Report, name: &str) -> Option<Option<Triple>> {
        self.take_optional(report, name, read_point)
    }

    pub(crate) fn factors(&self, report: &mut Report, name: &str) -> Option<Triple> {
        self.take(report, name, |report, what, _, node| convert::factors(report, what, node), preset_triple)
    }

    pub(crate) fn matrix(&self, report: &mut Report, name: &str) -> Option<[f32; 16]> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::numbers::<16>(report, what, &key.kind.text(), ANY, node)
        };
        self.take(report, name, read, |_| None)
    }

    pub(crate) fn color(&self, report: &mut Report, name: &str) -> Option<Triple> {
        self.take(report, name, read_color, preset_triple)
    }

    pub(crate) fn optional_color(&self, report: &mut Report, name: &str) -> Option<Option<Triple>> {
        self.take_optional(report, name, read_color)
    }

    pub(crate) fn color_desc(&self, report: &mut Report, name: &str) -> Option<ColorDesc> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::color_desc(report, what, range(key), node)
        };
        self.take(report, name, read, |preset| preset_number(preset).map(ColorDesc::from))
    }

    pub(crate) fn float_desc(&self, report: &mut Report, name: &str) -> Option<FloatDesc> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::float_desc(report, what, range(key), node)
        };
        self.take(report, name, read, |preset| preset_number(preset).map(FloatDesc::from))
    }

    pub(crate) fn optional_float_desc(&self, report: &mut Report, name: &str) -> Option<Option<FloatDesc>> {
        self.take_optional(report, name, |report, what, key, node| {
            convert::float_desc(report, what, range(key), node)
        })
    }

    /// Whether tables of this kind have the key.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.keys().iter().any(|key| key.name == name)
    }

    pub(crate) fn ior(&self, report: &mut Report, name: &str) -> Option<Ior> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::ior(report, what, range(key), node)
        };
        self.take(report, name, read, |preset| preset_number(preset).map(Ior::from))
    }

    /// A number, or one of some words.
    pub(crate) fn number_or_word(
        &self,
        report: &mut Report,
        name: &str,
    ) -> Option<Result<f32, &'static str>> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| match (key.kind, &node.value) {
            (Kind::NumberOrWord(_, words), Value::Text(text)) if text.parse::<f64>().is_err() => {
                convert::word(report, what, words, node).map(Err)
            }
            (Kind::NumberOrWord(..), Value::Integer(_) | Value::Number(_)) => {
                read_number(report, what, key, node).map(Ok)
            }
            (kind, _) => {
                convert::wrong_type(report, what, &kind.text(), node);
                None
            }
        };
        self.take(report, name, read, |preset| match preset {
            Preset::Word(word) => Some(Err(*word)),
            _ => None,
        })
    }

    /// A file, `None` inside where the key is absent.
    pub(crate) fn optional_file(&self, report: &mut Report, name: &str) -> Option<Option<Sourced<PathBuf>>> {
        let text = self.optional_text(report, name)?;
        Some(text.map(|text| Sourced { value: PathBuf::from(text.value), span: text.span }))
    }

    pub(crate) fn word(&self, report: &mut Report, name: &str) -> Option<&'static str> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| match key.kind {
            Kind::Word(words) => convert::word(report, what, words, node),
            _ => None,
        };
        self.take(report, name, read, |preset| match preset {
            Preset::Word(word) => Some(*word),
            _ => None,
        })
    }

    pub(crate) fn optional_word(&self, report: &mut Report, name: &str) -> Option<Option<&'static str>> {
        self.take_optional(report, name, |report, what, key, node| match key.kind {
            Kind::Word(words) => convert::word(report, what, words, node),
            _ => None,
        })
    }

    /// Words without repeats, or `None` inside for all of them.
    pub(crate) fn words(&self, report: &mut Report, name: &str) -> Option<Option<Vec<&'static str>>> {
        self.take_optional(report, name, |report, what, key, node| {
            let Kind::Words(words) = key.kind else { return None };
            let mut list = convert::list(report, what, &key.kind.text(), node, |report, what, item| {
                convert::word(report, what, words, item)
            })?;
            if list.is_empty() {
                report.push(Diagnostic::error("degenerate", format!("{what} is empty")).at(node.span));
                return None;
            }
            list.sort_by_key(|name| words.iter().position(|word| word.name == *name));
            list.dedup();
            Some(list)
        })
    }

    pub(crate) fn text(&self, report: &mut Report, name: &str) -> Option<Sourced<String>> {
        self.take(report, name, |report, what, _, node| convert::text(report, what, node), |_| None)
    }

    pub(crate) fn optional_text(&self, report: &mut Report, name: &str) -> Option<Option<Sourced<String>>> {
        self.take_optional(report, name, |report, what, _, node| convert::text(report, what, node))
    }

    pub(crate) fn file(&self, report: &mut Report, name: &str) -> Option<Sourced<PathBuf>> {
        let text = self.text(report, name)?;
        Some(Sourced { value: PathBuf::from(text.value), span: text.span })
    }

    pub(crate) fn points(&self, report: &mut Report, name: &str) -> Option<Vec<Triple>> {
        self.take(report, name, read_points, |_| Some(Vec::new()))
    }

    pub(crate) fn optional_points(&self, report: &mut Report, name: &str) -> Option<Option<Vec<Triple>>> {
        self.take_optional(report, name, read_points)
    }

    pub(crate) fn pairs(&self, report: &mut Report, name: &str) -> Option<Vec<[f32; 2]>> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::list(report, what, &key.kind.text(), node, |report, what, item| {
                convert::numbers::<2>(report, what, "a pair of numbers", ANY, item)
            })
        };
        self.take(report, name, read, |_| Some(Vec::new()))
    }

    pub(crate) fn optional_rows(&self, report: &mut Report, name: &str) -> Option<Option<Vec<Vec<f32>>>> {
        self.take_optional(report, name, |report, what, key, node| {
            convert::list(report, what, &key.kind.text(), node, |report, what, row| {
                convert::list(report, what, "a row of numbers", row, |report, what, item| {
                    convert::number(report, what, ANY, item)
                })
            })
        })
    }

    pub(crate) fn indices(&self, report: &mut Report, name: &str) -> Option<Vec<[u32; 3]>> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::list(report, what, &key.kind.text(), node, convert::indices)
        };
        self.take(report, name, read, |_| None)
    }

    /// Colours with opacity, which is 1 where it is not given.
    pub(crate) fn vertex_colors(&self, report: &mut Report, name: &str) -> Option<Vec<[f32; 4]>> {
        let read = |report: &mut Report, what: &str, key: &Key, node: &Node| {
            convert::list(report, what, &key.kind.text(), node, |report, what, item| match &item.value {
                Value::Array(items) if items.len() == 3 => {
                    let rgb = convert::numbers::<3>(report, what, "[r, g, b]", ANY, item);
                    rgb.map(|[r, g, b]| [r, g, b, 1.0])
                }
                _ => convert::numbers::<4>(report, what, "[r, g, b] or [r, g, b, opacity]", ANY, item),
            })
        };
        self.take(report, name, read, |_| Some(Vec::new()))
    }

    /// A reader of an inline table; `None` inside where the key is absent.
    pub(crate) fn inner(&self, report: &mut Report, name: &str) -> Option<Option<Reader<'a>>> {
        let Some(entry) = self.given(name) else { return Some(None) };
        let Kind::Section(inner) = self.key(name).kind else { return None };
        let what = self.label(name);
        let table = as_table(report, &what, &entry.node)?;
        Some(Some(Reader::new(report, section(inner)?, what, table, entry.node.span)))
    }
}

fn range(key: &Key) -> Range {
    match key.kind {
        Kind::Number(range)
        | Kind::NumberOrWord(range, _)
        | Kind::Pair(range)
        | Kind::Color(range)
        | Kind::ColorOrTexture(range)
        | Kind::NumberOrTexture(range)
        | Kind::Ior(range) => range,
        _ => ANY,
    }
}

fn preset_number(preset: &Preset) -> Option<f32> {
    match preset {
        Preset::Number(x) => Some(*x as f32),
        _ => None,
    }
}

fn preset_triple(preset: &Preset) -> Option<Triple> {
    match preset {
        Preset::Triple(triple) => Some(triple.map(|x| x as f32)),
        Preset::Number(x) => Some([*x as f32; 3]),
        _ => None,
    }
}

fn read_integer(report: &mut Report, what: &str, key: &Key, node: &Node) -> Option<i128> {
    let Kind::Integer(min, max) = key.kind else { return None };
    convert::integer(report, what, min, max, node)
}

fn read_number(report: &mut Report, what: &str, key: &Key, node: &Node) -> Option<f32> {
    convert::number(report, what, range(key), node)
}

fn read_color(report: &mut Report, what: &str, key: &Key, node: &Node) -> Option<Triple> {
    convert::color(report, what, &key.kind.text(), range(key), node)
}

fn read_point(report: &mut Report, what: &str, key: &Key, node: &Node) -> Option<Triple> {
    match key.kind {
        Kind::Direction => convert::direction(report, what, node),
        _ => convert::numbers::<3>(report, what, "[x, y, z]", ANY, node),
    }
}

fn read_points(report: &mut Report, what: &str, key: &Key, node: &Node) -> Option<Vec<Triple>> {
    let Kind::Points(min, max) = key.kind else { return None };
    let points = convert::list(report, what, &key.kind.text(), node, |report, what, item| {
        convert::numbers::<3>(report, what, "[x, y, z]", ANY, item)
    })?;
    if points.len() < min || points.len() > max {
        let message = format!("{what} must be {}, not {}", key.kind.text(), points.len());
        report.push(Diagnostic::error("wrong-type", message).at(node.span));
        return None;
    }
    Some(points)
}
