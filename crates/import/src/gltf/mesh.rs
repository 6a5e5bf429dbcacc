//! Meshes (glTF 2.0 §3.7): each primitive becomes triangles in place.

use scenefile::Span;
use scenefile::desc::{Normals, Shape, Triple};

use super::Importer;
use super::accessor::Accessor;
use super::fault::{Fault, Known};
use super::json::Value;
use super::pose::Pose;
use crate::matrix::{add, cross, narrow, sub, unit, wide};

/// A primitive.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub positions: Vec<Triple>,
    pub normals: Vec<Triple>,
    pub uvs: [Vec<[f32; 2]>; 2],
    pub colors: Vec<[f32; 4]>,
    pub indices: Vec<[u32; 3]>,
    /// The number of its material.
    pub material: Option<usize>,
    pub span: Span,
}

impl Part {
    pub(super) fn shape(self) -> Shape {
        let [uvs, uvs2] = self.uvs;
        Shape::Triangles {
            positions: self.positions,
            indices: self.indices,
            vertex_normals: self.normals,
            uvs,
            uvs2,
            colors: self.colors,
            normals: Normals::Given,
        }
    }

    /// Whether any triangle has an area.
    pub(super) fn has_area(&self) -> bool {
        self.indices.iter().any(|t| {
            let normal = self.face(*t);
            normal.iter().any(|x| *x != 0.0) && normal.iter().all(|x| x.is_finite())
        })
    }

    /// Twice the area of a triangle, along its normal.
    fn face(&self, t: [u32; 3]) -> [f64; 3] {
        let [a, b, c] = t.map(|v| wide(self.positions[v as usize]));
        cross(sub(b, a), sub(c, a))
    }

    /// Gives normals where they are zero or not finite: the mean of the faces around.
    fn repair_normals(&mut self) {
        let good = |n: &Triple| n.iter().all(|x| x.is_finite()) && n.iter().any(|x| x.abs() > 1e-18);
        if self.normals.iter().all(good) {
            return;
        }
        let mut sums = vec![[0.0; 3]; self.positions.len()];
        for t in &self.indices {
            for v in t {
                sums[*v as usize] = add(sums[*v as usize], self.face(*t));
            }
        }
        for (normal, sum) in self.normals.iter_mut().zip(sums).filter(|(n, _)| !good(n)) {
            *normal = narrow(unit(sum).unwrap_or([0.0, 0.0, 1.0]));
        }
    }
}

impl<'t> Importer<'t> {
    /// The primitives of a mesh that have triangles.
    pub(super) fn parts(&mut self, mesh: &'t Value<'t>, pose: &Pose) -> Vec<Part> {
        let primitives = mesh.array("primitives");
        let primitives = self.told(primitives).unwrap_or_default();
        let mut parts = Vec::new();
        for primitive in primitives {
            match self.primitive(primitive, pose) {
                Ok(Some(part)) if part.has_area() => parts.push(part),
                Ok(Some(part)) => {
                    let text = "a primitive whose triangles have no area";
                    self.report.instead(text, "it is left out", part.span);
                }
                Ok(None) => {}
                Err(fault) => self.fault(fault),
            }
        }
        parts
    }

    fn primitive(&mut self, primitive: &'t Value<'t>, pose: &Pose) -> Known<Option<Part>> {
        let span = primitive.span();
        let mode = primitive.whole("mode")?.unwrap_or(4);
        match mode {
            0 => self.report.instead("points are not rendered", "they are left out", span),
            1..=3 => self.report.instead("lines are not rendered", "they are left out", span),
            4..=6 => {}
            _ => return Err(Fault::new("unknown-kind", format!("{mode} is no mode of a primitive"), span)),
        }
        let Some(attributes) = primitive.get("attributes") else {
            return Err(Fault::new("missing-key", "a primitive without `attributes`", span));
        };
        if mode < 4 {
            return Ok(None);
        }
        let source = self.source;
        let Some(positions) = source.accessor(attributes, "POSITION")? else {
            self.report.instead("a primitive without positions", "it is left out", span);
            return Ok(None);
        };
        let packed = primitive.extension("KHR_draco_mesh_compression");
        if let Some(packed) = packed
            && !positions.has_data()
        {
            let text = "meshes compressed by Draco are not read";
            return Err(Fault::new("unsupported", text, packed.span()));
        }
        let count = positions.count;
        let order = source.accessor(primitive, "indices")?;
        let corners = order.as_ref().map_or(count, |order| order.count);
        self.spend(12usize.saturating_mul(corners), span)?;
        let mut indices = triangles(mode, order.as_ref(), count);
        if let Some(wrong) = indices.iter().flatten().find(|i| **i as usize >= count) {
            let text = format!("an index is {wrong}, but there are {count} vertices");
            return Err(Fault::new("out-of-range", text, primitive.get("indices").map_or(span, Value::span)));
        }
        // Primitives often share vertices of which each uses a few.
        let some = (indices.len() * 6 < count).then(|| compact(&mut indices));
        let vertices = some.as_ref().map_or(count, Vec::len);
        let uses = |name: &str| usize::from(attributes.get(name).is_some());
        let floats =
            3 + 3 * uses("NORMAL") + 2 * (uses("TEXCOORD_0") + uses("TEXCOORD_1")) + 4 * uses("COLOR_0");
        self.spend((4 * floats).saturating_mul(vertices), span)?;
        let columns = Columns { attributes, count, some: some.as_deref(), span };
        let read = |name: &str| columns.check(name, source.accessor(attributes, name)?);
        let mut part = Part {
            positions: columns.vectors(&columns.check("POSITION", Some(positions))?),
            normals: columns.vectors(&read("NORMAL")?),
            uvs: [columns.vectors(&read("TEXCOORD_0")?), columns.vectors(&read("TEXCOORD_1")?)],
            colors: columns.colors(read("COLOR_0")?),
            indices,
            material: primitive.pick("material", "material", self.list("materials")?)?.map(|(i, _)| i),
            span,
        };
        pose.morph(source, primitive, &columns, &mut part)?;
        pose.bend(source, &columns, &mut part)?;
        let finite = part.positions.iter().flatten().all(|x| x.is_finite())
            && part.uvs.iter().flatten().flatten().chain(part.colors.iter().flatten()).all(|x| x.is_finite());
        if !finite {
            return Err(Fault::new(
                "out-of-range",
                "a position, texture coordinate or colour is not finite",
                span,
            ));
        }
        for v in part.uvs.iter_mut().flatten() {
            // Theirs grow downward.
            v[1] = 1.0 - v[1];
        }
        part.repair_normals();
        Ok(Some(part))
    }
}

