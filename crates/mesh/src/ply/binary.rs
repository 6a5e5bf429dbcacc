use super::header::{Element, Scalar};
use super::{Faces, Source, VertexLayout, place};
use crate::{MeshError, TriangleMesh};

/// Values of a binary file; `BIG`: most significant byte first.
pub(super) struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
    at: usize,
}

/// The first `N` bytes as a number of little-endian order.
fn head<const N: usize, const BIG: bool>(bytes: &[u8]) -> [u8; N] {
    let mut head = [0; N];
    head.copy_from_slice(&bytes[..N]);
    if BIG {
        head.reverse();
    }
    head
}

fn f32_of<const BIG: bool>(b: &[u8]) -> f32 {
    f32::from_le_bytes(head::<4, BIG>(b))
}

fn u32_of<const BIG: bool>(b: &[u8]) -> u32 {
    u32::from_le_bytes(head::<4, BIG>(b))
}

fn value_of<const BIG: bool>(kind: Scalar, b: &[u8]) -> f64 {
    match kind {
        Scalar::I8 => f64::from(i8::from_le_bytes(head::<1, BIG>(b))),
        Scalar::U8 => f64::from(b[0]),
        Scalar::I16 => f64::from(i16::from_le_bytes(head::<2, BIG>(b))),
        Scalar::U16 => f64::from(u16::from_le_bytes(head::<2, BIG>(b))),
        Scalar::I32 => f64::from(i32::from_le_bytes(head::<4, BIG>(b))),
        Scalar::U32 => f64::from(u32_of::<BIG>(b)),
        Scalar::F32 => f64::from(f32_of::<BIG>(b)),
        Scalar::F64 => f64::from_le_bytes(head::<8, BIG>(b)),
    }
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(bytes: &'a [u8], header: usize) -> Self {
        Self { bytes, at: header }
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn truncated(&self) -> MeshError {
        self.error("the data end too early".into(), "the file is cut off: export the mesh again")
    }

    /// Triangles and polygons whose list has lengths of `LENGTH` bytes (unsigned) and 32-bit indices,
    /// `before` bytes of other properties before it and `after` behind.
    fn lists<const LENGTH: usize>(
        &mut self,
        count: usize,
        before: usize,
        after: usize,
        faces: &mut Faces,
    ) -> Result<(), MeshError> {
        let triangle = before + LENGTH + 12 + after;
        faces.triangles.reserve(count.min(self.rest().len() / triangle));
        let mut rest = self.rest();
        let length_of = |b: &[u8]| if LENGTH == 1 { u32::from(b[0]) } else { u32_of::<BIG>(b) } as usize;
        for _ in 0..count {
            if let Some((row, behind)) = rest.split_at_checked(triangle)
                && length_of(&row[before..]) == 3
            {
                let list = &row[before + LENGTH..before + LENGTH + 12];
                faces.triangles.push([
                    u32_of::<BIG>(&list[..4]),
                    u32_of::<BIG>(&list[4..8]),
                    u32_of::<BIG>(&list[8..12]),
                ]);
                rest = behind;
                continue;
            }
            self.at = self.bytes.len() - rest.len();
            let length = rest.get(before..before + LENGTH).map(length_of).ok_or_else(|| self.truncated())?;
            let from = before + LENGTH;
            let end =
                length.checked_mul(4).and_then(|n| n.checked_add(from)).ok_or_else(|| self.truncated())?;
            let list = rest.get(from..end).ok_or_else(|| self.truncated())?;
            let start = faces.corners.len();
            faces.corners.extend(list.chunks_exact(4).map(u32_of::<BIG>));
            faces.close(start);
            rest = rest.get(end + after..).ok_or_else(|| self.truncated())?;
        }
        self.at = self.bytes.len() - rest.len();
        Ok(())
    }
}

impl<const BIG: bool> Source for Binary<'_, BIG> {
    fn value(&mut self, kind: Scalar) -> Result<f64, MeshError> {
        let bytes = self.rest().get(..kind.size()).ok_or_else(|| self.truncated())?;
        self.at += kind.size();
        Ok(value_of::<BIG>(kind, bytes))
    }

    fn left(&self) -> usize {
        self.rest().len()
    }

    fn least_size(kind: Scalar) -> usize {
        kind.size()
    }

    fn error(&self, message: String, help: &str) -> MeshError {
        MeshError::new(place(self.bytes, self.at, false), message, help)
    }

    fn sweep_vertices(&mut self, element: &Element, layout: &VertexLayout, mesh: &mut TriangleMesh) -> bool {
        if element.properties.iter().any(|p| p.list.is_some()) {
            return false;
        }
        let mut offsets = Vec::new();
        let mut stride = 0;
        for property in &element.properties {
            offsets.push((stride, property.kind));
            stride += property.kind.size();
        }
        // The caller may have allowed for one byte more than there is.
        let Some(data) = self.rest().get(..stride * mesh.positions.len()) else { return false };
        self.at += data.len();
        columns::<3, BIG, _>(data, stride, layout.position.map(|p| offsets[p]), &mut mesh.positions);
        if let Some(normal) = layout.normal {
            columns::<3, BIG, _>(data, stride, normal.map(|p| offsets[p]), &mut mesh.normals);
        }
        if let Some(uv) = layout.uv {
            columns::<2, BIG, _>(data, stride, uv.map(|p| offsets[p]), &mut mesh.uvs);
        }
        if let Some(uv2) = layout.uv2 {
            columns::<2, BIG, _>(data, stride, uv2.map(|p| offsets[p]), &mut mesh.uvs2);
        }
        if let Some((rgb, alpha)) = layout.color {
            let of = |row: &[u8], p: usize| value_of::<BIG>(offsets[p].1, &row[offsets[p].0..]) as f32;
            for (color, row) in mesh.colors.iter_mut().zip(data.chunks_exact(stride)) {
                let [r, g, b] = rgb.map(|p| offsets[p].1.color(of(row, p)));
                *color = [r, g, b, alpha.map_or(1.0, |p| offsets[p].1.share(of(row, p)))];
            }
        }
        true
    }

    fn sweep_faces(&mut self, element: &Element, list: usize, faces: &mut Faces) -> Result<bool, MeshError> {
        let property = &element.properties[list];
        let lists = element.properties.iter().filter(|p| p.list.is_some()).count();
        let Some(length) = property.list else { return Ok(false) };
        if lists != 1 || !matches!(property.kind, Scalar::I32 | Scalar::U32) {
            return Ok(false);
        }
        let Ok(count) = usize::try_from(element.count) else { return Ok(false) };
        let before = element.properties[..list].iter().map(|p| p.kind.size()).sum();
        let after = element.properties[list + 1..].iter().map(|p| p.kind.size()).sum();
        match length {
            Scalar::U8 => self.lists::<1>(count, before, after, faces)?,
            Scalar::U32 | Scalar::I32 => self.lists::<4>(count, before, after, faces)?,
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// Reads `N` values of each row, at the given offsets and types.
fn columns<const N: usize, const BIG: bool, V: From<[f32; N]>>(
    data: &[u8],
    stride: usize,
    columns: [(usize, Scalar); N],
    out: &mut [V],
) {
    let rows = out.iter_mut().zip(data.chunks_exact(stride));
    let first = columns[0].0;
    let in_a_run = columns.iter().enumerate().all(|(i, c)| *c == (first + 4 * i, Scalar::F32));
    if in_a_run {
        for (value, row) in rows {
            let run = &row[first..first + 4 * N];
            *value = V::from(std::array::from_fn(|i| f32_of::<BIG>(&run[4 * i..])));
        }
    } else {
        for (value, row) in rows {
            *value = V::from(columns.map(|(offset, kind)| value_of::<BIG>(kind, &row[offset..]) as f32));
        }
    }
}
