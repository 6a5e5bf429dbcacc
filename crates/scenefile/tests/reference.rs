//! The specification is the truth: every key of it can be written, counts, is described, and holds its range.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;

use nephroid_scenefile as scenefile;
use scenefile::spec::{Form, Key, Kind, Preset, Range, SECTIONS, Section, Variant};
use scenefile::{Loaded, SceneDesc, describe, parse, topics};

/// A folder with the files that examples name.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in ["wood.png", "other.png", "bunny.ply", "other.ply", "lamp.ies", "other.ies"] {
        std::fs::write(folder.path().join(file), "").unwrap();
    }
    folder
}

const BASE: &str = "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n";
const NAMED: &str = "\n[materials.paint]\nkind = \"diffuse\"\n[textures.chess]\nkind = \"checker\"\na = 0\nb = 1\n\
                     [[groups.pile.objects]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"paint\"\n[groups.heap]\nobjects = []\n";

fn load(folder: &Path, text: &str) -> Loaded {
    parse(text, &folder.join("scene.toml"), &[])
}

fn description(folder: &Path, text: &str) -> SceneDesc {
    let loaded = load(folder, text);
    assert!(loaded.desc.is_some(), "{text}\n{}", loaded.render());
    loaded.desc.unwrap()
}

/// A value that no key has as default, and one that a required key has in the base text.
fn sample(key: &Key, second: bool) -> String {
    let inside = |range: &Range| {
        let low = if range.min.is_finite() { range.min } else { -7.0 };
        let high = if range.max.is_finite() { range.max } else { low + 5.0 };
        let share = if second { 0.25 } else { 0.3125 };
        format!("{}", low + (high - low).min(10.0) * share)
    };
    let points = |n: usize| {
        let all = ["[0, 0, 0]", "[1, 0, 0]", "[1, 1, 0]", "[0, 1, 0]"];
        let z = if second { "[0, 1, 0.5]" } else { "[0, 1, 0]" };
        let mut list = all[..n - 1].to_vec();
        list.push(z);
        format!("[{}]", list.join(", "))
    };
    match key.kind {
        Kind::Bool => (key.preset != Preset::Bool(true)).to_string(),
        Kind::Integer(min, max) => ((min.max(-40) + 5 + i128::from(second)).min(max)).to_string(),
        // Less than half a side of the box.
        Kind::Number(range) if key.name == "radius" => inside(&Range { max: 0.625, ..range }),
        Kind::Number(range) if key.name == "falloff_angle" => inside(&Range { max: 20.0, ..range }),
        Kind::Number(range) | Kind::NumberOrTexture(range) => inside(&range),
        Kind::NumberOrWord(range, _) => inside(&range),
        Kind::Text if key.name == "name" => "\"somebody\"".into(),
        Kind::Text if second => "\"silver\"".into(),
        Kind::Text => "\"copper\"".into(),
        Kind::Word(words) => {
            let default = if let Preset::Word(word) = key.preset { word } else { "" };
            format!("\"{}\"", words.iter().find(|word| word.name != default).unwrap().name)
        }
        Kind::Words(words) => format!("[\"{}\"]", words[1].name),
        Kind::Window if second => "[0, 0, 2, 3]".into(),
        Kind::Window => "[1, 0, 2, 3]".into(),
        Kind::Size(..) => "[31, 47]".into(),
        Kind::Pair(_) => "[0.5, 0.75]".into(),
        Kind::Point if key.name == "min" && second => "[0.125, 0.125, -2]".into(),
        Kind::Point if second => "[2.5, 3.5, 1.5]".into(),
        Kind::Point if ["look_at", "max"].contains(&key.name) => "[1, 2, 3]".into(),
        Kind::Point => "[0.5, 0.25, 0.125]".into(),
        Kind::Direction if second => "[0.5, -0.25, 0.25]".into(),
        Kind::Direction if key.name == "edge_v" => "[0, 0.5, 0.75]".into(),
        Kind::Direction => "[0.5, 0.25, 0.125]".into(),
        Kind::Factors => "[2, 1, 3]".into(),
        Kind::Color(_) | Kind::ColorOrTexture(_) if second => "\"#123456\"".into(),
        Kind::Color(_) | Kind::ColorOrTexture(_) => "[0.25, 0.125, 0.375]".into(),
        Kind::Ior(_) => "\"water\"".into(),
        Kind::File(extensions) => {
            let stem =
                ["ply", "ies", "cube"].into_iter().find(|stem| extensions.contains(stem)).unwrap_or("png");
            match (stem, second) {
                ("ply", false) => "\"bunny.ply\"".into(),
                ("ply", true) => "\"other.ply\"".into(),
                ("ies", false) => "\"lamp.ies\"".into(),
                ("ies", true) => "\"other.ies\"".into(),
                ("cube", false) => "\"look.cube\"".into(),
                ("cube", true) => "\"other.cube\"".into(),
                (_, false) => "\"wood.png\"".into(),
                (_, true) => "\"other.png\"".into(),
            }
        }
        Kind::Texture => "\"chess\"".into(),
        Kind::Material if second => "{ kind = \"mirror\" }".into(),
        Kind::Material => "\"paint\"".into(),
        Kind::Group if second => "\"heap\"".into(),
        Kind::Group => "\"pile\"".into(),
        Kind::Transform => "[{ translate = [1, 2, 3] }]".into(),
        Kind::Matrix => "[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]".into(),
        Kind::Points(min, _) => points(min.clamp(3, 4)),
        Kind::Rows if second => "[[1, 0], [2, 1], [3, 3]]".into(),
        Kind::Rows => "[[1, 0], [2, 1]]".into(),
        Kind::Pairs if second => "[[1, 0], [2, 1], [3, 3]]".into(),
        Kind::Pairs => "[[1, 0], [2, 1], [2, 3]]".into(),
        Kind::VertexColors => "[[0.5, 0.25, 0], [1, 1, 1, 0.5], [0, 0, 0]]".into(),
        Kind::Indices if second => "[[0, 2, 1]]".into(),
        Kind::Indices => "[[0, 1, 2]]".into(),
        Kind::Objects if second => "[{ shape = \"sphere\", material = \"paint\" }]".into(),
        Kind::Objects => "[]".into(),
        Kind::Section("rotate") => "{ axis = [1, 0, 0], degrees = 45 }".into(),
        Kind::Section("displacement") => "{ texture = \"chess\", scale = 0.5 }".into(),
        Kind::Section(_) => "{ position = [1, 2, 3], target = [2, 5, 1] }".into(),
    }
}

