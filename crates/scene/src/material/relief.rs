//! What bends shading normals: normal maps and bump maps, and what keeps bent normals from doing harm.

use math::{Frame, Vec3};

use super::Material;
use super::source::{FloatSource, Lookup, Place};
use crate::SurfaceInteraction;
use crate::texture::{Mapping, TexturePoint};

/// Cosine to which a shading normal is bent back where it faces away from a viewer who sees the surface's other side, and
/// least cosine between a bent and the geometric normal.
const BENT_COSINE: f32 = 0.01;

/// The shading normal, unless `wo` lies between its horizon and the geometric normal's, as at the silhouette of a
/// smooth mesh: then it is tilted toward `wo` until both agree on the side, where otherwise nothing would be
/// scattered.
#[inline]
pub(super) fn facing(ns: Vec3, ng: Vec3, wo: Vec3) -> Vec3 {
    let (cos, side) = (wo.dot(ns), wo.dot(ng));
    if cos * side > 0.0 || side == 0.0 {
        return ns;
    }
    (ns + wo * (BENT_COSINE.copysign(side) - cos)).normalize()
}

/// The normal nearest to `ns`, in the plane of it and `ng`, from which `wo` is mirrored to `wo`'s side of the surface: no mirror
/// image lies beneath it, and `ns` faces `wo` (Keller et al. 2017, *The Iray Light Transport Simulation and Rendering
/// System*, §A.3, asks for the same).
pub(super) fn with_valid_mirror(ns: Vec3, ng: Vec3, wo: Vec3) -> Vec3 {
    // Seen from behind, all is the other way round.
    let side = 1.0f32.copysign(wo.dot(ng));
    let (n, g) = (ns * side, ng * side);
    let height = wo.dot(g);
    let least = BENT_COSINE.min(0.9 * height);
    if 2.0 * n.dot(wo) * n.dot(g) - height >= least {
        return ns;
    }
    let across = n - g * n.dot(g);
    let Some(x) = across.try_normalize() else { return ns };
    // With N at the angle a from g, and wo's part in the plane of length r at the angle φ, the mirror image's height is
    // 2·r·cos(a − φ)·cos a − r·cos φ = r·cos(2a − φ).
    let (along, phi) = (wo.dot(x), wo.dot(x).atan2(height));
    let r = along.hypot(height);
    let most = 0.5 * (phi + (least / r).clamp(-1.0, 1.0).acos());
    let a = across.length().atan2(n.dot(g)).min(most).max(0.0);
    let (sin, cos) = a.sin_cos();
    (x * sin + g * cos) * side
}

/// The shading normal of smooth meshes for what reflects and refracts: `wo` is mirrored to its side of the surface, and refracted
/// to the other, where otherwise coarse meshes of glass have black seams. `eta`: index beyond the back over that beyond the front.
#[inline(never)]
pub(super) fn glossy_normal(ns: Vec3, ng: Vec3, wo: Vec3, eta: f32) -> Vec3 {
    let n = with_valid_mirror(facing(ns, ng, wo), ng, wo);
    let side = 1.0f32.copysign(wo.dot(ng));
    let across = if side > 0.0 { eta } else { 1.0 / eta };
    // Snell's law: the refracted direction is −wo/η + (cosᵢ/η − cosₜ)·n.
    let cos_i = wo.dot(n * side);
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (across * across);
    if sin2_t >= 1.0 {
        return n;
    }
    let refracted = n * side * (cos_i / across - (1.0 - sin2_t).sqrt()) - wo / across;
    if refracted.dot(ng * side) < 0.0 { n } else { ng }
}

impl Material {
    /// The shading normal under normal map and bump map, as a ray along `wo` may see it.
    #[inline(never)]
    pub(super) fn bent_normal(
        &self,
        hit: &SurfaceInteraction,
        wo: Vec3,
        eta: f32,
        lookup: &Lookup<'_>,
    ) -> Vec3 {
        let at = TexturePoint::of_hit(hit, lookup.footprint, lookup.of);
        let mut ns = hit.ns;
        if let Some((texture, strength)) = self.normal_map {
            ns = mapped_normal(ns, texture, strength, &at, lookup);
        }
        if let Some((texture, height)) = self.bump_map {
            ns = bumped_normal(ns, texture, height, &at, lookup);
        }
        // A normal that turned past the geometric horizon is brought back to it.
        let c = ns.dot(hit.ng);
        if c < BENT_COSINE {
            ns = (ns + hit.ng * (BENT_COSINE - c)).normalize();
        }
        if self.mirrors { glossy_normal(ns, hit.ng, wo, eta) } else { facing(ns, hit.ng, wo) }
    }

    /// The shading frame whose x is the tangent, turned as the material says.
    #[inline(never)]
    pub(super) fn oriented_frame(&self, hit: &SurfaceInteraction, ns: Vec3, lookup: &Lookup<'_>) -> Frame {
        let frame = Frame::from_zx(ns, hit.dpdu);
        if self.rotation == FloatSource::Constant(0.0) {
            return frame;
        }
        let place = Place { hit: Some(hit), lookup };
        let (sin, cos) = place.float(self.rotation).to_radians().sin_cos();
        let at = TexturePoint::of_hit(hit, lookup.footprint, lookup.of);
        let [_, dv] = at.attributes().map_or([Vec3::ZERO; 2], |a| a.tangents(0, hit.p));
        // From growing u toward growing v, also where the coordinates are mirrored.
        let hand = if dv.dot(frame.y) < 0.0 { -1.0 } else { 1.0 };
        Frame::from_zx(ns, frame.x * cos + frame.y * (sin * hand))
    }
}

