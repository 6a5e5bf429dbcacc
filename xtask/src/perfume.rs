//! `cargo xtask perfume`: the glTF model of the cookbook's product shot, a bottle with a metal cap, from generated shapes.

use math::Vec3;
use mesh::shapes::{Profile, lathe, rounded_box};
use mesh::{MeshError, TriangleMesh};
use serde_json::{Value, json};

use crate::{Outcome, root};

/// A mesh, its name, and its material's glTF properties.
struct Part {
    name: &'static str,
    mesh: TriangleMesh,
    material: Value,
}

/// Writes the model, or with `--check` compares it.
pub fn run(arguments: &[String]) -> Outcome {
    let path = root().join("scenes/cookbook/perfume.glb");
    let bytes = glb(&parts().map_err(|e| e.to_string())?);
    match arguments {
        [] => std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display())),
        [flag] if flag == "--check" => match std::fs::read(&path) {
            Ok(old) if old == bytes => Ok(()),
            _ => Err("scenes/cookbook/perfume.glb is not current: cargo xtask perfume".into()),
        },
        _ => Err("usage: cargo xtask perfume [--check]".into()),
    }
}

/// The bottle in metres. The perfume lies wholly within the glass, so that a ray leaves glass where it enters perfume.
fn parts() -> Result<Vec<Part>, MeshError> {
    let glass = json!({
        "name": "glass",
        "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 },
            "KHR_materials_ior": { "ior": 1.52 },
            "KHR_materials_volume": { "thicknessFactor": 0.01 },
        },
    });
    let perfume = json!({
        "name": "perfume",
        "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 },
            "KHR_materials_ior": { "ior": 1.36 },
            "KHR_materials_volume": {
                "thicknessFactor": 0.01, "attenuationDistance": 0.03, "attenuationColor": [0.95, 0.52, 0.20],
            },
        },
    });
    let gold = |roughness: f32| {
        json!({
            "name": "gold",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.95, 0.70, 0.36, 1], "metallicFactor": 1, "roughnessFactor": roughness,
            },
        })
    };
    let collar = Profile::polyline(
        [
            [0.0, 0.0615],
            [0.0102, 0.0615],
            [0.0105, 0.0618],
            [0.0105, 0.0662],
            [0.0102, 0.0665],
            [0.0, 0.0665],
        ]
        .map(math::Vec2::from)
        .to_vec(),
    );
    let block = |min: [f32; 3], max: [f32; 3], radius: f32| rounded_box(min.into(), max.into(), radius, 8);
    let part = |name, mesh, material| Part { name, mesh, material };
    Ok(vec![
        part("bottle", block([-0.026, 0.0, -0.014], [0.026, 0.062, 0.014], 0.0045), glass),
        part("perfume", block([-0.0215, 0.009, -0.0095], [0.0215, 0.056, 0.0095], 0.003), perfume),
        part("collar", lathe(&collar, 96)?, gold(0.12)),
        part("cap", block([-0.0125, 0.0672, -0.0125], [0.0125, 0.0985, 0.0125], 0.0016), gold(0.22)),
    ])
}

/// The binary form of glTF 2.0: a head of 12 bytes, a chunk of JSON, a chunk of numbers.
fn glb(parts: &[Part]) -> Vec<u8> {
    let mut numbers = Vec::new();
    let (mut views, mut accessors, mut meshes, mut nodes) = (vec![], vec![], vec![], vec![]);
    let mut store = |bytes: Vec<u8>, target: u32| {
        views.push(
            json!({ "buffer": 0, "byteOffset": numbers.len(), "byteLength": bytes.len(), "target": target }),
        );
        numbers.extend(bytes);
        views.len() - 1
    };
    for (i, Part { name, mesh, .. }) in parts.iter().enumerate() {
        let bounds = mesh.bounds();
        let positions = store(floats(&mesh.positions), 34962);
        let normals = store(floats(&mesh.normals), 34962);
        let indices = store(mesh.indices.iter().flatten().flat_map(|i| i.to_le_bytes()).collect(), 34963);
        let vertices = mesh.positions.len();
        let first = accessors.len();
        accessors.extend([
            json!({
                "bufferView": positions, "componentType": 5126, "count": vertices, "type": "VEC3",
                "min": bounds.min.to_array(), "max": bounds.max.to_array(),
            }),
            json!({ "bufferView": normals, "componentType": 5126, "count": vertices, "type": "VEC3" }),
            json!({ "bufferView": indices, "componentType": 5125, "count": 3 * mesh.indices.len(), "type": "SCALAR" }),
        ]);
        meshes.push(json!({
            "name": name,
            "primitives": [{
                "attributes": { "POSITION": first, "NORMAL": first + 1 }, "indices": first + 2, "material": i,
            }],
        }));
        nodes.push(json!({ "name": name, "mesh": i }));
    }
    let materials: Vec<&Value> = parts.iter().map(|part| &part.material).collect();
    let document = json!({
        "asset": { "version": "2.0", "generator": "nephroid xtask perfume" },
        "extensionsUsed": ["KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume"],
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": numbers.len() }],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = Vec::new();
    let words = [0x4654_6C67, 2, 12 + 8 + text.len() + 8 + numbers.len(), text.len(), 0x4E4F_534A];
    file.extend(words.iter().flat_map(|word| (*word as u32).to_le_bytes()));
    file.extend(text);
    file.extend([numbers.len() as u32, 0x004E_4942].iter().flat_map(|word| word.to_le_bytes()));
    file.extend(numbers);
    file
}

fn floats(vectors: &[Vec3]) -> Vec<u8> {
    vectors.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_model_is_current() {
        super::run(&["--check".into()]).unwrap();
    }
}