/// What a key needs beside itself to be allowed.
fn companions(section: &Section, kind: &str, key: &str) -> (&'static [&'static str], &'static str) {
    match (section.name, kind, key) {
        ("objects", "quad", "corners") => (&["origin", "edge_u", "edge_v"], ""),
        ("objects", "height-field", "file") => (&["heights"], ""),
        ("objects", _, "radiance" | "power" | "lumens" | "nits") => (&["material"], ""),
        ("objects", _, "color" | "temperature") => (&[], "power = 3\n"),
        ("objects", _, "emission_texture" | "two_sided_emission" | "light_group") => (&[], "radiance = 3\n"),
        ("objects", "band", "inner_radius") => (&[], "outer_radius = 9\n"),
        ("objects", "mesh" | "triangles", "crease_angle") => (&[], "normals = \"smooth\"\n"),
        ("lights", "point" | "spot" | "goniometric" | "projector", "power" | "lumens" | "candela") => {
            (&["intensity"], "")
        }
        ("lights", "point" | "spot", "color" | "temperature") => (&["intensity"], "power = 3\n"),
        ("lights", "goniometric" | "projector", "color" | "temperature") => (&["intensity"], "candela = 3\n"),
        ("lights", "directional", "lux") => (&["irradiance"], ""),
        ("lights", "directional", "color" | "temperature") => (&["irradiance"], "lux = 3\n"),
        ("lights", "environment", "nits" | "lux") => (&["radiance"], ""),
        ("lights", "environment", "color" | "temperature") => (&["radiance"], "nits = 3\n"),
        ("lights", "spot", "target") => (&["direction"], ""),
        ("materials", "conductor" | "coated-conductor", "metal") => (&["n", "k"], ""),
        ("lights", "environment", "radiance") => (&["file"], ""),
        ("lights", "environment", "mapping" | "scale" | "rotation" | "transform") => {
            (&["radiance"], "file = \"wood.png\"\n")
        }
        ("lights", "environment", "file") => (&["radiance"], ""),
        ("materials", _, "attenuation_color") => (&[], "attenuation_distance = 2\n"),
        ("materials", _, "attenuation_distance") => (&[], "attenuation_color = 0.5\n"),
        ("textures", "image", "wrap_v") => (&[], "wrap = \"clamp\"\n"),
        ("textures", _, "planar_u") => (&[], "planar_v = [0, 1, 0]\n"),
        ("textures", _, "planar_v") => (&[], "planar_u = [1, 0, 0]\n"),
        ("materials", _, "alpha_across") => (&[], "alpha = 0.75\n"),
        _ => (&[], ""),
    }
}

