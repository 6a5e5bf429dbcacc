//! Displacement of placed solids: cut fine enough for the picture, moved by a texture.

use std::sync::Arc;

use math::{Bounds3, Transform, Vec2, Vec3};
use mesh::{Subdivided, TriangleMesh};
use scenefile::desc::{Displacement, EdgeLength};
use scenefile::{Diagnostic, Sourced};

use super::shapes::Solid;
use crate::attributes::Owner;
use crate::texture::{Mapping, TexturePoint};
use crate::{Camera, MaterialId, Object, Shape, Texture};

/// Triangles that displacement makes of an object, at most.
const MOST: usize = 1 << 24;

/// How wide the camera's pixels are at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixels {
    eye: Vec3,
    /// Where rays start, and what is added for each unit of distance from there.
    width: f32,
    spread: f32,
}

impl Pixels {
    /// Those in the middle of the picture.
    pub fn of(camera: &Camera) -> Self {
        let [width, height] = camera.resolution();
        let middle = Vec2::new(width as f32, height as f32) * 0.5;
        let sample = camera.sample_we(middle, [0.5; 2]);
        Self { eye: camera.position(), width: sample.width, spread: sample.spread }
    }

    fn at(&self, distance: f32) -> f32 {
        self.width + self.spread * distance
    }

    /// Where a line comes nearest to the camera.
    fn at_line(&self, a: Vec3, b: Vec3) -> f32 {
        let along = b - a;
        let t = ((self.eye - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        self.at(self.eye.distance(a + along * if t.is_finite() { t } else { 0.0 }))
    }

    /// In units of an object of a group, where any of its instances comes nearest.
    fn of_instances(&self, bounds: Bounds3, placed: &[Transform]) -> f32 {
        let width = |t: &Transform| {
            let world = t.bounds(&bounds);
            let nearest = self.eye.clamp(world.min, world.max);
            let m = t.matrix().matrix3;
            let scale =
                [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length()).into_iter().fold(0.0, f32::max);
            self.at(self.eye.distance(nearest)) / scale
        };
        placed.iter().map(width).fold(f32::INFINITY, f32::min)
    }
}

/// Where objects are placed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Within<'a> {
    /// In the world.
    World,
    /// In a group, of which these are the instances.
    Group(&'a [Transform]),
}

/// What displaces an object.
pub(super) struct Displacer<'a> {
    pub desc: &'a Sourced<Displacement>,
    pub textures: &'a [Texture],
    pub texture: u32,
    pub pixels: Pixels,
    pub within: Within<'a>,
}

impl Displacer<'_> {
    /// The solid, cut and moved.
    pub fn apply(&self, solid: Solid) -> Result<Solid, Diagnostic> {
        let mesh = solid.into_mesh();
        self.check(&mesh)?;
        let pixel = match (self.desc.edge, self.within) {
            (EdgeLength::Pixels(_), Within::Group(placed)) => self.pixels.of_instances(mesh.bounds(), placed),
            (EdgeLength::Units(_), _) | (EdgeLength::Pixels(_), Within::World) => 1.0,
        };
        let longest = |a: Vec3, b: Vec3| match (self.desc.edge, self.within) {
            (EdgeLength::Units(length), _) => length,
            (EdgeLength::Pixels(n), Within::World) => n * self.pixels.at_line(a, b),
            (EdgeLength::Pixels(n), Within::Group(_)) => n * pixel,
        };
        let cut = Subdivided::new(mesh, longest, MOST).map_err(|e| self.too_many(e.triangles))?;
        let heights = self.heights(cut.mesh());
        Ok(Solid::Mesh(cut.displaced(&heights)))
    }

    /// Whether the texture finds on a mesh what it is laid out by.
    fn check(&self, mesh: &TriangleMesh) -> Result<(), Diagnostic> {
        let name = &self.desc.texture;
        let wrong = |lacks: &str, help: &str| {
            let message = format!(
                "the shape has no {lacks}, by which the displacement's texture `{}` is laid out",
                name.value
            );
            Err(Diagnostic::error("bad-shape", message).at(name.span).help(help))
        };
        let mut open = vec![self.texture];
        while let Some(id) = open.pop() {
            let Some(texture) = self.textures.get(id as usize) else { continue };
            open.extend(texture.parts());
            let by_uv = match texture {
                Texture::Image(t) => Some(t.map),
                Texture::Checker(t) => Some(t.map),
                Texture::Dots(t) => Some(t.map),
                Texture::VertexColor(_) if mesh.colors.is_empty() => {
                    return wrong("colours of vertices", "give the mesh some, or use another texture");
                }
                Texture::Constant(_)
                | Texture::Product(..)
                | Texture::Mix(..)
                | Texture::Noise(_)
                | Texture::VertexColor(_) => None,
            };
            if matches!(by_uv, Some(Mapping::Uv { .. })) && mesh.uvs.is_empty() {
                let help = "give the mesh coordinates, or use a planar mapping or a noise, which is laid out in space";
                return wrong("texture coordinates", help);
            }
        }
        Ok(())
    }

