//! Scenes of other programs: rendered, converted, saved and resumed.

use crate::harness::Place;

/// A cup of glass and metal made of curved shapes, and a lamp.
const PBRT: &str = r#"
Integrator "path" "integer maxdepth" [ 4 ]
Sampler "independent" "integer pixelsamples" 3
PixelFilter "gaussian"
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
LookAt 0 1.5 4  0 0.5 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
Texture "board" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
Material "diffuse" "texture reflectance" "board"
Shape "bilinearmesh" "point3 P" [-2 0 2  2 0 2  -2 0 -2  2 0 -2] "point2 uv" [0 0 1 0 0 1 1 1]
AttributeBegin
  Rotate -90 1 0 0
  Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.1
  Shape "cylinder" "float radius" 0.6 "float zmin" 0 "float zmax" 1
AttributeEnd
MakeNamedMaterial "glass" "string type" "dielectric"
ObjectBegin "pebble"
  NamedMaterial "glass"
  Shape "loopsubdiv" "integer levels" 2 "integer indices" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]
    "point3 P" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1]
ObjectEnd
Translate 1.2 0.5 0.5
ObjectInstance "pebble"
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [9 8 7]
  Translate 0 2 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" 0.5
AttributeEnd
"#;

/// Two pictures of the same radiance, to the bit; the files also name their scenes.
fn assert_same(place: &Place, a: &str, b: &str) {
    let beauty = |name: &str| nephroid::RgbImage::read(&place.path(name)).unwrap();
    let (a, b) = (beauty(a), beauty(b));
    assert!(a.pixels() == b.pixels());
    assert!(a.pixels().iter().flatten().any(|x| *x > 0.0));
}

#[test]
fn a_converted_scene_gives_the_same_picture() {
    let place = Place::new();
    place.write("a.pbrt", PBRT);
    let said = place.ok(&["render", "a.pbrt", "-q", "-o", "a.exr"]).err;
    assert_eq!(said, "", "nothing in it needs a warning");
    assert_eq!(place.ok(&["convert", "a.pbrt", "b.toml"]).err, "");
    // The cylinder, the lamp (its texture lies on it as pbrt's disks have it) and the pebble.
    assert!(place.path("b-meshes/00003.ply").exists() && !place.path("b-meshes/00004.ply").exists());
    place.ok(&["render", "b.toml", "-q", "-o", "b.exr"]);
    assert_same(&place, "a.exr", "b.exr");
    // Elsewhere, from elsewhere, file names still lead to the files.
    std::fs::create_dir(place.path("sub")).unwrap();
    place.ok(&["convert", "b.toml", "sub/c.toml"]);
    place.ok(&["render", "sub/c.toml", "-q", "-o", "c.exr"]);
    assert_same(&place, "a.exr", "c.exr");
    let again = place.run(&["convert", "a.pbrt", "b.toml"]);
    assert!(again.code == Some(2) && again.err.contains("exist"), "{}", again.err);
}

#[test]
fn arguments_mean_the_same_and_renders_go_on() {
    let place = Place::new();
    place.write("a.pbrt", PBRT);
    let render = ["render", "a.pbrt", "-q", "--width", "12", "--max-depth", "1"];
    place.ok(&[&render[..], &["--passes", "4", "-o", "whole.exr"]].concat());
    assert_eq!(crate::harness::size(&place.path("whole.exr")), (12, 8));
    place.ok(&[&render[..], &["--passes", "2", "-o", "part.exr", "--checkpoint", "a.neph"]].concat());
    // The scene is read again: it must be what it was.
    place.write("a.pbrt", &PBRT.replace("[9 8 7]", "[9 8 6]"));
    let other = place.run(&["resume", "a.neph", "--passes", "4", "-q"]);
    assert!(other.code == Some(2) && other.err.contains("a.pbrt: it was changed"), "{}", other.err);
    std::fs::remove_file(place.path("a.pbrt")).unwrap();
    let gone = place.run(&["resume", "a.neph", "--passes", "4", "-q"]);
    assert!(gone.code == Some(2) && gone.err.contains("a.pbrt: it cannot be read"), "{}", gone.err);
    place.write("a.pbrt", PBRT);
    place.ok(&["resume", "a.neph", "--passes", "4", "-q"]);
    assert_same(&place, "whole.exr", "part.exr");
}

#[test]
fn doubts_are_said_or_are_errors() {
    let place = Place::new();
    place.write("a.pbrt", &PBRT.replace("Material \"diffuse\" \"texture", "Material \"measured\" \"texture"));
    let ran = place.ok(&["render", "a.pbrt", "--passes", "1", "-o", "a.exr"]);
    assert!(ran.err.contains("warning[unsupported]") && ran.err.contains("a.pbrt:10:1"), "{}", ran.err);
    let before = place.files();
    let strict = place.run(&["render", "a.pbrt", "--strict", "-o", "b.exr"]);
    assert_eq!((strict.code, place.files()), (Some(2), before));
    assert!(strict.err.contains("error[unsupported]"), "{}", strict.err);
    let set = place.ok(&["info", "a.pbrt", "--set", "render.seed=3"]);
    assert!(set.out.contains("seed 3"), "{}", set.out);
}

#[test]
fn the_ground_of_a_model_fades_into_its_surround() {
    let place = Place::new();
    place.write("a.obj", "v 0 0 0\nv 0.02 0 0\nv 0 0.02 0\nv 0 0 0.02\nf 1 2 3\nf 1 3 4\n");
    // From far above: the ground in the middle, its edge around it, what shines below it in the corners.
    let ground = place.ok(&["info", "a.obj"]);
    assert!(
        ground.err.contains("a ground is laid under the model: --no-ground leaves it out"),
        "{}",
        ground.err
    );
    let render = [
        "render",
        "a.obj",
        "-q",
        "--size",
        "24x24",
        "--passes",
        "200",
        "--camera",
        "0.01,1,0.0101:0.01,0,0.01:20",
    ];
    place.ok(&[&render[..], &["-o", "with.exr"]].concat());
    place.ok(&[&render[..], &["--no-ground", "-o", "without.exr"]].concat());
    let read = |name: &str| nephroid::RgbImage::read(&place.path(name)).unwrap();
    let (with, without) = (read("with.exr"), read("without.exr"));
    let mut counts = [0; 2];
    for (i, (a, b)) in with.pixels().iter().zip(without.pixels()).enumerate() {
        let far = ((i % 24) as f32 - 11.5).hypot((i / 24) as f32 - 11.5);
        for c in 0..3 {
            // The model and what it shades.
            if far > 4.0 {
                assert!((a[c] - b[c]).abs() < 0.05 * b[c], "pixel {i}: {a:?} {b:?}");
            }
        }
        counts[usize::from(a != b)] += 1;
    }
    assert!(counts.iter().all(|n| *n > 50), "there is ground, and what lies beyond it: {counts:?}");
    let seen = place.ok(&["info", "a.obj", "--no-ground"]);
    assert!(
        !seen.err.contains("ground") && seen.out.contains("(0, 0, 0) to (0.02, 0.02, 0.02)"),
        "{} {}",
        seen.err,
        seen.out
    );
    let asked = place.run(&["info", "a.obj", "--ground", "--no-ground"]);
    assert_eq!(asked.code, Some(2));
}
