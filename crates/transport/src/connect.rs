use bsdf::{BsdfKind, TransportMode};
use color::Lanes;
use math::{FRAC_1_PI, Vec3};
use scene::light::LightHit;
use scene::{LightId, Scene};

use crate::direct::{Sampled, direct_weighted, light_hit};
use crate::mis::{End, connection_weight, direct_weight, emission_weight};
use crate::project::reflected;
use crate::subpath::{EyeEnd, PathVertex, density, geometric_cos, merging, survival};
use crate::{Direct, Emission, LightDensities, LightNumbers, LightVertex, SubpathMis, Vertex};

/// Joins a vertex of an eye path and one of a light path: weighted radiance toward `eye.vertex.wo`, not multiplied by the
/// throughput of the eye path. `None`: none arrives.
#[inline]
pub fn connect(scene: &Scene, eye: &PathVertex, light: &LightVertex, eta: f64) -> Option<Lanes> {
    let (x, y) = (&eye.vertex, &light.at.vertex);
    let d = y.hit.p - x.hit.p;
    let d2 = d.length_squared();
    let wi = d / d2.sqrt();
    if !wi.is_finite() {
        return None;
    }
    let f_eye = x.bsdf.eval(x.wo, wi, TransportMode::Radiance);
    if f_eye.is_zero() {
        return None;
    }
    let f_light = reflected(y, -wi);
    if f_light.is_zero() {
        return None;
    }
    let cos_eye = x.bsdf.abs_cos(wi);
    let over = 1.0 / f64::from(d2);
    let light_end = End {
        mis: light.at.mis,
        merging: merging(&y.bsdf),
        reverse: density(y, -wi, y.wo, TransportMode::Radiance),
        reached: density(x, x.wo, wi, TransportMode::Radiance) * geometric_cos(y, wi) * over,
    };
    let eye_end = End {
        mis: eye.mis,
        merging: merging(&x.bsdf),
        reverse: density(x, wi, x.wo, TransportMode::Importance),
        reached: density(y, y.wo, -wi, TransportMode::Importance) * geometric_cos(x, wi) * over,
    };
    let weight = connection_weight(eta, &light_end, &eye_end);
    let left = x.transmittance(scene, wi, d2.sqrt());
    let radiance = light.flux * f_light * f_eye * left * (cos_eye * weight / d2);
    if radiance.is_zero() || scene.occluded(&x.hit.spawn_ray_to(y.hit.p, y.hit.p_error, facing(y, -wi))) {
        return None;
    }
    Some(radiance)
}

/// The geometric normal on the side of `w`.
fn facing(vertex: &Vertex, w: Vec3) -> Vec3 {
    let ng = vertex.hit.ng;
    if ng.dot(w) < 0.0 { -ng } else { ng }
}

/// Light sampling, weighted against all other techniques.
#[inline]
pub fn connect_light(
    scene: &Scene,
    eye: &PathVertex,
    eta: f64,
    numbers: &mut impl LightNumbers,
    found: impl FnMut(&Direct),
) {
    let vertex = &eye.vertex;
    let weight = |sampled: &Sampled| {
        let wi = sampled.li.wi;
        let found = LightDensities::of_direct(scene, sampled.light, sampled.expected, &sampled.li);
        let forward = density(vertex, vertex.wo, wi, TransportMode::Radiance);
        let end = End {
            mis: eye.mis,
            merging: merging(&vertex.bsdf),
            reverse: density(vertex, wi, vertex.wo, TransportMode::Importance),
            reached: found.emitted / found.direct * geometric_cos(vertex, wi),
        };
        direct_weight(eta, forward * found.cos / found.direct, &end)
    };
    direct_weighted(scene, vertex, numbers, weight, found);
}

/// The light that the surface at `vertex` is, seen from the eye path's last vertex.
pub fn emission_against_all(scene: &Scene, end: &EyeEnd, vertex: &Vertex, eta: f64) -> Option<Emission> {
    let light = vertex.hit.light?;
    let hit = light_hit(vertex);
    let radiance = scene.emitted(light, &hit, vertex.wo);
    let weight = weight_of(scene, light, end, Some(hit), eta);
    (!radiance.is_zero()).then_some(Emission { light, radiance, weight })
}

/// The lights at infinity that an eye path sees on leaving the scene.
pub fn escape_against_all(scene: &Scene, end: EyeEnd, eta: f64) -> impl Iterator<Item = Emission> {
    scene.environments().iter().filter_map(move |&light| {
        let radiance = scene.light(light).escaped(end.direction);
        (!radiance.is_zero()).then(|| Emission {
            light,
            radiance,
            weight: weight_of(scene, light, &end, None, eta),
        })
    })
}

fn weight_of(scene: &Scene, light: LightId, end: &EyeEnd, hit: Option<LightHit>, eta: f64) -> f32 {
    let found = LightDensities::of_end(scene, light, end, hit);
    emission_weight(eta, &end.leaving, found.direct / found.cos, found.emitted / found.cos)
}

/// Weights of the photons that are merged at one vertex of an eye path (Georgiev 2012, eq. 38, 39).
#[derive(Clone, Copy, Debug)]
pub struct MergingWeights<'v> {
    eye: &'v PathVertex,
    eta: f32,
    lambert: Option<Lambert>,
}

/// What all photons share at a Lambertian vertex.
#[derive(Clone, Copy, Debug)]
struct Lambert {
    normal: Vec3,
    /// Density with which the eye path goes on, per cosine.
    forward: f32,
    /// What competes on the eye path's side, with η.
    eye: f32,
}

impl<'v> MergingWeights<'v> {
    /// For photons within a radius r, with η = π·r²·n.
    pub fn new(eye: &'v PathVertex, eta: f64) -> Self {
        let PathVertex { vertex, mis } = eye;
        let lambert = matches!(vertex.bsdf.kind(), BsdfKind::Diffuse { .. }).then(|| {
            let survival = survival(&vertex.bsdf, vertex.wo);
            let reverse = survival * FRAC_1_PI * vertex.bsdf.abs_cos(vertex.wo);
            Lambert {
                normal: vertex.bsdf.ns(),
                forward: survival * FRAC_1_PI,
                eye: (eta + mis.before(eta, f64::from(reverse))) as f32,
            }
        });
        Self { eye, eta: eta as f32, lambert }
    }

    /// Of a photon that arrived from `wi`, on the side of `wo`, with those numbers.
    #[inline]
    pub fn weight(&self, light: &SubpathMis, wi: Vec3) -> f32 {
        match &self.lambert {
            Some(l) => {
                let reverse = l.forward * l.normal.dot(wi).abs();
                let dvc = light.rest + self.eta * light.merges;
                self.eta / (l.eye + light.edge + dvc * reverse)
            }
            None => self.weight_any(light, wi),
        }
    }

    #[inline(never)]
    fn weight_any(&self, light: &SubpathMis, wi: Vec3) -> f32 {
        let PathVertex { vertex, mis } = self.eye;
        let light_reverse = density(vertex, vertex.wo, wi, TransportMode::Radiance);
        let eye_reverse = density(vertex, wi, vertex.wo, TransportMode::Importance);
        let eta = f64::from(self.eta);
        (eta / (eta + light.before(eta, light_reverse) + mis.before(eta, eye_reverse))) as f32
    }
}