    fn too_many(&self, triangles: f64) -> Diagnostic {
        let made = if triangles < 1e15 {
            format!("about {}", rounded(triangles))
        } else {
            "endlessly many".to_owned()
        };
        let message = format!("displacement would cut this shape into {made} triangles; {MOST} are the most");
        // The number is an estimate.
        let factor = 1.5 * (triangles / MOST as f64).max(1.0).sqrt();
        let help = match self.desc.edge {
            EdgeLength::Units(length) => {
                format!("edge_length = {} would do", rounded(f64::from(length) * factor))
            }
            EdgeLength::Pixels(n) if triangles < 1e15 => format!(
                "edge_pixels = {} would do, or an `edge_length`; near the camera pixels are small",
                rounded(f64::from(n) * factor)
            ),
            EdgeLength::Pixels(_) => {
                "the camera touches it, where pixels are small: give `edge_length`".to_owned()
            }
        };
        Diagnostic::error("too-large", message).at(self.desc.span).help(help)
    }

    /// The way out of each vertex: the texture averaged over the edges around.
    fn heights(&self, mesh: &TriangleMesh) -> Vec<f32> {
        let mut around = vec![(0.0f32, 0u32, 0u32); mesh.positions.len()];
        for (i, t) in (0u32..).zip(&mesh.indices) {
            let corners = mesh.corners(i as usize);
            for k in 0..3 {
                let vertex = &mut around[t[k] as usize];
                vertex.0 += corners[k].distance(corners[(k + 1) % 3]);
                vertex.1 += 1;
                vertex.2 = i;
            }
        }
        let object =
            Object { shape: Shape::Mesh(Arc::new(mesh.clone())), material: MaterialId(0), light: None };
        let Displacement { scale, midlevel, .. } = self.desc.value;
        let height = |v: usize| {
            let (sum, count, prim) = around[v];
            if count == 0 {
                return 0.0;
            }
            let hit = object.at(mesh.positions[v], prim);
            let at = TexturePoint::of_hit(&hit, sum / count as f32, Owner::Object(&object));
            let [r, g, b] =
                self.textures.get(self.texture as usize).map_or([0.0; 3], |t| t.evaluate(self.textures, &at));
            scale * ((r + g + b) / 3.0 - midlevel)
        };
        par::map_chunks(mesh.positions.len(), 1 << 12, |chunk| chunk.map(height).collect::<Vec<f32>>())
            .concat()
    }
}

