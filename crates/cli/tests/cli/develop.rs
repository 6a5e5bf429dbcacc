//! Display after the render: `develop`, and display flags of the others.

use nephroid::{ExrChannels, RgbImage};

use crate::harness::Place;

const LIT: &str = "[camera]\nposition = [0, 1, 4]\nlook_at = [0, 0.5, 0]\n[film]\nsize = [24, 18]\n\
                   [[objects]]\nshape = \"sphere\"\nradius = 1\nmaterial = { kind = \"diffuse\", color = 0.6 }\n\
                   [[lights]]\nkind = \"point\"\nposition = [3, 3, 3]\nintensity = 3000\nlight_group = \"key\"\n\
                   [[lights]]\nkind = \"point\"\nposition = [-3, 3, 3]\nintensity = [0, 0, 900]\nlight_group = \"fill\"\n";

fn rendered() -> Place {
    let place = Place::new();
    place.write("lit.toml", LIT);
    let ran = place.ok(&[
        "render",
        "lit.toml",
        "--passes",
        "2",
        "--layers",
        "lights",
        "-o",
        "lit.exr",
        "-o",
        "lit.png",
        "--checkpoint",
        "lit.neph",
    ]);
    assert!(ran.err.contains("exposure −") && ran.err.contains("EV, automatic"), "{}", ran.err);
    place
}

#[test]
fn what_is_developed_is_what_was_rendered() {
    let place = rendered();
    let shown = place.path("lit.png");
    for file in ["lit.exr", "lit.neph"] {
        let ran = place.ok(&["develop", file, "-o", "again.png"]);
        assert!(ran.err.contains("EV, automatic"), "{}", ran.err);
        let again = RgbImage::read(&place.path("again.png")).unwrap();
        assert_eq!(again, RgbImage::read(&shown).unwrap(), "{file}");
    }
    // Display is no part of what is rendered.
    for command in [
        &["merge", "lit.neph", "-o", "again.png", "--exposure", "-9", "--view", "false-color"][..],
        &[
            "resume",
            "lit.neph",
            "-o",
            "again.png",
            "--passes",
            "3",
            "--exposure",
            "-9",
            "--white-balance",
            "D50",
        ],
    ] {
        place.ok(command);
        assert_ne!(RgbImage::read(&place.path("again.png")).unwrap(), RgbImage::read(&shown).unwrap());
    }
}

#[test]
fn lights_are_mixed() {
    let place = rendered();
    let args = ["develop", "lit.exr", "-o", "mixed.exr", "--light", "fill=0", "--light", "key=2,1,0.5,1"];
    place.ok(&args);
    let [before, after] = ["lit.exr", "mixed.exr"].map(|file| ExrChannels::read(&place.path(file)).unwrap());
    let key = before.colours("light-key").unwrap();
    for (found, key) in after.colours("").unwrap().iter().zip(key) {
        assert_eq!(*found, [2.0 * key[0], key[1], 2.0 * key[2]]);
    }
}

#[test]
fn what_cannot_be_developed_is_said() {
    let place = rendered();
    place.write("bad.cube", "LUT_3D_SIZE 2\n0 0 0\n");
    place.ok(&["develop", "lit.exr", "-q", "-o", "plain.exr", "--light", "key=1"]);
    place.ok(&["render", "box.toml", "-q", "-o", "box.exr"]);
    for (args, said) in [
        (&["lit.exr", "-o", "lit.exr"][..], "it is the picture that is developed"),
        (&["lit.exr", "-o", "a.png", "--light", "kay=1"], "did you mean `key`?"),
        (&["box.exr", "-o", "a.png", "--light", "key=1"], "--layers lights"),
        (&["lit.exr", "-o", "a.png", "--lut", "bad.cube"], "asks for 8"),
        (&["lit.exr", "-o", "a.png", "--lut", "none.cube"], "none.cube"),
        (&["lit.png", "-o", "a.png"], "EXR picture or a checkpoint"),
        (&["none.exr", "-o", "a.png"], "none.exr"),
        (&["lit.exr", "-o", "a.png", "--view", "agx-punch"], "agx-punchy"),
        (&["lit.exr", "-o", "a.png", "--white-balance", "D66"], "D50"),
        (&["lit.exr", "-o", "a.png", "--light", "key"], "sun=0.5"),
    ] {
        let ran = place.run(&[&["develop"], args].concat());
        assert_eq!(ran.code, Some(2), "{args:?}: {}", ran.err);
        assert!(ran.err.contains(said), "{args:?}: {}", ran.err);
        assert!(!place.path("a.png").exists());
    }
}
