//! Help, version, completions and the man page.

use crate::harness::Place;

#[test]
fn the_version() {
    let ran = Place::new().ok(&["--version"]);
    assert_eq!(ran.out, concat!("nephroid ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn nothing_asked_is_a_question() {
    let ran = Place::new().run(&[]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("render") && ran.err.contains("describe"), "{}", ran.err);
}

#[test]
fn help_names_every_flag() {
    let out = Place::new().ok(&["render", "--help"]).out;
    for flag in [
        "--output",
        "--integrator",
        "--size",
        "--width",
        "--passes",
        "--seed",
        "--threads",
        "--exposure",
        "--max-depth",
        "--set",
        "--timings",
        "--quiet",
    ] {
        assert!(out.contains(flag), "{flag}: {out}");
    }
}

#[test]
fn completions_of_shells() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish"] {
        let out = place.ok(&["completions", shell]).out;
        for word in ["render", "passes", "photon_map", "describe"] {
            assert!(out.contains(word), "{shell}: {word}");
        }
    }
    assert_eq!(place.run(&["completions", "dos"]).code, Some(2));
}

#[test]
fn the_man_page() {
    let out = Place::new().ok(&["man"]).out;
    assert!(out.contains(".TH nephroid 1"), "{}", &out[..200.min(out.len())]);
    for part in
        [".SH NAME", ".SH \"NEPHROID RENDER\"", "\\-\\-passes", ".SH \"NEPHROID COMPARE\"", "\\-\\-mask"]
    {
        assert!(out.contains(part), "{part}");
    }
}
