//! From TOML values to numbers, points, words: each checks its type and range and says what is wrong.

use crate::desc::{ColorDesc, FloatDesc, Ior, Triple};
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::document::{Entry, Node, Value};
use crate::nearest::nearest;
use crate::source::Sourced;
use crate::spec::{Kind, Range, Word};

/// "0.5", "\"red\"", "an array": a value as named in a message.
fn shown(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => format!("the string {}", quoted(text)),
        Value::Integer(i) => i.to_string(),
        Value::Number(x) => x.to_string(),
        Value::Bool(b) => b.to_string(),
        _ => node.type_name().to_owned(),
    }
}

/// "wrong-type" for a value that should have been `expected`.
pub(crate) fn wrong_type(report: &mut Report, what: &str, expected: &str, node: &Node) {
    let mut error =
        Diagnostic::error("wrong-type", format!("{what} must be {expected}, not {}", shown(node)))
            .at(node.span);
    if let Value::Text(text) = &node.value
        && (text.trim().parse::<f64>().is_ok() || text == "true" || text == "false")
    {
        error = error.help("remove the quotes");
    }
    report.push(error);
}

/// "out-of-range" for a value that should have been `expected`.
fn out_of_range(report: &mut Report, what: &str, expected: &str, node: &Node) {
    let message = format!("{what} must be {expected}, not {}", shown(node));
    report.push(Diagnostic::error("out-of-range", message).at(node.span));
}

/// An integer from `min` to `max`; 1e6 is one too.
pub(crate) fn integer(report: &mut Report, what: &str, min: i128, max: i128, node: &Node) -> Option<i128> {
    let value = match node.value {
        Value::Integer(i) => i,
        Value::Number(x) if x.fract() == 0.0 && x.abs() < 9.0e15 => x as i128,
        Value::Number(_)
        | Value::Text(_)
        | Value::Bool(_)
        | Value::Datetime
        | Value::Array(_)
        | Value::Table(_) => {
            wrong_type(report, what, &Kind::Integer(min, max).text(), node);
            return None;
        }
    };
    if value < min || value > max {
        out_of_range(report, what, &Kind::Integer(min, max).text(), node);
        return None;
    }
    Some(value)
}

/// A finite number in a range; "inf" and "nan" are errors, as is what overflows 32 bits.
pub(crate) fn number(report: &mut Report, what: &str, range: Range, node: &Node) -> Option<f32> {
    let value = match node.value {
        Value::Integer(i) => i as f64,
        Value::Number(x) => x,
        _ => {
            wrong_type(report, what, &Kind::Number(range).text(), node);
            return None;
        }
    };
    let single = value as f32;
    // Both: 1e-60 is not positive in 32 bits, and 179.99999999 is no longer less than 180.
    if !range.contains(value) || !range.contains(single as f64) {
        let expected = if value.is_finite() && !single.is_finite() {
            "a number that fits 32 bits".to_owned()
        } else if range.text().is_empty() {
            "a finite number".to_owned()
        } else {
            Kind::Number(range).text()
        };
        out_of_range(report, what, &expected, node);
        return None;
    }
    Some(single)
}

/// Exactly `N` numbers.
pub(crate) fn numbers<const N: usize>(
    report: &mut Report,
    what: &str,
    expected: &str,
    range: Range,
    node: &Node,
) -> Option<[f32; N]> {
    let Value::Array(items) = &node.value else {
        wrong_type(report, what, expected, node);
        return None;
    };
    if items.len() != N {
        let message = format!("{what} must be {expected}, not an array of {}", items.len());
        report.push(Diagnostic::error("wrong-type", message).at(node.span));
        return None;
    }
    let mut out = [0.0; N];
    let mut good = true;
    for (i, item) in items.iter().enumerate() {
        match item_number(report, what, i, range, item) {
            Some(x) => out[i] = x,
            None => good = false,
        }
    }
    good.then_some(out)
}

