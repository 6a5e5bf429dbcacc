use bsdf::TransportMode;
use color::Lanes;
use math::{Vec2, Vec3};
use scene::Scene;

use crate::mis::{End, projection_weight};
use crate::subpath::{density, geometric_cos, merging};
use crate::{LightVertex, Vertex};

/// A vertex of a light path joined to the camera.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Where on the film, in pixels.
    pub film_position: Vec2,
    /// What a pixel at that place receives of the path, as if it were the only one; not weighted.
    pub radiance: Lanes,
    /// Width of a pixel at the vertex.
    pub footprint: f32,
    /// The vertex, reached by one camera path a pixel.
    end: End,
}

impl Projection {
    /// Weight against all other techniques (Georgiev 2012, eq. 46), where each light path meets `per_light_path`
    /// camera paths a pixel.
    pub fn weight(&self, eta: f64, per_light_path: f64) -> f32 {
        projection_weight(eta, &End { reached: self.end.reached * per_light_path, ..self.end })
    }
}

/// Joins a vertex of a light path to the camera; `None` where nothing arrives. The caller asks [`is_seen`].
pub fn project(scene: &Scene, light: &LightVertex) -> Option<(Projection, Vec3)> {
    let camera = scene.camera();
    let vertex = &light.at.vertex;
    let wi = camera.sample_wi(vertex.hit.p, light.u_lens)?;
    let f = reflected(vertex, wi.wi);
    if f.is_zero() {
        return None;
    }
    let left = vertex.transmittance(scene, wi.wi, wi.distance);
    let radiance = light.flux * f * left * wi.importance;
    let density_a = camera.pdf_we(wi.p, -wi.wi).across(f64::from(wi.distance).powi(2));
    let end = End {
        mis: light.at.mis,
        merging: merging(&vertex.bsdf),
        reverse: density(vertex, wi.wi, vertex.wo, TransportMode::Radiance),
        reached: density_a * geometric_cos(vertex, wi.wi),
    };
    let pixel = camera.sample_we(wi.film_position, [0.5; 2]);
    let footprint = pixel.width + pixel.spread * wi.distance;
    let projection = Projection { film_position: wi.film_position, radiance, footprint, end };
    Some((projection, wi.p))
}

/// Whether nothing lies between a vertex and a point of the lens.
pub fn is_seen(scene: &Scene, vertex: &Vertex, lens: Vec3) -> bool {
    !scene.occluded(&vertex.hit.spawn_ray_to(lens, 0.0, Vec3::ZERO))
}

/// f·|cos| of a photon's vertex toward `wi`, with the factor of shading normals (Veach 1997, eq. 5.19).
pub(crate) fn reflected(vertex: &Vertex, wi: Vec3) -> Lanes {
    let bsdf = &vertex.bsdf;
    let f = bsdf.eval(vertex.wo, wi, TransportMode::Importance);
    if f.is_zero() {
        return f;
    }
    f * (bsdf.abs_cos(wi) * bsdf.shading_correction(vertex.wo, wi))
}
