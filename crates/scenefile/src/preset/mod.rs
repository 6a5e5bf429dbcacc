//! Materials by name: `preset = "amber"` stands for the keys of a table, and further keys override these.

mod table;

use std::borrow::Cow;

use crate::convert;
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::document::{self, Entry, Node, Table, Value};
use crate::nearest::nearest;
use crate::source::{FileId, Span};
use crate::spec::POSITIVE;

/// The key that names a preset.
pub(crate) const KEY: &str = "preset";
/// The key that says how long a scene unit is, where a preset absorbs.
const UNIT_KEY: &str = "metres_per_unit";

const EYE: &str = "Chosen by eye.";
const MEASURED: &str = "Measured n and k, as `metal`.";

/// A material by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialPreset {
    /// As `preset` takes it.
    pub name: &'static str,
    /// What it is, one line.
    pub doc: &'static str,
    /// Where its numbers come from.
    pub source: &'static str,
    /// Its keys in TOML; lengths are metres.
    pub keys: &'static str,
}

/// Presets of one sort.
struct Group {
    name: &'static str,
    presets: &'static [MaterialPreset],
}

/// Keys that say the same in another way: what a file gives of the one leaves out what the preset has of the other.
const INSTEAD: &[(&[&str], &[&str])] = &[
    (&["roughness", "anisotropy"], &["alpha", "alpha_across"]),
    (&["absorption"], &["attenuation_color", "attenuation_distance"]),
    (&["metal"], &["n", "k"]),
];

/// Every preset, in the order of the reference.
pub fn presets() -> impl Iterator<Item = &'static MaterialPreset> {
    table::GROUPS.iter().flat_map(|group| group.presets)
}

/// The preset of a name.
pub(crate) fn find(name: &str) -> Option<&'static MaterialPreset> {
    presets().find(|preset| preset.name == name)
}

/// The list of all presets, for `describe`.
pub(crate) fn page() -> String {
    let mut out = String::from(
        "A material may be named instead of described, and further keys override what the name stands for:\n\
         \x20   material = { preset = \"amber\" }\n\
         \x20   [materials.ring]\n\
         \x20   preset = \"gold\"\n\
         \x20   roughness = 0.2\n\
         What absorbs does so by lengths in metres; where a scene unit is a centimetre say\n\
         metres_per_unit = 0.01 beside the preset. `describe NAME` prints the keys and their source.\n",
    );
    for group in table::GROUPS {
        out += &format!("\n{}\n", group.name);
        for preset in group.presets {
            out += &format!("    {:<20}{}\n", preset.name, crate::describe::wrapped(preset.doc, 24));
        }
    }
    out
}

impl MaterialPreset {
    /// What `describe` says of it.
    pub(crate) fn text(&self) -> String {
        let keys: String = self.keys.lines().map(|line| format!("    {line}\n")).collect();
        let lengths = if self.absorbs() {
            "Lengths are metres: say metres_per_unit = 0.01 where a scene unit is a centimetre.\n"
        } else {
            ""
        };
        format!(
            "[materials.NAME]  preset = \"{}\"\n{}\n{}\n\nIt stands for these keys, which further keys override:\n{keys}{lengths}",
            self.name, self.doc, self.source
        )
    }

    fn absorbs(&self) -> bool {
        self.keys.lines().any(|line| line.starts_with("absorption") || line.starts_with("attenuation"))
    }
}

