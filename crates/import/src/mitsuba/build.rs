//! From elements to plugins with typed parameters.

use std::rc::Rc;

use scenefile::{Diagnostic, Span};

use super::Importer;
use super::plugin::{Param, Plugin, Tag, Value};
use super::xml::Node;
use crate::report::nearest;

/// Elements that are no plugins.
const ELEMENTS: [&str; 17] = [
    "integer",
    "float",
    "string",
    "boolean",
    "point",
    "vector",
    "rgb",
    "srgb",
    "spectrum",
    "blackbody",
    "transform",
    "animation",
    "ref",
    "alias",
    "default",
    "include",
    "path",
];

/// The numbers of a list by commas or spaces; `None` where a word is no finite number.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty());
    words.map(|w| w.parse().ok().filter(|x: &f64| (*x as f32).is_finite())).collect()
}

/// A name of version 2 and later from one of before: `toWorld` is `to_world`, `intIOR` is `int_ior`.
fn modern(name: &str) -> String {
    let mut out = String::new();
    let mut before = ' ';
    for c in name.chars() {
        if c.is_ascii_uppercase() && before.is_ascii_lowercase() {
            out.push('_');
        }
        out.push(c.to_ascii_lowercase());
        before = c;
    }
    out
}

impl Importer {
    /// A plugin and all within it. `None`: it has no type, which is an error.
    pub(super) fn plugin(&mut self, node: &Node, tag: Tag) -> Option<Rc<Plugin>> {
        self.known_attributes(node, &["type", "id", "name", "version", "value", "intent"]);
        let Some(kind) = node.attribute("type") else {
            self.report.error("syntax", format!("<{}> has no `type`", node.tag), node.span);
            return None;
        };
        let id = node.text("id").map(str::to_owned);
        let mut params: Vec<Param> = Vec::new();
        for child in &node.children {
            let Some(param) = self.param(child) else { continue };
            if !param.name.is_empty() && params.iter().any(|p| p.name == param.name) {
                let text = format!("`{}` is given twice", param.name);
                self.report.error("duplicate", text, param.span);
            }
            params.push(param);
        }
        self.plugins += 1;
        let plugin = Rc::new(Plugin {
            tag,
            kind: kind.value.clone(),
            id: id.clone(),
            span: node.span,
            kind_span: kind.span,
            old: node.old,
            index: self.plugins,
            params,
        });
        if let Some(id) = id {
            self.identify(id, plugin.clone());
        }
        Some(plugin)
    }

    fn identify(&mut self, id: String, plugin: Rc<Plugin>) {
        let span = plugin.span;
        if let Some(first) = self.ids.insert(id.clone(), plugin) {
            let text = format!("the id `{id}` is given twice");
            let twice = Diagnostic::error("duplicate", text).at(span);
            self.report.push(twice.label(first.span, "here it was given before"));
        }
    }

    /// Says that an element is none.
    pub(super) fn unknown_element(&mut self, node: &Node) {
        let known = ELEMENTS.iter().copied().chain(Tag::names());
        let wrong = Diagnostic::error("unknown-element", format!("there is no element <{}>", node.tag));
        let help = nearest(&node.tag, known).map(|n| format!("did you mean <{n}>?"));
        self.report.push(wrong.at(node.span).maybe_help(help));
    }

