//! Shapes: to surfaces of the description, with material, light and placement.

use std::collections::BTreeMap;

use scenefile::desc::{Emission, Material, MaterialKind, MaterialRef, Normals, Object, Shape};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::Params;
use super::subdivision;
use crate::curve;
use crate::surfaces::{self, Mesh};

/// Vertices that a tessellated shape has at most.
const MOST_VERTICES: u64 = 1 << 26;

impl Importer {
    pub(super) fn shape(&mut self, kind: &str, at: Span, params: &Params) {
        let material = self.current_material(params.span);
        let emission = self.emission(params.span);
        let emission = emission.filter(|e| gives_light(e));
        self.alpha(params);
        let made = match kind {
            "trianglemesh" => self.triangle_mesh(params).map(|m| self.triangles(m, params)),
            "plymesh" => Some(self.ply_mesh(params, material.as_ref(), emission.is_some())),
            "bilinearmesh" => self.bilinear_mesh(params).map(|m| self.triangles(m, params)),
            "loopsubdiv" => self.loop_subdivision(params).map(|m| self.triangles(m, params)),
            "curve" => self.curve_shape(params).map(|m| self.triangles(m, params)),
            "sphere" => Some(self.sphere(params)),
            "disk" => Some(self.disk(params)),
            "cylinder" | "cone" | "paraboloid" => {
                self.quadric(kind, params).map(|m| self.triangles(m, params))
            }
            "heightfield" | "heightfield2" | "hyperboloid" | "nurbs" => {
                let text = format!("the shape `{kind}` is not rendered");
                self.report.instead(text, "it is left out", params.span);
                params.ignore(&[
                    "Pz", "nu", "nv", "uorder", "vorder", "uknots", "vknots", "u0", "v0", "u1", "v1",
                ]);
                params.ignore(&["P", "Pw", "p1", "p2", "phimax"]);
                return;
            }
            _ => {
                self.report.error("unknown-kind", format!("there is no shape `{kind}`"), at);
                return;
            }
        };
        let Some(shape) = made.flatten() else { return };
        if material.is_none() {
            if let Some(emission) = emission {
                let text = "a surface that is no more than an interface does not shine in pbrt";
                self.report.instead(text, "it is left out", emission.span.unwrap_or(params.span));
            }
            return;
        }
        let place = match self.object {
            Some(_) => self.graphics.ctm,
            None => self.mirror.after(&self.graphics.ctm),
        };
        let object = Object {
            name: None,
            shape: Sourced::at(shape, params.span),
            material,
            transform: place.steps(),
            flip_normals: self.graphics.reverse,
            emission,
            light_group: None,
        };
        let object = Sourced::at(object, params.span);
        match &mut self.object {
            Some(open) => open.group.objects.push(object),
            None => self.desc.objects.push(object),
        }
    }

    fn alpha(&mut self, params: &Params) {
        for name in ["alpha", "shadowalpha"] {
            if let Some(param) = params.any(name)
                && param.numbers().first() != Some(&1.0)
            {
                let text = "the opacity of shapes is not rendered";
                self.report.instead(text, "they are opaque", param.span);
            }
        }
    }

    /// A mesh in place; `None` where nothing of it has an area, which is said.
    fn triangles(&mut self, mut mesh: Mesh, params: &Params) -> Option<Shape> {
        mesh.repair();
        if mesh.indices.is_empty() {
            self.report.instead(format!("{} has no area", params.what), "it is left out", params.span);
            return None;
        }
        Some(Shape::Triangles {
            positions: mesh.positions,
            indices: mesh.indices,
            vertex_normals: mesh.normals,
            uvs: mesh.uvs,
            uvs2: Vec::new(),
            colors: Vec::new(),
            normals: Normals::Given,
        })
    }

    /// Vertices, normals and texture coordinates of a mesh; what does not match is an error.
    fn vertices(&mut self, params: &Params) -> Option<Mesh> {
        let positions = params.triples("P");
        let normals = params.triples("N");
        let uvs = params.pairs(&["uv", "st"]);
        if positions.is_empty() {
            self.report.error("missing-parameter", format!("{} has no points `P`", params.what), params.span);
            return None;
        }
        let count = positions.len();
        for (what, n) in [("normals", normals.len()), ("texture coordinates", uvs.len())] {
            if n != 0 && n != count {
                let text = format!("{} has {n} {what} for {count} points", params.what);
                self.report.error("parameter", text, params.span);
                return None;
            }
        }
        Some(Mesh::new(&positions, &normals, &uvs))
    }

