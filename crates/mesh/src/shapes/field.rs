//! Heights over a rectangle of the plane y = 0, as an open sheet or as the top of a closed body.

use math::{DVec2, DVec3, Vec2, Vec3};

use crate::{MeshError, TriangleMesh};

/// A rectangle about the origin, cut into cells: `size` along x and z, `cells` likewise.
#[derive(Clone, Copy)]
pub(super) struct Field {
    pub(super) size: DVec2,
    pub(super) cells: [u32; 2],
}

impl Field {
    /// The longer side has `resolution` cells, the shorter one as many as keep the cells about square.
    pub(super) fn new(size: [f32; 2], resolution: u32) -> Self {
        let size = DVec2::new(size[0].into(), size[1].into());
        let cells = (size / size.max_element() * f64::from(resolution)).round().max(DVec2::ONE);
        Self { size, cells: [cells.x as u32, cells.y as u32] }
    }

    /// The uv of vertex (i, j).
    fn share(&self, i: u32, j: u32) -> DVec2 {
        let [columns, rows] = self.cells.map(f64::from);
        DVec2::new(f64::from(i) / columns, f64::from(j) / rows)
    }

    /// x and z of vertex (i, j); j counts toward −z.
    pub(super) fn at(&self, i: u32, j: u32) -> DVec2 {
        let share = self.share(i, j);
        DVec2::new(share.x - 0.5, 0.5 - share.y) * self.size
    }

    /// The surface from heights and normals, row by row from +z to −z, facing +y. u goes along +x, v along −z.
    pub(super) fn sheet(&self, points: &[(f64, DVec3)]) -> TriangleMesh {
        let [columns, rows] = self.cells;
        let stride = columns + 1;
        let mut mesh = TriangleMesh::default();
        for j in 0..=rows {
            for i in 0..=columns {
                let (height, normal) = points[(j * stride + i) as usize];
                let at = self.at(i, j);
                mesh.positions.push(DVec3::new(at.x, height, at.y).as_vec3());
                mesh.normals.push(normal.normalize_or(DVec3::Y).as_vec3());
                mesh.uvs.push(self.share(i, j).as_vec2());
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let (a, b) = (j * stride + i, (j + 1) * stride + i);
                mesh.indices.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
            }
        }
        mesh
    }

    /// A [`sheet`](Self::sheet) with four walls down to a flat bottom at `bottom`: closed, oriented outward.
    pub(super) fn body(&self, mut mesh: TriangleMesh, bottom: f32) -> Result<TriangleMesh, MeshError> {
        let [columns, rows] = self.cells;
        let stride = columns + 1;
        // The border, counter-clockwise seen from above, side by side with the way out of it.
        let sides: [(Vec3, Vec<u32>); 4] = [
            (Vec3::Z, (0..=columns).collect()),
            (Vec3::X, (0..=rows).map(|j| j * stride + columns).collect()),
            (Vec3::NEG_Z, (0..=columns).rev().map(|i| rows * stride + i).collect()),
            (Vec3::NEG_X, (0..=rows).rev().map(|j| j * stride).collect()),
        ];
        if let Some(low) = mesh.positions.iter().map(|p| p.y).reduce(f32::min).filter(|y| *y <= bottom) {
            return Err(MeshError::whole(
                format!("the surface goes down to {low}, the bottom lies at {bottom}"),
                "make the body deeper or the surface flatter",
            ));
        }
        let below = |top: Vec3| Vec3::new(top.x, bottom, top.z);
        let push = |mesh: &mut TriangleMesh, position: Vec3, normal: Vec3, uv: Vec2| {
            mesh.positions.push(position);
            mesh.normals.push(normal);
            mesh.uvs.push(uv);
            mesh.positions.len() as u32 - 1
        };
        let middle = push(&mut mesh, Vec3::new(0.0, bottom, 0.0), Vec3::NEG_Y, Vec2::splat(0.5));
        for (out, border) in sides {
            let mut last: Option<[u32; 3]> = None;
            for v in border {
                let (top, uv) = (mesh.positions[v as usize], mesh.uvs[v as usize]);
                let upper = push(&mut mesh, top, out, uv);
                let lower = push(&mut mesh, below(top), out, uv);
                let floor = push(&mut mesh, below(top), Vec3::NEG_Y, uv);
                if let Some([p, p_low, p_floor]) = last {
                    mesh.indices.extend([[p_low, lower, upper], [p_low, upper, p], [middle, floor, p_floor]]);
                }
                last = Some([upper, lower, floor]);
            }
        }
        Ok(mesh)
    }
}
