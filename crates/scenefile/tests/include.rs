//! Scenes of several files.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;

use nephroid_scenefile::desc::{ImageSource, Texture};
use nephroid_scenefile::{Loaded, load, parse, to_toml};

const SCENE: &str = "include = [\"lib/materials.toml\", \"lights.toml\"]\n[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n[[objects]]\nname = \"ball\"\nshape = \"sphere\"\nmaterial = \"wood\"\n";
const MATERIALS: &str = "include = \"../textures/all.toml\"\n[materials.wood]\nkind = \"diffuse\"\ncolor = { texture = \"planks\" }\n[[objects]]\nname = \"floor\"\nshape = \"disk\"\nradius = 9\nmaterial = \"wood\"\n";
const TEXTURES: &str = "[textures.planks]\nkind = \"image\"\nfile = \"planks.png\"\n";
const LIGHTS: &str =
    "[[lights]]\nkind = \"point\"\nposition = [0, 9, 0]\npower = 3\n[film]\nsize = [30, 20]\n";

/// A folder of files by their names.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn whole() -> tempfile::TempDir {
    folder(&[
        ("scene.toml", SCENE),
        ("lib/materials.toml", MATERIALS),
        ("textures/all.toml", TEXTURES),
        ("textures/planks.png", ""),
        ("lights.toml", LIGHTS),
    ])
}

fn read(folder: &Path, overrides: &[&str]) -> Loaded {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    load(&folder.join("scene.toml"), &overrides)
}

#[test]
fn the_parts_make_one_scene() {
    let folder = whole();
    let loaded =
        read(folder.path(), &["materials.wood.color=0.25", "objects.floor.radius=3", "objects.0.radius=2"]);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    let names = |loaded: &Loaded| {
        loaded.desc.as_ref().unwrap().objects.iter().map(|o| o.name.clone().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(names(&loaded), ["ball", "floor"]);
    let plain = read(folder.path(), &[]);
    let desc = plain.desc.unwrap();
    assert_eq!((desc.film.size, desc.lights.len()), ([30, 20], 1));
    let Texture::Image(image) = &desc.textures["planks"].value else { panic!() };
    let ImageSource::File(file) = &image.source else { panic!() };
    assert!(desc.resolve(file).is_file(), "{file:?}");
    // One flat file says the same.
    let flat = to_toml(&desc);
    assert!(!flat.contains("include"), "{flat}");
    assert_eq!(parse(&flat, &folder.path().join("flat.toml"), &[]).desc.as_ref(), Some(&desc));
}

#[test]
fn mistakes_point_into_their_file() {
    let folder = whole();
    std::fs::write(folder.path().join("lights.toml"), LIGHTS.replace("power = 3", "power = -3")).unwrap();
    let said = read(folder.path(), &[]).render();
    assert!(said.contains("lights.toml:4:9") && said.contains("out-of-range"), "{said}");
    std::fs::write(folder.path().join("lights.toml"), "[[lights]\n").unwrap();
    let said = read(folder.path(), &[]).render();
    assert!(said.contains("lights.toml:1") && said.contains("syntax") && said.contains("1 error"), "{said}");
    std::fs::remove_file(folder.path().join("lights.toml")).unwrap();
    let said = read(folder.path(), &[]).render();
    assert!(said.contains("scene.toml:1:34") && said.contains("is not there"), "{said}");
    std::fs::remove_file(folder.path().join("textures/planks.png")).unwrap();
    std::fs::write(folder.path().join("lights.toml"), LIGHTS).unwrap();
    let said = read(folder.path(), &[]).render();
    assert!(said.contains("all.toml:3:8") && said.contains("missing-file"), "{said}");
}

#[test]
fn what_is_given_twice_is_told_with_both_places() {
    for (more, name) in [
        ("[materials.wood]\nkind = \"mirror\"\n", "`wood`"),
        ("[film]\nsize = [3, 3]\n", "`size`"),
        ("[[lights]]\nkind = \"point\"\npower = 1\n[camera]\nposition = [1, 1, 1]\n", "`position`"),
        ("[objects]\nx = 1\n", "`objects`"),
    ] {
        let folder = whole();
        std::fs::write(folder.path().join("more.toml"), more).unwrap();
        let scene = SCENE.replace("\"lights.toml\"", "\"lights.toml\", \"more.toml\"");
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        let said = read(folder.path(), &[]).render();
        assert!(said.contains(&format!("{name} is given in two files")), "{said}");
        assert!(said.contains("--> ") && said.contains("more.toml:") && said.contains("the other"), "{said}");
    }
    // Names of objects are looked at as in one file.
    let folder = whole();
    std::fs::write(folder.path().join("scene.toml"), SCENE.replace("\"ball\"", "\"floor\"")).unwrap();
    assert!(read(folder.path(), &[]).render().contains("duplicate-name"));
}

#[test]
fn circles_towers_and_crowds_end() {
    let circle =
        folder(&[("scene.toml", "include = [\"a.toml\"]"), ("a.toml", "include = [\"./scene.toml\"]")]);
    let said = read(circle.path(), &[]).render();
    assert!(said.contains("`./scene.toml` includes itself") && said.contains("a.toml:1:12"), "{said}");

    let tower = folder(&[("scene.toml", "include = [\"0.toml\"]")]);
    for i in 0..40 {
        let text = format!("include = [\"{}.toml\"]", i + 1);
        std::fs::write(tower.path().join(format!("{i}.toml")), text).unwrap();
    }
    assert!(read(tower.path(), &[]).render().contains("one file too many"));

    let crowd = tempfile::tempdir().unwrap();
    let names: Vec<String> = (0..300).map(|i| format!("\"{i}.toml\"")).collect();
    std::fs::write(crowd.path().join("scene.toml"), format!("include = [{}]", names.join(", "))).unwrap();
    for i in 0..300 {
        std::fs::write(crowd.path().join(format!("{i}.toml")), "").unwrap();
    }
    assert!(read(crowd.path(), &[]).render().contains("one file too many"));

    // Twice the same file, on two ways, is there once.
    let diamond = whole();
    std::fs::write(
        diamond.path().join("lights.toml"),
        format!("include = [\"lib/materials.toml\"]\n{LIGHTS}"),
    )
    .unwrap();
    let loaded = read(diamond.path(), &[]);
    assert_eq!(loaded.desc.unwrap().objects.len(), 2);
}

#[test]
fn what_is_no_file_is_refused() {
    for (include, part) in [
        ("3", "must be a list of file names"),
        ("[1, {}]", "must be a list of file names"),
        ("[\"\"]", "only .toml can be included"),
        ("[\"a.gltf\"]", "`nephroid convert` makes a .toml"),
        ("[\".\"]", "only .toml can be included"),
        ("[\"folder.toml\"]", "is a folder"),
        ("[\"none.toml\"]", "is not there"),
        ("[\"binary.toml\"]", "is not UTF-8"),
        ("[\"/dev/zero\"]", "only .toml can be included"),
    ] {
        let folder = folder(&[("scene.toml", &format!("include = {include}\n")), ("folder.toml/x", "")]);
        std::fs::write(folder.path().join("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
        let said = read(folder.path(), &[]).render();
        assert!(said.contains(part), "{include}: {said}");
    }
    let said = parse("includes = [\"a\"]\n", Path::new("scene.toml"), &[]).render();
    assert!(said.contains("did you mean `include`?"), "{said}");
}
