//! Wavefront OBJ with its material files: an object for each material.

mod lower;
mod map;
mod mtl;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mesh::TriangleMesh;
use mesh::obj::ObjModel;
use scenefile::desc::{Emission, MaterialRef, Object, SceneDesc};
use scenefile::{FileId, Loaded, Sourced, Sources, Span};

use crate::file::read_plain;
use crate::ply;
use crate::report::Report;
use crate::stage::Ground;
use mtl::Mtl;

/// Bytes of a material file, at most.
const MOST_MTL: usize = 64 << 20;
/// Material files of a scene, at most.
const MOST_LIBRARIES: usize = 64;

/// What a material of a file becomes.
#[derive(Clone, Debug, Default)]
struct Surface {
    /// A key of the description's materials.
    key: String,
    emission: Option<Emission>,
}

/// The state of an import.
struct Importer {
    report: Report,
    sources: Sources,
    desc: SceneDesc,
    /// What the material files have, by name; the first of a name counts.
    materials: BTreeMap<String, Mtl>,
    /// Names of textures by what they are.
    textures: std::collections::HashMap<String, String>,
}

/// Reads a model, framed and lit.
pub(crate) fn load(path: &Path, ground: Ground) -> Loaded {
    let mut importer = Importer {
        report: Report::default(),
        sources: Sources::default(),
        desc: SceneDesc {
            base: path.parent().unwrap_or(Path::new("")).to_path_buf(),
            ..SceneDesc::default()
        },
        materials: BTreeMap::new(),
        textures: std::collections::HashMap::new(),
    };
    let read = read_plain(path);
    let (bytes, model) = match read {
        Ok(bytes) => {
            let model = mesh::obj::parse_model(&bytes).map_err(|e| ply::fault(e, &bytes));
            (bytes, model)
        }
        Err(why) => (Vec::new(), Err(ply::unreadable(path, &why))),
    };
    let places = Places::of(&bytes);
    // The text is shown where something is wrong.
    let text =
        String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned());
    importer.sources.add(path, text);
    match model {
        Ok(model) => importer.model(model, &places),
        Err(diagnostic) => importer.report.push(diagnostic),
    }
    ply::finish(importer.desc, importer.report, importer.sources, ground)
}

/// Where a file first names each material and each library.
#[derive(Debug, Default)]
struct Places {
    found: BTreeMap<String, Span>,
}

impl Places {
    fn of(bytes: &[u8]) -> Self {
        let mut found = BTreeMap::new();
        let mut start = 0;
        for line in bytes.split_inclusive(|b| *b == b'\n') {
            let range = start..start + line.trim_ascii_end().len();
            start += line.len();
            // Few lines begin so; the rest must cost nothing.
            if !matches!(line.first(), Some(b'u' | b'm' | b' ' | b'\t')) {
                continue;
            }
            let line = line.trim_ascii();
            if line.starts_with(b"usemtl") || line.starts_with(b"mtllib") {
                let name = String::from_utf8_lossy(line).into_owned();
                found.entry(name).or_insert(Span { file: FileId(0), start: range.start, end: range.end });
            }
        }
        Self { found }
    }

    fn get(&self, keyword: &str, name: &str) -> Span {
        let exact = self.found.get(&format!("{keyword} {name}"));
        let near = || {
            let same = |line: &str| line.strip_prefix(keyword).is_some_and(|rest| rest.trim() == name);
            self.found.iter().find(|(line, _)| same(line)).map(|(_, span)| span)
        };
        exact.or_else(near).copied().unwrap_or(Span { file: FileId(0), start: 0, end: 0 })
    }
}

