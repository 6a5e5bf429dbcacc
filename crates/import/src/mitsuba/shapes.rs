//! Shapes, groups and their instances.

use std::rc::Rc;

use scenefile::desc::{
    Emission, FloatDesc, Group, Instance, Material, MaterialKind, MaterialRef, Normals, Object, Roughness,
    Shape, Triple,
};
use scenefile::{Diagnostic, Sourced};

use super::Importer;
use super::bsdf::{Use, Uv, each_part};
use super::plugin::{Plugin, Tag};
use crate::matrix::{Matrix, add, length, narrow, sub, unit};
use crate::names::free_name;
use crate::report::nearest;
use crate::surfaces::{self, Mesh};

/// Kinds that are known, for those that are not.
const KINDS: [&str; 17] = [
    "obj",
    "ply",
    "serialized",
    "sphere",
    "rectangle",
    "disk",
    "cube",
    "cylinder",
    "shapegroup",
    "instance",
    "merge",
    "bsplinecurve",
    "linearcurve",
    "hair",
    "ellipsoids",
    "ellipsoidsmesh",
    "sdfgrid",
];

/// Where objects go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target<'a> {
    World,
    Group(&'a str),
}

/// What the material and light of a shape ask of its geometry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Needs {
    /// It matters which side is the front.
    pub sides: bool,
    /// It matters where texture coordinates lie.
    pub uvs: bool,
}

/// A shape in its own space.
pub(super) struct Made {
    pub shape: Shape,
    /// From the shape's own space to the world's, as far as the shape does not hold it.
    pub place: Matrix,
    /// Whether its front is the other side.
    pub flipped: bool,
}

impl Importer {
    pub(super) fn shape(&mut self, plugin: &Rc<Plugin>, into: Target<'_>) {
        match plugin.kind.as_str() {
            "shapegroup" => return,
            "instance" => return self.instance(plugin, into),
            "merge" => {
                for child in self.children(plugin, Tag::Shape) {
                    if child.kind == "merge" {
                        self.report.error("cycle", "a `merge` within a `merge`", child.span);
                    } else {
                        self.shape(&child, into);
                    }
                }
                plugin.finish(&mut self.report);
                return;
            }
            _ => {}
        }
        let emitters = self.children(plugin, Tag::Emitter);
        let bsdfs = self.children(plugin, Tag::Bsdf);
        if bsdfs.len() > 1 {
            let text = "a shape of several BSDFs is not rendered";
            self.report.instead(text, "the first one covers it", plugin.span);
        }
        for (tag, what) in [(Tag::Sensor, "sensors on shapes"), (Tag::Subsurface, "light below a surface")] {
            if !self.children(plugin, tag).is_empty() {
                let text = format!("{what} are not rendered")
                    .replace("light below a surface are", "light below a surface is");
                self.report.instead(text, "the shape has its BSDF alone", plugin.span);
            }
        }
        let used = Use { uv: self.uv(plugin), absorption: self.media(plugin) };
        let emission = emitters.first().and_then(|e| self.area_emission(e, used.uv));
        let material = match bsdfs.first() {
            Some(bsdf) => self.material(bsdf, used),
            // Version 0.6 lets light pass where media meet.
            None if plugin.old && plugin.find_any(&["interior", "exterior"]).is_some() => None,
            None if emission.is_some() => None,
            None => Some(self.default_material(plugin)),
        };
        let needs = Needs {
            sides: emission.is_some() || material.as_ref().is_some_and(|m| self.has_sides(m)),
            uvs: emission.as_ref().is_some_and(|e| e.texture.is_some())
                || material.as_ref().is_some_and(|m| self.textured.contains(m) || self.is_anisotropic(m)),
        };
        let made = self.made(plugin, needs);
        plugin.finish(&mut self.report);
        let Some(made) = made else { return };
        let black = bsdfs.is_empty() && emission.is_some();
        match material {
            Some(name) => {
                let material = MaterialRef::Named(Sourced::at(name, plugin.span));
                self.place(plugin, made, Some(material), emission, into);
            }
            None if black => self.place(plugin, made, None, emission, into),
            None => self.unseen(plugin, made, emission, used.absorption, into),
        }
    }