    fn faces<const N: usize>(&mut self, params: &Params, count: usize) -> Option<Vec<[u32; N]>> {
        let mut indices = params.indices(&mut self.report, "indices", count)?;
        if params.any("indices").is_none() {
            if count != N {
                let text = format!("{} has no `indices`", params.what);
                self.report.error("missing-parameter", text, params.span);
                return None;
            }
            indices = (0..N as u32).collect();
        }
        if indices.len() % N != 0 {
            let text = format!("{} has {} indices, which {N} do not divide", params.what, indices.len());
            self.report.error("parameter", text, params.span);
            return None;
        }
        Some(indices.chunks_exact(N).map(|c| std::array::from_fn(|i| c[i])).collect())
    }

    fn triangle_mesh(&mut self, params: &Params) -> Option<Mesh> {
        // Tangents are of no use without hair or anisotropy along them; face indices are for textures of Ptex.
        params.ignore(&["S", "faceIndices"]);
        let mesh = self.vertices(params)?;
        let indices = self.faces::<3>(params, mesh.positions.len())?;
        Some(Mesh { indices, ..mesh })
    }

    fn bilinear_mesh(&mut self, params: &Params) -> Option<Mesh> {
        if let Some(file) = params.any("emissionfilename") {
            let text = "the image of an area light is not rendered";
            self.report.instead(text, "it shines in one colour", file.span);
        }
        params.ignore(&["faceIndices"]);
        let mesh = self.vertices(params)?;
        let patches = self.faces::<4>(params, mesh.positions.len())?;
        if patches.len() as u64 * surfaces::PATCH_VERTICES > MOST_VERTICES {
            self.report.error("too-large", format!("{} has too many patches", params.what), params.span);
            return None;
        }
        Some(surfaces::bilinear(&mesh, &patches))
    }

    fn loop_subdivision(&mut self, params: &Params) -> Option<Mesh> {
        params.ignore(&["scheme"]);
        let levels = params.any("nlevels").map_or("levels", |_| "nlevels");
        let levels = params.integer(&mut self.report, levels, 3, [0, 16]);
        let mesh = self.vertices(params)?;
        let indices = self.faces::<3>(params, mesh.positions.len())?;
        let corners = 3 * indices.len() as u64;
        if corners << (2 * levels) > MOST_VERTICES {
            self.report.error("too-large", format!("{} makes too many triangles", params.what), params.span);
            return None;
        }
        match subdivision::subdivide(&mesh.positions, &indices, levels) {
            Some(mesh) => Some(mesh),
            None => {
                let text = format!("{} joins more than two triangles at an edge", params.what);
                self.report.instead(text, "it is not subdivided", params.span);
                Some(Mesh { indices, ..mesh })
            }
        }
    }

    fn curve_shape(&mut self, params: &Params) -> Option<Mesh> {
        params.ignore(&["splitdepth"]);
        let width = params.number_or("width", 1.0);
        let widths = [params.number_or("width0", width), params.number_or("width1", width)];
        let degree = params.integer(&mut self.report, "degree", 3, [2, 3]);
        let basis = match params.text("basis") {
            None | Some("bezier") => curve::Basis::Bezier,
            Some("bspline") => curve::Basis::BSpline,
            Some(other) => {
                self.report.error(
                    "parameter",
                    format!("`{other}` is none of bezier and bspline"),
                    params.span,
                );
                return None;
            }
        };
        let form = match params.text("type") {
            Some("cylinder") => curve::Form::Tube,
            Some("ribbon") => curve::Form::Ribbon,
            _ => {
                let text = "a flat curve does not turn to each ray";
                self.report.instead(text, "it is a round tube", params.span);
                curve::Form::Tube
            }
        };
        let (points, normals) = (params.triples("P"), params.triples("N"));
        let made = curve::tessellate(&points, degree as usize, basis, form, widths, &normals);
        if made.is_none() {
            let text = format!("the number of points of {} does not fit its degree and basis", params.what);
            self.report.error("parameter", text, params.span);
        }
        made
    }

