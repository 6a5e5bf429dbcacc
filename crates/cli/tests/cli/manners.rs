//! What people type before they have read anything, and what they are told.

use expect_test::expect;

use crate::harness::{BOX, Place, masked, size};

#[test]
fn a_scene_alone_is_rendered() {
    let place = Place::new();
    place.ok(&["box.toml", "-q"]);
    assert_eq!(place.files(), ["box.png", "box.toml"]);
    place.ok(&["-q", "--spp", "1", "box.toml", "-o", "a.png"]);
    assert_eq!(size(&place.path("a.png")), (16, 12));
}

#[test]
fn names_of_other_renderers_for_our_flags() {
    let place = Place::new();
    place.ok(&["box.toml", "-q", "--passes", "3", "--size", "8x6", "-o", "a.exr"]);
    place.ok(&["box.toml", "-q", "--spp", "3", "--resolution", "8x6", "-o", "b.exr"]);
    place.ok(&["box.toml", "-q", "--samples", "3", "--size", "8", "-o", "c.exr"]);
    assert_eq!(place.read("a.exr"), place.read("b.exr"));
    assert_eq!(place.read("a.exr"), place.read("c.exr"), "the height keeps the aspect");
}

#[test]
fn flags_that_are_not_known_are_answered() {
    let place = Place::new();
    let said = |flag: &str| {
        let ran = place.run(&["render", "box.toml", flag]);
        assert_eq!(ran.code, Some(2), "{flag}");
        ran.err
    };
    let all =
        ["--gpu", "--exposre", "--output-file", "--photon", "--bounces=3", "-j", "--zzz"].map(said).concat();
    expect![[r#"
        error: the flag `--gpu` is not known here
          = help: Nephroid computes on the processor's cores; --threads says on how many
        error: the flag `--exposre` is not known here
          = help: did you mean `--exposure`?
        error: the flag `--output-file` is not known here
          = help: did you mean `--output`?
        error: the flag `--photon` is not known here
          = help: it belongs to `nephroid replay`
        error: the flag `--bounces` is not known here
          = help: --max-depth N bounds the length of paths
        error: the flag `-j` is not known here
          = help: --threads N says how many
        error: the flag `--zzz` is not known here
          = help: `nephroid help COMMAND` lists the flags of a command
    "#]]
    .assert_eq(&all);
}

#[test]
fn files_that_are_no_scenes_are_named_for_what_they_are() {
    let place = Place::new();
    place.write("sofa.blend", "BLENDER-v405RENDH");
    place.write("sofa.usdz", "PK");
    place.write("sky.hdr", "#?RADIANCE\n");
    place.write("named-badly.toml", "Kaydara FBX Binary  \u{0}");
    let said = |name: &str| {
        let ran = place.run(&["render", name]);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{name}");
        ran.err
    };
    let all = ["sofa.blend", "sofa.usdz", "sky.hdr", "named-badly.toml"].map(said).concat();
    expect![[r#"
        error[file]: sofa.blend is a Blender file, which is not read as a scene
         --> sofa.blend
          = help: in Blender, File > Export > glTF 2.0, as .glb, with Cameras and Punctual Lights ticked; render that file

        1 error
        error[file]: sofa.usdz is a scene in OpenUSD, which is not read as a scene
         --> sofa.usdz
          = help: open it in Blender (File > Import > Universal Scene Description) and export glTF (.glb)

        1 error
        error[file]: sky.hdr is a picture of the surroundings (Radiance HDR), which is not read as a scene
         --> sky.hdr
          = help: a scene lights itself with it: [[lights]] with kind = "environment" and file = "NAME"; `nephroid describe environment` tells more

        1 error
        error[file]: named-badly.toml is a scene in Autodesk's FBX, which is not read as a scene
         --> named-badly.toml
          = help: open it in Blender (File > Import > FBX) or in the program that wrote it, and export glTF (.glb)

        1 error
    "#]].assert_eq(&all);
    let ran = place.run(&["info", "sofa.blend"]);
    assert!(ran.err.contains("Blender"), "{}", ran.err);
}

#[test]
fn the_nearest_file_is_named() {
    let place = Place::new();
    let ran = place.run(&["render", "bxo.toml"]);
    assert_eq!(ran.code, Some(2));
    expect![[r#"
        error[file]: the scene bxo.toml is not there
         --> bxo.toml
          = help: did you mean box.toml?

        1 error
    "#]]
    .assert_eq(&ran.err);
    assert!(place.run(&["box"]).err.contains("did you mean box.toml?"));
}

#[test]
fn a_picture_that_is_there_is_not_replaced_in_silence() {
    let place = Place::new();
    let first = place.ok(&["box.toml", "--integrator", "path"]).err;
    assert!(!first.contains("replaced"), "{first}");
    let again = place.ok(&["box.toml", "--integrator", "path", "-o", "box.png", "-o", "new.exr"]).err;
    let line = again.lines().next();
    assert_eq!(line, Some("box.png is there already: it will be replaced"), "{again}");
}

#[cfg(target_os = "linux")]
#[test]
fn the_reason_of_a_folder_that_takes_no_files() {
    let place = Place::new();
    let ran = place.run(&["render", "box.toml", "-o", "/proc/x.png"]);
    assert_eq!(ran.code, Some(2));
    expect![[r#"
        error: cannot write /proc/x.png: the folder /proc takes no new files
          = help: write to an ordinary folder
    "#]]
    .assert_eq(&ran.err);
}

#[test]
fn several_scenes_in_one_command() {
    let place = Place::new();
    place.write("other.toml", &BOX.replace("passes = 2", "passes = 1"));
    let ran = place.ok(&["box.toml", "other.toml", "--integrator", "path"]);
    assert_eq!(place.files(), ["box.png", "box.toml", "other.png", "other.toml"]);
    expect![[r#"
        box.toml (1 of 2)
        pass 1/2 (50 %), _ s elapsed, _ s left
        pass 2/2 (100 %), grain _ %, _ s elapsed
        wrote box.png (16x12, 2 passes)
        exposure _ EV, automatic
        grain _ %: a first draft; clean (1.0 %) after about _ passes
        other.toml (2 of 2)
        pass 1/1 (100 %), _ s elapsed
        wrote other.png (16x12, 1 pass)
        exposure _ EV, automatic
    "#]]
    .assert_eq(&masked(&ran.err));
    // Where they go.
    std::fs::create_dir(place.path("out")).unwrap();
    place.ok(&["box.toml", "other.toml", "-q", "-o", "out", "-o", "{}-linear.exr"]);
    assert!(place.path("out/box.png").exists() && place.path("other-linear.exr").exists());
    let ran = place.run(&["box.toml", "other.toml", "-o", "a.png", "--checkpoint", "a.neph"]);
    assert_eq!(ran.code, Some(2));
    expect![[r#"
        error: a.png cannot be the picture of 2 scenes
          = help: name a folder that is there, as -o pictures/, or put {} for the scene's name, as -o {}.exr
        error: a checkpoint is of one scene
          = help: render the scenes one by one, each with a checkpoint of its own
    "#]]
    .assert_eq(&ran.err);
}

#[test]
fn all_scenes_are_looked_at_before_the_first_is_rendered() {
    let place = Place::new();
    place.write("bad.toml", &BOX.replace("passes = 2", "passes = 0"));
    let before = place.files();
    let ran = place.run(&["bad.toml", "box.toml", "none.toml", "-q"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("bad.toml:3:") && ran.err.contains("none.toml is not there"), "{}", ran.err);
    assert_eq!(place.files(), before);
    // What only compiling finds does not stop the others.
    place.write("torn.ply", "this is no ply");
    let mesh = "\n[[objects]]\nshape = \"mesh\"\nfile = \"torn.ply\"\nmaterial = \"white\"\n";
    place.write("late.toml", &format!("{BOX}{mesh}"));
    let ran = place.run(&["late.toml", "box.toml", "-q"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("torn.ply"), "{}", ran.err);
    assert!(place.path("box.png").exists());
}
