//! The reference of scene files, printed from the specification.

use std::fmt;

use crate::diagnostic::CODES;
use crate::nearest::nearest;
use crate::search::search;
use crate::spec::{Form, Key, Kind, Preset, SECTIONS, Section, Variant};

/// A topic that does not exist, and the nearest that does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownTopic {
    /// What was asked for.
    pub topic: String,
    /// What may have been meant.
    pub nearest: Option<String>,
}

impl fmt::Display for UnknownTopic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no topic is named `{}`", self.topic)?;
        match &self.nearest {
            Some(nearest) => write!(f, "; did you mean `{nearest}`?"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnknownTopic {}

/// Topics that are no section.
pub(crate) const PAGES: &[(&str, &str, &str)] = &[
    (
        "colors",
        "How colours are written.",
        "Colours are linear RGB (Rec. 709 primaries), written as\n\
         \x20 [0.7, 0.1, 0.1]            three numbers\n\
         \x20 0.7                        one number: grey\n\
         \x20 \"#d04040\"                  sRGB as in web pages, converted to linear\n\
         \x20 { texture = \"NAME\" }       a texture, where the key allows one\n\
         Colours of materials lie from 0 to 1; amounts of light are ≥ 0 and may exceed 1.\n",
    ),
    (
        "units",
        "Which units quantities have.",
        "Lengths are scene units; take metres where powers shall be physical. Angles are degrees.\n\
         A lamp has one amount of light, in watts or in what the eye sees of them:\n\
         \x20 radiance     W/(sr m^2)   of surfaces and environments\n\
         \x20 nits         cd/m^2       the same; 179 nits of white are 1 W/(sr m^2)\n\
         \x20 intensity    W/sr         of point and spot lights\n\
         \x20 candela      cd           the same; 179 cd of white are 1 W/sr\n\
         \x20 irradiance   W/m^2        of directional lights\n\
         \x20 lux          lm/m^2       the same; 179 lux of white are 1 W/m^2\n\
         \x20 power        W            the total flux of any lamp\n\
         \x20 lumens       lm           the same; 179 lm of white are 1 W\n\
         \x20 temperature  K            colours any of these like a black body, instead of color\n\
         179 lm are one watt of light of equal energy over the visible range. That is not what a lamp draws:\n\
         a label of 9 W and 806 lm means lumens = 806.\n\
         \x20 a candle           12 lm, 1 cd, 1900 K       a sheet of paper on a desk    500 lux\n\
         \x20 a 60-W bulb        800 lm, 2700 K            an overcast sky               10 000 lux\n\
         \x20 a downlight        500 to 3000 lm, 4000 K    the sun at noon               100 000 lux\n\
         \x20 a screen           100 to 500 nits, 6500 K   the sun's disc                1.6e9 nits\n\
         Each holds for each of the channels red, green, blue. The picture is radiance; film.exposure\n\
         and film.view turn it into display colours.\n",
    ),
    (
        "formats",
        "Scenes of other programs: what is read, and what to export.",
        "`nephroid FILE` renders these as they are; `nephroid convert FILE OUT.toml` makes a scene of them\n\
         to go on with:\n\
         \x20 .gltf .glb     glTF 2.0: from Blender (File > Export > glTF 2.0, with Cameras and Punctual\n\
         \x20                Lights), SketchUp, Cinema 4D, Maya, Houdini, most shops of models\n\
         \x20 .pbrt          pbrt, version 4, or 3 where its names differ\n\
         \x20 .xml           Mitsuba, version 3, or 0.6 where it differs\n\
         \x20 .obj .ply .stl meshes; also as objects of a scene (shape = \"mesh\")\n\
         .blend, .fbx, .usd, .dae, .abc and the like are not read: open them in Blender or in the program that\n\
         wrote them, and export glTF. Pictures (.hdr, .exr, .png, .jpg) are textures or surroundings, and\n\
         luminaires (.ies, .ldt) lamps of a scene. `--set` and `--camera` change scenes of all kinds.\n",
    ),
    (
        "include",
        "How a scene takes tables from other files.",
        "include = [\"materials.toml\", \"parts/lamps.toml\"], above all tables, adds the tables of other TOML files:\n\
         \x20 materials, textures, groups       by name; no name may be given twice\n\
         \x20 objects, lights, instances        behind those of the including file\n\
         \x20 render, film, camera, ...         key by key; no key may be given twice\n\
         File names start from the folder of the file that they stand in. Files may include others, 16 deep and\n\
         256 in all, 12 MiB together; one that is included on several ways counts once. `--set` works on the\n\
         whole, `nephroid convert` writes it as one file, and checkpoints hold it.\n",
    ),
    (
        "overrides",
        "How --set changes a scene from the command line.",
        "--set PATH.KEY=VALUE changes the scene before it is checked:\n\
         \x20 --set photon_map.photons=100000\n\
         \x20 --set materials.glass.ior=1.33\n\
         \x20 --set objects.ball.radius=2        by the object's name\n\
         \x20 --set objects.0.radius=2           by its number, from 0\n\
         \x20 --set render.integrator=path       plain words need no quotes\n\
         \x20 --set camera.position=[0,1,5]\n\
         It works on scenes of other programs, too: names and numbers are those that `nephroid convert` writes.\n\
         --camera 0,1,5:0,1,0:40 is short for camera.position, camera.look_at and camera.fov.\n",
    ),
];

/// What the page of presets is about.
const PRESETS: &str = "Materials by name: metals, glass, gems, liquids, paints and more.";

/// Every topic and what it is about, in the order of the reference.
pub fn topics() -> Vec<(&'static str, &'static str)> {
    let mut out: Vec<(&str, &str)> = Vec::new();
    for section in SECTIONS {
        out.push((section.name, section.doc));
        out.extend(section.variants().iter().map(|variant| (variant.name, variant.doc)));
    }
    out.extend(PAGES.iter().map(|(name, doc, _)| (*name, *doc)));
    out.push(("presets", PRESETS));
    out.push(("errors", "What the codes of errors mean."));
    out
}

/// The reference of a topic: a section ("camera"), a kind ("sphere", "materials.glass"), a key ("camera.fov"), or
/// one of the pages "colors", "units", "formats", "include", "overrides", "presets", "errors", or a preset ("gold"). An empty topic lists all. Where a word or several are none of these,
/// what speaks of them, the best first.
///
/// Plain text of at most about 100 columns that ends with a newline.
///
/// # Errors
/// The topic is unknown.
pub fn describe(topic: &str) -> Result<String, UnknownTopic> {
    if topic.is_empty() {
        return Ok(overview());
    }
    let name = topic.trim_matches(['[', ']']).trim_end_matches(".NAME");
    if name == "errors" {
        let width = column(CODES.iter().map(|(code, _)| *code));
        return Ok(CODES.iter().map(|(code, doc)| format!("{code:<width$}{doc}\n")).collect());
    }
    if ["presets", "preset", "materials.preset"].contains(&name) {
        return Ok(crate::preset::page());
    }
    if let Some((_, doc, text)) = PAGES.iter().find(|page| page.0 == name) {
        return Ok(format!("{doc}\n\n{text}"));
    }
    if let Some(section) = SECTIONS.iter().find(|section| section.name == name) {
        return Ok(section_text(section));
    }
    let (first, second) = name.split_once('.').unwrap_or(("", name));
    for section in SECTIONS.iter().filter(|section| first.is_empty() || section.name == first) {
        if let Some(variant) = section.variant(second) {
            return Ok(variant_text(section, variant));
        }
    }
    if let ("" | "presets", Some(preset)) = (first, crate::preset::find(second)) {
        let others = if first.is_empty() { search(topic) } else { None };
        // Two lines of introduction, and the preset itself.
        let others = others.filter(|text| text.lines().count() > 3);
        return Ok(others.into_iter().fold(preset.text(), |text, others| text + "\n" + &others));
    }
    let holders = |section: &&&Section| section.name == first || section.variant(first).is_some();
    if !first.is_empty()
        && let Some(section) = SECTIONS.iter().find(holders)
    {
        let mut found: Vec<(&Key, Vec<&str>)> =
            section.keys.iter().filter(|key| key.name == second).map(|key| (key, Vec::new())).collect();
        for variant in section.variants().iter().filter(|v| section.name == first || v.name == first) {
            for key in variant.keys().filter(|key| key.name == second) {
                match found.iter_mut().find(|(other, _)| *other == key) {
                    Some((_, kinds)) => kinds.push(variant.name),
                    None => found.push((key, vec![variant.name])),
                }
            }
        }
        let title = |kinds: &[&str]| match kinds {
            [] => section.header(),
            kinds => format!("{} {}", section.header(), kinds.join(", ")),
        };
        if !found.is_empty() {
            return Ok(found
                .iter()
                .map(|(key, kinds)| format!("{}\n{}", title(kinds), key_text(key)))
                .collect());
        }
    }
    if first.is_empty()
        && let Some(found) = search(topic)
    {
        return Ok(found);
    }
    let names: Vec<&str> = topics().into_iter().map(|(name, _)| name).collect();
    let nearest = nearest(second, names).map(str::to_owned);
    Err(UnknownTopic { topic: topic.to_owned(), nearest })
}

/// Width of a column of names, with a gap behind the longest.
fn column<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    names.map(|name| name.chars().count()).max().unwrap_or(0) + 2
}

fn overview() -> String {
    let mut out =
        String::from("A scene is a TOML file of these tables. `describe TOPIC` tells more of each.\n\n");
    for section in SECTIONS {
        if section.form == Form::Inline {
            continue;
        }
        out += &format!("{:<20}{}\n", section.header(), section.doc);
        let width = column(section.variants().iter().map(|v| v.name)).max(16);
        for variant in section.variants() {
            out += &format!("    {:<width$}{}\n", variant.name, variant.doc);
        }
    }
    out += "\nAnd:\n";
    for section in SECTIONS.iter().filter(|section| section.form == Form::Inline) {
        out += &format!("{:<20}{}\n", section.name, section.doc);
    }
    for (name, doc, _) in PAGES {
        out += &format!("{name:<20}{doc}\n");
    }
    out += &format!("{:<20}{}\n", "presets", PRESETS);
    out += &format!("{:<20}{}\n", "errors", "What the codes of errors mean.");
    out
}

fn section_text(section: &Section) -> String {
    let mut out = format!("{}\n{}\n", section.header(), wrapped(section.doc, 0));
    if let Some(switch) = section.switch {
        let default = match switch.preset {
            Some(preset) => format!("default \"{preset}\""),
            None => "required".to_owned(),
        };
        out += &format!("\n{}  one of these words, {default}\n", switch.key);
        let width = column(switch.variants.iter().map(|v| v.name)).max(16);
        for variant in switch.variants {
            out += &format!("    {:<width$}{}\n", variant.name, wrapped(variant.doc, width + 4));
        }
    }
    if !section.keys.is_empty() {
        out += if section.switch.is_some() { "\nKeys of every kind:\n" } else { "\n" };
        out += &keys_text(section.keys.iter());
    }
    for variant in section.variants() {
        if variant.keys().next().is_some() {
            out += &format!("\nKeys of {}:\n{}", variant.name, keys_text(variant.keys()));
        }
    }
    let examples: Vec<&str> = std::iter::once(section.example)
        .chain(section.variants().iter().map(|variant| variant.example))
        .filter(|example| !example.is_empty())
        .collect();
    if let Some(example) = examples.first() {
        out += &format!("\nExample:\n{}", indented(example));
    }
    out
}

fn variant_text(section: &Section, variant: &Variant) -> String {
    let switch = section.switch.map_or("kind", |switch| switch.key);
    let mut out =
        format!("{}  {switch} = \"{}\"\n{}\n", section.header(), variant.name, wrapped(variant.doc, 0));
    if variant.keys().next().is_some() {
        out += &format!("\n{}", keys_text(variant.keys()));
    }
    if !section.keys.is_empty() {
        out += &format!("\nKeys of every {}:\n{}", section.noun, keys_text(section.keys.iter()));
    }
    out + &format!("\nExample:\n{}", indented(variant.example))
}

fn keys_text<'a>(keys: impl Iterator<Item = &'a Key>) -> String {
    keys.map(key_text).collect()
}