    fn ply_mesh(&mut self, params: &Params, material: Option<&MaterialRef>, shines: bool) -> Option<Shape> {
        let Some(file) = params.find("filename", &["string"]) else {
            self.report.error("missing-parameter", format!("{} has no `filename`", params.what), params.span);
            return None;
        };
        if let Some(displaced) = params.any("displacement") {
            self.report.instead("displacement is not rendered", "the surface is smooth", displaced.span);
            params.ignore(&["edgelength", "displacement.uvscale"]);
        }
        let path = self.find_file(file.text().unwrap_or_default());
        // pbrt turns faces to the side of their normals. It shows where the sides differ: only then is the file read here.
        let sides = shines || material.is_some_and(|m| has_sides(&self.desc.materials, m));
        if sides && let Ok(read) = mesh::read(self.base.join(&path)) {
            let mut turned = Mesh::from(read);
            if turned.turn_to_normals() {
                return self.triangles(turned, params);
            }
        }
        Some(Shape::Mesh { file: Sourced::at(path, file.span), normals: Normals::Given })
    }

    fn sphere(&mut self, params: &Params) -> Option<Shape> {
        let radius = params.positive(&mut self.report, "radius", 1.0);
        let z = [("zmin", -radius), ("zmax", radius)]
            .map(|(name, all)| params.number_or(name, all).clamp(-radius, radius));
        let turn = params.number_or("phimax", 360.0);
        if z == [-radius, radius] && turn >= 360.0 {
            return Some(Shape::Sphere { center: [0.0; 3], radius: radius as f32 });
        }
        let mesh = surfaces::sphere(radius, z[0].min(z[1]), z[0].max(z[1]), turn.clamp(0.0, 360.0));
        self.triangles(mesh, params)
    }

    fn disk(&mut self, params: &Params) -> Option<Shape> {
        let radius = params.positive(&mut self.report, "radius", 1.0);
        let (height, inner) = (params.number_or("height", 0.0), params.number_or("innerradius", 0.0));
        let turn = params.number_or("phimax", 360.0);
        if inner <= 0.0 && turn >= 360.0 {
            let center = [0.0, 0.0, height as f32];
            return Some(Shape::Disk { center, normal: [0.0, 0.0, 1.0], radius: radius as f32 });
        }
        self.triangles(
            surfaces::disk(radius, inner.clamp(0.0, radius), height, turn.clamp(0.0, 360.0)),
            params,
        )
    }

    fn quadric(&mut self, kind: &str, params: &Params) -> Option<Mesh> {
        let radius = params.positive(&mut self.report, "radius", 1.0);
        let turn = params.number_or("phimax", 360.0).clamp(0.0, 360.0);
        Some(match kind {
            "cylinder" => surfaces::cylinder(
                radius,
                params.number_or("zmin", -1.0),
                params.number_or("zmax", 1.0),
                turn,
            ),
            "cone" => surfaces::cone(radius, params.positive(&mut self.report, "height", 1.0), turn),
            _ => {
                let top = params.positive(&mut self.report, "zmax", 1.0);
                surfaces::paraboloid(radius, params.number_or("zmin", 0.0).clamp(0.0, top), top, turn)
            }
        })
    }
}

/// Whether any of it arrives.
fn gives_light(emission: &Emission) -> bool {
    match emission.amount {
        scenefile::desc::EmissionAmount::Radiance(rgb) => rgb.iter().any(|c| *c > 0.0),
        scenefile::desc::EmissionAmount::Power { watts, .. } => watts > 0.0,
    }
}

/// Whether it matters which side of a surface is its front.
fn has_sides(materials: &BTreeMap<String, Sourced<Material>>, material: &MaterialRef) -> bool {
    let kind = match material {
        MaterialRef::Named(name) => materials.get(&name.value).map(|m| &m.kind),
        MaterialRef::Inline(material) => Some(&material.kind),
    };
    matches!(kind, Some(MaterialKind::Dielectric { .. }))
}
