//! Meshes of files.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use scenefile::desc::{Normals, Shape};
use scenefile::{Sourced, Span};

use super::Importer;
use super::plugin::Plugin;
use super::serialized;
use super::shapes::{Made, Needs, triangles};
use crate::curve::{Basis, Form, tessellate};
use crate::file;
use crate::matrix::{Matrix, add, sub, times};
use crate::surfaces::Mesh;

/// Bytes of a mesh file, at most.
const MOST_BYTES: u64 = 8 << 30;
/// Bytes of a file of curves, at most.
const MOST_CURVES: u64 = 256 << 20;
/// Bytes that a PLY header has, at most.
const HEADER: u64 = 64 << 10;

impl Importer {
    /// Which normals a mesh is shaded with.
    fn normals(&mut self, plugin: &Plugin) -> Normals {
        let report = &mut self.report;
        let flat = plugin.is(report, "face_normals");
        match plugin.number(report, "max_smooth_angle") {
            _ if flat => Normals::Flat,
            Some(angle) => Normals::Smooth { crease_degrees: angle.clamp(0.0, 180.0) as f32 },
            None => Normals::Completed,
        }
    }

    /// The file of a mesh and the place of its name; none is an error.
    fn mesh_path(&mut self, plugin: &Plugin) -> Option<(PathBuf, Span)> {
        let Some(name) = plugin.text(&mut self.report, "filename").map(str::to_owned) else {
            let text = format!("{} has no `filename`", plugin.what());
            self.report.error("missing-parameter", text, plugin.span);
            return None;
        };
        let span = plugin.find("filename").map_or(plugin.span, |p| p.span);
        Some((self.find_file(&name), span))
    }

    pub(super) fn mesh_file(
        &mut self,
        plugin: &Rc<Plugin>,
        place: Matrix,
        flipped: bool,
        needs: Needs,
    ) -> Option<Made> {
        let (path, span) = self.mesh_path(plugin)?;
        let normals = self.normals(plugin);
        plugin.ignore(&["load_materials", "srgb", "collapse", "packed", "load_visibility"]);
        let is_obj = plugin.kind == "obj";
        // Mitsuba goes by the plugin, ours by the file's name.
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        let fits = if is_obj { extension == "obj" } else { extension == "ply" || extension == "gz" };
        if !fits {
            let text = format!("{} is not called .{}", path.display(), plugin.kind);
            self.report.error("unknown-format", text, span);
            return None;
        }
        let whole = self.base.join(&path);
        let own = normals == Normals::Completed && has_normals(&whole, is_obj);
        // Where vertices have normals these tell the front, and turn with the transform; else the order of the vertices
        // does, after the transform.
        let flipped = flipped != (!own && place.determinant() < 0.0);
        if own
            && needs.sides
            && let Ok(read) = mesh::read(&whole)
        {
            let mut turned = Mesh::from(read);
            if turned.turn_to_normals() {
                turned.repair();
                return Some(Made { shape: triangles(turned), place, flipped });
            }
        }
        Some(Made { shape: Shape::Mesh { file: Sourced::at(path, span), normals }, place, flipped })
    }

    pub(super) fn serialized(&mut self, plugin: &Rc<Plugin>, place: Matrix, flipped: bool) -> Option<Made> {
        let (path, span) = self.mesh_path(plugin)?;
        let normals = self.normals(plugin);
        let index =
            plugin.integer(&mut self.report, "shape_index", [0, i64::from(u32::MAX)]).unwrap_or_default();
        let read = file::read(&self.base.join(&path), MOST_BYTES)
            .and_then(|bytes| serialized::read(&bytes, index as usize));
        let (mut mesh, faces) = match read {
            Ok(read) => read,
            Err(reason) => {
                self.report.error("mesh", format!("the mesh {} {reason}", path.display()), span);
                return None;
            }
        };
        let normals = if faces { Normals::Flat } else { normals };
        let own = normals == Normals::Completed && !mesh.normals.is_empty();
        if own {
            mesh.repair();
        } else {
            mesh.normals.clear();
            mesh.repair();
        }
        if mesh.indices.is_empty() {
            self.report.instead(format!("{} has no area", plugin.what()), "it is left out", plugin.span);
            return None;
        }
        let mut shape = triangles(mesh);
        if let Shape::Triangles { normals: wanted, .. } = &mut shape {
            *wanted = normals;
        }
        let flipped = flipped != (!own && place.determinant() < 0.0);
        Some(Made { shape, place, flipped })
    }

