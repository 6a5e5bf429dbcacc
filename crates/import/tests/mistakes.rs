//! What is said about scenes that are wrong: every place, and never a panic.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::path::Path;

use expect_test::{Expect, expect};
use nephroid_import::load;

fn check(text: &str, expected: &Expect) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pbrt");
    std::fs::write(&path, text).unwrap();
    let loaded = load(&path, &[]);
    assert!(loaded.desc.is_none());
    let folder = format!("{}/", folder.path().display());
    expected.assert_eq(&loaded.render().replace(&folder, ""));
}

#[test]
fn one_mistake_hides_no_other() {
    let text = "Camera \"perspective\" \"float fov\" [ 30\nWorldBegin\nShpae \"sphere\"\nTranslate 1 two 3\nMaterial \"chrome\"\n\
                Shape \"sphere\" \"flaot radius\" 2\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1] \"integer indices\" [0 1 9]\n\
                AttributeBegin\nNamedMaterial \"gold\nTransformEnd\nObjectEnd\n";
    check(
        text,
        &expect![[r#"
        error[syntax]: `float fov` takes a closing bracket here
         --> a.pbrt:2:1
          |
        2 | WorldBegin
          | ^^^^^^^^^^

        warning[unsupported]: there is no `Camera`: one at the origin looks along +z
         --> a.pbrt:2:1
          |
        2 | WorldBegin
          | ^^^^^^^^^^

        error[unknown-directive]: there is no directive `Shpae`
         --> a.pbrt:3:1
          |
        3 | Shpae "sphere"
          | ^^^^^

        error[syntax]: `Translate` takes 3 numbers here
         --> a.pbrt:4:13
          |
        4 | Translate 1 two 3
          |             ^^^

        error[unknown-kind]: there is no material `chrome`
         --> a.pbrt:5:10
          |
        5 | Material "chrome"
          |          ^^^^^^^^

        error[parameter]: `flaot` is no type of parameter
         --> a.pbrt:6:16
          |
        6 | Shape "sphere" "flaot radius" 2
          |                ^^^^^^^^^^^^^^

        error[missing-parameter]: the shape `trianglemesh` has no points `P`
         --> a.pbrt:7:1
          |
        7 | Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1] "integer indices" [0 1 9]
          | ^^^^^

        error[parameter]: the values of `P` are not of the type `point3`
         --> a.pbrt:7:22
          |
        7 | Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1] "integer indices" [0 1 9]
          |                      ^^^^^^^^^^

        warning[unknown-parameter]: the shape `trianglemesh` has no parameter `integer indices`: it is ignored
         --> a.pbrt:7:51
          |
        7 | Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1] "integer indices" [0 1 9]
          |                                                   ^^^^^^^^^^^^^^^^^

        error[syntax]: this string has no closing quote on its line
         --> a.pbrt:9:15
          |
        9 | NamedMaterial "gold
          |               ^^^^^

        error[syntax]: `NamedMaterial` takes a string in quotes here
          --> a.pbrt:10:1
           |
        10 | TransformEnd
           | ^^^^^^^^^^^^

        error[syntax]: `ObjectEnd` ends nothing that is open here
          --> a.pbrt:11:1
           |
        11 | ObjectEnd
           | ^^^^^^^^^

        10 errors, 2 warnings
    "#]],
    );
}