    /// Mitsuba's default is grey and diffuse.
    fn default_material(&mut self, plugin: &Plugin) -> String {
        if let Some(known) = &self.default_material {
            return known.clone();
        }
        let mut grey = Material::diffuse(0.5);
        grey.two_sided = false;
        let name = free_name(&self.desc.materials, "default");
        self.desc.materials.insert(name.clone(), Sourced::at(grey, plugin.span));
        self.default_material = Some(name.clone());
        name
    }

    /// A shape that scatters nothing: it is not there, unless what it holds absorbs or it shines.
    fn unseen(
        &mut self,
        plugin: &Plugin,
        made: Made,
        emission: Option<Sourced<Emission>>,
        absorption: Triple,
        into: Target<'_>,
    ) {
        if emission.is_some() {
            let text = "a lamp that lets light pass is not rendered";
            self.report.instead(text, "it is opaque", plugin.span);
            return self.place(plugin, made, None, emission, into);
        }
        if absorption == [0.0; 3] {
            return;
        }
        let clear = scenefile::desc::Dielectric {
            ior: 1.0.into(),
            outside_ior: Some(1.0),
            absorption,
            ..Default::default()
        };
        let name = free_name(&self.desc.materials, "medium");
        self.desc.materials.insert(name.clone(), Sourced::at(clear.into(), plugin.span));
        let material = MaterialRef::Named(Sourced::at(name, plugin.span));
        self.place(plugin, made, Some(material), None, into);
    }

    fn place(
        &mut self,
        plugin: &Plugin,
        made: Made,
        material: Option<MaterialRef>,
        emission: Option<Sourced<Emission>>,
        into: Target<'_>,
    ) {
        let place = match into {
            Target::World => self.mirror.after(&made.place),
            Target::Group(_) => made.place,
        };
        let object = Object {
            name: None,
            shape: Sourced::at(made.shape, plugin.span),
            material,
            transform: place.steps(),
            displacement: None,
            flip_normals: made.flipped,
            emission,
            light_group: None,
        };
        let object = Sourced::at(object, plugin.span);
        match into {
            Target::World => self.desc.objects.push(object),
            Target::Group(name) => {
                if let Some(group) = self.desc.groups.get_mut(name) {
                    group.value.objects.push(object);
                }
            }
        }
    }

    /// A group by its plugin; its shapes are made when it is first placed.
    fn group(&mut self, plugin: &Rc<Plugin>) -> String {
        if let Some(known) = self.groups.get(&plugin.index) {
            return known.clone();
        }
        let name = free_name(&self.desc.groups, plugin.label());
        self.groups.insert(plugin.index, name.clone());
        self.desc.groups.insert(name.clone(), Sourced::at(Group::default(), plugin.span));
        for child in self.children(plugin, Tag::Shape) {
            if matches!(child.kind.as_str(), "instance" | "shapegroup") {
                let text = "groups within groups are not rendered";
                self.report.instead(text, "the inner one is left out", child.span);
            } else {
                self.shape(&child, Target::Group(&name));
            }
        }
        plugin.finish(&mut self.report);
        name
    }

    fn instance(&mut self, plugin: &Rc<Plugin>, into: Target<'_>) {
        let groups = self.children(plugin, Tag::Shape);
        let place = plugin.place(&mut self.report, "to_world");
        plugin.finish(&mut self.report);
        let Some(group) = groups.first().filter(|g| g.kind == "shapegroup") else {
            let text = format!("{} needs a `shapegroup`", plugin.what());
            self.report.error("missing-parameter", text, plugin.span);
            return;
        };
        if into != Target::World {
            return;
        }
        let name = self.group(group);
        if self.desc.groups.get(&name).is_none_or(|g| g.objects.is_empty()) {
            return;
        }
        let instance = Instance {
            name: None,
            group: Sourced::at(name, plugin.span),
            transform: self.mirror.after(&place).steps(),
            material: None,
        };
        self.desc.instances.push(Sourced::at(instance, plugin.span));
    }