    /// Curves of points and radii, as tubes.
    pub(super) fn curves(&mut self, plugin: &Rc<Plugin>, place: Matrix) -> Option<Made> {
        let (path, span) = self.mesh_path(plugin)?;
        let text = match file::read(&self.base.join(&path), MOST_CURVES) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(reason) => {
                self.report.error("missing-file", format!("{} {reason}", path.display()), span);
                return None;
            }
        };
        let mut whole = Mesh::default();
        let mut curve: Vec<[f64; 4]> = Vec::new();
        for line in text.lines().chain([""]) {
            match super::build::numbers(line).as_deref() {
                Some([x, y, z, r]) => curve.push([*x, *y, *z, *r]),
                Some([]) => add_curve(&mut whole, &std::mem::take(&mut curve), plugin.kind == "bsplinecurve"),
                _ => {
                    let text = format!("{} does not hold four numbers a line", path.display());
                    self.report.error("mesh", text, span);
                    return None;
                }
            }
        }
        whole.repair();
        if whole.indices.is_empty() {
            self.report.instead(format!("{} has no area", plugin.what()), "it is left out", plugin.span);
            return None;
        }
        Some(Made { shape: triangles(whole), place, flipped: false })
    }
}

/// Adds tubes about a curve, a segment each; too few points are no curve.
fn add_curve(whole: &mut Mesh, curve: &[[f64; 4]], spline: bool) {
    let points: Vec<[f64; 3]> = curve.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let width = |i: usize| 2.0 * curve.get(i).map_or(0.0, |p| p[3]);
    let segments = curve.len().saturating_sub(if spline { 3 } else { 1 });
    for i in 0..segments {
        let made = if spline {
            // A uniform cubic B-spline passes near its inner points.
            let ends = [0, 1].map(|k| (width(i + k) + 4.0 * width(i + k + 1) + width(i + k + 2)) / 6.0);
            tessellate(&points[i..i + 4], 3, Basis::BSpline, Form::Tube, ends, &[])
        } else {
            let (a, b) = (points[i], points[i + 1]);
            let third = times(sub(b, a), 1.0 / 3.0);
            let controls = [a, add(a, third), sub(b, third), b];
            tessellate(&controls, 3, Basis::Bezier, Form::Tube, [width(i), width(i + 1)], &[])
        };
        let Some(made) = made else { continue };
        let first = whole.positions.len() as u32;
        whole.positions.extend(made.positions);
        whole.normals.extend(made.normals);
        whole.uvs.extend(made.uvs);
        whole.indices.extend(made.indices.into_iter().map(|t| t.map(|v| v + first)));
    }
}

/// Whether a mesh file has normals; `false` where it cannot be read, which is said where it is read whole.
fn has_normals(path: &Path, is_obj: bool) -> bool {
    let Ok(file) = File::open(path) else { return false };
    if is_obj {
        return obj_has_normals(BufReader::with_capacity(1 << 20, file));
    }
    let mut bytes = Vec::new();
    let packed = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    let read = if packed {
        flate2::read::MultiGzDecoder::new(file).take(HEADER).read_to_end(&mut bytes)
    } else {
        file.take(HEADER).read_to_end(&mut bytes)
    };
    let end = bytes.windows(10).position(|w| w == b"end_header").unwrap_or(bytes.len());
    let header = String::from_utf8_lossy(&bytes[..end]);
    read.is_ok() && header.lines().any(|l| l.starts_with("property") && l.trim_end().ends_with(" nx"))
}

/// Whether a line begins with `vn`.
fn obj_has_normals(mut reader: impl Read) -> bool {
    let mut chunk = vec![0; 1 << 20];
    // The last bytes before the chunk, as a line begins at the start.
    let mut tail = vec![b'\n'];
    loop {
        let Ok(n @ 1..) = reader.read(&mut chunk) else { return false };
        tail.extend(&chunk[..n]);
        if tail.windows(4).any(|w| w[0] == b'\n' && &w[1..3] == b"vn" && w[3].is_ascii_whitespace()) {
            return true;
        }
        tail.drain(..tail.len().saturating_sub(3));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_obj_files() {
        assert!(obj_has_normals(&b"v 0 0 0\nvn 0 0 1\n"[..]));
        assert!(obj_has_normals(&b"vn\t0 0 1\n"[..]));
        assert!(!obj_has_normals(&b"v 0 0 0\n#vn 0 0 1\nvnx 1"[..]));
        // In pieces as small as may be.
        struct Slow<'a>(&'a [u8]);
        impl Read for Slow<'_> {
            fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
                let Some((first, rest)) = self.0.split_first() else { return Ok(0) };
                to[0] = *first;
                self.0 = rest;
                Ok(1)
            }
        }
        assert!(obj_has_normals(Slow(b"v 0 0 0\nvn 0 0 1\n")));
        assert!(!obj_has_normals(Slow(b"v 0 0 0\nvt 0 0\n")));
    }

    #[test]
    fn curves_become_tubes() {
        let mut mesh = Mesh::default();
        add_curve(&mut mesh, &[[0.0, 0.0, 0.0, 0.1], [0.0, 0.0, 1.0, 0.1], [0.0, 1.0, 1.0, 0.2]], false);
        assert!(!mesh.indices.is_empty());
        let few = mesh.indices.len();
        add_curve(&mut mesh, &[[0.0; 4]; 3], true);
        assert_eq!(mesh.indices.len(), few, "three points make no cubic spline");
    }
}
