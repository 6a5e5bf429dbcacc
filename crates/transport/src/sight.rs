use math::Ray;
use photons::PhotonMap;
use scene::Scene;

use crate::{Vertex, Within};

/// Lift of a segment between points of a surface, of its length, so that a plane does not stand in its way.
const LIFT: f32 = 0.01;
/// The same for each unit by which the normals at its ends differ: of an edge that bends by θ, the chord is at most θ/4
/// of its length below.
const LIFT_OF_BEND: f32 = 0.3;

/// Whether a wall stands between a vertex and the photons found about it, as one of them says. Each says so for all with
/// the same chance, so that a lookup that is dropped where its witness is hidden has, in the mean, the share of photons that are
/// not. Density estimation takes all light within a disc for light on its middle: where a partition stands on a
/// lit floor, its dark side would be lit by a disc's width. Glass hides nothing: a disc under a ball that touches the
/// floor is one disc.
#[inline]
pub fn is_hidden(scene: &Scene, map: &PhotonMap, vertex: &Vertex, within: &Within) -> bool {
    if within.count == 0 {
        return false;
    }
    let (position, normal) = map.place(within.witness);
    let hit = &vertex.hit;
    let own = vertex.facing_ng();
    let length = (position - hit.p).length();
    // Where light passes through, photons of the other side count, too: the segment stays on this one.
    let normal = if normal.dot(own) < 0.0 { -normal } else { normal };
    let lift = length * (LIFT + LIFT_OF_BEND * (normal - own).length()) + 2.0 * hit.p_error;
    let origin = hit.p + own * lift;
    let ray = Ray { origin, direction: position + normal * lift - origin, t_max: 1.0 };
    scene.occluded(&ray) && scene.intersect(&ray).is_some_and(|wall| scene.medium(&wall).is_none())
}
