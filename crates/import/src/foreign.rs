//! Files that are no scenes here: what they are, and what to do with them.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use scenefile::Diagnostic;

/// Why a file that is named as a scene is none, where its name or its first bytes tell.
pub(crate) fn refusal(path: &Path) -> Option<Diagnostic> {
    let Kind { what, help, .. } = by_name(path).or_else(|| by_content(path))?;
    let message = format!("{} is {what}, which is not read as a scene", path.display());
    Some(Diagnostic::error("file", message).help(*help))
}

/// A kind of file.
struct Kind {
    /// Extensions, in lower case.
    extensions: &'static [&'static str],
    /// What such files begin with.
    begins: &'static [&'static [u8]],
    /// What it is.
    what: &'static str,
    /// What to do.
    help: &'static str,
}

fn by_name(path: &Path) -> Option<&'static Kind> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    KINDS.iter().find(|kind| kind.extensions.contains(&&*extension))
}

/// Of a file that is named like a scene of ours, or like none.
fn by_content(path: &Path) -> Option<&'static Kind> {
    let mut first = Vec::new();
    let ordinary = std::fs::metadata(path).is_ok_and(|meta| meta.is_file());
    File::open(path).ok().filter(|_| ordinary)?.take(32).read_to_end(&mut first).ok()?;
    KINDS.iter().find(|kind| kind.begins.iter().any(|begin| first.starts_with(begin)))
}

/// A kind whose name or first bytes tell it.
const fn kind(
    extensions: &'static [&'static str],
    begins: &'static [&'static [u8]],
    what: &'static str,
    help: &'static str,
) -> Kind {
    Kind { extensions, begins, what, help }
}

const EXPORT: &str = "export the scene as glTF (.glb) and render that";
const SKY: &str = "a scene lights itself with it: [[lights]] with kind = \"environment\" and file = \"NAME\"; \
                   `nephroid describe environment` tells more";

const KINDS: &[Kind] = &[
    kind(
        &["blend", "blend1"],
        &[b"BLENDER"],
        "a Blender file",
        "in Blender, File > Export > glTF 2.0, as .glb, with Cameras and Punctual Lights ticked; render that file",
    ),
    kind(
        &["fbx"],
        &[b"Kaydara FBX Binary"],
        "a scene in Autodesk's FBX",
        "open it in Blender (File > Import > FBX) or in the program that wrote it, and export glTF (.glb)",
    ),
    kind(
        &["usd", "usda", "usdc", "usdz"],
        &[b"#usda", b"PXR-USDC"],
        "a scene in OpenUSD",
        "open it in Blender (File > Import > Universal Scene Description) and export glTF (.glb)",
    ),
    kind(
        &["abc"],
        &[b"Ogawa"],
        "an Alembic cache",
        "open it in Blender (File > Import > Alembic) and export glTF (.glb), or its meshes as PLY",
    ),
    kind(
        &["dae"],
        &[],
        "a COLLADA document",
        "open it in a program that reads it, as Blender up to 4.5, and export glTF (.glb)",
    ),
    kind(
        &["3mf"],
        &[],
        "a model for printing (3MF)",
        "export STL from the program that wrote it, or open it in a slicer and export STL from there",
    ),
    kind(&["max", "3ds"], &[], "a scene of 3ds Max", EXPORT),
    kind(&["c4d"], &[], "a scene of Cinema 4D", EXPORT),
    kind(&["ma", "mb"], &[b"//Maya"], "a scene of Maya", EXPORT),
    kind(&["skp"], &[], "a SketchUp model", EXPORT),
    kind(&["hip", "hipnc", "hiplc"], &[], "a scene of Houdini", EXPORT),
    kind(
        &["3dm"],
        &[b"3D Geometry File Format"],
        "a Rhino model",
        "export its meshes as OBJ (File > Export), or glTF",
    ),
    kind(&["lxs", "lxo", "scn"], &[], "a scene of another renderer", EXPORT),
    kind(
        &[
            "step", "stp", "iges", "igs", "brep", "sldprt", "sldasm", "ipt", "iam", "f3d", "x_t", "dwg",
            "dxf", "ifc",
        ],
        &[b"ISO-10303-21"],
        "a CAD model of exact surfaces, not of triangles",
        "export a mesh from the CAD program, as OBJ, PLY or STL; FreeCAD reads most of these",
    ),
    kind(
        &["zip", "7z", "rar", "tar", "gz", "xz", "zst"],
        &[b"PK\x03\x04", b"7z\xbc\xaf", b"Rar!", b"\x1f\x8b", b"\x28\xb5\x2f\xfd"],
        "an archive or a compressed file",
        "unpack it and name the scene in it",
    ),
    kind(
        &["hdr", "pic", "rgbe"],
        &[b"#?RADIANCE", b"#?RGBE"],
        "a picture of the surroundings (Radiance HDR)",
        SKY,
    ),
    kind(&["exr"], &[b"\x76\x2f\x31\x01"], "a picture (OpenEXR)", SKY),
    kind(
        &["png", "jpg", "jpeg", "tif", "tiff", "webp", "bmp", "tga", "gif", "ppm", "pfm"],
        &[b"\x89PNG", b"\xff\xd8\xff", b"GIF8"],
        "a picture",
        "name the scene; a scene uses pictures as textures: `nephroid describe textures` tells more",
    ),
    kind(
        &["ies", "ldt"],
        &[b"IESNA"],
        "the light distribution of a luminaire",
        "a scene has it as a lamp: [[lights]] with kind = \"profile\" and file = \"NAME\"; `nephroid describe profile` \
         tells more",
    ),
    kind(&["mtl"], &[], "a list of materials of an OBJ file", "name the .obj file: it brings its materials"),
    kind(&["bin"], &[], "the data of another file, as of a .gltf", "name the .gltf file: it brings its data"),
    kind(
        &["las", "laz", "e57", "pcd", "xyz"],
        &[b"LASF"],
        "a cloud of points",
        "make triangles of it first, in MeshLab or CloudCompare, and save these as PLY",
    ),
    kind(&["py", "sh", "js"], &[], "a program", "run it if it writes a scene, and name what it wrote"),
    kind(
        &["glsl", "osl", "mtlx", "sbsar"],
        &[],
        "a material alone",
        "write its values as a material of a scene: `nephroid describe principled` tells which there are",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_format_that_is_read_is_refused() {
        use crate::Format;
        for kind in KINDS {
            for extension in kind.extensions {
                let name = format!("a.{extension}");
                assert_eq!(Format::of(Path::new(&name)), Format::Native, "{name}");
            }
        }
        for name in ["a.toml", "a", "a.txt"] {
            assert!(refusal(Path::new(name)).is_none(), "{name}");
        }
    }

    #[test]
    fn names_and_first_bytes_tell() {
        let said = refusal(Path::new("Sofa.BLEND")).unwrap();
        assert!(said.message.contains("Blender") && said.help.unwrap().contains("glTF"), "{}", said.message);
        let folder = tempfile::tempdir().unwrap();
        let disguised = folder.path().join("scene.toml");
        std::fs::write(&disguised, b"BLENDER-v300RENDH").unwrap();
        assert!(refusal(&disguised).unwrap().message.contains("Blender"));
        std::fs::write(&disguised, b"[render]\n").unwrap();
        assert!(refusal(&disguised).is_none());
    }
}