/// The attributes of a primitive: as many vectors each as there are vertices.
pub(super) struct Columns<'a> {
    pub attributes: &'a Value<'a>,
    pub count: usize,
    /// The vertices that are used, if not all are.
    pub some: Option<&'a [u32]>,
    pub span: Span,
}

impl Columns<'_> {
    pub(super) fn check<'b>(&self, name: &str, column: Option<Accessor<'b>>) -> Known<Option<Accessor<'b>>> {
        let least = match name.split('_').next() {
            Some("TEXCOORD") => 2,
            Some("JOINTS" | "WEIGHTS") => 4,
            _ => 3,
        };
        match column {
            Some(column) if column.count != self.count || column.width < least => {
                let text = format!(
                    "`{name}` has {} vectors of {} numbers for {} vertices",
                    column.count, column.width, self.count
                );
                Err(Fault::new("conflict", text, self.attributes.get(name).map_or(self.span, Value::span)))
            }
            column => Ok(column),
        }
    }

    /// None where there is no column.
    pub(super) fn vectors<const N: usize>(&self, column: &Option<Accessor<'_>>) -> Vec<[f32; N]> {
        match (column, self.some) {
            (None, _) => Vec::new(),
            (Some(column), None) => column.floats(),
            (Some(column), Some(some)) => column.floats_at(some),
        }
    }

    fn colors(&self, column: Option<Accessor<'_>>) -> Vec<[f32; 4]> {
        let positive = |c: [f32; 4]| c.map(|x| x.max(0.0));
        match &column {
            Some(three) if three.width == 3 => {
                self.vectors(&column).into_iter().map(|[r, g, b]| positive([r, g, b, 1.0])).collect()
            }
            _ => self.vectors(&column).into_iter().map(positive).collect(),
        }
    }
}

/// The triangles of a list (4), strip (5) or fan (6) of vertices (§3.7.2.1); those that name a vertex twice are none.
fn triangles(mode: u64, order: Option<&Accessor<'_>>, count: usize) -> Vec<[u32; 3]> {
    if mode == 4
        && let Some(mut all) = order.and_then(Accessor::triangles)
    {
        all.retain(proper);
        return all;
    }
    let order: Vec<u32> = match order {
        Some(order) => order.wholes::<1>().into_iter().map(|[i]| i).collect(),
        None => (0..count as u32).collect(),
    };
    let windows = |f: fn(usize, &[u32]) -> [u32; 3]| {
        order.windows(3).enumerate().map(|(i, w)| f(i, w)).collect::<Vec<_>>()
    };
    let mut all = match mode {
        5 => windows(|i, w| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] }),
        6 => {
            let first = order.first().copied().unwrap_or(0);
            order.get(1..).unwrap_or(&[]).windows(2).map(|w| [first, w[0], w[1]]).collect()
        }
        _ => order.chunks_exact(3).map(|w| [w[0], w[1], w[2]]).collect(),
    };
    all.retain(proper);
    all
}

fn proper(t: &[u32; 3]) -> bool {
    t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
}

/// The vertices that are used, in order; the triangles are numbered by them from now on.
fn compact(triangles: &mut [[u32; 3]]) -> Vec<u32> {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for corner in triangles.iter_mut().flatten() {
        // Every one is there.
        *corner = used.partition_point(|u| u < corner) as u32;
    }
    used
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans() {
        assert_eq!(triangles(4, None, 7), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(triangles(5, None, 5), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(triangles(6, None, 5), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert!(
            [4, 5, 6].iter().all(|m| triangles(*m, None, 2).is_empty() && triangles(*m, None, 0).is_empty())
        );
    }

    #[test]
    fn only_vertices_in_use_are_kept() {
        let mut triangles = [[7, 90, 3], [3, 90, 12]];
        assert_eq!(compact(&mut triangles), [3, 7, 12, 90]);
        assert_eq!(triangles, [[1, 3, 0], [0, 3, 2]]);
    }
}