#[test]
fn values_out_of_range() {
    let text = "Film \"rgb\" \"integer xresolution\" -5\nScale 1 0 1\nWorldBegin\nShape \"sphere\" \"float radius\" -1\n\
                Texture \"t\" \"spectrum\" \"imagemap\"\nMaterial \"diffuse\" \"texture reflectance\" \"u\"\n\
                Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]\n\
                LightSource \"point\" \"spectrum I\" [500 1 400 1]\nShape \"sphere\" \"float radius\" [1e99]\nAttributeBegin\n";
    check(
        text,
        &expect![[r#"
            error[out-of-range]: `xresolution` of the film `rgb` must be a whole number from 1 to 65536, not -5
             --> a.pbrt:1:12
              |
            1 | Film "rgb" "integer xresolution" -5
              |            ^^^^^^^^^^^^^^^^^^^^^

            error[degenerate]: this transform flattens space, is not affine, or overflows
             --> a.pbrt:2:1
              |
            2 | Scale 1 0 1
              | ^^^^^

            warning[unsupported]: there is no `Camera`: one at the origin looks along +z
             --> a.pbrt:3:1
              |
            3 | WorldBegin
              | ^^^^^^^^^^

            error[out-of-range]: `radius` of the shape `sphere` must be greater than 0
             --> a.pbrt:4:16
              |
            4 | Shape "sphere" "float radius" -1
              |                ^^^^^^^^^^^^^^

            error[missing-parameter]: the texture `t` has no `filename`
             --> a.pbrt:5:1
              |
            5 | Texture "t" "spectrum" "imagemap"
              | ^^^^^^^

            error[unknown-texture]: no spectrum texture is named `u`
             --> a.pbrt:6:20
              |
            6 | Material "diffuse" "texture reflectance" "u"
              |                    ^^^^^^^^^^^^^^^^^^^^^

            error[out-of-range]: the shape `trianglemesh` names vertex 3, but there are 3
             --> a.pbrt:7:53
              |
            7 | Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 3]
              |                                                     ^^^^^^^^^^^^^^^^^

            error[spectrum]: the wavelengths of `I` do not rise
             --> a.pbrt:8:21
              |
            8 | LightSource "point" "spectrum I" [500 1 400 1]
              |                     ^^^^^^^^^^^^

            error[parameter]: a value of `radius` is not finite
             --> a.pbrt:9:16
              |
            9 | Shape "sphere" "float radius" [1e99]
              |                ^^^^^^^^^^^^^^

            error[syntax]: `AttributeBegin` without `AttributeEnd`
              --> a.pbrt:10:1
               |
            10 | AttributeBegin
               | ^^^^^^^^^^^^^^

            9 errors, 1 warning
        "#]],
    );
}

#[test]
fn files_that_go_round() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pbrt");
    std::fs::write(&path, "WorldBegin\nInclude \"b.pbrt\"\nInclude \"none.pbrt\"\nInclude \".\"\n").unwrap();
    std::fs::write(folder.path().join("b.pbrt"), "AttributeBegin\nInclude \"a.pbrt\"\n").unwrap();
    let text = load(&path, &[]).render().replace(&format!("{}/", folder.path().display()), "");
    expect![[r#"
        warning[unsupported]: there is no `Camera`: one at the origin looks along +z
         --> a.pbrt:1:1
          |
        1 | WorldBegin
          | ^^^^^^^^^^

        error[file]: the scene file `none.pbrt` is not there
         --> a.pbrt:3:9
          |
        3 | Include "none.pbrt"
          |         ^^^^^^^^^^^

        error[file]: the scene file `.` is no ordinary file
         --> a.pbrt:4:9
          |
        4 | Include "."
          |         ^^^

        error[syntax]: `AttributeBegin` without `AttributeEnd` in this file
         --> b.pbrt:1:1
          |
        1 | AttributeBegin
          | ^^^^^^^^^^^^^^

        error[file]: the scene file `a.pbrt` includes itself
         --> b.pbrt:2:9
          |
        2 | Include "a.pbrt"
          |         ^^^^^^^^

        4 errors, 1 warning
    "#]]
    .assert_eq(&text);
    let missing = load(Path::new("none.pbrt"), &[]).render();
    expect![[r#"
        error[file]: the scene none.pbrt is not there
         --> none.pbrt
          = help: the name is relative to the folder that the command is given in

        1 error
    "#]]
    .assert_eq(&missing);
}

#[test]
fn deep_and_wide_inclusion_ends() {
    let folder = tempfile::tempdir().unwrap();
    for i in 0..40 {
        let next = format!("Include \"{}.pbrt\"\nInclude \"{}.pbrt\"\n", i + 1, i + 1);
        std::fs::write(folder.path().join(format!("{i}.pbrt")), next).unwrap();
    }
    let loaded = load(&folder.path().join("0.pbrt"), &[]);
    assert!(loaded.desc.is_none());
    assert!(loaded.sources.iter().count() <= 10_000);
    let text = loaded.render();
    assert!(text.contains("through more than 32 files"), "{}", &text[..500]);
}

/// Any cut, and any byte replaced, gives diagnostics or a scene, in bounded time.
#[test]
fn damaged_texts_do_no_harm() {
    let text = "LookAt 3 4 1.5 .5 .5 0 0 0 1\nCamera \"perspective\" \"float fov\" 45\nSampler \"halton\" \"integer pixelsamples\" 8\n\
                Film \"rgb\" \"string filename\" \"x.png\" \"integer xresolution\" [4] \"integer yresolution\" [4]\nWorldBegin\n\
                LightSource \"infinite\" \"rgb L\" [.4 .45 .5]\nAttributeBegin\nMaterial \"dielectric\" \"float eta\" 1.5\n\
                Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] \"integer indices\" [0 1 2 2 1 3]\n\
                Shape \"curve\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3]\nAttributeEnd\n\
                Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" [ 8 ]\nMaterial \"diffuse\" \"texture reflectance\" \"c\"\n\
                Translate 0 0 -1\nShape \"bilinearmesh\" \"point3 P\" [ -20 -20 0 20 -20 0 -20 20 0 20 20 0 ]\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pbrt");
    let mut scenes = 0;
    let mut read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let loaded = load(&path, &[]);
        loaded.render();
        scenes += usize::from(loaded.desc.is_some());
    };
    read(text.as_bytes());
    for cut in 0..text.len() {
        read(&text.as_bytes()[..cut]);
    }
    for (i, byte) in (0..text.len()).zip(b"]\"[-9e\\#\x00\xff".iter().cycle()) {
        let mut bytes = text.as_bytes().to_vec();
        bytes[i] = *byte;
        read(&bytes);
    }
    assert!(scenes > 100, "{scenes} of them are scenes");
}
