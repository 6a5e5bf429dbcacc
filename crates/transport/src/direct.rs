use bsdf::{Lobes, TransportMode};
use color::Lanes;
use math::Vec3;
use sampling::Sampler;
use scene::light::{Drawn, LiSample, LightHit};
use scene::{LightId, Scene};

use crate::{EyeChain, Scattered, Vertex, Walk};

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

/// Numbers in [0, 1) for light sampling at one vertex.
pub trait LightNumbers {
    /// Chooses a light, or a part of one.
    fn choice(&mut self) -> f32;
    /// A point of the `nth` light that is sampled.
    fn point(&mut self, nth: u32) -> [f32; 2];
}

impl LightNumbers for Sampler {
    #[inline]
    fn choice(&mut self) -> f32 {
        self.next_1d()
    }

    #[inline]
    fn point(&mut self, _nth: u32) -> [f32; 2] {
        self.next_2d()
    }
}

/// Next-event estimation: light reflected toward `vertex.wo` that arrives straight from sampled lights, each with its
/// weight against finding the light by BSDF sampling. Not multiplied by any throughput.
#[inline]
pub fn direct(scene: &Scene, vertex: &Vertex, numbers: &mut impl LightNumbers, found: impl FnMut(&Direct)) {
    direct_against(scene, vertex, Lobes::ALL, numbers, found);
}

/// [`direct`], weighted against BSDF sampling from `rivals` alone; [`Lobes::NONE`]: not weighted.
#[inline]
pub fn direct_against(
    scene: &Scene,
    vertex: &Vertex,
    rivals: Lobes,
    numbers: &mut impl LightNumbers,
    found: impl FnMut(&Direct),
) {
    let weight = |sampled: &Sampled| {
        if sampled.li.is_delta {
            return 1.0;
        }
        let rival = vertex.bsdf.pdf_w_lobes(vertex.wo, sampled.li.wi, rivals, TransportMode::Radiance);
        power_heuristic(sampled.expected * sampled.li.pdf_w, rival)
    };
    direct_weighted(scene, vertex, numbers, weight, found);
}

/// [`direct`] at the S surface `vertex`, the end of a chain that merging competes for.
pub fn direct_in_chain(
    scene: &Scene,
    vertex: &Vertex,
    chain: &EyeChain,
    numbers: &mut impl LightNumbers,
    found: impl FnMut(&Direct),
) {
    let weight = |sampled: &Sampled| {
        let li = &sampled.li;
        let merge = chain.merge_over_direct(scene, vertex, sampled.light, sampled.expected, li);
        let emission = if li.is_delta {
            0.0
        } else {
            let rival = vertex.bsdf.pdf_w(vertex.wo, li.wi, TransportMode::Radiance);
            f64::from(rival) / (f64::from(sampled.expected) * f64::from(li.pdf_w))
        };
        (1.0 / (1.0 + merge + emission)) as f32
    };
    direct_weighted(scene, vertex, numbers, weight, found);
}

/// A light that was sampled.
pub(crate) struct Sampled {
    pub light: LightId,
    /// Expected number of its samples at the vertex.
    pub expected: f32,
    pub li: LiSample,
}

/// [`direct`], weighted by a function of what was sampled.
#[inline]
pub(crate) fn direct_weighted(
    scene: &Scene,
    vertex: &Vertex,
    numbers: &mut impl LightNumbers,
    weight: impl Fn(&Sampled) -> f32,
    mut found: impl FnMut(&Direct),
) {
    if vertex.bsdf.is_delta_only() {
        return;
    }
    let receiver = vertex.receiver();
    let u_light = numbers.choice();
    for nth in 0..scene.direct_picker().draws() {
        let drawn = scene.direct_picker().draw(&receiver, nth, u_light);
        let u = numbers.point(nth);
        if let Some(direct) = from_light(scene, vertex, &drawn, u, &weight) {
            found(&direct);
        }
    }
}

