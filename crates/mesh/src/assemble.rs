//! What the readers have in common: checks of what was read, and repair of normals.

use math::{Vec2, Vec3};

use crate::{MeshError, TriangleMesh};

/// Most vertices, and most triangles, of a mesh: three corners a triangle are numbered in 32 bits.
pub(crate) const MAX_COUNT: usize = (u32::MAX / 3) as usize;

/// Finishes a mesh whose indices are in range: drops triangles that name a vertex twice, makes normals unit,
/// gives smooth ones where they are zero, and refuses what is not finite or empty.
pub(crate) fn finish(mut mesh: TriangleMesh) -> Result<TriangleMesh, MeshError> {
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(not_finite("the position", i, mesh.positions[i].to_string()));
    }
    for uvs in [&mesh.uvs, &mesh.uvs2] {
        if let Some(i) = uvs.iter().position(|t| !t.is_finite()) {
            return Err(not_finite("the texture coordinate", i, uvs[i].to_string()));
        }
    }
    if let Some(i) = mesh.colors.iter().position(|c| !c.iter().all(|x| x.is_finite())) {
        return Err(not_finite("the colour", i, format!("{:?}", mesh.colors[i])));
    }
    mesh.indices.retain(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    if mesh.indices.is_empty() {
        return Err(MeshError::whole(
            "there is no triangle in the file",
            "export the mesh again, with its faces",
        ));
    }
    if mesh.positions.len() > MAX_COUNT || mesh.indices.len() > MAX_COUNT {
        return Err(MeshError::whole(
            format!("{} vertices and {} triangles are too many", mesh.positions.len(), mesh.indices.len()),
            format!("split the mesh into parts of at most {MAX_COUNT} triangles"),
        ));
    }
    let mut missing = false;
    for (i, n) in mesh.normals.iter_mut().enumerate() {
        if !n.is_finite() {
            return Err(not_finite("the normal", i, n.to_string()));
        }
        let length_squared = n.length_squared();
        if (length_squared - 1.0).abs() > 1e-6 {
            // In f64, since the squares of large and of small floats leave the range of f32.
            *n = n.as_dvec3().normalize_or_zero().as_vec3();
            missing |= *n == Vec3::ZERO;
        }
    }
    if missing {
        let (positions, indices) = (mesh.positions.clone(), mesh.indices.clone());
        let smooth = TriangleMesh { positions, indices, ..Default::default() }.with_smooth_normals();
        for (n, s) in mesh.normals.iter_mut().zip(smooth.normals) {
            if *n == Vec3::ZERO {
                *n = s;
            }
        }
    }
    if mesh.uvs.iter().all(|t| *t == Vec2::ZERO) {
        mesh.uvs = Vec::new();
    }
    Ok(mesh)
}

/// Linear from a colour that is encoded as sRGB (IEC 61966-2-1).
pub(crate) fn linear_from_srgb(x: f32) -> f32 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn not_finite(what: &str, i: usize, value: String) -> MeshError {
    MeshError::whole(
        format!("{what} of vertex {i} (counting from 0) is {value}"),
        "repair the mesh: every number must be finite",
    )
}
