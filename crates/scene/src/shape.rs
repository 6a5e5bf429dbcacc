use std::sync::Arc;

use math::{PI, Ray, Transform, Vec2, Vec3, gamma};
use mesh::TriangleMesh;

use crate::attributes::{disk_uv, sphere_uv};
use crate::interaction::TURNED;
use crate::{LightId, MaterialId, SurfaceInteraction};

/// Geometry of an object, in the space of the BVH that holds it.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Triangles.
    Mesh(Arc<TriangleMesh>),
    /// A sphere; its front is outside.
    Sphere {
        /// Centre.
        center: Vec3,
        /// Radius.
        radius: f32,
        /// Whether its front is inside.
        flipped: bool,
    },
    /// A flat disc; its front is the side of the normal.
    Disk {
        /// Centre.
        center: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// Radius.
        radius: f32,
    },
}

/// A shape and what it is made of.
#[derive(Clone, Debug)]
pub struct Object {
    /// Geometry.
    pub shape: Shape,
    /// Material.
    pub material: MaterialId,
    /// The light that it is, if it shines.
    pub light: Option<LightId>,
}

impl Object {
    /// The surface at a hit of `ray`.
    #[inline]
    pub(crate) fn interaction(&self, ray: &Ray, hit: &accel::Hit) -> SurfaceInteraction {
        match &self.shape {
            Shape::Mesh(mesh) => triangle(mesh, self.blank(hit), hit),
            Shape::Sphere { center, radius, flipped } => {
                sphere(*center, *radius, *flipped, ray, self.blank(hit)).unpacked()
            }
            Shape::Disk { center, normal, radius } => {
                disk(*center, *normal, *radius, ray, self.blank(hit)).unpacked()
            }
        }
    }

    /// The surface at a point of it; `prim`: the triangle.
    pub(crate) fn at(&self, p: Vec3, prim: u32) -> SurfaceInteraction {
        let mut hit = accel::Hit { t: 0.0, u: 0.0, v: 0.0, geom: 0, prim, instance: accel::NO_INSTANCE };
        let ray = Ray::new(p, Vec3::Z);
        if let Shape::Mesh(mesh) = &self.shape {
            [_, hit.u, hit.v] = barycentric(p, &mesh.corners(prim as usize));
        }
        self.interaction(&ray, &hit)
    }

    /// What all shapes give alike.
    #[inline]
    fn blank(&self, hit: &accel::Hit) -> SurfaceInteraction {
        SurfaceInteraction {
            p: Vec3::ZERO,
            p_error: 0.0,
            ng: Vec3::Z,
            ns: Vec3::Z,
            dpdu: Vec3::ZERO,
            uv: Vec2::new(hit.u, hit.v),
            uv_per_length: 0.0,
            t: hit.t,
            material: self.material,
            light: self.light,
            prim: hit.prim,
            object: hit.geom,
        }
    }
}

/// Rounded operations that `t` of a triangle is allowed for each unit of distance to its farthest corner; more than
/// the tests below need.
const REACH_ROUNDINGS: u32 = 3;

#[inline]
fn triangle(mesh: &TriangleMesh, mut s: SurfaceInteraction, hit: &accel::Hit) -> SurfaceInteraction {
    let [i0, i1, i2] = mesh.indices[hit.prim as usize].map(|i| i as usize);
    let (p0, p1, p2) = (mesh.positions[i0], mesh.positions[i1], mesh.positions[i2]);
    let (b1, b2) = (hit.u, hit.v);
    let b0 = 1.0 - b1 - b2;
    let (q0, q1, q2) = (p0 * b0, p1 * b1, p2 * b2);
    let (e1, e2) = (p1 - p0, p2 - p0);
    let cross = e1.cross(e2);
    s.p = q0 + q1 + q2;
    // Barycentric interpolation rounds seven times (Pharr, Jakob & Humphreys 2023, §6.8.5). A ray that starts here
    // must besides be farther off the plane than the error of the `t` with which the triangle itself is met, which
    // grows with the distance of its corners and mixes the axes: so the box is a cube, and never flat.
    let reach = (p0 - s.p).abs().max((p1 - s.p).abs()).max((p2 - s.p).abs()).max_element();
    let rounding = (q0.abs() + q1.abs() + q2.abs()).max_element();
    s.p_error = rounding * gamma(7) + reach * gamma(REACH_ROUNDINGS);
    let area2 = cross.length();
    s.ng = if area2 > 0.0 { cross * (1.0 / area2) } else { sliver_normal(p0, p1, p2) };
    s.ns = s.ng;
    if !mesh.normals.is_empty() {
        let n = mesh.normals[i0] * b0 + mesh.normals[i1] * b1 + mesh.normals[i2] * b2;
        let len2 = n.length_squared();
        if len2 > 0.0 {
            let n = n / len2.sqrt();
            s.ns = if n.dot(s.ng) < 0.0 { -n } else { n };
        }
    }
    if !mesh.uvs.is_empty() {
        let t = TextureAt::of([i0, i1, i2].map(|i| mesh.uvs[i]), [b0, b1, b2], [e1, e2], area2);
        (s.uv, s.uv_per_length) = (Vec2::new(t.uv.x, t.uv.y), t.uv_per_length);
        s.dpdu = Vec3::new(t.dpdu.x, t.dpdu.y, t.dpdu.z);
    }
    s
}

