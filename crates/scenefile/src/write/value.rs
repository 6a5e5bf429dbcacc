//! Values as TOML text, and the lines of one table.

use crate::desc::{ColorDesc, FloatDesc, Ior, Triple};
use crate::spec::{Preset, Section};

/// The shortest decimal that reads back as the same number of 32 bits.
pub(super) fn number(x: f32) -> String {
    if x.is_nan() {
        return "nan".into();
    }
    if x.is_infinite() {
        return if x > 0.0 { "inf".into() } else { "-inf".into() };
    }
    let text = if x != 0.0 && !(1e-5..1e9).contains(&x.abs()) { format!("{x:e}") } else { format!("{x}") };
    // The reader goes by way of 64 bits; where that rounds twice the long form is exact.
    let exact = text.parse::<f64>().is_ok_and(|wide| wide as f32 == x);
    let text = if exact { text } else { format!("{:e}", x as f64) };
    if text == "-0" { "-0.0".into() } else { text }
}

/// [x, y, z].
pub(super) fn triple(t: Triple) -> String {
    format!("[{}]", t.map(number).join(", "))
}

/// A basic string.
pub(super) fn quote(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            '\r' => out += "\\r",
            c if c.is_control() => out += &format!("\\u{:04X}", c as u32),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A key, quoted where it must be.
pub(super) fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { name.to_owned() } else { quote(name) }
}

fn color(rgb: Triple) -> String {
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] { number(rgb[0]) } else { triple(rgb) }
}

fn texture(name: &str) -> String {
    format!("{{ texture = {} }}", quote(name))
}

/// The lines of one table; what equals the default of its specification is left out.
pub(super) struct Fields {
    section: &'static Section,
    pub(super) kind: Option<&'static str>,
    pub(super) lines: Vec<(&'static str, String)>,
}

impl Fields {
    /// A table of a kind, which is written unless it is the default one.
    pub(super) fn new(section: &'static Section, kind: Option<&'static str>) -> Self {
        let mut fields = Self { section, kind, lines: Vec::new() };
        if let (Some(switch), Some(kind)) = (section.switch, kind)
            && switch.preset != Some(kind)
        {
            fields.lines.push((switch.key, quote(kind)));
        }
        fields
    }

    fn preset(&self, key: &str) -> Option<Preset> {
        let variant = self.kind.and_then(|kind| self.section.variant(kind));
        let mut keys = self.section.keys.iter().chain(variant.into_iter().flat_map(|variant| variant.keys()));
        keys.find(|spec| spec.name == key).map(|spec| spec.preset)
    }

    /// A value as it stands.
    pub(super) fn raw(&mut self, key: &'static str, value: String) {
        self.lines.push((key, value));
    }

    /// A value before all others.
    pub(super) fn first(&mut self, key: &'static str, value: String) {
        self.lines.insert(0, (key, value));
    }

    pub(super) fn text(&mut self, key: &'static str, text: &str) {
        self.raw(key, quote(text));
    }

    pub(super) fn word(&mut self, key: &'static str, word: &'static str) {
        if self.preset(key) != Some(Preset::Word(word)) {
            self.raw(key, quote(word));
        }
    }

    pub(super) fn bool(&mut self, key: &'static str, value: bool) {
        if self.preset(key) != Some(Preset::Bool(value)) {
            self.raw(key, value.to_string());
        }
    }

    pub(super) fn integer(&mut self, key: &'static str, value: impl Into<i128>) {
        let value = value.into();
        if self.preset(key) != Some(Preset::Integer(value)) {
            self.raw(key, value.to_string());
        }
    }

    fn is_preset(&self, key: &str, value: f32) -> bool {
        matches!(self.preset(key), Some(Preset::Number(preset)) if preset as f32 == value)
    }

    pub(super) fn number(&mut self, key: &'static str, value: f32) {
        if !self.is_preset(key, value) {
            self.raw(key, number(value));
        }
    }

    pub(super) fn optional_number(&mut self, key: &'static str, value: Option<f32>) {
        if let Some(value) = value {
            self.raw(key, number(value));
        }
    }

    /// Two values as text.
    pub(super) fn pair(&mut self, key: &'static str, pair: [String; 2]) {
        let preset = match self.preset(key) {
            Some(Preset::Pair(preset)) => Some(preset.map(|x| number(x as f32))),
            _ => None,
        };
        if preset != Some(pair.clone()) {
            self.raw(key, format!("[{}]", pair.join(", ")));
        }
    }

    /// Two numbers for which one may stand.
    pub(super) fn factor_pair(&mut self, key: &'static str, pair: [f32; 2]) {
        if pair[0] != pair[1] {
            self.raw(key, format!("[{}, {}]", number(pair[0]), number(pair[1])));
        } else {
            self.number(key, pair[0]);
        }
    }

    pub(super) fn triple(&mut self, key: &'static str, value: Triple) {
        let default =
            matches!(self.preset(key), Some(Preset::Triple(preset)) if preset.map(|x| x as f32) == value);
        if !default {
            self.raw(key, triple(value));
        }
    }

    pub(super) fn color(&mut self, key: &'static str, value: &ColorDesc) {
        match value {
            ColorDesc::Rgb(rgb) if rgb.iter().all(|x| self.is_preset(key, *x)) => {}
            ColorDesc::Rgb(rgb) => self.raw(key, color(*rgb)),
            ColorDesc::Texture(name) => self.raw(key, texture(name)),
        }
    }

    pub(super) fn float(&mut self, key: &'static str, value: &FloatDesc) {
        match value {
            FloatDesc::Value(x) => self.number(key, *x),
            FloatDesc::Texture(name) => self.raw(key, texture(name)),
        }
    }

    pub(super) fn ior(&mut self, key: &'static str, value: &Ior) {
        match value {
            Ior::Value(x) => self.number(key, *x),
            Ior::Glass(name) => self.text(key, name),
        }
    }

    pub(super) fn list<T>(&mut self, key: &'static str, items: &[T], write: impl Fn(&T) -> String) {
        self.raw(key, format!("[{}]", items.iter().map(write).collect::<Vec<_>>().join(", ")));
    }

    /// As an inline table.
    pub(super) fn inline(&self) -> String {
        let lines: Vec<_> = self.lines.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        format!("{{ {} }}", lines.join(", "))
    }
}
