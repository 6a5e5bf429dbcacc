//! What each fuzz target does with its bytes, and where fuzzing begins.
//!
//! Inputs are small (`run` bounds them), and files are read from a folder of the process alone: an input that could name a file
//! elsewhere is left out.

pub mod seeds;

use std::path::Path;

use film::{FilmHead, SectionReader, SectionWriter};
use scenefile::{Loaded, SceneDesc};

thread_local! {
    static FOLDER: tempfile::TempDir = {
        let folder = tempfile::tempdir().expect("a folder for files");
        seeds::neighbours(folder.path());
        folder
    };
}

/// Does something with a file of these bytes, beside a few others.
fn with_file(name: &str, data: &[u8], then: impl FnOnce(&Path)) {
    FOLDER.with(|folder| {
        let path = folder.path().join(name);
        std::fs::write(&path, data).expect("a file in the folder");
        then(&path);
    });
}

/// Whether a text might name a file outside of its folder: by `..`, by a slash where a name begins, or in letters that stand for
/// either. A slash before `>` ends an element of XML.
fn leads_out(data: &[u8]) -> bool {
    let begins = |w: &[u8]| matches!(w, [b'"' | b'\'' | b' ' | b'\t', b'/', last] if *last != b'>');
    data.windows(3).any(begins) || data.windows(2).any(|w| w == b".." || w == b"\\u" || w == b"&#")
}

/// What is read well is written as TOML that reads the same.
fn survives_toml(desc: &SceneDesc) {
    let text = scenefile::to_toml(desc);
    let again = scenefile::parse(&text, &desc.base.join("a.toml"), &[]);
    assert!(again.desc.is_some(), "{}\n{text}", again.render());
    assert!(again.desc.as_ref() == Some(desc), "another description:\n{text}");
}

fn scene(name: &str, data: &[u8]) {
    if leads_out(data) {
        return;
    }
    with_file(name, data, |path| {
        let loaded: Loaded = import::load(path, &[]);
        let _ = loaded.render();
        if let Some(mut desc) = loaded.desc {
            // Large meshes and embedded pictures become files.
            let written = import::outsource(&mut desc, &path.with_extension("toml"));
            written.expect("files in the folder");
            survives_toml(&desc);
        }
    });
}

/// A scene file of Nephroid's own.
pub fn toml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if leads_out(data) {
        return;
    }
    FOLDER.with(|folder| {
        let loaded = scenefile::parse(text, &folder.path().join("a.toml"), &[]);
        let _ = loaded.render();
        if let Some(desc) = loaded.desc {
            survives_toml(&desc);
        }
    });
}

/// A small scene file, compiled: what shapes, textures and displacement make of values that pass the reader.
pub fn compile(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    // Counts of four digits make meshes that take longer than an input may.
    let long = data.windows(4).any(|w| w.iter().all(u8::is_ascii_digit));
    if leads_out(data) || long {
        return;
    }
    FOLDER.with(|folder| {
        let Some(desc) = scenefile::parse(text, &folder.path().join("a.toml"), &[]).desc else { return };
        let groups = desc.groups.values().flat_map(|group| &group.objects);
        if desc.objects.iter().chain(groups).all(|object| is_cut_coarsely(object)) {
            let workers = par::Workers::new(1).expect("a thread");
            let _ = workers.run(|| scene::compile(&desc));
        }
    });
}

/// Whether displacement makes few triangles of an object.
fn is_cut_coarsely(object: &scenefile::desc::Object) -> bool {
    use scenefile::desc::{EdgeLength, Shape};
    let Some(displacement) = &object.displacement else { return true };
    let small = match &object.shape.value {
        Shape::Sphere { radius, .. } => *radius < 2.0,
        Shape::Box { min, max } => min.iter().chain(max).all(|x| x.abs() < 2.0),
        _ => false,
    };
    // A sphere begins with 65 536 triangles.
    small && object.transform.is_empty() && matches!(displacement.edge, EdgeLength::Units(edge) if edge > 0.02)
}

/// A pbrt scene.
pub fn pbrt(data: &[u8]) {
    scene("scene.pbrt", data);
}