/// A whole scene with one table of a kind: its required keys, those that make it complete, and more.
fn scene(section: &Section, variant: Option<&Variant>, more: &str, without: &[&str]) -> String {
    let kind = variant.map_or("", |variant| variant.name);
    let keys: Vec<&Key> = section.keys.iter().chain(variant.into_iter().flat_map(Variant::keys)).collect();
    let essential = [
        "edge_u",
        "edge_v",
        "origin",
        "material",
        "intensity",
        "irradiance",
        "direction",
        "n",
        "k",
        "heights",
    ];
    let mut lines = String::new();
    for key in keys {
        let needed = key.preset == Preset::Required
            || (section.name == "lights" && key.name == "radiance")
            || (essential.contains(&key.name) && !(section.name == "instances" && key.name == "material"));
        let given = more.lines().any(|line| line.starts_with(&format!("{} =", key.name)));
        if needed && !given && !without.contains(&key.name) {
            lines += &format!("{} = {}\n", key.name, sample(key, false));
        }
    }
    let switch = section.switch.map(|switch| format!("{} = \"{kind}\"\n", switch.key)).unwrap_or_default();
    let header = match section.form {
        Form::Table => format!("[{}]", section.name),
        Form::Named => format!("[{}.mine]", section.name),
        Form::List => format!("[[{}]]", section.name),
        Form::Inline => unreachable!(),
    };
    let base = if section.name == "camera" { "" } else { BASE };
    format!("{base}{NAMED}{header}\n{switch}{lines}{more}")
}

