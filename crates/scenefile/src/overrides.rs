//! `path.key=value`: changes to a document before it is read, so that they are checked like the rest.

use crate::diagnostic::{Diagnostic, quoted};
use crate::document::{Entry, Node, Table, Value, parse_value};
use crate::nearest::nearest;
use crate::source::{FileId, Sources, Span};
use crate::spec::{Form, SECTIONS, section};

/// One part of a path.
struct Part {
    name: String,
    span: Span,
}

/// Applies one override; its text becomes a source named `--set`.
pub(crate) fn apply(root: &mut Table, text: &str, sources: &mut Sources) -> Result<(), Diagnostic> {
    let file = sources.add("--set", text);
    let whole = Span { file, start: 0, end: text.len().max(1) };
    let usage = "write PATH.KEY=VALUE, as in photon_map.photons=100000 or objects.lamp.power=40";
    let (parts, value_start) = path(text, file).ok_or_else(|| {
        Diagnostic::error("override", format!("{} is no override", quoted(text))).at(whole).help(usage)
    })?;
    let node = value(text, value_start, file)?;
    let (last, way) = match parts.split_last() {
        Some((last, way)) if !way.is_empty() => (last, way),
        _ => {
            return Err(Diagnostic::error("override", "an override names a table and a key")
                .at(whole)
                .help(usage));
        }
    };
    let table = descend(root, way)?;
    match table.entries.iter_mut().find(|entry| entry.key == last.name) {
        Some(entry) => *entry = Entry { key: last.name.clone(), key_span: last.span, node },
        None => table.entries.push(Entry { key: last.name.clone(), key_span: last.span, node }),
    }
    Ok(())
}

/// The table that an override's path begins with.
pub(crate) fn root(text: &str) -> Option<String> {
    let (parts, _) = path(text, FileId(0))?;
    parts.into_iter().next().map(|part| part.name)
}

/// The parts of the path and where the value starts. Parts may be quoted.
fn path(text: &str, file: FileId) -> Option<(Vec<Part>, usize)> {
    let mut parts = Vec::new();
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let trimmed = rest.trim_start();
        at += rest.len() - trimmed.len();
        let quote = trimmed.chars().next().filter(|c| *c == '"' || *c == '\'');
        let (name, start, end) = match quote {
            Some(quote) => {
                let length = trimmed[1..].find(quote)?;
                (&trimmed[1..=length], at, at + length + 2)
            }
            None => {
                let length = trimmed.find(['.', '=']).unwrap_or(trimmed.len());
                let name = trimmed[..length].trim_end();
                if name.is_empty() {
                    return None;
                }
                (name, at, at + name.len())
            }
        };
        parts.push(Part { name: name.to_owned(), span: Span { file, start, end } });
        let rest = &text[end..];
        let trimmed = rest.trim_start();
        at = end + rest.len() - trimmed.len();
        match trimmed.chars().next()? {
            '.' => at += 1,
            '=' => return Some((parts, at + 1)),
            _ => return None,
        }
    }
}

/// A TOML value, or else bare words as a string.
fn value(text: &str, start: usize, file: FileId) -> Result<Node, Diagnostic> {
    let raw = &text[start..];
    let word = raw.trim();
    let lead = raw.len() - raw.trim_start().len();
    let span = Span { file, start: start + lead, end: start + lead + word.len() };
    if word.is_empty() {
        let span = Span { file, start: start.saturating_sub(1), end: start };
        return Err(Diagnostic::error("override", "no value")
            .at(span)
            .help("write \"\" for an empty string"));
    }
    let string = || Node { value: Value::Text(word.to_owned()), span };
    if word.starts_with('#') {
        return Ok(string());
    }
    match parse_value(text, start, file) {
        Ok(node) => Ok(node),
        Err(_) if bare(word) => Ok(string()),
        Err(error) => {
            Err(Diagnostic { code: "override", ..error }.help("quote text that is not a plain word"))
        }
    }
}

/// Text that cannot have been meant as another value: it starts like a word or a path.
fn bare(word: &str) -> bool {
    let first = word.chars().next().unwrap_or('"');
    let number = word.trim_start_matches(['+', '-', '.']).starts_with(|c: char| c.is_ascii_digit());
    let path = word.starts_with('.') || word.starts_with('/');
    (first.is_alphabetic() || first == '_' || (path && !number))
        && !word.contains(['"', '\'', '\n', '[', ']', '{', '}'])
}

