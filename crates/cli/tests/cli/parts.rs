//! A part of the picture, another camera, and values of scenes of other programs.

use nephroid::RgbImage;

use crate::harness::{Place, masked};

/// A quad under a lamp, by another program.
const PBRT: &str = r#"
LookAt 0 1 4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 12 "string filename" "x.exr"
WorldBegin
LightSource "point" "rgb I" [20 20 20] "point3 from" [0 3 0]
NamedMaterial "grey"
Shape "trianglemesh" "point3 P" [-2 0 2  2 0 2  2 0 -2  -2 0 -2] "integer indices" [0 1 2 0 2 3]
"#;

fn pbrt() -> String {
    PBRT.replace(
        "WorldBegin",
        "WorldBegin\nMakeNamedMaterial \"grey\" \"string type\" \"diffuse\" \"rgb reflectance\" [.5 .5 .5]",
    )
}

#[test]
fn a_part_has_the_bytes_of_the_whole() {
    let place = Place::new();
    let part = |x: usize, y: usize| (4..13).contains(&x) && (3..10).contains(&y);
    for integrator in ["auto", "path", "photon_map", "sppm", "vcm"] {
        for layers in [&["--layers", "techniques,lights"][..], &[]] {
            let render = |name: &str, more: &[&str]| {
                let args = ["box.toml", "-q", "--integrator", integrator, "--spp", "3", "-o", name];
                place.ok(&[&args[..], layers, more].concat());
                RgbImage::read(&place.path(name)).unwrap()
            };
            let whole = render("whole.exr", &[]);
            let crop = render("part.exr", &["--crop", "4,3,13,10"]);
            assert_eq!((crop.width(), crop.height()), (16, 12));
            let mut lit = 0;
            for (i, (a, b)) in whole.pixels().iter().zip(crop.pixels()).enumerate() {
                let expected = if part(i % 16, i / 16) { *a } else { [0.0; 3] };
                assert_eq!(*b, expected, "{integrator} {layers:?}: pixel {},{}", i % 16, i / 16);
                lit += u32::from(*b != [0.0; 3]);
            }
            assert!(lit > 30, "{integrator}: {lit}");
        }
    }
}

#[test]
fn parts_are_saved_and_go_on() {
    let place = Place::new();
    let crop = ["--integrator", "vcm", "--crop", "25%,25%,75%,75%", "-q"];
    let render = |args: &[&str]| place.ok(&[&["box.toml"][..], &crop, args].concat());
    render(&["--spp", "4", "-o", "a.exr"]);
    render(&["--spp", "2", "-o", "b.exr", "--checkpoint", "b.neph"]);
    place.ok(&["resume", "b.neph", "--passes", "4", "-q"]);
    assert_eq!(place.read("a.exr"), place.read("b.exr"));
    render(&["--pass-range", "0..2", "-o", "c.exr", "--checkpoint", "c.neph"]);
    render(&["--pass-range", "2..4", "-o", "c.exr", "--checkpoint", "d.neph"]);
    place.ok(&["merge", "d.neph", "c.neph", "-o", "m.exr", "-q"]);
    assert_eq!(place.read("a.exr"), place.read("m.exr"));
    let args = ["--integrator", "vcm", "-q", "--pass-range", "4..6", "--checkpoint", "e.neph", "-o", "e.exr"];
    place.ok(&[&["box.toml"][..], &args].concat());
    let other = place.run(&["merge", "c.neph", "e.neph", "-o", "m.exr"]);
    assert!(other.code == Some(2) && other.err.contains("film.crop"), "{}", other.err);
    // In the scene, too.
    place.ok(&[
        "box.toml",
        "-q",
        "--integrator",
        "vcm",
        "--spp",
        "4",
        "--set",
        "film.crop=[4,3,12,9]",
        "-o",
        "t.exr",
    ]);
    let picture = |name: &str| RgbImage::read(&place.path(name)).unwrap().pixels().to_vec();
    assert_eq!(picture("a.exr"), picture("t.exr"));
    for (args, part) in [
        (["--crop", "4,3,17,10"], "no part of the picture"),
        (["--crop", "4,3,4,10"], "empty"),
        (["--set", "film.crop=[4,3,12,13]"], "no part of a picture of 16 x 12"),
        (["--set", "film.crop=[4,3]"], "[x0, y0, x1, y1]"),
    ] {
        let ran = place.run(&["box.toml", args[0], args[1]]);
        assert!(ran.code == Some(2) && ran.err.contains(part), "{args:?}: {}", ran.err);
    }
}