fn each_kind(section: &'static Section) -> Vec<Option<&'static Variant>> {
    if section.variants().is_empty() { vec![None] } else { section.variants().iter().map(Some).collect() }
}

#[test]
fn every_key_can_be_written_and_counts() {
    let folder = folder();
    let mut keys = 0;
    for section in SECTIONS.iter().filter(|section| section.form != Form::Inline) {
        for variant in each_kind(section) {
            let all = section.keys.iter().chain(variant.into_iter().flat_map(Variant::keys));
            let kind = variant.map_or("", |variant| variant.name);
            for key in all {
                let (without, with) = companions(section, kind, key.name);
                let plain = scene(section, variant, with, without);
                // The companions may make a scene complete that is not so without the key.
                let before = load(folder.path(), &plain).desc;
                let line = format!("{with}{} = {}\n", key.name, sample(key, true));
                let text = scene(section, variant, &line, without);
                let after = description(folder.path(), &text);
                assert!(before != Some(after), "{}.{kind}.{} has no effect", section.name, key.name);
                keys += 1;
            }
        }
    }
    assert!(keys > 150, "{keys}");
}

#[test]
fn every_step_of_a_placement_counts() {
    let folder = folder();
    let plain = "[[objects]]\nshape = \"sphere\"\nmaterial = \"paint\"\n";
    let before = description(folder.path(), &format!("{BASE}{NAMED}{plain}"));
    for name in ["transform", "rotate", "look_at"] {
        let section = scenefile::spec::section(name).unwrap();
        for key in section.keys {
            let step = match name {
                "transform" => format!("{} = {}", key.name, sample(key, false)),
                "rotate" if key.name == "axis" => {
                    format!("rotate = {{ axis = {}, degrees = 3 }}", sample(key, false))
                }
                "look_at" if key.name != "target" => {
                    format!("look_at = {{ target = [0, 1, 3], {} = {} }}", key.name, sample(key, false))
                }
                _ => format!("{name} = {{ {} = {} }}", key.name, sample(key, false)),
            };
            let after =
                description(folder.path(), &format!("{BASE}{NAMED}{plain}transform = [{{ {step} }}]\n"));
            assert_ne!(before, after, "{step}");
            assert_eq!(after.objects[0].transform.len(), 1);
        }
    }
}

#[test]
fn defaults_are_those_of_the_types() {
    let folder = folder();
    let desc = description(folder.path(), &format!("{BASE}[render]\n[film]\n[photon_map]\n"));
    let plain = SceneDesc::default();
    assert_eq!((desc.render, desc.film, desc.photon_map), (plain.render, plain.film, plain.photon_map));
    let camera = desc.camera.unwrap().value;
    let default = scenefile::desc::Camera::default();
    assert_eq!(
        (camera.kind, camera.up, camera.fov, camera.fov_axis),
        (default.kind, default.up, default.fov, default.fov_axis)
    );
}

#[test]
fn ranges_hold_at_their_ends() {
    let folder = folder();
    let mut ends = 0;
    for section in SECTIONS.iter().filter(|section| section.form != Form::Inline) {
        for variant in each_kind(section) {
            let kind = variant.map_or("", |variant| variant.name);
            for key in section.keys.iter().chain(variant.into_iter().flat_map(Variant::keys)) {
                let (without, with) = companions(section, kind, key.name);
                // Values and whether they are allowed.
                let mut values: Vec<(String, bool)> = vec![];
                match key.kind {
                    Kind::Integer(min, max) => {
                        values = vec![
                            (min.to_string(), true),
                            ((min - 1).to_string(), false),
                            (max.to_string(), true),
                            ((max + 1).to_string(), false),
                            ("1.5".into(), false),
                        ];
                    }
                    Kind::Number(range)
                    | Kind::NumberOrTexture(range)
                    | Kind::Ior(range)
                    | Kind::Color(range)
                    | Kind::ColorOrTexture(range) => {
                        for (end, open, step) in
                            [(range.min, range.open_min, -1.0), (range.max, range.open_max, 1.0)]
                        {
                            if end.is_finite() {
                                values.push((format!("{end}"), !open));
                                values.push((format!("{}", end + step * 1e-3), false));
                            }
                        }
                        values.extend(["nan", "inf", "-inf", "1e39"].map(|x| (x.to_owned(), false)));
                        if range.min == 0.0 {
                            values.push(("1e-60".into(), !range.open_min));
                        }
                    }
                    _ => {}
                }
                for (value, allowed) in values {
                    // Other rules than the range bind these.
                    let bound = (allowed && key.name == "falloff_angle")
                        || (allowed && key.name == "color" && ["lights", "objects"].contains(&section.name))
                        || (allowed && kind == "phong" && key.name != "exponent")
                        || (allowed && kind == "diffuse-transmission");
                    if bound {
                        continue;
                    }
                    let text = scene(section, variant, &format!("{with}{} = {value}\n", key.name), without);
                    let loaded = load(folder.path(), &text);
                    let codes: Vec<_> =
                        loaded.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
                    let place =
                        format!("{}.{kind}.{} = {value}\n{}", section.name, key.name, loaded.render());
                    if allowed {
                        assert!(codes.is_empty(), "{place}");
                    } else {
                        let wrong = if value == "1.5" { "wrong-type" } else { "out-of-range" };
                        assert_eq!(codes, [wrong], "{place}");
                    }
                    ends += 1;
                }
            }
        }
    }
    assert!(ends > 300, "{ends}");
}

#[test]
fn every_example_is_a_scene() {
    let folder = folder();
    let all: Vec<&str> = SECTIONS
        .iter()
        .flat_map(|section| {
            std::iter::once(section.example).chain(section.variants().iter().map(|v| v.example))
        })
        .collect();
    let names = |header: &str| {
        let tables = all.iter().filter(|example| example.starts_with(header));
        let mut seen = std::collections::BTreeSet::new();
        let first = |example: &&&str| seen.insert(example.lines().next().unwrap().to_owned());
        tables.filter(first).map(|example| example.to_string()).collect::<String>()
    };
    let context = [names("[materials."), names("[textures."), names("[groups.")];
    for example in &all {
        if example.is_empty() {
            continue;
        }
        let header = example.lines().next().unwrap();
        let context: String = context.concat();
        let base = if example.contains("[camera]") { "" } else { BASE };
        let text = if context.contains(header) {
            format!("{base}{context}")
        } else {
            format!("{base}{context}{example}")
        };
        assert!(text.contains(*example), "{example}");
        description(folder.path(), &text);
    }
}

#[test]
fn describe_covers_every_key() {
    for (topic, doc) in topics() {
        let text = describe(topic).unwrap();
        assert!(text.ends_with('\n') && !text.is_empty());
        assert!(!doc.is_empty());
        let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(longest <= 110, "{topic}: a line of {longest}");
    }
    for section in SECTIONS {
        let whole = describe(section.name).unwrap();
        for variant in each_kind(section) {
            let variant_text =
                variant.map(|variant| describe(&format!("{}.{}", section.name, variant.name)).unwrap());
            for key in section.keys.iter().chain(variant.into_iter().flat_map(Variant::keys)) {
                let start = key.doc.split(' ').next().unwrap();
                assert!(
                    whole.contains(&format!("    {} ", key.name)) && whole.contains(start),
                    "{}",
                    key.name
                );
                if let Some(text) = &variant_text {
                    assert!(text.contains(&format!("    {} ", key.name)), "{}", key.name);
                }
                let one = describe(&format!("{}.{}", section.name, key.name)).unwrap();
                assert!(one.contains(start) && one.contains(key.unit), "{}", key.name);
            }
        }
    }
    let overview = describe("").unwrap();
    for (topic, _) in topics() {
        assert!(overview.contains(topic), "{topic}");
    }
    let error = describe("materials.glass").unwrap_err();
    assert_eq!(error.to_string(), "no topic is named `materials.glass`; did you mean `dielectric`?");
    assert_eq!(describe("shpere").unwrap_err().nearest.as_deref(), Some("sphere"));
}

#[test]
fn names_are_unique_within_reach() {
    for section in SECTIONS {
        for variant in each_kind(section) {
            let mut names: Vec<&str> = section
                .keys
                .iter()
                .chain(variant.into_iter().flat_map(Variant::keys))
                .map(|key| key.name)
                .collect();
            names.extend(section.switch.map(|switch| switch.key));
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{}", section.name);
        }
    }
}

/// Codes that a source gives to diagnostics: the literals that stand first in calls that make one.
fn codes(source: &str) -> Vec<&str> {
    const MAKERS: &[&str] = &[
        "Diagnostic::error(",
        "Diagnostic::warning(",
        "Diagnostic::note(",
        "report.error(",
        "report.note(",
        ".error(",
        ".note(",
        "Fault::new(",
        " bad(",
        ".unknown(",
    ];
    let source = source.split("#[cfg(test)]").next().unwrap_or_default();
    let mut found = Vec::new();
    for maker in MAKERS {
        for (at, _) in source.match_indices(maker) {
            let rest = source[at + maker.len()..].trim_start();
            let rest = rest.strip_prefix("report,").unwrap_or(rest).trim_start();
            let literal = rest.strip_prefix('"').and_then(|rest| rest.split_once('"'));
            let is_code =
                |text: &&str| !text.is_empty() && text.chars().all(|c| c.is_ascii_lowercase() || c == '-');
            found.extend(literal.map(|(text, _)| text).filter(is_code));
        }
    }
    found
}

#[test]
fn every_code_of_the_program_is_described() {
    use nephroid_scenefile::diagnostic::CODES;

    fn sources(folder: &Path, into: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                sources(&path, into);
            } else if path.extension().is_some_and(|e| e == "rs") {
                into.push(std::fs::read_to_string(path).unwrap());
            }
        }
    }
    assert_eq!(
        codes("Diagnostic::error(\n    \"planted-code\", x); report.error(\"b\", y)"),
        ["planted-code", "b", "b"]
    );
    let mut texts = Vec::new();
    for name in ["scenefile", "import", "scene", "session"] {
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src"), &mut texts);
    }
    let used: std::collections::BTreeSet<&str> = texts.iter().flat_map(|text| codes(text)).collect();
    assert!(used.len() > 40, "{used:?}");
    let undescribed: Vec<_> =
        used.iter().filter(|code| !CODES.iter().any(|(known, _)| known == *code)).collect();
    assert!(undescribed.is_empty(), "put into `CODES`: {undescribed:?}");
    for (code, _) in CODES {
        let literal = format!("\"{code}\"");
        let uses: usize = texts.iter().map(|text| text.matches(&literal).count()).sum();
        assert!(uses > 1, "nothing says {code} any more");
    }
}
