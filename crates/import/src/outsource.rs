//! A description that can be written as TOML elsewhere: large meshes and embedded pictures in files of their own, file names
//! that lead there.

use std::fmt;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use scenefile::desc::{
    EmbeddedImage, Image, ImageSource, LightKind, Normals, Object, SceneDesc, Shape, Texture, Triple,
};

/// Triangles of a mesh that stays in the text.
const FEW: usize = 64;

/// A file that cannot be written.
#[derive(Debug)]
pub struct OutsourceError {
    /// The file or folder.
    pub path: PathBuf,
    /// Why.
    pub error: io::Error,
}

impl fmt::Display for OutsourceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} cannot be written: {}", self.path.display(), self.error)
    }
}

impl std::error::Error for OutsourceError {}

/// Prepares `desc` for being written to `scene`: meshes in place of more than 64 triangles become binary PLY files in a
/// folder beside it, named after it, embedded pictures become files in another, and names of other files are changed
/// to lead to the same files from there. Files of the same names are replaced. Returns the files written.
///
/// # Errors
/// Where folder or files cannot be written; `desc` has changed in part then.
pub fn outsource(desc: &mut SceneDesc, scene: &Path) -> Result<Vec<PathBuf>, OutsourceError> {
    let to = scene.parent().unwrap_or(Path::new("")).to_path_buf();
    rebase(desc, &to);
    let mut written = Vec::new();
    pictures(desc, &to, &beside(scene, "-images"), &mut written)?;
    let folder = beside(scene, "-meshes");
    let mut meshes = 0;
    let groups = desc.groups.values_mut().flat_map(|group| &mut group.value.objects);
    for object in desc.objects.iter_mut().chain(groups) {
        let Some(bytes) = ply_of(object) else { continue };
        meshes += 1;
        let file = folder.join(format!("{meshes:05}.ply"));
        written.push(write(&to, &file, &bytes)?);
        let Shape::Triangles { normals, .. } = object.shape.value else { continue };
        object.value.shape.value = Shape::Mesh { file: file.into(), normals };
    }
    Ok(written)
}

/// The folder beside a scene that is named after it.
fn beside(scene: &Path, what: &str) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("scene".as_ref()).to_os_string();
    name.push(what);
    PathBuf::from(name)
}

/// Writes a file of a folder that is made if need be, both relative to `to`.
fn write(to: &Path, file: &Path, bytes: &[u8]) -> Result<PathBuf, OutsourceError> {
    let path = to.join(file);
    let wrong = |error| OutsourceError { path: path.clone(), error };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(wrong)?;
    }
    std::fs::write(&path, bytes).map_err(wrong)?;
    Ok(path)
}

/// Every picture that textures and lights name.
fn sources(desc: &mut SceneDesc) -> impl Iterator<Item = &mut ImageSource> {
    let textures = desc.textures.values_mut().filter_map(|texture| match &mut texture.value {
        Texture::Image(Image { source, .. }) => Some(source),
        _ => None,
    });
    let lights = desc.lights.iter_mut().filter_map(|light| match &mut light.value.kind {
        LightKind::Sky { source, .. }
        | LightKind::Goniometric { source, .. }
        | LightKind::Projector { source, .. } => Some(source),
        _ => None,
    });
    textures.chain(lights)
}

/// Embedded pictures become files, each of them once.
fn pictures(
    desc: &mut SceneDesc,
    to: &Path,
    folder: &Path,
    written: &mut Vec<PathBuf>,
) -> Result<(), OutsourceError> {
    let mut known: Vec<(Arc<[u8]>, PathBuf)> = Vec::new();
    for source in sources(desc) {
        let ImageSource::Embedded(image) = source else { continue };
        let file = match known.iter().find(|(bytes, _)| Arc::ptr_eq(bytes, &image.bytes)) {
            Some((_, file)) => file.clone(),
            None => {
                let file = folder.join(file_name(image, known.len() + 1));
                written.push(write(to, &file, &image.bytes)?);
                known.push((image.bytes.clone(), file.clone()));
                file
            }
        };
        *source = ImageSource::File(file.into());
    }
    Ok(())
}

