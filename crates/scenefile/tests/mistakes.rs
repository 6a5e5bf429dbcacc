//! What a person reads after a mistake.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;

use expect_test::{Expect, expect};
use nephroid_scenefile::{load, parse};

fn check(text: &str, expected: Expect) {
    expected.assert_eq(&parse(text, Path::new("box.toml"), &[]).render());
}

const BASE: &str = "camera = { position = [0, 1, 5], look_at = [0, 1, 0] }\n\
                    lights = [{ kind = \"point\", position = [0, 3, 0], power = 9 }]\n";

/// Mistakes in a scene that is otherwise whole.
fn check_in_scene(text: &str, expected: Expect) {
    check(&format!("{BASE}{text}"), expected);
}

/// Overrides of a whole scene.
fn check_overrides(overrides: &[&str], expected: Expect) {
    let text = format!(
        "{BASE}[materials.glass]\nkind = \"dielectric\"\n[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n\
         material = \"glass\"\n"
    );
    let overrides: Vec<String> = overrides.iter().map(|text| text.to_string()).collect();
    expected.assert_eq(&parse(&text, Path::new("box.toml"), &overrides).render());
}

#[test]
fn misspelt_key_as_in_the_manual() {
    let text = "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n\n[[lights]]\nkind = \"environment\"\nradiance = 1\n\
                \n\n[materials.white]\nkind = \"diffuse\"\n  colour = [0.7, 0.7, 0.7]\n\n[[objects]]\nshape = \"sphere\"\n\
                material = \"white\"\n";
    check(
        text,
        expect![[r#"
        error[unknown-key]: unknown key `colour` in material `white`
          --> box.toml:12:3
           |
        12 |   colour = [0.7, 0.7, 0.7]
           |   ^^^^^^
           = help: did you mean `color`?

        1 error
    "#]],
    );
}

#[test]
fn everything_at_once() {
    let text = "\
[render]
integrator = \"pathtracer\"
passes = 0
[flim]
size = [1, 2]
[film]
size = [70000, 10]
exposure = \"1.5\"
filter_radius = nan
[camera]
kind = \"fisheye\"
position = [0, 0, 0]
fov = 180
[materials.red]
color = 0.5
[materials.shiny]
kind = \"mirror\"
roughness = 0.1
[materials.gold]
kind = \"conductor\"
n = 1
roughness = 0.1
alpha = 0.2
[materials.odd]
kind = \"diffuse\"
color = [0.5, 2]
[materials.odder]
kind = \"diffuse\"
color = [0.5, 2, 0.1]
[textures.wood]
kind = \"image\"
file = \"no such.png\"
[[objects]]
shape = \"spere\"
[[objects]]
shape = \"sphere\"
radius = -1
material = \"rde\"
[[objects]]
shape = \"quad\"
origin = [0, 0, 0]
edge_u = [1, 0, 0]
edge_v = [2, 0, 0]
radiance = 3
[[objects]]
shape = \"disk\"
normal = [0, 0, 0]
material = 3
[[objects]]
name = \"pot\"
shape = \"teapot\"
level = 100000
parts = [\"lid\", \"handel\"]
[[lights]]
kind = \"point\"
position = [0, 1]
intensity = 1
power = 2
";
    check(
        text,
        expect![[r##"
            error[unknown-kind]: `integrator` of [render] knows no `pathtracer`
             --> box.toml:2:14
              |
            2 | integrator = "pathtracer"
              |              ^^^^^^^^^^^^
              = help: did you mean "path"? There are "auto", "path", "photon_map", "sppm", "vcm"

            error[out-of-range]: `passes` of [render] must be an integer from 1 to 1000000000, not 0
             --> box.toml:3:10
              |
            3 | passes = 0
              |          ^

            error[unknown-table]: unknown table `flim`
             --> box.toml:4:2
              |
            4 | [flim]
              |  ^^^^
              = help: did you mean `film`?

            error[out-of-range]: the width in `size` of [film] must be an integer from 1 to 65536, not 70000
             --> box.toml:7:9
              |
            7 | size = [70000, 10]
              |         ^^^^^

            error[wrong-type]: `exposure` of [film] must be a number from -64 to 64 or "auto", not the string `1.5`
             --> box.toml:8:12
              |
            8 | exposure = "1.5"
              |            ^^^^^
              = help: remove the quotes

            error[out-of-range]: `filter_radius` of [film] must be a number > 0 and ≤ 16, not NaN
             --> box.toml:9:17
              |
            9 | filter_radius = nan
              |                 ^^^

            error[missing-key]: missing `look_at` in [camera]
              --> box.toml:10:1
               |
            10 | [camera]
               | ^^^^^^^^
               = help: `look_at` is [x, y, z] in scene units: What is in the middle of the picture.

            error[unknown-kind]: unknown kind of camera `fisheye`
              --> box.toml:11:8
               |
            11 | kind = "fisheye"
               |        ^^^^^^^^^
               = help: there are "pinhole", "thin-lens", "orthographic", "spherical"

            error[out-of-range]: `fov` of [camera] must be a number > 0 and < 180, not 180
              --> box.toml:13:7
               |
            13 | fov = 180
               |       ^^^

            error[missing-key]: missing `kind` in material `red`
              --> box.toml:14:1
               |
            14 | [materials.red]
               | ^^^^^^^^^^^^^^^
               = help: it is "diffuse", "phong", "mirror", "dielectric", "conductor", "plastic", "rough-diffuse", "diffuse-transmission", "sheen", "thin-dielectric", "coated-diffuse", "coated-conductor", "principled" or "mix"; or name a `preset`

            error[unknown-key]: unknown key `roughness` in material `shiny`
              --> box.toml:18:1
               |
            18 | roughness = 0.1
               | ^^^^^^^^^
               = help: only kind = "dielectric", "conductor", "plastic", "rough-diffuse", "sheen", "thin-dielectric", "coated-diffuse", "coated-conductor" or "principled" has it

            error[missing-key]: missing `k` in material `gold`
              --> box.toml:19:1
               |
            19 | [materials.gold]
               | ^^^^^^^^^^^^^^^^
               = help: `k` is a colour ([r, g, b], grey or "#rrggbb") ≥ 0: Imaginary part of the index.

            error[conflict]: `roughness` and `alpha` exclude each other in material `gold`
              --> box.toml:23:1
               |
            23 | alpha = 0.2
               | ^^^^^
              ::: box.toml:22:1
               |
            22 | roughness = 0.1
               | --------- the other

            error[wrong-type]: `color` of material `odd` must be a colour ([r, g, b], grey, "#rrggbb" or { texture = "NAME" }) from 0 to 1, not an array of 2
              --> box.toml:26:9
               |
            26 | color = [0.5, 2]
               |         ^^^^^^^^

            error[out-of-range]: number 2 of `color` of material `odder` must be a number from 0 to 1, not 2
              --> box.toml:29:15
               |
            29 | color = [0.5, 2, 0.1]
               |               ^

            error[missing-file]: the file `no such.png` of texture `wood` is not there
              --> box.toml:32:8
               |
            32 | file = "no such.png"
               |        ^^^^^^^^^^^^^
               = help: file names start from the folder of the scene file

            error[missing-material]: object 1 has no material
              --> box.toml:33:1
               |
            33 | [[objects]]
               | ^^^^^^^^^^^
               = help: give `material`, or `radiance` or `power` to make it a lamp

            error[unknown-kind]: unknown shape `spere`
              --> box.toml:34:9
               |
            34 | shape = "spere"
               |         ^^^^^^^
               = help: did you mean "sphere"? There are "sphere", "disk", "quad", "mesh", "triangles", "box", "teapot", "lathe", "cylinder", "torus", "icosphere", "band", "ring", "coffee-cup", "wine-glass", "wine", "cone", "capsule", "rounded-box", "round-brilliant", "water-surface", "height-field"

            error[out-of-range]: `radius` of object 2 must be a number > 0, not -1
              --> box.toml:37:10
               |
            37 | radius = -1
               |          ^^

            error[unknown-material]: unknown material `rde` in object 2
              --> box.toml:38:12
               |
            38 | material = "rde"
               |            ^^^^^
               = help: did you mean `red`?

            error[degenerate]: `edge_u` and `edge_v` are parallel in object 3: a light needs an area
              --> box.toml:40:9
               |
            40 | shape = "quad"
               |         ^^^^^^

            error[degenerate]: `normal` of object 4 has no length
              --> box.toml:47:10
               |
            47 | normal = [0, 0, 0]
               |          ^^^^^^^^^

            error[wrong-type]: `material` of object 4 must be the name of a material, { kind = … } or { preset = "NAME" }, not 3
              --> box.toml:48:12
               |
            48 | material = 3
               |            ^

            error[missing-material]: object `pot` has no material
              --> box.toml:49:1
               |
            49 | [[objects]]
               | ^^^^^^^^^^^
               = help: give `material`, or `radiance` or `power` to make it a lamp

            error[out-of-range]: `level` of object `pot` must be an integer from 1 to 256, not 100000
              --> box.toml:52:9
               |
            52 | level = 100000
               |         ^^^^^^

            error[unknown-kind]: item 2 of `parts` of object `pot` knows no `handel`
              --> box.toml:53:17
               |
            53 | parts = ["lid", "handel"]
               |                 ^^^^^^^^
               = help: did you mean "handle"? There are "body", "handle", "spout", "lid", "bottom"

            error[wrong-type]: `position` of light 1 must be [x, y, z], not an array of 2
              --> box.toml:56:12
               |
            56 | position = [0, 1]
               |            ^^^^^^

            error[conflict]: `intensity` and `power` exclude each other in light 1
              --> box.toml:58:1
               |
            58 | power = 2
               | ^^^^^
              ::: box.toml:57:1
               |
            57 | intensity = 1
               | --------- the other

            28 errors
        "##]],
    );
}

#[test]
fn names_that_lead_nowhere() {
    check_in_scene(
        "[materials.floor]\nkind = \"diffuse\"\ncolor = { texture = \"chekcer\" }\nnormal_map = \"bumps\"\n\
         [textures.checker]\nkind = \"checker\"\na = 0\nb = { texture = \"checker\" }\n\
         [[objects]]\nname = \"a\"\nshape = \"sphere\"\nmaterial = \"flor\"\n\
         [[objects]]\nname = \"a\"\nshape = \"mesh\"\nfile = \"cow.fbx\"\nmaterial = \"floor\"\n\
         [[objects]]\nshape = \"sphere\"\n\
         [[instances]]\ngroup = \"trees\"\n",
        expect![[r#"
            error[unknown-texture]: unknown texture `chekcer` in material `floor`
             --> box.toml:5:21
              |
            5 | color = { texture = "chekcer" }
              |                     ^^^^^^^^^
              = help: did you mean `checker`?

            error[unknown-texture]: unknown texture `bumps` in material `floor`
             --> box.toml:6:14
              |
            6 | normal_map = "bumps"
              |              ^^^^^^^
              = help: the scene has the textures `checker`

            error[texture-cycle]: texture `checker` is made of itself
              --> box.toml:10:17
               |
            10 | b = { texture = "checker" }
               |                 ^^^^^^^^^

            error[unknown-material]: unknown material `flor` in object `a`
              --> box.toml:14:12
               |
            14 | material = "flor"
               |            ^^^^^^
               = help: did you mean `floor`?

            error[duplicate-name]: two objects are named `a`
              --> box.toml:15:1
               |
            15 | [[objects]]
               | ^^^^^^^^^^^
              ::: box.toml:11:1
               |
            11 | [[objects]]
               | ----------- the first

            error[unknown-format]: `cow.fbx` of object `a` is of no known format
              --> box.toml:18:8
               |
            18 | file = "cow.fbx"
               |        ^^^^^^^^^
               = help: known are .obj, .ply, .ply.gz, .stl

            error[missing-file]: the file `cow.fbx` of object `a` is not there
              --> box.toml:18:8
               |
            18 | file = "cow.fbx"
               |        ^^^^^^^^^
               = help: file names start from the folder of the scene file

            error[missing-material]: object 3 has no material
              --> box.toml:20:1
               |
            20 | [[objects]]
               | ^^^^^^^^^^^
               = help: give `material`, or `radiance` or `power` to make it a lamp

            error[unknown-group]: unknown group `trees` in instance 1
              --> box.toml:23:9
               |
            23 | group = "trees"
               |         ^^^^^^^
               = help: the scene has no groups; add [groups.NAME]

            9 errors
        "#]],
    );
}

#[test]
fn substances_that_nobody_measured() {
    check_in_scene(
        "[materials.a]\nkind = \"conductor\"\nmetal = \"glod\"\n\
         [materials.b]\nkind = \"dielectric\"\nior = \"watre\"\n\
         [[objects]]\nshape = \"sphere\"\nmaterial = \"a\"\n",
        expect![[r#"
            error[unknown-substance]: unknown metal `glod` in material `a`
             --> box.toml:5:9
              |
            5 | metal = "glod"
              |         ^^^^^^
              = help: did you mean `gold`?

            error[unknown-substance]: unknown substance `watre` in material `b`
             --> box.toml:8:7
              |
            8 | ior = "watre"
              |       ^^^^^^^
              = help: did you mean `water`?

            2 errors
        "#]],
    );
}

#[test]
fn shapes_without_extent() {
    check_in_scene(
        "[[objects]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 0, 1]\nradiance = 1\n\
         [[objects]]\nshape = \"quad\"\ncorners = [[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3]]\nradiance = 1\n\
         [[objects]]\nshape = \"triangles\"\npositions = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]\nindices = [[0, 1, 2]]\n\
         radiance = 1\n\
         [[objects]]\nshape = \"triangles\"\npositions = [[0, 0, 0], [1, 1, 1], [2, 0, 2]]\nindices = [[0, 1, 3]]\n\
         radiance = 1\n\
         [[objects]]\nshape = \"lathe\"\nprofile = [[0, 0], [0, 1]]\nradiance = 1\n\
         [[objects]]\nshape = \"torus\"\nsegments = 65536\ntube_segments = 65536\nradiance = 1\n\
         transform = [{ scale = [1, 0, 1] }, { matrix = [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1] }, \
         { translate = [1, 2, 3], scale = 2 }, { turn = 3 }, {}, { rotate = { axis = [0, 0, 0], degrees = 3 } }]\n",
        expect![[r#"
            error[degenerate]: `max` does not exceed `min` in every coordinate in object 1: a light needs an area
             --> box.toml:4:9
              |
            4 | shape = "box"
              |         ^^^^^

            error[degenerate]: the corners lie on a line in object 2: a light needs an area
             --> box.toml:9:9
              |
            9 | shape = "quad"
              |         ^^^^^^

            error[degenerate]: no triangle has an area in object 3: a light needs an area
              --> box.toml:13:9
               |
            13 | shape = "triangles"
               |         ^^^^^^^^^^^

            error[out-of-range]: triangle 1 has vertex 3, but there are 3 in object 4
              --> box.toml:18:9
               |
            18 | shape = "triangles"
               |         ^^^^^^^^^^^

            error[degenerate]: the profile has no extent in object 5: a light needs an area
              --> box.toml:23:9
               |
            23 | shape = "lathe"
               |         ^^^^^^^

            error[too-large]: 8589934592 triangles are more than the 67108864 allowed in object 6
              --> box.toml:27:9
               |
            27 | shape = "torus"
               |         ^^^^^^^

            error[degenerate]: `scale` of step 1 of `transform` of object 6 must not be 0: it would flatten
              --> box.toml:31:24
               |
            31 | transform = [{ scale = [1, 0, 1] }, { matrix = [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1] }, { translate = [1, 2, …
               |                        ^^^^^^^^^

            error[degenerate]: the matrix is singular: it would flatten in step 2 of `transform` of object 6
              --> box.toml:31:48
               |
            31 | …rm = [{ scale = [1, 0, 1] }, { matrix = [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1] }, { translate = [1, 2, 3], sca…
               |                                          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^

            error[conflict]: step 3 of `transform` of object 6 has several keys: their order would not count
              --> box.toml:31:125
               |
            31 | …0, 0, 0, 1] }, { translate = [1, 2, 3], scale = 2 }, { turn = 3 }, {}, { rotate = { axis = [0, 0, 0], degrees = 3 } }]
               |                                          ^^^^^
               = help: write [{ translate = … }, { scale = … }]

            error[unknown-key]: unknown key `turn` in step 4 of `transform` of object 6
              --> box.toml:31:140
               |
            31 | …{ translate = [1, 2, 3], scale = 2 }, { turn = 3 }, {}, { rotate = { axis = [0, 0, 0], degrees = 3 } }]
               |                                          ^^^^
               = help: it has the keys translate, rotate, scale, look_at, matrix

            error[missing-key]: step 5 of `transform` of object 6 is empty
              --> box.toml:31:152
               |
            31 | …= [1, 2, 3], scale = 2 }, { turn = 3 }, {}, { rotate = { axis = [0, 0, 0], degrees = 3 } }]
               |                                          ^^
               = help: a step is one of translate, rotate, scale, look_at, matrix

            error[degenerate]: `axis` of `rotate` of step 6 of `transform` of object 6 has no length
              --> box.toml:31:176
               |
            31 | …, { turn = 3 }, {}, { rotate = { axis = [0, 0, 0], degrees = 3 } }]
               |                                          ^^^^^^^^^

            12 errors
        "#]],
    );
}

#[test]
fn views_without_direction() {
    for (look_at, up) in [("[0, 1, 5]", "[0, 1, 0]"), ("[0, 9, 5]", "[0, -2, 0]"), ("[0, 1, 0]", "[0, 0, 0]")]
    {
        let text = format!(
            "lights = [{{ kind = \"environment\", radiance = 1 }}]\n[camera]\nposition = [0, 1, 5]\nlook_at = {look_at}\n\
             up = {up}\n[[objects]]\nshape = \"sphere\"\nmaterial = {{ kind = \"diffuse\" }}\n"
        );
        let loaded = parse(&text, Path::new("box.toml"), &[]);
        let codes: Vec<_> = loaded.diagnostics.iter().map(|d| d.code).collect();
        assert_eq!(codes, ["degenerate"], "{}", loaded.render());
    }
}

#[test]
fn nothing_at_all() {
    check(
        "",
        expect![[r#"
            error[no-camera]: the scene has no camera
             --> box.toml
              = help: add [camera] with `position` and `look_at`

            1 error
        "#]],
    );
}

#[test]
fn doubts_about_a_scene_that_can_be_rendered() {
    let text = "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n";
    assert!(parse(text, Path::new("box.toml"), &[]).desc.is_some());
    check(
        text,
        expect![[r#"
        warning[empty-scene]: the scene has no object
         --> box.toml
          = help: add [[objects]]

        warning[no-light]: nothing emits light: the picture will be black
         --> box.toml
          = help: add [[lights]], or give an object `radiance` or `power`

        2 warnings
    "#]],
    );
}

#[test]
fn wrong_brackets() {
    check(
        "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\n[objects]\nshape = \"sphere\"\n[[film]]\nsize = [1, 1]\n\
         [materials]\nkind = \"mirror\"\n[render]\npasses = 1\n",
        expect![[r#"
            error[wrong-type]: there may be several of objects; this is a table
             --> box.toml:4:1
              |
            4 | [objects]
              | ^^^^^^^^^
              = help: write [[objects]] with two brackets

            error[wrong-type]: [film] is written once and holds keys; this is an array
             --> box.toml:6:1
              |
            6 | [[film]]
              | ^^^^^^^^
              = help: write [film] on a line of its own

            error[wrong-type]: a material without a name
             --> box.toml:9:1
              |
            9 | kind = "mirror"
              | ^^^^
              = help: write [materials.NAME] above it

            3 errors
        "#]],
    );
}

#[test]
fn syntax_errors_and_what_stands_before() {
    check(
        "[camera]\nposition = [0, 1, 5]\nfob = 30\n[[lights]]\nkind = point\nkind = \"spot\"\n[x\n",
        expect![[r#"
            error[unknown-key]: unknown key `fob` in [camera]
             --> box.toml:3:1
              |
            3 | fob = 30
              | ^^^
              = help: did you mean `fov`?

            error[syntax]: string values must be quoted, expected literal string
             --> box.toml:5:8
              |
            5 | kind = point
              |        ^^^^^
              = help: write text between quotes, and 0.5 instead of .5

            error[syntax]: duplicate key
             --> box.toml:6:1
              |
            6 | kind = "spot"
              | ^^^^
              = help: each key and each table may be written once; rename or remove one

            error[syntax]: unclosed table, expected `]`
             --> box.toml:7:3
              |
            7 | [x
              |   ^

            4 errors
        "#]],
    );
}

#[test]
fn exclusive_keys() {
    check(
        "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n\
         [materials.a]\nkind = \"conductor\"\nmetal = \"gold\"\nk = 3\n\
         [materials.b]\nkind = \"phong\"\ndiffuse = 0.7\nspecular = 0.6\n\
         [[objects]]\nshape = \"sphere\"\nmaterial = \"a\"\ncolor = 0.5\n\
         [[objects]]\nshape = \"sphere\"\nradiance = 3\npower = 4\n\
         [[objects]]\nshape = \"quad\"\norigin = [0, 0, 0]\ncorners = []\nmaterial = \"a\"\n\
         [[lights]]\nkind = \"spot\"\nposition = [0, 1, 0]\ntarget = [0, 1, 0]\npower = 3\ncolor = 0\n\
         [[lights]]\nkind = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, 1, 0]\ntarget = [0, 0, 0]\nintensity = 3\n\
         [[lights]]\nkind = \"spot\"\nposition = [0, 1, 0]\ntarget = [0, 0, 0]\ncone_angle = 3\nfalloff_angle = 4\n\
         intensity = 1\n",
        expect![[r#"
            error[conflict]: `metal` and `k` exclude each other in material `a`
             --> box.toml:7:1
              |
            7 | k = 3
              | ^
             ::: box.toml:6:1
              |
            6 | metal = "gold"
              | ----- the other

            error[out-of-range]: material `b` reflects more light than it gets
             --> box.toml:8:12
              |
            8 | [materials.b]
              |            ^
              = help: `diffuse` and `specular` must add up to at most 1 in each channel

            error[conflict]: `color` without `power`, `lumens` or `nits` in object 1
              --> box.toml:15:1
               |
            15 | color = 0.5
               | ^^^^^
               = help: the colour of a surface belongs to its material

            error[conflict]: `radiance` and `power` exclude each other in object 2
              --> box.toml:19:1
               |
            19 | power = 4
               | ^^^^^
              ::: box.toml:18:1
               |
            18 | radiance = 3
               | -------- the other

            error[conflict]: `corners` and `origin` exclude each other in object 3
              --> box.toml:22:1
               |
            22 | origin = [0, 0, 0]
               | ^^^^^^
              ::: box.toml:23:1
               |
            23 | corners = []
               | ------- the other

            error[wrong-type]: `corners` of object 3 must be 4 points [x, y, z], not 0
              --> box.toml:23:11
               |
            23 | corners = []
               |           ^^

            error[degenerate]: the target of light 1 is its position
              --> box.toml:28:10
               |
            28 | target = [0, 1, 0]
               |          ^^^^^^^^^

            error[out-of-range]: `color` of light 1 is black: it cannot be scaled to an amount
              --> box.toml:30:9
               |
            30 | color = 0
               |         ^

            error[conflict]: `direction` and `target` exclude each other in light 2
              --> box.toml:35:1
               |
            35 | target = [0, 0, 0]
               | ^^^^^^
              ::: box.toml:34:1
               |
            34 | direction = [0, 1, 0]
               | --------- the other

            error[out-of-range]: `falloff_angle` of light 3 is greater than the cone's 3 degrees
              --> box.toml:42:17
               |
            42 | falloff_angle = 4
               |                 ^

            10 errors
        "#]],
    );
}

#[test]
fn overrides_point_at_themselves() {
    check_overrides(
        &[
            "photon_map.fotons=1000",
            "camera.fov=400",
            "materials.glas.ior=1.3",
            "materials.glass.ior=[1,2]",
            "objects.bal.radius=2",
            "objects.7.radius=2",
            "objects=3",
            "nothing",
            "a.b=",
            "render.integrator=pth",
            "render.passes=1.3.5",
            "rendr.passes=3",
            "objects.radius=3",
            "camera.fov.x=3",
            "film.size=[1,",
        ],
        expect![[r#"
            error[unknown-key]: unknown key `fotons` in [photon_map]
             --> --set:1:12
              |
            1 | photon_map.fotons=1000
              |            ^^^^^^
              = help: did you mean `photons`?

            error[out-of-range]: `fov` of [camera] must be a number > 0 and < 180, not 400
             --> --set:1:12
              |
            1 | camera.fov=400
              |            ^^^

            error[override]: there is no `glas` to set
             --> --set:1:11
              |
            1 | materials.glas.ior=1.3
              |           ^^^^
              = help: did you mean `glass`?

            error[wrong-type]: `ior` of material `glass` must be a number from 0.1 to 10 or a name, not an array
             --> --set:1:21
              |
            1 | materials.glass.ior=[1,2]
              |                     ^^^^^

            error[override]: none of `objects` is named `bal`
             --> --set:1:9
              |
            1 | objects.bal.radius=2
              |         ^^^
              = help: did you mean `ball`?

            error[override]: there is no `objects` 7: 1 are numbered from 0
             --> --set:1:9
              |
            1 | objects.7.radius=2
              |         ^

            error[override]: an override names a table and a key
             --> --set:1:1
              |
            1 | objects=3
              | ^^^^^^^^^
              = help: write PATH.KEY=VALUE, as in photon_map.photons=100000 or objects.lamp.power=40

            error[override]: `nothing` is no override
             --> --set:1:1
              |
            1 | nothing
              | ^^^^^^^
              = help: write PATH.KEY=VALUE, as in photon_map.photons=100000 or objects.lamp.power=40

            error[override]: no value
             --> --set:1:4
              |
            1 | a.b=
              |    ^
              = help: write "" for an empty string

            error[unknown-kind]: `integrator` of [render] knows no `pth`
             --> --set:1:19
              |
            1 | render.integrator=pth
              |                   ^^^
              = help: did you mean "path"? There are "auto", "path", "photon_map", "sppm", "vcm"

            error[override]: invalid float
             --> --set:1:18
              |
            1 | render.passes=1.3.5
              |                  ^^
              = help: quote text that is not a plain word

            error[override]: there is no `rendr` to set
             --> --set:1:1
              |
            1 | rendr.passes=3
              | ^^^^^
              = help: did you mean `render`?

            error[override]: `objects` is a list
             --> --set:1:1
              |
            1 | objects.radius=3
              | ^^^^^^^
              = help: write objects.NAME.KEY=VALUE, or a number from 0 for NAME

            error[override]: `fov` is an integer and has no keys
             --> --set:1:8
              |
            1 | camera.fov.x=3
              |        ^^^

            error[override]: unclosed array, expected `]`
             --> --set:1:14
              |
            1 | film.size=[1,
              |              ^
              = help: quote text that is not a plain word

            15 errors
        "#]],
    );
}

#[test]
fn overrides_apply() {
    let text = format!(
        "{BASE}[materials.\"a b\"]\nkind = \"diffuse\"\n[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n\
         material = {{ kind = \"mirror\" }}\n"
    );
    let overrides = [
        "photon_map.photons = 1e5",
        "render.integrator=path",
        "camera.fov=33",
        "camera.position=[1, 2, 3]",
        "objects.ball.radius=2",
        "objects.0.center=[0, 2, 0]",
        "objects.ball.material.color=#ff0000",
        "objects.ball.material={ kind = \"diffuse\", color = 0.25 }",
        "materials.\"a b\".color=0.125",
        "materials.new={ kind = \"mirror\" }",
        "render.max_depth=7",
        "render.max_depth=none",
        "lights.0.power=12",
    ];
    let overrides = overrides.map(str::to_owned);
    let loaded = parse(&text, Path::new("box.toml"), &overrides);
    let desc = loaded.desc.clone().unwrap_or_else(|| panic!("{}", loaded.render()));
    assert_eq!(desc.photon_map.photons, 100_000);
    assert_eq!(desc.render.integrator, nephroid_scenefile::desc::IntegratorKind::Path);
    assert_eq!(desc.render.max_depth, None);
    let camera = desc.camera.unwrap();
    assert_eq!((camera.fov, camera.position), (33.0, [1.0, 2.0, 3.0]));
    assert_eq!(
        desc.objects[0].shape.value,
        nephroid_scenefile::desc::Shape::Sphere { center: [0.0, 2.0, 0.0], radius: 2.0 }
    );
    use nephroid_scenefile::desc::Material;
    assert_eq!(desc.objects[0].material, Some(Material::diffuse(0.25).into()));
    assert_eq!(desc.materials["a b"].value, Material::diffuse(0.125));
    assert_eq!(desc.materials["new"].value, Material::mirror(1.0));
}

#[test]
fn files_that_are_no_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str, bytes: Option<&[u8]>, expected: Expect| {
        let path = folder.path().join(name);
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        let text = load(&path, &[]).render().replace(&folder.path().display().to_string(), "FOLDER");
        expected.assert_eq(&text);
    };
    check(
        "absent.toml",
        None,
        expect![[r#"
        error[file]: the scene FOLDER/absent.toml is not there
         --> FOLDER/absent.toml

        1 error
    "#]],
    );
    check(
        "",
        None,
        expect![[r#"
        error[file]: the scene FOLDER/ is a folder
         --> FOLDER/
          = help: name the scene file in it

        1 error
    "#]],
    );
    check(
        "latin1.toml",
        Some(b"# Stra\xdfe\n"),
        expect![[r#"
        error[file]: the scene FOLDER/latin1.toml is not UTF-8 text: byte 6, in line 1, is wrong
         --> FOLDER/latin1.toml

        1 error
    "#]],
    );
    check(
        "utf16.toml",
        Some(b"\xff\xfea\x00"),
        expect![[r#"
        error[file]: the scene FOLDER/utf16.toml is not UTF-8 text: byte 0, in line 1, is wrong
         --> FOLDER/utf16.toml
          = help: it seems to be UTF-16: save it as UTF-8

        1 error
    "#]],
    );
    check(
        "zero.toml",
        Some(b"a = 1\0"),
        expect![[r#"
        error[syntax]: string values must be quoted, expected literal string
         --> FOLDER/zero.toml:1:5
          |
        1 | a = 1�
          |     ^^
          = help: write text between quotes, and 0.5 instead of .5

        1 error
    "#]],
    );
    check(
        "huge.toml",
        Some(&vec![b'\n'; (12 << 20) + 1]),
        expect![[r#"
        error[file]: the scene FOLDER/huge.toml is larger than 12 MiB
         --> FOLDER/huge.toml
          = help: put large meshes into PLY or OBJ files and name these

        1 error
    "#]],
    );
}

#[test]
fn byte_order_mark_and_crlf_are_no_mistakes() {
    let text = "\u{feff}[camera]\r\nposition = [0, 1, 5]\r\nlook_at = [0, 0, 0]\r\nfoV = 3\r\n";
    check(
        text,
        expect![[r#"
            error[unknown-key]: unknown key `foV` in [camera]
             --> box.toml:4:1
              |
            4 | foV = 3
              | ^^^
              = help: did you mean `fov`?

            1 error
        "#]],
    );
}

#[test]
fn files_are_looked_for_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scenes")).unwrap();
    std::fs::write(folder.path().join("cow.PLY"), "").unwrap();
    let path = folder.path().join("scenes/cow.toml");
    std::fs::write(
        &path,
        format!(
            "{BASE}[[objects]]\nshape = \"mesh\"\nfile = \"../cow.PLY\"\nmaterial = {{ kind = \"mirror\" }}\n"
        ),
    )
    .unwrap();
    let loaded = load(&path, &[]);
    let desc = loaded.desc.clone().unwrap_or_else(|| panic!("{}", loaded.render()));
    assert_eq!(desc.base, folder.path().join("scenes"));
    assert!(desc.resolve(Path::new("../cow.PLY")).is_file());
}

#[test]
fn colours_in_every_spelling() {
    let loaded = parse(
        &format!(
            "{BASE}[materials.a]\nkind = \"diffuse\"\ncolor = \"#ff8000\"\n[materials.b]\nkind = \"diffuse\"\ncolor = \"#f80\"\n\
             [materials.c]\nkind = \"diffuse\"\ncolor = 1\n"
        ),
        Path::new("box.toml"),
        &[],
    );
    use nephroid_scenefile::desc::{ColorDesc, MaterialKind};
    let color = |name: &str| match &loaded.desc.as_ref().unwrap().materials[name].kind {
        MaterialKind::Diffuse { color: ColorDesc::Rgb(rgb) } => *rgb,
        other => panic!("{other:?}"),
    };
    // IEC 61966-2-1: byte 128 is 0.215861, byte 136 is 0.246201.
    assert_eq!(color("a")[0], 1.0);
    assert!((color("a")[1] - 0.215_861).abs() < 1e-6);
    assert!((color("b")[1] - 0.246_201).abs() < 1e-6);
    assert_eq!(color("c"), [1.0; 3]);
}
