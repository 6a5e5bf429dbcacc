use color::Lanes;
use math::{Bounds3, Vec3, gamma};
use sampling::{Discrete, warp};

use super::emission::Origin;
use super::pattern::Pattern;
use super::{AreaEmission, LiSample, LightHit, Sides};
use crate::shape::barycentric;

/// Triangles with one emission; points are uniform in area over all of them, or drawn by the pattern that the emission has.
#[derive(Clone, Debug)]
pub struct TriangleLight {
    triangles: Vec<[Vec3; 3]>,
    /// Unit normal of each triangle's front, and its longest edge.
    normals: Vec<(Vec3, f32)>,
    picks: Discrete,
    area: f32,
    bounds: Bounds3,
    surface: AreaEmission,
    pattern: Option<Box<Pattern>>,
}

impl TriangleLight {
    /// From triangles wound counter-clockwise seen from the front. Their order gives the `prim` index.
    /// `None` where the total area is zero or something is not finite or a lane is negative.
    pub fn new(triangles: Vec<[Vec3; 3]>, radiance: Lanes, sides: Sides) -> Option<Self> {
        let finite = triangles.iter().flatten().all(|v| v.is_finite());
        let area_of = |t: &[Vec3; 3]| 0.5 * cross(t).length();
        let picks = Discrete::new(triangles.iter().map(area_of));
        let area = picks.total() as f32;
        let bounds = Bounds3::of_points(triangles.iter().flatten().copied());
        let normals =
            triangles.iter().map(|t| (cross(t).normalize_or_zero().as_vec3(), longest_edge(t))).collect();
        let ok = finite && area.is_normal() && super::is_emission(radiance);
        ok.then_some(Self {
            triangles,
            normals,
            picks,
            area,
            bounds,
            surface: AreaEmission { radiance, sides },
            pattern: None,
        })
    }

    /// The same with a factor on the radiance that depends on the point: of (point, triangle), averaged over about a width.
    pub(super) fn textured(self, factor: impl Fn(Vec3, u32, f32) -> Lanes) -> Option<Self> {
        let areas: Vec<f64> = self.triangles.iter().map(|t| 0.5 * cross(t).length()).collect();
        let at = |prim: u32, u, width| factor(point(&self.triangles[prim as usize], u).0, prim, width);
        let pattern = Some(Box::new(Pattern::new(&areas, at)?));
        Some(Self { pattern, ..self })
    }

    /// The parallelogram with a corner and two edges; its front is along `edge_u × edge_v`.
    /// `None` as in [`Self::new`].
    pub fn quad(corner: Vec3, edge_u: Vec3, edge_v: Vec3, radiance: Lanes, sides: Sides) -> Option<Self> {
        let [a, b, c, d] = [corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v];
        Self::new(vec![[a, b, c], [a, c, d]], radiance, sides)
    }

    /// Emission, without what a texture makes of it.
    pub fn surface(&self) -> &AreaEmission {
        &self.surface
    }

    pub(super) fn surface_mut(&mut self) -> &mut AreaEmission {
        &mut self.surface
    }

    pub(super) fn pattern(&self) -> Option<&Pattern> {
        self.pattern.as_deref()
    }

    /// Density of points per area.
    pub(super) fn pdf_a(&self, p: Vec3, prim: u32) -> f32 {
        match &self.pattern {
            None => 1.0 / self.area,
            Some(pattern) => {
                let Some(t) = self.triangles.get(prim as usize) else { return 0.0 };
                let [b0, b1, _] = barycentric(p, t);
                pattern.pdf_a(prim, warp::triangle_inverse([b0, b1]))
            }
        }
    }

    /// Total area of one side.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Bounds of the vertices.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// A vertex and the unit normal of the front of each triangle that has any area.
    pub(super) fn faces(&self) -> impl Iterator<Item = (Vec3, Vec3)> {
        self.triangles.iter().filter_map(|t| Some((t[0], cross(t).try_normalize()?.as_vec3())))
    }

    #[inline]
    pub(super) fn origin(&self, u_pick: f32, u: [f32; 2]) -> Origin {
        match &self.pattern {
            None => self.origin_at(self.picks.sample(u_pick).0, u, 1.0 / self.area),
            Some(pattern) => {
                let s = pattern.sample(u_pick, u);
                self.origin_at(s.prim as usize, s.u, s.pdf_a)
            }
        }
    }

    #[inline]
    fn origin_at(&self, index: usize, u: [f32; 2], pdf_a: f32) -> Origin {
        let (p, rounding) = point(&self.triangles[index], u);
        let (ng, reach) = self.normals[index];
        let p_error = rounding * gamma(6) + reach * gamma(3);
        Origin { p, p_error, ng, pdf_a, prim: index as u32 }
    }

    #[inline]
    pub(super) fn sample_li(&self, p: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        let origin = self.origin(u_pick, u);
        let area = if self.pattern.is_some() { 1.0 / origin.pdf_a } else { self.area };
        self.surface.li_from_area(area, p, &origin)
    }

    pub(super) fn pdf_li_w(&self, receiver: Vec3, wi: Vec3, hit: LightHit) -> f32 {
        let area = if self.pattern.is_some() { 1.0 / self.pdf_a(hit.p, hit.prim) } else { self.area };
        self.surface.pdf_li_w(area, receiver, wi, hit)
    }
}

/// A point of a triangle, and a bound of the numbers that were added up for it.
#[inline]
fn point(t: &[Vec3; 3], u: [f32; 2]) -> (Vec3, f32) {
    let [b0, b1] = warp::triangle(u);
    let parts = [t[0] * b0, t[1] * b1, t[2] * (1.0 - b0 - b1)];
    let rounding = (parts[0].abs() + parts[1].abs() + parts[2].abs()).max_element();
    (parts[0] + parts[1] + parts[2], rounding)
}

fn longest_edge(t: &[Vec3; 3]) -> f32 {
    t[0].distance(t[1]).max(t[1].distance(t[2])).max(t[2].distance(t[0]))
}

/// Twice the area, along the front normal.
fn cross(t: &[Vec3; 3]) -> math::DVec3 {
    let v = t.map(|v| v.as_dvec3());
    (v[1] - v[0]).cross(v[2] - v[0])
}