/// A number of an array; its name is made only for an error.
fn item_number(report: &mut Report, what: &str, i: usize, range: Range, item: &Node) -> Option<f32> {
    if let Value::Number(x) = item.value
        && range.contains(x)
        && range.contains(x as f32 as f64)
    {
        return Some(x as f32);
    }
    number(report, &format!("number {} of {what}", i + 1), range, item)
}

/// Two numbers, or one for both.
pub(crate) fn pair(report: &mut Report, what: &str, range: Range, node: &Node) -> Option<[f32; 2]> {
    match node.value {
        Value::Integer(_) | Value::Number(_) => number(report, what, range, node).map(|x| [x; 2]),
        _ => numbers::<2>(report, what, &Kind::Pair(range).text(), range, node),
    }
}

/// A vector of any length but zero.
pub(crate) fn direction(report: &mut Report, what: &str, node: &Node) -> Option<Triple> {
    let vector = numbers::<3>(report, what, &Kind::Direction.text(), crate::spec::ANY, node)?;
    if vector == [0.0; 3] {
        report.push(Diagnostic::error("degenerate", format!("{what} has no length")).at(node.span));
        return None;
    }
    Some(vector)
}

/// Three factors, or one for all; none zero.
pub(crate) fn factors(report: &mut Report, what: &str, node: &Node) -> Option<Triple> {
    let any = crate::spec::ANY;
    let factors = match node.value {
        Value::Integer(_) | Value::Number(_) => [number(report, what, any, node)?; 3],
        _ => numbers::<3>(report, what, &Kind::Factors.text(), any, node)?,
    };
    if factors.contains(&0.0) {
        report.push(
            Diagnostic::error("degenerate", format!("{what} must not be 0: it would flatten")).at(node.span),
        );
        return None;
    }
    Some(factors)
}

/// The sRGB curve inverted (IEC 61966-2-1).
fn linear_from_srgb(byte: u8) -> f32 {
    let x = byte as f64 / 255.0;
    (if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32
}

/// "#rgb" or "#rrggbb".
fn hex_color(text: &str) -> Option<Triple> {
    let digits = text.strip_prefix('#')?;
    if !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let byte = |i: usize| match digits.len() {
        3 => u8::from_str_radix(&digits[i..=i], 16).ok().map(|x| x * 17),
        6 => u8::from_str_radix(&digits[2 * i..2 * i + 2], 16).ok(),
        _ => None,
    };
    Some([linear_from_srgb(byte(0)?), linear_from_srgb(byte(1)?), linear_from_srgb(byte(2)?)])
}

/// [r, g, b], a grey, or "#rrggbb".
pub(crate) fn color(
    report: &mut Report,
    what: &str,
    expected: &str,
    range: Range,
    node: &Node,
) -> Option<Triple> {
    match &node.value {
        Value::Integer(_) | Value::Number(_) => number(report, what, range, node).map(|x| [x; 3]),
        Value::Text(text) => {
            let color = hex_color(text);
            if color.is_none() {
                wrong_type(report, what, expected, node);
            }
            color
        }
        _ => numbers::<3>(report, what, expected, range, node),
    }
}

/// The name in { texture = "NAME" }.
fn texture(report: &mut Report, what: &str, entries: &[Entry], node: &Node) -> Option<Sourced<String>> {
    let mut name = None;
    let mut good = true;
    for entry in entries {
        if entry.key == "texture" {
            name = text(report, &format!("`texture` of {what}"), &entry.node);
            good &= name.is_some();
        } else {
            let help = nearest(&entry.key, ["texture"]).map(|k| format!("did you mean `{k}`?"));
            let message = format!("unknown key {} in {what}", quoted(&entry.key));
            report.push(Diagnostic::error("unknown-key", message).at(entry.key_span).maybe_help(help));
            good = false;
        }
    }
    if name.is_none() && good {
        let message = format!("missing `texture` in {what}");
        report.push(
            Diagnostic::error("missing-key", message).at(node.span).help("write { texture = \"NAME\" }"),
        );
    }
    name
}

/// A colour or a texture.
pub(crate) fn color_desc(report: &mut Report, what: &str, range: Range, node: &Node) -> Option<ColorDesc> {
    match &node.value {
        Value::Table(table) => texture(report, what, &table.entries, node).map(ColorDesc::Texture),
        _ => color(report, what, &Kind::ColorOrTexture(range).text(), range, node).map(ColorDesc::Rgb),
    }
}

/// A number or a texture.
pub(crate) fn float_desc(report: &mut Report, what: &str, range: Range, node: &Node) -> Option<FloatDesc> {
    match &node.value {
        Value::Table(table) => texture(report, what, &table.entries, node).map(FloatDesc::Texture),
        Value::Integer(_) | Value::Number(_) => number(report, what, range, node).map(FloatDesc::Value),
        _ => {
            wrong_type(report, what, &Kind::NumberOrTexture(range).text(), node);
            None
        }
    }
}

/// An index or the name of a substance.
pub(crate) fn ior(report: &mut Report, what: &str, range: Range, node: &Node) -> Option<Ior> {
    match &node.value {
        Value::Text(name) => Some(Ior::Glass(Sourced::at(name.clone(), node.span))),
        Value::Integer(_) | Value::Number(_) => number(report, what, range, node).map(Ior::Value),
        _ => {
            wrong_type(report, what, &Kind::Ior(range).text(), node);
            None
        }
    }
}

/// A string.
pub(crate) fn text(report: &mut Report, what: &str, node: &Node) -> Option<Sourced<String>> {
    match &node.value {
        Value::Text(text) => Some(Sourced::at(text.clone(), node.span)),
        _ => {
            wrong_type(report, what, "a string", node);
            None
        }
    }
}

/// One of some words.
pub(crate) fn word(
    report: &mut Report,
    what: &str,
    words: &'static [Word],
    node: &Node,
) -> Option<&'static str> {
    let Value::Text(text) = &node.value else {
        wrong_type(report, what, &Kind::Word(words).text(), node);
        return None;
    };
    if let Some(word) = words.iter().find(|word| word.name == text) {
        return Some(word.name);
    }
    let names = || words.iter().map(|word| word.name);
    report.push(unknown_word(&format!("{what} knows no {}", quoted(text)), text, names, node));
    None
}

