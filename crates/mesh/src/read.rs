use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::{MeshError, TriangleMesh, obj, ply, stl};

/// How much more a compressed mesh may hold than it has bytes; meshes reach a tenth of it.
const MOST_GROWTH: u64 = 64;
/// Bytes that a compressed mesh may hold in any case.
const SMALL: u64 = 64 << 20;

/// Reads a mesh file by its extension, `.obj`, `.ply`, `.stl` or `.ply.gz` (gzip) in any case.
///
/// # Errors
/// Where the file can't be read, has another extension, or is refused by its parser. The error names the path.
pub fn read(path: impl AsRef<Path>) -> Result<TriangleMesh, MeshError> {
    let path = path.as_ref();
    let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let parse: fn(&[u8]) -> Result<TriangleMesh, MeshError> = if name.ends_with(".obj") {
        obj::parse
    } else if name.ends_with(".ply") {
        ply::parse
    } else if name.ends_with(".stl") {
        stl::parse
    } else if name.ends_with(".ply.gz") {
        |bytes| ply::parse(&unpacked(bytes)?)
    } else {
        let extension =
            path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let error = MeshError::whole(
            format!("`.{extension}` is no mesh format that can be read"),
            "convert the mesh to .ply or .obj",
        );
        return Err(error.in_file(path));
    };
    std::fs::read(path)
        .map_err(|e| MeshError::whole(e.to_string(), "check that the path is right and the file readable"))
        .and_then(|bytes| parse(&bytes))
        .map_err(|e| e.in_file(path))
}

/// What gzip holds. Memory is bounded by the size of the packed bytes.
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, MeshError> {
    let most = SMALL.max(MOST_GROWTH.saturating_mul(bytes.len() as u64));
    let mut plain = Vec::new();
    MultiGzDecoder::new(bytes)
        .take(most + 1)
        .read_to_end(&mut plain)
        .map_err(|e| MeshError::whole(format!("gzip cannot be unpacked: {e}"), "pack the mesh again"))?;
    if plain.len() as u64 > most {
        return Err(MeshError::whole(
            format!("it unpacks to more than {MOST_GROWTH} times its size"),
            "unpack it, if it is what it says",
        ));
    }
    Ok(plain)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    #[test]
    fn packed_meshes() {
        let folder = tempfile::tempdir().unwrap();
        let pack = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            let mut packer = GzEncoder::new(Vec::new(), Compression::best());
            packer.write_all(bytes).unwrap();
            std::fs::write(&path, packer.finish().unwrap()).unwrap();
            path
        };
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        let mesh = read(pack("a.PLY.gz", text.as_bytes())).unwrap();
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (3, 1));
        let bomb = read(pack("b.ply.gz", &vec![0; (SMALL + 9) as usize])).unwrap_err();
        assert!(bomb.message.contains("64 times"), "{bomb}");
        let plain = folder.path().join("c.ply.gz");
        std::fs::write(&plain, text).unwrap();
        assert!(read(plain).unwrap_err().message.contains("gzip"));
    }
}
