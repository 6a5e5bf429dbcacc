//! What few materials ask of a surface, and hits therefore do not carry: second texture coordinates, colours of vertices,
//! both tangents. It is found again from the object, the triangle and the place.

use math::{PI, Transform, Vec2, Vec3};
use mesh::TriangleMesh;

use crate::interaction::TURNED;
use crate::scene::Outer;
use crate::{Object, Scene, Shape};

/// What a point is of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Owner<'a> {
    /// Not known, or of no matter.
    Unknown,
    /// The object of a number in hits.
    Scene(&'a Scene),
    /// An object, where it stands in the world.
    Object(&'a Object),
}

impl<'a> Owner<'a> {
    /// The piece of the surface that a triangle of an object is.
    pub fn attributes(self, object: u32, prim: u32) -> Option<Attributes<'a>> {
        match self {
            Self::Unknown => None,
            Self::Scene(scene) => scene.attributes(object, prim),
            Self::Object(object) => Attributes::of(&object.shape, prim, None),
        }
    }
}

/// A piece of a surface on which texture coordinates are known.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Attributes<'a> {
    /// A triangle, in the world.
    Triangle(Triangle<'a>),
    /// A sphere or a disk, and what takes it to the world.
    Round(&'a Shape, Option<&'a Transform>),
}

/// A triangle where it stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<'a> {
    mesh: &'a TriangleMesh,
    vertices: [usize; 3],
    corner: Vec3,
    edges: [Vec3; 2],
    /// Gradients of the second and third barycentric coordinate.
    gradients: [Vec3; 2],
}

impl Scene {
    /// The piece of an object, by its number in hits, that a triangle of it is.
    #[inline(never)]
    fn attributes(&self, object: u32, prim: u32) -> Option<Attributes<'_>> {
        let object = object & !TURNED;
        let (shape, transform) = match self.outer.get(object as usize) {
            Some(Outer::Object(object)) => (&object.shape, None),
            Some(Outer::Instance { .. }) => return None,
            None => {
                // Objects of instances are numbered on, instance by instance.
                let last = self.instance_numbers.partition_point(|(first, _)| *first <= object);
                let (first, outer) = *self.instance_numbers.get(last.checked_sub(1)?)?;
                let Outer::Instance { group, render_from_object, .. } = self.outer.get(outer as usize)?
                else {
                    return None;
                };
                let objects = &self.groups.get(*group as usize)?.objects;
                (&objects.get((object - first) as usize)?.shape, Some(render_from_object))
            }
        };
        Attributes::of(shape, prim, transform)
    }
}

impl<'a> Triangle<'a> {
    fn of(mesh: &'a TriangleMesh, prim: u32, transform: Option<&Transform>) -> Option<Self> {
        let vertices = mesh.indices.get(prim as usize)?.map(|v| v as usize);
        let [p0, p1, p2] = vertices.map(|v| {
            let p = mesh.positions[v];
            transform.map_or(p, |t| t.point(p))
        });
        let edges = [p1 - p0, p2 - p0];
        let n = edges[0].cross(edges[1]);
        let area2 = n.length_squared();
        let gradients = if area2 > 0.0 {
            [edges[1].cross(n) / area2, n.cross(edges[0]) / area2]
        } else {
            [Vec3::ZERO; 2]
        };
        Some(Self { mesh, vertices, corner: p0, edges, gradients })
    }

    /// Barycentric coordinates of what lies above or below `p`, inside the triangle or beside it.
    fn shares(&self, p: Vec3) -> [f32; 3] {
        let [b1, b2] = self.gradients.map(|g| g.dot(p - self.corner));
        [1.0 - b1 - b2, b1, b2]
    }

    fn uv_of(&self, uvs: &[Vec2], p: Vec3) -> Vec2 {
        let [b0, b1, b2] = self.shares(p);
        if uvs.is_empty() {
            return Vec2::new(b1, b2);
        }
        let [t0, t1, t2] = self.vertices.map(|v| uvs[v]);
        t0 * b0 + t1 * b1 + t2 * b2
    }

    /// How a set of coordinates varies along the edges.
    fn differences(&self, uvs: &[Vec2]) -> [Vec2; 2] {
        if uvs.is_empty() {
            return [Vec2::X, Vec2::Y];
        }
        let [t0, t1, t2] = self.vertices.map(|v| uvs[v]);
        [t1 - t0, t2 - t0]
    }