    /// A parameter or nested plugin; `None` where it is none, which is reported.
    fn param(&mut self, node: &Node) -> Option<Param> {
        let given = node.text("name").unwrap_or_default();
        let name = if node.old { modern(given) } else { given.to_owned() };
        let span = node.attribute("value").map_or(node.span, |a| a.span);
        let (value, span) = match (node.tag.as_str(), Tag::from_name(&node.tag)) {
            ("spectrum", _) if node.text("type").is_none() => (Value::Color(self.spectrum(node)?), span),
            (_, Some(tag)) => (Value::Plugin(self.plugin(node, tag)?), node.span),
            ("rgb" | "srgb" | "blackbody", _) => (Value::Color(self.spectrum(node)?), span),
            ("integer" | "float", _) => {
                self.known_attributes(node, &["name", "value"]);
                let value = self.required(node, "value")?;
                match value.trim().parse::<f64>() {
                    Ok(x) if (x as f32).is_finite() => (Value::Number(x), span),
                    // Nothing is as far as that.
                    Ok(x) if x.is_infinite() => (Value::Number(f64::from(f32::MAX).copysign(x)), span),
                    _ => return self.malformed(&value, "number", span),
                }
            }
            ("boolean", _) => {
                self.known_attributes(node, &["name", "value"]);
                let value = self.required(node, "value")?;
                match value.trim().to_ascii_lowercase().as_str() {
                    "true" => (Value::Truth(true), span),
                    "false" => (Value::Truth(false), span),
                    _ => return self.malformed(&value, "boolean", span),
                }
            }
            ("string", _) => {
                self.known_attributes(node, &["name", "value"]);
                (Value::Text(self.required(node, "value")?), span)
            }
            ("point" | "vector", _) => {
                self.known_attributes(node, &["name", "value", "x", "y", "z"]);
                (Value::Triple(self.triple(node, 0.0)?), span)
            }
            ("transform", _) => (Value::Place(self.transform(node)?), node.span),
            ("animation", _) => {
                let text = "movement is not rendered";
                self.report.instead(text, "the first place holds", node.span);
                let first = node.children.iter().find(|c| c.tag == "transform")?;
                (Value::Place(self.transform(first)?), node.span)
            }
            ("ref", _) => {
                self.known_attributes(node, &["id", "name"]);
                (Value::Reference(self.required(node, "id")?), node.span)
            }
            _ => {
                self.unknown_element(node);
                return None;
            }
        };
        Some(Param::new(name, value, span))
    }

    pub(super) fn malformed<T>(&mut self, value: &str, what: &str, span: Span) -> Option<T> {
        let mut shown: String = value.chars().take(40).collect();
        if shown.len() < value.len() {
            shown.push('…');
        }
        self.report.error("syntax", format!("`{shown}` does not read as a {what}"), span);
        None
    }

    /// The text of an attribute that must be there.
    pub(super) fn required(&mut self, node: &Node, name: &str) -> Option<String> {
        let found = node.text(name).map(str::to_owned);
        if found.is_none() {
            self.report.error("syntax", format!("<{}> has no `{name}`", node.tag), node.span);
        }
        found
    }

    /// Says which attributes an element does not have.
    pub(super) fn known_attributes(&mut self, node: &Node, known: &[&str]) {
        for attribute in node.attributes.iter().filter(|a| !known.contains(&a.name.as_str())) {
            let text = format!("<{}> has no attribute `{}`: it is ignored", node.tag, attribute.name);
            let help = nearest(&attribute.name, known.iter().copied());
            let wrong = Diagnostic::warning("unknown-attribute", text).at(attribute.span);
            self.report.push(wrong.maybe_help(help.map(|n| format!("did you mean `{n}`?"))));
        }
    }

    /// x, y and z, each or in one; `value` of one number stands for all three.
    pub(super) fn triple(&mut self, node: &Node, default: f64) -> Option<[f64; 3]> {
        if let Some(value) = node.attribute("value") {
            return match numbers(&value.value).as_deref() {
                Some([x, y, z]) => Some([*x, *y, *z]),
                Some([x]) => Some([*x; 3]),
                _ => self.malformed(&value.value, "triple of numbers", value.span),
            };
        }
        let mut out = [default; 3];
        for (x, name) in out.iter_mut().zip(["x", "y", "z"]) {
            if let Some(a) = node.attribute(name) {
                match a.value.trim().parse::<f64>() {
                    Ok(value) if (value as f32).is_finite() => *x = value,
                    _ => return self.malformed(&a.value, "number", a.span),
                }
            }
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_names() {
        for (old, new) in [("toWorld", "to_world"), ("intIOR", "int_ior"), ("alphaU", "alpha_u"), ("k", "k")]
        {
            assert_eq!(modern(old), new);
        }
    }

    #[test]
    fn lists() {
        assert_eq!(numbers(" 1, 2  3,4 "), Some(vec![1.0, 2.0, 3.0, 4.0]));
        assert_eq!(numbers("1;2"), None);
        assert_eq!(numbers("nan"), None);
        assert_eq!(numbers("1e39"), None);
    }
}
