//! Plugins: objects of a scene with their parameters.

use std::cell::Cell;
use std::rc::Rc;

use scenefile::{Diagnostic, Span};

use super::spectrum::Spectrum;
use crate::matrix::Matrix;
use crate::report::Report;

/// What a plugin is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    Shape,
    Bsdf,
    Emitter,
    Sensor,
    Film,
    Sampler,
    Integrator,
    Filter,
    Texture,
    Medium,
    Phase,
    Volume,
    Subsurface,
}

/// Elements that are plugins, by every name they have.
const TAGS: [(&str, Tag); 16] = [
    ("shape", Tag::Shape),
    ("bsdf", Tag::Bsdf),
    ("emitter", Tag::Emitter),
    ("luminaire", Tag::Emitter),
    ("sensor", Tag::Sensor),
    ("camera", Tag::Sensor),
    ("film", Tag::Film),
    ("sampler", Tag::Sampler),
    ("integrator", Tag::Integrator),
    ("rfilter", Tag::Filter),
    ("texture", Tag::Texture),
    ("medium", Tag::Medium),
    ("phase", Tag::Phase),
    ("volume", Tag::Volume),
    ("subsurface", Tag::Subsurface),
    ("spectrum", Tag::Texture),
];

impl Tag {
    pub(super) fn from_name(name: &str) -> Option<Self> {
        TAGS.iter().find(|(n, _)| *n == name).map(|(_, tag)| *tag)
    }

    /// Every name of an element that is a plugin.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        TAGS.iter().map(|(name, _)| *name)
    }

    pub(super) fn name(self) -> &'static str {
        TAGS.iter().find(|(_, tag)| *tag == self).map_or("", |(name, _)| name)
    }
}

/// The value of a parameter.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Truth(bool),
    Text(String),
    /// A point or vector.
    Triple([f64; 3]),
    Color(Spectrum),
    Place(Matrix),
    Plugin(Rc<Plugin>),
    /// A plugin by its id.
    Reference(String),
}

/// A parameter.
#[derive(Debug)]
pub(super) struct Param {
    /// Empty for nested plugins without a name.
    pub name: String,
    pub value: Value,
    pub span: Span,
    used: Cell<bool>,
}

impl Param {
    pub(super) fn new(name: String, value: Value, span: Span) -> Self {
        Self { name, value, span, used: Cell::new(false) }
    }

    pub(super) fn mark(&self) {
        self.used.set(true);
    }
}

/// An object of the scene.
#[derive(Debug)]
pub(super) struct Plugin {
    pub tag: Tag,
    pub kind: String,
    pub id: Option<String>,
    pub span: Span,
    /// Of its `type`.
    pub kind_span: Span,
    /// Whether it is of a version before 2.
    pub old: bool,
    /// No other has the same.
    pub index: usize,
    pub params: Vec<Param>,
}

impl Plugin {
    /// What it is, in words.
    pub(super) fn what(&self) -> String {
        format!("the {} `{}`", self.tag.name(), self.kind)
    }

    /// A name for it: its id, else its kind.
    pub(super) fn label(&self) -> &str {
        self.id.as_deref().filter(|id| !id.is_empty()).unwrap_or(&self.kind)
    }

    /// The parameter of a name; it counts as used.
    pub(super) fn find(&self, name: &str) -> Option<&Param> {
        let found = self.params.iter().find(|p| p.name == name)?;
        found.mark();
        Some(found)
    }

    /// The first there is of several names; all count as used.
    pub(super) fn find_any(&self, names: &[&str]) -> Option<&Param> {
        names.iter().filter_map(|name| self.find(name)).fold(None, |first, p| first.or(Some(p)))
    }

    /// Marks parameters that change nothing here.
    pub(super) fn ignore(&self, names: &[&str]) {
        names.iter().for_each(|name| {
            self.find(name);
        });
    }

    fn wrong(&self, report: &mut Report, param: &Param, wanted: &str) {
        let text = format!("`{}` of {} must be {wanted}", param.name, self.what());
        report.error("parameter", text, param.span);
    }

    /// A number; another type is an error.
    pub(super) fn number(&self, report: &mut Report, name: &str) -> Option<f64> {
        let param = self.find(name)?;
        match param.value {
            Value::Number(x) => return Some(x),
            Value::Color(Spectrum::Flat(x)) => return Some(x),
            _ => self.wrong(report, param, "a number"),
        }
        None
    }

    pub(super) fn number_or(&self, report: &mut Report, name: &str, default: f64) -> f64 {
        self.number(report, name).unwrap_or(default)
    }

    /// A number > 0.
    pub(super) fn positive(&self, report: &mut Report, name: &str, default: f64) -> f64 {
        match self.number(report, name) {
            Some(x) if x > 0.0 => x,
            None => default,
            Some(_) => {
                let text = format!("`{name}` of {} must be greater than 0", self.what());
                report.error("out-of-range", text, self.find(name).map_or(self.span, |p| p.span));
                default
            }
        }
    }

    /// A whole number within `range`; one outside is an error.
    pub(super) fn integer(&self, report: &mut Report, name: &str, range: [i64; 2]) -> Option<i64> {
        let x = self.number(report, name)?;
        let [low, high] = range.map(|x| x as f64);
        if x.fract() == 0.0 && (low..=high).contains(&x) {
            return Some(x as i64);
        }
        let text =
            format!("`{name}` of {} must be a whole number from {low} to {high}, not {x}", self.what());
        report.error("out-of-range", text, self.find(name).map_or(self.span, |p| p.span));
        None
    }

    pub(super) fn truth(&self, report: &mut Report, name: &str) -> Option<bool> {
        let param = self.find(name)?;
        match &param.value {
            Value::Truth(x) => return Some(*x),
            _ => self.wrong(report, param, "a boolean"),
        }
        None
    }

    pub(super) fn is(&self, report: &mut Report, name: &str) -> bool {
        self.truth(report, name).unwrap_or(false)
    }

    pub(super) fn text(&self, report: &mut Report, name: &str) -> Option<&str> {
        let param = self.find(name)?;
        match &param.value {
            Value::Text(x) => return Some(x),
            _ => self.wrong(report, param, "a string"),
        }
        None
    }

    pub(super) fn triple(&self, report: &mut Report, name: &str) -> Option<[f64; 3]> {
        let param = self.find(name)?;
        match param.value {
            Value::Triple(x) => return Some(x),
            Value::Color(Spectrum::Rgb(x)) => return Some(x),
            _ => self.wrong(report, param, "a point or vector"),
        }
        None
    }

    /// A transform; the identity where there is none.
    pub(super) fn place(&self, report: &mut Report, name: &str) -> Matrix {
        match self.find(name) {
            Some(Param { value: Value::Place(m), .. }) => *m,
            Some(param) => {
                self.wrong(report, param, "a transform");
                Matrix::IDENTITY
            }
            None => Matrix::IDENTITY,
        }
    }

    /// Says which parameters are of no use to anybody.
    pub(super) fn finish(&self, report: &mut Report) {
        for param in self.params.iter().filter(|p| !p.used.get()) {
            let text = match &param.value {
                Value::Plugin(plugin) => format!("{} has no use for {}", self.what(), plugin.what()),
                Value::Reference(id) => format!("{} has no use for `{id}`", self.what()),
                _ => format!("{} has no parameter `{}`", self.what(), param.name),
            };
            report.push(
                Diagnostic::warning("unknown-parameter", format!("{text}: it is ignored")).at(param.span),
            );
        }
    }
}