    /// Which way the texture coordinates of a shape count.
    fn uv(&mut self, plugin: &Plugin) -> Uv {
        let flipped = plugin.truth(&mut self.report, "flip_tex_coords");
        match plugin.kind.as_str() {
            "sphere" => Uv::Up,
            "obj" if flipped.unwrap_or(true) => Uv::Up,
            "ply" | "serialized" if flipped.unwrap_or(false) => Uv::Up,
            _ => Uv::Down,
        }
    }

    /// Geometry; `None` where there is nothing, which is reported.
    fn made(&mut self, plugin: &Rc<Plugin>, needs: Needs) -> Option<Made> {
        let report = &mut self.report;
        let to_world = plugin.place(report, "to_world");
        let flipped = plugin.is(report, "flip_normals");
        plugin.ignore(&["silhouette_sampling_weight"]);
        let made = |shape, place| Some(Made { shape, place, flipped });
        match plugin.kind.as_str() {
            "obj" | "ply" => self.mesh_file(plugin, to_world, flipped, needs),
            "serialized" => self.serialized(plugin, to_world, flipped),
            "sphere" => {
                let center = plugin.triple(report, "center").unwrap_or([0.0; 3]);
                let radius = plugin.positive(report, "radius", 1.0) as f32;
                let place = to_world.after(&Matrix::translate(center));
                if !needs.uvs {
                    return made(Shape::Sphere { center: [0.0; 3], radius }, place);
                }
                // Ours would not turn its coordinates with the transform.
                let r = f64::from(radius);
                let mut ball = surfaces::sphere(r, -r, r, 360.0);
                ball.repair();
                made(triangles(ball), place)
            }
            "rectangle" => {
                let (edge_u, edge_v) = ([2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
                made(Shape::Quad { origin: [-1.0, -1.0, 0.0], edge_u, edge_v }, to_world)
            }
            "disk" if needs.uvs => {
                let mut disk = surfaces::disk(1.0, 0.0, 0.0, 360.0);
                // Mitsuba's u grows outward, v around.
                disk.uvs.iter_mut().for_each(|uv| *uv = [1.0 - uv[1], uv[0]]);
                disk.repair();
                made(triangles(disk), to_world)
            }
            "disk" => made(Shape::Disk { center: [0.0; 3], normal: [0.0, 0.0, 1.0], radius: 1.0 }, to_world),
            "cube" => made(triangles(cube()), to_world),
            "cylinder" => {
                let [p0, p1] = [("p0", [0.0; 3]), ("p1", [0.0, 0.0, 1.0])]
                    .map(|(name, default)| plugin.triple(report, name).unwrap_or(default));
                let radius = plugin.positive(report, "radius", 1.0);
                let along = sub(p1, p0);
                let Some(frame) = upright(p0, along) else {
                    report.error("degenerate", format!("{} has no length", plugin.what()), plugin.span);
                    return None;
                };
                let mut tube = surfaces::cylinder(radius, 0.0, length(along), 360.0);
                tube.repair();
                made(triangles(tube), to_world.after(&frame))
            }
            "bsplinecurve" | "linearcurve" => self.curves(plugin, to_world),
            kind if KINDS.contains(&kind) => {
                let text = format!("the shape `{kind}` is not rendered");
                report.instead(text, "it is left out", plugin.span);
                plugin.params.iter().for_each(|p| p.mark());
                None
            }
            kind => {
                let wrong = Diagnostic::error("unknown-kind", format!("there is no shape `{kind}`"));
                let help = nearest(kind, KINDS.into_iter()).map(|n| format!("did you mean `{n}`?"));
                report.push(wrong.at(plugin.kind_span).maybe_help(help));
                plugin.params.iter().for_each(|p| p.mark());
                None
            }
        }
    }

    /// Whether it matters which way a material's surface is combed.
    fn is_anisotropic(&self, name: &str) -> bool {
        let Some(material) = self.desc.materials.get(name) else { return false };
        let mut found = false;
        each_part(&mut material.value.clone(), &mut |m| {
            let roughness = match &m.kind {
                MaterialKind::Conductor(m) => &m.roughness,
                MaterialKind::Dielectric(m) => &m.roughness,
                MaterialKind::CoatedDiffuse(m) => &m.roughness,
                MaterialKind::Principled(m) => &m.roughness,
                _ => return,
            };
            found |= match roughness {
                Roughness::Perceived { anisotropy, .. } => *anisotropy != FloatDesc::Value(0.0),
                Roughness::Alpha { along, across } => along != across,
            };
        });
        found
    }

    /// Whether a material's two sides differ.
    pub(super) fn has_sides(&self, name: &str) -> bool {
        let Some(material) = self.desc.materials.get(name) else { return true };
        let mut found = false;
        each_part(&mut material.value.clone(), &mut |m| {
            let passes = matches!(m.kind, MaterialKind::Dielectric(_) | MaterialKind::Principled(_));
            found |= passes || !m.two_sided;
        });
        found
    }
}

/// The origin at a place and +z along a direction, +x and +y as Mitsuba has them (Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited"). `None`: the direction has no length.
fn upright(origin: [f64; 3], along: [f64; 3]) -> Option<Matrix> {
    let [x, y, z] = unit(along)?;
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    Some(Matrix([
        [1.0 + sign * x * x * a, b, x, origin[0]],
        [sign * b, sign + y * y * a, y, origin[1]],
        [-sign * x, -y, z, origin[2]],
        [0.0, 0.0, 0.0, 1.0],
    ]))
}

/// A mesh in place.
pub(super) fn triangles(mesh: Mesh) -> Shape {
    Shape::Triangles {
        positions: mesh.positions,
        indices: mesh.indices,
        vertex_normals: mesh.normals,
        uvs: mesh.uvs,
        uvs2: Vec::new(),
        colors: Vec::new(),
        normals: Normals::Given,
    }
}

/// The cube of ±1, each face with texture coordinates of its own as Mitsuba's has them: (0, 1), (1, 1), (1, 0), (0, 0)
/// around each.
fn cube() -> Mesh {
    // For each face the first corner, the way to the second and that from there to the third.
    const FACES: [[[f64; 3]; 3]; 6] = [
        [[1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [-2.0, 0.0, 0.0]],
        [[1.0, 1.0, -1.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 2.0]],
        [[1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]],
        [[1.0, -1.0, 1.0], [0.0, 2.0, 0.0], [-2.0, 0.0, 0.0]],
        [[-1.0, -1.0, 1.0], [0.0, 2.0, 0.0], [0.0, 0.0, -2.0]],
        [[1.0, 1.0, -1.0], [0.0, -2.0, 0.0], [-2.0, 0.0, 0.0]],
    ];
    let mut mesh = Mesh::default();
    for [first, along, across] in FACES {
        let n = mesh.positions.len() as u32;
        let corners = [first, add(first, along), add(add(first, along), across), add(first, across)];
        mesh.positions.extend(corners.map(narrow));
        mesh.uvs.extend([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        mesh.indices.extend([[n, n + 1, n + 2], [n + 3, n, n + 2]]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::{cross, dot, wide};

    #[test]
    fn frames_of_cylinders() {
        for along in [[0.0, 0.0, 2.0], [0.0, 0.0, -1.0], [0.3, 1.7, 0.0], [-1.0, 0.5, -0.2]] {
            let m = upright([1.0, 2.0, 3.0], along).unwrap();
            let tip = sub(m.point([0.0, 0.0, length(along)]), add([1.0, 2.0, 3.0], along));
            assert!(length(tip) < 1e-12 && (m.determinant() - 1.0).abs() < 1e-12);
        }
        assert!(upright([0.0; 3], [0.0; 3]).is_none());
    }

    #[test]
    fn the_cube_faces_outward() {
        let cube = cube();
        assert_eq!((cube.positions.len(), cube.indices.len()), (24, 12));
        for t in &cube.indices {
            let [a, b, c] = t.map(|v| wide(cube.positions[v as usize]));
            let n = cross(sub(b, a), sub(c, a));
            assert!(dot(n, a) > 0.0 && length(n) == 4.0, "{t:?}");
        }
    }
}
