//! PLY: polygons in text or binary of either byte order.
//!
//! Elements and properties may come in any order and of any type; those that are not known are skipped. Read are
//! `x y z`, `nx ny nz`, one of `u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`, a second set `u2 v2`, and colours
//! `red green blue` with or without `alpha` of the element `vertex`, and the list `vertex_indices` or `vertex_index` of the
//! element `face`. Colours that are floats are linear; whole numbers are shares of their type's greatest, encoded as sRGB
//! but for alpha.
//! Facts of the format: Turk, *The PLY Polygon File Format*, 1994.

mod ascii;
mod binary;
mod header;

use math::{Vec2, Vec3};

use crate::assemble::{MAX_COUNT, finish, linear_from_srgb};
use crate::polygon::triangulate;
use crate::{MeshError, Place, TriangleMesh};
use header::{Element, Format, Property, Scalar};

/// Reads the triangles of a PLY file; polygons are cut into triangles, which follow those that were triangles.
/// Time is linear in the file, memory at most a small multiple of its size.
///
/// # Errors
/// Where the header is malformed, counts are larger than the file can hold, the file is cut off, an index is out of
/// range, a number not finite, or no triangle there.
pub fn parse(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    let header = header::parse(bytes)?;
    let mut content = Content::default();
    let elements = &header.elements;
    match header.format {
        Format::Ascii => content.read(elements, &mut ascii::Ascii::new(bytes, header.length))?,
        Format::LittleEndian => {
            content.read(elements, &mut binary::Binary::<false>::new(bytes, header.length))?
        }
        Format::BigEndian => {
            content.read(elements, &mut binary::Binary::<true>::new(bytes, header.length))?
        }
    }
    content.finish()
}

/// What yields values in the order of the file.
trait Source {
    /// The next value; exact for every type.
    fn value(&mut self, kind: Scalar) -> Result<f64, MeshError>;

    /// Bytes left, and how many a value of the type takes at least.
    fn left(&self) -> usize;
    fn least_size(kind: Scalar) -> usize;

    /// An error at the place reached.
    fn error(&self, message: String, help: &str) -> MeshError;

    /// Reads a whole vertex or face element in one sweep where its layout allows; `false` where nothing was read.
    fn sweep_vertices(&mut self, _: &Element, _: &VertexLayout, _: &mut TriangleMesh) -> bool {
        false
    }
    fn sweep_faces(&mut self, _: &Element, _list: usize, _: &mut Faces) -> Result<bool, MeshError> {
        Ok(false)
    }
}

/// Which property of a vertex holds what.
struct VertexLayout {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    uv2: Option<[usize; 2]>,
    color: Option<([usize; 3], Option<usize>)>,
}

impl VertexLayout {
    fn of(element: &Element) -> Option<Self> {
        let find = |name: &str| element.properties.iter().position(|p| p.list.is_none() && p.name == name);
        let triple = |names: [&str; 3]| Some([find(names[0])?, find(names[1])?, find(names[2])?]);
        let uv = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]]
            .iter()
            .find_map(|names| Some([find(names[0])?, find(names[1])?]));
        let color = triple(["red", "green", "blue"]).map(|rgb| (rgb, find("alpha")));
        let uv2 = find("u2").zip(find("v2")).map(|(u, v)| [u, v]);
        Some(Self { position: triple(["x", "y", "z"])?, normal: triple(["nx", "ny", "nz"]), uv, uv2, color })
    }
}

impl Scalar {
    /// A value as a share: of the greatest of its type, or as it is where that is a float.
    fn share(self, x: f32) -> f32 {
        x / match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => i32::MAX as f32,
            Self::U32 => u32::MAX as f32,
            Self::F32 | Self::F64 => 1.0,
        }
    }

    /// A value as a linear colour.
    fn color(self, x: f32) -> f32 {
        match self {
            Self::F32 | Self::F64 => x,
            _ => linear_from_srgb(self.share(x)),
        }
    }
}

