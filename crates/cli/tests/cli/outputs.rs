//! What a render writes and says.

use expect_test::expect;

use crate::harness::{Place, masked, size};

#[test]
fn the_default_output_is_named_after_the_scene() {
    let place = Place::new();
    let ran = place.ok(&["render", "box.toml"]);
    assert_eq!(place.files(), ["box.png", "box.toml"]);
    assert_eq!(size(&place.path("box.png")), (16, 12));
    assert_eq!(ran.out, "");
    expect![[r#"
        caustic map: _ stored photons, _ KiB, typical radius _
        pass 1/2 (50 %), _ s elapsed, _ s left
        pass 2/2 (100 %), grain _ %, _ s elapsed
        wrote box.png (16x12, 2 passes)
        exposure _ EV, automatic
        grain _ %: a first draft; clean (1.0 %) after about _ passes
    "#]]
    .assert_eq(&masked(&ran.err));
}

#[test]
fn path_tracing_says_its_passes() {
    let place = Place::new();
    let ran = place.ok(&["render", "box.toml", "--integrator", "path", "-o", "a.exr"]);
    expect![[r#"
        pass 1/2 (50 %), _ s elapsed, _ s left
        pass 2/2 (100 %), grain _ %, _ s elapsed
        wrote a.exr (16x12, 2 passes)
        grain _ %: a first draft; clean (1.0 %) after about _ passes
    "#]]
    .assert_eq(&masked(&ran.err));
}

#[test]
fn a_pipe_gets_few_lines() {
    let place = Place::new();
    let ran = place.ok(&["render", "box.toml", "--integrator", "path", "--passes", "200", "--size", "4x4"]);
    let lines: Vec<_> = ran.err.lines().filter(|l| l.starts_with("pass ")).collect();
    // The first, the last, and one each five seconds.
    assert!((2..=8).contains(&lines.len()), "{lines:?}");
    assert!(lines[0].starts_with("pass 1/200 (0 %)"), "{lines:?}");
    assert!(lines[lines.len() - 1].starts_with("pass 200/200 (100 %)"), "{lines:?}");
    assert!(!ran.err.contains('\r') && !ran.err.contains('\u{1b}'), "{:?}", ran.err);
}

#[test]
fn quiet_says_nothing() {
    let place = Place::new();
    let ran = place.ok(&["render", "box.toml", "--quiet"]);
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    assert_eq!(place.files(), ["box.png", "box.toml"]);
}

#[test]
fn several_outputs_of_a_wanted_size() {
    let place = Place::new();
    let ran =
        place.ok(&["render", "box.toml", "-o", "a.exr", "-o", "b.png", "--output", "c.EXR", "--size", "7x5"]);
    assert_eq!(place.files(), ["a.exr", "b.png", "box.toml", "c.EXR"]);
    for name in ["a.exr", "b.png", "c.EXR"] {
        assert_eq!(size(&place.path(name)), (7, 5), "{name}");
        assert!(ran.err.contains(&format!("wrote {name} (7x5, 2 passes)")), "{}", ran.err);
    }
    assert_eq!(place.read("a.exr"), place.read("c.EXR"));
}

#[test]
fn width_keeps_the_aspect() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "--width", "8", "--passes", "1", "-q"]);
    assert_eq!(size(&place.path("box.png")), (8, 6));
}

#[test]
fn settings_arrive() {
    let place = Place::new();
    let render = |name: &str, more: &[&str]| {
        let mut args = vec!["render", "box.toml", "-q", "-o", name];
        args.extend(more);
        place.ok(&args);
        place.read(name)
    };
    let plain = render("plain.exr", &[]);
    assert_eq!(plain, render("same.exr", &[]), "a render repeats");
    let spelt = ["--passes", "2", "--seed", "0", "--max-depth", "4", "--size", "16x12"];
    assert_eq!(plain, render("spelt.exr", &spelt), "flags that say what the scene says");
    let changes: [&[&str]; 7] = [
        &["--seed", "1"],
        &["--passes", "3"],
        &["--max-depth", "1"],
        &["--integrator", "path"],
        &["--set", "photon_map.photons=2001"],
        &["--set", "objects.ball.radius=0.3"],
        &["--set", "materials.white.color=[0.1, 0.2, 0.3]", "--set", "render.passes=1"],
    ];
    let mut seen = vec![plain];
    for change in changes {
        let bytes = render("changed.exr", change);
        assert!(!seen.contains(&bytes), "{change:?} changed nothing");
        seen.push(bytes);
    }
}

#[test]
fn exposure_is_of_pngs_alone() {
    let place = Place::new();
    let render = |ev: &str| {
        place.ok(&["render", "box.toml", "-q", "-o", "a.exr", "-o", "a.png", "--exposure", ev]);
        // Beside its attributes, which say how it was shown.
        let exr = nephroid::ExrChannels::read(&place.path("a.exr")).unwrap();
        (exr, place.read("a.png"))
    };
    let (exr, png) = render("0");
    let (exr_brighter, png_brighter) = render("-2.5");
    assert_eq!(exr, exr_brighter);
    assert_ne!(png, png_brighter);
}

#[test]
fn timings_name_every_phase() {
    let place = Place::new();
    let ran = place.ok(&["render", "box.toml", "-q", "--timings"]);
    for phase in
        ["load scene", "compile scene", "trace photons", "build photon maps", "eye passes", "write", "total"]
    {
        assert!(ran.out.contains(phase), "{phase}: {}", ran.out);
    }
    assert_eq!(ran.err, "");
}

#[test]
fn an_older_picture_is_replaced() {
    let place = Place::new();
    place.write("box.png", "old");
    place.ok(&["render", "box.toml", "-q"]);
    assert_eq!(size(&place.path("box.png")), (16, 12));
    assert_eq!(place.files(), ["box.png", "box.toml"]);
}