    fn set(&self, set: u8) -> &'a [Vec2] {
        if set > 0 && !self.mesh.uvs2.is_empty() { &self.mesh.uvs2 } else { &self.mesh.uvs }
    }
}

impl<'a> Attributes<'a> {
    fn of(shape: &'a Shape, prim: u32, transform: Option<&'a Transform>) -> Option<Self> {
        match shape {
            Shape::Mesh(mesh) => Triangle::of(mesh, prim, transform).map(Self::Triangle),
            Shape::Sphere { .. } | Shape::Disk { .. } => Some(Self::Round(shape, transform)),
        }
    }

    /// The first texture coordinates at `p`.
    pub fn uv(&self, p: Vec3) -> Vec2 {
        match self {
            Self::Triangle(t) => t.uv_of(&t.mesh.uvs, p),
            Self::Round(shape, transform) => {
                let p = transform.map_or(p, |t| t.inverse().point(p));
                match shape {
                    Shape::Sphere { center, .. } => sphere_uv((p - *center).normalize_or(Vec3::X)),
                    Shape::Disk { center, normal, radius } => disk_uv(*center, *normal, *radius, p),
                    Shape::Mesh(_) => Vec2::ZERO,
                }
            }
        }
    }

    /// The second texture coordinates at `p`, and their growth per unit of length; `None` where there are none.
    pub fn uv2(&self, p: Vec3) -> Option<(Vec2, f32)> {
        let Self::Triangle(t) = self else { return None };
        if t.mesh.uvs2.is_empty() {
            return None;
        }
        let [d1, d2] = t.differences(&t.mesh.uvs2);
        let det = d1.x * d2.y - d1.y * d2.x;
        let area2 = t.edges[0].cross(t.edges[1]).length();
        Some((t.uv_of(&t.mesh.uvs2, p), (det.abs() / area2.max(f32::MIN_POSITIVE)).sqrt()))
    }

    /// The colour of the vertices at `p`; `None` where they have none.
    pub fn color(&self, p: Vec3) -> Option<[f32; 4]> {
        let Self::Triangle(t) = self else { return None };
        if t.mesh.colors.is_empty() {
            return None;
        }
        let (shares, colors) = (t.shares(p), t.vertices.map(|v| t.mesh.colors[v]));
        Some(std::array::from_fn(|c| (0..3).map(|k| shares[k] * colors[k][c]).sum()))
    }

    /// The directions of growing u and of growing v of a set at `p`; zero where unknown, not of unit length.
    pub fn tangents(&self, set: u8, p: Vec3) -> [Vec3; 2] {
        match self {
            Self::Triangle(t) => {
                let ([d1, d2], [e1, e2]) = (t.differences(t.set(set)), t.edges);
                let det = d1.x * d2.y - d1.y * d2.x;
                if det == 0.0 {
                    return [Vec3::ZERO; 2];
                }
                [(e1 * d2.y - e2 * d1.y) / det, (e2 * d1.x - e1 * d2.x) / det]
            }
            Self::Round(shape, transform) => {
                let local = transform.map_or(p, |t| t.inverse().point(p));
                let tangents = match shape {
                    Shape::Sphere { center, .. } => {
                        let n = (local - *center).normalize_or(Vec3::X);
                        let along = Vec3::new(-n.z, 0.0, n.x);
                        [along, along.cross(n)]
                    }
                    Shape::Disk { normal, .. } => {
                        let frame = math::Frame::from_z(*normal);
                        [frame.x, frame.y]
                    }
                    Shape::Mesh(_) => [Vec3::ZERO; 2],
                };
                tangents.map(|v| transform.map_or(v, |t| t.vector(v)))
            }
        }
    }
}

/// Texture coordinates of a sphere in the direction `n` from its centre.
pub(crate) fn sphere_uv(n: Vec3) -> Vec2 {
    let phi = n.x.atan2(-n.z);
    Vec2::new(phi / (2.0 * PI) + 0.5, n.y.clamp(-1.0, 1.0).asin() / PI + 0.5)
}

/// Texture coordinates of a disk.
pub(crate) fn disk_uv(center: Vec3, normal: Vec3, radius: f32, p: Vec3) -> Vec2 {
    let local = math::Frame::from_z(normal).to_local(p - center) / radius;
    Vec2::new(local.x, local.y) * 0.5 + 0.5
}
