//! A description that can be written as TOML elsewhere: large meshes in files of their own, file names that lead there.

use std::fmt;
use std::io;
use std::path::{Component, Path, PathBuf};

use scenefile::desc::{Image, ImageSource, LightKind, Normals, Object, SceneDesc, Shape, Texture, Triple};

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
/// folder beside it, named after it, and names of other files are changed to lead to the same files from there. Files
/// of the same names are replaced. Returns the files written.
///
/// # Errors
/// Where folder or files cannot be written; `desc` has changed in part then.
pub fn outsource(desc: &mut SceneDesc, scene: &Path) -> Result<Vec<PathBuf>, OutsourceError> {
    let to = scene.parent().unwrap_or(Path::new("")).to_path_buf();
    rebase(desc, &to);
    let mut name = scene.file_stem().unwrap_or("scene".as_ref()).to_os_string();
    name.push("-meshes");
    let folder = PathBuf::from(name);
    let mut written = Vec::new();
    let groups = desc.groups.values_mut().flat_map(|group| &mut group.value.objects);
    for object in desc.objects.iter_mut().chain(groups) {
        let Some(bytes) = ply_of(object) else { continue };
        let file = folder.join(format!("{:05}.ply", written.len() + 1));
        let path = to.join(&file);
        let wrong = |path: &Path, error| OutsourceError { path: path.to_path_buf(), error };
        if written.is_empty() {
            std::fs::create_dir_all(to.join(&folder)).map_err(|e| wrong(&to.join(&folder), e))?;
        }
        std::fs::write(&path, bytes).map_err(|e| wrong(&path, e))?;
        let Shape::Triangles { normals, .. } = object.shape.value else { continue };
        object.value.shape.value = Shape::Mesh { file: file.into(), normals };
        written.push(path);
    }
    Ok(written)
}

/// The PLY file of a large mesh in place.
fn ply_of(object: &Object) -> Option<Vec<u8>> {
    match &object.shape.value {
        Shape::Triangles { positions, indices, vertex_normals, uvs, normals, .. } if indices.len() > FEW => {
            // Where normals are made anew those given do not matter.
            let kept = matches!(normals, Normals::Given | Normals::Completed);
            let given = if kept { &vertex_normals[..] } else { &[] };
            Some(ply(positions, given, uvs, indices))
        }
        _ => None,
    }
}

/// Binary little-endian PLY (Turk 1994).
fn ply(positions: &[Triple], normals: &[Triple], uvs: &[[f32; 2]], indices: &[[u32; 3]]) -> Vec<u8> {
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
    for texture in desc.textures.values_mut() {
        if let Texture::Image(Image { source: ImageSource::File(file), .. }) = &mut texture.value {
            moved(&mut file.value);
        }
    }
    for light in &mut desc.lights {
        match &mut light.value.kind {
            LightKind::Sky { source: ImageSource::File(file), .. }
            | LightKind::Goniometric { source: ImageSource::File(file), .. }
            | LightKind::Projector { source: ImageSource::File(file), .. }
            | LightKind::Profile { file, .. } => moved(&mut file.value),
            _ => {}
        }
    }
    let groups = desc.groups.values_mut().flat_map(|group| &mut group.value.objects);
    for object in desc.objects.iter_mut().chain(groups) {
        if let Shape::Mesh { file, .. } = &mut object.value.shape.value {
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
        let indices: Vec<[u32; 3]> = (0..68).map(|i| [i, i + 1, i + 2]).collect();
        let read = mesh::ply::parse(&ply(&positions, &normals, &uvs, &indices)).unwrap();
        assert_eq!(read.indices, indices);
        for i in 0..70 {
            assert_eq!(read.positions[i].to_array(), positions[i]);
            assert_eq!(read.normals[i], math::Vec3::from(normals[i]).normalize_or_zero());
            assert_eq!(read.uvs[i].to_array(), uvs[i]);
        }
    }
}
