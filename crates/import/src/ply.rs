//! A mesh file alone: PLY and STL, and what they have in common with OBJ.

use std::path::Path;

use mesh::{MeshError, Place, TriangleMesh};
use scenefile::desc::{
    Channel, ColorDesc, Material, MaterialRef, Normals, Object, Principled, SceneDesc, Shape, Texture,
    TransformSteps,
};
use scenefile::{Diagnostic, FileId, Loaded, Sources, Span};

use crate::file::read_plain;
use crate::matrix::Matrix;
use crate::report::Report;
use crate::stage::{self, Given, Ground};

/// Edges that bend more than this stay sharp where a file has no normals, in degrees.
const CREASE: f32 = 35.0;
/// The colour of what has none.
pub(crate) const GREY: f32 = 0.6;

/// A format of meshes alone.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    /// +y is taken for up, as in glTF.
    Ply,
    /// +z is up, as in programs for manufacture, and −y the front.
    Stl,
}

impl Kind {
    fn parse(self, bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
        match self {
            Self::Ply => mesh::ply::parse(bytes),
            Self::Stl => mesh::stl::parse(bytes),
        }
    }

    /// To +y up and +z as the front.
    fn upright(self) -> TransformSteps {
        match self {
            Self::Ply => TransformSteps::new(),
            Self::Stl => Matrix::rows([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]).steps(),
        }
    }
}

/// Reads a mesh, framed and lit.
pub(crate) fn load(path: &Path, kind: Kind, ground: Ground) -> Loaded {
    let read = read_plain(path);
    let mesh = match read {
        Ok(bytes) => kind.parse(&bytes).map_err(|e| fault(e, &bytes)),
        Err(why) => Err(unreadable(path, &why)),
    };
    let mut sources = Sources::default();
    sources.add(path, "");
    let mut report = Report::default();
    let mut desc =
        SceneDesc { base: path.parent().unwrap_or(Path::new("")).to_path_buf(), ..SceneDesc::default() };
    match mesh {
        Ok(mesh) => {
            let mut material = Principled { base_color: GREY.into(), ..Principled::default() };
            if !mesh.colors.is_empty() {
                let name = "vertex-colors";
                desc.textures.insert(name.into(), Texture::VertexColor { channel: Channel::Rgb }.into());
                material.base_color = ColorDesc::texture(name);
            }
            desc.materials.insert("surface".into(), Material::from(material).into());
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let object = Object {
                name: Some(name),
                transform: kind.upright(),
                ..Object::new(shape(mesh), MaterialRef::from("surface"))
            };
            desc.objects.push(object.into());
            // Colours on points of scans are no reason for holes, so that opacity of vertices is not asked for.
            finish(desc, report, sources, ground)
        }
        Err(diagnostic) => {
            report.push(diagnostic);
            finish(desc, report, sources, ground)
        }
    }
}

/// Frames and lights what was read, with a ground under it, and checks it.
pub(crate) fn finish(mut desc: SceneDesc, mut report: Report, sources: Sources, ground: Ground) -> Loaded {
    if !report.has_error() {
        let light = desc.objects.iter().any(|object| object.emission.is_some());
        stage::complete(&mut desc, Given { light, ground }, &mut report);
        scenefile::check(&desc).into_iter().for_each(|d| report.push(d));
    }
    let diagnostics = report.finish();
    let failed = diagnostics.iter().any(Diagnostic::is_error);
    Loaded { desc: (!failed).then_some(desc), diagnostics, sources }
}

/// The triangles in place; without normals, smooth but for creases.
pub(crate) fn shape(mesh: TriangleMesh) -> Shape {
    let normals =
        if mesh.normals.is_empty() { Normals::Smooth { crease_degrees: CREASE } } else { Normals::Given };
    Shape::Triangles {
        positions: mesh.positions.into_iter().map(|p| p.to_array()).collect(),
        indices: mesh.indices,
        vertex_normals: mesh.normals.into_iter().map(|n| n.to_array()).collect(),
        uvs: mesh.uvs.into_iter().map(|t| t.to_array()).collect(),
        uvs2: mesh.uvs2.into_iter().map(|t| t.to_array()).collect(),
        colors: mesh.colors,
        normals,
    }
}

/// A file that cannot be read.
pub(crate) fn unreadable(path: &Path, why: &str) -> Diagnostic {
    let whole = Span { file: FileId(0), start: 0, end: 0 };
    Diagnostic::error("file", format!("the file {} {why}", path.display())).at(whole)
}

/// What is wrong with a mesh, at its line if it has one.
pub(crate) fn fault(error: MeshError, bytes: &[u8]) -> Diagnostic {
    let (start, message) = match error.place {
        Place::Whole => (0, error.message),
        Place::Byte(byte) => (0, format!("byte {byte}: {}", error.message)),
        Place::Line(line) => (line_start(bytes, line), format!("line {line}: {}", error.message)),
    };
    let span = Span { file: FileId(0), start, end: start };
    Diagnostic::error("bad-mesh", message).at(span).help(error.help)
}

/// The byte at which a line starts, counted from 1; 0 where there are not as many.
fn line_start(bytes: &[u8], line: u64) -> usize {
    let ends = bytes.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(i, _)| i + 1);
    std::iter::once(0).chain(ends).nth(usize::try_from(line.saturating_sub(1)).unwrap_or(0)).unwrap_or(0)
}
