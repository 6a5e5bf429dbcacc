//! `render --layers` and `film.layers`.

use crate::harness::{BOX, Place};

/// Names of the layers on request among the channels of a picture.
fn layers(place: &Place, name: &str) -> Vec<String> {
    let bytes = place.read(name);
    let text = String::from_utf8_lossy(&bytes);
    // Names of channels end with a zero byte.
    let words = text.split(|c: char| c.is_control() || c == '\u{fffd}');
    let red = words.filter_map(|word| word.strip_suffix(".R"));
    red.filter(|name| name.starts_with("light-") || name.starts_with("technique-"))
        .map(str::to_owned)
        .collect()
}

#[test]
fn layers_come_on_request_alone() {
    let place = Place::new();
    let args = ["render", "box.toml", "--integrator", "path", "-q", "-o", "a.exr"];
    place.ok(&args);
    assert!(layers(&place, "a.exr").is_empty());
    place.ok(&[&args[..], &["--layers", "techniques,lights"]].concat());
    let both = ["light-bulb", "light-lamp", "technique-direct", "technique-emission"];
    assert_eq!(layers(&place, "a.exr"), both);
    place.write("layers.toml", &BOX.replace("[film]", "[film]\nlayers = [\"lights\"]"));
    let args =
        ["render", "layers.toml", "--set", "lights.bulb.light_group=\"key light\"", "-q", "-o", "b.exr"];
    place.ok(&[&args[..], &["--integrator", "photon_map"]].concat());
    assert_eq!(layers(&place, "b.exr"), ["light-key_light", "light-lamp", "light-other"]);
    let wrong = place.run(&["render", "box.toml", "--layers", "lamps"]);
    assert_eq!(wrong.code, Some(2));
    assert!(wrong.err.contains("techniques") && wrong.err.contains("lights"), "{}", wrong.err);
}

#[test]
fn checkpoints_keep_layers() {
    let place = Place::new();
    let render = |range: &str, file: &str, layers: &str| {
        let args = ["render", "box.toml", "--integrator", "vcm", "--pass-range", range, "--checkpoint", file];
        place.ok(&[&args[..], &["--layers", layers, "-q", "-o", "part.exr"]].concat());
    };
    render("0..1", "a.neph", "lights");
    render("1..2", "b.neph", "lights");
    render("1..2", "c.neph", "techniques");
    place.ok(&["merge", "a.neph", "b.neph", "-o", "merged.exr", "-q"]);
    let args =
        ["render", "box.toml", "--integrator", "vcm", "--layers", "lights", "-q", "-o", "straight.exr"];
    place.ok(&args);
    assert!(place.read("merged.exr") == place.read("straight.exr"));
    assert_eq!(layers(&place, "merged.exr"), ["light-bulb", "light-lamp"]);
    let refused = place.run(&["merge", "a.neph", "c.neph", "-o", "no.exr"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("layers"), "{}", refused.err);
}
