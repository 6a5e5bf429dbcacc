//! Looking for words in the reference of scene files.

use crate::describe::PAGES;
use crate::preset::presets;
use crate::spec::{Key, Kind, SECTIONS, Section, Variant};

/// Finds, at most.
const MOST: usize = 12;

/// Words that say nothing.
const SMALL: &[&str] =
    &["of", "the", "in", "is", "on", "to", "my", "an", "and", "or", "how", "with", "for", "do"];

/// What people call things, and the words of the reference that stand for it.
const CALLED: &[(&[&str], &[&str])] = &[
    (&["clearcoat", "varnish", "lacquer", "carpaint"], &["coat", "coated"]),
    (&["hdri", "hdr", "envmap", "ibl", "skybox", "dome", "background", "surroundings"], &["environment"]),
    (&["ies", "eulumdat", "ldt", "luminaire", "photometric"], &["photometric", "profile"]),
    (&["sun", "daylight", "sunlight", "sky"], &["sun-sky", "sky"]),
    (&["lux"], &["lux"]),
    (&["lumen", "lm"], &["lumens"]),
    (&["nit", "luminance", "cd"], &["nits", "candela"]),
    (&["kelvin", "blackbody"], &["temperature"]),
    (&["watt", "watts"], &["power"]),
    (&["caustics"], &["caustic"]),
    (&["photons"], &["photons", "photon"]),
    (&["ocean", "sea", "pool", "lake"], &["water"]),
    (&["velvet", "cloth", "fabric", "fuzz"], &["sheen"]),
    (&["chrome", "steel", "iron", "metallic"], &["conductor", "metal"]),
    (&["plaster", "clay", "chalk", "lambertian", "matte", "matt"], &["matt", "matte"]),
    (&["paper", "leaf", "lampshade", "curtain", "translucent"], &["diffuse-transmission"]),
    (&["window", "pane"], &["thin-dielectric", "window"]),
    (&["transparent", "transparency", "refraction", "liquid"], &["dielectric", "ior"]),
    (&["tint", "beer", "lambert", "absorb"], &["attenuation_color", "absorption"]),
    (
        &["dof", "depthfield", "bokeh", "focus", "aperture", "fstop"],
        &["thin-lens", "focus_distance", "lens_radius"],
    ),
    (&["panorama", "360", "vr"], &["spherical"]),
    (&["isometric", "parallel"], &["orthographic"]),
    (&["iridescence", "iridescent", "interference", "soap"], &["film_thickness"]),
    (&["hole", "cutout", "mask", "alphamask"], &["opacity", "opacity_cutoff"]),
    (&["relief", "displacement", "normals", "bump"], &["bump_map", "normal_map"]),
    (&["copy", "copies", "array", "instance", "duplicate"], &["instances"]),
    (&["move", "scale", "translate", "pivot"], &["transform"]),
    (&["firefly", "fireflies", "noisy", "denoise", "denoiser", "clean"], &["noise", "denoise"]),
    (&["spp", "samples", "quality"], &["passes"]),
    (&["resolution", "width", "height", "pixels"], &["size"]),
    (&["bounces", "depth"], &["max_depth"]),
    (&["brightness", "dark", "bright", "black", "ev", "iso"], &["exposure"]),
    (&["gamma", "tonemap", "tonemapping", "tone", "aces", "filmic"], &["view"]),
    (&["bulb", "led", "lamp", "emitter", "emissive", "emission"], &["power", "radiance", "lights"]),
    (&["arealight", "softbox"], &["quad", "radiance"]),
    (&["slide", "gobo"], &["projector"]),
    (&["wood", "stone"], &["fbm", "marble"]),
    (&["gem", "jewel", "jewelry", "jewellery", "brilliant"], &["diamond", "ring"]),
    (&["model", "obj", "ply"], &["mesh", "formats"]),
    (
        &["blender", "blend", "fbx", "usd", "gltf", "glb", "pbrt", "mitsuba", "collada", "import", "export"],
        &["formats"],
    ),
    (&["bdpt", "bidirectional", "mlt", "metropolis"], &["vcm"]),
];

/// What is not there, said before what comes near it.
const ABSENT: &[(&[&str], &str)] = &[
    (
        &["fog", "smoke", "haze", "volume", "volumetric", "media", "godrays"],
        "Fog and smoke are not rendered; glass and liquids absorb: dielectric.absorption.",
    ),
    (&["sss", "subsurface", "skin", "wax", "milk"], "Light that scatters beneath a surface is not rendered."),
    (&["dispersion", "rainbow", "prism", "fire"], "Dispersion is not rendered: light is linear RGB."),
    (
        &["animation", "motion", "motionblur", "blur", "keyframe", "shutter"],
        "Nothing moves in a picture: there is no motion blur.",
    ),
    (&["gpu", "cuda"], "All is computed on the processor's cores."),
];