#[inline]
fn from_light(
    scene: &Scene,
    vertex: &Vertex,
    drawn: &Drawn,
    u: [f32; 2],
    weight: impl Fn(&Sampled) -> f32,
) -> Option<Direct> {
    let expected = drawn.expected;
    if expected == 0.0 {
        return None;
    }
    let light = LightId(drawn.light as u32);
    let li = scene.sample_li(light, vertex.hit.p, vertex.hit.ng, drawn.u, u)?;
    let f = vertex.bsdf.eval(vertex.wo, li.wi, TransportMode::Radiance);
    if f.is_zero() || li.radiance.is_zero() {
        return None;
    }
    let sampled = Sampled { light, expected, li };
    let weight = weight(&sampled);
    let li = sampled.li;
    let ray = if li.distance.is_finite() {
        vertex.hit.spawn_ray_to(li.p, li.p_error, li.n)
    } else {
        vertex.hit.spawn_ray(li.wi)
    };
    if scene.occluded(&ray) {
        return None;
    }
    let cos = vertex.bsdf.ns().dot(li.wi).abs();
    let left = vertex.transmittance(scene, li.wi, li.distance);
    Some(Direct { light, radiance: f * li.radiance * left * (cos * weight / (expected * li.pdf_w)) })
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
    emission_of(light, light_hit(vertex), walk.scene(), walk.last().copied(), vertex.wo)
}

/// The point of the light that the surface at `vertex` is.
pub(crate) fn light_hit(vertex: &Vertex) -> LightHit {
    LightHit { p: vertex.hit.p, ng: vertex.hit.authored_ng(), prim: vertex.hit.prim }
}

#[inline(never)]
fn emission_of(
    light: LightId,
    hit: LightHit,
    scene: &Scene,
    last: Option<Scattered>,
    wo: Vec3,
) -> Option<Emission> {
    let radiance = scene.emitted(light, &hit, wo);
    let (own, other) = densities(scene, last, light, -wo, Some(hit));
    (!radiance.is_zero()).then_some(Emission { light, radiance, weight: power_heuristic(own, other) })
}

/// The lights at infinity that a walk sees when it leaves the scene.
#[inline]
pub fn emission_escaped<'s>(walk: &Walk<'s>) -> impl Iterator<Item = Emission> + use<'s> {
    let (scene, last, direction) = (walk.scene(), walk.last().copied(), walk.ray.direction);
    scene.environments().iter().filter_map(move |&light| {
        let radiance = scene.light(light).escaped(direction);
        (!radiance.is_zero()).then(|| {
            let (own, other) = densities(scene, last, light, direction, None);
            Emission { light, radiance, weight: power_heuristic(own, other) }
        })
    })
}

/// [`emission_at`] where merging may compete.
#[inline]
pub fn emission_in_chain(walk: &Walk<'_>, vertex: &Vertex, chain: &EyeChain) -> Option<Emission> {
    let light = vertex.hit.light?;
    if !chain.competes() {
        return emission_at(walk, vertex);
    }
    let hit = light_hit(vertex);
    let radiance = walk.scene().emitted(light, &hit, vertex.wo);
    (!radiance.is_zero()).then(|| {
        let merge = chain.merge_over_emission(walk, light, Some(hit));
        Emission { light, radiance, weight: against_both(walk, light, Some(hit), merge) }
    })
}

/// [`emission_escaped`] where merging may compete.
pub fn escaped_in_chain<'s>(walk: Walk<'s>, chain: EyeChain) -> impl Iterator<Item = Emission> + use<'s> {
    emission_escaped(&walk).map(move |e| {
        if !chain.competes() {
            return e;
        }
        let merge = chain.merge_over_emission(&walk, e.light, None);
        Emission { weight: against_both(&walk, e.light, None, merge), ..e }
    })
}

/// Balance heuristic of emission against light sampling and merging, whose density over emission's is `merge`.
fn against_both(walk: &Walk<'_>, light: LightId, hit: Option<LightHit>, merge: f64) -> f32 {
    let (own, other) = densities(walk.scene(), walk.last().copied(), light, walk.ray.direction, hit);
    let direct = if own.is_infinite() { 0.0 } else { f64::from(other) / f64::from(own) };
    (1.0 / (1.0 + merge + direct)) as f32
}

/// Densities per steradian at the last vertex, of the walk and of light sampling; an infinite one and 0 where that
/// could not have found the light.
fn densities(
    scene: &Scene,
    last: Option<Scattered>,
    light: LightId,
    direction: Vec3,
    hit: Option<LightHit>,
) -> (f32, f32) {
    let Some(last) = last.filter(|last| last.lit) else { return (f32::INFINITY, 0.0) };
    let expected = scene.direct_picker().expected(light.0 as usize, &last.from);
    (last.pdf_w, expected * scene.light(light).pdf_li_w(last.from.p, direction, hit))
}
