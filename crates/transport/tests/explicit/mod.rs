//! Whole paths, and the density of every technique that may make them, per product of areas (of lights at infinity: of
//! the direction instead of the first area; where a factor is a delta it is left out for all).

use bsdf::{BsdfKind, Lobes, TransportMode};
use math::Vec3;
use nephroid_transport::{PathVertex, Sides, Subpath, Vertex};
use sampling::Sampler;
use scene::light::{LeSample, LiSample, LightHit};
use scene::{LightId, Scene};

use crate::Walked;

/// Where a path begins.
#[derive(Clone)]
pub struct LightPoint {
    pub id: LightId,
    /// As a light path would have started; only place, direction, normal, cosine and densities count.
    pub le: LeSample,
    /// The surface, where an eye path met it.
    pub surface: Option<Vertex>,
    /// Where light sampling drew it: its numbers, and the light's contribution before any weight.
    pub drawn: Option<(Sampler, f32)>,
}

impl LightPoint {
    pub fn of_emission(scene: &Scene, id: LightId, le: &LeSample) -> Self {
        assert!(scene.global_picker().pmf(id.0 as usize) > 0.0);
        Self { id, le: *le, surface: None, drawn: None }
    }

    /// A point with its front normal (zero at infinity and at points) that shines along `w`.
    fn at(scene: &Scene, id: LightId, start: &LightHit, w: Vec3) -> Self {
        let LightHit { p, ng, prim } = *start;
        let light = scene.light(id);
        let (pdf_a, pdf_w) = light.pdf_le(start, w);
        let area = !light.is_infinite() && !light.is_delta();
        let cos = if area { ng.dot(w).abs() } else { 1.0 };
        let n = if ng.dot(w) < 0.0 { -ng } else { ng };
        let le = LeSample { p, p_error: 0.0, n, w, radiance: color::Lanes::ONE, cos, pdf_a, pdf_w, prim };
        Self { id, le, surface: None, drawn: None }
    }
}

/// A surface on a path.
#[derive(Clone)]
pub struct Node {
    pub vertex: Vertex,
    pub to_light: Vec3,
    pub to_camera: Vec3,
    /// Whether the path takes a delta lobe there.
    pub specular: bool,
}

/// A path from a light to the camera; `nodes` from the light on.
pub struct FullPath {
    pub light: LightPoint,
    pub nodes: Vec<Node>,
    pub lens: Vec3,
    pub u_lens: [f32; 2],
}

impl FullPath {
    /// The lights that an eye path meets after `walked`: `vertex` is one, or the scene was left.
    pub fn at_light(
        scene: &Scene,
        walked: &Walked,
        subpath: &Subpath<'_>,
        vertex: Option<&PathVertex>,
        lens: Vec3,
        u_lens: [f32; 2],
    ) -> Vec<Self> {
        let Some(last) = walked.vertices.last() else { return Vec::new() };
        let w = -subpath.end().direction;
        let lights: Vec<LightPoint> = match vertex {
            None => scene
                .environments()
                .iter()
                .map(|&id| {
                    let start = LightHit { p: last.vertex.hit.p, ng: Vec3::ZERO, prim: 0 };
                    LightPoint::at(scene, id, &start, w)
                })
                .collect(),
            Some(at) => {
                let hit = &at.vertex.hit;
                let shines = |id: &LightId| !scene.light(*id).emitted(hit.authored_ng(), w).is_zero();
                let start = LightHit { p: hit.p, ng: hit.authored_ng(), prim: hit.prim };
                let point =
                    |id| LightPoint { surface: Some(at.vertex), ..LightPoint::at(scene, id, &start, w) };
                hit.light.filter(shines).map(point).into_iter().collect()
            }
        };
        let path = |light| Self { light, nodes: eye_nodes(walked, -w), lens, u_lens };
        lights.into_iter().map(path).collect()
    }

    /// The paths that light sampling at `at` makes with these numbers.
    pub fn by_light_sampling(
        scene: &Scene,
        walked: &Walked,
        at: &PathVertex,
        lens: Vec3,
        u_lens: [f32; 2],
        sampler: Sampler,
    ) -> Vec<Self> {
        let mut numbers = sampler;
        let (vertex, picker) = (&at.vertex, scene.direct_picker());
        let u_light = numbers.next_1d();
        let mut paths = Vec::new();
        for nth in 0..picker.draws() {
            let drawn = picker.draw(&vertex.receiver(), nth, u_light);
            let u = numbers.next_2d();
            let light = LightId(drawn.light as u32);
            let li = (drawn.expected > 0.0)
                .then(|| scene.sample_li(light, vertex.hit.p, vertex.hit.ng, drawn.u, u))
                .flatten();
            let path = li.and_then(|li| {
                let (light, nodes) = Self::to_sampled(scene, walked, at, light, &li)?;
                let f = vertex.bsdf.eval(vertex.wo, li.wi, TransportMode::Radiance);
                let cos = vertex.bsdf.abs_cos(li.wi);
                let unweighted = (f * li.radiance * (cos / (drawn.expected * li.pdf_w))).mean();
                let light = LightPoint { drawn: Some((sampler, unweighted)), ..light };
                (unweighted > 0.0).then_some(Self { light, nodes, lens, u_lens })
            });
            paths.extend(path);
        }
        paths
    }