/// Three figures, without an exponent where that is short.
fn rounded(x: f64) -> String {
    let unit = 10f64.powf(x.log10().floor() - 2.0);
    let x = (x / unit).ceil() * unit;
    if (1e-3..1e6).contains(&x) { format!("{}", (x * 1e6).round() / 1e6) } else { format!("{x:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::desc::SceneDesc;
    use scenefile::parse;

    fn compiled(object: &str) -> Result<(crate::Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
        let text = format!(
            "[film]\nsize = [100, 100]\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 40\n[[lights]]\nkind = \"environment\"\n\
             radiance = 1\n[materials.white]\nkind = \"diffuse\"\n[textures.one]\nkind = \"product\"\na = 1\nb = 1\n[textures.hills]\nkind = \"fbm\"\n\
             [textures.chess]\nkind = \"checker\"\na = 0\nb = 1\n[textures.paint]\nkind = \"vertex-color\"\n{object}"
        );
        let loaded = parse(&text, std::path::Path::new("a.toml"), &[]);
        let desc: SceneDesc = loaded.desc.clone().unwrap_or_else(|| panic!("{}", loaded.render()));
        super::super::compile(&desc)
    }

    fn said(object: &str) -> String {
        let told = compiled(object).unwrap_err();
        told.into_iter()
            .map(|d| format!("{}: {} ({})\n", d.code, d.message, d.help.unwrap_or_default()))
            .collect()
    }

    fn mesh(object: &str) -> TriangleMesh {
        let scene = compiled(object).unwrap_or_else(|e| panic!("{e:?}")).0;
        match scene.outer.first() {
            Some(crate::scene::Outer::Object(Object { shape: Shape::Mesh(mesh), .. })) => (**mesh).clone(),
            other => panic!("{other:?}"),
        }
    }

    const BALL: &str = "[[objects]]\nshape = \"sphere\"\nmaterial = \"white\"\ntransform = [{ scale = 2 }]\n";

    #[test]
    fn a_sphere_grows_by_the_scale_whichever_way_it_faces() {
        for flip in ["", "flip_normals = true\n"] {
            let displaced =
                "displacement = { texture = \"one\", scale = 0.3, midlevel = 0.5, edge_length = 0.1 }";
            let ball = mesh(&format!("{BALL}{flip}{displaced}\n"));
            assert!(ball.is_closed());
            assert_eq!(ball.signed_volume() < 0.0, !flip.is_empty());
            // In units of the world, after the placement.
            assert!(ball.positions.iter().all(|p| (p.length() - 2.15).abs() < 1e-3));
        }
    }

    #[test]
    fn edges_have_the_size_of_pixels_where_they_are() {
        // A floor from below the camera to far away.
        let floor = "[[objects]]\nshape = \"quad\"\norigin = [-20, -2, 5]\nedge_u = [40, 0, 0]\nedge_v = [0, 0, -60]\nmaterial = \"white\"\n\
                     displacement = { texture = \"hills\", scale = 0, edge_pixels = 20 }\n";
        let floor = mesh(floor);
        let pixel = 2.0 * 20f32.to_radians().tan() / 100.0;
        let eye = Vec3::new(0.0, 0.0, 5.0);
        let (mut near, mut far) = (f32::INFINITY, 0f32);
        for i in 0..floor.indices.len() {
            let [a, b, c] = floor.corners(i);
            for (a, b) in [(a, b), (b, c), (c, a)] {
                let seen = a.distance(b) / (20.0 * pixel * eye.distance(a).max(eye.distance(b)));
                assert!(seen < 1.001, "{a} {b} {seen}");
                (near, far) = (near.min(a.distance(b)), far.max(a.distance(b)));
            }
        }
        assert!(far > 10.0 * near, "{near} {far}");
    }

    #[test]
    fn instances_are_as_fine_as_the_nearest_one_wants() {
        let scene = |near: &str| {
            let text = format!(
                "[groups.g]\n[[groups.g.objects]]\nshape = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"white\"\n\
                 displacement = {{ texture = \"hills\", scale = 0.1, edge_pixels = 8 }}\n[[instances]]\ngroup = \"g\"\n\
                 transform = [{{ translate = [0, 0, -100] }}]\n[[instances]]\ngroup = \"g\"\ntransform = [{near}]\n"
            );
            compiled(&text).unwrap_or_else(|e| panic!("{e:?}")).0.triangles
        };
        let (far, near) =
            (scene("{ translate = [9, 0, -100] }"), scene("{ scale = 0.5 }, { translate = [0, 0, 2] }"));
        assert!(near > 20 * far && far >= 12, "{near} {far}");
    }

    #[test]
    fn what_cannot_be_displaced_is_said() {
        let object = |shape: &str, how: &str| {
            format!("[[objects]]\nshape = {shape}\nmaterial = \"white\"\ndisplacement = {{ {how} }}\n")
        };
        let ball = object("\"icosphere\"", "texture = \"chess\", scale = 0.1");
        assert!(
            said(&ball).contains("no texture coordinates, by which the displacement's texture `chess`"),
            "{}",
            said(&ball)
        );
        assert!(compiled(&object("\"icosphere\"", "texture = \"hills\", scale = 0.1")).is_ok());
        let ball = object("\"sphere\"", "texture = \"paint\", scale = 0.1");
        assert!(said(&ball).contains("no colours of vertices"), "{}", said(&ball));
        let fine = said(&object("\"sphere\"", "texture = \"hills\", scale = 0.1, edge_length = 1e-5"));
        assert!(
            fine.starts_with("too-large") && fine.contains("e11 triangles; 16777216 are the most"),
            "{fine}"
        );
        // What is proposed does.
        let proposed = fine.split("edge_length = ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        assert!((0.001..0.004).contains(&proposed.parse::<f64>().unwrap()), "{fine}");
        let touched = said(
            "[[objects]]\nshape = \"quad\"\norigin = [-1, -1, 5]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]\nmaterial = \"white\"\n\
                            displacement = { texture = \"hills\", scale = 0.1 }\n",
        );
        assert!(touched.contains("give `edge_length`") || touched.contains("an `edge_length`"), "{touched}");
    }
}