/// A place of the reference.
struct Entry {
    /// As `describe` takes it.
    topic: String,
    /// Its own name.
    name: &'static str,
    /// Kinds that have it, of keys of some kinds alone.
    kinds: Vec<&'static str>,
    doc: &'static str,
    /// Values it may have, with what they mean.
    values: Vec<(&'static str, &'static str)>,
    /// More text to look through.
    text: &'static str,
}

/// What the reference says of some words; `None` where it has none of them. Every word must be found in an entry, by itself or by
/// what it is called here.
pub(crate) fn search(query: &str) -> Option<String> {
    let words = words(query);
    if words.is_empty() {
        return None;
    }
    let mut found: Vec<(u32, Entry, Option<usize>)> = entries()
        .into_iter()
        .filter_map(|entry| {
            let scores: Option<Vec<Match>> = words.iter().map(|word| best(word, &entry)).collect();
            let scores = scores?;
            let value = scores.iter().find_map(|m| m.value);
            Some((scores.iter().map(|m| m.score).sum(), entry, value))
        })
        .collect();
    // Stable: of equals in the order of the reference.
    found.sort_by_key(|(score, ..)| std::cmp::Reverse(*score));
    let absent = ABSENT.iter().find(|(names, _)| words.iter().any(|w| names.contains(&w.as_str())));
    if found.is_empty() && absent.is_none() {
        return None;
    }
    let mut out = absent.map_or(String::new(), |(_, remark)| format!("{remark}\n\n"));
    let more = found.len().saturating_sub(MOST);
    found.truncate(MOST);
    if !found.is_empty() {
        out += &format!("`describe TOPIC` tells more of each. Of \"{query}\" speak:\n\n");
    }
    let width = found.iter().map(|(_, entry, _)| entry.topic.len()).max().unwrap_or(0) + 2;
    for (_, entry, value) in &found {
        out += &format!("{:<width$}{}\n", entry.topic, crate::describe::wrapped(&line(entry, *value), width));
    }
    if more > 0 {
        out += &format!("\nand {more} more\n");
    }
    Some(out)
}

/// The words of a query, in lower case; one where several together are called something here.
fn words(query: &str) -> Vec<String> {
    let query = query.to_lowercase();
    let all = query.split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_'));
    let words: Vec<String> =
        all.filter(|word| word.len() > 1 && !SMALL.contains(word)).map(str::to_owned).collect();
    let joined = words.concat();
    let known = |names: &&[&str]| names.contains(&joined.as_str());
    let names = CALLED.iter().map(|(names, _)| *names).chain(ABSENT.iter().map(|(names, _)| *names));
    if names.into_iter().any(|names| known(&names)) { vec![joined] } else { words }
}

/// What is said of an entry that was found, with the value that was.
fn line(entry: &Entry, value: Option<usize>) -> String {
    let kinds = match entry.kinds.as_slice() {
        [] => String::new(),
        kinds if kinds.len() > 4 => format!("{}, …: ", kinds[..3].join(", ")),
        kinds => format!("{}: ", kinds.join(", ")),
    };
    let value = match value.and_then(|i| entry.values.get(i)) {
        Some((name, "")) => format!(" Here \"{name}\"."),
        Some((name, doc)) => format!(" \"{name}\": {doc}"),
        None => String::new(),
    };
    format!("{kinds}{}{value}", entry.doc)
}

/// How well a word fits an entry.
#[derive(Clone, Copy)]
struct Match {
    score: u32,
    /// The value that it is of.
    value: Option<usize>,
}

/// The best of a word and of what it is called here.
fn best(word: &str, entry: &Entry) -> Option<Match> {
    let own = matched(word, entry);
    let called = CALLED.iter().filter(|(names, _)| names.contains(&word)).flat_map(|(_, ours)| *ours);
    // One that is called so stands behind one that is named so.
    let called =
        called.filter_map(|ours| matched(ours, entry)).map(|m| Match { score: m.score * 9 / 10, ..m });
    own.into_iter().chain(called).max_by_key(|m| m.score)
}

fn matched(word: &str, entry: &Entry) -> Option<Match> {
    let plain = |score| Match { score, value: None };
    let value = entry.values.iter().position(|(name, _)| *name == word);
    let in_value = || entry.values.iter().position(|(name, doc)| has(name, word) || has(doc, word));
    let parts = || entry.name.split(['-', '_']).any(|part| part == word);
    match () {
        () if entry.name == word => Some(plain(100)),
        () if value.is_some() => Some(Match { score: 80, value }),
        () if parts() => Some(plain(60)),
        () if word.len() > 2 && entry.name.contains(word) => Some(plain(40)),
        () if has(entry.doc, word) => Some(plain(20)),
        () => in_value()
            .map(|i| Match { score: 15, value: Some(i) })
            .or_else(|| has(entry.text, word).then(|| plain(10))),
    }
}

