use math::{Bounds3, DVec3, Transform, Vec2, Vec3};

use crate::MeshError;

/// Triangles over shared vertices, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a vertex; or empty, where the surface is faceted.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a vertex (v points up, as in OBJ); or empty.
    pub uvs: Vec<Vec2>,
    /// A second set of texture coordinates; or empty.
    pub uvs2: Vec<Vec2>,
    /// Linear RGB and opacity, one a vertex; or empty.
    pub colors: Vec<[f32; 4]>,
    /// Three vertices for each triangle.
    pub indices: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Checks what every user of a mesh relies on.
    ///
    /// # Errors
    /// Where normals, uvs or colours are neither empty nor one a vertex, a number is not finite, a normal's length
    /// is off 1 by more than 1 %, or an index is out of range.
    pub fn validate(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("uvs", self.uvs.len()),
            ("second uvs", self.uvs2.len()),
            ("colours", self.colors.len()),
        ];
        for (name, len) in lengths {
            if len != 0 && len != vertices {
                return Err(MeshError::whole(
                    format!("{len} {name} for {vertices} vertices"),
                    "give none or one for each vertex",
                ));
            }
        }
        let not_finite = |name: &str, i: usize| {
            MeshError::whole(
                format!("{name} of vertex {i} is not finite"),
                "repair the mesh: export it again",
            )
        };
        if let Some(i) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(not_finite("the position", i));
        }
        if let Some(i) = self.normals.iter().position(|n| !n.is_finite()) {
            return Err(not_finite("the normal", i));
        }
        for uvs in [&self.uvs, &self.uvs2] {
            if let Some(i) = uvs.iter().position(|t| !t.is_finite()) {
                return Err(not_finite("the texture coordinate", i));
            }
        }
        if let Some(i) = self.colors.iter().position(|c| !c.iter().all(|x| x.is_finite())) {
            return Err(not_finite("the colour", i));
        }
        if let Some(i) = self.normals.iter().position(|n| (n.length() - 1.0).abs() > 0.01) {
            return Err(MeshError::whole(
                format!("the normal of vertex {i} has length {}, not 1", self.normals[i].length()),
                "normalise it, or leave all normals out",
            ));
        }
        if let Some(i) = self.indices.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
            return Err(MeshError::whole(
                format!("triangle {i} names vertices {:?}, but there are {vertices}", self.indices[i]),
                "indices count from 0 and must be less than the number of vertices",
            ));
        }
        Ok(())
    }

    /// The corners of triangle `i`.
    pub fn corners(&self, i: usize) -> [Vec3; 3] {
        self.indices[i].map(|v| self.positions[v as usize])
    }

    fn corners_f64(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.indices.iter().map(|t| t.map(|v| self.positions[v as usize].as_dvec3()))
    }

    /// Bounds of all vertices, used or not.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::of_points(self.positions.iter().copied())
    }

    /// Sum of the triangles' areas, in square units.
    pub fn area(&self) -> f64 {
        self.corners_f64().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// Volume enclosed, in cubic units: positive where a closed surface is oriented outward, negative where inward.
    /// Without meaning for an open surface. Overlapping shells count each.
    pub fn signed_volume(&self) -> f64 {
        // Divergence theorem, about the centre of the bounds for the sake of precision.
        let o = self.bounds().center().as_dvec3();
        self.corners_f64().map(|[a, b, c]| (a - o).dot((b - o).cross(c - o))).sum::<f64>() / 6.0
    }

    /// The mesh under a transform. The outside stays outside: winding is reversed where handedness swaps.
    pub fn transformed(mut self, t: &Transform) -> Self {
        for p in &mut self.positions {
            *p = t.point(*p);
        }
        for n in &mut self.normals {
            *n = t.normal(*n).normalize_or(*n);
        }
        if t.swaps_handedness() {
            self.reverse_winding();
        }
        self
    }

    /// The mesh turned inside out: winding and normals reversed.
    pub fn flipped(mut self) -> Self {
        self.reverse_winding();
        for n in &mut self.normals {
            *n = -*n;
        }
        self
    }

    fn reverse_winding(&mut self) {
        for t in &mut self.indices {
            t.swap(1, 2);
        }
    }

    /// Bytes of vertices and indices.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.uvs2[..])
            + size_of_val(&self.colors[..])
            + size_of_val(&self.indices[..])
    }

    /// Appends what a vertex of another mesh has besides position and normal.
    pub(crate) fn push_attributes(&mut self, of: &Self, vertex: usize) {
        self.uvs.extend(of.uvs.get(vertex));
        self.uvs2.extend(of.uvs2.get(vertex));
        self.colors.extend(of.colors.get(vertex));
    }

    /// Both meshes in one. Normals, uvs and colours are dropped unless both have them.
    pub fn merged(mut self, other: &Self) -> Self {
        let base = self.positions.len() as u32;
        if self.positions.is_empty() {
            return other.clone();
        }
        join(&mut self.normals, &other.normals);
        join(&mut self.uvs, &other.uvs);
        join(&mut self.uvs2, &other.uvs2);
        join(&mut self.colors, &other.colors);
        self.positions.extend_from_slice(&other.positions);
        self.indices.extend(other.indices.iter().map(|t| t.map(|v| v + base)));
        self
    }
}

/// One list behind the other; none where either is empty.
fn join<T: Copy>(one: &mut Vec<T>, other: &[T]) {
    if one.is_empty() || other.is_empty() {
        one.clear();
    } else {
        one.extend_from_slice(other);
    }
}
