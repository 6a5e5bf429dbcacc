//! Wavefront OBJ: polygons over `v`, `vt` and `vn`, with `usemtl` and `mtllib`.
//!
//! Groups, smoothing groups, lines, points and free-form surfaces are ignored, as are weights of vertices. Three numbers
//! behind a vertex's place are its colour, encoded as sRGB, which counts where every vertex has one.
//! Facts of the format: Wavefront, *Advanced Visualizer Manual*, appendix B1.

use std::borrow::Cow;
use std::collections::HashMap;

use math::{Vec2, Vec3};

use crate::assemble::{finish, linear_from_srgb};
use crate::polygon::triangulate;
use crate::text::{float, integer, shown, word};
use crate::{MeshError, Place, TriangleMesh};

/// A mesh with the names of its materials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjModel {
    /// The triangles of all materials.
    pub mesh: TriangleMesh,
    /// Names by `usemtl`, in order of their first use; the empty name stands for faces before the first.
    pub materials: Vec<String>,
    /// For each triangle the place of its material in `materials`.
    pub material_of_triangle: Vec<u16>,
    /// Material files by `mtllib`, as written.
    pub libraries: Vec<String>,
}

/// Reads the triangles of an OBJ file. Polygons are cut into triangles; corners with equal indices share a vertex.
/// Where normals (uvs) are given for some corners only, the others get smooth normals (uvs of zero).
///
/// # Errors
/// Where a statement is malformed, an index out of range, a number not finite, or no triangle there.
pub fn parse(bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    parse_model(bytes).map(|model| model.mesh)
}

/// As [`parse`], with the materials' names.
///
/// # Errors
/// As [`parse`], and where there are more than 65 535 materials.
pub fn parse_model(bytes: &[u8]) -> Result<ObjModel, MeshError> {
    let mut reader = Reader::default();
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut rest = bytes;
    while !rest.is_empty() {
        reader.line += 1;
        let first = reader.line;
        let line = logical_line(&mut rest, &mut reader.line);
        let last = std::mem::replace(&mut reader.line, first);
        reader.statement(&line)?;
        reader.line = last;
    }
    reader.finish()
}

/// Splits off a line, joined with those that follow a backslash at its end; counts the joined ones.
fn logical_line<'a>(rest: &mut &'a [u8], line: &mut u64) -> Cow<'a, [u8]> {
    let mut joined = Cow::Borrowed(physical_line(rest));
    while joined.last() == Some(&b'\\') && !rest.is_empty() {
        let owned = joined.to_mut();
        owned.pop();
        owned.push(b' ');
        owned.extend_from_slice(physical_line(rest));
        *line += 1;
    }
    joined
}

fn physical_line<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
    let line = &rest[..end];
    *rest = &rest[(end + 1).min(rest.len())..];
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// No texture coordinate or normal.
const NONE: u32 = u32::MAX;
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

#[derive(Default)]
struct Reader {
    line: u64,
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Of the positions, where they have any.
    colors: Vec<[f32; 4]>,
    /// Indices into positions, uvs, normals for each corner of each face.
    corners: Vec<[u32; 3]>,
    /// For each face where its corners end, and its material.
    faces: Vec<(u32, u16)>,
    /// The greatest index of each kind and its line: indices may point forward.
    greatest: [(u32, u64); 3],
    materials: Vec<String>,
    material_numbers: HashMap<String, u16>,
    material: Option<u16>,
    libraries: Vec<String>,
}

/// What follows a vertex's place, where it is a colour.
fn color(rest: &mut &[u8]) -> Option<[f32; 4]> {
    let mut rgb = [0.0; 3];
    for x in &mut rgb {
        *x = linear_from_srgb(float(word(rest)?)?);
    }
    let [r, g, b] = rgb;
    Some([r, g, b, 1.0])
}

impl Reader {
    fn error(&self, message: String, help: &str) -> MeshError {
        MeshError::new(Place::Line(self.line), message, help)
    }

