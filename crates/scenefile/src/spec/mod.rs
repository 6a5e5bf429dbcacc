//! The one table of what a scene file may say. The reader checks keys, types and ranges by it, the writer leaves out
//! what it gives as default, and `describe` prints it.

mod light;
mod material;
mod object;
mod settings;
mod shape;
mod texture;

pub use light::LIGHTS;
pub use material::MATERIALS;
pub use object::{DISPLACEMENT, GROUPS, INSTANCES, LOOK_AT, OBJECTS, ROTATE, TRANSFORM};
pub use settings::{CAMERA, FILM, PHOTON_MAP, RENDER, SPPM, VCM};
pub use texture::{PICTURES, TEXTURE_REF, TEXTURES};

/// Numbers that a key allows; always finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least, or what it must exceed.
    pub min: f64,
    /// The greatest, or what it must stay below.
    pub max: f64,
    /// Whether `min` itself is excluded.
    pub open_min: bool,
    /// Whether `max` itself is excluded.
    pub open_max: bool,
}

/// Any finite number.
pub const ANY: Range = Range { min: f64::NEG_INFINITY, max: f64::INFINITY, open_min: true, open_max: true };
/// > 0.
pub const POSITIVE: Range = Range { min: 0.0, ..ANY };
/// ≥ 0.
pub const NON_NEGATIVE: Range = Range { min: 0.0, open_min: false, ..ANY };
/// 0 to 1.
pub const UNIT: Range = closed(0.0, 1.0);

/// From `min` to `max`, both allowed.
pub const fn closed(min: f64, max: f64) -> Range {
    Range { min, max, open_min: false, open_max: false }
}

impl Range {
    /// Whether a number is allowed.
    pub fn contains(&self, x: f64) -> bool {
        let above = if self.open_min { x > self.min } else { x >= self.min };
        let below = if self.open_max { x < self.max } else { x <= self.max };
        x.is_finite() && above && below
    }

    /// "> 0", "from 0 to 1", …; empty for any finite number.
    pub fn text(&self) -> String {
        let low = if self.open_min { ">" } else { "≥" };
        let high = if self.open_max { "<" } else { "≤" };
        match (self.min.is_finite(), self.max.is_finite()) {
            (false, false) => String::new(),
            (true, false) => format!("{low} {}", self.min),
            (false, true) => format!("{high} {}", self.max),
            (true, true) if self.open_min || self.open_max => {
                format!("{low} {} and {high} {}", self.min, self.max)
            }
            (true, true) => format!("from {} to {}", self.min, self.max),
        }
    }
}

/// One of a set of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// What it means, one line.
    pub doc: &'static str,
}

/// A word and what it means.
pub const fn word(name: &'static str, doc: &'static str) -> Word {
    Word { name, doc }
}

/// The type of a key's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// true or false.
    Bool,
    /// An integer from the first to the second.
    Integer(i128, i128),
    /// A number.
    Number(Range),
    /// Any string.
    Text,
    /// A number, or one of these words.
    NumberOrWord(Range, &'static [Word]),
    /// One of these words.
    Word(&'static [Word]),
    /// Some of these words, in any order.
    Words(&'static [Word]),
    /// Two integers, each from the first to the second.
    Size(i128, i128),
    /// Four integers: a part of the picture.
    Window,
    /// Two numbers, or one that stands for both.
    Pair(Range),
    /// A point or vector [x, y, z].
    Point,
    /// A vector of any length but zero.
    Direction,
    /// Three factors or one that stands for all, none zero.
    Factors,
    /// A linear colour [r, g, b], one number (grey) or "#rrggbb" (sRGB).
    Color(Range),
    /// A colour as above or a texture.
    ColorOrTexture(Range),
    /// A number or a texture.
    NumberOrTexture(Range),
    /// A number in the range or the name of a substance.
    Ior(Range),
    /// A file name, relative to the scene file, with one of these extensions.
    File(&'static [&'static str]),
    /// The name of a texture.
    Texture,
    /// The name of a material, or a material in place.
    Material,
    /// The name of a group.
    Group,
    /// Placement steps.
    Transform,
    /// Sixteen numbers.
    Matrix,
    /// A list of this many points at least and at most.
    Points(usize, usize),
    /// A list of pairs of numbers.
    Pairs,
    /// A list of lists of numbers.
    Rows,
    /// A list of linear colours with or without opacity.
    VertexColors,
    /// A list of triples of vertex numbers.
    Indices,
    /// A list of objects.
    Objects,
    /// A table of its own kind: the section's name.
    Section(&'static str),
}

/// What holds when a key is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// It must not be absent.
    Required,
    /// Nothing, which means this.
    Absent(&'static str),
    /// A truth value.
    Bool(bool),
    /// An integer.
    Integer(i128),
    /// A number; for pairs and colours, each component.
    Number(f64),
    /// Two integers or numbers.
    Pair([f64; 2]),
    /// A point or direction.
    Triple([f64; 3]),
    /// A word.
    Word(&'static str),
}

/// A key of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The type of its value.
    pub kind: Kind,
    /// The unit; empty for none.
    pub unit: &'static str,
    /// The value when absent.
    pub preset: Preset,
    /// What it is, one line.
    pub doc: &'static str,
}

/// A key.
pub const fn key(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    preset: Preset,
    doc: &'static str,
) -> Key {
    Key { name, kind, unit, preset, doc }
}

/// One of the kinds of a table that has several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// The value of the switch.
    pub name: &'static str,
    /// What it is, one line.
    pub doc: &'static str,
    /// The keys that this kind has besides the section's own.
    pub keys: &'static [&'static [Key]],
    /// An example in TOML; it may use the names of the other examples.
    pub example: &'static str,
}