/// Whether a text has the word, also in the plural.
fn has(text: &str, word: &str) -> bool {
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_'));
    words.any(|w| {
        let w = w.to_lowercase();
        w == word || w.strip_suffix('s') == Some(word)
    })
}

fn entries() -> Vec<Entry> {
    let mut all = Vec::new();
    for (name, doc, text) in PAGES {
        all.push(Entry { topic: (*name).into(), name, kinds: Vec::new(), doc, values: Vec::new(), text });
    }
    for preset in presets() {
        all.push(Entry {
            topic: format!("presets.{}", preset.name),
            name: preset.name,
            kinds: Vec::new(),
            doc: preset.doc,
            values: Vec::new(),
            text: preset.source,
        });
    }
    for section in SECTIONS {
        let topic = section.name.to_owned();
        all.push(Entry {
            topic,
            name: section.name,
            kinds: Vec::new(),
            doc: section.doc,
            values: Vec::new(),
            text: "",
        });
        let first = all.len();
        for key in section.keys {
            all.push(of_key(section, None, key));
        }
        for variant in section.variants() {
            all.push(of_variant(section, variant));
            for key in variant.keys() {
                let entry = of_key(section, Some(variant), key);
                let same = |other: &&mut Entry| {
                    other.topic == entry.topic && other.doc == entry.doc && !other.kinds.is_empty()
                };
                match all[first..].iter_mut().find(same) {
                    Some(other) => other.kinds.push(variant.name),
                    None => all.push(entry),
                }
            }
        }
    }
    all
}

fn of_variant(section: &'static Section, variant: &'static Variant) -> Entry {
    // Kinds of one name are told apart by their section.
    let twice = SECTIONS.iter().filter(|s| s.variant(variant.name).is_some()).count() > 1;
    let is_section = SECTIONS.iter().any(|s| s.name == variant.name);
    let topic = match twice || is_section {
        true => format!("{}.{}", section.name, variant.name),
        false => variant.name.to_owned(),
    };
    Entry { topic, name: variant.name, kinds: Vec::new(), doc: variant.doc, values: Vec::new(), text: "" }
}

fn of_key(section: &'static Section, variant: Option<&'static Variant>, key: &'static Key) -> Entry {
    let values = match key.kind {
        Kind::Word(words) | Kind::Words(words) => words.iter().map(|word| (word.name, word.doc)).collect(),
        Kind::Ior(_) => color::ior_names().map(|name| (name, "")).collect(),
        Kind::Text if key.name == "metal" => color::metal_names().map(|name| (name, "")).collect(),
        _ => Vec::new(),
    };
    Entry {
        topic: format!("{}.{}", section.name, key.name),
        name: key.name,
        kinds: variant.map(|variant| variant.name).into_iter().collect(),
        doc: key.doc,
        values,
        text: key.unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Topics that are found, the best first.
    fn topics(query: &str) -> Vec<String> {
        let text = search(query).unwrap_or_default();
        let table = text.split("speak:\n\n").nth(1).unwrap_or_default().to_owned();
        let topic = |line: &str| line.split("  ").next().map(str::to_owned);
        table.lines().filter(|line| !line.starts_with(' ')).filter_map(topic).collect()
    }

    #[test]
    fn what_beginners_look_for_is_found_among_the_first_three() {
        for (query, topic) in [
            ("clearcoat", "coated-diffuse"),
            ("gold", "materials.metal"),
            ("diamond", "materials.ior"),
            ("lux", "lights.lux"),
            ("ies", "profile"),
            ("HDRI", "environment"),
            ("water", "materials.ior"),
            ("caustic", "photon_map.caustic_photons"),
            ("exposure", "film.exposure"),
            ("blender", "formats"),
            ("spp", "render.passes"),
            ("depth of field", "thin-lens"),
            ("soap", "materials.film_thickness"),
            ("kelvin", "lights.temperature"),
            ("agx", "film.view"),
        ] {
            let found = topics(query);
            assert!(found.iter().take(3).any(|t| t == topic), "{query}: {found:?}");
        }
    }

    #[test]
    fn every_topic_that_is_found_is_one() {
        for entry in entries() {
            assert!(crate::describe(&entry.topic).is_ok(), "{}", entry.topic);
        }
    }

    #[test]
    fn what_is_not_there_is_said() {
        assert!(search("fog").unwrap().starts_with("Fog and smoke are not rendered"));
        assert!(search("shpere").is_none() && search("").is_none() && search("zzz").is_none());
    }

    #[test]
    fn words_that_stand_for_others_lead_somewhere() {
        for (names, ours) in CALLED {
            assert!(!topics(names[0]).is_empty(), "{names:?}");
            assert!(ours.iter().any(|word| entries().iter().any(|e| matched(word, e).is_some())), "{ours:?}");
        }
    }
}