/// The table that a path leads to. Settings tables are made where absent; everything else must exist.
fn descend<'a>(root: &'a mut Table, way: &[Part]) -> Result<&'a mut Table, Diagnostic> {
    let mut table = root;
    for (depth, part) in way.iter().enumerate() {
        let position = table.entries.iter().position(|entry| entry.key == part.name);
        let index = match position {
            Some(index) => index,
            None => {
                let known = section(&part.name).filter(|section| section.form != Form::Inline);
                let makes = match known {
                    // `materials.red = { … }` may be the first material.
                    Some(section) => {
                        section.form == Form::Table || (section.form == Form::Named && way.len() == 1)
                    }
                    None => false,
                };
                if depth > 0 || !makes {
                    return Err(nowhere(table, part, depth));
                }
                let node = Node { value: Value::Table(Table::default()), span: part.span };
                table.entries.push(Entry { key: part.name.clone(), key_span: part.span, node });
                table.entries.len() - 1
            }
        };
        let mut node = &mut table.entries[index].node;
        // In a list the next part is a number or a name; it is stepped over here.
        let listed = matches!(node.value, Value::Array(_));
        if listed {
            let Some(next) = way.get(depth + 1) else {
                let help = format!("write {}.NAME.KEY=VALUE, or a number from 0 for NAME", part.name);
                let message = format!("{} is a list", quoted(&part.name));
                return Err(Diagnostic::error("override", message).at(part.span).help(help));
            };
            node = item(node, &part.name, next)?;
            return descend_rest(node, next, &way[depth + 2..]);
        }
        table = as_table(node, part)?;
    }
    Ok(table)
}

fn descend_rest<'a>(node: &'a mut Node, part: &Part, rest: &[Part]) -> Result<&'a mut Table, Diagnostic> {
    let table = as_table(node, part)?;
    let Some(next) = rest.first() else { return Ok(table) };
    let known: Vec<String> = table.entries.iter().map(|entry| entry.key.clone()).collect();
    let Some(entry) = table.entries.iter_mut().find(|entry| entry.key == next.name) else {
        return Err(unknown(
            &format!("{} has no table {}", quoted(&part.name), quoted(&next.name)),
            next,
            &known,
        ));
    };
    if matches!(entry.node.value, Value::Array(_)) {
        let Some(after) = rest.get(1) else {
            return Err(
                Diagnostic::error("override", format!("{} is a list", quoted(&next.name))).at(next.span)
            );
        };
        let node = item(&mut entry.node, &next.name, after)?;
        return descend_rest(node, after, &rest[2..]);
    }
    descend_rest(&mut entry.node, next, &rest[1..])
}

fn as_table<'a>(node: &'a mut Node, part: &Part) -> Result<&'a mut Table, Diagnostic> {
    let type_name = node.type_name();
    match &mut node.value {
        Value::Table(table) => Ok(table),
        _ => {
            let message = format!("{} is {type_name} and has no keys", quoted(&part.name));
            Err(Diagnostic::error("override", message).at(part.span))
        }
    }
}

/// An item of a list by its `name` or its number from 0.
fn item<'a>(node: &'a mut Node, list: &str, part: &Part) -> Result<&'a mut Node, Diagnostic> {
    let Value::Array(items) = &mut node.value else {
        return Err(Diagnostic::error("override", format!("{} is no list", quoted(list))).at(part.span));
    };
    let name = |node: &Node| match &node.value {
        Value::Table(table) => table.get("name").and_then(|entry| match &entry.node.value {
            Value::Text(name) => Some(name.clone()),
            _ => None,
        }),
        _ => None,
    };
    let names: Vec<Option<String>> = items.iter().map(name).collect();
    let count = items.len();
    let by_name = names.iter().position(|name| name.as_deref() == Some(&part.name));
    let index = by_name.or_else(|| part.name.parse::<usize>().ok());
    match index {
        Some(index) if index < count => Ok(&mut items[index]),
        Some(index) => {
            let message = format!("there is no {} {index}: {count} are numbered from 0", quoted(list));
            Err(Diagnostic::error("override", message).at(part.span))
        }
        None => {
            let names: Vec<String> = names.into_iter().flatten().collect();
            Err(unknown(&format!("none of {} is named {}", quoted(list), quoted(&part.name)), part, &names))
        }
    }
}

fn nowhere(table: &Table, part: &Part, depth: usize) -> Diagnostic {
    let mut names: Vec<String> = table.entries.iter().map(|entry| entry.key.clone()).collect();
    if depth == 0 {
        names.extend(SECTIONS.iter().filter(|s| s.form == Form::Table).map(|s| s.name.to_owned()));
        names.dedup();
    }
    unknown(&format!("there is no {} to set", quoted(&part.name)), part, &names)
}

fn unknown(message: &str, part: &Part, names: &[String]) -> Diagnostic {
    let help = match nearest(&part.name, names.iter().map(String::as_str)) {
        Some(name) => Some(format!("did you mean {}?", quoted(name))),
        None if names.is_empty() => None,
        None => {
            let some: Vec<_> = names.iter().take(12).map(|name| quoted(name)).collect();
            let more = if names.len() > some.len() { ", …" } else { "" };
            Some(format!("there are {}{more}", some.join(", ")))
        }
    };
    Diagnostic::error("override", message).at(part.span).maybe_help(help)
}
