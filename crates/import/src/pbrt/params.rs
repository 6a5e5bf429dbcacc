//! Parameters: `"type name" [ values ]`, and their use.

use std::cell::Cell;

use scenefile::{Diagnostic, Span};

use crate::report::Report;
use crate::spectrum::Space;

/// What stood between the brackets.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
    Truths(Vec<bool>),
}

/// One parameter.
#[derive(Clone, Debug)]
pub(super) struct Param {
    /// Its type, by the name of pbrt-v4.
    pub kind: &'static str,
    pub name: String,
    pub values: Values,
    /// Its declaration.
    pub span: Span,
    used: Cell<bool>,
}

/// Types by every name they have, their name in version 4, and how many numbers make one value (0: none do).
const TYPES: [(&str, &str, usize); 19] = [
    ("integer", "integer", 1),
    ("float", "float", 1),
    ("point2", "point2", 2),
    ("vector2", "vector2", 2),
    ("point3", "point3", 3),
    ("point", "point3", 3),
    ("vector3", "vector3", 3),
    ("vector", "vector3", 3),
    ("normal3", "normal", 3),
    ("normal", "normal", 3),
    ("rgb", "rgb", 3),
    ("color", "rgb", 3),
    ("xyz", "xyz", 3),
    ("blackbody", "blackbody", 1),
    ("spectrum", "spectrum", 0),
    ("string", "string", 0),
    ("texture", "texture", 0),
    ("bool", "bool", 0),
    ("boolean", "bool", 0),
];

impl Param {
    /// Checks a declaration and its values against each other.
    pub(super) fn new(declaration: &str, values: Values, span: Span) -> Result<Self, Diagnostic> {
        let wrong = |text: String| Err(Diagnostic::error("parameter", text).at(span));
        let mut words = declaration.split_ascii_whitespace();
        let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
            return wrong(format!("`{declaration}` does not read as a type and a name"));
        };
        let Some(&(_, kind, arity)) = TYPES.iter().find(|(alias, ..)| *alias == kind) else {
            return wrong(format!("`{kind}` is no type of parameter"));
        };
        let fits = match (&values, kind) {
            (Values::Numbers(n), "spectrum") => n.len() % 2 == 0 && !n.is_empty(),
            // Version 3 gives a factor after the temperature.
            (Values::Numbers(n), "blackbody") => matches!(n.len(), 1 | 2),
            (Values::Numbers(n), _) => arity > 0 && n.len() % arity == 0,
            (Values::Texts(_), _) => matches!(kind, "string" | "texture" | "spectrum"),
            (Values::Truths(_), _) => kind == "bool",
        };
        // An empty list is one of any type.
        let fits = fits || values == Values::Numbers(Vec::new());
        let number = |n: &Vec<f64>| n.iter().all(|x| (*x as f32).is_finite());
        let finite = if let Values::Numbers(n) = &values { number(n) } else { true };
        match (fits, finite) {
            (false, _) => wrong(format!("the values of `{name}` are not of the type `{kind}`")),
            (_, false) => wrong(format!("a value of `{name}` is not finite")),
            _ => Ok(Self { kind, name: name.to_owned(), values, span, used: Cell::new(false) }),
        }
    }

    pub(super) fn numbers(&self) -> &[f64] {
        if let Values::Numbers(n) = &self.values { n } else { &[] }
    }

    pub(super) fn text(&self) -> Option<&str> {
        if let Values::Texts(t) = &self.values { t.first().map(String::as_str) } else { None }
    }

    /// The first three numbers.
    pub(super) fn triple(&self) -> Option<[f64; 3]> {
        let n = self.numbers();
        (n.len() >= 3).then(|| [n[0], n[1], n[2]])
    }
}

/// The parameters of one directive.
#[derive(Clone, Debug)]
pub(super) struct Params {
    /// What they belong to, as "the shape `sphere`".
    pub what: String,
    /// The directive.
    pub span: Span,
    /// What RGB values mean.
    pub space: Space,
    list: Vec<Param>,
}

impl Params {
    /// `defaults`: what `Attribute` set before, which a parameter of the same name replaces.
    pub(super) fn new(what: String, span: Span, space: Space, list: Vec<Param>, defaults: &[Param]) -> Self {
        let mut params = Self { what, span, space, list };
        for (i, default) in defaults.iter().enumerate() {
            let later = defaults[i + 1..].iter().any(|d| d.name == default.name);
            if !later && !params.list.iter().any(|p| p.name == default.name) {
                // Whoever does not know a default may leave it.
                default.used.set(true);
                params.list.push(default.clone());
            }
        }
        params
    }

