use std::path::Path;

use crate::{MeshError, TriangleMesh, obj, ply};

/// Reads a mesh file by its extension, `.obj` or `.ply` in any case.
///
/// # Errors
/// Where the file can't be read, has another extension, or is refused by its parser. The error names the path.
pub fn read(path: impl AsRef<Path>) -> Result<TriangleMesh, MeshError> {
    let path = path.as_ref();
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let parse: fn(&[u8]) -> Result<TriangleMesh, MeshError> = match extension.as_str() {
        "obj" => obj::parse,
        "ply" => ply::parse,
        _ => {
            let error = MeshError::whole(
                format!("`.{extension}` is no mesh format that can be read"),
                "convert the mesh to .ply or .obj",
            );
            return Err(error.in_file(path));
        }
    };
    std::fs::read(path)
        .map_err(|e| MeshError::whole(e.to_string(), "check that the path is right and the file readable"))
        .and_then(|bytes| parse(&bytes))
        .map_err(|e| e.in_file(path))
}