/// A name that is safe on any system and unique by its number; its extension is that of the content, where that is known.
fn file_name(image: &EmbeddedImage, number: usize) -> String {
    let name = Path::new(&image.name);
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let text = |part: Option<&std::ffi::OsStr>| -> String {
        part.unwrap_or_default().to_string_lossy().chars().take(60).map(safe).collect()
    };
    let b = &image.bytes[..];
    let extension = match b {
        [0x89, b'P', b'N', b'G', ..] => "png".to_owned(),
        [0xff, 0xd8, ..] => "jpg".to_owned(),
        [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "tif".to_owned(),
        [0x76, 0x2f, 0x31, 0x01, ..] => "exr".to_owned(),
        [b'#', b'?', ..] => "hdr".to_owned(),
        [b'R', b'I', b'F', b'F', ..] => "webp".to_owned(),
        _ => text(name.extension()),
    };
    format!("{number:03}-{}.{extension}", text(name.file_stem()))
}

/// The PLY file of a large mesh in place.
fn ply_of(object: &Object) -> Option<Vec<u8>> {
    match &object.shape.value {
        Shape::Triangles { positions, indices, vertex_normals, uvs, uvs2, colors, normals }
            if indices.len() > FEW =>
        {
            // Where normals are made anew those given do not matter.
            let kept = matches!(normals, Normals::Given | Normals::Completed);
            let given = if kept { &vertex_normals[..] } else { &[] };
            Some(ply(&Vertices { positions, normals: given, uvs, uvs2, colors }, indices))
        }
        _ => None,
    }
}

/// What vertices have; all but the positions may be empty.
struct Vertices<'a> {
    positions: &'a [Triple],
    normals: &'a [Triple],
    uvs: &'a [[f32; 2]],
    uvs2: &'a [[f32; 2]],
    colors: &'a [[f32; 4]],
}

/// Binary little-endian PLY (Turk 1994).
fn ply(vertices: &Vertices<'_>, indices: &[[u32; 3]]) -> Vec<u8> {
    let &Vertices { positions, normals, uvs, uvs2, colors } = vertices;
    let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", positions.len());
    let mut property = |names: &[&str]| {
        for name in names {
            header += &format!("property float {name}\n");
        }
    };
    property(&["x", "y", "z"]);
    if !normals.is_empty() {
        property(&["nx", "ny", "nz"]);
    }
    if !uvs.is_empty() {
        property(&["u", "v"]);
    }
    if !uvs2.is_empty() {
        property(&["u2", "v2"]);
    }
    if !colors.is_empty() {
        property(&["red", "green", "blue", "alpha"]);
    }
    header +=
        &format!("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", indices.len());
    let mut bytes = header.into_bytes();
    let mut put = |values: &[f32]| values.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    for (i, p) in positions.iter().enumerate() {
        put(p);
        if let Some(n) = normals.get(i) {
            // As a scene normalises those in place: both give the same picture.
            put(&math::Vec3::from(*n).normalize_or_zero().to_array());
        }
        if let Some(uv) = uvs.get(i) {
            put(uv);
        }
        if let Some(uv2) = uvs2.get(i) {
            put(uv2);
        }
        if let Some(color) = colors.get(i) {
            put(color);
        }
    }
    for t in indices {
        bytes.push(3);
        t.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    bytes
}

/// Changes the folder that file names start from.
fn rebase(desc: &mut SceneDesc, to: &Path) {
    let from = std::mem::replace(&mut desc.base, to.to_path_buf());
    let whole = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
    };
    let [old, new] = [&from, to].map(whole);
    if old == new {
        return;
    }
    let moved = |file: &mut PathBuf| {
        if file.is_relative() {
            *file = relative(&old.join(&*file), &new);
        }
    };
    for source in sources(desc) {
        if let ImageSource::File(file) = source {
            moved(&mut file.value);
        }
    }
    for light in &mut desc.lights {
        if let LightKind::Profile { file, .. } = &mut light.value.kind {
            moved(&mut file.value);
        }
    }
    let groups = desc.groups.values_mut().flat_map(|group| &mut group.value.objects);
    for object in desc.objects.iter_mut().chain(groups) {
        if let Some(file) = object.value.shape.value.file_mut() {
            moved(&mut file.value);
        }
    }
}

