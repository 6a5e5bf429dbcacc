//! Materials by name.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;

use nephroid_scenefile::desc::{Material, MaterialKind, MaterialRef, Metal, Roughness};
use nephroid_scenefile::{Loaded, SceneDesc, describe, parse, presets, to_toml, topics};

fn load(keys: &str) -> Loaded {
    let text = format!(
        "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n[[objects]]\nshape = \"sphere\"\nradiance = 1\nmaterial = {{ {keys} }}\n"
    );
    parse(&text, Path::new("scene.toml"), &[])
}

fn scene(keys: &str) -> SceneDesc {
    let loaded = load(keys);
    assert!(loaded.diagnostics.is_empty(), "{keys}\n{}", loaded.render());
    loaded.desc.unwrap()
}

fn material(desc: &SceneDesc) -> &Material {
    match desc.objects[0].material.as_ref().unwrap() {
        MaterialRef::Inline(material) => material,
        MaterialRef::Named(name) => panic!("{}", name.value),
    }
}

/// The help and the message of the first mistake.
fn mistake(keys: &str) -> String {
    load(keys).render()
}

#[test]
fn every_preset_is_a_material_that_is_written_as_its_keys() {
    for preset in presets() {
        let desc = scene(&format!("preset = \"{}\"", preset.name));
        let text = to_toml(&desc);
        assert!(!text.contains("preset"), "{text}");
        let again = parse(&text, Path::new("scene.toml"), &[]);
        assert_eq!(again.desc.as_ref(), Some(&desc), "{}", preset.name);
        assert!(preset.doc.ends_with('.') && preset.source.ends_with('.'), "{}", preset.name);
    }
    assert!(presets().count() > 100);
}

#[test]
fn names_are_unique_and_no_topics_and_described() {
    let mut names: Vec<&str> = presets().map(|preset| preset.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    let page = describe("presets").unwrap();
    for preset in presets() {
        assert!(!topics().iter().any(|(topic, _)| *topic == preset.name), "{}", preset.name);
        assert!(page.contains(&format!("    {} ", preset.name)), "{}", preset.name);
        let text = describe(preset.name).unwrap();
        assert!(text.contains(preset.source) && text.contains(preset.keys.lines().next().unwrap()), "{text}");
    }
    // What was found before is still found.
    assert!(describe("gold").unwrap().contains("materials.metal"));
    assert!(describe("gemstone amber").is_err());
}

#[test]
fn further_keys_override() {
    let gold = scene("preset = \"gold\", roughness = 0.3");
    let MaterialKind::Conductor(gold) = &material(&gold).kind else { panic!() };
    assert_eq!(gold.metal, Metal::Named("gold".to_owned().into()));
    assert_eq!(gold.roughness, Roughness::Perceived { roughness: 0.3.into(), anisotropy: 0.0.into() });
    // Another way to say the same takes the place of what the preset says.
    let steel = scene("preset = \"brushed-steel\", alpha = 0.2, n = 2, k = 3, opacity = 0.5");
    let MaterialKind::Conductor(conductor) = &material(&steel).kind else { panic!() };
    assert_eq!(conductor.metal, Metal::Index { n: [2.0; 3], k: [3.0; 3] });
    assert_eq!(conductor.roughness, Roughness::Alpha { along: 0.2.into(), across: 0.2.into() });
    assert_eq!(material(&steel).opacity, 0.5.into());
    let tea = scene("preset = \"tea\", absorption = 3");
    let MaterialKind::Dielectric(tea) = &material(&tea).kind else { panic!() };
    assert_eq!(tea.absorption, [3.0; 3]);
    scene("preset = \"gold\", kind = \"conductor\"");
}

#[test]
fn lengths_follow_the_unit() {
    let absorption = |keys: &str| match &material(&scene(keys)).kind {
        MaterialKind::Dielectric(dielectric) => dielectric.absorption,
        _ => panic!(),
    };
    for name in ["water", "whisky"] {
        let metre = absorption(&format!("preset = \"{name}\""));
        let centimetre = absorption(&format!("preset = \"{name}\", metres_per_unit = 0.01"));
        for (a, b) in metre.iter().zip(centimetre) {
            assert!((a - 100.0 * b).abs() < 1e-3 * a && *a > 0.0, "{name}: {metre:?} {centimetre:?}");
        }
    }
}

#[test]
fn mistakes_are_told() {
    for (keys, parts) in [
        ("preset = \"amer\"", &["unknown-preset", "did you mean `amber`?"][..]),
        ("preset = \"qqqqqqqq\"", &["unknown-preset", "`nephroid describe presets` lists all"]),
        ("preset = 3", &["wrong-type", "the name of a preset"]),
        ("presett = \"gold\"", &["missing `kind`", "did you mean `preset` by `presett`?"]),
        ("preset = \"gold\", kind = \"diffuse\"", &["conflict", "the preset has the kind `conductor`"]),
        ("preset = \"gold\", colour = 1", &["unknown key `colour`"]),
        ("preset = \"gold\", metres_per_unit = 1", &["conflict", "has no length"]),
        ("preset = \"tea\", metres_per_unit = 0", &["out-of-range", "metres_per_unit"]),
        ("preset = \"tea\", metres_per_unit = nan", &["out-of-range"]),
        ("preset = \"tea\", metres_per_unit = 1e-42", &["out-of-range", "attenuation_distance"]),
        ("preset = \"tea\", ior = 90", &["out-of-range", "`ior`"]),
        ("metres_per_unit = 1, kind = \"mirror\"", &["unknown key `metres_per_unit`"]),
    ] {
        let said = mistake(keys);
        for part in parts {
            assert!(said.contains(part), "{keys}: {part}\n{said}");
        }
    }
    let text = "[[objects]]\nshape = \"sphere\"\nmaterial = \"gold\"\n[materials]\npreset = \"gold\"\n";
    let said = parse(text, Path::new("scene.toml"), &[]).render();
    assert!(said.contains("{ preset = \"gold\" }") && said.contains("a material without a name"), "{said}");
}
