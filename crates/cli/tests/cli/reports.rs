//! `info`, `compare` and `describe`.

use std::process::Stdio;

use expect_test::expect;

use crate::harness::{BOX, Place, masked};

#[test]
fn info_says_what_is_in_a_scene() {
    let place = Place::new();
    let ran = place.ok(&["info", "box.toml"]);
    let hidden = ran.out.lines().map(|l| l.split(" (").next().unwrap_or_default());
    let said: String = hidden.map(|l| format!("{l}\n")).collect();
    expect![[r#"
        scene       box.toml
        picture     16x12, blackman-harris filter, automatic exposure, view agx-punchy
        integrator  auto, 2 passes, seed 0, depth 4
        objects     4, 2 triangles
        materials   4, 0 textures
        bounds     
        memory      meshes _ B, BVH about _ B, textures _ B, film _ KiB
        lights      2, 40.00 W, 7160 lm
             30.00 W      5370 lm  _ %  disk lamp
             10.00 W      1790 lm  _ %  point bulb, 142.4 cd
    "#]]
    .assert_eq(&masked(&said));
    assert_eq!(ran.err, "");
    assert_eq!(place.files(), ["box.toml"]);
}

#[test]
fn info_names_lamps_as_the_scene_does() {
    let place = Place::new();
    let quad = "\n[[objects]]\nname = \"softbox\"\nshape = \"quad\"\norigin = [0, 3, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\n";
    let sun = "\n[[lights]]\nname = \"day\"\nkind = \"sun-sky\"\nsun_direction = [0, 1, 0.3]\n";
    let spot = "\n[[lights]]\nkind = \"spot\"\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\ncandela = 500\n";
    place.write("lamps.toml", &format!("{BOX}{quad}lumens = 800\n{sun}{spot}"));
    let out = place.ok(&["info", "lamps.toml"]).out;
    for part in [
        "800.0 lm",
        "quad softbox",
        "disk lamp",
        "point bulb, 142.4 cd",
        "sun-sky day (sun)",
        "spot light, 500.0 cd",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
    place.ok(&["box.toml", "-q", "--spp", "1", "--checkpoint", "a.neph"]);
    assert!(place.ok(&["info", "a.neph"]).out.contains("box.toml ("), "the file, not its folder");
}

#[test]
fn info_follows_the_flags() {
    let place = Place::new();
    let ran = place.ok(&[
        "info",
        "box.toml",
        "--integrator",
        "path",
        "--size",
        "7x5",
        "--set",
        "objects.lamp.power=5",
    ]);
    assert!(
        ran.out.contains("7x5") && ran.out.contains("path") && !ran.out.contains("photon map"),
        "{}",
        ran.out
    );
    let (bulb, lamp) = (ran.out.find("bulb").unwrap(), ran.out.find("lamp").unwrap());
    assert!(bulb < lamp, "by power: {}", ran.out);
}

#[test]
fn the_hash_of_a_scene_ignores_its_layout() {
    let place = Place::new();
    let hash = |name: &str| {
        let out = place.ok(&["info", name]).out;
        out.lines().next().unwrap().split(['(', ')']).nth(1).unwrap().to_owned()
    };
    let text = String::from_utf8(place.read("box.toml")).unwrap();
    place.write("spaced.toml", &text.replace(" = ", "   =  ").replace("[render]", "# a comment\n[render]"));
    place.write("other.toml", &text.replace("power = 30", "power = 31"));
    assert_eq!(hash("box.toml").len(), 32);
    assert_eq!(hash("box.toml"), hash("spaced.toml"));
    assert_ne!(hash("box.toml"), hash("other.toml"));
}

#[test]
fn a_picture_equals_itself_and_not_another() {
    let place = Place::new();
    let size = ["--size", "32x32"];
    place.ok(&[&["render", "box.toml", "-q", "-o", "a.exr", "-o", "a.png"][..], &size].concat());
    place.ok(&[&["render", "box.toml", "-q", "-o", "b.exr", "--seed", "5"][..], &size].concat());
    let ran = place.ok(&["compare", "a.exr", "a.exr"]);
    expect![[r#"
        a.exr: relmse 0  relmse999 0  bias 0  block_median 0  block_max 0  nonfinite 0  flip 0
    "#]]
    .assert_eq(&ran.out);
    let ran = place.ok(&["compare", "a.exr", "b.exr", "a.exr", "a.png", "--json"]);
    let lines: Vec<serde_json::Value> = ran.out.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[0]["image"], "b.exr");
    assert!(lines[0]["relmse"].as_f64().unwrap() > 0.0 && lines[0]["flip"].as_f64().unwrap() > 0.0);
    assert_eq!(lines[1]["relmse"], 0.0);
    assert_eq!(lines[1]["nonfinite"], 0);
}

#[test]
fn a_difference_is_a_sheet_of_three() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "-q", "-o", "a.exr"]);
    place.ok(&["compare", "a.exr", "a.exr", "--diff", "d.png"]);
    assert_eq!(crate::harness::size(&place.path("d.png")), (48, 12));
}

#[test]
fn a_mask_limits_the_comparison() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "-q", "-o", "a.exr"]);
    // Nothing in the box is as bright as the mask wants everywhere.
    let ran = place.run(&["compare", "a.exr", "a.exr", "--mask", "none.exr"]);
    assert_eq!(ran.code, Some(2));
    // A mask of the pixels that a bulb a thousand times as strong makes bright.
    place.ok(&["render", "box.toml", "-q", "-o", "mask.exr", "--set", "lights.bulb.power=10000"]);
    let ran = place.ok(&["compare", "a.exr", "a.exr", "--mask", "mask.exr", "--json"]);
    assert!(ran.out.contains("\"relmse\":0.0"), "{}", ran.out);
}

