use bsdf::{BsdfKind, Lobes, TransportMode};
use color::Lanes;
use math::FRAC_1_PI;
use photons::{Kernel, Neighbourhood, PhotonMap, PhotonView, Query, Scratch};

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
        if self.count == 0 { 0.0 } else { per_disc(self.count, self.radius) }
    }
}

fn per_disc(count: usize, radius: f32) -> f32 {
    count as f32 / (std::f32::consts::PI * radius * radius)
}

/// The query at a vertex: on the side that is seen.
fn query(vertex: &Vertex, radius: f32, kernel: Kernel) -> Query {
    Query { position: vertex.hit.p, normal: vertex.facing_ng(), radius, kernel }
}

/// The query for what a surface lets pass: on the other side. `None` where photons there are not seen.
fn query_behind(vertex: &Vertex, front: &Query) -> Option<Query> {
    let passes = vertex.bsdf.lobes().contains(Lobes::TRANSMISSION);
    passes.then_some(Query { normal: -front.normal, ..*front })
}

/// What a surface reflects of photons: f toward `vertex.wo`, with the change from the cosine to the geometric normal,
/// which the photons' density carries, to that of the shading normal.
enum Receiver<'v> {
    /// f is the same for every photon above the surface, which they all are.
    Lambert(Lanes),
    Level(&'v Vertex),
    Bent(&'v Vertex),
}

impl<'v> Receiver<'v> {
    #[inline]
    fn new(vertex: &'v Vertex) -> Self {
        match *vertex.bsdf.kind() {
            _ if vertex.bsdf.ns() != vertex.hit.ng => Self::Bent(vertex),
            BsdfKind::Diffuse { albedo } => Self::Lambert(albedo * FRAC_1_PI),
            _ => Self::Level(vertex),
        }
    }

    #[inline]
    fn reflected(&self, photon: &PhotonView<'_>, weight: f32) -> Lanes {
        match *self {
            Self::Lambert(f) => f * photon.power * weight,
            Self::Level(vertex) => {
                let f = vertex.bsdf.eval(vertex.wo, photon.direction(), TransportMode::Radiance);
                f * photon.power * weight
            }
            Self::Bent(vertex) => {
                let wi = photon.direction();
                let f = vertex.bsdf.eval(vertex.wo, wi, TransportMode::Radiance);
                f * photon.power * (weight * bend(wi.dot(vertex.bsdf.ns()), wi.dot(vertex.hit.ng)))
            }
        }
    }
}

/// Density estimation: L ≈ Σ f·Φ·k(d/r)/r² (Jensen 2001, eq. 7.7), no further cosine. Where the surface lets light pass, both
/// sides are estimated, each from its own neighbours; radius and count are those of the side that is seen.
pub fn merge(map: &PhotonMap, vertex: &Vertex, lookup: &Lookup, scratch: &mut Scratch) -> Merged {
    let query = query(vertex, lookup.max_radius, lookup.kernel);
    let receiver = Receiver::new(vertex);
    if let Receiver::Lambert(f) = receiver {
        let (e, found) = irradiance(map, &query, lookup.knn, scratch);
        return Merged { radiance: f * e, radius: found.radius, count: found.count };
    }
    let mut radiance = Lanes::ZERO;
    let found = merge_each(map, vertex, lookup, scratch, |_, part| radiance += part);
    Merged { radiance, radius: found.radius, count: found.count }
}

/// The photons of the estimate that [`merge`] makes: calls `f` with each and the radiance that it adds toward `vertex.wo`;
/// what was looked at on the side that is seen.
pub fn merge_each(
    map: &PhotonMap,
    vertex: &Vertex,
    lookup: &Lookup,
    scratch: &mut Scratch,
    mut f: impl FnMut(&PhotonView<'_>, Lanes),
) -> Neighbourhood {
    let query = query(vertex, lookup.max_radius, lookup.kernel);
    let receiver = Receiver::new(vertex);
    let found = map.gather_knn(&query, lookup.knn, scratch, |photon, weight| {
        f(photon, receiver.reflected(photon, weight));
    });
    if let Some(behind) = query_behind(vertex, &query) {
        map.gather_knn(&behind, lookup.knn, scratch, |photon, weight| {
            f(photon, receiver.reflected(photon, weight));
        });
    }
    found
}

/// Photons within a given radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Within {
    /// How many.
    pub count: usize,
    /// One of them, each with the same chance, by its place in the map; 0 where there is none.
    pub witness: u32,
}

impl Within {
    /// Photons per unit of area, where `radius` was looked at.
    #[inline]
    pub fn density(&self, radius: f32) -> f32 {
        per_disc(self.count, radius)
    }
}

/// The same estimate with a given radius: calls `f` with each photon and the radiance that it adds toward
/// `vertex.wo`. On both sides where the surface lets light pass.
#[inline]
pub fn merge_within(
    map: &PhotonMap,
    vertex: &Vertex,
    radius: f32,
    kernel: Kernel,
    mut f: impl FnMut(&PhotonView<'_>, Lanes),
) -> Within {
    let receiver = Receiver::new(vertex);
    let (mut witness, mut highest) = (0, 0);
    let mut show = |photon: &PhotonView<'_>, weight: f32| {
        // Multiples of the golden section scatter evenly over the numbers (Knuth 1998, §6.4).
        let rank = photon.slot.wrapping_add(1).wrapping_mul(0x9e37_79b9);
        if rank >= highest {
            (witness, highest) = (photon.slot, rank);
        }
        f(photon, receiver.reflected(photon, weight));
    };
    let front = query(vertex, radius, kernel);
    let mut count = map.gather(&front, &mut show);
    if let Some(behind) = query_behind(vertex, &front) {
        count += map.gather(&behind, &mut show);
    }
    Within { count, witness }
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
    let query = query(vertex, max_radius, Kernel::Constant);
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
