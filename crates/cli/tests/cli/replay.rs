//! `replay`.

use expect_test::expect;

use crate::harness::Place;

#[test]
fn a_camera_path_is_told_vertex_by_vertex() {
    let place = Place::new();
    let ran = place.ok(&["replay", "box.toml", "--integrator", "path", "--pass", "1", "--pixel", "8,9"]);
    expect![[r#"
        camera path through pixel 8,9 of pass 1 (path, seed 0)
          vertex 0    an object without name (white, diffuse, D)
                      at (0.0367687, 0, 1.13188), 3.03768 away, footprint 0.178148
                      normal (0, 1, 0)
                      throughput 1 1 1
            + direct    0.281469 0.281469 0.281469 (direct, from lamp)
          end         left the scene
          direct      0.281469 0.281469 0.281469
          caustic     0 0 0
          indirect    0 0 0
          beauty      0.281469 0.281469 0.281469, times the filter's weight 1
    "#]]
    .assert_eq(&ran.out);
    assert_eq!(ran.err, "");
    assert_eq!(place.files(), ["box.toml"]);
}

#[test]
fn a_photon_path_is_told_for_each_map_that_has_one() {
    let place = Place::new();
    let both =
        place.ok(&["replay", "box.toml", "--integrator", "photon_map", "--pass", "1", "--photon", "7"]);
    let said: Vec<_> = both.out.lines().filter(|line| !line.starts_with(' ')).collect();
    assert_eq!(
        said,
        [
            "global photon path 7 of pass 1 (photon_map, seed 0)",
            "caustic photon path 7 of pass 1 (photon_map, seed 0)"
        ]
    );
    let args = [
        "replay",
        "box.toml",
        "--integrator",
        "photon_map",
        "--pass",
        "1",
        "--photon",
        "7",
        "--map",
        "caustic",
    ];
    let one = place.ok(&args);
    assert!(both.out.ends_with(&one.out) && both.out != one.out, "{}", one.out);
}

#[test]
fn a_checkpoint_stands_for_its_scene() {
    let place = Place::new();
    place.ok(&["render", "box.toml", "--integrator", "sppm", "--seed", "5", "--checkpoint", "a.neph", "-q"]);
    let key = ["--pass", "1", "--pixel", "4,6", "--json"];
    let of = |scene: &[&str]| place.ok(&[&["replay"], scene, &key].concat()).out;
    assert_eq!(of(&["a.neph"]), of(&["box.toml", "--integrator", "sppm", "--seed", "5"]));
    assert_ne!(of(&["a.neph"]), of(&["box.toml", "--integrator", "sppm", "--seed", "6"]));
    let refused = place.run(&["replay", "a.neph", "--seed", "6", "--pass", "1", "--pixel", "4,6"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("cannot be changed"), "{}", refused.err);
}

#[test]
fn paths_that_are_not_there_are_refused() {
    let place = Place::new();
    let said = |args: &[&str]| {
        let ran = place.run(&[&["replay", "box.toml", "--integrator", "sppm"], args].concat());
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{args:?}");
        ran.err
    };
    assert!(said(&["--pass", "0", "--pixel", "16,0"]).contains("0,0 to 15,11"));
    assert!(said(&["--pass", "4194304", "--pixel", "0,0"]).contains("4194303"));
    assert!(said(&["--pass", "0", "--photon", "192"]).contains("0 to 191"));
    assert!(said(&["--pass", "0", "--photon", "0", "--map", "caustic"]).contains("global"));
    assert!(said(&["--pass", "0", "--pixel", "3"]).contains("10,20"));
    assert!(said(&["--pass", "0"]).contains("--pixel"));
    assert!(said(&["--pixel", "1,1"]).contains("--pass"));
    assert!(said(&["--pass", "0", "--pixel", "1,1", "--photon", "1"]).contains("cannot be used with"));
}

/// Lamps so bright that the light is beyond what a film holds, or any number.
#[test]
fn a_warning_ends_with_the_command_that_shows_the_path() {
    let place = Place::new();
    for (integrator, power) in [("path", "3e38"), ("sppm", "3e38"), ("photon_map", "3e38")] {
        let set = format!("objects.lamp.power={power}");
        let ran = place.ok(&["render", "box.toml", "--integrator", integrator, "--set", &set, "-q"]);
        let line = ran.err.lines().find(|line| line.contains("nephroid replay")).unwrap_or_else(|| {
            panic!("{integrator}: {}", ran.err);
        });
        let (_, command) = line.split_once("nephroid ").unwrap();
        let words: Vec<_> = command.split(' ').collect();
        assert_eq!(words[..2], ["replay", "box.toml"], "{line}");
        let again = place.ok(&words);
        assert!(again.out.contains("e3") || again.out.contains("inf"), "{integrator}: {}", again.out);
    }
}