#[test]
fn pictures_that_do_not_fit_are_refused() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "-q", "-o", "a.exr"]);
    place.ok(&["render", "box.toml", "-q", "-o", "b.exr", "--size", "7x5"]);
    for (args, part) in [
        (["compare", "a.exr", "b.exr"], "7x5"),
        (["compare", "a.exr", "none.exr"], "none.exr"),
        (["compare", "box.toml", "a.exr"], "box.toml"),
    ] {
        let ran = place.run(&args);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{args:?}");
        assert!(ran.err.contains(part), "{args:?}: {}", ran.err);
    }
    let ran = place.run(&["compare", "a.exr", "a.exr", "--diff", "none/d.png"]);
    assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""));
}

#[test]
fn describe_prints_the_reference() {
    let place = Place::new();
    let all = place.ok(&["describe"]).out;
    for key in ["photon_map", "film", "dielectric", "teapot"] {
        assert!(all.contains(key), "{key}");
    }
    let topic = place.ok(&["describe", "photon_map"]).out;
    assert!(topic.contains("caustic_knn"), "{topic}");
    assert!(place.ok(&["describe", "film.exposure"]).out.contains("EV"));
}

#[test]
fn describe_knows_what_was_meant() {
    let place = Place::new();
    let ran = place.run(&["describe", "foton_map"]);
    assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""));
    assert!(ran.err.contains("photon_map"), "{}", ran.err);
}

#[test]
fn describe_looks_for_words() {
    let place = Place::new();
    let said = |words: &[&str]| place.ok(&[&["describe"][..], words].concat()).out;
    assert!(said(&["gold"]).contains("materials.metal"), "{}", said(&["gold"]));
    assert!(said(&["depth", "of", "field"]).contains("thin-lens"));
    assert!(said(&["fog"]).contains("not rendered"));
    assert!(said(&["units"]).contains("lumens"));
    assert!(said(&["errors"]).contains("unknown-directive"));
    assert!(said(&["materials"]).contains("diffuse-transmission  "), "names are set apart");
}

#[test]
fn a_reader_that_goes_away_is_no_mistake() {
    let place = Place::new();
    for args in [&["describe"][..], &["man"], &["completions", "bash"], &["info", "box.toml"]] {
        let mut child = place.command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
    }
}