/// The normal that a normal map stands for: x along growing u of the map's own coordinates, y along growing v, so that
/// mirrored coordinates give mirrored relief (as MikkTSpace has it: Mikkelsen 2008, §2.2), z along `ns`.
fn mapped_normal(ns: Vec3, texture: u32, strength: f32, at: &TexturePoint<'_>, lookup: &Lookup<'_>) -> Vec3 {
    let Some(map) = lookup.textures.get(texture as usize) else { return ns };
    let local = map.evaluate_normal(lookup.textures, at);
    let mapping = map.mapping(lookup.textures).unwrap_or_default();
    let attributes = at.attributes();
    let tangents = |set: u8| attributes.map_or([Vec3::ZERO; 2], |a| a.tangents(set, at.p));
    let [du, dv] = Mapping::directions(&mapping, ns, tangents);
    let frame = Frame::from_zx(ns, du);
    let y = if dv.dot(frame.y) < 0.0 { -frame.y } else { frame.y };
    let bent = frame.x * (local.x * strength) + y * (local.y * strength) + ns * local.z.max(1e-3);
    bent.try_normalize().unwrap_or(ns)
}

/// The normal of the surface moved along `ns` by the texture's mean times `height`: ns − ∇h (Blinn 1978; Mikkelsen 2010,
/// *Bump Mapping Unparametrized Surfaces on the GPU*, eq. 4). Slopes are central differences over a texel or the
/// footprint, whichever is larger.
fn bumped_normal(ns: Vec3, texture: u32, height: f32, at: &TexturePoint<'_>, lookup: &Lookup<'_>) -> Vec3 {
    let Some(map) = lookup.textures.get(texture as usize) else { return ns };
    let Some(grain) = map.grain(lookup.textures, at) else { return ns };
    let step = grain.max(0.5 * at.width);
    let level = |by: Vec3| {
        let [r, g, b] = map.evaluate(lookup.textures, &at.moved(by));
        (r + g + b) / 3.0
    };
    let frame = Frame::from_z(ns);
    let slope = |axis: Vec3| (level(axis * step) - level(axis * -step)) * (height / (2.0 * step));
    let bent = ns - frame.x * slope(frame.x) - frame.y * slope(frame.y);
    bent.try_normalize().unwrap_or(ns)
}

#[cfg(test)]
mod tests {
    use sampling::{Domain, Sampler, warp};

    use super::*;

    #[test]
    fn mirrors_of_bent_normals_lie_above_the_surface() {
        let mut changed = 0;
        for i in 0..20_000 {
            let mut s = Sampler::new(3, i, Domain::Other, 0);
            let (ng, wo) = (warp::sphere(s.next_2d()), warp::sphere(s.next_2d()));
            let tilted = warp::sphere(s.next_2d());
            let ns = if tilted.dot(ng) < BENT_COSINE {
                (tilted + ng * (BENT_COSINE - tilted.dot(ng))).normalize()
            } else {
                tilted
            };
            if wo.dot(ng).abs() < 1e-4 {
                continue;
            }
            let n = with_valid_mirror(ns, ng, wo);
            assert!((n.length() - 1.0).abs() < 1e-4);
            let mirrored = n * (2.0 * n.dot(wo)) - wo;
            let (above, side) = (mirrored.dot(ng), wo.dot(ng));
            assert!(above * side > 0.0, "{i}: {above} {side}");
            assert!(n.dot(wo) * side > 0.0 && n.dot(ng) > 0.0, "{i}");
            // No more than needed: what is right stays, and what is changed ends at the bound.
            if n == ns {
                continue;
            }
            changed += 1;
            let least = BENT_COSINE.min(0.9 * side.abs());
            assert!((above.abs() - least).abs() < 2e-3, "{i}: {above} {least}");
        }
        assert!(changed > 1000, "{changed}");
    }

    /// Both ways that light goes at smooth glass lie on the sides where they should, so that none is lost.
    #[test]
    fn glass_of_smooth_meshes_swallows_nothing() {
        let mut lost = 0;
        for i in 0..20_000 {
            let mut s = Sampler::new(4, i, Domain::Other, 0);
            let (ng, wo) = (warp::sphere(s.next_2d()), warp::sphere(s.next_2d()));
            let ns = (ng + warp::sphere(s.next_2d()) * 0.7).normalize();
            if wo.dot(ng).abs() < 1e-3 {
                continue;
            }
            let throughput = |ns: Vec3| {
                let kind = bsdf::BsdfKind::Dielectric { eta: 1.5, tint: color::Lanes::ONE };
                let glass = bsdf::Bsdf::new(kind, Frame::from_z(ns), ng);
                let lobes = glass.delta_lobes(wo, bsdf::TransportMode::Importance);
                lobes.into_iter().flatten().map(|lobe| lobe.weight.mean()).sum::<f32>()
            };
            lost += u32::from(throughput(facing(ns, ng, wo)) < 0.999);
            let whole = throughput(glossy_normal(ns, ng, wo, 1.5));
            assert!((whole - 1.0).abs() < 1e-4, "{i}: {whole}");
        }
        assert!(lost > 500, "{lost}");
    }

    #[test]
    fn a_facing_normal_stays() {
        let (ng, wo) = (Vec3::Z, Vec3::new(0.3, 0.0, 0.9).normalize());
        let ns = Vec3::new(0.2, 0.1, 0.95).normalize();
        assert_eq!(with_valid_mirror(ns, ng, wo), ns);
        assert_eq!(facing(ns, ng, wo), ns);
        assert_eq!(with_valid_mirror(ng, ng, -ng), ng);
    }
}
