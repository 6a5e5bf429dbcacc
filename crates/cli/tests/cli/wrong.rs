//! What is refused: status 2, every reason, nothing written.

use crate::harness::{BOX, Place, Ran};

fn refused(place: &Place, args: &[&str]) -> Ran {
    let before = place.files();
    let ran = place.run(args);
    assert_eq!(ran.code, Some(2), "{args:?}: {}{}", ran.out, ran.err);
    assert_eq!(place.files(), before, "{args:?}");
    assert_eq!(ran.out, "");
    assert!(!ran.err.lines().any(|l| l.starts_with("pass ")), "{args:?} began to render: {}", ran.err);
    ran
}

#[test]
fn every_mistake_of_a_scene_is_said_with_its_place() {
    let place = Place::new();
    let text = BOX
        .replace("passes = 2", "passes = 0")
        .replace("knn = 20\ncau", "kn = 20\ncau")
        .replace("ior = 1.5", "ior = -1.5")
        .replace("material = \"metal\"", "material = \"mettal\"")
        .replace("radius = 0.4\npower", "radius = \"big\"\npower");
    place.write("bad.toml", &text);
    let ran = refused(&place, &["render", "bad.toml", "-o", "a.exr"]);
    let line = |part: &str| text.lines().position(|l| l.contains(part)).unwrap() + 1;
    for part in ["passes = 0", "kn = 20", "ior = -1.5", "mettal", "radius = \"big\""] {
        assert!(ran.err.contains(&format!("bad.toml:{}:", line(part))), "{part}: {}", ran.err);
    }
    assert!(ran.err.contains("help:") && ran.err.contains("5 errors"), "{}", ran.err);
    assert!(!ran.err.contains('\u{1b}'), "no colours in a pipe");
    // The same without rendering.
    assert_eq!(refused(&place, &["info", "bad.toml"]).err, ran.err);
}

#[test]
fn scenes_that_are_not_there_or_no_scenes() {
    let place = Place::new();
    assert!(refused(&place, &["render", "none.toml"]).err.contains("none.toml"));
    assert!(refused(&place, &["render", "."]).err.contains("folder"));
    place.write("binary.toml", "\u{0}\u{1}\u{2}");
    refused(&place, &["render", "binary.toml"]);
}

#[test]
fn mistakes_that_only_compiling_finds() {
    let place = Place::new();
    place.write("none.ply", "this is no ply");
    place.write(
        "mesh.toml",
        &format!("{BOX}\n[[objects]]\nshape = \"mesh\"\nfile = \"none.ply\"\nmaterial = \"white\"\n"),
    );
    let ran = refused(&place, &["render", "mesh.toml"]);
    assert!(ran.err.contains("none.ply") && ran.err.contains("mesh.toml:"), "{}", ran.err);
}

#[test]
fn overrides_are_checked_like_the_scene() {
    let place = Place::new();
    for set in ["photon_map.photons=many", "photon_map.foton=3", "nonsense", "render.passes=-1", "=", "a.b="]
    {
        let ran = refused(&place, &["render", "box.toml", "--set", set]);
        assert!(ran.err.contains("error"), "{set}: {}", ran.err);
    }
    let many = refused(&place, &["render", "box.toml", "--set", "render.passes=5000000"]);
    assert!(many.err.contains("4194304"), "{}", many.err);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_render() {
    let place = Place::new();
    std::fs::create_dir(place.path("folder.exr")).unwrap();
    // Would take for ever.
    let forever = ["render", "box.toml", "--passes", "4000000", "--size", "512x512"];
    let cases: [(&[&str], &str); 6] = [
        (&["-o", "none/a.exr"], "none"),
        (&["-o", "folder.exr"], "folder"),
        (&["-o", "a.jpg"], "jpg"),
        (&["-o", "a"], "format"),
        (&["-o", "a.exr", "-o", "./a.exr"], "twice"),
        (&["-o", "box.toml/a.exr"], "box.toml"),
    ];
    for (outputs, part) in cases {
        let args: Vec<_> = forever.iter().chain(outputs).copied().collect();
        let ran = refused(&place, &args);
        assert!(ran.err.contains(part) && ran.err.contains("help:"), "{outputs:?}: {}", ran.err);
    }
    let ran = refused(&place, &[&forever[..], &["-o", "a.jpg", "-o", "none/b.png", "-o", "c.png"]].concat());
    assert_eq!(ran.err.matches("error:").count(), 2, "all at once: {}", ran.err);
}

#[test]
fn a_file_that_the_scene_reads_is_not_replaced() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "-q", "-o", "wood.png"]);
    place.write("wood.toml", &format!("{BOX}\n[textures.wood]\nkind = \"image\"\nfile = \"wood.png\"\n"));
    let before = place.read("wood.png");
    assert!(refused(&place, &["render", "wood.toml", "-o", "wood.png"]).err.contains("reads"));
    assert!(refused(&place, &["render", "wood.toml"]).err.contains("reads"), "the default, too");
    assert_eq!(place.read("wood.png"), before);
}

#[test]
fn outputs_and_scene_are_wrong_together() {
    let place = Place::new();
    place.write("bad.toml", &BOX.replace("passes = 2", "passes = 0"));
    let ran = refused(&place, &["render", "bad.toml", "-o", "a.jpg"]);
    assert!(ran.err.contains("bad.toml:3:") && ran.err.contains(".jpg"), "{}", ran.err);
}

#[cfg(unix)]
#[test]
fn a_protected_output_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new();
    place.write("a.png", "keep");
    std::fs::set_permissions(place.path("a.png"), std::fs::Permissions::from_mode(0o444)).unwrap();
    let ran = refused(&place, &["render", "box.toml", "-o", "a.png"]);
    assert!(ran.err.contains("permission"), "{}", ran.err);
    assert_eq!(place.read("a.png"), b"keep");
}

#[test]
fn command_lines_that_make_no_sense() {
    let place = Place::new();
    let cases: [&[&str]; 14] = [
        &["rendr", "box.toml"],
        &["render"],
        &["render", "box.toml", "--passes", "0"],
        &["render", "box.toml", "--passes", "-1"],
        &["render", "box.toml", "--size", "16.5"],
        &["render", "box.toml", "--size", "0x5"],
        &["render", "box.toml", "--size", "4x4", "--width", "3"],
        &["render", "box.toml", "--exposure", "bright"],
        &["render", "box.toml", "--threads", "x"],
        &["render", "box.toml", "--integrator", "metropolis"],
        &["render", "box.toml", "--max-depth", "0"],
        &["render", "box.toml", "--seed", "-1"],
        &["render", "box.toml", "--no-such-flag"],
        &["compare", "a.exr"],
    ];
    for args in cases {
        assert!(!refused(&place, args).err.is_empty(), "{args:?}");
    }
    assert!(refused(&place, &["rendr"]).err.contains("render"), "the nearest command is named");
    assert!(refused(&place, &["render", "box.toml", "--integrator", "paht"]).err.contains("path"));
}