fn key_text(key: &Key) -> String {
    let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
    let default = match default_text(&key.preset) {
        Some(default) => format!("; {default}"),
        None => String::new(),
    };
    let head = wrapped(&format!("{}{unit}{default}", key.kind.text()), 20);
    let mut out = format!("    {:<15} {head}\n{:20}{}\n", key.name, "", wrapped(key.doc, 20));
    if let Kind::Word(words) | Kind::Words(words) = key.kind {
        for word in words {
            out += &format!("{:22}{:<17} {}\n", "", word.name, wrapped(word.doc, 40));
        }
    }
    out
}

/// "default 1", "required", …
fn default_text(preset: &Preset) -> Option<String> {
    Some(match preset {
        Preset::Required => "required".to_owned(),
        Preset::Absent("") => return None,
        Preset::Absent(meaning) => format!("if absent: {meaning}"),
        Preset::Bool(value) => format!("default {value}"),
        Preset::Integer(value) => format!("default {value}"),
        Preset::Number(value) => format!("default {value}"),
        Preset::Pair([a, b]) => format!("default [{a}, {b}]"),
        Preset::Triple([a, b, c]) => format!("default [{a}, {b}, {c}]"),
        Preset::Word(word) => format!("default \"{word}\""),
    })
}

/// Lines of at most about 100 columns; all but the first are indented.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    let mut column = indent;
    for word in text.split(' ') {
        let width = word.chars().count();
        if column > indent && column + 1 + width > 100 {
            out.push('\n');
            out.extend(std::iter::repeat_n(' ', indent));
            column = indent;
        } else if column > indent {
            out.push(' ');
            column += 1;
        }
        out += word;
        column += width;
    }
    out
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}
