use math::{DVec2, DVec3};

use crate::TriangleMesh;

/// A vertex before it is rounded to `f32`.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub(super) position: DVec3,
    /// Need not be unit.
    pub(super) normal: DVec3,
    pub(super) uv: DVec2,
}

/// A row of vertices of a [`Grid`], by its first one.
#[derive(Clone, Copy)]
pub(super) enum Row {
    /// Once round: the last vertex is the first again, but for its uv.
    Ring(u32),
    /// One point, with a vertex for each column, so that each triangle there has a normal and uv of its own.
    Pole(u32),
}

/// Rows of vertices, each once round something, sewn together.
pub(super) struct Grid {
    columns: u32,
    mesh: TriangleMesh,
}

impl Grid {
    pub(super) fn new(columns: u32) -> Self {
        Self { columns, mesh: TriangleMesh::default() }
    }

    fn push(&mut self, vertex: Vertex) {
        self.mesh.positions.push(vertex.position.as_vec3());
        self.mesh.normals.push(vertex.normal.normalize_or(DVec3::Y).as_vec3());
        self.mesh.uvs.push(vertex.uv.as_vec2());
    }

    /// A ring of the vertices at 0, 1 … columns; the last is put exactly where the first is.
    pub(super) fn ring(&mut self, vertex: impl Fn(u32) -> Vertex) -> Row {
        let start = self.mesh.positions.len() as u32;
        let first = vertex(0);
        (0..self.columns).for_each(|j| self.push(vertex(j)));
        self.push(Vertex { position: first.position, normal: first.normal, ..vertex(self.columns) });
        Row::Ring(start)
    }

    /// A point; the vertex of each column is asked for in the column's middle, j + ½, and must keep its position.
    pub(super) fn pole(&mut self, vertex: impl Fn(f64) -> Vertex) -> Row {
        let start = self.mesh.positions.len() as u32;
        (0..self.columns).for_each(|j| self.push(vertex(f64::from(j) + 0.5)));
        Row::Pole(start)
    }

    /// Triangles between two rows; the outside is along (direction of columns) × (direction from `a` to `b`).
    pub(super) fn sew(&mut self, a: Row, b: Row) {
        for j in 0..self.columns {
            match (a, b) {
                (Row::Ring(a), Row::Ring(b)) => {
                    self.mesh.indices.push([a + j, a + j + 1, b + j + 1]);
                    self.mesh.indices.push([a + j, b + j + 1, b + j]);
                }
                (Row::Pole(a), Row::Ring(b)) => self.mesh.indices.push([a + j, b + j + 1, b + j]),
                (Row::Ring(a), Row::Pole(b)) => self.mesh.indices.push([a + j, a + j + 1, b + j]),
                (Row::Pole(_), Row::Pole(_)) => {}
            }
        }
    }

    pub(super) fn finish(self) -> TriangleMesh {
        self.mesh
    }
}

/// Cosine and sine of `part`/`whole` of a turn; exact at the quarters.
pub(super) fn turn(part: f64, whole: u32) -> (f64, f64) {
    let quarters = 4.0 * part / f64::from(whole);
    let quarter = quarters.round();
    let (sin, cos) = ((quarters - quarter) * std::f64::consts::FRAC_PI_2).sin_cos();
    match quarter.rem_euclid(4.0) as u32 {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    }
}
