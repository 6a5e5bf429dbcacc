//! What pbrt scenes become. Expected values follow from the format's pages and are worked out beside each.
#![allow(clippy::unwrap_used, reason = "helpers of tests, too")]

use std::io::Write;
use std::path::Path;

mod cameras;
mod lights;
mod materials;
mod pictures;
mod settings;
mod surfaces;

use nephroid_import::{load, strict};
use scenefile::desc::{
    CameraKind, Channel, ColorDesc, ColorSpace, EmissionAmount, FloatDesc, FovAxis, IntegratorKind,
    LightKind, Mapping, MaterialKind, MaterialRef, Metal, NoiseKind, Object, PointAmount, Roughness,
    SceneDesc, Shape, Texture, TextureFilter, TransformStep, Wrap,
};
use scenefile::{Loaded, Severity};

/// A camera that swaps no hands, so that nothing is mirrored.
const HEAD: &str = "Scale -1 1 1\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n";
const TRIANGLE: &str = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

fn read_in(folder: &Path, text: &str) -> Loaded {
    let path = folder.join("scene.pbrt");
    std::fs::write(&path, text).unwrap();
    load(&path, &[])
}

fn read(text: &str) -> Loaded {
    read_in(tempfile::tempdir().unwrap().path(), text)
}

/// The description of a text that gives no diagnostic.
fn desc(text: &str) -> SceneDesc {
    let loaded = read(text);
    assert!(loaded.diagnostics.is_empty(), "{}", loaded.render());
    loaded.desc.unwrap()
}

/// With the head before it.
fn world(text: &str) -> SceneDesc {
    desc(&format!("{HEAD}{text}"))
}

/// A description and the messages of its warnings.
fn warned(text: &str) -> (SceneDesc, Vec<String>) {
    let loaded = read(&format!("{HEAD}{text}"));
    assert!(loaded.diagnostics.iter().all(|d| d.severity == Severity::Warning), "{}", loaded.render());
    assert!(loaded.diagnostics.iter().all(|d| !d.labels.is_empty()), "each has a place");
    (loaded.desc.unwrap(), loaded.diagnostics.into_iter().map(|d| d.message).collect())
}

fn close(a: impl IntoIterator<Item = f32>, b: impl IntoIterator<Item = f32>) {
    let (a, b): (Vec<_>, Vec<_>) = (a.into_iter().collect(), b.into_iter().collect());
    let near = |(x, y): (&f32, &f32)| (x - y).abs() <= 1e-5 * (1.0 + y.abs());
    assert!(a.len() == b.len() && a.iter().zip(&b).all(near), "{a:?} {b:?}");
}

fn matrix(object: &Object) -> [f32; 16] {
    match object.transform[..] {
        [] => std::array::from_fn(|i| if i % 5 == 0 { 1.0 } else { 0.0 }),
        [TransformStep::Matrix(m)] => m,
        _ => panic!("{:?}", object.transform),
    }
}

fn kind<'a>(desc: &'a SceneDesc, object: &Object) -> &'a MaterialKind {
    match &object.material {
        Some(MaterialRef::Named(name)) => &desc.materials[&name.value].kind,
        other => panic!("{other:?}"),
    }
}

fn material(text: &str) -> MaterialKind {
    let desc = world(&format!("{text}\n{TRIANGLE}"));
    kind(&desc, &desc.objects[0]).clone()
}