    fn to_sampled(
        scene: &Scene,
        walked: &Walked,
        at: &PathVertex,
        id: LightId,
        li: &LiSample,
    ) -> Option<(LightPoint, Vec<Node>)> {
        let front = if scene.light(id).emitted(li.n, -li.wi).is_zero() { -li.n } else { li.n };
        let mut light = LightPoint::at(scene, id, &LightHit { p: li.p, ng: front, prim: li.prim }, -li.wi);
        let upto = with(walked, at);
        // The light's own surface, for emission at the end of the same path.
        let mut ray = at.vertex.hit.spawn_ray(li.wi);
        ray.t_max = f32::INFINITY;
        match scene.intersect(&ray) {
            Some(hit) if hit.light == Some(id) => {
                let bsdf = scene.bsdf(&hit, -li.wi, 1.0, 0.0);
                let hit = scene::SurfaceInteraction { p: li.p, ..hit };
                light.surface =
                    Some(Vertex { hit, bsdf, wo: -li.wi, footprint: 0.0, sides: Sides::default() });
            }
            Some(_) if li.distance.is_infinite() => return None,
            _ => {}
        }
        Some((light, eye_nodes(&upto, li.wi)))
    }

    /// The path that a connection of `at` with the last vertex of a light path makes, if neither is specular alone.
    pub fn by_connection(
        scene: &Scene,
        walked: &Walked,
        at: &PathVertex,
        point: &LightPoint,
        light: &Walked,
        lens: Vec3,
        u_lens: [f32; 2],
    ) -> Option<Self> {
        let end = light.vertices.last()?;
        if end.vertex.bsdf.is_delta_only() {
            return None;
        }
        let to_light = (end.vertex.hit.p - at.vertex.hit.p).normalize();
        let reflects = |v: &Vertex, w| !v.bsdf.eval(v.wo, w, TransportMode::Radiance).is_zero();
        let ray = at.vertex.hit.spawn_ray_to(end.vertex.hit.p, end.vertex.hit.p_error, -to_light * 0.0);
        if !reflects(&at.vertex, to_light) || !reflects(&end.vertex, -to_light) || scene.occluded(&ray) {
            return None;
        }
        let mut nodes = Vec::new();
        for (i, v) in light.vertices.iter().enumerate() {
            let to_camera = light.vertices.get(i + 1).map_or(-to_light, |next| -next.vertex.wo);
            let specular = i + 1 < light.vertices.len() && light.specular[i];
            nodes.push(Node { vertex: v.vertex, to_light: v.vertex.wo, to_camera, specular });
        }
        nodes.extend(eye_nodes(&with(walked, at), to_light));
        Some(Self { light: point.clone(), nodes, lens, u_lens })
    }
}

fn with(walked: &Walked, at: &PathVertex) -> Walked {
    Walked {
        vertices: walked.vertices.iter().chain([at]).copied().collect(),
        specular: walked.specular.iter().copied().chain([false]).collect(),
    }
}

/// The vertices of an eye path, the last first, which is left along `to_light`.
fn eye_nodes(walked: &Walked, to_light: Vec3) -> Vec<Node> {
    let mut nodes = Vec::new();
    let mut to_light = to_light;
    for (v, &specular) in walked.vertices.iter().zip(&walked.specular).rev() {
        nodes.push(Node { vertex: v.vertex, to_light, to_camera: v.vertex.wo, specular });
        to_light = -v.vertex.wo;
    }
    nodes
}

/// Density of the delta lobe that leads back (from `on` to `back`) over that of the one which leads on, per steradian.
pub fn ratio(vertex: &Vertex, back: Vec3, on: Vec3) -> f64 {
    let ng = vertex.hit.ng;
    let (cos_back, cos_on) = (f64::from(ng.dot(back)), f64::from(ng.dot(on)));
    match *vertex.bsdf.kind() {
        BsdfKind::Dielectric { eta, .. } | BsdfKind::RoughDielectric { eta, .. }
            if cos_back * cos_on < 0.0 =>
        {
            let eta = if cos_back > 0.0 { f64::from(eta) } else { 1.0 / f64::from(eta) };
            (cos_back / cos_on).abs() / (eta * eta)
        }
        _ => 1.0,
    }
}

pub fn survival(vertex: &Vertex, wo: Vec3) -> f64 {
    f64::from(vertex.bsdf.albedo(wo).max().clamp(0.02, 1.0))
}

/// The densities of all techniques.
pub struct Explicit<'p> {
    path: &'p FullPath,
    /// Of light sampling, of the light's point.
    drawn: f64,
    /// With which a light path reaches the light's point [0] and each node [i + 1].
    light: Vec<f64>,
    /// With which an eye path reaches them.
    eye: Vec<f64>,
    eta: f64,
}