/// Barycentric coordinates of the point of a triangle that lies nearest to `p`, up to rounding: for points on it. 0 where it
/// has no area.
pub(crate) fn barycentric(p: Vec3, [a, b, c]: &[Vec3; 3]) -> [f32; 3] {
    let [p, b, c] = [p, *b, *c].map(|v| (v - *a).as_dvec3());
    let n = b.cross(c);
    let over = 1.0 / n.length_squared();
    let (b1, b2) = (p.cross(c).dot(n) * over, b.cross(p).dot(n) * over);
    if !(b1.is_finite() && b2.is_finite()) {
        return [0.0; 3];
    }
    let (b1, b2) = (b1.clamp(0.0, 1.0), b2.clamp(0.0, 1.0));
    [(1.0 - b1 - b2).max(0.0), b1, b2].map(|x| x as f32)
}

/// Where a point of a triangle lies on a texture: the fields of [`SurfaceInteraction`] of these names.
struct TextureAt {
    uv: Vec2,
    dpdu: Vec3,
    uv_per_length: f32,
}

impl TextureAt {
    /// From the corners' coordinates, the point's barycentric ones, two edges and twice the area.
    #[inline(never)]
    fn of([t0, t1, t2]: [Vec2; 3], [b0, b1, b2]: [f32; 3], [e1, e2]: [Vec3; 2], area2: f32) -> Self {
        let uv = t0 * b0 + t1 * b1 + t2 * b2;
        let (d1, d2) = (t1 - t0, t2 - t0);
        let det = d1.x * d2.y - d1.y * d2.x;
        if det == 0.0 {
            return Self { uv, dpdu: Vec3::ZERO, uv_per_length: 0.0 };
        }
        Self {
            uv,
            dpdu: (e1 * d2.y - e2 * d1.y) / det,
            uv_per_length: (det.abs() / area2.max(f32::MIN_POSITIVE)).sqrt(),
        }
    }
}

/// The normal of a triangle whose cross product underflows, in f64; z where it has no area at all.
#[cold]
fn sliver_normal(p0: Vec3, p1: Vec3, p2: Vec3) -> Vec3 {
    let n = (p1 - p0).as_dvec3().cross((p2 - p0).as_dvec3());
    if n.length_squared() > 0.0 { n.normalize().as_vec3() } else { Vec3::Z }
}

#[inline(never)]
fn sphere(
    center: Vec3,
    radius: f32,
    flipped: bool,
    ray: &Ray,
    mut s: SurfaceInteraction,
) -> SurfaceInteraction {
    let n = (ray.at(s.t) - center).normalize();
    let q = n * radius;
    s.p = center + q;
    // Normalising and scaling: five rounded operations on q; the sum rounds once more. A cube, as for triangles.
    s.p_error = radius * gamma(5) + s.p.abs().max_element() * gamma(2);
    s.ng = if flipped { -n } else { n };
    s.ns = s.ng;
    if flipped {
        s.object |= TURNED;
    }
    s.uv = sphere_uv(n);
    s.dpdu = Vec3::new(-n.z, 0.0, n.x);
    s.uv_per_length = 1.0 / (std::f32::consts::SQRT_2 * PI * radius);
    s
}

#[inline(never)]
fn disk(center: Vec3, normal: Vec3, radius: f32, ray: &Ray, mut s: SurfaceInteraction) -> SurfaceInteraction {
    let p = ray.at(s.t);
    s.p = p - normal * (p - center).dot(normal);
    s.p_error = (s.p.abs() + center.abs()).max_element() * gamma(6) + radius * gamma(2);
    s.ng = normal;
    s.ns = normal;
    let frame = math::Frame::from_z(normal);
    s.uv = disk_uv(center, normal, radius, s.p);
    s.dpdu = frame.x;
    s.uv_per_length = 0.5 / radius;
    s
}