    /// The last parameter of a name that is of one of the types; it counts as used.
    pub(super) fn find(&self, name: &str, kinds: &[&str]) -> Option<&Param> {
        let found = self.list.iter().rev().find(|p| p.name == name && kinds.contains(&p.kind))?;
        found.used.set(true);
        Some(found)
    }

    /// Whether there is a parameter of a name, of any type; it counts as used.
    pub(super) fn any(&self, name: &str) -> Option<&Param> {
        let found = self.list.iter().rev().find(|p| p.name == name)?;
        found.used.set(true);
        Some(found)
    }

    /// A number, of an integer or float.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.find(name, &["float", "integer"]).and_then(|p| p.numbers().first().copied())
    }

    /// A number or its default.
    pub(super) fn number_or(&self, name: &str, default: f64) -> f64 {
        self.number(name).unwrap_or(default)
    }

    /// A whole number within `range`, or the default; one outside is an error.
    pub(super) fn integer(&self, report: &mut Report, name: &str, default: u32, range: [u32; 2]) -> u32 {
        let Some(param) = self.find(name, &["integer", "float"]) else { return default };
        let Some(&value) = param.numbers().first() else { return default };
        let [low, high] = range.map(f64::from);
        if value.fract() == 0.0 && (low..=high).contains(&value) {
            return value as u32;
        }
        let text =
            format!("`{name}` of {} must be a whole number from {low} to {high}, not {value}", self.what);
        report.error("out-of-range", text, param.span);
        default
    }

    /// A number > 0, or the default; one that is not is an error.
    pub(super) fn positive(&self, report: &mut Report, name: &str, default: f64) -> f64 {
        let Some(param) = self.find(name, &["float", "integer"]) else { return default };
        match param.numbers().first() {
            Some(&value) if value > 0.0 => value,
            _ => {
                let text = format!("`{name}` of {} must be greater than 0", self.what);
                report.error("out-of-range", text, param.span);
                default
            }
        }
    }

    pub(super) fn truth(&self, name: &str) -> Option<bool> {
        match self.find(name, &["bool"])?.values {
            Values::Truths(ref t) => t.first().copied(),
            _ => None,
        }
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.find(name, &["string"]).and_then(Param::text)
    }

    pub(super) fn point(&self, name: &str) -> Option<[f64; 3]> {
        self.find(name, &["point3", "vector3", "normal"]).and_then(Param::triple)
    }

    /// Triples of points or normals; none where absent.
    pub(super) fn triples(&self, name: &str) -> Vec<[f64; 3]> {
        let numbers = self.find(name, &["point3", "vector3", "normal"]).map_or(&[][..], Param::numbers);
        numbers.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
    }

    /// Texture coordinates by any of the names; old files give them as plain numbers.
    pub(super) fn pairs(&self, names: &[&str]) -> Vec<[f64; 2]> {
        let found = names.iter().find_map(|n| self.find(n, &["point2", "vector2", "float"]));
        found.map_or(&[][..], Param::numbers).chunks_exact(2).map(|c| [c[0], c[1]]).collect()
    }

    /// Indices of vertices; empty where absent. `None`: one is no index of `count` vertices, which is an error.
    pub(super) fn indices(&self, report: &mut Report, name: &str, count: usize) -> Option<Vec<u32>> {
        let Some(param) = self.find(name, &["integer"]) else { return Some(Vec::new()) };
        if let Some(bad) =
            param.numbers().iter().find(|i| !(0.0..count as f64).contains(*i) || i.fract() != 0.0)
        {
            let text = format!("{} names vertex {bad}, but there are {count}", self.what);
            report.error("out-of-range", text, param.span);
            return None;
        }
        Some(param.numbers().iter().map(|i| *i as u32).collect())
    }

    /// Marks parameters that change nothing here.
    pub(super) fn ignore(&self, names: &[&str]) {
        for name in names {
            self.any(name);
        }
    }

    /// Says which parameters are of no use to anybody.
    pub(super) fn finish(&self, report: &mut Report) {
        for param in self.list.iter().filter(|p| !p.used.get()) {
            let text = format!("{} has no parameter `{} {}`", self.what, param.kind, param.name);
            report.push(
                Diagnostic::warning("unknown-parameter", format!("{text}: it is ignored")).at(param.span),
            );
        }
    }
}
