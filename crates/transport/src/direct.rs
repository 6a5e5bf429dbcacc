use bsdf::{Lobes, TransportMode};
use color::Lanes;
use math::Vec3;
use sampling::Sampler;
use scene::light::LightHit;
use scene::{LightId, Scene};

use crate::{Scattered, Vertex, Walk};

/// Power heuristic with exponent 2 (Veach 1997, eq. 9.13) for a sample of density `own` against one other
/// technique of density `other`.
#[inline]
pub fn power_heuristic(own: f32, other: f32) -> f32 {
    if own.is_infinite() {
        return 1.0;
    }
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// Light that reached a vertex straight from a light.
#[derive(Clone, Copy, Debug)]
pub struct Direct {
    /// Which light.
    pub light: LightId,
    /// Reflected toward `vertex.wo`, weighted.
    pub radiance: Lanes,
}

/// Next-event estimation: light reflected toward `vertex.wo` that arrives straight from one sampled light, with the
/// weight against finding the light by BSDF sampling. Not multiplied by any throughput. `None`: there is none.
#[inline]
pub fn direct(scene: &Scene, vertex: &Vertex, sampler: &mut Sampler) -> Option<Direct> {
    let u_light = sampler.next_1d();
    let u = sampler.next_2d();
    direct_against(scene, vertex, Lobes::ALL, u_light, u)
}

/// [`direct`] from given numbers, weighted against BSDF sampling from `rivals` alone; [`Lobes::NONE`]: not weighted.
#[inline]
pub fn direct_against(
    scene: &Scene,
    vertex: &Vertex,
    rivals: Lobes,
    u_light: f32,
    u: [f32; 2],
) -> Option<Direct> {
    if vertex.bsdf.is_delta_only() {
        return None;
    }
    let (index, pmf, u_pick) = scene.direct_picker().sample(u_light);
    if pmf == 0.0 {
        return None;
    }
    let id = LightId(index as u32);
    let li = scene.light(id).sample_li(vertex.hit.p, vertex.hit.ng, u_pick, u)?;
    let f = vertex.bsdf.eval(vertex.wo, li.wi, TransportMode::Radiance);
    if f.is_zero() || li.radiance.is_zero() {
        return None;
    }
    let cos = vertex.bsdf.ns().dot(li.wi).abs();
    let density = pmf * li.pdf_w;
    let weight = if li.is_delta {
        1.0
    } else {
        power_heuristic(density, vertex.bsdf.pdf_w_lobes(vertex.wo, li.wi, rivals, TransportMode::Radiance))
    };
    let ray = if li.distance.is_finite() {
        vertex.hit.spawn_ray_to(li.p, li.p_error, li.n)
    } else {
        vertex.hit.spawn_ray(li.wi)
    };
    if scene.occluded(&ray) {
        return None;
    }
    Some(Direct { light: id, radiance: f * li.radiance * (cos * weight / density) })
}

/// A light that a walk met by following its own ray.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Which.
    pub light: LightId,
    /// Its radiance along the ray.
    pub radiance: Lanes,
    /// Weight against light sampling at the last vertex; 1 where that could not have found it.
    pub weight: f32,
}

/// The light that the surface at `vertex` is, seen from where the walk came.
#[inline]
pub fn emission_at(walk: &Walk<'_>, vertex: &Vertex) -> Option<Emission> {
    let light = vertex.hit.light?;
    let hit = LightHit { p: vertex.hit.p, ng: vertex.hit.authored_ng(), prim: vertex.hit.prim };
    emission_of(light, hit, walk.scene(), walk.last().copied(), vertex.wo)
}

#[inline(never)]
fn emission_of(
    light: LightId,
    hit: LightHit,
    scene: &Scene,
    last: Option<Scattered>,
    wo: Vec3,
) -> Option<Emission> {
    let radiance = scene.light(light).emitted(hit.ng, wo);
    let weight = weight_against_direct(scene, last, light, -wo, Some(hit));
    (!radiance.is_zero()).then_some(Emission { light, radiance, weight })
}

/// The lights at infinity that a walk sees when it leaves the scene.
#[inline]
pub fn emission_escaped<'s>(walk: &Walk<'s>) -> impl Iterator<Item = Emission> + use<'s> {
    let (scene, last, direction) = (walk.scene(), walk.last().copied(), walk.ray.direction);
    scene.environments().iter().filter_map(move |&light| {
        let radiance = scene.light(light).escaped(direction);
        (!radiance.is_zero()).then(|| Emission {
            light,
            radiance,
            weight: weight_against_direct(scene, last, light, direction, None),
        })
    })
}

fn weight_against_direct(
    scene: &Scene,
    last: Option<Scattered>,
    light: LightId,
    direction: Vec3,
    hit: Option<LightHit>,
) -> f32 {
    let Some(last) = last.filter(|last| last.lit) else { return 1.0 };
    let pmf = scene.direct_picker().pmf(light.0 as usize);
    let other = pmf * scene.light(light).pdf_li_w(last.p, direction, hit);
    power_heuristic(last.pdf_w, other)
}
