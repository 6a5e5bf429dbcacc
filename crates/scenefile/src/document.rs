//! TOML text as a tree whose every value knows its span, in the order written.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::Diagnostic;
use crate::source::{FileId, Span};

/// Above this size only the first syntax error is looked for: the parser may find one at every byte.
const RECOVER_BYTES: usize = 1 << 18;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Text(String),
    /// Beyond 128 bits: the greatest or least number of 128 bits.
    Integer(i128),
    Number(f64),
    Bool(bool),
    Datetime,
    Array(Vec<Node>),
    Table(Table),
}

/// A value at a place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: Value,
    /// Of a table with a header: the header.
    pub(crate) span: Span,
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Span,
    pub(crate) node: Node,
}

/// Entries in the order written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    pub(crate) entries: Vec<Entry>,
}

impl Table {
    pub(crate) fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }
}

impl Node {
    /// "a string", "an integer", …
    pub(crate) fn type_name(&self) -> &'static str {
        match &self.value {
            Value::Text(_) => "a string",
            Value::Integer(_) => "an integer",
            Value::Number(_) => "a number",
            Value::Bool(_) => "true or false",
            Value::Datetime => "a date",
            Value::Array(_) => "an array",
            Value::Table(_) => "a table",
        }
    }
}

/// Parses a document. With syntax errors the tree is what could be made of the rest.
pub(crate) fn parse(text: &str, file: FileId) -> (Table, Vec<Diagnostic>) {
    let (table, errors) = if text.len() <= RECOVER_BYTES {
        DeTable::parse_recoverable(text)
    } else {
        match DeTable::parse(text) {
            Ok(table) => (table, Vec::new()),
            Err(error) => (Spanned::new(0..0, DeTable::new()), vec![error]),
        }
    };
    let errors = errors.iter().map(|error| syntax_error(error, text, file)).collect();
    (convert_table(table.into_inner(), file), errors)
}

/// Parses the one value that stands at `text[start..]`, with spans from the start of `text`; `start` ≥ 2.
pub(crate) fn parse_value(text: &str, start: usize, file: FileId) -> Result<Node, Diagnostic> {
    // As the value of a key, so that whatever follows the value is an error.
    let padded = format!("{}v={}", " ".repeat(start.saturating_sub(2)), &text[start..]);
    let (table, errors) = parse(&padded, file);
    if let Some(error) = errors.into_iter().next() {
        return Err(error);
    }
    let mut entries = table.entries.into_iter();
    match (entries.next(), entries.next()) {
        (Some(entry), None) => Ok(entry.node),
        _ => Err(Diagnostic::error("syntax", "not one value").at(Span { file, start, end: text.len() })),
    }
}

fn syntax_error(error: &toml::de::Error, text: &str, file: FileId) -> Diagnostic {
    let range = error.span().unwrap_or(text.len()..text.len());
    let span = Span { file, start: range.start, end: range.end };
    let message = error.message().replace('\n', ", ").replace(", expected nothing", "");
    let help = if message.starts_with("duplicate key") {
        Some("each key and each table may be written once; rename or remove one".to_owned())
    } else if message.starts_with("string values must be quoted") {
        Some("write text between quotes, and 0.5 instead of .5".to_owned())
    } else {
        None
    };
    Diagnostic::error("syntax", message).at(span).maybe_help(help)
}

fn convert_table(table: DeTable<'_>, file: FileId) -> Table {
    let mut entries: Vec<Entry> = table
        .into_iter()
        .map(|(key, value)| {
            let range = key.span();
            Entry {
                key_span: Span { file, start: range.start, end: range.end },
                key: key.into_inner().into_owned(),
                node: convert(value, file),
            }
        })
        .collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    Table { entries }
}

fn convert_array(array: DeArray<'_>, file: FileId) -> Vec<Node> {
    array.into_iter().map(|value| convert(value, file)).collect()
}

fn convert(value: Spanned<DeValue<'_>>, file: FileId) -> Node {
    let range = value.span();
    let value = match value.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(integer) => {
            let digits = integer.as_str();
            let beyond = if digits.starts_with('-') { i128::MIN } else { i128::MAX };
            Value::Integer(i128::from_str_radix(digits, integer.radix()).unwrap_or(beyond))
        }
        DeValue::Float(number) => Value::Number(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(value) => Value::Bool(value),
        DeValue::Datetime(_) => Value::Datetime,
        DeValue::Array(array) => Value::Array(convert_array(array, file)),
        DeValue::Table(table) => Value::Table(convert_table(table, file)),
    };
    Node { value, span: Span { file, start: range.start, end: range.end } }
}