/// Faces as read: vertices may come later in the file, so that polygons can't be cut yet.
#[derive(Default)]
struct Faces {
    triangles: Vec<[u32; 3]>,
    corners: Vec<u32>,
    /// Where the corners of each polygon end.
    ends: Vec<usize>,
}

#[derive(Default)]
struct Content {
    mesh: TriangleMesh,
    faces: Faces,
    seen_vertices: bool,
}

impl Content {
    fn read<S: Source>(&mut self, elements: &[Element], source: &mut S) -> Result<(), MeshError> {
        for element in elements.iter().filter(|e| !e.properties.is_empty()) {
            let least: usize =
                element.properties.iter().map(|p| S::least_size(p.list.unwrap_or(p.kind))).sum();
            // The last value of a text needs no separator after it.
            if element.count.saturating_mul(least as u64) > source.left() as u64 + 1 {
                return Err(source.error(
                    format!(
                        "{} `{}` elements need {} bytes or more, but {} are left",
                        element.count,
                        element.name,
                        element.count.saturating_mul(least as u64),
                        source.left()
                    ),
                    "the file is cut off or its header wrong: export the mesh again",
                ));
            }
            match element.name.as_str() {
                "vertex" => self.vertices(element, source)?,
                "face" => self.faces(element, source)?,
                _ => skip(element, source)?,
            }
        }
        Ok(())
    }

    fn vertices<S: Source>(&mut self, element: &Element, source: &mut S) -> Result<(), MeshError> {
        let layout = VertexLayout::of(element)
            .ok_or_else(|| source.error("vertices without x, y and z".into(), "export the mesh again"))?;
        if self.seen_vertices || element.count > MAX_COUNT as u64 {
            return Err(source.error(
                format!("a second `vertex` element, or more than {MAX_COUNT} vertices"),
                "split the file into one for each mesh",
            ));
        }
        self.seen_vertices = true;
        let count = element.count as usize;
        let mesh = &mut self.mesh;
        mesh.positions = vec![Vec3::ZERO; count];
        mesh.normals = vec![Vec3::ZERO; if layout.normal.is_some() { count } else { 0 }];
        mesh.uvs = vec![Vec2::ZERO; if layout.uv.is_some() { count } else { 0 }];
        mesh.uvs2 = vec![Vec2::ZERO; if layout.uv2.is_some() { count } else { 0 }];
        mesh.colors = vec![[1.0; 4]; if layout.color.is_some() { count } else { 0 }];
        if source.sweep_vertices(element, &layout, mesh) {
            return Ok(());
        }
        let mut values = vec![0.0; element.properties.len()];
        for i in 0..count {
            for (value, property) in values.iter_mut().zip(&element.properties) {
                if let Some(length) = list_length(property, source)? {
                    for _ in 0..length {
                        source.value(property.kind)?;
                    }
                } else {
                    *value = source.value(property.kind)? as f32;
                }
            }
            mesh.positions[i] = Vec3::from_array(layout.position.map(|p| values[p]));
            if let Some(normal) = layout.normal {
                mesh.normals[i] = Vec3::from_array(normal.map(|p| values[p]));
            }
            if let Some(uv) = layout.uv {
                mesh.uvs[i] = Vec2::from_array(uv.map(|p| values[p]));
            }
            if let Some(uv2) = layout.uv2 {
                mesh.uvs2[i] = Vec2::from_array(uv2.map(|p| values[p]));
            }
            if let Some((rgb, alpha)) = layout.color {
                let share = |p: usize| element.properties[p].kind.share(values[p]);
                let color = |p: usize| element.properties[p].kind.color(values[p]);
                let [r, g, b] = rgb.map(color);
                mesh.colors[i] = [r, g, b, alpha.map_or(1.0, share)];
            }
        }
        Ok(())
    }