impl Variant {
    /// Its keys.
    pub fn keys(&self) -> impl Iterator<Item = &'static Key> + use<> {
        self.keys.iter().flat_map(|keys| keys.iter())
    }
}

/// The key that chooses a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// Its name.
    pub key: &'static str,
    /// The kind when absent; `None` where one must be named.
    pub preset: Option<&'static str>,
    /// The kinds.
    pub variants: &'static [Variant],
}

/// How often a section may be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `[name]`, once.
    Table,
    /// `[name.NAME]`, once for each NAME.
    Named,
    /// `[[name]]`, any number of times.
    List,
    /// `{ … }`, in other sections.
    Inline,
}

/// A kind of table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Its name.
    pub name: &'static str,
    /// One of them, in words: "material".
    pub noun: &'static str,
    /// How it is written.
    pub form: Form,
    /// What it is.
    pub doc: &'static str,
    /// The key that chooses a kind, where there are several.
    pub switch: Option<Switch>,
    /// The keys of every kind.
    pub keys: &'static [Key],
    /// An example in TOML; empty where the kinds have theirs.
    pub example: &'static str,
}

impl Section {
    /// As it is written in a file: `[camera]`, `[[objects]]`.
    pub fn header(&self) -> String {
        match self.form {
            Form::Table => format!("[{}]", self.name),
            Form::Named => format!("[{}.NAME]", self.name),
            Form::List => format!("[[{}]]", self.name),
            Form::Inline => format!("{{ {} }}", self.name),
        }
    }

    /// A kind by name.
    pub fn variant(&self, name: &str) -> Option<&'static Variant> {
        self.variants().iter().find(|variant| variant.name == name)
    }

    /// The kinds; empty where there is one only.
    pub fn variants(&self) -> &'static [Variant] {
        self.switch.map_or(&[], |switch| switch.variants)
    }
}

/// Every section of a file, in the order of the reference.
pub const SECTIONS: &[&Section] = &[
    &RENDER,
    &FILM,
    &CAMERA,
    &PHOTON_MAP,
    &SPPM,
    &VCM,
    &TEXTURES,
    &MATERIALS,
    &OBJECTS,
    &LIGHTS,
    &GROUPS,
    &INSTANCES,
    &DISPLACEMENT,
    &TRANSFORM,
    &ROTATE,
    &LOOK_AT,
    &TEXTURE_REF,
];

/// The section of a name.
pub fn section(name: &str) -> Option<&'static Section> {
    SECTIONS.iter().copied().find(|section| section.name == name)
}

impl Kind {
    /// What a value must be, in words: "a number > 0".
    pub fn text(&self) -> String {
        let with = |what: &str, range: &Range| match range.text() {
            text if text.is_empty() => what.to_owned(),
            text => format!("{what} {text}"),
        };
        let words = |words: &[Word]| {
            words.iter().map(|word| format!("\"{}\"", word.name)).collect::<Vec<_>>().join(" | ")
        };
        match self {
            Self::Bool => "true or false".into(),
            Self::Integer(min, max) => match (*min, *max) {
                (min, max) if max == u32::MAX as i128 => format!("an integer ≥ {min} of 32 bits"),
                (min, max) if max == u64::MAX as i128 => format!("an integer ≥ {min} of 64 bits"),
                (min, max) if min <= i32::MIN as i128 && max >= i32::MAX as i128 => {
                    "an integer of 32 bits".into()
                }
                (min, max) => format!("an integer from {min} to {max}"),
            },
            Self::Number(range) => with("a number", range),
            Self::NumberOrWord(range, list) => format!("{} or {}", with("a number", range), words(list)),
            Self::Text => "a string".into(),
            Self::Word(list) => words(list),
            Self::Words(list) => format!("a list of {}", words(list)),
            Self::Window => "[x0, y0, x1, y1], whole numbers".into(),
            Self::Size(min, max) => format!("[width, height], each from {min} to {max}"),
            Self::Pair(range) => with("[u, v] or a number", range),
            Self::Point => "[x, y, z]".into(),
            Self::Direction => "a vector [x, y, z], not zero".into(),
            Self::Factors => "a number or [x, y, z], none 0".into(),
            Self::Color(range) => with("a colour ([r, g, b], grey or \"#rrggbb\")", range),
            Self::ColorOrTexture(range) => {
                with("a colour ([r, g, b], grey, \"#rrggbb\" or { texture = \"NAME\" })", range)
            }
            Self::NumberOrTexture(range) => with("a number or { texture = \"NAME\" }", range),
            Self::Ior(range) => format!("{} or a name", with("a number", range)),
            Self::File(extensions) => format!("a file name (.{})", extensions.join(", .")),
            Self::Texture => "the name of a texture".into(),
            Self::Material => "the name of a material, { kind = … } or { preset = \"NAME\" }".into(),
            Self::Group => "the name of a group".into(),
            Self::Transform => "a list of steps ({ translate = [x, y, z] }, …)".into(),
            Self::Matrix => "16 numbers".into(),
            Self::Points(min, max) if min == max => format!("{min} points [x, y, z]"),
            Self::Points(min, _) if *min > 0 => format!("a list of points [x, y, z], at least {min}"),
            Self::Points(..) => "a list of vectors [x, y, z]".into(),
            Self::Pairs => "a list of pairs of numbers".into(),
            Self::Rows => "a list of rows of numbers".into(),
            Self::VertexColors => "a list of [r, g, b] or [r, g, b, opacity]".into(),
            Self::Indices => "a list of [a, b, c]".into(),
            Self::Objects => "a list of objects".into(),
            Self::Section(name) => {
                let keys = section(name).map_or(&[][..], |section| section.keys);
                format!("{{ {} }}", keys.iter().map(|key| key.name).collect::<Vec<_>>().join(", "))
            }
        }
    }
}
