//! Shapes: to surfaces of the description, with material, light and placement.

use scenefile::desc::{FloatDesc, MaterialRef, Normals, Object, Shape};
use scenefile::{Sourced, Span};

use super::Importer;
use super::params::Params;
use super::subdivision;
use crate::curve;
use crate::surfaces::{self, Mesh};

/// Vertices of all shapes together that become meshes here, at most: about 1.5 GB.
const MOST_VERTICES: u64 = 1 << 25;

impl Importer {
    pub(super) fn shape(&mut self, kind: &str, at: Span, params: &Params) {
        let material = self.surface(params);
        let emission = self.emission(params.span);
        let needs = Needs {
            sides: emission.is_some() || material.as_deref().is_some_and(|m| self.has_sides(m)),
            uvs: emission.as_ref().is_some_and(|e| e.texture.is_some())
                || material.as_deref().is_some_and(|m| self.has_uv_textures(m)),
        };
        let made = match kind {
            "trianglemesh" => self.triangle_mesh(params, needs).map(|m| self.triangles(m, params)),
            "plymesh" => Some(self.ply_mesh(params, needs)),
            "bilinearmesh" => self.bilinear_mesh(params).map(|m| self.triangles(m, params)),
            "loopsubdiv" => self.loop_subdivision(params).map(|m| self.triangles(m, params)),
            "curve" => self.curve_shape(params).map(|m| self.triangles(m, params)),
            "sphere" => Some(self.sphere(params, needs)),
            "disk" => Some(self.disk(params, needs)),
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
        if kind != "trianglemesh" && !self.has_room(&shape, params) {
            return;
        }
        let Some(material) = material else {
            if let Some(emission) = emission {
                let text = "a surface that is no more than an interface does not shine in pbrt";
                self.report.instead(text, "it is left out", emission.span.unwrap_or(params.span));
            }
            return;
        };
        let place = match self.object {
            Some(_) => self.graphics.ctm,
            None => self.mirror.after(&self.graphics.ctm),
        };
        let object = Object {
            name: None,
            shape: Sourced::at(shape, params.span),
            material: Some(MaterialRef::Named(Sourced::at(material, params.span))),
            transform: place.steps(),
            displacement: None,
            flip_normals: self.graphics.reverse,
            emission,
            light_group: None,
        };
        self.add_object(Sourced::at(object, params.span), kind == "curve");
    }

    /// The key of the material of a shape with its opacity and what fills it; `None`: nothing scatters.
    fn surface(&mut self, params: &Params) -> Option<String> {
        let opacity = self.alpha(params);
        let mut key = self.current_material(params.span)?;
        if opacity != FloatDesc::Value(1.0) && self.graphics.area_light.is_some() {
            let text = "a lamp is opaque";
            self.report.instead(text, "its `alpha` is ignored", params.span);
        } else {
            key = self.with_opacity(&key, opacity, params.span);
        }
        match self.graphics.interior {
            Some(filling) => {
                let filled = self.with_absorption(&key, filling.absorption, params.span);
                if filled == key {
                    self.outside_of_glass(filling, params.span);
                }
                Some(filled)
            }
            None => Some(key),
        }
    }

    /// Puts an object into the scene or the open object. Curves of one kind, of which there are very many, become one.
    fn add_object(&mut self, object: Sourced<Object>, is_curve: bool) {
        let inside = self.object.is_some();
        let objects = match &mut self.object {
            Some(open) => &mut open.group.objects,
            None => &mut self.desc.objects,
        };
        let before = self.curves_at.take();
        let same = |last: &Sourced<Object>| {
            let (a, b) = (&last.value, &object.value);
            a.transform == b.transform
                && a.flip_normals == b.flip_normals
                && a.emission.is_none()
                && b.emission.is_none()
                && a.material_name() == b.material_name()
        };
        let here = (inside, objects.len());
        if is_curve
            && before == Some(here)
            && let Some(last) = objects.last_mut().filter(|last| same(last))
        {
            last.value.shape.value.extend(object.value.shape.value);
            self.curves_at = Some(here);
            return;
        }
        objects.push(object);
        if is_curve {
            self.curves_at = Some((inside, objects.len()));
        }
    }

    /// Counts what a small text makes much of; too much is an error.
    fn has_room(&mut self, shape: &Shape, params: &Params) -> bool {
        let Shape::Triangles { positions, .. } = shape else { return true };
        self.vertices = self.vertices.saturating_add(positions.len() as u64);
        let has_room = self.vertices <= MOST_VERTICES;
        if !has_room {
            self.report.error(
                "too-large",
                "the curved shapes of the scene have too many facets",
                params.span,
            );
        }
        has_room
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

    fn triangle_mesh(&mut self, params: &Params, needs: Needs) -> Option<Mesh> {
        // Tangents are of no use without hair or anisotropy along them; face indices are for textures of Ptex.
        params.ignore(&["S", "faceIndices"]);
        let mesh = self.vertices(params)?;
        let indices = self.faces::<3>(params, mesh.positions.len())?;
        let mesh = Mesh { indices, ..mesh };
        Some(if needs.uvs { with_uvs(mesh) } else { mesh })
    }

    fn bilinear_mesh(&mut self, params: &Params) -> Option<Mesh> {
        // The image says where samples go, not what shines.
        params.ignore(&["faceIndices", "emissionfilename"]);
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
        // Twice as much on the way: rings of neighbours.
        if corners << (2 * levels) > MOST_VERTICES / 2 {
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

    fn ply_mesh(&mut self, params: &Params, needs: Needs) -> Option<Shape> {
        let Some(file) = params.find("filename", &["string"]) else {
            self.report.error("missing-parameter", format!("{} has no `filename`", params.what), params.span);
            return None;
        };
        if let Some(displaced) = params.any("displacement") {
            self.report.instead("displacement is not rendered", "the surface is smooth", displaced.span);
            params.ignore(&["edgelength", "displacement.uvscale", "uvscale"]);
        }
        let path = self.find_file(file.text().unwrap_or_default());
        // pbrt turns faces to the side of their normals, and has texture coordinates where none are given. The file is read here only
        // where that shows.
        if (needs.sides || needs.uvs)
            && let Ok(read) = mesh::read(self.base.join(&path))
        {
            let mut mesh = Mesh::from(read);
            let turned = needs.sides && mesh.turn_to_normals();
            let bare = needs.uvs && mesh.uvs.is_empty();
            if bare {
                mesh = with_uvs(mesh);
            }
            if turned || bare {
                return self.triangles(mesh, params);
            }
        }
        Some(Shape::Mesh { file: Sourced::at(path, file.span), normals: Normals::Given })
    }

    fn sphere(&mut self, params: &Params, needs: Needs) -> Option<Shape> {
        let radius = params.positive(&mut self.report, "radius", 1.0);
        let z = [("zmin", -radius), ("zmax", radius)]
            .map(|(name, all)| params.number_or(name, all).clamp(-radius, radius));
        let turn = params.number_or("phimax", 360.0);
        // Ours has other texture coordinates.
        if z == [-radius, radius] && turn >= 360.0 && !needs.uvs {
            return Some(Shape::Sphere { center: [0.0; 3], radius: radius as f32 });
        }
        let mesh = surfaces::sphere(radius, z[0].min(z[1]), z[0].max(z[1]), turn.clamp(0.0, 360.0));
        self.triangles(mesh, params)
    }

    fn disk(&mut self, params: &Params, needs: Needs) -> Option<Shape> {
        let radius = params.positive(&mut self.report, "radius", 1.0);
        let (height, inner) = (params.number_or("height", 0.0), params.number_or("innerradius", 0.0));
        let turn = params.number_or("phimax", 360.0);
        if inner <= 0.0 && turn >= 360.0 && !needs.uvs {
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

/// What must be as pbrt has it, because it shows.
#[derive(Clone, Copy)]
struct Needs {
    /// Which side of a face is its front.
    sides: bool,
    /// Texture coordinates where none are given.
    uvs: bool,
}

/// pbrt's texture coordinates of triangles that have none: (0, 0), (1, 0) and (1, 1).
fn with_uvs(mesh: Mesh) -> Mesh {
    if !mesh.uvs.is_empty() {
        return mesh;
    }
    let corners: Vec<usize> = mesh.indices.iter().flatten().map(|v| *v as usize).collect();
    let of = |list: &[[f32; 3]]| {
        if list.is_empty() { Vec::new() } else { corners.iter().map(|v| list[*v]).collect() }
    };
    Mesh {
        positions: of(&mesh.positions),
        normals: of(&mesh.normals),
        uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].into_iter().cycle().take(corners.len()).collect(),
        indices: (0..mesh.indices.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    }
}

/// What shapes need of an object.
trait Placed {
    /// The name of the material.
    fn material_name(&self) -> Option<&str>;
}

impl Placed for Object {
    fn material_name(&self) -> Option<&str> {
        match &self.material {
            Some(MaterialRef::Named(name)) => Some(&name.value),
            _ => None,
        }
    }
}

/// Meshes that grow.
trait Growing {
    /// Takes in another mesh of the same kind.
    fn extend(&mut self, other: Shape);
}

impl Growing for Shape {
    fn extend(&mut self, other: Shape) {
        if let (
            Shape::Triangles { positions, indices, vertex_normals, uvs, .. },
            Shape::Triangles { positions: p, indices: i, vertex_normals: n, uvs: t, .. },
        ) = (self, other)
        {
            let first = positions.len() as u32;
            positions.extend(p);
            vertex_normals.extend(n);
            uvs.extend(t);
            indices.extend(i.into_iter().map(|t| t.map(|v| v + first)));
        }
    }
}