/// A hit found in an instance's own space, moved to the world.
pub(crate) fn to_world(mut s: SurfaceInteraction, m: &Transform) -> SurfaceInteraction {
    let matrix = m.matrix().matrix3;
    let abs = |v: Vec3| {
        Vec3::from(matrix.x_axis).abs() * v.x
            + Vec3::from(matrix.y_axis).abs() * v.y
            + Vec3::from(matrix.z_axis).abs() * v.z
    };
    let scale = matrix.determinant().abs().cbrt();
    // Pharr, Jakob & Humphreys 2023, eq. 6.30: the error of a transformed point that was not exact.
    let translation = Vec3::from(m.matrix().translation).abs();
    let box_error =
        abs(Vec3::splat(s.p_error)) * (1.0 + gamma(3)) + (abs(s.p.abs()) + translation) * gamma(3);
    s.p_error = box_error.max_element();
    s.p = m.point(s.p);
    s.ng = m.normal(s.ng).normalize();
    s.ns = m.normal(s.ns).normalize();
    s.dpdu = m.vector(s.dpdu);
    s.uv_per_length /= scale.max(f32::MIN_POSITIVE);
    s
}

#[cfg(test)]
mod tests {
    use accel::{Bvh, Geometry};
    use sampling::{Domain, Sampler, warp};

    use super::*;

    /// Rays that leave a surface on either side do not meet the point that they leave: of `shape`, whatever its size
    /// and place.
    fn leaves_cleanly(name: &str, make: impl Fn(&mut Sampler) -> Shape) {
        let mut self_hits = 0;
        for trial in 0..2000 {
            let mut s = Sampler::new(1, trial, Domain::Other, 0);
            let shape = make(&mut s);
            let mut geometry = Geometry::default();
            let (aim, size) = match &shape {
                Shape::Mesh(m) => {
                    geometry.add_triangles(&m.positions, &m.indices);
                    (m.positions.iter().sum::<Vec3>() / 3.0, m.bounds().size().length())
                }
                Shape::Sphere { center, radius, .. } => {
                    geometry.add_sphere(*center, *radius);
                    (*center, *radius)
                }
                Shape::Disk { center, normal, radius } => {
                    geometry.add_disk(*center, *normal, *radius);
                    (*center, *radius)
                }
            };
            let bvh = Bvh::build(geometry);
            let object = Object { shape, material: MaterialId(0), light: None };
            let jitter = warp::sphere(s.next_2d()) * (0.3 * size * s.next_1d());
            let from = aim + warp::sphere(s.next_2d()) * (size * 3.0);
            let ray = Ray::new(from, (aim + jitter - from).normalize());
            let Some(hit) = bvh.closest(&ray) else { continue };
            let surface = object.interaction(&ray, &hit);
            for i in 0..100 {
                let mut w = warp::sphere(s.next_2d());
                if i % 2 == 0 {
                    // Grazing.
                    w = (w - surface.ng * w.dot(surface.ng) * 0.999).normalize();
                }
                let leaving = surface.spawn_ray(w);
                // From inside a sphere the far side is met, at a distance that tells.
                if let Some(again) = bvh.closest(&leaving)
                    && leaving.at(again.t).distance(surface.p) < 1e-3 * size * w.dot(surface.ng).abs()
                {
                    self_hits += 1;
                }
            }
        }
        assert_eq!(self_hits, 0, "{name}");
    }

    fn offset(s: &mut Sampler) -> Vec3 {
        // On the axes' planes as often as far away.
        let scale = [0.0, 1.0, 1e3, 1e5][s.next_u32() as usize % 4];
        warp::sphere(s.next_2d()) * scale
    }

    #[test]
    fn rays_that_leave_a_triangle_do_not_meet_it() {
        leaves_cleanly("triangle", |s| {
            let size = 10f32.powf(s.next_1d() * 6.0 - 3.0);
            let o = offset(s);
            let flat = s.next_u32() % 4;
            let positions: Vec<Vec3> = (0..3)
                .map(|_| {
                    let mut p = warp::sphere(s.next_2d()) * size;
                    // Axis-aligned planes through 0 have points without any rounding of their own.
                    if flat < 3 {
                        p[flat as usize] = 0.0;
                    }
                    p + if flat < 3 { Vec3::ZERO } else { o }
                })
                .collect();
            Shape::Mesh(Arc::new(TriangleMesh { positions, indices: vec![[0, 1, 2]], ..Default::default() }))
        });
    }

    #[test]
    fn rays_that_leave_a_sphere_do_not_meet_it() {
        leaves_cleanly("sphere", |s| Shape::Sphere {
            radius: 10f32.powf(s.next_1d() * 6.0 - 3.0),
            center: offset(s) * 0.01,
            flipped: false,
        });
    }

    #[test]
    fn rays_that_leave_a_disk_do_not_meet_it() {
        leaves_cleanly("disk", |s| Shape::Disk {
            radius: 10f32.powf(s.next_1d() * 6.0 - 3.0),
            center: offset(s) * 0.01,
            normal: warp::sphere(s.next_2d()),
        });
    }
}