/// The table with the keys of its preset in place of the name; as it is where it has none. `None` after a mistake.
pub(crate) fn resolved<'a>(report: &mut Report, what: &str, table: &'a Table) -> Option<Cow<'a, Table>> {
    let Some(named) = table.get(KEY) else { return Some(Cow::Borrowed(table)) };
    let Value::Text(name) = &named.node.value else {
        convert::wrong_type(report, &format!("`{KEY}` of {what}"), "the name of a preset", &named.node);
        return None;
    };
    let Some(preset) = find(name) else {
        if !report.count_if_full() {
            report.push(unknown(name, &named.node));
        }
        return None;
    };
    let (mut own, _) = document::parse(preset.keys, FileId(0));
    own.entries.iter_mut().for_each(|entry| move_to(entry, named.node.span));
    if let (Some(kind), Some(own)) = (table.get("kind"), own.get("kind"))
        && kind.node.value != own.node.value
    {
        let message = format!("`kind` of {what} is another than that of the preset {}", quoted(name));
        report.push(
            Diagnostic::error("conflict", message)
                .at(kind.node.span)
                .label(named.node.span, format!("the preset has the kind {}", text_of(own)))
                .help("remove one of the two"),
        );
        return None;
    }
    if let Some(unit) = table.get(UNIT_KEY) {
        scale(report, what, preset, unit, &mut own)?;
    }
    let given = |keys: &[&str]| keys.iter().any(|key| table.get(key).is_some());
    own.entries.retain(|entry| {
        let instead = INSTEAD.iter().flat_map(|(a, b)| [(*a, *b), (*b, *a)]);
        let mut others = instead.filter(|(keys, _)| keys.contains(&entry.key.as_str()));
        table.get(&entry.key).is_none() && !others.any(|(_, others)| given(others))
    });
    let further = table.entries.iter().filter(|entry| ![KEY, UNIT_KEY].contains(&entry.key.as_str()));
    own.entries.extend(further.cloned());
    Some(Cow::Owned(own))
}

/// Lengths of a preset, from metres to scene units.
fn scale(
    report: &mut Report,
    what: &str,
    preset: &MaterialPreset,
    unit: &Entry,
    own: &mut Table,
) -> Option<()> {
    if !preset.absorbs() {
        let message =
            format!("`{UNIT_KEY}` of {what} does nothing: the preset {} has no length", preset.name);
        report.push(Diagnostic::error("conflict", message).at(unit.key_span).help("remove it"));
        return None;
    }
    let metres = convert::number(report, &format!("`{UNIT_KEY}` of {what}"), POSITIVE, &unit.node)?;
    for entry in &mut own.entries {
        match entry.key.as_str() {
            "absorption" => times(&mut entry.node, f64::from(metres)),
            "attenuation_distance" => times(&mut entry.node, 1.0 / f64::from(metres)),
            _ => {}
        }
    }
    Some(())
}

fn times(node: &mut Node, factor: f64) {
    match &mut node.value {
        Value::Integer(i) => node.value = Value::Number(*i as f64 * factor),
        Value::Number(x) => *x *= factor,
        Value::Array(items) => items.iter_mut().for_each(|item| times(item, factor)),
        Value::Text(_) | Value::Bool(_) | Value::Datetime | Value::Table(_) => {}
    }
}

fn text_of(entry: &Entry) -> String {
    match &entry.node.value {
        Value::Text(text) => quoted(text),
        _ => String::new(),
    }
}

/// What a preset's keys say was written where its name stands.
fn move_to(entry: &mut Entry, span: Span) {
    fn node(value: &mut Node, span: Span) {
        value.span = span;
        match &mut value.value {
            Value::Array(items) => items.iter_mut().for_each(|item| node(item, span)),
            Value::Table(table) => table.entries.iter_mut().for_each(|entry| move_to(entry, span)),
            Value::Text(_) | Value::Integer(_) | Value::Number(_) | Value::Bool(_) | Value::Datetime => {}
        }
    }
    entry.key_span = span;
    node(&mut entry.node, span);
}

fn unknown(name: &str, node: &Node) -> Diagnostic {
    let help = match nearest(name, presets().map(|preset| preset.name)) {
        Some(near) => format!("did you mean {}? `nephroid describe presets` lists all", quoted(near)),
        None => "`nephroid describe presets` lists all".to_owned(),
    };
    Diagnostic::error("unknown-preset", format!("no preset is named {}", quoted(name)))
        .at(node.span)
        .help(help)
}