    fn statement(&mut self, line: &[u8]) -> Result<(), MeshError> {
        let mut rest = line;
        match word(&mut rest) {
            Some(b"v") => {
                let [x, y, z] = self.numbers("v", &mut rest)?;
                self.positions.push(Vec3::new(x, y, z));
                self.colors.extend(color(&mut rest));
            }
            Some(b"vn") => {
                let [x, y, z] = self.numbers("vn", &mut rest)?;
                self.normals.push(Vec3::new(x, y, z));
            }
            Some(b"vt") => {
                let [u] = self.numbers("vt", &mut rest)?;
                // A one-dimensional texture has no v.
                let v = word(&mut rest).and_then(float).unwrap_or(0.0);
                self.uvs.push(Vec2::new(u, v));
            }
            // `fo` is the older spelling.
            Some(b"f" | b"fo") => self.face(rest)?,
            Some(b"usemtl") => {
                let name = String::from_utf8_lossy(rest.trim_ascii()).into_owned();
                self.material = Some(self.material_number(name)?);
            }
            Some(b"mtllib") => self.libraries.push(String::from_utf8_lossy(rest.trim_ascii()).into_owned()),
            None => {}
            Some(keyword) if keyword[0] == b'#' || keyword[0].is_ascii_alphabetic() => {}
            Some(keyword) => {
                return Err(self.error(
                    format!("`{}` begins no OBJ statement (v, vt, vn, f, …)", shown(keyword)),
                    "check that this is a Wavefront OBJ text file",
                ));
            }
        }
        Ok(())
    }

    fn numbers<const N: usize>(&self, keyword: &str, rest: &mut &[u8]) -> Result<[f32; N], MeshError> {
        let mut numbers = [0.0; N];
        for n in &mut numbers {
            let word = word(rest).ok_or_else(|| {
                self.error(
                    format!("`{keyword}` needs {N} numbers"),
                    "the line is cut off: export the mesh again",
                )
            })?;
            *n = float(word).ok_or_else(|| {
                self.error(format!("`{}` is not a number", shown(word)), "write numbers as 1.5 or -2e-3")
            })?;
        }
        Ok(numbers)
    }

    fn material_number(&mut self, name: String) -> Result<u16, MeshError> {
        if let Some(&number) = self.material_numbers.get(&name) {
            return Ok(number);
        }
        let number = u16::try_from(self.materials.len())
            .ok()
            .filter(|&n| n < u16::MAX)
            .ok_or_else(|| self.error("more than 65535 materials".into(), "merge some materials"))?;
        self.material_numbers.insert(name.clone(), number);
        self.materials.push(name);
        Ok(number)
    }

    fn face(&mut self, mut rest: &[u8]) -> Result<(), MeshError> {
        let start = self.corners.len();
        while let Some(word) = word(&mut rest) {
            if word[0] == b'#' {
                break;
            }
            let mut corner = [NONE; 3];
            for (kind, text) in word.split(|&b| b == b'/').enumerate() {
                if kind > 2 || (text.is_empty() && kind == 0) {
                    return Err(self.bad_corner(word));
                }
                if !text.is_empty() {
                    let written = integer(text).ok_or_else(|| self.bad_corner(word))?;
                    corner[kind] = self.index(kind, written)?;
                }
            }
            self.corners.push(corner);
        }
        if self.corners.len() - start < 3 {
            let n = self.corners.len() - start;
            return Err(
                self.error(format!("a face needs at least 3 corners, here are {n}"), "remove or complete it")
            );
        }
        let material = match self.material {
            Some(material) => material,
            None => {
                let number = self.material_number(String::new())?;
                *self.material.insert(number)
            }
        };
        let end = u32::try_from(self.corners.len())
            .map_err(|_| self.error("more than 4 billion corners".into(), "split the mesh"))?;
        self.faces.push((end, material));
        Ok(())
    }

    fn bad_corner(&self, word: &[u8]) -> MeshError {
        self.error(
            format!("`{}` is no corner of a face", shown(word)),
            "write corners as v, v/vt, v//vn or v/vt/vn with whole numbers",
        )
    }

    /// The 0-based index: positive ones count from 1, negative ones back from the last element so far.
    fn index(&mut self, kind: usize, written: i64) -> Result<u32, MeshError> {
        let count = [self.positions.len(), self.uvs.len(), self.normals.len()][kind] as i64;
        let index = if written > 0 { written - 1 } else { count + written };
        if written == 0 || index < 0 || index >= i64::from(NONE) {
            return Err(self.error(
                format!("{} index {written} is out of range: {count} so far", KINDS[kind]),
                "indices count from 1, or backwards from -1",
            ));
        }
        let index = index as u32;
        if index >= self.greatest[kind].0 {
            self.greatest[kind] = (index, self.line);
        }
        Ok(index)
    }