#[test]
fn another_camera() {
    let place = Place::new();
    let render = |name: &str, more: &[&str]| {
        place.ok(&[&["box.toml", "-q", "--spp", "1", "-o", name][..], more].concat());
        place.read(name)
    };
    let short = render("a.exr", &["--camera", "0,2,5:0,0.5,0:30"]);
    let sets =
        ["--set", "camera.position=[0,2,5]", "--set", "camera.look_at=[0,0.5,0]", "--set", "camera.fov=30"];
    assert_eq!(short, render("b.exr", &sets));
    assert_ne!(short, render("c.exr", &["--camera", "-1,2,5"]));
    let wrong = place.run(&["box.toml", "--camera", "1,2"]);
    assert!(wrong.code == Some(2) && wrong.err.contains("0,2,5:0,1,0:40"), "{}", wrong.err);
    let same = place.run(&["box.toml", "--camera", "0,2,5:0,2,5"]);
    assert!(same.code == Some(2) && same.err.contains("the target is the position"), "{}", same.err);
}

#[test]
fn values_of_other_programs_scenes() {
    let place = Place::new();
    place.write("quad.pbrt", &pbrt());
    let set = [
        "--camera",
        "1,2,4:0,0,0",
        "--set",
        "lights.0.intensity=40",
        "--set",
        "materials.grey.color=[0.9,0.1,0.1]",
        "--set",
        "render.max_depth=2",
    ];
    let base = ["quad.pbrt", "--integrator", "path", "--spp", "2"];
    let render = |name: &str, more: &[&str]| place.ok(&[&base[..], &["-q", "-o", name], more].concat());
    render("a.exr", &set);
    // As the converted scene with the same values.
    place.ok(&[&["convert", "quad.pbrt", "quad.toml"][..], &set].concat());
    place.ok(&["quad.toml", "-q", "--integrator", "path", "--spp", "2", "-o", "b.exr"]);
    assert_eq!(place.read("a.exr"), place.read("b.exr"));
    let image = RgbImage::read(&place.path("a.exr")).unwrap();
    let red = image.pixels().iter().any(|[r, g, _]| *r > 5.0 * g && *g > 0.0);
    assert!(red, "the floor is red");
    // A render that goes on keeps them.
    let first =
        ["quad.pbrt", "--integrator", "path", "--spp", "1", "-q", "-o", "c.exr", "--checkpoint", "c.neph"];
    place.ok(&[&first[..], &set].concat());
    place.ok(&["resume", "c.neph", "--passes", "2", "-q"]);
    assert_eq!(place.read("a.exr"), place.read("c.exr"));
    // Mistakes are said where they are.
    let wrong = place.run(&["quad.pbrt", "--set", "camera.fow=30", "--set", "materials.gray.color=1"]);
    assert_eq!(wrong.code, Some(2));
    expect_test::expect![[r#"
        error[unknown-key]: unknown key `fow` in [camera]
         --> --set:1:8
          |
        1 | camera.fow=30
          |        ^^^
          = help: did you mean `fov`?

        error[override]: there is no `gray` to set
         --> --set:1:11
          |
        1 | materials.gray.color=1
          |           ^^^^
          = help: did you mean `grey`?

        2 errors
    "#]]
    .assert_eq(&masked(&wrong.err));
}