/// "unknown-kind": the nearest of the words, and all of them.
pub(crate) fn unknown_word<'a, I: Iterator<Item = &'a str>>(
    message: &str,
    text: &str,
    names: impl Fn() -> I,
    node: &Node,
) -> Diagnostic {
    let all = names().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let help = match nearest(text, names()) {
        Some(name) => format!("did you mean \"{name}\"? There are {all}"),
        None => format!("there are {all}"),
    };
    Diagnostic::error("unknown-kind", message).at(node.span).help(help)
}

/// A list, each item read by `read`; stops at the first bad item, so that a long list is not a long report.
pub(crate) fn list<T>(
    report: &mut Report,
    what: &str,
    expected: &str,
    node: &Node,
    mut read: impl FnMut(&mut Report, &str, &Node) -> Option<T>,
) -> Option<Vec<T>> {
    let Value::Array(items) = &node.value else {
        wrong_type(report, what, expected, node);
        return None;
    };
    let mut out = Vec::with_capacity(items.len());
    for (i, item) in items.iter().enumerate() {
        let mut probe = Report::default();
        match read(&mut probe, "", item) {
            Some(value) => out.push(value),
            None => {
                // Once more, with the name of the item.
                read(report, &format!("item {} of {what}", i + 1), item);
                return None;
            }
        }
    }
    Some(out)
}

/// Three vertex numbers.
pub(crate) fn indices(report: &mut Report, what: &str, node: &Node) -> Option<[u32; 3]> {
    let Value::Array(items) = &node.value else {
        wrong_type(report, what, "three vertex numbers [a, b, c]", node);
        return None;
    };
    if items.len() != 3 {
        let message = format!("{what} must be three vertex numbers, not {}", items.len());
        report.push(Diagnostic::error("wrong-type", message).at(node.span));
        return None;
    }
    let mut out = [0; 3];
    for (slot, item) in out.iter_mut().zip(items) {
        *slot = integer(report, what, 0, u32::MAX as i128, item)? as u32;
    }
    Some(out)
}