impl<'p> Explicit<'p> {
    pub fn new(scene: &Scene, path: &'p FullPath, eta: f64, film_density: f64) -> Self {
        let (nodes, le) = (&path.nodes, &path.light.le);
        let light = scene.light(path.light.id);
        let index = path.light.id.0 as usize;
        let cos = |i: usize, w: Vec3| f64::from(nodes[i].vertex.hit.ng.dot(w).abs());
        let p = |i: usize| nodes[i].vertex.hit.p;
        let d2 = |a: Vec3, b: Vec3| f64::from(a.distance_squared(b));
        let m = nodes.len();
        let (far, delta) = (light.is_infinite(), light.is_delta());
        let first = d2(le.p, p(0));
        let emission = f64::from(scene.global_picker().pmf(index));
        let (pdf_a, pdf_w) = (f64::from(le.pdf_a), f64::from(le.pdf_w));
        let mut from_light = if far {
            vec![emission * pdf_w, pdf_a * cos(0, le.w)]
        } else {
            vec![emission * pdf_a, pdf_w * cos(0, le.w) / first]
        };
        // A delta lobe counts as 1 from the light on, and from the camera on as its ratio to that.
        let forward = |i: usize| {
            let n = &nodes[i];
            let pdf = f64::from(n.vertex.bsdf.pdf_w(n.to_light, n.to_camera, TransportMode::Importance));
            if n.specular { 1.0 } else { pdf * survival(&n.vertex, n.to_light) }
        };
        let backward = |i: usize| {
            let n = &nodes[i];
            let pdf = f64::from(n.vertex.bsdf.pdf_w(n.to_camera, n.to_light, TransportMode::Radiance));
            if n.specular {
                ratio(&n.vertex, n.to_light, n.to_camera)
            } else {
                pdf * survival(&n.vertex, n.to_camera)
            }
        };
        for (i, node) in nodes.iter().enumerate().skip(1) {
            from_light.push(forward(i - 1) * cos(i, node.to_light) / d2(p(i), p(i - 1)));
        }
        let mut from_eye = vec![0.0; m + 1];
        let camera =
            scene.camera().pdf_we(path.lens, -nodes[m - 1].to_camera).across(d2(path.lens, p(m - 1)));
        from_eye[m] = film_density * camera * cos(m - 1, nodes[m - 1].to_camera);
        for i in (1..m).rev() {
            from_eye[i] = backward(i) * cos(i - 1, nodes[i - 1].to_camera) / d2(p(i), p(i - 1));
        }
        let geometry = if far { 1.0 } else { f64::from(le.cos) / first };
        from_eye[0] = if delta { 0.0 } else { backward(0) * geometry };
        let direct = f64::from(scene.direct_picker().expected(index, &nodes[0].vertex.receiver()));
        let front = if light.emitted(le.n, le.w).is_zero() { -le.n } else { le.n };
        let hit = (!far).then_some(LightHit { p: le.p, ng: front, prim: le.prim });
        let drawn = match delta {
            true => direct,
            false => direct * f64::from(light.pdf_li_w(p(0), -le.w, hit)) * geometry,
        };
        Self { path, drawn, light: from_light, eye: from_eye, eta }
    }

    /// With a factor on the density of light sampling.
    pub fn times_drawn(self, factor: f64) -> Self {
        Self { drawn: self.drawn * factor, ..self }
    }

    fn joins(&self, i: usize) -> bool {
        let n = &self.path.nodes[i];
        !n.specular && !n.vertex.bsdf.is_delta_only()
    }

    /// Light path up to and with node `s` − 1 (0: the light's point alone; none: nothing), eye path from node `t` on.
    fn product(&self, light: std::ops::Range<usize>, eye: std::ops::Range<usize>) -> f64 {
        self.light[light].iter().product::<f64>() * self.eye[eye].iter().product::<f64>()
    }

    pub fn emission(&self) -> f64 {
        self.product(0..0, 0..self.eye.len())
    }

    pub fn direct(&self) -> f64 {
        if self.joins(0) { self.drawn * self.product(0..0, 1..self.eye.len()) } else { 0.0 }
    }

    /// Of nodes `i` and `i` + 1.
    pub fn connection(&self, i: usize) -> f64 {
        let joins = self.joins(i) && self.joins(i + 1);
        if joins { self.product(0..i + 2, i + 2..self.eye.len()) } else { 0.0 }
    }

    pub fn merge(&self, i: usize) -> f64 {
        let one_sided = !self.path.nodes[i].vertex.bsdf.lobes().contains(Lobes::TRANSMISSION);
        let merges = self.joins(i) && one_sided;
        if merges { self.eta * self.product(0..i + 2, i + 1..self.eye.len()) } else { 0.0 }
    }

    pub fn projection(&self) -> f64 {
        if self.joins(self.path.nodes.len() - 1) { self.product(0..self.light.len(), 0..0) } else { 0.0 }
    }

    pub fn total(&self) -> f64 {
        let m = self.path.nodes.len();
        let merges: f64 = (0..m).map(|i| self.merge(i)).sum();
        let connections: f64 = (1..m).map(|i| self.connection(i - 1)).sum();
        self.emission() + self.direct() + connections + merges + self.projection()
    }
}