impl Importer {
    fn model(&mut self, model: ObjModel, places: &Places) {
        for library in model.libraries.iter().take(MOST_LIBRARIES) {
            self.library(library, places.get("mtllib", library));
        }
        if model.libraries.len() > MOST_LIBRARIES {
            let at = places.get("mtllib", &model.libraries[MOST_LIBRARIES]);
            self.report.instead(
                format!("more than {MOST_LIBRARIES} material files"),
                "the rest is not read",
                at,
            );
        }
        let colored = !model.mesh.colors.is_empty();
        let ObjModel { mesh, materials, material_of_triangle, .. } = model;
        for (i, (mesh, name)) in
            split(mesh, &material_of_triangle, materials.len()).into_iter().zip(&materials).enumerate()
        {
            if mesh.indices.is_empty() {
                continue;
            }
            let span = places.get("usemtl", name);
            let surface = self.surface(name, colored, span);
            let title = if name.is_empty() { format!("mesh {}", i + 1) } else { name.clone() };
            let object = Object {
                name: Some(title),
                material: Some(MaterialRef::Named(Sourced::at(surface.key, span))),
                emission: surface.emission.map(|emission| Sourced::at(emission, span)),
                ..Object::bare(ply::shape(mesh))
            };
            self.desc.objects.push(Sourced::at(object, span));
        }
    }

    /// Reads the material file, or the several, that an `mtllib` names.
    fn library(&mut self, written: &str, span: Span) {
        let base = self.desc.base.clone();
        let exists = |name: &str| base.join(slashed(name)).is_file();
        // Names may contain spaces, and several may stand in a line.
        let names: Vec<&str> =
            if exists(written) { vec![written] } else { written.split_ascii_whitespace().collect() };
        for name in names {
            let name = slashed(name);
            let beside = name.file_name().map(PathBuf::from).unwrap_or_default();
            let found = [&name, &beside].into_iter().find(|name| base.join(name).is_file());
            let read = match found {
                Some(name) => read_plain(&base.join(name)),
                None => Err("is not there".to_owned()),
            };
            match read {
                Ok(bytes) if bytes.len() <= MOST_MTL => {
                    let text = String::from_utf8_lossy(&bytes).into_owned();
                    let path = base.join(found.unwrap_or(&name));
                    let file = self.sources.add(&path, text.as_str());
                    let folder = found.and_then(|name| name.parent()).unwrap_or(Path::new("")).to_path_buf();
                    let all = mtl::parse(&text, file, &folder, &mut self.report);
                    for (name, material) in all {
                        self.materials.entry(name).or_insert(material);
                    }
                }
                Ok(_) => {
                    let text = format!(
                        "the material file `{}` has more than {} MiB",
                        name.display(),
                        MOST_MTL >> 20
                    );
                    self.report.instead(text, "its materials are grey", span);
                }
                Err(why) => {
                    let text = format!("the material file `{}` {why}", name.display());
                    self.report.instead(text, "its materials are grey", span);
                }
            }
        }
    }
}

/// A name as this machine's paths are written.
fn slashed(name: &str) -> PathBuf {
    PathBuf::from(name.replace('\\', "/"))
}

/// The triangles of each material, with the vertices that they use.
fn split(mesh: TriangleMesh, of_triangle: &[u16], materials: usize) -> Vec<TriangleMesh> {
    if materials <= 1 {
        return vec![mesh];
    }
    let mut parts: Vec<TriangleMesh> = vec![TriangleMesh::default(); materials];
    for (t, material) in mesh.indices.iter().zip(of_triangle) {
        if let Some(part) = parts.get_mut(usize::from(*material)) {
            part.indices.push(*t);
        }
    }
    // For each vertex the part that used it last, and its number there.
    let mut used: Vec<(u32, u32)> = vec![(u32::MAX, 0); mesh.positions.len()];
    for (p, part) in (0u32..).zip(&mut parts) {
        for corner in part.indices.iter_mut().flatten() {
            let i = *corner as usize;
            if used[i].0 != p {
                used[i] = (p, part.positions.len() as u32);
                part.positions.push(mesh.positions[i]);
                part.normals.extend(mesh.normals.get(i));
                part.uvs.extend(mesh.uvs.get(i));
                part.uvs2.extend(mesh.uvs2.get(i));
                part.colors.extend(mesh.colors.get(i));
            }
            *corner = used[i].1;
        }
    }
    parts
}