/// A Mitsuba scene.
pub fn mitsuba(data: &[u8]) {
    scene("scene.xml", data);
}

/// A mesh in Mitsuba's own format.
pub fn serialized(data: &[u8]) {
    with_file("mesh.serialized", data, |path| {
        let text = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"serialized\">\
                    <string name=\"filename\" value=\"mesh.serialized\"/></shape></scene>";
        let scene = path.with_file_name("serialized.xml");
        std::fs::write(&scene, text).expect("a file in the folder");
        let _ = import::load(&scene, &[]).render();
    });
}

/// A mesh as a scene, with its materials.
pub fn model(data: &[u8]) {
    scene("scene.obj", data);
}

/// Materials of a mesh.
pub fn mtl(data: &[u8]) {
    if leads_out(data) {
        return;
    }
    with_file("a.mtl", data, |path| {
        let _ = import::load(&path.with_file_name("a.obj"), &[]).render();
    });
}

/// Light by direction: IES or EULUMDAT.
pub fn photometry(data: &[u8]) {
    let _ = photometry::read(data);
}

/// glTF as text.
pub fn gltf(data: &[u8]) {
    scene("scene.gltf", data);
}

/// glTF in one binary file.
pub fn glb(data: &[u8]) {
    scene("scene.glb", data);
}

/// A mesh in text.
pub fn obj(data: &[u8]) {
    if let Ok(mesh) = mesh::obj::parse(data) {
        mesh.validate().expect("a mesh that was read is valid");
    }
}

/// A mesh in text or binary.
pub fn ply(data: &[u8]) {
    if let Ok(mesh) = mesh::ply::parse(data) {
        mesh.validate().expect("a mesh that was read is valid");
    }
}

/// Loose triangles in text or binary.
pub fn stl(data: &[u8]) {
    if let Ok(mesh) = mesh::stl::parse(data) {
        mesh.validate().expect("a mesh that was read is valid");
    }
}

/// A texture.
pub fn image(data: &[u8]) {
    use scene::texture::{Encoding, ImageTexture};
    let _ = ImageTexture::from_bytes(data, Encoding::Srgb);
}

/// A spectrum in a file.
pub fn spd(data: &[u8]) {
    with_file("lamp.spd", data, |path| {
        let text = b"Camera \"perspective\"\nWorldBegin\nLightSource \"point\" \"spectrum I\" \"lamp.spd\"\nShape \"sphere\"\n";
        let scene = path.with_file_name("lamp.pbrt");
        std::fs::write(&scene, text).expect("a file in the folder");
        let _ = import::load(&scene, &[]).render();
    });
}

/// Sections with right checksums: in the input each is a tag, a length (u32, little-endian) and its bytes.
fn sections(data: &[u8]) -> Option<Vec<u8>> {
    let mut out = SectionWriter::new(Vec::new());
    let mut rest = data;
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let (tag, length) = head.split_first_chunk::<4>()?;
        let length = u32::from_le_bytes(length.try_into().ok()?) as usize;
        let (bytes, after) = after.split_at(length.min(after.len()));
        out.write(*tag, bytes).ok()?;
        rest = after;
    }
    out.finish().ok()
}

/// A film, its sections intact.
pub fn film(data: &[u8]) {
    let Some(bytes) = sections(data) else { return };
    let mut input = SectionReader::new(&bytes[..]);
    if let Ok(film) = FilmHead::read(&mut input).and_then(|head| head.read_pixels(&mut input)) {
        let _ = (film.beauty(), film.passes());
    }
}

/// A checkpoint: its first half as it comes, or its sections intact.
pub fn checkpoint(data: &[u8]) {
    let Some((first, rest)) = data.split_first() else { return };
    let bytes = match (first % 2, rest.split_first_chunk::<12>()) {
        (0, Some((head, rest))) => match sections(rest) {
            Some(sections) => [head, &sections[..]].concat(),
            None => return,
        },
        _ => rest.to_vec(),
    };
    with_file("a.ckpt", &bytes, |path| {
        if let Ok(checkpoint) = session::Checkpoint::read(path) {
            let _ = checkpoint.film.beauty();
        }
    });
}
