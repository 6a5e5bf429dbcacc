use color::Lanes;
use math::{Bounds3, Vec3, gamma};
use sampling::{Discrete, warp};

use super::emission::Origin;
use super::{AreaEmission, LiSample, Sides};

/// Triangles with one emission; points are uniform in area over all of them.
#[derive(Clone, Debug)]
pub struct TriangleLight {
    triangles: Vec<[Vec3; 3]>,
    /// Unit normal of each triangle's front, and its longest edge.
    normals: Vec<(Vec3, f32)>,
    picks: Discrete,
    area: f32,
    bounds: Bounds3,
    surface: AreaEmission,
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
        })
    }

    /// The parallelogram with a corner and two edges; its front is along `edge_u × edge_v`.
    /// `None` as in [`Self::new`].
    pub fn quad(corner: Vec3, edge_u: Vec3, edge_v: Vec3, radiance: Lanes, sides: Sides) -> Option<Self> {
        let [a, b, c, d] = [corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v];
        Self::new(vec![[a, b, c], [a, c, d]], radiance, sides)
    }

    /// Emission.
    pub fn surface(&self) -> &AreaEmission {
        &self.surface
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
        let (index, _, _) = self.picks.sample(u_pick);
        let t = &self.triangles[index];
        let [b0, b1] = warp::triangle(u);
        let parts = [t[0] * b0, t[1] * b1, t[2] * (1.0 - b0 - b1)];
        let (ng, reach) = self.normals[index];
        let rounding = (parts[0].abs() + parts[1].abs() + parts[2].abs()).max_element();
        let p_error = rounding * gamma(6) + reach * gamma(3);
        Origin { p: parts[0] + parts[1] + parts[2], p_error, ng, pdf_a: 1.0 / self.area, prim: index as u32 }
    }

    #[inline]
    pub(super) fn sample_li(&self, p: Vec3, u_pick: f32, u: [f32; 2]) -> Option<LiSample> {
        self.surface.li_from_area(self.area, p, &self.origin(u_pick, u))
    }
}

fn longest_edge(t: &[Vec3; 3]) -> f32 {
    t[0].distance(t[1]).max(t[1].distance(t[2])).max(t[2].distance(t[0]))
}

/// Twice the area, along the front normal.
fn cross(t: &[Vec3; 3]) -> math::DVec3 {
    let v = t.map(|v| v.as_dvec3());
    (v[1] - v[0]).cross(v[2] - v[0])
}