    fn finish(mut self) -> Result<ObjModel, MeshError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for kind in 0..3 {
            let (index, line) = self.greatest[kind];
            if line > 0 && index as usize >= counts[kind] {
                return Err(MeshError::new(
                    Place::Line(line),
                    format!(
                        "{} index {} is out of range: the file has {}",
                        KINDS[kind],
                        index + 1,
                        counts[kind]
                    ),
                    "the file is cut off or damaged: export the mesh again",
                ));
            }
        }
        if let Some(i) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::whole(
                format!("the position of vertex {i} (counting from 0) is {}", self.positions[i]),
                "repair the mesh: every number must be finite",
            ));
        }
        let (mesh, corner_vertices) = self.vertices();
        let mut model =
            ObjModel { mesh, materials: self.materials, libraries: self.libraries, ..Default::default() };
        let mut start = 0;
        let mut polygon = Vec::new();
        for (end, material) in self.faces {
            let corners = &corner_vertices[start..end as usize];
            start = end as usize;
            let mut emit = |t: [u32; 3]| {
                if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                    model.mesh.indices.push(t);
                    model.material_of_triangle.push(material);
                }
            };
            if let [a, b, c] = *corners {
                emit([a, b, c]);
            } else {
                polygon.clear();
                polygon.extend(corners.iter().map(|&v| model.mesh.positions[v as usize]));
                triangulate(&polygon, |t| emit(t.map(|k| corners[k])));
            }
        }
        model.mesh = finish(model.mesh)?;
        Ok(model)
    }

    /// A vertex for each different corner, and the vertex of each corner.
    fn vertices(&mut self) -> (TriangleMesh, Vec<u32>) {
        // All positions have a colour, or none counts.
        if self.colors.len() != self.positions.len() {
            self.colors.clear();
        }
        let has_uvs = self.corners.iter().any(|c| c[1] != NONE);
        let has_normals = self.corners.iter().any(|c| c[2] != NONE);
        let same = |c: &[u32; 3]| (c[1] == c[0] || !has_uvs) && (c[2] == c[0] || !has_normals);
        if self.corners.iter().all(same) {
            let mut mesh =
                TriangleMesh { positions: std::mem::take(&mut self.positions), ..Default::default() };
            if has_uvs {
                mesh.uvs = std::mem::take(&mut self.uvs);
                mesh.uvs.resize(mesh.positions.len(), Vec2::ZERO);
            }
            if has_normals {
                mesh.normals = std::mem::take(&mut self.normals);
                mesh.normals.resize(mesh.positions.len(), Vec3::Y);
            }
            mesh.colors = std::mem::take(&mut self.colors);
            return (mesh, self.corners.iter().map(|c| c[0]).collect());
        }
        let mut mesh = TriangleMesh::default();
        let mut number: HashMap<[u32; 3], u32> = HashMap::new();
        // Most positions have one corner; the map serves the rest.
        let mut first: Vec<Option<([u32; 3], u32)>> = vec![None; self.positions.len()];
        let corner_vertices = self
            .corners
            .iter()
            .map(|&corner| {
                let new = mesh.positions.len() as u32;
                let vertex = match &mut first[corner[0] as usize] {
                    Some((c, vertex)) if *c == corner => *vertex,
                    Some(_) => *number.entry(corner).or_insert(new),
                    none => none.insert((corner, new)).1,
                };
                if vertex == new {
                    mesh.positions.push(self.positions[corner[0] as usize]);
                    mesh.colors.extend(self.colors.get(corner[0] as usize));
                    if has_uvs {
                        mesh.uvs.push(self.uvs.get(corner[1] as usize).copied().unwrap_or_default());
                    }
                    if has_normals {
                        mesh.normals.push(self.normals.get(corner[2] as usize).copied().unwrap_or_default());
                    }
                }
                vertex
            })
            .collect();
        (mesh, corner_vertices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::{Expect, expect};

    fn ok(text: &str) -> TriangleMesh {
        let mesh = parse(text.as_bytes()).unwrap();
        mesh.validate().unwrap();
        mesh
    }

    fn refused(text: &str, expected: Expect) {
        expected.assert_eq(&parse(text.as_bytes()).unwrap_err().to_string());
    }

    #[test]
    fn every_form_of_a_quad_is_the_same() {
        let plain = ok("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
        assert_eq!(plain.indices, [[0, 1, 2], [0, 2, 3]]);
        for text in [
            "# c\r\nv 0 0 0\r\nv 1.0 0 0 1\r\nv 1e0 1 0 # c\r\nv 0 10e-1 0\r\ng a b\r\ns off\r\nf 1 2 3 4\r\n",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1",
            "f 1 2 3 \\\n4\nv 0 0 0\nv 1 \\\n0 0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n",
            "\u{feff}v 0 0 0\nv\t1 0 0\n  v 1 1 0\nv 0 1 0\n\n\nf 1 2 3 4 # end\nl 1 2\np 1\n",
        ] {
            assert_eq!(ok(text), plain, "{text}");
        }
    }

    #[test]
    fn corners_that_differ_are_different_vertices() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5\nvn 0 0 2\nvn 0 1 0\n\
                    f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/4/2 3/3/2\n";
        let mesh = ok(text);
        assert_eq!(mesh.positions.len(), 5);
        assert_eq!(mesh.indices, [[0, 1, 2], [1, 3, 4]]);
        assert_eq!(mesh.normals[0], Vec3::Z);
        assert_eq!(mesh.normals[3], Vec3::Y);
        assert_eq!(mesh.uvs[3], Vec2::new(0.5, 0.0));
    }

    #[test]
    fn vertex_colours_count_where_all_have_one() {
        let mesh = ok("v 0 0 0 1 0.5 0\nv 1 0 0 1 0 0\nv 0 1 0 0 0 1\nvt 0 1\nvt 1 1\nf 1/1 3/2 2/1\n");
        assert_eq!(mesh.colors.len(), 3);
        assert!((mesh.colors[0][1] - 0.214_041).abs() < 1e-5, "{:?}", mesh.colors);
        assert_eq!(mesh.colors[1], [0.0, 0.0, 1.0, 1.0]);
        assert!(ok("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n").colors.is_empty());
    }

    #[test]
    fn missing_normals_are_filled_in() {
        let mesh = ok("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 2 4 3\n");
        assert!(mesh.uvs.is_empty());
        assert_eq!(mesh.normals[0], Vec3::NEG_Z);
        assert!((mesh.normals[mesh.indices[1][1] as usize] - Vec3::Z).length() < 1e-6);
    }

    #[test]
    fn materials_are_kept_by_triangle() {
        let text = "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nusemtl red paint\nf 1 2 3 4\n\
                    usemtl blue\nf 1 3 4\nusemtl red paint\nf 1 2 4\n";
        let model = parse_model(text.as_bytes()).unwrap();
        assert_eq!(model.materials, ["", "red paint", "blue"]);
        assert_eq!(model.material_of_triangle, [0, 1, 1, 2, 1]);
        assert_eq!(model.libraries, ["a b.mtl"]);
    }

    #[test]
    fn faults_are_named_with_their_line() {
        let v = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
        refused("", expect!["there is no triangle in the file (export the mesh again, with its faces)"]);
        refused(v, expect!["there is no triangle in the file (export the mesh again, with its faces)"]);
        refused(
            &format!("{v}f 1 2\n"),
            expect!["line 4: a face needs at least 3 corners, here are 2 (remove or complete it)"],
        );
        refused(
            &format!("{v}f 1 2 5\nf 1 2 3\n"),
            expect![
                "line 4: vertex index 5 is out of range: the file has 3 (the file is cut off or damaged: export the mesh again)"
            ],
        );
        refused(
            &format!("{v}f 1 2 -4\n"),
            expect![
                "line 4: vertex index -4 is out of range: 3 so far (indices count from 1, or backwards from -1)"
            ],
        );
        refused(
            &format!("{v}f 1 2 0\n"),
            expect![
                "line 4: vertex index 0 is out of range: 3 so far (indices count from 1, or backwards from -1)"
            ],
        );
        refused(
            &format!("{v}f 1/1 2/1 3/1\n"),
            expect![
                "line 4: texture coordinate index 1 is out of range: the file has 0 (the file is cut off or damaged: export the mesh again)"
            ],
        );
        refused(
            &format!("{v}f 1 2 x\n"),
            expect![
                "line 4: `x` is no corner of a face (write corners as v, v/vt, v//vn or v/vt/vn with whole numbers)"
            ],
        );
        refused(
            "v 0 0\n",
            expect!["line 1: `v` needs 3 numbers (the line is cut off: export the mesh again)"],
        );
        refused("\n\nv 0 0 1,5\n", expect!["line 3: `1,5` is not a number (write numbers as 1.5 or -2e-3)"]);
        refused(
            &format!("{v}v 0 0 nan\nf 1 2 3\n"),
            expect![
                "the position of vertex 3 (counting from 0) is [0, 0, NaN] (repair the mesh: every number must be finite)"
            ],
        );
        refused(
            "\u{1}\u{2}\n",
            expect![
                "line 1: `\\u{1}\\u{2}` begins no OBJ statement (v, vt, vn, f, …) (check that this is a Wavefront OBJ text file)"
            ],
        );
    }
}
