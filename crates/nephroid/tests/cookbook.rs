//! The scenes of the cookbook: each loads without a warning and makes a picture with light in it.

#![allow(clippy::unwrap_used)] // a test

use std::path::Path;

use nephroid::{Control, Job, Layer, Session, compile, load};

const LONGER_SIDE: u32 = 48;
const PASSES: u64 = 2;

#[test]
fn every_recipe_makes_a_picture() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cookbook");
    let mut recipes = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            check(&path);
            recipes += 1;
        }
    }
    assert_eq!(recipes, 9, "recipes that are scene files");
}

fn check(path: &Path) {
    let name = path.display();
    let loaded = load(path, &[]);
    assert!(loaded.diagnostics.is_empty(), "{name}: {:?}", loaded.diagnostics);
    let mut desc = loaded.desc.unwrap();
    let longer = desc.film.size.into_iter().max().unwrap();
    assert!(longer >= 1000, "{name}: the picture of a recipe has 1000 pixels or more");
    desc.film.size = desc.film.size.map(|side| (side * LONGER_SIDE / longer).max(1));
    let compiled = compile(&desc, 2).unwrap();
    // Under water the camera is in the water on purpose.
    let expected: &[&str] = if path.ends_with("underwater.toml") { &["camera-inside"] } else { &[] };
    let codes: Vec<_> = compiled.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, expected, "{name}: {:?}", compiled.warnings);
    let job = Job { passes: 0..PASSES, ..Job::new(&desc, compiled.scene).unwrap() };
    let mut session = Session::new(job, 2).unwrap();
    session.run(&mut |_| Control::Continue).unwrap();
    let film = session.into_film();
    let sum = |layer| film.layer(layer).iter().map(|&v| f64::from(v)).sum::<f64>();
    let [beauty, caustic] = [Layer::Beauty, Layer::Caustic].map(sum);
    assert!(
        beauty.is_finite() && caustic > 0.0 && beauty >= caustic,
        "{name}: {caustic} of {beauty} is caustic"
    );
}