/// The way from a folder to a file.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let parts = |path: &Path| path.components().map(|c| c.as_os_str().to_os_string()).collect::<Vec<_>>();
    let (to, from) = (parts(file), parts(folder));
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    // Nothing in common, not even the root: no way.
    if common == 0 {
        return file.to_path_buf();
    }
    let up = from[common..].iter().map(|_| Component::ParentDir.as_os_str().to_os_string());
    up.chain(to[common..].iter().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways() {
        let way = |file: &str, folder: &str| relative(Path::new(file), Path::new(folder));
        assert_eq!(way("/a/b/c.ply", "/a/b"), Path::new("c.ply"));
        assert_eq!(way("/a/b/c.ply", "/a/x/y"), Path::new("../../b/c.ply"));
    }

    #[test]
    fn a_mesh_survives_its_file() {
        let positions: Vec<Triple> = (0..70).map(|i| [i as f32, (i * i % 7) as f32, 0.5]).collect();
        let normals: Vec<Triple> = (0..70).map(|i| [0.1 * i as f32, 1.0, 0.3]).collect();
        let uvs: Vec<[f32; 2]> = (0..70).map(|i| [i as f32 / 70.0, 0.25]).collect();
        let uvs2: Vec<[f32; 2]> = (0..70).map(|i| [0.5, i as f32]).collect();
        let colors: Vec<[f32; 4]> = (0..70).map(|i| [i as f32 / 70.0, 0.7, 3.0, 0.25]).collect();
        let indices: Vec<[u32; 3]> = (0..68).map(|i| [i, i + 1, i + 2]).collect();
        let vertices =
            Vertices { positions: &positions, normals: &normals, uvs: &uvs, uvs2: &uvs2, colors: &colors };
        let read = mesh::ply::parse(&ply(&vertices, &indices)).unwrap();
        assert_eq!(read.colors, colors);
        assert_eq!(read.indices, indices);
        for i in 0..70 {
            assert_eq!(read.positions[i].to_array(), positions[i]);
            assert_eq!(read.normals[i], math::Vec3::from(normals[i]).normalize_or_zero());
            assert_eq!(read.uvs[i].to_array(), uvs[i]);
            assert_eq!(read.uvs2[i].to_array(), uvs2[i]);
        }
    }

    #[test]
    fn embedded_pictures_become_files_once() {
        let folder = tempfile::tempdir().unwrap();
        let image = |name: &str, bytes: &Arc<[u8]>| {
            let embedded = EmbeddedImage { name: name.into(), bytes: bytes.clone() };
            Texture::Image(Image::new(ImageSource::Embedded(embedded)))
        };
        let one: Arc<[u8]> = [0x89, b'P', b'N', b'G', 7].into();
        let two: Arc<[u8]> = [0xff, 0xd8, 9].into();
        let mut desc = SceneDesc::default();
        for (name, texture) in
            [("a", image("../../etc/passwd", &one)), ("b", image("wood/ö", &two)), ("c", image("wood", &one))]
        {
            desc.textures.insert(name.into(), texture.into());
        }
        let written = outsource(&mut desc, &folder.path().join("room.toml")).unwrap();
        let names: Vec<_> = written.iter().map(|path| path.strip_prefix(folder.path()).unwrap()).collect();
        assert_eq!(names, [Path::new("room-images/001-passwd.png"), Path::new("room-images/002-_.jpg")]);
        assert_eq!(std::fs::read(&written[1]).unwrap(), &two[..]);
        let file = |name: &str| match &desc.textures[name].value {
            Texture::Image(Image { source: ImageSource::File(file), .. }) => file.value.clone(),
            other => panic!("{other:?}"),
        };
        assert_eq!(file("a"), file("c"));
        assert_eq!(file("b"), Path::new("room-images/002-_.jpg"));
    }
}
