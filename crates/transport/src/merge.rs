use bsdf::{BsdfKind, TransportMode};
use color::Lanes;
use math::FRAC_1_PI;
use photons::{Kernel, Neighbourhood, PhotonMap, Query, Scratch};

use crate::Vertex;

/// How a photon map is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Neighbours.
    pub knn: usize,
    /// Greatest radius, in scene units.
    pub max_radius: f32,
    /// Profile.
    pub kernel: Kernel,
}

/// A density estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merged {
    /// Radiance toward `vertex.wo`.
    pub radiance: Lanes,
    /// Radius that was used.
    pub radius: f32,
    /// Photons in it.
    pub count: usize,
}

impl Merged {
    /// Photons per unit of area.
    pub fn density(&self) -> f32 {
        if self.count == 0 {
            0.0
        } else {
            self.count as f32 / (std::f32::consts::PI * self.radius * self.radius)
        }
    }
}

/// The query at a vertex: on the side that is seen.
pub(crate) fn query(vertex: &Vertex, lookup: &Lookup) -> Query {
    let ng = vertex.hit.ng;
    let normal = if vertex.wo.dot(ng) < 0.0 { -ng } else { ng };
    Query { position: vertex.hit.p, normal, radius: lookup.max_radius, kernel: lookup.kernel }
}

/// Density estimation: L ≈ Σ f·Φ·k(d/r)/r² (Jensen 2001, eq. 7.7), no further cosine. The photons' density carries
/// the cosine to the geometric normal; where the shading normal is another, theirs replaces it.
pub fn merge(map: &PhotonMap, vertex: &Vertex, lookup: &Lookup, scratch: &mut Scratch) -> Merged {
    let query = query(vertex, lookup);
    let (ns, ng) = (vertex.bsdf.ns(), vertex.hit.ng);
    if let BsdfKind::Diffuse { albedo } = *vertex.bsdf.kind()
        && ns == ng
    {
        // f is the same for every photon above the surface, which they all are.
        let (e, found) = irradiance(map, &query, lookup.knn, scratch);
        return Merged { radiance: albedo * e * FRAC_1_PI, radius: found.radius, count: found.count };
    }
    let mut radiance = Lanes::ZERO;
    let found = map.gather_knn(&query, lookup.knn, scratch, |photon, weight| {
        let wi = photon.direction();
        let f = vertex.bsdf.eval(vertex.wo, wi, TransportMode::Radiance);
        let bend = if ns == ng { 1.0 } else { bend(wi.dot(ns), wi.dot(ng)) };
        radiance += f * photon.power * (weight * bend);
    });
    Merged { radiance, radius: found.radius, count: found.count }
}

/// |cos to the shading normal| / |cos to the geometric normal|.
fn bend(cos_shading: f32, cos_geometric: f32) -> f32 {
    if cos_geometric == 0.0 { 0.0 } else { (cos_shading / cos_geometric).abs() }
}

/// Irradiance Σ Φ·k(d/r)/r² at a point of a surface, on the side of the query's normal, and what was looked at.
pub fn irradiance(
    map: &PhotonMap,
    query: &Query,
    knn: usize,
    scratch: &mut Scratch,
) -> (Lanes, Neighbourhood) {
    let mut sum = Lanes::ZERO;
    let found = map.gather_knn(query, knn, scratch, |photon, weight| sum += photon.power * weight);
    (sum, found)
}

/// The irradiance stored at the nearest sample of a map of irradiance samples (photons whose power is irradiance);
/// `None` where there is none of a compatible normal within `max_radius`.
pub fn nearest_irradiance(
    map: &PhotonMap,
    vertex: &Vertex,
    max_radius: f32,
    scratch: &mut Scratch,
) -> Option<Lanes> {
    let query = query(vertex, &Lookup { knn: 2, max_radius, kernel: Kernel::Constant });
    let mut found: Option<(f32, Lanes)> = None;
    // Of two neighbours the second is dropped, so this is a search for the one nearest; where the second lies
    // beyond the radius, both may be shown.
    map.gather_knn(&query, 2, scratch, |photon, _| {
        let d2 = (map.photon(photon.slot).position - query.position).length_squared();
        if found.is_none_or(|(best, _)| d2 < best) {
            found = Some((d2, photon.power));
        }
    });
    found.map(|(_, e)| e)
}