    fn faces<S: Source>(&mut self, element: &Element, source: &mut S) -> Result<(), MeshError> {
        let is_indices =
            |p: &Property| p.list.is_some() && matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
        let Some(list) = element.properties.iter().position(is_indices) else {
            return Err(source.error("faces without a list `vertex_indices`".into(), "export the mesh again"));
        };
        if source.sweep_faces(element, list, &mut self.faces)? {
            return Ok(());
        }
        for _ in 0..element.count {
            for (p, property) in element.properties.iter().enumerate() {
                let length = list_length(property, source)?;
                if p != list {
                    for _ in 0..length.unwrap_or(1) {
                        source.value(property.kind)?;
                    }
                    continue;
                }
                let length = length.unwrap_or(0);
                let start = self.faces.corners.len();
                for _ in 0..length {
                    let index = source.value(property.kind)?;
                    if !(0.0..f64::from(u32::MAX)).contains(&index) || index.fract() != 0.0 {
                        return Err(out_of_range(source, index));
                    }
                    self.faces.corners.push(index as u32);
                }
                self.faces.close(start);
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<TriangleMesh, MeshError> {
        let vertices = self.mesh.positions.len();
        let outside = |i: &&u32| **i as usize >= vertices;
        let worst =
            self.faces.triangles.iter().flatten().find(outside).or(self.faces.corners.iter().find(outside));
        if let Some(i) = worst {
            return Err(MeshError::whole(
                format!("a face names vertex {i} (counting from 0), but there are {vertices}"),
                "the file is damaged: export the mesh again",
            ));
        }
        self.mesh.indices = self.faces.triangles;
        let mut start = 0;
        let mut polygon = Vec::new();
        for end in self.faces.ends {
            let corners = &self.faces.corners[start..end];
            start = end;
            polygon.clear();
            polygon.extend(corners.iter().map(|&v| self.mesh.positions[v as usize]));
            if polygon.iter().all(|p| p.is_finite()) {
                triangulate(&polygon, |t| self.mesh.indices.push(t.map(|k| corners[k])));
            }
        }
        finish(self.mesh)
    }
}

impl Faces {
    /// Takes the corners from `start` on as one face. Faces of fewer than three corners are nothing.
    fn close(&mut self, start: usize) {
        match self.corners[start..] {
            [] | [_] | [_, _] => self.corners.truncate(start),
            [a, b, c] => {
                self.triangles.push([a, b, c]);
                self.corners.truncate(start);
            }
            _ => self.ends.push(self.corners.len()),
        }
    }
}

fn out_of_range<S: Source>(source: &S, index: f64) -> MeshError {
    source.error(format!("{index} is no vertex index"), "the file is damaged: export the mesh again")
}

/// The length of a list property, `None` for a single value. Refuses what the file can't hold.
fn list_length<S: Source>(property: &Property, source: &mut S) -> Result<Option<usize>, MeshError> {
    let Some(kind) = property.list else { return Ok(None) };
    let length = source.value(kind)?;
    if length < 0.0
        || length.fract() != 0.0
        || length * S::least_size(property.kind) as f64 > source.left() as f64 + 1.0
    {
        return Err(source.error(
            format!("a list `{}` of {length} values, but {} bytes are left", property.name, source.left()),
            "the file is cut off or damaged: export the mesh again",
        ));
    }
    Ok(Some(length as usize))
}

fn skip<S: Source>(element: &Element, source: &mut S) -> Result<(), MeshError> {
    for _ in 0..element.count {
        for property in &element.properties {
            for _ in 0..list_length(property, source)?.unwrap_or(1) {
                source.value(property.kind)?;
            }
        }
    }
    Ok(())
}

/// The place of a byte: its line in a text, else its offset.
fn place(bytes: &[u8], at: usize, text: bool) -> Place {
    let at = at.min(bytes.len());
    if text {
        Place::Line(1 + bytes[..at].iter().filter(|&&b| b == b'\n').count() as u64)
    } else {
        Place::Byte(at as u64)
    }
}

#[cfg(test)]
mod tests;
